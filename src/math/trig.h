#pragma once

namespace hooke::math {

/// Sine, cosine and arctangent use only + - * /, so that every compiler and C library gives the same bits.

template <class T>
struct SinCos {
  T sin = T(0);
  T cos = T(1);
};

/// Returns sine and cosine of `angle` [rad], each within 1e-15 for |angle| up to 1e6. Beyond, the error grows
/// as the spacing of doubles does, about 2e-16 |angle|. From 2^53 on, where doubles no longer resolve a turn,
/// the result is that of angle zero. NaN and infinity give NaN. The sine of -0 is -0.
SinCos<double> sin_cos(double angle);

/// Computes in double and rounds.
SinCos<float> sin_cos(float angle);

/// Returns the angle [rad] from the x axis to (x, y), in [-pi, pi], within 1e-15. Signs of zeros count as in
/// IEEE 754: (0, 0) gives 0, (y, x) = (0, -0) gives pi. Infinite arguments point along the axes or the
/// diagonals. NaN gives NaN.
double atan2(double y, double x);

/// Computes in double and rounds. The float nearest to pi is a little more than pi.
float atan2(float y, float x);

/// These are the coefficients of atan(t) = t + t z (k[0] + k[1] z + ...) with z = t^2, for t in [0, 1]. The
/// polynomial has the least largest relative error, 1.1e-7 (Remez exchange). Kernels of many lanes use it,
/// too.
inline constexpr float kArctangent[7] = {-0.3333239159f,  0.1997421407f,  -0.140413277f,   0.09968472985f,
                                         -0.06020312876f, 0.02473406228f, -0.004822533899f};

/// Computes atan2 in float throughout, in a tenth of the time and within a relative error of 4e-7. Signs of
/// zeros and infinities do not count as in IEEE 754; (0, 0) gives 0.
float quick_atan2(float y, float x);

/// Calls atan2, because a shorter series would save nothing in double.
double quick_atan2(double y, double x);

}  // namespace hooke::math
