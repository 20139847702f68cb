#include "lab/dense.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <optional>
#include <random>

namespace hooke {

using geometry::ConvexSolid;
using lab::BodyMotion;
using lab::DenseMotion;
using lab::DensePair;
using lab::RigidBody;

namespace {

constexpr double kSkin = 1e-3;       // [m]
constexpr double kAllowance = 1e-5;  // [m]

class Random {
 public:
  explicit Random(std::uint64_t seed) : bits_(seed) {}
  double operator()(double size) { return std::uniform_real_distribution<double>(-size, size)(bits_); }
  DVec3 vector(double size) { return {(*this)(size), (*this)(size), (*this)(size)}; }
  Quaternion<double> rotation() {
    return normalize(Quaternion<double>{(*this)(1), (*this)(1), (*this)(1), (*this)(1)});
  }

 private:
  std::mt19937_64 bits_;
};

RigidBody body_of(ConvexSolid solid) {
  RigidBody body;
  for (const DVec3 v : solid.vertices) body.radius = std::max(body.radius, length(v) + solid.skin);
  body.shapes.push_back({.kind = ShapeKind::kHull, .solid = std::move(solid)});
  return body;
}

/// Time at which a point on its way crosses a triangle; nothing if it does not, or only just.
std::optional<double> crossing(DVec3 p, DVec3 way, DVec3 a, DVec3 b, DVec3 c) {
  const DVec3 n = cross(b - a, c - a);
  const double speed = dot(n, way);
  if (std::abs(speed) < 1e-6) return {};
  const double t = dot(n, a - p) / speed;
  const DVec3 at = p + t * way;
  const double margin = 1e-9 * dot(n, n);
  const bool inside = dot(n, cross(b - a, at - a)) > margin && dot(n, cross(c - b, at - b)) > margin &&
                      dot(n, cross(a - c, at - c)) > margin;
  if (!inside || !(t > 0 && t < 1)) return {};
  return t;
}

/// Time at which a segment on its way crosses another.
std::optional<double> edge_crossing(DVec3 a, DVec3 along_a, DVec3 way, DVec3 b, DVec3 along_b) {
  const DVec3 n = cross(along_a, along_b);
  const double speed = dot(n, way);
  if (std::abs(speed) < 1e-6) return {};
  const double t = dot(n, b - a) / speed;
  const DVec3 between = b - a - t * way;  // = s along_a - r along_b
  const double s = dot(cross(between, along_b), n) / dot(n, n);
  const double r = dot(cross(between, along_a), n) / dot(n, n);
  const bool inside = s > 1e-9 && s < 1 - 1e-9 && r > 1e-9 && r < 1 - 1e-9;
  if (!inside || !(t > 0 && t < 1)) return {};
  return t;
}

struct Outcome {
  int met = 0;
  int late = 0;       // after the exact time, or not at all
  int premature = 0;  // with a gap still open
  double widest = 0;  // of those gaps [m]
};

/// What meets within a skin of a crossing is seen before it, and where it is said to meet it does.
void judge(const RigidBody& a, const BodyMotion& at_a, const RigidBody& b, const BodyMotion& at_b,
           std::optional<double> exact, Outcome& outcome) {
  const DenseMotion motion_a(at_a, 1);
  const DenseMotion motion_b(at_b, 1);
  const DensePair pair = {a, motion_a, b, motion_b};
  const double start = pair.gap(0).distance;
  if (start <= 0) return;
  const auto share = lab::first_contact(pair, kAllowance);
  outcome.met += share ? 1 : 0;
  if (exact && !(share && *share <= *exact)) ++outcome.late;
  if (exact && !lab::may_meet(pair, 0)) ++outcome.late;
  if (share && pair.gap(*share).distance > 0) ++outcome.premature;
}

Outcome points_and_triangles(int count) {
  Random random(1);
  Outcome outcome;
  const RigidBody point = body_of(geometry::solid_sphere(kSkin));
  for (int i = 0; i < count; ++i) {
    const DVec3 a = random.vector(1), b = random.vector(1), c = random.vector(1);
    const BodyMotion at = {.center = random.vector(1), .velocity = random.vector(2)};
    const BodyMotion other = {.velocity = random.vector(1)};
    judge(point, at, body_of(geometry::solid_triangle(a, b, c)), other,
          crossing(at.center, at.velocity - other.velocity, a, b, c), outcome);
  }
  return outcome;
}

Outcome edges_and_edges(int count) {
  Random random(2);
  Outcome outcome;
  for (int i = 0; i < count; ++i) {
    const double half_a = 0.6 + random(0.5), half_b = 0.6 + random(0.5);
    const BodyMotion a = {random.vector(1), random.rotation(), random.vector(2), {}};
    const BodyMotion b = {random.vector(1), random.rotation(), random.vector(1), {}};
    const DVec3 along_a = rotate(a.rotation, DVec3{0, 2 * half_a, 0});
    const DVec3 along_b = rotate(b.rotation, DVec3{0, 2 * half_b, 0});
    judge(body_of(geometry::solid_capsule(kSkin, half_a)), a, body_of(geometry::solid_capsule(kSkin, half_b)),
          b,
          edge_crossing(a.center - 0.5 * along_a, along_a, a.velocity - b.velocity, b.center - 0.5 * along_b,
                        along_b),
          outcome);
  }
  return outcome;
}

/// Boxes that turn: at no sampled time before they are said to meet may they overlap by more than is allowed.
Outcome turning_boxes(int count) {
  Random random(3);
  Outcome outcome;
  const ConvexSolid solids[] = {
      geometry::solid_hull(geometry::make_box_hull({Real(0.5), Real(0.25), Real(0.125)})),
      geometry::solid_hull(geometry::make_box_hull({Real(1), Real(0.01), Real(0.5)})),
      geometry::solid_capsule(0.125, 0.5)};
  for (int i = 0; i < count; ++i) {
    const RigidBody a = body_of(solids[i % 3]), b = body_of(solids[i / 3 % 3]);
    const DVec3 place = random.vector(2);
    const DenseMotion motion_a({place, random.rotation(), random.vector(1) - place, random.vector(3)}, 1);
    const DenseMotion motion_b({{}, random.rotation(), {}, random.vector(3)}, 1);
    const DensePair pair = {a, motion_a, b, motion_b};
    if (pair.gap(0).distance <= 0) continue;
    const auto share = lab::first_contact(pair, kAllowance);
    outcome.met += share ? 1 : 0;
    if (share && pair.gap(*share).distance > 0) {
      ++outcome.premature;
      outcome.widest = std::max(outcome.widest, pair.gap(*share).distance);
    }
    const bool may = lab::may_meet(pair, 0);
    for (int k = 1; k <= 20; ++k) {
      const double time = share.value_or(1) * k / 20.0;
      const double gap = pair.gap(time).distance;
      if (gap < -kAllowance || (gap < 0 && !may)) ++outcome.late;
    }
  }
  return outcome;
}

void check_all(int count) {
  const Outcome points = points_and_triangles(count / 2);
  CHECK(points.late == 0);
  CHECK(points.premature == 0);
  CHECK(points.met > count / 100);
  const Outcome edges = edges_and_edges(count / 2 - count / 20);
  CHECK(edges.late == 0);
  CHECK(edges.premature == 0);
  CHECK(edges.met > count / 50);
  const Outcome boxes = turning_boxes(count / 20);
  CHECK(boxes.late == 0);
  // Work is bounded: who has come very near, turning, after all rounds is said to meet.
  CHECK(boxes.premature <= count / 200000);
  CHECK(boxes.widest < 2e-4);
  CHECK(boxes.met > count / 100);
}

}  // namespace

TEST_SUITE("lab/sweeps") {
  TEST_CASE("of 100 000 random sweeps none is seen late") {
    check_all(100000);
  }

  TEST_CASE("1 000 000 random sweeps, none late" * doctest::skip()) {
    check_all(1000000);
  }
}

}  // namespace hooke
