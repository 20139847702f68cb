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
using hooke::DVec3;
using hooke::find_stable_poses;
using hooke::MeshDesc;
using hooke::Real;
using hooke::StablePose;
using hooke::StablePoses;
using hooke::Vec3;

using hooke::test::kPi;

namespace {

struct Corner {
  double x = 0;
  double y = 0;
};

/// A prism along z of a convex outline that runs counter-clockwise, seen from +z.
MeshDesc make_prism(const std::vector<Corner>& outline, double half_length) {
  MeshDesc mesh;
  const auto count = std::uint32_t(outline.size());
  for (const double z : {-half_length, half_length}) {
    for (const Corner& c : outline) mesh.positions.push_back({Real(c.x), Real(c.y), Real(z)});
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t next = (i + 1) % count;
    mesh.triangles.push_back({i, next, count + next});
    mesh.triangles.push_back({i, count + next, count + i});
    if (i == 0 || next == 0) continue;
    mesh.triangles.push_back({0, next, i});
    mesh.triangles.push_back({count, count + i, count + next});
  }
  return mesh;
}

/// Its cross section leans so far that the center of mass overhangs its base by a quarter of a meter.
MeshDesc make_leaning_prism() {
  return make_prism({{0, 0}, {1, 0}, {2.5, 1}, {1.5, 1}}, 0.5);
}

MeshDesc make_round_prism(int sides, double radius, double half_length) {
  std::vector<Corner> outline;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * kPi * i / sides;
    outline.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return make_prism(outline, half_length);
}

MeshDesc make_tetrahedron() {
  return {.positions = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
          .triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
}

/// The share of all directions from the center of the leaning prism that meet one of its ends, by the
/// midpoint rule: the integral of z / r^3 over the end.
double share_of_leaning_end() {
  const int cells = 500;
  double sum = 0;
  for (int i = 0; i < cells; ++i) {
    for (int k = 0; k < cells; ++k) {
      const double y = (k + 0.5) / cells - 0.5;
      const double x = (i + 0.5) / cells - 0.5 + 1.5 * y;
      const double r2 = x * x + y * y + 0.25;
      sum += 0.5 / (r2 * std::sqrt(r2)) / (cells * cells);
    }
  }
  return sum / (4 * kPi);
}

StablePoses poses_of(const MeshDesc& mesh) {
  auto poses = find_stable_poses(mesh);
  REQUIRE(poses.has_value());
  return std::move(poses).value();
}

const StablePose& pose_on(const StablePoses& all, DVec3 normal) {
  const auto found = std::ranges::find_if(
      all.poses, [normal](const StablePose& pose) { return dot(pose.normal, normal) > 0.999999; });
  REQUIRE(found != all.poses.end());
  return *found;
}

double sum_of(const StablePoses& all) {
  double sum = 0;
  for (const StablePose& pose : all.poses) sum += pose.probability;
  return sum;
}

/// A world in which the solid is in this pose, but a millimeter too high and turned so that a point a meter
/// away is a millimeter off, runs for two seconds. Returns the cosine between the facet's normal and straight
/// down.
double uprightness_after_nudge(const MeshDesc& mesh, const StablePose& pose, DVec3 axis) {
  hooke::World world = hooke::World::create().value();
  REQUIRE(world.add_body({.shape = hooke::Shape::half_space()}).has_value());
  const auto id = world.add_mesh(mesh);
  REQUIRE(id.has_value());
  const auto turn = hooke::quaternion_about(axis, 1e-3) * pose.rotation;
  const auto body = world.add_body({.kind = hooke::BodyKind::kDynamic,
                                    .shape = hooke::Shape::hull_of(id.value()),
                                    .position = pose.position + DVec3{0, 1e-3, 0},
                                    .rotation = {Real(turn.x), Real(turn.y), Real(turn.z), Real(turn.w)}});
  REQUIRE(body.has_value());
  for (int i = 0; i < 120; ++i) world.step(Real(1) / 60);
  const hooke::Quat q = world.pose(body.value()).rotation;
  return -double(rotate(q, hooke::vector_cast<Real>(pose.normal)).y);
}

}  // namespace

TEST_SUITE_BEGIN("geometry/stable_poses");

TEST_CASE("a brick lies on each of six sides with the share of that side's solid angle") {
  const double a = 1;
  const double b = 2;
  const double c = 3;
  const StablePoses all = poses_of(hooke::test::make_box({0.5f, 1, 1.5f}));
  REQUIRE(all.poses.size() == 6);
  CHECK(sum_of(all) == Approx(1).epsilon(1e-14));
  CHECK(all.hull_error < 1e-6);
  // The center of the brick sees a side p x q at the distance r / 2 under 4 atan(p q / (r diagonal)).
  const auto share = [&](double p, double q, double r) {
    return std::atan(p * q / (r * std::sqrt(a * a + b * b + c * c))) / kPi;
  };
  for (const double sign : {-1.0, 1.0}) {
    CHECK(pose_on(all, {sign, 0, 0}).probability == Approx(share(b, c, a)).epsilon(1e-12));
    CHECK(pose_on(all, {0, sign, 0}).probability == Approx(share(c, a, b)).epsilon(1e-12));
    CHECK(pose_on(all, {0, 0, sign}).probability == Approx(share(a, b, c)).epsilon(1e-12));
  }
  CHECK(std::abs(all.poses[0].normal.x) == Approx(1));
  // On end, the brick tips over the shorter side of its base: its center rises to half a diagonal.
  const StablePose& on_end = pose_on(all, {0, 0, 1});
  CHECK(on_end.height == Approx(c / 2));
  CHECK(on_end.margin == Approx(a / 2));
  CHECK(on_end.tip_angle == Approx(std::atan(a / c)));
  CHECK(on_end.tip_height == Approx(std::hypot(a, c) / 2 - c / 2));
}

TEST_CASE("a regular tetrahedron lies on each side a quarter of the time, and tips at atan sqrt 2") {
  const StablePoses all = poses_of(make_tetrahedron());
  REQUIRE(all.poses.size() == 4);
  for (const StablePose& pose : all.poses) {
    CHECK(pose.probability == Approx(0.25).epsilon(1e-12));
    CHECK(pose.tip_angle == Approx(std::atan(std::sqrt(2.0))));
  }
}

TEST_CASE("a prism of 32 sides stands on its ends as often as they are seen from its center") {
  const int sides = 32;
  const double half_length = 0.3;
  const StablePoses all = poses_of(make_round_prism(sides, 0.5, half_length));
  REQUIRE(all.poses.size() == 34);
  // A pyramid over a regular polygon: 2 pi - 2 n asin(h sin(pi / n) / slant height).
  const double slant = std::hypot(half_length, 0.5 * std::cos(kPi / sides));
  const double angle = 2 * kPi - 2 * sides * std::asin(half_length * std::sin(kPi / sides) / slant);
  CHECK(pose_on(all, {0, 0, 1}).probability == Approx(angle / (4 * kPi)).epsilon(1e-6));
  CHECK(pose_on(all, {0, 0, -1}).probability == Approx(angle / (4 * kPi)).epsilon(1e-6));
  CHECK(all.poses.back().tip_angle == Approx(kPi / sides).epsilon(1e-4));
  CHECK(sum_of(all) == Approx(1).epsilon(1e-14));
}

TEST_CASE("a prism that leans too far rolls from its base onto its side, which gets the share of both") {
  const StablePoses all = poses_of(make_leaning_prism());
  REQUIRE(all.poses.size() == 4);
  const DVec3 side = normalize(DVec3{1, -1.5, 0});
  const StablePose& lying = pose_on(all, side);
  const double end = pose_on(all, {0, 0, 1}).probability;
  CHECK(pose_on(all, {0, 0, -1}).probability == Approx(end).epsilon(1e-6));
  CHECK(end == Approx(share_of_leaning_end()).epsilon(1e-5));
  CHECK(pose_on(all, -side).probability == Approx(lying.probability).epsilon(1e-6));
  CHECK(lying.probability == Approx(0.5 - end).epsilon(1e-6));
  // Seen along the side's normal the center is half a meter times cos(slope) from its middle.
  CHECK(lying.margin == Approx(std::sqrt(3.25) / 2 - 0.75 / std::sqrt(3.25)).epsilon(1e-6));
}

TEST_CASE("a prism that leans stands on its base if its center of mass is given low enough") {
  const MeshDesc leaning = make_leaning_prism();
  const auto weighted = find_stable_poses(leaning, DVec3{0.6, 0.2, 0});
  REQUIRE(weighted.has_value());
  CHECK(pose_on(weighted.value(), {0, -1, 0}).margin == Approx(0.4).epsilon(1e-6));
  CHECK(weighted.value().center == DVec3{0.6, 0.2, 0});
}

TEST_CASE("the placed solid touches the plane y = 0 with its facet, its center above the origin") {
  for (const MeshDesc& mesh : {make_leaning_prism(), hooke::test::make_ell(Real(0.2)), make_tetrahedron()}) {
    const StablePoses all = poses_of(mesh);
    for (const StablePose& pose : all.poses) {
      const DVec3 center = rotate(pose.rotation, all.center) + pose.position;
      CHECK(length(center - DVec3{0, pose.height, 0}) < 1e-12);
      for (const DVec3& corner : pose.support) {
        CHECK(std::abs((rotate(pose.rotation, corner) + pose.position).y) < 1e-5);
      }
      double lowest = 1;
      for (const Vec3& p : mesh.positions) {
        lowest = std::min(lowest, (rotate(pose.rotation, hooke::vector_cast<double>(p)) + pose.position).y);
      }
      CHECK(std::abs(lowest) < 1e-6);
    }
  }
}

TEST_CASE("a solid stays in each of its stable poses when it is lifted by 1 mm and turned by 1 mrad") {
  for (const MeshDesc& mesh : {hooke::test::make_box({0.5f, 1, 1.5f}), make_leaning_prism(),
                               make_tetrahedron(), make_round_prism(5, 0.5, 0.2)}) {
    for (const StablePose& pose : poses_of(mesh).poses) {
      CHECK(uprightness_after_nudge(mesh, pose, {1, 0, 0}) > 0.99999);
      CHECK(uprightness_after_nudge(mesh, pose, {0, 0, -1}) > 0.99999);
    }
  }
}

TEST_CASE("what has no center, or one outside, is refused with a cure") {
  MeshDesc open = hooke::test::make_box({1, 1, 1});
  open.triangles.pop_back();
  const auto without_center = find_stable_poses(open);
  REQUIRE_FALSE(without_center.has_value());
  CHECK(without_center.error().message.find("repair_solid") != std::string::npos);
  CHECK(find_stable_poses(open, DVec3{0, 0, 0}).has_value());

  const auto outside = find_stable_poses(open, DVec3{0, 1.5, 0});
  REQUIRE_FALSE(outside.has_value());
  CHECK(outside.error().where == "center");
  CHECK(outside.error().message.find("0.5") != std::string::npos);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(find_stable_poses(open, DVec3{0, nan, 0}).has_value());
  CHECK_FALSE(find_stable_poses({}).has_value());
}

TEST_SUITE_END();
