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

/// Yarns side by side, from `lane` of a block on.
struct YarnLanes {
  YarnRow* rows;
  std::uint32_t links;
  int lane;
  Real h;  ///< Length of the substep [s].
  const Real* position;
  Real* velocity;
};

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

/// The vector of a link, from its node to the next, where these are about to be.
template <class Number>
HWY_INLINE Triple<Number> link_at_end(const YarnLanes& at, std::uint32_t i, const Quad<Number>& v0,
                                      const Quad<Number>& v1) {
  Triple<Number> d;
  read_offset(at.position, at.rows[i + 1].record + at.lane, at.rows[i].record + at.lane, d);
  add(Number(at.h), Triple<Number>{v1.x - v0.x, v1.y - v0.y, v1.z - v0.z}, d);
  return d;
}

/// Direction and length of a link, and the rate at which it grows. In a later solution the direction is that
/// at the end of the substep, and the rate the mean one.
template <class Number>
struct LinkMotion {
  Triple<Number> direction;
  Number length, inverse_length, rate;
};
template <class Number, bool kAgain>
HWY_INLINE LinkMotion<Number> motion_of_link(const YarnLanes& at, std::uint32_t i, const Quad<Number>& v0,
                                             const Quad<Number>& v1) {
  const Number none(Real(0));
  Triple<Number> d;
  read_offset(at.position, at.rows[i + 1].record + at.lane, at.rows[i].record + at.lane, d);
  const Triple<Number> dv = {v1.x - v0.x, v1.y - v0.y, v1.z - v0.z};
  LinkMotion<Number> link;
  link.length = root(dot(d, d));
  Number end_length = link.length;
  if constexpr (kAgain) {
    d = link_at_end(at, i, v0, v1);
    end_length = root(dot(d, d));
  }
  link.inverse_length = choose(above(end_length, none), quotient(Number(Real(1)), end_length), none);
  link.direction = scaled(link.inverse_length, d);
  link.rate = dot(link.direction, dv);
  if constexpr (kAgain) link.rate = Number(Real(1) / at.h) * (end_length - link.length);
  return link;
}

/// Eliminates the impulses of the links of the yarns from `lane` on, from the first to the last.
template <class Number, bool kLimited, bool kAgain>
HWY_INLINE void eliminate_links(const YarnLanes& at, const YarnMaterial& material) {
  const Number none(Real(0));
  const Number one(Real(1));
  Triple<Number> before = {none, none, none};  // the direction of the link before
  Number pivot_inverse = none;                 // and the inverse of its pivot
  Number impulse = none;
  Quad<Number> v0, v1;
  read_quad(at.velocity, at.rows[0].record + at.lane, v0);
  Number softness = v0.w;  // with which the links so far hold the node, along the link
  for (std::uint32_t i = 0; i < at.links; ++i) {
    YarnRow& row = at.rows[i];
    read_quad(at.velocity, at.rows[i + 1].record + at.lane, v1);
    const auto link = motion_of_link<Number, kAgain>(at, i, v0, v1);
    const Triple<Number>& n = link.direction;
    const auto law = LinkLaw<Number>::template of<kLimited>(row, at.lane, material);
    const Number error =
        bounded_error<Number, kLimited>(link.length - law.rest_length, link.rate, row, at.lane, material);
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
    Number rest = link.rate + law.bias * error;
    if constexpr (kAgain) rest = rest - gamma * get<Number>(row.given + at.lane);
    impulse = (rest + shared * impulse) * pivot_inverse;
    if (i > 0) write(coupling, at.rows[i - 1].coupling + at.lane);
    put3(n, row.direction, at.lane);
    write(link.inverse_length, row.inverse_length + at.lane);
    write(impulse, row.impulse + at.lane);
    before = n;
    v0 = v1;
  }
}

/// Finds the impulses from the last link to the first.
template <class Number>
HWY_INLINE void substitute_links(const YarnLanes& at) {
  auto impulse = get<Number>(at.rows[at.links - 1].impulse + at.lane);
  for (std::uint32_t i = at.links - 1; i-- > 0;) {
    impulse =
        get<Number>(at.rows[i].impulse + at.lane) + get<Number>(at.rows[i].coupling + at.lane) * impulse;
    write(impulse, at.rows[i].impulse + at.lane);
  }
}

/// Marks links that end longer than their limit. Returns whether any is new.
template <class Number>
HWY_INLINE bool limit_links(const YarnLanes& at, const YarnMaterial& material) {
  const Number none(Real(0));
  const Number one(Real(1));
  bool any_new = false;
  for (std::uint32_t i = 0; i < at.links; ++i) {
    const Number most = get<Number>(at.rows[i].rest_length + at.lane) * Number(material.most_impulse);
    const auto is_limited = get<Number>(at.rows[i].is_limited + at.lane);
    const auto passes = choose(above(get<Number>(at.rows[i].impulse + at.lane), most), one, none);
    any_new = any_new || any(above(passes, is_limited));
    write(larger(passes, is_limited), at.rows[i].is_limited + at.lane);
  }
  return any_new;
}

