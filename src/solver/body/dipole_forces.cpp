#include "solver/body/dipole_forces.h"

#include "elements/dipoles.h"
#include "elements/fields.h"
#include "math/rotation.h"
#include "state/body_frames.h"

#include <algorithm>

namespace hooke::solver {

namespace {

struct Pull {
  DVec3 force = {};   ///< Force [N].
  DVec3 torque = {};  ///< Torque [N m].
};

/// Share of a rate omega^2 [1/s^2] that a substep of length h follows.
double followed(double rate, double h) {
  const double turn = h * h * rate;
  return turn > 1 ? 1 / turn : 1;
}

/// Mean of 1 / I about the axes across the moment.
double inverse_inertia_across(const state::BodyMass& mass, DVec3 moment) {
  if (!(mass.inverse_mass > Real(0))) return 0;
  const DVec3 axis = normalize(rotate(math::in_double(conjugate(mass.principal)), moment));
  const DVec3 inverse = {1 / static_cast<double>(mass.inertia.x), 1 / static_cast<double>(mass.inertia.y),
                         1 / static_cast<double>(mass.inertia.z)};
  const double along =
      axis.x * axis.x * inverse.x + axis.y * axis.y * inverse.y + axis.z * axis.z * inverse.z;
  return 0.5 * (inverse.x + inverse.y + inverse.z - along);
}

Dipole dipole_of(const state::Bodies& bodies, std::uint32_t row) {
  const Pose pose = state::pose_now(bodies, row);
  const DVec3 moment = vector_cast<double>(bodies.traits[row].dipole_moment);
  return {.row = row,
          .center = pose.position,
          .moment = rotate(math::in_double(pose.rotation), moment),
          .size = length(moment),
          .inverse_mass = static_cast<double>(bodies.mass[row].inverse_mass),
          .inverse_inertia = inverse_inertia_across(bodies.mass[row], moment)};
}

/// What another dipole does to `own`.
Pull pull_of_pair(const Dipole& own, const Dipole& other, double h) {
  const DVec3 d = own.center - other.center;
  const double r = length(d);
  if (!(r >= elements::kDipoleGap)) return {};
  const double inverse = 1 / r;
  const DVec3 n = inverse * d;
  const double size = elements::kMagneticConstant * (own.size * other.size) * (inverse * inverse * inverse);
  const double turning = 2 * (own.inverse_inertia + other.inverse_inertia);
  const double moving = 24 * (own.inverse_mass + other.inverse_mass) * (inverse * inverse);
  const double share = followed(size * std::max(turning, moving), h);
  return {.force = share * elements::dipole_force(other.moment, own.moment, n, inverse),
          .torque = share * cross(own.moment, elements::dipole_field(other.moment, n, inverse))};
}

Pull pull_of_field(const Dipole& own, const FieldDesc& field, double h) {
  const DVec3 b = elements::flux_density(field, own.center);
  const double share = followed(own.size * length(b) * own.inverse_inertia, h);
  return {.force = elements::times_gradient(field, own.moment), .torque = share * cross(own.moment, b)};
}

}  // namespace

void list_bodies_with_dipoles(const state::Bodies& bodies, std::vector<std::uint32_t>& rows) {
  rows.clear();
  for (std::uint32_t row = 0; row < bodies.traits.size(); ++row) {
    const state::BodyTraits& traits = bodies.traits[row];
    if (traits.alive && traits.dipole_moment != Vec3{}) rows.push_back(row);
  }
}

void gather_dipoles(const std::vector<state::Field>& fields, std::span<const std::uint32_t> rows,
                    const state::Bodies& bodies, std::vector<Dipole>& dipoles) {
  dipoles.clear();
  for (const state::Field& field : fields) {
    if (field.desc.kind != FieldDesc::Kind::kDipole) continue;
    const DVec3 moment = vector_cast<double>(field.desc.vector);
    dipoles.push_back({.center = field.desc.center, .moment = moment, .size = length(moment)});
  }
  for (const std::uint32_t row : rows) dipoles.push_back(dipole_of(bodies, row));
}

void add_dipole_forces(parallel::Range range, std::span<const Dipole> dipoles,
                       const std::vector<state::Field>& fields, double h, state::Bodies& bodies) {
  for (int i = range.begin; i < range.end; ++i) {
    const Dipole& own = dipoles[i];
    if (!is_dynamic(bodies, own.row)) continue;
    Pull sum;
    const auto add = [&](const Pull& pull) {
      sum.force += pull.force;
      sum.torque += pull.torque;
    };
    for (const state::Field& field : fields) {
      if (field.desc.kind == FieldDesc::Kind::kMagnetic) add(pull_of_field(own, field.desc, h));
    }
    for (const Dipole& other : dipoles) {
      if (&other != &own) add(pull_of_pair(own, other, h));
    }
    bodies.force[own.row] += vector_cast<Real>(sum.force);
    bodies.torque[own.row] += vector_cast<Real>(sum.torque);
  }
}

double dipole_energy(const std::vector<state::Field>& fields, std::span<const Dipole> dipoles) {
  double energy = 0;
  for (std::size_t i = 0; i < dipoles.size(); ++i) {
    const Dipole& own = dipoles[i];
    if (own.row == Dipole::kFixed) continue;
    for (const state::Field& field : fields) {
      if (field.desc.kind == FieldDesc::Kind::kMagnetic)
        energy -= dot(own.moment, elements::flux_density(field.desc, own.center));
    }
    for (const Dipole& other : dipoles.first(i))
      energy -= dot(own.moment, elements::dipole_field(other.moment, own.center - other.center));
  }
  return energy;
}

}  // namespace hooke::solver
