#include "collision/manifold/manifold_features.h"

#include "base/assert.h"
#include "collision/manifold/manifold_clip.h"
#include "collision/manifold/manifold_tuning.h"

#include <algorithm>
#include <cmath>

namespace hooke::collision {

namespace {

constexpr std::array<std::array<std::uint8_t, 4>, 6> kBoxFaces = {
    {{1, 3, 7, 5}, {0, 4, 6, 2}, {2, 6, 7, 3}, {0, 1, 5, 4}, {4, 5, 7, 6}, {0, 2, 3, 1}}};

Feature point_feature(Vec3 p, std::uint32_t vertex) {
  Feature f;
  f.add(p, vertex, 0);
  return f;
}

Feature segment_feature(Vec3 p, std::uint32_t vertex_p, Vec3 q, std::uint32_t vertex_q) {
  Feature f = point_feature(p, vertex_p);
  f.kind = Feature::Kind::kSegment;
  f.add(q, vertex_q, 0);
  return f;
}

Feature box_feature(const Convex& box, Vec3 n, Real least_cosine) {
  const std::array<Real, 3> along = {dot(box.axes.x, n), dot(box.axes.y, n), dot(box.axes.z, n)};
  const auto size = [&along](int i) { return std::fabs(along[static_cast<std::size_t>(i)]); };
  const int steepest = size(0) >= size(1) && size(0) >= size(2) ? 0 : size(1) >= size(2) ? 1 : 2;
  if (size(steepest) >= least_cosine) {
    return face_of_box(box, 2 * steepest + (along[static_cast<std::size_t>(steepest)] < Real(0) ? 1 : 0));
  }
  unsigned corner = 0;
  for (unsigned i = 0; i < 3; ++i) corner |= along[i] < Real(0) ? 0u : 1u << i;
  const int flattest = size(0) <= size(1) && size(0) <= size(2) ? 0 : size(1) <= size(2) ? 1 : 2;
  if (size(flattest) > kFlatSide) return point_feature(corner_of_box(box, corner), corner);
  const unsigned first = corner & ~(1u << flattest);
  const unsigned second = corner | 1u << flattest;
  return segment_feature(corner_of_box(box, first), first, corner_of_box(box, second), second);
}

Feature triangle_feature(const Convex& c, Vec3 n) {
  const auto& p = c.corners;
  const Vec3 normal = normalize(cross(p[1] - p[0], p[2] - p[0]));
  Feature f;
  if (dot(normal, n) >= kFlatFaceCosine) {
    f.kind = Feature::Kind::kPolygon;
    f.normal = normal;
    for (std::uint32_t i = 0; i < 3; ++i) f.add(p[i], i, i);
    return f;
  }
  std::size_t best = 0;
  for (std::size_t i = 1; i < 3; ++i) best = dot(p[i], n) > dot(p[best], n) ? i : best;
  Real flattest = kFlatSide;
  std::size_t other = best;
  for (std::size_t i = 0; i < 3; ++i) {
    const Real size = length(p[best] - p[i]);
    const Real slope = i == best || !(size > Real(0)) ? Real(1) : dot(p[best] - p[i], n) / size;
    other = slope < flattest ? i : other;
    flattest = std::min(flattest, slope);
  }
  const auto id = [](std::size_t i) { return static_cast<std::uint32_t>(i); };
  if (other == best) return point_feature(p[best], id(best));
  const auto [first, second] = std::minmax(best, other);
  return segment_feature(p[first], id(first), p[second], id(second));
}

/// The flat end of a cylinder or cone at `center`, seen along n.
Feature disc_feature(const Convex& c, Vec3 center, Vec3 outward, Vec3 n) {
  Feature f;
  f.kind = Feature::Kind::kDisc;
  f.normal = outward;
  f.center = center;
  f.radius = c.shape.radius;
  const Vec3 lowest = direction_across(outward, n, c.axes.x);
  // With marks a quarter turn apart, the lowest point lies deeper than the nearest mark by at most (1 - cos
  // 45 degrees) of the tilt.
  const bool tilted = Real(0.3) * std::fabs(dot(n, lowest)) > kTiltedRim;
  const Vec3 first = tilted ? lowest : c.axes.x;
  const Vec3 second = cross(outward, first);
  const Real r = f.radius;
  f.add(center + r * first, 0, 0);
  f.add(center + r * second, 1, 1);
  f.add(center - r * first, 2, 2);
  f.add(center - r * second, 3, 3);
  return f;
}

Feature cylinder_feature(const Convex& c, Vec3 n) {
  const Real along = dot(c.axes.y, n);
  const Vec3 end = c.shape.half_height * c.axes.y;
  if (along >= kFlatEnd) return disc_feature(c, c.center + end, c.axes.y, n);
  if (along <= -kFlatEnd) return disc_feature(c, c.center - end, -c.axes.y, n);
  const Vec3 side = c.center + c.shape.radius * direction_across(c.axes.y, n, c.axes.x);
  if (std::fabs(along) <= kFlatSide) return segment_feature(side - end, 0, side + end, 1);
  return along < Real(0) ? point_feature(side - end, 0) : point_feature(side + end, 1);
}

Feature cone_feature(const Convex& c, Vec3 n) {
  const Vec3 tip = c.shape.half_height * c.axes.y;
  if (dot(c.axes.y, n) <= -kFlatEnd) return disc_feature(c, c.center - tip, -c.axes.y, n);
  const Vec3 rim = c.shape.radius * direction_across(c.axes.y, n, c.axes.x) - tip;
  const Vec3 side = tip - rim;
  if (std::fabs(dot(side, n)) <= kFlatSide * length(side)) {
    return segment_feature(c.center + rim, 0, c.center + tip, 1);
  }
  return dot(side, n) < Real(0) ? point_feature(c.center + rim, 0) : point_feature(c.center + tip, 1);
}

Feature capsule_feature(const Convex& c, Vec3 n) {
  const Real along = dot(c.axes.y, n);
  const Vec3 end = c.shape.half_height * c.axes.y;
  if (std::fabs(along) <= kFlatSide) return segment_feature(c.center - end, 0, c.center + end, 1);
  return along < Real(0) ? point_feature(c.center - end, 0) : point_feature(c.center + end, 1);
}

/// A feature seen along the normal: its points in the plane, and its height over the plane as a linear
/// function of the position.
struct Seen {
  const Feature* feature = nullptr;
  std::array<Flat, Feature::kMaxPoints> at;
  Flat slope = {Real(0), Real(0)};
  Real height = Real(0);             ///< Height at (0, 0).
  Flat center = {Real(0), Real(0)};  ///< Center of a disc.

