#pragma once

#include "state/tables.h"

#include <cstdint>

/// \file
/// Hooks of bodies that become soft, and rigid again. Points have no rotation, so that a soft body is held by
/// balls: one at the place of the hook, and helpers where its kind holds more than a place.

namespace hooke::world {

/// Moves the hooks of a body to the solid that it has become, the object in the row `object`.
void move_hooks_to_solid(std::uint32_t body, std::uint32_t object, state::Tables& tables);

/// Moves the hooks of a solid to the body that it has become again. The hooks that the body had are as they
/// were, without a gap; the others stay balls, distances and slides.
void move_hooks_to_body(std::uint32_t object, std::uint32_t body, state::Tables& tables);

/// Removes the helpers of hooks that are gone.
void drop_orphaned_helpers(state::Tables& tables);

}  // namespace hooke::world
