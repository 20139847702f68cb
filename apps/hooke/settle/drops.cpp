#include "hooke/settle/drops.h"

#include "hooke/world.h"

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <optional>
#include <thread>
#include <utility>

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

/// A world of a plane and the mesh, from which each trial starts anew, so that none depends on those before.
class Trials {
 public:
  static Result<Trials> create(const MeshDesc& mesh, const DropOptions& options) {
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
    return Trials(std::move(made).value(), body.value());
  }

  /// Lets the mesh go from `pose`. Returns its rotation at rest, or nothing if it still moves after a minute.
  Result<std::optional<Quat>> run(const Pose& pose) {
    if (auto restored = world_.restore(start_); !restored) return restored.error();
    if (auto placed = world_.set_pose(body_, pose); !placed) return placed.error();
    for (int step = 0; step < kStepsMax && !world_.asleep(body_); ++step) world_.step(Real(1) / 60);
    if (!world_.asleep(body_)) return std::optional<Quat>();
    return std::optional<Quat>(world_.pose(body_).rotation);
  }

 private:
  Trials(World world, BodyId body) : world_(std::move(world)), start_(world_.snapshot()), body_(body) {}

  World world_;
  Snapshot start_;
  BodyId body_;
};

using Rests = std::vector<std::optional<Quat>>;

/// Lets the mesh go from each of the poses; each thread has a world of its own, and takes every so many-th.
Result<Rests> rests_of(const MeshDesc& mesh, const std::vector<Pose>& starts, const DropOptions& options) {
  const auto workers = std::clamp<std::size_t>(static_cast<std::size_t>(options.workers), 1, starts.size());
  Rests rests(starts.size());
  std::vector<Result<void>> done(workers);
  const auto work = [&](std::size_t worker) -> Result<void> {
    auto trials = Trials::create(mesh, options);
    if (!trials) return trials.error();
    for (std::size_t i = worker; i < starts.size(); i += workers) {
      const auto rest = trials.value().run(starts[i]);
      if (!rest) return rest.error();
      rests[i] = rest.value();
    }
    return {};
  };
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 1; i < workers; ++i) {
      threads.emplace_back([&, i] { done[i] = work(i); });
    }
    done[0] = work(0);
  }
  for (const auto& one : done) {
    if (!one) return one.error();
  }
  return rests;
}

/// Counts one more drop that lies in no stable pose.
void count_other(std::vector<OtherPose>& others, Quat rotation) {
  const auto normal = vector_cast<double>(rotate(conjugate(rotation), Vec3{0, -1, 0}));
  for (OtherPose& other : others) {
    if (dot(other.normal, normal) < kCosineOfPose) continue;
    ++other.count;
    return;
  }
  others.push_back({normal, 1});
}

}  // namespace

double radius_of(const MeshDesc& mesh, DVec3 center) {
  double radius = 0;
  for (const Vec3& p : mesh.positions) radius = std::max(radius, length(vector_cast<double>(p) - center));
  return radius;
}

Result<DropCounts> drop(const MeshDesc& mesh, const StablePoses& poses, const DropOptions& options) {
  Random random(options.seed);
  std::vector<Pose> starts;
  starts.reserve(static_cast<std::size_t>(options.count));
  for (int i = 0; i < options.count; ++i) {
    starts.push_back(start_pose(mesh, random.rotation(), options.height));
  }
  const auto rests = rests_of(mesh, starts, options);
  if (!rests) return rests.error();
  DropCounts counts;
  counts.poses.assign(poses.poses.size(), 0);
  for (const std::optional<Quat>& rest : rests.value()) {
    if (!rest) {
      ++counts.moving;
    } else if (const auto found = pose_of(poses, *rest)) {
      ++counts.poses[*found];
    } else {
      ++counts.elsewhere;
      count_other(counts.others, *rest);
    }
  }
  return counts;
}

Result<std::vector<int>> disturb(const MeshDesc& mesh, const StablePoses& poses, double distance,
                                 const DropOptions& options) {
  const double angle = std::min(distance / radius_of(mesh, poses.center), 1.0);
  // The sine and cosine of eighths of a turn, so that no rounding of a library is in the starts.
  constexpr double kHalf = std::numbers::sqrt2 / 2;
  constexpr double kTurns[8][2] = {{1, 0},  {kHalf, kHalf},   {0, 1},  {-kHalf, kHalf},
                                   {-1, 0}, {-kHalf, -kHalf}, {0, -1}, {kHalf, -kHalf}};
  std::vector<Pose> starts;
  for (const StablePose& pose : poses.poses) {
    starts.push_back(start_pose(mesh, pose.rotation, distance));
    for (const auto& [x, z] : kTurns) {
      // To the first order: an angle of half a radian is 2 % less, and repeats on every machine.
      const Quaternion<double> turn = normalize(Quaternion<double>{x * angle / 2, 0, z * angle / 2, 1});
      starts.push_back(start_pose(mesh, turn * pose.rotation, 0));
    }
  }
  const auto rests = rests_of(mesh, starts, options);
  if (!rests) return rests.error();
  std::vector<int> stays(poses.poses.size(), 0);
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const auto& rest = rests.value()[i];
    const std::size_t pose = i / kDisturbances;
    if (rest && pose_of(poses, *rest) == pose) ++stays[pose];
  }
  return stays;
}

}  // namespace hooke::app
