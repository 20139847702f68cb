#include "geometry/convex/mass_properties.h"

#include "math/rotation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hooke::geometry {

namespace {

using Inertia = math::Symmetric3<double>;

/// Turns the integral of x x^T into the one of |x|^2 1 - x x^T.
Inertia inertia_from(const Inertia& second_moment) {
  const double trace = second_moment.xx + second_moment.yy + second_moment.zz;
  return {trace - second_moment.xx, -second_moment.xy, -second_moment.xz,
          trace - second_moment.yy, -second_moment.yz, trace - second_moment.zz};
}

/// s x x^T.
Inertia square_of(DVec3 x, double s) {
  return {s * x.x * x.x, s * x.x * x.y, s * x.x * x.z, s * x.y * x.y, s * x.y * x.z, s * x.z * x.z};
}

/// Inertia of a point of this mass at `offset`: what moving the axes away from the center adds (Steiner).
Inertia inertia_of_point(double mass, DVec3 offset) {
  return inertia_from(square_of(offset, mass));
}

/// R m R^T.
Inertia rotated(const Inertia& m, const Quaternion<double>& q) {
  const Quaternion<double> back = conjugate(q);
  const auto column = [&](DVec3 axis) { return rotate(q, m * rotate(back, axis)); };
  const DVec3 x = column({1, 0, 0});
  const DVec3 y = column({0, 1, 0});
  const DVec3 z = column({0, 0, 1});
  return {x.x, 0.5 * (x.y + y.x), 0.5 * (x.z + z.x), y.y, 0.5 * (y.z + z.y), z.z};
}

/// Properties of a solid that is symmetric about y.
MassProperties turned_solid(double volume, double along, double across) {
  return {.volume = volume, .inertia = {across, 0, 0, along, 0, across}};
}

MassProperties mass_of_box(DVec3 half) {
  const double volume = 8 * half.x * half.y * half.z;
  const DVec3 square = {half.x * half.x, half.y * half.y, half.z * half.z};
  const double third = volume / 3;
  return {.volume = volume,
          .inertia = {third * (square.y + square.z), 0, 0, third * (square.z + square.x), 0,
                      third * (square.x + square.y)}};
}

MassProperties mass_of_sphere(double r) {
  const double volume = 4.0 / 3.0 * std::numbers::pi * r * r * r;
  return turned_solid(volume, 0.4 * volume * r * r, 0.4 * volume * r * r);
}

MassProperties mass_of_cylinder(double r, double h) {
  const double volume = 2 * std::numbers::pi * r * r * h;
  return turned_solid(volume, 0.5 * volume * r * r, volume * (0.25 * r * r + h * h / 3));
}

/// The two half spheres have their centers 3/8 r beyond the ends of the cylinder, and 2/5 r^2 about these
/// ends.
MassProperties mass_of_capsule(double r, double h) {
  const MassProperties middle = mass_of_cylinder(r, h);
  const MassProperties ends = mass_of_sphere(r);
  return turned_solid(middle.volume + ends.volume, middle.inertia.yy + ends.inertia.yy,
                      middle.inertia.xx + ends.inertia.xx + ends.volume * h * (h + 0.75 * r));
}

/// The height of the cone is 2 h; the center is at a quarter of it.
MassProperties mass_of_cone(double r, double h) {
  const double volume = 2.0 / 3.0 * std::numbers::pi * r * r * h;
  MassProperties cone = turned_solid(volume, 0.3 * volume * r * r, 0.15 * volume * (r * r + h * h));
  cone.center = {0, -0.5 * h, 0};
  return cone;
}

/// Sums over tetrahedra with a common corner, with a sign: those that face away count negative. With
/// d = a.(b x c), s = a + b + c:
///
///     V = sum d / 6,   int x = sum d s / 24,   int x x^T = sum d (s s^T + a a^T + b b^T + c c^T) / 120
///
/// (Eberly 2002, Polyhedral mass properties, gives the same integrals over the surface.)
class Tetrahedra {
 public:
  /// The apex should be near the solid, otherwise digits cancel.
  explicit Tetrahedra(Vec3 apex) : apex_(vector_cast<double>(apex)) {}

  void add(const Vec3& corner_a, const Vec3& corner_b, const Vec3& corner_c) {
    const DVec3 a = vector_cast<double>(corner_a) - apex_;
    const DVec3 b = vector_cast<double>(corner_b) - apex_;
    const DVec3 c = vector_cast<double>(corner_c) - apex_;
    const DVec3 s = a + b + c;
    const double d = dot(a, cross(b, c));
    six_volumes_ += d;
    first_ += d * s;
    second_ = second_ + square_of(s, d) + square_of(a, d) + square_of(b, d) + square_of(c, d);
  }

  [[nodiscard]] MassProperties total() const {
    const double volume = six_volumes_ / 6;
    if (!(std::abs(volume) > 0)) return {};
    const DVec3 center = 1 / (4 * six_volumes_) * first_;
    const auto [xx, xy, xz, yy, yz, zz] = second_;
    const Inertia second = {xx / 120, xy / 120, xz / 120, yy / 120, yz / 120, zz / 120};
    return {.volume = volume,
            .center = apex_ + center,
            .inertia = inertia_from(second + square_of(center, -volume))};
  }

