/// The step, in order. This file says what happens and when; each named stage says how.
///
///   detect    who is near whom, and where they touch             collision/, world/bodies
///   prepare   rows in solver form, colored; the wind             solver/, world/stages
///   substep   force, hit, correct, move; a few per step               solver/
///   finish    quarantine, folds, sleep, origins, report world/
///
/// Rules for this file: no arithmetic beyond time, no data access beyond naming a table, under 200 lines.
/// A stage reads the tables it takes by const reference and writes the ones it takes by reference.

#include "hooke/world.h"

#include "collision/deformable/element_contacts.h"
#include "collision/deformable/particle_contacts.h"
#include "collision/deformable/rope_contacts.h"
#include "collision/deformable/rope_passes.h"
#include "parallel/thread_pool.h"
#include "solver/air/force_fields.h"
#include "solver/body/body_motion.h"
#include "solver/contact/body_contacts.h"
#include "solver/contact/impacts.h"
#include "solver/coupled/direct_islands.h"
#include "solver/joint/joints.h"
#include "solver/rope/rope_repulsion.h"
#include "solver/soft/element_contact_solve.h"
#include "solver/soft/particle_contact_solve.h"
#include "solver/soft/particle_kernels.h"
#include "world/body_stages.h"
#include "world/claim.h"
#include "world/events.h"
#include "world/force_stages.h"
#include "world/hook_stages.h"
#include "world/impact_clamp.h"
#include "world/particle_stages.h"
#include "world/sleep.h"
#include "world/stepping.h"
#include "world/stopwatch.h"
#include "world/world_data.h"

#include <memory>

