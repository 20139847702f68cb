#include "hooke/view/picture_pace.h"

#include <doctest/doctest.h>

namespace hooke::app {

namespace {

using namespace std::chrono_literals;
using Time = PicturePace::Clock::time_point;

/// Draws pictures for a time while everything moves. A picture takes `full_ms` with all pixels.
double scale_after(PicturePace& pace, Time& now, double full_ms, int count, int width = 1280) {
  double scale = 1;
  for (int i = 0; i < count; ++i) {
    pace.wake(now);
    CHECK(pace.is_due(now));
    scale = pace.scale(now, width);
    const double picture_ms = 4 + (full_ms - 4) * scale * scale;
    pace.drew(now, picture_ms);
    now += std::chrono::microseconds(static_cast<int>(1000 * picture_ms));
  }
  return scale;
}

}  // namespace

TEST_SUITE("session/picture_pace") {
  TEST_CASE("pictures that are quick enough have all pixels") {
    PicturePace pace;
    Time now = PicturePace::Clock::now();
    CHECK(scale_after(pace, now, 40, 100) == 1);
  }

  TEST_CASE("slow pictures get fewer pixels until 20 are drawn a second, and all of them again") {
    PicturePace pace;
    Time now = PicturePace::Clock::now();
    const double scale = scale_after(pace, now, 80, 100);
    CHECK(scale < 0.75);
    CHECK(4 + 76 * scale * scale < 46);
    CHECK(scale_after(pace, now, 20, 100) == 1);
  }

  TEST_CASE("objects can be told apart in a small window, and a large one is drawn in time") {
    PicturePace pace;
    Time now = PicturePace::Clock::now();
    CHECK(scale_after(pace, now, 1000, 100) * 1280 >= 700);
    CHECK(scale_after(pace, now, 500, 100, 3840) < 0.35);
  }

  TEST_CASE("what rests is drawn once with all pixels, and not again until something changes") {
    PicturePace pace;
    Time now = PicturePace::Clock::now();
    CHECK(scale_after(pace, now, 100, 100) < 1);
    now += 400ms;
    CHECK(pace.scale(now, 1280) < 1);
    now += 200ms;
    REQUIRE(pace.is_due(now));
    CHECK(pace.scale(now, 1280) == 1);
    pace.drew(now, 100);
    CHECK_FALSE(pace.is_due(now + 1h));
    pace.wake(now + 2h);
    CHECK(pace.is_due(now + 2h));
    CHECK(pace.scale(now + 2h, 1280) < 1);
  }

  TEST_CASE("a scale that is asked for stays") {
    PicturePace pace(0.5);
    Time now = PicturePace::Clock::now();
    CHECK(scale_after(pace, now, 10, 20) == 0.5);
    CHECK(pace.scale(now + 1h, 1280) == 0.5);
  }
}

}  // namespace hooke::app
