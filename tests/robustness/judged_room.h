#pragma once

#include "world/hulls.h"
#include "world/surface_room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <variant>
#include <vector>

/// \file
/// A room for the hard cases of deformables: bodies are judged, too, and so is each tetrahedron.

namespace hooke::test {

/// A box of cells with six tetrahedra each, cut along one diagonal, that are all the same way round.
struct Tetrahedra {
  std::vector<Vec3> points = {};
  std::vector<std::array<std::uint32_t, 4>> cells = {};
};

inline Tetrahedra box_of_tetrahedra(std::array<int, 3> cells, Vec3 size) {
  Tetrahedra box;
  const auto at = [&](int x, int y, int z) {
    return static_cast<std::uint32_t>((x * (cells[1] + 1) + y) * (cells[2] + 1) + z);
  };
  const auto place = [](int i, int n, Real length) {
    return length * (static_cast<Real>(i) / static_cast<Real>(n) - Real(0.5));
  };
  for (int x = 0; x <= cells[0]; ++x)
    for (int y = 0; y <= cells[1]; ++y)
      for (int z = 0; z <= cells[2]; ++z)
        box.points.push_back(
            {place(x, cells[0], size.x), place(y, cells[1], size.y), place(z, cells[2], size.z)});
  // From the one end of the diagonal to the other, along the three axes in any order (Kuhn 1960).
  constexpr std::array<std::array<int, 3>, 6> kOrders = {
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  for (int i = 0; i < cells[0] * cells[1] * cells[2]; ++i) {
    const std::array from = {i / (cells[1] * cells[2]), i / cells[2] % cells[1], i % cells[2]};
    for (std::size_t k = 0; k < kOrders.size(); ++k) {
      std::array<int, 3> p = from;
      std::array<std::uint32_t, 4> t = {at(p[0], p[1], p[2])};
      for (std::size_t n = 0; n < 3; ++n) {
        ++p[static_cast<std::size_t>(kOrders[k][n])];
        t[n + 1] = at(p[0], p[1], p[2]);
      }
      if (k >= 3) std::swap(t[2], t[3]);
      box.cells.push_back(t);
    }
  }
  return box;
}

/// A ball of tetrahedra: a cube whose layers are drawn to spheres.
inline Tetrahedra ball_of_tetrahedra(int cells, Real radius) {
  Tetrahedra ball = box_of_tetrahedra({cells, cells, cells}, {Real(2), Real(2), Real(2)});
  for (Vec3& p : ball.points) {
    const Real layer = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    if (layer > 0) p = (radius * layer / length(p)) * p;
  }
  return ball;
}

inline SolidDesc solid_of(const Tetrahedra& shape, DVec3 at) {
  SolidDesc desc;
  desc.points = shape.points;
  desc.tetrahedra = shape.cells;
  desc.position = at;
  return desc;
}

/// A room whose bodies have hulls, and whose solids may have been added with their tetrahedra.
struct JudgedRoom : Room {
  struct Body {
    BodyId id = {};
    Hull hull = {};
  };
  struct Cells {
    SolidId id = {};
    std::vector<std::array<std::uint32_t, 4>> tetrahedra = {};
    std::vector<double> volumes = {};  ///< At rest [m^3].
  };
  std::vector<Body> bodies = {};
  std::vector<Cells> cells = {};

  BodyId add_body(const BodyDesc& desc, Hull hull) {
    const auto added = world.add_body(desc);
    REQUIRE_MESSAGE(added, (added ? "" : added.error().message));
    bodies.push_back({added.value(), std::move(hull)});
    return added.value();
  }
  BodyId add_box(BodyDesc desc, Vec3 half) {
    desc.shape = Shape::box(half);
    return add_body(desc, hull_of_box(half));
  }
  /// Adds a body with the triangles of a mesh or, of a convex one, with its hull.
  BodyId add_mesh(BodyDesc desc, const MeshDesc& mesh, ShapeKind kind = ShapeKind::kMesh) {
    const auto added = world.add_mesh(mesh);
    REQUIRE_MESSAGE(added, (added ? "" : added.error().message));
    desc.shape = {.kind = kind, .mesh = added.value()};
    return add_body(desc, hull_of_mesh(mesh));
  }
  /// Adds a solid each of whose tetrahedra is to keep its sign.
  SolidId add_cells(const SolidDesc& desc) {
    const SolidId id = add(desc);
    REQUIRE(world.positions(id).size() == desc.points.size());
    Cells of = {.id = id, .tetrahedra = desc.tetrahedra};
    for (const auto& t : of.tetrahedra) of.volumes.push_back(volume_of(id, t));
    cells.push_back(std::move(of));
    return id;
  }

  [[nodiscard]] double volume_of(SolidId id, const std::array<std::uint32_t, 4>& t) const {
    const PointView x = world.positions(id);
    return dot(x[t[1]] - x[t[0]], cross(x[t[2]] - x[t[0]], x[t[3]] - x[t[0]])) / 6;
  }
  /// Least volume of a tetrahedron over that at rest; negative if one is inside out.
  [[nodiscard]] double least_volume() const {
    double least = std::numeric_limits<double>::infinity();
    for (const Cells& of : cells) {
      for (std::size_t i = 0; i < of.volumes.size(); ++i)
        least = std::min(least, volume_of(of.id, of.tetrahedra[i]) / of.volumes[i]);
    }
    return least;
  }
  /// Pairs of an edge and a triangle that cross now; those of two bodies do not count.
  [[nodiscard]] std::size_t crossing() const {
    Surfaces all = surfaces_of(*this);
    Surfaces hulls;
    for (const Body& body : bodies) {
      append(world.pose(body.id), body.hull, all);
      append(world.pose(body.id), body.hull, hulls);
    }
    return count_crossings(all).crossing - count_crossings(hulls).crossing;
  }
};

/// The worst of some steps.
struct Verdict {
  std::size_t crossing = 0;       ///< Most crossing pairs after a step.
  double least_volume = 1e9;      ///< Least volume of a tetrahedron over that at rest.
  double most_energy = -1e300;    ///< [J]
  double overlap = 0;             ///< Deepest of a point in a body [m].
  std::uint32_t held_back = 0;    ///< StepReport::points_held_back, summed.
  std::uint32_t touching = 0;     ///< StepReport::surfaces_touching, summed.
  std::uint32_t unconverged = 0;  ///< Solids that were not solved to the end.
};

/// Steps and judges after every `every`th step.
inline Verdict judge(JudgedRoom& room, int steps, Real dt, int every = 1) {
  Verdict verdict;
  for (int i = 1; i <= steps; ++i) {
    const StepReport report = room.world.step(dt);
    CHECK(report.healthy());
    verdict.held_back += report.points_held_back;
    verdict.unconverged += report.solids_unconverged;
    verdict.touching += report.surfaces_touching;
    if (i % every != 0) continue;
    verdict.crossing = std::max(verdict.crossing, room.crossing());
    verdict.least_volume = std::min(verdict.least_volume, room.least_volume());
    const Measurement measured = room.world.measure();
    verdict.most_energy = std::max(verdict.most_energy, measured.energy.total());
    verdict.overlap = std::max(verdict.overlap, measured.largest_penetration);
  }
  return verdict;
}

/// Largest speed of a point of a deformable [m/s].
template <class Id>
double fastest_of(const World& world, Id id) {
  const PointView v = world.velocities(id);
  double fastest = 0;
  for (std::size_t i = 0; i < v.size(); ++i) fastest = std::max(fastest, length(v[i]));
  return fastest;
}

}  // namespace hooke::test
