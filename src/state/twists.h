#pragma once

#include "hooke/math.h"

#include "state/hooks.h"

#include <cstdint>

/// \file
/// Where ropes are held against twist, and how far they are twisted between those clamps.

namespace hooke::state {

/// A segment of a rope that one thing holds at both ends: a body, or the world. The material of the rope
/// rotates with that holder there.
struct TwistClamp {
  std::uint32_t segment = 0;               ///< Row of the segment within the rope.
  std::uint32_t body = HookPlace::kWorld;  ///< Row of the body.
  std::uint32_t slot = 0;                  ///< Slot of the body's id; 0 for the world.
  DVec3 tangent = {};                      ///< Unit vector along the segment, in the holder's frame.
  DVec3 director = {};  ///< Unit vector across it that rotates with the material, in the same frame.
};

/// The part of a rope between two clamps that follow one another.
struct TwistSpan {
  std::uint32_t object = 0;  ///< Row of the rope.
  TwistClamp a = {};
  TwistClamp b = {};
  double length = 0;           ///< Rest length of the segments between the clamps [m].
  double angle = 0;            ///< Twist at the start of the last substep, whole turns included [rad].
  double expected = 0;         ///< Twist at the end of the last substep as the velocities give it [rad].
  double reaction = 0;         ///< Change of the twist rate in the last substep by all but this row [rad/s].
  bool implicit = false;       ///< Whether the row uses the reaction in this substep.
  double impulse = 0;          ///< Impulse on what is at b, in this substep [N m s].
  Real mean_torque = Real(0);  ///< Torque, mean over the last step [N m].
};

}  // namespace hooke::state
