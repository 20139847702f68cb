#include "convert.h"

#include "io/model/model_flat.h"
#include "limits.h"
#include "refusal.h"

#include <algorithm>
#include <array>
#include <assimp/GltfMaterial.h>
#include <assimp/ObjMaterial.h>
#include <assimp/material.h>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace hooke::importer {

namespace {

using io::ImporterExit;
// Corners of a polygon; triangulating takes the square of it, or the cube.
constexpr unsigned kMaxCorners = 4096;

using DMat4 = Matrix4<double>;
using DMat3 = Matrix3<double>;

DMat4 matrix_of(const aiMatrix4x4& a) {
  return {{{a.a1, a.b1, a.c1, a.d1},
           {a.a2, a.b2, a.c2, a.d2},
           {a.a3, a.b3, a.c3, a.d3},
           {a.a4, a.b4, a.c4, a.d4}}};
}

DVec3 vector_of(const aiVector3D& v) {
  return {v.x, v.y, v.z};
}

/// Returns the rotation from the frame that the importer gives into Hooke's, without scale.
DMat3 rotation_of(const Frame& frame) {
  const DMat3 from_z = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};  // x, y, z up -> x, z, -y
  const DMat3 from_x = {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};  // x up, y, z -> -y, x, z
  const DMat3 to_file = frame.stands_upright ? transpose(from_z) : DMat3{};
  if (frame.up == UpAxis::kZ) return from_z * to_file;
  return frame.up == UpAxis::kX ? from_x * to_file : to_file;
}

float linear_of_srgb(float value) {
  return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

float fraction(float value, float fallback) {
  return std::isfinite(value) ? std::clamp(value, 0.0f, 1.0f) : fallback;
}

/// Returns the Blinn-Phong exponent whose highlight has this roughness: 2 / roughness^4 - 2 (Karis, 2013).
float shininess_of(float roughness) {
  const float squared = std::max(roughness * roughness, 0.04f);
  return std::clamp(2.0f / (squared * squared) - 2.0f, 1.0f, 1000.0f);
}

std::string bare_name(const std::string& path) {
  const auto separator = path.find_last_of("/\\:");
  const std::string name = separator == std::string::npos ? path : path.substr(separator + 1);
  return io::is_bare_file_name(name) ? name : std::string();
}

/// Replaces each %XX by the byte it stands for.
std::string percent_decoded(const std::string& text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned byte = 0;
    const char* digits = text.data() + i + 1;
    const bool is_escape = text[i] == '%' && i + 2 < text.size() &&
                           std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2;
    result += is_escape ? static_cast<char>(byte) : text[i];
    i += is_escape ? 2 : 0;
  }
  return result;
}

/// Takes the image that the file itself holds; none if it is not encoded, or too large.
void take_embedded(const aiTexture* texture, std::string& file, ImageBytes& image) {
  if (texture == nullptr || texture->mHeight != 0 || texture->mWidth == 0) return;
  if (texture->mWidth > io::kMaxImageSize) {
    throw Refusal(ImporterExit::kLimitExceeded, "an image of more than 64 MiB");
  }
  const auto* first = reinterpret_cast<const std::byte*>(texture->pcData);
  image = std::make_shared<const std::vector<std::byte>>(first, first + texture->mWidth);
  file = bare_name(texture->mFilename.C_Str());
  const bool is_png = texture->mWidth > 4 && std::to_integer<int>(first[0]) == 0x89;
  if (file.find('.') == std::string::npos) {
    if (file.empty()) file = "texture";
    file += is_png ? ".png" : ".jpg";
  }
}

/// The images of a scene that were taken, each once, however many materials have it.
using TakenImages = std::map<const aiTexture*, std::pair<std::string, ImageBytes>>;

/// Where textures come from.
struct TextureSource {
  const aiScene& scene;
  bool names_are_uris;
  TakenImages& taken;
};

