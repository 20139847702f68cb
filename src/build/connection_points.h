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

/// Checks names, and checks numbers against the count of points; the count is 0 for a body, which has none.
void check_connection_points(Checks& checks, const std::vector<ConnectionPointDesc>& given,
                             std::size_t count);

/// The places that the maker of a body names; null where there are none. `center` is the center of mass [m].
[[nodiscard]] std::shared_ptr<const state::NamedPlaces> connection_points_of(
    const std::vector<ConnectionPointDesc>& given, Vec3 center);

/// The frame that the places of an object are given in.
struct ConnectionPointFrame {
  DVec3 position = {};  ///< Position of the frame [m].
  Quat rotation = {};
};

/// Gives the last object the places that its maker names and, under other names, those of its kind.
void append_connection_points(const std::vector<ConnectionPointDesc>& given,
                              const ConnectionPointFrame& frame, const state::NamedPlaces& of_its_kind,
                              state::Tables& tables);

/// Names one point of a deformable.
[[nodiscard]] state::NamedPlace named_point(const char* name, std::uint32_t point);
/// Corners, edges and center of a grid of columns and rows.
[[nodiscard]] state::NamedPlaces connection_points_of_grid(std::uint32_t columns, std::uint32_t rows);
/// Corners, faces and center of a box of cells: its corners first, then the centers of its cells.
[[nodiscard]] state::NamedPlaces connection_points_of_box(std::array<std::int32_t, 3> cells);

/// All places of a body: its own, then those of its kind.
[[nodiscard]] state::NamedPlaces connection_points_of_body(std::uint32_t body, const state::Tables& tables);

/// Finds the place of this name; the error at `where` lists the names that exist.
[[nodiscard]] Result<state::NamedPlace> find_connection_point(const state::NamedPlaces& places,
                                                              const std::string& name, const char* where);

}  // namespace hooke::build
