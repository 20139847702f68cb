/// The arithmetic of ball hooks, in Numbers of solver/simd/numbers.h. Included again for each instruction
/// set.

#if defined(HOOKE_SOLVER_JOINT_BALL_JOINT_ROWS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_JOINT_BALL_JOINT_ROWS_H
#undef HOOKE_SOLVER_JOINT_BALL_JOINT_ROWS_H
#else
#define HOOKE_SOLVER_JOINT_BALL_JOINT_ROWS_H
#endif

#include "solver/joint/ball_joint_kernels.h"
#include "solver/simd/numbers.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

template <class Number>
HWY_INLINE Scale<Number> get6(const Real (&from)[6][kLanes], int i) {
  return {get<Number>(from[0] + i), get<Number>(from[1] + i), get<Number>(from[2] + i),
          get<Number>(from[3] + i), get<Number>(from[4] + i), get<Number>(from[5] + i)};
}

/// The rows j_x, j_y, j_z of one body.
template <class Number>
struct BallRows {
  Triple<Number> x, y, z;

  HWY_INLINE Triple<Number> rates(const Triple<Number>& omega) const {
    return {dot(x, omega), dot(y, omega), dot(z, omega)};
  }
};

template <class Number>
HWY_INLINE BallRows<Number> rows_of(const Scale<Number>& scale, const Triple<Number>& arm) {
  const Number zero(Real(0));
  return {scale.times({zero, arm.z, zero - arm.y}), scale.times({zero - arm.z, zero, arm.x}),
          scale.times({arm.y, zero - arm.x, zero})};
}
template <class Number>
HWY_INLINE BallRows<Number> get_rows(const Real (&from)[3][3][kLanes], int i) {
  return {get3<Number>(from[0], i), get3<Number>(from[1], i), get3<Number>(from[2], i)};
}
template <class Number>
HWY_INLINE void put_rows(const BallRows<Number>& rows, Real (&to)[3][3][kLanes], int i) {
  put3(rows.x, to[0], i);
  put3(rows.y, to[1], i);
  put3(rows.z, to[2], i);
}
template <class Number>
HWY_INLINE BallRows<Number> difference(const BallRows<Number>& a, const BallRows<Number>& b) {
  return {difference(a.x, b.x), difference(a.y, b.y), difference(a.z, b.z)};
}

/// The sum of c[k] y^k.
template <class Number, int kCount>
HWY_INLINE Number polynomial(const Real (&c)[kCount], Number y) {
  Number value(c[kCount - 1]);
  for (int k = kCount - 2; k >= 0; --k) value = Number(c[k]) + y * value;
  return value;
}

/// How far `arm` moves when the rotation vector theta turns it. More than a whole turn in one step counts as
/// none.
template <class Number>
HWY_INLINE Triple<Number> turned_by(const Triple<Number>& theta, const Triple<Number>& arm) {
  // sin x / x and cos x in powers of x^2, up to x = pi: error 1e-8.
  constexpr Real kSine[] = {Real(1),
                            Real(-1.0 / 6),
                            Real(1.0 / 120),
                            Real(-1.0 / 5040),
                            Real(1.0 / 362880),
                            Real(-1.0 / 39916800),
                            Real(1.0 / 6227020800.0),
                            Real(-1.0 / 1307674368000.0),
                            Real(1.0 / 355687428096000.0)};
  constexpr Real kCosine[] = {Real(1),
                              Real(-1.0 / 2),
                              Real(1.0 / 24),
                              Real(-1.0 / 720),
                              Real(1.0 / 40320),
                              Real(-1.0 / 3628800),
                              Real(1.0 / 479001600.0),
                              Real(-1.0 / 87178291200.0),
                              Real(1.0 / 20922789888000.0),
                              Real(-1.0 / 6402373705728000.0)};
  const Triple<Number> half = scaled(Number(Real(0.5)), theta);
  const Number square = dot(half, half);
  const auto whole = above(square, Number(Real(9.8696)));
  const Number y = choose(whole, Number(Real(0)), square);
  const Triple<Number> u = scaled(choose(whole, Number(Real(0)), polynomial(kSine, y)), half);
  const Triple<Number> t = scaled(Number(Real(2)), cross(u, arm));
  return sum(scaled(polynomial(kCosine, y), t), cross(u, t));
}

