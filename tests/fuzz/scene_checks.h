#pragma once

#include "hooke/scene_io.h"
#include "hooke/world.h"

#include <cstddef>
#include <string>

namespace hooke::fuzz {

/// Throws where the tables of a world do not agree with each other.
void check_tables(const World& world);

/// Whether a scene is so small that a few steps of it take milliseconds, and needs no model files.
[[nodiscard]] bool is_small(const Scene& scene);

/// Makes a scene and what was written of it, and steps both: what can be made must be healthy, and both the
/// same.
void run_both(Scene scene, const Scene& written);

}  // namespace hooke::fuzz
