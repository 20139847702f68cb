#include "hooke/export/motion_skin.h"

#include "render/shapes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

namespace hooke::app {

namespace {

/// A rope gets about as many rings as this, or one at each point if it has more.
constexpr std::size_t kUsualRings = 16;
constexpr std::size_t kMostPieces = 4;
constexpr std::uint32_t kSidesOfRopes = 8;
constexpr std::uint32_t kSidesOfSprings = 5;
/// A spring is thinner than the particles at its ends by this factor, as the renderer draws it.
constexpr float kSpringWidth = 0.3F;
constexpr int kFewBalls = 100;  ///< Up to this number, balls have 320 triangles, and 80 beyond it.

/// Returns a point at `part` of the way from p[1] to p[2] on the Catmull-Rom curve. Points that lie on each
/// other do it no harm.
DVec3 curve_point(const std::array<DVec3, 4>& p, double part) {
  const DVec3 from = 0.5 * (p[2] - p[0]);
  const DVec3 to = 0.5 * (p[3] - p[1]);
  const double t = part;
  const double t2 = t * t;
  const double t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * p[1] + (t3 - 2 * t2 + t) * from + (3 * t2 - 2 * t3) * p[2] + (t3 - t2) * to;
}

/// Returns `across` turned into the plane across a unit tangent, by as little as possible.
DVec3 turned_across(DVec3 across, DVec3 tangent) {
  const DVec3 flat = across - dot(across, tangent) * tangent;
  if (length_squared(flat) > 1e-12) return normalize(flat);
  const DVec3 other = std::abs(tangent.y) < 0.9 ? DVec3{0, 1, 0} : DVec3{1, 0, 0};
  return normalize(other - dot(other, tangent) * tangent);
}

}  // namespace

MotionSkin::MotionSkin(const Figure& figure, std::span<const DVec3> points,
                       std::span<const std::uint32_t> materials, std::uint32_t iron) {
  if (figure.surface) add_surface(figure, materials);
  add_tubes(figure, points.size());
  if (figure.kind == SceneObject::Kind::kParticles) {
    const int splits = figure.radii.size() > kFewBalls ? 1 : 2;
    const render::MeshGeometry ball = render::make_sphere(splits);
    shapes_.emplace_back();
    triangles_.push_back(ball.indices);
    for (const render::Vertex& vertex : ball.vertices) shapes_.back().push_back(vertex.position);
    const std::size_t count = std::min(points.size(), figure.radii.size());
    for (std::uint32_t i = 0; i < count; ++i) add_ball(i, figure.radii[i], 0);
  }
  if (!figure.surface) end_part(materials.front());
  add_balls(figure, points.size());
  end_part(iron);
  const std::vector<Vec3> first = vertices(points);
  mesh_.vertices.resize(first.size());
  for (std::size_t i = 0; i < first.size(); ++i)
    mesh_.vertices[i].position = {first[i].x, first[i].y, first[i].z};
  // What follows the surface has a normal for each vertex.
  std::uint32_t next = 0;
  for (const std::uint32_t group : mesh_.normal_groups) next = std::max(next, group + 1);
  while (mesh_.normal_groups.size() < first.size()) mesh_.normal_groups.push_back(next++);
}

void MotionSkin::end_part(std::uint32_t material) {
  const auto end = static_cast<std::uint32_t>(mesh_.indices.size());
  if (end > part_begin_) mesh_.parts.push_back({part_begin_, end - part_begin_, material});
  part_begin_ = end;
}

/// A vertex that triangles of two materials share becomes two: each belongs to one part.
void MotionSkin::add_surface(const Figure& figure, std::span<const std::uint32_t> materials) {
  const ClothSurface& surface = *figure.surface;
  const std::vector<std::uint32_t>& indices = surface.geometry->indices;
  for (std::size_t r = 0; r < figure.ranges.size(); ++r) {
    const PaintedRange& range = figure.ranges[r];
    const std::size_t end = range.count == 0 ? indices.size() : range.first + range.count;
    // Vertices keep their order, so that those of a grid stay rows and columns.
    std::map<std::uint32_t, std::uint32_t> number_of;
    for (std::size_t i = range.first; i < end; ++i) number_of.try_emplace(indices[i]);
    for (auto& [vertex, number] : number_of) {
      number = next_vertex_++;
      const render::Vertex& source = surface.geometry->vertices[vertex];
      mesh_.vertices.push_back({.uv = {source.u, source.v}});
      mesh_.normal_groups.push_back(surface.group_of[vertex]);
      point_of_.push_back(surface.point_of[vertex]);
    }
    for (std::size_t i = range.first; i < end; ++i) mesh_.indices.push_back(number_of[indices[i]]);
    end_part(materials[r]);
  }
}

void MotionSkin::add_tubes(const Figure& figure, std::size_t points) {
  if (figure.kind == SceneObject::Kind::kRope || figure.kind == SceneObject::Kind::kHook) {
    if (points < 2) return;
    Tube tube;
    tube.radius = figure.radius;
    tube.sides = kSidesOfRopes;
    tube.points.resize(points);
    std::iota(tube.points.begin(), tube.points.end(), 0U);
    const std::size_t pieces = (kUsualRings + points - 2) / (points - 1);
    tube.pieces =
        points == 2 ? 1 : static_cast<std::uint32_t>(std::clamp(pieces, std::size_t{1}, kMostPieces));
    tubes_.push_back(std::move(tube));
  }
  for (const SpringDesc& spring : figure.springs) {
    if (spring.a >= points || spring.b >= points || spring.a == spring.b) continue;
    const float radius = kSpringWidth * std::min(figure.radii[spring.a], figure.radii[spring.b]);
    tubes_.push_back({.points = {spring.a, spring.b}, .radius = radius, .sides = kSidesOfSprings});
  }
  for (const Tube& tube : tubes_) add_tube_triangles(tube);
}

/// The order is: the tip of the start, its small ring, the rings, the small ring of the end, its tip.
void MotionSkin::add_tube_triangles(const Tube& tube) {
  const std::uint32_t sides = tube.sides;
  const auto rings = static_cast<std::uint32_t>((tube.points.size() - 1) * tube.pieces + 3);
  const std::uint32_t start = next_vertex_;
  const std::uint32_t end = start + 1 + rings * sides;
  const auto vertex = [&](std::uint32_t ring, std::uint32_t side) {
    return start + 1 + ring * sides + side % sides;
  };
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh_.indices.insert(mesh_.indices.end(), {a, b, c});
  };
  for (std::uint32_t i = 0; i < sides; ++i) {
    add(start, vertex(0, i + 1), vertex(0, i));
    for (std::uint32_t ring = 0; ring + 1 < rings; ++ring) {
      add(vertex(ring, i), vertex(ring, i + 1), vertex(ring + 1, i));
      add(vertex(ring + 1, i), vertex(ring, i + 1), vertex(ring + 1, i + 1));
    }
    add(vertex(rings - 1, i), vertex(rings - 1, i + 1), end);
  }
  next_vertex_ = end + 1;
}

