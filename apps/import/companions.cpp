#include "companions.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

namespace hooke::importer {

namespace {

constexpr std::string_view kBlank = " \t\r\n";
constexpr std::size_t kLongestName = 4096;  // Bytes of a name with its folders.

class Names {
 public:
  /// Folders in a name are dropped.
  void add(std::string_view name) {
    if (const auto separator = name.find_last_of("/\\"); separator != std::string_view::npos) {
      name.remove_prefix(separator + 1);
    }
    if (name.empty() || is_full()) return;
    if (std::find(names_.begin(), names_.end(), name) == names_.end()) names_.emplace_back(name);
  }
  [[nodiscard]] bool is_full() const { return names_.size() >= kMostCompanions; }
  [[nodiscard]] std::vector<std::string> take() { return std::move(names_); }

 private:
  std::vector<std::string> names_;
};

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

/// Adds what stands behind each `mtllib`, and the name that the importer tries when that is missing.
void add_of_obj(const std::string& path, std::string_view text, Names& names) {
  constexpr std::string_view kKey = "mtllib";
  for (std::size_t at = 0; (at = text.find(kKey, at)) != std::string_view::npos && !names.is_full();) {
    const std::size_t end = std::min(text.find_first_of("\r\n", at), text.size());
    names.add(trimmed(text.substr(at + kKey.size(), std::min(end - at - kKey.size(), kLongestName))));
    at = end;
  }
  names.add(std::filesystem::path(path).stem().string() + ".mtl");
}

/// Adds the string of each "uri", except data in place.
void add_of_gltf(std::string_view text, Names& names) {
  constexpr std::string_view kKey = "\"uri\"";
  for (std::size_t at = 0; (at = text.find(kKey, at)) != std::string_view::npos && !names.is_full();) {
    at += kKey.size();
    const std::size_t colon = text.find_first_not_of(kBlank, at);
    if (colon == std::string_view::npos || text[colon] != ':') continue;
    const std::size_t quote = text.find_first_not_of(kBlank, colon + 1);
    if (quote == std::string_view::npos || text[quote] != '"') continue;
    std::size_t end = quote + 1;
    while (end < text.size() && text[end] != '"' && end - quote < kLongestName)
      end += text[end] == '\\' ? 2 : 1;
    if (end >= text.size() || text[end] != '"' || text.substr(quote + 1, 5) == "data:") continue;
    const auto word = nlohmann::json::parse(text.substr(quote, end - quote + 1), nullptr, false);
    if (word.is_string()) names.add(word.get<std::string>());
  }
}

}  // namespace

std::vector<std::string> companion_names(const std::string& path, std::string_view ending,
                                         std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  Names names;
  if (ending == "obj") add_of_obj(path, text, names);
  if (ending == "gltf" || ending == "glb") add_of_gltf(text, names);
  return names.take();
}

}  // namespace hooke::importer
