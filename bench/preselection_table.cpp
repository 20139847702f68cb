/// Prints a table of how many pairs of triangles of two meshes each preselection leaves. It compares each
/// mesh with itself in 200 poses around it. `preselection_table [MODEL...]` takes model files, too.

#include "hooke/model_io.h"

#include "geometry/mesh/preselection.h"
#include "geometry/meshes.h"
#include "math/random.h"

#include <cstdio>
#include <string>
#include <vector>

namespace {

using hooke::DVec3;
using hooke::MeshDesc;
using hooke::Real;
using hooke::geometry::BoundingVolumes;
using hooke::geometry::MeshView;
using hooke::geometry::RigidPose;
using hooke::geometry::TrianglePair;

constexpr int kPoses = 200;

struct Mesh {
  std::vector<DVec3> positions;
  const MeshDesc& desc;

  explicit Mesh(const MeshDesc& mesh) : desc(mesh) {
    for (const auto& p : mesh.positions) positions.push_back(hooke::vector_cast<double>(p));
  }
  [[nodiscard]] MeshView view() const { return {positions, desc.triangles}; }
};

RigidPose random_pose(std::mt19937_64& random, double reach) {
  const DVec3 q = hooke::test::random_vector(random);
  const double w = hooke::test::signed_unit(random);
  return {reach * hooke::test::random_vector(random), normalize(hooke::Quaternion<double>{q.x, q.y, q.z, w})};
}

/// Counts the pairs that overlap, among those that the oriented boxes leave.
std::uint64_t count_true(const Mesh& mesh, const BoundingVolumes& volumes, const RigidPose& b_in_a) {
  std::vector<TrianglePair> found;
  find_candidates(volumes.oriented_box_tree, volumes.oriented_box_tree, b_in_a, 0, found);
  std::vector<DVec3> moved;
  for (const DVec3& p : mesh.positions) moved.push_back(to_world(b_in_a, p));
  const MeshView placed = {moved, mesh.desc.triangles};
  std::uint64_t count = 0;
  for (const auto& [a, b] : found) {
    count += hooke::geometry::triangles_overlap(mesh.view().corners(a), placed.corners(b)) ? 1 : 0;
  }
  return count;
}

void add_rows(const std::string& name, const MeshDesc& desc) {
  const Mesh mesh(desc);
  const BoundingVolumes volumes = make_bounding_volumes(mesh.view());
  std::vector<RigidPose> poses;
  std::mt19937_64 random(1);
  for (int i = 0; i < kPoses; ++i) poses.push_back(random_pose(random, 1.5 * volumes.sphere.radius));
  std::uint64_t overlapping = 0;
  for (const RigidPose& pose : poses) overlapping += count_true(mesh, volumes, pose);
  std::printf("%-24s %6zu %-18s %12s %12.1f\n", name.c_str(), desc.triangles.size(), "overlap", "",
              static_cast<double>(overlapping) / kPoses);
  for (const auto preselection : hooke::kPreselections) {
    hooke::geometry::Candidates sum;
    for (const RigidPose& pose : poses) {
      const auto count = count_candidates(preselection, volumes, {}, volumes, pose);
      sum.volumes_compared += count.volumes_compared;
      sum.pairs_left += count.pairs_left;
    }
    std::printf("%-24s %6zu %-18s %12.1f %12.1f\n", name.c_str(), desc.triangles.size(),
                name_of(preselection), static_cast<double>(sum.volumes_compared) / kPoses,
                static_cast<double>(sum.pairs_left) / kPoses);
  }
}

}  // namespace

int main(int count, char** paths) {
  std::printf("%-24s %6s %-18s %12s %12s\n", "mesh", "faces", "preselection", "volumes", "pairs");
  add_rows("ball", hooke::test::make_sphere(3));
  add_rows("ring", hooke::test::make_torus(1, Real(0.2), 32, 16));
  add_rows("rod", hooke::test::make_box({4, Real(0.1), Real(0.1)}));
  for (int i = 1; i < count; ++i) {
    const std::string path = paths[i];
    const auto model = hooke::import_model(path);
    if (model) {
      add_rows(path.substr(path.rfind('/') + 1), model.value().mesh);
    } else {
      std::fprintf(stderr, "%s: %s\n", model.error().where.c_str(), model.error().message.c_str());
    }
  }
  return 0;
}
