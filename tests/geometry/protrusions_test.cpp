#include "geometry/mesh/protrusions.h"

#include "geometry/meshes.h"

#include <algorithm>
#include <doctest/doctest.h>

namespace hooke {

using geometry::find_protrusions;
using geometry::Protrusions;

namespace {

long peaks_of(const Protrusions& found) {
  return std::count_if(found.ends.begin(), found.ends.end(), [](auto e) { return e[0] == e[1]; });
}

/// Every triangle with corners of its own.
MeshDesc soup_of(const MeshDesc& mesh) {
  MeshDesc soup;
  for (const auto& triangle : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    for (const std::uint32_t corner : triangle) soup.positions.push_back(mesh.positions[corner]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

}  // namespace

TEST_SUITE("geometry/protrusions") {
  TEST_CASE("a cube has twelve ridges and eight peaks, welded or not; turned inside out it has none") {
    const MeshDesc cube = test::make_cube(1);
    MeshDesc hollow = cube;
    for (auto& triangle : hollow.triangles) std::swap(triangle[1], triangle[2]);
    for (const MeshDesc& mesh : {cube, soup_of(cube)}) {
      const Protrusions found = find_protrusions(mesh);
      CHECK(found.ends.size() == 20);
      CHECK(peaks_of(found) == 8);
      for (std::uint32_t i = 0; i < found.ends.size(); ++i) {
        // Diagonals join a corner to more than the three that ridges join it to.
        CHECK(found.neighbors_of(i).size() >= (found.is_peak(i) ? 3U : 2U));
        if (!found.is_peak(i)) CHECK(found.neighbors_of(i).size() == 2);
      }
    }
    CHECK(find_protrusions(hollow).ends.empty());
  }

  TEST_CASE("a flat sheet protrudes at its rim only, and each part belongs to a triangle that has it") {
    const MeshDesc sheet = test::make_grid(5, 4, 1);
    const Protrusions found = find_protrusions(sheet);
    CHECK(found.ends.size() == 28);  // the rim has 14 edges and as many corners
    CHECK(peaks_of(found) == 14);
    CHECK(found.triangle_begin.size() == sheet.triangles.size() + 1);
    CHECK(found.triangle_begin.back() == found.ends.size());
    for (std::size_t t = 0; t < sheet.triangles.size(); ++t) {
      for (std::uint32_t i = found.triangle_begin[t]; i < found.triangle_begin[t + 1]; ++i) {
        for (const std::uint32_t vertex : found.ends[i])
          CHECK(std::find(sheet.triangles[t].begin(), sheet.triangles[t].end(), vertex) !=
                sheet.triangles[t].end());
      }
    }
  }

  TEST_CASE("a roof has a ridge, a valley has none") {
    for (const double height : {1.0, -1.0}) {
      const auto y = static_cast<Real>(height);
      const MeshDesc mesh = {
          .positions = {{-1, 0, 0}, {-1, 0, 1}, {0, y, 1}, {0, y, 0}, {1, 0, 1}, {1, 0, 0}},
          .triangles = {{0, 1, 2}, {0, 2, 3}, {3, 2, 4}, {3, 4, 5}}};
      const Protrusions found = find_protrusions(mesh);
      const bool has_ridge =
          std::find(found.ends.begin(), found.ends.end(), geometry::Edge{2, 3}) != found.ends.end();
      CHECK(has_ridge == (height > 0));
    }
  }
}

}  // namespace hooke
