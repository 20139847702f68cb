/// Isometric bending elements in the Numbers of solver/simd/numbers.h. Included anew for each instruction
/// set.

#if defined(HOOKE_SOLVER_SOFT_ISOMETRIC_BENDING_ROWS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_SOFT_ISOMETRIC_BENDING_ROWS_H
#undef HOOKE_SOLVER_SOFT_ISOMETRIC_BENDING_ROWS_H
#else
#define HOOKE_SOLVER_SOFT_ISOMETRIC_BENDING_ROWS_H
#endif

#include "solver/simd/numbers.h"
#include "solver/soft/isometric_bending_kernels.h"

#include <cstdint>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

/// Solves a spring between two particles; `d` goes from b to a.
template <class Number>
HWY_INLINE void solve_spring(const Triple<Number>& d, Number rest_length, const SpringMaterial& material,
                             Quad<Number>& a, Quad<Number>& b) {
  const Number l2 = dot(d, d);
  const Number l = root(l2);
  const Number rate = d.x * (a.x - b.x) + d.y * (a.y - b.y) + d.z * (a.z - b.z);
  const Number none(Real(0));
  const Number whole = l * Number(material.recovery);
  const Number most = whole + Number(material.recovery_time) * larger(rate, none);
  const Number least = Number(material.recovery_time) * smaller(rate, none) - whole;
  const Number error = smaller(larger(l * (l - rest_length), least), most);
  const Number numerator = rate + Number(material.bias) * error;
  const Number denominator = l2 * (a.w + b.w + Number(material.gamma));
  const Number zero(Real(0));
  const Number s = choose(above(denominator, zero), quotient(numerator, denominator), zero);
  const Number s_a = s * a.w;
  const Number s_b = s * b.w;
  a = {a.x - s_a * d.x, a.y - s_a * d.y, a.z - s_a * d.z, a.w};
  b = {b.x + s_b * d.x, b.y + s_b * d.y, b.z + s_b * d.z, b.w};
}

/// The impulse of a bend with the curvature q and its rate; `w` is the sum of w_i K_i^2.
template <class Number, bool kDamped>
HWY_INLINE Triple<Number> bend_impulse(const Triple<Number>& q, const Triple<Number>& rate, Number w,
                                       Number gamma, const IsometricBendSoftness& softness) {
  const Number one(Real(1));
  const Number bias(softness.bias);
  const Number share = quotient(one, w + gamma);
  const Triple<Number> p = scaled(share, sum(rate, scaled(bias, q)));
  if constexpr (!kDamped) return p;
  const Number zero(Real(0));
  const Number q2 = dot(q, q);
  const Number rate_along = dot(q, rate);
  const Number damped =
      quotient(rate_along + Number(softness.damped_bias) * q2, w + Number(softness.gamma_share) * gamma);
  const Number more = quotient(damped - share * (rate_along + bias * q2), q2);
  return sum(p, scaled(choose(above(q2, zero), more, zero), q));
}

/// Solves the elements of a block from `lane` on, one for each lane of a Number.
template <class Number, bool kWings, bool kDamped>
HWY_INLINE void solve_isometric_bend_lanes(const IsometricBendBlock& block, int lane,
                                           const IsometricBendMaterials& materials, const Real* position,
                                           Real* velocity) {
  const auto record = [&](int k) HWY_ATTR { return block.record[k] + lane; };
  Triple<Number> e, d2, d3;  // from x0
  read_offset(position, record(1), record(0), e);
  read_offset(position, record(2), record(0), d2);
  read_offset(position, record(3), record(0), d3);
  Quad<Number> v0, v1, v2, v3;
  read_quad(velocity, record(0), v0);
  read_quad(velocity, record(1), v1);
  read_quad(velocity, record(2), v2);
  read_quad(velocity, record(3), v3);

  const Number k1 = get<Number>(block.weight[0] + lane);
  const Number k2 = get<Number>(block.weight[1] + lane);
  const Number k3 = get<Number>(block.weight[2] + lane);
  const Number k0 = Number(Real(0)) - (k1 + k2 + k3);
  const Number w = k0 * k0 * v0.w + k1 * k1 * v1.w + k2 * k2 * v2.w + k3 * k3 * v3.w;
  // Takes differences from the first particle, as for positions: a common velocity of the four has no
  // effect.
  const auto from_first = [&](const Quad<Number>& v) HWY_ATTR {
    return Triple<Number>{v.x - v0.x, v.y - v0.y, v.z - v0.z};
  };
  const auto weighted = [&](const Triple<Number>& a, const Triple<Number>& b, const Triple<Number>& c)
                            HWY_ATTR { return sum(sum(scaled(k1, a), scaled(k2, b)), scaled(k3, c)); };
  const Triple<Number> rate = weighted(from_first(v1), from_first(v2), from_first(v3));
  const Triple<Number> p = bend_impulse<Number, kDamped>(weighted(e, d2, d3), rate, w,
                                                         get<Number>(block.gamma + lane), materials.bend);
  const auto push = [&](Number k, Quad<Number>& v) HWY_ATTR {
    const Number s = k * v.w;
    v = {v.x - s * p.x, v.y - s * p.y, v.z - s * p.z, v.w};
  };
  push(k0, v0);
  push(k1, v1);
  push(k2, v2);
  push(k3, v3);

  if constexpr (kWings) {
    solve_spring(difference(d2, d3), get<Number>(block.wing_length + lane), *materials.wings, v2, v3);
  }
  solve_spring(e, get<Number>(block.edge_length + lane), materials.edge, v1, v0);
  write_quad(v0, velocity, record(0));
  write_quad(v1, velocity, record(1));
  write_quad(v2, velocity, record(2));
  write_quad(v3, velocity, record(3));
}

/// All loads of a Number come before its stores, so that the copies which fill a block store what their
/// original does.
template <class Number, bool kWings, bool kDamped>
HWY_INLINE void solve_isometric_bend_blocks(const IsometricBendRun& run,
                                            const IsometricBendMaterials& materials,
                                            const state::PositionRecord* positions,
                                            state::VelocityRecord* velocities) {
  const auto* position = reinterpret_cast<const Real*>(positions);
  auto* velocity = reinterpret_cast<Real*>(velocities);
  for (const IsometricBendBlock& block : run.blocks) {
    const int count = &block == &run.blocks.back() ? run.last_count : kLanes;
    for (int lane = 0; lane < count; lane += kLanesOf<Number>)
      solve_isometric_bend_lanes<Number, kWings, kDamped>(block, lane, materials, position, velocity);
  }
}

template <class Number>
HWY_INLINE void solve_isometric_bend_run(const IsometricBendRun& run, const IsometricBendMaterials& materials,
                                         const state::PositionRecord* position,
                                         state::VelocityRecord* velocity) {
  const bool damped = materials.bend.is_damped();
  if (materials.wings != nullptr) {
    damped ? solve_isometric_bend_blocks<Number, true, true>(run, materials, position, velocity)
           : solve_isometric_bend_blocks<Number, true, false>(run, materials, position, velocity);
  } else {
    damped ? solve_isometric_bend_blocks<Number, false, true>(run, materials, position, velocity)
           : solve_isometric_bend_blocks<Number, false, false>(run, materials, position, velocity);
  }
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
