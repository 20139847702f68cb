#include "collision/continuous/continuous_sweep.h"

#include "base/assert.h"
#include "collision/continuous/continuous_tuning.h"
#include "collision/manifold/manifold_axes.h"
#include "collision/manifold/manifold_mesh.h"
#include "collision/manifold/shape_placement.h"
#include "math/rotation.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace hooke::collision {

namespace {

/// The rotation of a collider.
struct Spin {
  Vec3 turn = {};        // [rad per step]
  Vec3 axis = {};        // axis about which the shape is round, through the center of mass; else zero
  Real reach = Real(0);  // distance of the core's points from the center of mass [m]
  bool is_round = false;

  /// Upper bound of the rate at which the core's extent along n can change [m per step].
  [[nodiscard]] Real rate(Vec3 n) const {
    const Real any = length(cross(n, turn));
    return reach * (is_round ? std::min(any, length(cross(axis, turn))) : any);
  }
  [[nodiscard]] Real largest_rate() const { return reach * length(is_round ? cross(axis, turn) : turn); }
};

Spin spin_of(const SweptCollider& c) {
  const Shape& shape = c.colliders.shape[c.row].shape;
  const Real aside = length(c.colliders.position[c.row]);
  Spin spin = {.turn = c.path.turn, .reach = c.path.radius};
  if (shape.kind == ShapeKind::kSphere) spin.reach = aside;
  if (shape.kind == ShapeKind::kCapsule) spin.reach = aside + shape.half_height;
  spin.is_round =
      aside == Real(0) && (shape.kind == ShapeKind::kCapsule || shape.kind == ShapeKind::kCylinder);
  const Quat rotation = c.path.rotation * c.colliders.rotation[c.row];
  if (spin.is_round) spin.axis = rotate(rotation, Vec3{Real(0), Real(1), Real(0)});
  return spin;
}

/// Upper bound of the speed at which two shapes can come together.
struct Closing {
  Vec3 parting = {};  // displacement of B's center relative to A's [m per step]
  Spin a = {};
  Spin b = {};

