#pragma once

#include "hooke/math.h"

#include <cstdint>
#include <span>
#include <vector>

namespace hooke::geometry {

/// Sorts points by the cells of an even grid without bounds, to find those that are near a position.
class PointGrid {
 public:
  /// Replaces all points. `cell` is the side of a cell [m], positive. Time and memory are linear in the
  /// points, wherever they are. Points that are not finite are put into the outermost cells.
  void build(std::span<const DVec3> points, double cell);

  /// Calls `visit(i)` for every point i in the cell of `place` and those around it: all that are nearer than
  /// a cell's side, and some that are not. The order depends on the points and the side alone.
  template <class Visit>
  void for_each_near(DVec3 place, Visit&& visit) const {
    if (entries_.empty()) return;
    const Cell middle = cell_of(place);
    for (std::int32_t x = -1; x <= 1; ++x) {
      for (std::int32_t y = -1; y <= 1; ++y) {
        for (std::int32_t z = -1; z <= 1; ++z) {
          for_each_in({middle.x + x, middle.y + y, middle.z + z}, visit);
        }
      }
    }
  }

 private:
  struct Cell {
    std::int32_t x = 0;
    std::int32_t y = 0;
    std::int32_t z = 0;

    friend bool operator==(const Cell&, const Cell&) = default;
  };
  struct Entry {
    Cell cell = {};
    std::uint32_t point = 0;
  };

  /// Calls `visit(i)` for every point i of the cell.
  template <class Visit>
  void for_each_in(const Cell& cell, Visit& visit) const {
    const std::uint32_t bucket = bucket_of(cell);
    for (std::uint32_t e = begin_[bucket]; e < begin_[bucket + 1]; ++e) {
      if (entries_[e].cell == cell) visit(entries_[e].point);
    }
  }

  [[nodiscard]] Cell cell_of(DVec3 place) const;
  /// Bucket of a cell, after Teschner et al. 2003, "Optimized spatial hashing for collision detection of
  /// deformable objects".
  [[nodiscard]] std::uint32_t bucket_of(const Cell& cell) const {
    const std::uint32_t hash = (static_cast<std::uint32_t>(cell.x) * 73856093u) ^
                               (static_cast<std::uint32_t>(cell.y) * 19349663u) ^
                               (static_cast<std::uint32_t>(cell.z) * 83492791u);
    return hash & mask_;
  }

  double inverse_cell_ = 0;  ///< [1/m]
  std::uint32_t mask_ = 0;
  std::vector<std::uint32_t> begin_;  ///< Begin of each bucket's entries; those of the last one end at the
                                      ///< next.
  std::vector<Entry> entries_;        ///< Entries by bucket, then by point.
  std::vector<Entry> unsorted_;
};

}  // namespace hooke::geometry
