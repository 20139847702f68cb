#pragma once

#include "hooke/math.h"

#include <limits>

namespace hooke::geometry {

/// A box along the axes. It is closed: boxes that touch overlap. The default is empty and overlaps nothing.
template <class T>
struct Box3 {
  static constexpr T kFar = std::numeric_limits<T>::infinity();

  Vector3<T> lower = {kFar, kFar, kFar};
  Vector3<T> upper = {-kFar, -kFar, -kFar};

  friend constexpr bool operator==(const Box3&, const Box3&) = default;
};

using Box = Box3<Real>;

template <class T>
constexpr Vector3<T> min_of(Vector3<T> a, Vector3<T> b) {
  return {a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z};
}
template <class T>
constexpr Vector3<T> max_of(Vector3<T> a, Vector3<T> b) {
  return {a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z};
}
/// The smallest box around both.
template <class T>
constexpr Box3<T> merge(const Box3<T>& a, const Box3<T>& b) {
  return {min_of(a.lower, b.lower), max_of(a.upper, b.upper)};
}
/// The smallest box around a box and a point.
template <class T>
constexpr Box3<T> merge(const Box3<T>& box, Vector3<T> point) {
  return {min_of(box.lower, point), max_of(box.upper, point)};
}
template <class T>
constexpr Box3<T> box_of(Vector3<T> a, Vector3<T> b, Vector3<T> c) {
  return {min_of(a, min_of(b, c)), max_of(a, max_of(b, c))};
}
template <class T>
constexpr bool overlap(const Box3<T>& a, const Box3<T>& b) {
  return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y &&
         b.lower.y <= a.upper.y && a.lower.z <= b.upper.z && b.lower.z <= a.upper.z;
}
template <class T>
constexpr bool contains(const Box3<T>& outer, const Box3<T>& inner) {
  return merge(outer, inner) == outer;
}
/// Half of the surface area; 0 for the empty box.
template <class T>
constexpr T half_surface(const Box3<T>& box) {
  const Vector3<T> size = box.upper - box.lower;
  return size.x < T(0) ? T(0) : size.x * size.y + size.y * size.z + size.z * size.x;
}
/// Squared distance from `p`, 0 inside.
template <class T>
constexpr T distance_squared(const Box3<T>& box, Vector3<T> p) {
  const Vector3<T> out = max_of(Vector3<T>{}, max_of(box.lower - p, p - box.upper));
  return dot(out, out);
}

}  // namespace hooke::geometry
