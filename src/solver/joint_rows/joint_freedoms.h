/// Values of a hook's freedoms, and the directions along which they change, in the Numbers of
/// solver/simd/numbers.h, as solver/joint_rows/joint_rows.h has them. Included anew for each instruction
/// set.

#if defined(HOOKE_SOLVER_JOINT_ROWS_JOINT_FREEDOMS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_JOINT_ROWS_JOINT_FREEDOMS_H
#undef HOOKE_SOLVER_JOINT_ROWS_JOINT_FREEDOMS_H
#else
#define HOOKE_SOLVER_JOINT_ROWS_JOINT_FREEDOMS_H
#endif

#include "hooke/desc.h"

#include "solver/joint_rows/joint_rows.h"
#include "solver/simd/numbers.h"
#include "solver/simd/symmetric_lanes.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

// The freedoms of a hook have numbers from 0 to 5; balls have a cone and a twist besides.
constexpr int kTwistFreedom = 3;
constexpr int kConeFreedom = 6;
constexpr int kBallTwist = 7;
constexpr int kFreedomCount = 8;

/// An end of a joint, as JointBody has it.
template <class Number>
struct JointEnd {
  Triple<Number> center, ahead;
  Quad<Number> rotation;
  Scale<Number> scale;
};

/// The places and axes by which a hook holds its ends, as HookPlace has them.
template <class Number>
struct HookFrame {
  Triple<Number> anchor_a, anchor_b;
  Quad<Number> axes_a, axes_b;
};

/// Directions and values of a hook's freedoms.
template <class Number>
struct Freedoms {
  bool is_ball;
  Triple<Number> r_a, r_b;  ///< Offsets from the centers of mass to b's anchor.
  Triple<Number> axis[kFreedomCount];
  Number value[kFreedomCount];
};

template <class Number>
HWY_INLINE Number size_of_number(const Number& x) {
  return larger(x, Number(0.0) - x);
}

/// The whole turns nearest to an angle. Adding 1.5 * 2^52, or 2^23 to a float, leaves a whole number.
template <class Number>
HWY_INLINE Number whole_turns_of(const Number& angle) {
  constexpr double kTurn = 0x1.921fb54442d18p+2;
  const Number magic(kIsSingle<Number> ? 0x1.8p+23 : 0x1.8p+52);
  return Number(kTurn) * ((Number(1 / kTurn) * angle + magic) - magic);
}

/// Computes p := p x + c, coefficient after coefficient.
template <class Number, int kSize>
HWY_INLINE Number polynomial(const Number& x, const double (&coefficients)[kSize]) {
  Number p(coefficients[0]);
  for (int i = 1; i < kSize; ++i) p = p * x + Number(coefficients[i]);
  return p;
}

/// The angle from the x axis to (x, y) within 4e-16 rad; (0, 0) gives 0. It is a rational function of Cephes
/// (Moshier 1989) on [-0.21, 0.66], to which quotients of up to 1 are brought by a rotation of 45 degrees.
template <class Number>
HWY_INLINE Number angle_of(const Number& y, const Number& x) {
  constexpr double kAbove[5] = {-8.750608600031904122785e-1, -1.615753718733365076637e1,
                                -7.500855792314704667340e1, -1.228866684490136173410e2,
                                -6.485021904942025371773e1};
  constexpr double kBelow[6] = {1,
                                2.485846490142306297962e1,
                                1.650270098316988542046e2,
                                4.328810604912902668951e2,
                                4.853903996359136964868e2,
                                1.945506571482613964425e2};
  constexpr double kQuarterPi = 0x1.921fb54442d18p-1;
  const Number zero(0.0);
  const Number size_x = size_of_number(x);
  const Number size_y = size_of_number(y);
  const Number more = larger(size_x, size_y);
  const Number less = smaller(size_x, size_y);
  const auto turned = above(less, Number(0.66) * more);
  const Number above_line = choose(turned, less - more, less);
  const Number along = choose(turned, less + more, more);
  const Number t = choose(above(along, zero), quotient(above_line, along), zero);
  const Number z = t * t;
  const Number fraction = quotient(z * polynomial(z, kAbove), polynomial(z, kBelow));
  Number angle = choose(turned, Number(kQuarterPi), zero) + (t + t * fraction);
  angle = choose(above(size_y, size_x), Number(2 * kQuarterPi) - angle, angle);
  angle = choose(above(zero, x), Number(4 * kQuarterPi) - angle, angle);
  return choose(above(zero, y), zero - angle, angle);
}

