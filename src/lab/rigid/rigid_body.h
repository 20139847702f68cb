#pragma once

#include "geometry/box.h"
#include "geometry/mesh/contact_mesh.h"
#include "lab/shape/convex_solid.h"
#include "lab/system/system.h"
#include "state/tables.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

/// \file
/// What bodies are to the laboratory's collider: shapes in double, and where two of them touch.

namespace hooke::lab {

using Box = geometry::Box3<double>;

/// One shape of a body, seen from its center of mass in its principal axes.
struct RigidShape {
  ShapeKind kind = ShapeKind::kSphere;
  geometry::ConvexSolid solid = {};                       ///< But for half-spaces and meshes.
  std::shared_ptr<const state::Mesh> mesh = {};           ///< kMesh only.
  std::shared_ptr<const geometry::ConvexHull> hull = {};  ///< Of boxes and hulls.
  /// Of closed meshes; where there is one, also of boxes and hulls.
  std::shared_ptr<const geometry::ContactMesh> surface = {};
  DVec3 position = {};               ///< Of the frame of a half-space, a mesh or a surface.
  Quaternion<double> rotation = {};  ///< Of the same.
  ContactDesc contact = {};
};

struct RigidBody {
  std::uint32_t slot = 0;
  int part = -1;         ///< Index among the bodies that move; -1: it stands at `still`.
  bool is_free = false;  ///< Forces move it.
  double mass = 0;       ///< [kg]; with `inertia` of bodies that forces move.
  std::optional<Axle> axle = {};
  DVec3 inertia = {};  ///< About the principal axes [kg m^2].
  BodyMotion still = {};
  std::vector<RigidShape> shapes = {};
  double radius = 0;  ///< Around the center of mass, of all shapes [m]; infinite with a half-space.
  FilterDesc filter = {};
};

/// All bodies that collide, by row: those that stand, and those that move with the index of their part. Of a
/// solid of triangles that the World takes as convex parts the triangles collide here. Errors: kUnsupported
/// for cylinders and cones, which have no corners; for a mesh that is no solid where one that moves may meet
/// it, with the reason.
[[nodiscard]] Result<std::vector<RigidBody>> rigid_bodies(const state::Tables& tables);

/// Where two bodies touch, or what keeps them apart.
struct Contact {
  DVec3 point = {};     ///< In the world [m], half way between the surfaces.
  DVec3 normal = {};    ///< From A to B, unit.
  double distance = 0;  ///< [m]; negative: depth.
  double friction = 0, static_friction = 0, restitution = 0;  ///< Of the two materials.
};

/// How a collider looks at pairs of shapes.
struct ContactSearch {
  CollisionOptions::Collider collider = CollisionOptions::Collider::kExact;
  CollisionOptions::MeshSearch mesh_search = CollisionOptions::MeshSearch::kTree;

  ContactSearch() = default;
  explicit ContactSearch(const CollisionOptions& options)
      : collider(options.collider), mesh_search(options.mesh_search) {}
};

struct BodyGap {
  double distance = 0;  ///< Of the nearest shapes [m]; at least `reach` where there is nothing nearer.
  DVec3 normal = {};    ///< From A to B.
};

/// Nearest of all pairs of shapes. Meshes are asked up to `reach` [m] from them.
[[nodiscard]] BodyGap gap_between(const RigidBody& a, const BodyMotion& at_a, const RigidBody& b,
                                  const BodyMotion& at_b, const ContactSearch& contact_search, double reach);

/// Tells which contacts find_contacts lists.
struct ContactQuery {
  ContactSearch search = {};
  double reach = 0;      ///< Largest distance of the shapes [m].
  double tolerance = 0;  ///< Corners belong to a place if they are no farther than this from it [m].
  std::span<const MaterialPairDesc> materials = {};  ///< The world's table.
};

/// Appends the places where shapes are within the reach, each with the normal and the distance of its shapes,
/// or triangle; of two solids of triangles each with its own.
void find_contacts(const RigidBody& a, const BodyMotion& at_a, const RigidBody& b, const BodyMotion& at_b,
                   const ContactQuery& query, std::vector<Contact>& contacts);

/// The shapes where they stand.
[[nodiscard]] Box bounds_of(const RigidBody& body, const BodyMotion& at);

}  // namespace hooke::lab
