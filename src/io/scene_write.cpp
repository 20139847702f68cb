#include "hooke/scene_io.h"

#include "io/scene_table.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace hooke {

namespace {

Error write_failure(const std::string& path) {
  return {ErrorCode::kFileNotWritable, path, std::string("cannot be written: ") + std::strerror(errno)};
}

}  // namespace

std::string write_scene(const Scene& scene) {
  return io::to_text(io::write_object(io::kind_of<Scene>(), &scene));
}

Result<void> save_scene(const Scene& scene, const std::string& path) {
  const std::string text = write_scene(scene);
  const std::string temporary = path + ".part";
  std::FILE* file = std::fopen(temporary.c_str(), "wb");
  if (file == nullptr) return write_failure(path);
  const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
  const bool closed = std::fclose(file) == 0;
  if (written && closed && std::rename(temporary.c_str(), path.c_str()) == 0) return {};
  const Error error = write_failure(path);
  std::remove(temporary.c_str());
  return error;
}

}  // namespace hooke
