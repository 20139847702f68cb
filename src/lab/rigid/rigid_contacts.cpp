/// Tests pairs of shapes: how far they are apart, and where they touch.

#include "collision/distance/pair_surface.h"
#include "lab/rigid/rigid_body.h"
#include "lab/shape/mesh_gap.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace hooke::lab {

namespace {

using geometry::ConvexSolid;
using geometry::SolidGap;

/// A distance larger than any that is asked for.
constexpr double kNothing = 1e30;

/// A Plane is solid below.
struct Plane {
  DVec3 normal = {};
  double offset = 0;
};

/// This is a shape at the position of its body.
struct PlacedRigidShape {
  const RigidShape& shape;
  ConvexSolid solid = {};  ///< Set for convex shapes.
  DVec3 position = {};     ///< Position of the frame of other shapes.
  Quaternion<double> rotation = {};

  PlacedRigidShape(const RigidShape& s, const BodyMotion& at)
      : shape(s),
        solid(geometry::placed(s.solid, at.rotation, at.center)),
        position(at.center + rotate(at.rotation, s.position)),
        rotation(normalize(at.rotation * s.rotation)) {}

  [[nodiscard]] bool is_convex() const { return !solid.vertices.empty(); }
  [[nodiscard]] bool is_mesh() const { return shape.mesh != nullptr; }
  [[nodiscard]] geometry::RigidPose pose() const { return {position, rotation}; }
  [[nodiscard]] Plane plane() const {
    const DVec3 n = rotate(rotation, DVec3{0, 1, 0});
    return {n, dot(n, position)};
  }
};

double height_over(const Plane& plane, const ConvexSolid& solid) {
  double low = kNothing;
  for (const DVec3 v : solid.vertices) low = std::min(low, dot(plane.normal, v) - plane.offset);
  return low - solid.skin;
}

/// Applies the paper's test of a sphere: the distance to the plane of each face that its center is above.
SolidGap gap_to_faces(const ConvexSolid& solid, const ConvexSolid& ball) {
  SolidGap best = {kNothing, {0, 1, 0}};
  const DVec3 center = ball.vertices[0];
  for (const ConvexSolid::Face& face : solid.faces) {
    const double height = dot(face.normal, center) - face.offset;
    if (face.loop.empty() || height < -ball.skin) continue;
    bool is_over = true;
    for (std::size_t i = 0; i < face.loop.size(); ++i) {
      const DVec3 from = solid.vertices[face.loop[i]];
      const DVec3 to = solid.vertices[face.loop[(i + 1) % face.loop.size()]];
      is_over = is_over && dot(face.normal, cross(to - from, center - from)) >= 0;
    }
    if (is_over && height - ball.skin < best.distance) best = {height - ball.skin, face.normal};
  }
  return best;
}

SolidGap convex_gap(const ConvexSolid& a, const ConvexSolid& b, const ContactSearch& contact_search) {
  if (contact_search.collider == CollisionOptions::Collider::kFaces) {
    if (b.vertices.size() == 1 && !a.faces.empty()) return gap_to_faces(a, b);
    if (a.vertices.size() == 1 && !b.faces.empty()) {
      const SolidGap gap = gap_to_faces(b, a);
      return {gap.distance, -gap.normal};
    }
  }
  return geometry::gap_between(a, b);
}

/// Returns the triangles of a mesh within `reach` of a solid, each as a solid of its own.
std::vector<ConvexSolid> triangles_near(const PlacedRigidShape& mesh, const ConvexSolid& solid,
                                        double reach) {
  const Quaternion<double> back = conjugate(mesh.rotation);
  const double around = solid.skin + reach;
  Box box;
  for (const DVec3 v : solid.vertices) {
    const DVec3 own = rotate(back, v - mesh.position);
    box = merge(box, Box{own - DVec3{around, around, around}, own + DVec3{around, around, around}});
  }
  std::vector<std::uint32_t> found;
  geometry::find_triangles(mesh.shape.mesh->bvh, {vector_cast<Real>(box.lower), vector_cast<Real>(box.upper)},
                           found);
  std::vector<ConvexSolid> result;
  for (const std::uint32_t triangle : found) {
    const auto [a, b, c] = mesh.shape.mesh->desc.triangles[triangle];
    const auto corner = [&](std::uint32_t i) {
      return mesh.position + rotate(mesh.rotation, vector_cast<double>(mesh.shape.mesh->desc.positions[i]));
    };
    result.push_back(geometry::solid_triangle(corner(a), corner(b), corner(c)));
  }
  return result;
}

/// A mesh is tested against a plane by its vertices.
ConvexSolid vertices_of(const PlacedRigidShape& mesh) {
  ConvexSolid solid;
  for (const Vec3 v : mesh.shape.mesh->desc.positions)
    solid.vertices.push_back(to_world(mesh.pose(), vector_cast<double>(v)));
  return solid;
}

/// Tells whether both shapes have a surface and at least one is a mesh.
bool are_surfaces(const PlacedRigidShape& a, const PlacedRigidShape& b) {
  return a.shape.surface && b.shape.surface && (a.is_mesh() || b.is_mesh());
}

bool is_ball_at_surface(const PlacedRigidShape& a, const PlacedRigidShape& b,
                        const ContactSearch& contact_search) {
  return a.shape.kind == ShapeKind::kSphere && b.is_mesh() && b.shape.surface &&
         contact_search.collider == CollisionOptions::Collider::kExact;
}

geometry::Search search_of(const ContactSearch& contact_search) {
  return contact_search.mesh_search == CollisionOptions::MeshSearch::kAll ? geometry::Search::kAll
                                                                          : geometry::Search::kTree;
}

std::vector<collision::MeshContact> ball_contacts(const PlacedRigidShape& ball, const PlacedRigidShape& mesh,
                                                  const ContactSearch& contact_search, double reach) {
  std::vector<collision::MeshContact> contacts;
  collision::find_sphere_contacts(ball.solid.vertices[0], ball.solid.skin, *mesh.shape.surface, mesh.pose(),
                                  {reach, search_of(contact_search)}, contacts);
  return contacts;
}

/// Calls `visit(contact)` for each contact of two surfaces, or of a surface and a sphere, with normals from a
/// to b. \return Whether the shapes are of these kinds.
template <class Visit>
bool for_each_mesh_contact(const PlacedRigidShape& a, const PlacedRigidShape& b,
                           const ContactSearch& contact_search, double reach, Visit&& visit) {
  const bool swapped = is_ball_at_surface(b, a, contact_search);
  std::vector<collision::MeshContact> contacts;
  if (are_surfaces(a, b)) {
    collision::find_mesh_contacts(*a.shape.surface, a.pose(), *b.shape.surface, b.pose(),
                                  {reach, search_of(contact_search)}, contacts);
  } else if (swapped || is_ball_at_surface(a, b, contact_search)) {
    contacts =
        swapped ? ball_contacts(b, a, contact_search, reach) : ball_contacts(a, b, contact_search, reach);
  } else {
    return false;
  }
  for (collision::MeshContact& contact : contacts) {
    if (swapped) contact.normal = -contact.normal;
    visit(contact);
  }
  return true;
}

/// Calls `visit(solid_a, solid_b, gap)` for each pair of convex pieces, and `visit_plane(plane, solid,
/// swapped)` for a half-space and a piece.
template <class Visit, class VisitPlane>
void for_each_piece(const PlacedRigidShape& a, const PlacedRigidShape& b, const ContactSearch& contact_search,
                    double reach, Visit&& visit, VisitPlane&& visit_plane) {
  if (a.is_convex() && b.is_convex()) {
    visit(a.solid, b.solid, convex_gap(a.solid, b.solid, contact_search));
  } else if (a.shape.kind == ShapeKind::kHalfSpace && b.is_convex()) {
    visit_plane(a.plane(), b.solid, false);
  } else if (b.shape.kind == ShapeKind::kHalfSpace && a.is_convex()) {
    visit_plane(b.plane(), a.solid, true);
  } else if (a.shape.kind == ShapeKind::kHalfSpace && b.is_mesh()) {
    visit_plane(a.plane(), vertices_of(b), false);
  } else if (b.shape.kind == ShapeKind::kHalfSpace && a.is_mesh()) {
    visit_plane(b.plane(), vertices_of(a), true);
  } else if (a.is_mesh() && b.is_convex()) {
    for (const ConvexSolid& piece : triangles_near(a, b.solid, reach))
      visit(piece, b.solid, convex_gap(piece, b.solid, contact_search));
  } else if (b.is_mesh() && a.is_convex()) {
    for (const ConvexSolid& piece : triangles_near(b, a.solid, reach))
      visit(a.solid, piece, convex_gap(a.solid, piece, contact_search));
  }
}

template <class Visit>
void for_each_pair(const RigidBody& a, const BodyMotion& at_a, const RigidBody& b, const BodyMotion& at_b,
                   Visit&& visit) {
  for (const RigidShape& of_a : a.shapes) {
    const PlacedRigidShape shape_a(of_a, at_a);
    for (const RigidShape& of_b : b.shapes) visit(shape_a, PlacedRigidShape(of_b, at_b));
  }
}

}  // namespace

