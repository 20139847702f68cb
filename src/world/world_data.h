#pragma once

#include "hooke/world.h"

#include "base/disjoint_sets.h"
#include "collision/broad_phase/broad_phase.h"
#include "collision/continuous/continuous.h"
#include "collision/deformable/body_passes.h"
#include "collision/deformable/particle_contacts.h"
#include "collision/deformable/rope_contacts.h"
#include "collision/narrow_phase/dense_piles.h"
#include "collision/narrow_phase/narrow_phase.h"
#include "parallel/thread_pool.h"
#include "solver/air/air.h"
#include "solver/air/gas_pressure.h"
#include "solver/air/liquids.h"
#include "solver/body/dipole_forces.h"
#include "solver/cloth/loaded_cloths.h"
#include "solver/contact/backing_contacts.h"
#include "solver/contact/body_contacts.h"
#include "solver/contact/impacts.h"
#include "solver/coupled/coupled_groups.h"
#include "solver/coupled/direct_islands.h"
#include "solver/coupled/load_bearing_contacts.h"
#include "solver/joint/joints.h"
#include "solver/rope/rope_repulsion.h"
#include "solver/rope/rope_spread.h"
#include "solver/rope/rope_systems.h"
#include "solver/rope/rope_twist.h"
#include "solver/soft/pass_masses.h"
#include "solver/soft/soft_groups.h"
#include "solver/surface/joined_solids.h"
#include "solver/surface/surface_groups.h"
#include "state/body_manifolds.h"
#include "state/sleeping_pairs.h"
#include "state/tables.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace hooke {

/// Two bodies that are about to meet faster than one of them asked for; see world::note_closing_pairs.
struct ClosingPair {
  std::uint32_t manifold = 0;
  Real speed = Real(0);  ///< Closing speed [m/s].
  DVec3 point = {};      ///< Where they will meet [m].
};

/// State of an awake body when the step began.
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

/// Added to the row of a body where that of a deformable may stand, too.
inline constexpr std::uint32_t kIsBody = 0x80000000;

/// What a deformable and something that it touches have given each other in the step so far.
struct DeformableTouch {
  std::uint32_t object = 0;  ///< Row of the deformable.
  std::uint32_t other = 0;   ///< Row of the other deformable, or of a body, with kIsBody.
  std::uint32_t points = 0;  ///< Places that pressed in the last particle substep.
  bool meets = false;        ///< Some place is about to meet in this particle substep.
  Real closing = Real(0);    ///< Fastest speed of such places [m/s].
  Real speed = Real(0);      ///< Fastest speed at which they met in the step [m/s].
  DVec3 met_at = {};         ///< Where that was [m].
  Vec3 normal = {};          ///< Unit vector from the deformable to the other, there.
  DVec3 closing_at = {};     ///< Where `closing` is [m].
  Vec3 closing_normal = {};
  DVec3 impulse = {};          ///< On the deformable [N s].
  double normal_impulse = 0;   ///< Sum along the normals [N s].
  double substep_impulse = 0;  ///< The same in this particle substep [N s].
  double largest_impulse = 0;  ///< Largest of these [N s].
  DVec3 weighted_place = {};   ///< Sum of places times their impulses, from the origin of the object.
};

/// What contacts did to a body of a coupled group, as the share of one particle substep.
struct ContactShare {
  std::uint32_t body = 0;  ///< Row of the body.
  Vec3 v = {};             ///< Change of velocity [m/s].
  Vec3 omega_scaled = {};
};

namespace world {

/// What is derived from the tables and made again when their revision changes: copies of rows only for the
/// objects that changed. It has no influence on results: a World that was restored derives all of it again.
struct Derived {
  // These members belong to deformables; see world::refresh_derived.
  std::uint64_t revision = ~std::uint64_t{0};  ///< Revision of the tables that these members were made from.
  solver::SoftGroups soft;                     ///< Copies of springs, bends, tetrahedra and triangles.
  std::vector<std::uint32_t> matched_objects;  ///< Rows of solids that are solved by shape matching.
  std::vector<solver::ClothBearing> cloth_bearings;  ///< What each cloth can bear, in order of creation.
  std::vector<std::uint32_t> gas_objects;        ///< Rows of closed cloths with gas, in order of creation.
  std::vector<solver::RopeSystem> rope_systems;  ///< One per chain of a rope, in order of creation.
  solver::CoupledGroups coupled_groups;  ///< Ropes with the hooks, points and bodies that they depend on.
  std::uint64_t clamps_revision = 0;     ///< Sum of `revision` and `hook_revision`, both of which only grow.

