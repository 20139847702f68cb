#include "geometry/closest.h"

#include "geometry/convex/closest_hull.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <doctest/doctest.h>
#include <limits>
#include <random>
#include <vector>

using hooke::DVec3;
using hooke::Vector3;
using hooke::geometry::closest_between_segments;
using hooke::geometry::closest_on_box;
using hooke::geometry::closest_on_capsule;
using hooke::geometry::closest_on_cone;
using hooke::geometry::closest_on_cylinder;
using hooke::geometry::closest_on_half_space;
using hooke::geometry::closest_on_segment;
using hooke::geometry::closest_on_sphere;
using hooke::geometry::closest_on_triangle;
using hooke::geometry::Segment;

namespace {

/// What rounding may cost, in units of the size of the figures (about one).
template <class T>
constexpr double kRounding = 40.0 * double(std::numeric_limits<T>::epsilon());

template <class T>
T signed_unit(std::mt19937& random) {
  return static_cast<T>(static_cast<double>(random()) / 2147483648.0 - 1.0);
}
template <class T>
Vector3<T> random_vector(std::mt19937& random) {
  const T x = signed_unit<T>(random);
  const T y = signed_unit<T>(random);
  return {x, y, signed_unit<T>(random)};
}

template <class T>
DVec3 wide(Vector3<T> v) {
  return hooke::vector_cast<double>(v);
}
template <class T>
double distance(Vector3<T> a, Vector3<T> b) {
  return hooke::length(wide(a) - wide(b));
}
double mix(double a, double b, double fraction) {
  return a + fraction * (b - a);
}
DVec3 mix(DVec3 a, DVec3 b, double fraction) {
  return {mix(a.x, b.x, fraction), mix(a.y, b.y, fraction), mix(a.z, b.z, fraction)};
}

constexpr int kSamples = 24;  // along each edge of a triangle

/// The answer is a point of the triangle, and no sample of the triangle is nearer.
template <class T>
void check_triangle(Vector3<T> p, Vector3<T> a, Vector3<T> b, Vector3<T> c) {
  const auto found = closest_on_triangle(p, a, b, c);
  const Vector3<T> w = found.weights;
  CHECK(std::min({w.x, w.y, w.z}) >= T(0));
  CHECK(std::fabs(double(w.x) + double(w.y) + double(w.z) - 1.0) < kRounding<T>);
  const DVec3 combination = double(w.x) * wide(a) + double(w.y) * wide(b) + double(w.z) * wide(c);
  CHECK(hooke::length(combination - wide(found.point)) < kRounding<T>);
  const double reached = distance(p, found.point);
  CHECK(std::fabs(std::sqrt(double(found.distance_squared)) - reached) < kRounding<T>);
  double nearest_sample = 1e30;
  for (int i = 0; i <= kSamples; ++i) {
    for (int j = 0; i + j <= kSamples; ++j) {
      const double v = double(i) / kSamples;
      const double u = double(j) / kSamples;
      const DVec3 sample = wide(a) + v * (wide(b) - wide(a)) + u * (wide(c) - wide(a));
      nearest_sample = std::min(nearest_sample, hooke::length(wide(p) - sample));
    }
  }
  CHECK(reached <= nearest_sample + kRounding<T>);
}

template <class T>
void check_segments(const Segment<T>& a, const Segment<T>& b) {
  const auto found = closest_between_segments(a, b);
  CHECK(std::min(found.fraction_a, found.fraction_b) >= T(0));
  CHECK(std::max(found.fraction_a, found.fraction_b) <= T(1));
  const DVec3 on_a = mix(wide(a.start), wide(a.end), double(found.fraction_a));
  const DVec3 on_b = mix(wide(b.start), wide(b.end), double(found.fraction_b));
  CHECK(hooke::length(on_a - wide(found.point_a)) < kRounding<T>);
  CHECK(hooke::length(on_b - wide(found.point_b)) < kRounding<T>);
  const double reached = distance(found.point_a, found.point_b);
  CHECK(std::fabs(std::sqrt(double(found.distance_squared)) - reached) < kRounding<T>);
  double nearest_sample = 1e30;
  for (int i = 0; i <= 60; ++i) {
    const DVec3 place = mix(wide(a.start), wide(a.end), i / 60.0);
    const auto other = closest_on_segment(place, wide(b.start), wide(b.end));
    nearest_sample = std::min(nearest_sample, std::sqrt(other.distance_squared));
  }
  CHECK(reached <= nearest_sample + kRounding<T>);
}

/// The answer lies on the surface, in the direction it says, and no sample of the surface is nearer.
/// `sample(a, b, is_end)` is a surface point for a and b in [-1, 1].
template <class T, class Closest, class Sample, class IsInside>
void check_solid(const Closest& closest, const Sample& sample, const IsInside& is_inside) {
  std::mt19937 random(7);
  std::vector<Vector3<T>> samples;
  for (int i = 0; i < 2000; ++i) {
    const T a = signed_unit<T>(random);
    samples.push_back(sample(a, signed_unit<T>(random), i % 3 == 0));
  }
  int inside = 0;
  for (const Vector3<T>& s : samples) CHECK(std::fabs(double(closest(s).signed_distance)) < kRounding<T>);
  for (int i = 0; i < 400; ++i) {
    const Vector3<T> p = T(i % 2 == 0 ? 0.5 : 1.8) * random_vector<T>(random);
    const auto found = closest(p);
    inside += found.signed_distance < T(0) ? 1 : 0;
    CHECK(std::fabs(double(hooke::length(found.normal)) - 1.0) < kRounding<T>);
    CHECK(distance(p, found.point + found.signed_distance * found.normal) < kRounding<T>);
    CHECK(std::fabs(double(closest(found.point).signed_distance)) < kRounding<T>);
    CHECK((found.signed_distance <= T(0)) == is_inside(p));
    double nearest = 1e30;
    for (const Vector3<T>& s : samples) nearest = std::min(nearest, distance(p, s));
    CHECK(std::fabs(double(found.signed_distance)) <= nearest + kRounding<T>);
  }
  CHECK(inside > 5);
}

}  // namespace

