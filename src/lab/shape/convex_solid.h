#pragma once

#include "hooke/math.h"

#include "geometry/convex/convex_hull.h"

#include <array>
#include <cstdint>
#include <vector>

/// \file
/// Convex solids in double, by their features: how far two are apart or overlap, exactly, and where they
/// touch. Every feature of one is held against every feature of the other, so the cost is that of the product
/// of their sizes: for the laboratory and for tests, not for the step (collision/distance/distance.h).

namespace hooke::geometry {

/// The convex hull of `vertices` with a skin around it: a sphere is one vertex, a capsule two.
struct ConvexSolid {
  struct Face {
    DVec3 normal = {};                     ///< Unit, outward.
    double offset = 0;                     ///< dot(normal, x) on the face [m].
    std::vector<std::uint32_t> loop = {};  ///< Counter-clockwise; empty for a side that only bounds a plate.
  };

  std::vector<DVec3> vertices = {};
  std::vector<Face> faces = {};
  std::vector<std::array<std::uint32_t, 2>> edges = {};
  std::vector<std::array<std::uint32_t, 2>> directions = {};  ///< Edges of which no two are parallel.
  double skin = 0;                                            ///< [m]
};

[[nodiscard]] ConvexSolid solid_sphere(double radius);
/// About the segment from -half_height to half_height on y.
[[nodiscard]] ConvexSolid solid_capsule(double radius, double half_height);
/// A plate without thickness. Of corners on one line: a segment, or a point.
[[nodiscard]] ConvexSolid solid_triangle(DVec3 a, DVec3 b, DVec3 c);
/// The planes of faces are taken anew, in double.
[[nodiscard]] ConvexSolid solid_hull(const ConvexHull& hull);

/// The same solid rotated about the origin by the unit quaternion, then shifted [m].
[[nodiscard]] ConvexSolid placed(const ConvexSolid& solid, Quaternion<double> rotation, DVec3 shift);

/// How far B is from A.
struct SolidGap {
  double distance = 0;  ///< [m]; negative: the least way to part them.
  DVec3 normal = {};    ///< From A to B, unit.
};

/// Cores apart: the least of all distances between vertices, edges and faces. Cores that overlap: the plane
/// of a face, or across two edges, that they overlap least along (separating axes: Gottschalk, Lin, Manocha
/// 1996, "OBBTree"). Cores that are one point or one line part upward or across it.
/// Precondition: both have a vertex, and all is finite.
[[nodiscard]] SolidGap gap_between(const ConvexSolid& a, const ConvexSolid& b);

/// Least distance along the unit vector n between the planes across it that hold the solids apart, B on the
/// side of n [m]; negative where they overlap along it. Never more than their distance.
[[nodiscard]] double separation_along(const ConvexSolid& a, const ConvexSolid& b, DVec3 n);

/// Places where the features that lie within `tolerance` [m] of the planes of contact meet, seen along
/// `gap.normal`: corners of one over the other, and crossings of edges. Half way between the surfaces; at
/// least one.
[[nodiscard]] std::vector<DVec3> contact_points(const ConvexSolid& a, const ConvexSolid& b,
                                                const SolidGap& gap, double tolerance);

}  // namespace hooke::geometry
