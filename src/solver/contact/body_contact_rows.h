/// The arithmetic of contact rows, in Numbers of solver/simd/numbers.h. Included again for each instruction
/// set.

#if defined(HOOKE_SOLVER_CONTACT_BODY_CONTACT_ROWS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_CONTACT_BODY_CONTACT_ROWS_H
#undef HOOKE_SOLVER_CONTACT_BODY_CONTACT_ROWS_H
#else
#define HOOKE_SOLVER_CONTACT_BODY_CONTACT_ROWS_H
#endif

#include "solver/contact/body_contact_kernels.h"
#include "solver/contact/contact_tuning.h"
#include "solver/simd/numbers.h"

#include <cstddef>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

/// Solves the rows of the points.
template <class Number, bool kAnchored>
HWY_INLINE void solve_points(ContactBlock& block, int lane, const ContactPass& pass,
                             const Displacement<Number>& moved_a, const Displacement<Number>& moved_b,
                             Bodies<Number, kAnchored>& bodies) {
  const Number zero(Real(0));
  const Number w_a = get<Number>(block.w_a + lane);
  const Number w_b = get<Number>(block.w_b + lane);
  const Number w = kAnchored ? w_a : w_a + w_b;
  const Triple<Number> n = get3<Number>(block.normal, lane);
  Number inverse_h(pass.inverse_h);
  if (!pass.foresees && block.bounces) {
    constexpr Real kNeverReached = Real(1e12);
    const auto bounces = above(get<Number>(block.restitution + lane), zero);
    inverse_h = choose(bounces, Number(kNeverReached), inverse_h);
  }
  const Number closing_speed = dot(n, difference(moved_b.dx, moved_a.dx));
  Number rate = dot(n, difference(bodies.b.v, bodies.a.v));
  Number total(Real(0));
  for (int k = 0; k < block.point_count; ++k) {
    ContactBlock::Point& point = block.point[k];
    const Triple<Number> j_a = get3<Number>(point.j_a, lane);
    const Triple<Number> j_b = get3<Number>(point.j_b, lane);
    const Number s = get<Number>(point.separation + lane) +
                     (closing_speed + (dot(j_b, moved_b.theta) - dot(j_a, moved_a.theta)));
    const auto apart = above(s, zero);
    const Number undo = larger(Number(pass.softness.rate) * s, Number(-kContactPushOutSpeed));
    const Number bias = choose(apart, inverse_h * s, undo);
    const Number mass_scale = choose(apart, Number(Real(1)), Number(pass.softness.mass_scale));
    const Number impulse_scale = choose(apart, zero, Number(pass.softness.impulse_scale));

    // All that does not wait for the previous point comes first.
    const Number before = get<Number>(point.impulse + lane);
    const Number mass = get<Number>(point.mass + lane);
    const Number target = (before - impulse_scale * before) - mass * bias;
    const Number scaled_mass = mass * mass_scale;
    const Number after = larger(target - scaled_mass * bodies.rate(rate, j_a, j_b), zero);
    const Number change = after - before;
    write(after, point.impulse + lane);
    bodies.turn(change, j_a, j_b);
    rate = rate + w * change;
    total = total + change;
  }
  bodies.push(total, n, w_a, w_b);
}

