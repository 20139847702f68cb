#include "solver/solid/tetrahedron_solve.h"

#include "elements/tetrahedron.h"
#include "geometry/solid/tetrahedral_mesh.h"
#include "math/random.h"
#include "solver/pass_rows.h"
#include "solver/solid/stiff_solution.h"
#include "solver/target_bits.h"

#include <cmath>
#include <doctest/doctest.h>
#include <random>

namespace hooke::solver {

namespace {

struct Jelly {
  state::Particles particles;
  state::Tetrahedra tetrahedra;
  TetrahedronBlocks rows;

  void solve() {
    const auto pass = [&](auto kernel) {
      for (const TetrahedronPass& of : rows.passes) kernel(rows, of, {of.first, of.end}, particles);
    };
    if (!rows.any_stiff) return pass(solve_tetrahedra);
    begin_stiff_solution(rows);
    pass(linearize_tetrahedra);
    TetrahedronBlocks* const part[] = {&rows};
    StiffSystem system = {.parts = part, .rows = {}, .ties = {}};
    while (sharpen(system)) continue;
    begin_directions(particles, system, pass);
    follow_directions(system, pass);
    finish_stiff_solution(is_solved(system), rows, particles);
  }

  /// One substep without other forces.
  void step(Real h) {
    prepare_tetrahedra(rows, h);
    for (const TetrahedronPass& pass : rows.passes)
      damp_tetrahedra(rows, pass, {pass.first, pass.end}, particles);
    solve();
    for (std::size_t i = 0; i < particles.position.size(); ++i)
      particles.position[i].x += h * particles.velocity[i].v;
  }

  [[nodiscard]] DVec3 momentum() const {
    DVec3 sum;
    for (std::size_t i = 0; i < particles.mass.size(); ++i)
      sum += static_cast<double>(particles.mass[i]) * vector_cast<double>(particles.velocity[i].v);
    return sum;
  }

  [[nodiscard]] DVec3 angular_momentum() const {
    DVec3 sum;
    for (std::size_t i = 0; i < particles.mass.size(); ++i)
      sum += static_cast<double>(particles.mass[i]) * cross(vector_cast<double>(particles.position[i].x),
                                                            vector_cast<double>(particles.velocity[i].v));
    return sum;
  }

  [[nodiscard]] double fastest() const {
    double most = 0;
    for (const auto& record : particles.velocity)
      most = std::max(most, static_cast<double>(length(record.v)));
    return most;
  }

  [[nodiscard]] int inside_out() const {
    int count = 0;
    for (const state::Tetrahedra::Corners& c : tetrahedra.corners) {
      const auto x = [&](std::uint32_t p) { return vector_cast<double>(particles.position[p].x); };
      count += geometry::volume6(x(c.a), x(c.b), x(c.c), x(c.d)) < 0 ? 1 : 0;
    }
    return count;
  }
};

struct Stuff {
  double young_modulus = 1e5;
  double poisson_ratio = 0.45;
  double damping = 0;
};

/// A cube of density 1000 and edge 0.5, `cells` along each edge, about the origin.
Jelly make_cube(int cells, const Stuff& stuff) {
  Jelly j;
  geometry::CellGrid grid = {.counts = {cells, cells, cells}, .corner = {-0.25, -0.25, -0.25}};
  grid.cell = {0.5 / cells, 0.5 / cells, 0.5 / cells};
  grid.filled.assign(static_cast<std::size_t>(cells) * cells * cells, 1);
  const geometry::TetrahedralMesh mesh = geometry::fill_cells(grid);
  state::Particles::for_each_column(j.particles, [&](auto& column) { column.resize(mesh.points.size()); });
  const auto material = elements::neo_hookean(stuff.young_modulus, stuff.poisson_ratio);
  for (const geometry::Tetrahedron& t : mesh.tetrahedra) {
    std::array<DVec3, 4> x;
    for (int i = 0; i < 4; ++i) x[i] = mesh.points[t[i]];
    const auto rest = elements::tetrahedron_rest(x);
    j.tetrahedra.corners.push_back({t[0], t[1], t[2], t[3]});
    j.tetrahedra.shape_gradient.push_back(
        {vector_cast<Real>(rest.b[1]), vector_cast<Real>(rest.b[2]), vector_cast<Real>(rest.b[3])});
    j.tetrahedra.volume.push_back(static_cast<Real>(rest.volume));
    j.tetrahedra.shear_modulus.push_back(static_cast<Real>(material.shear));
    j.tetrahedra.volume_modulus.push_back(static_cast<Real>(material.volume));
    j.tetrahedra.damping_time.push_back(static_cast<Real>(stuff.damping));
    for (const std::uint32_t p : t) j.particles.mass[p] += static_cast<Real>(250 * rest.volume);
  }
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    j.particles.position[i].x = vector_cast<Real>(mesh.points[i]);
    j.particles.velocity[i].inverse_mass = Real(1) / j.particles.mass[i];
  }
  build_tetrahedra(owner_of_all(j.particles, {}, {}, j.tetrahedra), j.tetrahedra, j.particles, j.rows);
  return j;
}

Vec3 random_vector(std::mt19937_64& random) {
  return vector_cast<Real>(test::random_vector(random));
}

constexpr Real kSubstep = Real(1) / Real(480);

}  // namespace

