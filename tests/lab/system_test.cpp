#include "lab/system/system.h"

#include "lab/scenes.h"
#include "lab/system/series.h"
#include "world/access.h"

#include <Eigen/Dense>
#include <cmath>
#include <functional>

namespace hooke {

using test::empty_space;
using test::make_world;
using test::take;

namespace {

/// A creased, moving cloth in wind: springs, bends, sails, a held and a driven corner.
ClothDesc make_cloth() {
  ClothDesc cloth;
  cloth.columns = 4;
  cloth.rows = 3;
  cloth.damping = Real(0.5);
  cloth.bend_stiffness = Real(0.02);
  cloth.bend_damping = Real(0.1);
  cloth.air_friction = Real(0.3);
  cloth.stretch_stiffness = Real(200);
  cloth.shear_stiffness = Real(100);
  PinDesc driven;
  driven.point = 3;
  driven.motion.kind = MotionDesc::Kind::kSine;
  driven.motion.amplitude = {Real(0.1), Real(0), Real(0.2)};
  cloth.pins = {{}, driven};
  return cloth;
}

World make_windy_world() {
  World world = make_world();
  WindDesc wind;
  wind.velocity = {Real(2), Real(0.5), Real(3)};
  REQUIRE(world.set_wind(wind));
  take(world.add_field({.kind = FieldDesc::Kind::kInverseSquare, .center = {3, 1, 2}, .strength = 2}));
  take(world.add_field({.kind = FieldDesc::Kind::kMagnetic, .vector = {Real(1), Real(2), Real(-1)}}));
  return world;
}

/// Something uneven but always the same.
double ripple(Eigen::Index i) {
  return std::sin(1.7 * static_cast<double>(i) + 0.3) + 0.5 * std::cos(4.1 * static_cast<double>(i));
}

lab::State disturbed(const lab::System& system, double size) {
  lab::State y = system.initial_state();
  for (Eigen::Index i = 0; i < y.size(); ++i) y[i] += size * ripple(i);
  return y;
}

lab::System make_system(const World& world) {
  return take(lab::System::create(WorldAccess::tables(world), 0));
}

/// The kinds of object, one at a time.
void for_each_object(const std::function<void(const lab::System&)>& check) {
  World cloth = make_windy_world();
  ClothDesc charged = make_cloth();
  charged.charge = Real(0.1);
  take(cloth.add_cloth(charged));
  check(make_system(cloth));
  World isometric = make_windy_world();
  charged.bend = ClothDesc::Bend::kIsometric;
  take(isometric.add_cloth(charged));
  check(make_system(isometric));
  World rope = make_windy_world();
  take(rope.add_rope({.masses = 6,
                      .stiffness = Real(50),
                      .inner_friction = Real(1),
                      .air_friction = Real(0.2),
                      .radius = Real(0.1)}));
  check(make_system(rope));
  World balls = make_windy_world();
  ParticlesDesc desc;
  desc.particles = {{}, {.position = {1, 0, 0}}, {.position = {0.2, 1, 0}}};
  desc.springs = {{.a = 0, .b = 1, .damping = Real(2)}, {.a = 1, .b = 2}};
  desc.damping = ParticlesDesc::Damping::kIsotropic;
  desc.drag_coefficient = Real(30);
  take(balls.add_particles(desc));
  check(make_system(balls));
}

}  // namespace

TEST_SUITE("lab/system") {
  TEST_CASE("series know the derivatives of products, quotients, roots and angles") {
    // f(t) = sqrt(1 + t) / (2 - t): 1/2 + t/2 + 3 t^2/16 + ...
    lab::Series<3> t(0.0);
    t.c[1] = 1;
    const lab::Series<3> f = sqrt(1.0 + t) / (2.0 - t);
    CHECK(f.c[0] == doctest::Approx(0.5));
    CHECK(f.c[1] == doctest::Approx(0.5));
    CHECK(f.c[2] == doctest::Approx(3.0 / 16));
    // atan2(t, 1) = t - t^3/3: no second term.
    const lab::Series<3> angle = atan2(t, lab::Series<3>(1.0));
    CHECK(angle.c[0] == 0);
    CHECK(angle.c[1] == doctest::Approx(1));
    CHECK(angle.c[2] == 0);
    // atan2(1 + t, 1): pi/4 + t/2 - t^2/4.
    CHECK(atan2(1.0 + t, lab::Series<3>(1.0)).c[2] == doctest::Approx(-0.25));
  }

  TEST_CASE("jerk and snap are the differences of accelerations along the motion") {
    for_each_object([](const lab::System& system) {
      const lab::State y = disturbed(system, 0.05);
      const double t = 0.3;
      const double h = 1e-4;
      const auto d = system.acceleration_and_derivatives(t, y, 3);
      // Along x + v h + a h^2/2 + j h^3/6 and v + a h + j h^2/2, exact to third order.
      const auto at = [&](double s) {
        lab::State moved = y;
        system.x(moved) += s * system.v(y) + s * s / 2 * d[0] + s * s * s / 6 * d[1];
        system.v(moved) += s * d[0] + s * s / 2 * d[1];
        return system.acceleration(t + s, moved);
      };
      CHECK((d[0] - system.acceleration(t, y)).norm() <= 1e-9 * d[0].norm());
      const lab::State jerk = (at(h) - at(-h)) / (2 * h);
      const lab::State snap = (at(h) - 2 * d[0] + at(-h)) / (h * h);
      CHECK((d[1] - jerk).norm() <= 1e-4 * d[1].norm());
      CHECK((d[2] - snap).norm() <= 1e-3 * d[2].norm());
    });
  }

  TEST_CASE("the Jacobian is the difference of accelerations, entry by entry and along a direction") {
    for_each_object([](const lab::System& system) {
      const lab::State y = disturbed(system, 0.05);
      const Eigen::Index n = system.coordinates();
      Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, 2 * n);
      const lab::Jacobian jacobian = system.jacobian(0.3, y);
      for (const auto& e : jacobian.by_position) matrix(e.row, e.column) += e.value;
      for (const auto& e : jacobian.by_velocity) matrix(e.row, n + e.column) += e.value;
      const double h = 1e-6;
      for (Eigen::Index i = 0; i < 2 * n; ++i) {
        lab::State up = y;
        lab::State down = y;
        up[i] += h;
        down[i] -= h;
        const lab::State slope = (system.acceleration(0.3, up) - system.acceleration(0.3, down)) / (2 * h);
        CHECK((matrix.col(i) - slope).norm() <= 1e-5 * (1 + slope.norm()));
      }
      const lab::State direction = disturbed(system, 1.0);
      const lab::State along = system.jacobian_times(0.3, y, direction);
      CHECK((along.head(n) - system.v(direction)).norm() == 0);
      CHECK((along.tail(n) - matrix * direction).norm() <= 1e-9 * along.norm());
    });
  }

