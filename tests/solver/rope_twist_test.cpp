#include "solver/rope/rope_twist.h"

#include "build/build.h"

#include <cmath>
#include <cstddef>
#include <doctest/doctest.h>
#include <vector>

namespace hooke {

namespace {

using state::Tables;

/// A rope along a curve that bends and winds, pinned at its first and last two points.
Tables curved_rope(double twist) {
  RopeDesc desc{.bend_stiffness = Real(1), .twist_stiffness = Real(1), .twist = static_cast<Real>(twist)};
  for (int i = 0; i < 13; ++i) {
    const double s = 0.4 * i;
    desc.points.push_back({std::cos(s), 0.3 * s, std::sin(1.3 * s)});
  }
  desc.pins = {{.point = 0}, {.point = 1}, {.point = 11}, {.point = 12}};
  Tables t;
  REQUIRE(build::add_rope(desc, t).has_value());
  solver::find_twist_spans(solver::list_holders(t), t);
  REQUIRE(t.twists.size() == 1);
  return t;
}

}  // namespace

TEST_SUITE("solver/rope_twist") {
  TEST_CASE("the gradients of a twist are its differences over those of places") {
    Tables t = curved_rope(0);
    // Ends of the clamps turn with their segments, which a gradient leaves out: inner nodes only.
    const state::TwistSpan& span = t.twists.front();
    solver::TwistRow row;
    solver::load_twist(t, span, row);
    CHECK(row.angle == doctest::Approx(0).scale(1e-6));
    constexpr Real kStep = Real(1) / Real(512);  // far above the rounding of places
    for (std::uint32_t node = 2; node <= 10; ++node) {
      for (Real Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
        Real& x = t.particles.position[node].x.*axis;
        const Real before = x;
        x = before + kStep;
        const double above = solver::twist_now(t, span);
        x = before - kStep;
        const double below = solver::twist_now(t, span);
        x = before;
        const DVec3 g = row.gradients[node];
        const double expected = axis == &Vec3::x ? g.x : axis == &Vec3::y ? g.y : g.z;
        CHECK((above - below) / (2.0 / 512) == doctest::Approx(expected).epsilon(0.01).scale(0.05));
      }
    }
  }

  TEST_CASE("a twist's gradients sum up to no force, and to the couple of its ends") {
    const Tables t = curved_rope(0);
    solver::TwistRow row;
    solver::load_twist(t, t.twists.front(), row);
    const std::vector<DVec3>& gradients = row.gradients;
    const auto x = [&](std::size_t node) { return vector_cast<double>(t.particles.position[node].x); };
    REQUIRE(gradients.size() == 13);
    DVec3 force;
    DVec3 couple = normalize(x(12) - x(11)) - normalize(x(1) - x(0));
    for (std::size_t i = 0; i < gradients.size(); ++i) {
      force += gradients[i];
      couple += cross(x(i), gradients[i]);
    }
    CHECK(length(force) < 1e-14);
    CHECK(length(couple) < 1e-14);
  }

  TEST_CASE("a direction that is carried along a closed way comes back turned by its solid angle") {
    // An octant of the sphere: pi / 2, right-handed about where it began (Gauss and Bonnet).
    DVec3 v = {0, 1, 0};
    v = solver::transport({1, 0, 0}, {0, 1, 0}, v);
    v = solver::transport({0, 1, 0}, {0, 0, 1}, v);
    v = solver::transport({0, 0, 1}, {1, 0, 0}, v);
    CHECK(length(v - DVec3{0, 0, 1}) < 1e-15);
  }

  TEST_CASE("a rope is made with the twist it is said to have, whole turns included") {
    const Tables t = curved_rope(20);
    const state::TwistSpan& span = t.twists.front();
    const state::Segments& s = t.segments;
    double total = 0;
    for (const Real length : s.rest_length) total += static_cast<double>(length);
    const double between = total - static_cast<double>(s.rest_length.front() + s.rest_length.back());
    CHECK(span.length == doctest::Approx(between).epsilon(1e-6));
    CHECK(span.angle == doctest::Approx(20 * between / total).epsilon(1e-6));
    CHECK(solver::twist_now(t, span) == doctest::Approx(span.angle).epsilon(1e-6));
  }
}

}  // namespace hooke
