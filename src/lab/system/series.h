#pragma once

#include "math/trig.h"

#include <array>
#include <cmath>

namespace hooke::lab {

/// A Series is a number as a function of one variable, by the first N coefficients of its power series, c0 +
/// c1 t + c2 t^2 + ... A formula written as a template and evaluated on Series gives exact derivatives,
/// without a second formula: along any direction with N = 2, in time, one order after the other, with more.
/// The recurrences are those of Moore 1966, "Interval Analysis", chapter 11. Comparisons use c0 alone.
template <int N>
struct Series {
  std::array<double, N> c = {};

  Series() = default;
  Series(double value) { c[0] = value; }  // NOLINT(google-explicit-constructor): a number is a constant
  Series(double value, double slope) : c{value, slope} {}

  friend bool operator<(const Series& a, const Series& b) { return a.c[0] < b.c[0]; }
  friend bool operator>(const Series& a, const Series& b) { return a.c[0] > b.c[0]; }

  friend Series operator-(Series a) {
    for (double& x : a.c) x = -x;
    return a;
  }
  friend Series operator+(Series a, const Series& b) {
    for (int i = 0; i < N; ++i) a.c[i] += b.c[i];
    return a;
  }
  friend Series operator-(Series a, const Series& b) {
    for (int i = 0; i < N; ++i) a.c[i] -= b.c[i];
    return a;
  }
  friend Series operator*(const Series& a, const Series& b) {
    Series r;
    for (int i = 0; i < N; ++i) {
      for (int j = 0; j <= i; ++j) r.c[i] += a.c[j] * b.c[i - j];
    }
    return r;
  }
  /// Solves q b = a for q, from the lowest coefficient on.
  friend Series operator/(const Series& a, const Series& b) {
    Series q;
    for (int i = 0; i < N; ++i) {
      double rest = a.c[i];
      for (int j = 0; j < i; ++j) rest -= q.c[j] * b.c[i - j];
      q.c[i] = rest / b.c[0];
    }
    return q;
  }
  /// Solves r r = a for r, from the lowest coefficient on; `a` must be positive.
  friend Series sqrt(const Series& a) {
    Series r;
    r.c[0] = std::sqrt(a.c[0]);
    for (int i = 1; i < N; ++i) {
      double rest = a.c[i];
      for (int j = 1; j < i; ++j) rest -= r.c[j] * r.c[i - j];
      r.c[i] = rest / (2 * r.c[0]);
    }
    return r;
  }
  /// Integrates theta' = (x y' - y x') / (x^2 + y^2) term by term.
  friend Series atan2(const Series& y, const Series& x) {
    const Series rate = (x * derivative(y) - y * derivative(x)) / (x * x + y * y);
    Series angle(math::atan2(y.c[0], x.c[0]));
    for (int i = 1; i < N; ++i) angle.c[i] = rate.c[i - 1] / i;
    return angle;
  }

 private:
  /// One coefficient is lost, so that the last is zero.
  static Series derivative(const Series& a) {
    Series r;
    for (int i = 1; i < N; ++i) r.c[i - 1] = i * a.c[i];
    return r;
  }
};

}  // namespace hooke::lab
