#pragma once

#include "hooke/math.h"

#include <cstdint>
#include <random>

namespace hooke::test {

/// Uniform in [-1, 1) from the engine's bits alone, so that the samples are the same with every library.
inline double signed_unit(std::mt19937_64& random) {
  return static_cast<double>(static_cast<std::int64_t>(random()) >> 11) * 0x1p-52;
}

/// Each coordinate of its own.
inline DVec3 random_vector(std::mt19937_64& random) {
  const double x = signed_unit(random);
  const double y = signed_unit(random);
  return {x, y, signed_unit(random)};
}

}  // namespace hooke::test
