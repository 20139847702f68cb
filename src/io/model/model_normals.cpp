#include "io/model/model_geometry.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <unordered_map>

namespace hooke::io {

namespace {

using geometry::find_flipped;
using geometry::is_degenerate;
using geometry::Weld;
using geometry::weld;
using geometry::weld_distance;

/// Above this number of faces around a point its corners keep their faces' normals, because comparing all
/// pairs takes the square of it.
constexpr std::size_t kMaxFan = 1024;

/// If more than this share of a material's area faces away from its stored normals, all of them are made
/// anew.
constexpr double kOpposingPart = 0.01;

/// These are the corners around each point, point after point.
struct Fans {
  std::vector<std::uint32_t> start;  ///< One more entry than points.
  std::vector<std::uint32_t> corners;
};

Fans find_fans(std::size_t point_count, std::span<const Triangle> triangles) {
  Fans fans;
  fans.start.assign(point_count + 1, 0);
  for (const Triangle& triangle : triangles) {
    for (const std::uint32_t i : triangle) ++fans.start[i + 1];
  }
  std::partial_sum(fans.start.begin(), fans.start.end(), fans.start.begin());
  fans.corners.resize(3 * triangles.size());
  std::vector<std::uint32_t> next(fans.start.begin(), fans.start.end() - 1);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::uint32_t i = 0; i < 3; ++i) fans.corners[next[triangles[t][i]]++] = 3 * t + i;
  }
  return fans;
}

DVec3 area_vector(std::span<const DVec3> points, const Triangle& triangle) {
  const DVec3 a = points[triangle[0]];
  return 0.5 * cross(points[triangle[1]] - a, points[triangle[2]] - a);
}

double corner_angle(std::span<const DVec3> points, const Triangle& triangle, std::size_t corner) {
  const DVec3 p = points[triangle[corner]];
  const DVec3 u = points[triangle[(corner + 1) % 3]] - p;
  const DVec3 v = points[triangle[(corner + 2) % 3]] - p;
  return std::atan2(length(cross(u, v)), dot(u, v));
}

/// A VertexKey holds the bits of one drawn vertex, to find equal ones.
struct VertexKey {
  std::array<std::uint32_t, 8> bits = {};
  friend bool operator==(const VertexKey&, const VertexKey&) = default;
};

struct VertexHash {
  std::size_t operator()(const VertexKey& key) const {
    std::uint64_t hash = 0;
    for (const std::uint32_t word : key.bits) {
      hash = (hash ^ word) * 0x9E3779B97F4A7C15ULL;
      hash ^= hash >> 32u;
    }
    return static_cast<std::size_t>(hash);
  }
};

/// Collects drawn vertices, each different one once.
class VertexTable {
 public:
  std::uint32_t add(const ModelVertex& vertex) {
    ModelVertex plain = vertex;
    for (float& v : plain.position) v += 0.0f;  // This turns -0 into 0, which is the same position.
    for (float& v : plain.normal) v += 0.0f;
    for (float& v : plain.uv) v += 0.0f;
    VertexKey key;
    std::memcpy(key.bits.data(), &plain, sizeof(plain));
    const auto [entry, is_new] = index_of_.try_emplace(key, static_cast<std::uint32_t>(vertices_.size()));
    if (is_new) vertices_.push_back(plain);
    return entry->second;
  }

  [[nodiscard]] std::vector<ModelVertex> take() { return std::move(vertices_); }

 private:
  std::unordered_map<VertexKey, std::uint32_t, VertexHash> index_of_;
  std::vector<ModelVertex> vertices_;
};

/// These are the triangles of a soup that have an area, turned outward, with their corners in the soup and
/// welded.
struct Faces {
  std::vector<DVec3> points;               ///< Welded points.
  std::vector<Triangle> welded;            ///< Indices into `points`.
  std::vector<Triangle> given;             ///< Indices into the soup's positions.
  std::vector<std::uint32_t> material_of;  ///< One for each face.
};

Faces find_faces(const Soup& soup) {
  Faces faces;
  const double distance = weld_distance(soup.positions);
  const Weld welds = weld(soup.positions, distance);
  faces.points.reserve(welds.first.size());
  for (const std::uint32_t i : welds.first) faces.points.push_back(soup.positions[i]);
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const Triangle given = soup.triangles[t];
    const Triangle welded = {welds.welded_of[given[0]], welds.welded_of[given[1]], welds.welded_of[given[2]]};
    if (is_degenerate(faces.points, welded, distance)) continue;
    faces.welded.push_back(welded);
    faces.given.push_back(given);
    faces.material_of.push_back(soup.material_of[t]);
  }
  const std::vector<std::uint8_t> flipped = find_flipped(faces.points, faces.welded);
  for (std::size_t t = 0; t < flipped.size(); ++t) {
    if (flipped[t] == 0) continue;
    std::swap(faces.welded[t][1], faces.welded[t][2]);
    std::swap(faces.given[t][1], faces.given[t][2]);
  }
  return faces;
}

