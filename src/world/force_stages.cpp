#include "world/force_stages.h"

#include "elements/fields.h"
#include "solver/body/body_forces.h"
#include "world/access.h"
#include "world/body_stages.h"

#include <algorithm>
#include <iterator>

namespace hooke::world {

namespace {

constexpr int kDipoleGrain = 16;

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
  parallel::for_ranges(*world.pool, static_cast<int>(world.frame.dipoles.size()), kDipoleGrain,
                       [&](parallel::Range range) {
                         solver::add_dipole_forces(range, world.frame.dipoles, tables.fields,
                                                   static_cast<double>(h), tables.bodies);
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

}  // namespace hooke::world
