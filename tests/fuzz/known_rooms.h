#pragma once

#include "scenes/scene_audit.h"

#include <cstdint>

/// \file
/// Rooms that are known to fail. A line goes when what it names is mended; `hooke_fuzz rooms` says so.

namespace hooke::fuzz {

struct KnownRoom {
  std::uint64_t seed = 0;
  test::Figure figure = test::Figure::kCount;
  double value = 0;           ///< What it comes to today; a fifth more fails.
  const char* why = nullptr;  ///< What is wrong.
};

inline constexpr const char* kThin =
    "a body that falls on a thin one of like mass sinks into it for a moment";
inline constexpr const char* kLively =
    "a light body with restitution that a heavy one presses on a mesh turns within a step";
inline constexpr const char* kCloth = "a cloth that a body falls on stretches too far, or its hooks open";

inline constexpr const char* kPressed =
    "a point of a hammock that a body presses on the floor goes in for a moment";

inline constexpr const char* kLinks = "3 t that come to rest on links of a chain press them into the ground";

inline constexpr const char* kSnag =
    "a light rope that falls over the edge of a plank is pushed off it after it has been solved";

inline constexpr KnownRoom kKnownRooms[] = {
    {2, test::Figure::kOverlap, 0.34, kThin},        {10, test::Figure::kOverlap, 0.662, kThin},
    {18, test::Figure::kEnergy, 0.0334, kLively},    {18, test::Figure::kRestOverlap, 0.2517, kLively},
    {27, test::Figure::kEnergy, 0.017, kCloth},      {28, test::Figure::kGap, 0.206, kCloth},
    {28, test::Figure::kRestGap, 0.0586, kCloth},    {33, test::Figure::kRestOverlap, 0.067, kLinks},
    {35, test::Figure::kRopeStretch, 0.0225, kSnag}, {241, test::Figure::kOutside, 1, kPressed},
};

}  // namespace hooke::fuzz
