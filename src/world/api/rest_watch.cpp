#include "hooke/settle.h"

namespace hooke {

namespace {

constexpr int kCalmSteps = 3;

}  // namespace

RestWatch::Verdict RestWatch::observe(const Unrest& unrest, bool disturbed) {
  ++steps_;
  const bool calm = unrest.sum <= limits_.residual && unrest.speed <= limits_.speed && !disturbed;
  calm_ = calm ? calm_ + 1 : 0;
  if (calm_ >= kCalmSteps) return Verdict::kAtRest;
  const bool fell = unrest.kinetic < last_kinetic_;
  const bool is_peak = fell && rising_;
  rising_ = !fell;
  last_kinetic_ = is_peak ? 0 : unrest.kinetic;
  return is_peak ? Verdict::kPeak : Verdict::kMoves;
}

bool RestWatch::is_still(double farthest) const {
  double leniency = 1;
  if (3 * steps_ >= limits_.steps) leniency = 10 * steps_ < 9 * limits_.steps ? 100 : 1000;
  return farthest <= limits_.drift * leniency;
}

}  // namespace hooke
