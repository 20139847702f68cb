#pragma once

#include "hooke/result.h"

#include <cstddef>
#include <span>
#include <string>

namespace hooke::io {

/// Puts `bytes` at `path`, all or nothing: into a new file beside it, flushed to the disk, renamed when
/// complete. On an Error the old file is as it was and no new one is left.
[[nodiscard]] Result<void> replace_file(const std::string& path, std::span<const std::byte> bytes);

}  // namespace hooke::io