  [[nodiscard]] Real along(Vec3 n) const { return a.rate(n) + b.rate(n) - dot(n, parting); }
  [[nodiscard]] Real fastest() const { return a.largest_rate() + b.largest_rate() + length(parting); }
};

/// The gap that separates two shapes, and its direction.
struct SeparatingGap {
  Real gap = Real(0);
  Vec3 n = {};  // from A to B
};

void take_better(SeparatingGap other, SeparatingGap& separating) {
  if (other.gap > separating.gap) separating = other;
}

/// Finds the gap by the nearest points. Returns false if those do not define the direction well.
bool separate_by_distance(const Convex& a, const Convex& b, SeparatingGap& separating) {
  const Distance d = distance_between(a, b);
  if (d.cores_overlap) return false;
  take_better({separation_along(a, b, d.normal), d.normal}, separating);
  return d.distance + skin_of(a) + skin_of(b) > Real(16) * axis_tolerance(a, b);
}

SeparatingGap separate_convex(const Convex& a, const Convex& b, ContactResult& result) {
  SeparatingGap separating = {-std::numeric_limits<Real>::infinity(), {}};
  if (separate_by_distance(a, b, separating)) return separating;
  result.count = 0;
  collide(a, b, {.margin = std::numeric_limits<Real>::infinity()}, result);
  take_better({result.separation, result.normal}, separating);
  return separating;
}

Vec3 front_of_triangle(const Convex& triangle) {
  const auto& [p, q, r] = triangle.corners;
  return normalize(cross(q - p, r - p));
}

SeparatingGap separate_from_triangle(const Convex& triangle, const Convex& b) {
  SeparatingGap separating = {-std::numeric_limits<Real>::infinity(), {}};
  if (separate_by_distance(triangle, b, separating)) return separating;
  const Vec3 front = front_of_triangle(triangle);
  Axis axis = {front, separation_along(triangle, b, front), kAxisOfA};
  improve_axis(triangle, b, axis_tolerance(triangle, b), axis);
  take_better({axis.separation, axis.n}, separating);
  return separating;
}

/// Distance from the allowed overlap at which an advance ends.
Real advance_tolerance(Real allowance) {
  return kSweepTolerance * allowance;
}

/// Advances from `begin` to `end`.
template <class Evaluate>
std::optional<Impact> advance(const Closing& closing, Real allowance, Real begin, Real end,
                              Evaluate&& evaluate) {
  const Real tolerance = advance_tolerance(allowance);
  Real target = -allowance;
  Real time = begin;
  SeparatingGap separating;
  for (int round = 0; round < kMostSweepRounds; ++round) {
    separating = evaluate(time);
    if (round == 0) target = std::min(target, separating.gap - Real(2) * tolerance);
    const Real slack = separating.gap - target;
    const Real rate = closing.along(separating.n);
    // A shape that slides along the other at that depth does not meet it.
    if (!(rate * (end - time) > std::max(slack, tolerance))) return std::nullopt;
    if (!(slack > tolerance)) break;
    time += slack / rate;
  }
  return Impact{time, separating.n};
}

ShapeKind kind_of(const SweptCollider& c) {
  return c.colliders.shape[c.row].shape.kind;
}

/// Two convex shapes at `time`, seen from A's center of mass.
std::pair<Convex, Convex> convex_pair_at(const SweptCollider& a, const SweptCollider& b, Real time) {
  const Pose pose_a = pose_at(a.path, time);
  const Pose pose_b = pose_at(b.path, time);
  std::pair<Convex, Convex> pair = {place(a.colliders, a.row, pose_a.rotation),
                                    place(b.colliders, b.row, pose_b.rotation)};
  pair.second.center += vector_cast<Real>(pose_b.position - pose_a.position);
  return pair;
}

/// A pair of which A is the half-space or the mesh, if there is one.
class PairSweep {
 public:
  PairSweep(const SweptCollider& a, const SweptCollider& b, Real allowance, SweepScratch& scratch)
      : a_(a), b_(b), allowance_(allowance), scratch_(scratch) {}

  std::optional<Impact> run(Real begin) {
    constexpr Real kEnd = Real(1);
    const Closing closing = {b_.path.displacement - a_.path.displacement, spin_of(a_), spin_of(b_)};
    const ShapeKind kind = kind_of(a_);
    if (kind == ShapeKind::kMesh) return sweep_mesh(closing, begin, kEnd);
    if (kind == ShapeKind::kHalfSpace) {
      return advance(closing, allowance_, begin, kEnd,
                     [this](Real time) { return separate_from_half_space(time); });
    }
    return advance(closing, allowance_, begin, kEnd, [this](Real time) {
      const auto [a, b] = convex_pair_at(a_, b_, time);
      return separate_convex(a, b, scratch_.result);
    });
  }

 private:
  [[nodiscard]] std::pair<Pose, Pose> poses(Real time) const {
    return {pose_at(a_.path, time), pose_at(b_.path, time)};
  }

  [[nodiscard]] SeparatingGap separate_from_half_space(Real time) const {
    const auto [pose_a, pose_b] = poses(time);
    const Convex plane = place(a_.colliders, a_.row, pose_a.rotation);
    const Convex b = place(b_.colliders, b_.row, pose_b.rotation);
    const Vec3 n = plane.axes.y;
    const Real height = height_over(plane, pose_b.position - pose_a.position);
    return {height + dot(n, support_of(b, -n)) - skin_of(b), n};
  }

  [[nodiscard]] PlacedMesh mesh_at(Real time) const {
    const auto [pose_a, pose_b] = poses(time);
    return place_mesh(a_.colliders.shape[a_.row], place(a_.colliders, a_.row, pose_a.rotation),
                      pose_b.position - pose_a.position);
  }
  [[nodiscard]] Convex shape_at(Real time) const {
    return place(b_.colliders, b_.row, pose_at(b_.path, time).rotation);
  }

