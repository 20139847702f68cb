#include "io/model/model_flat.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <type_traits>
#include <utility>

namespace hooke::io {

namespace {

constexpr std::array<char, 8> kMagic = {'h', 'o', 'o', 'k', 'e', 'm', 'd', 'l'};
constexpr std::uint32_t kVersion = 3;
constexpr std::uint32_t kNoImage = 0xFFFFFFFF;
constexpr float kNoRoughness = -1.0f;
// Tolerance of a squared length; rounding to float is a thousand times less.
constexpr float kUnitTolerance = 1e-3f;

struct Header {
  std::array<char, 8> magic = kMagic;
  std::uint32_t version = kVersion;
  std::uint32_t vertex_count = 0;
  std::uint32_t index_count = 0;
  std::uint32_t part_count = 0;
  std::uint32_t material_count = 0;
  std::uint32_t image_count = 0;
};
static_assert(sizeof(Header) == 32 && std::is_trivially_copyable_v<Header>);
static_assert(sizeof(ModelVertex) == 32 && std::is_trivially_copyable_v<ModelVertex>);
static_assert(sizeof(ModelPart) == 12 && std::is_trivially_copyable_v<ModelPart>);

struct MaterialRecord {
  std::array<float, 3> color = {};
  float opacity = 0.0f;
  float shininess = 0.0f;
  float metalness = 0.0f;
  float roughness = kNoRoughness;
  float normal_scale = 1.0f;
  std::uint16_t name_size = 0;
  // Of the color, the normals, and the roughness.
  std::array<std::uint16_t, 3> file_size = {};
  std::array<std::uint32_t, 3> image = {};  // Numbers of the images, or kNoImage.
};
static_assert(sizeof(MaterialRecord) == 52 && std::is_trivially_copyable_v<MaterialRecord>);

Error wrong(std::string message) {
  return {.code = ErrorCode::kOutOfRange, .message = std::move(message)};
}

/// Returns the length of the UTF-8 sequence at the start of `text`, or 0 if it is not printable.
std::size_t clean_sequence(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) return byte(0) >= 0x20 && byte(0) != 0x7F ? 1 : 0;
  const std::size_t size = byte(0) >= 0xF0 ? 4 : byte(0) >= 0xE0 ? 3 : 2;
  if (byte(0) < 0xC2 || byte(0) > 0xF4 || text.size() < size) return 0;
  std::uint32_t code = byte(0) & (0x7Fu >> size);
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xC0u) != 0x80u) return 0;
    code = (code << 6u) | (byte(i) & 0x3Fu);
  }
  // 0x80 to 0x9F are control characters.
  constexpr std::array<std::uint32_t, 5> kSmallest = {0, 0, 0xA0, 0x800, 0x10000};
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  const bool format_control = (code >= 0x200B && code <= 0x200F) || (code >= 0x2028 && code <= 0x202E);
  return code < kSmallest[size] || code > 0x10FFFF || surrogate || format_control ? 0 : size;
}

bool in_range(float value, float low, float high) {
  return value >= low && value <= high;  // This is false for a NaN.
}

bool is_sound(const ModelVertex& vertex) {
  const auto fits = [](float value) { return in_range(value, -kMaxModelCoordinate, kMaxModelCoordinate); };
  const auto [x, y, z] = vertex.normal;
  return std::all_of(vertex.position.begin(), vertex.position.end(), fits) &&
         std::all_of(vertex.uv.begin(), vertex.uv.end(), fits) &&
         in_range(x * x + y * y + z * z, 1.0f - kUnitTolerance, 1.0f + kUnitTolerance);
}

bool is_sound(const ModelMaterial& material) {
  const auto is_fraction = [](float value) { return in_range(value, 0.0f, 1.0f); };
  return std::all_of(material.color.begin(), material.color.end(), is_fraction) &&
         is_fraction(material.opacity) && in_range(material.shininess, 0.0f, 1e6f) &&
         is_fraction(material.metalness) && is_fraction(material.roughness.value_or(0.0f)) &&
         in_range(material.normal_scale, -100.0f, 100.0f) && is_clean_text(material.name);
}

Result<void> check_parts(const Model& model) {
  std::size_t next = 0;
  for (const ModelPart& part : model.parts) {
    if (part.first != next || part.count == 0 || part.count % 3 != 0) return wrong("a part with a bad range");
    if (part.material >= model.materials.size()) return wrong("a part without a material");
    next += part.count;
    if (next > model.indices.size()) return wrong("a part past the last index");
  }
  if (next != model.indices.size()) return wrong("triangles that belong to no part");
  return {};
}