namespace hooke {

namespace {

using parallel::for_ranges;
using parallel::Range;
using state::SpringClass;
using world::for_bodies;
using world::for_contact_colors;

// Sizes below which a job stays on one thread.
constexpr int kParticleGrain = 2048;
constexpr int kContactGrain = 256;
constexpr int kElementContactGrain = 32;

void detect(WorldData& w, double dt) {
  world::refresh_derived(w);
  world::refresh_hooks(w);
  world::set_off_explosions(w, dt);
  world::list_awake_bodies(w);
  solver::evaluate_ragdolls(*w.pool, w.tables.hooks, w.tables.bodies, w.joints);
  world::find_body_contacts(w, static_cast<Real>(dt));
  if (world::wake_touched(w, static_cast<Real>(dt))) world::list_awake_bodies(w);
  collision::find_contacts(dt, w.particle_contacts, w.tables);
  collision::find_rope_contacts(*w.pool, static_cast<Real>(dt), w.rope_contacts, w.tables);
}

void prepare(WorldData& w, double dt, Real h) {
  state::Tables& t = w.tables;
  const Real particle_h = h / static_cast<Real>(t.desc.particle_substeps);
  world::prepare_rows(w, particle_h);
  world::begin_motion(w, static_cast<Real>(dt));
  for_bodies(w, [&](auto rows) { solver::prepare_bodies(rows, t.bodies); });
  solver::prepare_joints(*w.pool, h, t.hooks, t.bodies, w.joints);
  world::prepare_body_contacts(w, h);
  world::begin_step(w, dt);
}

void apply_forces(WorldData& w, double time, Real h, bool first) {
  state::Particles& particles = w.tables.particles;
  world::begin_particle_substep(w, h);
  world::apply_wind(w, h, first);
  world::apply_forces(w, h);
  for_ranges(*w.pool, particles.count(), kParticleGrain,
             [&](Range rows) { solver::wide::accelerate(w.tables.desc.gravity, h, rows, particles); });
  world::call_force_laws(w, time, h);
  solver::repel(*w.pool, h, w.repulsion, w.tables);
  solver::drive_pins(w.tables.pins, w.tables.objects, time, h, particles);
}

/// Elastic rows, soft ones before those that hold; ropes with what they are tied to, exactly; contacts last
/// among the writers of velocity.
void substep_particles(WorldData& w, double time, Real h, bool first) {
  state::Tables& t = w.tables;
  apply_forces(w, time, h, first);
  for_ranges(*w.pool, t.contacts.count(), kContactGrain,
             [&](Range rows) { collision::update_contacts(rows, h, w.particle_contacts, t); });
  for_ranges(*w.pool, static_cast<int>(t.element_contacts.size()), kElementContactGrain,
             [&](Range rows) { collision::update_element_contacts(rows, h, t); });
  collision::update_rope_contacts(*w.pool, h, w.rope_contacts, t);
  world::begin_coupled_groups(w, h, first);
  world::solve_springs(w, h, SpringClass::kStretch, SpringClass::kBend);
  world::solve_bends(w);
  world::solve_solids(w, h);
  world::solve_springs(w, h, SpringClass::kTether, SpringClass::kLimit);
  world::solve_ropes(w, h);
  collision::stop_rope_passes(*w.pool, h, w.rope_contacts, t);
  solver::solve_element_contacts(h, t);
  for_ranges(*w.pool, t.contacts.count(), kContactGrain, [&](Range rows) {
    solver::solve_contacts(t.objects, rows, h, t.bodies, t.contacts, t.particles);
  });
  for_ranges(*w.pool, t.particles.count(), kParticleGrain,
             [&](Range rows) { solver::wide::move(h, rows, t.particles); });
  world::flow_solids(w, h);
}

/// Bodies: hits that bounce, in the order of time; contacts with bias, or as a whole in hard islands; hooks,
/// then everything that is tied to them; poses, and where lively contacts are then; last the contacts again
/// without bias, which takes out the speed that pushed overlaps apart, and friction.
void substep(WorldData& w, int i, double time, Real h) {
  state::Bodies& bodies = w.tables.bodies;
  const int particle_substeps = w.tables.desc.particle_substeps;
  const Real particle_h = h / static_cast<Real>(particle_substeps);
  world::drive_kinematic_bodies(w, time + static_cast<double>(h), h);
  world::force_bodies(w, time, h);
  const solver::BodyStep step = {.gravity = w.tables.desc.gravity, .h = h, .first = i == 0};
  for_bodies(w, [&](auto rows) { solver::accelerate_bodies(rows, step, bodies); });
  world::freeze_inertia(w, h, false);
  world::resolve_impacts(w, h);
  for (int sweep = 0; sweep < w.tables.desc.bias_sweeps; ++sweep) {
    for_contact_colors(w, [&](Range blocks) {
      solver::solve_body_contacts(blocks, w.contact_step, w.body_contacts, bodies);
    });
  }
  solver::solve_direct_islands(*w.pool, step, w.direct_islands, w.body_contacts, bodies);
  world::limit_dense_piles(w);
  solver::solve_joints(*w.pool, h, w.tables.hooks, bodies, w.joints);
  solver::propagate_impacts(bodies, w.impacts);
  for (int k = 1; k <= particle_substeps; ++k) {
    substep_particles(w, time + k * static_cast<double>(particle_h), particle_h, k == 1);
    for_bodies(w, [&](auto rows) { solver::move_bodies(rows, particle_h, bodies); });
  }
  world::freeze_inertia(w, h, true);
  world::refresh_contacts(w, h);
  solver::relax_joints(*w.pool, h, w.tables.hooks, bodies, w.joints);
  for_contact_colors(
      w, [&](Range blocks) { solver::relax_body_contacts(blocks, w.contact_step, w.body_contacts, bodies); });
  world::limit_dense_piles(w);
}

void finish_bodies(WorldData& w, double dt) {
  state::Bodies& bodies = w.tables.bodies;
  world::finish_body_contacts(w);
  world::clamp_to_impact_times(w);
  for_bodies(w, [&](auto rows) { solver::finish_bodies(rows, bodies); });
  solver::finish_joints(*w.pool, static_cast<Real>(dt), w.tables.desc.substeps, bodies, w.joints,
                        w.tables.hooks);
  world::drop_broken_hooks(w);
  world::put_to_sleep(w, static_cast<Real>(dt));
  world::gather_events(w);
}

void finish(WorldData& w, double dt, StepReport& report) {
  report.rows_quarantined = world::quarantine_bodies(w);
  finish_bodies(w, dt);
  report.rows_quarantined += world::quarantine_non_finite(w);
  world::flow_cloths(w);
  world::rebase_origins(w);
  world::end_step(w, dt, report);
}

}  // namespace

StepReport World::step(Real dt) {
  const std::shared_ptr<WorldData> data = data_;  // force laws may move this World, or destroy it
  const world::Claim claim(data);
  StepReport report;
  if (!claim || !world::is_step(dt)) return report;
  WorldData& w = *claim;
  world::Stepping stepping(w);
  world::Stopwatch watch;
  const auto frame = static_cast<double>(dt);
  const int substeps = w.tables.desc.substeps;
  const Real h = dt / static_cast<Real>(substeps);

  detect(w, frame);
  report.detect_ms = watch.lap_ms();
  prepare(w, frame, h);
  report.prepare_ms = watch.lap_ms();
  for (int i = 0; i < substeps; ++i) substep(w, i, w.tables.time + i * (frame / substeps), h);
  report.substep_ms = watch.lap_ms();
  finish(w, frame, report);
  report.finish_ms = watch.lap_ms();
  stepping.end();
  return report;
}

}  // namespace hooke
