#include "solver/cloth/cloth_loads.h"

#include "solver/cloth/cloth_tuning.h"

#include <algorithm>
#include <cmath>

namespace hooke::solver {

WholeSolid whole_solid(std::uint32_t object, const state::Tables& tables) {
  const state::Rows rows = tables.objects[object].particles;
  const auto place = [&](std::uint32_t row) { return vector_cast<double>(tables.particles.position[row].x); };
  WholeSolid solid;
  DVec3 momentum;
  for (std::uint32_t row = rows.first; row < rows.end(); ++row) {
    const auto mass = static_cast<double>(tables.particles.mass[row]);
    solid.mass += mass;
    solid.center += mass * place(row);
    momentum += mass * vector_cast<double>(tables.particles.velocity[row].v);
  }
  solid.center = (1 / solid.mass) * solid.center;
  solid.velocity = (1 / solid.mass) * momentum;
  for (std::uint32_t row = rows.first; row < rows.end(); ++row) {
    const auto mass = static_cast<double>(tables.particles.mass[row]);
    const DVec3 r = place(row) - solid.center;
    solid.spin += mass * cross(r, vector_cast<double>(tables.particles.velocity[row].v));
    solid.inertia = solid.inertia + math::inertia_of_point(mass, r);
  }
  return solid;
}

void release_solid_loads(std::span<const ClothLoad> loads, state::Tables& tables) {
  for (const ClothLoad& load : loads) {
    if (load.push == DVec3{} && load.turn == DVec3{}) continue;
    const WholeSolid solid = whole_solid(load.solid, tables);
    const DVec3 change = (1 / solid.mass) * load.push;
    const DVec3 turn = math::inverse(solid.inertia) * load.turn;
    if (!is_finite(change) || !is_finite(turn)) continue;
    const state::Rows rows = tables.objects[load.solid].particles;
    for (std::uint32_t row = rows.first; row < rows.end(); ++row) {
      const DVec3 r = vector_cast<double>(tables.particles.position[row].x) - solid.center;
      tables.particles.velocity[row].v += vector_cast<Real>(change + cross(turn, r));
    }
  }
}

/// Angular velocity of the load's solid by its scaled rotation [rad/s].
DVec3 ClothLoads::turned(const Load& load, DVec3 scaled_rotation) const {
  return solids_[load.solid].scale * scaled_rotation;
}

/// Velocity of the cloth where the solid presses, less that of a whole solid there [m/s], or its change.
DVec3 ClothLoads::motion_of(const Load& load, std::span<const DVec3> of) const {
  DVec3 sum;
  for (std::size_t k = 0; k < 3; ++k) sum += load.weight[k] * of[load.point[k]];
  if (load.solid == kNone) return sum;
  const std::size_t row = solids_[load.solid].row;
  return sum - of[row] - cross(turned(load, of[row + 1]), load.lever);
}

/// Adds an impulse on the cloth, and its reaction on a whole solid.
void ClothLoads::push(const Load& load, DVec3 impulse, std::span<DVec3> impulses) const {
  for (std::size_t k = 0; k < 3; ++k) impulses[load.point[k]] += load.weight[k] * impulse;
  if (load.solid == kNone) return;
  const Solid& solid = solids_[load.solid];
  impulses[solid.row] -= impulse;
  impulses[solid.row + 1] -= transpose(solid.scale) * cross(load.lever, impulse);
}

/// Impulse along the normal [N s].
double ClothLoads::push_of(const Load& load, DVec3 motion) {
  return load.mass * std::max(0.0, load.least_speed - dot(load.normal, motion));
}

/// Velocity of the cloth across the normal, relative to the solid [m/s].
DVec3 ClothLoads::sliding(const Load& load, DVec3 motion) {
  const DVec3 relative = motion - load.surface;
  return relative - dot(load.normal, relative) * load.normal;
}

/// Takes the solid of a load, unless it is taken already. Returns its index.
std::size_t ClothLoads::take_solid(const ClothLoad& of, std::span<const ClothLoad> loads,
                                   const state::Tables& tables, std::vector<DVec3>& velocities,
                                   std::vector<double>& masses) {
  const auto known = std::find_if(solids_.begin(), solids_.end(),
                                  [&](const Solid& solid) { return solid.object == of.solid; });
  if (known != solids_.end()) return static_cast<std::size_t>(known - solids_.begin());
  Solid solid = {.object = of.solid, .whole = whole_solid(of.solid, tables), .row = velocities.size()};
  solid.scale = inverse(transpose(math::cholesky(solid.whole.inertia)));
  std::uint32_t cloth = of.object;
  for (const ClothLoad& other : loads) {
    if (other.is_left || other.solid != of.solid || other.object == of.object || other.object == cloth)
      continue;
    cloth = other.object;
    ++solid.cloths;
  }
  velocities.push_back(solid.whole.velocity);
  velocities.push_back(transpose(solid.scale) * solid.whole.spin);
  masses.push_back(solid.whole.mass / solid.cloths);
  masses.push_back(1.0 / solid.cloths);
  solids_.push_back(solid);
  return solids_.size() - 1;
}

void ClothLoads::take(std::uint32_t object, std::span<const ClothLoad> loads, double h,
                      const state::Tables& tables, std::vector<DVec3>& velocities,
                      std::vector<double>& masses) {
  loads_.clear();
  solids_.clear();
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const ClothLoad& of = loads[i];
    if (of.object != object || of.is_left) continue;
    Load load = {.index = i, .weight = of.weight, .normal = of.normal, .friction = of.friction};
    double own = 0;  // Inverse mass of the cloth there.
    for (std::size_t k = 0; k < 3; ++k) {
      if (of.weight[k] == 0) continue;
      load.point[k] = of.particle[k] - tables.objects[object].particles.first;
      const double mass = masses[load.point[k]];
      if (mass > 0) own += of.weight[k] * of.weight[k] / mass;
    }
    if (!(own > 0)) continue;
    const double most = kMostLoadOnCloth / own;
    load.mass = of.inverse_mass * most > 1 ? 1 / of.inverse_mass : most;
    load.least_speed = -of.separation / h;
    if (of.is_whole) {
      load.solid = take_solid(of, loads, tables, velocities, masses);
      const WholeSolid& whole = solids_[load.solid].whole;
      load.lever = of.place - whole.center;
      load.mass = std::min(10 * whole.mass, most);
    } else {
      load.surface = of.surface;
      load.least_speed += dot(of.normal, of.surface);
    }
    loads_.push_back(load);
  }
}

