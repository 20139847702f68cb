#pragma once

#include "base/disjoint_sets.h"
#include "base/lists_by_key.h"
#include "base/sort_unique.h"
#include "state/tables.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

/// \file
/// Points that become several, because the triangles or tetrahedra around them part: the part that is common
/// to cloths and solids that tear and that are cut. Elements are counted from the object's first
/// one, particles are rows of their table.

namespace hooke::build {

/// Two elements with an edge or a face in common, the lower first.
using ElementPair = std::array<std::uint32_t, 2>;

/// Says which elements have each particle of an object.
class Incidence {
 public:
  template <std::size_t N>
  Incidence(std::span<const std::array<std::uint32_t, N>> elements, state::Rows particles)
      : first_(particles.first) {
    elements_.fill(particles.count, [&](auto visit) {
      for (std::uint32_t i = 0; i < elements.size(); ++i) {
        for (const std::uint32_t p : elements[i]) visit(p - first_, i);
      }
    });
  }

  /// The elements that have a particle, in ascending order.
  [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t particle) const {
    return elements_.of(particle - first_);
  }

 private:
  std::uint32_t first_;
  base::ListsByKey<std::uint32_t> elements_;
};

/// The triangles of a cloth (N = 3), or the tetrahedra of a solid (N = 4).
template <std::size_t N>
struct ElementMesh {
  std::vector<std::array<std::uint32_t, N>> corners;
  std::span<const Real> weight;  ///< Mass or volume of each.
  Incidence incidence;

  [[nodiscard]] bool has(std::uint32_t element, std::uint32_t particle) const {
    const auto& c = corners[element];
    return std::find(c.begin(), c.end(), particle) != c.end();
  }
  /// Whether two elements have all but one of their corners in common.
  [[nodiscard]] bool are_neighbors(std::uint32_t a, std::uint32_t b) const {
    std::size_t common = 0;
    for (const std::uint32_t p : corners[a]) common += has(b, p) ? 1 : 0;
    return common + 1 == N;
  }
};

[[nodiscard]] ElementMesh<3> triangles_of(const state::Tables& tables, const state::Deformable& cloth);
[[nodiscard]] ElementMesh<4> tetrahedra_of(const state::Tables& tables, const state::Deformable& solid);

/// A particle gives some of its elements to a new one at the same place. If it gives to several, it stands in
/// as many splits that follow one another.
struct PointSplit {
  std::uint32_t particle = 0;
  std::vector<std::uint32_t> moved = {};  ///< Elements that get the new particle, in ascending order.
  double share = 0;  ///< Share of these, by weight, in all that the particle has had until this split.
};

/// Elements of a particle whose share is smaller than this stay with it: their point would be too light.
inline constexpr double kLeastShare = 1e-6;

/// Divides the elements of a particle into those that hang together by neighbors that are not in `parted`,
/// which is sorted.
template <std::size_t N>
std::vector<std::vector<std::uint32_t>> parts_at(const ElementMesh<N>& mesh, std::uint32_t particle,
                                                 std::span<const ElementPair> parted) {
  const auto elements = mesh.incidence.of(particle);
  base::DisjointSets sets(elements.size());
  for (std::uint32_t i = 0; i < elements.size(); ++i) {
    for (std::uint32_t k = i + 1; k < elements.size(); ++k) {
      const ElementPair pair = {elements[i], elements[k]};
      if (mesh.are_neighbors(pair[0], pair[1]) && !std::binary_search(parted.begin(), parted.end(), pair))
        sets.merge(i, k);
    }
  }
  std::vector<std::vector<std::uint32_t>> parts(elements.size());
  for (std::uint32_t i = 0; i < elements.size(); ++i) parts[sets.root(i)].push_back(elements[i]);
  std::erase_if(parts, [](const auto& part) { return part.empty(); });
  return parts;
}

/// Appends what makes one particle of each part of a particle's elements. The part of the largest weight
/// keeps the particle, of equals the first.
template <std::size_t N>
void append_splits(const ElementMesh<N>& mesh, std::uint32_t particle,
                   std::vector<std::vector<std::uint32_t>> parts, std::vector<PointSplit>& splits) {
  if (parts.size() < 2) return;
  std::vector<double> weights;
  double all = 0;
  for (const auto& part : parts) {
    double weight = 0;
    for (const std::uint32_t element : part) weight += static_cast<double>(mesh.weight[element]);
    weights.push_back(weight);
    all += weight;
  }
  const auto kept = std::max_element(weights.begin(), weights.end()) - weights.begin();
  double left = all;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i == static_cast<std::size_t>(kept) || !(weights[i] > kLeastShare * all)) continue;
    splits.push_back({.particle = particle, .moved = std::move(parts[i]), .share = weights[i] / left});
    left -= weights[i];
  }
}

