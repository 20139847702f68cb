#include "geometry/fracture/fracture_seeds.h"

#include "base/disjoint_sets.h"
#include "base/splitmix.h"
#include "geometry/box.h"
#include "geometry/triangle_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

namespace hooke::geometry {

namespace {

constexpr double kConvexTolerance = 1e-6;  ///< In diagonals of the box around the solid.
constexpr double kLeastVolume = 1e-12;     ///< In cubes of that diagonal.
constexpr std::size_t kConvexTests = 100'000'000;
constexpr std::size_t kFewestTestedPlanes = 256;

/// Numbers uniform in [0, 1), the same on every machine: splitmix64 (Steele et al. 2014).
class SeedNumbers {
 public:
  explicit SeedNumbers(std::uint32_t seed) : state_(seed) { next(); }

  double uniform() { return base::unit_number(next()); }

 private:
  std::uint64_t next() {
    state_ += base::kSplitmixStep;
    return base::splitmix(state_);
  }

  std::uint64_t state_;
};

std::array<DVec3, 3> corners_of(const MeshDesc& mesh, const Triangle& t) {
  return {vector_cast<double>(mesh.positions[t[0]]), vector_cast<double>(mesh.positions[t[1]]),
          vector_cast<double>(mesh.positions[t[2]])};
}

Box3<double> bounds_of(const MeshDesc& mesh) {
  Box3<double> box;
  for (const auto& t : mesh.triangles) {
    const auto [a, b, c] = corners_of(mesh, t);
    box = merge(box, box_of(a, b, c));
  }
  return box;
}

/// Unit outward normal; zero of a triangle without area.
DVec3 unit_normal(const std::array<DVec3, 3>& t) {
  return normalize(cross(t[1] - t[0], t[2] - t[0]));
}

/// Whether no corner beside an edge stands out over the plane of the triangle on its other side.
bool is_locally_convex(const MeshDesc& mesh, const MeshTopology& topology, double tolerance) {
  for (std::size_t e = 0; e < topology.edges.size(); ++e) {
    const EdgeSides& sides = topology.edge_sides[e];
    for (std::size_t k = 0; k < 2; ++k) {
      const auto t = corners_of(mesh, mesh.triangles[sides.triangles[k]]);
      const auto other = vector_cast<double>(mesh.positions[sides.opposite[1 - k]]);
      if (dot(unit_normal(t), other - t[0]) > tolerance) return false;
    }
  }
  return true;
}

/// Whether all corners are below the planes of triangles, of all or, in large meshes, of some.
bool is_below_its_planes(const MeshDesc& mesh, double tolerance) {
  const std::size_t planes = std::max(kFewestTestedPlanes, kConvexTests / mesh.positions.size());
  const std::size_t step = std::max<std::size_t>(1, mesh.triangles.size() / planes);
  for (std::size_t i = 0; i < mesh.triangles.size(); i += step) {
    const auto t = corners_of(mesh, mesh.triangles[i]);
    const DVec3 normal = unit_normal(t);
    for (const auto& other : mesh.triangles) {
      for (const std::uint32_t v : other) {
        if (dot(normal, vector_cast<double>(mesh.positions[v]) - t[0]) > tolerance) return false;
      }
    }
  }
  return true;
}

/// Draws places that are uniform in a solid.
class PlaceDrawer {
 public:
  PlaceDrawer(const FractureSolid& solid, std::uint32_t seed) : solid_(solid), numbers_(seed) {
    if (!solid.is_convex) return;
    for (const auto& t : solid.mesh.triangles) {
      const auto [a, b, c] = corners_of(solid.mesh, t);
      const DVec3 o = solid.origin;
      volume_ += std::max(0.0, dot(a - o, cross(b - o, c - o)));
      volume_up_to_.push_back(volume_);
    }
  }

  /// A place about the solid's origin; nothing if that try has failed.
  std::optional<DVec3> draw() { return solid_.is_convex ? draw_in_tetrahedron() : draw_in_box(); }

  double uniform() { return numbers_.uniform(); }

  [[nodiscard]] bool is_inside(DVec3 place) const {
    if (!solid_.is_convex) return is_solid_at(solid_.tree, solid_.origin + place);
    return std::ranges::all_of(solid_.mesh.triangles, [&](const Triangle& t) {
      const auto corners = corners_of(solid_.mesh, t);
      return dot(unit_normal(corners), solid_.origin + place - corners[0]) <= 0;
    });
  }

 private:
  /// The solid is cut into tetrahedra at its origin. One is drawn by its volume, and a place in it by the
  /// gaps between three sorted numbers.
  DVec3 draw_in_tetrahedron() {
    const double wanted = uniform() * volume_;
    const auto found = std::upper_bound(volume_up_to_.begin(), volume_up_to_.end(), wanted);
    const auto last = static_cast<std::ptrdiff_t>(volume_up_to_.size()) - 1;
    const auto index = static_cast<std::size_t>(std::min(found - volume_up_to_.begin(), last));
    std::array<double, 3> u = {uniform(), uniform(), uniform()};
    std::sort(u.begin(), u.end());
    const auto [a, b, c] = corners_of(solid_.mesh, solid_.mesh.triangles[index]);
    return u[0] * (a - solid_.origin) + (u[1] - u[0]) * (b - solid_.origin) +
           (u[2] - u[1]) * (c - solid_.origin);
  }