BodyGap gap_between(const RigidBody& a, const BodyMotion& at_a, const RigidBody& b, const BodyMotion& at_b,
                    const ContactSearch& contact_search, double reach) {
  BodyGap best = {kNothing, {0, 1, 0}};
  const auto take = [&](double distance, DVec3 normal) {
    if (distance < best.distance) best = {distance, normal};
  };
  for_each_pair(a, at_a, b, at_b, [&](const PlacedRigidShape& of_a, const PlacedRigidShape& of_b) {
    if (of_a.is_mesh() || of_b.is_mesh()) take(reach, best.normal);
    if (are_surfaces(of_a, of_b)) {
      const collision::MeshGap gap =
          collision::find_mesh_gap(*of_a.shape.surface, of_a.pose(), *of_b.shape.surface, of_b.pose(), reach,
                                   search_of(contact_search));
      take(gap.distance, gap.normal);
      return;
    }
    if (for_each_mesh_contact(of_a, of_b, contact_search, reach, [&](const collision::MeshContact& contact) {
          take(-contact.depth, contact.normal);
        }))
      return;
    for_each_piece(
        of_a, of_b, contact_search, reach,
        [&](const ConvexSolid&, const ConvexSolid&, const SolidGap& gap) { take(gap.distance, gap.normal); },
        [&](const Plane& plane, const ConvexSolid& solid, bool swapped) {
          take(height_over(plane, solid), swapped ? -plane.normal : plane.normal);
        });
  });
  return best;
}

