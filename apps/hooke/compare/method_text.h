#pragma once

#include <string_view>

namespace hooke::app {

/// This is what a page tells of a method: for people who meet it for the first time.
struct MethodText {
  std::string_view formula;  ///< One step, from x and v to x' and v', with a for the acceleration.
  std::string_view growth;   ///< Closed form of the growth per step without damping, y being h omega.
  std::string_view words;    ///< Why it behaves so.
};

/// Returns empty texts for a name that is unknown.
MethodText method_text(std::string_view name);

}  // namespace hooke::app
