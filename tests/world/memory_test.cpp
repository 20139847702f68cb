/// Where memory runs out: each call and each step is made to fail at its first allocation, its second, and so
/// on, until it has all it asks for.

#include "hooke/world.h"

#include "world/allocation_counter.h"
#include "world/make.h"

#include <cstdint>
#include <doctest/doctest.h>
#include <new>
#include <utility>

namespace hooke {

using namespace test;

namespace {

constexpr Real kDt = Real(1) / Real(60);

struct Yard {
  World world;
  MeshId mesh = {};
  BodyId box = {};
  ClothId cloth = {};
};

MeshDesc wedge() {
  return {.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          .triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

Yard make_yard() {
  Yard y{.world = make_world()};
  y.mesh = take(y.world.add_mesh(wedge()));
  take(y.world.add_body({.shape = Shape::half_space()}));
  for (int i = 0; i < 4; ++i)
    y.box = take(y.world.add_body({.kind = BodyKind::kDynamic,
                                   .shape = Shape::box({Real(0.5), Real(0.5), Real(0.5)}),
                                   .position = {0, 0.5 + i, 0}}));
  y.cloth = take(
      y.world.add_cloth({.columns = 5, .rows = 5, .corner = {-0.5, 5, -0.5}, .row_direction = {0, 0, 1}}));
  const RopeId rope = take(y.world.add_rope({.hook_point = {2, 3, 0}, .masses = 5}));
  take(y.world.add_hook({.kind = HookKind::kBall, .a = {.body = y.box}, .b = {.point = point(rope, 4)}}));
  return y;
}

/// Calls `call(yard)` with ever more memory until it has enough; each failure leaves the world as it was.
template <class Call>
void fail_everywhere(Call&& call) {
  Yard yard = make_yard();
  Yard calm = make_yard();
  const std::uint64_t before = yard.world.state_hash();
  std::uint64_t allowed = 0;
  for (bool done = false; !done; ++allowed) {
    REQUIRE(allowed < 5000);
    try {
      const AllocationCounter counter(allowed);
      done = call(yard);
    } catch (const std::bad_alloc&) {
    }
    if (!done) CHECK(yard.world.state_hash() == before);
  }
  CHECK(allowed > 1);
  REQUIRE(call(calm));
  for (int i = 0; i < 5; ++i) {
    CHECK(yard.world.step(kDt).healthy());
    CHECK(calm.world.step(kDt).healthy());
  }
  CHECK(yard.world.state_hash() == calm.world.state_hash());
}

}  // namespace

TEST_SUITE("world/memory") {
  TEST_CASE("an object that is added only in part for lack of memory is removed again") {
    fail_everywhere([](Yard& y) { return y.world.add_mesh(wedge()).has_value(); });
    fail_everywhere([](Yard& y) {
      return y.world.add_body({.kind = BodyKind::kDynamic, .shape = Shape::hull_of(y.mesh)}).has_value();
    });
    fail_everywhere([](Yard& y) {
      return y.world.add_body({.kind = BodyKind::kDynamic, .shape = Shape::of_mesh(y.mesh)}).has_value();
    });
    fail_everywhere([](Yard& y) { return y.world.add_rope({.hook_point = {9, 9, 9}}).has_value(); });
    fail_everywhere([](Yard& y) {
      return y.world.add_cloth({.corner = {9, 9, 9}, .tethers = true, .pins = {{0}}}).has_value();
    });
    fail_everywhere([](Yard& y) {
      return y.world.add_solid({.cells = {2, 1, 1}, .position = {9, 9, 9}}).has_value();
    });
    fail_everywhere([](Yard& y) {
      return y.world.add_particles({.particles = {{}, {.position = {0, 9, 0}}}, .springs = {{0, 1}}})
          .has_value();
    });
    fail_everywhere([](Yard& y) {
      return y.world.add_hook({.a = {.body = y.box}, .b = {.point = point(y.cloth, 12)}}).has_value();
    });
    fail_everywhere([](Yard& y) {
      const SeamDesc seam = {.a = {point(y.cloth, 0), "left"}, .b = {point(y.cloth, 0), "right"}};
      return y.world.sew(seam).has_value();
    });
    fail_everywhere([](Yard& y) { return y.world.add_field({.vector = {1, 0, 0}}).has_value(); });
  }

  TEST_CASE(
      "a body that cannot be removed, and threads that cannot be started, for lack of memory change "
      "nothing") {
    fail_everywhere([](Yard& y) { return y.world.remove(y.box); });
    fail_everywhere([](Yard& y) { return y.world.set_workers(3).has_value(); });
    Yard sleeping = make_yard();
    run(sleeping.world, 300);
    bool done = false;
    for (std::uint64_t allowed = 0; !done; ++allowed) {
      try {
        const AllocationCounter counter(allowed);
        done = sleeping.world.remove(sleeping.box);
      } catch (const std::bad_alloc&) {
      }
      CHECK(sleeping.world.step(kDt).healthy());
    }
  }

  TEST_CASE("a world whose restore fails for lack of memory is empty, and can be restored later") {
    Yard yard = make_yard();
    const std::uint64_t before = yard.world.state_hash();
    const Snapshot snapshot = yard.world.snapshot();
    std::uint64_t allowed = 0;
    for (bool done = false; !done; ++allowed) {
      World other = make_world();
      try {
        const AllocationCounter counter(allowed);
        done = other.restore(snapshot).has_value();
      } catch (const std::bad_alloc&) {
        CHECK(other.memory().particles == 0);
        CHECK(other.add_rope({}).has_value());
        CHECK(other.step(kDt).healthy());
        CHECK(other.restore(snapshot).has_value());
      }
      CHECK(other.state_hash() == before);
    }
    CHECK(allowed > 20);
  }

  TEST_CASE("a step without the memory it needs is taken back, and made once there is enough") {
    Yard yard = make_yard();
    const DVec3 box = yard.world.pose(yard.box).position;
    const DVec3 corner = yard.world.positions(yard.cloth)[24];
    std::uint64_t allowed = 0;
    for (bool done = false; !done; ++allowed) {
      REQUIRE(allowed < 5000);
      try {
        const AllocationCounter counter(allowed);
        done = yard.world.step(kDt).moved;
      } catch (const std::bad_alloc&) {
        CHECK(yard.world.pose(yard.box).position == box);
        CHECK(yard.world.positions(yard.cloth)[24] == corner);
        CHECK(yard.world.time() == 0);
      }
    }
    CHECK(allowed > 20);
    run(yard.world, 60);
    CHECK(yard.world.pose(yard.box).position.y == doctest::Approx(3.5).epsilon(0.01));
  }
}

}  // namespace hooke
