#pragma once

#include "hooke/scene_io.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>

/// \file
/// What a run of a scene must not do, whatever is in it: gain energy, pull hooks apart, press bodies into
/// each other, stretch ropes, or lose things.

namespace hooke::test {

enum class Figure : std::uint8_t {
  /// Largest gain of energy less the work of motors, over the energy at the start and that work.
  kEnergy,
  kGap,           ///< Gap of a hook over the size of the smaller body that it holds.
  kRestGap,       ///< The same in the last quarter of the run, where it lasts for ten steps.
  kOverlap,       ///< Overlap of two bodies over the least width of the thinner one.
  kRestOverlap,   ///< The same in the last quarter of the run, where it lasts for ten steps.
  kPointOverlap,  ///< Depth of a point of a rope, cloth or jelly in a body [m].
  kRopeStretch,   ///< Relative change of length of a rope's segment.
  kClothStretch,  ///< Relative extension of an edge of a cloth.
  kVolume,        ///< Relative change of a jelly's volume.
  kSpeed,         ///< Speed of the fastest thing [m/s].
  kOutside,       ///< Number of bodies and points outside the room.
  kUnhealthy,     ///< Number of steps with a state that is not finite.
  kCount
};
inline constexpr std::size_t kFigures = static_cast<std::size_t>(Figure::kCount);

[[nodiscard]] const char* name_of(Figure figure);
/// The most that a sound run comes to.
[[nodiscard]] double limit_of(Figure figure);

/// The worst of a figure in a run.
struct Worst {
  double value = 0;
  double time = 0;         ///< When it was [s].
  std::string where = {};  ///< What it was of.
};

struct Audit {
  std::array<Worst, kFigures> worst = {};
  /// Where the bodies' origins are at the end, by name, in the scene's frame [m].
  std::map<std::string, DVec3> ends = {};
  double milliseconds = 0;  ///< Of the longest step.

  [[nodiscard]] const Worst& of(Figure figure) const { return worst[static_cast<std::size_t>(figure)]; }
};

/// Runs a scene to its end and audits every step. Ropes have their points given, and cloths are grids. What
/// is outside is judged by the bodies named floor, wall_right and wall_front, and only in the scene's own
/// frame. `say` gets a line about each step. Throws std::runtime_error where the scene is refused.
[[nodiscard]] Audit run_audit(const Scene& scene, const Placement& placement = {},
                              const std::function<void(const std::string&)>& say = {});

}  // namespace hooke::test