 private:
  DVec3 apex_;
  double six_volumes_ = 0;
  DVec3 first_ = {};
  Inertia second_ = {};
};

constexpr int kSweeps = 8;
constexpr double kNegligible = 1e-13;
constexpr double kFlat = 1e-9;   ///< A disk's moment about its axis is the sum of the two across.
constexpr double kThin = 1e-12;  ///< Moments below this part of the largest are rounding.

/// The rotation about one axis that takes the element `off` between the two others out of a matrix with `p`
/// and `q` on its diagonal there: cosine and sine of half its angle, at most 45 degrees.
struct HalfAngle {
  double cosine = 1, sine = 0;
};
HalfAngle jacobi_angle(double p, double q, double off) {
  const double ratio = (q - p) / (2 * off);
  const double tangent = (ratio < 0 ? -1 : 1) / (std::abs(ratio) + std::sqrt(ratio * ratio + 1));
  const double cosine = 1 / std::sqrt(tangent * tangent + 1);
  const double half = std::sqrt(0.5 * (1 + cosine));
  return {half, tangent * cosine / (2 * half)};
}

}  // namespace

MassProperties mass_of(const Shape& shape) {
  const auto r = static_cast<double>(shape.radius);
  const auto h = static_cast<double>(shape.half_height);
  switch (shape.kind) {
    case ShapeKind::kSphere:
      return mass_of_sphere(r);
    case ShapeKind::kBox:
      return mass_of_box(vector_cast<double>(shape.half_extents));
    case ShapeKind::kCapsule:
      return mass_of_capsule(r, h);
    case ShapeKind::kCylinder:
      return mass_of_cylinder(r, h);
    case ShapeKind::kCone:
      return mass_of_cone(r, h);
    case ShapeKind::kHalfSpace:
    case ShapeKind::kMesh:
    case ShapeKind::kHull:
    case ShapeKind::kCompound:
      break;
  }
  return {};
}

MassProperties mass_of(const ConvexHull& hull) {
  if (hull.vertices.empty()) return {};
  Tetrahedra sum(hull.vertices.front());
  for (const ConvexHull::Face& face : hull.faces) {
    const auto corner = [&](std::size_t k) { return hull.vertices[hull.loop[face.first + k]]; };
    for (std::size_t k = 1; k + 1 < face.count; ++k) sum.add(corner(0), corner(k), corner(k + 1));
  }
  return sum.total();
}

MassProperties mass_of(std::span<const Vec3> positions,
                       std::span<const std::array<std::uint32_t, 3>> triangles) {
  if (triangles.empty()) return {};
  Tetrahedra sum(positions[triangles[0][0]]);
  for (const auto& t : triangles) sum.add(positions[t[0]], positions[t[1]], positions[t[2]]);
  return sum.total();
}

bool is_physical(const MassProperties& solid) {
  const DVec3 m = principal_axes(solid.inertia).moments;
  const double sum = (1 + kFlat) * (m.x + m.y + m.z);
  const double most = std::max({m.x, m.y, m.z});
  return solid.volume > 0 && std::min({m.x, m.y, m.z}) > kThin * most && sum > 2 * most;
}

MassProperties moved(const MassProperties& solid, Quat rotation, DVec3 shift) {
  const Quaternion<double> q = math::in_double(rotation);
  return {.volume = solid.volume,
          .center = rotate(q, solid.center) + shift,
          .inertia = rotated(solid.inertia, q)};
}

MassProperties joined(const MassProperties& a, double density_a, const MassProperties& b, double density_b) {
  const double mass_a = density_a * a.volume;
  const double mass_b = density_b * b.volume;
  const double mass = mass_a + mass_b;
  if (!(std::abs(mass) > 0)) return {};
  const DVec3 apart = b.center - a.center;
  const auto scaled = [](const Inertia& i, double s) -> Inertia {
    return {s * i.xx, s * i.xy, s * i.xz, s * i.yy, s * i.yz, s * i.zz};
  };
  return {.volume = mass,
          .center = a.center + mass_b / mass * apart,
          .inertia = scaled(a.inertia, density_a) + scaled(b.inertia, density_b) +
                     inertia_of_point(mass_a * mass_b / mass, apart)};
}

DVec3 vertex_average(std::span<const Vec3> positions) {
  if (positions.empty()) return {};
  const auto first = vector_cast<double>(positions[0]);
  DVec3 sum = {};
  for (const Vec3& p : positions) sum += vector_cast<double>(p) - first;
  return first + 1 / static_cast<double>(positions.size()) * sum;
}

PrincipalAxes principal_axes(const Inertia& matrix) {
  const double negligible = kNegligible * (std::abs(matrix.xx) + std::abs(matrix.yy) + std::abs(matrix.zz));
  Quaternion<double> q = {};
  Inertia m = matrix;
  for (int i = 0; i < 3 * kSweeps; ++i) {
    const int axis = i % 3;
    const double off = axis == 0 ? m.yz : axis == 1 ? m.xz : m.xy;
    if (!(std::abs(off) > negligible)) continue;
    HalfAngle half;
    if (axis == 0) half = jacobi_angle(m.yy, m.zz, off);
    if (axis == 1) half = jacobi_angle(m.zz, m.xx, off);
    if (axis == 2) half = jacobi_angle(m.xx, m.yy, off);
    const double s = -half.sine;
    const Quaternion<double> rotation = {axis == 0 ? s : 0, axis == 1 ? s : 0, axis == 2 ? s : 0,
                                         half.cosine};
    q = normalize(q * rotation);
    m = rotated(matrix, conjugate(q));
  }
  if (q.w < 0) q = {-q.x, -q.y, -q.z, -q.w};
  return {.rotation = q, .moments = {m.xx, m.yy, m.zz}};
}

}  // namespace hooke::geometry
