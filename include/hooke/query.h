#pragma once

#include "hooke/desc.h"
#include "hooke/id.h"
#include "hooke/math.h"

#include <array>
#include <cstdint>

/// \file
/// What the queries of World take and give: rays, swept shapes, nearest points, of bodies and of deformables.

namespace hooke {

/// Which bodies a query finds. By default it finds every body that collides, but no sensor.
struct QueryFilter {
  FilterDesc filter = {};  ///< Finds the bodies that a body with this filter would collide with.
  BodyId skip = {};        ///< A body that is not found, such as the one that asks; null for none.
  bool sensors = false;    ///< Whether sensors are found too.
};

/// Where a ray or a swept shape first meets a body.
struct CastHit {
  BodyId body = {};            ///< The body that is met.
  std::uint32_t part = 0;      ///< Index into BodyDesc::parts; 0 for a body of one shape.
  std::uint32_t triangle = 0;  ///< Index of the triangle of a mesh; 0 for other shapes.
  DVec3 point = {};            ///< Place on the body's surface, in the world [m].
  Vec3 normal = {};            ///< Outward normal of the body's surface, of unit length.
  double fraction = 0;         ///< Share of the motion that is free. [0, 1]
  double distance = 0;         ///< Length of that share [m].
};

/// The point of a body's surface nearest to a place.
struct ClosestPoint {
  BodyId body = {};            ///< The body that has the point.
  std::uint32_t part = 0;      ///< Index into BodyDesc::parts; 0 for a body of one shape.
  std::uint32_t triangle = 0;  ///< Index of the triangle of a mesh; 0 for other shapes.
  DVec3 point = {};            ///< The point, in the world [m].
  Vec3 normal = {};            ///< Outward normal of the surface there, of unit length.
  Real distance = Real(0);     ///< Distance of the place from the point [m]; negative if the place is inside.
};

/// Which deformables a query finds; all by default.
struct DeformableFilter {
  /// Finds the cloths and solids that a cloth with this filter would touch. Ropes and particles have no
  /// filter of their own: they count as having the default one.
  FilterDesc filter = {};
  PointRef skip = {};     ///< An object that is not found; any of its points. Empty for none.
  bool ropes = true;      ///< Whether ropes are found.
  bool cloths = true;     ///< Whether cloths are found.
  bool solids = true;     ///< Whether solids are found.
  bool particles = true;  ///< Whether loose particles are found.
  /// Added to the radius of ropes and particles [m], not negative, so that a pointer meets thin ones.
  Real margin = Real(0);
};

/// A place on a deformable, and what it belongs to. A rope is a tube of its radius about its segments, and a
/// particle a ball of its radius. A cloth is the surface through its points, without its thickness. A solid
/// is what World::surface shows.
struct DeformablePlace {
  /// The object, with the point that moves the place most as its index. It fits World::apply_force,
  /// World::pin and HookEnd; with the index PointRef::kNearest and `point` as its anchor, a hook holds the
  /// place itself.
  PointRef nearest = {};
  /// Which part of the object: a segment of a rope, which joins the points `element` and `element` + 1; an
  /// index into World::triangles of a cloth or solid; or the number of a particle.
  std::uint32_t element = 0;
  /// Corners of that part: points of the object, or of a solid indices into World::surface. A segment has two
  /// of them and a particle one; the rest repeats the first.
  std::array<std::uint32_t, 3> corners = {};
  /// Weights of the corners, with the sum 1: they give the place on the triangle, on the middle line of a
  /// rope, or at the center of a particle.
  std::array<Real, 3> weights = {Real(1), Real(0), Real(0)};
  DVec3 point = {};  ///< The place on the surface, in the world [m].
  /// Normal of the surface, of unit length: outward, or to the side of a cloth from which the query looks.
  Vec3 normal = {};
};

/// Where a ray first meets a deformable.
struct DeformableHit {
  DeformablePlace place = {};  ///< The place that is met.
  double fraction = 0;         ///< Share of the motion that is free. [0, 1]
  double distance = 0;         ///< Length of that share [m].
};

/// The place of a deformable that is nearest to a point.
struct ClosestDeformable {
  DeformablePlace place = {};  ///< The place.
  /// Distance of the point from it [m]; negative if the point is inside a rope, a solid or a particle.
  Real distance = Real(0);
};

}  // namespace hooke
