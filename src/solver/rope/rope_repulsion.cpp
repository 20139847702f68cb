#include "solver/rope/rope_repulsion.h"

#include "base/assert.h"
#include "elements/repulsion.h"
#include "solver/rope/rope_tuning.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hooke::solver {

namespace {

constexpr int kPointGrain = 256;

using Point = Repulsion::Point;
using Pair = Repulsion::Pair;

/// Lists the points of all ropes with a repulsion.
void gather(const state::Tables& t, Repulsion& memory) {
  memory.points.clear();
  memory.places.clear();
  for (std::uint32_t o = 0; o < t.objects.size(); ++o) {
    const state::Deformable& rope = t.objects[o];
    if (!(rope.repulsion_strength > Real(0))) continue;
    Point point = {
        .object = o, .root_strength = std::sqrt(rope.repulsion_strength), .range = rope.repulsion_range};
    for (std::uint32_t i = 0; i < rope.particles.count; ++i) {
      point.row = rope.particles.first + i;
      point.v = t.particles.velocity[point.row].v;
      point.inverse_mass = t.particles.velocity[point.row].inverse_mass;
      memory.points.push_back(point);
      memory.places.push_back(rope.origin + vector_cast<double>(t.particles.position[point.row].x));
      if (i < rope.segments.count) point.arc += t.segments.rest_length[rope.segments.first + i];
    }
  }
}

double largest_range(const std::vector<Point>& points) {
  Real range = Real(0);
  for (const Point& point : points) range = std::max(range, point.range);
  return static_cast<double>(range);
}

bool are_adjacent(const Point& a, const Point& b) {
  constexpr Real kTurn = std::numbers::pi_v<Real> / 2;
  return a.object == b.object && std::abs(a.arc - b.arc) < kTurn * a.range;
}

/// Whether the notes are still complete: no point has moved so far against the others that two points
/// without a note can be near.
bool are_known(const Repulsion& memory) {
  if (memory.found_at.size() != memory.places.size()) return false;
  DVec3 drift;
  for (std::size_t i = 0; i < memory.places.size(); ++i) drift += memory.places[i] - memory.found_at[i];
  drift = (1 / static_cast<double>(memory.places.size())) * drift;
  double largest_square = 0;
  for (std::size_t i = 0; i < memory.places.size(); ++i)
    largest_square = std::max(largest_square, length_squared(memory.places[i] - memory.found_at[i] - drift));
  return 2 * std::sqrt(largest_square) < (kRepulsionNoted - kRepulsionNear) * largest_range(memory.points);
}

/// Notes what may push each point in `range`. The notes hold until a point has moved too far.
void find_others(parallel::Range range, double reach, const Repulsion& memory, Repulsion::Part& part) {
  part.end.clear();
  part.others.clear();
  for (auto i = static_cast<std::uint32_t>(range.begin); i < static_cast<std::uint32_t>(range.end); ++i) {
    const auto first = static_cast<std::ptrdiff_t>(part.others.size());
    memory.grid.for_each_near(memory.places[i], [&](std::uint32_t j) {
      const bool is_near = length_squared(memory.places[i] - memory.places[j]) < reach * reach;
      if (is_near && j != i && !are_adjacent(memory.points[i], memory.points[j])) part.others.push_back(j);
    });
    std::sort(part.others.begin() + first, part.others.end());
    part.end.push_back(static_cast<std::uint32_t>(part.others.size()));
  }
}

/// Calls `visit(i, j, offset)` for each point i in `range` and each j noted for it, if either can move. The
/// offset goes from j to i.
template <class Visit>
void for_each_other(parallel::Range range, const Repulsion& memory, const Repulsion::Part& part,
                    Visit&& visit) {
  HOOKE_ASSERT(part.end.size() == static_cast<std::size_t>(range.count()));
  std::uint32_t k = 0;
  for (auto i = static_cast<std::uint32_t>(range.begin); i < static_cast<std::uint32_t>(range.end); ++i) {
    const std::uint32_t end = part.end[i - static_cast<std::uint32_t>(range.begin)];
    for (; k < end; ++k) {
      const std::uint32_t j = part.others[k];
      if (!(memory.points[i].inverse_mass + memory.points[j].inverse_mass > Real(0))) continue;
      visit(i, j, memory.places[i] - memory.places[j]);
    }
  }
}

/// Lists the pairs that push each point in `range`.
void find_pairs(parallel::Range range, Real h, Repulsion& memory, Repulsion::Part& part) {
  part.pairs.clear();
  for_each_other(range, memory, part, [&](std::uint32_t i, std::uint32_t j, DVec3 offset) {
    Point& a = memory.points[i];
    const Point& b = memory.points[j];
    const Real r = (a.range + b.range) / 2;
    const double near = kRepulsionNear * static_cast<double>(r);
    const double square = length_squared(offset);
    if (!(square < near * near)) return;
    const double distance = std::sqrt(square);
    // Two points at the same place move apart along x.
    const DVec3 normal = distance > 0 ? (1 / distance) * offset : DVec3{i < j ? -1.0 : 1.0, 0, 0};
    Pair pair = {.point = i, .other = j, .normal = vector_cast<Real>(normal), .range = r};
    pair.strength = a.root_strength * b.root_strength;
    pair.free = static_cast<Real>(distance) + h * dot(a.v - b.v, pair.normal);
    if (!(pair.free < r)) return;
    a.neighbors += Real(1);
    part.pairs.push_back(pair);
  });
}

void push(const Repulsion& memory, const Repulsion::Part& part, Real h, state::Particles& particles) {
  for (const Pair& pair : part.pairs) {
    const Point& a = memory.points[pair.point];
    const Point& b = memory.points[pair.other];
    const Real w = a.inverse_mass * a.neighbors + b.inverse_mass * b.neighbors;
    const Real y = elements::repelled_distance(pair.free, h * h * pair.strength * w, pair.range);
    const Real impulse = h * elements::repulsion_force(pair.strength, pair.range, y);
    particles.velocity[a.row].v += (a.inverse_mass * impulse) * pair.normal;
  }
}

}  // namespace

