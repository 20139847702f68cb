/// Yarns in the Numbers of solver/simd/numbers.h. Included anew for each instruction set.

#if defined(HOOKE_SOLVER_SOFT_YARN_ROWS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_SOFT_YARN_ROWS_H
#undef HOOKE_SOLVER_SOFT_YARN_ROWS_H
#else
#define HOOKE_SOLVER_SOFT_YARN_ROWS_H
#endif

#include "solver/simd/numbers.h"
#include "solver/soft/soft_tuning.h"
#include "solver/soft/yarn_kernels.h"

#include <cstdint>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

/// Coefficients of the links of a row, one of the two laws of its material for each lane.
template <class Number>
struct LinkLaw {
  Number rest_length, bias, gamma;

  template <bool kLimited>
  static HWY_INLINE LinkLaw of(const YarnRow& row, int lane, const YarnMaterial& material) {
    const auto rest_length = get<Number>(row.rest_length + lane);
    const LinkLaw own = {rest_length, Number(material.spring.bias), Number(material.spring.gamma)};
    if constexpr (!kLimited) return own;
    const auto is_limited = above(get<Number>(row.is_limited + lane), Number(Real(0)));
    const Number most = rest_length * Number(Real(1) + material.most_extension);
    return {choose(is_limited, most, rest_length), choose(is_limited, Number(material.limit.bias), own.bias),
            choose(is_limited, Number(material.limit.gamma), own.gamma)};
  }
};

/// The error of a length that counts: a rigid link takes back little of it in a substep.
template <class Number, bool kLimited>
HWY_INLINE Number bounded_error(Number error, Number rate, const YarnRow& row, int lane,
                                const YarnMaterial& material) {
  const Number none(Real(0));
  const auto bounded = [&](const SpringMaterial& of) HWY_ATTR {
    const Number most = Number(of.recovery) + Number(of.recovery_time) * larger(rate, none);
    const Number least = Number(of.recovery_time) * smaller(rate, none) - Number(of.recovery);
    return smaller(larger(error, least), most);
  };
  if constexpr (!kLimited) return bounded(material.spring);
  const auto is_limited = above(get<Number>(row.is_limited + lane), none);
  return choose(is_limited, bounded(material.limit), bounded(material.spring));
}

/// Eliminates the impulses of the links of the yarns from `lane` on, from the first to the last.
template <class Number, bool kLimited, bool kAgain>
HWY_INLINE void eliminate_links(YarnRow* rows, std::uint32_t links, int lane, const YarnMaterial& material,
                                Real h, const Real* position, const Real* velocity) {
  const Number none(Real(0));
  const Number one(Real(1));
  Triple<Number> before = {none, none, none};  // the direction of the link before
  Number pivot_inverse = none;                 // and the inverse of its pivot
  Number impulse = none;
  Quad<Number> v0, v1;
  read_quad(velocity, rows[0].record + lane, v0);
  Number softness = v0.w;  // with which the links so far hold the node, along the link
  for (std::uint32_t i = 0; i < links; ++i) {
    YarnRow& row = rows[i];
    Triple<Number> d;
    read_offset(position, rows[i + 1].record + lane, row.record + lane, d);
    read_quad(velocity, rows[i + 1].record + lane, v1);
    const Triple<Number> dv = {v1.x - v0.x, v1.y - v0.y, v1.z - v0.z};
    const Number length = root(dot(d, d));
    Number end_length = length;
    if constexpr (kAgain) {
      add(Number(h), dv, d);
      end_length = root(dot(d, d));
    }
    const Number inverse_length = choose(above(end_length, none), quotient(one, end_length), none);
    const Triple<Number> n = scaled(inverse_length, d);
    Number rate = dot(n, dv);
    if constexpr (kAgain) rate = Number(Real(1) / h) * (end_length - length);
    const auto law = LinkLaw<Number>::template of<kLimited>(row, lane, material);
    const Number error = bounded_error<Number, kLimited>(length - law.rest_length, rate, row, lane, material);
    const Number shared = v0.w * dot(before, n);
    const Number coupling = shared * pivot_inverse;
    if (i > 0) {
      // w_i - (w_i n_{i-1}.n_i)^2 / pivot, without the difference of what is nearly alike.
      const Triple<Number> turn = cross(before, n);
      softness = v0.w * (softness + v0.w * dot(turn, turn)) * pivot_inverse;
    }
    const Number gamma = larger(law.gamma, Number(kLeastYarnSoftness) * (v0.w + v1.w));
    softness = softness + gamma;
    const Number pivot = softness + v1.w;
    pivot_inverse = choose(above(pivot, none), quotient(one, pivot), none);
    Number rest = rate + law.bias * error;
    if constexpr (kAgain) rest = rest - gamma * get<Number>(row.given + lane);
    impulse = (rest + shared * impulse) * pivot_inverse;
    if (i > 0) write(coupling, rows[i - 1].coupling + lane);
    put3(n, row.direction, lane);
    write(inverse_length, row.inverse_length + lane);
    write(impulse, row.impulse + lane);
    before = n;
    v0 = v1;
  }
}

