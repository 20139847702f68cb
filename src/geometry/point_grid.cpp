#include "geometry/point_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace hooke::geometry {

PointGrid::Cell PointGrid::cell_of(DVec3 place) const {
  constexpr double kEnd = 1 << 30;
  const auto along = [&](double x) {
    const double cell = std::floor(x * inverse_cell_);
    // not a number counts as the end
    return static_cast<std::int32_t>(cell > -kEnd ? std::min(cell, kEnd) : -kEnd);
  };
  return {along(place.x), along(place.y), along(place.z)};
}

void PointGrid::build(std::span<const DVec3> points, double cell) {
  const auto count = static_cast<std::uint32_t>(points.size());
  inverse_cell_ = 1 / cell;
  mask_ = std::bit_ceil(2 * count + 1) - 1;
  unsorted_.resize(count);
  entries_.resize(count);
  // The counts stand two entries further on, so that filling a bucket moves its beginning to where the next
  // one begins.
  begin_.assign(mask_ + 3, 0);
  for (std::uint32_t i = 0; i < count; ++i) {
    unsorted_[i] = {cell_of(points[i]), i};
    ++begin_[bucket_of(unsorted_[i].cell) + 2];
  }
  for (std::size_t bucket = 2; bucket < begin_.size(); ++bucket) begin_[bucket] += begin_[bucket - 1];
  for (const Entry& entry : unsorted_) entries_[begin_[bucket_of(entry.cell) + 1]++] = entry;
}

}  // namespace hooke::geometry
