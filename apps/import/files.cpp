#include "files.h"

#include "limits.h"
#include "refusal.h"

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace hooke::importer {

namespace {

using io::ImporterExit;

/// Bytes in memory as assimp reads them.
class MemoryStream : public Assimp::IOStream {
 public:
  explicit MemoryStream(std::span<const std::byte> bytes) : bytes_(bytes) {}
  explicit MemoryStream(std::vector<std::byte> owned) : owned_(std::move(owned)), bytes_(owned_) {}

  // NOLINTBEGIN(readability-identifier-naming): assimp's names
  std::size_t Read(void* target, std::size_t size, std::size_t count) override {
    const std::size_t whole = size == 0 ? 0 : std::min(count, (bytes_.size() - at_) / size);
    if (whole > 0) std::memcpy(target, bytes_.data() + at_, whole * size);
    at_ += whole * size;
    return whole;
  }
  std::size_t Write(const void* /*data*/, std::size_t /*size*/, std::size_t /*count*/) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    const std::size_t base = origin == aiOrigin_CUR ? at_ : origin == aiOrigin_END ? bytes_.size() : 0;
    const std::size_t target = origin == aiOrigin_END ? base - offset : base + offset;
    if (target > bytes_.size()) return aiReturn_FAILURE;  // a wrapped difference is larger, too
    at_ = target;
    return aiReturn_SUCCESS;
  }
  std::size_t Tell() const override { return at_; }
  std::size_t FileSize() const override { return bytes_.size(); }
  void Flush() override {}
  // NOLINTEND(readability-identifier-naming)

 private:
  std::vector<std::byte> owned_;
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
};

class OpenFile {
 public:
  explicit OpenFile(const std::string& path)
      : number_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)) {}
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  ~OpenFile() {
    if (number_ >= 0) ::close(number_);
  }
  [[nodiscard]] int number() const { return number_; }

 private:
  int number_;
};

}  // namespace

std::vector<std::byte> read_regular_file(const std::string& path, std::size_t limit) {
  const OpenFile file(path);
  struct stat status = {};
  if (file.number() < 0 || ::fstat(file.number(), &status) != 0) {
    throw Refusal(ImporterExit::kNotReadable, std::generic_category().message(errno));
  }
  if (!S_ISREG(status.st_mode)) throw Refusal(ImporterExit::kNotReadable, "not a regular file");
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size > limit) throw Refusal(ImporterExit::kLimitExceeded, "larger than 256 MiB");
  std::vector<std::byte> bytes(size);
  std::size_t at = 0;
  while (at < size) {
    const ssize_t got = ::read(file.number(), bytes.data() + at, size - at);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw Refusal(ImporterExit::kNotReadable, std::generic_category().message(errno));
    if (got == 0) break;  // someone cuts the file while it is read
    at += static_cast<std::size_t>(got);
  }
  bytes.resize(at);
  return bytes;
}

ModelFolder::ModelFolder(std::string path, std::span<const std::byte> bytes)
    : path_(std::move(path)), bytes_(bytes), budget_(kMaxFileSize - bytes.size()) {}

std::string ModelFolder::beside(const std::string& file) const {
  const auto slash = path_.rfind('/');
  const std::string folder = slash == std::string::npos ? "" : path_.substr(0, slash + 1);
  const auto separator = file.find_last_of("/\\");
  return folder + (separator == std::string::npos ? file : file.substr(separator + 1));
}

bool ModelFolder::Exists(const char* file) const {
  struct stat status = {};
  return file == path_ || (::stat(beside(file).c_str(), &status) == 0 && S_ISREG(status.st_mode));
}

Assimp::IOStream* ModelFolder::Open(const char* file, const char* mode) {
  if (mode == nullptr || mode[0] != 'r') return nullptr;
  if (file == path_) return std::make_unique<MemoryStream>(bytes_).release();
  try {
    std::vector<std::byte> bytes = read_regular_file(beside(file), budget_);
    budget_ -= bytes.size();
    return std::make_unique<MemoryStream>(std::move(bytes)).release();
  } catch (const Refusal&) {
    return nullptr;  // assimp's word for a missing file
  }
}

void ModelFolder::Close(Assimp::IOStream* stream) {
  const std::unique_ptr<Assimp::IOStream> ends_here(stream);
}

}  // namespace hooke::importer
