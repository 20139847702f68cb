#pragma once

#include "hooke/scene_io.h"

#include "io/json/json_document.h"

#include <vector>

namespace hooke::io {

/// Keys of a scene that are understood and change nothing, because another key replaces them or what they
/// belong to has no use for them: the mass of a body that never moves, the cells of a jelly that is made of a
/// mesh. Each as the Error that `hooke validate` makes of it. `document` is what the scene was read from.
[[nodiscard]] std::vector<JsonError> find_ignored_keys(const Scene& scene, const JsonDocument& document);

}  // namespace hooke::io
