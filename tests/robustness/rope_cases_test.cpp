/// Ropes that wind about themselves.

#include "robustness/judged_room.h"
#include "world/knots.h"

#include <cmath>

namespace hooke {

using namespace test;

namespace {

MotionDesc moved_by(DVec3 way, double seconds) {
  MotionDesc motion;
  motion.kind = MotionDesc::Kind::kKeyframes;
  motion.keyframes = {{0, {}}, {seconds, vector_cast<Real>(way)}};
  return motion;
}

}  // namespace

TEST_SUITE("robustness/ropes") {
  TEST_CASE("D-20: an overhand knot whose ends part at 1 m/s gets tight, and no part of it passes another") {
    for (const double friction : {0.1, 0.4}) {
      CAPTURE(friction);
      Room room;
      room.world = World::create({.gravity = {}, .substeps = 1, .wind = {.air_density = Real(0)}}).value();
      RopeDesc desc = overhand(2 * kRopeRadius, friction);
      desc.axial_stiffness = Real(2e4);
      double total = 0;
      for (std::size_t i = 1; i < desc.points.size(); ++i)
        total += length(desc.points[i] - desc.points[i - 1]);
      const DVec3 along = desc.points.back() - desc.points.front();
      const double goes = total - 16 * kRopeRadius - length(along);
      const DVec3 half = 0.5 * goes * normalize(along);
      desc.pins = {{0, moved_by(-half, goes)}, {last_of(desc), moved_by(half, goes)}};
      const RopeId rope = room.add(desc);
      Surfaces before = surfaces_of(room);
      before.owners.clear();
      for (int i = 0; i < 240; ++i) {
        CHECK(room.world.step(Real(1) / 480).healthy());
        Surfaces after = surfaces_of(room);
        after.owners.clear();  // Lines of one rope count, too.
        CHECK(count_passes(before, after) == 0);
        CHECK(knot_determinant(room.world.positions(rope)) == doctest::Approx(3));
        before = after;
      }
      const PointView x = room.world.positions(rope);
      CHECK(least_distance(x, x, true, 3.2 * kRopeRadius) > 1.8 * kRopeRadius);
      CHECK(room.world.measure().largest_stretch < 0.05);
      CHECK(rms_of(room.world.velocities(rope)) < 0.05);
    }
  }
}

}  // namespace hooke