/// K^-1 by cofactors; K is positive definite.
template <class Number, bool kAnchored>
HWY_INLINE Scale<Number> mass_of(Number w, const BallRows<Number>& a, const BallRows<Number>& b) {
  const auto entry = [&](const Triple<Number>& a_e, const Triple<Number>& a_f, const Triple<Number>& b_e,
                         const Triple<Number>& b_f) HWY_ATTR {
    if constexpr (kAnchored) return dot(a_e, a_f);
    return dot(a_e, a_f) + dot(b_e, b_f);
  };
  const Number xx = w + entry(a.x, a.x, b.x, b.x);
  const Number xy = entry(a.x, a.y, b.x, b.y);
  const Number xz = entry(a.x, a.z, b.x, b.z);
  const Number yy = w + entry(a.y, a.y, b.y, b.y);
  const Number yz = entry(a.y, a.z, b.y, b.z);
  const Number zz = w + entry(a.z, a.z, b.z, b.z);
  const Number c_x = yy * zz - yz * yz;
  const Number c_y = xz * yz - xy * zz;
  const Number c_z = xy * yz - xz * yy;
  const Number s = quotient(Number(Real(1)), xx * c_x + (xy * c_y + xz * c_z));
  return {
      s * c_x, s * c_y, s * c_z, s * (xx * zz - xz * xz), s * (xy * xz - xx * yz), s * (xx * yy - xy * xy)};
}

/// Applies three impulses to the bodies' rotation.
template <class Number, bool kAnchored>
HWY_INLINE void turn(const Triple<Number>& p, const BallRows<Number>& a, const BallRows<Number>& b,
                     Bodies<Number, kAnchored>& bodies) {
  bodies.turn(p.x, a.x, b.x);
  bodies.turn(p.y, a.y, b.y);
  bodies.turn(p.z, a.z, b.z);
}

/// Applies them to the bodies' velocity.
template <class Number, bool kAnchored>
HWY_INLINE void push(const Triple<Number>& p, const BallBlock& block, int lane,
                     Bodies<Number, kAnchored>& bodies) {
  take(get<Number>(block.w_a + lane), p, bodies.a.v);
  if constexpr (!kAnchored) add(get<Number>(block.w_b + lane), p, bodies.b.v);
}

template <class Number, bool kAnchored>
HWY_INLINE Triple<Number> parting(const BallRows<Number>& a, const BallRows<Number>& b,
                                  const Bodies<Number, kAnchored>& bodies) {
  return sum(difference(bodies.b.v, bodies.a.v),
             difference(b.rates(bodies.b.omega), a.rates(bodies.a.omega)));
}

/// The part of `change` that keeps the impulse `before` within what the hook can take.
template <class Number>
HWY_INLINE Triple<Number> capped(const Triple<Number>& before, const Triple<Number>& change,
                                 const BallBlock& block, int lane) {
  const Number strength = get<Number>(block.strength + lane);
  const Triple<Number> impulse = sum(before, change);
  const Number square = dot(impulse, impulse);
  const auto over = above(square, strength * strength);
  const Triple<Number> less = difference(scaled(quotient(strength, root(square)), impulse), before);
  return {choose(over, less.x, change.x), choose(over, less.y, change.y), choose(over, less.z, change.z)};
}

/// A hook that needs more than it can take, as in the last substep too, breaks.
template <class Number>
HWY_INLINE void note_need(const Triple<Number>& needed, BallBlock& block, int lane) {
  const Number zero(Real(0));
  const Number one(Real(1));
  const Number size = root(dot(needed, needed));
  const Number least = smaller(size, get<Number>(block.size + lane));
  const Number strength = get<Number>(block.strength + lane);
  const Number was_broken = get<Number>(block.broken + lane);
  const auto whole = above(one, was_broken);
  const auto breaks = above(least, strength);
  const Number held = get<Number>(block.held + lane);
  write(size, block.size + lane);
  write(choose(whole, held + one, held), block.held + lane);
  write(choose(whole, size, get<Number>(block.needed + lane)), block.needed + lane);
  write(choose(breaks, one, was_broken), block.broken + lane);
  write(choose(breaks, zero, strength), block.strength + lane);
}

