#include "build/blade.h"

#include "base/sort_unique.h"
#include "build/cloth_splits.h"
#include "build/point_splits.h"
#include "build/solid_splits.h"
#include "geometry/orientation.h"

#include <algorithm>

namespace hooke::build {

namespace {

/// Room around a blade, so that rounding of middles takes no element from it; as a share of its place
/// [ratio].
constexpr double kRoom = 1e-12;

using geometry::max_of;
using geometry::min_of;

/// Whether `d` is above the plane of a, b, c; points in the plane count as above it.
bool is_above(DVec3 a, DVec3 b, DVec3 c, DVec3 d) {
  return geometry::orientation(a, b, c, d) >= 0;
}

/// Whether an edge goes around the line from `p` to `q` to the left. The edge from `b` to `a` then does not,
/// even if the line meets it: of two triangles with a common edge a line through that edge crosses one.
bool goes_left(DVec3 p, DVec3 q, DVec3 a, DVec3 b) {
  const bool in_order = std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
  return in_order ? is_above(p, q, a, b) : !is_above(p, q, b, a);
}

/// Places in the world of the corners of an object's elements, and their middles.
template <std::size_t N>
class ElementPlaces {
 public:
  ElementPlaces(const ElementMesh<N>& mesh, const state::Deformable& object, const state::Tables& t)
      : mesh_(mesh), origin_(object.origin), positions_(t.particles.position) {}

  [[nodiscard]] DVec3 at(std::uint32_t particle) const {
    return origin_ + vector_cast<double>(positions_[particle].x);
  }
  [[nodiscard]] DVec3 middle(std::uint32_t element) const {
    DVec3 sum;
    for (const std::uint32_t p : mesh_.corners[element]) sum += at(p);
    return (1.0 / N) * sum;
  }
  /// Whether the blade may come between an element and a neighbor that is no larger: each way between two
  /// middles is no farther from the larger element than the smaller one is long.
  [[nodiscard]] bool is_near(const SweptBlade& blade, std::uint32_t element) const {
    geometry::Box3<double> box;
    for (const std::uint32_t p : mesh_.corners[element]) box = geometry::merge(box, {at(p), at(p)});
    const double size = length(box.upper - box.lower);
    const DVec3 room = {size, size, size};
    return blade.may_meet({box.lower - room, box.upper + room});
  }

 private:
  const ElementMesh<N>& mesh_;
  DVec3 origin_;
  const std::vector<state::PositionRecord>& positions_;
};

/// Lists the pairs of neighbors between which the blade leads.
template <std::size_t N>
std::vector<ElementPair> find_parted(const ElementMesh<N>& mesh, const ElementPlaces<N>& places,
                                     const SweptBlade& blade) {
  std::vector<ElementPair> pairs;
  for (std::uint32_t e = 0; e < mesh.corners.size(); ++e) {
    if (!places.is_near(blade, e)) continue;
    for (const std::uint32_t p : mesh.corners[e]) {
      for (const std::uint32_t f : mesh.incidence.of(p)) {
        if (mesh.are_neighbors(e, f)) pairs.push_back({std::min(e, f), std::max(e, f)});
      }
    }
  }
  base::sort_unique(pairs);
  std::erase_if(pairs, [&](const ElementPair& pair) {
    return !blade.crosses(places.middle(pair[0]), places.middle(pair[1]));
  });
  return pairs;
}

std::vector<ElementPair> joined(const std::vector<ElementPair>& a, const std::vector<ElementPair>& b) {
  std::vector<ElementPair> all;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all));
  return all;
}

/// What a blade does to an object: the pairs between which it leads, these with those that were scored
/// before, and the points that split.
struct Parting {
  std::vector<ElementPair> cut, parted;
  std::vector<PointSplit> splits;
};

template <std::size_t N>
Parting part_by(const SweptBlade& blade, const ElementMesh<N>& mesh, const state::Deformable& object,
                const state::Tables& t) {
  Parting parting = {
      .cut = find_parted(mesh, ElementPlaces<N>(mesh, object, t), blade), .parted = {}, .splits = {}};
  if (parting.cut.empty()) return parting;
  parting.parted = joined(parting.cut, object.scored);
  parting.splits = find_splits<N>(mesh, parting.cut, parting.parted);
  return parting;
}

}  // namespace