/// Finds the impulses from the last link to the first.
template <class Number>
HWY_INLINE void substitute_links(YarnRow* rows, std::uint32_t links, int lane) {
  auto impulse = get<Number>(rows[links - 1].impulse + lane);
  for (std::uint32_t i = links - 1; i-- > 0;) {
    impulse = get<Number>(rows[i].impulse + lane) + get<Number>(rows[i].coupling + lane) * impulse;
    write(impulse, rows[i].impulse + lane);
  }
}

/// Marks links that end longer than their limit. Returns whether any is new.
template <class Number>
HWY_INLINE bool limit_links(YarnRow* rows, std::uint32_t links, int lane, const YarnMaterial& material) {
  const Number none(Real(0));
  const Number one(Real(1));
  bool any_new = false;
  for (std::uint32_t i = 0; i < links; ++i) {
    const Number most = get<Number>(rows[i].rest_length + lane) * Number(material.most_impulse);
    const auto is_limited = get<Number>(rows[i].is_limited + lane);
    const auto passes = choose(above(get<Number>(rows[i].impulse + lane), most), one, none);
    any_new = any_new || any(above(passes, is_limited));
    write(larger(passes, is_limited), rows[i].is_limited + lane);
  }
  return any_new;
}

/// Holds only links at their limit that pull at least as they would without it.
template <class Number>
HWY_INLINE void renew_limits(YarnRow* rows, std::uint32_t links, int lane, const YarnMaterial& material) {
  const Number none(Real(0));
  const Number one(Real(1));
  for (std::uint32_t i = 0; i < links; ++i) {
    const Number most = get<Number>(rows[i].rest_length + lane) * Number(material.most_impulse);
    write(choose(above(get<Number>(rows[i].given + lane), most), one, none), rows[i].is_limited + lane);
  }
}

/// Gives the impulses of the links to their nodes, those from before included in what is noted.
template <class Number, bool kAgain>
HWY_INLINE void apply_links(YarnRow* rows, std::uint32_t links, int lane, Real* velocity) {
  const Number none(Real(0));
  Triple<Number> before = {none, none, none};
  for (std::uint32_t i = 0; i <= links; ++i) {
    YarnRow& row = rows[i];
    Triple<Number> p = {none, none, none};
    if (i < links) {
      const auto impulse = get<Number>(row.impulse + lane);
      p = scaled(impulse, get3<Number>(row.direction, lane));
      if constexpr (kAgain) {
        write(get<Number>(row.given + lane) + impulse, row.given + lane);
        put3(sum(get3<Number>(row.pull, lane), p), row.pull, lane);
      } else {
        write(impulse, row.given + lane);
        put3(p, row.pull, lane);
      }
    }
    Quad<Number> v;
    read_quad(velocity, row.record + lane, v);
    const Triple<Number> change = difference(p, before);
    v = {v.x + v.w * change.x, v.y + v.w * change.y, v.z + v.w * change.z, v.w};
    write_quad(v, velocity, row.record + lane);
    before = p;
  }
}

