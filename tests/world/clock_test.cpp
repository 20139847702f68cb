#include "hooke/clock.h"

#include "make.h"

#include <cmath>
#include <doctest/doctest.h>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

namespace {

using hooke::Clock;
using hooke::DVec3;
using hooke::Quat;
using hooke::Real;
using hooke::World;
using hooke::test::make_world;
using hooke::test::take;

constexpr double kStep = 1.0 / 60;
constexpr int kSteps = 240;

/// A rope in gusts: sensitive to every step.
World gusty_rope() {
  hooke::WorldDesc desc;
  desc.wind = {.velocity = {Real(6), Real(0), Real(1)}, .gust = Real(0.5)};
  World world = make_world(desc);
  take(world.add_rope({.hook_point = {0, 3, 0}, .total_mass = Real(0.2), .masses = 12}));
  return world;
}

/// The state's hash after kSteps steps that came due by pictures `elapsed(picture)` seconds apart.
std::uint64_t hash_by_display(const std::function<double(int)>& elapsed) {
  World world = gusty_rope();
  Clock clock = take(Clock::create({.step_seconds = kStep, .catch_up_steps = 8}));
  for (int picture = 0; world.step_count() < kSteps; ++picture) {
    const Clock::Due due = clock.advance(elapsed(picture));
    for (int i = 0; i < due.steps && world.step_count() < kSteps; ++i) world.step(Real(1) / Real(60));
  }
  return world.state_hash();
}

/// What a machine did whose steps take `cost(time)` seconds each and its pictures 1 ms.
struct Playback {
  double elapsed = 0;                ///< [s]
  double longest_wait = 0;           ///< [s] between two pictures.
  std::vector<std::uint64_t> drops;  ///< In each second.
};

Playback play(Clock& clock, double seconds, const std::function<double(double)>& cost) {
  Playback playback;
  playback.drops.assign(static_cast<std::size_t>(seconds) + 1, 0);
  double last = 0.001;
  while (playback.elapsed < seconds) {
    playback.elapsed += last;
    const Clock::Due due = clock.advance(last);
    CHECK(due.steps <= clock.desc().catch_up_steps);
    const auto second = static_cast<std::size_t>(std::min(playback.elapsed, seconds));
    playback.drops[second] += due.dropped;
    last = 0.001 + due.steps * cost(playback.elapsed);
    playback.longest_wait = std::max(playback.longest_wait, last);
  }
  return playback;
}

/// Cheap steps that become ten times as dear, and dearer than their own length, from second 1 to 3.
double overloaded(double time) {
  return time >= 1 && time < 3 ? 0.05 : 0.005;
}

Quat about_z(double angle) {
  return hooke::quaternion_about(hooke::Vec3{Real(0), Real(0), Real(1)}, static_cast<Real>(angle));
}

}  // namespace

