#include "hooke/geometry.h"

#include "base/float_environment.h"
#include "geometry/box.h"
#include "geometry/convex/convex_hull.h"
#include "geometry/convex/mass_properties.h"
#include "geometry/mesh/simplify.h"
#include "geometry/solid/parts_listener.h"
#include "geometry/solid/solid_cut.h"
#include "geometry/triangle_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <utility>

/// \file
/// Cuts a solid into parts that are nearly convex, after the idea of approximate convex decomposition (Lien
/// and Amato 2007). The measure of a part is how deep its surface dips below its hull, and the deepest part
/// is cut. Of a number of planes the one is taken that leaves the smallest hulls. The cuts themselves are in
/// the hull's faces and are not measured. In the end parts that make a good one are joined.

namespace hooke {

namespace {

using geometry::ConvexHull;
using geometry::Corners;
using geometry::SolidHalves;
using geometry::SolidPiece;

constexpr int kPartsMax = 256;
constexpr std::size_t kNotchPlanesMax = 32;
constexpr int kSamplesPerExtent = 24;
constexpr double kOnPlane = 1e-6;   // [extents of the solid]
constexpr int kTrialVertices = 48;  // of hulls by which cuts are compared
// The costs of a cut that goes all around the part, and of one that leaves everything on one side, are in
// units of the volume of its hull. A ring has to be cut although no single cut makes its hulls smaller.
constexpr double kCostOfLength = 0.01;
constexpr double kCostOfUnevenness = 0.01;
constexpr double kGrowthMax = 0.05;  // largest growth of the volume, by joining two parts
// A mesh of more triangles is cut in place of it after it was simplified to so many: the time of all cuts
// grows with the triangles, and the cuts lie nearly in the same places.
constexpr std::size_t kTrianglesMax = 4096;
constexpr std::size_t kTrianglesSimplified = 3000;

/// The solid that all parts belong to.
struct Solid {
  std::vector<Corners> surface;
  std::vector<Plane> notch_planes;  // where a cut is likely to be good
  double on_plane = 0;              // distance below which a point counts as on a plane [m]
};

struct Part {
  SolidPiece piece;
  ConvexHull hull;
  geometry::Box bounds = {};
  double volume = 0;      // volume of the hull [m^3]
  double depth = 0;       // depth of the surface below the hull [m]
  bool is_final = false;  // no plane cuts it, or only one that leaves nothing
};

/// Largest depth of the surface below the hull, at points at most 1/24 of the extent apart.
double depth_of(std::span<const Corners> surface, const ConvexHull& hull) {
  const double spacing = 2 * static_cast<double>(hull.outer_radius) / kSamplesPerExtent;
  double deepest = 0;
  const auto sample = [&](Vec3 p) {
    Real depth = std::numeric_limits<Real>::infinity();
    for (const ConvexHull::Face& face : hull.faces)
      depth = std::min(depth, face.offset - dot(face.normal, p));
    deepest = std::max(deepest, static_cast<double>(depth));
  };
  for (const auto& [a, b, c] : surface) {
    const auto longest = static_cast<double>(std::max({length(b - a), length(c - b), length(a - c)}));
    const int steps = std::clamp(static_cast<int>(std::ceil(longest / spacing)), 1, 2 * kSamplesPerExtent);
    for (int i = 0; i <= steps; ++i) {
      for (int k = 0; k <= steps - i; ++k) {
        sample(a + Real(i) / Real(steps) * (b - a) + Real(k) / Real(steps) * (c - a));
      }
    }
  }
  return deepest;
}

Result<ConvexHull> hull_around(const SolidPiece& piece, int vertex_limit) {
  std::vector<Vec3> points = piece.corners;
  points.reserve(points.size() + 3 * piece.surface.size());
  for (const Corners& t : piece.surface) points.insert(points.end(), t.begin(), t.end());
  return geometry::make_convex_hull(points, vertex_limit);
}

/// Makes a part; an Error if it is too thin.
Result<Part> make_part(SolidPiece piece) {
  Result<ConvexHull> hull = hull_around(piece, ConvexHull::kMaxVertices);
  if (!hull) return hull.error();
  Part part = {.piece = std::move(piece), .hull = std::move(hull).value()};
  for (const Vec3& v : part.hull.vertices) part.bounds = merge(part.bounds, v);
  part.volume = geometry::mass_of(part.hull).volume;
  part.depth = depth_of(part.piece.surface, part.hull);
  return part;
}

/// Planes of the triangles beside edges that lie in a notch, the longest and sharpest first.
std::vector<Plane> find_notch_planes(const MeshDesc& mesh, double on_plane) {
  struct Notch {
    double size = 0;
    std::array<Plane, 2> planes = {};
  };
  const auto topology = geometry::compute_topology(mesh.positions.size(), mesh.triangles);
  std::vector<Notch> notches;
  for (std::size_t e = 0; e < topology.edges.size(); ++e) {
    Notch notch;
    for (std::size_t side = 0; side < 2; ++side) {
      const auto& t = mesh.triangles[topology.edge_sides[e].triangles[side]];
      const Corners corners = {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
      const DVec3 normal = geometry::normal_of(corners);
      notch.planes[side] = {normal, dot(normal, vector_cast<double>(corners[0]))};
    }
    const double above = signed_distance(
        notch.planes[0], vector_cast<double>(mesh.positions[topology.edge_sides[e].opposite[1]]));
    if (!(above > on_plane)) continue;
    const auto along =
        vector_cast<double>(mesh.positions[topology.edges[e][1]] - mesh.positions[topology.edges[e][0]]);
    notch.size = length(along) * length(cross(notch.planes[0].normal, notch.planes[1].normal));
    notches.push_back(notch);
  }
  std::stable_sort(notches.begin(), notches.end(),
                   [](const Notch& a, const Notch& b) { return a.size > b.size; });
  std::vector<Plane> planes;
  for (const Notch& notch : notches) {
    for (const Plane& plane : notch.planes) {
      const bool is_known = std::ranges::any_of(planes, [&](const Plane& known) {
        const double sign = dot(known.normal, plane.normal) < 0 ? -1 : 1;
        return length(known.normal - sign * plane.normal) < 1e-4 &&
               std::abs(known.offset - sign * plane.offset) < 1e2 * on_plane;
      });
      if (!is_known && planes.size() < kNotchPlanesMax) planes.push_back(plane);
    }
  }
  return planes;
}

/// Planes across the hull in nine directions, dividing its width evenly.
void append_even_planes(const ConvexHull& hull, std::vector<Plane>& planes) {
  const double s = std::sqrt(0.5);
  const std::array<DVec3, 9> directions = {
      {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {s, s, 0}, {s, -s, 0}, {0, s, s}, {0, s, -s}, {s, 0, s}, {-s, 0, s}}};
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const DVec3 n = directions[i];
    const auto end = [&](DVec3 along) {
      return dot(n, vector_cast<double>(hull.vertices[geometry::support(hull, vector_cast<Real>(along))]));
    };
    const double low = end(-n);
    const double high = end(n);
    const int cells = i < 3 ? 8 : 4;
    for (int k = 1; k < cells; ++k) planes.push_back({n, low + (high - low) * k / cells});
  }
}

/// Estimates the volume of the hull around a piece.
double hull_volume(const SolidPiece& piece) {
  const Result<ConvexHull> hull = hull_around(piece, kTrialVertices);
  return hull ? geometry::mass_of(hull.value()).volume : 0.0;
}

/// The two sides of the plane that leaves the smallest hulls. Of nearly equal planes it takes a short cut
/// through the middle. Returns nothing if no plane cuts the part.
std::optional<SolidHalves> find_best_cut(const Part& part, const Solid& solid) {
  std::vector<Plane> planes = solid.notch_planes;
  append_even_planes(part.hull, planes);
  const double whole = hull_volume(part.piece);
  const double girth = 2 * 3.14159265358979 * static_cast<double>(part.hull.outer_radius);
  std::optional<SolidHalves> best;
  double smallest = std::numeric_limits<double>::infinity();
  for (const Plane& plane : planes) {
    SolidHalves halves = cut(part.piece, solid.surface, plane, solid.on_plane);
    if (halves.below.surface.empty() || halves.above.surface.empty()) continue;
    const double below = hull_volume(halves.below);
    const double above = hull_volume(halves.above);
    const double cost = (below + above) / whole + kCostOfLength * halves.cut_length / girth +
                        kCostOfUnevenness * std::abs(below - above) / whole;
    if (!(cost < smallest)) continue;
    smallest = cost;
    best = std::move(halves);
  }
  return best;
}

/// Index of the part to cut next; parts.size() if all are good enough.
std::size_t find_deepest(const std::vector<Part>& parts, double concavity_max) {
  std::size_t deepest = parts.size();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].is_final || parts[i].depth <= concavity_max) continue;
    if (deepest == parts.size() || parts[i].depth > parts[deepest].depth) deepest = i;
  }
  return deepest;
}

