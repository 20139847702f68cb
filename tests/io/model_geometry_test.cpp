#include "io/model/model_geometry.h"

#include "geometry/meshes.h"
#include "io/model_support.h"

#include <doctest/doctest.h>
#include <numbers>
#include <set>

using hooke::DVec3;
using hooke::MeshDesc;
using hooke::Model;
using hooke::model_of;
using hooke::io::Triangle;
using hooke::io::triangulate;
using hooke::io_test::append;
using hooke::io_test::box;
using hooke::io_test::measure;
using hooke::io_test::sphere;
using hooke::io_test::turn_over;

namespace {

double signed_area(const std::vector<DVec3>& corners, const std::vector<Triangle>& triangles) {
  DVec3 sum = {};
  for (const Triangle& t : triangles) {
    sum += 0.5 * cross(corners[t[1]] - corners[t[0]], corners[t[2]] - corners[t[0]]);
  }
  return length(sum);
}

double total_area(const std::vector<DVec3>& corners, const std::vector<Triangle>& triangles) {
  double sum = 0.0;
  for (const Triangle& t : triangles) {
    sum += 0.5 * length(cross(corners[t[1]] - corners[t[0]], corners[t[2]] - corners[t[0]]));
  }
  return sum;
}

void check_triangulation(const std::vector<DVec3>& corners, double area) {
  const std::vector<Triangle> triangles = triangulate(corners);
  CHECK(triangles.size() == corners.size() - 2);
  CHECK(total_area(corners, triangles) == doctest::Approx(area));
  CHECK(signed_area(corners, triangles) == doctest::Approx(area));  // equal only if none is turned over
}

/// In a slanted plane, so that no axis is special.
DVec3 slanted(double x, double y) {
  return {x, 0.3 * x + y, 2 - 0.7 * y + 0.1 * x};
}

double slant() {
  return length(cross(slanted(1, 0) - slanted(0, 0), slanted(0, 1) - slanted(0, 0)));
}

double worst_normal_error_of_sphere(const Model& model) {
  double worst = 0.0;
  for (const auto& vertex : model.vertices) {
    const DVec3 p = {vertex.position[0], vertex.position[1], vertex.position[2]};
    const DVec3 n = {vertex.normal[0], vertex.normal[1], vertex.normal[2]};
    worst = std::max(worst, length(n - normalize(p)));
  }
  return worst;
}

}  // namespace

