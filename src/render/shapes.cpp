#include "render/shapes.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <utility>

namespace hooke::render {

namespace {

constexpr float kPi = std::numbers::pi_v<float>;

/// This is a point of an outline that is rotated about the y axis: radius and height, normal in the same
/// plane, v.
struct ProfilePoint {
  float radius = 0;
  float height = 0;
  float normal_radius = 0;
  float normal_height = 0;
  float v = 0;
};

/// Joins two rings of `count` vertices each, the second farther along, seen from outside.
void add_band(std::uint32_t first, std::uint32_t second, std::uint32_t count, MeshGeometry& geometry) {
  for (std::uint32_t i = 0; i + 1 < count; ++i) {
    const std::uint32_t a = first + i;
    const std::uint32_t b = second + i;
    geometry.indices.insert(geometry.indices.end(), {a, a + 1, b, b, a + 1, b + 1});
  }
}

/// Makes a shape of revolution; the profile runs from the top to the bottom.
MeshGeometry make_turned(std::span<const ProfilePoint> profile, int sides = kRoundSides) {
  MeshGeometry geometry;
  const auto ring = static_cast<std::uint32_t>(sides + 1);
  for (const ProfilePoint& point : profile) {
    const auto first = static_cast<std::uint32_t>(geometry.vertices.size());
    for (int i = 0; i <= sides; ++i) {
      const float part = static_cast<float>(i) / static_cast<float>(sides);
      const float s = std::sin(2 * kPi * part);
      const float c = std::cos(2 * kPi * part);
      geometry.vertices.push_back(
          {{point.radius * s, point.height, point.radius * c},
           normalize(Vec3{point.normal_radius * s, point.normal_height, point.normal_radius * c}),
           part,
           point.v});
    }
    // Bands go downward, so the upper ring is the second one, to be counter-clockwise from outside.
    if (first >= ring) add_band(first, first - ring, ring, geometry);
  }
  return geometry;
}

std::uint32_t add_midpoint(std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>& known,
                           std::vector<Vec3>& points, std::uint32_t a, std::uint32_t b) {
  const auto key = std::minmax(a, b);
  const auto [place, is_new] =
      known.try_emplace({key.first, key.second}, static_cast<std::uint32_t>(points.size()));
  if (is_new) points.push_back(normalize(points[a] + points[b]));
  return place->second;
}

}  // namespace

MeshGeometry make_box(Vec3 half_size) {
  MeshGeometry geometry;
  const Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int side = 0; side < 6; ++side) {
    const float sign = side < 3 ? 1.0F : -1.0F;
    const Vec3 normal = sign * axes[side % 3];
    // Walls keep the texture upright; the lids look along z.
    const Vec3 up = side % 3 == 1 ? Vec3{0, 0, -sign} : Vec3{0, 1, 0};
    const Vec3 right = cross(up, normal);
    const auto first = static_cast<std::uint32_t>(geometry.vertices.size());
    for (int corner = 0; corner < 4; ++corner) {
      const float x = corner == 1 || corner == 2 ? 1.0F : -1.0F;
      const float y = corner >= 2 ? 1.0F : -1.0F;
      const Vec3 p = normal + x * right + y * up;
      geometry.vertices.push_back({{p.x * half_size.x, p.y * half_size.y, p.z * half_size.z},
                                   normal,
                                   0.5F + 0.5F * x,
                                   0.5F + 0.5F * y});
    }
    geometry.indices.insert(geometry.indices.end(),
                            {first, first + 1, first + 2, first, first + 2, first + 3});
  }
  return geometry;
}

MeshGeometry make_sphere(int splits) {
  const float g = std::numbers::phi_v<float>;
  std::vector<Vec3> points = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                              {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  for (Vec3& p : points) p = normalize(p);
  MeshGeometry geometry;
  geometry.indices = {0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                      4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                      6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
  for (int split = 0; split < std::clamp(splits, 0, 6); ++split) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
    std::vector<std::uint32_t> finer;
    finer.reserve(4 * geometry.indices.size());
    for (std::size_t i = 0; i < geometry.indices.size(); i += 3) {
      const std::uint32_t a = geometry.indices[i];
      const std::uint32_t b = geometry.indices[i + 1];
      const std::uint32_t c = geometry.indices[i + 2];
      const std::uint32_t ab = add_midpoint(known, points, a, b);
      const std::uint32_t bc = add_midpoint(known, points, b, c);
      const std::uint32_t ca = add_midpoint(known, points, c, a);
      finer.insert(finer.end(), {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca});
    }
    geometry.indices = std::move(finer);
  }
  for (const Vec3 p : points) {
    geometry.vertices.push_back({p, p, 0.5F + std::atan2(p.x, p.z) / (2 * kPi),
                                 0.5F + std::asin(std::clamp(p.y, -1.0F, 1.0F)) / kPi});
  }
  return geometry;
}

MeshGeometry make_capsule(float radius, float half_height, int sides) {
  std::vector<ProfilePoint> profile;
  const int rings = (sides + 2) / 3;
  for (int end = 0; end < 2; ++end) {
    const float shift = end == 0 ? half_height : -half_height;
    for (int i = 0; i <= rings; ++i) {
      // The angle is zero at the upper pole, pi at the lower one.
      const float angle =
          0.5F * kPi * (static_cast<float>(i) / static_cast<float>(rings) + static_cast<float>(end));
      // The radius must be exactly zero at both poles. Otherwise the triangles there would have an area and
      // could face inward.
      const float s = std::max(std::sin(angle), 0.0F);
      const float c = std::cos(angle);
      profile.push_back({radius * s, shift + radius * c, s, c, 0});
    }
  }
  const float total = radius + half_height;
  for (ProfilePoint& point : profile) point.v = total > 0 ? 0.5F + 0.5F * point.height / total : 0.5F;
  return make_turned(profile, sides);
}

MeshGeometry make_cylinder(float radius, float half_height) {
  const ProfilePoint profile[] = {{0, half_height, 0, 1, 1},        {radius, half_height, 0, 1, 1},
                                  {radius, half_height, 1, 0, 1},   {radius, -half_height, 1, 0, 0},
                                  {radius, -half_height, 0, -1, 0}, {0, -half_height, 0, -1, 0}};
  return make_turned(profile);
}

MeshGeometry make_cone(float radius, float half_height) {
  // The side's normal is perpendicular to the line from the tip to the rim.
  const float outward = 2 * half_height;
  const ProfilePoint profile[] = {{0, half_height, outward, radius, 1},
                                  {radius, -half_height, outward, radius, 0},
                                  {radius, -half_height, 0, -1, 0},
                                  {0, -half_height, 0, -1, 0}};
  return make_turned(profile);
}

void update_normals(MeshGeometry& geometry) {
  std::vector<Vec3> sums(geometry.vertices.size());
  for (std::size_t i = 0; i + 2 < geometry.indices.size(); i += 3) {
    const std::uint32_t a = geometry.indices[i];
    const std::uint32_t b = geometry.indices[i + 1];
    const std::uint32_t c = geometry.indices[i + 2];
    if (std::max({a, b, c}) >= sums.size()) continue;
    const Vec3 origin = geometry.vertices[a].position;
    // This is twice the area times the unit normal.
    const Vec3 normal = cross(geometry.vertices[b].position - origin, geometry.vertices[c].position - origin);
    sums[a] += normal;
    sums[b] += normal;
    sums[c] += normal;
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const Vec3 normal = normalize(sums[i]);
    if (normal != Vec3{}) geometry.vertices[i].normal = normal;
  }
  ++geometry.vertex_revision;
}

}  // namespace hooke::render