/// Tells for each material whether its stored normals exist and point to the side that its faces do.
std::vector<std::uint8_t> find_trusted(const Soup& soup, const Faces& faces) {
  std::vector<double> area(soup.materials.size(), 0.0);
  std::vector<double> opposing(soup.materials.size(), 0.0);
  for (std::size_t t = 0; t < faces.given.size(); ++t) {
    const DVec3 face = area_vector(faces.points, faces.welded[t]);
    bool agrees = true;
    for (const std::uint32_t i : faces.given[t]) agrees = agrees && dot(face, soup.normals[i]) > 0;
    area[faces.material_of[t]] += length(face);
    opposing[faces.material_of[t]] += agrees ? 0.0 : length(face);
  }
  std::vector<std::uint8_t> trusted(area.size());
  for (std::size_t m = 0; m < area.size(); ++m) trusted[m] = opposing[m] <= kOpposingPart * area[m] ? 1 : 0;
  return trusted;
}

std::array<float, 3> narrow(DVec3 v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

std::vector<DVec3> crease_normals(std::span<const DVec3> points, std::span<const Triangle> triangles,
                                  double crease) {
  std::vector<DVec3> face(triangles.size());
  std::vector<double> angle;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    face[t] = normalize(area_vector(points, triangles[t]));
    for (std::size_t i = 0; i < 3; ++i) angle.push_back(corner_angle(points, triangles[t], i));
  }
  const Fans fans = find_fans(points.size(), triangles);
  // The slack keeps coplanar faces together.
  const double least_cosine = std::cos(std::clamp(crease, 0.0, 3.2)) - 1e-9;
  std::vector<DVec3> normals(3 * triangles.size());
  for (std::uint32_t corner = 0; corner < normals.size(); ++corner) {
    const std::uint32_t p = triangles[corner / 3][corner % 3];
    const DVec3 own = face[corner / 3];
    DVec3 sum = {};
    const bool is_crowded = fans.start[p + 1] - fans.start[p] > kMaxFan;
    for (std::uint32_t k = fans.start[p]; k < fans.start[p + 1] && !is_crowded; ++k) {
      const std::uint32_t other = fans.corners[k];
      if (dot(own, face[other / 3]) >= least_cosine) sum += angle[other] * face[other / 3];
    }
    const DVec3 mean = normalize(sum);
    normals[corner] = dot(mean, own) > 0 ? mean : own;
  }
  return normals;
}

Model assemble_model(const Soup& soup, double crease) {
  const Faces faces = find_faces(soup);
  const std::vector<std::uint8_t> trusted = find_trusted(soup, faces);
  const std::vector<DVec3> made = crease_normals(faces.points, faces.welded, crease);

  std::vector<std::uint32_t> order(faces.given.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return faces.material_of[a] < faces.material_of[b];
  });

  Model model;
  VertexTable table;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t t = order[k];
    const std::uint32_t material = faces.material_of[t];
    if (k == 0 || faces.material_of[order[k - 1]] != material) {
      model.parts.push_back({static_cast<std::uint32_t>(model.indices.size()), 0,
                             static_cast<std::uint32_t>(model.materials.size())});
      model.materials.push_back(soup.materials[material]);
    }
    model.parts.back().count += 3;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t given = faces.given[t][i];
      const DVec3 normal = trusted[material] != 0 ? normalize(soup.normals[given]) : made[3 * t + i];
      const bool is_unit = dot(normal, normal) > 0.5;
      model.indices.push_back(table.add({.position = narrow(soup.positions[given]),
                                         .normal = narrow(is_unit ? normal : made[3 * t + i]),
                                         .uv = soup.uvs[given]}));
    }
  }
  if (model.materials.empty()) model.materials.emplace_back();
  model.vertices = table.take();
  return model;
}

void weld_model(Model& model) {
  std::vector<DVec3> points;
  points.reserve(model.vertices.size());
  for (const ModelVertex& vertex : model.vertices) {
    points.push_back({vertex.position[0], vertex.position[1], vertex.position[2]});
  }
  const double distance = weld_distance(points);
  Weld welded = weld(points, distance);
  std::vector<DVec3> welded_points;
  welded_points.reserve(welded.first.size());
  for (const std::uint32_t i : welded.first) welded_points.push_back(points[i]);

  model.mesh = {};
  model.mesh.positions.reserve(welded_points.size());
  for (const DVec3 p : welded_points) model.mesh.positions.push_back(vector_cast<Real>(p));
  for (std::size_t i = 0; i + 2 < model.indices.size(); i += 3) {
    const Triangle triangle = {welded.welded_of[model.indices[i]], welded.welded_of[model.indices[i + 1]],
                               welded.welded_of[model.indices[i + 2]]};
    if (!is_degenerate(welded_points, triangle, distance)) model.mesh.triangles.push_back(triangle);
  }
  model.welded_of = std::move(welded.welded_of);
}

}  // namespace hooke::io
