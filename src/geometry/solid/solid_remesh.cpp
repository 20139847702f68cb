#include "hooke/geometry.h"

#include "base/float_environment.h"
#include "geometry/closest.h"
#include "geometry/mesh/winding_number.h"
#include "geometry/solid/surface_nets.h"
#include "geometry/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

/// \file
/// Makes a closed surface around any triangles. A node of a grid is inside where the surface winds about it
/// more than half a time, which closes holes as a soap film does, or where it is near a part of the surface
/// that is too thin for the grid. The surface net of the nodes is the new surface.

namespace hooke {

namespace {

using geometry::Box3;
using geometry::NodeGrid;
using geometry::Triangle;

constexpr double kNodesMax = 1 << 24;
constexpr int kMargin = 3;           // Nodes around the mesh that remain outside.
constexpr double kBand = 1.5;        // Distances beyond so many voxels are not measured.
constexpr double kInside = 0.51;     // Least winding number inside: both sides of a lone sheet have a half.
constexpr double kThinReach = 0.87;  // Half the diagonal of a voxel: no sheet so thick slips between nodes.
constexpr double kFilled = 0.25;     // Depth of nodes that are filled for their neighbors' sake [voxels].
constexpr double kEnclosed = 1;      // Surface that lies deeper than so many voxels is an inner one.
constexpr int kSamplesMax = 256;     // Samples along the side of a triangle.

using DCorners = std::array<DVec3, 3>;

DCorners corners_of(const MeshDesc& mesh, const Triangle& t) {
  return {vector_cast<double>(mesh.positions[t[0]]), vector_cast<double>(mesh.positions[t[1]]),
          vector_cast<double>(mesh.positions[t[2]])};
}

/// Calls `take` with points of the triangle that are at most `spacing` apart along its sides.
template <class Take>
void sample(const DCorners& t, double spacing, const Take& take) {
  const double longest = std::max({length(t[1] - t[0]), length(t[2] - t[1]), length(t[0] - t[2])});
  const int parts = static_cast<int>(std::clamp(std::ceil(longest / spacing), 1.0, 1.0 * kSamplesMax));
  for (int i = 0; i < parts; ++i) {
    for (int k = 0; k < parts - i; ++k) {
      const double u = (i + 1.0 / 3) / parts;
      const double v = (k + 1.0 / 3) / parts;
      take(t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]));
    }
  }
}

/// The field of which the new surface is the zero.
class RemeshField {
 public:
  RemeshField(const MeshDesc& mesh, double voxel)
      : mesh_(mesh), tree_(geometry::build_winding_tree(mesh.positions, mesh.triangles)), voxel_(voxel) {}

  /// Lays the grid; returns false if it would have too many nodes.
  bool lay_grid() {
    for (const Triangle& t : mesh_.triangles) {
      const auto [a, b, c] = corners_of(mesh_, t);
      box_ = merge(box_, geometry::box_of(a, b, c));
    }
    const DVec3 size = box_.upper - box_.lower;
    double count = 1;
    const double along[3] = {size.x, size.y, size.z};
    for (std::size_t k = 0; k < 3; ++k) {
      const double nodes = std::ceil(along[k] / voxel_) + 1 + 2 * kMargin;
      count *= nodes;
      if (!(count <= kNodesMax)) return false;
      grid_.counts[k] = static_cast<int>(nodes);
    }
    const DVec3 room = voxel_ * DVec3{grid_.counts[0] - 1.0, grid_.counts[1] - 1.0, grid_.counts[2] - 1.0};
    grid_.corner = box_.lower - 0.5 * (room - size);
    grid_.spacing = voxel_;
    grid_.value.resize(static_cast<std::size_t>(count));
    return true;
  }

