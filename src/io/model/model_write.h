#pragma once

#include "hooke/math.h"
#include "hooke/model_io.h"

#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

/// \file
/// Writes mesh formats, each from a model that `check_model` accepts to the bytes of a file, in meters. The
/// same model gives the same bytes. Images of their own files are referred to by their bare names.

namespace hooke::io {

using Bytes = std::vector<std::byte>;

/// Appends a value as it lies in memory, little-endian.
template <class T>
void put(Bytes& bytes, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  const std::size_t at = bytes.size();
  bytes.resize(at + sizeof(T));
  std::memcpy(bytes.data() + at, &value, sizeof(T));
}

inline void put_text(Bytes& bytes, std::string_view text) {
  const std::size_t at = bytes.size();
  bytes.resize(at + text.size());
  if (!text.empty()) std::memcpy(bytes.data() + at, text.data(), text.size());
}

/// Returns the image's name without its folders. It is empty for none, and for a name that no format can
/// hold.
[[nodiscard]] std::string image_name(const ModelMaterial& material);

/// Returns a name for each material, in printable ASCII of at most `size` bytes. No two are the same, even
/// when case is ignored.
[[nodiscard]] std::vector<std::string> plain_material_names(const Model& model, std::size_t size);

/// Converts a linear value to sRGB, each in [0, 1].
[[nodiscard]] float srgb_of_linear(float value);

[[nodiscard]] bool has_uvs(const Model& model);

/// Converts a vector from y up to z up.
[[nodiscard]] inline std::array<float, 3> stand_on_z(const std::array<float, 3>& v) {
  return {v[0], -v[2], v[1]};
}

struct ObjText {
  std::string obj;
  std::string mtl;
};

/// Writes with y up, and each position, normal and texture coordinate once. `library` is the name of the .mtl
/// file.
[[nodiscard]] ObjText write_obj(const Model& model, std::string_view library);

/// Writes the binary form with z up. It has no place for materials, texture coordinates and smooth normals.
[[nodiscard]] Bytes write_stl(const Model& model);

/// Returns the roughness whose highlight has this Blinn-Phong exponent: exponent = 2 / roughness^4 - 2
/// (Karis, 2013).
[[nodiscard]] float roughness_of(float shininess);

/// Whether glTF can hold the image: a PNG or a JPEG, by its first bytes.
[[nodiscard]] bool is_gltf_image(const std::vector<std::byte>& bytes);

/// Writes one mesh with a primitive for each part. Images that `is_gltf_image` accepts are held in the file;
/// others are referred to by their names beside it.
[[nodiscard]] Bytes write_glb(const Model& model);

/// Writes with z up, and smoothing groups from the creases of the normals. Objects hold at most 65535
/// vertices and faces each, so a large model becomes several.
[[nodiscard]] Bytes write_3ds(const Model& model);

}  // namespace hooke::io
