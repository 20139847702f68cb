#pragma once

#include "geometry/mesh/contact_mesh.h"

#include <cstdint>
#include <vector>

/// \file
/// Finds the contacts of two solids with surfaces of triangles, convex or not: where they touch, which way
/// they push each other and how deep they overlap. It works in double for the laboratory, which moves bodies
/// until the overlap is small (the paper's 4.3 and 4.5). Depths are exact where the overlap is small against
/// the triangles.
///
/// The paper tests all faces and edges of one against all of the other. Trees of oriented boxes give the same
/// contacts to the bit.

namespace hooke::collision {

enum class MeshContactKind : std::uint8_t {
  kVertexFace,  ///< A vertex of a at a face of b: feature_a is the vertex, feature_b the triangle.
  /// feature_a is the triangle, feature_b the vertex.
  kFaceVertex,
  /// The features are an edge of each.
  kEdgeEdge,
  kEdgeFace,  ///< An edge of a goes through b and no edge of b is near: feature_b is the triangle nearest.
  kFaceEdge,  ///< feature_a is the triangle, feature_b the edge.
};

struct MeshContact {
  MeshContactKind kind = MeshContactKind::kVertexFace;
  std::uint32_t feature_a = geometry::kNone;
  std::uint32_t feature_b = geometry::kNone;
  DVec3 point = {};   ///< Point midway between the two surfaces [m].
  DVec3 normal = {};  ///< Unit vector from a to b; b moved along it leaves a.
  double depth = 0;   ///< Overlap along the normal [m]; negative: the gap.
};

/// This tells how far contacts are searched, and by which method.
struct MeshContactSearch {
  double margin = 0;  ///< Largest gap of a contact [m]; not negative.
  geometry::Search search = geometry::Search::kTree;
};

/// Replaces `found` by the contacts, in order of (kind, feature_a, feature_b). There is at least one if and
/// only if the solids overlap, touch, or have a vertex and a face, or two edges that face each other, within
/// the margin.
///
/// - A vertex in the other solid, or within the margin of it, is pushed out through the nearest face. Of
/// faces that are about as near (within the margin), it takes the one that the vertex's own solid is most
/// clear of. So a box resting on another of the same size is pushed up, not aside.
///
/// - A convex edge may go in through one face and out through another. Where those two meet in an edge, and
/// the way out over that edge is shorter, the two edges have a contact. Else the edge has one through the
/// face nearest to the middle of the part inside, or one at each end where that part is about as deep at
/// both.
///
/// - Two convex edges may cross within the margin, each on the outer side of the other.
///
/// It is defined for all finite poses with unit rotations; a pose that is not finite has no contacts.
void find_mesh_contacts(const geometry::ContactMesh& a, const geometry::RigidPose& pose_a,
                        const geometry::ContactMesh& b, const geometry::RigidPose& pose_b,
                        const MeshContactSearch& search, std::vector<MeshContact>& found);

/// Returns the largest depth of the contacts [m], or minus infinity without any.
[[nodiscard]] double largest_depth(const std::vector<MeshContact>& contacts);

/// Replaces `found` by the contacts of a sphere (a) with a solid (b). `radius` [m] is not negative. There is
/// one at each face, edge or vertex of the surface that is a local minimum of the distance from `center` and
/// within the margin of the sphere. A sphere whose center is inside the solid has one contact, at the nearest
/// point. `feature_b` is the index of a triangle, an edge or a vertex; the kinds are kVertexFace, kEdgeEdge
/// and kFaceVertex.
void find_sphere_contacts(DVec3 center, double radius, const geometry::ContactMesh& b,
                          const geometry::RigidPose& pose_b, const MeshContactSearch& search,
                          std::vector<MeshContact>& found);

}  // namespace hooke::collision
