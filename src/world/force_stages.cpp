#include "world/force_stages.h"

#include "base/assert.h"
#include "elements/fields.h"
#include "solver/air/force_fields.h"
#include "solver/air/wind.h"
#include "solver/body/body_forces.h"
#include "solver/rope/rope_repulsion.h"
#include "solver/soft/particle_kernels.h"
#include "world/access.h"
#include "world/body_stages.h"

#include <algorithm>
#include <iterator>

namespace hooke::world {

namespace {

using parallel::for_ranges;
using parallel::Range;

constexpr int kDipoleGrain = 16;
constexpr int kForceGrain = 1024;
constexpr int kGravityGrain = 2048;
constexpr int kAirGrain = 512;

/// Lists the bodies that force laws over bodies see.
void list_law_bodies(WorldData& world) {
  const state::Tables& tables = world.tables;
  const auto asks = [](const state::ForceLawEntry& entry) { return entry.body_law != nullptr; };
  world.frame.law_bodies.clear();
  if (std::none_of(tables.force_laws.begin(), tables.force_laws.end(), asks)) return;
  std::copy_if(world.frame.awake.begin(), world.frame.awake.end(), std::back_inserter(world.frame.law_bodies),
               [&](std::uint32_t body) { return is_dynamic(tables.bodies, body); });
}

void force_dipoles(WorldData& world, Real h) {
  state::Tables& tables = world.tables;
  solver::gather_dipoles(tables.fields, world.frame.dipole_bodies, tables.bodies, world.frame.dipoles);
  for_ranges(*world.pool, static_cast<int>(world.frame.dipoles.size()), kDipoleGrain, [&](Range range) {
    solver::add_dipole_forces(range, world.frame.dipoles, tables.fields, static_cast<double>(h),
                              tables.bodies);
  });
}

void set_off(const FieldDesc& explosion, state::Tables& tables) {
  for (const std::uint32_t body : tables.moving_bodies) {
    if (!is_dynamic(tables.bodies, body)) continue;
    const Vec3 change =
        vector_cast<Real>(elements::radial(explosion, tables.bodies.center[body] - explosion.center));
    if (change == Vec3{}) continue;
    state::wake(tables.bodies, body);
    tables.bodies.motion[body].v += change;
  }
  for (const state::Deformable& object : tables.objects) {
    const DVec3 origin = object.origin - explosion.center;
    for (std::uint32_t p = object.particles.first; p < object.particles.end(); ++p) {
      if (!(tables.particles.velocity[p].inverse_mass > Real(0))) continue;
      const DVec3 place = origin + vector_cast<double>(tables.particles.position[p].x);
      tables.particles.velocity[p].v += vector_cast<Real>(elements::radial(explosion, place));
    }
  }
}

bool air_moves(const state::Tables& tables, const state::Deformable& object) {
  return tables.desc.wind.air_density > Real(0) &&
         (object.drag_coefficient > Real(0) || object.lift_coefficient > Real(0));
}

/// Calls `work` with ranges that cover the rows of an object's particles, on several threads.
template <class Work>
void for_particles(const WorldData& world, const state::Deformable& object, Work work) {
  const auto first = static_cast<int>(object.particles.first);
  for_ranges(*world.pool, static_cast<int>(object.particles.count), kForceGrain, [&](Range range) {
    work(Range{first + range.begin, first + range.end});
  });
}

/// Computes the loads of the wind once for all particle substeps of a substep; `h` is the length of one of
/// them [s]. Particle substeps are short because stretched cloth swings fast; the wind changes far more
/// slowly.
void compute_air_loads(WorldData& world, const state::Deformable& object, Real h, solver::AirLoads& loads) {
  state::Tables& tables = world.tables;
  const auto count = static_cast<Real>(tables.desc.particle_substeps);
  const solver::Air air = {world.frame.wind, tables.desc.wind.air_density, count * h};
  for_ranges(*world.pool, static_cast<int>(object.triangles.count), kAirGrain, [&](Range range) {
    solver::load_triangles(object, tables.triangles, air, tables.particles, range, loads);
  });
  for_particles(world, object,
                [&](Range rows) { solver::gather_loads(tables.particles, Real(1) / count, rows, loads); });
}

void apply_liquids(WorldData& world, const state::Deformable& object, Real h) {
  state::Tables& t = world.tables;
  for (const state::Field& field : t.fields) {
    if (field.desc.kind != FieldDesc::Kind::kLiquid) continue;
    const solver::LiquidSurface surface(field.desc, t.desc.gravity);
    solver::find_liquid_loads(object, {t.segments, t.triangles, t.tetrahedra}, surface, t.particles,
                              world.frame.liquid_loads);
    solver::apply_liquid(field.desc, surface, object, world.frame.liquid_loads, h, t.particles);
  }
}

void apply_wind(WorldData& world, Real h, bool first) {
  state::Tables& tables = world.tables;
  for (std::size_t row = 0; row < tables.objects.size(); ++row) {
    const state::Deformable& object = tables.objects[row];
    if (!air_moves(tables, object)) continue;
    if (object.segments.count > 0) {
      const solver::Air air = {world.frame.wind, tables.desc.wind.air_density, h};
      solver::push_segments(object, tables.segments, air, tables.particles);
    }
    if (object.triangles.count == 0) continue;
    solver::AirLoads& loads = world.derived.soft.groups[world.derived.soft.group_of[row]].air_loads;
    if (first) compute_air_loads(world, object, h, loads);
    for_particles(world, object, [&](Range rows) { solver::push_particles(loads, rows, tables.particles); });
  }
}

void apply_forces(WorldData& world, Real h) {
  state::Tables& tables = world.tables;
  const solver::ForceInputs inputs = {tables.fields, world.frame.wind, tables.desc.wind.air_density,
                                      tables.any_force};
  for (const state::Deformable& object : tables.objects) {
    if (tables.fields.empty() && !tables.any_force && !object.points_drag) continue;
    for_ranges(*world.pool, static_cast<int>(object.particles.count), kForceGrain,
               [&](Range range) { solver::apply_forces(object, inputs, h, range, tables.particles); });
    apply_liquids(world, object, h);
  }
}

void apply_gravity(WorldData& world, Real h) {
  for_ranges(*world.pool, world.tables.particles.count(), kGravityGrain, [&](Range rows) {
    solver::wide::accelerate(world.tables.desc.gravity, h, rows, world.tables.particles);
  });
}

void call_force_laws(WorldData& world, double time, Real h) {
  state::Tables& tables = world.tables;
  if (tables.force_laws.empty()) return;
  std::fill(world.frame.law_force.begin(), world.frame.law_force.end(), Vec3{});
  for (const state::ForceLawEntry& entry : tables.force_laws) {
    if (!entry.law) continue;
    for (const state::Deformable& object : tables.objects) {
      ForceView view = ForceViewAccess::make(tables, object, time, world.frame.law_force.data());
      entry.law(view);
    }
  }
  HOOKE_ASSERT(world.frame.law_force.size() == tables.particles.velocity.size());
  for (std::size_t p = 0; p < world.frame.law_force.size(); ++p) {
    tables.particles.velocity[p].v +=
        (h * tables.particles.velocity[p].inverse_mass) * world.frame.law_force[p];
  }
}

void repel_and_drive(WorldData& world, double time, Real h) {
  state::Tables& tables = world.tables;
  solver::repel(*world.pool, h, world.frame.repulsion, tables);
  solver::drive_pins(tables.pins, tables.objects, time, h, tables.particles);
}

}  // namespace

void set_off_explosions(WorldData& world, double dt) {
  state::Tables& tables = world.tables;
  for (const state::Field& field : tables.fields) {
    if (field.desc.kind != FieldDesc::Kind::kExplosion) continue;
    if (field.desc.time >= tables.time && field.desc.time < tables.time + dt) set_off(field.desc, tables);
  }
}

void begin_body_forces(WorldData& world) {
  const state::Tables& tables = world.tables;
  const auto in_air = [&](std::uint32_t body) {
    const state::BodyTraits& traits = tables.bodies.traits[body];
    return traits.drag_coefficient > Real(0) || traits.magnus_volume != Real(0);
  };
  list_law_bodies(world);
  solver::list_bodies_with_dipoles(tables.bodies, world.frame.dipole_bodies);
  world.frame.bodies_surrounded = !tables.fields.empty() || !world.frame.dipole_bodies.empty() ||
                                  std::any_of(world.frame.awake.begin(), world.frame.awake.end(), in_air);
  if (world.frame.law_bodies.empty() && !world.frame.bodies_surrounded) return;
  world.frame.given_force = tables.bodies.force;
  world.frame.given_torque = tables.bodies.torque;
}

void force_bodies(WorldData& world, double time, Real h) {
  state::Tables& tables = world.tables;
  solver::twist_bodies(static_cast<double>(h) / tables.desc.particle_substeps, tables,
                       world.frame.twist_rows);
  if (world.frame.law_bodies.empty() && !world.frame.bodies_surrounded) return;
  tables.bodies.force = world.frame.given_force;
  tables.bodies.torque = world.frame.given_torque;
  if (world.frame.bodies_surrounded) {
    const solver::Surroundings around = {.fields = tables.fields,
                                         .colliders = tables.colliders,
                                         .desc = tables.desc,
                                         .step = tables.step_count,
                                         .time = time,
                                         .h = h};
    for_bodies(world, [&](auto rows) { solver::add_body_forces(rows, around, tables.bodies); });
    if (!world.frame.dipole_bodies.empty()) force_dipoles(world, h);
  }
  if (world.frame.law_bodies.empty()) return;
  BodyForceView view = ForceViewAccess::make(world, time);
  for (const state::ForceLawEntry& entry : tables.force_laws) {
    if (entry.body_law) entry.body_law(view);
  }
}

void read_wind(WorldData& world, double time) {
  const state::Tables& tables = world.tables;
  const bool even = !solver::has_gusts(tables.desc.wind);
  for (const state::Deformable& object : tables.objects) {
    if (!object.feels_air()) continue;
    if (even) {
      const auto first = world.frame.wind.begin() + object.particles.first;
      std::fill(first, first + object.particles.count, solver::AirRecord{tables.desc.wind.velocity, Real(0)});
      continue;
    }
    for_particles(world, object, [&](Range rows) {
      for (int p = rows.begin; p < rows.end; ++p) {
        const DVec3 place = object.origin + vector_cast<double>(tables.particles.position[p].x);
        world.frame.wind[p].v = solver::wind_at(tables.desc.wind, place, time, tables.step_count);
      }
    });
  }
}

void accelerate_particles(WorldData& world, double time, Real h, bool first) {
  apply_wind(world, h, first);
  apply_forces(world, h);
  apply_gravity(world, h);
  call_force_laws(world, time, h);
  repel_and_drive(world, time, h);
}

}  // namespace hooke::world
