#include "hooke/geometry.h"

#include "base/float_environment.h"
#include "base/sort_unique.h"
#include "geometry/mesh/mesh_clean.h"

#include <algorithm>
#include <string>
#include <utility>

namespace hooke {

namespace {

using geometry::EdgeSides;
using geometry::kNone;
using geometry::MeshTopology;
using geometry::Triangle;
using geometry::TrianglePair;
using Numbers = std::vector<std::uint32_t>;

constexpr std::size_t kNamedMax = 8;

/// "triangle 3 has", "triangles 3, 5 and 7 more have".
std::string named(Numbers numbers, const char* one_does, const char* many_do) {
  base::sort_unique(numbers);
  std::string text = numbers.size() == 1 ? "triangle " : "triangles ";
  for (std::size_t i = 0; i < std::min(numbers.size(), kNamedMax); ++i) {
    if (i > 0) text += i + 1 == numbers.size() ? " and " : ", ";
    text += std::to_string(numbers[i]);
  }
  if (numbers.size() > kNamedMax) text += " and " + std::to_string(numbers.size() - kNamedMax) + " more";
  return text.append(" ").append(numbers.size() == 1 ? one_does : many_do);
}

Error refusal(std::string message) {
  return {.code = ErrorCode::kOutOfRange, .where = "mesh.triangles", .message = std::move(message)};
}

/// Checks that indices are in range and coordinates finite. Corners that are named twice can be repaired.
Result<void> check_numbers(const MeshDesc& mesh) {
  if (mesh.positions.size() > geometry::kVertexLimit || mesh.triangles.size() > geometry::kTriangleLimit) {
    return Error{ErrorCode::kLimitExceeded, "mesh", "more than 2^24 positions or 2^25 triangles"};
  }
  Numbers out_of_range;
  Numbers not_finite;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t corner : mesh.triangles[t]) {
      if (corner >= mesh.positions.size()) {
        out_of_range.push_back(t);
      } else if (!is_finite(mesh.positions[corner])) {
        not_finite.push_back(t);
      }
    }
  }
  const char* beyond = "a vertex beyond the positions";
  if (!out_of_range.empty()) {
    return refusal(named(out_of_range, "names ", "name ").append(beyond));
  }
  if (!not_finite.empty()) {
    return refusal(named(not_finite, "has", "have").append(" a coordinate that is not finite"));
  }
  return {};
}

/// The mesh while it is repaired.
struct Draft {
  std::vector<DVec3> points = {};
  std::vector<Triangle> triangles = {};
  Numbers given = {};  ///< Numbers of `triangles` in the given mesh.

  void keep(const std::vector<std::uint8_t>& is_kept, Numbers& dropped) {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      if (is_kept[t] == 0) {
        dropped.push_back(given[t]);
        continue;
      }
      triangles[kept] = triangles[t];
      given[kept++] = given[t];
    }
    triangles.resize(kept);
    given.resize(kept);
  }
};

/// The mesh with its points welded and all its triangles. Points of no triangle do not count for the size.
Draft welded(const MeshDesc& mesh) {
  std::vector<std::uint8_t> is_used(mesh.positions.size(), 0);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t corner : t) is_used[corner] = 1;
  }
  std::vector<DVec3> used;
  Numbers place(mesh.positions.size(), kNone);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (is_used[i] == 0) continue;
    place[i] = static_cast<std::uint32_t>(used.size());
    used.push_back(vector_cast<double>(mesh.positions[i]));
  }
  const geometry::Weld weld = geometry::weld(used, geometry::weld_distance(used));
  Draft draft;
  for (const std::uint32_t i : weld.first) draft.points.push_back(used[i]);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    draft.triangles.push_back({weld.welded_of[place[a]], weld.welded_of[place[b]], weld.welded_of[place[c]]});
    draft.given.push_back(t);
  }
  return draft;
}

void drop_degenerate(Draft& draft, Numbers& dropped) {
  const double distance = geometry::weld_distance(draft.points);
  std::vector<std::uint8_t> is_kept;
  for (const Triangle& t : draft.triangles) {
    is_kept.push_back(geometry::is_degenerate(draft.points, t, distance) ? 0 : 1);
  }
  draft.keep(is_kept, dropped);
}

