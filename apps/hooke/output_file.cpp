#include "hooke/output_file.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <system_error>
#include <unistd.h>

namespace hooke::app {

namespace {

namespace fs = std::filesystem;

Error failure(const std::string& path, const std::string& reason) {
  return {ErrorCode::kFileNotWritable, path, "cannot be written: " + reason};
}

}  // namespace

bool is_standard_output(const std::string& path) {
  return path == "-" || path == "/dev/stdout";
}

Result<OutputFile> OutputFile::create(const std::string& path) {
  if (is_standard_output(path)) return OutputFile(stdout, path, std::nullopt);
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status)) {
    std::FILE* device = std::fopen(path.c_str(), "w");
    if (device == nullptr) return failure(path, std::strerror(errno));
    return OutputFile(device, path, std::nullopt);
  }
  auto whole = process::NewFile::create(path);
  if (!whole) return whole.error();
  const int copy = ::fcntl(whole->number(), F_DUPFD_CLOEXEC, 0);
  std::FILE* file = copy >= 0 ? ::fdopen(copy, "w") : nullptr;
  if (file == nullptr) return failure(path, std::strerror(errno));
  return OutputFile(file, path, std::move(*whole));
}

void OutputFile::write(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), file_.get());
}

Result<void> OutputFile::finish() {
  errno = 0;
  const bool flushed = std::fflush(file_.get()) == 0 && std::ferror(file_.get()) == 0;
  if (!flushed) return failure(path_, errno != 0 ? std::strerror(errno) : "an earlier write failed");
  return whole_ ? whole_->finish() : Result<void>();
}

Result<void> write_file(const std::string& path, std::string_view text) {
  auto file = OutputFile::create(path);
  if (!file) return file.error();
  file->write(text);
  return file->finish();
}

}  // namespace hooke::app
