#include "io/scene/scene_check.h"
#include "io/scene/scene_source.h"

#include <algorithm>
#include <charconv>
#include <filesystem>

/// \file
/// Takes the names of a scene apart: of copies, of ends of hooks, of files.

namespace hooke::io {

EndName take_end_name(const std::string& name) {
  const std::size_t dot = name.rfind('.');
  if (dot == std::string::npos) return {name};
  return {name.substr(0, dot), name.substr(dot + 1)};
}

std::string glue_name(const std::string& body) {
  return body + "_glue";
}

std::optional<CopyName> take_copy_name(const std::string& name) {
  const std::size_t bracket = name.rfind('[');
  if (bracket == std::string::npos || !name.ends_with(']')) return std::nullopt;
  std::size_t copy = 0;
  const char* end = name.data() + name.size() - 1;
  const auto parsed = std::from_chars(name.data() + bracket + 1, end, copy);
  if (parsed.ec != std::errc() || parsed.ptr != end) return std::nullopt;
  return CopyName{name.substr(0, bracket), copy};
}

Result<std::string> locate_file(const std::string& scene_path, const std::string& file) {
  namespace fs = std::filesystem;
  const Error outside = {ErrorCode::kOutOfRange, file, in_quotes(file) + " is outside of the scene's folder"};
  const bool strange = std::any_of(file.begin(), file.end(),
                                   [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\\'; });
  if (strange) {
    return Error{ErrorCode::kOutOfRange, file,
                 in_quotes(file) + " has a character that a path must not have"};
  }
  const fs::path relative = fs::path(file).lexically_normal();
  if (relative.is_absolute() || relative.empty() || *relative.begin() == "..") return outside;
  const fs::path folder = fs::path(scene_path).parent_path();
  const fs::path joined = folder.empty() ? relative : folder / relative;
  // A link inside the folder may still lead out of it.
  std::error_code failure;
  const fs::path root = fs::weakly_canonical(fs::absolute(folder.empty() ? "." : folder), failure);
  if (failure) return joined.string();
  const fs::path real = fs::weakly_canonical(fs::absolute(joined), failure);
  if (failure) return joined.string();
  const auto [end, unused] = std::mismatch(root.begin(), root.end(), real.begin(), real.end());
  static_cast<void>(unused);
  if (end != root.end() && !end->empty()) return outside;
  return joined.string();
}

}  // namespace hooke::io
