#include "fuzz/population.h"

#include <algorithm>

namespace hooke::fuzz {

namespace {

template <class IdType>
PointRef point_of_one(Random& random, const World& world, const std::vector<IdType>& ids) {
  if (ids.empty()) return {};
  const IdType id = random.one_of(ids);
  return point(id, random.index(world.positions(id).size()));
}

}  // namespace

PointRef pick_point(Random& random, const World& world, const Population& all) {
  const PointRef points[] = {point_of_one(random, world, all.ropes), point_of_one(random, world, all.ropes),
                             point_of_one(random, world, all.cloths), point_of_one(random, world, all.solids),
                             point_of_one(random, world, all.particles)};
  const std::size_t first = random.below(5);
  for (std::size_t i = 0; i < 5; ++i) {
    const PointRef found = points[(first + i) % 5];
    if (found.kind != PointRef::Kind::kNone) return found;
  }
  return {};
}

double check_finite(const World& world, const Population& all) {
  double fastest = 0;
  for (const BodyId id : all.bodies) {
    const Pose pose = world.pose(id);
    const Vec3 v = world.velocity(id);
    expect(is_finite(pose.position) && is_finite(v) && is_finite(world.angular_velocity(id)),
           "a body is not finite");
    const Quat q = pose.rotation;
    const double size = static_cast<double>(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    expect(size > 0.99 && size < 1.01, "a rotation that is none");
    fastest = std::max(fastest, length(vector_cast<double>(v)));
  }
  for_each_view(world, all, [&](const PointView& positions, const PointView& velocities) {
    for (std::size_t i = 0; i < positions.size(); ++i) {
      expect(is_finite(positions[i]) && is_finite(velocities.offset(i)), "a point is not finite");
      fastest = std::max(fastest, length(vector_cast<double>(velocities.offset(i))));
    }
  });
  return fastest;
}

}  // namespace hooke::fuzz