/// Notes which links are so taut that their nodes need it. Returns 1 in lanes that have to be solved again:
/// where some are, if it was the `first` solution, or where a link turns so far that it ends longer than it
/// should.
template <class Number>
HWY_INLINE Number look_at_links(YarnRow* rows, std::uint32_t links, int lane, Real h, bool first,
                                const Real* position, const Real* velocity) {
  const Number none(Real(0));
  const Number one(Real(1));
  Number again = none;
  Quad<Number> v0, v1;
  read_quad(velocity, rows[0].record + lane, v0);
  for (std::uint32_t i = 0; i < links; ++i) {
    YarnRow& row = rows[i];
    Triple<Number> d;
    read_offset(position, rows[i + 1].record + lane, row.record + lane, d);
    read_quad(velocity, rows[i + 1].record + lane, v1);
    add(Number(h), Triple<Number>{v1.x - v0.x, v1.y - v0.y, v1.z - v0.z}, d);
    const Number error = root(dot(d, d)) - dot(get3<Number>(row.direction, lane), d);
    const auto is_long = above(error, Number(kYarnLengthTolerance) * get<Number>(row.rest_length + lane));
    again = choose(is_long, one, again);
    const Number stiffness =
        Number(h) * get<Number>(row.given + lane) * get<Number>(row.inverse_length + lane);
    const auto is_taut = above(stiffness * (v0.w + v1.w), Number(kLeastTautness));
    write(choose(is_taut, stiffness, none), row.tautness + lane);
    if (first) again = choose(is_taut, one, again);
    v0 = v1;
  }
  return again;
}

/// Lets the tension of taut links act where they are about to be: a step of Newton's method, in which links
/// resist turning.
template <class Number>
HWY_INLINE void turn_taut_links(YarnRow* rows, std::uint32_t links, int lane, Real h, const Real* position,
                                Real* velocity) {
  const Number none(Real(0));
  const Number one(Real(1));
  Triple<Number> change = {none, none, none};  // of the velocity of a node, if the next did not change
  Triple<Number> lacking_before = change;
  Number tautness_before = none;
  Number share_before = none;  // of the change of the next node
  Quad<Number> v0;
  read_quad(velocity, rows[0].record + lane, v0);
  Quad<Number> v1 = v0;
  for (std::uint32_t i = 0; i <= links; ++i) {
    YarnRow& row = rows[i];
    Triple<Number> lacking = {none, none, none};
    Number tautness = none;
    if (i < links) {
      tautness = get<Number>(row.tautness + lane);
      Triple<Number> d;
      read_offset(position, rows[i + 1].record + lane, row.record + lane, d);
      read_quad(velocity, rows[i + 1].record + lane, v1);
      add(Number(h), Triple<Number>{v1.x - v0.x, v1.y - v0.y, v1.z - v0.z}, d);
      const Number length = root(dot(d, d));
      const Number inverse = choose(above(length, none), quotient(one, length), none);
      const Triple<Number> pull = scaled(get<Number>(row.given + lane) * inverse, d);
      const Triple<Number> given = get3<Number>(row.pull, lane);
      const auto is_taut = above(tautness, none);
      lacking = {choose(is_taut, pull.x - given.x, none), choose(is_taut, pull.y - given.y, none),
                 choose(is_taut, pull.z - given.z, none)};
      put3(sum(given, lacking), row.pull, lane);
    }
    const Number from_before = v0.w * tautness_before;
    const Number to_next = v0.w * tautness;
    const Number inverse = quotient(one, one + to_next + from_before * (one - share_before));
    const Triple<Number> own = scaled(v0.w, difference(lacking, lacking_before));
    change = scaled(inverse, sum(own, scaled(from_before, change)));
    share_before = to_next * inverse;
    put3(change, row.direction, lane);
    write(share_before, row.coupling + lane);
    tautness_before = tautness;
    lacking_before = lacking;
    v0 = v1;
  }
  Triple<Number> after = {none, none, none};
  for (std::uint32_t i = links + 1; i-- > 0;) {
    YarnRow& row = rows[i];
    change = sum(get3<Number>(row.direction, lane), scaled(get<Number>(row.coupling + lane), after));
    Quad<Number> v;
    read_quad(velocity, row.record + lane, v);
    write_quad(Quad<Number>{v.x + change.x, v.y + change.y, v.z + change.z, v.w}, velocity,
               row.record + lane);
    if (i < links) {
      Triple<Number> pull = get3<Number>(row.pull, lane);
      add(get<Number>(row.tautness + lane), difference(after, change), pull);
      put3(pull, row.pull, lane);
    }
    after = change;
  }
}

