#include "solver/rope/rope_records.h"
#include "solver/rope/rope_sweep.h"

// One lane at a time.

namespace hooke::solver::wide {

void load_ropes_scalar(const RopeLocations<kRopeLanes>& locations, RopeLanes<kRopeLanes>& ropes) {
  HWY_NAMESPACE::load_rope_lanes<double>(locations, ropes);
}

void solve_ropes_scalar(double h, const RopeTraits<kRopeLanes>& traits, RopeLanes<kRopeLanes>& ropes) {
  HWY_NAMESPACE::solve_rope_lanes<double>(h, traits, ropes);
}

void store_ropes_scalar(double h, const RopeLocations<kRopeLanes>& locations,
                        const RopeTraits<kRopeLanes>& traits, const bool (&chosen)[kRopeLanes],
                        const RopeLanes<kRopeLanes>& ropes) {
  HWY_NAMESPACE::store_rope_lanes<double>(h, locations, traits, chosen, ropes);
}

void load_ropes(const RopeLocations<1>& locations, RopeLanes<1>& rope) {
  HWY_NAMESPACE::load_rope_lanes<double>(locations, rope);
}

void solve_ropes(double h, const RopeTraits<1>& traits, RopeLanes<1>& rope) {
  HWY_NAMESPACE::solve_rope_lanes<double>(h, traits, rope);
}

void store_ropes(double h, const RopeLocations<1>& locations, const RopeTraits<1>& traits,
                 const bool (&chosen)[1], const RopeLanes<1>& rope) {
  HWY_NAMESPACE::store_rope_lanes<double>(h, locations, traits, chosen, rope);
}

}  // namespace hooke::solver::wide