  NodeGrid& measure() {
    for (int z = 0; z < grid_.counts[2]; ++z) {
      for (int y = 0; y < grid_.counts[1]; ++y) {
        for (int x = 0; x < grid_.counts[0]; ++x)
          grid_.value[grid_.index(x, y, z)] = value_at(grid_.place(x, y, z));
      }
    }
    wound_.reserve(grid_.value.size());
    for (const double value : grid_.value) wound_.push_back(value < 0 ? 1 : 0);
    for (const Triangle& t : mesh_.triangles) thicken(corners_of(mesh_, t));
    return grid_;
  }

 private:
  /// Distance from the surface, negative inside; far from the surface what the winding number lacks.
  [[nodiscard]] double value_at(DVec3 p) const {
    // Beside a mouth that is wound about twice, as of half a model with walls inside and outside, the number
    // is large beyond the box, too; the surface must end there.
    const bool is_beyond = geometry::distance_squared(box_, p) > 0;
    const double lack = is_beyond ? kInside : kInside - std::abs(geometry::winding_number(tree_, p));
    const auto closest =
        geometry::find_closest(tree_.bvh, vector_cast<Real>(p), static_cast<Real>(kBand * voxel_));
    if (!closest) return std::clamp(2 * lack, -1.0, 1.0) * kBand * voxel_;
    // A node on the surface is no end of a crossing, so it keeps a little distance.
    const double distance = std::max(length(vector_cast<double>(closest->point) - p), 1e-3 * voxel_);
    return lack > 0 ? distance : -distance;
  }

  /// Whether the node nearest to the point is inside by the winding number. It costs nothing, where the
  /// number itself at each sample took nine tenths of the time.
  [[nodiscard]] bool is_near_inside(DVec3 p) const {
    const DVec3 at = 1 / voxel_ * (p - grid_.corner);
    const auto nearest = [](double x) { return static_cast<int>(std::floor(x + 0.5)); };
    return wound_[grid_.index(nearest(at.x), nearest(at.y), nearest(at.z))] != 0;
  }

  [[nodiscard]] bool has_inside(DVec3 p, DVec3 step) const {
    return is_near_inside(p + step) || is_near_inside(p + 0.5 * step);
  }

  /// Gives thickness to those parts of a triangle that have no inside within a voxel of either of its sides.
  void thicken(const DCorners& t) {
    const DVec3 across = cross(t[1] - t[0], t[2] - t[0]);
    const double twice_area = length(across);
    if (!(twice_area > 0)) return;
    const DVec3 step = voxel_ / twice_area * across;
    sample(t, voxel_, [&](DVec3 p) {
      if (!has_inside(p, -step) && !has_inside(p, step)) stamp(t, p);
    });
  }

  /// Lowers the values of the nodes near a sample to their distance from the thickened triangle.
  void stamp(const DCorners& t, DVec3 p) {
    const DVec3 place = 1 / voxel_ * (p - grid_.corner);
    const auto first = [](double at) { return static_cast<int>(std::floor(at)) - 1; };
    for (int z = first(place.z); z < first(place.z) + 4; ++z) {
      for (int y = first(place.y); y < first(place.y) + 4; ++y) {
        for (int x = first(place.x); x < first(place.x) + 4; ++x) {
          const DVec3 node = grid_.place(x, y, z);
          const auto closest = geometry::closest_on_triangle(node, t[0], t[1], t[2]);
          double& value = grid_.value[grid_.index(x, y, z)];
          value = std::min(value, length(closest.point - node) - kThinReach * voxel_);
        }
      }
    }
  }

  const MeshDesc& mesh_;
  geometry::WindingTree tree_;
  double voxel_;
  Box3<double> box_ = {};
  std::vector<std::uint8_t> wound_;  // For each node, whether it is inside by the winding number alone.
  NodeGrid grid_;
};

