#include "collision/shape_gap.h"

#include <algorithm>
#include <cmath>

namespace hooke::collision {

namespace {

Gap gap_to_sphere(Real radius, Vec3 x) {
  const Real r = length(x);
  if (!(r > Real(0))) return {-radius, {Real(0), Real(1), Real(0)}};
  return {r - radius, (Real(1) / r) * x};
}

Gap gap_to_box(Vec3 half, Vec3 x) {
  const Vec3 size = {std::abs(x.x), std::abs(x.y), std::abs(x.z)};
  const auto sign = [](Real v) { return v < Real(0) ? Real(-1) : Real(1); };
  const Vec3 over = size - half;
  const Vec3 outside = {std::max(over.x, Real(0)), std::max(over.y, Real(0)), std::max(over.z, Real(0))};
  const Real apart = length(outside);
  if (apart > Real(0)) {
    const Vec3 n = (Real(1) / apart) * outside;
    return {apart, {sign(x.x) * n.x, sign(x.y) * n.y, sign(x.z) * n.z}};
  }
  if (over.x >= over.y && over.x >= over.z) return {over.x, {sign(x.x), Real(0), Real(0)}};
  if (over.y >= over.z) return {over.y, {Real(0), sign(x.y), Real(0)}};
  return {over.z, {Real(0), Real(0), sign(x.z)}};
}

}  // namespace

Gap gap_to_shape(const Shape& shape, Vec3 x) {
  switch (shape.kind) {
    case ShapeKind::kHalfSpace:
      return {x.y, {Real(0), Real(1), Real(0)}};
    case ShapeKind::kSphere:
      return gap_to_sphere(shape.radius, x);
    case ShapeKind::kBox:
      return gap_to_box(shape.half_extents, x);
    case ShapeKind::kMesh:
      break;
  }
  return {std::numeric_limits<Real>::infinity(), {Real(0), Real(1), Real(0)}};
}

Gap gap_to_triangle(const state::Mesh&, std::uint32_t, Vec3) {
  return {};
}
std::vector<std::uint32_t> triangles_near(const state::Mesh&, Vec3, Real) {
  return {};
}
Real distance_to_mesh(const state::Mesh&, Vec3, Real reach) {
  return reach;
}

}  // namespace hooke::collision
