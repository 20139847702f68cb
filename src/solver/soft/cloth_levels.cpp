#include "solver/soft/cloth_levels.h"

#include "base/assert.h"
#include "base/counting_sort.h"
#include "solver/linear/coloring.h"
#include "solver/soft/particle_kernels.h"
#include "solver/soft/soft_tuning.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hooke::solver {

namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;

constexpr std::uint32_t kNone = 0xFFFFFFFF;
constexpr std::size_t kCellSize = 4;
constexpr std::size_t kMostOfCell = 6;  ///< With points that found no cell.

/// What joins the points of a level: rows that hold lengths, and with rows across cells all neighbors.
struct Graph {
  std::uint32_t count = 0;
  std::vector<Pair> rows = {};   ///< Each once, ascending, the smaller point first.
  std::vector<Pair> links = {};  ///< The same, with neighbors across cells.
};

void sort_pairs(std::vector<Pair>& pairs) {
  for (Pair& pair : pairs) {
    if (pair.first > pair.second) std::swap(pair.first, pair.second);
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

Graph graph_of(const state::Deformable& cloth, const state::Springs& springs) {
  Graph graph{.count = cloth.particles.count};
  for (std::uint32_t row = cloth.springs.first; row < cloth.springs.end(); ++row) {
    const state::SpringClass kind = springs.kind[row];
    if (kind != state::SpringClass::kStretch && kind != state::SpringClass::kShear) continue;
    const Pair pair = {springs.particle_a[row] - cloth.particles.first,
                       springs.particle_b[row] - cloth.particles.first};
    graph.links.push_back(pair);
    if (kind == state::SpringClass::kStretch) graph.rows.push_back(pair);
  }
  sort_pairs(graph.rows);
  sort_pairs(graph.links);
  return graph;
}

/// Puts points together to cells of about four, each with the point that has most neighbors in it already:
/// on a grid these are squares.
class Cells {
 public:
  explicit Cells(const Graph& graph)
      : count_(graph.count), links_(graph.count, 0), cell_(graph.count, kNone) {
    first_.assign(count_ + 1, 0);
    for (const auto& [a, b] : graph.links) {
      ++first_[a + 1];
      ++first_[b + 1];
    }
    for (std::uint32_t i = 0; i < count_; ++i) first_[i + 1] += first_[i];
    neighbors_.resize(first_.back());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (const auto& [a, b] : graph.links) {
      neighbors_[next[a]++] = b;
      neighbors_[next[b]++] = a;
    }
  }

  void make() {
    for (std::uint32_t seed = 0; seed < count_; ++seed) {
      if (cell_[seed] == kNone) grow(seed);
    }
  }

  [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(size_.size()); }
  [[nodiscard]] const std::vector<std::uint32_t>& of_point() const { return cell_; }

 private:
  [[nodiscard]] std::span<const std::uint32_t> neighbors(std::uint32_t point) const {
    return {neighbors_.data() + first_[point], first_[point + 1] - first_[point]};
  }

  void grow(std::uint32_t seed) {
    const std::uint32_t cell = count();
    size_.push_back(1);
    near_.clear();
    cell_[seed] = cell;
    std::uint32_t last = seed;
    while (size_.back() < kCellSize) {
      for (const std::uint32_t neighbor : neighbors(last)) {
        if (cell_[neighbor] == kNone && links_[neighbor]++ == 0) near_.push_back(neighbor);
      }
      last = kNone;
      for (const std::uint32_t point : near_) {
        if (cell_[point] == kNone && (last == kNone || links_[point] > links_[last])) last = point;
      }
      if (last == kNone) break;
      cell_[last] = cell;
      ++size_.back();
    }
    for (const std::uint32_t point : near_) links_[point] = 0;
    if (size_.back() == 1) join_neighbor(seed);
  }

  /// Gives a point that is alone to a cell beside it, if one has room.
  void join_neighbor(std::uint32_t point) {
    std::uint32_t best = kNone;
    for (const std::uint32_t neighbor : neighbors(point)) {
      const std::uint32_t cell = cell_[neighbor];
      if (cell == kNone || size_[cell] >= kMostOfCell) continue;
      if (best == kNone || size_[cell] < size_[best]) best = cell;
    }
    if (best == kNone) return;
    size_.pop_back();
    cell_[point] = best;
    ++size_[best];
  }

  std::uint32_t count_;
  std::vector<std::uint32_t> first_;  ///< Where the neighbors of a point begin.
  std::vector<std::uint32_t> neighbors_;
  std::vector<std::uint32_t> links_;  ///< By point: its neighbors in the cell that grows.
  std::vector<std::uint32_t> cell_;   ///< By point.
  std::vector<std::uint32_t> near_;   ///< Points beside that cell.
  std::vector<std::size_t> size_;     ///< By cell.
};

/// The graph of cells: what joined their points joins them.
Graph coarsen(const Graph& fine, const Cells& cells) {
  Graph graph{.count = cells.count()};
  const auto carry = [&](const std::vector<Pair>& from, std::vector<Pair>& to) {
    for (const auto& [a, b] : from) {
      const Pair pair = {cells.of_point()[a], cells.of_point()[b]};
      if (pair.first != pair.second) to.push_back(pair);
    }
    sort_pairs(to);
  };
  carry(fine.rows, graph.rows);
  carry(fine.links, graph.links);
  return graph;
}

/// Makes blocks of the rows of a level, color by color.
void build_rows(const Graph& graph, ClothLevel& level) {
  std::vector<std::uint64_t> used(graph.count, 0);
  std::vector<std::pair<int, Pair>> colored;
  int lone_color = 64;
  for (const Pair& row : graph.rows) {
    const std::uint32_t ends[2] = {row.first, row.second};
    int color = take_color(used, ends, 2);
    if (color >= 64) color = lone_color++;
    colored.emplace_back(color, row);
  }
  base::counting_sort(colored, static_cast<std::size_t>(lone_color),
                      [](const auto& row) { return row.first; });
  for (std::size_t i = 0; i < colored.size();) {
    SpringPass pass{.first = static_cast<int>(level.rows.size())};
    const int color = colored[i].first;
    while (i < colored.size() && colored[i].first == color) {
      SpringBlock block{};
      const std::size_t first = i;
      for (int lane = 0; lane < kLanes; ++lane) {
        const Pair& ends = colored[i < colored.size() && colored[i].first == color ? i : i - 1].second;
        if (i < colored.size() && colored[i].first == color) ++i;
        block.record_a[lane] = 4 * ends.first;
        block.record_b[lane] = 4 * ends.second;
      }
      pass.last_count = static_cast<int>(i - first);
      level.rows.push_back(block);
    }
    pass.end = static_cast<int>(level.rows.size());
    level.passes.push_back(pass);
  }
}

ClothLevel make_level(const Graph& graph, const Cells& cells) {
  ClothLevel level;
  level.first_member.assign(graph.count + 1, 0);
  for (const std::uint32_t cell : cells.of_point()) ++level.first_member[cell + 1];
  for (std::uint32_t i = 0; i < graph.count; ++i) level.first_member[i + 1] += level.first_member[i];
  level.members.resize(level.first_member.back());
  std::vector<std::uint32_t> next(level.first_member.begin(), level.first_member.end() - 1);
  for (std::uint32_t point = 0; point < cells.of_point().size(); ++point)
    level.members[next[cells.of_point()[point]]++].point = point;
  level.position.resize(graph.count);
  level.velocity.resize(graph.count);
  level.velocity_before.resize(graph.count);
  level.rest.resize(graph.count);
  level.spread.resize(graph.count);
  level.is_new.assign(graph.count, 0);
  build_rows(graph, level);
  return level;
}

/// The points that a level is made of. Of a cloth's own points nothing is new, and none is spread.
struct Points {
  std::span<const state::PositionRecord> position;
  std::span<state::VelocityRecord> velocity;
  std::span<const Vec3> rest;
  const ClothLevel* level = nullptr;
};

Points points_of(ClothLevel& level) {
  return {level.position, level.velocity, level.rest, &level};
}

std::span<CellMember> members_of(ClothLevel& level, std::size_t cell) {
  return {level.members.data() + level.first_member[cell],
          level.first_member[cell + 1] - level.first_member[cell]};
}

/// Finds the weights of a cell's points, its mass, and its place at rest.
void weigh_cell(const Points& fine, std::size_t cell, ClothLevel& level) {
  const std::span<CellMember> members = members_of(level, cell);
  bool is_held = false;
  for (CellMember& member : members) {
    member.inverse_mass = fine.velocity[member.point].inverse_mass;
    is_held = is_held || member.inverse_mass == Real(0);
  }
  Real sum = 0;
  for (CellMember& member : members) {
    const bool counts = is_held == (member.inverse_mass == Real(0));
    member.weight = !counts ? Real(0) : is_held ? Real(1) : Real(1) / member.inverse_mass;
    sum += member.weight;
  }
  Vec3 rest = {};
  for (CellMember& member : members) {
    member.weight /= sum;
    rest += member.weight * fine.rest[member.point];
  }
  std::array<Real, 6> spread = {};
  for (const CellMember& member : members) {
    const Vec3 d = fine.rest[member.point] - rest;
    const Real products[6] = {d.x * d.x, d.y * d.y, d.z * d.z, d.x * d.y, d.y * d.z, d.z * d.x};
    for (std::size_t k = 0; k < 6; ++k) {
      const Real own = fine.level == nullptr ? Real(0) : fine.level->spread[member.point][k];
      spread[k] += member.weight * (own + products[k]);
    }
  }
  level.velocity[cell].inverse_mass = is_held ? Real(0) : Real(1) / sum;
  level.rest[cell] = rest;
  level.spread[cell] = spread;
  level.is_new[cell] = 1;
  level.any_new = true;
}

bool has_new_member(const Points& fine, std::span<const CellMember> members) {
  const bool look_below = fine.level != nullptr && fine.level->any_new;
  return std::any_of(members.begin(), members.end(), [&](const CellMember& member) {
    return fine.velocity[member.point].inverse_mass != member.inverse_mass ||
           (look_below && fine.level->is_new[member.point] != 0);
  });
}

/// Gives the cells of a level the means of their points.
void average(const Points& fine, ClothLevel& level) {
  if (level.any_new) std::fill(level.is_new.begin(), level.is_new.end(), std::uint8_t{0});
  level.any_new = false;
  for (std::size_t cell = 0; cell < level.position.size(); ++cell) {
    const std::span<const CellMember> members = members_of(level, cell);
    if (has_new_member(fine, members)) weigh_cell(fine, cell, level);
    Vec3 x = {};
    Vec3 v = {};
    for (const CellMember& member : members) {
      x += member.weight * fine.position[member.point].x;
      v += member.weight * fine.velocity[member.point].v;
    }
    level.position[cell].x = x;
    level.velocity[cell].v = v;
    level.velocity_before[cell] = v;
  }
}

/// The deviation of a cell's points across a direction.
Real deviation_across(const std::array<Real, 6>& s, Vec3 n) {
  const Real along = n.x * n.x * s[0] + n.y * n.y * s[1] + n.z * n.z * s[2] +
                     Real(2) * (n.x * n.y * s[3] + n.y * n.z * s[4] + n.z * n.x * s[5]);
  return std::sqrt(std::max(s[0] + s[1] + s[2] - along, Real(0)));
}

/// Finds the largest length of the rows at cells that are new.
void bound_rows(Real extension, ClothLevel& level) {
  for (SpringBlock& block : level.rows) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const std::uint32_t a = block.record_a[lane] / 4;
      const std::uint32_t b = block.record_b[lane] / 4;
      if ((level.is_new[a] | level.is_new[b]) == 0) continue;
      const Vec3 way = level.rest[a] - level.rest[b];
      const Real d = length(way);
      // Cells that have the same place at rest bound nothing.
      Real most = std::numeric_limits<Real>::max();
      if (d > Real(0)) {
        const Vec3 n = (Real(1) / d) * way;
        const Real s = deviation_across(level.spread[a], n) - deviation_across(level.spread[b], n);
        most = (Real(1) + extension) * (d + s * s / (Real(2) * d));
      }
      block.rest_length[lane] = most;
    }
  }
}

