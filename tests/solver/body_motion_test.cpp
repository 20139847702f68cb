#include "solver/body/body_motion.h"

#include "math/rotation.h"
#include "solver/body_scene.h"

#include <doctest/doctest.h>
#include <numbers>

namespace hooke::solver {
namespace {

using testing::BodyScene;
using testing::solid_box;

double energy_of_rotation(const BodyScene& scene, std::uint32_t row) {
  const auto axes = math::in_double(scene.bodies.rotation[row] * scene.bodies.mass[row].principal);
  const DVec3 l = rotate(conjugate(axes), vector_cast<double>(scene.bodies.angular_momentum[row]));
  const DVec3 i = vector_cast<double>(scene.bodies.mass[row].inertia);
  return 0.5 * (l.x * l.x / i.x + l.y * l.y / i.y + l.z * l.z / i.z);
}

}  // namespace

TEST_SUITE("solver/body_motion") {
  TEST_CASE("a body that tumbles over its middle axis keeps angular momentum exactly, and energy") {
    // Largest relative error of energy in 100 s, at 60 steps of 4 substeps.
    for (const auto& spin : {std::pair{2.0, 2e-5}, {6.0, 1e-4}, {20.0, 1e-3}}) {
      const double omega = spin.first;
      const double allowed = spin.second;
      CAPTURE(omega);
      BodyScene scene;
      scene.settings.gravity = {};
      scene.substeps = 4;
      const std::uint32_t box =
          scene.add(solid_box(Real(100), {Real(0.5), Real(0.1), Real(0.25)}), {0, 0, 0});
      // The moments about x, z, y, from the least to the most.
      scene.spin(box, {Real(1e-3 * omega), Real(1e-3 * omega), static_cast<Real>(omega)});
      const Vec3 momentum = scene.bodies.angular_momentum[box];
      const double energy = energy_of_rotation(scene, box);
      double worst = 0;
      int flips = 0;
      Real last = Real(1);
      for (int i = 0; i < 6000; ++i) {
        scene.step();
        worst = std::max(worst, std::abs(energy_of_rotation(scene, box) / energy - 1));
        const Real along = rotate(scene.bodies.rotation[box], Vec3{Real(0), Real(0), Real(1)}).z;
        if (along * last < Real(0)) ++flips;
        last = along;
      }
      CHECK(scene.bodies.angular_momentum[box] == momentum);
      CHECK(flips > 2);
      CHECK(worst < allowed);
    }
  }

  TEST_CASE("a small plate that spins at 3000 to 30 000 rad/s keeps its energy") {
    // As a hit leaves it; without turned_to_energy this went up and down 20-fold.
    for (const double omega : {3000.0, 10000.0, 30000.0}) {
      CAPTURE(omega);
      BodyScene scene;
      scene.settings.gravity = {};
      scene.substeps = 8;
      const std::uint32_t plate =
          scene.add(solid_box(Real(0.0018), {Real(0.0363), Real(0.0005), Real(0.0127)}), {0, 0, 0});
      scene.spin(plate, static_cast<Real>(omega) * normalize(Vec3{Real(-0.2), Real(1), Real(-0.1)}));
      const double energy = energy_of_rotation(scene, plate);
      for (int i = 0; i < 60; ++i) {
        scene.step();
        CHECK(energy_of_rotation(scene, plate) == doctest::Approx(energy).epsilon(1e-3));
      }
    }
  }

  TEST_CASE("a symmetric top precesses about its angular momentum at L / I") {
    // Free precession: the symmetry axis goes round L at the rate |L| / I_1 (Landau and Lifshitz,
    // Mechanics, paragraph 33).
    BodyScene scene;
    scene.settings.gravity = {};
    const Real i_1 = Real(2);
    const std::uint32_t top = scene.add({Real(10), {i_1, Real(3), i_1}}, {0, 0, 0});
    scene.spin(top, {Real(1), Real(4), Real(0)});
    const DVec3 l = vector_cast<double>(scene.bodies.angular_momentum[top]);
    const double rate = length(l) / static_cast<double>(i_1);
    const DVec3 up = normalize(l);
    const auto axis = [&] {
      const DVec3 a =
          vector_cast<double>(rotate(scene.bodies.rotation[top], Vec3{Real(0), Real(1), Real(0)}));
      return normalize(a - dot(a, up) * up);
    };
    const DVec3 start = axis();
    scene.run(600);
    const double angle = rate * 10;
    const DVec3 expected = std::cos(angle) * start + std::sin(angle) * cross(up, start);
    const double error = length(axis() - expected);  // [rad]
    CHECK(error < 1e-4 * angle);
  }

  TEST_CASE("a free ball falls as a parabola, the velocity half a substep early") {
    BodyScene scene;
    const std::uint32_t ball = scene.add(testing::solid_sphere(Real(1), Real(0.1)), {0, 0, 0});
    scene.run(60);
    const double h = static_cast<double>(scene.settings.h);
    CHECK(scene.bodies.center[ball].y == doctest::Approx(-0.5 * 9.81 * (1 + h)).epsilon(1e-5));
    CHECK(scene.velocity(ball).y == doctest::Approx(-9.81).epsilon(1e-5));
  }

  TEST_CASE("damping is a rate of decay and a torque turns by the inertia") {
    BodyScene scene;
    scene.settings.gravity = {};
    const std::uint32_t body = scene.add({Real(2), {Real(1), Real(2), Real(3)}}, {0, 0, 0});
    scene.bodies.motion[body].v.x = Real(1);
    scene.bodies.traits[body].linear_damping = Real(0.5);
    scene.bodies.torque[body] = {Real(0), Real(6), Real(0)};
    scene.step();
    const double h = static_cast<double>(scene.settings.h);
    CHECK(scene.velocity(body).x == doctest::Approx(std::pow(1 + 0.5 * h, -8)).epsilon(1e-5));
    CHECK(scene.bodies.angular_velocity[body].y == doctest::Approx(3.0 / 60).epsilon(1e-5));
  }

  TEST_CASE("a kinematic body moves as told") {
    BodyScene scene;
    const std::uint32_t body = scene.add({Real(0)}, {0, 0, 0});
    scene.bodies.traits[body].kind = BodyKind::kKinematic;
    scene.awake.push_back(body);
    scene.bodies.motion[body].v = {Real(2), Real(0), Real(0)};
    scene.bodies.angular_velocity[body] = {Real(0), std::numbers::pi_v<Real>, Real(0)};
    scene.run(30);
    CHECK(scene.bodies.center[body].x == doctest::Approx(1.0).epsilon(1e-5));
    const Vec3 x = rotate(scene.bodies.rotation[body], Vec3{Real(1), Real(0), Real(0)});
    CHECK(x.z == doctest::Approx(-1.0).epsilon(1e-5));
  }
}

}  // namespace hooke::solver
