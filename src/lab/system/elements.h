#pragma once

#include "hooke/desc.h"

#include "elements/air.h"
#include "elements/dihedral.h"
#include "elements/fields.h"
#include "elements/isometric_bend.h"
#include "elements/spring.h"
#include "lab/system/turn.h"

#include <array>
#include <cstdint>
#include <numbers>
#include <vector>

/// \file
/// Represents the forces of one object as rows, which know the points that they act on. Each row has one
/// function,
///
/// template <class T> Forces<T, n> force(const Points<T, n>& p) const
///
/// for doubles, for directional derivatives and for series in time (series.h).

namespace hooke::lab {

/// These are the n points of a row.
template <class T, int n>
struct Points {
  std::array<Vector3<T>, n> x, v;
  std::array<DVec3, n> wind;  ///< Wind at each point [m/s].
};

template <class T, int n>
using Forces = std::array<Vector3<T>, n>;

struct SpringRow {
  static constexpr int kPoints = 2;
  std::array<std::uint32_t, 2> at = {};
  elements::Spring spring = {};

  template <class T>
  Forces<T, 2> force(const Points<T, 2>& p) const {
    const Vector3<T> f = elements::spring_force(spring, p.x[0] - p.x[1], p.v[0] - p.v[1]);
    return {f, -f};
  }
};

/// E = k (theta - theta_0)^2 / 2, F_i = -(k (theta - theta_0) + c theta') G_i.
struct BendRow {
  static constexpr int kPoints = 4;
  std::array<std::uint32_t, 4> at = {};  ///< The ends of the edge, then the two opposite vertices.
  double stiffness = 0;                  ///< [N m]
  double damping = 0;                    ///< [N m s]
  double rest_angle = 0;                 ///< [rad]

  template <class T>
  Forces<T, 4> force(const Points<T, 4>& p) const {
    const auto bend = elements::dihedral(p.x[0], p.x[1], p.x[2], p.x[3]);
    if (!bend.valid) return {};
    T moment = stiffness * opening(bend.angle);
    for (int i = 0; i < 4; ++i) moment = moment + damping * dot(bend.gradient[i], p.v[i]);
    Forces<T, 4> f;
    for (int i = 0; i < 4; ++i) f[i] = -moment * bend.gradient[i];
    return f;
  }

  /// Returns theta - theta_0 in (-pi, pi].
  template <class T>
  [[nodiscard]] T opening(T angle) const {
    constexpr double kPi = std::numbers::pi;
    const T c = angle - rest_angle;
    return c > T(kPi) ? c - 2 * kPi : (c < T(-kPi) ? c + 2 * kPi : c);
  }
};

/// E = k |q|^2 / 2, F_i = -k K_i (1 + tau |q|' / |q|) q, see elements::isometric_bend.
struct CurvatureRow {
  static constexpr int kPoints = 4;
  std::array<std::uint32_t, 4> at = {};  ///< The ends of the edge, then the two opposite vertices.
  double stiffness = 0;                  ///< k [N/m]
  double damping = 0;                    ///< tau [s]
  std::array<double, 4> weights = {};

  template <class T>
  Forces<T, 4> force(const Points<T, 4>& p) const {
    const Vector3<T> q = elements::curvature(weights, p.x);
    T pull = T(stiffness);
    const T q2 = dot(q, q);
    if (damping > 0 && q2 > T(0))
      pull = pull + stiffness * damping * dot(q, elements::curvature(weights, p.v)) / q2;
    Forces<T, 4> f;
    for (int i = 0; i < 4; ++i) f[i] = (-weights[i] * pull) * q;
    return f;
  }
};

/// A triangle feels the wind; a third of the force acts on each corner.
struct SailRow {
  static constexpr int kPoints = 3;
  std::array<std::uint32_t, 3> at = {};
  double density = 0;  ///< Density of the air [kg/m^3].
  double drag = 0, lift = 0;

  template <class T>
  Forces<T, 3> force(const Points<T, 3>& p) const {
    const DVec3 wind = (1.0 / 3) * (p.wind[0] + p.wind[1] + p.wind[2]);
    const Vector3<T> flow = vector_cast<T>(wind) - (1.0 / 3) * (p.v[0] + p.v[1] + p.v[2]);
    const Vector3<T> normal = cross(p.x[1] - p.x[0], p.x[2] - p.x[0]);
    const Vector3<T> f = (1.0 / 3) * elements::triangle_air_force(flow, normal, density, drag, lift);
    return {f, f, f};
  }
};

/// A segment of a rope feels the wind; half of the force acts on each end.
struct StrandRow {
  static constexpr int kPoints = 2;
  std::array<std::uint32_t, 2> at = {};
  double half_rho_area = 0;  ///< rho C_d D L / 2 [kg/m]

