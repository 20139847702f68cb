#pragma once

#include "hooke/model_io.h"

#include "temporary_folder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>
#include <map>
#include <span>
#include <stdlib.h>
#include <string>
#include <utility>
#include <vector>

/// \file
/// What the tests of models share: where things are, what a mesh measures, shapes to try.

namespace hooke::io_test {

namespace fs = std::filesystem;

/// Sets an environment variable, and puts back what was there.
class ScopedVariable {
 public:
  ScopedVariable(const char* name, const std::string& value) : name_(name) {
    if (const char* old = std::getenv(name); old != nullptr) old_ = old;
    ::setenv(name, value.c_str(), 1);
  }
  ScopedVariable(const ScopedVariable&) = delete;
  ScopedVariable& operator=(const ScopedVariable&) = delete;
  ~ScopedVariable() {
    if (old_.empty()) {
      ::unsetenv(name_);
    } else {
      ::setenv(name_, old_.c_str(), 1);
    }
  }

 private:
  const char* name_;
  std::string old_ = {};
};

using test::TemporaryFolder;

inline std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// The importer of this build. Keep the result alive while importing.
inline ScopedVariable built_importer() {
  return {"HOOKE_IMPORT", HOOKE_BUILT_IMPORTER};
}

/// A file of the sample models, or an empty path (and a message) where they are absent.
inline std::string sample(const std::string& name) {
  const fs::path path = fs::path(HOOKE_SAMPLE_MODELS) / name;
  if (!fs::exists(path)) MESSAGE("skipped, no sample model ", path.string());
  return fs::exists(path) ? path.string() : std::string();
}

struct Measures {
  double volume = 0.0;
  double area = 0.0;
  DVec3 low = {1e300, 1e300, 1e300};
  DVec3 high = {-1e300, -1e300, -1e300};
  std::size_t open_edges = 0;  ///< Walked more often one way than the other.
};

inline Measures measure(const MeshDesc& mesh) {
  Measures m;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : mesh.triangles) {
    std::array<DVec3, 3> p = {};
    for (std::size_t i = 0; i < 3; ++i) {
      p[i] = vector_cast<double>(mesh.positions[t[i]]);
      m.low = {std::min(m.low.x, p[i].x), std::min(m.low.y, p[i].y), std::min(m.low.z, p[i].z)};
      m.high = {std::max(m.high.x, p[i].x), std::max(m.high.y, p[i].y), std::max(m.high.z, p[i].z)};
      const std::uint32_t to = t[(i + 1) % 3];
      edges[{std::min(t[i], to), std::max(t[i], to)}] += t[i] < to ? 1 : -1;
    }
    m.volume += dot(p[0], cross(p[1], p[2])) / 6;
    m.area += length(cross(p[1] - p[0], p[2] - p[0])) / 2;
  }
  for (const auto& [edge, balance] : edges) m.open_edges += balance != 0 ? 1 : 0;
  return m;
}

/// A box around the origin, counter-clockwise from outside.
inline MeshDesc box(Vec3 half, Vec3 center = {}) {
  MeshDesc mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.positions.push_back(center + Vec3{(i & 1) != 0 ? half.x : -half.x, (i & 2) != 0 ? half.y : -half.y,
                                           (i & 4) != 0 ? half.z : -half.z});
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

/// A sphere of latitudes and longitudes.
inline MeshDesc sphere(double radius, std::uint32_t rings, std::uint32_t segments) {
  constexpr double kPi = 3.14159265358979323846;
  MeshDesc mesh;
  mesh.positions.push_back({0, Real(radius), 0});
  for (std::uint32_t r = 1; r < rings; ++r) {
    for (std::uint32_t s = 0; s < segments; ++s) {
      const double a = kPi * r / rings;
      const double b = 2 * kPi * s / segments;
      mesh.positions.push_back({Real(radius * std::sin(a) * std::cos(b)), Real(radius * std::cos(a)),
                                Real(-radius * std::sin(a) * std::sin(b))});
    }
  }
  mesh.positions.push_back({0, Real(-radius), 0});
  const auto last = static_cast<std::uint32_t>(mesh.positions.size() - 1);
  for (std::uint32_t s = 0; s < segments; ++s) {
    const std::uint32_t t = (s + 1) % segments;
    mesh.triangles.push_back({0, 1 + s, 1 + t});
    for (std::uint32_t r = 0; r + 2 < rings; ++r) {
      const std::uint32_t a = 1 + r * segments;
      mesh.triangles.push_back({a + s, a + segments + s, a + segments + t});
      mesh.triangles.push_back({a + s, a + segments + t, a + t});
    }
    const std::uint32_t a = 1 + (rings - 2) * segments;
    mesh.triangles.push_back({last, a + t, a + s});
  }
  return mesh;
}

inline void append(MeshDesc& mesh, const MeshDesc& other) {
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
}

inline void turn_over(MeshDesc& mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
}

}  // namespace hooke::io_test
