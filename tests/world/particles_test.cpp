#include "world/make.h"

#include <cmath>
#include <numbers>

namespace hooke {

using namespace test;

TEST_SUITE("world/particles") {
  TEST_CASE("a stone falls by g t^2 / 2 and the half substep of a semi-implicit step") {
    World world = make_world();
    const ParticlesId stone = take(world.add_particles({.particles = {{.position = {0, 100, 0}}}}));
    run(world, 120);
    // y = -g t^2 / 2 - g t h / 2 with h = 1/480 s.
    CHECK(world.positions(stone)[0].y == doctest::Approx(100 - 9.81 * 2 - 9.81 * 2 / 960).epsilon(1e-6));
  }

  TEST_CASE("viscous drag gives the terminal velocity m g / c and quadratic drag sqrt(2 m g / rho Cd A)") {
    World viscous = make_world();
    const ParticlesId slow = take(viscous.add_particles({.particles = {{}}, .air_friction = Real(2)}));
    run(viscous, 600);
    // Measured after the kick of a substep: m g / c + g h.
    CHECK(viscous.velocities(slow)[0].y == doctest::Approx(-9.81 / 2 - 9.81 / 480).epsilon(1e-4));
    World quadratic = make_world();
    ParticleDesc ball;
    ball.radius = Real(0.1);
    const ParticlesId fast =
        take(quadratic.add_particles({.particles = {ball}, .drag_coefficient = Real(0.5)}));
    run(quadratic, 3000);
    const double area = std::numbers::pi * 0.01;
    CHECK(quadratic.velocities(fast)[0].y ==
          doctest::Approx(-std::sqrt(2 * 9.81 / (1.225 * 0.5 * area))).epsilon(1e-3));
  }

  TEST_CASE("particles rest on capsules, cylinders, cones and hulls") {
    World world = make_world();
    const Quat upside_down = {Real(1), Real(0), Real(0), Real(0)};
    const MeshId corners =
        take(world.add_mesh({.positions = {{-1, 0, -1}, {1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {0, -1, 0}},
                             .triangles = {{0, 1, 4}}}));
    const Shape shapes[] = {Shape::capsule(Real(0.3), Real(0.5)), Shape::cylinder(Real(0.3), Real(0.5)),
                            Shape::cone(Real(0.3), Real(0.5)), Shape::hull_of(corners)};
    const double tops[] = {0.8, 0.5, 0.5, 0};
    ParticlesDesc desc;
    for (int i = 0; i < 4; ++i) {
      BodyDesc body;
      body.shape = shapes[i];
      body.position = {4.0 * i, 0, 0};
      if (body.shape.kind == ShapeKind::kCone) body.rotation = upside_down;
      take(world.add_body(body));
      ParticleDesc stone;
      stone.position = {4.0 * i, tops[i] + 0.15, 0};
      stone.radius = Real(0.1);
      desc.particles.push_back(stone);
    }
    const ParticlesId stones = take(world.add_particles(desc));
    run(world, 120);
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(world.positions(stones)[i].y == doctest::Approx(tops[i] + 0.1).epsilon(1e-3));
      CHECK(std::fabs(double(world.velocities(stones)[i].y)) < 1e-3);
    }
  }

  TEST_CASE("a spinning dumbbell keeps its angular momentum under central damping") {
    World world = make_world(empty_space());
    ParticlesDesc desc;
    desc.particles = {{.position = {-0.5, 0, 0}, .velocity = {0, Real(1), 0}},
                      {.position = {0.5, 0, 0}, .velocity = {0, Real(-1), 0}}};
    desc.springs = {{.a = 0, .b = 1, .stiffness = Real(1000), .damping = Real(0.5)}};
    take(world.add_particles(desc));
    const double start = world.measure().angular_momentum.z;
    run(world, 3600);
    CHECK(world.measure().angular_momentum.z == doctest::Approx(start).epsilon(1e-5));
  }

  TEST_CASE("isotropic damping, the paper's, brakes the rotation") {
    // L = e^{-c t / mu}, mu = 0.5 kg, c = 0.5: e^-1 after one second.
    World world = make_world(empty_space());
    ParticlesDesc desc;
    desc.particles = {{.position = {-0.5, 0, 0}, .velocity = {0, Real(1), 0}},
                      {.position = {0.5, 0, 0}, .velocity = {0, Real(-1), 0}}};
    desc.springs = {{.a = 0, .b = 1, .stiffness = Real(1e5), .damping = Real(0.5)}};
    desc.damping = ParticlesDesc::Damping::kIsotropic;
    take(world.add_particles(desc));
    const double start = world.measure().angular_momentum.z;
    run(world, 60);
    CHECK(world.measure().angular_momentum.z / start == doctest::Approx(std::exp(-1.0)).epsilon(5e-3));
  }

  TEST_CASE("springs in series add up as 1/K = 1/k1 + 1/k2") {
    World world = make_world();
    ParticlesDesc desc;
    desc.particles = {{.position = {0, 0, 0}}, {.position = {0, -1, 0}}, {.position = {0, -2, 0}}};
    desc.springs = {{.a = 0, .b = 1, .stiffness = Real(200)}, {.a = 1, .b = 2, .stiffness = Real(300)}};
    desc.air_friction = Real(3);
    desc.pins = {{0}};
    const ParticlesId chain = take(world.add_particles(desc));
    run(world, 1200);
    const double extension = -2.0 - world.positions(chain)[2].y;
    CHECK(extension == doctest::Approx(9.81 * (2 / 200.0 + 1 / 300.0)).epsilon(1e-3).scale(0));
  }

  TEST_CASE("a charge circles in a magnetic field at q B / m and keeps its speed") {
    World world = make_world(empty_space());
    take(world.add_field({.kind = FieldDesc::Kind::kMagnetic, .vector = {0, 0, Real(2)}}));
    ParticleDesc electron;
    electron.charge = Real(-1.5);
    electron.velocity = {Real(1), 0, 0};
    const ParticlesId id = take(world.add_particles({.particles = {electron}}));
    run(world, 600);
    const DVec3 v = world.velocities(id)[0];
    CHECK(length(v) == doctest::Approx(1.0).epsilon(1e-5));
    CHECK(v.x == doctest::Approx(std::cos(3.0 * 10)).epsilon(1e-4));
    CHECK(v.y == doctest::Approx(std::sin(3.0 * 10)).epsilon(1e-4));
  }

  TEST_CASE("a planet comes back to where it was after 2 pi sqrt(a^3 / GM)") {
    WorldDesc desc = empty_space();
    World world = make_world(desc);
    take(world.add_field({.kind = FieldDesc::Kind::kInverseSquare, .strength = 4.0}));
    const ParticlesId id = take(world.add_particles(
        {.particles = {{.position = {2, 0, 0}, .velocity = {0, Real(std::sqrt(2.0)), 0}}}}));
    const double energy = world.measure().energy.total();
    const double period = 2 * std::numbers::pi * std::sqrt(8.0 / 4.0);
    const int steps = static_cast<int>(std::lround(period * 120));
    run(world, steps, static_cast<Real>(period / steps));
    CHECK(world.positions(id)[0].x == doctest::Approx(2.0).epsilon(1e-4));
    CHECK(std::abs(world.positions(id)[0].y) < 2e-2);
    CHECK(world.measure().energy.total() == doctest::Approx(energy).epsilon(1e-3));
  }

  TEST_CASE("a pin follows its motion and what hangs on it follows the pin") {
    World world = make_world(empty_space());
    ParticlesDesc desc;
    desc.particles = {{.position = {0, 0, 0}}, {.position = {1, 0, 0}}};
    desc.springs = {{.a = 0, .b = 1, .stiffness = kRigid}};
    MotionDesc sine;
    sine.kind = MotionDesc::Kind::kSine;
    sine.amplitude = {Real(0.5), 0, 0};
    sine.frequency_hz = Real(0.5);
    desc.pins = {{0, sine}};
    const ParticlesId id = take(world.add_particles(desc));
    for (int i = 1; i <= 120; ++i) {
      run(world, 1);
      const double expected = 0.5 * std::sin(std::numbers::pi * world.time());
      CHECK(world.positions(id)[0].x == doctest::Approx(expected).epsilon(1e-5).scale(1));
      CHECK(world.positions(id)[1].x - expected == doctest::Approx(1.0).epsilon(1e-3));
    }
  }

  TEST_CASE("keyframes are reached in time and joined by straight lines") {
    World world = make_world(empty_space());
    MotionDesc path;
    path.kind = MotionDesc::Kind::kKeyframes;
    path.keyframes = {{0.0, {}}, {1.0, {0, Real(2), 0}}, {2.0, {Real(4), Real(2), 0}}};
    const ParticlesId id = take(world.add_particles({.particles = {{}}, .pins = {{0, path}}}));
    run(world, 30);
    CHECK(world.positions(id)[0].y == doctest::Approx(1.0).epsilon(1e-4));
    run(world, 60);
    CHECK(world.positions(id)[0].x == doctest::Approx(2.0).epsilon(1e-4));
    run(world, 60);
    CHECK(world.positions(id)[0].x == doctest::Approx(4.0).epsilon(1e-4));
  }

  TEST_CASE("a block on a slope sticks up to tan theta = mu and slides with g (sin - mu cos) beyond") {
    for (const double angle : {0.45, 0.5}) {  // atan 0.5 = 0.46365
      World world = make_world();
      BodyDesc slope;
      slope.shape = Shape::half_space();
      slope.rotation = quaternion_about(Vec3{0, 0, Real(1)}, static_cast<Real>(angle));
      take(world.add_body(slope));
      const DVec3 up = {-std::sin(angle), std::cos(angle), 0};
      const ParticlesId block = take(world.add_particles({.particles = {{.position = 0.01 * up}}}));
      run(world, 60);
      const DVec3 x = world.positions(block)[0];
      const double expected = angle < 0.46365 ? 0 : 0.5 * 9.81 * (std::sin(angle) - 0.5 * std::cos(angle));
      CHECK(length(x - 0.01 * up) == doctest::Approx(expected).epsilon(1e-2).scale(1e-3));
      if (angle < 0.46365) CHECK(length(x - 0.01 * up) < 1e-6);
    }
  }

  TEST_CASE("fast particles do not pass a thin box, a plate of triangles or a sphere") {
    for (const ShapeKind kind : {ShapeKind::kBox, ShapeKind::kMesh, ShapeKind::kSphere}) {
      World world = make_world();
      MeshDesc plate;
      plate.positions = {{-2, 0, -2}, {-2, 0, 2}, {2, 0, 2}, {2, 0, -2}};
      plate.triangles = {{0, 1, 2}, {0, 2, 3}};
      const MeshId mesh = take(world.add_mesh(plate));
      BodyDesc body;
      if (kind == ShapeKind::kBox) body.shape = Shape::box({2, Real(0.005), 2});
      if (kind == ShapeKind::kMesh) body.shape = Shape::of_mesh(mesh);
      if (kind == ShapeKind::kSphere) body.shape = Shape::sphere(Real(0.5));
      take(world.add_body(body));
      for (const double speed : {1.0, 10.0, 100.0, 1000.0}) {
        const ParticlesId bullet =
            take(world.add_particles({.particles = {{.position = {0.1, 1.0 + speed / 100, 0.13},
                                                     .velocity = {0, static_cast<Real>(-speed), 0}}}}));
        run(world, 60);
        CHECK(world.positions(bullet)[0].y > 0.0);
        CHECK(world.remove(bullet));
      }
    }
  }

  TEST_CASE("sliding over the triangles of a flat mesh is sliding over a plane") {
    World world = make_world();
    MeshDesc floor;
    const int side = 20;
    for (int z = 0; z <= side; ++z) {
      for (int x = 0; x <= side; ++x) {
        floor.positions.push_back(
            {Real(0.37) * static_cast<Real>(x), 0, Real(0.41) * static_cast<Real>(z) - 4});
      }
    }
    for (int z = 0; z < side; ++z) {
      for (int x = 0; x < side; ++x) {
        const auto a = static_cast<std::uint32_t>(z * (side + 1) + x);
        const auto c = a + side + 1;
        floor.triangles.push_back({a, c, c + 1});
        floor.triangles.push_back({a, c + 1, a + 1});
      }
    }
    BodyDesc body;
    body.shape = Shape::of_mesh(take(world.add_mesh(floor)));
    body.contact.friction = Real(0);
    take(world.add_body(body));
    const ParticlesId puck = take(world.add_particles(
        {.particles = {{.position = {0.2, 0.01, 0}, .velocity = {Real(3), 0, Real(0.2)}}}}));
    for (int i = 0; i < 120; ++i) {
      run(world, 1);
      CHECK(world.positions(puck)[0].y == doctest::Approx(0.01).epsilon(1e-3).scale(0));
      CHECK(world.velocities(puck)[0].x == doctest::Approx(3.0).epsilon(1e-5));
    }
  }

  TEST_CASE("a fall keeps its energy to the last digits") {
    World world = make_world();
    const ParticlesId id = take(world.add_particles({.particles = {{.position = {0, 100, 0}}}}));
    for (int i = 0; i < 120; ++i) {
      run(world, 1);
      CHECK(world.measure().energy.total() == doctest::Approx(981.0).epsilon(1e-5));
    }
    CHECK(world.positions(id)[0].y == doctest::Approx(80.38).epsilon(1e-2));
  }
}

}  // namespace hooke