/// Replaces the part by its two sides of the best plane; a side that is too thin is left out.
void cut_part(std::size_t number, const Solid& solid, std::vector<Part>& parts) {
  parts[number].is_final = true;
  std::optional<SolidHalves> halves = find_best_cut(parts[number], solid);
  if (!halves) return;
  Result<Part> below = make_part(std::move(halves->below));
  Result<Part> above = make_part(std::move(halves->above));
  if (!below) std::swap(below, above);
  if (!below) return;
  parts[number] = std::move(below).value();
  if (!above) return;
  parts.insert(parts.begin() + static_cast<std::ptrdiff_t>(number) + 1, std::move(above).value());
}

/// Limits of a joined part: its depth, and how much larger it is than its two parts.
struct JoinLimits {
  double depth = 0;  // [m]
  double growth = 0;
};

/// Joins two parts into one; returns nothing if they are apart, or the limits are exceeded.
std::optional<Part> join(const Part& a, const Part& b, const JoinLimits& limits, double on_plane) {
  const auto slack = static_cast<Real>(on_plane);
  const Vec3 margin = {slack, slack, slack};
  const geometry::Box around_a = {a.bounds.lower - margin, a.bounds.upper + margin};
  if (!overlap(around_a, b.bounds)) return std::nullopt;
  SolidPiece both = {.surface = a.piece.surface, .planes = {}, .corners = a.piece.corners};
  both.surface.insert(both.surface.end(), b.piece.surface.begin(), b.piece.surface.end());
  both.corners.insert(both.corners.end(), b.piece.corners.begin(), b.piece.corners.end());
  Result<Part> part = make_part(std::move(both));
  if (!part || part.value().depth > limits.depth) return std::nullopt;
  if (part.value().volume > (1 + limits.growth) * (a.volume + b.volume)) return std::nullopt;
  return std::move(part).value();
}