void MotionSkin::add_ball(std::uint32_t point, float radius, std::uint32_t shape) {
  for (const std::uint32_t index : triangles_[shape]) mesh_.indices.push_back(next_vertex_ + index);
  next_vertex_ += static_cast<std::uint32_t>(shapes_[shape].size());
  balls_.push_back({point, radius, shape});
}

void MotionSkin::add_balls(const Figure& figure, std::size_t points) {
  if (figure.loads.empty()) return;
  const render::MeshGeometry ball = render::make_sphere(2);
  shapes_.emplace_back();
  triangles_.push_back(ball.indices);
  for (const render::Vertex& vertex : ball.vertices) shapes_.back().push_back(vertex.position);
  for (const FigureLoad& load : figure.loads) {
    if (load.point >= points) continue;
    add_ball(static_cast<std::uint32_t>(load.point), load.radius,
             static_cast<std::uint32_t>(shapes_.size() - 1));
  }
}

void MotionSkin::put_tube(Tube& tube, std::span<const DVec3> points, std::vector<Vec3>& vertices) {
  std::vector<DVec3> stations;
  const std::size_t last = tube.points.size() - 1;
  const auto at = [&](std::size_t i) { return points[tube.points[i]]; };
  for (std::size_t i = 0; i < last; ++i) {
    const std::array<DVec3, 4> knots = {i > 0 ? at(i - 1) : 2 * at(0) - at(1), at(i), at(i + 1),
                                        i + 1 < last ? at(i + 2) : 2 * at(last) - at(last - 1)};
    for (std::uint32_t s = 0; s < tube.pieces; ++s) {
      stations.push_back(curve_point(knots, static_cast<double>(s) / tube.pieces));
    }
  }
  stations.push_back(at(last));
  const auto radius = static_cast<double>(tube.radius);
  const double step = 2 * std::numbers::pi / tube.sides;
  DVec3 tangent = {1, 0, 0};
  DVec3 across = tube.across;
  const auto put_ring = [&](DVec3 center, double size) {
    const DVec3 up = cross(tangent, across);
    for (std::uint32_t i = 0; i < tube.sides; ++i) {
      const DVec3 way = std::cos(i * step) * across + std::sin(i * step) * up;
      vertices.push_back(vector_cast<float>(center + size * radius * way));
    }
  };
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const DVec3 from = stations[i > 0 ? i - 1 : 0];
    const DVec3 way = normalize(stations[std::min(i + 1, stations.size() - 1)] - from);
    if (way != DVec3{}) tangent = way;
    across = turned_across(across, tangent);
    if (i == 0) {
      tube.across = across;
      vertices.push_back(vector_cast<float>(stations[0] - radius * tangent));
      put_ring(stations[0] - std::sqrt(0.5) * radius * tangent, std::sqrt(0.5));
    }
    put_ring(stations[i], 1);
  }
  put_ring(stations.back() + std::sqrt(0.5) * radius * tangent, std::sqrt(0.5));
  vertices.push_back(vector_cast<float>(stations.back() + radius * tangent));
}

std::vector<Vec3> MotionSkin::vertices(std::span<const DVec3> points) {
  std::vector<Vec3> result;
  result.reserve(next_vertex_);
  for (const std::uint32_t point : point_of_) {
    result.push_back(point < points.size() ? vector_cast<float>(points[point]) : Vec3{});
  }
  for (Tube& tube : tubes_) put_tube(tube, points, result);
  for (const Ball& ball : balls_) {
    const Vec3 center = ball.point < points.size() ? vector_cast<float>(points[ball.point]) : Vec3{};
    for (const Vec3& vertex : shapes_[ball.shape]) result.push_back(center + ball.radius * vertex);
  }
  return result;
}

}  // namespace hooke::app
