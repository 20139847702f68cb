#include "hooke/export/motion_look.h"

#include "render/batches.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdlib.h>
#include <system_error>
#include <utility>

namespace hooke::app {

namespace {

namespace fs = std::filesystem;

std::vector<std::byte> read_bytes(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> content{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  std::vector<std::byte> bytes(content.size());
  if (!content.empty()) std::memcpy(bytes.data(), content.data(), content.size());
  return bytes;
}

/// Tells whether a file is PNG or JPEG, which formats of motion hold, by its first bytes.
bool is_portable(const std::vector<std::byte>& bytes) {
  const auto begins = [&](std::initializer_list<int> signature) {
    return bytes.size() > signature.size() &&
           std::equal(signature.begin(), signature.end(), bytes.begin(),
                      [](int a, std::byte b) { return std::byte(a) == b; });
  };
  return begins({0x89, 'P', 'N', 'G'}) || begins({0xFF, 0xD8, 0xFF});
}

/// Returns the content of a PNG file of the image; empty if there is no place for temporary files.
std::vector<std::byte> png_of(const render::Image& image) {
  std::string folder = (fs::temp_directory_path() / "hooke_image_XXXXXX").string();
  if (::mkdtemp(folder.data()) == nullptr) return {};
  const fs::path path = fs::path(folder) / "image.png";
  std::vector<std::byte> bytes;
  if (render::write_png(image, path.string())) bytes = read_bytes(path);
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  return bytes;
}

}  // namespace

std::shared_ptr<const render::Image> MotionLooks::load(const std::string& path, const ImageBytes& bytes,
                                                       ImageUse use) {
  const auto [entry, is_new] = images_.try_emplace({path, bytes, use});
  if (!is_new) return entry->second;
  auto image = bytes ? render::decode_image(*bytes, path) : render::load_image(path);
  if (!image) {
    warnings_.push_back(to_line(image.error()));
    return nullptr;
  }
  render::Image seen = use == ImageUse::kNormals ? render::normals_of(image.value()) : image.value();
  const bool is_changed = seen.pixels != image.value().pixels;
  entry->second = std::make_shared<const render::Image>(std::move(seen));
  auto file = std::make_shared<MotionImage>();
  file->name = fs::path(path).filename().string();
  file->bytes = bytes ? *bytes : read_bytes(path);
  if (is_changed || !is_portable(file->bytes)) {
    file->name = fs::path(path).stem().string() + ".png";
    file->bytes = png_of(*entry->second);
  }
  if (file->bytes.empty()) {
    warnings_.push_back(path + ": is left out, as it could not be made a PNG file");
  } else {
    files_[entry->second.get()] = std::move(file);
  }
  return entry->second;
}

std::shared_ptr<const MotionImage> MotionLooks::file_of(const render::Image* image) const {
  const auto file = files_.find(image);
  return file == files_.end() ? nullptr : file->second;
}

std::uint32_t MotionLooks::find(MotionRecording& motion, const Finish& finish, const std::string& name,
                                bool two_sided) {
  const render::Color c = finish.color;
  const Key key = {name,
                   {c.r, c.g, c.b, finish.opacity, finish.shininess, finish.roughness, finish.metalness,
                    finish.transmission, finish.relief},
                   {finish.texture.get(), finish.normals.get(), finish.finish.get()},
                   two_sided};
  const auto [entry, is_new] = numbers_.try_emplace(key);
  if (!is_new) return entry->second;
  MotionMaterial material;
  material.name = name.empty() ? "look" : name;
  material.color = render::linear_of(c);
  material.opacity = finish.opacity;
  material.shininess = finish.shininess;
  material.roughness = std::clamp(finish.roughness, 0.0F, 1.0F);
  material.metalness = std::clamp(finish.metalness, 0.0F, 1.0F);
  material.transmission = std::clamp(finish.transmission, 0.0F, 1.0F);
  material.two_sided = two_sided;
  material.image = file_of(finish.texture.get());
  material.cutout = material.image != nullptr && finish.texture->channels == 4;
  material.normal_map = file_of(finish.normals.get());
  material.normal_scale = finish.relief;
  material.roughness_map = file_of(finish.finish.get());
  entry->second = motion.add_material(std::move(material));
  return entry->second;
}

}  // namespace hooke::app
