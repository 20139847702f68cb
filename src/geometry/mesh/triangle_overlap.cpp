#include "geometry/mesh/triangle_overlap.h"

#include "geometry/box.h"
#include "geometry/orientation.h"

namespace hooke::geometry {

namespace {

constexpr int kNoAxis = -1;

/// An axis along which the three points are seen as a triangle; kNoAxis if they lie on one line.
int axis_facing(DVec3 a, DVec3 b, DVec3 c) {
  for (int axis = 0; axis < 3; ++axis) {
    if (orientation(seen_along(axis, a), seen_along(axis, b), seen_along(axis, c)) != 0) return axis;
  }
  return kNoAxis;
}

bool boxes_overlap(DVec3 a, DVec3 b, DVec3 c, DVec3 d) {
  return overlap(Box3<double>{min_of(a, b), max_of(a, b)}, Box3<double>{min_of(c, d), max_of(c, d)});
}

/// Whether `p`, which is on the line through a and b, is between them.
bool is_between(Point2 p, Point2 a, Point2 b) {
  const auto within = [](double value, double from, double to) {
    return from <= to ? from <= value && value <= to : to <= value && value <= from;
  };
  return within(p.x, a.x, b.x) && within(p.y, a.y, b.y);
}

bool segments_overlap(Point2 a, Point2 b, Point2 c, Point2 d) {
  const int abc = orientation(a, b, c);
  const int abd = orientation(a, b, d);
  const int cda = orientation(c, d, a);
  const int cdb = orientation(c, d, b);
  if (abc * abd < 0 && cda * cdb < 0) return true;
  return (abc == 0 && is_between(c, a, b)) || (abd == 0 && is_between(d, a, b)) ||
         (cda == 0 && is_between(a, c, d)) || (cdb == 0 && is_between(b, c, d));
}

/// Whether signs agree, zero with either.
bool agree(int a, int b, int c) {
  return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

/// Tests a segment in the triangle's plane. Seen along the axis the triangle has an area.
bool flat_segment_meets(DVec3 from, DVec3 to, const DTriangle& triangle, int axis) {
  const Point2 p = seen_along(axis, from);
  const Point2 q = seen_along(axis, to);
  const Point2 a = seen_along(axis, triangle[0]);
  const Point2 b = seen_along(axis, triangle[1]);
  const Point2 c = seen_along(axis, triangle[2]);
  return agree(orientation(a, b, p), orientation(b, c, p), orientation(c, a, p)) ||
         segments_overlap(p, q, a, b) || segments_overlap(p, q, b, c) || segments_overlap(p, q, c, a);
}

/// Whether all corners of `a` are on one side of the plane of `b`, which has an area.
bool is_beside(const DTriangle& a, const DTriangle& b) {
  const int first = orientation(b[0], b[1], b[2], a[0]);
  return first != 0 && orientation(b[0], b[1], b[2], a[1]) == first &&
         orientation(b[0], b[1], b[2], a[2]) == first;
}

bool are_finite(const DTriangle& t) {
  return is_finite(t[0]) && is_finite(t[1]) && is_finite(t[2]);
}

bool has_edge_that_meets(const DTriangle& a, const DTriangle& b) {
  return segment_meets_triangle(a[0], a[1], b) || segment_meets_triangle(a[1], a[2], b) ||
         segment_meets_triangle(a[2], a[0], b);
}

}  // namespace

bool segments_overlap(DVec3 a, DVec3 b, DVec3 c, DVec3 d) {
  if (!is_finite(a) || !is_finite(b) || !is_finite(c) || !is_finite(d)) return false;
  if (!boxes_overlap(a, b, c, d) || orientation(a, b, c, d) != 0) return false;
  for (const DTriangle& t :
       {DTriangle{a, b, c}, DTriangle{a, b, d}, DTriangle{c, d, a}, DTriangle{c, d, b}}) {
    const int axis = axis_facing(t[0], t[1], t[2]);
    if (axis == kNoAxis) continue;
    return segments_overlap(seen_along(axis, a), seen_along(axis, b), seen_along(axis, c),
                            seen_along(axis, d));
  }
  return true;  // all points are on one line, where boxes that overlap are segments that overlap
}

bool segment_meets_triangle(DVec3 from, DVec3 to, const DTriangle& triangle) {
  if (!is_finite(from) || !is_finite(to) || !are_finite(triangle)) return false;
  const auto& [a, b, c] = triangle;
  const int from_side = orientation(a, b, c, from);
  const int to_side = orientation(a, b, c, to);
  if (from_side * to_side > 0) return false;
  if (from_side != 0 || to_side != 0) {
    return agree(orientation(from, to, a, b), orientation(from, to, b, c), orientation(from, to, c, a));
  }
  const int axis = axis_facing(a, b, c);
  if (axis != kNoAxis) return flat_segment_meets(from, to, triangle, axis);
  return segments_overlap(from, to, a, b) || segments_overlap(from, to, b, c) ||
         segments_overlap(from, to, c, a);
}

bool triangles_overlap(const DTriangle& a, const DTriangle& b) {
  if (!are_finite(a) || !are_finite(b)) return false;
  if (!overlap(box_of(a[0], a[1], a[2]), box_of(b[0], b[1], b[2]))) return false;
  if (is_beside(a, b) || is_beside(b, a)) return false;
  return has_edge_that_meets(a, b) || has_edge_that_meets(b, a);
}

}  // namespace hooke::geometry
