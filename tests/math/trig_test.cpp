#include "math/trig.h"

#include "base/hash.h"
#include "math/random.h"

#include <cmath>
#include <cstdint>
#include <doctest/doctest.h>
#include <limits>
#include <random>
#include <type_traits>

using hooke::math::sin_cos;

using hooke::test::signed_unit;

namespace {

constexpr double kPi = 3.141592653589793;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double worst_sin_cos_error(double range, int samples) {
  std::mt19937_64 random(1);
  double worst = 0.0;
  for (int i = 0; i < samples; ++i) {
    const double angle = range * signed_unit(random);
    const auto mine = sin_cos(angle);
    worst = std::fmax(worst, std::fabs(mine.sin - std::sin(angle)));
    worst = std::fmax(worst, std::fabs(mine.cos - std::cos(angle)));
  }
  return worst;
}

}  // namespace

TEST_SUITE("math/trig") {
  TEST_CASE("sine and cosine are those of the C library up to a million radians") {
    CHECK(worst_sin_cos_error(0.8, 100000) < 3e-16);
    CHECK(worst_sin_cos_error(10.0, 100000) < 3e-16);
    CHECK(worst_sin_cos_error(1e6, 100000) < 3e-16);
  }

  TEST_CASE("beyond that the error is that of an angle rounded to double") {
    for (const double range : {1e7, 1e9, 1e12, 1e15}) {
      CHECK(worst_sin_cos_error(range, 10000) < 2.3e-16 * range);
    }
    CHECK(sin_cos(1e16).sin == 0.0);
    CHECK(sin_cos(-1e300).cos == 1.0);
  }

  TEST_CASE("near multiples of a quarter turn the small one keeps its digits") {
    for (int quarters = -1000; quarters <= 1000; ++quarters) {
      const double angle = quarters * (kPi / 2.0);
      const bool is_sine_small = quarters % 2 == 0;
      const double mine = is_sine_small ? sin_cos(angle).sin : sin_cos(angle).cos;
      const double theirs = is_sine_small ? std::sin(angle) : std::cos(angle);
      // 1e-22 is the rounding of 1000 times the second part of pi/2; the values are near 1e-16.
      CHECK(std::fabs(mine - theirs) < 1e-22);
    }
  }

  TEST_CASE("zero keeps its sign and what is not finite gives NaN") {
    CHECK(sin_cos(0.0).sin == 0.0);
    CHECK_FALSE(std::signbit(sin_cos(0.0).sin));
    CHECK(std::signbit(sin_cos(-0.0).sin));
    CHECK(sin_cos(-0.0).cos == 1.0);
    for (const double angle : {kInfinity, -kInfinity, std::nan("")}) {
      CHECK(std::isnan(sin_cos(angle).sin));
      CHECK(std::isnan(sin_cos(angle).cos));
    }
  }

  TEST_CASE("tiny angles are their own sine") {
    for (const double angle : {1e-9, 1e-300, 5e-324}) CHECK(sin_cos(angle).sin == angle);
  }

  TEST_CASE("the angle of a vector is that of the C library in all quadrants and at all scales") {
    std::mt19937_64 random(2);
    double worst = 0.0;
    for (int i = 0; i < 100000; ++i) {
      const double scale = std::ldexp(1.0, static_cast<int>(random() % 2000) - 1000);
      const double skew = std::ldexp(1.0, static_cast<int>(random() % 40) - 20);
      const double x = scale * signed_unit(random);
      const double y = skew * scale * signed_unit(random);
      worst = std::fmax(worst, std::fabs(hooke::math::atan2(y, x) - std::atan2(y, x)));
    }
    CHECK(worst < 1e-15);
  }

  TEST_CASE("small angles of vectors keep their digits") {
    for (const double y : {1e-3, -1e-9, 1e-200, 5e-324}) {
      const double theirs = std::atan2(y, 1.0);
      CHECK(std::fabs(hooke::math::atan2(y, 1.0) - theirs) <= 4e-16 * std::fabs(theirs));
    }
  }

  TEST_CASE("the axes, the diagonals, the zeros and the infinities are exact") {
    const double special[] = {0.0, -0.0, 1.0, -1.0, kInfinity, -kInfinity, 5e-324, -1e308};
    for (const double y : special) {
      for (const double x : special) {
        CAPTURE(y);
        CAPTURE(x);
        const double mine = hooke::math::atan2(y, x);
        CHECK(mine == std::atan2(y, x));
        CHECK(std::signbit(mine) == std::signbit(std::atan2(y, x)));
      }
    }
    CHECK(std::isnan(hooke::math::atan2(std::nan(""), 1.0)));
    CHECK(std::isnan(hooke::math::atan2(1.0, std::nan(""))));
  }

  TEST_CASE("float answers are the double answers rounded") {
    static_assert(std::is_same_v<decltype(sin_cos(1.0f).sin), float>);
    CHECK(sin_cos(2.5f).sin == static_cast<float>(std::sin(2.5)));
    CHECK(sin_cos(2.5f).cos == static_cast<float>(std::cos(2.5)));
    CHECK(hooke::math::atan2(1.0f, -2.0f) == static_cast<float>(std::atan2(1.0, -2.0)));
  }

  TEST_CASE("the bits are the recorded ones on every compiler") {
    std::mt19937_64 random(3);
    hooke::base::StateHash hash;
    for (int i = 0; i < 20000; ++i) {
      const double angle = 1e5 * signed_unit(random);
      hash.add(sin_cos(angle).sin);
      hash.add(sin_cos(angle).cos);
      hash.add(hooke::math::atan2(angle, signed_unit(random)));
    }
    CHECK(hash.value() == 13216208774556235252ULL);
  }

  TEST_CASE("the quick arctangent in float is within 4e-7 of the angle, all the way round") {
    double worst = 0.0;
    for (int i = -20000; i <= 20000; ++i) {
      const double angle = i * (kPi / 20000.0) * 0.99999;
      const auto y = static_cast<float>(3e-3 * std::sin(angle));
      const auto x = static_cast<float>(3e-3 * std::cos(angle));
      const double exact = std::atan2(static_cast<double>(y), static_cast<double>(x));
      const double off = std::fabs(static_cast<double>(hooke::math::quick_atan2(y, x)) - exact);
      worst = std::fmax(worst, i == 0 ? 0.0 : off / std::fabs(exact));
    }
    CHECK(worst < 4e-7);
    CHECK(hooke::math::quick_atan2(0.0f, 0.0f) == 0.0f);
    CHECK(hooke::math::quick_atan2(1e-9f, 1.0f) == 1e-9f);
  }
}
