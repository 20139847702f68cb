#include "files.h"

#include "io/folder_file.h"
#include "limits.h"
#include "refusal.h"
#include "text_encoding.h"

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace hooke::importer {

namespace {

using io::ImporterExit;

/// Serves bytes in memory to assimp.
class MemoryStream : public Assimp::IOStream {
 public:
  explicit MemoryStream(std::span<const std::byte> bytes) : bytes_(bytes) {}

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
    if (target > bytes_.size()) return aiReturn_FAILURE;  // A wrapped difference is larger, too.
    at_ = target;
    return aiReturn_SUCCESS;
  }
  std::size_t Tell() const override { return at_; }
  std::size_t FileSize() const override { return bytes_.size(); }
  void Flush() override {}
  // NOLINTEND(readability-identifier-naming)

 private:
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
};

class OpenFile {
 public:
  explicit OpenFile(const std::string& path)
      : number_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY | O_NOFOLLOW)) {}
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

std::vector<std::byte> read_model_file(const std::string& path, std::size_t limit) {
  const std::filesystem::path named(path);
  const auto real = io::resolve_in_folder(named.parent_path(), named.filename().string());
  if (!real) throw Refusal(ImporterExit::kNotReadable, real.error().message);
  const OpenFile file(*real);
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
    if (got == 0) break;  // The file was shortened while it was read.
    at += static_cast<std::size_t>(got);
  }
  bytes.resize(at);
  return is_text(named.extension().string()) ? to_utf8(std::move(bytes)) : bytes;
}

ModelFolder::ModelFolder(std::string path, std::span<const std::byte> bytes,
                         const std::vector<std::string>& companions)
    : path_(std::move(path)), bytes_(bytes) {
  const std::filesystem::path folder = std::filesystem::path(path_).parent_path();
  std::size_t budget = kMaxFileSize - std::min(bytes.size(), kMaxFileSize);
  for (const std::string& name : companions) {
    try {
      std::vector<std::byte> read = read_model_file((folder / name).string(), budget);
      budget -= std::min(read.size(), budget);
      companions_.emplace(name, std::move(read));
    } catch (const Refusal&) {
      continue;  // The importer may need it and fail, or may not need it.
    }
  }
}

const std::vector<std::byte>* ModelFolder::find(const std::string& file) const {
  const auto separator = file.find_last_of("/\\");
  const auto found = companions_.find(separator == std::string::npos ? file : file.substr(separator + 1));
  return found == companions_.end() ? nullptr : &found->second;
}

bool ModelFolder::Exists(const char* file) const {
  return file == path_ || find(file) != nullptr;
}

Assimp::IOStream* ModelFolder::Open(const char* file, const char* mode) {
  if (mode == nullptr || mode[0] != 'r') return nullptr;
  if (file == path_) return std::make_unique<MemoryStream>(bytes_).release();
  const std::vector<std::byte>* bytes = find(file);
  return bytes != nullptr ? std::make_unique<MemoryStream>(*bytes).release() : nullptr;
}

void ModelFolder::Close(Assimp::IOStream* stream) {
  const std::unique_ptr<Assimp::IOStream> ends_here(stream);
}

}  // namespace hooke::importer
