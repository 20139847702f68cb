#include "collision/manifold/manifold_points.h"

#include "state/manifolds.h"

#include <algorithm>
#include <limits>

namespace hooke::collision {

namespace {

constexpr Real kSameDepth = Real(5e-4);  // [m]
constexpr Real kKeepArea = Real(1.1);  // of points that span nearly the same, the one of the last step stays

struct Candidates {
  const Meeting& meeting;
  std::span<const std::uint32_t> old_keys;

  [[nodiscard]] const MeetingPoint& at(int i) const { return meeting.point[static_cast<std::size_t>(i)]; }
  [[nodiscard]] bool is_old(int i) const {
    return std::find(old_keys.begin(), old_keys.end(), at(i).key) != old_keys.end();
  }
  /// Twice the signed area of three points, seen along the normal.
  [[nodiscard]] Real area(int i, int j, int k) const {
    return dot(meeting.normal, cross(at(j).on_a - at(i).on_a, at(k).on_a - at(i).on_a));
  }
  /// The point with the largest score.
  template <class Score>
  [[nodiscard]] int best(const Score& score) const {
    int found = 0;
    Real largest = -std::numeric_limits<Real>::infinity();
    for (int i = 0; i < meeting.count; ++i) {
      const Real s = score(i);
      found = s > largest ? i : found;
      largest = s > largest ? s : largest;
    }
    return found;
  }
  [[nodiscard]] Real favor(int i) const { return is_old(i) ? kKeepArea : Real(1); }
  /// Of the points that are about as deep as the deepest the one farthest from the middle: a point in the
  /// middle of a side would leave a corner out.
  [[nodiscard]] int outermost_of_deepest() const {
    const Real deepest = deepest_of(meeting);
    Vec3 middle = {};
    for (int i = 0; i < meeting.count; ++i) {
      middle += Real(1) / static_cast<Real>(meeting.count) * at(i).on_a;
    }
    return best([&](int i) {
      if (at(i).separation > deepest + kSameDepth) return -std::numeric_limits<Real>::infinity();
      return favor(i) * length_squared(at(i).on_a - middle);
    });
  }
};

/// Whether `p` lies behind `q`: the body would have to turn by 45 degrees before `p` touches first.
bool is_behind(const MeetingPoint& p, const MeetingPoint& q, Vec3 normal) {
  const Real behind = p.separation - q.separation;
  if (!(behind > Real(0))) return false;
  const Vec3 apart = p.on_a - q.on_a;
  const Real along = dot(apart, normal);
  return length_squared(apart) - along * along < behind * behind;
}

/// The upper corners of a flat body, say: seen along the normal they are where the lower ones are.
void remove_points_behind(Meeting& meeting) {
  std::array<MeetingPoint, Meeting::kMaxPoints> all = meeting.point;
  const int count = meeting.count;
  const auto any_before = [&](const MeetingPoint& p) {
    return std::any_of(all.begin(), all.begin() + count,
                       [&](const MeetingPoint& q) { return is_behind(p, q, meeting.normal); });
  };
  meeting.count = 0;
  for (int i = 0; i < count; ++i) {
    const MeetingPoint& p = all[static_cast<std::size_t>(i)];
    if (!any_before(p)) meeting.point[static_cast<std::size_t>(meeting.count++)] = p;
  }
}

}  // namespace

void reduce_points(Meeting& meeting, Real margin, std::span<const std::uint32_t> old_keys) {
  const auto end = meeting.point.begin() + meeting.count;
  const auto kept = std::remove_if(meeting.point.begin(), end,
                                   [margin](const MeetingPoint& p) { return !(p.separation <= margin); });
  meeting.count = static_cast<int>(kept - meeting.point.begin());
  if (meeting.count <= state::Manifold::kMaxPoints) return;
  remove_points_behind(meeting);
  if (meeting.count <= state::Manifold::kMaxPoints) return;
  const Candidates c = {meeting, old_keys};
  const int first = c.outermost_of_deepest();
  const int second =
      c.best([&](int i) { return c.favor(i) * length_squared(c.at(i).on_a - c.at(first).on_a); });
  const int third = c.best(
      [&](int i) { return c.favor(i) * std::max(c.area(first, second, i), -c.area(first, second, i)); });
  const Real sense = c.area(first, second, third) < Real(0) ? Real(-1) : Real(1);
  // What a point adds outside each side of the triangle.
  const int fourth = c.best([&](int i) {
    const Real gain = std::max({-sense * c.area(first, second, i), -sense * c.area(second, third, i),
                                -sense * c.area(third, first, i)});
    return c.favor(i) * gain;
  });
  std::array<int, 4> chosen = {first, second, third, fourth};
  std::sort(chosen.begin(), chosen.end());
  meeting.count = 0;
  int last = -1;
  for (const int i : chosen) {
    if (i != last) meeting.point[static_cast<std::size_t>(meeting.count++)] = c.at(i);
    last = i;
  }
}

Real deepest_of(const Meeting& meeting) {
  Real deepest = std::numeric_limits<Real>::infinity();
  for (int i = 0; i < meeting.count; ++i) {
    deepest = std::min(deepest, meeting.point[static_cast<std::size_t>(i)].separation);
  }
  return deepest;
}

void swap_sides(Meeting& meeting) {
  meeting.normal = -meeting.normal;
  for (int i = 0; i < meeting.count; ++i) {
    MeetingPoint& p = meeting.point[static_cast<std::size_t>(i)];
    std::swap(p.on_a, p.on_b);
  }
}

void meet(const Convex& a, const Convex& b, const MeetingQuery& query, Meeting& meeting) {
  const ShapeKind kind_a = a.shape.kind;
  const ShapeKind kind_b = b.shape.kind;
  if (is_round_pair(kind_a, kind_b)) return meet_round(a, b, query, meeting);
  if (kind_a == ShapeKind::kBox && kind_b == ShapeKind::kBox) return meet_boxes(a, b, query, meeting);
  const auto is_polyhedron = [](const Convex& c) {
    return c.hull != nullptr && (c.shape.kind == ShapeKind::kHull || c.shape.kind == ShapeKind::kBox);
  };
  if (is_polyhedron(a) && is_polyhedron(b)) return meet_hulls(a, b, query, meeting);
  return meet_convex(a, b, query, meeting);
}

}  // namespace hooke::collision
