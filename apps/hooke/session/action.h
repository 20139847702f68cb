#pragma once

#include "hooke/math.h"
#include "hooke/session/scene_document.h"

#include <string>
#include <variant>

/// \file
/// What a user may do to a running scene. An action has the same result whenever it is done in the same
/// state, so that a timeline can do it again.

namespace hooke::app {

/// A line of sight.
struct Ray {
  DVec3 origin = {};  ///< [m]
  DVec3 motion = {};  ///< As far as one sees [m].
};

/// Grabs what the ray meets first.
struct Grab {
  Ray ray = {};
};
/// Moves the place where the hand wants what it holds.
struct MoveHand {
  DVec3 target = {};  ///< [m]
};
/// Lets go, so that what was held flies on.
struct Release {};
/// Shoots a ball along the ray.
struct Shoot {
  Ray ray = {};
  double speed = 20;    ///< [m/s]
  double radius = 0.1;  ///< [m]
};
/// Adds a copy of an object of the scene, at rest and free of pins, where the ray meets something, or at
/// `distance` along it.
struct Drop {
  std::string object = {};  ///< Name of the object.
  Ray ray = {};
  double distance = 5;  ///< [m]
};
/// Holds what the ray meets where it is: a point of a deformable by a pin, a body by a fixed hook to the
/// world. What is held so already is let go.
struct Pin {
  Ray ray = {};
};
/// Ties what two rays meet together by a string of that length.
struct Tie {
  Ray first = {};
  Ray second = {};
};
/// Removes the object that the ray meets.
struct Remove {
  Ray ray = {};
};
/// Cuts ropes, cloths and solids along the plane between two rays from one eye.
struct Cut {
  Ray first = {};
  Ray second = {};
};

/// Takes over what an edited scene says of gravity, wind and workers: see can_change_live.
struct Edit {
  SharedDocument document = {};
  std::string what = {};  ///< What was changed, for the user.
};

using Action = std::variant<Grab, MoveHand, Release, Shoot, Drop, Pin, Tie, Remove, Cut, Edit>;

/// What came of an action.
struct Outcome {
  bool done = false;
  std::string text = {};  ///< What was done, or why not; one line.
};

}  // namespace hooke::app
