#pragma once

#include "hooke/desc.h"
#include "hooke/result.h"

#include "build/checks.h"
#include "state/tables.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace hooke::build {

/// Checks the names, and the point numbers against `count`, which is 0 for a body because it has no points.
void check_connection_points(Checks& checks, const std::vector<ConnectionPointDesc>& given,
                             std::size_t count);

/// Returns the connection points that the maker of a body names; null if there are none. `center` is the
/// center of mass in the body's frame [m].
[[nodiscard]] std::shared_ptr<const state::NamedPlaces> connection_points_of(
    const std::vector<ConnectionPointDesc>& given, Vec3 center);

/// The frame in which an object's connection points are given.
struct ConnectionPointFrame {
  DVec3 position = {};  ///< Origin of the frame in the world [m].
  Quat rotation = {};
};

/// Sets the connection points of the last object: those that its maker names, then those of its kind whose
/// names are not taken.
void append_connection_points(const std::vector<ConnectionPointDesc>& given,
                              const ConnectionPointFrame& frame, const state::NamedPlaces& of_its_kind,
                              state::Tables& tables);

/// Makes a connection point at one point of a deformable.
[[nodiscard]] state::NamedPlace named_point(const char* name, std::uint32_t point);
/// Returns corners, edges and center of a grid of columns and rows.
[[nodiscard]] state::NamedPlaces connection_points_of_grid(std::uint32_t columns, std::uint32_t rows);
/// Returns faces, corners and center of a box of cells. The points of the box are the corners of its cells, x
/// fastest, then the centers of its cells.
[[nodiscard]] state::NamedPlaces connection_points_of_box(std::array<std::int32_t, 3> cells);

/// Returns all connection points of a body: those that its maker named, then those of its kind.
[[nodiscard]] state::NamedPlaces connection_points_of_body(std::uint32_t body, const state::Tables& tables);

/// Finds the connection point with this name. The Error at `where` lists the names that exist.
[[nodiscard]] Result<state::NamedPlace> find_connection_point(const state::NamedPlaces& places,
                                                              const std::string& name, const char* where);

}  // namespace hooke::build
