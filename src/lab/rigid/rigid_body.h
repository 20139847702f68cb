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
/// Represents bodies for the laboratory's collider: shapes in double, and where two of them touch.

namespace hooke::lab {

using Box = geometry::Box3<double>;

/// A RigidShape is one shape of a body, in the frame of its center of mass and principal axes.
struct RigidShape {
  ShapeKind kind = ShapeKind::kSphere;
  geometry::ConvexSolid solid = {};                       ///< Empty for half-spaces and meshes.
  std::shared_ptr<const state::Mesh> mesh = {};           ///< Set for kMesh only.
  std::shared_ptr<const geometry::ConvexHull> hull = {};  ///< Set for boxes and hulls.
  /// Set for closed meshes; if any body has a mesh, also for boxes and hulls.
  std::shared_ptr<const geometry::ContactMesh> surface = {};
  DVec3 position = {};               ///< Position of the frame of a half-space, a mesh or a surface.
  Quaternion<double> rotation = {};  ///< Rotation of the same frame.
  ContactDesc contact = {};
};

struct RigidBody {
  std::uint32_t slot = 0;
  int part = -1;         ///< Index among the bodies that move; -1 if it stands at `still`.
  bool is_free = false;  ///< Whether forces move it.
  double mass = 0;       ///< Mass of a body that forces move [kg].
  std::optional<Axle> axle = {};
  DVec3 inertia = {};  ///< Moments about the principal axes [kg m^2].
  BodyMotion still = {};
  std::vector<RigidShape> shapes = {};
  double radius = 0;  ///< Radius around the center of mass of all shapes [m]; infinite with a half-space.
  FilterDesc filter = {};
};

/// Returns all bodies that collide, by row: those that stand, and those that move with the index of their
/// part. A mesh that the World takes as convex parts collides by its triangles here. The Error is
/// kUnsupported for cylinders and cones, which have no corners, and for a mesh that is no solid if a body
/// with a mesh moves; it gives the reason.
[[nodiscard]] Result<std::vector<RigidBody>> rigid_bodies(const state::Tables& tables);

/// A Contact is a place where two bodies touch, or where they are nearest.
struct Contact {
  DVec3 point = {};     ///< Point in the world [m], half way between the surfaces.
  DVec3 normal = {};    ///< Unit vector from A to B.
  double distance = 0;  ///< Gap [m]; negative: depth.
  double friction = 0, static_friction = 0, restitution = 0;  ///< Values of the two materials.
};

/// This selects the tests for pairs of shapes.
struct ContactSearch {
  CollisionOptions::Collider collider = CollisionOptions::Collider::kExact;
  CollisionOptions::MeshSearch mesh_search = CollisionOptions::MeshSearch::kTree;

  ContactSearch() = default;
  explicit ContactSearch(const CollisionOptions& options)
      : collider(options.collider), mesh_search(options.mesh_search) {}
};

struct BodyGap {
  double distance = 0;  ///< Distance of the nearest shapes [m]; at least `reach` where nothing is nearer.
  DVec3 normal = {};    ///< Unit vector from A to B.
};

/// Returns the gap of the nearest pair of shapes. Meshes are searched up to `reach` [m].
[[nodiscard]] BodyGap gap_between(const RigidBody& a, const BodyMotion& at_a, const RigidBody& b,
                                  const BodyMotion& at_b, const ContactSearch& contact_search, double reach);

/// This tells which contacts find_contacts lists.
struct ContactQuery {
  ContactSearch search = {};
  double reach = 0;      ///< Largest distance of the shapes [m].
  double tolerance = 0;  ///< Features no farther than this from the planes of contact count as touching [m].
  std::span<const MaterialPairDesc> materials = {};  ///< The table of the World.
};

/// Appends the contacts of shapes within the reach, each with the normal and the distance of its shapes or
/// its triangle. Contacts of two meshes have a normal and a distance each.
void find_contacts(const RigidBody& a, const BodyMotion& at_a, const RigidBody& b, const BodyMotion& at_b,
                   const ContactQuery& query, std::vector<Contact>& contacts);

/// Returns a box around the shapes at one time.
[[nodiscard]] Box bounds_of(const RigidBody& body, const BodyMotion& at);

}  // namespace hooke::lab