/// Takes the first of some textures that a material has: the name of a file, or an image in the model.
void take_texture(const TextureSource& source, const aiMaterial& material,
                  std::initializer_list<aiTextureType> types, std::string& file, ImageBytes& image) {
  aiString name;
  const bool found = std::any_of(types.begin(), types.end(), [&](aiTextureType type) {
    return material.GetTexture(type, 0, &name) == aiReturn_SUCCESS;
  });
  if (!found || name.length == 0) return;
  if (name.C_Str()[0] != '*') {
    file = bare_name(source.names_are_uris ? percent_decoded(name.C_Str()) : name.C_Str());
    return;
  }
  const aiTexture* texture = source.scene.GetEmbeddedTexture(name.C_Str());
  const auto [entry, is_new] = source.taken.try_emplace(texture);
  if (is_new) take_embedded(texture, entry->second.first, entry->second.second);
  file = entry->second.first;
  image = entry->second.second;
}

/// Adds metalness and roughness as a file gives them, and what its images say of them and of the relief.
void take_finish(const TextureSource& source, const aiMaterial& material, ModelMaterial& result) {
  float metalness = 0.0f;
  if (material.Get(AI_MATKEY_METALLIC_FACTOR, metalness) == aiReturn_SUCCESS)
    result.metalness = fraction(metalness, 0.0f);
  float roughness = 0.0f;
  if (material.Get(AI_MATKEY_ROUGHNESS_FACTOR, roughness) == aiReturn_SUCCESS) {
    result.roughness = fraction(roughness, 1.0f);
    result.shininess = shininess_of(*result.roughness);
  }
  take_texture(source, material, {aiTextureType_NORMALS, aiTextureType_NORMAL_CAMERA, aiTextureType_HEIGHT},
               result.normal_map.file, result.normal_map.bytes);
  float scale = 1.0f;
  if (material.Get(AI_MATKEY_GLTF_TEXTURE_SCALE(aiTextureType_NORMALS, 0), scale) == aiReturn_SUCCESS ||
      material.Get(AI_MATKEY_OBJ_BUMPMULT_HEIGHT(0), scale) == aiReturn_SUCCESS) {
    result.normal_scale = std::isfinite(scale) ? std::clamp(scale, -100.0f, 100.0f) : 1.0f;
  }
  // Only glTF has both in one image.
  if (!source.names_are_uris) return;
  take_texture(source, material,
               {aiTextureType_METALNESS, aiTextureType_DIFFUSE_ROUGHNESS, aiTextureType_UNKNOWN},
               result.roughness_map.file, result.roughness_map.bytes);
}

ModelMaterial material_of(const TextureSource& source, const aiMaterial& material, const Frame& frame) {
  ModelMaterial result;
  result.name = io::cleaned_text(material.GetName().C_Str());
  aiColor4D color(result.color[0], result.color[1], result.color[2], 1.0f);
  const bool has_color = material.Get(AI_MATKEY_BASE_COLOR, color) == aiReturn_SUCCESS ||
                         material.Get(AI_MATKEY_COLOR_DIFFUSE, color) == aiReturn_SUCCESS;
  const std::array<float, 3> channels = {color.r, color.g, color.b};
  for (std::size_t i = 0; has_color && i < 3; ++i) {
    const float value = fraction(channels[i], result.color[i]);
    result.color[i] = frame.stores_srgb ? linear_of_srgb(value) : value;
  }
  float opacity = 1.0f;
  if (material.Get(AI_MATKEY_OPACITY, opacity) == aiReturn_SUCCESS) result.opacity = fraction(opacity, 1.0f);
  float shininess = 0.0f;
  if (material.Get(AI_MATKEY_SHININESS, shininess) == aiReturn_SUCCESS && shininess > 0.0f) {
    result.shininess = std::min(shininess, 1000.0f);
  }
  take_finish(source, material, result);
  take_texture(source, material, {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}, result.texture,
               result.image);
  return result;
}

/// Adds the meshes of a scene, node by node.
class Builder {
 public:
  Builder(const aiScene& scene, const Frame& frame) : scene_(scene), has_normals_(frame.has_normals) {
    TakenImages taken;
    const TextureSource source = {scene, frame.names_are_uris, taken};
    for (unsigned i = 0; frame.has_materials && i < scene.mNumMaterials; ++i) {
      soup_.materials.push_back(material_of(source, *scene.mMaterials[i], frame));
    }
    if (soup_.materials.empty()) soup_.materials.emplace_back();
    if (soup_.materials.size() > io::kMaxModelMaterials) {
      throw Refusal(ImporterExit::kLimitExceeded, "more than 65536 materials");
    }
  }