/// Joins each part with the first later ones that fit.
void join_parts(const JoinLimits& limits, double on_plane, std::vector<Part>& parts) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (std::size_t k = i + 1; k < parts.size();) {
      std::optional<Part> joined = join(parts[i], parts[k], limits, on_plane);
      if (!joined) {
        ++k;
        continue;
      }
      parts[i] = std::move(*joined);
      parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(k));
      k = i + 1;
    }
  }
}

/// Tells the listener how many of the parts there may be are made.
void advance(std::size_t parts, std::size_t parts_max) {
  geometry::PartsListener* listener = geometry::PartsListening::current();
  if (listener != nullptr) listener->advance(static_cast<double>(parts) / static_cast<double>(parts_max));
}

/// Cuts the solid until its parts are good, and joins those that were cut in vain.
Result<std::vector<Part>> find_parts(const MeshDesc& mesh, double concavity_max, std::size_t parts_max) {
  Solid solid;
  for (const auto& t : mesh.triangles) {
    solid.surface.push_back({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]});
  }
  Result<Part> whole = make_part({.surface = solid.surface, .planes = {}, .corners = {}});
  if (!whole) return whole.error();
  solid.on_plane = kOnPlane * static_cast<double>(whole.value().hull.outer_radius);
  solid.notch_planes = find_notch_planes(mesh, solid.on_plane);
  std::vector<Part> parts = {std::move(whole).value()};
  while (parts.size() < parts_max) {
    const std::size_t deepest = find_deepest(parts, concavity_max);
    if (deepest == parts.size()) break;
    cut_part(deepest, solid, parts);
    advance(parts.size(), parts_max);
  }
  // Some cuts may have turned out needless; those that leave no trace are undone first.
  for (const double share : {0.01, 1.0})
    join_parts({share * concavity_max, share * kGrowthMax}, solid.on_plane, parts);
  return parts;
}

}  // namespace

Result<std::vector<MeshDesc>> decompose_convex(const MeshDesc& mesh, Real concavity_max, int parts_max) {
  const base::FloatEnvironment environment;
  if (!(concavity_max > Real(0)) || !std::isfinite(concavity_max)) {
    return Error{.where = "concavity_max", .message = "the largest concavity is positive and finite"};
  }
  if (parts_max < 1 || parts_max > kPartsMax) {
    return Error{.where = "parts_max", .message = std::to_string(parts_max) + " is outside [1, 256]"};
  }
  if (const Result<void> solid = geometry::validate_solid(mesh); !solid) return solid.error();
  geometry::PartsListener* listener = geometry::PartsListening::current();
  if (listener != nullptr) {
    std::vector<MeshDesc> known = listener->recall(mesh, concavity_max, parts_max);
    if (!known.empty()) return known;
  }
  const bool is_fine = mesh.triangles.size() > kTrianglesMax;
  Result<std::vector<Part>> parts =
      find_parts(is_fine ? geometry::simplify(mesh, kTrianglesSimplified) : mesh,
                 static_cast<double>(concavity_max), static_cast<std::size_t>(parts_max));
  if (!parts) return parts.error();
  std::vector<MeshDesc> meshes;
  std::transform(parts.value().begin(), parts.value().end(), std::back_inserter(meshes),
                 [](const Part& part) { return geometry::mesh_of(part.hull); });
  if (listener != nullptr) {
    listener->advance(1);
    listener->keep(mesh, concavity_max, parts_max, meshes);
  }
  return meshes;
}

}  // namespace hooke