  template <class T>
  Forces<T, 2> force(const Points<T, 2>& p) const {
    const Vector3<T> flow = vector_cast<T>(0.5 * (p.wind[0] + p.wind[1])) - 0.5 * (p.v[0] + p.v[1]);
    const Vector3<T> f = 0.5 * elements::strand_air_force(flow, p.x[1] - p.x[0], half_rho_area);
    return {f, f};
  }
};

/// Gravity, fields and drag act on one point.
struct PointRow {
  static constexpr int kPoints = 1;
  std::array<std::uint32_t, 1> at = {};
  double mass = 0;           ///< [kg]
  double charge = 0;         ///< [C]
  double viscous = 0;        ///< [N s/m]
  double half_rho_area = 0;  ///< rho C_d A / 2 [kg/m]
  DVec3 uniform = {};        ///< Gravity and the uniform fields together [m/s^2].
  DVec3 magnetic = {};       ///< All magnetic fields together [T].
  DVec3 load = {};           ///< Force of the contacts of a body [N].
  const std::vector<FieldDesc>* attractors = nullptr;

  template <class T>
  Forces<T, 1> force(const Points<T, 1>& p) const {
    Vector3<T> f = vector_cast<T>(mass * uniform + load);
    f += elements::magnetic_force(p.v[0], magnetic, charge);
    f += elements::point_air_force(vector_cast<T>(p.wind[0]) - p.v[0], viscous, half_rho_area);
    for (const FieldDesc& field : *attractors) {
      f += mass * elements::attraction(p.x[0] - vector_cast<T>(field.center), field.strength);
    }
    return {f};
  }
};

/// These are Euler's equations for the rotation p of a body (turn.h). With the inertia I about the principal
/// axes,
///
/// I omega' = torque - omega x I omega   (in those axes),   omega' -= damping omega
///
/// The row acts on a point of mass 1 whose position is p, so that its force is p''.
struct RotationRow {
  static constexpr int kPoints = 1;
  std::array<std::uint32_t, 1> at = {};
  std::array<DVec3, 3> axes = {};  ///< Principal axes in the world, where p = 0.
  DVec3 inertia = {};              ///< Moments about them [kg m^2].
  DVec3 torque = {};               ///< Torque of the contacts, in world axes [N m].
  double damping = 0;              ///< [1/s]

  template <class T>
  Forces<T, 1> force(const Points<T, 1>& points) const {
    const Vector3<T> p = points.x[0];
    const Vector3<T> omega = spin_of(p, points.v[0]);
    const Vector3<T> own = in_axes(turned(-p, omega));
    const Vector3<T> moment =
        in_axes(turned(-p, vector_cast<T>(torque))) - cross(own, weighted(own, inertia));
    const DVec3 inverse = {1 / inertia.x, 1 / inertia.y, 1 / inertia.z};
    const Vector3<T> spin_up = turned(p, out_of_axes(weighted(moment, inverse))) - damping * omega;
    // omega' s + omega s' = p'' + p x p'' / 2 is solved for p''.
    const Vector3<T> b = rotation_scale(p) * spin_up + (0.5 * dot(p, points.v[0])) * omega;
    return {(1 / rotation_scale(p)) * rotation_rate(p, b)};
  }

  template <class T>
  [[nodiscard]] Vector3<T> in_axes(Vector3<T> v) const {
    return {dot(vector_cast<T>(axes[0]), v), dot(vector_cast<T>(axes[1]), v),
            dot(vector_cast<T>(axes[2]), v)};
  }
  template <class T>
  [[nodiscard]] Vector3<T> out_of_axes(Vector3<T> v) const {
    return v.x * vector_cast<T>(axes[0]) + v.y * vector_cast<T>(axes[1]) + v.z * vector_cast<T>(axes[2]);
  }
  template <class T>
  static Vector3<T> weighted(Vector3<T> v, DVec3 weights) {
    return {weights.x * v.x, weights.y * v.y, weights.z * v.z};
  }
};

}  // namespace hooke::lab
