#pragma once

#include "hooke/math.h"

#include "geometry/convex/convex_hull.h"

#include <array>
#include <cstdint>
#include <vector>

/// \file
/// Represents convex solids in double, by their features: how far two are apart or overlap, exactly, and
/// where they touch. Every feature of one is compared with every feature of the other, so the cost is the
/// product of their sizes. This serves the laboratory and tests; a step uses collision/distance/distance.h.

namespace hooke::geometry {

/// A ConvexSolid is the convex hull of `vertices` with a skin around it. A sphere is one vertex, a capsule
/// two.
struct ConvexSolid {
  struct Face {
    DVec3 normal = {};  ///< Unit vector, outward.
    double offset = 0;  ///< dot(normal, x) on the face [m].
    /// Counter-clockwise; empty for a side that only bounds a flat solid.
    std::vector<std::uint32_t> loop = {};
  };

  std::vector<DVec3> vertices = {};
  std::vector<Face> faces = {};
  std::vector<std::array<std::uint32_t, 2>> edges = {};
  std::vector<std::array<std::uint32_t, 2>> directions = {};  ///< Edges of which no two are parallel.
  double skin = 0;                                            ///< [m]
};

[[nodiscard]] ConvexSolid solid_sphere(double radius);
/// Makes a capsule about the segment from -half_height to half_height on y.
[[nodiscard]] ConvexSolid solid_capsule(double radius, double half_height);
/// Makes a flat solid without thickness. Corners on one line give a segment, or a point.
[[nodiscard]] ConvexSolid solid_triangle(DVec3 a, DVec3 b, DVec3 c);
/// Makes the solid of a hull. The planes of its faces are computed anew, in double.
[[nodiscard]] ConvexSolid solid_hull(const ConvexHull& hull);

/// Returns the solid rotated about the origin by the unit quaternion, then shifted [m].
[[nodiscard]] ConvexSolid placed(const ConvexSolid& solid, Quaternion<double> rotation, DVec3 shift);

/// A SolidGap tells how far B is from A.
struct SolidGap {
  double distance = 0;  ///< Distance [m]; negative: the least translation that separates them.
  DVec3 normal = {};    ///< Unit vector from A to B.
};

/// Returns the gap of two solids. Where the cores are apart it is the least distance between vertices, edges
/// and faces. Where they overlap it is along the separating axis of least overlap: a normal of a face, or
/// across two edges (Gottschalk, Lin, Manocha 1996, "OBBTree"). Cores that are one point or one line separate
/// upward or across the line. Precondition: both have a vertex, and all is finite.
[[nodiscard]] SolidGap gap_between(const ConvexSolid& a, const ConvexSolid& b);

/// Returns the least distance along the unit vector n between planes across n that separate the solids, B on
/// the side of n [m]; it is negative where they overlap along n. It never exceeds their distance.
[[nodiscard]] double separation_along(const ConvexSolid& a, const ConvexSolid& b, DVec3 n);

/// Returns points where the features within `tolerance` [m] of the planes of contact overlap, seen along
/// `gap.normal`: corners of one over the other, and crossings of edges. They lie half way between the
/// surfaces; there is at least one.
[[nodiscard]] std::vector<DVec3> contact_points(const ConvexSolid& a, const ConvexSolid& b,
                                                const SolidGap& gap, double tolerance);

}  // namespace hooke::geometry
