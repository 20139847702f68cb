#pragma once

#include "hooke/shape.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace hooke::test {

/// A flat sheet in the plane z = 0, facing +z: columns x rows points, `cell` apart, every cell cut by the
/// same diagonal. Point (column, row) is row * columns + column.
inline MeshDesc make_grid(std::uint32_t columns, std::uint32_t rows, Real cell) {
  MeshDesc mesh;
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      mesh.positions.push_back({cell * Real(column), cell * Real(row), Real(0)});
      if (column + 1 == columns || row + 1 == rows) continue;
      const std::uint32_t corner = row * columns + column;
      mesh.triangles.push_back({corner, corner + 1, corner + columns + 1});
      mesh.triangles.push_back({corner, corner + columns + 1, corner + columns});
    }
  }
  return mesh;
}

/// A cube of the given half extent about the origin, facing outward.
inline MeshDesc make_cube(Real half) {
  MeshDesc mesh;
  for (std::uint32_t i = 0; i < 8; ++i) {
    mesh.positions.push_back(
        {(i & 1u) != 0 ? half : -half, (i & 2u) != 0 ? half : -half, (i & 4u) != 0 ? half : -half});
  }
  const std::array<std::uint32_t, 4> faces[] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                                {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& f : faces) {
    mesh.triangles.push_back({f[0], f[1], f[2]});
    mesh.triangles.push_back({f[0], f[2], f[3]});
  }
  return mesh;
}

/// A sphere of radius 1 facing outward: an octahedron, each triangle cut in four `levels` times.
inline MeshDesc make_sphere(int levels) {
  MeshDesc mesh;
  mesh.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [entry, is_new] = middles.try_emplace({a < b ? a : b, a < b ? b : a},
                                                       static_cast<std::uint32_t>(mesh.positions.size()));
      if (is_new) mesh.positions.push_back(normalize(mesh.positions[a] + mesh.positions[b]));
      return entry->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& t : mesh.triangles) {
      const std::uint32_t ab = middle(t[0], t[1]);
      const std::uint32_t bc = middle(t[1], t[2]);
      const std::uint32_t ca = middle(t[2], t[0]);
      finer.insert(finer.end(), {{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}});
    }
    mesh.triangles = finer;
  }
  return mesh;
}

/// A box about the origin, facing outward.
inline MeshDesc make_box(Vec3 half) {
  MeshDesc mesh = make_cube(1);
  for (Vec3& p : mesh.positions) p = {half.x * p.x, half.y * p.y, half.z * p.z};
  return mesh;
}

/// A ring of round wire about the y axis, facing outward: `around` x `across` points.
inline MeshDesc make_torus(Real ring_radius, Real wire_radius, std::uint32_t around, std::uint32_t across) {
  MeshDesc mesh;
  const Real turn = Real(6.283185307179586);
  for (std::uint32_t i = 0; i < around; ++i) {
    const Real a = turn * Real(i) / Real(around);
    for (std::uint32_t k = 0; k < across; ++k) {
      const Real b = turn * Real(k) / Real(across);
      const Real out = ring_radius + wire_radius * std::cos(b);
      mesh.positions.push_back({out * std::cos(a), wire_radius * std::sin(b), out * std::sin(a)});
      const std::uint32_t next = (i + 1) % around * across;
      const std::uint32_t up = (k + 1) % across;
      mesh.triangles.push_back({i * across + k, i * across + up, next + up});
      mesh.triangles.push_back({i * across + k, next + up, next + k});
    }
  }
  return mesh;
}

/// A corner of two arms of length 2, width 1 and thickness 2 half_z in the plane z = 0: x, y in [0, 2]
/// without (1, 2] x (1, 2]. Concave, facing outward.
inline MeshDesc make_ell(Real half_z) {
  MeshDesc mesh;
  const Real outline[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  for (const Real z : {-half_z, half_z}) {
    for (const auto& p : outline) mesh.positions.push_back({p[0], p[1], z});
  }
  const std::array<std::uint32_t, 3> lid[] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
  for (const auto& t : lid) {
    mesh.triangles.push_back({t[0], t[2], t[1]});
    mesh.triangles.push_back({t[0] + 6, t[1] + 6, t[2] + 6});
  }
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t next = (i + 1) % 6;
    mesh.triangles.push_back({i, next, next + 6});
    mesh.triangles.push_back({i, next + 6, i + 6});
  }
  return mesh;
}

}  // namespace hooke::test
