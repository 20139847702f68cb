#include "io/model/model_write.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

namespace hooke::io {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kFloat = 5126;  // These are constants of OpenGL that glTF uses.
constexpr int kUnsignedInt = 5125;
constexpr int kVertexBuffer = 34962;
constexpr int kIndexBuffer = 34963;

/// Encodes a text for a URI: everything but letters, digits and "-._~" becomes %XX (RFC 3986).
std::string percent_encoded(const std::string& text) {
  constexpr std::string_view kHexDigits = "0123456789ABCDEF";
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                          c == '-' || c == '.' || c == '_' || c == '~';
    if (is_plain) {
      result += c;
    } else {
      result += {'%', kHexDigits[byte >> 4u], kHexDigits[byte & 15u]};
    }
  }
  return result;
}

/// The images that the file holds, in the order of their bytes after the geometry.
struct HeldImages {
  std::vector<ImageBytes> images;
  std::vector<std::size_t> views;  // The view of each.
  std::size_t size = 0;            // [bytes], each filled up to a multiple of four
};

/// Adds an image: a view of the bytes appended to `held`, each once, or a name beside the file.
Json image_entry(Json& document, const ModelMaterial& material, std::size_t base, HeldImages& held) {
  if (!material.image || !is_gltf_image(*material.image)) {
    return {{"uri", percent_encoded(image_name(material))}};
  }
  auto found = std::find(held.images.begin(), held.images.end(), material.image);
  if (found == held.images.end()) {
    document["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", base + held.size}, {"byteLength", material.image->size()}});
    held.views.push_back(document["bufferViews"].size() - 1);
    held.images.push_back(material.image);
    held.size += (material.image->size() + 3) / 4 * 4;
    found = held.images.end() - 1;
  }
  const bool is_png = std::to_integer<int>((*material.image)[0]) == 0x89;
  return {{"bufferView", held.views[static_cast<std::size_t>(found - held.images.begin())]},
          {"mimeType", is_png ? "image/png" : "image/jpeg"},
          {"name", std::filesystem::path(image_name(material)).stem().string()}};
}

void put_materials(Json& document, const Model& model, std::size_t base, HeldImages& held) {
  for (const ModelMaterial& material : model.materials) {
    Json surface = {
        {"baseColorFactor", {material.color[0], material.color[1], material.color[2], material.opacity}},
        {"metallicFactor", 0.0f},
        {"roughnessFactor", roughness_of(material.shininess)}};
    if (const std::string image = image_name(material); !image.empty()) {
      surface["baseColorTexture"] = {{"index", document["textures"].size()}};
      document["textures"].push_back({{"source", document["images"].size()}});
      document["images"].push_back(image_entry(document, material, base, held));
    }
    Json entry = {{"name", material.name}, {"pbrMetallicRoughness", surface}};
    if (material.opacity < 1.0f) entry["alphaMode"] = "BLEND";
    document["materials"].push_back(entry);
  }
}

/// Writes the bounds that glTF requires with positions.
void put_bounds(Json& accessor, const Model& model) {
  std::array<float, 3> low = model.vertices[0].position;
  std::array<float, 3> high = low;
  for (const ModelVertex& vertex : model.vertices) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], vertex.position[i]);
      high[i] = std::max(high[i], vertex.position[i]);
    }
  }
  accessor["min"] = low;
  accessor["max"] = high;
}

void put_geometry(Json& document, const Model& model, std::size_t vertex_bytes, std::size_t index_bytes) {
  document["bufferViews"] = {
      {{"buffer", 0},
       {"byteOffset", 0},
       {"byteLength", vertex_bytes},
       {"byteStride", sizeof(ModelVertex)},
       {"target", kVertexBuffer}},
      {{"buffer", 0}, {"byteOffset", vertex_bytes}, {"byteLength", index_bytes}, {"target", kIndexBuffer}}};
  const auto vertex_column = [&](std::size_t offset, const char* type) {
    return Json{{"bufferView", 0},
                {"byteOffset", offset},
                {"componentType", kFloat},
                {"count", model.vertices.size()},
                {"type", type}};
  };
  document["accessors"] = {vertex_column(offsetof(ModelVertex, position), "VEC3"),
                           vertex_column(offsetof(ModelVertex, normal), "VEC3"),
                           vertex_column(offsetof(ModelVertex, uv), "VEC2")};
  put_bounds(document["accessors"][0], model);
  Json attributes = {{"POSITION", 0}, {"NORMAL", 1}};
  if (has_uvs(model)) {
    attributes["TEXCOORD_0"] = 2;
  } else {
    document["accessors"].erase(2);
  }
  Json primitives = Json::array();
  for (const ModelPart& part : model.parts) {
    primitives.push_back(
        {{"attributes", attributes}, {"indices", document["accessors"].size()}, {"material", part.material}});
    document["accessors"].push_back({{"bufferView", 1},
                                     {"byteOffset", std::size_t{4} * part.first},
                                     {"componentType", kUnsignedInt},
                                     {"count", part.count},
                                     {"type", "SCALAR"}});
  }
  document["meshes"] = {{{"primitives", primitives}}};
}

}  // namespace

float roughness_of(float shininess) {
  return std::pow(2.0f / (shininess + 2.0f), 0.25f);
}

bool is_gltf_image(const std::vector<std::byte>& bytes) {
  const auto byte = [&](std::size_t i) { return std::to_integer<int>(bytes[i]); };
  if (bytes.size() < 8) return false;
  return (byte(0) == 0x89 && byte(1) == 'P' && byte(2) == 'N' && byte(3) == 'G') ||
         (byte(0) == 0xFF && byte(1) == 0xD8 && byte(2) == 0xFF);
}

Bytes write_glb(const Model& model) {
  const std::size_t vertex_bytes = model.vertices.size() * sizeof(ModelVertex);
  const std::size_t index_bytes = model.indices.size() * sizeof(std::uint32_t);
  Json document = {{"asset", {{"version", "2.0"}, {"generator", "Hooke"}}},
                   {"scene", 0},
                   {"scenes", {{{"nodes", {0}}}}},
                   {"nodes", {{{"mesh", 0}}}},
                   {"buffers", Json::array()}};  // its place; the images decide its length
  HeldImages held;
  put_geometry(document, model, vertex_bytes, index_bytes);
  put_materials(document, model, vertex_bytes + index_bytes, held);
  const std::size_t buffer_bytes = vertex_bytes + index_bytes + held.size;
  document["buffers"] = {{{"byteLength", buffer_bytes}}};
  std::string text = document.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');

  Bytes bytes;
  bytes.reserve(28 + text.size() + buffer_bytes);
  put_text(bytes, "glTF");
  put(bytes, std::uint32_t{2});
  put(bytes, static_cast<std::uint32_t>(28 + text.size() + buffer_bytes));
  put(bytes, static_cast<std::uint32_t>(text.size()));
  put_text(bytes, "JSON");
  put_text(bytes, text);
  put(bytes, static_cast<std::uint32_t>(buffer_bytes));
  put_text(bytes, std::string_view("BIN\0", 4));
  for (ModelVertex vertex : model.vertices) {
    vertex.uv[1] = 1.0f - vertex.uv[1];  // glTF counts rows from the top.
    put(bytes, vertex);
  }
  for (const std::uint32_t index : model.indices) put(bytes, index);
  for (const auto& image : held.images) {
    bytes.insert(bytes.end(), image->begin(), image->end());
    bytes.resize((bytes.size() + 3) / 4 * 4);
  }
  return bytes;
}

}  // namespace hooke::io