  std::optional<DVec3> draw_in_box() {
    const DVec3 half = solid_.half_extents;
    const double x = (2 * uniform() - 1) * half.x;
    const double y = (2 * uniform() - 1) * half.y;
    const double z = (2 * uniform() - 1) * half.z;
    const DVec3 place = {x, y, z};
    if (!is_inside(place)) return std::nullopt;
    return place;
  }

  const FractureSolid& solid_;
  SeedNumbers numbers_;
  std::vector<double> volume_up_to_;
  double volume_ = 0;
};

/// base^exponent for an exponent in [0, 1), by square roots alone, so that all machines agree.
double power(double base, double exponent) {
  double result = 1;
  for (int bit = 0; bit < 24; ++bit) {
    base = std::sqrt(base);
    exponent *= 2;
    if (exponent < 1) continue;
    exponent -= 1;
    result *= base;
  }
  return result;
}

/// Draws a place towards the impact, so that the logarithm of its distance is uniform from `radius` on: the
/// number of seeds falls with the cube of the distance, and cells grow in proportion to it.
DVec3 drawn_to(DVec3 impact, double radius, DVec3 place, double number) {
  const double distance = length(place - impact);
  if (!(distance > radius)) return place;
  return impact + power(radius / distance, number) * (place - impact);
}

/// Whether a place in the mesh's frame is at most that far from the box around the solid.
bool is_near(const FractureSolid& solid, DVec3 place, double distance) {
  const Box3<double> box = {-solid.half_extents, solid.half_extents};
  return distance_squared(box, place - solid.origin) <= distance * distance;
}

}  // namespace

bool is_convex_solid(const MeshDesc& mesh) {
  const MeshTopology topology = compute_topology(mesh.positions.size(), mesh.triangles);
  if (!topology.is_closed()) return false;
  const Box3<double> box = bounds_of(mesh);
  const double tolerance = kConvexTolerance * length(box.upper - box.lower);
  base::DisjointSets shells(mesh.positions.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    shells.merge(a, b);
    shells.merge(a, c);
  }
  const std::uint32_t shell = shells.root(mesh.triangles[0][0]);
  const bool is_one =
      std::ranges::all_of(mesh.triangles, [&](const Triangle& t) { return shells.root(t[0]) == shell; });
  return is_one && is_locally_convex(mesh, topology, tolerance) && is_below_its_planes(mesh, tolerance);
}

Result<FractureSolid> make_fracture_solid(const MeshDesc& mesh) {
  if (const Result<void> valid = validate_solid(mesh); !valid) {
    return Error{valid.error().code, valid.error().where,
                 valid.error().message + "; repair_solid or remesh_solid may close it"};
  }
  const Box3<double> box = bounds_of(mesh);
  FractureSolid solid = {.mesh = mesh};
  solid.origin = 0.5 * (box.lower + box.upper);
  solid.half_extents = 0.5 * (box.upper - box.lower);
  solid.diagonal = length(box.upper - box.lower);
  for (const auto& t : mesh.triangles) {
    const auto [a, b, c] = corners_of(mesh, t);
    solid.volume += dot(a - solid.origin, cross(b - solid.origin, c - solid.origin)) / 6;
  }
  if (!(solid.volume > kLeastVolume * solid.diagonal * solid.diagonal * solid.diagonal)) {
    return Error{ErrorCode::kOutOfRange, "mesh",
                 "is flat: it has no volume that could be divided; give it a thickness"};
  }
  solid.is_convex = is_convex_solid(mesh);
  if (solid.is_convex) return solid;
  Result<BspTree> tree = build_bsp(mesh);
  if (!tree) return tree.error();
  solid.tree = std::move(tree).value();
  return solid;
}

Result<std::vector<DVec3>> place_seeds(const FractureSolid& solid, const FractureDesc& desc) {
  std::vector<DVec3> seeds;
  for (const DVec3& seed : desc.seeds) seeds.push_back(seed - solid.origin);
  if (!seeds.empty()) return seeds;
  const auto count = static_cast<std::size_t>(desc.cells);
  const std::size_t tries = 100'000 + 1000 * count;
  const double radius = desc.impact_radius * solid.diagonal;
  if (desc.impact && !is_near(solid, *desc.impact, radius)) {
    return Error{ErrorCode::kOutOfRange, "impact",
                 "lies outside the box around the solid; it should lie in or on it"};
  }
  PlaceDrawer drawer(solid, desc.seed);
  for (std::size_t i = 0; i < tries && seeds.size() < count; ++i) {
    std::optional<DVec3> place = drawer.draw();
    const double number = drawer.uniform();
    if (!place) continue;
    if (desc.impact) {
      place = drawn_to(*desc.impact - solid.origin, radius, *place, number);
      if (!drawer.is_inside(*place)) continue;
    }
    seeds.push_back(*place);
  }
  if (seeds.size() == count) return seeds;
  return Error{ErrorCode::kOutOfRange, desc.impact ? "impact" : "mesh",
               "only " + std::to_string(seeds.size()) + " of " + std::to_string(count) +
                   " seeds fell into the solid; " +
                   (desc.impact ? "the impact should lie in or on it"
                                : "it fills too little of its box: give `seeds`")};
}

}  // namespace hooke::geometry
