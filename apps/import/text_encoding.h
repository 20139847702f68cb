#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace hooke::importer {

/// Whether files with this extension are text from the first byte to the last: .obj, .mtl and .gltf, in any
/// case.
[[nodiscard]] bool is_text(std::string_view extension);

/// Returns text as UTF-8 without a mark at its start: what a byte order mark says to be UTF-16 is converted,
/// a lone half of a pair becomes U+FFFD, and an odd byte at the end is dropped. Other bytes come back as they
/// are.
[[nodiscard]] std::vector<std::byte> to_utf8(std::vector<std::byte> bytes);

}  // namespace hooke::importer