/// Of triangles with the same corners the first stays. None stays where each edge has two others without
/// them.
void drop_duplicates(Draft& draft, Numbers& dropped) {
  const auto sorted = [](Triangle t) {
    std::sort(t.begin(), t.end());
    return t;
  };
  std::vector<std::pair<Triangle, std::uint32_t>> by_corners;
  for (std::uint32_t t = 0; t < draft.triangles.size(); ++t) {
    by_corners.emplace_back(sorted(draft.triangles[t]), t);
  }
  std::sort(by_corners.begin(), by_corners.end());
  const MeshTopology topology = geometry::compute_topology(draft.points.size(), draft.triangles);
  std::vector<std::uint8_t> is_kept(draft.triangles.size(), 1);
  for (std::size_t first = 0, last = 0; first < by_corners.size(); first = last) {
    while (last < by_corners.size() && by_corners[last].first == by_corners[first].first) ++last;
    const auto copies = static_cast<std::uint32_t>(last - first);
    if (copies == 1) continue;
    const auto& edges = topology.triangle_edges[by_corners[first].second];
    const bool is_needed = std::any_of(edges.begin(), edges.end(), [&](std::uint32_t e) {
      return topology.edge_sides[e].triangle_count - copies == 1;
    });
    for (std::size_t i = is_needed ? first + 1 : first; i < last; ++i) is_kept[by_corners[i].second] = 0;
  }
  draft.keep(is_kept, dropped);
}

void flip_outward(Draft& draft, Numbers& turned) {
  const std::vector<std::uint8_t> must_flip = geometry::find_flipped(draft.points, draft.triangles);
  for (std::size_t t = 0; t < must_flip.size(); ++t) {
    if (must_flip[t] == 0) continue;
    std::swap(draft.triangles[t][1], draft.triangles[t][2]);
    turned.push_back(draft.given[t]);
  }
}

Result<void> check_surface(const Draft& draft) {
  if (draft.triangles.empty()) return refusal("no triangle with an area is left");
  const MeshTopology topology = geometry::compute_topology(draft.points.size(), draft.triangles);
  Numbers open;
  Numbers branching;
  Numbers opposite;
  for (std::uint32_t t = 0; t < draft.triangles.size(); ++t) {
    for (const std::uint32_t e : topology.triangle_edges[t]) {
      const EdgeSides& sides = topology.edge_sides[e];
      if (sides.triangle_count == 1) open.push_back(draft.given[t]);
      if (sides.triangle_count > 2) branching.push_back(draft.given[t]);
      if (sides.triangle_count == 2 && !sides.has_same_winding) opposite.push_back(draft.given[t]);
    }
  }
  if (!branching.empty()) {
    return refusal(named(branching, "has", "have") + " an edge with more than two triangles");
  }
  if (!open.empty()) {
    return refusal(named(open, "has", "have") + " an edge without a neighbor: the surface is open");
  }
  if (!opposite.empty()) {
    return refusal(named(opposite, "faces", "face") + " the other side than a neighbor: there is no outside");
  }
  return {};
}

Result<void> check_solid(const Draft& draft) {
  std::vector<TrianglePair> crossings;
  geometry::find_crossings({draft.points, draft.triangles}, crossings);
  if (!crossings.empty()) {
    Numbers numbers;
    for (const auto& [a, b] : crossings) numbers.insert(numbers.end(), {draft.given[a], draft.given[b]});
    return refusal(named(numbers, "crosses itself", "cross each other"));
  }
  const DVec3 apex = draft.points[0];
  double volume = 0;
  for (const auto& [a, b, c] : draft.triangles) {
    volume += dot(draft.points[a] - apex, cross(draft.points[b] - apex, draft.points[c] - apex)) / 6;
  }
  const double size = 1e6 * geometry::weld_distance(draft.points);
  if (!(volume > 1e-15 * size * size * size)) return refusal("all triangles lie in one plane: no volume");
  return {};
}

}  // namespace

Result<SolidRepair> repair_solid(const MeshDesc& mesh) {
  const base::FloatEnvironment environment;
  if (Result<void> usable = check_numbers(mesh); !usable) return usable.error();
  SolidRepair repair;
  Draft draft = welded(mesh);
  drop_degenerate(draft, repair.degenerate);
  drop_duplicates(draft, repair.duplicate);
  flip_outward(draft, repair.turned);
  if (Result<void> closed = check_surface(draft); !closed) return closed.error();
  if (Result<void> solid = check_solid(draft); !solid) return solid.error();
  Numbers place(draft.points.size(), kNone);
  for (const Triangle& t : draft.triangles) {
    for (const std::uint32_t corner : t) place[corner] = 0;
  }
  for (std::size_t i = 0; i < draft.points.size(); ++i) {
    if (place[i] == kNone) continue;
    place[i] = static_cast<std::uint32_t>(repair.mesh.positions.size());
    repair.mesh.positions.push_back(vector_cast<Real>(draft.points[i]));
  }
  for (const auto& [a, b, c] : draft.triangles)
    repair.mesh.triangles.push_back({place[a], place[b], place[c]});
  repair.points_dropped = static_cast<std::uint32_t>(mesh.positions.size() - repair.mesh.positions.size());
  repair.given = draft.given;
  return repair;
}

}  // namespace hooke
