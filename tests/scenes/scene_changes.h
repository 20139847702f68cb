#pragma once

#include "hooke/scene_io.h"

/// \file
/// The same scene in another form, which must move in the same way.

namespace hooke::test {

/// The scene in a mirror at x = 0. It knows what SceneBuilder makes.
[[nodiscard]] Scene mirrored(Scene scene);

/// The scene with its objects in the opposite order. Bodies that stood first come last.
[[nodiscard]] Scene reordered(Scene scene);

}  // namespace hooke::test