  // These members belong to hooks; see world::refresh_hooks.
  std::uint64_t joints_revision = ~std::uint64_t{0};
  solver::Joints joints;
  std::vector<std::uint8_t> hooked;  ///< Whether a hook holds the body, by body row.
  solver::Supports supports;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> hooked_pairs;  ///< Bodies that do not collide, sorted.
  std::vector<std::uint32_t>
      hooked_begin;  ///< Index of the first pair of each first body; one more at the end.

  // These members belong to bodies. What they hold never changes the result of a step.
  collision::BroadPhase broad_phase;
  bool broad_phase_stale = true;             ///< All boxes must be entered again.
  std::vector<std::uint32_t> placed_bodies;  ///< Bodies that were added, placed by hand or put to sleep since
                                             ///< detect last entered boxes.
  std::atomic<bool> boxes_are_current =
      false;  ///< All boxes are where their bodies are now; see boxes_for_queries.
  std::mutex boxes_mutex;
};

/// What lives for one step or one substep. Only its memory is kept from one to the next.
struct Frame {
  // These members say which bodies move and which are near each other.
  std::vector<std::uint32_t> awake;  ///< Rows of bodies that move in this step, in ascending order.
  std::vector<std::uint32_t>
      moved_set;  ///< Rows of those and of placed bodies: all that may meet others in this step.
  std::vector<std::uint8_t> in_moved_set;  ///< By collider; empty if no body sleeps: all are in the set.
  std::vector<collision::ColliderPair> pairs_found;
  collision::DensePiles dense_piles;
  collision::NarrowPhase narrow_phase;
  state::SleepingPairScratch sleeping_pair_scratch;
  std::vector<ClosingPair> closing_pairs;  ///< In order of their manifolds.
  std::vector<ContactEvent> contacts_now;  ///< Contacts of bodies that ask for events.
  std::vector<SensorEvent> visits_now;
  std::vector<DeformableTouch> deformable_touches;  ///< Of deformables that ask for events.
  std::vector<DeformableContactEvent> deformable_touches_now;
  std::vector<Vec3> contact_impulses;  ///< By particle: of those contacts in the step so far [N s].
  double step_length = 0;              ///< [s]
  base::DisjointSets islands;          ///< Sets of bodies that may fall asleep together.
  std::vector<Real> island_rest;       ///< Time for which each island has been at rest, at its root [s].
  std::vector<Vec3> pushes;  ///< By body row: force of all points of deformables that press on it [N].
  std::vector<std::uint8_t> body_marks;  ///< By body: scratch of couple_articulations and share_out_contacts.

  // These members solve contacts of bodies.
  solver::BodyContacts body_contacts;
  solver::ContactStep contact_step;
  solver::Impacts impacts;
  solver::DirectIslands direct_islands;
  solver::LoadBearingScratch load_bearing;
  RouteCounts routes;  ///< Counts of contacts by their ways.

  // These members clamp bodies to their times of impact.
  std::vector<std::uint8_t> fast;    ///< By body row: it may pass through others.
  std::vector<std::uint8_t> astray;  ///< By body row: it leaves the boxes that detect expected it to stay in.
  std::vector<collision::ImpactCandidate> impact_candidates;
  collision::PathScratch path_scratch;
  collision::SweptBodies swept;
  collision::ContinuousScratch continuous;

  bool bodies_quarantined = false;  ///< Some body was quarantined in this step.

  std::vector<std::uint32_t> check_marks;  ///< Scratch memory of HOOKE_VALIDATE.

  // These members hold the state when the step began, to which quarantine and a step that throws go back.
  std::vector<Quat> start_rotation;  ///< By body row; set for awake bodies.
  std::vector<state::PositionRecord> start_position;
  std::vector<state::VelocityRecord> start_velocity;
  std::vector<DVec3> start_origin;
  std::vector<StartOfBody> start_bodies;  ///< One for each awake body; see world::Stepping.