/// Makes what cannot be reached from the border of the grid a part of the inside.
void fill_cavities(NodeGrid& grid, double value_inside) {
  std::vector<std::uint8_t> is_reached(grid.value.size(), 0);
  std::vector<std::size_t> waiting = {0};
  is_reached[0] = 1;
  const std::size_t row = grid.counts[0];
  const std::size_t layer = row * grid.counts[1];
  while (!waiting.empty()) {
    const std::size_t node = waiting.back();
    waiting.pop_back();
    const std::size_t at[3] = {node % row, node / row % grid.counts[1], node / layer};
    const std::size_t steps[3] = {1, row, layer};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto visit = [&](std::size_t next) {
        if (is_reached[next] != 0 || grid.value[next] < 0) return;
        is_reached[next] = 1;
        waiting.push_back(next);
      };
      if (at[axis] > 0) visit(node - steps[axis]);
      if (at[axis] + 1 < static_cast<std::size_t>(grid.counts[axis])) visit(node + steps[axis]);
    }
  }
  for (std::size_t i = 0; i < is_reached.size(); ++i) {
    if (is_reached[i] == 0 && !(grid.value[i] < 0)) grid.value[i] = value_inside;
  }
}

/// Measures how far the given surface lies from the new one, and the new one from the given.
void measure_change(const MeshDesc& given, double voxel, SolidRemesh& remesh) {
  const geometry::WindingTree made =
      geometry::build_winding_tree(remesh.mesh.positions, remesh.mesh.triangles);
  double sum = 0;
  double area = 0;
  double largest = 0;
  for (const Triangle& t : given.triangles) {
    const DCorners corners = corners_of(given, t);
    double samples = 0;
    double distances = 0;
    sample(corners, 2 * voxel, [&](DVec3 p) {
      const auto closest = geometry::find_closest(made.bvh, vector_cast<Real>(p));
      const double distance = std::sqrt(static_cast<double>(closest->distance_squared));
      if (distance > kEnclosed * voxel && geometry::winding_number(made, p) > kInside) return;
      largest = std::max(largest, distance);
      distances += distance;
      ++samples;
    });
    if (!(samples > 0)) continue;
    const double weight = length(cross(corners[1] - corners[0], corners[2] - corners[0]));
    sum += weight * distances / samples;
    area += weight;
  }
  remesh.moved_max = static_cast<Real>(largest);
  remesh.moved_mean = area > 0 ? static_cast<Real>(sum / area) : Real(0);
  const geometry::Bvh bvh = geometry::build_bvh(given.positions, given.triangles);
  for (const Vec3 p : remesh.mesh.positions) {
    const auto closest = geometry::find_closest(bvh, p);
    remesh.bridged = std::max(remesh.bridged, std::sqrt(closest->distance_squared));
  }
}

Error voxel_error(const char* message) {
  return {ErrorCode::kOutOfRange, "voxel", message};
}

}  // namespace

Result<SolidRemesh> remesh_solid(const MeshDesc& mesh, Real voxel) {
  const base::FloatEnvironment environment;
  if (const Result<void> usable = geometry::validate_mesh(mesh); !usable) return usable.error();
  if (!(voxel > Real(0)) || !std::isfinite(voxel)) return voxel_error("must be positive and finite");
  const auto size = static_cast<double>(voxel);
  RemeshField field(mesh, size);
  if (!field.lay_grid()) return voxel_error("is too small: the grid would have more than 16777216 nodes");
  NodeGrid& grid = field.measure();
  const geometry::MeshTopology topology = geometry::compute_topology(mesh.positions.size(), mesh.triangles);
  if (!topology.is_closed()) fill_cavities(grid, -kFilled * size);
  geometry::make_well_composed(grid, -kFilled * size);
  SolidRemesh remesh = {.mesh = geometry::make_surface_net(grid), .voxel = voxel};
  if (remesh.mesh.triangles.empty()) return voxel_error("is too large: no node lies inside the mesh");
  measure_change(mesh, size, remesh);
  return remesh;
}

Real default_voxel(const MeshDesc& mesh) {
  geometry::Box box;
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t corner : t) {
      if (corner >= mesh.positions.size()) continue;
      box = merge(box, mesh.positions[corner]);
    }
  }
  const Vec3 size = box.upper - box.lower;
  constexpr Real kVoxelsAlong = Real(64);
  return std::max({size.x, size.y, size.z}) / kVoxelsAlong;
}

}  // namespace hooke
