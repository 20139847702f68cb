#include "lab/scenes.h"
#include "lab/system/turn.h"
#include "math/rotation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hooke {

using test::advance;
using test::make_run;
using test::make_world;
using test::take;

namespace {

double in_double(Real value) {
  return static_cast<double>(value);
}

/// A disc of radius 0.5 m and 0.2 m thick along y, spinning aside of its axis.
struct Top {
  World world = make_world(test::empty_space());
  BodyId id = {};
  double along = 0.125;                             // inertia per mass about the axis
  double across = (3 * 0.5 * 0.5 + 4 * 0.01) / 12;  // and across it
  DVec3 spin = {1, 5, 0};                           // in world axes, which are the body's at the start
  DVec3 momentum = {across * spin.x, along* spin.y, 0};

  Top() {
    BodyDesc disc = {.kind = BodyKind::kDynamic, .shape = Shape::cylinder(Real(0.5), Real(0.1))};
    disc.angular_velocity = {Real(1), Real(5), Real(0)};
    id = take(world.add_body(disc));
  }

  /// The axis goes round L with L / I1, the body about its axis with w3 (I1 - I3) / I1.
  [[nodiscard]] Quaternion<double> rotation(double t) const {
    const double own = spin.y * (across - along) / across * t;
    return math::quaternion_of((t / across) * momentum) * math::quaternion_of(DVec3{0, own, 0});
  }
};

/// Angle between two rotations [rad].
double angle_between(Quaternion<double> a, Quaternion<double> b) {
  return length(math::turn_between(a, b, DVec3{}));
}

/// How far a method's rotation is from the closed form after `seconds`.
double top_error(const std::string& stepper, double dt, double seconds) {
  const Top top;
  lab::Run run = make_run(top.world, {.stepper = stepper, .dt = dt});
  advance(run, std::llround(seconds / dt));
  return angle_between(take(run.body(top.id)).rotation, top.rotation(seconds));
}

/// The complete elliptic integral K, by the arithmetic-geometric mean.
double elliptic_quarter(double modulus_squared) {
  double a = 1;
  double b = std::sqrt(1 - modulus_squared);
  for (int i = 0; i < 40; ++i) {
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return std::numbers::pi / 2 / a;
}

}  // namespace

TEST_SUITE("lab/bodies") {
  TEST_CASE("coordinates of a turn, its rate and its spin agree with quaternions") {
    const DVec3 p = {0.4, -0.7, 0.2};
    const DVec3 omega = {1.5, 0.3, -2};
    const DVec3 rate = lab::rotation_rate(p, omega);
    CHECK(length(lab::spin_of(p, rate) - omega) < 1e-15);
    // 2 tan(angle / 2) along the axis.
    const double angle = 2 * std::atan(length(p) / 2);
    const Quaternion<double> q = math::quaternion_of(angle * normalize(p));
    CHECK(angle_between(q, lab::rotation_of(p)) < 1e-15);
    CHECK(length(lab::turned(p, omega) - rotate(q, omega)) < 1e-14);
    // q' = omega q / 2, by a small step both ways.
    const double h = 1e-5;
    const Quaternion<double> after = math::quaternion_of(h * omega) * q;
    CHECK(angle_between(after, lab::rotation_of(p + h * rate)) < 1e-9);
  }

  TEST_CASE("a free symmetric top follows its closed form, each method at its order") {
    const struct {
      std::string stepper;
      double order;
    } rows[] = {{"euler", 1},
                {"symplectic_euler", 1},
                {"taylor2", 2},
                {"taylor3", 3},
                {"heun", 2},
                {"midpoint", 2},
                {"verlet", 2},
                {"rk4", 4},
                {"implicit_euler", 1},
                {"am2", 2},
                {"bdf2", 2},
                {"ab2", 2},
                {"ab4", 4}};
    for (const auto& row : rows) {
      CAPTURE(row.stepper);
      const double dt = row.order < 3 ? 1.0 / 480 : 1.0 / 60;  // sizes are float: errors end at 1e-7
      const double coarse = top_error(row.stepper, dt, 2);
      const double fine = top_error(row.stepper, dt / 2, 2);
      CHECK(std::log2(coarse / fine) == doctest::Approx(row.order).epsilon(0.12));
    }
    CHECK(top_error("rk4", 1.0 / 240, 10) < 1e-6);
  }

  TEST_CASE("a body turned about its middle axis is back after the period of the elliptic integral") {
    World world = make_world(test::empty_space());
    BodyDesc desc = {.kind = BodyKind::kDynamic, .shape = Shape::box({Real(0.5), Real(0.1), Real(0.25)})};
    desc.angular_velocity = {Real(0), Real(0.3), Real(6)};
    const BodyId box = take(world.add_body(desc));
    const double aside = in_double(Real(0.3));
    const double i1 = (0.2 * 0.2 + 0.5 * 0.5) / 12;
    const double i2 = (1 + 0.2 * 0.2) / 12;
    const double i3 = (1 + 0.5 * 0.5) / 12;
    const double energy = i2 * 36 + i3 * aside * aside;
    const double momentum = i2 * i2 * 36 + i3 * i3 * aside * aside;
    const double rate = std::sqrt((i3 - i2) * (momentum - energy * i1) / (i1 * i2 * i3));
    const double modulus = (i2 - i1) * (energy * i3 - momentum) / ((i3 - i2) * (momentum - energy * i1));
    const double period = 4 * elliptic_quarter(modulus) / rate;
    lab::Run run = make_run(world, {.stepper = "rk4", .dt = period / 4000});
    const auto own_spin = [&] {
      const lab::BodyState now = take(run.body(box));
      return rotate(conjugate(now.rotation), now.angular_velocity);
    };
    const double before = run.energy().total();
    advance(run, 2000);
    CHECK(own_spin().z == doctest::Approx(-6).epsilon(1e-6));
    advance(run, 2000);
    CHECK(length(own_spin() - DVec3{0, aside, 6}) < 1e-5);  // the sizes are float
    CHECK(run.energy().total() == doctest::Approx(before).epsilon(1e-9));
  }

  TEST_CASE("energy and momentum of a free top drift at the order of the method") {
    const auto drift = [](const std::string& stepper, double dt) {
      const Top top;
      lab::Run run = make_run(top.world, {.stepper = stepper, .dt = dt});
      const double before = run.energy().total();
      advance(run, std::llround(2 / dt));
      const lab::BodyState now = take(run.body(top.id));
      const DVec3 own = rotate(conjugate(now.rotation), now.angular_velocity);
      const DVec3 momentum =
          rotate(now.rotation, {top.across * own.x, top.along * own.y, top.across * own.z});
      return std::pair(std::abs(run.energy().total() / before - 1),
                       length(momentum - top.momentum) / length(top.momentum));
    };
    struct Method {
      std::string stepper;
      double order;
    };
    for (const Method& method : {Method{"euler", 1}, Method{"heun", 2}, Method{"rk4", 4}}) {
      CAPTURE(method.stepper);
      const auto coarse = drift(method.stepper, 1.0 / 120);
      const auto fine = drift(method.stepper, 1.0 / 240);
      CHECK(std::log2(coarse.first / fine.first) > method.order - 0.2);
      CHECK(std::log2(coarse.second / fine.second) > method.order - 0.2);
    }
  }

  TEST_CASE("a thrown body flies its parabola and spins on for ten turns") {
    World world = make_world();
    BodyDesc ball = {.kind = BodyKind::kDynamic, .shape = Shape::sphere(Real(0.1)), .position = {0, 100, 0}};
    ball.velocity = {Real(3), Real(4), Real(0)};
    ball.angular_velocity = {Real(0), Real(8), Real(0)};
    const BodyId id = take(world.add_body(ball));
    lab::Run run = make_run(world, {.stepper = "rk4", .dt = 0.005});
    advance(run, 1571);
    const lab::BodyState now = take(run.body(id));
    const double t = run.time();
    const double g = in_double(Real(9.81));
    CHECK(now.center.y == doctest::Approx(100 + 4 * t - g * t * t / 2).epsilon(1e-12));
    CHECK(now.velocity.y == doctest::Approx(4 - g * t).epsilon(1e-12));
    CHECK(angle_between(now.rotation, math::quaternion_of(DVec3{0, 8 * t, 0})) < 1e-4);
    CHECK(length(now.angular_velocity - DVec3{0, 8, 0}) < 1e-5);
  }

  TEST_CASE("a body goes round a center of attraction and comes back after 2 pi sqrt(a^3 / GM)") {
    World world = make_world(test::empty_space());
    take(world.add_field({.kind = FieldDesc::Kind::kInverseSquare, .strength = 4.0}));
    BodyDesc desc = {.kind = BodyKind::kDynamic, .shape = Shape::sphere(Real(0.1)), .position = {1, 0, 0}};
    desc.velocity = {Real(0), Real(2), Real(0)};
    const BodyId id = take(world.add_body(desc));
    lab::Run run = make_run(world, {.stepper = "rk4", .dt = std::numbers::pi / 1000});
    advance(run, 1000);
    const DVec3 back = take(run.body(id)).center - DVec3{1, 0, 0};
    CHECK(length(back) < 1e-6);
  }

  TEST_CASE("a magnet and the gradient of a field are reported as left out") {
    World world = make_world(test::empty_space());
    BodyDesc desc = {.kind = BodyKind::kDynamic, .shape = Shape::sphere(Real(0.1))};
    desc.dipole_moment = {Real(1), Real(0), Real(0)};
    take(world.add_body(desc));
    take(world.add_field(
        {.kind = FieldDesc::Kind::kMagnetic, .vector = {Real(1), Real(0), Real(0)}, .strength = 2}));
    const lab::Run run = make_run(world, {.stepper = "rk4", .dt = 0.01});
    REQUIRE(run.report().size() == 1);
    CHECK(run.report()[0].left_out.size() == 2);
  }

  TEST_CASE("a user's law pulls a body as it pulls a particle: an oscillation") {
    for (const char* stepper : {"rk4", "verlet", "bdf2"}) {
      World world = make_world(test::empty_space());
      const BodyId id = take(world.add_body(
          {.kind = BodyKind::kDynamic, .shape = Shape::sphere(Real(0.1)), .position = {1, 0, 0}}));
      take(world.add_force_law([](BodyForceView& view) {
        for (std::size_t i = 0; i < view.size(); ++i) {
          const auto x = static_cast<Real>(view.center_of_mass(i).x);
          view.add_force(i, {-4 * view.mass(i) * x, Real(0), Real(0)});
        }
      }));
      lab::Run run = make_run(world, {.stepper = stepper, .dt = 1.0 / 240});
      advance(run, 1200);
      INFO(stepper);
      CHECK(take(run.body(id)).center.x == doctest::Approx(std::cos(2 * run.time())).epsilon(3e-3));
      CHECK(run.report()[0].left_out.empty());
      const auto taylor = lab::Run::create(world, {.stepper = "taylor2"});
      REQUIRE_FALSE(taylor);  // a law has no derivatives
    }
  }

  TEST_CASE("a user's law turns a body: a pendulum of torsion, by the law's view of its rotation") {
    World world = make_world(test::empty_space());
    // 1000 kg, I = 1000 (1 + 1) / 12 about each axis.
    const BodyId id = take(world.add_body({.kind = BodyKind::kDynamic,
                                           .shape = Shape::box({Real(0.5), Real(0.5), Real(0.5)}),
                                           .rotation = {0, 0, std::sin(Real(0.5)), std::cos(Real(0.5))}}));
    const double inertia = 1000.0 / 6;
    take(world.add_force_law([](BodyForceView& view) {
      const Quat q = view.rotation(0);
      view.add_torque(0, {Real(0), Real(0), -Real(9 * 1000.0 / 6) * 2 * std::atan2(q.z, q.w)});
      view.add_torque(0, Real(-2) * view.angular_velocity(0));
    }));
    lab::Run run = make_run(world, {.stepper = "rk4", .dt = 1.0 / 240});
    advance(run, 480);
    // theta'' = -9 theta - 2 / I theta', from 1 rad at rest.
    const double decay = 1 / inertia;
    const double omega = std::sqrt(9 - decay * decay);
    const double t = run.time();
    const double theta = std::exp(-decay * t) * (std::cos(omega * t) + decay / omega * std::sin(omega * t));
    CHECK(angle_between(take(run.body(id)).rotation, math::quaternion_of(DVec3{0, 0, theta})) < 1e-5);
  }

  TEST_CASE(
      "a law over bodies sees all of them in order, the others where the step began, and that is said") {
    World world = make_world(test::empty_space());
    std::vector<BodyId> ids;
    for (const double x : {-1.0, 1.0, 5.0}) {
      BodyDesc ball = {.kind = BodyKind::kDynamic, .shape = Shape::sphere(Real(0.1)), .position = {x, 0, 0}};
      ball.mass = Real(2);
      ids.push_back(take(world.add_body(ball)));
    }
    // The first two pull each other with 2 N/m and swing about their middle; the third is no part of it.
    std::vector<std::size_t> sizes;
    take(world.add_force_law([&sizes](BodyForceView& view) {
      sizes.push_back(view.size());
      const Vec3 way = vector_cast<Real>(view.center_of_mass(1) - view.center_of_mass(0));
      view.add_force(0, Real(2) * way);
      view.add_force(1, Real(-2) * way);
    }));
    const auto error = [&](double dt) {
      lab::Run run = make_run(world, {.stepper = "rk4", .dt = dt, .contacts = false});
      advance(run, std::llround(0.5 / dt));
      CHECK(take(run.body(ids[2])).center == DVec3{5, 0, 0});
      CHECK(run.report()[0].left_out.size() == 1);
      return std::abs(take(run.body(ids[1])).center.x - std::cos(std::sqrt(2.0) * 0.5));
    };
    const double coarse = error(0.01);
    const double fine = error(0.0025);
    CHECK(coarse < 5e-3);
    CHECK(fine < coarse / 3.5);  // of first order, as the others are a step late
    CHECK(std::all_of(sizes.begin(), sizes.end(), [](std::size_t size) { return size == 3; }));
  }

  TEST_CASE("a kinematic body goes as told") {
    World world = make_world();
    BodyDesc arm = {.kind = BodyKind::kKinematic, .shape = Shape::box({Real(1), Real(0.5), Real(0.5)})};
    arm.velocity = {Real(1), Real(0), Real(0)};
    arm.angular_velocity = {Real(0), Real(0), Real(2)};
    const BodyId id = take(world.add_body(arm));
    lab::Run run = make_run(world, {.dt = 0.25});
    advance(run, 4);
    const lab::BodyState now = take(run.body(id));
    CHECK(length(now.center - DVec3{1, 0, 0}) < 1e-15);
    CHECK(angle_between(now.rotation, math::quaternion_of(DVec3{0, 0, 2})) < 1e-14);
  }

  TEST_CASE("a body that turns by more than a radian a step is refused") {
    const Top top;
    const auto run = lab::Run::create(top.world, {.stepper = "rk4", .dt = 0.25});
    REQUIRE_FALSE(run);
    CHECK(run.error().where == "body 1");
    CHECK(run.error().message == "turns by 1.27 rad in a step of 0.25 s; at most 1 can be followed");
  }

  TEST_CASE("an id that is not there has no state") {
    const Top top;
    lab::Run run = make_run(top.world, {});
    CHECK(run.body(BodyId{}).error().code == ErrorCode::kStaleId);
  }

  TEST_CASE("a declared accuracy chooses steps for a body by its farthest point") {
    const Top top;
    lab::Run run = make_run(top.world, {.dt = 0.05, .accuracy = lab::Accuracy{1e-5, 2}});
    advance(run, 40);
    CHECK(0.6 * angle_between(take(run.body(top.id)).rotation, top.rotation(2)) < 1e-5);
    CHECK(run.report()[0].error.has_value());
  }
}

}  // namespace hooke