  [[nodiscard]] Real height_at(Flat p) const { return height + dot(slope, p); }
};

struct Projection {
  Vec3 n, t1, t2;

  explicit Projection(Vec3 normal) : n(normal), t1(), t2() {
    const bool along_x = std::fabs(n.x) > Real(0.6);
    t1 = normalize(
        hooke::cross(n, along_x ? Vec3{Real(0), Real(1), Real(0)} : Vec3{Real(1), Real(0), Real(0)}));
    t2 = hooke::cross(n, t1);
  }
  [[nodiscard]] Flat flat(Vec3 p) const { return {hooke::dot(t1, p), hooke::dot(t2, p)}; }
  [[nodiscard]] Vec3 lift(Flat p, Real height) const { return p.u * t1 + p.v * t2 + height * n; }

  [[nodiscard]] Seen see(const Feature& f) const {
    Seen s;
    s.feature = &f;
    HOOKE_ASSERT(f.count > (f.kind == Feature::Kind::kSegment ? 1 : 0));
    for (int i = 0; i < f.count; ++i)
      s.at[static_cast<std::size_t>(i)] = flat(f.point[static_cast<std::size_t>(i)]);
    s.height = hooke::dot(n, f.point[0]);
    if (f.kind == Feature::Kind::kSegment) {
      const Flat d = s.at[1] - s.at[0];
      const Real size = dot(d, d);
      const Real rise = hooke::dot(n, f.point[1]) - s.height;
      if (size > Real(0)) s.slope = {rise / size * d.u, rise / size * d.v};
    } else if (f.kind != Feature::Kind::kPoint) {
      const Real steep = hooke::dot(n, f.normal);
      s.slope = {-hooke::dot(t1, f.normal) / steep, -hooke::dot(t2, f.normal) / steep};
      s.center = flat(f.center);
    }
    s.height -= dot(s.slope, s.at[0]);
    return s;
  }
};

/// Collects points of the contact result.
struct Collector {
  const Projection& projection;
  const Seen& a;
  const Seen& b;
  Real skin_a, skin_b;
  ContactResult& result;