/// Holds only links at their limit that pull at least as they would without it.
template <class Number>
HWY_INLINE void renew_limits(const YarnLanes& at, const YarnMaterial& material) {
  const Number none(Real(0));
  const Number one(Real(1));
  for (std::uint32_t i = 0; i < at.links; ++i) {
    const Number most = get<Number>(at.rows[i].rest_length + at.lane) * Number(material.most_impulse);
    write(choose(above(get<Number>(at.rows[i].given + at.lane), most), one, none),
          at.rows[i].is_limited + at.lane);
  }
}

/// Gives the impulses of the links to their nodes, those from before included in what is noted.
template <class Number, bool kAgain>
HWY_INLINE void apply_links(const YarnLanes& at) {
  const Number none(Real(0));
  Triple<Number> before = {none, none, none};
  for (std::uint32_t i = 0; i <= at.links; ++i) {
    YarnRow& row = at.rows[i];
    Triple<Number> p = {none, none, none};
    if (i < at.links) {
      const auto impulse = get<Number>(row.impulse + at.lane);
      p = scaled(impulse, get3<Number>(row.direction, at.lane));
      if constexpr (kAgain) {
        write(get<Number>(row.given + at.lane) + impulse, row.given + at.lane);
        put3(sum(get3<Number>(row.pull, at.lane), p), row.pull, at.lane);
      } else {
        write(impulse, row.given + at.lane);
        put3(p, row.pull, at.lane);
      }
    }
    Quad<Number> v;
    read_quad(at.velocity, row.record + at.lane, v);
    const Triple<Number> change = difference(p, before);
    v = {v.x + v.w * change.x, v.y + v.w * change.y, v.z + v.w * change.z, v.w};
    write_quad(v, at.velocity, row.record + at.lane);
    before = p;
  }
}

/// Notes which links are so taut that their nodes need it. Returns 1 in lanes that have to be solved again:
/// where some are, if it was the `first` solution, or where a link turns so far that it ends longer than it
/// should.
template <class Number>
HWY_INLINE Number look_at_links(const YarnLanes& at, bool first) {
  const Number none(Real(0));
  const Number one(Real(1));
  Number again = none;
  Quad<Number> v0, v1;
  read_quad(at.velocity, at.rows[0].record + at.lane, v0);
  for (std::uint32_t i = 0; i < at.links; ++i) {
    YarnRow& row = at.rows[i];
    read_quad(at.velocity, at.rows[i + 1].record + at.lane, v1);
    const Triple<Number> d = link_at_end(at, i, v0, v1);
    const Number error = root(dot(d, d)) - dot(get3<Number>(row.direction, at.lane), d);
    const auto is_long = above(error, Number(kYarnLengthTolerance) * get<Number>(row.rest_length + at.lane));
    again = choose(is_long, one, again);
    const Number stiffness =
        Number(at.h) * get<Number>(row.given + at.lane) * get<Number>(row.inverse_length + at.lane);
    const auto is_taut = above(stiffness * (v0.w + v1.w), Number(kLeastTautness));
    write(choose(is_taut, stiffness, none), row.tautness + at.lane);
    if (first) again = choose(is_taut, one, again);
    v0 = v1;
  }
  return again;
}

/// What a taut link lacks of the pull that it has where its nodes are about to be; it counts as given then.
template <class Number>
HWY_INLINE Triple<Number> lacking_pull(const YarnLanes& at, std::uint32_t i, Number tautness,
                                       const Quad<Number>& v0, const Quad<Number>& v1) {
  const Number none(Real(0));
  YarnRow& row = at.rows[i];
  const Triple<Number> d = link_at_end(at, i, v0, v1);
  const Number length = root(dot(d, d));
  const Number inverse = choose(above(length, none), quotient(Number(Real(1)), length), none);
  const Triple<Number> pull = scaled(get<Number>(row.given + at.lane) * inverse, d);
  const Triple<Number> given = get3<Number>(row.pull, at.lane);
  const auto is_taut = above(tautness, none);
  const Triple<Number> lacking = {choose(is_taut, pull.x - given.x, none),
                                  choose(is_taut, pull.y - given.y, none),
                                  choose(is_taut, pull.z - given.z, none)};
  put3(sum(given, lacking), row.pull, at.lane);
  return lacking;
}

