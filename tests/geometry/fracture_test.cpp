/// Solids divided into cells: what is conserved, what cells share, and what is refused.

#include "hooke/fracture.h"

#include "geometry/convex/convex_hull.h"
#include "geometry/meshes.h"
#include "geometry/solids.h"
#include "geometry/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <doctest/doctest.h>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace hooke {

using namespace test;

namespace {

MeshDesc mesh_of(const SolidMesh& solid) {
  MeshDesc mesh = {.triangles = solid.triangles};
  for (const DVec3& p : solid.positions) mesh.positions.push_back(vector_cast<Real>(p));
  return mesh;
}

MeshDesc box_mesh(DVec3 lower, DVec3 upper) {
  return mesh_of(make_box(lower, upper));
}

double volume_of(const MeshDesc& mesh) {
  return test::volume_of(geometry::solid_mesh_of(mesh));
}

double volume_of(const Fracture& fracture) {
  double sum = 0;
  for (const FractureCell& cell : fracture.cells) sum += cell.volume;
  return sum;
}

/// Largest distance of a corner over the plane of a triangle, over the size of the cell.
double concavity_of(const MeshDesc& mesh) {
  double largest = 0;
  double size = 0;
  for (const Vec3& p : mesh.positions) size = std::max(size, static_cast<double>(length(p)));
  for (const auto& t : mesh.triangles) {
    const auto a = vector_cast<double>(mesh.positions[t[0]]);
    const DVec3 across =
        cross(vector_cast<double>(mesh.positions[t[1]]) - a, vector_cast<double>(mesh.positions[t[2]]) - a);
    if (length(across) < 1e-4 * size * size) continue;  // Its normal is not known.
    for (const Vec3& p : mesh.positions)
      largest = std::max(largest, dot(normalize(across), vector_cast<double>(p) - a) / size);
  }
  return largest;
}

/// Area of the inner faces of a cell.
double inner_area(const FractureCell& cell) {
  double sum = 0;
  for (std::size_t t = 0; t < cell.mesh.triangles.size(); ++t) {
    if (cell.across[t] == FractureCell::kSurface) continue;
    const auto& [a, b, c] = cell.mesh.triangles[t];
    const auto corner = [&](std::uint32_t v) { return vector_cast<double>(cell.mesh.positions[v]); };
    sum += 0.5 * length(cross(corner(b) - corner(a), corner(c) - corner(a)));
  }
  return sum;
}

double bond_area(const Fracture& fracture) {
  double sum = 0;
  for (const FractureBond& bond : fracture.bonds) sum += bond.area;
  return sum;
}

std::string where_of(const Result<Fracture>& result) {
  return result ? std::string() : result.error().where;
}

}  // namespace

