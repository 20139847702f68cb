#include "collision/manifold/manifold_axes.h"
#include "collision/manifold/manifold_clip.h"
#include "collision/manifold/manifold_features.h"
#include "collision/manifold/manifold_points.h"
#include "collision/manifold/manifold_tuning.h"

#include <cmath>

namespace hooke::collision {

namespace {

/// Data of two boxes for the test of their axes: B in the frame of A.
struct BoxPair {
  Real r[3][3];     ///< r[i][j]: axis j of B along axis i of A.
  Real size[3][3];  ///< |r|
  Real offset[3];   ///< From the center of A to that of B.
  Real half_a[3], half_b[3];

  BoxPair(const Convex& a, const Convex& b) {
    const Vec3 axes_a[3] = {a.axes.x, a.axes.y, a.axes.z};
    const Vec3 axes_b[3] = {b.axes.x, b.axes.y, b.axes.z};
    const Vec3 d = b.center - a.center;
    for (int i = 0; i < 3; ++i) {
      offset[i] = dot(axes_a[i], d);
      for (int j = 0; j < 3; ++j) {
        r[i][j] = dot(axes_a[i], axes_b[j]);
        size[i][j] = std::fabs(r[i][j]);
      }
    }
    const Vec3 ha = a.shape.half_extents;
    const Vec3 hb = b.shape.half_extents;
    half_a[0] = ha.x, half_a[1] = ha.y, half_a[2] = ha.z;
    half_b[0] = hb.x, half_b[1] = hb.y, half_b[2] = hb.z;
  }
};

/// The axis with the largest separation so far. Ties and near ties go to the last step's axis and to faces.
struct Choice {
  std::uint32_t last_axis;
  Real keep;  ///< The amount by which another axis has to be better.
  std::uint32_t code = 0;
  Real separation = Real(0);
  Real score = -std::numeric_limits<Real>::infinity();

  void offer(std::uint32_t candidate, Real s, Real bias) {
    const Real candidate_score = (candidate == last_axis ? s + keep : s) - bias;
    const bool better = candidate_score > score;
    code = better ? candidate : code;
    separation = better ? s : separation;
    score = better ? candidate_score : score;
  }
};

void offer_faces(const BoxPair& p, Choice& choice) {
  for (int i = 0; i < 3; ++i) {
    const Real reach =
        p.half_a[i] + p.half_b[0] * p.size[i][0] + p.half_b[1] * p.size[i][1] + p.half_b[2] * p.size[i][2];
    choice.offer(1u + static_cast<unsigned>(i), std::fabs(p.offset[i]) - reach, Real(0));
  }
  for (int j = 0; j < 3; ++j) {
    const Real along = p.offset[0] * p.r[0][j] + p.offset[1] * p.r[1][j] + p.offset[2] * p.r[2][j];
    const Real reach =
        p.half_b[j] + p.half_a[0] * p.size[0][j] + p.half_a[1] * p.size[1][j] + p.half_a[2] * p.size[2][j];
    choice.offer(4u + static_cast<unsigned>(j), std::fabs(along) - reach, Real(0));
  }
}

/// Axes a_i x b_j. In the frame of A their product with the offset is offset[i2] r[i1][j] - offset[i1]
/// r[i2][j].
void offer_edges(const BoxPair& p, Real bias, Choice& choice) {
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3;
    const int i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const Real squared = p.r[i1][j] * p.r[i1][j] + p.r[i2][j] * p.r[i2][j];
      if (squared < kParallelEdges) continue;
      const int j1 = (j + 1) % 3;
      const int j2 = (j + 2) % 3;
      const Real along = std::fabs(p.offset[i2] * p.r[i1][j] - p.offset[i1] * p.r[i2][j]);
      const Real reach = p.half_a[i1] * p.size[i2][j] + p.half_a[i2] * p.size[i1][j] +
                         p.half_b[j1] * p.size[i][j2] + p.half_b[j2] * p.size[i][j1];
      choice.offer(7u + static_cast<unsigned>(3 * i + j), (along - reach) / std::sqrt(squared), bias);
    }
  }
}

Vec3 axis_of(const Convex& box, int i) {
  return i == 0 ? box.axes.x : i == 1 ? box.axes.y : box.axes.z;
}

Real half_of(const Convex& box, int i) {
  return i == 0 ? box.shape.half_extents.x : i == 1 ? box.shape.half_extents.y : box.shape.half_extents.z;
}

/// The plane of a face of the reference box: seen along `normal`, u and v run along the other two axes.
struct FacePlane {
  Vec3 normal, u, v;
  Real half_normal, half_u, half_v;
  unsigned face;  ///< 0..5

  FacePlane(const Convex& box, int axis, Vec3 outward)
      : normal(outward),
        u(axis_of(box, (axis + 1) % 3)),
        v(axis_of(box, (axis + 2) % 3)),
        half_normal(half_of(box, axis)),
        half_u(half_of(box, (axis + 1) % 3)),
        half_v(half_of(box, (axis + 2) % 3)),
        face(2 * static_cast<unsigned>(axis) + (dot(outward, axis_of(box, axis)) < Real(0) ? 1 : 0)) {}
};

