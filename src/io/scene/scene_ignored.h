#pragma once

#include "hooke/scene_io.h"

#include "io/json/json_document.h"

#include <vector>

namespace hooke::io {

/// Finds keys of a scene that are understood but change nothing. Another key replaces them, or their object
/// has no use for them: the mass of a body that never moves, the cells of a jelly that is made of a mesh.
/// Each comes as the Error that `hooke validate` shows. `document` is what the scene was read from.
[[nodiscard]] std::vector<JsonError> find_ignored_keys(const Scene& scene, const JsonDocument& document);

}  // namespace hooke::io