TEST_SUITE("geometry/fracture") {
  TEST_CASE("cells of a convex solid are closed and convex, and their volumes sum to that of the solid") {
    const MeshDesc solids[] = {box_mesh({-1, -0.5, -0.01}, {1, 0.5, 0.01}), make_sphere(3),
                               box_mesh({1000, 0, 0}, {1001, 2, 3})};
    for (const MeshDesc& solid : solids) {
      for (const int count : {1, 2, 7, 150}) {
        const Fracture pieces = fracture(solid, {.cells = count, .seed = 7, .least_face = 0}).value();
        CAPTURE(count);
        CHECK(pieces.cells.size() + pieces.merged == static_cast<std::size_t>(count));
        CHECK(volume_of(pieces) == doctest::Approx(volume_of(solid)).epsilon(1e-12));
        double inner = 0;
        for (const FractureCell& cell : pieces.cells) {
          CHECK(cell.is_convex);
          CHECK(geometry::validate_solid(cell.mesh).has_value());
          CHECK(cell.across.size() == cell.mesh.triangles.size());
          CHECK(volume_of(cell.mesh) == doctest::Approx(cell.volume).epsilon(1e-4));
          CHECK(concavity_of(cell.mesh) < 1e-3);
          inner += inner_area(cell);
        }
        // Each inner face belongs to two cells.
        CHECK(inner == doctest::Approx(2 * bond_area(pieces)).epsilon(1e-4));
      }
    }
  }

  TEST_CASE("a bar cut across its length has bonds of its section, with the section modulus b h^2 / 6") {
    const MeshDesc bar = box_mesh({0, -0.1, -0.15}, {2, 0.1, 0.15});
    const Fracture pieces =
        fracture(bar, {.seeds = {{0.25, 0, 0}, {0.75, 0, 0}, {1.25, 0, 0}, {1.75, 0, 0}}}).value();
    REQUIRE(pieces.cells.size() == 4);
    REQUIRE(pieces.bonds.size() == 3);
    for (std::uint32_t i = 0; i < 3; ++i) {
      const FractureBond& bond = pieces.bonds[i];
      CHECK(bond.a == i);
      CHECK(bond.b == i + 1);
      CHECK(bond.area == doctest::Approx(0.2 * 0.3).epsilon(1e-6));
      CHECK(bond.section_modulus == doctest::Approx(0.3 * 0.2 * 0.2 / 6).epsilon(1e-6));
      CHECK(length(bond.center - DVec3{0.5 * (i + 1), 0, 0}) < 1e-6);
      CHECK(length(bond.normal - DVec3{1, 0, 0}) < 1e-9);
      CHECK(length(pieces.cells[i].center - DVec3{0.25 + 0.5 * i, 0, 0}) < 1e-6);
    }
  }

  TEST_CASE("the section modulus is that of the textbook: a square, and a rectangle that lies askew") {
    const auto modulus = [](double angle, double width, double height) {
      SolidMesh bar = make_box({-1, -0.5 * width, -0.5 * height}, {1, 0.5 * width, 0.5 * height});
      bar = moved(std::move(bar), {std::sin(0.5 * angle), 0, 0, std::cos(0.5 * angle)}, 1, {});
      const Fracture halves = fracture(mesh_of(bar), {.seeds = {{-0.5, 0, 0}, {0.5, 0, 0}}}).value();
      REQUIRE(halves.bonds.size() == 1);
      return halves.bonds[0].section_modulus;
    };
    for (const double angle : {0.0, 0.3, 0.7853981633974483, 2.0}) {
      CHECK(modulus(angle, 0.3, 0.3) == doctest::Approx(0.0045).epsilon(1e-5));
      CHECK(modulus(angle, 0.1, 0.4) == doctest::Approx(0.4 * 0.01 / 6).epsilon(1e-5));
    }
  }

  TEST_CASE("every place of a cell is nearer to its seed than to any other") {
    std::vector<DVec3> seeds;
    for (int i = 0; i < 30; ++i)
      seeds.push_back({0.31 * (i % 3) - 0.3, 0.2 * (i % 5) - 0.4 + 0.01 * i, 0.03 * i - 0.4});
    const Fracture pieces =
        fracture(box_mesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}), {.seeds = seeds, .least_share = 0}).value();
    REQUIRE(pieces.cells.size() == seeds.size());
    for (const FractureCell& cell : pieces.cells) {
      for (const Vec3& corner : cell.mesh.positions) {
        const DVec3 place = cell.center + vector_cast<double>(corner);
        double least = 1e9;
        for (const DVec3& seed : seeds) least = std::min(least, length(place - seed));
        CHECK(length(place - seeds[cell.seed]) < least + 1e-6);
      }
    }
  }

  TEST_CASE("the surfaces of what two cells share are the same, seen from both sides") {
    const Fracture pieces = fracture(make_sphere(2), {.cells = 40}).value();
    for (const FractureBond& bond : pieces.bonds) {
      CHECK(bond.a < bond.b);
      CHECK(length(bond.normal) == doctest::Approx(1));
      CHECK(dot(bond.normal, pieces.cells[bond.b].center - pieces.cells[bond.a].center) > 0);
    }
    CHECK(std::is_sorted(pieces.bonds.begin(), pieces.bonds.end(), [](const auto& x, const auto& y) {
      return std::pair(x.a, x.b) < std::pair(y.a, y.b);
    }));
  }

  TEST_CASE("a solid that is not convex is divided exactly, and what a cell has in two pieces is two cells") {
    // A U: its two arms belong to one cell, whose seed lies between them.
    const SolidMesh block = make_box({-1, -1, -0.5}, {1, 1, 0.5});
    const SolidMesh gap = make_box({-0.5, -0.5, -1}, {0.5, 2, 1});
    const auto shape = geometry::combine_solids(block, gap, SolidOperation::kDifference).value();
    const Fracture pieces = fracture(mesh_of(shape), {.seeds = {{0, -0.9, 0}, {0, 0.7, 0}}}).value();
    REQUIRE(pieces.cells.size() == 3);
    CHECK(pieces.cells[0].seed == 0);
    CHECK(pieces.cells[1].seed == 1);
    CHECK(pieces.cells[2].seed == 1);
    CHECK_FALSE(pieces.cells[0].is_convex);
    CHECK(pieces.cells[1].is_convex);
    CHECK(volume_of(pieces) == doctest::Approx(3.0 - 0.5).epsilon(1e-10));
    REQUIRE(pieces.bonds.size() == 2);
    for (const FractureBond& bond : pieces.bonds) {
      CHECK(bond.a == 0);
      CHECK(bond.area == doctest::Approx(0.5));
      CHECK(bond.section_modulus == doctest::Approx(0.5 * 0.5 / 6).epsilon(1e-5));
    }
  }

  TEST_CASE("rings, and stars with dents, are divided without loss") {
    std::mt19937 random(3);
    const SolidMesh solids[] = {make_ring(24, 0.6, 1, 0.2), make_star(2, 0.6, random), make_corner()};
    for (const SolidMesh& solid : solids) {
      const Fracture pieces = fracture(mesh_of(solid), {.cells = 20, .seed = 5, .least_face = 0}).value();
      CHECK(pieces.cells.size() + pieces.merged >= 20);
      CHECK(volume_of(pieces) == doctest::Approx(volume_of(mesh_of(solid))).epsilon(1e-10));
      double inner = 0;
      for (const FractureCell& cell : pieces.cells) {
        CHECK(geometry::validate_solid(cell.mesh).has_value());
        inner += inner_area(cell);
      }
      CHECK(inner == doctest::Approx(2 * bond_area(pieces)).epsilon(1e-4));
    }
  }

  TEST_CASE("cells crowd about an impact, and grow with the distance from it") {
    const MeshDesc pane = box_mesh({-1, -1, -0.005}, {1, 1, 0.005});
    const Fracture pieces = fracture(pane, {.cells = 200, .impact = DVec3{0.3, 0.2, 0.005}}).value();
    double near = 0;
    double far = 0;
    int near_count = 0;
    int far_count = 0;
    for (const FractureCell& cell : pieces.cells) {
      const double distance = length(cell.center - DVec3{0.3, 0.2, 0});
      (distance < 0.2 ? near : far) += cell.volume;
      ++(distance < 0.2 ? near_count : far_count);
    }
    REQUIRE(near_count > 0);
    REQUIRE(far_count > 0);
    CHECK(near_count > 50);
    CHECK(far / far_count > 10 * near / near_count);
    CHECK(volume_of(pieces) == doctest::Approx(volume_of(pane)).epsilon(1e-12));
  }

  TEST_CASE("faces that are small for their cells are no bonds, and every cell keeps its largest one") {
    const Fracture all = fracture(make_sphere(2), {.cells = 60, .least_face = 0}).value();
    const Fracture some = fracture(make_sphere(2), {.cells = 60, .least_face = 0.5}).value();
    CHECK(all.unbonded_share == 0);
    CHECK(bond_area(some) == doctest::Approx((1 - some.unbonded_share) * bond_area(all)).epsilon(1e-12));
    CHECK(some.unbonded_share > 0.01);
    CHECK(some.unbonded_share < 0.4);
    std::vector<double> largest(all.cells.size(), 0);
    std::vector<double> kept(all.cells.size(), 0);
    const auto note = [](const Fracture& pieces, std::vector<double>& area) {
      for (const FractureBond& bond : pieces.bonds) {
        for (const std::uint32_t cell : {bond.a, bond.b}) area[cell] = std::max(area[cell], bond.area);
      }
    };
    note(all, largest);
    note(some, kept);
    CHECK(largest == kept);
  }

  TEST_CASE("small cells, empty ones and seeds at one place are merged, and counted") {
    const MeshDesc box = box_mesh({0, 0, 0}, {1, 1, 1});
    const std::vector<DVec3> seeds = {
        {0.2, 0.5, 0.5}, {0.2, 0.5, 0.5}, {0.8, 0.5, 0.5}, {0.999, 0.5, 0.5}, {5, 5, 5}};
    const Fracture all = fracture(box, {.seeds = seeds, .least_share = 0}).value();
    CHECK(all.cells.size() == 3);
    CHECK(all.merged == 2);
    const Fracture few =
        fracture(box, {.seeds = {{0.2, 0.5, 0.5}, {0.8, 0.5, 0.5}, {0.8, 0.999, 0.5}, {1.2, 0.999, 0.5}},
                       .least_share = 0.5})
            .value();
    CHECK(few.merged == 1);
    CHECK(volume_of(few) == doctest::Approx(1).epsilon(1e-12));
    // However many seeds lie outside, one cell is left.
    const Fracture one = fracture(box, {.seeds = {{7, 0, 0}, {8, 0, 0}}}).value();
    CHECK(one.cells.size() == 1);
    CHECK(one.cells[0].seed == 0);
    CHECK(one.bonds.empty());
    CHECK(volume_of(one) == doctest::Approx(1).epsilon(1e-12));
  }

  TEST_CASE("random hulls are divided without loss, also where many cells meet in one corner") {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> number(-1, 1);
    for (int trial = 0; trial < 60; ++trial) {
      const double scale = trial % 3 == 0 ? 1e-3 : trial % 3 == 1 ? 1 : 1e3;
      std::vector<Vec3> points;
      for (int i = 0; i < 24; ++i) {
        const double y = (trial % 2 == 0 ? 1 : 0.02) * number(random);
        points.push_back(vector_cast<Real>(scale * DVec3{number(random), y, number(random)}));
      }
      const MeshDesc hull = geometry::mesh_of(geometry::make_convex_hull(points).value());
      FractureDesc desc = {.cells = 40, .seed = static_cast<std::uint32_t>(trial)};
      // Eight cells meet wherever seeds form a grid.
      for (int i = 0; i < 64 && trial % 4 == 0; ++i)
        desc.seeds.push_back(0.5 * scale * DVec3{i % 4 - 1.5, i / 4 % 4 - 1.5, i / 16 - 1.5});
      const Fracture pieces = fracture(hull, desc).value();
      CAPTURE(trial);
      CHECK(volume_of(pieces) == doctest::Approx(volume_of(hull)).epsilon(1e-9));
      for (const FractureCell& cell : pieces.cells) CHECK(geometry::validate_solid(cell.mesh).has_value());
    }
  }

  TEST_CASE("the same description gives the same bits, and another seed other cells") {
    const auto bits = [](std::uint32_t seed) {
      const Fracture pieces =
          fracture(make_sphere(2), {.cells = 30, .seed = seed, .impact = DVec3{0, 0, 0.9}}).value();
      std::vector<double> numbers;
      for (const FractureCell& cell : pieces.cells) {
        numbers.insert(numbers.end(), {cell.volume, cell.center.x, cell.center.y, cell.center.z});
      }
      for (const FractureBond& bond : pieces.bonds)
        numbers.insert(numbers.end(), {bond.area, bond.section_modulus});
      return numbers;
    };
    const std::vector<double> once = bits(4);
    const std::vector<double> again = bits(4);
    REQUIRE(once.size() == again.size());
    CHECK(std::memcmp(once.data(), again.data(), once.size() * sizeof(double)) == 0);
    CHECK(once != bits(5));
  }

  TEST_CASE("what cannot be divided is refused with its place") {
    const MeshDesc box = box_mesh({0, 0, 0}, {1, 1, 1});
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    CHECK(where_of(fracture(box, {.cells = 0})) == "cells");
    CHECK(where_of(fracture(box, {.cells = -3})) == "cells");
    CHECK(where_of(fracture(box, {.cells = 4097})) == "cells");
    CHECK(where_of(fracture(box, {.seeds = {{0.5, kNan, 0.5}}})) == "seeds");
    CHECK(where_of(fracture(box, {.impact = DVec3{kNan, 0, 0}})) == "impact");
    CHECK(where_of(fracture(box, {.impact = DVec3{100, 0, 0}})) == "impact");
    CHECK(where_of(fracture(box, {.impact_radius = kNan})) == "impact_radius");
    CHECK(where_of(fracture(box, {.least_share = 0.6})) == "least_share");
    CHECK(where_of(fracture(box, {.least_share = kNan})) == "least_share");
    CHECK(where_of(fracture(box, {.least_face = kNan})) == "least_face");
    CHECK(where_of(fracture(box, {.least_face = -1})) == "least_face");
    MeshDesc open = box;
    open.triangles.pop_back();
    CHECK_FALSE(fracture(open, {}).has_value());
    CHECK_FALSE(fracture(mesh_of(inside_out(make_box({0, 0, 0}, {1, 1, 1}))), {}).has_value());
    CHECK_FALSE(fracture(box_mesh({0, 0, 0}, {1, 1, 0}), {}).has_value());
    CHECK_FALSE(fracture({}, {}).has_value());
  }
}

}  // namespace hooke
