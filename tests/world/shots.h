#pragma once

#include "hooke/hooke.h"

#include "validation/crossings.h"
#include "world/make.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

/// \file
/// Seeded shots, and what they are thrown at.

namespace hooke::test {

/// Numbers that are the same on every machine.
struct Random {
  std::uint32_t state = 1;
  double between(double low, double high) {
    state = 1664525U * state + 1013904223U;
    return low + (high - low) * (static_cast<double>(state >> 8U) / 16777216.0);
  }
  Real real_between(double low, double high) { return static_cast<Real>(between(low, high)); }
  /// Even in the logarithm.
  double log_between(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
};

enum class Form : std::uint8_t { kBall, kBox, kNeedle, kCone, kHull, kMesh };
inline constexpr int kForms = 6;

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// How often a ray from `from` up the y axis, a little aslant, goes through triangles.
template <class Points>
int hits_above(DVec3 from, const Points& points, const Triangles& triangles) {
  const DVec3 to = from + DVec3{0.0137, 1000, 0.0171};
  int hits = 0;
  for (const auto& [a, b, c] : triangles) {
    const DVec3 p = points[a];
    const DVec3 q = points[b];
    const DVec3 r = points[c];
    if (exact_orientation(p, q, r, from) * exact_orientation(p, q, r, to) >= 0) continue;
    const int side = exact_orientation(from, to, p, q);
    if (side != 0 && side == exact_orientation(from, to, q, r) && side == exact_orientation(from, to, r, p))
      ++hits;
  }
  return hits;
}

inline constexpr double kHalfWidth = 0.6;  ///< Of what is held at height 0 [m].

/// The corners of an icosahedron and, of a star, a spike on each of its faces.
inline MeshDesc round_mesh(double radius, bool star) {
  const double golden = 0.5 * (1 + std::sqrt(5.0));
  MeshDesc mesh;
  std::vector<DVec3> corners;
  for (const double s : {-1.0, 1.0}) {
    for (const double t : {-golden, golden}) {
      corners.push_back({0, s, t});
      corners.push_back({s, t, 0});
      corners.push_back({t, 0, s});
    }
  }
  for (DVec3& corner : corners) corner = (radius / length(corner)) * corner;
  const double edge = 1.0515 * radius;
  const auto joined = [&](std::size_t a, std::size_t b) {
    return length(corners[a] - corners[b]) < 1.01 * edge;
  };
  for (const DVec3 corner : corners) mesh.positions.push_back(vector_cast<Real>((star ? 0.5 : 1.0) * corner));
  for (std::uint32_t a = 0; a < 12; ++a) {
    for (std::uint32_t b = a + 1; b < 12; ++b) {
      for (std::uint32_t c = b + 1; c < 12; ++c) {
        if (!joined(a, b) || !joined(b, c) || !joined(a, c)) continue;
        const bool outward = dot(cross(corners[b] - corners[a], corners[c] - corners[a]), corners[a]) > 0;
        const std::array<std::uint32_t, 3> face = {a, outward ? b : c, outward ? c : b};
        if (!star) {
          mesh.triangles.push_back(face);
          continue;
        }
        const auto tip = static_cast<std::uint32_t>(mesh.positions.size());
        const DVec3 middle = corners[a] + corners[b] + corners[c];
        mesh.positions.push_back(vector_cast<Real>((radius / length(middle)) * middle));
        for (std::size_t k = 0; k < 3; ++k) mesh.triangles.push_back({face[k], face[(k + 1) % 3], tip});
      }
    }
  }
  return mesh;
}

inline Shape shape_of(Form form, double size, Random& random, World& world) {
  const Real s = static_cast<Real>(size);
  switch (form) {
    case Form::kBall:
      return Shape::sphere(s);
    case Form::kBox:
      return {.kind = ShapeKind::kBox, .half_extents = {s, Real(0.5) * s, random.real_between(0.2, 1) * s}};
    case Form::kNeedle:
      return {.kind = ShapeKind::kCapsule, .radius = Real(0.0015), .half_height = s};
    case Form::kCone:
      return {.kind = ShapeKind::kCone, .radius = Real(0.5) * s, .half_height = s};
    case Form::kHull:
      return Shape::hull_of(take(world.add_mesh(round_mesh(size, false))));
    case Form::kMesh:
      return Shape::of_mesh(take(world.add_mesh(round_mesh(size, true))));
  }
  return {};
}

/// A shot down from above what is held at height 0, as large as `least_size` [m] or up to 0.06 m.
inline BodyDesc shot(Form form, double least_size, Random& random, World& world) {
  const double speed = random.log_between(1, 1000);
  BodyDesc desc = {.kind = BodyKind::kDynamic};
  desc.shape = shape_of(form, random.between(least_size, std::max(0.06, 2 * least_size)), random, world);
  desc.mass = static_cast<Real>(random.log_between(0.001, 10));
  desc.position = {random.between(-0.4, 0.4), 0.3 + random.between(0, 1) * speed / 60,
                   random.between(-0.4, 0.4)};
  // It comes down within the rim, however far above it begins.
  const double slant = std::min(0.1, 0.15 / desc.position.y);
  desc.velocity = {random.real_between(-slant, slant) * static_cast<Real>(speed), static_cast<Real>(-speed),
                   random.real_between(-slant, slant) * static_cast<Real>(speed)};
  desc.angular_velocity = {random.real_between(-20, 20), random.real_between(-20, 20),
                           random.real_between(-20, 20)};
  desc.rotation = normalize(
      Quat{random.real_between(-1, 1), random.real_between(-1, 1), random.real_between(-1, 1), Real(0.3)});
  return desc;
}

/// A sheet of n x n points that is held at all its edges.
inline ClothDesc held_sheet(std::uint32_t n) {
  ClothDesc desc;
  desc.columns = desc.rows = static_cast<int>(n);
  desc.corner = {-kHalfWidth, 0, -kHalfWidth};
  desc.width = desc.height = static_cast<Real>(2 * kHalfWidth);
  desc.row_direction = {Real(0), Real(0), Real(1)};
  for (std::uint32_t i = 0; i < n * n; ++i) {
    if (i < n || i >= n * (n - 1) || i % n == 0 || i % n == n - 1) desc.pins.push_back({i});
  }
  return desc;
}

}  // namespace hooke::test