template <class Number, bool kLimited, bool kAgain>
HWY_INLINE void find_impulses(YarnRow* rows, std::uint32_t links, int lane, const YarnMaterial& material,
                              Real h, const Real* position, const Real* velocity) {
  eliminate_links<Number, kLimited, kAgain>(rows, links, lane, material, h, position, velocity);
  substitute_links<Number>(rows, links, lane);
}

/// Solves the yarns from `lane` on.
template <class Number, bool kLimited>
HWY_INLINE void solve_yarn_lanes(YarnRow* rows, std::uint32_t links, int lane, const YarnMaterial& material,
                                 Real h, const Real* position, Real* velocity) {
  const Number none(Real(0));
  if constexpr (kLimited) {
    for (std::uint32_t i = 0; i < links; ++i) write(none, rows[i].is_limited + lane);
  }
  find_impulses<Number, false, false>(rows, links, lane, material, h, position, velocity);
  if constexpr (kLimited) {
    for (int round = 0; round < kMostYarnRounds && limit_links<Number>(rows, links, lane, material); ++round)
      find_impulses<Number, true, false>(rows, links, lane, material, h, position, velocity);
  }
  apply_links<Number, false>(rows, links, lane, velocity);
  for (int round = 0; round < kMostYarnRounds; ++round) {
    const Number again = look_at_links<Number>(rows, links, lane, h, round < 2, position, velocity);
    const auto is_again = above(again, none);
    if (!any(is_again)) return;
    // Yarns that are solved change no more.
    for (std::uint32_t i = 0; i < links; ++i)
      write(choose(is_again, get<Number>(rows[i].tautness + lane), none), rows[i].tautness + lane);
    if constexpr (kLimited) renew_limits<Number>(rows, links, lane, material);
    turn_taut_links<Number>(rows, links, lane, h, position, velocity);
    find_impulses<Number, kLimited, true>(rows, links, lane, material, h, position, velocity);
    for (std::uint32_t i = 0; i < links; ++i)
      write(choose(is_again, get<Number>(rows[i].impulse + lane), none), rows[i].impulse + lane);
    apply_links<Number, true>(rows, links, lane, velocity);
  }
}

template <class Number>
HWY_INLINE void solve_yarn_block(const YarnBlock& block, YarnRow* rows, const YarnMaterial& material, Real h,
                                 const state::PositionRecord* positions, state::VelocityRecord* velocities) {
  const auto* position = reinterpret_cast<const Real*>(positions);
  auto* velocity = reinterpret_cast<Real*>(velocities);
  const std::uint32_t links = block.row_count - 1;
  for (int lane = 0; lane < block.count; lane += kLanesOf<Number>) {
    if (material.has_limit()) {
      solve_yarn_lanes<Number, true>(rows, links, lane, material, h, position, velocity);
    } else {
      solve_yarn_lanes<Number, false>(rows, links, lane, material, h, position, velocity);
    }
  }
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
