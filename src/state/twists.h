#pragma once

#include "hooke/math.h"

#include "state/hooks.h"

#include <cstdint>

/// \file
/// Where ropes are held against twist, and how far they are twisted between.

namespace hooke::state {

/// A segment of a rope that one thing holds at both ends: a body, or the world. The material there turns with
/// it.
struct TwistClamp {
  std::uint32_t segment = 0;               ///< Of the rope.
  std::uint32_t body = HookPlace::kWorld;  ///< Row.
  std::uint32_t slot = 0;                  ///< Of the body's id; 0 for the world.
  DVec3 tangent = {};                      ///< Unit vector along the segment, in the frame of what holds it.
  DVec3 director = {};  ///< Unit vector across it that turns with the material, in the same frame.
};

/// A rope between two clamps that follow one another.
struct TwistSpan {
  std::uint32_t object = 0;  ///< Row of the rope.
  TwistClamp a = {};
  TwistClamp b = {};
  double length = 0;           ///< At rest, of the segments between the clamps [m].
  double angle = 0;            ///< At the start of the last substep, whole turns included [rad].
  double expected = 0;         ///< At the end of the last substep, as velocities say [rad].
  double reaction = 0;         ///< Change of its rate in the last substep by all but itself [rad/s].
  bool implicit = false;       ///< Whether the row of this substep asks for the reaction.
  double impulse = 0;          ///< On what is at b, in this substep [N m s].
  Real mean_torque = Real(0);  ///< Over the last step [N m].
};

}  // namespace hooke::state
