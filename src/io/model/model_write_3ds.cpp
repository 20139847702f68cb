#include "io/model/model_geometry.h"
#include "io/model/model_write.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <numeric>

namespace hooke::io {

namespace {

constexpr std::size_t kMaxPerObject = 65535;  // The format counts vertices and faces in 16 bits.
constexpr std::size_t kMaxMaterialName = 16;
constexpr double kSameNormal = 0.97;  // Cosine of 14 degrees; normals made for each corner differ a little.

/// Writes a chunk's header now and its size on destruction.
class Chunk {
 public:
  Chunk(Bytes& bytes, std::uint16_t kind) : bytes_(bytes), start_(bytes.size()) {
    put(bytes_, kind);
    put(bytes_, std::uint32_t{0});
  }
  Chunk(const Chunk&) = delete;
  Chunk& operator=(const Chunk&) = delete;
  ~Chunk() {
    const auto size = static_cast<std::uint32_t>(bytes_.size() - start_);
    std::memcpy(bytes_.data() + start_ + 2, &size, sizeof(size));
  }

 private:
  Bytes& bytes_;
  std::size_t start_;
};

template <class T>
void put_chunk(Bytes& bytes, std::uint16_t kind, const T& content) {
  const Chunk chunk(bytes, kind);
  put(bytes, content);
}

void put_name(Bytes& bytes, std::string_view name) {
  put_text(bytes, name);
  put(bytes, '\0');
}

void put_color(Bytes& bytes, std::uint16_t kind, const std::array<float, 3>& linear) {
  const Chunk chunk(bytes, kind);
  std::array<std::uint8_t, 3> color = {};
  std::transform(linear.begin(), linear.end(), color.begin(), [](float channel) {
    return static_cast<std::uint8_t>(std::lround(255.0f * srgb_of_linear(channel)));
  });
  put_chunk(bytes, 0x0011, color);
}

void put_percent(Bytes& bytes, std::uint16_t kind, float percent) {
  const Chunk chunk(bytes, kind);
  put_chunk(bytes, 0x0030, static_cast<std::uint16_t>(std::lround(std::clamp(percent, 0.0f, 100.0f))));
}

void put_material(Bytes& bytes, const ModelMaterial& material, const std::string& name) {
  const Chunk chunk(bytes, 0xAFFF);
  {
    const Chunk name_chunk(bytes, 0xA000);
    put_name(bytes, name);
  }
  put_color(bytes, 0xA010, material.color);         // Ambient.
  put_color(bytes, 0xA020, material.color);         // Diffuse.
  put_color(bytes, 0xA030, {0.03f, 0.03f, 0.03f});  // Specular.
  put_chunk(bytes, 0xA100, std::uint16_t{3});       // Phong; a shading without highlights loses the exponent.
  put_percent(bytes, 0xA040, material.shininess);   // Read back as the exponent.
  put_percent(bytes, 0xA041, 50.0f);                // Strength of the highlight.
  put_percent(bytes, 0xA050, 100.0f * (1.0f - material.opacity));  // Transparency.
  const std::string image = image_name(material);
  if (image.empty()) return;
  const Chunk texture(bytes, 0xA200);
  put_chunk(bytes, 0x0030, std::uint16_t{100});
  const Chunk file(bytes, 0xA300);
  put_name(bytes, image);
}

/// Patches has the triangles around each welded point, and for each triangle the patch of smooth surface it
/// belongs to.
class Patches {
 public:
  explicit Patches(const Model& model) : model_(model) {
    Model welded;
    welded.vertices = model.vertices;
    welded.indices = model.indices;
    weld_model(welded);
    welded_of_ = std::move(welded.welded_of);
    point_count_ = welded.mesh.positions.size();
    parent_.resize(model.indices.size() / 3);
    std::iota(parent_.begin(), parent_.end(), 0u);
    unite_smooth_neighbors();
  }

