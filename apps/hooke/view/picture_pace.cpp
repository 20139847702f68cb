#include "hooke/view/picture_pace.h"

#include <algorithm>
#include <array>

namespace hooke::app {

namespace {

constexpr std::array<double, 9> kScales = {1, 0.85, 0.7, 0.6, 0.55, 0.5, 0.4, 0.32, 0.25};
constexpr double kLeastWidth = 700;  ///< Of a picture [px].
constexpr double kSlow = 46;         ///< Longer pictures get fewer pixels [ms].
constexpr double kQuick = 40;      ///< Pixels are added as long as a picture is expected to stay below [ms].
constexpr std::size_t kCount = 7;  ///< Pictures whose median is looked at.
constexpr std::chrono::milliseconds kLinger{500};  ///< From the last change to rest.

double median_of(std::vector<double> times) {
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  return *middle;
}

/// Returns the largest scale whose pictures are expected to be quick, or the least one. The time goes with
/// the number of pixels at most, so that fewer pixels may turn out to take longer than that.
std::size_t scale_for(double picture_ms, std::size_t step) {
  for (std::size_t i = 0; i + 1 < kScales.size(); ++i) {
    const double ratio = kScales[i] / kScales[step];
    if (picture_ms * ratio * ratio < kQuick) return i;
  }
  return kScales.size() - 1;
}

}  // namespace

PicturePace::PicturePace(std::optional<double> fixed_scale) : fixed_scale_(fixed_scale) {}

void PicturePace::wake(Clock::time_point now) {
  last_change_ = now;
  has_rested_ = false;
}

bool PicturePace::is_at_rest(Clock::time_point now) const {
  return now - last_change_ >= kLinger;
}

bool PicturePace::is_due(Clock::time_point now) const {
  return !is_at_rest(now) || !has_rested_;
}

double PicturePace::scale(Clock::time_point now, int window_width) {
  if (fixed_scale_) return *fixed_scale_;
  while (step_ > 0 && kScales[step_] * window_width < kLeastWidth) --step_;
  return is_at_rest(now) ? 1 : kScales[step_];
}

void PicturePace::drew(Clock::time_point now, double picture_ms) {
  if (is_at_rest(now)) {
    has_rested_ = true;
    times_.clear();
    return;
  }
  times_.push_back(picture_ms);
  if (times_.size() < kCount) return;
  const double median = median_of(times_);
  times_.clear();
  const std::size_t wanted = scale_for(median, step_);
  if (median > kSlow || wanted < step_) step_ = wanted;
}

}  // namespace hooke::app
