#pragma once

#include "hooke/math.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

/// \file
/// An independent check of whether surfaces cross: every edge against every triangle, with exact signs, and
/// of whether lines passed each other. It shares no code with the engine, so that both cannot have the same
/// fault.

namespace hooke {

/// Triangles and lines of several objects, between points in the world.
struct Surfaces {
  std::vector<DVec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<std::uint32_t, 2>> lines;  ///< Edges that belong to no triangle, as those of ropes.
  std::vector<std::uint32_t> owners;  ///< By point: its object, for count_passes; empty: all are different.
};

struct Crossings {
  std::size_t crossing = 0;  ///< Pairs of an edge and a triangle without common point that cross.
  std::size_t touching = 0;  ///< Pairs where an end of the edge lies exactly on the triangle's plane, inside.
  std::size_t coplanar = 0;  ///< Pairs of which both ends lie exactly in the triangle's plane: no crossing.
};

/// Sign of the volume of the tetrahedron (a, b, c, d): -1, 0 or 1, exact for any finite coordinates whose
/// products neither overflow nor underflow.
[[nodiscard]] int exact_orientation(DVec3 a, DVec3 b, DVec3 c, DVec3 d);

/// Counts the crossing pairs of all edges and all triangles.
[[nodiscard]] Crossings count_crossings(const Surfaces& surfaces);

/// Counts the pairs of a line and a line, or of a line and an edge of a triangle, without a common point,
/// that meet while all points go from where they are in `before` to where they are in `after`, straight and
/// evenly. Lines that come within 1e-8 m of each other count, too; those of one object do not.
[[nodiscard]] std::size_t count_passes(const Surfaces& before, const Surfaces& after);

}  // namespace hooke
