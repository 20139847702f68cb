#pragma once

#include "hooke/scene_io.h"

#include <optional>
#include <string>
#include <vector>

namespace hooke::app {

/// Names of the objects of a scene of which copies may be dropped: bodies that are not endless, ropes,
/// cloths, solids and particles, each array once.
std::vector<std::string> names_to_drop(const Scene& scene);

/// Returns a copy of the object of that name, free of pins and dynamic if it is a body, with its middle at
/// `place` [m]. It is called `new_name`. There is nothing if no such object can be dropped.
std::optional<SceneObjects> copy_of(const Scene& scene, const std::string& name, DVec3 place,
                                    const std::string& new_name);

}  // namespace hooke::app
