#pragma once

#include "hooke/scene_io.h"

#include <cstdint>

namespace hooke::io {

/// What a quantity is measured on. Hooks and ropes twist, hooks and the world have gaps, and much breaks.
enum class Subject : std::uint8_t {
  kWorld,
  kObject,
  kPoint,
  kRope,
  kBody,
  kHook,
  kTwists,
  kGaps,
  kBreaks,
  kYields
};

[[nodiscard]] Subject subject_of(SceneExpectation::Quantity quantity);

}  // namespace hooke::io
