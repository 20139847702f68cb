#include "collision/deformable/particle_contacts.h"
#include "elements/dihedral.h"
#include "elements/isometric_bend.h"
#include "elements/tetrahedron.h"
#include "solver/rope/rope_repulsion.h"
#include "solver/rope/rope_rows.h"
#include "solver/rope/rope_tuning.h"
#include "solver/rope/rope_twist.h"
#include "solver/solid/shape_matching.h"
#include "solver/surface/surface_contacts.h"
#include "state/sleeping_pairs.h"
#include "world/claim.h"
#include "world/hook_stages.h"
#include "world/object_edits.h"
#include "world/world_data.h"

#include <algorithm>
#include <cmath>

namespace hooke {

namespace {

using state::Tables;

/// Position of the particle half a substep ago, from its object's origin [m]. A substep moves it by h v with
/// the new v, which is thus the velocity at the middle. An energy needs both at one time.
DVec3 middle_of(const Tables& t, std::uint32_t p) {
  return vector_cast<double>(t.particles.position[p].x) -
         0.5 * t.substep * vector_cast<double>(t.particles.velocity[p].v);
}

double distance(const Tables& t, std::uint32_t a, std::uint32_t b) {
  return length(vector_cast<double>(t.particles.position[a].x) -
                vector_cast<double>(t.particles.position[b].x));
}

double potential_of(const Tables& t, DVec3 x, double mass, double gravity_scale = 1) {
  double sum = -gravity_scale * mass * dot(vector_cast<double>(t.desc.gravity), x);
  for (const state::Field& field : t.fields) {
    if (field.desc.kind == FieldDesc::Kind::kUniform)
      sum -= mass * dot(vector_cast<double>(field.desc.vector), x);
    const double r = length(x - field.desc.center);
    if (field.desc.kind == FieldDesc::Kind::kInverseSquare && r > 0) sum -= mass * field.desc.strength / r;
  }
  return sum;
}

/// Adds energies and momenta of particles. A pinned particle counts in none of them.
void measure_particles(const Tables& t, Measurement& m) {
  for (const state::Deformable& object : t.objects) {
    for (std::uint32_t p = object.particles.first; p < object.particles.end(); ++p) {
      if (!(t.particles.velocity[p].inverse_mass > Real(0))) continue;
      const auto mass = static_cast<double>(t.particles.mass[p]);
      const DVec3 x = object.origin + middle_of(t, p);
      const DVec3 v = vector_cast<double>(t.particles.velocity[p].v);
      m.energy.kinetic += 0.5 * mass * length_squared(v);
      m.energy.potential += potential_of(t, x, mass);
      m.momentum += mass * v;
      m.angular_momentum += mass * cross(x, v);
    }
  }
}

double potential_of_dipoles(const Tables& t) {
  std::vector<std::uint32_t> rows;
  std::vector<solver::Dipole> dipoles;
  solver::list_bodies_with_dipoles(t.bodies, rows);
  solver::gather_dipoles(t.fields, rows, t.bodies, dipoles);
  return solver::dipole_energy(t.fields, dipoles);
}

/// Adds the energy of a dynamic body; the kinetic energy is p^2 / 2 m + L I^-1 L / 2.
void add_energy(const Tables& t, std::uint32_t body, Energy& energy) {
  const state::BodyMass& mass = t.bodies.mass[body];
  const auto kilograms = static_cast<double>(mass.mass);
  const DVec3 v = vector_cast<double>(t.bodies.motion[body].v);
  const Quat axes = t.bodies.rotation[body] * mass.principal;
  const DVec3 l = vector_cast<double>(rotate(conjugate(axes), t.bodies.angular_momentum[body]));
  const DVec3 inertia = vector_cast<double>(mass.inertia);
  energy.kinetic += 0.5 * kilograms * length_squared(v);
  energy.kinetic += 0.5 * (l.x * l.x / inertia.x + l.y * l.y / inertia.y + l.z * l.z / inertia.z);
  const DVec3 middle = t.bodies.center[body] - 0.5 * t.body_substep * v;  // as middle_of a particle
  energy.potential +=
      potential_of(t, middle, kilograms, static_cast<double>(t.bodies.traits[body].gravity_scale));
}

/// Adds energies and momenta of bodies.
void measure_bodies(const Tables& t, Measurement& m) {
  for (const std::uint32_t body : t.moving_bodies) {
    const state::BodyMass& mass = t.bodies.mass[body];
    if (!(mass.mass > Real(0))) continue;
    add_energy(t, body, m.energy);
    const auto kilograms = static_cast<double>(mass.mass);
    const DVec3 v = vector_cast<double>(t.bodies.motion[body].v);
    m.momentum += kilograms * v;
    m.angular_momentum +=
        kilograms * cross(t.bodies.center[body], v) + vector_cast<double>(t.bodies.angular_momentum[body]);
  }
}

double deepest_of_bodies(const Tables& t) {
  double deepest = 0;
  state::for_each_manifold(t.pairs, [&](const state::Manifold& manifold) {
    deepest = std::max(deepest, static_cast<double>(state::deepest_overlap(manifold)));
  });
  return deepest;
}

struct Stretch {
  double largest = 0, sum = 0;
  std::size_t count = 0;
  std::uint32_t where = 0;  ///< Particle at one end of what stretches most.