/// Lists the splits of the particles of the pairs in `among`, when all pairs in `parted` part. Both are
/// sorted.
template <std::size_t N>
std::vector<PointSplit> find_splits(const ElementMesh<N>& mesh, std::span<const ElementPair> among,
                                    std::span<const ElementPair> parted) {
  std::vector<std::uint32_t> particles;
  for (const auto& [a, b] : among) {
    for (const std::uint32_t p : mesh.corners[a]) {
      if (mesh.has(b, p)) particles.push_back(p);
    }
  }
  base::sort_unique(particles);
  std::vector<PointSplit> splits;
  for (const std::uint32_t p : particles) append_splits(mesh, p, parts_at(mesh, p, parted), splits);
  return splits;
}

/// The corners of elements after splits. The particle of split i is the i-th behind the object's.
template <std::size_t N>
std::vector<std::array<std::uint32_t, N>> corners_after(const ElementMesh<N>& mesh, state::Rows particles,
                                                        std::span<const PointSplit> splits) {
  std::vector<std::array<std::uint32_t, N>> after = mesh.corners;
  for (std::uint32_t i = 0; i < splits.size(); ++i) {
    for (const std::uint32_t element : splits[i].moved) {
      auto& corners = after[element];
      *std::find(corners.begin(), corners.end(), splits[i].particle) = particles.end() + i;
    }
  }
  return after;
}

/// The corner that an element has after splits in place of one that it had before.
template <std::size_t N>
std::uint32_t corner_after(const ElementMesh<N>& mesh, std::span<const std::array<std::uint32_t, N>> after,
                           std::uint32_t element, std::uint32_t particle) {
  const auto& before = mesh.corners[element];
  const auto at = std::find(before.begin(), before.end(), particle) - before.begin();
  return after[element][static_cast<std::size_t>(at)];
}

/// Appends a particle for each split to the object, and shares out what the split ones had: mass, charge,
/// drag and force, so that both sums are the same to the bit. Places and velocities are equal. Numbers of
/// particles behind the object rise wherever they are stored.
void append_split_particles(std::uint32_t object, std::span<const PointSplit> splits, state::Tables& tables);

/// How far particles are moved into their elements where they have parted in a surface that touches itself,
/// as a share of the way to their middle: nothing keeps surfaces that lie on each other from crossing, so
/// that the sides of a crack must not. Smaller: rounding of positions leaves no gap. Larger: a form at rest
/// that is disturbed, and energy of cloths (solids keep their strain). Chosen by hand; with none a cut sheet
/// on a ball had 9 crossings.
inline constexpr double kGapOfCracks = 1e-3;

/// Moves the particles of splits apart that lie on each other, but those that are held.
template <std::size_t N>
void draw_apart(std::span<const std::array<std::uint32_t, N>> after, const ElementMesh<N>& mesh,
                std::span<const PointSplit> splits, std::uint32_t first_added, state::Tables& t) {
  struct Move {
    std::uint32_t particle;
    Vec3 place;
  };
  std::vector<Move> moves;
  const auto list = [&](std::uint32_t before, std::uint32_t particle) {
    DVec3 sum;
    double count = 0;
    for (const std::uint32_t e : mesh.incidence.of(before)) {
      if (corner_after(mesh, after, e, before) != particle) continue;
      for (const std::uint32_t p : after[e]) sum += vector_cast<double>(t.particles.position[p].x);
      count += static_cast<double>(N);
    }
    if (!(count > 0) || !(t.particles.velocity[particle].inverse_mass > Real(0))) return;
    const DVec3 x = vector_cast<double>(t.particles.position[particle].x);
    moves.push_back({particle, vector_cast<Real>(x + kGapOfCracks * ((1 / count) * sum - x))});
  };
  for (std::uint32_t i = 0; i < splits.size(); ++i) {
    list(splits[i].particle, first_added + i);
    if (i == 0 || splits[i - 1].particle != splits[i].particle) list(splits[i].particle, splits[i].particle);
  }
  for (const Move& move : moves) t.particles.position[move.particle].x = move.place;
}

/// Of the elements that had all of some particles, finds the first that has kept most of its own; nothing if
/// there is none.
template <std::size_t N>
std::optional<std::uint32_t> find_least_changed(const ElementMesh<N>& mesh,
                                                std::span<const std::array<std::uint32_t, N>> after,
                                                std::span<const std::uint32_t> particles) {
  std::optional<std::uint32_t> best;
  std::size_t least = N + 1;
  for (const std::uint32_t e : mesh.incidence.of(particles.front())) {
    if (!std::all_of(particles.begin(), particles.end(), [&](std::uint32_t p) { return mesh.has(e, p); }))
      continue;
    std::size_t changed = 0;
    for (std::size_t k = 0; k < N; ++k) changed += mesh.corners[e][k] != after[e][k] ? 1 : 0;
    if (changed >= least) continue;
    least = changed;
    best = e;
  }
  return best;
}

