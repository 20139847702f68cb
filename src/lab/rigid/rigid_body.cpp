#include "lab/rigid/rigid_body.h"

#include "math/rotation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace hooke::lab {

namespace {

double in_double(Real value) {
  return static_cast<double>(value);
}

Error has_no_corners(const RigidBody& body, ShapeKind kind) {
  return {
      ErrorCode::kUnsupported, "body " + std::to_string(body.slot),
      std::string(kind == ShapeKind::kCone ? "a cone" : "a cylinder") +
          " has no corners; the laboratory collides spheres, capsules, boxes, hulls, half-spaces and meshes"};
}

/// Returns the core in the frame of its shape.
geometry::ConvexSolid solid_of(const state::ColliderShape& s) {
  if (s.shape.kind == ShapeKind::kSphere) return geometry::solid_sphere(in_double(s.shape.radius));
  if (s.shape.kind == ShapeKind::kCapsule)
    return geometry::solid_capsule(in_double(s.shape.radius), in_double(s.shape.half_height));
  return s.hull == nullptr ? geometry::ConvexSolid{} : geometry::solid_hull(*s.hull);
}

double radius_of(const RigidShape& shape) {
  if (shape.kind == ShapeKind::kHalfSpace) return std::numeric_limits<double>::infinity();
  double radius = 0;
  for (const DVec3 v : shape.solid.vertices) radius = std::max(radius, length(v) + shape.solid.skin);
  if (shape.mesh == nullptr) return radius;
  for (const Vec3 v : shape.mesh->desc.positions)
    radius = std::max(radius, length(shape.position + rotate(shape.rotation, vector_cast<double>(v))));
  return radius;
}

/// Surfaces makes the surface of each mesh once.
class Surfaces {
 public:
  using Surface = std::shared_ptr<const geometry::ContactMesh>;

  /// Returns null for a mesh that is no solid.
  Surface of(const std::shared_ptr<const state::Mesh>& mesh) {
    for (const auto& [known, surface] : made_) {
      if (known == mesh) return surface;
    }
    made_.emplace_back(mesh, make(mesh->desc));
    return made_.back().second;
  }
  static Surface make(const MeshDesc& mesh) {
    Result<geometry::ContactMesh> made = geometry::make_contact_mesh(mesh);
    return made ? std::make_shared<const geometry::ContactMesh>(std::move(made).value()) : nullptr;
  }

 private:
  std::vector<std::pair<std::shared_ptr<const state::Mesh>, Surface>> made_;
};

bool is_mesh(const RigidBody& body) {
  return std::any_of(body.shapes.begin(), body.shapes.end(),
                     [](const RigidShape& shape) { return shape.mesh != nullptr; });
}

/// Gives meshes a surface, and also boxes and hulls if any body has a mesh. If a body with a mesh moves, a
/// mesh without an inside is an Error.
Result<void> add_surfaces(std::vector<RigidBody>& bodies) {
  const bool any_moves = std::any_of(bodies.begin(), bodies.end(),
                                     [](const RigidBody& body) { return body.is_free && is_mesh(body); });
  const bool any = std::any_of(bodies.begin(), bodies.end(), is_mesh);
  Surfaces surfaces;
  for (RigidBody& body : bodies) {
    for (RigidShape& shape : body.shapes) {
      if (shape.mesh != nullptr) shape.surface = surfaces.of(shape.mesh);
      if (shape.hull != nullptr && any) shape.surface = Surfaces::make(geometry::mesh_of(*shape.hull));
      if (!any_moves || shape.mesh == nullptr || shape.surface != nullptr) continue;
      const Error reason = geometry::make_contact_mesh(shape.mesh->desc).error();
      return Error{
          ErrorCode::kUnsupported, "body " + std::to_string(body.slot),
          "is no solid, and a solid of triangles moves near it: " + reason.where + ": " + reason.message};
    }
  }
  return {};
}

Result<void> add_shapes(const state::Tables& tables, std::uint32_t row, RigidBody& body) {
  const Quaternion<double> to_principal = conjugate(math::in_double(tables.bodies.mass[row].principal));
  for (const std::uint32_t c : state::colliders_of(tables.bodies, row)) {
    const state::ColliderShape& own = tables.colliders.shape[c];
    RigidShape shape = {.kind = own.whole ? ShapeKind::kMesh : own.shape.kind,
                        .contact = tables.colliders.surface[c]};
    if (shape.kind == ShapeKind::kMesh) {
      shape.mesh = own.whole ? own.whole : own.mesh;
    } else {
      shape.hull = own.hull;
    }
    if (shape.kind == ShapeKind::kCylinder || shape.kind == ShapeKind::kCone)
      return has_no_corners(body, shape.kind);
    shape.position = rotate(to_principal, vector_cast<double>(tables.colliders.position[c]));
    shape.rotation = normalize(to_principal * math::in_double(tables.colliders.rotation[c]));
    const bool is_next_part = own.whole && !body.shapes.empty() && body.shapes.back().mesh == own.whole &&
                              body.shapes.back().position == shape.position &&
                              body.shapes.back().rotation == shape.rotation;
    if (is_next_part) continue;
    if (!own.whole) shape.solid = geometry::placed(solid_of(own), shape.rotation, shape.position);
    body.radius = std::max(body.radius, radius_of(shape));
    body.shapes.push_back(std::move(shape));
  }
  return {};
}

}  // namespace

Result<std::vector<RigidBody>> rigid_bodies(const state::Tables& tables) {
  const state::Bodies& bodies = tables.bodies;
  std::vector<RigidBody> result;
  int parts = 0;
  for (std::uint32_t row = 0; row < bodies.traits.size(); ++row) {
    const state::BodyTraits& traits = bodies.traits[row];
    if (!traits.alive) continue;
    RigidBody body = {.slot = bodies.slot[row]};
    if (traits.kind != BodyKind::kStatic) body.part = parts++;
    if (!traits.collides || traits.sensor) continue;
    body.filter = traits.filter;
    body.is_free = traits.kind == BodyKind::kDynamic;
    if (body.is_free) {
      body.mass = in_double(bodies.mass[row].mass);
      body.inertia = vector_cast<double>(bodies.mass[row].inertia);
      body.axle = axle_of(tables, row);
    }
    body.still = {.center = bodies.center[row],
                  .rotation = normalize(math::in_double(bodies.rotation[row]) *
                                        math::in_double(bodies.mass[row].principal))};
    if (const Result<void> added = add_shapes(tables, row, body); !added) return added.error();
    result.push_back(std::move(body));
  }
  if (const Result<void> added = add_surfaces(result); !added) return added.error();
  return result;
}

Box bounds_of(const RigidBody& body, const BodyMotion& at) {
  Box box;
  const auto add = [&](DVec3 own, double skin) {
    const DVec3 v = at.center + rotate(at.rotation, own);
    const DVec3 around = {skin, skin, skin};
    box = merge(box, Box{v - around, v + around});
  };
  for (const RigidShape& shape : body.shapes) {
    if (shape.kind == ShapeKind::kHalfSpace) return {-Box{}.lower, -Box{}.upper};
    for (const DVec3 v : shape.solid.vertices) add(v, shape.solid.skin);
    if (shape.mesh == nullptr) continue;
    for (const Vec3 v : shape.mesh->desc.positions)
      add(shape.position + rotate(shape.rotation, vector_cast<double>(v)), 0);
  }
  return box;
}

}  // namespace hooke::lab
