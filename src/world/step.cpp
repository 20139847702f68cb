/// The step, in order. This file says what happens and when; each named stage says how.
///
///   detect    which particles are near which shapes              collision/
///   prepare   rows in solver form, colored; the wind             solver/, world/stages
///   substep   force, correct, move; a few per step               solver/
///   finish    quarantine, origins, report                        world/stages
///
/// Rules for this file: no arithmetic beyond time, no data access beyond naming a table, under 200 lines.
/// A stage reads the tables it takes by const reference and writes the ones it takes by reference.

#include "hooke/world.h"

#include "base/float_environment.h"
#include "collision/particle_contacts.h"
#include "parallel/thread_pool.h"
#include "solver/bends.h"
#include "solver/chains.h"
#include "solver/contacts.h"
#include "solver/forces.h"
#include "solver/springs.h"
#include "solver/wide/wide.h"
#include "world/stages.h"
#include "world/stopwatch.h"
#include "world/world_data.h"

#include <cmath>

namespace hooke {

namespace {

using parallel::for_ranges;
using parallel::Range;
using state::SpringClass;

// Sizes below which a job stays on one thread.
constexpr int kParticleGrain = 2048;
constexpr int kBlockGrain = 16;
constexpr int kContactGrain = 256;
constexpr int kChainGrain = 1;

void detect(WorldData& w, double dt) {
  world::refresh_derived(w);
  collision::find_contacts(w.tables, dt);
}

void prepare(WorldData& w, double dt, Real h) {
  solver::prepare_springs(w.spring_blocks, h);
  solver::prepare_bends(w.bend_blocks, h);
  world::begin_step(w, dt);
}

/// Rows of one pass share no particle, so their order does not matter; passes follow one another.
void solve_springs(WorldData& w, Real h, SpringClass first, SpringClass last) {
  for (const solver::SpringPass& pass : w.spring_blocks.passes) {
    if (pass.kind < first || pass.kind > last) continue;
    for_ranges(*w.pool, pass.end - pass.first, kBlockGrain, [&](Range blocks) {
      const Range rows = {pass.first + blocks.begin, pass.first + blocks.end};
      solver::solve_springs(w.spring_blocks, pass, rows, h, w.tables.particles);
    });
  }
}

void solve_bends(WorldData& w) {
  for (const solver::BendPass& pass : w.bend_blocks.passes) {
    for_ranges(*w.pool, pass.end - pass.first, kBlockGrain, [&](Range blocks) {
      const Range rows = {pass.first + blocks.begin, pass.first + blocks.end};
      solver::solve_bends(w.bend_blocks, pass, rows, w.tables.particles);
    });
  }
}

void apply_forces(WorldData& w, double time, Real h) {
  state::Particles& particles = w.tables.particles;
  world::remember_rope_velocities(w);
  world::apply_wind(w, h);
  world::apply_forces(w, h);
  for_ranges(*w.pool, particles.count(), kParticleGrain,
             [&](Range rows) { solver::wide::accelerate(w.tables.desc.gravity, h, rows, particles); });
  world::call_force_laws(w, time, h);
  solver::drive_pins(w.tables.pins, w.tables.objects, time, h, particles);
}

/// Ropes first, exactly; then elastic rows, soft ones before those that hold; contacts last among the writers
/// of velocity.
void substep_particles(WorldData& w, double time, Real h) {
  state::Tables& t = w.tables;
  apply_forces(w, time, h);

  for_ranges(*w.pool, t.contacts.count(), kContactGrain,
             [&](Range rows) { collision::update_contacts(rows, t); });
  for_ranges(*w.pool, static_cast<int>(w.chains.size()), kChainGrain, [&](Range rows) {
    solver::solve_chains(std::span(w.chains).subspan(rows.begin, rows.count()), w.velocity_before, h,
                         t.particles, t.segments, t.contacts);
  });
  solve_springs(w, h, SpringClass::kStretch, SpringClass::kBend);
  solve_bends(w);
  solve_springs(w, h, SpringClass::kTether, SpringClass::kLimit);
  for_ranges(*w.pool, t.contacts.count(), kContactGrain,
             [&](Range rows) { solver::solve_contacts(t.objects, rows, h, t.contacts, t.particles); });

  for_ranges(*w.pool, t.particles.count(), kParticleGrain,
             [&](Range rows) { solver::wide::move(h, rows, t.particles); });
}

void finish(WorldData& w, double dt, StepReport& report) {
  report.rows_quarantined = world::quarantine_non_finite(w);
  world::rebase_origins(w);
  world::end_step(w, dt, report);
}

}  // namespace

StepReport World::step(Real dt) {
  WorldData& w = *data_;
  StepReport report;
  if (!(dt > Real(0)) || !std::isfinite(dt) || w.stepping) return report;
  const base::FloatEnvironment environment;
  w.stepping = true;
  world::Stopwatch watch;
  const auto frame = static_cast<double>(dt);
  const int passes = w.tables.desc.substeps * w.tables.desc.particle_substeps;
  const Real h = dt / static_cast<Real>(passes);

  detect(w, frame);
  report.detect_ms = watch.lap_ms();
  prepare(w, frame, h);
  report.prepare_ms = watch.lap_ms();
  // Bodies stand still in this version, so a substep of the world is its particle substeps.
  for (int i = 1; i <= passes; ++i) substep_particles(w, w.tables.time + i * (frame / passes), h);
  report.substep_ms = watch.lap_ms();
  finish(w, frame, report);
  report.finish_ms = watch.lap_ms();
  w.stepping = false;
  return report;
}

}  // namespace hooke
