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

inline constexpr const char* kPinched =
    "a light body between the ground and what falls on it, up to 1000 times as heavy";
inline constexpr const char* kHookedBoard =
    "a light board, on a hinge or on glued legs, is passed by the load on it or by one that falls on it";
inline constexpr const char* kRopeHit = "a heavy ball falls on light ropes, which throw it off";
inline constexpr const char* kJelly =
    "a jelly under a plate of many times its mass is squeezed too far and throws it off";
inline constexpr const char* kClothHit =
    "a heavy body presses a cloth through what is under it and pulls its hooks open";

inline constexpr KnownRoom kKnownRooms[] = {
    {2, test::Figure::kOverlap, 0.34, kHookedBoard},
    {5, test::Figure::kEnergy, 0.0185, kClothHit},
    {5, test::Figure::kPointOverlap, 0.0871, kClothHit},
    {5, test::Figure::kOutside, 1, kClothHit},
    {6, test::Figure::kEnergy, 0.032, kRopeHit},
    {8, test::Figure::kEnergy, 0.2022, kRopeHit},
    {10, test::Figure::kEnergy, 0.1023, kRopeHit},
    {11, test::Figure::kOverlap, 2.568, kHookedBoard},
    {13, test::Figure::kEnergy, 0.1581, kJelly},
    {27, test::Figure::kEnergy, 0.023, kPinched},
    {28, test::Figure::kGap, 0.3811, kClothHit},
    {28, test::Figure::kRestGap, 0.0551, kClothHit},
    {28, test::Figure::kPointOverlap, 0.0845, kClothHit},
    {28, test::Figure::kOutside, 4, kClothHit},
    {32, test::Figure::kEnergy, 0.393, kHookedBoard},
    {32, test::Figure::kOverlap, 3.381, kHookedBoard},
    {32, test::Figure::kRestOverlap, 3.083, kHookedBoard},
    {33, test::Figure::kOverlap, 0.589, kHookedBoard},
    {33, test::Figure::kRestOverlap, 0.0573, kHookedBoard},
    {34, test::Figure::kEnergy, 0.3172, kJelly},
    {39, test::Figure::kOverlap, 0.5664, kHookedBoard},

};

}  // namespace hooke::fuzz
