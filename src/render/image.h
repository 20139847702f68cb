#pragma once

#include "hooke/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace hooke::render {

/// An Image is bytes of sRGB color, in rows from top to bottom without padding.
struct Image {
  int width = 0;
  int height = 0;
  int channels = 3;  ///< 3 is RGB, 4 is RGB and alpha.
  std::vector<std::uint8_t> pixels;

  friend bool operator==(const Image&, const Image&) = default;
};

/// Tells whether the sizes are positive, the channels 3 or 4 and the pixels as many as these say.
bool is_consistent(const Image& image);

/// Writes the picture by process::write_file, so that `path` never leads to an incomplete file.
Result<void> write_png(const Image& image, const std::string& path);

/// These limits bound the cost of a file from an unknown source.
struct ImageLimits {
  std::size_t max_file_bytes = std::size_t{64} << 20;
  int max_side = 8192;  ///< [px]
};

/// Reads PNG, JPEG, BMP or TGA. A file with transparency gives four channels, any other three.
Result<Image> load_image(const std::string& path, const ImageLimits& limits = {});

/// Reads the same from the bytes of a file; `name` stands in messages.
Result<Image> decode_image(std::span<const std::byte> bytes, const std::string& name,
                           const ImageLimits& limits = {});

/// Height between black and white of an image of heights, in widths of the image: files give no unit.
inline constexpr float kReliefHeight = 1.0F / 64;

/// Returns an image of normals: red to the right, green up, blue outward, each from -1 to 1. An image of
/// grays is taken for heights, which repeat at its rim; one with colors is returned as it is.
Image normals_of(const Image& image);

}  // namespace hooke::render