/// Solves twist, then the two directions of the friction disc, within what the impulses of the points allow.
template <class Number, bool kAnchored>
HWY_INLINE void solve_friction(ContactBlock& block, int lane, Bodies<Number, kAnchored>& bodies) {
  const Number zero(Real(0));
  Number load = zero;
  Number twist_limit = zero;
  for (int k = 0; k < block.point_count; ++k) {
    const Number impulse = get<Number>(block.point[k].impulse + lane);
    load = load + impulse;
    twist_limit = twist_limit + get<Number>(block.twist_lever[k] + lane) * impulse;
  }

  write(larger(get<Number>(block.pushed + lane), load), block.pushed + lane);

  const Triple<Number> twist_a = get3<Number>(block.twist_j_a, lane);
  const Triple<Number> twist_b = get3<Number>(block.twist_j_b, lane);
  const Number twist_before = get<Number>(block.twist_impulse + lane);
  const Number twist_wish =
      twist_before - get<Number>(block.twist_mass + lane) * bodies.rate(zero, twist_a, twist_b);
  const Number twist = larger(smaller(twist_wish, twist_limit), zero - twist_limit);
  write(twist, block.twist_impulse + lane);
  bodies.turn(twist - twist_before, twist_a, twist_b);

  const Triple<Number> t_1 = get3<Number>(block.tangent, lane);
  const Triple<Number> t_2 = cross(get3<Number>(block.normal, lane), t_1);
  const Triple<Number> a_1 = get3<Number>(block.friction_j_a[0], lane);
  const Triple<Number> b_1 = get3<Number>(block.friction_j_b[0], lane);
  const Triple<Number> a_2 = get3<Number>(block.friction_j_a[1], lane);
  const Triple<Number> b_2 = get3<Number>(block.friction_j_b[1], lane);
  const Triple<Number> dv = difference(bodies.b.v, bodies.a.v);
  const Number slip_1 = bodies.rate(dot(t_1, dv) + get<Number>(block.surface_speed[0] + lane), a_1, b_1);
  const Number slip_2 = bodies.rate(dot(t_2, dv) + get<Number>(block.surface_speed[1] + lane), a_2, b_2);
  const Number mass_12 = get<Number>(block.friction_mass[1] + lane);
  const Number before_1 = get<Number>(block.friction_impulse[0] + lane);
  const Number before_2 = get<Number>(block.friction_impulse[1] + lane);
  const Number wish_1 = before_1 - (get<Number>(block.friction_mass[0] + lane) * slip_1 + mass_12 * slip_2);
  const Number wish_2 = before_2 - (mass_12 * slip_1 + get<Number>(block.friction_mass[2] + lane) * slip_2);
  const Number size = root(wish_1 * wish_1 + wish_2 * wish_2);
  const auto slides = above(size, get<Number>(block.static_friction + lane) * load);
  const Number shrink = choose(
      slides, quotient(get<Number>(block.friction + lane) * load, choose(slides, size, Number(Real(1)))),
      Number(Real(1)));
  const Number after_1 = shrink * wish_1;
  const Number after_2 = shrink * wish_2;
  write(after_1, block.friction_impulse[0] + lane);
  write(after_2, block.friction_impulse[1] + lane);
  const Number change_1 = after_1 - before_1;
  const Number change_2 = after_2 - before_2;
  bodies.turn(change_1, a_1, b_1);
  bodies.turn(change_2, a_2, b_2);
  const Number w_a = get<Number>(block.w_a + lane);
  const Number w_b = get<Number>(block.w_b + lane);
  bodies.push(change_1, t_1, w_a, w_b);
  bodies.push(change_2, t_2, w_a, w_b);
}

template <class Number, bool kAnchored>
HWY_INLINE void solve_lanes(ContactBlock& block, int lane, const ContactPass& pass, Real* motion) {
  MovingBodies<Number, kAnchored> pair(block, lane, motion);
  Bodies<Number, kAnchored>& bodies = pair.velocity;
  solve_points(block, lane, pass, pair.moved_a, pair.moved_b, bodies);
  if (pass.friction) solve_friction(block, lane, bodies);
  pair.write_back(block, lane, motion);
}

