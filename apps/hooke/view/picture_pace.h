#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <vector>

namespace hooke::app {

/// A PicturePace decides when the window draws a picture, and with how many pixels.
///
/// Nothing is drawn while nothing changes. Where a picture takes longer than 1/20 s, as without a graphics
/// card, pictures get fewer pixels while things move, and all of them half a second after.
class PicturePace {
 public:
  using Clock = std::chrono::steady_clock;

  /// `fixed_scale` is used for every picture; without it, what gives 20 pictures a second.
  explicit PicturePace(std::optional<double> fixed_scale = {});

  /// Says that the next picture may differ from the last one.
  void wake(Clock::time_point now);

  /// Whether a picture is to be drawn.
  [[nodiscard]] bool is_due(Clock::time_point now) const;

  /// Width and height of that picture in those of a window of that width, 0.25 to 1. It is as small only as
  /// leaves 700 pixels beside one another, on which objects can still be told apart.
  double scale(Clock::time_point now, int window_width);

  /// Says that it was drawn at the time for which is_due and scale were asked, and how long that took [ms].
  void drew(Clock::time_point now, double picture_ms);

 private:
  [[nodiscard]] bool is_at_rest(Clock::time_point now) const;

  std::optional<double> fixed_scale_;
  std::size_t step_ = 0;  ///< Index of the scale while things move.
  Clock::time_point last_change_ = Clock::now();
  bool has_rested_ = false;    ///< Whether the picture of what is at rest was drawn.
  std::vector<double> times_;  ///< Of the last pictures of this scale [ms].
};

}  // namespace hooke::app
