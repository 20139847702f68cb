#pragma once

#include "hooke/model_io.h"
#include "hooke/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// \file
/// Defines the flat format in which `hooke-import` passes a model on: a header, then vertices, indices,
/// parts, images and materials, little-endian, with nothing between them. Its reader trusts no byte, because
/// the file that the importer parsed may have taken it over.

namespace hooke::io {

inline constexpr std::uint32_t kMaxModelVertices = 1u << 24;
inline constexpr std::uint32_t kMaxModelTriangles = 1u << 25;
inline constexpr std::uint32_t kMaxModelMaterials = 1u << 16;
inline constexpr std::size_t kMaxImageSize = std::size_t{64} << 20;  ///< Bytes of an image in a model.
inline constexpr std::size_t kMaxModelText = 255;  ///< Bytes of the name of a material or a texture.
/// Largest coordinate of either sign [m], so that squares stay far from overflow.
inline constexpr float kMaxModelCoordinate = 1e9f;

/// This is the largest size of a model in bytes.
inline constexpr std::size_t kMaxFlatModelSize = std::size_t{1200} << 20;

/// This is how `hooke-import` ends. All codes but the first come with a reason on standard error.
enum class ImporterExit : int {
  kDone = 0,
  kBadSyntax = 65,
  kNotReadable = 66,
  kOutOfRange = 67,
  kLimitExceeded = 68,
  kUnsupported = 69,
};

/// Tells whether a text is printable UTF-8 of at most `kMaxModelText` bytes.
[[nodiscard]] bool is_clean_text(std::string_view text);

/// Returns the text with every byte that is not clean replaced by '_', cut to `kMaxModelText` bytes.
[[nodiscard]] std::string cleaned_text(std::string_view text);

/// Tells whether a name is that of a file in a folder: no separators, not "." or "..". An empty name stands
/// for none and is allowed.
[[nodiscard]] bool is_bare_file_name(std::string_view name);

/// Returns an Error if the drawn half of a model is wrong; `mesh` and `welded_of` are not read. It checks
/// counts, indices, ranges, finite coordinates, unit normals and clean text.
[[nodiscard]] Result<void> check_model(const Model& model);

/// Returns the drawn half of a model that `check_model` accepts, as bytes.
[[nodiscard]] std::vector<std::byte> write_flat_model(const Model& model);

/// Reads the model in `bytes`, checks it by `check_model`, and leaves out `mesh` and `welded_of`. Textures
/// are bare file names. It allocates no more than a small multiple of the bytes given.
[[nodiscard]] Result<Model> read_flat_model(std::span<const std::byte> bytes);

}  // namespace hooke::io
