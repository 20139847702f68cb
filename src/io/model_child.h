#pragma once

#include "hooke/model_io.h"
#include "hooke/result.h"

#include <cstddef>
#include <string>
#include <vector>

namespace hooke::io {

/// The bytes that `hooke-import` writes for the file at `path`, unchecked. Returns an Error when there is no
/// importer, when it refuses, ends by a signal, writes more than `kMaxFlatModelSize` bytes or takes longer
/// than 15 s; it is gone when this returns. Safe to call from several threads.
///
/// The importer is $HOOKE_IMPORT if that is set; else `hooke-import` beside the running program; else the
/// installed one.
[[nodiscard]] Result<std::vector<std::byte>> run_importer(const std::string& path,
                                                          const ImportOptions& options);

}  // namespace hooke::io
