#include "elements/tetrahedron.h"

#include "geometry/solid/tetrahedral_mesh.h"
#include "math/random.h"

#include <cmath>
#include <doctest/doctest.h>
#include <random>
#include <vector>

namespace hooke::elements {

namespace {

using DMat3 = Matrix3<double>;

DMat3 diagonal(double x, double y, double z) {
  return {{x, 0, 0}, {0, y, 0}, {0, 0, z}};
}

double largest(const DMat3& m) {
  return std::sqrt(contract(m, m));
}

/// A deformation with no symmetry, mirrored for `sign` -1.
DMat3 skewed(double sign) {
  return {{1.2 * sign, 0.3, -0.1}, {0.2, 0.9, 0.4}, {-0.3, 0.1, 1.1}};
}

Quaternion<double> some_turn() {
  return normalize(Quaternion<double>{0.3, -0.5, 0.2, 0.7});
}

}  // namespace

TEST_SUITE("elements/tetrahedron") {
  TEST_CASE("at small strain the material has its Young's modulus and Poisson's ratio") {
    for (const double nu : {0.0, 0.2, 0.3, 0.45, 0.499}) {
      const NeoHookean<double> material = neo_hookean(2e5, nu);
      const double e = 1e-6;
      const DMat3 p = stress(diagonal(1 + e, 1 - nu * e, 1 - nu * e), material);
      // The lateral stress is what is left of two terms of size lambda e: of second order.
      CHECK(p.x.x == doctest::Approx(2e5 * e).epsilon(1e-3));
      CHECK(std::abs(p.y.y) < 1e-3 * 2e5 * e);
      CHECK(std::abs(p.z.z) < 1e-3 * 2e5 * e);
    }
  }

  TEST_CASE("a pulled bar narrows by the law of stable neo-Hookean matter at any stretch") {
    const NeoHookean<double> m = neo_hookean(1e5, 0.4);
    for (const double s : {0.6, 0.9, 1.5, 3.0}) {
      // Lateral stress mu t + (lambda (s t^2 - 1) - mu) s t = 0 gives t^2 = ((lambda + mu) s - mu) / (lambda
      // s^2).
      const double t = std::sqrt(((m.volume + m.shear) * s - m.shear) / (m.volume * s * s));
      const DMat3 p = stress(diagonal(s, t, t), m);
      CHECK(std::abs(p.y.y) < 1e-9 * m.shear);
      CHECK(p.x.x == doctest::Approx(m.shear * (s - t * t / s)).epsilon(1e-9));
      // A sheet between plates: A / A_0 = (lambda + mu) s^2 / (mu + lambda s^2) (V71).
      const double across = (m.volume + m.shear) * s / (m.shear + m.volume * s * s);
      CHECK(std::abs(stress(diagonal(s, across, 1), m).y.y) < 1e-9 * m.shear);
    }
  }

  TEST_CASE("the stress is the gradient of the energy, inside out as well") {
    const NeoHookean<double> material = neo_hookean(1e5, 0.45);
    for (const double sign : {1.0, -1.0}) {
      const DMat3 f = skewed(sign);
      const DMat3 p = stress(f, material);
      const double d = 1e-6;
      const Vector3<double>* columns[] = {&p.x, &p.y, &p.z};
      for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) {
          DMat3 step = {{}, {}, {}};
          Vector3<double>& column = c == 0 ? step.x : c == 1 ? step.y : step.z;
          (r == 0 ? column.x : r == 1 ? column.y : column.z) = d;
          const double slope =
              (energy_density(f + step, material) - energy_density(f - step, material)) / (2 * d);
          const double exact = r == 0 ? columns[c]->x : r == 1 ? columns[c]->y : columns[c]->z;
          CHECK(slope == doctest::Approx(exact).epsilon(1e-6));
        }
      }
    }
  }

  TEST_CASE("a turned solid has no energy and no stress; a stretched one has more in no direction less") {
    const NeoHookean<double> material = neo_hookean(1e5, 0.45);
    const DMat3 turn = matrix_of(some_turn());
    CHECK(std::abs(energy_density(turn, material)) < 1e-10 * material.volume);
    CHECK(largest(stress(turn, material)) < 1e-10 * material.volume);
    const DMat3 f = skewed(1);
    CHECK(energy_density(turn * f, material) == doctest::Approx(energy_density(f, material)).epsilon(1e-12));
    CHECK(energy_density(f, material) > 0);
    CHECK(energy_density(diagonal(0, 0, 0), material) > 0);
    CHECK(energy_density(diagonal(-1, 1, 1), material) > 0);
  }

  TEST_CASE("shape functions give back the deformation they are asked about") {
    const std::array<DVec3, 4> x = {DVec3{0, 0, 0}, DVec3{2, 0, 0}, DVec3{0, 3, 0}, DVec3{0, 0, 4}};
    const TetrahedronRest<double> rest = tetrahedron_rest(x);
    CHECK(rest.volume == doctest::Approx(4));
    std::array<DVec3, 4> moved;
    const DMat3 f = skewed(1);
    for (int i = 0; i < 4; ++i) moved[i] = DVec3{7, -5, 3} + f * x[i];
    CHECK(largest(gradient_of(moved, rest.b) - f) < 1e-12);
    CHECK(tetrahedron_rest(std::array<DVec3, 4>{x[0], x[2], x[1], x[3]}).volume == doctest::Approx(-4));
    const TetrahedronRest<double> flat = tetrahedron_rest(std::array<DVec3, 4>{x[0], x[1], x[2], x[0]});
    CHECK(flat.volume == 0);
    CHECK(flat.b[1] == DVec3{});
  }

  TEST_CASE("patch test: in an irregular mesh, evenly strained, no inner point feels a force (V73)") {
    geometry::CellGrid grid = {.counts = {3, 3, 3}, .filled = std::vector<std::uint8_t>(27, 1)};
    geometry::TetrahedralMesh mesh = geometry::fill_cells(grid);
    const auto inner = [](DVec3 p) { return p.x > 0 && p.x < 3 && p.y > 0 && p.y < 3 && p.z > 0 && p.z < 3; };
    std::mt19937_64 random(5);
    for (DVec3& p : mesh.points) {
      if (inner(p)) p += 0.1 * test::random_vector(random);
    }
    const NeoHookean<double> material = neo_hookean(1.0, 0.3);
    const DMat3 f = skewed(1);
    std::vector<DVec3> force(mesh.points.size());
    double size = 0;
    for (const geometry::Tetrahedron& t : mesh.tetrahedra) {
      std::array<DVec3, 4> x, moved;
      for (int i = 0; i < 4; ++i) {
        x[i] = mesh.points[t[i]];
        moved[i] = f * x[i];
      }
      const TetrahedronRest<double> rest = tetrahedron_rest(x);
      const DMat3 p = stress(gradient_of(moved, rest.b), material);
      for (int i = 0; i < 4; ++i) {
        force[t[i]] -= rest.volume * (p * rest.b[i]);
        size = std::max(size, length(rest.volume * (p * rest.b[i])));
      }
    }
    double worst = 0;
    int count = 0;
    for (std::size_t i = 0; i < force.size(); ++i) {
      if (!inner(mesh.points[i])) continue;
      worst = std::max(worst, length(force[i]));
      ++count;
    }
    CHECK(count == 8 + 27);
    CHECK(worst < 1e-13 * 24 * size);
  }
}

}  // namespace hooke::elements
