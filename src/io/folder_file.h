#pragma once

#include "hooke/result.h"

#include <filesystem>
#include <string>

namespace hooke::io {

/// Returns the path, without links, of `name` in `folder` (empty: the current one). The Error
/// kFileNotReadable, without `where`, tells that there is nothing, or that a symbolic link leads out of the
/// folder. A model must not make a program read other files of the machine. The folder itself may be a link.
[[nodiscard]] Result<std::string> resolve_in_folder(const std::filesystem::path& folder,
                                                    const std::string& name);

/// Returns the ending of a file with its point, in lower case: ".obj".
[[nodiscard]] std::string lower_ending(const std::filesystem::path& path);

}  // namespace hooke::io