/// Applies the impulses of the last substep at the start of a step, in which bodies carry nothing over yet.
template <class Number, bool kAnchored>
HWY_INLINE void warm_start_ball_lanes(BallBlock& block, int lane, Real* motion) {
  MovingBodies<Number, kAnchored> pair(block, lane, motion);
  Bodies<Number, kAnchored>& bodies = pair.velocity;
  const Triple<Number> gap = get3<Number>(block.gap, lane);
  const BallRows<Number> a =
      rows_of(get6<Number>(block.scale_a, lane), sum(get3<Number>(block.arm_a, lane), gap));
  const BallRows<Number> b = rows_of(get6<Number>(block.scale_b, lane), get3<Number>(block.arm_b, lane));
  put_rows(a, block.j_a, lane);
  put_rows(b, block.j_b, lane);
  const Triple<Number> impulse = get3<Number>(block.impulse, lane);
  turn(impulse, a, b, bodies);
  push(impulse, block, lane, bodies);
  pair.write_back(block, lane, motion);
}

template <class Number, bool kAnchored>
HWY_INLINE void solve_ball_lanes(BallBlock& block, int lane, const BallPass& pass, Real* motion) {
  MovingBodies<Number, kAnchored> pair(block, lane, motion);
  Bodies<Number, kAnchored>& bodies = pair.velocity;
  const Scale<Number> scale_a = get6<Number>(block.scale_a, lane);
  const Scale<Number> scale_b = get6<Number>(block.scale_b, lane);
  const Triple<Number> arm_a = get3<Number>(block.arm_a, lane);
  const Triple<Number> arm_b = get3<Number>(block.arm_b, lane);
  const Triple<Number> by_turn_a = turned_by(scale_a.times(pair.moved_a.theta), arm_a);
  const Triple<Number> by_turn_b = turned_by(scale_b.times(pair.moved_b.theta), arm_b);
  const Triple<Number> gap =
      sum(get3<Number>(block.gap, lane),
          sum(difference(pair.moved_b.dx, pair.moved_a.dx), difference(by_turn_b, by_turn_a)));

  // Both bodies are pushed at B's anchor, so that no moment arises from nothing while the anchors are apart.
  const BallRows<Number> a = rows_of(scale_a, sum(sum(arm_a, by_turn_a), gap));
  const BallRows<Number> b = rows_of(scale_b, sum(arm_b, by_turn_b));
  const Triple<Number> before = get3<Number>(block.impulse, lane);
  turn(before, difference(a, get_rows<Number>(block.j_a, lane)),
       difference(b, get_rows<Number>(block.j_b, lane)), bodies);
  put_rows(a, block.j_a, lane);
  put_rows(b, block.j_b, lane);

  const Number w_a = get<Number>(block.w_a + lane);
  const Number w = kAnchored ? w_a : w_a + get<Number>(block.w_b + lane);
  const Scale<Number> mass = mass_of<Number, kAnchored>(w, a, b);
  const Number parts[6] = {mass.xx, mass.xy, mass.xz, mass.yy, mass.yz, mass.zz};
  for (int k = 0; k < 6; ++k) write(parts[k], block.mass[k] + lane);

  Triple<Number> wish = parting(a, b, bodies);
  add(Number(pass.rate), gap, wish);
  const Triple<Number> solved = mass.times(wish);
  Triple<Number> change = scaled(Number(Real(0) - pass.impulse_scale), before);
  take(Number(pass.mass_scale), solved, change);
  change = capped(before, change, block, lane);
  put3(sum(before, change), block.impulse, lane);
  turn(change, a, b, bodies);
  push(change, block, lane, bodies);
  pair.write_back(block, lane, motion);
}

template <class Number, bool kAnchored>
HWY_INLINE void relax_ball_lanes(BallBlock& block, int lane, Real* motion) {
  MovingBodies<Number, kAnchored> pair(block, lane, motion);
  Bodies<Number, kAnchored>& bodies = pair.velocity;
  const BallRows<Number> a = get_rows<Number>(block.j_a, lane);
  const BallRows<Number> b = get_rows<Number>(block.j_b, lane);
  const Triple<Number> solved = get6<Number>(block.mass, lane).times(parting(a, b, bodies));
  const Triple<Number> before = get3<Number>(block.impulse, lane);
  const Triple<Number> wish = scaled(Number(Real(-1)), solved);
  const Triple<Number> change = capped(before, wish, block, lane);
  turn(change, a, b, bodies);
  push(change, block, lane, bodies);
  pair.write_back(block, lane, motion);

  const Triple<Number> impulse = sum(before, change);
  put3(impulse, block.impulse, lane);
  put3(sum(get3<Number>(block.impulse_sum, lane), impulse), block.impulse_sum, lane);
  note_need(sum(before, wish), block, lane);
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
