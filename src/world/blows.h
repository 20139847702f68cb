#pragma once

#include "world/world_data.h"

/// \file
/// When bodies yield (BodyDesc::yields): the impulses of their contacts are added up over the substeps of a
/// step. A step in which one is too much is taken back and made again with a solid in the body's place.

namespace hooke::world {

/// Begins a step of `dt` [s]: copies the tables if some body that yields may be hit hard in it, so that the
/// step can be taken back.
void watch_for_blows(WorldData& world, double dt);

/// Adds up what the substep that ends at `time` [s], of length `h` [s], gave to bodies that yield. If that is
/// too much for some of them, and the step can be taken back, it is: all is as when the step began, but they
/// are soft. Returns whether it was.
[[nodiscard]] bool take_back_for_blows(WorldData& world, double dt, double time, Real h);

/// Makes those soft that were given too much in a step that was not taken back, as by what pressed on them
/// slowly. They have taken the whole of it as rigid bodies.
void soften_pressed(WorldData& world, double time);

}  // namespace hooke::world
