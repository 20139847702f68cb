/// Sweeps with known answers (ipc-toolkit, tests of continuous collision: Wang et al. 2021, A large-scale
/// benchmark and an inclusion-based algorithm for continuous collision detection). docs/geometry_cases.md
/// lists them.

#include "lab/rigid/dense.h"

#include <algorithm>
#include <doctest/doctest.h>

namespace hooke {

using lab::DenseMotion;
using lab::DensePair;
using lab::RigidBody;

namespace {

constexpr double kSkin = 1e-3;       // [m], around points, edges and triangles
constexpr double kAllowance = 1e-5;  // [m]

/// A point, an edge or a triangle, where its corners are.
RigidBody body_of(DVec3 a, DVec3 b, DVec3 c) {
  RigidBody body;
  geometry::ConvexSolid solid = geometry::solid_triangle(a, b, c);
  solid.skin = kSkin;
  for (const DVec3 v : solid.vertices) body.radius = std::max(body.radius, length(v) + kSkin);
  body.shapes.push_back({.kind = ShapeKind::kHull, .solid = std::move(solid)});
  return body;
}

bool meet(const RigidBody& a, DVec3 way_a, const RigidBody& b, DVec3 way_b) {
  const DenseMotion motion_a({.velocity = way_a}, 1);
  const DenseMotion motion_b({.velocity = way_b}, 1);
  return lab::first_contact({a, motion_a, b, motion_b}, kAllowance).has_value();
}

}  // namespace

TEST_SUITE("lab/known_sweeps") {
  TEST_CASE("T-28: a point and a triangle that move along y meet if they pass each other within it") {
    const RigidBody triangle = body_of({-1, 0, 1}, {1, 0, 1}, {0, 0, -1});
    int hits = 0;
    for (const double z : {-2.0, -1.1, -1.0, -0.5, 0.0, 0.5, 1.0, 1.1}) {
      const RigidBody point = body_of({0, 1, z}, {0, 1, z}, {0, 1, z});
      for (const double u0 : {-1.0, 0.0, 0.5, 1.0, 2.0}) {
        for (const double u1 : {-1.0, 0.0, 0.5, 1.0, 2.0}) {
          CAPTURE(z);
          CAPTURE(u0);
          CAPTURE(u1);
          const bool expected = u1 - u0 >= 1 && z >= -1 && z <= 1;
          CHECK(meet(point, {0, u0, 0}, triangle, {0, u1, 0}) == expected);
          hits += expected ? 1 : 0;
        }
      }
    }
    CHECK(hits > 30);
  }

  TEST_CASE("T-29: two edges across each other that move along y meet if they cross") {
    for (const double x : {-1.01, -1.0, -0.5, 0.0, 0.5, 1.0, 1.01}) {
      const RigidBody a = body_of({-1, -1, 0}, {1, -1, 0}, {1, -1, 0});
      const RigidBody b = body_of({x, 1, -1}, {x, 1, 1}, {x, 1, 1});
      for (const double u : {-1.0, 0.0, 0.99, 1.0, 1.0 + 1e-9, 2.0}) {
        CAPTURE(x);
        CAPTURE(u);
        CHECK(meet(a, {0, u, 0}, b, {0, -u, 0}) == (u >= 1 && x >= -1 && x <= 1));
      }
    }
  }

  TEST_CASE("T-31: an edge that passes the end of another by half a micrometer") {
    const RigidBody a = body_of({1, 0.50803125, 0}, {0, 0.50803125, 1}, {0, 0.50803125, 1});
    const RigidBody b = body_of({-5e-7, 0.5, 0}, {-5e-7, 0.5, 1}, {-5e-7, 0.5, 1});
    CHECK(meet(a, {0, 0.47124375 - 0.50803125, 0}, b, {}));
    CHECK_FALSE(meet(a, {0, 0.47124375 - 0.50803125, 0}, b, {0, -1, 0}));
  }
}

}  // namespace hooke
