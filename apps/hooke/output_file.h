#pragma once

#include "hooke/result.h"

#include "process/new_file.h"

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace hooke::app {

/// Whether the words mean the standard output: "-" or "/dev/stdout".
bool is_standard_output(const std::string& path);

/// A file that appears under its name only when it is complete. Pipes and devices are written as they are.
class OutputFile {
 public:
  /// kFileNotWritable if the folder or file refuses.
  static Result<OutputFile> create(const std::string& path);

  /// A write that fails shows in finish().
  void write(std::string_view text);

  /// Flushes and gives the file its name. Call once, last.
  Result<void> finish();

 private:
  struct Closer {
    void operator()(std::FILE* file) const {
      if (file != stdout) std::fclose(file);
    }
  };

  OutputFile(std::FILE* file, std::string path, std::optional<process::NewFile> whole)
      : whole_(std::move(whole)), file_(file), path_(std::move(path)) {}

  std::optional<process::NewFile> whole_;  ///< None for what is written in place.
  std::unique_ptr<std::FILE, Closer> file_;
  std::string path_;
};

/// All of it, or an Error and the old file; pipes and devices as above.
Result<void> write_file(const std::string& path, std::string_view text);

}  // namespace hooke::app
