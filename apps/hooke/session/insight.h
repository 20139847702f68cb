#pragma once

#include "hooke/debug_draw.h"
#include "hooke/world.h"

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace hooke::app {

/// Length of the longest arrow over the distance of the camera.
inline constexpr double kArrowShare = 0.12;

/// What is to be seen of a world besides its objects.
struct InsightWish {
  DebugDrawDesc desc = {.contacts = false};  ///< What; the lengths and full scales follow from what is found.
  double arrow = 0.5;                        ///< Length of the arrow of the largest force [m].
  friend bool operator==(const InsightWish& a, const InsightWish& b);

  /// Whether anything is.
  [[nodiscard]] bool any() const;
};

/// One of the subjects that can be shown besides objects.
struct InsightChoice {
  const char* name;
  bool DebugDrawDesc::*shown;
};

/// All of them, in the order of their keys in the window.
[[nodiscard]] std::span<const InsightChoice> insight_choices();

/// The debug picture of hooke/debug_draw.h as plain data, free of the world; users know it as insight (the
/// window) and --show (pictures). Places are in the world [m].
struct Insight {
  struct Line {
    DebugSubject subject = DebugSubject::kContacts;
    DVec3 from = {};
    DVec3 to = {};
    DebugColor color = {};
  };
  struct Point {
    DVec3 place = {};
    DebugColor color = {};
  };
  struct Triangle {
    std::array<DVec3, 3> corners = {};
    DebugColor color = {};
  };
  struct Text {
    DVec3 place = {};
    std::string text = {};
    DebugColor color = {};
  };
  std::vector<Line> lines = {};
  std::vector<Point> points = {};
  std::vector<Triangle> triangles = {};
  std::vector<Text> texts = {};
  DebugDrawLegend legend = {};
  double arrow_force = 0;  ///< Force whose arrow has the length InsightWish::arrow [N]; 0 if nothing presses.
};

/// Makes debug pictures, one after the other. Scales follow the largest force and load of the last seconds,
/// so that colors do not flicker.
class InsightMaker {
 public:
  /// Returns the picture of now; null if nothing is wished. `seconds` is the time since the last one [s].
  std::shared_ptr<const Insight> make(const World& world, const InsightWish& wish, double seconds);

 private:
  double force_ = 0;    ///< [N]
  double tension_ = 0;  ///< [N]
  double strain_ = 0;
};

}  // namespace hooke::app
