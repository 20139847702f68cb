#include "geometry/bsp/bsp_solid.h"

#include "base/float_environment.h"
#include "geometry/box.h"
#include "geometry/bsp/bsp_seams.h"
#include "geometry/bsp/bsp_shells.h"
#include "geometry/bsp/bsp_slivers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

namespace hooke::geometry {

namespace {

constexpr double kFarthest = 1e9;   // [m]
constexpr double kSmallest = 1e-9;  // [m]

Error solid_error(std::string where, std::string message, ErrorCode code = ErrorCode::kOutOfRange) {
  return {code, std::move(where), std::move(message)};
}

std::string solid_element(const char* name, std::size_t index) {
  return std::string("mesh.").append(name).append("[").append(std::to_string(index)).append("]");
}

Result<void> check_indices(const SolidMesh& mesh) {
  if (mesh.triangles.empty()) return solid_error("mesh.triangles", "a solid needs triangles");
  if (mesh.positions.size() > kVertexLimit || mesh.triangles.size() > kTriangleLimit) {
    return solid_error("mesh", "more than 2^24 positions or 2^25 triangles", ErrorCode::kLimitExceeded);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    if (std::max({a, b, c}) < mesh.positions.size()) continue;
    return solid_error(solid_element("triangles", t),
                       "names a vertex beyond the " + std::to_string(mesh.positions.size()) + " positions");
  }
  return {};
}

/// Numbers the vertices; those at the same position get the number of the first of them.
std::vector<std::uint32_t> weld_places(const std::vector<LatticePoint>& points) {
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t i) { return std::tie(points[i].x, points[i].y, points[i].z); };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t i, std::uint32_t j) { return key(i) != key(j) ? key(i) < key(j) : i < j; });
  std::vector<std::uint32_t> same(points.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    same[order[k]] = k > 0 && key(order[k]) == key(order[k - 1]) ? same[order[k - 1]] : order[k];
  }
  return same;
}

/// A triangle written from its smallest corner on, in either direction.
struct Winding {
  Triangle corners = {};  // ascending except for the direction
  bool is_even = false;
  std::uint32_t triangle = 0;
};

Winding winding_of(const Triangle& t, std::uint32_t triangle) {
  Winding w = {t, true, triangle};
  std::rotate(w.corners.begin(), std::min_element(w.corners.begin(), w.corners.end()), w.corners.end());
  if (w.corners[1] > w.corners[2]) {
    std::swap(w.corners[1], w.corners[2]);
    w.is_even = false;
  }
  return w;
}

/// The triangles to keep, ascending: of equal ones the first, of opposite ones none.
std::vector<std::uint32_t> without_duplicates(const std::vector<Triangle>& triangles,
                                              const std::vector<std::uint32_t>& kept) {
  std::vector<Winding> windings;
  windings.reserve(kept.size());
  for (const std::uint32_t t : kept) windings.push_back(winding_of(triangles[t], t));
  std::sort(windings.begin(), windings.end(), [](const Winding& a, const Winding& b) {
    return std::tie(a.corners, a.triangle) < std::tie(b.corners, b.triangle);
  });
  std::vector<std::uint32_t> rest;
  for (std::size_t begin = 0, end = 0; begin < windings.size(); begin = end) {
    std::ptrdiff_t excess = 0;
    while (end < windings.size() && windings[end].corners == windings[begin].corners) {
      excess += windings[end++].is_even ? 1 : -1;
    }
    for (std::size_t k = begin; k < end && excess != 0; ++k) {
      if (windings[k].is_even != (excess > 0)) continue;
      rest.push_back(windings[k].triangle);
      break;
    }
  }
  std::sort(rest.begin(), rest.end());
  return rest;
}

/// Six times the volume; exact.
math::Int128 six_volumes(const std::vector<LatticePoint>& p, const std::vector<Triangle>& triangles,
                         const std::vector<std::uint32_t>& kept) {
  math::Int128 sum = 0;
  for (const std::uint32_t t : kept) {
    const auto& [a, b, c] = triangles[t];
    const Vector3<math::Int128> u = {p[a].x, p[a].y, p[a].z};
    const Vector3<math::Int128> v = {p[b].x, p[b].y, p[b].z};
    const Vector3<math::Int128> w = {p[c].x, p[c].y, p[c].z};
    sum += dot(u, cross(v, w));
  }
  return sum;
}

/// The piece seen from its other side.
BspPiece flipped(const BspPiece& piece) {
  BspPiece turned = {.plane = piece.plane, .triangle = piece.triangle, .is_flipped = !piece.is_flipped};
  const std::size_t count = piece.corners.size();
  for (std::size_t k = count; k-- > 0;) {
    turned.corners.push_back({piece.corners[k].point, piece.corners[(k + count - 1) % count].edge_plane});
  }
  return turned;
}

}  // namespace

