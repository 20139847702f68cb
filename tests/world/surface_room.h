#pragma once

#include "hooke/hooke.h"

#include "validation/crossings.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <doctest/doctest.h>
#include <string>
#include <variant>
#include <vector>

/// \file
/// A world for tests of contacts between deformables. Each frame is judged by the checker of crossings.h.

namespace hooke {

inline constexpr Real kFrame = Real(1) / Real(60);  // [s]
inline constexpr Real kEdge = Real(0.02);           // [m]

using Surface = std::variant<ClothId, SolidId, RopeId>;

/// A world and the surfaces that were added to it.
struct Room {
  World world = World::create({.substeps = 8, .workers = 1}).value();
  std::vector<Surface> surfaces = {};

  ClothId add(const ClothDesc& desc) {
    const auto added = world.add_cloth(desc);
    REQUIRE_MESSAGE(added, (added ? "" : added.error().message));
    surfaces.push_back(added.value());
    return added.value();
  }
  SolidId add(const SolidDesc& desc) {
    const auto added = world.add_solid(desc);
    REQUIRE_MESSAGE(added, (added ? "" : added.error().message));
    surfaces.push_back(added.value());
    return added.value();
  }
  RopeId add(const RopeDesc& desc) {
    const auto added = world.add_rope(desc);
    REQUIRE_MESSAGE(added, (added ? "" : added.error().message));
    surfaces.push_back(added.value());
    return added.value();
  }
  void add_ground() {
    REQUIRE(world.add_body({.kind = BodyKind::kStatic, .shape = {.kind = ShapeKind::kHalfSpace}}));
  }
  void add_ball(DVec3 at, Real radius) {
    REQUIRE(world.add_body({.kind = BodyKind::kStatic,
                            .shape = {.kind = ShapeKind::kSphere, .radius = radius},
                            .position = at}));
  }
};

inline Surfaces surfaces_of(const Room& room) {
  Surfaces all;
  for (const Surface& surface : room.surfaces) {
    const auto first = static_cast<std::uint32_t>(all.points.size());
    const auto take = [&](const auto& points, const auto& triangles) {
      for (std::size_t i = 0; i < points.size(); ++i) all.points.push_back(points[i]);
      for (const auto& [a, b, c] : triangles) all.triangles.push_back({first + a, first + b, first + c});
    };
    if (const auto* cloth = std::get_if<ClothId>(&surface)) {
      take(room.world.positions(*cloth), room.world.triangles(*cloth));
    } else if (const auto* rope = std::get_if<RopeId>(&surface)) {
      const PointView points = room.world.positions(*rope);
      for (std::uint32_t i = 0; i < points.size(); ++i) {
        all.points.push_back(points[i]);
        if (i > 0) all.lines.push_back({first + i - 1, first + i});
      }
    } else {
      const SolidId solid = std::get<SolidId>(surface);
      take(room.world.surface(solid), room.world.triangles(solid));
    }
    all.owners.resize(all.points.size(), first);
  }
  return all;
}

/// What a run of some frames came to.
struct Run {
  std::size_t crossing = 0;  ///< Most crossing pairs in a frame.
  std::uint32_t held_back = 0;
  std::uint32_t touching = 0;
  std::uint32_t unconverged = 0;  ///< Solids that were not solved to the end.
};

/// Steps and checks every frame.
inline Run run(Room& room, int frames) {
  Run result;
  for (int i = 0; i < frames; ++i) {
    const StepReport report = room.world.step(kFrame);
    CHECK(report.healthy());
    result.held_back += report.points_held_back;
    result.touching += report.surfaces_touching;
    result.unconverged += report.solids_unconverged;
    result.crossing = std::max(result.crossing, count_crossings(surfaces_of(room)).crossing);
  }
  return result;
}

/// A level sheet of n x n points, its middle at `at`.
inline ClothDesc sheet(int n, DVec3 at) {
  ClothDesc desc;
  desc.columns = desc.rows = n;
  desc.width = desc.height = kEdge * static_cast<Real>(n - 1);
  desc.corner = at - 0.5 * DVec3{static_cast<double>(desc.width), 0, static_cast<double>(desc.height)};
  desc.row_direction = {Real(0), Real(0), Real(1)};
  desc.thickness = Real(0.25) * kEdge;
  desc.bend_stiffness = Real(1e-5);
  desc.drag_coefficient = desc.lift_coefficient = Real(0);
  desc.self_contact = true;
  return desc;
}

/// A cube of jelly with `cells` cells along each edge.
inline SolidDesc soft_cube(DVec3 at, Real size, int cells) {
  SolidDesc desc;
  desc.size = {size, size, size};
  desc.cells = {cells, cells, cells};
  desc.position = at;
  return desc;
}

/// A pinned sheet of 1.2 by 0.3 m, whose columns go along `down`.
inline ClothDesc ramp(DVec3 down, Real friction) {
  ClothDesc desc = sheet(2, {});
  desc.columns = 60;
  desc.rows = 16;
  desc.width = Real(59) * kEdge;
  desc.height = Real(15) * kEdge;
  desc.column_direction = vector_cast<Real>(down);
  desc.corner = DVec3{0, 0, -0.15};
  for (std::uint32_t i = 0; i < 60 * 16; ++i) desc.pins.push_back({.point = i});
  desc.contact.friction = friction;
  desc.self_contact = false;
  return desc;
}

inline DVec3 mean_of(const PointView& points) {
  DVec3 sum;
  for (std::size_t i = 0; i < points.size(); ++i) sum += points[i];
  return (1.0 / static_cast<double>(points.size())) * sum;
}

inline double rms_of(const PointView& velocities) {
  double sum = 0;
  for (std::size_t i = 0; i < velocities.size(); ++i) sum += dot(velocities[i], velocities[i]);
  return std::sqrt(sum / static_cast<double>(velocities.size()));
}

}  // namespace hooke
