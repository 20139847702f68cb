#include "math/trig.h"

#include <cmath>
#include <cstdint>
#include <limits>

namespace hooke::math {

namespace {

constexpr double kHalfPi = 0x1.921fb54442d18p+0;
constexpr double kHalfPiError = 0x1.1a62633145c07p-54;  // pi/2 - kHalfPi
constexpr double kTwoOverPi = 0x1.45f306dc9c883p-1;

// The head of pi/2 has 33 bits, so that its product with a whole number up to 2^20 is exact.
constexpr double kHalfPiHead = 0x1.921fb54400000p+0;
constexpr double kHalfPiTail = 0x1.0b4611a626331p-34;

constexpr double kManyTurns = 0x1p+20 * kHalfPi;     // 2^18 turns: the largest angle that is reduced exactly
constexpr double kNoPhaseFrom = 9007199254740992.0;  // 2^53

// These are atan(k / 8), rounded to nearest.
constexpr double kArctangents[9] = {0.0,
                                    0x1.fd5ba9aac2f6ep-4,
                                    0x1.f5b75f92c80ddp-3,
                                    0x1.6f61941e4def1p-2,
                                    0x1.dac670561bb4fp-2,
                                    0x1.1e00babdefeb4p-1,
                                    0x1.4978fa3269ee1p-1,
                                    0x1.700a7c5784634p-1,
                                    0x1.921fb54442d18p-1};

/// Returns sin(r + tail) for |r| <= pi/4 by its Taylor series. The remainder is below r^19 / 19! < 1e-19.
double sine_near_zero(double r, double tail) {
  const double z = r * r;
  double p = 1.0 / 355687428096000.0;
  p = -1.0 / 1307674368000.0 + z * p;
  p = 1.0 / 6227020800.0 + z * p;
  p = -1.0 / 39916800.0 + z * p;
  p = 1.0 / 362880.0 + z * p;
  p = -1.0 / 5040.0 + z * p;
  p = 1.0 / 120.0 + z * p;
  p = -1.0 / 6.0 + z * p;
  return r + (r * z * p + tail * (1.0 - 0.5 * z));
}

/// Returns cos(r + tail) for |r| <= pi/4. The remainder is below r^18 / 18! < 1e-17.
double cosine_near_zero(double r, double tail) {
  const double z = r * r;
  double p = 1.0 / 20922789888000.0;
  p = -1.0 / 87178291200.0 + z * p;
  p = 1.0 / 479001600.0 + z * p;
  p = -1.0 / 3628800.0 + z * p;
  p = 1.0 / 40320.0 + z * p;
  p = -1.0 / 720.0 + z * p;
  p = 1.0 / 24.0 + z * p;
  const double head = 1.0 - 0.5 * z;
  return head + (((1.0 - head) - 0.5 * z) + (z * z * p - r * tail));
}

/// Returns atan(t) for t in [0, 1] as atan(c) + atan((t - c) / (1 + t c)), with c the nearest eighth. The
/// series is then taken at |u| <= 1/16, and its remainder is below u^15 / 15 < 1e-19.
double arctangent_of_fraction(double t) {
  const double eighths = std::floor(8.0 * t + 0.5);
  const double c = 0.125 * eighths;
  const double u = (t - c) / (1.0 + t * c);
  const double z = u * u;
  double p = 1.0 / 13.0;
  p = -1.0 / 11.0 + z * p;
  p = 1.0 / 9.0 + z * p;
  p = -1.0 / 7.0 + z * p;
  p = 1.0 / 5.0 + z * p;
  p = -1.0 / 3.0 + z * p;
  return kArctangents[static_cast<int>(eighths)] + (u + u * z * p);
}

}  // namespace

SinCos<double> sin_cos(double angle) {
  if (angle == 0.0) return {angle, 1.0};
  if (!(std::fabs(angle) < kNoPhaseFrom)) {
    if (std::isfinite(angle)) return {0.0, 1.0};
    const double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan};
  }
  if (std::fabs(angle) > kManyTurns) angle -= kManyTurns * std::floor(angle / kManyTurns);
  const double quarters = std::floor(angle * kTwoOverPi + 0.5);
  const double head = angle - quarters * kHalfPiHead;
  const double r = head - quarters * kHalfPiTail;
  const double tail = (head - r) - quarters * kHalfPiTail;
  const double s = sine_near_zero(r, tail);
  const double c = cosine_near_zero(r, tail);
  switch (static_cast<std::int64_t>(quarters) & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

SinCos<float> sin_cos(float angle) {
  const SinCos<double> wide = sin_cos(static_cast<double>(angle));
  return {static_cast<float>(wide.sin), static_cast<float>(wide.cos)};
}

double atan2(double y, double x) {
  if (std::isnan(x) || std::isnan(y)) return std::numeric_limits<double>::quiet_NaN();
  const double size_x = std::fabs(x);
  const double size_y = std::fabs(y);
  const bool is_left = std::signbit(x);
  double angle = 0.0;
  if (size_y > size_x) {
    const double beyond_y_axis = arctangent_of_fraction(size_x / size_y);
    angle = kHalfPi + ((is_left ? beyond_y_axis : -beyond_y_axis) + kHalfPiError);
  } else {
    // Equal sizes include two infinities, whose quotient is not a number.
    const double slope = size_x == size_y ? 1.0 : size_y / size_x;
    const double above_x_axis = size_x > 0.0 ? arctangent_of_fraction(slope) : 0.0;
    angle = is_left ? 2.0 * kHalfPi - (above_x_axis - 2.0 * kHalfPiError) : above_x_axis;
  }
  return std::copysign(angle, y);
}

float atan2(float y, float x) {
  return static_cast<float>(atan2(static_cast<double>(y), static_cast<double>(x)));
}

// Kernels must give the same bits, so the order of operations is that of solver/soft/particle_kernels.cpp.
float quick_atan2(float y, float x) {
  const float size_x = std::fabs(x);
  const float size_y = std::fabs(y);
  const bool is_steep = size_y > size_x;
  const float larger = is_steep ? size_y : size_x;
  const float t = larger > 0.0f ? (is_steep ? size_x : size_y) / larger : 0.0f;
  const float z = t * t;
  const float z2 = z * z;
  const auto pair = [z](int i) { return kArctangent[i] + z * kArctangent[i + 1]; };
  const float p = pair(0) + z2 * (pair(2) + z2 * (pair(4) + z2 * kArctangent[6]));
  float angle = t + (t * z) * p;
  if (is_steep) angle = static_cast<float>(kHalfPi) - angle;
  if (x < 0.0f) angle = static_cast<float>(2.0 * kHalfPi) - angle;
  return std::copysign(angle, y);
}

double quick_atan2(double y, double x) {
  return atan2(y, x);
}

}  // namespace hooke::math