  void add(Flat p, std::uint32_t key) const {
    const Real height_a = a.height_at(p) + skin_a;
    const Real height_b = b.height_at(p) - skin_b;
    result.add({projection.lift(p, height_a), projection.lift(p, height_b), height_b - height_a, key});
  }
};

/// The outward normal of A is along the given normal, that of B against it: seen along it A runs
/// counter-clockwise and B clockwise.
void overlap_polygons(const Seen& clipper, const Seen& subject, bool clipper_is_a, const Collector& out) {
  CutPolygon polygon;
  const Feature& f = *subject.feature;
  for (std::size_t i = 0; i < static_cast<std::size_t>(f.count); ++i) {
    polygon.add({subject.at[i], Real(0), kVertexOfB | f.vertex[i], f.edge[i]});
  }
  const Feature& g = *clipper.feature;
  for (int i = 0; i < g.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const auto next = static_cast<std::size_t>(i + 1 < g.count ? i + 1 : 0);
    clip_polygon(polygon, clipper.at[clipper_is_a ? k : next], clipper.at[clipper_is_a ? next : k],
                 g.edge[k]);
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(polygon.count); ++i) {
    out.add(polygon.cut[i].at, polygon.cut[i].key);
  }
}

/// The part of a segment from fraction `first` to `last`, with the features that end it.
struct Part {
  Real first = Real(0);
  Real last = Real(1);
  std::uint32_t key_first = kVertexOfB | 0u;
  std::uint32_t key_last = kVertexOfB | 1u;
};

void clip_segment(Part& part, Real height_start, Real height_end, std::uint32_t key) {
  const Real t = height_start / (height_start - height_end);
  if (height_start < Real(0) && height_end < Real(0)) part.last = Real(-1);
  if (height_start < Real(0) && height_end >= Real(0) && t > part.first) part.first = t, part.key_first = key;
  if (height_start >= Real(0) && height_end < Real(0) && t < part.last) part.last = t, part.key_last = key;
}

void add_part(const Seen& segment, const Part& part, const Collector& out) {
  if (part.first > part.last) return;
  out.add(mix(segment.at[0], segment.at[1], part.first), part.key_first);
  out.add(mix(segment.at[0], segment.at[1], part.last), part.key_last);
}

void overlap_segment(const Seen& polygon, const Seen& segment, bool polygon_is_a, const Collector& out) {
  const Feature& f = *polygon.feature;
  Part part = {.key_first = kVertexOfB | segment.feature->vertex[0],
               .key_last = kVertexOfB | segment.feature->vertex[1]};
  for (int i = 0; i < f.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const auto next = static_cast<std::size_t>(i + 1 < f.count ? i + 1 : 0);
    const Flat along = polygon_is_a ? polygon.at[next] - polygon.at[k] : polygon.at[k] - polygon.at[next];
    clip_segment(part, cross(along, segment.at[0] - polygon.at[k]),
                 cross(along, segment.at[1] - polygon.at[k]), kCrossing | f.edge[k]);
  }
  add_part(segment, part, out);
}

/// Two sides that are parallel overlap in a segment, others in a point.
void overlap_segments(const Seen& a, const Seen& b, const Collector& out) {
  const Flat along_a = a.at[1] - a.at[0];
  const Flat along_b = b.at[1] - b.at[0];
  const Real size_a = dot(along_a, along_a);
  const Real cross_product = cross(along_a, along_b);
  // Up to about a degree the sides count as parallel.
  if (cross_product * cross_product > Real(4e-4) * size_a * dot(along_b, along_b)) {
    const Real t = cross(b.at[0] - a.at[0], along_b) / cross_product;
    out.add(mix(a.at[0], a.at[1], std::clamp(t, Real(0), Real(1))), kCrossing);
    return;
  }
  Part part = {.key_first = kVertexOfB | b.feature->vertex[0], .key_last = kVertexOfB | b.feature->vertex[1]};
  const Real start = dot(along_a, b.at[0] - a.at[0]);
  const Real end = dot(along_a, b.at[1] - a.at[0]);
  clip_segment(part, start, end, kVertexOfA | a.feature->vertex[0]);
  clip_segment(part, size_a - start, size_a - end, kVertexOfA | a.feature->vertex[1]);
  add_part(b, part, out);
}

/// A disc that is little tilted against the normal is taken as a circle.
bool is_inside(const Seen& seen, bool is_a, Flat p) {
  const Feature& f = *seen.feature;
  if (f.kind == Feature::Kind::kDisc) {
    const Flat from_center = p - seen.center;
    return dot(from_center, from_center) <= Real(1.0001) * f.radius * f.radius;
  }
  for (int i = 0; i < f.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const auto next = static_cast<std::size_t>(i + 1 < f.count ? i + 1 : 0);
    const Flat along = seen.at[next] - seen.at[k];
    const Real left = cross(along, p - seen.at[k]);
    if ((is_a ? left : -left) < -kOverFaceSlack * dot(along, along)) return false;
  }
  return true;
}

/// Adds the points where the line from p to q crosses the rim of a disc.
void add_rim_crossings(const Seen& disc, Flat p, Flat q, std::uint32_t key, const Collector& out) {
  const Flat d = q - p;
  const Flat f = p - disc.center;
  const Real radius = disc.feature->radius;
  const Real size = dot(d, d);
  const Real half = dot(d, f);
  const Real root = half * half - size * (dot(f, f) - radius * radius);
  if (!(root > Real(0)) || !(size > Real(0))) return;
  const Real half_chord = std::sqrt(root);
  const Real first = (-half - half_chord) / size;
  const Real last = (-half + half_chord) / size;
  if (first >= Real(0) && first <= Real(1)) out.add(mix(p, q, first), key);
  if (last >= Real(0) && last <= Real(1)) out.add(mix(p, q, last), key | 1u << 15);
}

/// Handles a disc with a disc, polygon or segment: adds the points of each that lie inside the other, and the
/// crossings.
void overlap_disc(const Seen& disc, const Seen& other, bool disc_is_a, const Collector& out) {
  const Feature& f = *other.feature;
  for (std::size_t i = 0; i < 4 && f.kind != Feature::Kind::kSegment; ++i) {
    if (is_inside(other, !disc_is_a, disc.at[i])) out.add(disc.at[i], kVertexOfA | disc.feature->vertex[i]);
  }
  for (int i = 0; i < f.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (is_inside(disc, disc_is_a, other.at[k])) out.add(other.at[k], kVertexOfB | f.vertex[k]);
  }
  if (f.kind == Feature::Kind::kDisc) {
    // The crossings of two circles lie on the line across that of the centers, at equal powers.
    const Flat apart = other.center - disc.center;
    const Real size = dot(apart, apart);
    if (!(size > Real(1e-6) * f.radius * f.radius)) return;
    const Real r = disc.feature->radius;
    const Real t = Real(0.5) * (size + r * r - f.radius * f.radius) / size;
    const Flat foot = mix(disc.center, other.center, t);
    const Real reach = std::sqrt((r * r) / size);
    add_rim_crossings(disc, {foot.u - reach * apart.v, foot.v + reach * apart.u},
                      {foot.u + reach * apart.v, foot.v - reach * apart.u}, kCrossing, out);
    return;
  }
  for (int i = 0; i < (f.count == 2 ? 1 : f.count); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const auto next = static_cast<std::size_t>(i + 1 < f.count ? i + 1 : 0);
    add_rim_crossings(disc, other.at[k], other.at[next], kCrossing | f.edge[k], out);
  }
}

}  // namespace

Vec3 corner_of_box(const Convex& c, unsigned corner) {
  const Vec3 h = c.shape.half_extents;
  const auto side = [corner](unsigned bit, Real half) { return (corner >> bit & 1u) != 0 ? half : -half; };
  return c.center + (side(0, h.x) * c.axes.x + side(1, h.y) * c.axes.y + side(2, h.z) * c.axes.z);
}

Feature face_of_box(const Convex& box, int face) {
  Feature f;
  f.kind = Feature::Kind::kPolygon;
  const auto& corners = kBoxFaces[static_cast<std::size_t>(face)];
  for (unsigned i = 0; i < 4; ++i) {
    f.add(corner_of_box(box, corners[i]), corners[i], static_cast<unsigned>(face) * 4 + i);
  }
  const Vec3 axis = face < 2 ? box.axes.x : face < 4 ? box.axes.y : box.axes.z;
  f.normal = face % 2 == 0 ? axis : -axis;
  return f;
}

Feature face_of_hull(const Convex& c, std::size_t face) {
  const geometry::ConvexHull::Face& from = c.hull->faces[face];
  HOOKE_ASSERT(from.count >= 3 && from.first + from.count <= c.hull->loop.size());
  Feature f;
  f.kind = Feature::Kind::kPolygon;
  f.normal = c.axes * from.normal;
  const std::uint32_t take = std::min<std::uint32_t>(from.count, Feature::kMaxPoints);
  for (std::uint32_t i = 0; i < take; ++i) {
    const std::uint32_t k = from.first + i * from.count / take;
    f.add(c.center + c.axes * c.hull->vertices[c.hull->loop[k]], c.hull->loop[k], k);
  }
  return f;
}

Feature feature_of_hull(const Convex& c, Vec3 n, Real least_cosine) {
  const geometry::ConvexHull& hull = *c.hull;
  const Vec3 local = {dot(c.axes.x, n), dot(c.axes.y, n), dot(c.axes.z, n)};
  std::size_t best = 0;
  for (std::size_t i = 1; i < hull.vertices.size(); ++i) {
    if (dot(hull.vertices[i], local) > dot(hull.vertices[best], local)) best = i;
  }
  // Only faces at the farthest vertex are compared: another face may have a better normal and yet lie behind.
  const auto has_best = [&](const geometry::ConvexHull::Face& f) {
    const auto first = hull.loop.begin() + f.first;
    return std::find(first, first + f.count, best) != first + f.count;
  };
  std::size_t face = 0;
  Real cosine = Real(-1);
  for (std::size_t i = 0; i < hull.faces.size(); ++i) {
    const Real c_face = dot(hull.faces[i].normal, local);
    if (c_face <= cosine || !has_best(hull.faces[i])) continue;
    face = i;
    cosine = c_face;
  }
  if (cosine >= least_cosine) return face_of_hull(c, face);
  // The edge whose slope down from the farthest vertex is least.
  Real flattest = kFlatSide;
  std::size_t other = best;
  for (const auto& edge : hull.edges) {
    if (edge.vertex_a != best && edge.vertex_b != best) continue;
    const std::size_t far_end = edge.vertex_a == best ? edge.vertex_b : edge.vertex_a;
    const Vec3 along = hull.vertices[best] - hull.vertices[far_end];
    const Real slope = dot(along, local) / length(along);
    other = slope < flattest ? far_end : other;
    flattest = std::min(flattest, slope);
  }
  const auto place = [&](std::size_t i) { return c.center + c.axes * hull.vertices[i]; };
  const auto id = [](std::size_t i) { return static_cast<std::uint32_t>(i); };
  if (other == best) return point_feature(place(best), id(best));
  const auto [first, second] = std::minmax(best, other);
  return segment_feature(place(first), id(first), place(second), id(second));
}

Feature feature_along(const Convex& convex, Vec3 n, Real least_cosine) {
  switch (convex.shape.kind) {
    case ShapeKind::kBox:
      return box_feature(convex, n, least_cosine);
    case ShapeKind::kHull:
      return feature_of_hull(convex, n, least_cosine);
    case ShapeKind::kCylinder:
      return cylinder_feature(convex, n);
    case ShapeKind::kCone:
      return cone_feature(convex, n);
    case ShapeKind::kCapsule:
      return capsule_feature(convex, n);
    case ShapeKind::kMesh:
      return triangle_feature(convex, n);
    case ShapeKind::kSphere:
    case ShapeKind::kHalfSpace:
    case ShapeKind::kCompound:
      break;
  }
  return point_feature(convex.center, 0);
}

void overlap_features(const Feature& a, const Feature& b, Real skin_a, Real skin_b, ContactResult& result) {
  using Kind = Feature::Kind;
  const Projection projection(result.normal);
  const Seen seen_a = projection.see(a);
  const Seen seen_b = projection.see(b);
  const Collector out = {projection, seen_a, seen_b, skin_a, skin_b, result};
  // The higher kind clips the lower one.
  const bool a_first = a.kind >= b.kind;
  const Seen& high = a_first ? seen_a : seen_b;
  const Seen& low = a_first ? seen_b : seen_a;
  if (low.feature->kind == Kind::kPoint) {
    // For a point with an edge or a point, the nearest points give a better position.
    if (high.feature->kind < Kind::kPolygon || !is_inside(high, a_first, low.at[0])) return;
    out.add(low.at[0], kVertexOfB | low.feature->vertex[0]);
  } else if (high.feature->kind == Kind::kDisc) {
    overlap_disc(high, low, a_first, out);
  } else if (low.feature->kind == Kind::kPolygon) {
    overlap_polygons(high, low, a_first, out);
  } else if (high.feature->kind == Kind::kPolygon) {
    overlap_segment(high, low, a_first, out);
  } else {
    overlap_segments(seen_a, seen_b, out);
  }
}

}  // namespace hooke::collision