/// Lets the tension of taut links act where they are about to be: a step of Newton's method, in which links
/// resist turning.
template <class Number>
HWY_INLINE void turn_taut_links(const YarnLanes& at) {
  const Number none(Real(0));
  const Number one(Real(1));
  Triple<Number> change = {none, none, none};  // of the velocity of a node, if the next did not change
  Triple<Number> lacking_before = change;
  Number tautness_before = none;
  Number share_before = none;  // of the change of the next node
  Quad<Number> v0;
  read_quad(at.velocity, at.rows[0].record + at.lane, v0);
  Quad<Number> v1 = v0;
  for (std::uint32_t i = 0; i <= at.links; ++i) {
    YarnRow& row = at.rows[i];
    Triple<Number> lacking = {none, none, none};
    Number tautness = none;
    if (i < at.links) {
      tautness = get<Number>(row.tautness + at.lane);
      read_quad(at.velocity, at.rows[i + 1].record + at.lane, v1);
      lacking = lacking_pull(at, i, tautness, v0, v1);
    }
    const Number from_before = v0.w * tautness_before;
    const Number to_next = v0.w * tautness;
    const Number inverse = quotient(one, one + to_next + from_before * (one - share_before));
    const Triple<Number> own = scaled(v0.w, difference(lacking, lacking_before));
    change = scaled(inverse, sum(own, scaled(from_before, change)));
    share_before = to_next * inverse;
    put3(change, row.direction, at.lane);
    write(share_before, row.coupling + at.lane);
    tautness_before = tautness;
    lacking_before = lacking;
    v0 = v1;
  }
  Triple<Number> after = {none, none, none};
  for (std::uint32_t i = at.links + 1; i-- > 0;) {
    YarnRow& row = at.rows[i];
    change = sum(get3<Number>(row.direction, at.lane), scaled(get<Number>(row.coupling + at.lane), after));
    Quad<Number> v;
    read_quad(at.velocity, row.record + at.lane, v);
    write_quad(Quad<Number>{v.x + change.x, v.y + change.y, v.z + change.z, v.w}, at.velocity,
               row.record + at.lane);
    if (i < at.links) {
      Triple<Number> pull = get3<Number>(row.pull, at.lane);
      add(get<Number>(row.tautness + at.lane), difference(after, change), pull);
      put3(pull, row.pull, at.lane);
    }
    after = change;
  }
}

template <class Number, bool kLimited, bool kAgain>
HWY_INLINE void find_impulses(const YarnLanes& at, const YarnMaterial& material) {
  eliminate_links<Number, kLimited, kAgain>(at, material);
  substitute_links<Number>(at);
}

/// Solves the yarns from `lane` on.
template <class Number, bool kLimited>
HWY_INLINE void solve_yarn_lanes(const YarnLanes& at, const YarnMaterial& material) {
  const Number none(Real(0));
  if constexpr (kLimited) {
    for (std::uint32_t i = 0; i < at.links; ++i) write(none, at.rows[i].is_limited + at.lane);
  }
  find_impulses<Number, false, false>(at, material);
  if constexpr (kLimited) {
    for (int round = 0; round < kMostYarnRounds && limit_links<Number>(at, material); ++round)
      find_impulses<Number, true, false>(at, material);
  }
  apply_links<Number, false>(at);
  for (int round = 0; round < kMostYarnRounds; ++round) {
    const Number again = look_at_links<Number>(at, round < 2);
    const auto is_again = above(again, none);
    if (!any(is_again)) return;
    // Yarns that are solved change no more.
    for (std::uint32_t i = 0; i < at.links; ++i) {
      write(choose(is_again, get<Number>(at.rows[i].tautness + at.lane), none),
            at.rows[i].tautness + at.lane);
    }
    if constexpr (kLimited) renew_limits<Number>(at, material);
    turn_taut_links<Number>(at);
    find_impulses<Number, kLimited, true>(at, material);
    for (std::uint32_t i = 0; i < at.links; ++i)
      write(choose(is_again, get<Number>(at.rows[i].impulse + at.lane), none), at.rows[i].impulse + at.lane);
    apply_links<Number, true>(at);
  }
}

template <class Number>
HWY_INLINE void solve_yarn_block(const YarnBlock& block, YarnRow* rows, const YarnMaterial& material, Real h,
                                 const state::PositionRecord* positions, state::VelocityRecord* velocities) {
  const auto* position = reinterpret_cast<const Real*>(positions);
  auto* velocity = reinterpret_cast<Real*>(velocities);
  const std::uint32_t links = block.row_count - 1;
  for (int lane = 0; lane < block.count; lane += kLanesOf<Number>) {
    const YarnLanes at = {rows, links, lane, h, position, velocity};
    if (material.has_limit()) {
      solve_yarn_lanes<Number, true>(at, material);
    } else {
      solve_yarn_lanes<Number, false>(at, material);
    }
  }
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
