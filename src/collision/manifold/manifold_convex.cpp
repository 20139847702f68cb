#include "collision/manifold/manifold_axes.h"
#include "collision/manifold/manifold_features.h"
#include "collision/manifold/manifold_points.h"
#include "geometry/closest.h"

#include <algorithm>
#include <cmath>

namespace hooke::collision {

namespace {

/// Collects candidates; the last step's axis is kept unless another is better by `keep`.
struct BestAxis {
  const Convex& a;
  const Convex& b;
  std::uint32_t last_axis;
  Real keep;
  Axis axis = {{Real(0), Real(1), Real(0)}, -std::numeric_limits<Real>::infinity(), kFreeAxis};
  Real score = -std::numeric_limits<Real>::infinity();

  void offer(Vec3 n, std::uint32_t code) {
    const Real separation = separation_along(a, b, n);
    const Real candidate_score = code == last_axis && code != kFreeAxis ? separation + keep : separation;
    if (!(candidate_score > score)) return;
    axis = {n, separation, code};
    score = candidate_score;
  }
  /// Offers the direction of `d` with the sign that points from A to B; nothing for a zero vector.
  void offer_toward(Vec3 d) {
    const Vec3 n = geometry::direction_or(d, Vec3{});
    if (n == Vec3{}) return;
    offer(dot(n, middle_of(b) - middle_of(a)) < Real(0) ? -n : n, kFreeAxis);
  }
};

/// Outward normal of a cone's side, on the side of `d`.
Vec3 side_of_cone(const Convex& cone, Vec3 d) {
  const Vec3 out = direction_across(cone.axes.y, d, cone.axes.x);
  return normalize(Real(2) * cone.shape.half_height * out + cone.shape.radius * cone.axes.y);
}

/// Offers the normals of those faces and flat ends of `own` that may separate it from `other`. `side` is the
/// base of their codes; with kAxisOfB the normals are negated.
void offer_faces(const Convex& own, const Convex& other, std::uint32_t side, BestAxis& best) {
  const Real sign = side == kAxisOfB ? Real(-1) : Real(1);
  const Vec3 to_other = middle_of(other) - middle_of(own);
  const auto offer = [&](Vec3 n, std::uint32_t code) { best.offer(sign * n, side + code); };
  const auto offer_toward = [&](Vec3 axis, std::uint32_t code) {
    const bool behind = dot(axis, to_other) < Real(0);
    offer(behind ? -axis : axis, behind ? code + 1 : code);
  };
  switch (own.shape.kind) {
    case ShapeKind::kBox:
      offer_toward(own.axes.x, 0);
      offer_toward(own.axes.y, 2);
      offer_toward(own.axes.z, 4);
      break;
    case ShapeKind::kHull: {
      const Real core = thinness_of(other);
      const auto& faces = own.hull->faces;
      for (std::size_t i = 0; i < faces.size(); ++i) {
        const Vec3 n = own.axes * faces[i].normal;
        // The middle of `other` is inside `other` by `core`, so the face separates no more than this.
        const Real bound = dot(n, middle_of(other) - own.center) - faces[i].offset - core;
        if (bound > best.axis.separation - best.keep) offer(n, static_cast<std::uint32_t>(i));
      }
      break;
    }
    case ShapeKind::kCylinder:
      offer_toward(own.axes.y, 0);
      break;
    case ShapeKind::kCone:
      offer(-own.axes.y, 0);
      offer(side_of_cone(own, to_other), 1);
      break;
    case ShapeKind::kMesh:
      offer(normalize(cross(own.corners[1] - own.corners[0], own.corners[2] - own.corners[0])), 0);
      break;
    case ShapeKind::kSphere:
    case ShapeKind::kCapsule:
    case ShapeKind::kHalfSpace:
    case ShapeKind::kCompound:
      break;
  }
}

bool has_shaft(const Convex& c) {
  return c.shape.kind == ShapeKind::kCapsule || c.shape.kind == ShapeKind::kCylinder ||
         c.shape.kind == ShapeKind::kCone;
}

geometry::Segment<Real> shaft_of(const Convex& c) {
  const Vec3 end = c.shape.half_height * c.axes.y;
  return {c.center - end, c.center + end};
}

/// Offers directions across the axis of a round shape and the edges of a box.
void offer_across_edges(const Convex& round, const Convex& box, BestAxis& best) {
  for (const Vec3 edge : {box.axes.x, box.axes.y, box.axes.z}) best.offer_toward(cross(round.axes.y, edge));
}

/// Offers directions between the axes of round shapes, and across them.
void offer_shafts(BestAxis& best) {
  const bool round_a = has_shaft(best.a);
  const bool round_b = has_shaft(best.b);
  if (round_a && round_b) {
    const auto pair = geometry::closest_between_segments(shaft_of(best.a), shaft_of(best.b));
    best.offer_toward(pair.point_b - pair.point_a);
    best.offer_toward(cross(best.a.axes.y, best.b.axes.y));
  }
  if (round_a && best.b.shape.kind == ShapeKind::kBox) offer_across_edges(best.a, best.b, best);
  if (round_b && best.a.shape.kind == ShapeKind::kBox) offer_across_edges(best.b, best.a, best);
}

}  // namespace

void collide_convex(const Convex& a, const Convex& b, const ContactQuery& query, ContactResult& result) {
  BestAxis best = {a, b, query.last_axis, preference(kKeepAxis, a, b)};
  best.offer(geometry::direction_or(middle_of(b) - middle_of(a), {Real(0), Real(1), Real(0)}), kFreeAxis);
  offer_faces(a, b, kAxisOfA, best);
  offer_faces(b, a, kAxisOfB, best);
  offer_shafts(best);
  Axis axis = best.axis;
  result.separation = axis.separation;
  result.axis = axis.code;
  if (axis.separation > query.margin) return;
  const Real tolerance = axis_tolerance(a, b);
  Nearest nearest = improve_axis(a, b, tolerance, axis);
  if (axis.separation < Real(0)) {
    // For overlapping shapes the separation is largest nearby at several directions, so this starts from
    // their middles too.
    BestAxis second = {a, b, 0, Real(0)};
    second.offer_toward(middle_of(b) - middle_of(a));
    const Nearest other = improve_axis(a, b, tolerance, second.axis);
    if (second.axis.separation > axis.separation + tolerance) {
      axis = second.axis;
      nearest = other;
    }
  }
  result.normal = axis.n;
  result.separation = axis.separation;
  result.axis = axis.code;
  if (axis.separation > query.margin) return;
  overlap_features(feature_along(a, axis.n), feature_along(b, -axis.n), skin_of(a), skin_of(b), result);
  complete_points(nearest, Real(4) * tolerance, result);
}

}  // namespace hooke::collision