void repel(parallel::ThreadPool& pool, Real h, Repulsion& memory, state::Tables& tables) {
  gather(tables, memory);
  if (memory.points.empty()) return;
  const bool knows = memory.revision == tables.revision &&
                     memory.parts.size() == static_cast<std::size_t>(pool.workers()) && are_known(memory);
  const double reach = kRepulsionNoted * largest_range(memory.points);
  if (!knows) {
    memory.grid.build(memory.places, reach);
    memory.found_at = memory.places;
    memory.revision = tables.revision;
    memory.parts.resize(static_cast<std::size_t>(pool.workers()));
  }
  const auto for_parts = [&](auto&& work) {
    parallel::for_ranges(
        pool, static_cast<int>(memory.points.size()), kPointGrain,
        [&](parallel::Range range, int part) { work(range, memory.parts[static_cast<std::size_t>(part)]); });
  };
  for_parts([&](parallel::Range range, Repulsion::Part& part) {
    if (!knows) find_others(range, reach, memory, part);
    find_pairs(range, h, memory, part);
  });
  for_parts([&](parallel::Range, const Repulsion::Part& part) { push(memory, part, h, tables.particles); });
}

double repulsion_energy(const state::Tables& tables) {
  Repulsion memory;
  gather(tables, memory);
  if (memory.points.empty()) return 0;
  const double reach = largest_range(memory.points);
  const parallel::Range all = {0, static_cast<int>(memory.points.size())};
  Repulsion::Part part;
  memory.grid.build(memory.places, reach);
  find_others(all, reach, memory, part);
  double energy = 0;
  for_each_other(all, memory, part, [&](std::uint32_t i, std::uint32_t j, DVec3 offset) {
    if (j < i) return;
    const Point& a = memory.points[i];
    const Point& b = memory.points[j];
    const auto strength = static_cast<double>(a.root_strength * b.root_strength);
    const double range = static_cast<double>(a.range + b.range) / 2;
    // The energy of two points at the same place is infinite.
    energy += elements::repulsion_energy(strength, range, std::max(length(offset), 1e-3 * range));
  });
  return energy;
}

}  // namespace hooke::solver
