#pragma once

#include "hooke/model_io.h"
#include "hooke/result.h"

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

namespace hooke::io {

inline constexpr std::chrono::milliseconds kImporterWallTime = std::chrono::seconds(15);

/// Returns the bytes, unchecked, that `hooke-import` writes for the file at `path`. It returns an Error when
/// there is no importer, or when the importer refuses, ends by a signal, writes more than `kMaxFlatModelSize`
/// bytes or takes longer than `wall_time`. The importer has ended when this returns. Several threads may call
/// it.
///
/// The importer is $HOOKE_IMPORT if that is set, else `hooke-import` beside the running program, else the
/// installed one.
[[nodiscard]] Result<std::vector<std::byte>> run_importer(
    const std::string& path, const ImportOptions& options,
    std::chrono::milliseconds wall_time = kImporterWallTime);

}  // namespace hooke::io
