#pragma once

#include "hooke/geometry.h"
#include "hooke/math.h"
#include "hooke/shape.h"

#include <array>
#include <cstdint>
#include <vector>

/// \file
/// Convex polyhedra in double, which planes cut.

namespace hooke::geometry {

/// A convex polyhedron. Neighboring faces name the same two points along their edge, so that it is closed
/// whatever rounding does.
struct ConvexCell {
  /// Marks a face that no cut has made.
  static constexpr std::uint32_t kUncut = 0xFFFFFFFF;

  struct Face {
    std::uint32_t first = 0;  ///< Its corners are loop[first, first + count), counter-clockwise from outside.
    std::uint32_t count = 0;
    std::uint32_t cut = kUncut;  ///< Number of the cut that made it.
  };

  std::vector<DVec3> points = {};
  std::vector<Face> faces = {};
  std::vector<std::uint32_t> loop = {};
};

/// Memory of cut_cell.
struct CellCutScratch {
  std::vector<double> height = {};
  std::vector<std::uint32_t> renamed = {};
  /// An edge that the plane crosses, the smaller point first, and the point where it does.
  struct Crossing {
    std::array<std::uint32_t, 2> edge = {};
    std::uint32_t point = 0;
  };
  std::vector<Crossing> crossings = {};
  std::vector<std::array<std::uint32_t, 2>> rim = {};  ///< Edges of what is left that lie in the plane.
  std::vector<std::uint32_t> corners = {};
  ConvexCell result = {};
};

/// The polyhedron that the triangles of a closed mesh enclose, about `origin`.
[[nodiscard]] ConvexCell cell_of(const MeshDesc& mesh, DVec3 origin);

/// Cuts away what is above the plane; the cell is empty if that is all. The new face has the number `cut`.
/// Points within `on_plane` [m] of the plane count as on it. Returns whether anything was cut.
bool cut_cell(const Plane& plane, double on_plane, std::uint32_t cut, CellCutScratch& scratch,
              ConvexCell& cell);

/// Appends the triangles of a face, as corners among the cell's points.
void append_triangles(const ConvexCell& cell, const ConvexCell::Face& face,
                      std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace hooke::geometry
