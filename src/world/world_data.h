#pragma once

#include "hooke/world.h"

#include "base/disjoint_sets.h"
#include "collision/broad_phase/broad_phase.h"
#include "collision/continuous/continuous.h"
#include "collision/deformable/particle_contacts.h"
#include "collision/deformable/rope_contacts.h"
#include "collision/narrow_phase/dense_piles.h"
#include "collision/narrow_phase/narrow_phase.h"
#include "parallel/thread_pool.h"
#include "solver/air/air.h"
#include "solver/air/liquids.h"
#include "solver/body/dipole_forces.h"
#include "solver/contact/body_contacts.h"
#include "solver/contact/impacts.h"
#include "solver/coupled/coupled_groups.h"
#include "solver/coupled/direct_islands.h"
#include "solver/coupled/load_bearing_contacts.h"
#include "solver/joint/joints.h"
#include "solver/rope/rope_repulsion.h"
#include "solver/rope/rope_systems.h"
#include "solver/rope/rope_twist.h"
#include "solver/soft/bending.h"
#include "solver/soft/gas_pressure.h"
#include "solver/soft/isometric_bending.h"
#include "solver/soft/plastic_flow.h"
#include "solver/soft/spring_blocks.h"
#include "solver/soft/tetrahedron_solve.h"
#include "state/sleeping_pairs.h"
#include "state/tables.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace hooke {

/// Bodies about to meet faster than one of them asked for; see world::note_approaches.
struct ClosingPair {
  std::uint32_t manifold = 0;
  Real speed = Real(0);  ///< [m/s]
  DVec3 point = {};      ///< Where they will meet [m].
};

/// How a body that is awake was when the step began.
struct StartOfBody {
  std::uint32_t row = 0;
  Real rest_time = Real(0);
  DVec3 center = {};
  Quat rotation = {};
  Vec3 v = {};
  Vec3 angular_momentum = {};
  Vec3 angular_velocity = {};
  Vec3 force = {};
  Vec3 torque = {};
};

/// What contacts did to a body in a bundle, for each particle substep when there are several in a substep.
struct ContactShare {
  std::uint32_t body = 0;  ///< Row.
  Vec3 v = {};             ///< [m/s]
  Vec3 omega_scaled = {};
};

namespace world {

/// What is derived from the tables, and made again when their revision changes. It decides nothing: a World
/// that was restored makes the same again.
struct Derived {
  // Of deformables; see world::refresh_derived.
  std::uint64_t revision = ~std::uint64_t{0};  ///< Revision of the tables that all of this belongs to.
  solver::SpringBlocks spring_blocks;
  solver::BendBlocks bend_blocks;
  solver::IsometricBendBlocks isometric_bend_blocks;
  solver::TetrahedronRows tetrahedra;
  solver::Yields yields;                       ///< Bends and tetrahedra that may flow.
  std::vector<std::uint32_t> matched_objects;  ///< Rows of solids that are matched to their shapes at rest.
  std::vector<std::uint32_t> gas_objects;      ///< Rows of closed cloths with gas, in order of creation.
  solver::AirLoads air_loads;
  std::vector<solver::RopeSystem> rope_systems;  ///< One per rope, in order of creation.
  solver::CoupledGroups coupled_groups;  ///< Ropes with the hooks, points and bodies that they depend on.
  std::uint64_t clamps_revision = 0;     ///< Sum of both revisions, which only grow.

  // Of hooks; see world::refresh_hooks.
  std::uint64_t joints_revision = ~std::uint64_t{0};
  solver::Joints joints;
  std::vector<std::uint8_t> hooked;  ///< Whether a hook holds the body, by body row.
  solver::Supports supports;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> hooked_pairs;  ///< Bodies that do not collide, sorted.
  std::vector<std::uint32_t>
      hooked_begin;  ///< Where the pairs of each first body begin; one more at the end.