void find_contacts(const RigidBody& a, const BodyMotion& at_a, const RigidBody& b, const BodyMotion& at_b,
                   const ContactQuery& query, std::vector<Contact>& contacts) {
  for_each_pair(a, at_a, b, at_b, [&](const PlacedRigidShape& of_a, const PlacedRigidShape& of_b) {
    const collision::PairSurface surface =
        collision::surface_of(of_a.shape.contact, of_b.shape.contact, query.materials);
    const auto add = [&](DVec3 point, DVec3 normal, double distance) {
      contacts.push_back({point, normal, distance, static_cast<double>(surface.friction),
                          static_cast<double>(surface.static_friction),
                          static_cast<double>(surface.restitution)});
    };
    if (for_each_mesh_contact(of_a, of_b, query.search, query.reach,
                              [&](const collision::MeshContact& contact) {
                                add(contact.point, contact.normal, -contact.depth);
                              }))
      return;
    for_each_piece(
        of_a, of_b, query.search, query.reach,
        [&](const ConvexSolid& x, const ConvexSolid& y, const SolidGap& gap) {
          if (gap.distance > query.reach) return;
          for (const DVec3 point : geometry::contact_points(x, y, gap, query.tolerance))
            add(point, gap.normal, gap.distance);
        },
        [&](const Plane& plane, const ConvexSolid& solid, bool swapped) {
          const double low = height_over(plane, solid);
          if (low > query.reach) return;
          for (const DVec3 v : solid.vertices) {
            const double height = dot(plane.normal, v) - plane.offset - solid.skin;
            if (!(height <= low + query.tolerance)) continue;
            add(v - (solid.skin + 0.5 * height) * plane.normal, swapped ? -plane.normal : plane.normal,
                height);
          }
        });
  });
}

}  // namespace hooke::lab