  void add(double length, double rest, std::uint32_t particle) {
    if (!(rest > 0)) return;
    const double relative = std::abs(length / rest - 1.0);
    if (relative > largest) {
      largest = relative;
      where = particle;
    }
    sum += relative;
    ++count;
  }
};

/// The particle as a point of its object; empty for none that stretches.
PointRef place_of(const Tables& t, const Stretch& stretch) {
  if (!(stretch.largest > 0)) return {};
  for (const state::Deformable& object : t.objects) {
    const state::Rows& rows = object.particles;
    if (stretch.where >= rows.first && stretch.where < rows.end())
      return world::point_of(t, object, stretch.where - rows.first);
  }
  return {};
}

double elastic(double stiffness, double extension) {
  return std::isinf(stiffness) ? 0.0 : 0.5 * stiffness * extension * extension;
}

double measure_springs(const Tables& t, Stretch& stretch) {
  double energy = 0;
  for (int i = 0; i < t.springs.count(); ++i) {
    const state::SpringClass kind = t.springs.kind[i];
    if (kind == state::SpringClass::kTether || kind == state::SpringClass::kLimit) continue;
    const double l = distance(t, t.springs.particle_a[i], t.springs.particle_b[i]);
    const auto rest = static_cast<double>(t.springs.rest_length[i]);
    if (kind == state::SpringClass::kStretch) stretch.add(l, rest, t.springs.particle_a[i]);
    const double middle =
        length(middle_of(t, t.springs.particle_a[i]) - middle_of(t, t.springs.particle_b[i]));
    energy += elastic(static_cast<double>(t.springs.stiffness[i]), middle - rest);
  }
  return energy;
}

/// Largest extension of a rigid segment by its tension [m]: under heavy loads it gives way a little, and
/// gives it back (solver/rope/rope_tuning.h). 0 if both ends are held.
double compliant_extension(const Tables& t, double tension, std::uint32_t particle) {
  const auto mass = [&](std::uint32_t p) { return static_cast<double>(t.particles.mass[p]); };
  const auto inverse = [&](std::uint32_t p) {
    return static_cast<double>(t.particles.velocity[p].inverse_mass);
  };
  if (!(inverse(particle) > 0 || inverse(particle + 1) > 0)) return 0;
  const double lighter =
      solver::lighter_end(mass(particle), inverse(particle), mass(particle + 1), inverse(particle + 1));
  return tension * solver::kComplianceInContact * t.substep * t.substep / lighter;
}

/// Energy of the segment of a rope between a particle and the next. It follows from the tension, because the
/// length of a very stiff segment is less exact.
double stretch_energy(const Tables& t, std::size_t segment, std::uint32_t particle) {
  const auto stiffness = static_cast<double>(t.segments.stiffness[segment]);
  const auto tension = static_cast<double>(t.segments.tension[segment]);
  if (!std::isinf(stiffness)) return 0.5 * tension * tension / stiffness;
  const auto rest = static_cast<double>(t.segments.rest_length[segment]);
  const double extension = distance(t, particle, particle + 1) - rest;
  const double explained = std::min(extension, compliant_extension(t, tension, particle));
  if (!(tension > 0 && explained > 0)) return 0;
  const double in_the_middle = length(middle_of(t, particle) - middle_of(t, particle + 1)) - rest;
  const double share = std::clamp(in_the_middle / extension, 0.0, 2.0);
  return 0.5 * tension * explained * share * share;
}

double measure_segments(const Tables& t, Stretch& stretch) {
  double energy = 0;
  for (const state::Deformable& object : t.objects) {
    for (std::uint32_t i = 0; i < object.segments.count; ++i) {
      const std::size_t s = object.segments.first + i;
      if (!t.segments.joins(s)) continue;
      const double l = distance(t, object.particles.first + i, object.particles.first + i + 1);
      const auto rest = static_cast<double>(t.segments.rest_length[s]);
      stretch.add(l, rest, object.particles.first + i);
      energy += stretch_energy(t, s, object.particles.first + i);
    }
  }
  return energy;
}

/// Energy of the bending of ropes [J].
double measure_rope_bends(const Tables& t) {
  double energy = 0;
  for (const state::Deformable& rope : t.objects) {
    if (!(rope.bend_stiffness > Real(0)) || rope.kind != PointRef::Kind::kRope) continue;
    const solver::RopeSystem rope_system = {.bend_stiffness = static_cast<double>(rope.bend_stiffness)};
    for (std::uint32_t i = 1; i + 1 < rope.particles.count; ++i) {
      const std::uint32_t p = rope.particles.first + i;
      const solver::RopeBend bend = solver::load_bend(rope_system, rope.segments.first + i - 1, t.segments);
      const DVec3 change = bend.behind * (middle_of(t, p + 1) - middle_of(t, p)) -
                           bend.before * (middle_of(t, p) - middle_of(t, p - 1));
      energy += 0.5 * bend.stiffness * length_squared(change);
    }
  }
  return energy;
}

/// Energy of the twist of ropes [J]. The twist at the middle of the last substep is the mean of those before
/// and after it.
double measure_twists(const Tables& t) {
  double energy = 0;
  for (const state::TwistSpan& span : t.twists) {
    const double angle = 0.5 * (span.angle + solver::twist_now(t, span));
    energy += 0.5 * solver::twist_stiffness(t, span) * angle * angle;
  }
  return energy;
}

double measure_bends(const Tables& t) {
  double energy = 0;
  for (int i = 0; i < t.bends.count(); ++i) {
    const state::Bends::Stencil& s = t.bends.stencil[i];
    const std::array<DVec3, 4> x = {middle_of(t, s.edge_a), middle_of(t, s.edge_b), middle_of(t, s.wing_a),
                                    middle_of(t, s.wing_b)};
    if (t.bends.is_isometric(i)) {
      const DVec3 q = elements::curvature(t.bends.weights_of(i), x);
      energy += elastic(
          static_cast<double>(stiffness_beside_clamp(t.bends, static_cast<std::size_t>(i), t.particles)),
          length(q));
      continue;
    }
    const auto d = elements::dihedral(x[0], x[1], x[2], x[3]);
    const double angle =
        d.valid ? elements::wrapped(d.angle - static_cast<double>(t.bends.rest_angle[i])) : 0.0;
    energy += elastic(static_cast<double>(t.bends.stiffness[i]), angle);
  }
  return energy;
}

double measure_tetrahedra(const Tables& t) {
  double energy = 0;
  for (int i = 0; i < t.tetrahedra.count(); ++i) {
    const auto [a, b, c, d] = t.tetrahedra.corners[i];
    std::array<DVec3, 4> gradients = {};
    for (std::size_t k = 0; k < 3; ++k) {
      gradients[k + 1] = vector_cast<double>(t.tetrahedra.shape_gradient[i][k]);
      gradients[0] -= gradients[k + 1];
    }
    const Matrix3<double> f = elements::gradient_of(
        {middle_of(t, a), middle_of(t, b), middle_of(t, c), middle_of(t, d)}, gradients);
    const elements::NeoHookean<double> material = {static_cast<double>(t.tetrahedra.shear_modulus[i]),
                                                   static_cast<double>(t.tetrahedra.volume_modulus[i])};
    energy += static_cast<double>(t.tetrahedra.volume[i]) * elements::energy_density(f, material);
  }
  return energy;
}

/// Work that brings the gas to its volume against the air around it [J]; it is zero where both pressures are
/// equal.
double measure_gas(const Tables& t) {
  double energy = 0;
  solver::GasVolume gas;
  for (const state::Deformable& object : t.objects) {
    if (!(object.gas > 0)) continue;
    solver::measure_gas(object, t.triangles, t.particles, gas);
    const double calm = object.gas / state::kAirPressure;  // Its volume at the pressure of the air [m^3].
    const double volume = std::max(gas.volume, 1e-3 * object.gas_volume);
    energy += state::kAirPressure * (volume - calm) - object.gas * std::log(volume / calm);
  }
  return energy;
}

double measure_matches(const Tables& t) {
  double energy = 0;
  for (const state::Deformable& object : t.objects) {
    if (object.rest_shape) energy += solver::match_energy(object, t.particles, -0.5 * t.substep);
  }
  return energy;
}

}  // namespace

Energy World::energy(BodyId id) const {
  const world::Reading reading(data_);
  const Tables& t = reading.tables();
  const std::uint32_t row = t.body_slots.find(id);
  Energy energy;
  if (row != state::SlotTable<BodyId>::kNone && t.bodies.mass[row].mass > Real(0)) add_energy(t, row, energy);
  return energy;
}

Measurement World::measure() const {
  const world::Reading reading(data_);
  const Tables& t = reading.tables();
  Measurement m;
  Stretch stretch;
  measure_particles(t, m);
  measure_bodies(t, m);
  m.energy.potential += potential_of_dipoles(t) + solver::repulsion_energy(t);
  m.energy.elastic = measure_springs(t, stretch) + measure_segments(t, stretch) + measure_bends(t) +
                     measure_rope_bends(t) + measure_twists(t) + measure_tetrahedra(t) + measure_gas(t) +
                     measure_matches(t);
  m.largest_stretch = stretch.largest;
  m.most_stretched = place_of(t, stretch);
  m.mean_stretch = stretch.count > 0 ? stretch.sum / static_cast<double>(stretch.count) : 0.0;
  for (const state::Hook& hook : t.hooks) m.largest_gap = std::max(m.largest_gap, world::gap_of(hook, t));
  m.largest_surface_overlap = static_cast<double>(solver::largest_overlap(t, reading->frame.surfaces));
  m.largest_penetration = std::max(collision::largest_penetration(t), deepest_of_bodies(t));
  return m;
}

}  // namespace hooke
