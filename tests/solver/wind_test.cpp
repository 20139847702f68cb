#include "solver/air/wind.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

namespace hooke::solver {
namespace {

WindDesc gusty() {
  WindDesc wind;
  wind.velocity = {Real(10), Real(0), Real(0)};
  wind.gust = Real(0.5);
  wind.side_gust = Real(0.2);
  return wind;
}

}  // namespace

TEST_SUITE("solver/wind") {
  TEST_CASE("without gusts the wind is its mean everywhere") {
    WindDesc wind = gusty();
    wind.gust = wind.side_gust = Real(0);
    CHECK(wind_at(wind, {3, 4, 5}, 7.0, 9) == wind.velocity);
  }

  TEST_CASE("gusts stay within their share, reach for it, and have no preferred sign") {
    const WindDesc wind = gusty();
    double least = 1e9, most = -1e9, sum = 0, product = 0;
    const int count = 20000;
    for (int i = 0; i < count; ++i) {
      const Vec3 w = wind_at(wind, {0.37 * i, 0.11 * i, 0}, 0.1 * i, 0);
      const double along = (static_cast<double>(w.x) / 10.0 - 1.0) / 0.5;
      const double across = static_cast<double>(w.z) / 2.0;
      least = std::min(least, along);
      most = std::max(most, along);
      sum += along;
      product += along * across;
      CHECK(std::abs(along) <= 1.0);
      CHECK(std::abs(across) <= 1.0001);
      CHECK(w.y == Real(0));
    }
    CHECK(least < -0.6);
    CHECK(most > 0.6);
    CHECK(std::abs(sum / count) < 0.03);      // mean
    CHECK(std::abs(product / count) < 0.01);  // the two are independent
  }

  TEST_CASE("it changes smoothly in time and place") {
    const WindDesc wind = gusty();
    for (int i = 0; i < 1000; ++i) {
      const double t = 0.01 * i;
      const double here = static_cast<double>(wind_at(wind, {1, 2, 3}, t, 0).x);
      // Steepest slope of the quintic is 1.875 over a correlation time of 0.5 s, from -1 to 1 at most.
      CHECK(std::abs(static_cast<double>(wind_at(wind, {1, 2, 3}, t + 1e-4, 0).x) - here) <=
            5.0 * 2 * 1.875 * 2e-4 + 1e-5);
      CHECK(std::abs(static_cast<double>(wind_at(wind, {1 + 1e-4, 2, 3}, t, 0).x) - here) <=
            5.0 * 2 * 1.875 * 5e-5 + 1e-5);
    }
  }

  TEST_CASE("another seed is another wind") {
    WindDesc other = gusty();
    other.seed = 2;
    CHECK_FALSE(wind_at(gusty(), {0.3, 0, 0}, 0.2, 0) == wind_at(other, {0.3, 0, 0}, 0.2, 0));
  }

  TEST_CASE("the paper's gusts depend on the step and not on the place") {
    WindDesc wind = gusty();
    wind.gusts = WindDesc::Gusts::kPaper;
    CHECK(wind_at(wind, {1, 0, 0}, 0.5, 3) == wind_at(wind, {9, 0, 0}, 0.7, 3));
    CHECK_FALSE(wind_at(wind, {1, 0, 0}, 0.5, 3) == wind_at(wind, {1, 0, 0}, 0.5, 4));
    for (std::uint64_t step = 0; step < 500; ++step) {  // W (1 + 0.5 rand / 100)
      const Real w = wind_at(wind, {}, 0, step).x;
      CHECK(w >= Real(10.0499));
      CHECK(w <= Real(15.0001));
    }
  }
}

}  // namespace hooke::solver
