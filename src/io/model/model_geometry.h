#pragma once

#include "hooke/math.h"
#include "hooke/model_io.h"

#include "geometry/mesh/mesh_clean.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// What turns a soup of triangles into a model: polygons, normals, drawn vertices. Welding, and which side is
/// outside: geometry/mesh/mesh_clean.h.
/// Pure functions; the same input gives the same output everywhere.
/// Read in this order: triangulate, crease_normals, assemble_model.

namespace hooke::io {

using geometry::Triangle;

/// Triangles between the corners of a polygon, which may be concave, a little warped, have corners in the
/// middle of a straight side, and holes cut in by pairs of corners at one place. Sides that cross give some
/// triangles, too. Takes up to the cube of the corners in time: bound them.
[[nodiscard]] std::vector<Triangle> triangulate(std::span<const DVec3> corners);

/// A unit normal for each corner: the mean, weighted by the angle at the corner, of the faces around the
/// point that turn at most `crease` [rad] from the corner's own. Triangles must not be degenerate.
[[nodiscard]] std::vector<DVec3> crease_normals(std::span<const DVec3> points,
                                                std::span<const Triangle> triangles, double crease);

/// Triangles as a file gives them, in Hooke's frame.
struct Soup {
  std::vector<DVec3> positions;           ///< [m]
  std::vector<DVec3> normals;             ///< One for each position; zero where the file has none.
  std::vector<std::array<float, 2>> uvs;  ///< One for each position.
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> material_of;  ///< For each triangle.
  std::vector<ModelMaterial> materials;
};

/// The drawn model: degenerate triangles dropped, outward faces, normals kept where they agree with the faces
/// and made with `crease` [rad] where not, one part for each material used, in the order of
/// the soup's. No triangles gives no parts and a material all the same.
[[nodiscard]] Model assemble_model(const Soup& soup, double crease);

/// Fills `mesh` and `welded_of` from the drawn half.
void weld_model(Model& model);

}  // namespace hooke::io