  void add_mesh(unsigned index, const DMat4& transform) {
    if (index >= scene_.mNumMeshes) throw Refusal(ImporterExit::kBadSyntax, "a node without its mesh");
    is_placed_[index] = true;
    const aiMesh& mesh = *scene_.mMeshes[index];
    const std::size_t base = soup_.positions.size();
    if (base + mesh.mNumVertices > io::kMaxModelVertices ||
        soup_.triangles.size() + mesh.mNumFaces > io::kMaxModelTriangles) {
      throw Refusal(ImporterExit::kLimitExceeded, "more than 2^24 vertices or 2^25 triangles");
    }
    const DMat3 linear = linear_part(transform);
    const double mirror = determinant(linear) < 0 ? -1.0 : 1.0;
    // Cofactors are the inverse transpose times the determinant, and exist for a flattening transform, too.
    const DMat3 cofactors = {mirror * cross(linear.y, linear.z), mirror * cross(linear.z, linear.x),
                             mirror * cross(linear.x, linear.y)};
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) add_vertex(mesh, i, transform, cofactors);
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      add_face(mesh.mFaces[i], mesh, static_cast<std::uint32_t>(base), mirror < 0);
    }
  }

  /// Adds objects that no node of the keyframer names; a .3ds has them at their final positions.
  void add_unplaced(const DMat4& transform) {
    for (unsigned i = 0; i < scene_.mNumMeshes; ++i) {
      if (!is_placed_[i]) add_mesh(i, transform);
    }
  }

  [[nodiscard]] io::Soup take() { return std::move(soup_); }

 private:
  void add_vertex(const aiMesh& mesh, unsigned i, const DMat4& transform, const DMat3& cofactors) {
    soup_.positions.push_back(transform_point(transform, vector_of(mesh.mVertices[i])));
    const DVec3 normal =
        has_normals_ && mesh.HasNormals() ? normalize(cofactors * vector_of(mesh.mNormals[i])) : DVec3{};
    soup_.normals.push_back(is_finite(normal) ? normal : DVec3{});
    std::array<float, 2> uv = {};
    if (mesh.HasTextureCoords(0)) uv = {mesh.mTextureCoords[0][i].x, mesh.mTextureCoords[0][i].y};
    const auto is_usable = [](float v) { return std::abs(v) <= io::kMaxModelCoordinate; };
    soup_.uvs.push_back(is_usable(uv[0]) && is_usable(uv[1]) ? uv : std::array<float, 2>{});
  }

  void add_face(const aiFace& face, const aiMesh& mesh, std::uint32_t base, bool is_mirrored) {
    if (face.mNumIndices < 3) return;  // Points and lines have nothing to collide with.
    if (face.mNumIndices > kMaxCorners) {
      throw Refusal(ImporterExit::kLimitExceeded, "a polygon of more than 4096 corners");
    }
    corners_.clear();
    for (unsigned i = 0; i < face.mNumIndices; ++i) {
      if (face.mIndices[i] >= mesh.mNumVertices) {
        throw Refusal(ImporterExit::kBadSyntax, "a face past the last vertex");
      }
      corners_.push_back(soup_.positions[base + face.mIndices[i]]);
      if (!is_finite(corners_.back())) {
        throw Refusal(ImporterExit::kOutOfRange, "a vertex whose position is not finite");
      }
    }
    const unsigned last_material = static_cast<unsigned>(soup_.materials.size() - 1);
    for (const io::Triangle& local : io::triangulate(corners_)) {
      io::Triangle triangle = {};
      std::transform(local.begin(), local.end(), triangle.begin(),
                     [&](std::uint32_t i) { return base + face.mIndices[i]; });
      if (is_mirrored) std::swap(triangle[1], triangle[2]);
      soup_.triangles.push_back(triangle);
      soup_.material_of.push_back(std::min(mesh.mMaterialIndex, last_material));
    }
  }

  const aiScene& scene_;
  bool has_normals_;
  std::vector<bool> is_placed_ = std::vector<bool>(scene_.mNumMeshes, false);
  io::Soup soup_;
  std::vector<DVec3> corners_;  ///< Scratch memory of add_face.
};