/// Applies the impulses that the block holds to the bodies, with the opposite sign.
template <class Number, bool kAnchored>
HWY_INLINE void take_impulses(const ContactBlock& block, int lane, Bodies<Number, kAnchored>& bodies) {
  const Number zero(Real(0));
  Number total = zero;
  for (int k = 0; k < block.point_count; ++k) {
    const Number impulse = zero - get<Number>(block.point[k].impulse + lane);
    total = total + impulse;
    bodies.turn(impulse, get3<Number>(block.point[k].j_a, lane), get3<Number>(block.point[k].j_b, lane));
  }
  const Number twist = zero - get<Number>(block.twist_impulse + lane);
  bodies.turn(twist, get3<Number>(block.twist_j_a, lane), get3<Number>(block.twist_j_b, lane));
  const Number w_a = get<Number>(block.w_a + lane);
  const Number w_b = get<Number>(block.w_b + lane);
  const Triple<Number> n = get3<Number>(block.normal, lane);
  const Triple<Number> t_1 = get3<Number>(block.tangent, lane);
  const Triple<Number> t[2] = {t_1, cross(n, t_1)};
  bodies.push(total, n, w_a, w_b);
  for (int i = 0; i < 2; ++i) {
    const Number impulse = zero - get<Number>(block.friction_impulse[i] + lane);
    bodies.turn(impulse, get3<Number>(block.friction_j_a[i], lane),
                get3<Number>(block.friction_j_b[i], lane));
    bodies.push(impulse, t[i], w_a, w_b);
  }
}

template <class Number, bool kAnchored>
HWY_INLINE void warm_start_lanes(const ContactBlock& block, int lane, Real* free_motion) {
  Bodies<Number, kAnchored> bodies;
  read_free(free_motion, block.record_a + lane, bodies.a);
  read_free(free_motion, block.record_b + lane, bodies.b);
  take_impulses(block, lane, bodies);
  write_free(bodies.a, free_motion, block.record_a + lane);
  if constexpr (!kAnchored) write_free(bodies.b, free_motion, block.record_b + lane);
}

/// What rows are made from, with A and B in the order of the block.
template <class Number>
struct Inputs {
  Scale<Number> scale_a, scale_b;
  Triple<Number> n;
  Triple<Number> anchor_a[state::Manifold::kMaxPoints], anchor_b[state::Manifold::kMaxPoints];
  Number present[state::Manifold::kMaxPoints];  ///< 1 for a point, 0 for one the manifold lacks.
  Number separation[state::Manifold::kMaxPoints];
  Triple<Number> friction_impulse;  ///< Impulse on B.
  Triple<Number> surface_velocity;
  Number spinning_friction;
};

// The four-number groups of a manifold that are read begin at these numbers.
constexpr std::size_t kNormalAt = offsetof(state::Manifold, normal) / sizeof(Real);
constexpr std::size_t kPointAt = offsetof(state::Manifold, point) / sizeof(Real);
constexpr std::size_t kPointStride = sizeof(state::ContactPoint) / sizeof(Real);
constexpr std::size_t kFrictionImpulseAt = offsetof(state::Manifold, friction_impulse) / sizeof(Real);
constexpr std::size_t kSurfaceAt = offsetof(state::Manifold, friction) / sizeof(Real);
static_assert(offsetof(state::Manifold, normal) % sizeof(Real) == 0);
static_assert(offsetof(state::ContactPoint, normal_impulse) == 7 * sizeof(Real));
static_assert(offsetof(state::Manifold, twist_impulse) == (kFrictionImpulseAt + 3) * sizeof(Real));
static_assert(offsetof(state::Manifold, surface_velocity) == (kSurfaceAt + 5) * sizeof(Real));

/// Reads the points, and stores what the block keeps of them.
template <class Number>
HWY_INLINE void read_points(const ContactSource& source, int lane, ContactBlock& block,
                            Inputs<Number>& inputs) {
  const Number zero(Real(0));
  const Number one(Real(1));
  const auto swapped = above(zero, get<Number>(source.sign + lane));
  const Number points = get<Number>(source.points + lane);
  const auto* base = reinterpret_cast<const Real*>(source.manifolds) + kPointAt;
  for (int k = 0; k < block.point_count; ++k) {
    Quad<Number> first, second;
    read_quad(base + kPointStride * k, source.manifold + lane, first);
    read_quad(base + kPointStride * k + 4, source.manifold + lane, second);
    const auto present = above(points, Number(static_cast<Real>(k)));
    const auto either = [&](Number if_swapped, Number if_not)
                            HWY_ATTR { return choose(present, choose(swapped, if_swapped, if_not), zero); };
    inputs.anchor_a[k] = {either(first.w, first.x), either(second.x, first.y), either(second.y, first.z)};
    inputs.anchor_b[k] = {either(first.x, first.w), either(first.y, second.x), either(first.z, second.y)};
    inputs.separation[k] = choose(present, second.z, zero);
    inputs.present[k] = choose(present, one, zero);
    write(inputs.separation[k], block.point[k].separation + lane);
    write(choose(present, Number(source.impulse_scale) * second.w, zero), block.point[k].impulse + lane);
  }
}

