#pragma once

#include <assimp/IOSystem.hpp>
#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace hooke::importer {

/// Returns all bytes of a regular file; text as UTF-8 (text_encoding.h). Throws a Refusal for a symbolic link
/// that leaves the file's folder, for folders, pipes and devices and for more than `limit` bytes.
[[nodiscard]] std::vector<std::byte> read_model_file(const std::string& path, std::size_t limit);

/// A ModelFolder holds all that the importers may open: the model and the files that came with it, in memory.
/// Folders in a name are dropped. After construction nothing is read from the disk, and nothing is ever
/// written.
class ModelFolder : public Assimp::IOSystem {
 public:
  /// Reads those of `companions`, which are bare names, that lie beside the model and fit the budget of its
  /// bytes. `bytes` must outlive the object.
  ModelFolder(std::string path, std::span<const std::byte> bytes, const std::vector<std::string>& companions);

  bool Exists(const char* file) const override;  // NOLINT(readability-identifier-naming): assimp's name
  char getOsSeparator() const override { return '/'; }  // NOLINT(readability-identifier-naming)
  Assimp::IOStream* Open(const char* file,
                         const char* mode) override;  // NOLINT(readability-identifier-naming)
  void Close(Assimp::IOStream* stream) override;      // NOLINT(readability-identifier-naming)

 private:
  /// Returns null for a file that it does not hold.
  [[nodiscard]] const std::vector<std::byte>* find(const std::string& file) const;

  std::string path_;
  std::span<const std::byte> bytes_;
  std::map<std::string, std::vector<std::byte>> companions_;
};

}  // namespace hooke::importer
