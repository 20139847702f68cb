#pragma once

#include "hooke/scene_io.h"

#include <cstddef>
#include <string>

namespace hooke::app {

/// Returns the list of descriptions that an object's path leads to, such as "ropes[2]" or
/// "timeline[0].add.ropes[2]". `row` gets the index in that list.
const SceneObjects& objects_of(const Scene& scene, const std::string& path, std::size_t& row);
/// The same for objects that were added to a running simulation too, with paths such as "added[1].ropes[0]".
const SceneObjects& objects_of(const Simulation& simulation, const std::string& path, std::size_t& row);

}  // namespace hooke::app