template <class Number>
HWY_INLINE void read_inputs(const ContactSource& source, int lane, ContactBlock& block,
                            Inputs<Number>& inputs) {
  const auto* base = reinterpret_cast<const Real*>(source.manifolds);
  const std::uint32_t* at = source.manifold + lane;
  const Number sign = get<Number>(source.sign + lane);
  const Number impulse_scale(source.impulse_scale);
  Quad<Number> normal, impulse, surface, velocity;
  read_quad(base + kNormalAt, at, normal);
  read_quad(base + kFrictionImpulseAt, at, impulse);
  read_quad(base + kSurfaceAt, at, surface);
  read_quad(base + kSurfaceAt + 4, at, velocity);
  inputs.n = {sign * normal.x, sign * normal.y, sign * normal.z};
  inputs.friction_impulse = scaled(sign * impulse_scale, Triple<Number>{impulse.x, impulse.y, impulse.z});
  inputs.surface_velocity = scaled(sign, Triple<Number>{velocity.y, velocity.z, velocity.w});
  inputs.spinning_friction = velocity.x;
  put3(inputs.n, block.normal, lane);
  write(impulse_scale * impulse.w, block.twist_impulse + lane);
  write(surface.x, block.friction + lane);
  write(surface.y, block.static_friction + lane);
  write(Number(Real(0)), block.pushed + lane);
  inputs.scale_a = read_scale<Number>(source.scale, block.record_a + lane);
  inputs.scale_b = read_scale<Number>(source.scale, block.record_b + lane);
  read_points(source, lane, block, inputs);
}

/// A unit vector across the unit vector n.
template <class Number>
HWY_INLINE Triple<Number> across(const Triple<Number>& n) {
  const Number zero(Real(0));
  const Number one(Real(1));
  // Of the axes x and y one makes an angle of more than 45 degrees with n.
  const auto steep = above(n.x * n.x, Number(Real(0.5)));
  const Number x = choose(steep, zero, one);
  const Number y = choose(steep, one, zero);
  const Number along = x * n.x + y * n.y;
  const Triple<Number> t = {x - along * n.x, y - along * n.y, zero - along * n.z};
  return scaled(quotient(one, root(dot(t, t))), t);
}

/// Mean position of the contact. Points count fully up to kFrictionFullGap and fade out to kFrictionNoGap. If
/// none is as near as that, it is the mean of all.
template <class Number>
struct MeanAnchors {
  Triple<Number> a, b;
};
template <class Number>
HWY_INLINE MeanAnchors<Number> mean_anchors(const Inputs<Number>& inputs, int points) {
  const Number zero(Real(0));
  const Number one(Real(1));
  MeanAnchors<Number> mean = {{zero, zero, zero}, {zero, zero, zero}};
  Number sum = zero;
  for (int k = 0; k < points; ++k) {
    const Number near = Number(Real(1) / (kFrictionNoGap - kFrictionFullGap)) *
                        (Number(kFrictionNoGap) - inputs.separation[k]);
    const Number weight =
        inputs.present[k] * (larger(smaller(near, one), zero) + Number(kFrictionLeastWeight));
    sum = sum + weight;
    add(weight, inputs.anchor_a[k], mean.a);
    add(weight, inputs.anchor_b[k], mean.b);
  }
  // A refreshed manifold may have no points now.
  const Number share = quotient(one, larger(sum, Number(Real(0.5) * kFrictionLeastWeight)));
  return {scaled(share, mean.a), scaled(share, mean.b)};
}

template <class Number, bool kAnchored>
struct RowMaker {
  const Inputs<Number>& inputs;
  ContactBlock& block;
  int lane;
  Number w;

