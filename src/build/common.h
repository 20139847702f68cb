#pragma once

#include "hooke/desc.h"

#include "build/checks.h"
#include "geometry/solid/tetrahedral_mesh.h"
#include "state/tables.h"

#include <limits>
#include <memory>
#include <vector>

namespace hooke::build {

/// The points of a new deformable, one entry for each, in the order of its maker.
struct Points {
  std::vector<DVec3> position;
  std::vector<Vec3> velocity;
  std::vector<Real> mass;
  std::vector<Real> charge;
  std::vector<Real> viscous_drag;
  std::vector<Real> drag_area;
  std::vector<Real> radius;
  std::vector<std::uint32_t> row_of;  ///< Row of each point, from the object's first one.

  /// Makes `count` points with all values zero and rows in the same order.
  explicit Points(std::size_t count);
};

/// Checks that pins and loads name points below `count`, and checks their motions and masses.
void check_points(Checks& checks, const std::vector<PinDesc>& pins, const std::vector<LoadDesc>& loads,
                  std::size_t count);

/// Adds loads to the mass of each point.
void add_loads(const std::vector<LoadDesc>& loads, std::vector<Real>& mass);

/// Appends a deformable with these points. It has no rows in other tables yet; they begin at the ends of
/// those. Its origin is the middle of the points' bounding box, rounded to whole meters, so that offsets are
/// small and can be shifted exactly.
state::Deformable& append_object(PointRef::Kind kind, const Points& points, const std::vector<PinDesc>& pins,
                                 state::Tables& tables);

/// Makes the skin of a solid from its outer points and the faces between them.
[[nodiscard]] std::shared_ptr<const state::Skin> skin_of(const geometry::TetrahedralMesh& mesh);
/// Makes a skin of the vertices of `surface`, held by the tetrahedra in which they lie.
[[nodiscard]] std::shared_ptr<const state::Skin> skin_of(const geometry::TetrahedralMesh& mesh,
                                                         const MeshDesc& surface);

struct SpringRow {
  std::uint32_t a = 0, b = 0;  ///< Points of the object, in the order of its maker.
  Real rest_length = Real(0);
  Real stiffness = Real(0);
  Real damping = Real(0);
  Real damped_mass = std::numeric_limits<Real>::infinity();
  state::SpringClass kind = state::SpringClass::kStretch;
  state::SpringForm form = state::SpringForm::kExplicit;
};

/// Appends a spring to the last object.
void append_spring(const SpringRow& spring, state::Tables& tables);

/// Says of the object that was appended last which events it asks for.
void report_contacts(bool contacts, Real hit_speed, state::Tables& tables);

/// Row of a point of `object` in the table of particles.
[[nodiscard]] inline std::uint32_t row_of(const state::Tables& tables, const state::Deformable& object,
                                          std::uint32_t point) {
  return object.particles.first + tables.particles.row_of[object.particles.first + point];
}

/// What a description says of contacts with other deformables.
struct SurfaceDesc {
  Real thickness = Real(0);
  bool self_contact = false;
  const FilterDesc& filter;
};

/// Says how an object touches others and itself. `points` at rest and `triangles` are its surface. No
/// surface keeps more than half of its mean edge from another, nor half of its shortest one from itself.
/// Returns an Error of the field `where` if it touches itself and is thicker than half of its mean edge.
Result<state::Surface> surface_for_contact(const SurfaceDesc& desc, const Points& points,
                                           const std::vector<std::array<std::uint32_t, 3>>& triangles,
                                           const char* where);

}  // namespace hooke::build
