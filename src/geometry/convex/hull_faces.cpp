#include "base/assert.h"
#include "geometry/convex/quickhull.h"

#include <algorithm>
#include <numeric>

namespace hooke::geometry {

namespace {

constexpr std::uint32_t kNoFace = 0xFFFFFFFF;

/// Joins triangles to faces, one face after another. A face grows by one triangle at a time and stays a disc:
/// its rim passes through each point once.
class FaceGrowth {
 public:
  FaceGrowth(std::span<const HullTriangle> triangles, std::span<const GridPoint> points, double tolerance,
             bool stay_convex)
      : triangles_(triangles),
        points_(points),
        tolerance_(tolerance),
        stay_convex_(stay_convex),
        face_of_(triangles.size(), kNoFace) {}

  std::vector<std::vector<std::uint32_t>> run() {
    std::vector<std::uint32_t> by_area(triangles_.size());
    std::iota(by_area.begin(), by_area.end(), 0u);
    std::stable_sort(by_area.begin(), by_area.end(), [this](std::uint32_t a, std::uint32_t b) {
      return triangles_[a].inverse_length < triangles_[b].inverse_length;
    });
    std::vector<std::vector<std::uint32_t>> faces;
    for (const std::uint32_t seed : by_area) {
      if (face_of_[seed] != kNoFace) continue;
      grow(seed, static_cast<std::uint32_t>(faces.size()));
      std::rotate(rim_.begin(), std::min_element(rim_.begin(), rim_.end()), rim_.end());
      faces.push_back(rim_);
    }
    return faces;
  }

 private:
  void grow(std::uint32_t seed, std::uint32_t face) {
    face_of_[seed] = face;
    rim_.assign(triangles_[seed].vertex.begin(), triangles_[seed].vertex.end());
    std::vector<std::uint32_t> members = {seed};
    // A triangle that did not fit may fit once others have joined: walk again until nothing changes.
    for (std::size_t before = 0; before != members.size();) {
      before = members.size();
      for (std::size_t i = 0; i < members.size(); ++i) {
        for (const std::uint32_t candidate : triangles_[members[i]].neighbor) {
          if (face_of_[candidate] != kNoFace || !is_near_plane(candidate, seed) || !join(candidate, seed))
            continue;
          face_of_[candidate] = face;
          members.push_back(candidate);
        }
      }
    }
  }

  [[nodiscard]] bool is_near_plane(std::uint32_t candidate, std::uint32_t seed) const {
    return std::ranges::all_of(triangles_[candidate].vertex, [&](std::uint32_t v) {
      return height_over(triangles_[seed], points_, points_[v]) >= -tolerance_;
    });
  }

  [[nodiscard]] std::size_t find_on_rim(std::uint32_t vertex) const {
    return static_cast<std::size_t>(std::find(rim_.begin(), rim_.end(), vertex) - rim_.begin());
  }

  /// Moves the rim out around a triangle that shares an edge with the face. Returns false if it must not.
  bool join(std::uint32_t candidate, std::uint32_t seed) {
    const std::array<std::uint32_t, 3>& vertex = triangles_[candidate].vertex;
    std::array<std::size_t, 3> place = {};
    std::transform(vertex.begin(), vertex.end(), place.begin(),
                   [this](std::uint32_t v) { return find_on_rim(v); });
    HOOKE_ASSERT(std::ranges::count(place, rim_.size()) <= 1);  // they share an edge
    std::vector<std::uint32_t> rim = rim_;
    std::size_t fresh = 0;
    while (fresh < 3 && place[fresh] != rim_.size()) ++fresh;
    if (fresh < 3) {
      // The triangle runs along the shared edge from the corner after the new one to the corner before it;
      // the rim runs in the other direction.
      rim.insert(rim.begin() + static_cast<std::ptrdiff_t>(place[(fresh + 2) % 3] + 1), vertex[fresh]);
    } else if (!close_corner(vertex, place, rim)) {
      return false;
    }
    if (stay_convex_ && !is_convex(rim, seed)) return false;
    rim_ = std::move(rim);
    return true;
  }

  /// Handles a triangle with all three corners on the rim: they have to follow each other, and the middle one
  /// is left inside.
  bool close_corner(const std::array<std::uint32_t, 3>& vertex, const std::array<std::size_t, 3>& place,
                    std::vector<std::uint32_t>& rim) const {
    if (rim.size() == 3) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t before = (place[k] + rim.size() - 1) % rim.size();
      const std::size_t after = (place[k] + 1) % rim.size();
      if (rim[before] != vertex[(k + 1) % 3] || rim[after] != vertex[(k + 2) % 3]) continue;
      rim.erase(rim.begin() + static_cast<std::ptrdiff_t>(place[k]));
      return true;
    }
    return false;
  }

  /// Whether no corner of the rim, seen along the seed's normal, lies more than the tolerance inside the line
  /// between the corners beside it.
  [[nodiscard]] bool is_convex(const std::vector<std::uint32_t>& rim, std::uint32_t seed) const {
    const DVec3 normal = triangles_[seed].inverse_length * vector_cast<double>(triangles_[seed].normal);
    for (std::size_t i = 0; i < rim.size(); ++i) {
      const GridPoint before = points_[rim[(i + rim.size() - 1) % rim.size()]];
      const auto along = vector_cast<double>(points_[rim[(i + 1) % rim.size()]] - before);
      const auto aside = vector_cast<double>(points_[rim[i]] - before);
      if (dot(normal, cross(aside, along)) < -tolerance_ * length(along)) return false;
    }
    return true;
  }

  std::span<const HullTriangle> triangles_;
  std::span<const GridPoint> points_;
  double tolerance_;
  bool stay_convex_;
  std::vector<std::uint32_t> face_of_;  // by triangle
  std::vector<std::uint32_t> rim_;      // rim of the face that grows, counter-clockwise from outside
};

}  // namespace

std::vector<std::vector<std::uint32_t>> join_triangles(std::span<const HullTriangle> triangles,
                                                       std::span<const GridPoint> points, double tolerance,
                                                       bool stay_convex) {
  return FaceGrowth(triangles, points, tolerance, stay_convex).run();
}

}  // namespace hooke::geometry