TEST_SUITE("solver/tetrahedron_solve") {
  TEST_CASE("rows of one color share no particle, and none is missing") {
    const Jelly j = make_cube(3, {});
    std::size_t rows = 0;
    for (const TetrahedronPass& pass : j.rows.passes) {
      std::vector<int> used(j.particles.mass.size(), 0);
      for (int i = pass.first; i < pass.end; ++i) {
        const int count = i + 1 == pass.end ? pass.last_count : kTetrahedronLanes;
        for (int lane = 0; lane < count; ++lane) {
          for (const auto& record : j.rows.blocks[i].record) CHECK(used[record[lane] / 4]++ == 0);
        }
        rows += count;
      }
    }
    CHECK(rows == j.tetrahedra.corners.size());
  }

  TEST_CASE("tetrahedra get the same bits with all instructions, stiff, soft, pressed and damped") {
    for (const bool is_stiff : {false, true}) {
      Jelly j = make_cube(4, {.damping = 0.002});
      std::mt19937_64 random(5);
      for (TetrahedronLaw& law : j.rows.laws) {
        law.shear_modulus *= !is_stiff || law.row % 3 == 0 ? Real(0.01) : Real(10);
        if (law.row % 5 == 0) law.damping_time = Real(0);
      }
      for (auto& record : j.particles.position) record.x += Real(0.02) * random_vector(random);
      for (auto& record : j.particles.velocity) record.v = random_vector(random);
      j.particles.velocity[7].inverse_mass = Real(0);
      for (std::uint32_t i = 0; i < j.particles.mass.size(); i += 10) {
        const auto w = static_cast<double>(j.particles.velocity[i].inverse_mass);
        j.rows.pressed.push_back(
            {.particle = i, .answer = math::axial(DVec3{0.6, 0.0, 0.8}, 1e-3 * w, i % 4 == 0 ? w : 0.5 * w)});
        j.rows.pressed_of[i] = static_cast<std::uint32_t>(j.rows.pressed.size());
      }
      check_bits_of_targets(j, [&](Jelly& net) {
        net.step(kSubstep);
        CHECK(net.rows.any_stiff == is_stiff);
        if (!is_stiff) return;
        find_pressed_impulses(net.rows);
        for (const PressedPoint& point : net.rows.pressed)
          net.particles.velocity[point.particle].v += vector_cast<Real>(point.change);
      });
    }
  }

  TEST_CASE("over a short substep the impulse on each corner is the stress times its face") {
    const Stuff stuff = {.young_modulus = 1e5, .poisson_ratio = 0.3};
    Jelly j = make_cube(1, stuff);
    const Mat3 f = {{Real(1.1), Real(0.1), 0}, {0, Real(0.95), Real(-0.1)}, {Real(0.05), 0, Real(1.05)}};
    std::vector<DVec3> expected(j.particles.mass.size());
    for (auto& record : j.particles.position) record.x = f * record.x;
    const auto material = elements::neo_hookean(stuff.young_modulus, stuff.poisson_ratio);
    const double h = 1e-6;
    for (std::size_t i = 0; i < j.tetrahedra.corners.size(); ++i) {
      const auto& c = j.tetrahedra.corners[i];
      const std::uint32_t ends[4] = {c.a, c.b, c.c, c.d};
      std::array<DVec3, 4> b;
      for (int k = 0; k < 3; ++k) b[k + 1] = vector_cast<double>(j.tetrahedra.shape_gradient[i][k]);
      b[0] = -(b[1] + b[2] + b[3]);
      const Matrix3<double> deformation = {vector_cast<double>(f.x), vector_cast<double>(f.y),
                                           vector_cast<double>(f.z)};
      const auto p = elements::stress(deformation, material);
      for (int k = 0; k < 4; ++k)
        expected[ends[k]] -= h * static_cast<double>(j.tetrahedra.volume[i]) * (p * b[k]);
    }
    j.step(static_cast<Real>(h));
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const DVec3 impulse =
          static_cast<double>(j.particles.mass[i]) * vector_cast<double>(j.particles.velocity[i].v);
      CHECK(length(impulse - expected[i]) < 2e-3 * length(expected[0]));
    }
  }

  TEST_CASE("a solid at rest stays at rest, and one that moves evenly keeps its velocity") {
    for (const double young_modulus : {1e3, 1e5, 1e9}) {
      Jelly j = make_cube(2, {.young_modulus = young_modulus, .damping = 0.01});
      for (int i = 0; i < 100; ++i) j.step(kSubstep);
      // Rounding of forces that cancel, at most those of the stiffest that a substep carries.
      CHECK(j.fastest() < 1e-4);
      for (auto& record : j.particles.velocity) record.v += Vec3{Real(3), Real(-2), Real(1)};
      for (int i = 0; i < 100; ++i) j.step(kSubstep);
      for (const auto& record : j.particles.velocity)
        CHECK(length(record.v - Vec3{Real(3), Real(-2), Real(1)}) < Real(3e-4));
    }
  }

  TEST_CASE("momentum and angular momentum stay, with and without damping") {
    for (const double damping : {0.0, 0.005}) {
      Jelly j = make_cube(3, {.damping = damping});
      std::mt19937_64 random(3);
      for (std::size_t i = 0; i < j.particles.mass.size(); ++i)
        j.particles.velocity[i].v =
            random_vector(random) + cross(Vec3{0, Real(5), 0}, j.particles.position[i].x);
      const DVec3 linear = j.momentum();
      const DVec3 angular = j.angular_momentum();
      for (int i = 0; i < 1000; ++i) j.step(kSubstep);
      CHECK(length(j.momentum() - linear) < 1e-6 * 125 * 1.3);
      CHECK(length(j.angular_momentum() - angular) < 1e-5 * length(angular));
    }
  }

  TEST_CASE("a solid turned inside out, or thrown together at random, comes back to rest") {
    std::mt19937_64 random(7);
    for (const bool mirrored : {true, false}) {
      // Random heaps of nearly incompressible matter may lock: a few tetrahedra of a thousand stay inside
      // out.
      const double poisson_ratio = mirrored ? 0.49 : 0.45;
      Jelly j = make_cube(4, {.young_modulus = 1e5, .poisson_ratio = poisson_ratio, .damping = 0.005});
      for (auto& record : j.particles.position) {
        const Vec3 x = record.x;
        record.x =
            mirrored ? Vec3{-x.x, x.y, x.z} + Real(0.005) * random_vector(random) : random_vector(random);
      }
      const int all = static_cast<int>(j.tetrahedra.corners.size());
      CHECK(j.inside_out() > (mirrored ? all - 1 : all / 4));
      for (int i = 0; i < 1500; ++i) j.step(kSubstep);
      CHECK(j.inside_out() == 0);
      CHECK(j.fastest() < 0.2);
    }
  }

  TEST_CASE("a solid much stiffer than a substep carries does not gain energy") {
    Jelly j = make_cube(4, {.young_modulus = 1e9});
    std::mt19937_64 random(11);
    for (auto& record : j.particles.velocity) record.v = random_vector(random);
    const double before = j.fastest();
    for (int i = 0; i < 2000; ++i) j.step(kSubstep);
    CHECK(j.fastest() < 0.5 * before);
  }

  TEST_CASE("damping stops pulsing and shearing at its rate, and no spin") {
    // One cell, its points moved by v = A x: a strain rate without stress, as long as nothing has moved.
    const Matrix3<double> shear = {{0, 0, 0}, {1, 0, 0}, {0, 0, 0}};
    const Matrix3<double> pulse = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (const Matrix3<double>& a : {shear, pulse}) {
      const double damping = 1e-3;
      Jelly j = make_cube(1, {.young_modulus = 1e5, .poisson_ratio = 0.3, .damping = damping});
      for (std::size_t i = 0; i < j.particles.mass.size(); ++i)
        j.particles.velocity[i].v = vector_cast<Real>(a * vector_cast<double>(j.particles.position[i].x));
      const auto kinetic = [&] {
        double sum = 0;
        for (std::size_t i = 0; i < j.particles.mass.size(); ++i)
          sum += 0.5 * static_cast<double>(j.particles.mass[i]) *
                 static_cast<double>(length_squared(j.particles.velocity[i].v));
        return sum;
      };
      const double before = kinetic();
      const double h = 1e-5;
      prepare_tetrahedra(j.rows, static_cast<Real>(h));
      for (const TetrahedronPass& pass : j.rows.passes)
        damp_tetrahedra(j.rows, pass, {pass.first, pass.end}, j.particles);
      // Power tau (2 mu E':E' + (lambda - mu) tr(E')^2) V, E' the symmetric part of A.
      const auto m = elements::neo_hookean(1e5, 0.3);
      const Matrix3<double> e = 0.5 * (a + transpose(a));
      const double trace = e.x.x + e.y.y + e.z.z;
      const double power =
          damping * 0.125 * (2 * m.shear * elements::contract(e, e) + (m.volume - m.shear) * trace * trace);
      CHECK((before - kinetic()) / h == doctest::Approx(power).epsilon(0.02));
    }
    Jelly spinning = make_cube(2, {.damping = 0.1});
    for (std::size_t i = 0; i < spinning.particles.mass.size(); ++i)
      spinning.particles.velocity[i].v = cross(Vec3{Real(1), Real(2), 0}, spinning.particles.position[i].x);
    const double before = spinning.fastest();
    prepare_tetrahedra(spinning.rows, kSubstep);
    for (const TetrahedronPass& pass : spinning.rows.passes)
      damp_tetrahedra(spinning.rows, pass, {pass.first, pass.end}, spinning.particles);
    CHECK(spinning.fastest() == doctest::Approx(before).epsilon(1e-5));
  }

  TEST_CASE("degenerate places leave everything finite") {
    for (const Real size : {Real(0), Real(1e-20), Real(1e10)}) {
      Jelly j = make_cube(1, {.damping = 0.01});
      for (auto& record : j.particles.position) record.x = size * record.x;
      for (int i = 0; i < 5; ++i) j.step(kSubstep);
      for (const auto& record : j.particles.velocity) CHECK(is_finite(record.v));
    }
    Jelly held = make_cube(1, {});
    for (auto& record : held.particles.velocity) record.inverse_mass = Real(0);
    for (auto& record : held.particles.position) record.x = Real(2) * record.x;
    held.step(kSubstep);
    CHECK(held.fastest() == 0);
  }
}

}  // namespace hooke::solver
