#include "geometry/solid/cell_joining.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

namespace hooke::geometry {

namespace {

constexpr std::uint32_t kTouchedCost = 1;
constexpr std::uint32_t kEmptyCost = 4;
constexpr int kSamplesPerCell = 4;
constexpr int kSamplesMax = 512;  // Along the side of a triangle.

class CellJoiner {
 public:
  CellJoiner(const MeshDesc& mesh, CellGrid& grid) : mesh_(mesh), grid_(grid) {}

  CellAdditions join() {
    touched_.assign(grid_.filled.size(), 0);
    for (const Triangle& t : mesh_.triangles) touch(t);
    CellAdditions additions;
    additions.thin = fill_thin_parts();
    find_pieces();
    additions.pieces = static_cast<std::uint32_t>(piece_sizes_.size());
    if (piece_sizes_.size() > 1) additions.bridges = bridge();
    return additions;
  }

 private:
  using Cell = std::array<int, 3>;

  [[nodiscard]] Cell cell_of(std::size_t i) const {
    const auto n = grid_.counts;
    return {static_cast<int>(i % n[0]), static_cast<int>(i / n[0] % n[1]), static_cast<int>(i / n[0] / n[1])};
  }

  /// Marks the cells in which samples of the triangle lie.
  void touch(const Triangle& triangle) {
    const DVec3 a = vector_cast<double>(mesh_.positions[triangle[0]]);
    const DVec3 ab = vector_cast<double>(mesh_.positions[triangle[1]]) - a;
    const DVec3 ac = vector_cast<double>(mesh_.positions[triangle[2]]) - a;
    const double longest = std::max({length(ab), length(ac), length(ac - ab)});
    const double spacing = std::min({grid_.cell.x, grid_.cell.y, grid_.cell.z}) / kSamplesPerCell;
    const int steps = static_cast<int>(std::clamp(std::ceil(longest / spacing), 1.0, 1.0 * kSamplesMax));
    for (int i = 0; i <= steps; ++i) {
      for (int k = 0; k <= steps - i; ++k) {
        const DVec3 p = a + (1.0 * i / steps) * ab + (1.0 * k / steps) * ac - grid_.corner;
        const double at[3] = {p.x / grid_.cell.x, p.y / grid_.cell.y, p.z / grid_.cell.z};
        Cell cell = {};
        for (int axis = 0; axis < 3; ++axis)
          cell[axis] = std::clamp(static_cast<int>(std::floor(at[axis])), 0, grid_.counts[axis] - 1);
        touched_[grid_.index(cell[0], cell[1], cell[2])] = 1;
      }
    }
  }

  [[nodiscard]] bool is_near_filled(const Cell& c, const std::vector<std::uint8_t>& filled) const {
    for (int z = std::max(c[2] - 1, 0); z <= std::min(c[2] + 1, grid_.counts[2] - 1); ++z) {
      for (int y = std::max(c[1] - 1, 0); y <= std::min(c[1] + 1, grid_.counts[1] - 1); ++y) {
        for (int x = std::max(c[0] - 1, 0); x <= std::min(c[0] + 1, grid_.counts[0] - 1); ++x)
          if (filled[grid_.index(x, y, z)] != 0) return true;
      }
    }
    return false;
  }

  std::uint32_t fill_thin_parts() {
    const std::vector<std::uint8_t> given = grid_.filled;
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < touched_.size(); ++i) {
      if (touched_[i] == 0 || is_near_filled(cell_of(i), given)) continue;
      grid_.filled[i] = 1;
      ++count;
    }
    return count;
  }

  /// Calls `visit` with the index of each cell that shares a face with cell `i`.
  template <class Visit>
  void for_each_neighbor(std::size_t i, const Visit& visit) const {
    const Cell cell = cell_of(i);
    const std::size_t steps[3] = {1, static_cast<std::size_t>(grid_.counts[0]),
                                  static_cast<std::size_t>(grid_.counts[0]) * grid_.counts[1]};
    for (int axis = 0; axis < 3; ++axis) {
      if (cell[axis] > 0) visit(i - steps[axis]);
      if (cell[axis] + 1 < grid_.counts[axis]) visit(i + steps[axis]);
    }
  }

  /// Numbers the pieces of filled cells that are joined by faces.
  void find_pieces() {
    piece_of_.assign(grid_.filled.size(), kNone);
    std::vector<std::size_t> waiting;
    for (std::size_t first = 0; first < piece_of_.size(); ++first) {
      if (grid_.filled[first] == 0 || piece_of_[first] != kNone) continue;
      const auto piece = static_cast<std::uint32_t>(piece_sizes_.size());
      piece_sizes_.push_back(0);
      piece_of_[first] = piece;
      waiting.assign(1, first);
      while (!waiting.empty()) {
        const std::size_t i = waiting.back();
        waiting.pop_back();
        ++piece_sizes_[piece];
        for_each_neighbor(i, [&](std::size_t next) {
          if (grid_.filled[next] == 0 || piece_of_[next] != kNone) return;
          piece_of_[next] = piece;
          waiting.push_back(next);
        });
      }
    }
  }

  /// Grows from the largest piece to the nearest other one, fills the way, and goes on from both: Prim's
  /// minimum spanning tree by Dijkstra's shortest ways. Returns the number of cells filled.
  std::uint32_t bridge() {
    using Offer = std::pair<std::uint32_t, std::size_t>;
    std::priority_queue<Offer, std::vector<Offer>, std::greater<>> waiting;
    std::vector<std::uint32_t> cost(grid_.filled.size(), std::numeric_limits<std::uint32_t>::max());
    std::vector<std::size_t> came_from(grid_.filled.size(), 0);
    std::vector<std::vector<std::size_t>> cells(piece_sizes_.size());
    for (std::size_t i = 0; i < piece_of_.size(); ++i)
      if (piece_of_[i] != kNone) cells[piece_of_[i]].push_back(i);
    const auto take = [&](std::vector<std::size_t>& piece) {
      for (const std::size_t i : piece) {
        cost[i] = 0;
        waiting.emplace(0, i);
      }
      piece.clear();
    };
    take(cells[std::max_element(piece_sizes_.begin(), piece_sizes_.end()) - piece_sizes_.begin()]);
    std::uint32_t count = 0;
    while (!waiting.empty()) {
      const Offer nearest = waiting.top();
      const std::size_t i = nearest.second;
      waiting.pop();
      if (nearest.first != cost[i]) continue;
      if (piece_of_[i] != kNone && !cells[piece_of_[i]].empty()) {
        for (std::size_t k = came_from[i]; cost[k] != 0; k = came_from[k]) {
          count += grid_.filled[k] == 0 ? 1 : 0;
          grid_.filled[k] = 1;
          cost[k] = 0;
          waiting.emplace(0, k);
        }
        take(cells[piece_of_[i]]);
        continue;
      }
      for_each_neighbor(i, [&](std::size_t next) {
        const std::uint32_t step = touched_[next] != 0 ? kTouchedCost : kEmptyCost;
        if (cost[i] + step >= cost[next]) return;
        cost[next] = cost[i] + step;
        came_from[next] = i;
        waiting.emplace(cost[next], next);
      });
    }
    return count;
  }

  const MeshDesc& mesh_;
  CellGrid& grid_;
  std::vector<std::uint8_t> touched_;
  std::vector<std::uint32_t> piece_of_;
  std::vector<std::uint32_t> piece_sizes_;
};

}  // namespace

CellAdditions join_cells(const MeshDesc& mesh, CellGrid& grid) {
  return CellJoiner(mesh, grid).join();
}

}  // namespace hooke::geometry
