#include "solver/cloth/cloth_grids.h"

#include "base/assert.h"
#include "solver/cloth/cloth_tuning.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hooke::solver {

namespace {

using state::SpringClass;

constexpr Real kNoLimit = Real(1e30);
constexpr std::size_t kCellSize = 4;     ///< Points of a cell.
constexpr std::size_t kMostOfCell = 6;   ///< With points that found no cell.
constexpr std::uint32_t kCoarsest = 16;  ///< Points of a grid that is not made coarser.

/// A spring with its limit, between two points.
struct Link {
  std::uint32_t a = 0, b = 0;
  Real rest_length = Real(1);
  Real limit = kNoLimit;
  ClothRowLaw law = {};
};

/// Springs and limits by their ends: a limit joins the spring with the same ends, if there is one.
std::vector<Link> list_links(const state::Deformable& object, const state::Springs& springs) {
  std::vector<Link> links;
  for (std::uint32_t row = object.springs.first; row < object.springs.end(); ++row) {
    const SpringClass kind = springs.kind[row];
    if (kind != SpringClass::kStretch && kind != SpringClass::kShear && kind != SpringClass::kLimit) continue;
    const std::uint32_t a = springs.particle_a[row] - object.particles.first;
    const std::uint32_t b = springs.particle_b[row] - object.particles.first;
    Link link = {.a = std::min(a, b), .b = std::max(a, b)};
    if (kind == SpringClass::kLimit) {
      link.limit = springs.rest_length[row];
      link.law.has_limit = true;
    } else {
      link.rest_length = springs.rest_length[row];
      link.law.stiffness = springs.stiffness[row];
      link.law.damping = springs.damping[row];
    }
    links.push_back(link);
  }
  std::stable_sort(links.begin(), links.end(),
                   [](const Link& x, const Link& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
  std::size_t kept = 0;
  for (const Link& link : links) {
    const bool joins = link.law.has_limit && kept > 0 && links[kept - 1].a == link.a &&
                       links[kept - 1].b == link.b && !links[kept - 1].law.has_limit;
    if (joins) {
      links[kept - 1].limit = link.limit;
      links[kept - 1].law.has_limit = true;
    } else {
      links[kept++] = link;
    }
  }
  links.resize(kept);
  return links;
}

/// Where the neighbors of each point go: the lane of entry k of point i is 16 (first_lane[i / 16] + k) + i
/// % 16.
std::uint32_t lane_of(const ClothGrid& grid, std::uint32_t point, std::uint32_t entry) {
  return kLanes * (grid.first_lane[point / kLanes] + entry) + point % kLanes;
}

/// Makes room for `degree` neighbors of each point.
void make_room(std::span<const std::uint32_t> degree, ClothGrid& grid) {
  grid.count = static_cast<std::uint32_t>(degree.size());
  const std::size_t blocks = (degree.size() + kLanes - 1) / kLanes;
  grid.first_lane.assign(blocks + 1, 0);
  for (std::size_t i = 0; i < degree.size(); ++i) {
    std::uint32_t& most = grid.first_lane[i / kLanes + 1];
    most = std::max(most, degree[i]);
  }
  for (std::size_t b = 0; b < blocks; ++b) grid.first_lane[b + 1] += grid.first_lane[b];
  NeighborLanes none = {};
  grid.neighbors.assign(grid.first_lane.back(), none);
  for (std::size_t b = 0; b < blocks; ++b) {
    for (std::uint32_t e = grid.first_lane[b]; e < grid.first_lane[b + 1]; ++e) {
      for (std::uint32_t lane = 0; lane < kLanes; ++lane)
        grid.neighbors[e].record[lane] =
            4 * std::min(static_cast<std::uint32_t>(b) * kLanes + lane, grid.count - 1);
    }
  }
  grid.mass.assign(blocks, {});
  grid.inverse.assign(blocks, {});
  for (auto* vectors : {&grid.residual, &grid.velocity, &grid.scratch})
    vectors->assign(blocks * kLanes + 1, {});
}

std::uint32_t ground_of(const ClothGrid& grid) {
  return static_cast<std::uint32_t>(grid.mass.size()) * kLanes;
}

/// Calls visit(neighbor, lane) for each neighbor of a point.
template <class Visit>
void for_neighbors(const ClothGrid& grid, std::uint32_t point, Visit visit) {
  const std::uint32_t block = point / kLanes;
  for (std::uint32_t e = grid.first_lane[block]; e < grid.first_lane[block + 1]; ++e) {
    const std::uint32_t neighbor = grid.neighbors[e].record[point % kLanes] / 4;
    if (neighbor != point) visit(neighbor, e * kLanes + point % kLanes);
  }
}

/// Puts points together to cells of up to four, each with the points that have most neighbors in it already:
/// on a grid these are squares.
class Cells {
 public:
  explicit Cells(ClothGrid& grid) : grid_(grid), links_(grid.count, 0) {
    grid_.cell.assign(grid.count, ClothGrid::kNone);
  }

  std::uint32_t make(std::span<const std::uint32_t> order, std::span<const std::uint8_t> held) {
    for (const std::uint32_t seed : order) {
      if (!is_free(seed, held)) continue;
      grow(seed, held);
    }
    list_members();
    return static_cast<std::uint32_t>(size_.size());
  }

 private:
  [[nodiscard]] bool is_free(std::uint32_t point, std::span<const std::uint8_t> held) const {
    return point < grid_.count && grid_.cell[point] == ClothGrid::kNone && (held.empty() || held[point] == 0);
  }

  void grow(std::uint32_t seed, std::span<const std::uint8_t> held) {
    const auto cell = static_cast<std::uint32_t>(size_.size());
    size_.push_back(1);
    near_.clear();
    grid_.cell[seed] = cell;
    std::uint32_t last = seed;
    while (size_.back() < kCellSize) {
      for_neighbors(grid_, last, [&](std::uint32_t neighbor, std::uint32_t /*lane*/) {
        if (!is_free(neighbor, held)) return;
        if (links_[neighbor]++ == 0) near_.push_back(neighbor);
      });
      std::uint32_t best = ClothGrid::kNone;
      for (const std::uint32_t point : near_) {
        if (grid_.cell[point] == ClothGrid::kNone &&
            (best == ClothGrid::kNone || links_[point] > links_[best]))
          best = point;
      }
      if (best == ClothGrid::kNone) break;
      grid_.cell[best] = cell;
      ++size_.back();
      last = best;
    }
    for (const std::uint32_t point : near_) links_[point] = 0;
    if (size_.back() == 1) join_neighbor(seed);
  }

  /// Gives a point that is alone to a cell beside it, if one has room.
  void join_neighbor(std::uint32_t point) {
    std::uint32_t best = ClothGrid::kNone;
    for_neighbors(grid_, point, [&](std::uint32_t neighbor, std::uint32_t /*lane*/) {
      if (neighbor >= grid_.count) return;
      const std::uint32_t cell = grid_.cell[neighbor];
      if (cell == ClothGrid::kNone || size_[cell] >= kMostOfCell) return;
      if (best == ClothGrid::kNone || size_[cell] < size_[best]) best = cell;
    });
    if (best == ClothGrid::kNone) return;
    size_.pop_back();
    grid_.cell[point] = best;
    ++size_[best];
  }

  void list_members() {
    grid_.first_member.assign(size_.size() + 1, 0);
    for (std::size_t i = 0; i < size_.size(); ++i)
      grid_.first_member[i + 1] = grid_.first_member[i] + static_cast<std::uint32_t>(size_[i]);
    grid_.member.resize(grid_.first_member.back());
    std::vector<std::uint32_t> next(grid_.first_member.begin(), grid_.first_member.end());
    for (std::uint32_t point = 0; point < grid_.count; ++point) {
      if (grid_.cell[point] != ClothGrid::kNone) grid_.member[next[grid_.cell[point]]++] = point;
    }
  }

  ClothGrid& grid_;
  std::vector<std::uint32_t> links_;  ///< By point: its neighbors in the cell that grows.
  std::vector<std::uint32_t> near_;   ///< Points beside that cell.
  std::vector<std::size_t> size_;     ///< By cell.
};

/// A neighbor of a cell, with a lane of the finer grid from which part of the row between them comes.
struct CoarseLink {
  std::uint32_t neighbor, lane;
};

/// Makes the grid of the cells of `finer`.
void build_coarser(const ClothGrid& finer, std::uint32_t cells, ClothGrid& grid) {
  std::vector<std::vector<CoarseLink>> links(cells);
  std::vector<std::uint32_t> degree(cells, 0);
  for (std::uint32_t cell = 0; cell < cells; ++cell) {
    for (std::uint32_t m = finer.first_member[cell]; m < finer.first_member[cell + 1]; ++m) {
      for_neighbors(finer, finer.member[m], [&](std::uint32_t neighbor, std::uint32_t lane) {
        const std::uint32_t other = neighbor < finer.count ? finer.cell[neighbor] : ClothGrid::kNone;
        if (other != cell) links[cell].push_back({other, lane});
      });
    }
    std::stable_sort(links[cell].begin(), links[cell].end(),
                     [](const CoarseLink& a, const CoarseLink& b) { return a.neighbor < b.neighbor; });
    for (std::size_t i = 0; i < links[cell].size(); ++i)
      degree[cell] += i == 0 || links[cell][i].neighbor != links[cell][i - 1].neighbor ? 1 : 0;
  }
  make_room(degree, grid);
  grid.first_source.assign(grid.neighbors.size() * kLanes + 1, 0);
  for (int pass = 0; pass < 2; ++pass) {
    for (std::uint32_t cell = 0; cell < cells; ++cell) {
      std::uint32_t entry = 0;
      for (std::size_t i = 0; i < links[cell].size(); ++i) {
        if (i > 0 && links[cell][i].neighbor != links[cell][i - 1].neighbor) ++entry;
        const std::uint32_t lane = lane_of(grid, cell, entry);
        if (pass == 0) {
          const std::uint32_t to = links[cell][i].neighbor;
          grid.neighbors[lane / kLanes].record[lane % kLanes] =
              4 * (to == ClothGrid::kNone ? ground_of(grid) : to);
          ++grid.first_source[lane + 1];
        } else {
          grid.source[grid.first_source[lane + 1]++] = links[cell][i].lane;
        }
      }
    }
    if (pass == 1) break;
    // Each entry begins where the one before ends; the second pass moves it on to its own end.
    std::uint32_t sum = 0;
    for (std::uint32_t& first : grid.first_source) {
      const std::uint32_t own = first;
      first = sum;
      sum += own;
    }
    grid.source.resize(sum);
  }
}

/// Makes coarser grids until few points are left.
void build_coarser_grids(ClothGrids& cloth) {
  cloth.grids.resize(1);
  std::vector<std::uint32_t> order = cloth.order;
  while (cloth.grids.back().count > kCoarsest) {
    ClothGrid& finer = cloth.grids.back();
    const bool is_finest = cloth.grids.size() == 1;
    const std::uint32_t cells = Cells(finer).make(
        order, is_finest ? std::span<const std::uint8_t>(cloth.held) : std::span<const std::uint8_t>());
    if (cells == 0 || 4 * cells > 3 * finer.count) break;
    ClothGrid grid;
    build_coarser(finer, cells, grid);
    cloth.grids.push_back(std::move(grid));
    order.resize(cells);
    for (std::uint32_t i = 0; i < cells; ++i) order[i] = i;
  }
}

void note_pinned(const state::Particles& particles, ClothGrids& cloth) {
  for (std::size_t i = 0; i < cloth.held.size(); ++i)
    cloth.held[i] = particles.velocity[cloth.first_particle + i].inverse_mass > Real(0) ? 0 : 1;
}

bool is_held_as_before(const state::Particles& particles, const ClothGrids& cloth) {
  for (std::size_t i = 0; i < cloth.held.size(); ++i) {
    const bool held = !(particles.velocity[cloth.first_particle + i].inverse_mass > Real(0));
    if (held != (cloth.held[i] != 0)) return false;
  }
  return true;
}

}  // namespace

void build_cloth_grids(const state::Deformable& object, const state::Springs& springs,
                       const state::Particles& particles, ClothGrids& cloth) {
  cloth = {};
  cloth.first_particle = object.particles.first;
  const std::vector<Link> links = list_links(object, springs);
  std::vector<std::uint32_t> degree(object.particles.count, 0);
  double length = 0;
  for (const Link& link : links) {
    ++degree[link.a];
    ++degree[link.b];
    length += static_cast<double>(link.rest_length);
    cloth.has_limits = cloth.has_limits || link.law.has_limit;
  }
  cloth.edge = links.empty() ? Real(1) : static_cast<Real>(length / static_cast<double>(links.size()));
  ClothGrid& grid = cloth.grids.emplace_back();
  make_room(degree, grid);
  RowLanes none = {};
  std::fill(std::begin(none.rest_length), std::end(none.rest_length), Real(1));
  std::fill(std::begin(none.limit), std::end(none.limit), kNoLimit);
  cloth.rows.assign(grid.neighbors.size(), none);
  cloth.laws.assign(grid.neighbors.size() * kLanes, {});
  std::fill(degree.begin(), degree.end(), 0);
  for (const Link& link : links) {
    for (const bool turned : {false, true}) {
      const std::uint32_t point = turned ? link.b : link.a;
      const std::uint32_t lane = lane_of(grid, point, degree[point]++);
      grid.neighbors[lane / kLanes].record[lane % kLanes] = 4 * (turned ? link.a : link.b);
      cloth.rows[lane / kLanes].rest_length[lane % kLanes] = link.rest_length;
      cloth.rows[lane / kLanes].limit[lane % kLanes] = link.limit;
      cloth.laws[lane] = link.law;
    }
  }
  cloth.order.assign(particles.row_of.begin() + object.particles.first,
                     particles.row_of.begin() + object.particles.end());
  cloth.held.assign(object.particles.count, 0);
  note_pinned(particles, cloth);
  build_coarser_grids(cloth);
}

void prepare_cloth_grids(const state::Particles& particles, Real h, ClothGrids& cloth) {
  if (!is_held_as_before(particles, cloth)) {
    note_pinned(particles, cloth);
    build_coarser_grids(cloth);
  }
  const ClothGrid& grid = cloth.finest();
  for (std::uint32_t point = 0; point < grid.count; ++point) {
    const Real w = particles.velocity[cloth.first_particle + point].inverse_mass;
    for_neighbors(grid, point, [&](std::uint32_t neighbor, std::uint32_t lane) {
      const Real both = w + particles.velocity[cloth.first_particle + neighbor].inverse_mass;
      const Real most = both > Real(0) ? kMostRowStiffness / both : Real(0);
      const ClothRowLaw& law = cloth.laws[lane];
      RowLanes& row = cloth.rows[lane / kLanes];
      const std::uint32_t i = lane % kLanes;
      const bool rigid = std::isinf(law.stiffness);
      const Real s = law.damping + h * law.stiffness;
      row.gain[i] = rigid ? most : std::min(h * s, most);
      row.bias[i] = rigid ? Real(1) / h : s > Real(0) ? law.stiffness / s : Real(0);
      row.limit_gain[i] = law.has_limit ? most : Real(0);
    });
  }
}

void take_masses(const state::Particles& particles, std::uint32_t first_particle, ClothGrid& grid) {
  for (std::uint32_t i = 0; i < grid.count; ++i) {
    const Real w = particles.velocity[first_particle + i].inverse_mass;
    grid.mass[i / kLanes].of[i % kLanes] = w > Real(0) ? Real(1) / w : Real(0);
  }
}

void coarsen_rows(const ClothGrid& finer, ClothGrid& grid) {
  for (std::uint32_t cell = 0; cell < grid.count; ++cell) {
    Real mass = Real(0);
    for (std::uint32_t m = finer.first_member[cell]; m < finer.first_member[cell + 1]; ++m)
      mass += finer.mass[finer.member[m] / kLanes].of[finer.member[m] % kLanes];
    grid.mass[cell / kLanes].of[cell % kLanes] = mass;
  }
  for (std::size_t lane = 0; lane + 1 < grid.first_source.size(); ++lane) {
    Real sum[6] = {};
    for (std::uint32_t s = grid.first_source[lane]; s < grid.first_source[lane + 1]; ++s) {
      const NeighborLanes& from = finer.neighbors[grid.source[s] / kLanes];
      for (std::size_t k = 0; k < 6; ++k) sum[k] += from.resist[k][grid.source[s] % kLanes];
    }
    for (std::size_t k = 0; k < 6; ++k)
      grid.neighbors[lane / kLanes].resist[k][lane % kLanes] = kCoarseStiffness * sum[k];
  }
}

}  // namespace hooke::solver