void add_nodes(Builder& builder, const aiNode& root) {
  struct Visit {
    const aiNode* node;
    DMat4 parent;
    int depth;
  };
  std::vector<Visit> open = {{&root, {}, 1}};
  int count = 0;
  while (!open.empty()) {
    const Visit visit = open.back();
    open.pop_back();
    if (visit.depth > kMaxNodeDepth + 1 || ++count > 2 * kMaxNodeCount) {
      throw Refusal(ImporterExit::kLimitExceeded, "too many nodes, or nodes stacked more than 64 deep");
    }
    const DMat4 world = visit.parent * matrix_of(visit.node->mTransformation);
    for (unsigned i = 0; i < visit.node->mNumMeshes; ++i) builder.add_mesh(visit.node->mMeshes[i], world);
    for (unsigned i = visit.node->mNumChildren; i-- > 0;) {
      open.push_back({visit.node->mChildren[i], world, visit.depth + 1});
    }
  }
}

/// Drops the points that no triangle uses, because their coordinates may be anything.
void compact(io::Soup& soup) {
  constexpr auto kUnused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> moved(soup.positions.size(), kUnused);
  for (const io::Triangle& triangle : soup.triangles) {
    for (const std::uint32_t i : triangle) moved[i] = 0;
  }
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < moved.size(); ++i) {
    if (moved[i] == kUnused) continue;
    moved[i] = count++;
    soup.positions[moved[i]] = soup.positions[i];
    soup.normals[moved[i]] = soup.normals[i];
    soup.uvs[moved[i]] = soup.uvs[i];
  }
  soup.positions.resize(count);
  soup.normals.resize(count);
  soup.uvs.resize(count);
  for (io::Triangle& triangle : soup.triangles) {
    for (std::uint32_t& i : triangle) i = moved[i];
  }
}

struct Bounds {
  DVec3 low, high;
};

Bounds bounds_of(const std::vector<DVec3>& points) {
  DVec3 low = points[0];
  DVec3 high = points[0];
  for (const DVec3 p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return {low, high};
}

double longest_side(const Bounds& bounds) {
  const DVec3 size = bounds.high - bounds.low;
  return std::max({size.x, size.y, size.z});
}

/// Returns the place, before it is scaled, that becomes the origin.
DVec3 origin_of(const Bounds& bounds, ModelOrigin origin) {
  if (origin == ModelOrigin::kFile) return {};
  DVec3 middle = 0.5 * (bounds.low + bounds.high);
  if (origin == ModelOrigin::kBottom) middle.y = bounds.low.y;
  return middle;
}

void place(io::Soup& soup, const Frame& frame) {
  const DMat3 rotation = rotation_of(frame);
  for (DVec3& p : soup.positions) p = rotation * p;
  for (DVec3& n : soup.normals) n = rotation * n;
  const Bounds bounds = bounds_of(soup.positions);
  const double scale = frame.fit > 0 ? frame.fit / longest_side(bounds) : frame.scale;
  const DVec3 origin = origin_of(bounds, frame.origin);
  for (DVec3& p : soup.positions) {
    p = scale * (p - origin);
    if (!(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= io::kMaxModelCoordinate)) {
      throw Refusal(ImporterExit::kOutOfRange, "a coordinate beyond 1e9 m: choose a smaller scale");
    }
    // The positions are rounded to float here, so that welding sees the numbers that are written.
    p = vector_cast<double>(vector_cast<float>(p));
  }
}

}  // namespace

io::Soup convert_scene(const aiScene& scene, const Frame& frame) {
  Builder builder(scene, frame);
  if (scene.mRootNode != nullptr) {
    add_nodes(builder, *scene.mRootNode);
    if (frame.stands_upright) builder.add_unplaced(matrix_of(scene.mRootNode->mTransformation));
  }
  io::Soup soup = builder.take();
  if (soup.triangles.empty()) throw Refusal(ImporterExit::kOutOfRange, "no triangles");
  compact(soup);
  place(soup, frame);
  return soup;
}

}  // namespace hooke::importer
