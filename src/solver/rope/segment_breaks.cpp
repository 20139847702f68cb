#include "solver/rope/segment_breaks.h"

#include "base/assert.h"

#include <algorithm>
#include <limits>

namespace hooke::solver {

wide::SegmentTraits<double> dashpot_traits(double resistance, const wide::SegmentTraits<double>& of) {
  constexpr double kLeastResistance = 1e-15;  // its inverse must be finite [kg]
  wide::SegmentTraits<double> traits = of;
  traits.per_rest = 0;
  traits.limit = std::numeric_limits<double>::infinity();
  traits.damping = 0;
  traits.per_stiffness = 0;
  traits.bias = 0;
  traits.resistance = std::max(resistance, kLeastResistance);
  return traits;
}

void apply_dashpot(const GivingSegment& giving, RopeSegment& segment) {
  segment.traits = dashpot_traits(giving.resistance, segment.traits);
  segment.tension_bound = 0;
  segment.limited = false;
}

bool set_dashpot(double speed, double impulse, GivingSegment& giving) {
  using Giving = GivingSegment::Giving;
  HOOKE_ASSERT(giving.most > 0);
  if (giving.giving == Giving::kMost) return false;
  double left = speed;
  if (giving.giving == Giving::kNothing) {
    giving.parting = speed;
  } else if (impulse > 0) {
    left = giving.parting - giving.most * (giving.parting - speed) / impulse;
  }
  giving.giving = giving.giving == Giving::kNothing ? Giving::kSome : Giving::kMost;
  giving.resistance = left > 0 ? giving.most / left : 0;
  return true;
}

}  // namespace hooke::solver
