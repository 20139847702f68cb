#pragma once

#include "hooke/result.h"

#include "process/child.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

/// \file
/// Every file is written so that its name always leads to a complete file: the new one or the old one.

namespace hooke::process {

/// A NewFile gets its name when it is complete. Until finish() it has no name, where the file system allows
/// that, so that nothing is left of it however the process ends. Elsewhere it has a preliminary name, which
/// the destructor or remove_unfinished_files() removes.
class NewFile {
 public:
  enum class Start : std::uint8_t {
    /// The file has no name; kNamed is used where that is not possible.
    kUnnamed,
    kNamed,
  };

  /// Begins a file that finish() will put at `path`, or at what a symbolic link there leads to. The Error is
  /// kFileNotWritable if the folder refuses, or if something stands at `path` that is no regular file.
  [[nodiscard]] static Result<NewFile> create(const std::string& path, Start start = Start::kUnnamed);

  NewFile(NewFile&& other) noexcept;
  NewFile& operator=(NewFile&& other) noexcept;
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;
  ~NewFile();

  /// Returns the descriptor, which is open for reading and writing and belongs to this object.
  [[nodiscard]] int number() const { return file_.number(); }

  /// Appends bytes. The Error is kFileNotWritable when not all of them can be written.
  Result<void> write(std::span<const std::byte> bytes);
  Result<void> write(std::string_view text);

  /// Flushes the file to the disk and gives it its name. Call it once, last. After an Error the old file is
  /// as it was.
  Result<void> finish();

 private:
  NewFile(Descriptor file, std::string shown, std::string path, std::string name);
  /// Ensures that the file has a preliminary name, from which it can be renamed.
  Result<void> take_name();

  Descriptor file_;
  std::string shown_;  ///< The path as the user wrote it, for errors.
  std::string path_;   ///< The path without symbolic links.
  std::string name_;   ///< The preliminary name; empty for none.
  int slot_ = -1;      ///< Slot of the name for remove_unfinished_files(); -1 for none.
};

/// Writes all of the content to `path`; after an Error the old file is as it was.
[[nodiscard]] Result<void> write_file(const std::string& path, std::span<const std::byte> bytes);
[[nodiscard]] Result<void> write_file(const std::string& path, std::string_view text);

/// Removes the unfinished files of this process that have preliminary names. A signal handler may call it.
void remove_unfinished_files() noexcept;

/// Makes signals of the user, of the terminal or of a limit call remove_unfinished_files() before they end
/// the process. Signals that are ignored or have a handler are left alone. A program's main function calls
/// this.
void remove_unfinished_files_on_signals();

}  // namespace hooke::process
