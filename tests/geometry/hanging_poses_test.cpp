#include "hooke/statics.h"
#include "hooke/world.h"

#include "constants.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <vector>

using doctest::Approx;
using hooke::DVec3;
using hooke::find_hanging_poses;
using hooke::HangingPose;
using hooke::HangingSolid;
using hooke::Real;
using hooke::test::kPi;

namespace {

std::vector<HangingPose> poses_of(const HangingSolid& solid) {
  auto poses = find_hanging_poses(solid);
  REQUIRE(poses.has_value());
  for (const HangingPose& pose : poses.value()) CHECK(pose.residual < 1e-9);
  return std::move(poses).value();
}

/// How far a box of the half sizes that hangs as found is from there after it was moved by a millimeter and
/// let swing in a World, stopped whenever its kinetic energy has passed a peak.
double distance_after_nudge(const HangingSolid& solid, const HangingPose& pose, hooke::Vec3 half,
                            std::vector<double>& tensions) {
  hooke::World world = hooke::World::create().value();
  const auto body = world.add_body({.kind = hooke::BodyKind::kDynamic,
                                    .shape = hooke::Shape::box(half),
                                    .position = pose.position + DVec3{1e-3, 0, 0},
                                    .rotation = {Real(pose.rotation.x), Real(pose.rotation.y),
                                                 Real(pose.rotation.z), Real(pose.rotation.w)},
                                    .mass = Real(solid.mass),
                                    .linear_damping = Real(0),
                                    .angular_damping = Real(0)});
  REQUIRE(body.has_value());
  std::vector<hooke::HookId> hooks;
  for (const hooke::Cable& cable : solid.cables) {
    hooke::HookDesc desc;
    desc.kind = hooke::HookKind::kDistance;
    desc.b.body = body.value();
    desc.anchor = cable.anchor;
    desc.anchor_b = pose.position + DVec3{1e-3, 0, 0} + rotate(pose.rotation, cable.attachment);
    desc.limits = hooke::HookLimits{.lower = Real(0), .upper = Real(cable.length)};
    const auto hook = world.add_hook(desc);
    REQUIRE(hook.has_value());
    hooks.push_back(hook.value());
  }
  double before = 0;
  for (int i = 0; i < 2400; ++i) {
    world.step(Real(1) / 60);
    const double kinetic = world.energy(body.value()).kinetic;
    if (kinetic < before) {
      REQUIRE(world.set_velocity(body.value(), {}).has_value());
      REQUIRE(world.set_angular_velocity(body.value(), {}).has_value());
    }
    before = kinetic < before ? 0 : kinetic;
  }
  for (const hooke::HookId hook : hooks) tensions.push_back(double(length(world.hook_force(hook).force)));
  return length(world.center_of_mass(body.value()) - pose.center);
}

}  // namespace

TEST_SUITE_BEGIN("geometry/hanging_poses");

TEST_CASE("hung from one cable, the center of mass comes below the anchor, and may turn freely") {
  const HangingSolid solid = {
      .center = {0.2, 0.1, -0.3},
      .mass = 2,
      .cables = {{.attachment = {0.5, 0.4, 0.1}, .anchor = {1, 5, 2}, .length = 1.5}}};
  const auto poses = poses_of(solid);
  REQUIRE(poses.size() == 1);
  const double arm = length(DVec3{0.3, 0.3, 0.4});
  CHECK(length(poses[0].center - DVec3{1, 5 - 1.5 - arm, 2}) < 1e-7);
  CHECK(poses[0].tensions[0] == Approx(2 * 9.81).epsilon(1e-9));
  CHECK(poses[0].neutral == 1);
  // The softest way is the pendulum's whose parts swing alike: the lesser root of the double pendulum's
  // stiffness, L for the cable and r for the arm, both with the weight W: W / L - x, W / r, coupled by W / L.
  const double w = 2 * 9.81;
  const double sum = w / 1.5 + w / 1.5 + w / arm;
  const double product = w / 1.5 * (w / 1.5 + w / arm) - w / 1.5 * w / 1.5;
  CHECK(poses[0].stiffness == Approx(0.5 * (sum - std::sqrt(sum * sum - 4 * product))).epsilon(1e-4));
}

TEST_CASE("two equal cables that lean alike share the weight by their slope") {
  const HangingSolid solid = {.mass = 10,
                              .cables = {{.attachment = {-0.5, 0.1, 0}, .anchor = {-1.1, 3, 0}, .length = 1},
                                         {.attachment = {0.5, 0.1, 0}, .anchor = {1.1, 3, 0}, .length = 1}}};
  const auto poses = poses_of(solid);
  const HangingPose& pose = poses[0];
  CHECK(length(pose.center - DVec3{0, 3 - 0.8 - 0.1, 0}) < 1e-8);
  for (const double tension : pose.tensions) CHECK(tension == Approx(10 * 9.81 / 2 / 0.8).epsilon(1e-8));
  CHECK(pose.neutral == 0);
  // Turned end for end the cables cross, and the center is higher.
  for (const HangingPose& other : poses) CHECK(other.center.y >= pose.center.y - 1e-9);
}