  // These members belong to particles.
  collision::ParticleContactScratch particle_contacts;
  collision::RopeContactFinder rope_contacts;
  collision::BodyPassFinder body_passes;
  std::vector<state::ElementContact> pressed_faces;  ///< Of stiff solids, by bodies; as below.
  state::BodyManifolds body_manifolds;               ///< Valid for one step.
  solver::BackingContacts backing_contacts;          ///< Valid for one particle substep.
  std::vector<solver::PassMass> pass_masses;         ///< Valid for one particle substep.
  solver::LoadedCloths loaded_cloths;                ///< Valid for one particle substep.
  std::uint32_t cloths_unconverged = 0;  ///< Solutions of these that did not come to an end in this step.
  std::uint32_t cloths_left_to_contacts = 0;  ///< Times in this step that bodies were not solved with one.
  std::uint32_t passes_held_back = 0;  ///< Points and bodies that hold_back_passes has moved in this step.
  std::uint32_t passes_left = 0;       ///< Elements that shapes have come through all the same.
  solver::SurfaceContacts surfaces;    ///< Contacts of deformables with each other.
  solver::JoinedSolids joined_solids;  ///< Stiff solids that are solved together.
  solver::Repulsion repulsion;
  std::vector<state::VelocityRecord> velocity_before;  ///< Velocities of rope nodes before forces act.
  std::vector<solver::AirRecord> wind;                 ///< Velocity of the air at each particle [m/s].
  std::vector<solver::LiquidLoad> liquid_loads;        ///< Loads of the object that is handled now.
  std::vector<solver::GasVolume> gas_volumes;          ///< One for each of Derived::gas_objects.
  solver::RopeSpreadScratch rope_spread;               ///< What surfaces did to ropes in a particle substep.
  std::vector<solver::RopeSystemScratch> rope_system_scratch;  ///< One per part of a parallel loop.
  std::vector<ContactShare> contact_shares;                    ///< Valid for one substep.
  std::vector<solver::HookedPoint> hooked_points;              ///< Valid for one particle substep.
  std::vector<int> pressing_points;          ///< By row of the body; valid while solids are solved.
  std::vector<solver::TwistRow> twist_rows;  ///< One for each twist span; valid for one particle substep.

  // These members belong to forces.
  std::vector<Vec3> law_force;               ///< Sum of the forces of laws on each particle [N].
  std::vector<std::uint32_t> law_bodies;     ///< Rows of the bodies that force laws see, in ascending order.
  std::vector<std::uint32_t> dipole_bodies;  ///< Rows of the bodies with a dipole moment, in ascending order.
  std::vector<solver::Dipole> dipoles;  ///< Dipoles of fields, then of bodies where they are in this substep.
  bool bodies_surrounded = false;       ///< Fields, air or dipoles act on bodies in each substep.
  std::vector<Vec3> given_force;        ///< Forces that the user gave for the step, by body row [N].
  std::vector<Vec3> given_torque;       ///< Torques that the user gave for the step [N m].
};

/// What one other body or deformable gave to a body that yields, in the step so far.
struct BlowSum {
  std::uint32_t yielding = 0;  ///< Row of Tables::yielding.
  std::uint32_t other = 0;     ///< Row of the deformable, or of the body, with kIsBody.
  Real impulse = Real(0);      ///< Sum along the normals of contacts [N s].
  Real pushed = Real(0);       ///< Largest impulse of one contact, with that of bouncing [N s].
  Real largest = Real(0);      ///< Largest impulse of one contact in one substep [N s].
  DVec3 place = {};            ///< Where that was [m].
};

/// What is kept to see which bodies yield in a step, and to take the step back then (world/blows.h).
struct Blows {
  std::unique_ptr<state::Tables> before;  ///< The tables when the step began, if `may_return`.
  bool may_return = false;
  int returns = 0;  ///< How often this step has been taken back.
  std::vector<BlowSum> sums;
  std::vector<std::uint32_t> row_of;  ///< By body: its row of Tables::yielding, or Tables::kNoRow.
};

/// What the World reports about the last step.
struct LastStep {
  Events events;
  std::vector<HookId> broken_hooks;
  std::vector<DeformableContact> deformable_contacts;
  std::vector<Vec3> contact_forces;           ///< By particle [N].
  std::uint64_t contact_forces_revision = 0;  ///< Revision of the tables to which these belong.
};

}  // namespace world

/// The inside of a World. A stage of the step takes from it what it uses.
struct WorldData {
  state::Tables tables;    ///< Everything that a snapshot holds.
  world::Derived derived;  ///< Made again from the tables when these change.
  world::Frame frame;      ///< Memory of one step.
  world::LastStep last_step;
  world::Blows blows;

  // These members serve every step.
  std::unique_ptr<parallel::ThreadPool> pool;
  bool stepping = false;  ///< A step runs, so calls that change the World are refused.
};

struct SnapshotData {
  state::Tables tables;
};

}  // namespace hooke
