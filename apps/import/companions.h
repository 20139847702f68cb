#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hooke::importer {

inline constexpr std::size_t kMostCompanions = 256;

/// Returns the bare names of files beside the model at `path` that its importer may ask for: the .mtl of an
/// .obj, the buffers of a glTF. They are found by their keys alone, before anything is parsed, so that all
/// reading is done before the process is sealed. A superfluous name does no harm. There are at most
/// kMostCompanions, each once.
[[nodiscard]] std::vector<std::string> companion_names(const std::string& path, std::string_view ending,
                                                       std::span<const std::byte> bytes);

}  // namespace hooke::importer
