#pragma once

#include "solver/soft/yarns.h"
#include "state/particles.h"

namespace hooke::solver::wide {

/// Solves the yarns of a block, whose rows begin at `rows`; the formula stands in solver/soft/yarns.h.
void solve_yarns(const YarnBlock& block, YarnRow* rows, const YarnMaterial& material, Real h,
                 const state::PositionRecord* position, state::VelocityRecord* velocity);
void solve_yarns_scalar(const YarnBlock& block, YarnRow* rows, const YarnMaterial& material, Real h,
                        const state::PositionRecord* position, state::VelocityRecord* velocity);

/// How far bends act ahead in a substep of h.
struct YarnBendTime {
  double h = 0;      ///< [s]
  double share = 0;  ///< h^2 + h tau [s^2]
};

/// Bends the yarns of a block.
void bend_yarns(const YarnBlock& block, const YarnRow* rows, YarnBendRow* bends, const YarnBendTime& time,
                const state::PositionRecord* position, state::VelocityRecord* velocity);
void bend_yarns_scalar(const YarnBlock& block, const YarnRow* rows, YarnBendRow* bends,
                       const YarnBendTime& time, const state::PositionRecord* position,
                       state::VelocityRecord* velocity);

}  // namespace hooke::solver::wide
