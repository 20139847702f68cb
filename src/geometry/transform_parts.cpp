#include "hooke/geometry.h"

#include "base/float_environment.h"
#include "geometry/closest.h"

#include <cmath>

namespace hooke {

namespace {

/// Share of a column's length: a rest below it is rounding alone and has no direction.
constexpr double kNoDirection = 1e-14;

/// A unit vector at right angles to the unit vector `v`: the coordinate axis least along it, made orthogonal.
DVec3 across(DVec3 v) {
  const DVec3 size = {std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)};
  const DVec3 axis = size.x <= size.y && size.x <= size.z ? DVec3{1, 0, 0}
                     : size.y <= size.z                   ? DVec3{0, 1, 0}
                                                          : DVec3{0, 0, 1};
  return normalize(axis - dot(axis, v) * v);
}

/// A unit vector at right angles to both, or to the unit vector `a` alone where there is no other direction.
DVec3 across(DVec3 a, DVec3 b) {
  const DVec3 normal = cross(a, b);
  return length(normal) > kNoDirection ? normalize(normal) : across(a);
}

/// Orthogonal axes: x along the first column, y along the second as far as it is across the first.
Matrix3<double> axes_of(const Matrix3<double>& m) {
  const DVec3 x = geometry::direction_or(m.x, {});
  const DVec3 y = geometry::direction_or(m.y, {});
  const DVec3 z = geometry::direction_or(m.z, {});
  DVec3 rest = y - dot(x, y) * x;
  rest -= dot(x, rest) * x;  // twice is enough (Kahan)
  const bool has_y = length(rest) > kNoDirection;
  Matrix3<double> axes;
  if (!(x == DVec3{})) {
    axes.x = x;
    axes.y = has_y ? normalize(rest) : -across(x, z);
  } else if (has_y) {
    axes.y = normalize(rest);
    axes.x = across(axes.y, z);
  } else if (!(z == DVec3{})) {
    axes.x = across(z);
    axes.y = cross(z, axes.x);
  }
  axes.z = cross(axes.x, axes.y);
  return axes;
}

}  // namespace

Quaternion<double> quaternion_from(const Matrix3<double>& r) {
  const base::FloatEnvironment environment;
  const double trace = r.x.x + r.y.y + r.z.z;
  Quaternion<double> q = {r.y.z - r.z.y, r.z.x - r.x.z, r.x.y - r.y.x, 1 + trace};
  if (r.x.x >= trace && r.x.x >= r.y.y && r.x.x >= r.z.z) {
    q = {1 + 2 * r.x.x - trace, r.x.y + r.y.x, r.x.z + r.z.x, r.y.z - r.z.y};
  } else if (r.y.y >= trace && r.y.y >= r.z.z) {
    q = {r.x.y + r.y.x, 1 + 2 * r.y.y - trace, r.y.z + r.z.y, r.z.x - r.x.z};
  } else if (r.z.z >= trace) {
    q = {r.x.z + r.z.x, r.y.z + r.z.y, 1 + 2 * r.z.z - trace, r.x.y - r.y.x};
  }
  return normalize(q.w < 0 ? Quaternion<double>{-q.x, -q.y, -q.z, -q.w} : q);
}

TransformParts decompose(const Matrix4<double>& matrix) {
  const base::FloatEnvironment environment;
  const Matrix3<double> m = linear_part(matrix);
  const Matrix3<double> axes = axes_of(m);
  return {.translation = translation_part(matrix),
          .rotation = quaternion_from(axes),
          .scale = {dot(axes.x, m.x), dot(axes.y, m.y), dot(axes.z, m.z)},
          .shear_xy = dot(axes.x, m.y),
          .shear_xz = dot(axes.x, m.z),
          .shear_yz = dot(axes.y, m.z)};
}

Matrix4<double> compose(const TransformParts& parts) {
  const base::FloatEnvironment environment;
  const Matrix3<double> r = matrix_of(parts.rotation);
  const DVec3 s = parts.scale;
  return affine(Matrix3<double>{s.x * r.x, parts.shear_xy * r.x + s.y * r.y,
                                parts.shear_xz * r.x + parts.shear_yz * r.y + s.z * r.z},
                parts.translation);
}

}  // namespace hooke