  TEST_CASE("the fastest oscillation is bounded from above, closely for a chain") {
    World world = make_world(empty_space());
    ParticlesDesc desc;
    for (int i = 0; i < 17; ++i) desc.particles.push_back({.position = {1.0 * i, 0, 0}});
    for (std::uint32_t i = 0; i < 16; ++i) desc.springs.push_back({.a = i, .b = i + 1});
    desc.pins = {{}};
    take(world.add_particles(desc));
    const lab::System system = make_system(world);
    const lab::State y = system.initial_state();
    const lab::Jacobian jacobian = system.jacobian(0, y);
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(48, 48);
    for (const auto& e : jacobian.by_position) matrix(e.row, e.column) -= e.value;
    const double exact = matrix.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff();
    double bound = 0;
    for (const lab::Oscillation& o : system.oscillations(0, y)) bound = std::max(bound, o.omega_squared);
    CHECK(bound >= exact);
    CHECK(bound <= 1.02 * exact);
  }

  TEST_CASE("without friction and air a falling, folding cloth keeps its energy") {
    WorldDesc desc;
    desc.wind.air_density = Real(0);
    for (const auto bend : {ClothDesc::Bend::kAngle, ClothDesc::Bend::kIsometric, ClothDesc::Bend::kYarn}) {
      World world = make_world(desc);
      ClothDesc cloth = make_cloth();
      cloth.bend = bend;
      cloth.column_direction = {Real(1), Real(0.3), Real(0)};
      cloth.row_direction = {Real(0), Real(0), Real(1)};
      cloth.damping = Real(0);
      cloth.bend_damping = Real(0);
      cloth.bend_stiffness = Real(0.5);
      cloth.air_friction = Real(0);
      cloth.pins = {{}};
      take(world.add_cloth(cloth));
      lab::Run run = take(lab::Run::create(world, {.dt = 0.001}));
      const double start = run.energy().total();
      double most_bent = 0;
      for (int i = 0; i < 500; ++i) {
        REQUIRE(run.advance());
        most_bent = std::max(most_bent, run.energy().elastic);
        CHECK(run.energy().total() == doctest::Approx(start).epsilon(1e-5));
      }
      CHECK(most_bent > 0.05);
    }
  }

  TEST_CASE("a World and the laboratory go the same way") {
    World world = make_windy_world();
    const ClothId cloth = take(world.add_cloth(make_cloth()));
    const RopeId rope = take(world.add_rope({.hook_point = {5, 0, 0},
                                             .direction = {Real(1), Real(-1), Real(0)},
                                             .masses = 8,
                                             .stiffness = Real(300),
                                             .inner_friction = Real(0.5),
                                             .air_friction = Real(0.1),
                                             .radius = Real(0.05)}));
    lab::Run run = take(lab::Run::create(world, {.dt = 0.005}));
    for (int i = 0; i < 60; ++i) {
      REQUIRE(run.advance());
      for (int j = 0; j < 20; ++j) REQUIRE(world.step(Real(0.00025)).healthy());
    }
    const auto check_points = [](const std::vector<DVec3>& ours, const PointView& theirs, const DVec3 start) {
      REQUIRE(ours.size() == theirs.size());
      CHECK(length(ours.back() - start) > 0.1);
      for (std::size_t i = 0; i < ours.size(); ++i) CHECK(length(ours[i] - theirs[i]) < 1.5e-3);
    };
    check_points(run.positions(cloth), world.positions(cloth), {1, -1, 0});
    check_points(run.positions(rope), world.positions(rope), {5 + std::sqrt(0.5), -std::sqrt(0.5), 0});
    CHECK(run.energy().total() == doctest::Approx(world.measure().energy.total()).epsilon(1e-2));
  }
}

}  // namespace hooke
