#pragma once

#include "hooke/desc.h"
#include "hooke/id.h"
#include "hooke/math.h"

#include <cstdint>

/// \file
/// What World's queries take and give: rays, swept shapes, nearest points.

namespace hooke {

/// Who can be found. By default every body that collides, but no sensor.
struct QueryFilter {
  FilterDesc filter = {};  ///< Found are the bodies that a body with this filter would collide with.
  BodyId skip = {};        ///< Not found: the body that asks, for example.
  bool sensors = false;    ///< Sensors are found too.
};

/// Where a ray or a swept shape first meets a body.
struct CastHit {
  BodyId body = {};
  std::uint32_t part = 0;      ///< Index into BodyDesc::parts; 0 for a body of one shape.
  std::uint32_t triangle = 0;  ///< Of a mesh.
  DVec3 point = {};            ///< On the body's surface [m].
  Vec3 normal = {};            ///< Of the body's surface, outward, unit.
  double fraction = 0;         ///< How much of the motion is free, in [0, 1].
  double distance = 0;         ///< The same as a way [m].
};

/// The point of a body's surface nearest to a place.
struct ClosestPoint {
  BodyId body = {};
  std::uint32_t part = 0;      ///< Index into BodyDesc::parts; 0 for a body of one shape.
  std::uint32_t triangle = 0;  ///< Of a mesh.
  DVec3 point = {};            ///< [m]
  Vec3 normal = {};            ///< Outward, unit.
  Real distance = Real(0);     ///< From the place [m]; negative: the place is inside.
};

}  // namespace hooke
