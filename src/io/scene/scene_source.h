#pragma once

#include "hooke/scene_io.h"

#include "io/json/json_document.h"

namespace hooke {

/// A SceneSource tells where everything in a scene stands in its file.
struct SceneSource {
  io::JsonDocument document = {};
};

namespace io {

/// Makes the error of a value at a path such as "ropes[0].masses"; without a source only the path is known.
[[nodiscard]] Error error_at(const SceneSource* source, const std::string& path, ErrorCode code,
                             std::string reason);

/// Returns "ropes[0]", the path of element `index` of a list.
[[nodiscard]] std::string indexed(std::string_view list, std::size_t index);

}  // namespace io

}  // namespace hooke
