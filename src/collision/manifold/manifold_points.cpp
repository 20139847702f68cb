#include "collision/manifold/manifold_points.h"

#include "base/assert.h"
#include "collision/manifold/manifold_tuning.h"
#include "state/manifolds.h"

#include <algorithm>
#include <limits>

namespace hooke::collision {

namespace {

// stays

struct Candidates {
  const ContactResult& result;
  std::span<const std::uint32_t> old_keys;

  [[nodiscard]] const ContactResultPoint& at(int i) const {
    return result.point[static_cast<std::size_t>(i)];
  }
  [[nodiscard]] bool is_old(int i) const {
    return std::find(old_keys.begin(), old_keys.end(), at(i).key) != old_keys.end();
  }
  /// Twice the signed area of three points, seen along the normal.
  [[nodiscard]] Real area(int i, int j, int k) const {
    return dot(result.normal, cross(at(j).on_a - at(i).on_a, at(k).on_a - at(i).on_a));
  }
  /// The point with the largest score.
  template <class Score>
  [[nodiscard]] int best(const Score& score) const {
    int found = 0;
    Real largest = -std::numeric_limits<Real>::infinity();
    for (int i = 0; i < result.count; ++i) {
      const Real s = score(i);
      found = s > largest ? i : found;
      largest = s > largest ? s : largest;
    }
    return found;
  }
  [[nodiscard]] Real favor(int i) const { return is_old(i) ? kKeepArea : Real(1); }
  /// Of the points that are about as deep as the deepest, the one farthest from the middle: a point in the
  /// middle of a side would leave a corner out.
  [[nodiscard]] int outermost_of_deepest() const {
    const Real deepest = deepest_of(result);
    Vec3 middle = {};
    for (int i = 0; i < result.count; ++i) {
      middle += Real(1) / static_cast<Real>(result.count) * at(i).on_a;
    }
    return best([&](int i) {
      if (at(i).separation > deepest + kSameDepth) return -std::numeric_limits<Real>::infinity();
      return favor(i) * length_squared(at(i).on_a - middle);
    });
  }
};

/// Whether `p` lies behind `q`: the body would have to rotate by 45 degrees before `p` touches first.
bool is_behind(const ContactResultPoint& p, const ContactResultPoint& q, Vec3 normal) {
  const Real behind = p.separation - q.separation;
  if (!(behind > Real(0))) return false;
  const Vec3 apart = p.on_a - q.on_a;
  const Real along = dot(apart, normal);
  return length_squared(apart) - along * along < behind * behind;
}

/// Removes points behind others, such as the upper corners of a flat body: seen along the normal they are
/// where the lower ones are.
void remove_points_behind(ContactResult& result) {
  std::array<ContactResultPoint, ContactResult::kMaxPoints> all = result.point;
  const int count = result.count;
  const auto any_before = [&](const ContactResultPoint& p) {
    return std::any_of(all.begin(), all.begin() + count,
                       [&](const ContactResultPoint& q) { return is_behind(p, q, result.normal); });
  };
  result.count = 0;
  for (int i = 0; i < count; ++i) {
    const ContactResultPoint& p = all[static_cast<std::size_t>(i)];
    if (!any_before(p)) result.point[static_cast<std::size_t>(result.count++)] = p;
  }
}

}  // namespace

void reduce_points(ContactResult& result, Real margin, std::span<const std::uint32_t> old_keys) {
  const auto end = result.point.begin() + result.count;
  const auto remaining = std::remove_if(
      result.point.begin(), end, [margin](const ContactResultPoint& p) { return !(p.separation <= margin); });
  result.count = static_cast<int>(remaining - result.point.begin());
  if (result.count <= state::Manifold::kMaxPoints) return;
  remove_points_behind(result);
  if (result.count <= state::Manifold::kMaxPoints) return;
  const Candidates c = {result, old_keys};
  const int first = c.outermost_of_deepest();
  const int second =
      c.best([&](int i) { return c.favor(i) * length_squared(c.at(i).on_a - c.at(first).on_a); });
  const int third = c.best(
      [&](int i) { return c.favor(i) * std::max(c.area(first, second, i), -c.area(first, second, i)); });
  const Real sense = c.area(first, second, third) < Real(0) ? Real(-1) : Real(1);
  // The area that a point adds outside each side of the triangle.
  const int fourth = c.best([&](int i) {
    const Real gain = std::max({-sense * c.area(first, second, i), -sense * c.area(second, third, i),
                                -sense * c.area(third, first, i)});
    return c.favor(i) * gain;
  });
  std::array<int, 4> chosen = {first, second, third, fourth};
  std::sort(chosen.begin(), chosen.end());
  HOOKE_ASSERT(chosen.front() >= 0 && chosen.back() < result.count);
  result.count = 0;
  int last = -1;
  for (const int i : chosen) {
    if (i != last) result.point[static_cast<std::size_t>(result.count++)] = c.at(i);
    last = i;
  }
}

Real deepest_of(const ContactResult& result) {
  Real deepest = std::numeric_limits<Real>::infinity();
  for (int i = 0; i < result.count; ++i) {
    deepest = std::min(deepest, result.point[static_cast<std::size_t>(i)].separation);
  }
  return deepest;
}

void swap_sides(ContactResult& result) {
  result.normal = -result.normal;
  for (int i = 0; i < result.count; ++i) {
    ContactResultPoint& p = result.point[static_cast<std::size_t>(i)];
    std::swap(p.on_a, p.on_b);
  }
}

void collide(const Convex& a, const Convex& b, const ContactQuery& query, ContactResult& result) {
  HOOKE_ASSERT(a.shape.kind != ShapeKind::kHalfSpace && b.shape.kind != ShapeKind::kHalfSpace);
  const ShapeKind kind_a = a.shape.kind;
  const ShapeKind kind_b = b.shape.kind;
  if (is_round_pair(kind_a, kind_b)) return collide_round(a, b, query, result);
  if (kind_a == ShapeKind::kBox && kind_b == ShapeKind::kBox) return collide_boxes(a, b, query, result);
  const auto is_polyhedron = [](const Convex& c) {
    return c.hull != nullptr && (c.shape.kind == ShapeKind::kHull || c.shape.kind == ShapeKind::kBox);
  };
  if (is_polyhedron(a) && is_polyhedron(b)) return collide_hulls(a, b, query, result);
  return collide_convex(a, b, query, result);
}

}  // namespace hooke::collision