SolidMesh solid_mesh_of(const MeshDesc& mesh) {
  SolidMesh solid = {.triangles = mesh.triangles};
  for (const Vec3& p : mesh.positions) solid.positions.push_back(vector_cast<double>(p));
  return solid;
}

LatticePoint Lattice::point_of(DVec3 place) const {
  const DVec3 steps = (1 / step) * (place - origin);
  const auto nearest = [](double x) { return static_cast<std::int64_t>(std::floor(x + 0.5)); };
  return {nearest(steps.x), nearest(steps.y), nearest(steps.z)};
}

Result<Lattice> make_lattice(std::span<const SolidMesh* const> meshes) {
  Box3<double> box;
  for (const SolidMesh* mesh : meshes) {
    for (std::size_t i = 0; i < mesh->positions.size(); ++i) {
      const DVec3 p = mesh->positions[i];
      const double size = std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
      if (!is_finite(p) || size > kFarthest) {
        return solid_error(solid_element("positions", i), "a coordinate is not finite, or beyond 1e9 m");
      }
      box = merge(box, p);
    }
  }
  const DVec3 size = box.upper - box.lower;
  const double longest = std::max({size.x, size.y, size.z});
  if (!(longest >= kSmallest)) return solid_error("mesh", "less than 1e-9 m wide");
  // Half of the box is at most 2^32 steps, and the origin, which is on the lattice, a step off its middle.
  Lattice lattice = {.step = 1};
  while (lattice.step * 0x1p33 < longest) lattice.step *= 2;
  while (lattice.step * 0x1p32 >= longest) lattice.step *= 0.5;
  const auto middle = [&](double low, double high) {
    return lattice.step * std::floor(0.5 * (low + high) / lattice.step);
  };
  lattice.origin = {middle(box.lower.x, box.upper.x), middle(box.lower.y, box.upper.y),
                    middle(box.lower.z, box.upper.z)};
  return lattice;
}

namespace {

/// A mesh on the lattice.
struct LatticeMesh {
  std::vector<LatticePoint> points = {};
  std::vector<Triangle> triangles = {};  // their corners welded; as many as in the mesh
  std::vector<std::uint32_t> kept = {};  // those of the triangles that stay
};

/// Welds the corners, and leaves out flat and double triangles.
LatticeMesh on_lattice(const Lattice& lattice, const SolidMesh& mesh) {
  LatticeMesh result;
  for (const DVec3& p : mesh.positions) result.points.push_back(lattice.point_of(p));
  const std::vector<std::uint32_t> same = weld_places(result.points);
  for (const Triangle& t : mesh.triangles) {
    const auto& [a, b, c] = result.triangles.emplace_back(Triangle{same[t[0]], same[t[1]], same[t[2]]});
    if (normal_of({result.points[a], result.points[b], result.points[c]}) == LatticeNormal{}) continue;
    result.kept.push_back(static_cast<std::uint32_t>(result.triangles.size() - 1));
  }
  result.kept = without_duplicates(result.triangles, result.kept);
  return result;
}

}  // namespace

Result<std::vector<BspPiece>> make_solid_pieces(BspSpace& space, const Lattice& lattice,
                                                const SolidMesh& mesh) {
  if (Result<void> usable = check_indices(mesh); !usable) return usable.error();
  const LatticeMesh moved = on_lattice(lattice, mesh);
  const std::vector<LatticePoint>& points = moved.points;
  if (moved.kept.empty()) {
    return solid_error("mesh.triangles", "no triangle is left with an area of its own");
  }
  const bool is_inside_out = six_volumes(points, moved.triangles, moved.kept) < 0;
  std::vector<BspPiece> pieces;
  for (const std::uint32_t t : moved.kept) {
    Triangle corners = moved.triangles[t];
    if (is_inside_out) std::swap(corners[1], corners[2]);
    pieces.push_back(space.add_triangle({points[corners[0]], points[corners[1]], points[corners[2]]}, t));
  }
  const auto seamed = seam_pieces(space, pieces);
  if (!seamed) return seamed.error();
  if (Result<void> sound = check_shells(space, pieces, seamed.value()); !sound) return sound.error();
  return pieces;
}

Result<BspPieces> build_solid_tree(BspSpace& space, const std::vector<BspPiece>& pieces) {
  Result<BspPieces> tree = build_pieces(space, pieces);
  if (!tree) return tree;
  std::vector<ClassifiedPiece> parts;
  for (const BspPiece& piece : pieces) {
    parts.clear();
    classify_pieces(space, tree.value(), piece, parts);
    if (parts.size() == 1 && parts[0].where == BspClass::kSame) continue;
    return solid_error(solid_element("triangles", piece.triangle),
                       "goes through the solid that the others enclose, or lies on another triangle; "
                       "a solid's surface does not cross itself");
  }
  return tree;
}

