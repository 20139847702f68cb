#include "hooke/settle/drops.h"

#include "hooke/world.h"

#include <algorithm>
#include <optional>

namespace hooke::app {

namespace {

constexpr int kStepsMax = 60 * 60;       // a minute
constexpr double kCosineOfPose = 0.999;  // 2.6 degrees from the facet's normal

/// Numbers by splitmix64 (Steele, Lea, Flood 2014), because those of the standard library differ by library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// Returns a number in [-1, 1).
  double next() {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1;
  }

  /// Returns a rotation; all are equally probable, because points of a ball point everywhere alike.
  Quaternion<double> rotation() {
    for (;;) {
      const Quaternion<double> q = {next(), next(), next(), next()};
      const double square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
      if (square <= 1 && square > 1e-4) return normalize(q);
    }
  }

 private:
  std::uint64_t state_;
};

/// Returns the pose whose facet points down, or nothing.
std::optional<std::size_t> pose_of(const StablePoses& all, Quat rotation) {
  std::optional<std::size_t> found;
  double best = kCosineOfPose;
  for (std::size_t i = 0; i < all.poses.size(); ++i) {
    const double down = -static_cast<double>(rotate(rotation, vector_cast<Real>(all.poses[i].normal)).y);
    if (!(down > best)) continue;
    best = down;
    found = i;
  }
  return found;
}

Pose start_pose(const MeshDesc& mesh, Quaternion<double> rotation, double height) {
  double lowest = 0;
  bool first = true;
  for (const Vec3& p : mesh.positions) {
    const double y = rotate(rotation, vector_cast<double>(p)).y;
    lowest = first ? y : std::min(lowest, y);
    first = false;
  }
  return {.position = {0, height - lowest, 0},
          .rotation = {static_cast<Real>(rotation.x), static_cast<Real>(rotation.y),
                       static_cast<Real>(rotation.z), static_cast<Real>(rotation.w)}};
}

}  // namespace

Result<DropCounts> drop(const MeshDesc& mesh, const StablePoses& poses, const DropOptions& options) {
  auto made = World::create();
  if (!made) return made.error();
  World& world = made.value();
  const auto shape = world.add_mesh(mesh);
  if (!shape) return shape.error();
  const ContactDesc contact = {.friction = static_cast<Real>(options.friction),
                               .restitution = static_cast<Real>(options.restitution)};
  const auto ground = world.add_body({.shape = Shape::half_space(), .contact = contact});
  if (!ground) return ground.error();
  const auto body = world.add_body(
      {.kind = BodyKind::kDynamic, .shape = Shape::of_mesh(shape.value()), .contact = contact});
  if (!body) return body.error();
  // Each drop starts from the same world, so that none depends on those before it.
  const Snapshot start = world.snapshot();
  Random random(options.seed);
  DropCounts counts = {.poses = std::vector<int>(poses.poses.size(), 0)};
  for (int i = 0; i < options.count; ++i) {
    if (auto restored = world.restore(start); !restored) return restored.error();
    const auto placed = world.set_pose(body.value(), start_pose(mesh, random.rotation(), options.height));
    if (!placed) return placed.error();
    for (int step = 0; step < kStepsMax && !world.asleep(body.value()); ++step) world.step(Real(1) / 60);
    if (!world.asleep(body.value())) {
      ++counts.moving;
      continue;
    }
    const auto found = pose_of(poses, world.pose(body.value()).rotation);
    ++(found ? counts.poses[*found] : counts.elsewhere);
  }
  return counts;
}

}  // namespace hooke::app
