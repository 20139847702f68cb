#pragma once

#include "hooke/desc.h"

#include <cstdint>

namespace hooke::solver {

/// The wind at a place and time [m/s], see WindDesc. It is value noise on a lattice of `correlation_length`
/// and `correlation_time`, joined by quintics: continuous in its second derivative, and the same bits
/// everywhere. `step` matters to WindDesc::Gusts::kPaper only.
[[nodiscard]] Vec3 wind_at(const WindDesc& wind, DVec3 place, double time, std::uint64_t step);

/// Whether the wind depends on place or time.
[[nodiscard]] bool has_gusts(const WindDesc& wind);

/// Horizontal unit vector across the mean wind; x for a vertical or missing wind.
[[nodiscard]] DVec3 side_of(Vec3 velocity);

}  // namespace hooke::solver