void solve_rows(const SpringMaterial& material, ClothLevel& level) {
  for (const SpringPass& pass : level.passes) {
    const wide::SpringRun run = {
        .blocks = {level.rows.data() + pass.first, static_cast<std::size_t>(pass.end - pass.first)},
        .last_count = pass.last_count};
    wide::solve_springs(run, material, level.position.data(), level.velocity.data());
  }
}

/// Changes the velocities of the points as those of their cells have changed. A cell with a held point never
/// does.
void pass_down(const ClothLevel& level, std::span<state::VelocityRecord> velocity) {
  for (std::size_t cell = 0; cell < level.position.size(); ++cell) {
    const Vec3 change = level.velocity[cell].v - level.velocity_before[cell];
    if (change == Vec3{}) continue;
    for (std::uint32_t m = level.first_member[cell]; m < level.first_member[cell + 1]; ++m)
      velocity[level.members[m].point].v += change;
  }
}

}  // namespace

ClothLevels build_cloth_levels(const state::Deformable& cloth, Real extension, const state::Tables& tables) {
  HOOKE_ASSERT(cloth.surface.rest_points != nullptr);
  ClothLevels out;
  out.extension = extension;
  Graph graph = graph_of(cloth, tables.springs);
  while (!graph.rows.empty()) {
    Cells cells(graph);
    cells.make();
    if (cells.count() == graph.count) break;
    graph = coarsen(graph, cells);
    if (graph.rows.empty()) break;
    out.levels.push_back(make_level(graph, cells));
  }
  return out;
}

void prepare_cloth_levels(ClothLevels& cloth, Real h) {
  cloth.material = {
      .one_sided = true, .bias = Real(1) / h, .recovery = h * kTetherRecoverySpeed, .recovery_time = h};
}

void solve_cloth_levels(const state::Deformable& object, state::Particles& particles, ClothLevels& cloth) {
  const auto first = particles.position.begin() + object.particles.first;
  const std::span<state::VelocityRecord> velocity = {particles.velocity.data() + object.particles.first,
                                                     object.particles.count};
  Points fine = {{first, object.particles.count}, velocity, *object.surface.rest_points};
  for (ClothLevel& level : cloth.levels) {
    average(fine, level);
    if (level.any_new) bound_rows(cloth.extension, level);
    fine = points_of(level);
  }
  for (std::size_t k = cloth.levels.size(); k-- > 0;) {
    solve_rows(cloth.material, cloth.levels[k]);
    pass_down(cloth.levels[k], k > 0 ? std::span(cloth.levels[k - 1].velocity) : velocity);
  }
}

}  // namespace hooke::solver