  /// Divides the time into stretches in which the shape moves no farther than its size or a part of its
  /// displacement. In each stretch it sweeps the triangles within reach, each only up to the earliest impact
  /// so far.
  std::optional<Impact> sweep_mesh(const Closing& closing, Real begin, Real end) {
    const Real displacement = closing.fastest() * (end - begin);
    const Real reach = std::max(b_.path.radius, displacement / kSweepStretches);
    const Real stretch = displacement > reach ? (end - begin) * (reach / displacement) : end - begin;
    for (Real time = begin; time < end; time += stretch) {
      const Real until = std::min(time + stretch, end);
      if (const auto impact = sweep_triangles(closing, time, until, reach)) return impact;
    }
    return std::nullopt;
  }

  std::optional<Impact> sweep_triangles(const Closing& closing, Real begin, Real end, Real reach) {
    const PlacedMesh mesh = mesh_at(begin);
    const Convex shape = shape_at(begin);
    find_triangles_near(mesh, shape, MeshReach(Real(1.01) * reach), scratch_.triangles);
    std::optional<Impact> first;
    for (const std::uint32_t index : scratch_.triangles) {
      const Real until = first ? first->time : end;
      if (stays_beside_plane(closing, mesh.triangle(index), shape, until - begin)) continue;
      const auto touched = advance(closing, allowance_, begin, until, [&](Real time) {
        return separate_in_mesh(mesh_at(time), index, shape_at(time));
      });
      if (!touched) continue;
      const auto impact = from_front(*touched, index, begin);
      if (impact && (!first || impact->time < first->time)) first = impact;
    }
    return first;
  }

  /// Whether the plane of a triangle alone shows that a shape does not meet it from the front for so long:
  /// the shape stays over the plane, or its middle stays behind a triangle that stands. Most triangles near a
  /// fast shape need no closer test.
  [[nodiscard]] bool stays_beside_plane(const Closing& closing, const Convex& triangle, const Convex& b,
                                        Real duration) const {
    const Vec3 n = front_of_triangle(triangle);
    const Real least = Real(2) * advance_tolerance(allowance_) - allowance_;
    if (separation_along(triangle, b, n) - duration * closing.along(n) > least) return true;
    if (!(a_.path.displacement == Vec3{}) || !(a_.path.turn == Vec3{})) return false;
    const Real rise = dot(n, closing.parting) + closing.b.reach * length(closing.b.turn);
    return dot(n, middle_of(b) - triangle.corners[0]) + duration * std::max(Real(0), rise) < Real(0);
  }

  /// A shape that overlaps a wall is not separated from it by motion through the next wall.
  SeparatingGap separate_in_mesh(const PlacedMesh& mesh, std::uint32_t index, const Convex& b) {
    const Convex triangle = mesh.triangle(index);
    const SeparatingGap separating = separate_from_triangle(triangle, b);
    if (separating.gap >= Real(0)) return separating;
    const Vec3 n = exit_direction(mesh, index, b, separating.n, scratch_.near);
    return n == separating.n ? separating : SeparatingGap{separation_along(triangle, b, n), n};
  }

  /// Height of the shape's middle over the triangle's plane [m].
  [[nodiscard]] Real height_of_middle(std::uint32_t index, Real time) const {
    const Convex triangle = mesh_at(time).triangle(index);
    return dot(front_of_triangle(triangle), middle_of(shape_at(time)) - triangle.corners[0]);
  }

  /// A shape that comes to a triangle from behind, or past its plane, goes on. But a shape that overlapped it
  /// at `begin`, and rotates, may be so thin in between that its middle gets behind the face before the
  /// overlap grows. It then meets the face before that.
  [[nodiscard]] std::optional<Impact> from_front(Impact impact, std::uint32_t index, Real begin) const {
    const Vec3 front = front_of_triangle(mesh_at(impact.time).triangle(index));
    if (!(dot(front, impact.normal) > Real(0))) return std::nullopt;
    if (height_of_middle(index, impact.time) > Real(0)) return impact;
    const Real height = height_of_middle(index, begin);
    if (!is_same_direction(front, impact.normal) || !(height > Real(0))) return std::nullopt;
    const Real least = Real(0.5) * std::min(height, b_.path.inner);
    Real behind = impact.time;
    impact.time = begin;
    for (int i = 0; i < kBehindFaceHalvings; ++i) {
      const Real time = Real(0.5) * (impact.time + behind);
      (height_of_middle(index, time) > least ? impact.time : behind) = time;
    }
    return impact;
  }