TEST_SUITE("geometry/closest") {
  TEST_CASE_TEMPLATE("no sample of a segment is nearer than the answer", T, float, double) {
    std::mt19937 random(1);
    for (int i = 0; i < 1000; ++i) {
      const Vector3<T> a = random_vector<T>(random);
      const Vector3<T> b = random_vector<T>(random);
      const Vector3<T> p = T(2) * random_vector<T>(random);
      const auto found = closest_on_segment(p, a, b);
      const double reached = distance(p, found.point);
      CHECK(hooke::length(mix(wide(a), wide(b), double(found.fraction)) - wide(found.point)) < kRounding<T>);
      CHECK(std::fabs(std::sqrt(double(found.distance_squared)) - reached) < kRounding<T>);
      for (int k = 0; k <= 20; ++k) {
        CHECK(reached <= hooke::length(wide(p) - mix(wide(a), wide(b), k / 20.0)) + kRounding<T>);
      }
    }
  }

  TEST_CASE("beyond its ends a segment answers with the end itself, and without length with its start") {
    const DVec3 a = {0.1, 0.2, 0.3};
    const DVec3 b = {1.7, -0.4, 0.9};
    CHECK(closest_on_segment(b + (b - a), a, b).point == b);
    CHECK(closest_on_segment(a - (b - a), a, b).point == a);
    CHECK(closest_on_segment(DVec3{5, 5, 5}, a, a).point == a);
    CHECK(closest_on_segment(DVec3{5, 5, 5}, a, a).fraction == 0.0);
  }

  TEST_CASE_TEMPLATE("no sample of a triangle is nearer than the answer", T, float, double) {
    std::mt19937 random(2);
    for (int i = 0; i < 1500; ++i) {
      const Vector3<T> a = random_vector<T>(random);
      const Vector3<T> b = random_vector<T>(random);
      const Vector3<T> c = random_vector<T>(random);
      const T reach = i % 3 == 0 ? T(0.3) : T(2);
      check_triangle(T(0.33) * (a + b + c) + reach * random_vector<T>(random), a, b, c);
    }
  }

  TEST_CASE_TEMPLATE("nor of thin triangles down to those without any width", T, float, double) {
    std::mt19937 random(3);
    for (int i = 0; i < 1500; ++i) {
      const Vector3<T> a = random_vector<T>(random);
      const Vector3<T> b = random_vector<T>(random);
      const T width = i % 10 == 9 ? T(0) : static_cast<T>(std::pow(10.0, -(i % 10)));
      const Vector3<T> c = a + signed_unit<T>(random) * (b - a) + width * random_vector<T>(random);
      check_triangle(a + T(1.5) * random_vector<T>(random), a, b, c);
      // Almost on the line: every area is rounding.
      const T off = static_cast<T>(std::pow(10.0, -(i / 10 % 12)));
      check_triangle(a + signed_unit<T>(random) * (b - a) + off * random_vector<T>(random), a, b, c);
    }
  }

  TEST_CASE("all seven regions of a triangle") {
    const DVec3 a = {0, 0, 0};
    const DVec3 b = {4, 0, 0};
    const DVec3 c = {0, 4, 0};
    const auto weights = [&](DVec3 p) { return closest_on_triangle(p, a, b, c).weights; };
    CHECK(weights({-1, -1, 2}) == DVec3{1, 0, 0});
    CHECK(weights({6, 1, 2}) == DVec3{0, 1, 0});
    CHECK(weights({1, 6, 2}) == DVec3{0, 0, 1});
    CHECK(weights({1, -1, 2}) == DVec3{0.75, 0.25, 0});
    CHECK(weights({3, 3, 2}) == DVec3{0, 0.5, 0.5});
    CHECK(weights({-1, 1, 2}) == DVec3{0.75, 0, 0.25});
    CHECK(weights({1, 2, -2}) == DVec3{0.25, 0.25, 0.5});
    CHECK(closest_on_triangle(DVec3{1, 2, -2}, a, b, c).distance_squared == 4.0);
  }

  TEST_CASE("a triangle of one point is that point") {
    const DVec3 a = {1, 2, 3};
    CHECK(closest_on_triangle(DVec3{}, a, a, a).point == a);
    CHECK(closest_on_triangle(DVec3{}, a, a, a).weights == DVec3{1, 0, 0});
  }

  TEST_CASE_TEMPLATE("no samples of two segments are nearer than the answer", T, float, double) {
    std::mt19937 random(4);
    for (int i = 0; i < 2000; ++i) {
      const Segment<T> a = {random_vector<T>(random), random_vector<T>(random)};
      const Segment<T> b = {T(0.7) * random_vector<T>(random), random_vector<T>(random)};
      check_segments(a, b);
    }
  }

  TEST_CASE_TEMPLATE("nor of nearly parallel, parallel and vanishing segments", T, float, double) {
    std::mt19937 random(5);
    for (int i = 0; i < 3000; ++i) {
      const Segment<T> a = {random_vector<T>(random), random_vector<T>(random)};
      const T angle = i % 10 == 9 ? T(0) : static_cast<T>(std::pow(10.0, -(i % 10)));
      const Vector3<T> start = T(0.5) * random_vector<T>(random);
      const T stretch = i % 7 == 0 ? T(0) : T(1.5) * signed_unit<T>(random);
      const Vector3<T> along = stretch * (a.end - a.start + angle * random_vector<T>(random));
      check_segments(a, {start, start + along});
      check_segments({start, start + along}, a);
      const T off = static_cast<T>(std::pow(10.0, -(i / 10 % 12)));
      const Vector3<T> near = a.start + signed_unit<T>(random) * (a.end - a.start) + off * start;
      check_segments(a, {near, near + along});
    }
  }

  TEST_CASE("segments that cross meet, and the end of one answers to the middle of the other") {
    const auto crossing = closest_between_segments<double>({{-1, 0, 0}, {1, 0, 0}}, {{0, -1, 0}, {0, 3, 0}});
    CHECK(crossing.distance_squared == 0.0);
    CHECK(crossing.fraction_a == 0.5);
    CHECK(crossing.fraction_b == 0.25);
    const auto apart = closest_between_segments<double>({{-1, -1, 0}, {-1, 1, 0}}, {{2, 0, 0}, {1, 0, 0}});
    CHECK(apart.fraction_a == 0.5);
    CHECK(apart.fraction_b == 1.0);
    CHECK(apart.point_a == DVec3{-1, 0, 0});
    CHECK(apart.point_b == DVec3{1, 0, 0});
    CHECK(apart.distance_squared == 4.0);
  }

  TEST_CASE("of parallel segments the answer has the first end that faces the other") {
    const auto pair = closest_between_segments<double>({{0, 0, 0}, {4, 0, 0}}, {{1, 1, 0}, {9, 1, 0}});
    CHECK(pair.point_a == DVec3{4, 0, 0});
    CHECK(pair.point_b == DVec3{4, 1, 0});
  }

  TEST_CASE_TEMPLATE("a sphere answers along the radius and its center looks up", T, float, double) {
    const auto outside = closest_on_sphere(Vector3<T>{T(3), T(0), T(4)}, T(2));
    CHECK(double(outside.signed_distance) == doctest::Approx(3.0));
    CHECK(distance(outside.normal, {T(0.6), T(0), T(0.8)}) < kRounding<T>);
    CHECK(distance(outside.point, {T(1.2), T(0), T(1.6)}) < kRounding<T>);
    CHECK(double(closest_on_sphere(Vector3<T>{T(0), T(0), T(-0.5)}, T(2)).signed_distance) == -1.5);
    CHECK(closest_on_sphere(Vector3<T>{}, T(2)).point == Vector3<T>{T(0), T(2), T(0)});
    CHECK(closest_on_sphere(Vector3<T>{}, T(2)).signed_distance == T(-2));
    // The square of this length is zero.
    const T tiny = std::numeric_limits<T>::denorm_min();
    CHECK(closest_on_sphere(Vector3<T>{T(0), T(0), -tiny}, T(1)).normal == Vector3<T>{T(0), T(0), T(-1)});
  }

  TEST_CASE("a half-space answers straight up") {
    const auto above = closest_on_half_space(DVec3{1, 2, 3});
    CHECK(above.point == DVec3{1, 0, 3});
    CHECK(above.signed_distance == 2.0);
    CHECK(above.normal == DVec3{0, 1, 0});
    CHECK(closest_on_half_space(DVec3{1, -2, 3}).signed_distance == -2.0);
  }

  TEST_CASE_TEMPLATE("no sample of a box's surface is nearer than the answer", T, float, double) {
    std::mt19937 random(6);
    const Vector3<T> h = {T(1), T(0.5), T(0.25)};
    for (int i = 0; i < 1000; ++i) {
      const Vector3<T> p = T(i % 2 == 0 ? 0.6 : 2.0) * random_vector<T>(random);
      const auto found = closest_on_box(p, h);
      const bool is_inside = std::fabs(p.x) <= h.x && std::fabs(p.y) <= h.y && std::fabs(p.z) <= h.z;
      CHECK((found.signed_distance <= T(0)) == is_inside);
      CHECK(std::fabs(double(hooke::length(found.normal)) - 1.0) < kRounding<T>);
      // The point is the answer's point moved by the signed distance along the normal.
      CHECK(distance(p, found.point + found.signed_distance * found.normal) < kRounding<T>);
      const auto on_surface = closest_on_box(found.point, h);
      CHECK(on_surface.signed_distance == T(0));
      for (int k = 0; k < 100; ++k) {
        Vector3<T> sample = {h.x * signed_unit<T>(random), h.y * signed_unit<T>(random),
                             h.z * signed_unit<T>(random)};
        const T side = k % 2 == 0 ? T(1) : T(-1);
        (k % 3 == 0   ? sample.x
         : k % 3 == 1 ? sample.y
                      : sample.z) = side * (k % 3 == 0   ? h.x
                                            : k % 3 == 1 ? h.y
                                                         : h.z);
        CHECK(std::fabs(double(found.signed_distance)) <= distance(p, sample) + kRounding<T>);
      }
    }
  }

  TEST_CASE("a box answers with the documented face where several are equally near") {
    const auto normal = [](DVec3 p) { return closest_on_box(p, {1, 1, 1}).normal; };
    CHECK(normal({0, 0, 0}) == DVec3{0, 1, 0});
    CHECK(normal({0.5, -0.5, 0.5}) == DVec3{0, -1, 0});
    CHECK(normal({-0.5, 0, 0.5}) == DVec3{-1, 0, 0});
    CHECK(normal({0.25, 0, -0.5}) == DVec3{0, 0, -1});
    CHECK(normal({1, 0, 0}) == DVec3{1, 0, 0});
    CHECK(closest_on_box(DVec3{1, 0, 0}, {1, 1, 1}).signed_distance == 0.0);
    CHECK(closest_on_box(DVec3{0.25, 2, 0.5}, {1, 0, 1}).normal == DVec3{0, 1, 0});
  }

  TEST_CASE_TEMPLATE("no sample of a capsule, cylinder or cone is nearer than the answer", T, float, double) {
    const T r = T(0.4);
    const T h = T(0.6);
    const auto on_side = [=](T around, T up, T radius) {
      const double angle = 3.14159265358979 * double(around);
      return Vector3<T>{radius * T(std::cos(angle)), up, radius * T(std::sin(angle))};
    };
    check_solid<T>(
        [=](auto p) { return closest_on_capsule(p, r, h); },
        [=](T a, T b, bool is_end) {
          const T up = is_end ? r * b : h * b;
          const T side = b < T(0) ? -h : h;
          const T radius = is_end ? std::sqrt(r * r - up * up) : r;
          return on_side(a, is_end ? up + side : up, radius);
        },
        [=](auto p) {
          return closest_on_segment(p, {T(0), -h, T(0)}, {T(0), h, T(0)}).distance_squared <= r * r;
        });
    check_solid<T>([=](auto p) { return closest_on_cylinder(p, r, h); },
                   [=](T a, T b, bool is_end) {
                     return is_end ? on_side(a, b < T(0) ? -h : h, r * std::fabs(b)) : on_side(a, h * b, r);
                   },
                   [=](auto p) { return std::fabs(p.y) <= h && p.x * p.x + p.z * p.z <= r * r; });
    check_solid<T>(
        [=](auto p) { return closest_on_cone(p, r, h); },
        [=](T a, T b, bool is_end) {
          return is_end ? on_side(a, -h, r * std::fabs(b)) : on_side(a, h * b, r * (T(1) - b) / T(2));
        },
        [=](auto p) {
          return std::fabs(p.y) <= h && std::sqrt(p.x * p.x + p.z * p.z) <= r * (h - p.y) / (T(2) * h);
        });
  }

  TEST_CASE("round shapes answer with the documented place where several are equally near") {
    CHECK(closest_on_capsule(DVec3{0, 0.5, 0}, 1.0, 2.0).normal == DVec3{1, 0, 0});
    CHECK(closest_on_capsule(DVec3{0, 2.5, 0}, 1.0, 2.0).normal == DVec3{0, 1, 0});
    CHECK(closest_on_capsule(DVec3{0, 0.5, 0}, 1.0, 2.0).signed_distance == -1.0);
    CHECK(closest_on_cylinder(DVec3{0, 0, 0}, 1.0, 1.0).normal == DVec3{0, 1, 0});
    CHECK(closest_on_cylinder(DVec3{0, 0, 0}, 1.0, 2.0).point == DVec3{1, 0, 0});
    CHECK(closest_on_cylinder(DVec3{0, -1.5, 0}, 1.0, 2.0).point == DVec3{0, -2, 0});
    const auto over_tip = closest_on_cone(DVec3{0, 3, 0}, 1.0, 2.0);
    CHECK(over_tip.point == DVec3{0, 2, 0});
    CHECK(over_tip.normal == DVec3{0, 1, 0});
    CHECK(closest_on_cone(DVec3{0, -1.9, 0}, 1.0, 2.0).normal == DVec3{0, -1, 0});
    CHECK(closest_on_cone(DVec3{0, 1.9, 0}, 1.0, 2.0).normal.x == doctest::Approx(4 / std::sqrt(17.0)));
  }

  TEST_CASE("beside a cone the distance is that to the line of its side") {
    // The side of radius 3, height 4 has the normal (4, 3) / 5.
    const auto beside = closest_on_cone(DVec3{1.5 + 0.8, 0.6, 0}, 3.0, 2.0);
    CHECK(beside.signed_distance == doctest::Approx(1.0));
    CHECK(beside.normal.x == doctest::Approx(0.8));
    CHECK(beside.normal.y == doctest::Approx(0.6));
    CHECK(closest_on_cone(DVec3{3 + 0.3, -2 - 0.4, 0}, 3.0, 2.0).signed_distance == doctest::Approx(0.5));
  }

  TEST_CASE("no sample of a hull is nearer than the answer") {
    std::mt19937 random(8);
    for (int round = 0; round < 4; ++round) {
      std::vector<hooke::Vec3> points;
      for (int i = 0; i < (round == 0 ? 4 : 40); ++i) points.push_back(random_vector<hooke::Real>(random));
      const auto hull = hooke::geometry::make_convex_hull(points).value();
      // A place in a random triangle of a random face.
      const auto sample = [&](hooke::Real a, hooke::Real b, bool) {
        const auto& face = hull.faces[random() % hull.faces.size()];
        const std::size_t corner = 1 + random() % (face.count - 2u);
        const auto vertex = [&](std::size_t i) { return hull.vertices[hull.loop[face.first + i]]; };
        const hooke::Real u = std::fabs(a);
        const hooke::Real v = (hooke::Real(1) - u) * std::fabs(b);
        return vertex(0) + u * (vertex(corner) - vertex(0)) + v * (vertex(corner + 1) - vertex(0));
      };
      check_solid<hooke::Real>(
          [&](auto p) { return hooke::geometry::closest_on_hull(p, hull); }, sample,
          [&](auto p) {
            return std::all_of(hull.faces.begin(), hull.faces.end(),
                               [&](const auto& face) { return hooke::dot(face.normal, p) <= face.offset; });
          });
    }
  }

  TEST_CASE("a hull of a box answers as the box does") {
    std::mt19937 random(9);
    const hooke::Vec3 h = {1, hooke::Real(0.5), hooke::Real(0.25)};
    const auto hull = hooke::geometry::make_box_hull(h);
    for (int i = 0; i < 500; ++i) {
      const hooke::Vec3 p = hooke::Real(i % 2 == 0 ? 0.6 : 2.0) * random_vector<hooke::Real>(random);
      const auto expected = closest_on_box(p, h);
      const auto found = hooke::geometry::closest_on_hull(p, hull);
      CHECK(std::fabs(double(found.signed_distance - expected.signed_distance)) < kRounding<hooke::Real>);
      CHECK(distance(found.point, expected.point) < kRounding<hooke::Real>);
    }
  }

  TEST_CASE("a hair outside a box the normal still has length one") {
    const float edge = 1.0f;
    const float next = std::nextafter(edge, 2.0f);
    CHECK(closest_on_box<float>({next, 0, 0}, {edge, edge, edge}).normal == Vector3<float>{1, 0, 0});
    const float tiny = std::numeric_limits<float>::denorm_min();
    CHECK(closest_on_box<float>({0, tiny, 0}, {edge, 0, edge}).normal == Vector3<float>{0, 1, 0});
  }
}
