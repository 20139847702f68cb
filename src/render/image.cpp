#include "render/image.h"

#include "hooke/math.h"

#include "process/new_file.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>

// These functions are static, because other libraries of a program bring their own copies. Formats that
// nobody needs and whose decoders had the most faults are left out.
#define STB_IMAGE_STATIC
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_NO_GIF
#define STBI_NO_PSD
#define STBI_NO_PIC
#define STBI_NO_HDR
#define STBI_NO_PNM
#define STBI_NO_STDIO
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image.h>
#include <stb/stb_image_write.h>

namespace hooke::render {

namespace {

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, FileCloser>;

struct PixelsFreer {
  void operator()(stbi_uc* pixels) const { stbi_image_free(pixels); }
};

void append_bytes(void* context, void* data, int size) {
  static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
}

Result<std::vector<std::uint8_t>> read_file(const std::string& path, std::size_t max_bytes) {
  std::error_code code;
  if (!std::filesystem::is_regular_file(path, code)) {
    return Error{ErrorCode::kFileNotReadable, path, "not a readable file"};
  }
  const std::uintmax_t size = std::filesystem::file_size(path, code);
  if (code) return Error{ErrorCode::kFileNotReadable, path, code.message()};
  if (size > max_bytes) {
    return Error{ErrorCode::kLimitExceeded, path,
                 std::to_string(size) + " bytes, at most " + std::to_string(max_bytes) + " are accepted"};
  }
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) return Error{ErrorCode::kFileNotReadable, path, std::strerror(errno)};
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  if (std::fread(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) {
    return Error{ErrorCode::kFileNotReadable, path, "the file ended early"};
  }
  return bytes;
}

/// Rounding of compressed images makes grays differ by so much.
constexpr int kGrayTolerance = 6;

bool is_gray(const Image& image) {
  const auto step = static_cast<std::size_t>(image.channels);
  for (std::size_t i = 0; i + 2 < image.pixels.size(); i += step) {
    const auto [low, high] = std::minmax({image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]});
    if (high - low > kGrayTolerance) return false;
  }
  return true;
}

std::uint8_t byte_of(float share) {
  // The middle is exact: 128 stands for zero, as the shaders read it.
  return static_cast<std::uint8_t>(std::clamp(std::round(128 + 127 * share), 0.0F, 255.0F));
}

}  // namespace

bool is_consistent(const Image& image) {
  if (image.width <= 0 || image.height <= 0 || (image.channels != 3 && image.channels != 4)) return false;
  const auto expected = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) *
                        static_cast<std::size_t>(image.channels);
  return image.pixels.size() == expected;
}

Result<void> write_png(const Image& image, const std::string& path) {
  if (!is_consistent(image))
    return Error{ErrorCode::kOutOfRange, path, "the image's size and pixels disagree"};
  std::string bytes;
  if (stbi_write_png_to_func(append_bytes, &bytes, image.width, image.height, image.channels,
                             image.pixels.data(), image.width * image.channels) == 0) {
    return Error{ErrorCode::kFileNotWritable, path, "cannot be written: not enough memory"};
  }
  return process::write_file(path, bytes);
}

Result<Image> load_image(const std::string& path, const ImageLimits& limits) {
  const auto bytes = read_file(path, limits.max_file_bytes);
  if (!bytes) return bytes.error();
  return decode_image(std::as_bytes(std::span(bytes.value())), path, limits);
}

Result<Image> decode_image(std::span<const std::byte> bytes, const std::string& path,
                           const ImageLimits& limits) {
  if (bytes.size() > limits.max_file_bytes)
    return Error{ErrorCode::kLimitExceeded, path, "the image has too many bytes"};
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const int size = static_cast<int>(bytes.size());
  Image image;
  int channels = 0;
  if (stbi_info_from_memory(data, size, &image.width, &image.height, &channels) == 0) {
    return Error{ErrorCode::kBadSyntax, path, "not a PNG, JPEG, BMP or TGA image"};
  }
  if (image.width > limits.max_side || image.height > limits.max_side) {
    return Error{ErrorCode::kLimitExceeded, path,
                 std::to_string(image.width) + " x " + std::to_string(image.height) + " pixels, at most " +
                     std::to_string(limits.max_side) + " a side are accepted"};
  }
  // Gray with alpha (2) also has transparency.
  image.channels = channels == 2 || channels == 4 ? 4 : 3;
  const std::unique_ptr<stbi_uc, PixelsFreer> pixels(
      stbi_load_from_memory(data, size, &image.width, &image.height, &channels, image.channels));
  if (!pixels) return Error{ErrorCode::kBadSyntax, path, stbi_failure_reason()};
  const auto count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) *
                     static_cast<std::size_t>(image.channels);
  image.pixels.assign(pixels.get(), pixels.get() + count);
  return image;
}

Image normals_of(const Image& image) {
  if (!is_consistent(image) || !is_gray(image)) return image;
  const auto height_at = [&](int x, int y) {
    const int column = (x + image.width) % image.width;
    const int row = (y + image.height) % image.height;
    const auto at =
        static_cast<std::size_t>(row * image.width + column) * static_cast<std::size_t>(image.channels);
    return static_cast<float>(image.pixels[at]) / 255;
  };
  Image normals = {image.width, image.height, 3, {}};
  normals.pixels.reserve(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 3);
  const float slope = 0.5F * kReliefHeight * static_cast<float>(image.width);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      // Rows count downward.
      const Vec3 normal = normalize(Vec3{slope * (height_at(x - 1, y) - height_at(x + 1, y)),
                                         slope * (height_at(x, y + 1) - height_at(x, y - 1)), 1});
      for (const auto part : {normal.x, normal.y, normal.z})
        normals.pixels.push_back(byte_of(static_cast<float>(part)));
    }
  }
  return normals;
}

}  // namespace hooke::render
