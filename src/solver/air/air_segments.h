/// The air on the segments of a rope in the Numbers of solver/simd/numbers.h. Included anew for each
/// instruction set.

#if defined(HOOKE_SOLVER_AIR_AIR_SEGMENTS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_AIR_AIR_SEGMENTS_H
#undef HOOKE_SOLVER_AIR_AIR_SEGMENTS_H
#else
#define HOOKE_SOLVER_AIR_AIR_SEGMENTS_H
#endif

#include "solver/air/air_kernels.h"
#include "solver/simd/numbers.h"

#include <cstdint>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

template <class Number>
HWY_INLINE Triple<Number> moved_on(const Triple<Number>& value, Triple<Number>& carried) {
  return {moved_on(value.x, carried.x), moved_on(value.y, carried.y), moved_on(value.z, carried.z)};
}

template <class Number>
HWY_INLINE Triple<Number> xyz(const Quad<Number>& q) {
  return {q.x, q.y, q.z};
}

template <class Number>
HWY_INLINE Quad<Number> quad_at(const Real* base, const std::uint32_t* line) {
  Quad<Number> q;
  read_quad(base, line, q);
  return q;
}

/// Pushes the segments from the i-th on, one for each lane, and their first nodes. The first lane of
/// `on_end` has the change that the segment before makes to the velocity of the first node. Afterwards it
/// has the change that the last of these segments makes to its end.
template <class Number>
HWY_INLINE void push_segment_lanes(const SegmentAir& air, std::uint32_t i, Triple<Number>& on_end) {
  std::uint32_t a[kLanesOf<Number>];
  std::uint32_t b[kLanesOf<Number>];
  for (std::uint32_t k = 0; k < kLanesOf<Number>; ++k) {
    a[k] = 4 * (air.first_particle + i + k);
    b[k] = a[k] + 4;
  }
  const Number zero(Real(0));
  const Number half(Real(0.5));
  const Number one(Real(1));
  const Quad<Number> x_a = quad_at<Number>(air.position, a);
  const Triple<Number> line = difference(xyz(quad_at<Number>(air.position, b)), xyz(x_a));
  const Quad<Number> v_a = quad_at<Number>(air.velocity, a);
  const Quad<Number> v_b = quad_at<Number>(air.velocity, b);
  const Triple<Number> flow = scaled(half, sum(difference(xyz(quad_at<Number>(air.wind, a)), xyz(v_a)),
                                               difference(xyz(quad_at<Number>(air.wind, b)), xyz(v_b))));
  const Number square = dot(line, line);
  const Number share = choose(above(square, zero), quotient(dot(flow, line), square), zero);
  const Triple<Number> across = difference(flow, scaled(share, line));
  Number rest;
  read_anywhere(air.rest_length + i, rest);
  const Number drag = Number(air.strength) * x_a.w * rest * root(dot(across, across));
  const Triple<Number> at_a = scaled(half * smaller(v_a.w * drag, one), across);
  const Triple<Number> at_b = scaled(half * smaller(v_b.w * drag, one), across);
  const Triple<Number> v = sum(xyz(v_a), sum(moved_on(at_b, on_end), at_a));
  write_quad(Quad<Number>{v.x, v.y, v.z, v_a.w}, air.velocity, a);
}

/// Every segment sees the velocities from before: the velocity of its end is written with the next segment.
template <class Number>
HWY_INLINE void push_segments_with(const SegmentAir& air) {
  const Number zero(Real(0));
  Triple<Number> on_ends = {zero, zero, zero};
  std::uint32_t i = 0;
  for (; i + kLanesOf<Number> <= air.count; i += kLanesOf<Number>) push_segment_lanes(air, i, on_ends);
  Triple<Real> on_end = {first_lane(on_ends.x), first_lane(on_ends.y), first_lane(on_ends.z)};
  for (; i < air.count; ++i) push_segment_lanes(air, i, on_end);
  Real* last = air.velocity + 4 * (air.first_particle + air.count);
  last[0] += on_end.x;
  last[1] += on_end.y;
  last[2] += on_end.z;
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
