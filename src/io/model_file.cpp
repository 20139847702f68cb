#include "io/model_file.h"

#include <cerrno>
#include <cstdlib>
#include <fcntl.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace hooke::io {

namespace {

constexpr mode_t kMode = S_IRUSR | S_IWUSR | S_IRGRP | S_IROTH;

Error system_error(const std::string& path) {
  return {ErrorCode::kFileNotWritable, path, std::generic_category().message(errno)};
}

bool write_all(int file, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t done = ::write(file, bytes.data(), bytes.size());
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(done));
  }
  return true;
}

/// Mode of the file that is replaced, or the usual one; mkstemp's is for the owner alone.
mode_t mode_for(const std::string& path) {
  struct stat status = {};
  return ::stat(path.c_str(), &status) == 0 ? status.st_mode & 0777u : kMode;
}

}  // namespace

Result<void> replace_file(const std::string& path, std::span<const std::byte> bytes) {
  struct stat status = {};
  if (::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) {
    return Error{ErrorCode::kFileNotWritable, path, "there is something that is no regular file"};
  }
  std::string temporary = path + ".XXXXXX";
  const int file = ::mkostemp(temporary.data(), O_CLOEXEC);
  if (file < 0) return system_error(path);
  bool done = ::fchmod(file, mode_for(path)) == 0 && write_all(file, bytes) && ::fsync(file) == 0;
  int reason = errno;
  if (::close(file) != 0 && done) {
    done = false;
    reason = errno;
  }
  if (done && ::rename(temporary.c_str(), path.c_str()) == 0) return {};
  if (done) reason = errno;
  ::unlink(temporary.c_str());
  errno = reason;
  return system_error(path);
}

}  // namespace hooke::io
