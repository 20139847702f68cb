/// hooke-ofg measures how often opposing face geometry finds that two meshes overlap, how many of the pairs
/// of triangles it finds, and what it costs. It varies k and mesh size, and compares with brute force and
/// trees. `hooke bench ofg` starts it.

#include "geometry/convex/convex_hull.h"
#include "geometry/meshes.h"
#include "lab/shape/opposing_faces.h"
#include "math/random.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

namespace {

using hooke::DVec3;
using hooke::MeshDesc;
using hooke::Real;
using hooke::geometry::ContactMesh;
using hooke::geometry::RigidPose;
using hooke::geometry::TrianglePair;
using hooke::geometry::triangles_overlap;
using hooke::test::random_vector;

constexpr int kPoses = 40;
/// Overlap of the meshes, as a share of the sum of their radii, as a step of a simulation finds it.
constexpr double kDepth = 0.01;

struct Pair {
  const char* name;
  ContactMesh a, b;
};

ContactMesh solid(const MeshDesc& mesh) {
  return hooke::geometry::make_contact_mesh(mesh).value();
}

MeshDesc scaled(MeshDesc mesh, Real factor) {
  for (auto& p : mesh.positions) p = factor * p;
  return mesh;
}

/// Returns the hull of the mesh before and after a shift, which is what a convex body passes over in a step
/// without rotation.
MeshDesc extruded(const MeshDesc& mesh, hooke::Vec3 shift) {
  std::vector<hooke::Vec3> points = mesh.positions;
  for (const auto& p : mesh.positions) points.push_back(p + shift);
  return mesh_of(hooke::geometry::make_convex_hull(points).value());
}

std::vector<Pair> pairs_of_meshes() {
  using namespace hooke::test;
  std::vector<Pair> pairs;
  for (int level = 1; level <= 5; ++level) {
    pairs.push_back({"two balls", solid(make_sphere(level)), solid(make_sphere(level))});
  }
  pairs.push_back({"ball, ball of 1/8", solid(make_sphere(3)), solid(scaled(make_sphere(3), Real(0.125)))});
  pairs.push_back({"cube, ball", solid(make_cube(1)), solid(make_sphere(3))});
  pairs.push_back({"plate, ball", solid(make_box({4, Real(0.1), 4})), solid(make_sphere(3))});
  pairs.push_back(
      {"two rings", solid(make_torus(1, Real(0.3), 16, 8)), solid(make_torus(1, Real(0.3), 16, 8))});
  pairs.push_back(
      {"two rings", solid(make_torus(1, Real(0.3), 64, 32)), solid(make_torus(1, Real(0.3), 64, 32))});
  pairs.push_back({"ell, ball", solid(make_ell(Real(0.5))), solid(scaled(make_sphere(3), Real(0.5)))});
  pairs.push_back({"extruded ball, ball", solid(extruded(make_sphere(2), {2, 0, 0})), solid(make_sphere(2))});
  return pairs;
}

double unit(std::mt19937_64& random) {
  return hooke::test::signed_unit(random);
}

/// Returns the pairs that overlap, by the tree, in order.
std::vector<TrianglePair> pairs_by_tree(const Pair& pair, const RigidPose& pose_b) {
  std::vector<TrianglePair> near;
  find_candidates(pair.a.tree, pair.b.tree, pose_b, 0, near);
  std::vector<DVec3> moved;
  for (const DVec3& p : pair.b.positions) moved.push_back(to_world(pose_b, p));
  const hooke::geometry::MeshView view = {moved, pair.b.triangles};
  std::erase_if(near, [&](const TrianglePair& t) {
    return !triangles_overlap(pair.a.view().corners(t.first), view.corners(t.second));
  });
  std::sort(near.begin(), near.end());
  return near;
}

std::size_t count_by_all(const Pair& pair, const RigidPose& pose_b) {
  std::vector<DVec3> moved;
  for (const DVec3& p : pair.b.positions) moved.push_back(to_world(pose_b, p));
  const hooke::geometry::MeshView view = {moved, pair.b.triangles};
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < pair.a.triangles.size(); ++i) {
    for (std::uint32_t k = 0; k < pair.b.triangles.size(); ++k) {
      count += triangles_overlap(pair.a.view().corners(i), view.corners(k)) ? 1 : 0;
    }
  }
  return count;
}

