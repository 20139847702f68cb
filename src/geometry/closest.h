#pragma once

#include "hooke/math.h"

#include <array>
#include <cmath>
#include <limits>

/// \file
/// Closest points of segments, triangles and the primitive shapes. The functions are templates over the real
/// type: contact uses float, its twin and the tests double. Everything is total for coordinates whose fourth
/// power is finite (1e9 in float). Lengths whose fourth power is zero (1e-11 in float) count as zero where a
/// direction is needed. Each function says what it returns in degenerate cases.
///
/// After Ericson (2005), Real-Time Collision Detection, chapter 5; the signed areas of a triangle are taken
/// from cross products, which lose fewer digits than products of dot products where a triangle is thin.

namespace hooke::geometry {

template <class T>
struct SegmentPoint {
  Vector3<T> point = {};
  T distance_squared = T(0);
  T fraction = T(0);  ///< point = a + fraction (b - a), in [0, 1].
};

template <class T>
struct SegmentPair {
  Vector3<T> point_a = {};
  Vector3<T> point_b = {};
  T distance_squared = T(0);
  T fraction_a = T(0);  ///< Fraction of point_a from start to end of its segment, in [0, 1].
  T fraction_b = T(0);
};

template <class T>
struct TrianglePoint {
  Vector3<T> point = {};
  T distance_squared = T(0);
  Vector3<T> weights = {T(1), T(0), T(0)};  ///< Weights of the corners a, b, c; in [0, 1], with the sum 1.
};

template <class T>
struct Segment {
  Vector3<T> start = {};
  Vector3<T> end = {};
};

/// A point on the surface of a solid.
template <class T>
struct SurfacePoint {
  Vector3<T> point = {};
  T signed_distance = T(0);  ///< Distance, negative inside the solid.
  Vector3<T> normal = {};    ///< Outward unit normal.
};

/// Length of `v`, computed so that no intermediate result overflows or underflows.
template <class T>
T safe_length(Vector3<T> v) {
  const T size = std::fmax(std::fabs(v.x), std::fmax(std::fabs(v.y), std::fabs(v.z)));
  return size > T(0) ? size * length(Vector3<T>{v.x / size, v.y / size, v.z / size}) : T(0);
}

/// Unit vector along `v`, however short; `otherwise` if `v` is zero.
template <class T>
Vector3<T> direction_or(Vector3<T> v, Vector3<T> otherwise) {
  const T size = std::fmax(std::fabs(v.x), std::fmax(std::fabs(v.y), std::fabs(v.z)));
  if (!(size > T(0))) return otherwise;
  // Four lanes, each with a value of its own. Compilers divide whole registers, and what an empty lane of a
  // vector of three happens to hold may be so small that the division takes a hundred cycles.
  T lane[4] = {v.x, v.y, v.z, T(0)};
  for (T& l : lane) l /= size;
  const T unit_length = std::sqrt(lane[0] * lane[0] + lane[1] * lane[1] + lane[2] * lane[2]);
  for (T& l : lane) l /= unit_length;
  return {lane[0], lane[1], lane[2]};
}

/// Point of the segment nearest to `p`. A segment of no length is its start, fraction 0.
template <class T>
SegmentPoint<T> closest_on_segment(Vector3<T> p, Vector3<T> a, Vector3<T> b) {
  const Vector3<T> ab = b - a;
  const T along = dot(p - a, ab);
  const T whole = dot(ab, ab);
  SegmentPoint<T> result = {.point = a};
  if (along >= whole && whole > T(0)) {
    result = {.point = b, .fraction = T(1)};
  } else if (along > T(0) && whole > T(0)) {
    const T fraction = along / whole;
    result = {.point = a + fraction * ab, .fraction = fraction};
  }
  result.distance_squared = length_squared(p - result.point);
  return result;
}

/// Surface point of the sphere of `radius` (not negative) about the origin. From the center it is the
/// topmost, +y.
template <class T>
SurfacePoint<T> closest_on_sphere(Vector3<T> p, T radius) {
  const Vector3<T> normal = direction_or(p, {T(0), T(1), T(0)});
  return {.point = radius * normal, .signed_distance = safe_length(p) - radius, .normal = normal};
}

/// Surface point of the half-space y <= 0.
template <class T>
SurfacePoint<T> closest_on_half_space(Vector3<T> p) {
  return {.point = {p.x, T(0), p.z}, .signed_distance = p.y, .normal = {T(0), T(1), T(0)}};
}

/// Surface point of the box |x| <= half_extents.x and so on (none negative). Inside and on the surface it is
/// on the nearest face; of equally near ones +y before -y before +x, -x, +z, -z. Outside the normal points
/// from the surface point to `p`.
template <class T>
SurfacePoint<T> closest_on_box(Vector3<T> p, Vector3<T> half_extents) {
  const Vector3<T> h = half_extents;
  const auto clamp = [](T value, T limit) { return value < -limit ? -limit : value > limit ? limit : value; };
  const Vector3<T> clamped = {clamp(p.x, h.x), clamp(p.y, h.y), clamp(p.z, h.z)};
  if (!(clamped == p)) {
    const Vector3<T> out = p - clamped;
    return {.point = clamped, .signed_distance = safe_length(out), .normal = direction_or(out, {})};
  }
  const Vector3<T> gap = {h.x - std::fabs(p.x), h.y - std::fabs(p.y), h.z - std::fabs(p.z)};
  const auto side = [](T value) { return value < T(0) ? T(-1) : T(1); };
  if (gap.y <= gap.x && gap.y <= gap.z) {
    const T s = side(p.y);
    return {.point = {p.x, s * h.y, p.z}, .signed_distance = -gap.y, .normal = {T(0), s, T(0)}};
  }
  if (gap.x <= gap.z) {
    const T s = side(p.x);
    return {.point = {s * h.x, p.y, p.z}, .signed_distance = -gap.x, .normal = {s, T(0), T(0)}};
  }
  const T s = side(p.z);
  return {.point = {p.x, p.y, s * h.z}, .signed_distance = -gap.z, .normal = {T(0), T(0), s}};
}

/// Surface point of the capsule of `radius` about the segment from -half_height to half_height on the y axis
/// (neither negative). For a point of that segment it lies along +x.
template <class T>
SurfacePoint<T> closest_on_capsule(Vector3<T> p, T radius, T half_height) {
  const T y = p.y < -half_height ? -half_height : p.y > half_height ? half_height : p.y;
  const Vector3<T> out = {p.x, p.y - y, p.z};
  const Vector3<T> normal = direction_or(out, {T(1), T(0), T(0)});
  return {.point = Vector3<T>{T(0), y, T(0)} + radius * normal,
          .signed_distance = safe_length(out) - radius,
          .normal = normal};
}

/// Solves for a solid of revolution about y in the half plane through `p`. `closest` takes a point (distance
/// from the axis, height, 0) and returns the surface point in that plane. Points on the axis are seen from
/// +x.
template <class T, class Closest>
SurfacePoint<T> closest_on_revolved(Vector3<T> p, const Closest& closest) {
  const Vector3<T> across = {p.x, T(0), p.z};
  const Vector3<T> out = direction_or(across, {T(1), T(0), T(0)});
  const SurfacePoint<T> flat = closest(Vector3<T>{safe_length(across), p.y, T(0)});
  const auto turned = [&](Vector3<T> v) { return v.x * out + Vector3<T>{T(0), v.y, T(0)}; };
  return {turned(flat.point), flat.signed_distance, turned(flat.normal)};
}

/// Surface point of the cylinder of `radius` about the y axis, from -half_height to half_height (neither
/// negative). Inside, an end is taken before the side, the upper before the lower.
template <class T>
SurfacePoint<T> closest_on_cylinder(Vector3<T> p, T radius, T half_height) {
  const Vector3<T> half_extents = {radius, half_height, std::numeric_limits<T>::infinity()};
  return closest_on_revolved(p, [&](Vector3<T> flat) { return closest_on_box(flat, half_extents); });
}

/// Surface point of the cone about the y axis with its base at -half_height and its tip at half_height (both
/// positive). Inside, the side is taken before the base.
template <class T>
SurfacePoint<T> closest_on_cone(Vector3<T> p, T radius, T half_height) {
  return closest_on_revolved(p, [&](Vector3<T> flat) -> SurfacePoint<T> {
    const Vector3<T> rim = {radius, -half_height, T(0)};
    const Vector3<T> tip = {T(0), half_height, T(0)};
    const Vector3<T> along = normalize(tip - rim);
    const Vector3<T> outward = {along.y, -along.x, T(0)};  // normal of the side
    const T over_side = dot(outward, flat - rim);
    const T over_base = -half_height - flat.y;
    const bool is_inside = over_side <= T(0) && over_base <= T(0);
    if (is_inside ? over_base > over_side : over_base > T(0) && flat.x <= radius) {
      return {{flat.x, -half_height, T(0)}, over_base, {T(0), T(-1), T(0)}};
    }
    const bool is_beside = dot(along, flat - rim) >= T(0) && dot(along, flat - tip) <= T(0);
    if (is_inside || is_beside) return {flat - over_side * outward, over_side, outward};
    const Vector3<T> corner = dot(along, flat - rim) < T(0) ? rim : tip;
    return {corner, safe_length(flat - corner), direction_or(flat - corner, outward)};
  });
}

/// The pair of points with one end of a segment: of `a` if `is_of_a`, its last if `is_end`.
template <class T>
SegmentPair<T> pair_with_end(const Segment<T>& a, const Segment<T>& b, bool is_of_a, bool is_end) {
  const Segment<T>& own = is_of_a ? a : b;
  const Segment<T>& other = is_of_a ? b : a;
  const Vector3<T> end = is_end ? own.end : own.start;
  const T fraction = is_end ? T(1) : T(0);
  const SegmentPoint<T> near = closest_on_segment(end, other.start, other.end);
  if (is_of_a) return {end, near.point, near.distance_squared, fraction, near.fraction};
  return {near.point, end, near.distance_squared, near.fraction, fraction};
}

/// The pair of points around the given position on `a`. Nearly parallel segments give a bad position along
/// themselves, and two projections keep that from opening a gap.
template <class T>
SegmentPair<T> pair_near(const Segment<T>& a, const Segment<T>& b, T fraction_a) {
  const SegmentPoint<T> on_b = closest_on_segment(a.start + fraction_a * (a.end - a.start), b.start, b.end);
  const SegmentPoint<T> on_a = closest_on_segment(on_b.point, a.start, a.end);
  return {on_a.point, on_b.point, on_a.distance_squared, on_a.fraction, on_b.fraction};
}

/// The nearest points of two segments. If several pairs are equally near (parallel segments), the pair has an
/// end of a segment: the first of start of a, end of a, start of b, end of b. Segments of no length are
/// points.
template <class T>
SegmentPair<T> closest_between_segments(const Segment<T>& a, const Segment<T>& b) {
  const Vector3<T> along_a = a.end - a.start;
  const Vector3<T> along_b = b.end - b.start;
  const Vector3<T> offset = a.start - b.start;
  const Vector3<T> normal = cross(along_a, along_b);
  const T determinant = dot(normal, normal);
  const T numerator_a = dot(cross(along_b, offset), normal);
  const T numerator_b = dot(cross(along_a, offset), normal);
  // Either the lines are nearest inside both segments, or an end is nearest.
  const bool is_inside =
      numerator_a > T(0) && numerator_a < determinant && numerator_b > T(0) && numerator_b < determinant;
  // Below a sine of about 0.003 (float) rounding decides where lines are nearest: then the ends are tested
  // too.
  const T clear =
      T(64) * std::numeric_limits<T>::epsilon() * length_squared(along_a) * length_squared(along_b);
  if (is_inside && determinant > clear) return pair_near(a, b, numerator_a / determinant);
  SegmentPair<T> best = pair_with_end(a, b, true, false);
  const auto keep_nearer = [&best](const SegmentPair<T>& pair) {
    if (pair.distance_squared < best.distance_squared) best = pair;
  };
  keep_nearer(pair_with_end(a, b, true, true));
  keep_nearer(pair_with_end(a, b, false, false));
  keep_nearer(pair_with_end(a, b, false, true));
  if (is_inside) keep_nearer(pair_near(a, b, numerator_a / determinant));
  return best;
}

/// The point nearest to `p` on the three edges of a triangle.
template <class T>
TrianglePoint<T> closest_on_outline(Vector3<T> p, Vector3<T> a, Vector3<T> b, Vector3<T> c) {
  const SegmentPoint<T> ab = closest_on_segment(p, a, b);
  const SegmentPoint<T> bc = closest_on_segment(p, b, c);
  const SegmentPoint<T> ca = closest_on_segment(p, c, a);
  if (ab.distance_squared <= bc.distance_squared && ab.distance_squared <= ca.distance_squared) {
    return {ab.point, ab.distance_squared, {T(1) - ab.fraction, ab.fraction, T(0)}};
  }
  if (bc.distance_squared <= ca.distance_squared) {
    return {bc.point, bc.distance_squared, {T(0), T(1) - bc.fraction, bc.fraction}};
  }
  return {ca.point, ca.distance_squared, {ca.fraction, T(0), T(1) - ca.fraction}};
}

/// Below a height of a twentieth of the longest edge the digits that float loses would show.
inline constexpr double kThinnessSquared = 0.0025;

/// The point of the triangle with the given weights of b and c.
template <class T>
TrianglePoint<T> point_inside(Vector3<T> p, Vector3<T> a, Vector3<T> ab, Vector3<T> ac,
                              std::array<T, 2> weights) {
  const auto [of_b, of_c] = weights;
  const Vector3<T> point = a + of_b * ab + of_c * ac;
  return {point, length_squared(p - point), {std::fmax(T(0), T(1) - of_b - of_c), of_b, of_c}};
}

/// The result for a thin triangle from a first guess inside it. The guess is corrected by its remaining
/// error, and the outline is tested too.
template <class T>
TrianglePoint<T> closest_on_thin_triangle(Vector3<T> p, Vector3<T> a, Vector3<T> b, Vector3<T> c,
                                          const TrianglePoint<T>& guess) {
  const Vector3<T> ab = b - a;
  const Vector3<T> ac = c - a;
  const Vector3<T> normal = cross(ab, ac);
  const Vector3<T> rest = p - guess.point;
  const T of_b = guess.weights.y + dot(normal, cross(rest, ac)) / dot(normal, normal);
  const T of_c = guess.weights.z + dot(normal, cross(ab, rest)) / dot(normal, normal);
  const TrianglePoint<T> outline = closest_on_outline(p, a, b, c);
  if (!(of_b > T(0) && of_c > T(0) && of_b + of_c < T(1))) return outline;
  const TrianglePoint<T> mended = point_inside(p, a, ab, ac, {of_b, of_c});
  return mended.distance_squared < outline.distance_squared ? mended : outline;
}

/// The point of the triangle nearest to `p`. A triangle without area is its outline. Of points equally near,
/// the one on ab is taken before the one on bc before the one on ca.
template <class T>
TrianglePoint<T> closest_on_triangle(Vector3<T> p, Vector3<T> a, Vector3<T> b, Vector3<T> c) {
  const Vector3<T> ab = b - a;
  const Vector3<T> ac = c - a;
  const Vector3<T> normal = cross(ab, ac);
  // The square of the smallest height in units of the longest edge; not a number for a single point.
  const T longest = std::fmax(length_squared(c - b), std::fmax(length_squared(ab), length_squared(ac)));
  const T thinness_squared = length_squared(normal) / (longest * longest);
  // These are twice the areas that p, seen along the normal, spans with the edges.
  const T opposite_a = dot(normal, cross(c - b, p - b));
  const T opposite_b = dot(normal, cross(p - a, ac));
  const T opposite_c = dot(normal, cross(ab, p - a));
  const bool is_inside =
      thinness_squared > T(0) && opposite_a > T(0) && opposite_b > T(0) && opposite_c > T(0);
  if (!is_inside) return closest_on_outline(p, a, b, c);
  const T whole = opposite_a + opposite_b + opposite_c;
  const TrianglePoint<T> inside = point_inside(p, a, ab, ac, {opposite_b / whole, opposite_c / whole});
  return thinness_squared > T(kThinnessSquared) ? inside : closest_on_thin_triangle(p, a, b, c, inside);
}

}  // namespace hooke::geometry
