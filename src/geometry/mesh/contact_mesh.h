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

/// The method of a search. Both give the same answer to the bit.
enum class Search : std::uint8_t {
  kAll,   ///< Tests every triangle and every pair: the paper's brute force.
  kTree,  ///< Uses the tree of oriented boxes.
};

struct ContactMesh {
  std::vector<DVec3> positions = {};  ///< [m]
  std::vector<Triangle> triangles = {};
  MeshTopology topology = {};
  std::vector<DVec3> face_normals = {};           ///< Outward unit normals.
  std::vector<DVec3> edge_normals = {};           ///< Sum of the normals of each edge's two faces.
  std::vector<DVec3> vertex_normals = {};         ///< Sum of the normals of each vertex's faces, weighted by
                                                  ///< their angles there.
  std::vector<std::uint8_t> is_convex_edge = {};  ///< 1 where the solid at the edge is less than a
                                                  ///< half-space.
  BoundingSphere sphere = {};                     ///< Smallest sphere around the mesh.
  OrientedBoxTree tree = {};
  double size = 0;  ///< Largest absolute coordinate [m]; rounding errors are relative to it.

  [[nodiscard]] MeshView view() const { return {positions, triangles}; }
};

/// Errors: those of validate_solid, a coordinate beyond 1e9 m, a triangle without area. `where` names the
/// triangle.
[[nodiscard]] Result<ContactMesh> make_contact_mesh(const MeshDesc& mesh);

/// Part of a surface.
enum class SurfaceFeature : std::uint8_t { kFace, kEdge, kVertex };

/// The point of the surface nearest to a given point.
struct SolidPoint {
  DVec3 point = {};
  double signed_distance = 0;  ///< Distance, negative inside [m].
  SurfaceFeature feature = SurfaceFeature::kFace;
  std::uint32_t index = 0;     ///< Index of the triangle, edge or vertex that it lies on.
  std::uint32_t triangle = 0;  ///< A triangle that has the point.
};

/// The nearest point of all triangles, of equally near ones the first. The normal of the face, edge or vertex
/// says whether `p` is inside (Baerentzen and Aanaes 2005, Signed distance computation using the angle
/// weighted pseudonormal). This is exact for surfaces that do not cut themselves.
[[nodiscard]] SolidPoint closest_on_solid(const ContactMesh& solid, DVec3 p, Search search);

/// The point of one triangle nearest to `p`; its `feature` is that of the face, an edge or a vertex.
[[nodiscard]] SolidPoint closest_on_face(const ContactMesh& solid, std::uint32_t triangle, DVec3 p);

/// Replaces `found` by the triangles not farther from `p` than `distance` [m], in ascending order.
void find_near_faces(const ContactMesh& solid, DVec3 p, double distance, Search search,
                     std::vector<std::uint32_t>& found);

}  // namespace hooke::geometry
