#pragma once

#include "hooke/math.h"
#include "hooke/model_io.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// What turns a soup of triangles into a model: welding, which side is outside, normals, drawn vertices.
/// Pure functions; the same input gives the same output everywhere.
/// Read in this order: triangulate, weld, is_degenerate, find_turned, crease_normals, assemble_model.

namespace hooke::io {

using Triangle = std::array<std::uint32_t, 3>;

struct Weld {
  std::vector<std::uint32_t> welded_of;  ///< For each point, its welded point.
  std::vector<std::uint32_t> first;      ///< For each welded point, the first point that made it.
};

/// Points closer than this are one: 1e-6 of the bounding box's diagonal. 0 for no points.
[[nodiscard]] double weld_distance(std::span<const DVec3> points);

/// Unites each point with the earliest welded point within `distance` per axis, or makes it a new one.
[[nodiscard]] Weld weld(std::span<const DVec3> points, double distance);

/// Whether two corners coincide or the height over the longest side is at most `distance`: such a triangle
/// has no direction.
[[nodiscard]] bool is_degenerate(std::span<const DVec3> points, const Triangle& triangle, double distance);

/// Triangles between the corners of a polygon, which may be concave, a little warped, have corners in the
/// middle of a straight side, and holes cut in by pairs of corners at one place. Sides that cross give some
/// triangles, too. Takes up to the cube of the corners in time: bound them.
[[nodiscard]] std::vector<Triangle> triangulate(std::span<const DVec3> corners);

/// Which triangles must be turned over to face outward, a flag for each. A surface without border is made
/// consistent and gets a positive volume; one inside another such surface turns with the outermost around it,
/// so that a cavity stays a cavity. A surface with a border stays as it is.
[[nodiscard]] std::vector<std::uint8_t> find_turned(std::span<const DVec3> points,
                                                    std::span<const Triangle> triangles);

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
