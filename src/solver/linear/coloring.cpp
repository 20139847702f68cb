#include "solver/linear/coloring.h"

#include "base/assert.h"

#include <algorithm>
#include <bit>

namespace hooke::solver {

int take_color(std::vector<std::uint64_t>& used, const std::uint32_t* particles, int count) {
  HOOKE_ASSERT(std::all_of(particles, particles + count, [&](std::uint32_t p) { return p < used.size(); }));
  std::uint64_t taken = 0;
  for (int i = 0; i < count; ++i) taken |= used[particles[i]];
  const int color = std::countr_one(taken);
  if (color >= 64) return 64;
  for (int i = 0; i < count; ++i) used[particles[i]] |= std::uint64_t{1} << color;
  return color;
}

}  // namespace hooke::solver
