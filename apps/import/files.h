#pragma once

#include <assimp/IOSystem.hpp>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace hooke::importer {

/// All bytes of a regular file, a link to one included. Throws a Refusal for folders, pipes and devices and
/// for more than `limit` bytes.
[[nodiscard]] std::vector<std::byte> read_regular_file(const std::string& path, std::size_t limit);

/// What the importers may open: the model, already in memory, and regular files beside it by their bare
/// names (an .mtl, a .bin). Folders in a name are dropped; nothing is ever written.
class ModelFolder : public Assimp::IOSystem {
 public:
  /// `bytes` must outlive the object.
  ModelFolder(std::string path, std::span<const std::byte> bytes);

  bool Exists(const char* file) const override;  // NOLINT(readability-identifier-naming): assimp's name
  char getOsSeparator() const override { return '/'; }  // NOLINT(readability-identifier-naming)
  Assimp::IOStream* Open(const char* file,
                         const char* mode) override;  // NOLINT(readability-identifier-naming)
  void Close(Assimp::IOStream* stream) override;      // NOLINT(readability-identifier-naming)

 private:
  [[nodiscard]] std::string beside(const std::string& file) const;

  std::string path_;
  std::span<const std::byte> bytes_;
  std::size_t budget_;  ///< Bytes that may still be read from other files.
};

}  // namespace hooke::importer