/// The face of the box that points most against the plane's normal, as a polygon over the plane.
CutPolygon face_over(const FacePlane& plane, const Convex& box, Vec3 from_plane) {
  const Real along[3] = {dot(box.axes.x, plane.normal), dot(box.axes.y, plane.normal),
                         dot(box.axes.z, plane.normal)};
  const Real size[3] = {std::fabs(along[0]), std::fabs(along[1]), std::fabs(along[2])};
  const int axis = size[0] >= size[1] && size[0] >= size[2] ? 0 : size[1] >= size[2] ? 1 : 2;
  const bool positive = along[axis] < Real(0);
  const Vec3 center = from_plane + (positive ? half_of(box, axis) : -half_of(box, axis)) * axis_of(box, axis);
  const Vec3 side_u = half_of(box, (axis + 1) % 3) * axis_of(box, (axis + 1) % 3);
  const Vec3 side_v = half_of(box, (axis + 2) % 3) * axis_of(box, (axis + 2) % 3);
  const unsigned face = 2 * static_cast<unsigned>(axis) + (positive ? 0 : 1);
  const Vec3 corners[4] = {center - side_u - side_v, center + side_u - side_v, center + side_u + side_v,
                           center - side_u + side_v};
  CutPolygon polygon;
  const unsigned bit_u = 1u << (axis + 1) % 3;
  const unsigned bit_v = 1u << (axis + 2) % 3;
  const unsigned base = positive ? 1u << axis : 0u;
  const unsigned vertices[4] = {base, base | bit_u, base | bit_u | bit_v, base | bit_v};
  for (unsigned i = 0; i < 4; ++i) {
    polygon.add({{dot(plane.u, corners[i]), dot(plane.v, corners[i])},
                 dot(plane.normal, corners[i]),
                 kVertexOfB | vertices[i],
                 face * 4 + i});
  }
  return polygon;
}

/// Makes the contact of a face of `reference` with the facing face of `other`. `on_a`: the reference is A.
void collide_faces(const Convex& reference, int axis, const Convex& other, bool on_a, ContactResult& result) {
  const FacePlane plane(reference, axis, on_a ? result.normal : -result.normal);
  CutPolygon polygon = face_over(plane, other, other.center - reference.center);
  const Flat corners[4] = {{-plane.half_u, -plane.half_v},
                           {plane.half_u, -plane.half_v},
                           {plane.half_u, plane.half_v},
                           {-plane.half_u, plane.half_v}};
  for (unsigned i = 0; i < 4; ++i)
    clip_polygon(polygon, corners[i], corners[(i + 1) % 4], plane.face * 4 + i);
  for (std::size_t i = 0; i < static_cast<std::size_t>(polygon.count); ++i) {
    const Cut& cut = polygon.cut[i];
    const Vec3 foot = reference.center + cut.at.u * plane.u + cut.at.v * plane.v;
    const Vec3 on_face = foot + plane.half_normal * plane.normal;
    const Vec3 on_other = foot + cut.height * plane.normal;
    result.add(
        {on_a ? on_face : on_other, on_a ? on_other : on_face, cut.height - plane.half_normal, cut.key});
  }
}

/// The edge of a box along its axis i that lies farthest along n.
Feature edge_along(const Convex& box, int i, Vec3 n) {
  unsigned corner = 0;
  for (int k = 0; k < 3; ++k) corner |= dot(axis_of(box, k), n) > Real(0) ? 1u << k : 0u;
  const unsigned first = corner & ~(1u << i);
  Feature f;
  f.kind = Feature::Kind::kSegment;
  f.add(corner_of_box(box, first), first, 0);
  f.add(corner_of_box(box, first | 1u << i), first | 1u << i, 0);
  return f;
}

void collide_edges(const Convex& a, const Convex& b, int edge, ContactResult& result) {
  const Feature edge_a = edge_along(a, edge / 3, result.normal);
  const Feature edge_b = edge_along(b, edge % 3, -result.normal);
  overlap_features(edge_a, edge_b, Real(0), Real(0), result);
  // There is one point, where the edges cross.
  const auto key_of = [](const Feature& f) {
    return static_cast<std::uint32_t>(f.vertex[0]) << 3 | f.vertex[1];
  };
  if (result.count > 0) result.point[0].key = kCrossing | 1u << 29 | key_of(edge_a) << 6 | key_of(edge_b);
}

}  // namespace

void collide_boxes(const Convex& a, const Convex& b, const ContactQuery& query, ContactResult& result) {
  const BoxPair pair(a, b);
  Choice choice = {query.last_axis, preference(kKeepAxis, a, b)};
  offer_faces(pair, choice);
  result.separation = choice.separation;
  result.axis = choice.code;
  if (choice.separation > query.margin) return;
  offer_edges(pair, preference(kPreferFaces, a, b), choice);
  result.separation = choice.separation;
  result.axis = choice.code;
  if (choice.separation > query.margin) return;
  const int axis = static_cast<int>(choice.code) - 1;
  const Vec3 n = axis < 3   ? axis_of(a, axis)
                 : axis < 6 ? axis_of(b, axis - 3)
                            : normalize(cross(axis_of(a, (axis - 6) / 3), axis_of(b, (axis - 6) % 3)));
  result.normal = dot(n, b.center - a.center) < Real(0) ? -n : n;
  if (axis >= 6) return collide_edges(a, b, axis - 6, result);
  if (axis < 3) collide_faces(a, axis, b, true, result);
  if (axis >= 3) collide_faces(b, axis - 3, a, false, result);
  if (result.count > 0 || result.separation > Real(0)) return;
  // The two faces miss each other although the boxes overlap: a corner is inside.
  const Vec3 on_a = support_of(a, result.normal);
  const Vec3 on_b = support_of(b, -result.normal);
  complete_points({axis < 3 ? on_b : on_a, axis < 3 ? on_b : on_a, true}, Real(0), result);
}

}  // namespace hooke::collision
