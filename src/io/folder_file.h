#pragma once

#include "hooke/result.h"

#include <filesystem>
#include <string>

namespace hooke::io {

/// The path without links of `name` in `folder` (empty: the current one). Errors, without `where`:
/// kFileNotReadable when there is nothing, and when a symbolic link leads out of the folder: what comes with
/// a model is not to reach for other files of the machine. The folder itself may be a link.
[[nodiscard]] Result<std::string> resolve_in_folder(const std::filesystem::path& folder,
                                                    const std::string& name);

}  // namespace hooke::io
