#pragma once

#include "geometry/triangle_mesh.h"

namespace hooke::geometry {

/// For each vertex, its distance from the nearest source along the surface, and that source.
struct GeodesicField {
  std::vector<Real> distance = {};         ///< [m]; infinity where no source can be reached.
  std::vector<std::uint32_t> source = {};  ///< A vertex of `sources`; kNone where none can be reached.
};

/// Distances along the triangles from the nearest of `sources` (vertices; those the mesh does not have are
/// ignored). They are exact on flat convex sheets with one source. Otherwise they are near: 1 % short on a
/// sphere of 8,000 triangles, 1 % long behind a corner, 4 % long at worst on a very uneven sheet. They are
/// never shorter than the straight line to the source, and never longer than the path along edges.
///
/// A front is marched outward from the sources (Kimmel and Sethian, 1998, Computing geodesic paths on
/// manifolds) with the update of Novotni and Klein (2002, Computing geodesic distances on triangular meshes):
/// the two known distances of a triangle give the position of the source in the triangle's plane, and the
/// third is the straight line from there. If the two come from different sources, the front is taken as
/// straight. A vertex whose distance shrinks is marched from again, which makes obtuse triangles harmless.
///
/// Precondition: `topology` is that of `triangles`, and has one vertex for each position.
GeodesicField compute_geodesic_field(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                                     const MeshTopology& topology, std::span<const std::uint32_t> sources);

}  // namespace hooke::geometry