TEST_SUITE("io/model_geometry") {
  TEST_CASE("a comb, a star and a spiral keep their area when they are cut into triangles") {
    std::vector<DVec3> comb = {slanted(0, 0), slanted(12, 0)};
    for (int i = 12; i > 0; --i) {
      comb.push_back(slanted(i, 3));
      comb.push_back(slanted(i - 0.5, 1));
    }
    comb.push_back(slanted(0, 3));
    check_triangulation(comb, 24 * slant());

    std::vector<DVec3> star;
    for (int i = 0; i < 18; ++i) {
      const double r = i % 2 == 0 ? 1.0 : 0.2;
      star.push_back(slanted(r * std::cos(i * std::numbers::pi / 9), r * std::sin(i * std::numbers::pi / 9)));
    }
    check_triangulation(star, 9 * 0.2 * std::sin(std::numbers::pi / 9) * slant());

    std::vector<DVec3> spiral;  // 202 corners: above the number up to which the best ear is looked for
    double area = 0.0;
    for (int i = 0; i <= 100; ++i) {
      spiral.push_back(slanted((1 + 0.03 * i) * std::cos(0.15 * i), (1 + 0.03 * i) * std::sin(0.15 * i)));
    }
    for (int i = 100; i >= 0; --i) {
      spiral.push_back(slanted((1.1 + 0.03 * i) * std::cos(0.15 * i), (1.1 + 0.03 * i) * std::sin(0.15 * i)));
    }
    for (int i = 0; i < 100; ++i) {  // between rays i and i + 1: the larger sector less the smaller
      const double inner = (1 + 0.03 * i) * (1.03 + 0.03 * i);
      const double outer = (1.1 + 0.03 * i) * (1.13 + 0.03 * i);
      area += 0.5 * std::sin(0.15) * (outer - inner);
    }
    check_triangulation(spiral, area * slant());
  }

  TEST_CASE("corners in the middle of straight sides stay corners of triangles with height") {
    const std::vector<DVec3> corners = {{0, 0, 0},   {2, 0, 0}, {2, 1, 0}, {1, 1, 0},
                                        {1, 1.5, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}};
    check_triangulation(corners, 3);
    for (const Triangle& t : triangulate(corners))
      CHECK_FALSE(hooke::geometry::is_degenerate(corners, t, 1e-9));
  }

  TEST_CASE("polygons that cross themselves or have no area give triangles and no crash") {
    CHECK(triangulate(std::vector<DVec3>{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).size() == 2);
    CHECK(triangulate(std::vector<DVec3>(7, DVec3{1, 2, 3})).size() == 5);
    CHECK(triangulate(std::vector<DVec3>{{0, 0, 0}, {1, 1, 0}}).empty());
  }

  TEST_CASE("points within the distance are one, and across a cell border, too") {
    const double d = 1e-3;
    std::vector<DVec3> points;
    for (int i = 0; i < 1000; ++i) {
      const double x = 0.0137 * i;  // every position in a cell comes up
      points.push_back({x, 0, 0});
      points.push_back({x + 0.9 * d, -0.9 * d, 0.9 * d});
    }
    const hooke::geometry::Weld weld = hooke::geometry::weld(points, d);
    CHECK(weld.first.size() == 1000);
    for (std::size_t i = 0; i < points.size(); ++i) CHECK(weld.welded_of[i] == i / 2);
  }

  TEST_CASE("a box turned inside out is turned back, and a box with one wrong triangle is repaired") {
    MeshDesc inside_out = box({1, 2, 3});
    turn_over(inside_out);
    CHECK(measure(model_of(inside_out).mesh).volume == doctest::Approx(48));

    MeshDesc mixed = box({1, 2, 3});
    std::swap(mixed.triangles[5][0], mixed.triangles[5][1]);
    const auto repaired = measure(model_of(mixed).mesh);
    CHECK(repaired.volume == doctest::Approx(48));
    CHECK(repaired.open_edges == 0);
  }

  TEST_CASE("a cavity stays a cavity whichever way the file winds both shells") {
    MeshDesc hollow = box({2, 2, 2});
    MeshDesc cavity = box({1, 1, 1});
    turn_over(cavity);
    append(hollow, cavity);
    CHECK(measure(model_of(hollow).mesh).volume == doctest::Approx(64 - 8));
    turn_over(hollow);
    CHECK(measure(model_of(hollow).mesh).volume == doctest::Approx(64 - 8));
  }

  TEST_CASE("two boxes side by side are judged one by one") {
    MeshDesc pair = box({1, 1, 1}, {-3, 0, 0});
    MeshDesc other = box({1, 1, 1}, {3, 0, 0});
    turn_over(other);
    append(pair, other);
    CHECK(measure(model_of(pair).mesh).volume == doctest::Approx(16));
  }

  TEST_CASE("an open sheet keeps its winding") {
    MeshDesc sheet;
    sheet.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    sheet.triangles = {{0, 2, 1}, {0, 3, 2}};
    const Model model = model_of(sheet);
    for (const auto& vertex : model.vertices) CHECK(vertex.normal[2] == doctest::Approx(-1));
  }

  TEST_CASE("an open sheet with a few triangles flipped is turned as the most of them are") {
    MeshDesc sheet = hooke::test::make_grid(6, 6, 1);
    const MeshDesc good = sheet;
    for (std::size_t t = 0; t < 50; t += 4)
      std::swap(sheet.triangles[t][1], sheet.triangles[t][2]);  // also the first
    const Model model = model_of(sheet);
    REQUIRE(model.mesh.triangles.size() == 50);
    for (const auto& vertex : model.vertices) CHECK(vertex.normal[2] == doctest::Approx(1));
    for (const auto& [a, b, c] : model.mesh.triangles) {
      const auto& p = model.mesh.positions;
      CHECK(cross(p[b] - p[a], p[c] - p[a]).z > 0);
    }
    // Of two sheets that do not touch each has its own say.
    for (const auto& t : good.triangles) sheet.triangles.push_back({t[0] + 36, t[2] + 36, t[1] + 36});
    for (const hooke::Vec3 p : good.positions) sheet.positions.push_back(p + hooke::Vec3{0, 0, 2});
    for (const auto& vertex : model_of(sheet).vertices)
      CHECK(vertex.normal[2] == doctest::Approx(vertex.position[2] > 1 ? -1 : 1));
  }

  TEST_CASE("a box is flat-shaded, a fine sphere is smooth, and crease zero makes it flat") {
    const Model cube = model_of(box({1, 1, 1}));
    CHECK(cube.vertices.size() == 24);
    CHECK(cube.mesh.positions.size() == 8);
    CHECK(cube.indices.size() == 36);
    REQUIRE(cube.parts.size() == 1);
    CHECK(cube.materials.size() == 1);

    const MeshDesc ball = sphere(0.5, 24, 48);
    const Model smooth = model_of(ball);
    CHECK(smooth.vertices.size() == ball.positions.size());
    CHECK(worst_normal_error_of_sphere(smooth) < 0.01);
    const Model flat = model_of(ball, 0.0);
    CHECK(flat.vertices.size() > 3 * ball.positions.size());
    CHECK(worst_normal_error_of_sphere(flat) > 0.05);
  }

  TEST_CASE("seams weld, and every drawn vertex knows its simulated one") {
    MeshDesc split;  // each triangle with corners of its own
    const MeshDesc whole = box({1, 1, 1}, {100, 0, 0});
    for (const auto& t : whole.triangles) {
      const auto base = static_cast<std::uint32_t>(split.positions.size());
      for (const std::uint32_t i : t) split.positions.push_back(whole.positions[i]);
      split.triangles.push_back({base, base + 1, base + 2});
    }
    split.triangles.push_back({0, 0, 1});
    const Model model = model_of(split);
    CHECK(model.mesh.positions.size() == 8);
    CHECK(model.mesh.triangles.size() == 12);
    REQUIRE(model.welded_of.size() == model.vertices.size());
    for (std::size_t i = 0; i < model.vertices.size(); ++i) {
      const auto& p = model.vertices[i].position;
      CHECK(model.mesh.positions[model.welded_of[i]] == hooke::Vec3{p[0], p[1], p[2]});
    }
  }

  TEST_CASE("bad indices and coordinates that are not finite are left out, down to nothing") {
    MeshDesc bad = box({1, 1, 1});
    bad.positions.push_back({std::numeric_limits<hooke::Real>::quiet_NaN(), 0, 0});
    bad.triangles.push_back({0, 1, 8});
    bad.triangles.push_back({0, 1, 4000000000u});
    CHECK(model_of(bad).mesh.triangles.size() == 12);
    CHECK(model_of({}).indices.empty());
    CHECK(model_of({}).materials.size() == 1);
  }
}
