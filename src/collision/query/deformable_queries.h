#pragma once

#include "hooke/math.h"
#include "hooke/query.h"

#include "state/tables.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

/// \file
/// Finds ropes, cloths, solids and particles with rays and points, where they are now. Each object is looked
/// at by its box first, then part by part: no tree is kept for queries, which are few in a step. What is
/// found follows from the tables alone.

namespace hooke::collision {

/// A place on a deformable; see DeformablePlace.
struct DeformableSpot {
  std::uint32_t object = 0;  ///< Row of the deformable.
  std::uint32_t element = 0;
  std::array<std::uint32_t, 3> corners = {};
  std::array<double, 3> weights = {1, 0, 0};
  DVec3 point = {};     ///< [m]
  DVec3 normal = {};    ///< Unit normal.
  double distance = 0;  ///< Of a ray: fraction of the motion. Of a point: distance, negative inside [m].
};

/// The first place in the path from `origin` over `motion` (finite, not zero) [m]. Of equally near ones it is
/// that of the object that was created first.
[[nodiscard]] std::optional<DeformableSpot> cast_ray(const state::Tables& tables,
                                                     const DeformableFilter& filter, DVec3 origin,
                                                     DVec3 motion);

/// The nearest place that is at most `reach` (not negative, may be infinite) from `point` [m], or of the
/// object in which `point` is deepest.
[[nodiscard]] std::optional<DeformableSpot> find_closest(const state::Tables& tables,
                                                         const DeformableFilter& filter, DVec3 point,
                                                         double reach);

/// Replaces `spots` by the nearest place of each object that is at most `reach` from `point`, or has it
/// inside, in order of creation.
void find_near(const state::Tables& tables, const DeformableFilter& filter, DVec3 point, double reach,
               std::vector<DeformableSpot>& spots);

/// The point, in the maker's order, that has the largest share in a place.
[[nodiscard]] std::uint32_t point_with_most_weight(const state::Tables& tables, const DeformableSpot& spot);

}  // namespace hooke::collision
