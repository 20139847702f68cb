#pragma once

#include "hooke/desc.h"
#include "hooke/id.h"
#include "hooke/math.h"

#include <cstdint>

/// \file
/// What the queries of World take and give: rays, swept shapes, nearest points.

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

}  // namespace hooke
