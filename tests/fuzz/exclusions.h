#pragma once

/// \file
/// What the trials leave out because it is known not to hold yet. This is the only place for that: a line
/// goes when what it names is mended. tests/fuzz/LOG.md says what was found of each.

namespace hooke::fuzz {

struct Exclusions {
  /// Finite values so large that float overflows in a step: a world that took one is not asked for health.
  bool health_after_huge_values = true;
  /// Steps of cloths: light ones with a heavy load, a limit of their extension, or hardly any width.
  bool health_of_cloths = true;
  /// How fast things may become that begin in each other, or of which some are cloths or hooked.
  bool speed_in_crowds = true;
  bool speed_of_cloths = true;
  bool speed_of_hooks = true;
  /// Whether a scene with one of these gains energy.
  bool energy_of_cloths = true;
  bool energy_of_ropes = true;
  bool energy_of_solids = true;
  bool energy_of_hooks = true;
};
inline constexpr Exclusions kLeftOut = {};

}  // namespace hooke::fuzz
