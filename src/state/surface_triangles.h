#pragma once

#include "state/tables.h"

#include <array>
#include <cstdint>
#include <vector>

namespace hooke::state {

/// The triangles of an object's surface, as rows of particles: those of a cloth, or the outer faces of a
/// solid. They follow from what rows join, and stand in the same order after a restore.
[[nodiscard]] std::vector<std::array<std::uint32_t, 3>> surface_triangles(const Tables& tables,
                                                                          const Deformable& object);

}  // namespace hooke::state
