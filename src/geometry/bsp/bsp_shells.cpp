#include "geometry/bsp/bsp_shells.h"

#include "base/disjoint_sets.h"
#include "geometry/line_triangle.h"
#include "geometry/mesh/bvh.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

namespace hooke::geometry {

namespace {

// Positions in steps would overflow float when multiplied with each other; the boxes need no more than float.
constexpr double kBoxScale = 0x1p-32;
constexpr double kBoxSlack = 1e-6;

/// The shell of each piece, named by its smallest piece. Where an edge has more than two pieces, solids only
/// touch.
std::vector<std::uint32_t> find_shells(const SeamedPieces& seamed) {
  using Step = std::pair<std::array<std::uint32_t, 2>, std::uint32_t>;  // an edge and a piece
  std::vector<Step> steps;
  for (std::uint32_t piece = 0; piece < seamed.outlines.size(); ++piece) {
    const auto& outline = seamed.outlines[piece];
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const std::uint32_t a = outline[k].vertex;
      const std::uint32_t b = outline[(k + 1) % outline.size()].vertex;
      steps.push_back({{std::min(a, b), std::max(a, b)}, piece});
    }
  }
  std::sort(steps.begin(), steps.end());
  base::DisjointSets sets(seamed.outlines.size());
  for (std::size_t begin = 0, end = 0; begin < steps.size(); begin = end) {
    while (end < steps.size() && steps[end].first == steps[begin].first) ++end;
    if (end - begin == 2) sets.merge(steps[begin].second, steps[begin + 1].second);
  }
  std::vector<std::uint32_t> shells(seamed.outlines.size());
  for (std::uint32_t piece = 0; piece < shells.size(); ++piece) shells[piece] = sets.root(piece);
  return shells;
}

std::array<DVec3, 3> places_of(const BspSpace& space, const BspPiece& piece) {
  const auto& c = piece.corners;
  return {space.point(c[0].point).place, space.point(c[1].point).place, space.point(c[2].point).place};
}

Bvh boxes_of(const BspSpace& space, std::span<const BspPiece> pieces) {
  std::vector<Vec3> positions;
  std::vector<Triangle> triangles;
  for (const BspPiece& piece : pieces) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    triangles.push_back({first, first + 1, first + 2});
    for (const DVec3& p : places_of(space, piece)) positions.push_back(vector_cast<Real>(kBoxScale * p));
  }
  return build_bvh(positions, triangles);
}

/// 1 where the ray leaves through the triangle, -1 where it enters, 0 where it misses. A line through an edge
/// passes one of the two triangles.
int passes(const std::array<DVec3, 3>& corners, DVec3 origin, DVec3 direction) {
  const auto [of_a, of_b, of_c] = line_volumes(origin, direction, corners);
  const bool is_leaving = of_a >= 0 && of_b >= 0 && of_c >= 0;
  const bool is_entering = of_a < 0 && of_b < 0 && of_c < 0;
  if (is_leaving == is_entering) return 0;
  const DVec3 a = corners[0] - origin;
  const DVec3 normal = cross(corners[1] - origin - a, corners[2] - origin - a);
  const double ahead = dot(normal, a);  // times dot(normal, direction): the sign of the distance along the
                                        // ray
  return is_leaving ? (ahead > 0 ? 1 : 0) : (ahead < 0 ? -1 : 0);
}

}  // namespace

Result<void> check_shells(const BspSpace& space, std::span<const BspPiece> pieces,
                          const SeamedPieces& seamed) {
  const std::vector<std::uint32_t> shells = find_shells(seamed);
  if (std::all_of(shells.begin(), shells.end(), [](std::uint32_t shell) { return shell == 0; })) return {};
  const Bvh boxes = boxes_of(space, pieces);
  std::vector<BvhEntry> near;
  for (std::uint32_t piece = 0; piece < pieces.size(); ++piece) {
    if (shells[piece] != piece) continue;
    const std::array<DVec3, 3> corners = places_of(space, pieces[piece]);
    const DVec3 middle = (1.0 / 3) * (corners[0] + corners[1] + corners[2]);
    const DVec3 normal = normalize(cross(corners[1] - corners[0], corners[2] - corners[0]));
    // The direction is outward and along nothing in particular: 4 is beyond the boxes, which end at 1.
    const DVec3 direction = 4.0 * (normal + DVec3{0.1234567, -0.0765432, 0.1543217});
    find_triangles_on_path(boxes, kBoxScale * middle, direction, kBoxSlack, near);
    int winding = 0;
    for (const BvhEntry& entry : near) {
      if (entry.triangle == piece) continue;
      winding += passes(places_of(space, pieces[entry.triangle]), middle, direction);
    }
    if (winding == 0) continue;
    return Error{ErrorCode::kOutOfRange, "mesh.triangles[" + std::to_string(pieces[piece].triangle) + "]",
                 "and its shell are wound " + std::to_string(winding + 1) +
                     " times around their inside together with others, or lie on them; a solid's surface "
                     "is wound once"};
  }
  return {};
}

}  // namespace hooke::geometry
