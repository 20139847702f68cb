#pragma once

#include "geometry/mesh/contact_mesh.h"

#include <cstdint>
#include <vector>

/// \file
/// Two solids with surfaces of triangles, convex or not, each where it is: where they touch, which way they
/// push each other and how deep they overlap. In double, for the laboratory, which moves until the overlap is
/// small (the paper's 4.3 and 4.5): depths are exact where the overlap is small against the triangles.
///
/// The paper tests all faces and edges of one against all of the other; the same by trees of oriented boxes
/// gives the same contacts to the bit.

namespace hooke::collision {

enum class MeshContactKind : std::uint8_t {
  kVertexFace,  ///< A vertex of a at a face of b: feature_a is the vertex, feature_b the triangle.
  kFaceVertex,  ///< feature_a is the triangle, feature_b the vertex.
  kEdgeEdge,    ///< An edge of each.
  kEdgeFace,    ///< An edge of a goes through b and no edge of b is near: feature_b is the triangle nearest.
  kFaceEdge,    ///< feature_a is the triangle, feature_b the edge.
};

struct MeshContact {
  MeshContactKind kind = MeshContactKind::kVertexFace;
  std::uint32_t feature_a = geometry::kNone;
  std::uint32_t feature_b = geometry::kNone;
  DVec3 point = {};   ///< Midway between the two surfaces [m].
  DVec3 normal = {};  ///< Of length one, from a to b: b moved along it gets away.
  double depth = 0;   ///< Overlap along the normal [m]; negative: the gap between the two.
};

/// Tells how far contacts are searched, and by which method.
struct MeshContactSearch {
  double margin = 0;  ///< Largest gap of a contact [m]; not negative.
  geometry::Search search = geometry::Search::kTree;
};

/// Replaces `found` by the contacts, in order of (kind, feature_a, feature_b). There is one if and only if
/// the solids overlap, or touch, or a vertex and a face or two edges that face each other are not farther
/// apart than the margin.
///
/// - A vertex in the other solid, or within the margin of it: pushed out through the nearest face; of the
///   faces that are about as near (within the margin) through the one that the vertex' own solid is most
///   clear of. So a box resting on another of the same size is pushed up, not aside.
/// - A convex edge that goes in through one face and out through another: where those two meet in an edge,
///   and that is the shorter way out, the contact of the two edges. Else one through the face nearest to the
///   middle of the part inside; where that part is as deep at both ends, one at each end.
/// - Two convex edges that cross within the margin, each on the outer side of the other.
///
/// Total for finite poses with rotations of length one; a pose that is not finite has no contacts.
void find_mesh_contacts(const geometry::ContactMesh& a, const geometry::RigidPose& pose_a,
                        const geometry::ContactMesh& b, const geometry::RigidPose& pose_b,
                        const MeshContactSearch& search, std::vector<MeshContact>& found);

/// The largest depth of the contacts [m]; minus infinity without any.
[[nodiscard]] double largest_depth(const std::vector<MeshContact>& contacts);

/// Replaces `found` by the contacts of a sphere (a) of `radius` [m] (not negative) about `center` with a
/// solid (b): the face, edge or vertex at each place of the surface that is nearer than any around it, within
/// the margin of the sphere. With its center inside the solid the sphere has one contact, at the nearest
/// place. `feature_b` is a triangle's, edge's or vertex' index; the kinds are kVertexFace, kEdgeEdge,
/// kFaceVertex.
void find_sphere_contacts(DVec3 center, double radius, const geometry::ContactMesh& b,
                          const geometry::RigidPose& pose_b, const MeshContactSearch& search,
                          std::vector<MeshContact>& found);

}  // namespace hooke::collision
