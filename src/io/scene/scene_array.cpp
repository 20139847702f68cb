#include "hooke/scene_io.h"

#include "base/splitmix.h"

#include <algorithm>

namespace hooke {

namespace {

std::uint64_t mixed(std::uint64_t word) {
  return base::splitmix(word + base::kSplitmixStep);
}

/// Returns a number uniform in [low, high).
double uniform(std::uint64_t word, double low, double high) {
  return low + (high - low) * base::unit_number(mixed(word));
}

std::size_t positive(std::int32_t n) {
  return static_cast<std::size_t>(std::max(n, 0));
}

DVec3 scaled(DVec3 spacing, double x, double y, double z) {
  return {x * spacing.x, y * spacing.y, z * spacing.z};
}

}  // namespace

std::size_t SceneArray::count() const {
  constexpr std::size_t kFar = std::size_t{1} << 40U;
  switch (kind) {
    case Kind::kSingle:
      return 1;
    case Kind::kGrid: {
      const std::size_t area = positive(grid[0]) * positive(grid[1]);
      const std::size_t layers = positive(grid[2]);
      return layers > 0 && area > kFar / layers ? kFar : area * layers;
    }
    case Kind::kPyramid:
      return positive(pyramid) * (positive(pyramid) + 1) / 2;
    case Kind::kRandom:
      return positive(random);
    case Kind::kList:
      return list.size();
  }
  return 0;
}

DVec3 SceneArray::offset(std::size_t i) const {
  if (i >= count()) return {};
  if (kind == Kind::kGrid) {
    const std::size_t columns = positive(grid[0]);
    const std::size_t area = columns * positive(grid[1]);
    const std::size_t row = i % area / columns;
    const std::size_t layer = i / area;
    return scaled(spacing, static_cast<double>(i % columns), static_cast<double>(row),
                  static_cast<double>(layer));
  }
  if (kind == Kind::kPyramid) {
    std::size_t row = 0;
    std::size_t length = positive(pyramid);
    for (; i >= length; --length, ++row) i -= length;
    // Each row is centered on the one below.
    return scaled(spacing, static_cast<double>(i) + 0.5 * static_cast<double>(row), static_cast<double>(row),
                  0);
  }
  if (kind == Kind::kRandom) {
    const std::uint64_t first = mixed(seed) + 3 * static_cast<std::uint64_t>(i);
    return {uniform(first, box[0].x, box[1].x), uniform(first + 1, box[0].y, box[1].y),
            uniform(first + 2, box[0].z, box[1].z)};
  }
  return kind == Kind::kList ? list[i] : DVec3{};
}

Quat SceneArray::rotation(std::size_t i) const {
  return kind == Kind::kList && i < rotations.size() ? rotations[i] : Quat{};
}

}  // namespace hooke
