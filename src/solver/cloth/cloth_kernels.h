#pragma once

#include "parallel/range.h"
#include "solver/cloth/cloth_grids.h"
#include "solver/simd/dispatch.h"

#include <cstdint>

namespace hooke::solver::wide {

/// What a kernel of a grid does.
enum class GridWork : std::uint8_t {
  kLinearize,  ///< rows -> B of neighbors, and the impulse of all rows: `to`; sums of limits that change
  kInvert,     ///< mass and B -> inverse
  kResist,     ///< to = (M + B) from; sums of from . to
  kBegin,      ///< to = S residual, with the smoothing S = kSmoothing (mass + sum B)^-1
  kLeave,      ///< to = residual - (M + B) from; 0 for what does not move
  kSmooth,     ///< to = from + S (residual - (M + B) from); sums of residual . to
};

/// A part of one pass over a grid. Vectors have four numbers for each point.
struct GridJob {
  GridWork work = GridWork::kResist;
  ClothGrid* grid = nullptr;
  parallel::Range blocks = {};
  const PointVector* from = nullptr;
  const PointVector* residual = nullptr;
  PointVector* to = nullptr;
  PointLanes* sums = nullptr;  ///< Sums over the blocks, lane by lane; null for none.
  // For kLinearize alone: rows, and where points are and go.
  RowLanes* rows = nullptr;
  const PointVector* guess = nullptr;               ///< Change of velocity that is expected [m/s].
  const state::PositionRecord* position = nullptr;  ///< From the first point on.
  const state::VelocityRecord* velocity = nullptr;
  Real h = Real(0);  ///< [s]
};

/// Does a part of a pass. The formulas stand in solver/cloth/cloth_solution.h.
void run(const GridJob& job);
void run_scalar(const GridJob& job);

}  // namespace hooke::solver::wide