SweptBlade::SweptBlade(const std::array<DVec3, 2>& from, const std::array<DVec3, 2>& to)
    : a_(from[0]),
      b_(from[1]),
      c_(to[1]),
      d_(to[0]),
      box_{min_of(min_of(a_, b_), min_of(c_, d_)), max_of(max_of(a_, b_), max_of(c_, d_))} {
  const DVec3 sizes = max_of(max_of(box_.lower, -1.0 * box_.lower), max_of(box_.upper, -1.0 * box_.upper));
  const double room = kRoom * (sizes.x + sizes.y + sizes.z);
  box_.lower -= DVec3{room, room, room};
  box_.upper += DVec3{room, room, room};
}

bool SweptBlade::may_meet(const geometry::Box3<double>& box) const {
  return geometry::overlap(box, box_);
}

bool SweptBlade::crosses(DVec3 p, DVec3 q) const {
  if (!may_meet({min_of(p, q), max_of(p, q)})) return false;
  const bool ab = goes_left(p, q, a_, b_);
  const bool bc = goes_left(p, q, b_, c_);
  const bool ca = goes_left(p, q, c_, a_);
  const bool cd = goes_left(p, q, c_, d_);
  const bool da = goes_left(p, q, d_, a_);
  const bool first = ab == bc && bc == ca && is_above(a_, b_, c_, p) != is_above(a_, b_, c_, q);
  const bool second = cd == da && cd == !ca && is_above(a_, c_, d_, p) != is_above(a_, c_, d_, q);
  return first != second;
}

std::vector<std::uint32_t> find_cut_segments(const state::Deformable& rope, const SweptBlade& blade,
                                             const state::Tables& t) {
  std::vector<std::uint32_t> segments;
  const auto at = [&](std::uint32_t node) {
    return rope.origin + vector_cast<double>(t.particles.position[rope.particles.first + node].x);
  };
  for (std::uint32_t i = 0; i < rope.segments.count; ++i) {
    if (t.segments.joins(rope.segments.first + i) && blade.crosses(at(i), at(i + 1))) segments.push_back(i);
  }
  return segments;
}

std::optional<ClothCut> cut_cloth(std::uint32_t object, const SweptBlade& blade, state::Tables& t) {
  const ElementMesh<3> mesh = triangles_of(t, t.objects[object]);
  const auto [cut, parted, splits] = part_by(blade, mesh, t.objects[object], t);
  if (cut.empty()) return std::nullopt;
  const auto after = corners_after(mesh, t.objects[object].particles, splits);
  ClothCut result = {.edges = static_cast<std::uint32_t>(cut.size()),
                     .first_added = t.objects[object].particles.count,
                     .added = static_cast<std::uint32_t>(splits.size()),
                     .held = count_held(t, splits),
                     .burst = !splits.empty() && t.objects[object].gas > 0};
  split_cloth(object, mesh, splits, t);
  state::Deformable& cloth = t.objects[object];
  cloth.scored = still_joined<3>(parted, after);
  result.scored = static_cast<std::uint32_t>(cloth.scored.size());
  return result;
}

std::optional<SolidCut> cut_solid(std::uint32_t object, const SweptBlade& blade, state::Tables& t) {
  const ElementMesh<4> mesh = tetrahedra_of(t, t.objects[object]);
  const auto [cut, parted, splits] = part_by(blade, mesh, t.objects[object], t);
  if (cut.empty()) return std::nullopt;
  SolidCut result = {.faces = static_cast<std::uint32_t>(cut.size()),
                     .first_added = t.objects[object].particles.count,
                     .added = static_cast<std::uint32_t>(splits.size()),
                     .held = count_held(t, splits)};
  part_solid(object, mesh, splits, parted, t);
  result.scored = static_cast<std::uint32_t>(t.objects[object].scored.size());
  return result;
}

}  // namespace hooke::build
