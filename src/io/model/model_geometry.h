#pragma once

#include "hooke/math.h"
#include "hooke/model_io.h"

#include "geometry/mesh/mesh_clean.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Turns loose triangles into a model: polygons, normals, drawn vertices. Welding, and which side is outside,
/// are in geometry/mesh/mesh_clean.h. These are pure functions; the same input gives the same output
/// everywhere. Read in this order: triangulate, crease_normals, assemble_model.

namespace hooke::io {

using geometry::Triangle;

/// Returns triangles between the corners of a polygon. It may be concave, a little warped, have corners in
/// the middle of a straight side, and holes cut in by pairs of corners at one place. Sides that cross give
/// some triangles, too. It takes up to the cube of the number of corners in time; callers must bound that
/// number.
[[nodiscard]] std::vector<Triangle> triangulate(std::span<const DVec3> corners);

/// Returns a unit normal for each corner. It is the mean, weighted by the angle at the corner, of those faces
/// around the point that are within `crease` [rad] of the corner's own. Triangles must not be degenerate.
[[nodiscard]] std::vector<DVec3> crease_normals(std::span<const DVec3> points,
                                                std::span<const Triangle> triangles, double crease);

/// A Soup is the triangles as a file gives them, in Hooke's frame.
struct Soup {
  std::vector<DVec3> positions;           ///< [m]
  std::vector<DVec3> normals;             ///< One for each position; zero where the file has none.
  std::vector<std::array<float, 2>> uvs;  ///< One for each position.
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> material_of;  ///< One for each triangle.
  std::vector<ModelMaterial> materials;
};

/// Makes the drawn model. Degenerate triangles are dropped and faces are turned outward. Normals are kept
/// where they agree with the faces, and made with `crease` [rad] where not. Each used material gives one
/// part, in the order of the soup's materials. No triangles give no parts, but still a material.
[[nodiscard]] Model assemble_model(const Soup& soup, double crease);

/// Fills `mesh` and `welded_of` from the drawn half.
void weld_model(Model& model);

}  // namespace hooke::io
