#include "lab/rigid/body_preselection.h"
#include "lab/scenes.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <map>
#include <random>

namespace hooke {

using lab::BodyMotion;
using lab::DenseMotion;
using lab::DensePair;
using lab::RigidBody;

namespace {

class Random {
 public:
  double operator()(double size) { return std::uniform_real_distribution<double>(-size, size)(bits_); }
  DVec3 vector(double size) { return {(*this)(size), (*this)(size), (*this)(size)}; }
  Quaternion<double> rotation() {
    return normalize(Quaternion<double>{(*this)(1), (*this)(1), (*this)(1), (*this)(1)});
  }

 private:
  std::mt19937_64 bits_{11};
};

RigidBody body_of(geometry::ConvexSolid solid) {
  RigidBody body;
  for (const DVec3 v : solid.vertices) body.radius = std::max(body.radius, length(v) + solid.skin);
  body.shapes.push_back({.kind = ShapeKind::kHull, .solid = std::move(solid)});
  return body;
}

std::vector<RigidBody> sample_bodies() {
  const auto rod = geometry::make_convex_hull(std::vector<Vec3>{{-1, -Real(0.0625), 0},
                                                                {1, -Real(0.0625), 0},
                                                                {1, Real(0.0625), 0},
                                                                {-1, 0, Real(0.125)},
                                                                {1, 0, Real(0.125)}});
  return {body_of(geometry::solid_sphere(0.25)), body_of(geometry::solid_capsule(0.125, 0.75)),
          body_of(geometry::solid_triangle({-0.5, 0, 0}, {0.5, 0, 0}, {0, 0, 1})),
          body_of(geometry::solid_hull(rod.value()))};
}

}  // namespace

TEST_SUITE("lab/preselection") {
  TEST_CASE("no preselection loses two bodies that come near each other on their ways") {
    Random random;
    const std::vector<RigidBody> bodies = sample_bodies();
    std::map<Preselection, int> left;
    int near = 0;
    for (int i = 0; i < 400; ++i) {
      const RigidBody& a = bodies[static_cast<std::size_t>(i) % bodies.size()];
      const RigidBody& b = bodies[static_cast<std::size_t>(i / 4) % bodies.size()];
      const auto motion = [&](double reach) {
        const BodyMotion start = {.center = random.vector(reach),
                                  .rotation = random.rotation(),
                                  .velocity = random.vector(40),
                                  .spin = random.vector(20)};
        return DenseMotion(start, 1.0 / 20);
      };
      const DenseMotion of_a = motion(1);
      const DenseMotion of_b = motion(1);
      const DensePair pair = {a, of_a, b, of_b};
      double least = 1e9;
      for (int s = 0; s <= 64; ++s) least = std::min(least, pair.gap(s / 64.0).distance);
      near += least <= 0.01;
      for (const Preselection kind : kPreselections) {
        const lab::BodyVolumes volumes_a = make_body_volumes(a, kind);
        const lab::BodyVolumes volumes_b = make_body_volumes(b, kind);
        const bool may =
            lab::may_collide(kind, {volumes_a, of_a, a.radius}, {volumes_b, of_b, b.radius}, 0.01);
        CAPTURE(name_of(kind));
        REQUIRE((may || least > 0.01));
        left[kind] += may;
      }
    }
    CHECK(near > 40);
    CHECK(left[Preselection::kAllPairs] == 400);
    for (const Preselection kind : kPreselections)
      if (kind != Preselection::kAllPairs) CHECK(left[kind] < 390);
    CHECK(left[Preselection::kVertexSphere] >= left[Preselection::kSphere]);
    CHECK(left[Preselection::kSphere] >= left[Preselection::kOrientedBox]);
  }

  TEST_CASE("bodies that stand are candidates as far as their volumes touch, skins and reach counted") {
    const RigidBody ball = body_of(geometry::solid_sphere(0.25));
    for (const Preselection kind : kPreselections) {
      const lab::BodyVolumes volumes = make_body_volumes(ball, kind);
      const auto meet = [&](double apart) {
        const DenseMotion here(BodyMotion{});
        const DenseMotion there(BodyMotion{.center = {0, apart, 0}});
        return lab::may_collide(kind, {volumes, here, ball.radius}, {volumes, there, ball.radius}, 0.125);
      };
      CAPTURE(name_of(kind));
      CHECK(meet(0.624));
      CHECK(meet(0.626) == (kind == Preselection::kAllPairs));
    }
  }

  TEST_CASE("a rod that turns meets what is off its middle place") {
    const RigidBody rod = body_of(geometry::solid_capsule(0.0625, 1));  // along y
    const RigidBody ball = body_of(geometry::solid_sphere(0.0625));
    const DenseMotion turns(BodyMotion{.spin = {0, 0, 1}}, 1);  // by 1 rad
    for (const Preselection kind : kPreselections) {
      const lab::BodyVolumes of_rod = make_body_volumes(rod, kind);
      const lab::BodyVolumes of_ball = make_body_volumes(ball, kind);
      CAPTURE(name_of(kind));
      for (const DVec3 place : {DVec3{0, 0.9, 0}, DVec3{-0.9 * std::sin(1), 0.9 * std::cos(1), 0}}) {
        const DenseMotion stands(BodyMotion{.center = place});
        CHECK(lab::may_collide(kind, {of_rod, turns, rod.radius}, {of_ball, stands, ball.radius}, 0));
      }
    }
  }

  TEST_CASE("a half-space is near to all") {
    RigidBody ground;
    ground.shapes.push_back({.kind = ShapeKind::kHalfSpace});
    const RigidBody ball = body_of(geometry::solid_sphere(0.25));
    for (const Preselection kind : kPreselections) {
      const lab::BodyVolumes of_ground = make_body_volumes(ground, kind);
      const lab::BodyVolumes of_ball = make_body_volumes(ball, kind);
      const DenseMotion here(BodyMotion{});
      const DenseMotion there(BodyMotion{.center = {0, 1000, 0}});
      CHECK(lab::may_collide(kind, {of_ground, here, 0}, {of_ball, there, ball.radius}, 0));
    }
  }
}

}  // namespace hooke
