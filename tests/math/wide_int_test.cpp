#include "math/wide_int.h"

#include <doctest/doctest.h>

using hooke::math::Int128;
using hooke::math::WideInt;

TEST_SUITE("math/wide_int") {
  constexpr Int128 kBig = (Int128{1} << 126) - 12345;  // positive, 126 bits

  TEST_CASE("sums and products agree with the built-in integers where those reach") {
    const Int128 samples[] = {
        0, 1, -1, 7, -13, Int128{1} << 62, -(Int128{1} << 62) - 5, (Int128{3} << 61) + 11};
    for (const Int128 a : samples) {
      for (const Int128 b : samples) {
        CHECK(WideInt(a) + WideInt(b) == WideInt(a + b));
        CHECK(WideInt(a) - WideInt(b) == WideInt(a - b));
        CHECK(WideInt(a) * WideInt(b) == WideInt(a * b));
        CHECK((WideInt(a) - WideInt(b)).sign() == (a > b ? 1 : a < b ? -1 : 0));
      }
    }
  }

  TEST_CASE("products beyond 128 bits keep every bit") {
    const WideInt a = kBig;
    const WideInt b = kBig - 1;
    // (a - b)(a + b) = a^2 - b^2, then the same times a + b: 378 bits.
    CHECK((a - b) * (a + b) == a * a - b * b);
    CHECK((a * a - b * b).sign() == 1);
    const WideInt a2 = a * a;
    const WideInt b2 = b * b;
    CHECK((a2 - b2) * (a + b) == a2 * a + a2 * b - b2 * a - b2 * b);
    // x (x + 2) - (x + 1)^2 = -1, whatever the size.
    const WideInt x = a * a * a;
    CHECK(x * WideInt(0) == WideInt());
    CHECK(a * (a + WideInt(2)) - (a + WideInt(1)) * (a + WideInt(1)) == WideInt(-1));
    CHECK((-x).sign() == -1);
    CHECK(-(-x) == x);
  }

  TEST_CASE("the double next to it") {
    CHECK(WideInt(0).approximate() == 0.0);
    CHECK(WideInt(-3).approximate() == -3.0);
    const double big = static_cast<double>(kBig);
    const WideInt a = kBig;
    CHECK(a.approximate() == doctest::Approx(big).epsilon(1e-15));
    CHECK((a * a * a).approximate() == doctest::Approx(big * big * big).epsilon(1e-15));
    CHECK((-(a * a)).approximate() == doctest::Approx(-big * big).epsilon(1e-15));
    CHECK((WideInt(Int128{1} << 100) * WideInt(Int128{1} << 100)).approximate() == 0x1p200);
  }
}