double ClothLoads::mass() const {
  double sum = 0;
  for (const Load& load : loads_) sum += load.solid == kNone ? load.mass : 0;
  for (const Solid& solid : solids_) sum += solid.whole.mass / solid.cloths;
  return sum;
}

void ClothLoads::begin(std::span<const DVec3> velocities) {
  for (Load& load : loads_)
    load.drag = load.friction > 0 && push_of(load, motion_of(load, velocities)) > 0 ? load.mass : 0;
}

double ClothLoads::energy(std::span<const DVec3> velocities) const {
  double sum = 0;
  for (const Load& load : loads_) {
    const DVec3 v = motion_of(load, velocities);
    const double push = push_of(load, v);
    sum += push * push / load.mass + load.drag * length_squared(sliding(load, v));
  }
  return 0.5 * sum;
}

/// Adds how the load resists changes of each point and of its solid alone.
void ClothLoads::add_resistance(const Load& load, std::span<math::Symmetric3<double>> resistances) const {
  for (std::size_t k = 0; k < 3; ++k) {
    const double w = load.weight[k] * load.weight[k];
    if (w == 0) continue;
    resistances[load.point[k]] =
        resistances[load.point[k]] + math::axial(load.normal, w * load.along, w * load.drag);
  }
  if (load.solid == kNone) return;
  const auto own = math::axial(load.normal, load.along, load.drag);
  const Solid& solid = solids_[load.solid];
  resistances[solid.row] = resistances[solid.row] + own;
  const auto of_rotation = [&](DVec3 axis) {
    return transpose(solid.scale) * cross(load.lever, own * cross(solid.scale * axis, load.lever));
  };
  const DVec3 x = of_rotation({1, 0, 0});
  const DVec3 y = of_rotation({0, 1, 0});
  const DVec3 z = of_rotation({0, 0, 1});
  resistances[solid.row + 1] =
      resistances[solid.row + 1] + math::Symmetric3<double>{x.x, x.y, x.z, y.y, y.z, z.z};
}

void ClothLoads::add(std::span<const DVec3> velocities, std::span<DVec3> impulses,
                     std::span<math::Symmetric3<double>> resistances) {
  for (Load& load : loads_) {
    const DVec3 v = motion_of(load, velocities);
    const double along = push_of(load, v);
    load.along = along > 0 ? load.mass : 0;
    push(load, along * load.normal - load.drag * sliding(load, v), impulses);
    add_resistance(load, resistances);
  }
}

void ClothLoads::resist(std::span<const DVec3> changes, std::span<DVec3> impulses) const {
  for (const Load& load : loads_) {
    const DVec3 change = motion_of(load, changes);
    const double along = (load.along - load.drag) * dot(load.normal, change);
    push(load, load.drag * change + along * load.normal, impulses);
  }
}

bool ClothLoads::renew(std::span<const DVec3> velocities) {
  bool any = false;
  for (Load& load : loads_) {
    if (!(load.friction > 0)) continue;
    const DVec3 v = motion_of(load, velocities);
    const double most = load.friction * push_of(load, v);
    const double speed = length(sliding(load, v));
    const double drag = load.mass * speed > most ? most / speed : load.mass;
    if (std::abs(load.drag - drag) <= kFrictionErrorOnCloth * drag) continue;
    load.drag = drag;
    any = true;
  }
  return any;
}

void ClothLoads::note_impulses(std::span<const DVec3> velocities, std::span<const DVec3> before,
                               std::span<ClothLoad> loads) {
  for (const Load& load : loads_) {
    const DVec3 v = motion_of(load, velocities);
    ClothLoad& of = loads[load.index];
    of.is_solved = true;
    of.lever = load.lever;
    if (load.solid != kNone && !solids_[load.solid].is_noted) {
      Solid& solid = solids_[load.solid];
      solid.is_noted = true;
      of.push = (solid.whole.mass / solid.cloths) * (velocities[solid.row] - before[solid.row]);
      const DVec3 rotation = (1.0 / solid.cloths) * (velocities[solid.row + 1] - before[solid.row + 1]);
      of.turn = solid.whole.inertia * (solid.scale * rotation);
    }
    const double along = push_of(load, v);
    if (!(along > 0)) continue;
    const DVec3 friction = -load.drag * sliding(load, v);
    const double size = length(friction);
    const double most = load.friction * along;
    of.impulse = along * load.normal + (size > most ? most / size : 1.0) * friction;
  }
}

}  // namespace hooke::solver