TEST_SUITE("world/clock") {
  TEST_CASE("the display's rate does not change the state") {
    World plain = gusty_rope();
    hooke::test::run(plain, kSteps);
    const std::uint64_t expected = plain.state_hash();
    for (const double rate : {24.0, 30.0, 60.0, 100.0, 144.0}) {
      CAPTURE(rate);
      CHECK(hash_by_display([&](int) { return 1 / rate; }) == expected);
    }
    std::mt19937 random(3);
    std::uniform_real_distribution<double> jitter(0, 0.05);
    CHECK(hash_by_display([&](int) { return jitter(random); }) == expected);
    // Ten times the work for two seconds: fewer steps per second, and the same steps.
    CHECK(hash_by_display([](int picture) { return picture < 20 ? 0.01 : 0.2; }) == expected);
  }

  TEST_CASE("as many steps come due as fit into the time, at any rate") {
    for (const double rate : {24.0, 60.0, 144.0, 1000.0}) {
      Clock clock = take(Clock::create({.step_seconds = kStep}));
      for (int i = 0; i < static_cast<int>(100 * rate); ++i) clock.advance(1 / rate);
      CAPTURE(rate);
      CHECK(clock.step_count() >= 5999);  // the last may lack a rounding
      CHECK(clock.step_count() <= 6000);
      CHECK(clock.dropped_step_count() == 0);
    }
  }

  TEST_CASE("a display slower than the steps skips states, a faster one shows between them") {
    Clock slow = take(Clock::create({.step_seconds = 0.01}));
    CHECK(slow.advance(0.035).steps == 3);
    CHECK(slow.skipped_frame_count() == 2);
    CHECK(slow.remainder_seconds() == doctest::Approx(0.005));
    Clock fast = take(Clock::create({.step_seconds = 0.01}));
    CHECK(fast.advance(0.004).steps == 0);
    CHECK(fast.advance(0.004).blend == doctest::Approx(0.8));
    CHECK(fast.advance(0.004).steps == 1);
    CHECK(fast.skipped_frame_count() == 0);
  }

  TEST_CASE("an overload drops time, exactly reported, and is over when it is over") {
    Clock clock = take(Clock::create({.step_seconds = kStep, .catch_up_steps = 4}));
    const Playback playback = play(clock, 6, overloaded);
    CHECK(playback.longest_wait <= 0.001 + 4 * 0.05);
    CHECK(playback.drops[1] > 0);
    CHECK(playback.drops[2] > 0);
    // The picture that was being made when it ended is the last one that was late.
    CHECK(playback.drops[4] == 0);
    CHECK(playback.drops[5] == 0);
    // At 20 steps a second, two seconds lose 80 of 120 steps.
    CHECK(clock.dropped_seconds() == doctest::Approx(2 * (1 - 20 * kStep)).epsilon(0.15));
    const double accounted =
        static_cast<double>(clock.step_count()) * kStep + clock.dropped_seconds() + clock.remainder_seconds();
    CHECK(std::abs(playback.elapsed - accounted) < 1e-12);
  }

  TEST_CASE("without the bound the steps that come due grow threefold each time, as in the paper") {
    // Steps that take r = 3 times their length: each picture owes three times the steps of the one before.
    Clock clock = take(Clock::create({.step_seconds = kStep, .catch_up_steps = 1'000'000}));
    CHECK(clock.advance(kStep).steps == 1);
    int last = 1;
    for (int picture = 1; picture <= 8; ++picture) {
      const int due = clock.advance(3 * kStep * last).steps;
      CHECK(std::abs(due - 3 * last) <= 1);  // a part of a step may be carried over
      last = due;
    }
    CHECK(last > 6000);  // 3^8 = 6561
    CHECK(clock.dropped_step_count() == 0);
  }

  TEST_CASE("any elapsed time gives a finite number of steps and a blend in [0, 1)") {
    Clock clock = take(Clock::create({.step_seconds = kStep}));
    const double infinity = std::numeric_limits<double>::infinity();
    for (const double nothing : {0.0, -1.0, -infinity, std::nan("")}) {
      const Clock::Due due = clock.advance(nothing);
      CHECK(due.steps == 0);
      CHECK(due.blend >= 0);
    }
    CHECK(clock.remainder_seconds() <= 0);
    for (const double huge : {1e7, 1e300, infinity}) {
      const Clock::Due due = clock.advance(huge);
      CHECK(due.steps == 4);
      CHECK(due.dropped >= 59'999'995);
      CHECK(due.dropped <= 59'999'996);
      CHECK(due.blend >= 0);
      CHECK(due.blend < 1);
    }
    clock.reset();
    CHECK(clock.advance(kStep).steps == 1);
  }

  TEST_CASE("a description out of range is refused") {
    for (const double seconds : {0.0, -1.0, 1e-7, 2.0, std::nan("")}) {
      CHECK(Clock::create({.step_seconds = seconds}).error().where == "clock.step_seconds");
    }
    CHECK(Clock::create({.catch_up_steps = 0}).error().where == "clock.catch_up_steps");
    CHECK(Clock::create({.catch_up_steps = 2'000'000}).error().where == "clock.catch_up_steps");
  }

  TEST_CASE("a rotation between two is turned at an even rate, the short way around") {
    const double third = 2 * std::numbers::pi / 3;
    for (const double part : {0.0, 0.25, 0.5, 1.0}) {
      const Quat between = blend(about_z(0.2), about_z(0.2 + third), part);
      const hooke::Vec3 x = rotate(between, hooke::Vec3{Real(1), Real(0), Real(0)});
      CHECK(std::atan2(static_cast<double>(x.y), static_cast<double>(x.x)) ==
            doctest::Approx(0.2 + part * third).epsilon(1e-5));
    }
    // 350 degrees are 10 back.
    const Quat back = blend(Quat{}, about_z(350 * std::numbers::pi / 180), 0.5);
    const hooke::Vec3 x = rotate(back, hooke::Vec3{Real(1), Real(0), Real(0)});
    CHECK(static_cast<double>(x.y) == doctest::Approx(-std::sin(5 * std::numbers::pi / 180)).epsilon(1e-4));
  }

  TEST_CASE("a blend begins and ends at the states themselves, and stays between them") {
    const DVec3 a = {0.1, 0.2, 1e6};
    const DVec3 b = {0.3, -0.7, 1e6 + 1};
    CHECK(blend(a, b, 0) == a);
    CHECK(blend(a, b, 1) == b);
    CHECK(blend(a, b, -3) == a);
    CHECK(blend(a, b, 7) == b);
    CHECK(blend(a, b, std::nan("")) == a);
    CHECK(blend(a, b, 0.5).x == doctest::Approx(0.2));

    World world = gusty_rope();
    const hooke::RopeId rope = take(world.add_rope({.hook_point = {1, 5, 0}}));
    const std::vector<DVec3> before = copy_points(world.positions(rope));
    hooke::test::run(world, 1);
    const std::vector<DVec3> middle = blend(before, world.positions(rope), 0.5);
    REQUIRE(middle.size() == before.size());
    CHECK(middle[15].y == doctest::Approx((before[15].y + world.positions(rope)[15].y) / 2));
  }
}
