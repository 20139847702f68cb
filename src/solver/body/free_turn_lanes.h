/// The midpoint rule for gyroscopic turns in the Numbers of solver/simd/numbers.h. Included anew for each
/// instruction set.

#if defined(HOOKE_SOLVER_BODY_FREE_TURN_LANES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_BODY_FREE_TURN_LANES_H
#undef HOOKE_SOLVER_BODY_FREE_TURN_LANES_H
#else
#define HOOKE_SOLVER_BODY_FREE_TURN_LANES_H
#endif

#include "solver/body/body_tuning.h"
#include "solver/body/free_turn_kernels.h"
#include "solver/simd/numbers.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

template <class Number>
HWY_INLINE Triple<Number> turned_by_quaternion(const Quad<Number>& q, const Triple<Number>& v) {
  const Triple<Number> u = {q.x, q.y, q.z};
  const Triple<Number> t = scaled(Number(Real(2)), cross(u, v));
  return sum(sum(v, scaled(q.w, t)), cross(u, t));
}
template <class Number>
HWY_INLINE Triple<Number> turned_back(const Quad<Number>& q, const Triple<Number>& v) {
  const Number zero(Real(0));
  return turned_by_quaternion(Quad<Number>{zero - q.x, zero - q.y, zero - q.z, q.w}, v);
}
template <class Number>
HWY_INLINE Triple<Number> entrywise(const Triple<Number>& a, const Triple<Number>& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// Does the same as math::quaternion_of up to a quarter radian, by the same terms.
template <class Number>
HWY_INLINE Quad<Number> small_turn(const Triple<Number>& phi) {
  const Triple<Number> half = scaled(Number(Real(0.5)), phi);
  const Number x2 = dot(half, half);
  const Number one(Real(1));
  const auto term = [&](double divisor) HWY_ATTR { return Number(static_cast<Real>(1 / divisor)) * x2; };
  const Number sine = one - term(6) * (one - term(20) * (one - term(42) * (one - term(72))));
  const Number cosine = one - term(2) * (one - term(12) * (one - term(30) * (one - term(56))));
  return {sine * half.x, sine * half.y, sine * half.z, cosine};
}

template <class Number>
HWY_INLINE void turn_lanes_freely(Real h, int lane, TurnLanes& turns) {
  const Quad<Number> axes = {get<Number>(turns.axes[0] + lane), get<Number>(turns.axes[1] + lane),
                             get<Number>(turns.axes[2] + lane), get<Number>(turns.axes[3] + lane)};
  const Triple<Number> inverse = get3<Number>(turns.inverse, lane);
  const Triple<Number> local = turned_back(axes, get3<Number>(turns.momentum, lane));
  const Number half_step(Real(0.5) * h);
  Triple<Number> omega = entrywise(inverse, local);
  for (int i = 0; i < kMidpointIterations; ++i) {
    const Quad<Number> turn = small_turn(scaled(half_step, omega));
    omega = turned_by_quaternion(turn, entrywise(inverse, turned_back(turn, local)));
  }
  put3(turned_by_quaternion(axes, omega), turns.omega, lane);
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