  /// Inverse effective mass of a row whose linear part is `linear`, or in general the product of two rows.
  HWY_INLINE Number inverse_mass(Number linear, const Velocity<Number>& p, const Velocity<Number>& q) const {
    const Number of_a = linear + dot(p.v, q.v);
    return kAnchored ? of_a : of_a + dot(p.omega, q.omega);
  }

  /// Returns j_a in `v` and j_b in `omega`.
  HWY_INLINE Velocity<Number> jacobians(const Triple<Number>& moment_a,
                                        const Triple<Number>& moment_b) const {
    return {inputs.scale_a.times(moment_a), inputs.scale_b.times(moment_b)};
  }

  HWY_INLINE void points(const MeanAnchors<Number>& mean) const {
    const Number friction = get<Number>(block.friction + lane);
    for (int k = 0; k < block.point_count; ++k) {
      ContactBlock::Point& point = block.point[k];
      const Triple<Number> r_a = inputs.anchor_a[k];
      const Triple<Number> r_b = inputs.anchor_b[k];
      const Velocity<Number> j = jacobians(cross(r_a, inputs.n), cross(r_b, inputs.n));
      put3(j.v, point.j_a, lane);
      put3(j.omega, point.j_b, lane);
      write(quotient(inputs.present[k], inverse_mass(w, j, j)), point.mass + lane);
      const Triple<Number> lever = difference(r_a, mean.a);
      write(friction * root(dot(lever, lever)) + inputs.spinning_friction, block.twist_lever[k] + lane);
    }
  }

  HWY_INLINE void twist() const {
    const Velocity<Number> j = jacobians(inputs.n, inputs.n);
    put3(j.v, block.twist_j_a, lane);
    put3(j.omega, block.twist_j_b, lane);
    const Number inverse = inverse_mass(Number(Real(0)), j, j);
    const auto turns = above(inverse, Number(Real(0)));
    write(choose(turns, quotient(Number(Real(1)), choose(turns, inverse, Number(Real(1)))), Number(Real(0))),
          block.twist_mass + lane);
  }

  HWY_INLINE void disc(const MeanAnchors<Number>& mean) const {
    const Triple<Number> t_1 = across(inputs.n);
    const Triple<Number> t[2] = {t_1, cross(inputs.n, t_1)};
    put3(t_1, block.tangent, lane);
    Velocity<Number> j[2];
    for (int i = 0; i < 2; ++i) {
      j[i] = jacobians(cross(mean.a, t[i]), cross(mean.b, t[i]));
      put3(j[i].v, block.friction_j_a[i], lane);
      put3(j[i].omega, block.friction_j_b[i], lane);
      write(dot(inputs.friction_impulse, t[i]), block.friction_impulse[i] + lane);
      write(dot(inputs.surface_velocity, t[i]), block.surface_speed[i] + lane);
    }
    const Number k_11 = inverse_mass(w, j[0], j[0]);
    const Number k_12 = inverse_mass(Number(Real(0)), j[0], j[1]);
    const Number k_22 = inverse_mass(w, j[1], j[1]);
    // The linear part alone makes the determinant at least w^2.
    const Number inverse = quotient(Number(Real(1)), k_11 * k_22 - k_12 * k_12);
    write(inverse * k_22, block.friction_mass[0] + lane);
    write(Number(Real(0)) - inverse * k_12, block.friction_mass[1] + lane);
    write(inverse * k_11, block.friction_mass[2] + lane);
  }
};

template <class Number, bool kAnchored>
HWY_INLINE void compute_lanes(const ContactSource& source, int lane, ContactBlock& block) {
  Inputs<Number> inputs;
  read_inputs(source, lane, block, inputs);
  const Number w_a = get<Number>(block.w_a + lane);
  const RowMaker<Number, kAnchored> rows = {inputs, block, lane,
                                            kAnchored ? w_a : w_a + get<Number>(block.w_b + lane)};
  const MeanAnchors<Number> mean = mean_anchors(inputs, block.point_count);
  rows.points(mean);
  rows.twist();
  rows.disc(mean);
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
