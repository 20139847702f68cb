#include "render/bounding_lines.h"

#include "render/shapes.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <vector>

using hooke::Mat4;
using hooke::Preselection;
using hooke::Quat;
using hooke::Vec3;
using hooke::render::add_bounding_lines;
using hooke::render::bounding_volume_named;
using hooke::render::DrawLine;
using hooke::render::MeshGeometry;

namespace {

std::vector<DrawLine> lines_of(const MeshGeometry& mesh, const Mat4& body, Preselection kind) {
  std::vector<DrawLine> lines;
  add_bounding_lines(mesh, Mat4{}, body, kind, lines);
  return lines;
}

/// The farthest end of a line along x.
float reach(const std::vector<DrawLine>& lines) {
  float farthest = -1e9F;
  for (const DrawLine& line : lines) farthest = std::max({farthest, line.from.x, line.to.x});
  return farthest;
}

}  // namespace

TEST_SUITE("render/bounding_lines") {
  TEST_CASE("a box along the axes grows as the body turns, an oriented one turns with it") {
    const MeshGeometry box = hooke::render::make_box({1, 2, 3});
    const Quat turn = hooke::quaternion_about(Vec3{0, 0, 1}, 0.5F);
    const Mat4 body = make_transform(Vec3{10, 0, 0}, turn, Vec3{1, 1, 1});
    const float corner = std::cos(0.5F) + 2 * std::sin(0.5F);  // of the turned box, along x
    const auto along_axes = lines_of(box, body, Preselection::kBox);
    REQUIRE(along_axes.size() == 12);
    CHECK(reach(along_axes) == doctest::Approx(10 + corner));
    for (const DrawLine& line : along_axes) {
      const Vec3 way = line.to - line.from;
      CHECK((way.x != 0) + (way.y != 0) + (way.z != 0) == 1);
    }
    const auto oriented = lines_of(box, body, Preselection::kOrientedBox);
    REQUIRE(oriented.size() == 12);
    float total = 0;
    for (const DrawLine& line : oriented) total += length(line.to - line.from);
    CHECK(total == doctest::Approx(4 * (2 + 4 + 6)));
    CHECK(reach(oriented) == doctest::Approx(10 + corner));
  }

  TEST_CASE("spheres are three circles around the body, wherever it is") {
    const MeshGeometry box = hooke::render::make_box({1, 2, 2});
    for (const auto kind : {Preselection::kSphere, Preselection::kVertexSphere}) {
      const auto lines = lines_of(box, make_transform(Vec3{5, 6, 7}, Quat{}, Vec3{1, 1, 1}), kind);
      CHECK(lines.size() == 3 * 48);
      for (const DrawLine& line : lines) CHECK(length(line.from - Vec3{5, 6, 7}) == doctest::Approx(3));
    }
  }

  TEST_CASE("trees are eight volumes, of few triangles fewer; nothing has none") {
    const MeshGeometry ball = hooke::render::make_sphere(2);
    CHECK(lines_of(ball, Mat4{}, Preselection::kBoxTree).size() == 8 * 12);
    CHECK(lines_of(ball, Mat4{}, Preselection::kOrientedBoxTree).size() == 8 * 12);
    CHECK(lines_of(ball, Mat4{}, Preselection::kSphereTree).size() == 8 * 3 * 48);
    MeshGeometry two = ball;
    two.indices.resize(6);
    CHECK(lines_of(two, Mat4{}, Preselection::kBoxTree).size() == 12);
    CHECK(lines_of(ball, Mat4{}, Preselection::kAllPairs).empty());
    for (const auto kind : hooke::kPreselections) CHECK(lines_of({}, Mat4{}, kind).empty());
  }

  TEST_CASE("volumes have names") {
    CHECK(bounding_volume_named("box") == Preselection::kBox);
    CHECK(bounding_volume_named("oriented_box_tree") == Preselection::kOrientedBoxTree);
    CHECK_FALSE(bounding_volume_named("all_pairs").has_value());
    CHECK_FALSE(bounding_volume_named("").has_value());
  }
}
