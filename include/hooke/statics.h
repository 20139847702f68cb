#pragma once

#include "hooke/math.h"
#include "hooke/result.h"
#include "hooke/shape.h"

#include <optional>
#include <vector>

/// \file
/// Where a rigid solid comes to rest, found by statics alone. Nothing here needs a World.

namespace hooke {

/// A way in which a solid lies still on a horizontal plane: on a facet of its convex hull that has the center
/// of mass above it.
struct StablePose {
  DVec3 normal = {};  ///< Outward unit normal of the facet it lies on, in the mesh's frame.
  /// Corners of that facet in the mesh's frame [m], counter-clockwise seen from outside.
  std::vector<DVec3> support = {};
  Quaternion<double> rotation = {};  ///< Shortest rotation of the mesh that turns `normal` straight down.
  /// Where to put the mesh's origin [m]: the solid then lies on the plane y = 0, its center of mass above the
  /// origin.
  DVec3 position = {};
  double height = 0;  ///< Height of the center of mass above the plane [m].
  /// Distance of the center of mass, seen from above, from the nearest side of the facet [m].
  double margin = 0;
  /// Smallest angle [rad] by which the solid must be tipped over a side of the facet until it falls.
  double tip_angle = 0;
  double tip_height = 0;  ///< How far the center of mass rises at least until the solid falls [m].
  /// Share of random orientations that end in this pose if the solid rolls slowly and slides freely.
  double probability = 0;
};

/// All stable poses of a solid on a plane.
struct StablePoses {
  std::vector<StablePose> poses = {};  ///< The most probable first. Probabilities sum to 1.
  DVec3 center = {};                   ///< Center of mass in the mesh's frame [m].
  /// How far points of the mesh stand out of the hull that was used [m]. A hull has 256 corners at most: a
  /// rounder mesh loses some, and its poses are those of the coarser hull.
  double hull_error = 0;
};

/// Finds the poses in which a solid lies still on a horizontal plane, and how probable each is.
///
/// - The center of mass is that of the volume inside the mesh, or `center` in the mesh's frame. With a center
///   given, the mesh may be open: only its convex hull touches the plane.
/// - The solid starts on each facet with the probability of the facet's solid angle, seen from the center of
///   mass. A facet that does not have the center above it passes its probability to the neighbor across the
///   side that the center overhangs most (Goldberg, Mirtich, Zhuang, Craig, Carlisle, Canny 1999, Part pose
///   statistics: estimators and experiments; the quasi-static estimator). Of a solid that bounces and
///   rolls on, poses which are easily tipped come out too probable.
/// - Facets within 2e-5 of the extent of one plane are one facet. A margin below 1e-6 of the largest distance
///   from the hull's center counts as none.
///
/// Errors: a mesh without volume inside if no center is given (its surface is open or faces inward), an index
/// or coordinate out of range, fewer than four points, a hull thinner than 1e-4 of its extent, a center that
/// is not finite or not inside the hull.
[[nodiscard]] Result<StablePoses> find_stable_poses(const MeshDesc& mesh, std::optional<DVec3> center = {});

}  // namespace hooke