Result<void> check_counts(std::size_t vertices, std::size_t indices, std::size_t parts,
                          std::size_t materials) {
  if (vertices == 0 || indices == 0) return wrong("no triangles");
  if (vertices > kMaxModelVertices || indices / 3 > kMaxModelTriangles) {
    return Error{.code = ErrorCode::kLimitExceeded, .message = "more than 2^24 vertices or 2^25 triangles"};
  }
  if (indices % 3 != 0) return wrong("an index count that is no multiple of three");
  if (parts > indices / 3 || materials == 0 || materials > kMaxModelMaterials) {
    return wrong("a bad number of parts or materials");
  }
  return {};
}

/// Takes values off the front of a span, and refuses when the span is too short.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : rest_(bytes) {}

  [[nodiscard]] bool take(void* target, std::size_t size) {
    if (size > rest_.size()) return false;
    if (size > 0) std::memcpy(target, rest_.data(), size);
    rest_ = rest_.subspan(size);
    return true;
  }

  template <class T>
  [[nodiscard]] bool take_column(std::vector<T>& column, std::size_t count) {
    if (count > rest_.size() / sizeof(T)) return false;  // This is checked before memory is allocated.
    column.resize(count);
    return take(column.data(), count * sizeof(T));
  }

  [[nodiscard]] bool take_text(std::string& text, std::size_t size) {
    if (size > rest_.size()) return false;
    text.resize(size);
    return take(text.data(), size);
  }

  [[nodiscard]] bool is_empty() const { return rest_.empty(); }

 private:
  std::span<const std::byte> rest_;
};

bool take_images(Reader& reader, std::uint32_t count, std::vector<ImageBytes>& images) {
  for (std::uint32_t i = 0; i < count; ++i) {
    std::uint32_t size = 0;
    std::vector<std::byte> bytes;
    if (!reader.take(&size, sizeof(size)) || size > kMaxImageSize) return false;
    if (!reader.take_column(bytes, size)) return false;
    images.push_back(std::make_shared<const std::vector<std::byte>>(std::move(bytes)));
  }
  return true;
}

bool take_material(Reader& reader, const std::vector<ImageBytes>& images, ModelMaterial& material) {
  MaterialRecord record;
  if (!reader.take(&record, sizeof(record))) return false;
  const std::array<ImageBytes*, 3> targets = {&material.image, &material.normal_map.bytes,
                                              &material.roughness_map.bytes};
  for (std::size_t i = 0; i < targets.size(); ++i) {
    if (record.image[i] == kNoImage) continue;
    if (record.image[i] >= images.size()) return false;
    *targets[i] = images[record.image[i]];
  }
  material.color = record.color;
  material.opacity = record.opacity;
  material.shininess = record.shininess;
  material.metalness = record.metalness;
  if (record.roughness != kNoRoughness) material.roughness = record.roughness;
  material.normal_scale = record.normal_scale;
  return reader.take_text(material.name, record.name_size) &&
         reader.take_text(material.texture, record.file_size[0]) &&
         reader.take_text(material.normal_map.file, record.file_size[1]) &&
         reader.take_text(material.roughness_map.file, record.file_size[2]);
}

/// Returns the images of a material and the names of their files, in the order of the record.
std::array<std::pair<const ImageBytes*, const std::string*>, 3> images_of(const ModelMaterial& material) {
  return {{{&material.image, &material.texture},
           {&material.normal_map.bytes, &material.normal_map.file},
           {&material.roughness_map.bytes, &material.roughness_map.file}}};
}

void put_bytes(std::vector<std::byte>& bytes, const void* data, std::size_t size) {
  const auto* first = static_cast<const std::byte*>(data);
  bytes.insert(bytes.end(), first, first + size);
}

}  // namespace

bool is_clean_text(std::string_view text) {
  if (text.size() > kMaxModelText) return false;
  while (!text.empty()) {
    const std::size_t size = clean_sequence(text);
    if (size == 0) return false;
    text.remove_prefix(size);
  }
  return true;
}