  /// Returns a set of smoothing groups, one bit, for each triangle. Patches that meet share no bit. With more
  /// than 32 patches at a point some do, and the crease between them is lost.
  [[nodiscard]] std::vector<std::uint32_t> masks() {
    std::vector<std::vector<std::uint32_t>> patches_at(point_count_);
    std::vector<std::vector<std::uint32_t>> points_of(parent_.size());
    for (std::uint32_t t = 0; t < parent_.size(); ++t) {
      const std::uint32_t patch = root(t);
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t point = welded_of_[model_.indices[std::size_t{3} * t + i]];
        auto& here = patches_at[point];
        if (std::find(here.begin(), here.end(), patch) != here.end()) continue;
        here.push_back(patch);
        points_of[patch].push_back(point);
      }
    }
    std::vector<std::uint32_t> mask(parent_.size(), 0);
    for (std::uint32_t patch = 0; patch < parent_.size(); ++patch) {
      std::uint32_t taken = 0;
      for (const std::uint32_t point : points_of[patch]) {
        for (const std::uint32_t other : patches_at[point]) taken |= mask[other];
      }
      if (!points_of[patch].empty())
        mask[patch] = 1u << (~taken == 0 ? 31u : static_cast<unsigned>(std::countr_one(taken)));
    }
    // The root of a patch is its first triangle.
    for (std::uint32_t t = 0; t < parent_.size(); ++t) mask[t] = mask[root(t)];
    return mask;
  }

 private:
  std::uint32_t root(std::uint32_t t) {
    for (; parent_[t] != t; t = parent_[t]) parent_[t] = parent_[parent_[t]];
    return t;
  }

  struct Edge {
    std::uint32_t triangle = 0;
    std::array<DVec3, 2> normals = {};  ///< Normals at the two ends of the edge, the lower point first.
  };

  /// Joins two triangles into one patch when they have about the same normals at both ends of their edge.
  void unite_smooth_neighbors() {
    std::map<std::array<std::uint32_t, 2>, Edge> first_at;
    for (std::uint32_t t = 0; t < parent_.size(); ++t) {
      for (std::size_t i = 0; i < 3; ++i) {
        std::array<std::uint32_t, 2> vertex = {model_.indices[std::size_t{3} * t + i],
                                               model_.indices[std::size_t{3} * t + (i + 1) % 3]};
        if (welded_of_[vertex[1]] < welded_of_[vertex[0]]) std::swap(vertex[0], vertex[1]);
        const Edge edge = {t, {normal_of(vertex[0]), normal_of(vertex[1])}};
        const auto [entry, is_new] =
            first_at.try_emplace({welded_of_[vertex[0]], welded_of_[vertex[1]]}, edge);
        const Edge& other = entry->second;
        if (dot(edge.normals[0], other.normals[0]) < kSameNormal) continue;
        if (dot(edge.normals[1], other.normals[1]) < kSameNormal) continue;
        const std::uint32_t a = root(other.triangle);
        const std::uint32_t b = root(t);
        parent_[std::max(a, b)] = std::min(a, b);
      }
    }
  }

  [[nodiscard]] DVec3 normal_of(std::uint32_t vertex) const {
    const auto& n = model_.vertices[vertex].normal;
    return {n[0], n[1], n[2]};
  }

  const Model& model_;
  std::vector<std::uint32_t> welded_of_;
  std::size_t point_count_ = 0;
  std::vector<std::uint32_t> parent_;
};

/// This is the content of one object of the file.
class Object {
 public:
  [[nodiscard]] bool is_full() const {
    return faces.size() == kMaxPerObject || positions.size() + 3 > kMaxPerObject;
  }

  /// Returns the number of a vertex; equal positions and image coordinates get the same number.
  [[nodiscard]] std::uint16_t add(const ModelVertex& vertex) {
    const auto next = static_cast<std::uint16_t>(positions.size());
    const auto [entry, is_new] = known_.try_emplace({vertex.position, vertex.uv}, next);
    if (is_new) {
      positions.push_back(stand_on_z(vertex.position));
      uvs.push_back(vertex.uv);
    }
    return entry->second;
  }

