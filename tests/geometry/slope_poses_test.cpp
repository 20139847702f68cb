#include "hooke/statics.h"
#include "hooke/world.h"

#include "constants.h"
#include "geometry/meshes.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <vector>

using doctest::Approx;
using hooke::AxleRest;
using hooke::DVec3;
using hooke::find_axle_rest;
using hooke::find_slope_poses;
using hooke::Real;
using hooke::SlopePose;
using hooke::SlopePoses;
using hooke::test::kPi;

namespace {

SlopePoses poses_on(double degrees, double friction) {
  auto poses = find_slope_poses(hooke::test::make_box({0.5f, 1, 1.5f}), degrees * kPi / 180, friction);
  REQUIRE(poses.has_value());
  return std::move(poses).value();
}

const SlopePose* pose_on(const SlopePoses& all, DVec3 normal) {
  const auto found = std::ranges::find_if(
      all.poses, [&](const SlopePose& pose) { return dot(pose.normal, normal) > 0.999999; });
  return found == all.poses.end() ? nullptr : &*found;
}

struct AfterSlope {
  double moved = 0;
  double turned = 0;  ///< Cosine of the turn of its up direction.
};

/// Lays the brick on a slope in a World, a tenth of a millimeter above it, and lets it go for two seconds.
AfterSlope run_on_slope(const SlopePose& pose, double degrees, double friction) {
  hooke::World world = hooke::World::create().value();
  const auto lean = hooke::quaternion_about(DVec3{0, 0, 1}, -degrees * kPi / 180);
  const hooke::ContactDesc contact = {.friction = Real(friction)};
  REQUIRE(world
              .add_body({.shape = hooke::Shape::half_space(),
                         .rotation = {Real(lean.x), Real(lean.y), Real(lean.z), Real(lean.w)},
                         .contact = contact})
              .has_value());
  const auto q = pose.rotation;
  const auto body = world.add_body({.kind = hooke::BodyKind::kDynamic,
                                    .shape = hooke::Shape::box({Real(0.5), Real(1), Real(1.5)}),
                                    .position = pose.position + DVec3{0, 1e-4, 0},
                                    .rotation = {Real(q.x), Real(q.y), Real(q.z), Real(q.w)},
                                    .contact = contact});
  REQUIRE(body.has_value());
  for (int i = 0; i < 120; ++i) world.step(Real(1) / 60);
  const hooke::Quat after = world.pose(body.value()).rotation;
  const DVec3 up = rotate(lean, DVec3{0, 1, 0});
  return {length(world.pose(body.value()).position - pose.position),
          -dot(hooke::vector_cast<double>(rotate(after, hooke::vector_cast<Real>(pose.normal))), up)};
}

}  // namespace

TEST_SUITE_BEGIN("geometry/slope_poses");

TEST_CASE("a brick on end tips where its center is over the edge, and its headings are those of a circle") {
  // On end: 1 m by 2 m, the center 1.5 m high. It tips over the narrow side from atan(0.5 / 1.5) on.
  const DVec3 end = {0, 0, 1};
  const SlopePoses gentle = poses_on(15, 1);
  REQUIRE(pose_on(gentle, end) != nullptr);
  CHECK(pose_on(gentle, end)->upright_share == 1);
  CHECK(pose_on(gentle, end)->tip_angle == Approx(std::atan(0.5 / 1.5)).epsilon(1e-6));
  CHECK(pose_on(gentle, end)->tip_angle_best == Approx(std::atan(std::hypot(0.5, 1) / 1.5)).epsilon(1e-6));
  const SlopePoses steep = poses_on(30, 1);
  // Headings within acos(0.5 / shift) of the two narrow sides tip it.
  const double shift = 1.5 * std::tan(kPi / 6);
  REQUIRE(pose_on(steep, end) != nullptr);
  CHECK(pose_on(steep, end)->upright_share == Approx(1 - 2 * std::acos(0.5 / shift) / kPi).epsilon(1e-6));
  CHECK(std::abs(pose_on(steep, end)->heading.y) == Approx(1).epsilon(1e-6));
  CHECK(pose_on(poses_on(40, 1), end) == nullptr);
  CHECK(steep.poses.front().upright_share == 1);
}

