#include "hooke/drawing/insight_drawing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

namespace hooke::app {

namespace {

constexpr float kPointSize = 4;     ///< Half the size of the cross of a point [px].
constexpr float kLineWidth = 1.8F;  ///< [px]
constexpr float kLoadWidth = 6;     ///< Width of a line whose color tells a load [px].
/// Colored triangles stand nearer to the eye than the surface they lie on, by this share of their distance.
constexpr float kNearer = 0.004F;

render::Color color_of(DebugColor color) {
  return {color.r, color.g, color.b};
}

std::uint8_t byte_of(float share) {
  return static_cast<std::uint8_t>(255 * std::clamp(share, 0.0F, 1.0F) + 0.5F);
}

/// The colors of a mesh as a texture of one row: each triangle has one of them.
class Palette {
 public:
  /// The column of a color.
  std::size_t column_of(DebugColor color) {
    const auto [found, is_new] = columns_.try_emplace(
        std::tuple(byte_of(color.r), byte_of(color.g), byte_of(color.b)), columns_.size());
    if (is_new) {
      for (const float share : {color.r, color.g, color.b}) pixels_.push_back(byte_of(share));
    }
    return found->second;
  }
  [[nodiscard]] std::size_t size() const { return columns_.size(); }
  [[nodiscard]] std::shared_ptr<const render::Image> image() const {
    return std::make_shared<render::Image>(
        render::Image{.width = static_cast<int>(size()), .height = 1, .channels = 3, .pixels = pixels_});
  }

 private:
  std::map<std::tuple<std::uint8_t, std::uint8_t, std::uint8_t>, std::size_t> columns_;
  std::vector<std::uint8_t> pixels_;
};

void add_triangles(const Insight& insight, DVec3 origin, render::DrawList& list) {
  if (insight.triangles.empty()) return;
  Palette palette;
  std::vector<std::size_t> columns;
  for (const Insight::Triangle& triangle : insight.triangles)
    columns.push_back(palette.column_of(triangle.color));
  auto geometry = std::make_shared<render::MeshGeometry>();
  for (std::size_t i = 0; i < insight.triangles.size(); ++i) {
    std::array<Vec3, 3> corners = {};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 place = vector_cast<float>(insight.triangles[i].corners[k] - origin);
      corners[k] = place + kNearer * (list.camera.eye - place);
    }
    const Vec3 normal = normalize(cross(corners[1] - corners[0], corners[2] - corners[0]));
    const float u = (static_cast<float>(columns[i]) + 0.5F) / static_cast<float>(palette.size());
    for (const Vec3& corner : corners) {
      geometry->indices.push_back(static_cast<std::uint32_t>(geometry->vertices.size()));
      geometry->vertices.push_back({corner, normal, u, 0.5F});
    }
  }
  render::DrawMesh mesh;
  mesh.geometry = std::move(geometry);
  mesh.transform = affine(Mat3{}, Vec3{});
  mesh.texture = palette.image();
  mesh.color = {1, 1, 1};
  mesh.surface.roughness = 1;
  mesh.two_sided = true;
  mesh.casts_shadow = false;
  list.meshes.push_back(std::move(mesh));
}

}  // namespace

void add_insight(const Insight& insight, DVec3 origin, float pixel, render::DrawList& list) {
  const auto local = [&](DVec3 place) { return vector_cast<float>(place - origin); };
  for (const Insight::Line& line : insight.lines) {
    const float width = line.subject == DebugSubject::kLoads ? kLoadWidth : kLineWidth;
    list.lines.push_back({local(line.from), local(line.to), color_of(line.color), 1, width, true});
  }
  for (const Insight::Point& point : insight.points) {
    const Vec3 place = local(point.place);
    const float size = kPointSize * pixel * length(place - list.camera.eye);
    for (const Vec3 axis : {Vec3{size, 0, 0}, Vec3{0, size, 0}, Vec3{0, 0, size}})
      list.lines.push_back({place - axis, place + axis, color_of(point.color), 1, kLineWidth, true});
  }
  add_triangles(insight, origin, list);
}

std::vector<SeenNumber> numbers_with_room(const Insight& insight, const Eye& eye, double line_px,
                                          std::size_t& left_out) {
  const auto width_of = [&](const Insight::Text& text) {
    return 0.6 * line_px * static_cast<double>(text.text.size());
  };
  std::vector<SeenNumber> seen;
  left_out = 0;
  for (const Insight::Text& text : insight.texts) {
    const auto pixel = pixel_of(eye, text.place);
    if (!pixel) continue;
    const bool has_room = std::none_of(seen.begin(), seen.end(), [&](const SeenNumber& other) {
      const double across = (*pixel)[0] - other.pixel[0];
      return std::abs((*pixel)[1] - other.pixel[1]) < line_px && across < width_of(*other.text) &&
             -across < width_of(text);
    });
    if (!has_room) {
      ++left_out;
      continue;
    }
    seen.push_back({&text, *pixel});
  }
  return seen;
}

}  // namespace hooke::app
