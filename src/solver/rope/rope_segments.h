/// The equation of a rope's segment, and its errors after a solution, in the Numbers of
/// solver/simd/numbers.h. Equations: solver/rope/rope_systems.h. Included anew for each instruction set.

#if defined(HOOKE_SOLVER_ROPE_ROPE_SEGMENTS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_ROPE_ROPE_SEGMENTS_H
#undef HOOKE_SOLVER_ROPE_ROPE_SEGMENTS_H
#else
#define HOOKE_SOLVER_ROPE_ROPE_SEGMENTS_H
#endif

#include "solver/rope/rope_kernels.h"
#include "solver/rope/rope_tuning.h"
#include "solver/simd/numbers.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

constexpr double kNoLength = 1e-100;  ///< A shorter vector has no direction [m].

template <class Number>
struct SegmentState {
  Triple<Number> line, relative, before;  ///< x_b - x_a; u_b - u_a, also before this substep's forces.
  Number limited, tension_bound;          ///< 1 or 0; T+, not negative.
};

/// q = K (u_b - u_a - offset), where K is `along` in the direction of n and `across` beside it: 1 / gamma
/// and beta.
template <class Number>
struct SegmentRow {
  Triple<Number> n, offset;
  Number n_offset;  ///< n.offset
  Number along, across;
};

/// What the segments of a rope have in common, with h and 1 / h.
template <class Number>
struct RopeTerms {
  Number h, per_h;
  Number compliance, most_along;  ///< chi; the largest `along` over the lighter mass, 1 / chi.
  Number first;                   ///< 1 or 0.
  Triple<Number> turning;
  bool limits;  ///< Whether any segment has a largest length.
};

/// Gives 1 for yes and 0 for no.
template <class Number>
HWY_INLINE Number one_if_above(Number a, Number b) {
  return choose(above(a, b), Number(1.0), Number(0.0));
}

template <class Number>
HWY_INLINE Triple<Number> choose3(Number flag, const Triple<Number>& yes, const Triple<Number>& no) {
  const auto condition = above(flag, Number(0.0));
  return {choose(condition, yes.x, no.x), choose(condition, yes.y, no.y), choose(condition, yes.z, no.z)};
}

/// A vector's length and direction, and a quotient that shares the division for it.
template <class Number>
struct Direction {
  Triple<Number> n;
  Number length, quotient;  ///< The latter is 1 / divisor.
};

/// The direction points down where the vector has none.
template <class Number>
HWY_INLINE Direction<Number> direction_of(const Triple<Number>& d, Number divisor) {
  const Number none(kNoLength);
  const Number length = root(dot(d, d));
  const Number size = larger(length, none);
  const Number per_both = quotient(Number(1.0), size * divisor);
  Direction<Number> result = {scaled(per_both * divisor, d), length, per_both * size};
  if (any(above(none, length))) {
    const Number zero(0.0);
    const Number is_none = one_if_above(none, length);
    result.n = choose3(is_none, Triple<Number>{zero, Number(-1.0), zero}, result.n);
  }
  return result;
}

/// The largest stiffness that a segment may have: chi as a stiffness.
template <class Number>
HWY_INLINE Number most_along(const SegmentTraits<Number>& traits, const RopeTerms<Number>& terms) {
  return terms.most_along * traits.lighter;
}

/// The length that a segment should have without a force.
template <class Number>
HWY_INLINE Number target_length(const SegmentState<Number>& at, const SegmentTraits<Number>& traits,
                                const RopeTerms<Number>& terms) {
  if (!terms.limits) return traits.rest;
  return choose(above(at.limited, Number(0.0)), traits.limit, traits.rest);
}

/// Sets the stiffness along a segment that may be at its limit, and returns its b.
template <class Number>
HWY_INLINE Number stiffen(const SegmentState<Number>& at, const SegmentTraits<Number>& traits,
                          const RopeTerms<Number>& terms, SegmentRow<Number>& row) {
  const Number most = most_along(traits, terms);
  row.along = smaller(traits.resistance, most);
  if (!terms.limits) return traits.bias;
  const auto limited = above(at.limited, Number(0.0));
  row.along = choose(limited, most, row.along);
  return choose(limited, terms.per_h, traits.bias);
}