template <class Number>
HWY_INLINE Quad<Number> product(const Quad<Number>& a, const Quad<Number>& b) {
  return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}
template <class Number>
HWY_INLINE Quad<Number> conjugate_of(const Quad<Number>& q) {
  const Number zero(0.0);
  return {zero - q.x, zero - q.y, zero - q.z, q.w};
}
template <class Number>
HWY_INLINE Quad<Number> normalized(const Quad<Number>& q) {
  const Number s = quotient(Number(1.0), root(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w));
  return {s * q.x, s * q.y, s * q.z, s * q.w};
}
template <class Number>
HWY_INLINE Triple<Number> rotated(const Quad<Number>& q, const Triple<Number>& v) {
  const Triple<Number> u = {q.x, q.y, q.z};
  const Triple<Number> t = scaled(Number(2.0), cross(u, v));
  return sum(v, sum(scaled(q.w, t), cross(u, t)));
}

/// The rotation by |phi| about phi, up to some turns: an eighth of it by the series, three times doubled.
template <class Number>
HWY_INLINE Quad<Number> quaternion_of(const Triple<Number>& phi) {
  constexpr double kSine[4] = {-1.0 / 5040, 1.0 / 120, -1.0 / 6, 1};
  constexpr double kCosine[5] = {1.0 / 40320, -1.0 / 720, 1.0 / 24, -1.0 / 2, 1};
  const Triple<Number> half = scaled(Number(1.0 / 16), phi);
  const Number x2 = dot(half, half);
  const Triple<Number> sine = scaled(polynomial(x2, kSine), half);
  Quad<Number> q = {sine.x, sine.y, sine.z, polynomial(x2, kCosine)};
  for (int i = 0; i < 3; ++i) q = product(q, q);
  return normalized(q);
}

/// The rotation by |phi| about phi for up to a quarter of a radian, bit for bit as math::quaternion_of.
template <class Number>
HWY_INLINE Quad<Number> quaternion_of_small(const Triple<Number>& phi) {
  const Number one(1.0);
  const Triple<Number> half = scaled(Number(0.5), phi);
  const Number x2 = dot(half, half);
  const auto term = [&](double divisor) HWY_ATTR { return Number(1 / divisor) * x2; };
  const Number sine = one - term(6) * (one - term(20) * (one - term(42) * (one - term(72))));
  const Number cosine = one - term(2) * (one - term(12) * (one - term(30) * (one - term(56))));
  return {sine * half.x, sine * half.y, sine * half.z, cosine};
}

/// The direction of v; zero for none.
template <class Number>
HWY_INLINE Triple<Number> unit_of(const Triple<Number>& v, const Number& length) {
  const Number zero(0.0);
  return scaled(choose(above(length, zero), quotient(Number(1.0), length), zero), v);
}

template <class Number>
struct Axes {
  Triple<Number> x, y, z;
};
template <class Number>
HWY_INLINE Axes<Number> axes_of(const Quad<Number>& q) {
  const Number zero(0.0);
  const Number one(1.0);
  return {rotated(q, {one, zero, zero}), rotated(q, {zero, one, zero}), rotated(q, {zero, zero, one})};
}

/// Takes the rotation from a's axes to b's apart as angles about a's x, then y, then b's z. They go on
/// beyond whole turns: of equivalent angles, those next to the last values are taken.
template <class Number>
HWY_INLINE void take_apart(const Axes<Number>& a, const Axes<Number>& b, const Triple<Number>& before,
                           Freedoms<Number>& f) {
  const Number zero(0.0);
  const Number one(1.0);
  const Number sine = zero - dot(a.y, b.z);
  const Number cosine = dot(a.z, b.z);
  const Number size = root(sine * sine + cosine * cosine);
  f.value[3] = angle_of(sine, cosine);
  f.value[4] = angle_of(dot(a.x, b.z), size);
  f.value[5] = angle_of(zero - dot(a.x, b.y), dot(a.x, b.x));
  const auto turned = above(size, zero);
  const Number inverse_size = quotient(one, size);
  const Number c = choose(turned, cosine * inverse_size, one);
  const Number s = choose(turned, sine * inverse_size, zero);
  const Triple<Number> y = sum(scaled(c, a.y), scaled(s, a.z));
  const Triple<Number> across = cross(y, b.z);
  const Number scale = quotient(one, larger(dot(a.x, across), Number(kLeastAngleCosine)));
  f.axis[3] = scaled(scale, across);
  f.axis[4] = y;
  f.axis[5] = scaled(scale, cross(a.x, y));
  f.value[3] = f.value[3] + whole_turns_of(before.x - f.value[3]);
  f.value[4] = f.value[4] + whole_turns_of(before.y - f.value[4]);
  f.value[5] = f.value[5] + whole_turns_of(before.z - f.value[5]);
}

