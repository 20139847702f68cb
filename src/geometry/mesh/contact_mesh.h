#pragma once

#include "hooke/result.h"
#include "hooke/shape.h"

#include "geometry/mesh/volume_tree.h"

#include <cstdint>
#include <span>
#include <vector>

/// \file
/// The closed surface of a solid, convex or not, prepared for contact: normals of faces, edges and vertices,
/// and a tree. In double, in the mesh's own frame.

namespace hooke::geometry {

/// How a search goes: both give the same answer to the bit.
enum class Search : std::uint8_t {
  kAll,   ///< Every triangle, every pair: the paper's brute force.
  kTree,  ///< By the tree of oriented boxes.
};

struct ContactMesh {
  std::vector<DVec3> positions = {};  ///< [m]
  std::vector<Triangle> triangles = {};
  MeshTopology topology = {};
  std::vector<DVec3> face_normals = {};           ///< Outward, of length one.
  std::vector<DVec3> edge_normals = {};           ///< The sum of its two faces' normals.
  std::vector<DVec3> vertex_normals = {};         ///< Of its faces' normals, weighted by their angles there.
  std::vector<std::uint8_t> is_convex_edge = {};  ///< 1 where the solid is less than a half-space.
  BoundingSphere sphere = {};                     ///< The smallest.
  OrientedBoxTree tree = {};
  double size = 0;  ///< The largest coordinate's size [m]: what rounding errors are measured by.

  [[nodiscard]] MeshView view() const { return {positions, triangles}; }
};

/// Errors: those of validate_solid, a coordinate beyond 1e9 m, a triangle without area. `where` names the
/// triangle.
[[nodiscard]] Result<ContactMesh> make_contact_mesh(const MeshDesc& mesh);

/// Part of a surface.
enum class SurfaceFeature : std::uint8_t { kFace, kEdge, kVertex };

/// The place of the surface nearest to a point.
struct SolidPoint {
  DVec3 point = {};
  double signed_distance = 0;  ///< Negative inside [m].
  SurfaceFeature feature = SurfaceFeature::kFace;
  std::uint32_t index = 0;     ///< Of the triangle, edge or vertex it lies on.
  std::uint32_t triangle = 0;  ///< One that has the place.
};

/// The nearest of all triangles, of equally near ones the first. Inside or outside is told by the normal of
/// the face, edge or vertex (Baerentzen and Aanaes 2005, Signed distance computation using the angle weighted
/// pseudonormal): exact for surfaces that do not cut themselves.
[[nodiscard]] SolidPoint closest_on_solid(const ContactMesh& solid, DVec3 p, Search search);

/// The point of one triangle nearest to `p`; its `feature` is the face's, an edge's or a vertex'.
[[nodiscard]] SolidPoint closest_on_face(const ContactMesh& solid, std::uint32_t triangle, DVec3 p);

/// Replaces `found` by the triangles not farther from `p` than `distance` [m], in ascending order.
void find_near_faces(const ContactMesh& solid, DVec3 p, double distance, Search search,
                     std::vector<std::uint32_t>& found);

}  // namespace hooke::geometry
