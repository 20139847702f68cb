/// A rope's segment in numbers.h's Numbers: its equation, and what is left of it after a solution. Equations:
/// solver/chains.h. Included anew for each instruction set.

#if defined(HOOKE_SOLVER_WIDE_ROPE_SEGMENTS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_WIDE_ROPE_SEGMENTS_H
#undef HOOKE_SOLVER_WIDE_ROPE_SEGMENTS_H
#else
#define HOOKE_SOLVER_WIDE_ROPE_SEGMENTS_H
#endif

#include "solver/wide/numbers.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

constexpr double kWaveDamping = 0.2;       ///< Share of the geometric stiffness that damps waves.
constexpr double kTransverseFloor = 1e-5;  ///< Of the lighter end's mass; keeps slack segments defined.
constexpr double kLimitTolerance = 1e-4;
constexpr double kFirmer = 1.0001;        ///< Than its stiffness says, by the most that `along` may be.
constexpr double kLargestFinite = 1e300;  ///< A larger stiffness is infinite [N/m].

template <class Number>
struct SegmentState {
  Triple<Number> line, relative, before;  ///< x_b - x_a, u_b - u_a, and that before this substep's forces.
  Number rest, stiffness, damping, limit, lighter;
  Number limited, tension_bound;
};

/// q = K (u_b - u_a - offset), K = `along` n, `across` beside it: 1 / gamma and beta.
template <class Number>
struct SegmentRow {
  Triple<Number> n, offset;
  Number along, across;
};

/// What the segments of a rope have in common; h and 1 / h.
template <class Number>
struct RopeTerms {
  Number h, per_h;
  Number most_along, first;  ///< `along` over the lighter mass, at most; 1 or 0.
  Triple<Number> turning;
};

/// 1 for yes, 0 for no.
template <class Number>
HWY_INLINE Number one_if_above(Number a, Number b) {
  return choose(above(a, b), Number(1.0), Number(0.0));
}

template <class Number>
HWY_INLINE Triple<Number> choose3(Number flag, const Triple<Number>& yes, const Triple<Number>& no) {
  const auto condition = above(flag, Number(0.0));
  return {choose(condition, yes.x, no.x), choose(condition, yes.y, no.y), choose(condition, yes.z, no.z)};
}

template <class Number>
HWY_INLINE Triple<Number> across(const Triple<Number>& n, const Triple<Number>& v) {
  return difference(v, scaled(dot(n, v), n));
}

/// Along d; down for none.
template <class Number>
HWY_INLINE Triple<Number> direction_of(const Triple<Number>& d, Number length) {
  const Number zero(0.0);
  return choose3(length, scaled(quotient(Number(1.0), length), d), Triple<Number>{zero, Number(-1.0), zero});
}

template <class Number>
HWY_INLINE Number is_rigid(const SegmentState<Number>& at) {
  return larger(at.limited, one_if_above(at.stiffness, Number(kLargestFinite)));
}

template <class Number>
HWY_INLINE SegmentRow<Number> linearized(const SegmentState<Number>& at, const RopeTerms<Number>& terms) {
  const Number zero(0.0);
  const Number h = terms.h;
  const auto first = above(terms.first, zero);
  const Triple<Number> relative = choose3(terms.first, Triple<Number>{zero, zero, zero}, at.relative);
  const Triple<Number> d = sum(at.line, scaled(h, relative));
  const Number length = root(dot(d, d));
  SegmentRow<Number> row;
  row.n = direction_of(d, length);

  const auto rigid = above(is_rigid(at), zero);
  const Number s = at.damping + h * at.stiffness;
  const Number bias = choose(rigid, terms.per_h, choose(above(s, zero), quotient(at.stiffness, s), zero));
  const Number most = terms.most_along * at.lighter;
  row.along = choose(rigid, most, smaller(h * s, most));
  const Number c = length - choose(above(at.limited, zero), at.limit, at.rest);

  const Number g = quotient(h * h * larger(zero, at.tension_bound), at.rest);
  const Number floor = Number(kTransverseFloor) * at.lighter;
  row.across = choose(first, Number(1 + kWaveDamping) * g + floor, g + floor);
  const Number yields = quotient(Number(1.0), row.across);
  const Triple<Number> turned =
      scaled(Number(kWaveDamping) * g * yields, cross(terms.turning, scaled(at.rest, row.n)));
  const Triple<Number> kept = scaled((g + floor) * yields, across(row.n, at.before));
  const Triple<Number> transverse =
      choose3(terms.first, sum(kept, across(row.n, turned)), across(row.n, relative));
  row.offset = sum(scaled(bias * (h * dot(row.n, relative) - c), row.n), transverse);
  return row;
}

template <class Number>
struct SegmentCheck {
  Number tension_bound, limited;
  Number error, limit_changed;  ///< Of the length, relative; 1 or 0.
};

/// After a solution, `at` with its velocities. `pull` is n.q; `held` is 1 if neither end moves.
template <class Number>
HWY_INLINE SegmentCheck<Number> checked(const SegmentState<Number>& at, const SegmentRow<Number>& row,
                                        Number pull, Number held, const RopeTerms<Number>& terms) {
  const Number zero(0.0);
  const Number h = terms.h;
  const Triple<Number> d = sum(at.line, scaled(h, at.relative));
  const Number length = root(dot(d, d));
  const Number tension = terms.per_h * pull;
  const Number s = at.damping + h * at.stiffness;
  const Number firm = larger(is_rigid(at), one_if_above(h * s, Number(kFirmer) * row.along));
  const Number expected = choose(above(firm, zero), quotient(h * pull, row.along),
                                 quotient(tension - at.damping * dot(row.n, at.relative), at.stiffness));
  const auto limited = above(at.limited, zero);
  const Number error = length - choose(limited, at.limit, at.rest) - expected;

  const Number over = choose(limited, zero, one_if_above(length, at.limit * Number(1 + kLimitTolerance)));
  const Number released = choose(limited, one_if_above(h * at.stiffness * (at.limit - at.rest), pull), zero);
  const auto fixed = above(held, zero);
  SegmentCheck<Number> result;
  result.tension_bound = larger(at.tension_bound, tension);
  result.error = choose(fixed, zero, quotient(larger(error, zero - error), at.rest));
  result.limit_changed = choose(fixed, zero, larger(over, released));
  result.limited = choose(above(result.limit_changed, zero), over, at.limited);
  return result;
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
