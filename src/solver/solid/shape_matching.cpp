#include "solver/solid/shape_matching.h"

#include "base/assert.h"
#include "math/polar.h"
#include "math/symmetric.h"

#include <cmath>

namespace hooke::solver {

namespace {

using state::Deformable;
using state::Particles;

using DMat3 = Matrix3<double>;

double mass_at(const Particles& particles, std::uint32_t p) {
  return static_cast<double>(particles.mass[p]);
}

DVec3 position_at(const Particles& particles, std::uint32_t p, double ahead) {
  return vector_cast<double>(particles.position[p].x) + ahead * vector_cast<double>(particles.velocity[p].v);
}

/// Sums over all points about their center of mass.
struct Moments {
  DVec3 velocity = {};                    ///< Velocity of the center [m/s].
  DVec3 angular_momentum = {};            ///< [kg m^2/s]
  math::Symmetric3<double> inertia = {};  ///< [kg m^2]
};

DVec3 center_of(const Deformable& object, const Particles& particles, double ahead) {
  HOOKE_ASSERT(object.rest_shape->mass > 0 && object.rest_shape->place.size() == object.particles.count);
  DVec3 sum;
  for (std::uint32_t p = object.particles.first; p < object.particles.end(); ++p)
    sum += mass_at(particles, p) * position_at(particles, p, ahead);
  return (1 / object.rest_shape->mass) * sum;
}

DMat3 product_of(const Deformable& object, const Particles& particles, DVec3 center, double ahead) {
  DMat3 a = {{}, {}, {}};
  for (std::uint32_t i = 0; i < object.particles.count; ++i) {
    const std::uint32_t row = object.particles.first + i;
    const DVec3 q = object.rest_shape->place[i];
    const DVec3 p = mass_at(particles, row) * (position_at(particles, row, ahead) - center);
    a.x += q.x * p;
    a.y += q.y * p;
    a.z += q.z * p;
  }
  return a;
}

Moments moments_of(const Deformable& object, const Particles& particles, DVec3 center) {
  Moments sum;
  DVec3 momentum;
  math::Symmetric3<double>& inertia = sum.inertia;
  // Without this, points that lie in one line would have no inertia about it.
  inertia = math::Symmetric3<double>::diagonal(1e-12 * object.rest_shape->inertia);
  for (std::uint32_t row = object.particles.first; row < object.particles.end(); ++row) {
    const double m = mass_at(particles, row);
    const DVec3 p = position_at(particles, row, 0) - center;
    const DVec3 v = m * vector_cast<double>(particles.velocity[row].v);
    momentum += v;
    sum.angular_momentum += cross(p, v);
    inertia.xx += m * (p.y * p.y + p.z * p.z);
    inertia.yy += m * (p.x * p.x + p.z * p.z);
    inertia.zz += m * (p.x * p.x + p.y * p.y);
    inertia.xy -= m * p.x * p.y;
    inertia.xz -= m * p.x * p.z;
    inertia.yz -= m * p.y * p.z;
  }
  sum.velocity = (1 / object.rest_shape->mass) * momentum;
  return sum;
}

/// sum m p x (R q), from A.
DVec3 torque_of(const DMat3& a, const DMat3& turn) {
  const DMat3 b = a * transpose(turn);  // sum m p (R q)^T
  return {b.z.y - b.y.z, b.x.z - b.z.x, b.y.x - b.x.y};
}

/// Takes the velocity u from a point: all of it, or less where something hangs on the point.
void slow_down(Particles& particles, std::uint32_t row, DVec3 u) {
  state::VelocityRecord& record = particles.velocity[row];
  const double share = static_cast<double>(record.inverse_mass) * mass_at(particles, row);
  record.v = vector_cast<Real>(vector_cast<double>(record.v) - share * u);
}

}  // namespace

Match find_match(const Deformable& object, const Particles& particles, double ahead) {
  const DVec3 center = center_of(object, particles, ahead);
  return {center, math::closest_rotation(product_of(object, particles, center, ahead))};
}

void match_shape(const Deformable& object, double h, Particles& particles) {
  const DVec3 center = center_of(object, particles, 0);
  const DMat3 product = product_of(object, particles, center, 0);
  const DMat3 turn = matrix_of(math::closest_rotation(product));
  const Moments sum = moments_of(object, particles, center);
  const state::RestShape& rest = *object.rest_shape;
  const bool rigid = std::isinf(rest.stiffness);
  const double pull = rigid ? 1 / h : h * rest.stiffness / (1 + h * h * rest.stiffness);
  const DVec3 torque = h * pull * sum.angular_momentum - pull * torque_of(product, turn);
  const DVec3 spin = math::inverse(sum.inertia) * torque;
  for (std::uint32_t i = 0; i < object.particles.count; ++i) {
    const std::uint32_t row = object.particles.first + i;
    const DVec3 p = position_at(particles, row, 0) - center;
    const DVec3 e = p - turn * rest.place[i];
    const DVec3 v = vector_cast<double>(particles.velocity[row].v) - sum.velocity;
    slow_down(particles, row, pull * (e + h * v) - cross(spin, p));
  }
}

void damp_shape(const Deformable& object, double h, Particles& particles) {
  if (!(object.rest_shape->damping > 0)) return;
  const DVec3 center = center_of(object, particles, 0);
  const Moments sum = moments_of(object, particles, center);
  const double share = h * object.rest_shape->damping / (1 + h * object.rest_shape->damping);
  const DVec3 spin = math::inverse(sum.inertia) * sum.angular_momentum;
  for (std::uint32_t row = object.particles.first; row < object.particles.end(); ++row) {
    const DVec3 p = position_at(particles, row, 0) - center;
    const DVec3 v = vector_cast<double>(particles.velocity[row].v) - sum.velocity;
    slow_down(particles, row, share * (v - cross(spin, p)));
  }
}

double match_energy(const Deformable& object, const Particles& particles, double ahead) {
  if (std::isinf(object.rest_shape->stiffness)) return 0;
  const Match match = find_match(object, particles, ahead);
  double sum = 0;
  for (std::uint32_t i = 0; i < object.particles.count; ++i) {
    const std::uint32_t row = object.particles.first + i;
    const DVec3 goal = match.center + rotate(match.turn, object.rest_shape->place[i]);
    sum += mass_at(particles, row) * length_squared(position_at(particles, row, ahead) - goal);
  }
  return 0.5 * object.rest_shape->stiffness * sum;
}

}  // namespace hooke::solver
