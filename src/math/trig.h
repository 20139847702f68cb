#pragma once

namespace hooke::math {

/// Sine, cosine and angle made of + - * / only, so that every compiler and C library gives the same bits.

template <class T>
struct SinCos {
  T sin = T(0);
  T cos = T(1);
};

/// Sine and cosine of `angle` [rad], each within 1e-15 for |angle| up to 1e6. Beyond, the error grows as that
/// of the angle itself does, about 2e-16 |angle|. From 2^53 on, where one cannot tell one turn from the next,
/// the answer is that of angle zero. NaN for NaN and infinity. The sine of -0 is -0.
SinCos<double> sin_cos(double angle);

/// The same, computed in double and rounded.
SinCos<float> sin_cos(float angle);

/// The angle [rad] from the x axis to (x, y), in [-pi, pi], within 1e-15; the signs of zeros count as in IEEE
/// 754: (0, 0) gives 0, (y, x) = (0, -0) gives pi. Infinite arguments point along the axes or the diagonals.
/// NaN for NaN.
double atan2(double y, double x);

/// The same, computed in double and rounded: the float nearest to pi is a little more than pi.
float atan2(float y, float x);

/// atan(t) = t + t z (k[0] + k[1] z + ...) with z = t^2, for t in [0, 1]: the polynomial whose largest
/// relative error, 1.1e-7, is least (Remez' exchange). Kernels of many lanes use it too.
inline constexpr float kArctangent[7] = {-0.3333239159f,  0.1997421407f,  -0.140413277f,   0.09968472985f,
                                         -0.06020312876f, 0.02473406228f, -0.004822533899f};

/// atan2 in float arithmetic throughout, for a tenth of the time: within 4e-7 of the angle, relatively. Signs
/// of zeros and infinities do not count as in IEEE 754; (0, 0) gives 0.
float quick_atan2(float y, float x);

/// In double nothing is gained: atan2.
double quick_atan2(double y, double x);

}  // namespace hooke::math
