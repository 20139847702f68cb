#include "io/folder_file.h"

#include <algorithm>
#include <cctype>
#include <system_error>

namespace hooke::io {

namespace fs = std::filesystem;

Result<std::string> resolve_in_folder(const fs::path& folder, const std::string& name) {
  std::error_code error;
  const fs::path real_folder = fs::canonical(folder.empty() ? fs::path(".") : folder, error);
  const fs::path file = error ? fs::path() : fs::canonical(real_folder / name, error);
  if (error) return Error{ErrorCode::kFileNotReadable, "", error.message()};
  const auto beneath = std::mismatch(real_folder.begin(), real_folder.end(), file.begin(), file.end());
  if (beneath.first != real_folder.end() || beneath.second == file.end()) {
    return Error{ErrorCode::kFileNotReadable, "",
                 "a symbolic link out of its folder: name the file that it leads to"};
  }
  return file.string();
}

std::string lower_ending(const fs::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

}  // namespace hooke::io
