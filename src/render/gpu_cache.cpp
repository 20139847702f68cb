#include "render/gpu_cache.h"

#include <algorithm>
#include <cstddef>

namespace hooke::render {

namespace {

static_assert(sizeof(Vertex) == 8 * sizeof(float), "the vertex layout below has no gaps, and Real is float");

GpuMesh make_gpu_mesh(const std::shared_ptr<const MeshGeometry>& geometry) {
  GpuMesh mesh;
  mesh.owner = geometry;
  mesh.vertex_array = make_vertex_array();
  mesh.vertices = make_buffer();
  mesh.indices = make_buffer();
  // The revisions differ from those of the geometry, so that the first update uploads.
  mesh.vertex_revision = geometry->vertex_revision - 1;
  mesh.topology_revision = geometry->topology_revision - 1;
  glBindVertexArray(mesh.vertex_array.name());
  glBindBuffer(GL_ARRAY_BUFFER, mesh.vertices.name());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh.indices.name());
  const auto attribute = [](GLuint location, GLint size, std::size_t offset) {
    glEnableVertexAttribArray(location);
    glVertexAttribPointer(location, size, GL_FLOAT, GL_FALSE, sizeof(Vertex), buffer_offset(offset));
  };
  attribute(0, 3, offsetof(Vertex, position));
  attribute(1, 3, offsetof(Vertex, normal));
  attribute(2, 2, offsetof(Vertex, u));
  return mesh;
}

template <class T>
void upload(GLenum target, GLuint buffer, const std::vector<T>& data) {
  glBindBuffer(target, buffer);
  glBufferData(target, static_cast<GLsizeiptr>(data.size() * sizeof(T)), data.data(), GL_DYNAMIC_DRAW);
}

void upload_pixels(const Image& image, bool is_color) {
  // OpenGL counts rows from the bottom.
  const auto row = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
  std::vector<std::uint8_t> flipped(image.pixels.size());
  for (std::size_t y = 0; y < static_cast<std::size_t>(image.height); ++y) {
    const auto from = image.pixels.begin() + static_cast<std::ptrdiff_t>(y * row);
    std::copy_n(from, row, flipped.end() - static_cast<std::ptrdiff_t>((y + 1) * row));
  }
  const bool has_alpha = image.channels == 4;
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  const GLint format = is_color ? (has_alpha ? GL_SRGB8_ALPHA8 : GL_SRGB8) : (has_alpha ? GL_RGBA8 : GL_RGB8);
  glTexImage2D(GL_TEXTURE_2D, 0, format, image.width, image.height, 0, has_alpha ? GL_RGBA : GL_RGB,
               GL_UNSIGNED_BYTE, flipped.data());
}

}  // namespace

Result<const GpuMesh*> GpuCache::update(const std::shared_ptr<const MeshGeometry>& geometry,
                                        const std::string& where) {
  auto place = meshes_.find(geometry.get());
  // A new object may have the address of one that was destroyed.
  if (place != meshes_.end() && place->second.owner.expired()) {
    meshes_.erase(place);
    place = meshes_.end();
  }
  if (place == meshes_.end()) place = meshes_.emplace(geometry.get(), make_gpu_mesh(geometry)).first;
  GpuMesh& mesh = place->second;
  const bool new_topology =
      mesh.topology_revision != geometry->topology_revision || mesh.index_count != geometry->indices.size();
  const bool new_vertices =
      mesh.vertex_revision != geometry->vertex_revision || mesh.vertex_count != geometry->vertices.size();
  if (new_topology) {
    const auto largest = std::max_element(geometry->indices.begin(), geometry->indices.end());
    mesh.max_index = largest != geometry->indices.end() ? *largest : 0;
  }
  if (mesh.max_index >= geometry->vertices.size()) {
    const std::string message = "index " + std::to_string(mesh.max_index) + " is beyond the " +
                                std::to_string(geometry->vertices.size()) + " vertices";
    meshes_.erase(place);
    return Error{ErrorCode::kOutOfRange, where + ".indices", message};
  }
  glBindVertexArray(mesh.vertex_array.name());
  if (new_topology) upload(GL_ELEMENT_ARRAY_BUFFER, mesh.indices.name(), geometry->indices);
  if (new_vertices) upload(GL_ARRAY_BUFFER, mesh.vertices.name(), geometry->vertices);
  mesh.topology_revision = geometry->topology_revision;
  mesh.vertex_revision = geometry->vertex_revision;
  mesh.index_count = geometry->indices.size();
  mesh.vertex_count = geometry->vertices.size();
  return &mesh;
}

Result<GLuint> GpuCache::update(const std::shared_ptr<const Image>& image, bool is_color,
                                const std::string& where) {
  const auto place = textures_.find({image.get(), is_color});
  if (place != textures_.end() && !place->second.owner.expired()) return place->second.texture.name();
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  if (!is_consistent(*image) || std::max(image->width, image->height) > largest) {
    return Error{ErrorCode::kOutOfRange, where + ".texture",
                 "the image is inconsistent or larger than " + std::to_string(largest) + " pixels a side"};
  }
  GpuTexture made{image, make_texture()};
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, made.texture.name());
  upload_pixels(*image, is_color);
  glGenerateMipmap(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  const GLuint name = made.texture.name();
  textures_.insert_or_assign({image.get(), is_color}, std::move(made));
  return name;
}

void GpuCache::remove_orphans() {
  std::erase_if(meshes_, [](const auto& entry) { return entry.second.owner.expired(); });
  std::erase_if(textures_, [](const auto& entry) { return entry.second.owner.expired(); });
}

}  // namespace hooke::render
