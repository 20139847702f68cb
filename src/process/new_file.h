#pragma once

#include "hooke/result.h"

#include "process/child.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

/// \file
/// How every file is written: under its name it is complete, or as it was before.

namespace hooke::process {

/// A file that gets its name when it is complete. Until then it has none, where the file system allows that,
/// so that however the process ends nothing is left of it. Elsewhere its preliminary name goes with this
/// object, or by remove_unfinished_files().
class NewFile {
 public:
  enum class Start : std::uint8_t {
    kUnnamed,  ///< kNamed where that is not possible.
    kNamed,
  };

  /// Replaces the file at `path`, in the end; what a symbolic link there leads to, if it is one.
  /// kFileNotWritable if the folder refuses, or there is something that is no regular file.
  [[nodiscard]] static Result<NewFile> create(const std::string& path, Start start = Start::kUnnamed);

  NewFile(NewFile&& other) noexcept;
  NewFile& operator=(NewFile&& other) noexcept;
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;
  ~NewFile();

  /// Open for reading and writing; closed with this object.
  [[nodiscard]] int number() const { return file_.number(); }

  /// Appends. kFileNotWritable when not all of it can be written.
  Result<void> write(std::span<const std::byte> bytes);
  Result<void> write(std::string_view text);

  /// Brings it to the disk and gives it its name. Call once, last. On an Error the old file is as it was.
  Result<void> finish();

 private:
  NewFile(Descriptor file, std::string shown, std::string path, std::string name);
  /// The name that the file has before its own; made if there is none yet.
  Result<void> take_name();

  Descriptor file_;
  std::string shown_;  ///< As the user wrote it, for errors.
  std::string path_;   ///< Without links.
  std::string name_;   ///< Preliminary; empty for none.
  int slot_ = -1;      ///< Where the name stands for remove_unfinished_files(); -1 for nowhere.
};

/// All of it, or an Error and the old file.
[[nodiscard]] Result<void> write_file(const std::string& path, std::span<const std::byte> bytes);
[[nodiscard]] Result<void> write_file(const std::string& path, std::string_view text);

/// Removes the preliminary names of this process's files. May be called from a handler of signals.
void remove_unfinished_files() noexcept;

/// Calls remove_unfinished_files() before a signal of the user, of the terminal or of a limit ends the
/// process. Leaves alone signals that are ignored or have a handler. For a program's main function.
void remove_unfinished_files_on_signals();

}  // namespace hooke::process