  const SweptCollider& a_;
  const SweptCollider& b_;
  Real allowance_;
  SweepScratch& scratch_;
};

bool is_wide(ShapeKind kind) {
  return kind == ShapeKind::kMesh || kind == ShapeKind::kHalfSpace;
}

}  // namespace

Path path_ahead(const state::Bodies& bodies, std::uint32_t body, Real dt) {
  return {.center = bodies.center[body],
          .rotation = bodies.rotation[body],
          .displacement = dt * bodies.motion[body].v,
          .turn = dt * bodies.angular_velocity[body],
          .radius = bodies.traits[body].radius,
          .inner = bodies.traits[body].inner_radius};
}

Real relative_displacement(const Path& a, const Path& b) {
  const bool a_is_small = a.radius <= b.radius;
  const Path& small = a_is_small ? a : b;
  const Path& large = a_is_small ? b : a;
  const Vec3 lever = vector_cast<Real>(small.center - large.center);
  const Vec3 center = small.displacement - large.displacement - cross(large.turn, lever);
  // A point that rotates by an angle leaves its tangent by up to half of the angle's square.
  const Real bend = Real(0.5) * length_squared(large.turn) * (length(lever) + small.radius);
  return length(center) + length(small.turn - large.turn) * small.radius + bend;
}

Pose pose_at(const Path& path, Real time) {
  const Real moving = time - path.since;
  return {path.center + vector_cast<double>(moving * path.displacement),
          path.turn == Vec3{} ? path.rotation
                              : normalize(math::quaternion_of(moving * path.turn) * path.rotation)};
}

Real rotation_reach(const SweptCollider& collider) {
  const Spin spin = spin_of(collider);
  return std::min(spin.largest_rate(), Real(2) * spin.reach);
}

Real overlap_allowance(const SweptCollider& a, const SweptCollider& b) {
  const auto thinness = [](const SweptCollider& c) {
    const state::ColliderShape& s = c.colliders.shape[c.row];
    return thinness_of({.shape = s.shape, .hull = s.hull.get()});
  };
  const Real of_a = thinness(a);
  const Real of_b = thinness(b);
  return std::min(kOverlapShareOfBoth * (of_a + of_b),
                  std::max(kOverlapAllowance, kOverlapShareOfThinner * std::min(of_a, of_b)));
}

bool are_separated(const SweptCollider& a, const SweptCollider& b, Vec3 n, Real allowance, Real begin) {
  if (is_wide(kind_of(a)) || is_wide(kind_of(b))) return false;
  const Closing closing = {b.path.displacement - a.path.displacement, spin_of(a), spin_of(b)};
  const auto [shape_a, shape_b] = convex_pair_at(a, b, begin);
  if (n == Vec3{}) n = normalize(middle_of(shape_b) - middle_of(shape_a));
  if (n == Vec3{}) return false;
  const Real closing_distance = std::max(Real(0), closing.along(n) * (Real(1) - begin));
  return closing_distance <= separation_along(shape_a, shape_b, n) + allowance;
}

std::optional<Impact> find_impact(const SweptCollider& a, const SweptCollider& b, Real allowance, Real begin,
                                  SweepScratch& scratch) {
  if (is_wide(kind_of(a)) && is_wide(kind_of(b))) return std::nullopt;
  const bool swapped = is_wide(kind_of(b));
  HOOKE_ASSERT(kind_of(a) != ShapeKind::kCompound && kind_of(b) != ShapeKind::kCompound);
  PairSweep sweep = swapped ? PairSweep(b, a, allowance, scratch) : PairSweep(a, b, allowance, scratch);
  auto impact = sweep.run(begin);
  if (impact && swapped) impact->normal = -impact->normal;
  return impact;
}

}  // namespace hooke::collision