std::string cleaned_text(std::string_view text) {
  std::string clean;
  while (!text.empty()) {
    const std::size_t size = clean_sequence(text);
    if (clean.size() + std::max<std::size_t>(size, 1) > kMaxModelText) break;
    clean += size == 0 ? std::string_view("_") : text.substr(0, size);
    text.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return clean;
}

bool is_bare_file_name(std::string_view name) {
  return is_clean_text(name) && name != "." && name != ".." &&
         name.find_first_of("/\\") == std::string_view::npos;
}

Result<void> check_model(const Model& model) {
  if (auto counts = check_counts(model.vertices.size(), model.indices.size(), model.parts.size(),
                                 model.materials.size());
      !counts) {
    return counts;
  }
  if (!std::all_of(model.vertices.begin(), model.vertices.end(),
                   [](const ModelVertex& vertex) { return is_sound(vertex); })) {
    return wrong("a vertex that is not finite, farther than 1e9 m, or without a unit normal");
  }
  const auto vertex_count = model.vertices.size();
  if (!std::all_of(model.indices.begin(), model.indices.end(),
                   [&](std::uint32_t index) { return index < vertex_count; })) {
    return wrong("an index past the last vertex");
  }
  if (!std::all_of(model.materials.begin(), model.materials.end(),
                   [](const ModelMaterial& material) { return is_sound(material); })) {
    return wrong("a material with a value out of range or an unreadable name");
  }
  return check_parts(model);
}

std::vector<std::byte> write_flat_model(const Model& model) {
  std::vector<ImageBytes> images;  // Each once, however many materials share it.
  for (const ModelMaterial& material : model.materials) {
    for (const auto& [image, file] : images_of(material)) {
      if (*image && std::find(images.begin(), images.end(), *image) == images.end()) images.push_back(*image);
    }
  }
  const Header header = {.vertex_count = static_cast<std::uint32_t>(model.vertices.size()),
                         .index_count = static_cast<std::uint32_t>(model.indices.size()),
                         .part_count = static_cast<std::uint32_t>(model.parts.size()),
                         .material_count = static_cast<std::uint32_t>(model.materials.size()),
                         .image_count = static_cast<std::uint32_t>(images.size())};
  std::vector<std::byte> bytes;
  bytes.reserve(sizeof(Header) + model.vertices.size() * sizeof(ModelVertex) + model.indices.size() * 4 +
                model.parts.size() * sizeof(ModelPart) + model.materials.size() * 96);
  put_bytes(bytes, &header, sizeof(header));
  put_bytes(bytes, model.vertices.data(), model.vertices.size() * sizeof(ModelVertex));
  put_bytes(bytes, model.indices.data(), model.indices.size() * sizeof(std::uint32_t));
  put_bytes(bytes, model.parts.data(), model.parts.size() * sizeof(ModelPart));
  for (const ImageBytes& image : images) {
    const auto size = static_cast<std::uint32_t>(image->size());
    put_bytes(bytes, &size, sizeof(size));
    put_bytes(bytes, image->data(), image->size());
  }
  for (const ModelMaterial& material : model.materials) {
    MaterialRecord record = {.color = material.color,
                             .opacity = material.opacity,
                             .shininess = material.shininess,
                             .metalness = material.metalness,
                             .roughness = material.roughness.value_or(kNoRoughness),
                             .normal_scale = material.normal_scale,
                             .name_size = static_cast<std::uint16_t>(material.name.size())};
    const auto all = images_of(material);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const ImageBytes& image = *all[i].first;
      record.file_size[i] = static_cast<std::uint16_t>(all[i].second->size());
      record.image[i] =
          image ? static_cast<std::uint32_t>(std::find(images.begin(), images.end(), image) - images.begin())
                : kNoImage;
    }
    put_bytes(bytes, &record, sizeof(record));
    put_bytes(bytes, material.name.data(), material.name.size());
    for (const auto& [image, file] : all) put_bytes(bytes, file->data(), file->size());
  }
  return bytes;
}

Result<Model> read_flat_model(std::span<const std::byte> bytes) {
  Reader reader(bytes);
  Header header;
  if (!reader.take(&header, sizeof(header)) || header.magic != kMagic || header.version != kVersion) {
    return wrong("not a flat model of this version");
  }
  if (auto counts =
          check_counts(header.vertex_count, header.index_count, header.part_count, header.material_count);
      !counts) {
    return counts.error();
  }
  Model model;
  if (!reader.take_column(model.vertices, header.vertex_count) ||
      !reader.take_column(model.indices, header.index_count) ||
      !reader.take_column(model.parts, header.part_count)) {
    return wrong("a flat model that ends early");
  }
  std::vector<ImageBytes> images;
  if (header.image_count / 3 > header.material_count || !take_images(reader, header.image_count, images)) {
    return wrong("a flat model with a bad image");
  }
  for (std::uint32_t i = 0; i < header.material_count; ++i) {
    if (!take_material(reader, images, model.materials.emplace_back()))
      return wrong("a flat model that ends early");
    for (const auto& [image, file] : images_of(model.materials.back())) {
      if (!is_bare_file_name(*file)) return wrong("a texture that is no file name");
    }
  }
  if (!reader.is_empty()) return wrong("a flat model with bytes left over");
  if (auto sound = check_model(model); !sound) return sound.error();
  return model;
}

}  // namespace hooke::io