  std::vector<std::array<float, 3>> positions = {};
  std::vector<std::array<float, 2>> uvs = {};
  std::vector<std::array<std::uint16_t, 3>> faces = {};
  std::vector<std::uint32_t> masks = {};
  std::vector<std::uint32_t> material_of = {};

 private:
  std::map<std::pair<std::array<float, 3>, std::array<float, 2>>, std::uint16_t> known_ = {};
};

std::vector<Object> split(const Model& model) {
  const std::vector<std::uint32_t> masks = Patches(model).masks();
  std::vector<Object> objects(1);
  for (const ModelPart& part : model.parts) {
    for (std::uint32_t i = part.first; i < part.first + part.count; i += 3) {
      if (objects.back().is_full()) objects.emplace_back();
      Object& object = objects.back();
      std::array<std::uint16_t, 3> face = {};
      for (std::size_t k = 0; k < 3; ++k) face[k] = object.add(model.vertices[model.indices[i + k]]);
      object.faces.push_back(face);
      object.masks.push_back(masks[i / 3]);
      object.material_of.push_back(part.material);
    }
  }
  return objects;
}

/// Writes the faces, their materials and their smoothing groups.
void put_faces(Bytes& bytes, const Object& object, const std::vector<std::string>& names) {
  constexpr std::uint16_t kAllEdgesVisible = 7;
  const Chunk chunk(bytes, 0x4120);
  put(bytes, static_cast<std::uint16_t>(object.faces.size()));
  for (const auto& face : object.faces) {
    put(bytes, face);
    put(bytes, kAllEdgesVisible);
  }
  for (std::size_t first = 0; first < object.faces.size();) {  // Parts are runs of one material.
    std::size_t last = first;
    while (last < object.faces.size() && object.material_of[last] == object.material_of[first]) ++last;
    const Chunk material(bytes, 0x4130);
    put_name(bytes, names[object.material_of[first]]);
    put(bytes, static_cast<std::uint16_t>(last - first));
    for (; first < last; ++first) put(bytes, static_cast<std::uint16_t>(first));
  }
  const Chunk smoothing(bytes, 0x4150);
  for (const std::uint32_t mask : object.masks) put(bytes, mask);
}

void put_object(Bytes& bytes, const Object& object, std::size_t number, const std::vector<std::string>& names,
                bool with_uvs) {
  const Chunk chunk(bytes, 0x4000);
  std::array<char, 16> name = {};
  // Names have at most ten characters.
  std::snprintf(name.data(), name.size(), "model%05zu", number % 100000);
  put_name(bytes, name.data());
  const Chunk mesh(bytes, 0x4100);
  {
    const Chunk vertices(bytes, 0x4110);
    put(bytes, static_cast<std::uint16_t>(object.positions.size()));
    for (const auto& position : object.positions) put(bytes, position);
  }
  if (with_uvs) {
    const Chunk uvs(bytes, 0x4140);
    put(bytes, static_cast<std::uint16_t>(object.uvs.size()));
    for (const auto& uv : object.uvs) put(bytes, uv);
  }
  constexpr std::array<float, 12> kIdentity = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
  put_chunk(bytes, 0x4160, kIdentity);
  put_faces(bytes, object, names);
}

}  // namespace

Bytes write_3ds(const Model& model) {
  const std::vector<std::string> names = plain_material_names(model, kMaxMaterialName);
  const std::vector<Object> objects = split(model);
  const bool with_uvs = has_uvs(model);
  Bytes bytes;
  {
    const Chunk main(bytes, 0x4D4D);
    put_chunk(bytes, 0x0002, std::uint32_t{3});
    const Chunk editor(bytes, 0x3D3D);
    put_chunk(bytes, 0x3D3E, std::uint32_t{3});
    for (std::size_t m = 0; m < model.materials.size(); ++m) {
      put_material(bytes, model.materials[m], names[m]);
    }
    put_chunk(bytes, 0x0100, 1.0f);  // Master scale.
    for (std::size_t i = 0; i < objects.size(); ++i) put_object(bytes, objects[i], i, names, with_uvs);
  }
  return bytes;
}

}  // namespace hooke::io