namespace {

struct Operand {
  std::vector<BspPiece> pieces = {};
  BspPieces tree = {};
};

Result<Operand> make_operand(BspSpace& space, const Lattice& lattice, const SolidMesh& mesh,
                             const char* name) {
  const auto named = [name](Error error) {
    error.where = std::string(name).append(".").append(error.where);
    return error;
  };
  auto pieces = make_solid_pieces(space, lattice, mesh);
  if (!pieces) return named(pieces.error());
  auto tree = build_solid_tree(space, pieces.value());
  if (!tree) return named(tree.error());
  return Operand{std::move(pieces).value(), std::move(tree).value()};
}

/// Appends the parts of the pieces that are in one of two classes to the other solid.
void keep_parts(BspSpace& space, const Operand& own, const Operand& other, std::array<BspClass, 2> kept,
                std::vector<BspPiece>& result) {
  std::vector<ClassifiedPiece> parts;
  for (const BspPiece& piece : own.pieces) {
    parts.clear();
    classify_pieces(space, other.tree, piece, parts);
    for (ClassifiedPiece& part : parts) {
      if (part.where == kept[0] || part.where == kept[1]) result.push_back(std::move(part.piece));
    }
  }
}

/// The surface of the result. Where both have the same face, that of `a` is used for both.
std::vector<BspPiece> surface_of(BspSpace& space, const Operand& a, const Operand& b,
                                 SolidOperation operation) {
  std::vector<BspPiece> surface;
  if (operation == SolidOperation::kUnion) {
    keep_parts(space, a, b, {BspClass::kOutside, BspClass::kSame}, surface);
    keep_parts(space, b, a, {BspClass::kOutside, BspClass::kOutside}, surface);
  } else if (operation == SolidOperation::kIntersection) {
    keep_parts(space, a, b, {BspClass::kInside, BspClass::kSame}, surface);
    keep_parts(space, b, a, {BspClass::kInside, BspClass::kInside}, surface);
  } else {
    keep_parts(space, a, b, {BspClass::kOutside, BspClass::kOpposite}, surface);
    const std::size_t of_a = surface.size();
    keep_parts(space, b, a, {BspClass::kInside, BspClass::kInside}, surface);
    for (std::size_t i = of_a; i < surface.size(); ++i) surface[i] = flipped(surface[i]);
  }
  return surface;
}

}  // namespace

Result<SolidMesh> combine_solids(const SolidMesh& a, const SolidMesh& b, SolidOperation operation) {
  const std::array<const SolidMesh*, 2> both = {&a, &b};
  const Result<Lattice> lattice = make_lattice(both);
  if (!lattice) return lattice.error();
  BspSpace space;
  const auto operand_a = make_operand(space, lattice.value(), a, "a");
  if (!operand_a) return operand_a.error();
  const auto operand_b = make_operand(space, lattice.value(), b, "b");
  if (!operand_b) return operand_b.error();
  const std::vector<BspPiece> surface = surface_of(space, operand_a.value(), operand_b.value(), operation);
  const auto seamed = seam_pieces(space, surface);
  if (!seamed) return seamed.error();
  const SeamedTriangles triangles = triangulate(space, surface, seamed.value());
  SolidMesh mesh = {.triangles = triangles.triangles};
  for (const std::uint32_t point : triangles.points) {
    mesh.positions.push_back(lattice.value().place_of(space.point(point).place));
  }
  return mesh;
}

}  // namespace hooke::geometry

namespace hooke {

Result<MeshDesc> combine_solids(const MeshDesc& a, const MeshDesc& b, SolidOperation operation) {
  const base::FloatEnvironment environment;
  const auto combined =
      geometry::combine_solids(geometry::solid_mesh_of(a), geometry::solid_mesh_of(b), operation);
  if (!combined) return combined.error();
  geometry::Box3<double> box;
  for (const DVec3& p : combined.value().positions) box = merge(box, p);
  const double diagonal = combined.value().positions.empty() ? 0 : length(box.upper - box.lower);
  // Twice the distance at which the corners of a model's file are welded.
  const geometry::SolidMesh clean = geometry::without_slivers(combined.value(), 2e-6 * diagonal);
  MeshDesc mesh = {.triangles = clean.triangles};
  for (const DVec3& p : clean.positions) mesh.positions.push_back(vector_cast<Real>(p));
  return mesh;
}

}  // namespace hooke
