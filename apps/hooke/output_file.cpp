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

constexpr mode_t kUsualMode = 0666;

Error failure(const std::string& path, const std::string& reason) {
  return {ErrorCode::kFileNotWritable, path, "cannot be written: " + reason};
}

}  // namespace

bool is_standard_output(const std::string& path) {
  return path == "-" || path == "/dev/stdout";
}

Result<OutputFile> OutputFile::create(const std::string& path) {
  if (is_standard_output(path)) return OutputFile(stdout, path, "");
  std::error_code code;
  const fs::path real = fs::is_symlink(path, code) ? fs::weakly_canonical(path, code) : fs::path(path);
  const fs::file_status status = fs::status(real, code);
  if (fs::is_directory(status)) return failure(path, "it is a folder");
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    std::FILE* device = std::fopen(path.c_str(), "w");
    if (device == nullptr) return failure(path, std::strerror(errno));
    return OutputFile(device, path, "");
  }
  const std::string temporary = real.string() + ".part" + std::to_string(::getpid());
  const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kUsualMode);
  std::FILE* file = descriptor >= 0 ? ::fdopen(descriptor, "w") : nullptr;
  if (file == nullptr) return failure(path, std::strerror(errno));
  return OutputFile(file, real.string(), temporary);
}

OutputFile::~OutputFile() {
  if (file_ != nullptr && !temporary_.empty()) ::unlink(temporary_.c_str());
}

void OutputFile::write(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), file_.get());
}

Result<void> OutputFile::finish() {
  errno = 0;
  const bool flushed = std::fflush(file_.get()) == 0 && std::ferror(file_.get()) == 0;
  if (!flushed) return failure(path_, errno != 0 ? std::strerror(errno) : "an earlier write failed");
  if (temporary_.empty()) return {};
  if (::fsync(::fileno(file_.get())) != 0) return failure(path_, std::strerror(errno));
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) return failure(path_, std::strerror(errno));
  file_.reset();
  return {};
}

Result<void> write_file(const std::string& path, std::string_view text) {
  auto file = OutputFile::create(path);
  if (!file) return file.error();
  file.value().write(text);
  return file.value().finish();
}

}  // namespace hooke::app
