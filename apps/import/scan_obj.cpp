#include "refusal.h"
#include "scan.h"

#include <algorithm>
#include <string>
#include <string_view>

namespace hooke::importer {

void scan_obj(std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::size_t number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, end - at);
    at = end + 1;
    ++number;
    const std::size_t word = line.find_first_not_of(" \t");
    if (word == std::string_view::npos || line[word] != 'f') continue;
    const std::string_view rest = line.substr(word + 1);
    if (rest.find_first_not_of(" \t\r") == std::string_view::npos) {
      throw Refusal(io::ImporterExit::kBadSyntax,
                    "line " + std::to_string(number) + ": a face without corners");
    }
  }
}

}  // namespace hooke::importer
