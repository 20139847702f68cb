#include "solver/soft/yarn_bend_rows.h"
#include "solver/soft/yarn_rows.h"

// Solves one lane at a time, in either precision.

namespace hooke::solver::wide {

void solve_yarns_scalar(const YarnBlock& block, YarnRow* rows, const YarnMaterial& material, Real h,
                        const state::PositionRecord* position, state::VelocityRecord* velocity) {
  HWY_NAMESPACE::solve_yarn_block<Real>(block, rows, material, h, position, velocity);
}

void bend_yarns_scalar(const YarnBlock& block, const YarnRow* rows, YarnBendRow* bends,
                       const YarnBendTime& time, const state::PositionRecord* position,
                       state::VelocityRecord* velocity) {
  HWY_NAMESPACE::bend_yarn_block<double>(block, rows, bends, time, position, velocity);
}

}  // namespace hooke::solver::wide