/// Moves the second mesh from far toward a random point of the first one's box until they touch, and a little
/// farther.
RigidPose touching_pose(const Pair& pair, std::mt19937_64& random) {
  const DVec3 q = random_vector(random);
  RigidPose pose = {{}, normalize(hooke::Quaternion<double>{q.x, q.y, q.z, unit(random)})};
  const DVec3 way = normalize(random_vector(random));
  const auto& box = pair.a.tree.nodes[0].volume;
  const DVec3 r = random_vector(random);
  const DVec3 h = box.half_extents;
  const DVec3 aim = box.center + box.axes * DVec3{r.x * h.x, r.y * h.y, r.z * h.z};
  const double reach = pair.a.sphere.radius + pair.b.sphere.radius;
  const auto at = [&](double distance) {
    pose.position = aim + distance * way;
    return pose;
  };
  double out = 3 * reach;
  double in = out;
  while (pairs_by_tree(pair, at(in)).empty() && in > -3 * reach) in -= 0.5 * kDepth * reach;
  out = in + 0.5 * kDepth * reach;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (in + out);
    (pairs_by_tree(pair, at(middle)).empty() ? out : in) = middle;
  }
  return at(in - kDepth * reach);
}

/// Returns the median over the poses, because the machine may be busy.
template <class Work>
double microseconds(const std::vector<RigidPose>& poses, const Work& work) {
  std::vector<double> times;
  for (const RigidPose& pose : poses) {
    const auto start = std::chrono::steady_clock::now();
    work(pose);
    const std::chrono::duration<double, std::micro> elapsed = std::chrono::steady_clock::now() - start;
    times.push_back(elapsed.count());
  }
  std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2), times.end());
  return times[times.size() / 2];
}

/// Measures all k for one pair of meshes, with a line of CSV each.
void measure(const Pair& pair, bool as_csv, std::FILE* out) {
  std::mt19937_64 random(1);
  std::vector<RigidPose> poses;
  while (poses.size() < kPoses) {
    const RigidPose pose = touching_pose(pair, random);
    if (!pairs_by_tree(pair, pose).empty()) poses.push_back(pose);  // A few meshes have missed each other.
  }
  std::size_t total = 0;
  for (const RigidPose& pose : poses) total += pairs_by_tree(pair, pose).size();
  const double by_tree = microseconds(poses, [&](const RigidPose& pose) { pairs_by_tree(pair, pose); });
  const std::vector<RigidPose> few(poses.begin(), poses.begin() + 3);
  const double by_all = microseconds(few, [&](const RigidPose& pose) { count_by_all(pair, pose); });
  for (const int k : {4, 8, 16, 32, 64}) {
    int seen = 0;
    std::size_t found = 0;
    hooke::collision::OpposingFaces faces;
    const double by_ofg = microseconds(poses, [&](const RigidPose& pose) {
      find_opposing_faces(pair.a, {}, pair.b, pose, k, faces);
      seen += faces.overlapping.empty() ? 0 : 1;
      found += faces.overlapping.size();
    });
    const char* form = as_csv ? "%s,%zu,%zu,%d,%.1f,%.1f,%.1f,%.1f,%.1f\n"
                              : "%-20s %6zu %6zu %4d %8.1f %8.1f %10.1f %10.1f %10.1f\n";
    std::fprintf(out, form, pair.name, pair.a.triangles.size(), pair.b.triangles.size(), k,
                 100.0 * seen / kPoses, 100.0 * static_cast<double>(found) / static_cast<double>(total),
                 by_ofg, by_tree, by_all);
    std::fflush(out);
  }
}

}  // namespace

int main(int count, char** words) {
  const bool as_csv = count > 1;
  std::FILE* out = as_csv ? std::fopen(words[1], "w") : stdout;
  if (out == nullptr) {
    std::fprintf(stderr, "hooke-ofg: %s: %s\n", words[1], std::strerror(errno));
    return 1;
  }
  std::fputs(
      as_csv ? "meshes,faces_a,faces_b,k,seen_percent,pairs_percent,us_ofg,us_tree,us_brute_force\n"
             : "meshes               faces  faces    k   seen %  pairs %     us ofg    us tree   us brute\n",
      out);
  for (const Pair& pair : pairs_of_meshes()) measure(pair, as_csv, out);
  if (as_csv) std::fclose(out);
  return 0;
}