TEST_CASE("a plate on three upright cables loads each by the lever rule") {
  // Attachments of an equilateral triangle; the center stands at the shares 0.5, 0.3, 0.2 of them.
  const DVec3 a = {1, 0, 0};
  const DVec3 b = {-0.5, 0, std::sqrt(0.75)};
  const DVec3 c = {-0.5, 0, -std::sqrt(0.75)};
  HangingSolid solid = {.center = 0.5 * a + 0.3 * b + 0.2 * c, .mass = 100};
  for (const DVec3 p : {a, b, c}) {
    solid.cables.push_back({.attachment = p, .anchor = p + DVec3{0, 4, 0}, .length = 2});
  }
  const auto poses = poses_of(solid);
  const double weight = 100 * 9.81;
  CHECK(poses[0].tensions[0] == Approx(0.5 * weight).epsilon(1e-8));
  CHECK(poses[0].tensions[1] == Approx(0.3 * weight).epsilon(1e-8));
  CHECK(poses[0].tensions[2] == Approx(0.2 * weight).epsilon(1e-8));
  CHECK(length(poses[0].position - DVec3{0, 2, 0}) < 1e-7);
}

TEST_CASE("a cable that is too long to pull is slack") {
  const HangingSolid solid = {.mass = 1,
                              .cables = {{.attachment = {0, 0.5, 0}, .anchor = {0, 3, 0}, .length = 1},
                                         {.attachment = {0, 0.5, 0}, .anchor = {1, 3, 0}, .length = 9}}};
  const auto poses = poses_of(solid);
  CHECK(poses[0].tensions[0] == Approx(9.81).epsilon(1e-9));
  CHECK(poses[0].tensions[1] == 0);
}

TEST_CASE("three cables in one plane from one point share as equal springs, and say that others may") {
  HangingSolid solid = {.mass = 1};
  for (const double x : {-1.0, 0.0, 1.0}) {
    solid.cables.push_back({.attachment = {0, 0, 0}, .anchor = {x, 1, 0}, .length = std::sqrt(1 + x * x)});
  }
  const auto poses = poses_of(solid);
  CHECK(poses[0].is_indeterminate);
  CHECK(poses[0].neutral == 3);
  CHECK(poses[0].tensions[0] == Approx(poses[0].tensions[2]).epsilon(1e-6));
}

TEST_CASE("a box hung from one, two and three cables stays where statics has it, nudged by 1 mm") {
  const hooke::Vec3 half = {Real(0.5), Real(0.1), Real(0.3)};
  HangingSolid solid = {.mass = 50};
  const hooke::Cable cables[] = {{.attachment = {-0.5, 0.1, 0.3}, .anchor = {-0.8, 2, 0.5}, .length = 1.2},
                                 {.attachment = {0.5, 0.1, 0.3}, .anchor = {1.1, 2.5, 0.2}, .length = 1.9},
                                 {.attachment = {0.1, 0.1, -0.3}, .anchor = {0, 3, -0.9}, .length = 2.2}};
  for (const hooke::Cable& cable : cables) {
    solid.cables.push_back(cable);
    for (const HangingPose& pose : poses_of(solid)) {
      std::vector<double> tensions;
      CAPTURE(solid.cables.size());
      CHECK(distance_after_nudge(solid, pose, half, tensions) < 2e-4);
      for (std::size_t i = 0; i < tensions.size(); ++i) {
        if (pose.tensions[i] > 0) CHECK(tensions[i] == Approx(pose.tensions[i]).epsilon(1e-3));
      }
    }
  }
}

TEST_CASE("cables that cannot reach, and values out of range, are refused with their place") {
  HangingSolid solid = {.cables = {{.attachment = {-0.5, 0, 0}, .anchor = {-5, 3, 0}, .length = 1},
                                   {.attachment = {0.5, 0, 0}, .anchor = {5, 3, 0}, .length = 1}}};
  const auto far = find_hanging_poses(solid);
  REQUIRE_FALSE(far.has_value());
  CHECK(far.error().message.find("too short") != std::string::npos);
  CHECK_FALSE(find_hanging_poses({}).has_value());
  solid.cables.pop_back();
  solid.cables[0].length = 0;
  REQUIRE_FALSE(find_hanging_poses(solid).has_value());
  CHECK(find_hanging_poses(solid).error().where == "cables[0].length");
  solid.cables[0].length = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(find_hanging_poses(solid).has_value());
  solid.cables[0].length = 1;
  solid.mass = -1;
  CHECK_FALSE(find_hanging_poses(solid).has_value());
}

TEST_SUITE_END();
