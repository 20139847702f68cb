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
/// The flat format in which `hooke-import` hands a model over: a header, then vertices, indices, parts and
/// materials, little-endian, nothing between them. Its reader trusts no byte: the writer may have been taken
/// over by the file it parsed.

namespace hooke::io {

inline constexpr std::uint32_t kMaxModelVertices = 1u << 24;
inline constexpr std::uint32_t kMaxModelTriangles = 1u << 25;
inline constexpr std::uint32_t kMaxModelMaterials = 1u << 16;
inline constexpr std::size_t kMaxModelText = 255;   ///< Bytes of a material's or a texture's name.
inline constexpr float kMaxModelCoordinate = 1e9f;  ///< [m], either sign: squares stay far from overflow.

/// No model takes more bytes than this.
inline constexpr std::size_t kMaxFlatModelSize = std::size_t{1200} << 20;

/// How `hooke-import` ends; a reason on standard error goes with all but the first.
enum class ImporterExit : int {
  kDone = 0,
  kBadSyntax = 65,
  kNotReadable = 66,
  kOutOfRange = 67,
  kLimitExceeded = 68,
  kUnsupported = 69,
};

/// Printable UTF-8 of at most `kMaxModelText` bytes.
[[nodiscard]] bool is_clean_text(std::string_view text);

/// The same text with every byte that is not clean replaced by '_', cut to `kMaxModelText` bytes.
[[nodiscard]] std::string cleaned_text(std::string_view text);

/// A name of a file and not of a folder: no separators, not "." or "..". Empty is none, and is allowed.
[[nodiscard]] bool is_bare_file_name(std::string_view name);

/// Tells what is wrong with the drawn half of a model (`mesh` and `welded_of` are not read), or nothing:
/// counts, indices, ranges, finite coordinates, unit normals, clean text.
[[nodiscard]] Result<void> check_model(const Model& model);

/// The drawn half of a model that `check_model` accepts, as bytes.
[[nodiscard]] std::vector<std::byte> write_flat_model(const Model& model);

/// The model in `bytes`, checked by `check_model`, without `mesh` and `welded_of`. Textures are bare file
/// names. Allocates no more than a small multiple of the bytes given.
[[nodiscard]] Result<Model> read_flat_model(std::span<const std::byte> bytes);

}  // namespace hooke::io