/// Finds the rotation vector, cone and twist of a ball.
template <class Number>
HWY_INLINE void take_apart_ball(const Axes<Number>& a, const Quad<Number>& q_a, const Quad<Number>& q_b,
                                Freedoms<Number>& f) {
  const Number zero(0.0);
  Quad<Number> q = product(conjugate_of(q_a), q_b);
  const Number sign = choose(above(zero, q.w), Number(-1.0), Number(1.0));
  q = {sign * q.x, sign * q.y, sign * q.z, sign * q.w};
  const Number s = root(q.x * q.x + q.y * q.y + q.z * q.z);
  const Number two(2.0);
  const Number scale = choose(above(s, Number(1e-12)), quotient(two * angle_of(s, q.w), s), two);
  f.axis[3] = a.x;
  f.axis[4] = a.y;
  f.axis[5] = a.z;
  f.value[3] = scale * q.x;
  f.value[4] = scale * q.y;
  f.value[5] = scale * q.z;

  const Triple<Number> b_x = rotated(q_b, {Number(1.0), zero, zero});
  const Triple<Number> across = cross(a.x, b_x);
  const Number size = root(dot(across, across));
  f.value[kConeFreedom] = angle_of(size, dot(a.x, b_x));
  f.axis[kConeFreedom] = unit_of(across, size);

  const Triple<Number> both = sum(a.x, b_x);
  f.value[kBallTwist] = two * angle_of(q.x, q.w);
  f.axis[kBallTwist] = scaled(quotient(two, larger(dot(both, both), Number(kLeastAngleCosine))), both);
}

/// Finds angles only if something depends on them; `before` are those of the last time.
template <class Number>
HWY_INLINE Freedoms<Number> find_freedoms(HookKind kind, bool turns, const HookFrame<Number>& hook,
                                          const JointEnd<Number>& a, const JointEnd<Number>& b,
                                          const Triple<Number>& before) {
  Freedoms<Number> f;
  f.is_ball = kind == HookKind::kBall;
  const Triple<Number> arm_a = rotated(a.rotation, hook.anchor_a);
  f.r_b = rotated(b.rotation, hook.anchor_b);
  f.r_a = sum(difference(b.center, a.center), f.r_b);
  const Triple<Number> d = difference(f.r_a, arm_a);
  f.r_a = sum(f.r_a, a.ahead);
  f.r_b = sum(f.r_b, b.ahead);
  const Quad<Number> q_a = product(a.rotation, hook.axes_a);
  const Axes<Number> axes_a = axes_of(q_a);
  f.axis[0] = axes_a.x;
  f.axis[1] = axes_a.y;
  f.axis[2] = axes_a.z;
  for (int i = 0; i < 3; ++i) f.value[i] = dot(d, f.axis[i]);
  if (kind == HookKind::kDistance) {
    const Number length = root(dot(d, d));
    const auto apart = above(length, Number(1e-9));
    const Triple<Number> n = unit_of(d, length);
    f.value[0] = length;
    f.axis[0] = {choose(apart, n.x, f.axis[0].x), choose(apart, n.y, f.axis[0].y),
                 choose(apart, n.z, f.axis[0].z)};
  }
  if (!turns) return f;
  const Quad<Number> q_b = product(b.rotation, hook.axes_b);
  if (f.is_ball) {
    take_apart_ball(axes_a, q_a, q_b, f);
  } else {
    take_apart(axes_a, axes_of(q_b), before, f);
  }
  return f;
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