/// Gives the place of a hook between several particles those of an element that had them all. A place at one
/// particle stays with it.
template <std::size_t N>
void part_place(const ElementMesh<N>& mesh, std::span<const std::array<std::uint32_t, N>> after,
                state::HookPlace& place) {
  if (place.particle_count < 2) return;
  const std::span particles = std::span(place.particle).first(place.particle_count);
  const std::optional<std::uint32_t> element = find_least_changed<N>(mesh, after, particles);
  if (!element) return;
  for (std::uint32_t& p : particles) p = corner_after(mesh, after, *element, p);
}

/// Lets hooks at an object follow its elements.
template <std::size_t N>
void part_hooks(std::uint32_t object, const ElementMesh<N>& mesh,
                std::span<const std::array<std::uint32_t, N>> after, state::Tables& t) {
  for (state::Hook& hook : t.hooks) {
    for (state::HookPlace* end : {&hook.a, &hook.b}) {
      if (end->object == object) part_place(mesh, after, *end);
    }
  }
  ++t.hook_revision;
}

/// Lets named places between several points of an object follow its elements likewise, in the maker's order;
/// `index` is that of each row, added ones too.
template <std::size_t N>
void part_places(const ElementMesh<N>& mesh, std::span<const std::array<std::uint32_t, N>> after,
                 std::span<const std::uint32_t> index, const state::Tables& t, state::Deformable& object) {
  if (!object.connection_points) return;
  auto places = std::make_shared<state::NamedPlaces>(*object.connection_points);
  const std::uint32_t first = object.particles.first;
  for (state::NamedPlace& place : *places) {
    std::vector<std::uint32_t> rows;
    for (std::size_t k = 0; k < 4 && place.weights[k] != Real(0); ++k)
      rows.push_back(first + t.particles.row_of[first + place.points[k]]);
    if (rows.size() < 2) continue;
    const std::optional<std::uint32_t> e = find_least_changed<N>(mesh, after, rows);
    for (std::size_t k = 0; e && k < rows.size(); ++k)
      place.points[k] = index[corner_after(mesh, after, *e, rows[k]) - first];
  }
  object.connection_points = std::move(places);
}

/// Keeps the pairs that are neighbors by their corners after splits.
template <std::size_t N>
std::vector<ElementPair> still_joined(std::span<const ElementPair> pairs,
                                      std::span<const std::array<std::uint32_t, N>> after) {
  std::vector<ElementPair> joined;
  for (const ElementPair& pair : pairs) {
    std::size_t common = 0;
    for (const std::uint32_t p : after[pair[0]])
      common += std::find(after[pair[1]].begin(), after[pair[1]].end(), p) != after[pair[1]].end() ? 1 : 0;
    if (common + 1 == N) joined.push_back(pair);
  }
  return joined;
}

/// Counts the particles that split and that a pin or a hook holds.
[[nodiscard]] std::uint32_t count_held(const state::Tables& tables, std::span<const PointSplit> splits);

/// Index of each row of an object in the order of the maker.
[[nodiscard]] std::vector<std::uint32_t> indices_of(const state::Tables& tables,
                                                    const state::Deformable& object);

/// Inserts copies of rows, which are before `at`, there.
template <class Table>
void insert_copies(Table& table, std::span<const std::uint32_t> from, std::uint32_t at) {
  if (from.empty()) return;
  Table::for_each_column(table, [&](auto& column) {
    column.insert(column.begin() + at, from.size(), column[from.front()]);
    for (std::size_t i = 0; i < from.size(); ++i) column[at + i] = column[from[i]];
  });
}

/// Erases rows, in ascending order.
template <class Table>
void erase_rows(Table& table, std::span<const std::uint32_t> rows) {
  if (rows.empty()) return;
  Table::for_each_column(table, [&](auto& column) {
    auto to = column.begin() + rows.front();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto end = i + 1 < rows.size() ? column.begin() + rows[i + 1] : column.end();
      to = std::move(column.begin() + rows[i] + 1, end, to);
    }
    column.erase(to, column.end());
  });
}

/// Appends copies of an object's rows to it, then erases others of its rows, both in ascending order. Rows of
/// later objects move.
template <class Table>
void change_rows(std::uint32_t object, state::Rows state::Deformable::*rows, Table& table,
                 std::span<const std::uint32_t> copied, std::span<const std::uint32_t> gone,
                 state::Tables& t) {
  insert_copies(table, copied, (t.objects[object].*rows).end());
  erase_rows(table, gone);
  const auto added = static_cast<std::uint32_t>(copied.size());
  const auto lost = static_cast<std::uint32_t>(gone.size());
  (t.objects[object].*rows).count += added - lost;
  for (std::size_t i = object + 1; i < t.objects.size(); ++i) (t.objects[i].*rows).first += added - lost;
}

}  // namespace hooke::build