/// Linearizes a segment at the start of the substep.
template <class Number>
HWY_INLINE SegmentRow<Number> linearized_first(const SegmentState<Number>& at,
                                               const SegmentTraits<Number>& traits,
                                               const RopeTerms<Number>& terms) {
  const Number pulled = terms.h * terms.h * at.tension_bound;
  const Number g = pulled * traits.per_rest;
  const Number held = g + Number(kTransverseFloor) * traits.lighter;
  SegmentRow<Number> row;
  row.across = held + Number(kWaveDamping) * g;
  const Direction<Number> direction = direction_of(at.line, row.across);
  row.n = direction.n;
  const Number bias = stiffen(at, traits, terms, row);
  const Number c = direction.length - target_length(at, traits, terms);
  const Number kept = held * direction.quotient;
  const Number turned = Number(kWaveDamping) * pulled * direction.quotient;  // d g L / across
  row.n_offset = Number(0.0) - bias * c;
  const Number along = row.n_offset - kept * dot(row.n, at.before);
  row.offset =
      sum(sum(scaled(kept, at.before), scaled(turned, cross(terms.turning, row.n))), scaled(along, row.n));
  return row;
}

/// Linearizes a segment about the last result.
template <class Number>
HWY_INLINE SegmentRow<Number> linearized_again(const SegmentState<Number>& at,
                                               const SegmentTraits<Number>& traits,
                                               const RopeTerms<Number>& terms) {
  const Number g = terms.h * terms.h * at.tension_bound * traits.per_rest;
  SegmentRow<Number> row;
  row.across = g + Number(kTransverseFloor) * traits.lighter;
  const Direction<Number> direction = direction_of(sum(at.line, scaled(terms.h, at.relative)), Number(1.0));
  row.n = direction.n;
  const Number bias = stiffen(at, traits, terms, row);
  const Number c = direction.length - target_length(at, traits, terms);
  const Number speed = dot(row.n, at.relative);
  row.n_offset = bias * (terms.h * speed - c);
  row.offset = sum(at.relative, scaled(row.n_offset - speed, row.n));
  return row;
}

/// Linearizes every lane: those at the start of the substep may stand beside others.
template <class Number>
HWY_INLINE SegmentRow<Number> linearized(const SegmentState<Number>& at, const SegmentTraits<Number>& traits,
                                         const RopeTerms<Number>& terms, bool all_first) {
  const SegmentRow<Number> row = linearized_first(at, traits, terms);
  if (all_first) return row;
  const SegmentRow<Number> again = linearized_again(at, traits, terms);
  const auto first = above(terms.first, Number(0.0));
  return {choose3(terms.first, row.n, again.n), choose3(terms.first, row.offset, again.offset),
          choose(first, row.n_offset, again.n_offset), choose(first, row.along, again.along),
          choose(first, row.across, again.across)};
}

template <class Number>
struct SegmentCheck {
  Number tension_bound, limited;
  Number error, limit_changed;  ///< Relative error of the length; 1 or 0.
};

/// Moves a segment onto its limit or off it.
template <class Number>
HWY_INLINE void check_limit(const SegmentState<Number>& at, const SegmentTraits<Number>& traits,
                            Number length, Number pull, const RopeTerms<Number>& terms,
                            SegmentCheck<Number>& check) {
  const Number zero(0.0);
  const auto limited = above(at.limited, zero);
  const Number over =
      choose(limited, zero, one_if_above(length, traits.limit * Number(1 + kRopeLimitTolerance)));
  const Number released = choose(
      limited, one_if_above(terms.h * (traits.limit - traits.rest), pull * traits.per_stiffness), zero);
  check.limit_changed = larger(over, released);
  check.limited = choose(above(check.limit_changed, zero), over, at.limited);
}

/// Evaluates a segment after a solution. `at` has its new velocities, `pull` is n.q and `opening` is n.(u_b
/// - u_a), with n as it was linearized.
template <class Number>
HWY_INLINE SegmentCheck<Number> checked(const SegmentState<Number>& at, const SegmentTraits<Number>& traits,
                                        Number pull, Number opening, const RopeTerms<Number>& terms) {
  const Number zero(0.0);
  const Triple<Number> d = sum(at.line, scaled(terms.h, at.relative));
  const Number length = root(dot(d, d));
  const Number tension = terms.per_h * pull;
  const auto firm = above(traits.resistance, Number(kFirmResistance) * most_along(traits, terms));
  const Number by_most = terms.h * terms.compliance * traits.per_lighter * pull;
  Number expected = choose(firm, by_most, (tension - traits.damping * opening) * traits.per_stiffness);
  SegmentCheck<Number> result = {larger(at.tension_bound, tension), zero, zero, zero};
  if (terms.limits) {
    expected = choose(above(at.limited, zero), by_most, expected);
    check_limit(at, traits, length, pull, terms, result);
  }
  const Number error = length - target_length(at, traits, terms) - expected;
  result.error = larger(error, zero - error) * traits.per_rest;
  return result;
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