  // Of bodies; what it holds does not change what a step does.
  collision::BroadPhase broad_phase;
  bool broad_phase_stale = true;             ///< Everything must be entered again.
  std::vector<std::uint32_t> placed_bodies;  ///< Bodies added, moved by hand or asleep since the last step.
  std::atomic<bool> boxes_are_current =
      false;  ///< Boxes of all bodies are where they are now; see boxes_for_queries.
  std::mutex boxes_mutex;
};

/// What lives for one step, or for one substep, and keeps only its memory from one to the next.
struct Frame {
  // Bodies: who moves, who is near whom.
  std::vector<std::uint32_t> awake;  ///< Rows of bodies that move in this step, in ascending order.
  std::vector<std::uint32_t>
      moved_set;  ///< Rows of those and of placed bodies: all that may meet others now.
  std::vector<std::uint8_t> in_moved_set;  ///< By collider; empty where nobody sleeps, as then all are in it.
  std::vector<collision::ColliderPair> pairs_found;
  collision::DensePiles dense_piles;
  collision::NarrowPhase narrow_phase;
  state::SleepingPairScratch sleeping_pair_scratch;
  std::vector<ClosingPair> closing_pairs;  ///< In order of manifolds.
  std::vector<ContactEvent> contacts_now;  ///< Contacts of bodies that ask for events.
  std::vector<SensorEvent> visits_now;
  base::DisjointSets islands;            ///< Bodies that may fall asleep together.
  std::vector<Real> island_rest;         ///< For how long each island has been at rest, at its root [s].
  std::vector<std::uint8_t> body_marks;  ///< By body: scratch of couple_articulations and share_out_contacts.

  // Bodies: how contacts are solved.
  solver::BodyContacts body_contacts;
  solver::ContactStep contact_step;
  solver::Impacts impacts;
  solver::DirectIslands direct_islands;
  solver::LoadBearingScratch load_bearing;

  // Bodies: clamping to the time of impact.
  std::vector<std::uint8_t> fast;    ///< By body: it may pass through others.
  std::vector<std::uint8_t> astray;  ///< By body: it goes where detect did not think it could.
  std::vector<collision::ImpactCandidate> impact_candidates;
  collision::PathScratch path_scratch;
  collision::SweptBodies swept;
  collision::ContinuousScratch continuous;

  bool bodies_quarantined = false;  ///< Some body was put back in this step.

  // Where the step began: quarantine and a step that throws put things back.
  std::vector<Quat> start_rotation;  ///< By body, of those awake.
  std::vector<state::PositionRecord> start_position;
  std::vector<state::VelocityRecord> start_velocity;
  std::vector<DVec3> start_origin;
  std::vector<StartOfBody> start_bodies;  ///< Bodies awake; see world::Stepping.

  // Particles.
  collision::ParticleContactScratch particle_contacts;
  collision::RopeContactFinder rope_contacts;
  solver::Repulsion repulsion;
  std::vector<state::VelocityRecord> velocity_before;  ///< Of rope nodes, before the substep's forces.
  std::vector<solver::AirRecord> wind;                 ///< At each particle [m/s].
  std::vector<solver::LiquidLoad> liquid_loads;        ///< Of the object at hand.
  std::vector<solver::GasVolume> gas_volumes;          ///< One for each of Derived::gas_objects.
  std::vector<solver::RopeSystemScratch> rope_system_scratch;  ///< One per part of a parallel loop.
  std::vector<ContactShare> contact_shares;                    ///< Lives for one substep.
  std::vector<solver::HookedPoint> hooked_points;              ///< Lives for one substep.
  std::vector<solver::TwistRow> twist_rows;                    ///< Lives for one substep.

  // Forces.
  std::vector<Vec3> law_force;               ///< What force laws ask for [N].
  std::vector<std::uint32_t> law_bodies;     ///< Bodies that force laws see: rows in ascending order.
  std::vector<std::uint32_t> dipole_bodies;  ///< Bodies with a dipole moment: rows in ascending order.
  std::vector<solver::Dipole> dipoles;  ///< Dipoles of bodies where they are in this substep, and of fields.
  bool bodies_surrounded = false;       ///< Something besides laws pushes bodies in each substep.
  std::vector<Vec3> given_force;        ///< On bodies, without fields and force laws [N].
  std::vector<Vec3> given_torque;       ///< [N m]
};

/// What the last step has to tell those who ask after it.
struct LastStep {
  Events events;
  std::vector<HookId> broken_hooks;
};

}  // namespace world

/// A World's inside, in parts: a stage of the step takes those that it uses.
struct WorldData {
  state::Tables tables;    ///< Everything that a snapshot holds.
  world::Derived derived;  ///< Made again from the tables when they change.
  world::Frame frame;      ///< Lives for one step.
  world::LastStep last_step;

  // Services.
  std::unique_ptr<parallel::ThreadPool> pool;
  bool stepping = false;  ///< A step runs: calls that change the World are refused.
};

struct SnapshotData {
  state::Tables tables;
};

}  // namespace hooke
