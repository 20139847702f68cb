/// This file is the step, in order: it says what happens and when. Each named stage says how.
///
///   detect    who is near whom, and where they touch
///   prepare   how each contact and hook is solved (solver/routes.h), and the rows for it
///   substep   force, impact, correct, move; a few per step
///   finish    quarantine, fast bodies, what breaks, sleep, events, folds, origins, what freezes, report
/// It computes nothing but times, and touches no data beyond naming a table. docs/step.md names the headers.

#include "hooke/world.h"

#include "world/blows.h"
#include "world/body_stages.h"
#include "world/claim.h"
#include "world/events.h"
#include "world/force_stages.h"
#include "world/hook_stages.h"
#include "world/impact_clamp.h"
#include "world/particle_stages.h"
#include "world/point_contact_stages.h"
#include "world/sleep.h"
#include "world/soft_bodies.h"
#include "world/step_report.h"
#include "world/stepping.h"
#include "world/stopwatch.h"
#include "world/world_data.h"

#include <memory>

namespace hooke {

namespace {

void detect(WorldData& w, double dt) {
  world::refresh_derived(w);
  world::refresh_hooks(w);
  world::set_off_explosions(w, dt);
  world::find_body_contacts(w, static_cast<Real>(dt));
  world::find_point_contacts(w, dt);
}

void prepare(WorldData& w, double dt, Real h) {
  world::prepare_particle_rows(w, h / static_cast<Real>(w.tables.desc.particle_substeps));
  world::begin_motion(w, static_cast<Real>(dt));
  world::prepare_joints(w, h);
  world::prepare_body_contacts(w, h);
  world::begin_step(w, dt);
}

/// Solves one particle substep: soft rows, yarns, tethers, loaded cloths as a whole, then ropes with what
/// depends on them. Contacts come last: nothing pushes a particle into a body then.
void substep_particles(WorldData& w, double end_time, Real h, bool first_of_substep, bool first_of_step) {
  world::begin_particle_substep(w, h);
  world::accelerate_particles(w, end_time, h, first_of_substep);
  world::update_point_contacts(w, h);
  world::begin_coupled_groups(w, h, first_of_substep);
  world::find_pressed_cloths(w, h);
  world::share_passing_masses(w, h, first_of_step);
  world::find_loaded_cloths(w);
  world::solve_springs(w, h, state::SpringClass::kStretch, state::SpringClass::kBend);
  world::solve_bends(w);
  world::solve_yarns(w);
  world::solve_solids(w, h);
  world::solve_springs(w, h, state::SpringClass::kTether, state::SpringClass::kLimit);
  world::solve_loaded_cloths(w, h);
  world::give_back_passing_masses(w);
  world::solve_ropes(w, end_time, h, first_of_step);
  world::solve_point_contacts(w, h);
  world::stop_body_passes(w, h);
  world::move_particles(w, h);
}

/// Solves one substep of bodies: impacts with restitution, in order of time; contacts with bias, and hooks
/// with all that depends on them. When bodies have moved, contacts are refreshed, and solved without bias,
/// which takes out the speed that pushed overlaps apart.
void substep(WorldData& w, int i, double begin_time, Real h) {
  const int particle_substeps = w.tables.desc.particle_substeps;
  const Real particle_h = h / static_cast<Real>(particle_substeps);
  world::accelerate_bodies(w, begin_time, h, i == 0);
  world::resolve_impacts(w, h);
  world::solve_body_contacts(w, h, i == 0);
  world::solve_joints(w, h);
  for (int k = 1; k <= particle_substeps; ++k) {
    substep_particles(w, begin_time + k * static_cast<double>(particle_h), particle_h, k == 1,
                      i == 0 && k == 1);
    world::move_bodies(w, particle_h);
    world::hold_back_passes(w, particle_h);
  }
  world::refresh_contacts(w, h);
  world::relax_joints(w, h);
  world::relax_body_contacts(w);
}

/// Makes the step up to its last substep. Returns false if a body yields: all is then as before, with a solid
/// in its place, and the step begins anew.
bool advance(WorldData& w, double dt, Real h, StepReport& report) {
  world::Stopwatch watch;
  detect(w, dt);
  report.detect_ms += watch.lap_ms();
  prepare(w, dt, h);
  report.prepare_ms += watch.lap_ms();
  bool holds = true;
  for (int i = 0; i < w.tables.desc.substeps && holds; ++i) {
    substep(w, i, w.tables.time + i * (dt / w.tables.desc.substeps), h);
    holds = !world::take_back_for_blows(w, dt, w.tables.time + (i + 1) * static_cast<double>(h), h);
  }
  report.substep_ms += watch.lap_ms();
  return holds;
}

void finish(WorldData& w, double dt, StepReport& report) {
  world::count_routes(w, report);
  report.rows_quarantined = world::quarantine_bodies(w);
  world::finish_body_contacts(w);
  world::clamp_to_impact_times(w);
  world::hold_back_passes(
      w, static_cast<Real>(dt) / static_cast<Real>(w.tables.desc.substeps * w.tables.desc.particle_substeps));
  report.rows_quarantined += world::finish_bodies(w, static_cast<Real>(dt));
  world::drop_broken_hooks(w);
  world::drop_broken_segments(w);
  world::put_to_sleep(w, static_cast<Real>(dt));
  world::gather_events(w);
  report.rows_quarantined += world::quarantine_non_finite(w);
  world::flow_cloths(w);
  world::rebase_origins(w);
  world::tear_deformables(w, dt);
  world::soften_pressed(w, w.tables.time + dt);
  world::follow_soft_bodies(w, dt);
  world::end_step(w, dt, report);
}

}  // namespace

StepReport World::step(Real dt) {
  const std::shared_ptr<WorldData> data = data_;  // Force laws may move or destroy this World.
  const world::Claim claim(data);
  if (!claim || !world::is_step(dt)) return {};
  StepReport report;
  WorldData& w = *claim;
  world::Stepping stepping(w);
  world::watch_for_blows(w, static_cast<double>(dt));
  const Real h = dt / static_cast<Real>(w.tables.desc.substeps);
  while (!advance(w, static_cast<double>(dt), h, report)) continue;
  world::Stopwatch watch;
  finish(w, static_cast<double>(dt), report);
  report.finish_ms = watch.lap_ms();
  stepping.end();
  return report;
}

}  // namespace hooke