TEST_CASE("a brick slides from atan(friction) on, and tips no more than friction makes it") {
  const SlopePoses holds = poses_on(30, std::tan(kPi / 6));
  CHECK_FALSE(holds.slides);
  CHECK(holds.slide_angle == Approx(kPi / 6).epsilon(1e-9));
  const SlopePoses slides = poses_on(40, 0.2);
  CHECK(slides.slides);
  CHECK(slides.acceleration_share ==
        Approx(std::sin(40 * kPi / 180) - 0.2 * std::cos(40 * kPi / 180)).epsilon(1e-9));
  // atan(0.2) is less than the brick's tip angle on end: it slides upright down a slope that would tip it.
  REQUIRE(pose_on(slides, {0, 0, 1}) != nullptr);
  CHECK(pose_on(slides, {0, 0, 1})->upright_share == 1);
}

TEST_CASE("what statics says of a brick on a slope a World does") {
  for (const SlopePose& pose : poses_on(17, 0.6).poses) {
    const AfterSlope after = run_on_slope(pose, 17, 0.6);
    CHECK(after.moved < 2e-3);
    CHECK(after.turned > 0.99999);
  }
  // Beyond the angle of friction it slides as said.
  const SlopePoses slides = poses_on(17, 0.2);
  const AfterSlope after = run_on_slope(slides.poses[0], 17, 0.2);
  CHECK(after.moved == Approx(0.5 * 9.81 * slides.acceleration_share * 4).epsilon(0.02));
  CHECK(after.turned > 0.9999);
  // On end, turned to its narrow side, it tips where the wide side would hold it.
  SlopePose across = *pose_on(poses_on(30, 1), {0, 0, 1});
  CHECK(run_on_slope(across, 30, 1).turned > 0.9999);
  const auto up = rotate(hooke::quaternion_about(DVec3{0, 0, 1}, -kPi / 6), DVec3{0, 1, 0});
  across.rotation = hooke::quaternion_about(up, kPi / 2) * across.rotation;
  CHECK(run_on_slope(across, 30, 1).turned < 0.9);
}

TEST_CASE("a solid on an axle rests with its center lowest, and friction holds it near") {
  const AxleRest rest =
      find_axle_rest({.center = {2, 1, 7}, .point = {1, 1, 0}, .axis = {0, 0, 3}, .mass = 2}).value();
  CHECK(rest.stable_angle == Approx(-kPi / 2));
  CHECK(rest.unstable_angle == Approx(kPi / 2));
  CHECK(rest.arm == Approx(1));
  CHECK(rest.largest_torque == Approx(2 * 9.81));
  CHECK(rest.torque == Approx(-2 * 9.81));
  CHECK_FALSE(rest.stays);
  CHECK(length(rotate(rest.rotation, DVec3{2, 1, 7}) + rest.position - DVec3{1, 0, 7}) < 1e-12);
  const AxleRest held =
      find_axle_rest({.center = {2, 1, 7}, .point = {1, 1, 0}, .mass = 2, .friction_torque = 9.81}).value();
  CHECK(held.held_within == Approx(kPi / 6));
  CHECK_FALSE(held.stays);
  CHECK(find_axle_rest({.center = {2, 1, 7}, .point = {1, 1, 0}, .mass = 2, .friction_torque = 20})
            .value()
            .stays);
}

TEST_CASE("about an axis that leans, only the part of gravity across it turns the solid") {
  const AxleRest rest =
      find_axle_rest({.center = {1, 0, 0}, .axis = {0, std::sin(1.0), std::cos(1.0)}, .gravity = 10}).value();
  CHECK(rest.largest_torque == Approx(10 * std::cos(1.0)));
  CHECK(std::abs(rest.stable_angle) == Approx(kPi / 2));
  CHECK(find_axle_rest({.center = {1, 0, 0}, .axis = {0, 1, 0}}).value().is_indifferent);
  CHECK(find_axle_rest({.center = {0, 0, 4}, .axis = {0, 0, 1}}).value().is_indifferent);
}

TEST_CASE("slopes and axles out of range are refused with their place") {
  const auto box = hooke::test::make_box({1, 1, 1});
  CHECK(find_slope_poses(box, kPi / 2, 1).error().where == "slope");
  CHECK(find_slope_poses(box, -0.1, 1).error().where == "slope");
  CHECK(find_slope_poses(box, 0.1, -1).error().where == "friction");
  CHECK(find_axle_rest({.axis = {0, 0, 0}}).error().where == "axis");
  CHECK(find_axle_rest({.mass = 0}).error().where == "mass");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(find_axle_rest({.center = {nan, 0, 0}}).error().where == "center");
  CHECK(find_axle_rest({.friction_torque = nan}).error().where == "friction_torque");
}

TEST_SUITE_END();
