#pragma once

#include "hooke/result.h"

#include "process/new_file.h"

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace hooke::app {

/// Tells whether a path means the standard output: "-" or "/dev/stdout".
bool is_standard_output(const std::string& path);

/// An OutputFile appears under its name only when it is complete. Pipes and devices are written directly.
class OutputFile {
 public:
  /// Opens a file. The Error is kFileNotWritable if the folder or file refuses.
  static Result<OutputFile> create(const std::string& path);

  /// Writes a text. If that fails, finish() returns the error.
  void write(std::string_view text);

  /// Flushes the file and gives it its name. Call it once, last.
  Result<void> finish();

 private:
  struct Closer {
    void operator()(std::FILE* file) const {
      if (file != stdout) std::fclose(file);
    }
  };

  OutputFile(std::FILE* file, std::string path, std::optional<process::NewFile> whole)
      : whole_(std::move(whole)), file_(file), path_(std::move(path)) {}

  std::optional<process::NewFile> whole_;  ///< Empty for what is written directly.
  std::unique_ptr<std::FILE, Closer> file_;
  std::string path_;
};

/// Writes all of a text; after an Error the old file is as it was. Pipes and devices are written directly.
Result<void> write_file(const std::string& path, std::string_view text);

}  // namespace hooke::app
