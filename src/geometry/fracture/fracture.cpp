#include "hooke/fracture.h"

#include "base/float_environment.h"
#include "geometry/fracture/face_section.h"
#include "geometry/fracture/fracture_seeds.h"
#include "geometry/fracture/fractured_parts.h"
#include "geometry/fracture/voronoi.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <utility>

namespace hooke {

namespace {

using geometry::ConvexCell;
using geometry::FaceSection;
using geometry::FractureSolid;
using geometry::Triangle;
using geometry::VoronoiCell;
using geometry::VoronoiCells;

constexpr std::size_t kMostSeeds = 4096;
constexpr double kLeastFace = 1e-12;  ///< Area of a face below which cells only touch [diagonals^2].

Error fracture_error(const char* where, std::string message) {
  return {ErrorCode::kOutOfRange, where, std::move(message)};
}

Result<void> check(const FractureDesc& desc) {
  const auto is_within = [](double value, double low, double high) { return value >= low && value <= high; };
  if (desc.seeds.empty() && (desc.cells < 1 || static_cast<std::size_t>(desc.cells) > kMostSeeds))
    return fracture_error("cells", std::to_string(desc.cells) + " is out of range, must be 1 to 4096");
  if (desc.seeds.size() > kMostSeeds)
    return fracture_error("seeds", std::to_string(desc.seeds.size()) + " are too many, must be 1 to 4096");
  for (std::size_t i = 0; i < desc.seeds.size(); ++i) {
    if (is_finite(desc.seeds[i])) continue;
    return {fracture_error("seeds", "seed " + std::to_string(i) + " is not finite")};
  }
  if (desc.impact && !is_finite(*desc.impact)) return fracture_error("impact", "is not finite");
  if (!is_within(desc.impact_radius, 0.001, 1)) {
    return fracture_error("impact_radius",
                          std::to_string(desc.impact_radius) + " is out of range, must be 0.001 to 1");
  }
  if (!is_within(desc.least_face, 0, 1)) {
    return fracture_error("least_face", std::to_string(desc.least_face) + " is out of range, must be 0 to 1");
  }
  if (!is_within(desc.least_share, 0, 0.5)) {
    return fracture_error("least_share",
                          std::to_string(desc.least_share) + " is out of range, must be 0 to 0.5");
  }
  return {};
}

/// Puts the corners about the center, rounded. Corners that no triangle uses are left out.
void set_mesh(std::span<const DVec3> points, std::vector<Triangle> triangles, DVec3 origin,
              FractureCell& cell) {
  const auto center = geometry::center_of(points, triangles);
  cell.volume = geometry::six_volumes(points, triangles) / 6;
  cell.center = origin + center;
  std::vector<std::uint32_t> renamed(points.size(), geometry::kNone);
  for (Triangle& t : triangles) {
    for (std::uint32_t& v : t) {
      if (renamed[v] == geometry::kNone) {
        renamed[v] = static_cast<std::uint32_t>(cell.mesh.positions.size());
        cell.mesh.positions.push_back(vector_cast<Real>(points[v] - center));
      }
      v = renamed[v];
    }
  }
  cell.mesh.triangles = std::move(triangles);
}

/// Makes cells and bonds of the polyhedra of a convex solid.
Fracture assemble(const FractureSolid& solid, std::span<const DVec3> seeds, const VoronoiCells& voronoi) {
  Fracture made;
  std::vector<std::uint32_t> cell_of(voronoi.cells.size(), FractureCell::kSurface);
  for (std::uint32_t i = 0; i < voronoi.cells.size(); ++i) {
    if (!voronoi.cells[i].polyhedron.faces.empty()) {
      cell_of[i] = static_cast<std::uint32_t>(made.cells.size());
      made.cells.push_back({.seed = i, .seed_place = solid.origin + seeds[i]});
    }
  }
  const double least = kLeastFace * solid.diagonal * solid.diagonal;
  for (std::uint32_t i = 0; i < voronoi.cells.size(); ++i) {
    if (cell_of[i] == FractureCell::kSurface) continue;
    const ConvexCell& cell = voronoi.cells[i].polyhedron;
    FractureCell& piece = made.cells[cell_of[i]];
    std::vector<Triangle> triangles;
    for (const ConvexCell::Face& face : cell.faces) {
      append_triangles(cell, face, triangles);
      piece.across.resize(triangles.size(),
                          face.cut == ConvexCell::kUncut ? FractureCell::kSurface : cell_of[face.cut]);
    }
    for (const std::uint32_t other : voronoi.cells[i].neighbors) {
      if (other < i) continue;
      std::vector<Triangle> shared;
      for (std::size_t t = 0; t < triangles.size(); ++t) {
        if (piece.across[t] == cell_of[other]) shared.push_back(triangles[t]);
      }
      const FaceSection section = geometry::measure_section(cell.points, shared);
      if (!(section.area > least)) continue;
      made.bonds.push_back({cell_of[i], cell_of[other], section.area, solid.origin + section.center,
                            section.normal, section.modulus});
    }
    set_mesh(cell.points, std::move(triangles), solid.origin, piece);
  }
  return made;
}

/// Makes cells and bonds of the parts that cells of a solid that is not convex consist of.
Fracture assemble(const FractureSolid& solid, std::span<const DVec3> seeds,
                  const geometry::FracturedParts& parts, double least) {
  Fracture made;
  for (const geometry::FracturedPart& part : parts.parts) {
    FractureCell cell = {
        .across = part.across, .seed = part.seed, .seed_place = solid.origin + seeds[part.seed]};
    set_mesh(part.points, part.triangles, solid.origin, cell);
    cell.is_convex = geometry::is_convex_solid(cell.mesh);
    made.small_pieces += cell.volume < least ? 1 : 0;
    made.cells.push_back(std::move(cell));
  }
  for (const geometry::PartFace& face : parts.faces) {
    const FaceSection section = geometry::measure_section(parts.parts[face.a].points, face.triangles);
    if (!(section.area > kLeastFace * solid.diagonal * solid.diagonal)) continue;
    made.bonds.push_back(
        {face.a, face.b, section.area, solid.origin + section.center, section.normal, section.modulus});
  }
  return made;
}

/// Leaves out bonds that are small for both of their cells. The largest face of a cell always stays.
void drop_small_faces(double least_face, Fracture& made) {
  std::vector<double> largest(made.cells.size(), 0);
  double whole = 0;
  for (const FractureBond& bond : made.bonds) {
    largest[bond.a] = std::max(largest[bond.a], bond.area);
    largest[bond.b] = std::max(largest[bond.b], bond.area);
    whole += bond.area;
  }
  std::erase_if(made.bonds, [&](const FractureBond& bond) {
    return bond.area < least_face * std::min(largest[bond.a], largest[bond.b]);
  });
  double left = whole;
  for (const FractureBond& bond : made.bonds) left -= bond.area;
  if (whole > 0) made.unbonded_share = std::max(0.0, left) / whole;
}

}  // namespace

Result<Fracture> fracture(const MeshDesc& mesh, const FractureDesc& desc) {
  const base::FloatEnvironment environment;
  if (const Result<void> checked = check(desc); !checked) return checked.error();
  const Result<FractureSolid> solid = geometry::make_fracture_solid(mesh);
  if (!solid) return solid.error();
  const Result<std::vector<DVec3>> seeds = geometry::place_seeds(solid.value(), desc);
  if (!seeds) return seeds.error();
  const double least = desc.least_share * solid.value().volume / static_cast<double>(seeds.value().size());
  const Result<VoronoiCells> cells = geometry::divide(solid.value(), seeds.value(), least);
  if (!cells) return cells.error();
  Fracture made;
  if (solid.value().is_convex) {
    made = assemble(solid.value(), seeds.value(), cells.value());
  } else {
    const geometry::FracturedParts parts =
        geometry::find_parts(cells.value(), seeds.value(), solid.value().diagonal);
    made = assemble(solid.value(), seeds.value(), parts, least);
  }
  made.merged = cells.value().merged;
  drop_small_faces(desc.least_face, made);
  return made;
}

}  // namespace hooke
