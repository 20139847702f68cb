/// What calls do at the wrong time: from within a step, on a World that was moved from, and after a step that
/// ended by an exception.

#include "world/make.h"

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace hooke {

using namespace test;

namespace {

constexpr Real kDt = Real(1) / Real(60);

struct Ids {
  MeshId mesh = {};
  BodyId floor = {}, box = {}, sleeper = {}, lift = {};
  HookId hook = {};
  RopeId rope = {};
  ClothId cloth = {};
  SolidId solid = {};
  ParticlesId particles = {};
  FieldId field = {};
  ForceLawId law = {};
};

/// Some of everything, in motion, and a box that sleeps.
struct Hall : Ids {
  World world;
};

MeshDesc tetrahedron() {
  return {.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          .triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

Hall make_hall(int workers = 1) {
  Hall h{{}, make_world({.workers = workers})};
  World& w = h.world;
  h.mesh = take(w.add_mesh(tetrahedron()));
  h.field = take(w.add_field({.vector = {Real(0.1), 0, 0}}));
  h.law = take(w.add_force_law(ForceLaw([](ForceView&) {})));
  h.floor = take(w.add_body({.shape = Shape::half_space()}));
  h.sleeper = take(w.add_body({.kind = BodyKind::kDynamic,
                               .shape = Shape::box({Real(0.5), Real(0.25), Real(0.5)}),
                               .position = {-4, 0.25, 0}}));
  for (int i = 0; i < 60; ++i) w.step(kDt);
  REQUIRE(w.asleep(h.sleeper));
  h.lift = take(w.add_body({.kind = BodyKind::kKinematic,
                            .shape = Shape::box({1, Real(0.125), 1}),
                            .position = {4, 1, 0},
                            .motion = {.kind = MotionDesc::Kind::kConstantVelocity, .velocity = {0, 1, 0}}}));
  h.box = take(w.add_body({.kind = BodyKind::kDynamic,
                           .shape = Shape::box({Real(0.25), Real(0.5), Real(0.25)}),
                           .position = {4, 1.625, 0},
                           .angular_velocity = {0, 3, 0}}));
  h.rope = take(w.add_rope({.hook_point = {3, 5, 0}}));
  h.cloth = take(w.add_cloth({.columns = 6, .rows = 6, .corner = {0, 3, 0}, .pins = {{0}}}));
  h.solid = take(w.add_solid({.cells = {2, 2, 2}, .position = {-2, 2, 0}}));
  h.particles = take(w.add_particles({.particles = {{.position = {0, 5, 5}}}}));
  h.hook = take(w.add_hook({.kind = HookKind::kBall, .a = {.body = h.box}, .anchor = {4, 3, 0}}));
  for (int i = 0; i < 20; ++i) REQUIRE(w.step(kDt).healthy());
  REQUIRE(w.asleep(h.sleeper));
  return h;
}

using Call = std::pair<const char*, std::function<bool(World&)>>;

/// Every call that changes a world, and whether it did.
std::vector<Call> calls_that_add(const Ids& h) {
  return {
      {"add_mesh", [](World& w) { return w.add_mesh(tetrahedron()).has_value(); }},
      {"add_body", [](World& w) { return w.add_body({.shape = Shape::sphere(1)}).has_value(); }},
      {"add_hook", [=](World& w) { return w.add_hook({.a = {.body = h.box}}).has_value(); }},
      {"sew",
       [=](World& w) {
         return w.sew({.a = {point(h.cloth, 0), "left"}, .b = {point(h.cloth, 0), "right"}}).has_value();
       }},
      {"add_rope", [](World& w) { return w.add_rope({}).has_value(); }},
      {"add_cloth", [](World& w) { return w.add_cloth({}).has_value(); }},
      {"add_solid", [](World& w) { return w.add_solid({}).has_value(); }},
      {"add_particles", [](World& w) { return w.add_particles({.particles = {{}}}).has_value(); }},
      {"add_field", [](World& w) { return w.add_field({}).has_value(); }},
      {"add_force_law", [](World& w) { return w.add_force_law(ForceLaw([](ForceView&) {})).has_value(); }},
      {"add_force_law of bodies",
       [](World& w) { return w.add_force_law(BodyForceLaw([](BodyForceView&) {})).has_value(); }},
  };
}

std::vector<Call> calls_that_remove(const Ids& h) {
  return {
      {"remove mesh", [=](World& w) { return w.remove(h.mesh); }},
      {"remove body", [=](World& w) { return w.remove(h.box); }},
      {"remove bodies",
       [=](World& w) {
         const std::vector<BodyId> ids = {h.box, h.floor};
         return w.remove(ids) > 0;
       }},
      {"remove hook", [=](World& w) { return w.remove(h.hook); }},
      {"remove rope", [=](World& w) { return w.remove(h.rope); }},
      {"remove cloth", [=](World& w) { return w.remove(h.cloth); }},
      {"remove solid", [=](World& w) { return w.remove(h.solid); }},
      {"remove particles", [=](World& w) { return w.remove(h.particles); }},
      {"remove field", [=](World& w) { return w.remove(h.field); }},
      {"remove law", [=](World& w) { return w.remove(h.law); }},
  };
}

std::vector<Call> calls_that_push(const Ids& h) {
  const PointRef p = point(h.rope, 7);
  return {
      {"apply_force, point",
       [=](World& w) {
         return w.apply_force(p, {1, 0, 0}).has_value();
       }},
      {"apply_impulse, point",
       [=](World& w) {
         return w.apply_impulse(p, {1, 0, 0}).has_value();
       }},
      {"set_velocity, point",
       [=](World& w) {
         return w.set_velocity(p, {1, 0, 0}).has_value();
       }},
      {"set_position",
       [=](World& w) {
         return w.set_position(p, {9, 9, 9}).has_value();
       }},
      {"apply_force",
       [=](World& w) {
         return w.apply_force(h.box, {1, 0, 0}).has_value();
       }},
      {"apply_force at",
       [=](World& w) {
         return w.apply_force(h.box, {1, 0, 0}, {}).has_value();
       }},
      {"apply_torque",
       [=](World& w) {
         return w.apply_torque(h.box, {1, 0, 0}).has_value();
       }},
      {"apply_impulse",
       [=](World& w) {
         return w.apply_impulse(h.box, {1, 0, 0}).has_value();
       }},
      {"apply_impulse at",
       [=](World& w) {
         return w.apply_impulse(h.box, {1, 0, 0}, {}).has_value();
       }},
      {"set_velocity",
       [=](World& w) {
         return w.set_velocity(h.box, {1, 0, 0}).has_value();
       }},
      {"set_angular_velocity",
       [=](World& w) {
         return w.set_angular_velocity(h.box, {1, 0, 0}).has_value();
       }},
      {"set_pose",
       [=](World& w) {
         return w.set_pose(h.box, {{0, 9, 0}}).has_value();
       }},
      {"set_motion", [=](World& w) { return w.set_motion(h.lift, {}).has_value(); }},
      {"set_motor",
       [=](World& w) {
         return w.set_motor(h.hook, {1, 1}).has_value();
       }},
      {"set_spring",
       [=](World& w) {
         return w.set_spring(h.hook, {1, 1}).has_value();
       }},
      {"set_steering", [=](World& w) { return w.set_steering(h.hook, 1).has_value(); }},
      {"pin", [=](World& w) { return w.pin(p).has_value(); }},
      {"unpin", [=](World& w) { return w.unpin(point(h.cloth, 0)).has_value(); }},
      {"cut", [](World& w) { return w.cut({}).has_value(); }},
      {"set_gravity", [](World& w) { return w.set_gravity({}).has_value(); }},
      {"set_wind",
       [](World& w) {
         return w.set_wind({.velocity = {9, 0, 0}}).has_value();
       }},
      {"set_workers", [](World& w) { return w.set_workers(2).has_value(); }},
      {"step", [](World& w) { return w.step(kDt).moved; }},
  };
}

std::vector<Call> all_calls(const Ids& h, const Snapshot& snapshot) {
  std::vector<Call> all = calls_that_add(h);
  for (const auto& more : {calls_that_remove(h), calls_that_push(h)}) {
    all.insert(all.end(), more.begin(), more.end());
  }
  all.emplace_back("restore", [snapshot](World& w) { return w.restore(snapshot).has_value(); });
  return all;
}

World take_away(World& world) {
  return std::move(world);
}

/// Two worlds that a step brought to the same bits go on with the same bits.
void check_same_future(World& a, World& b) {
  for (int i = 0; i < 10; ++i) {
    CHECK(a.step(kDt).healthy());
    CHECK(b.step(kDt).healthy());
    CHECK(a.state_hash() == b.state_hash());
  }
}

struct Seen {
  std::vector<DVec3> places;
  bool operator==(const Seen&) const = default;
};

/// Places and velocities of everything.
Seen look(const Hall& h) {
  Seen seen;
  const World& w = h.world;
  for (const BodyId body : {h.floor, h.box, h.sleeper, h.lift}) {
    const Pose pose = w.pose(body);
    seen.places.push_back(pose.position);
    seen.places.push_back({d(pose.rotation.x), d(pose.rotation.y), d(pose.rotation.z)});
    seen.places.push_back(vector_cast<double>(w.velocity(body)));
    seen.places.push_back(vector_cast<double>(w.angular_velocity(body)));
    seen.places.push_back({w.asleep(body) ? 1.0 : 0.0, 0, w.time()});
  }
  for (const PointView& view : {w.positions(h.rope), w.velocities(h.rope), w.positions(h.cloth),
                                w.velocities(h.cloth), w.positions(h.solid), w.velocities(h.solid)}) {
    for (std::size_t i = 0; i < view.size(); ++i) seen.places.push_back(view[i]);
  }
  return seen;
}

double largest_difference(const Seen& a, const Seen& b) {
  REQUIRE(a.places.size() == b.places.size());
  double largest = 0;
  for (std::size_t i = 0; i < a.places.size(); ++i)
    largest = std::max(largest, length(a.places[i] - b.places[i]));
  return largest;
}

}  // namespace

TEST_SUITE("world/calls") {
  TEST_CASE("a force law cannot change the world, and a step does not notice that it tried") {
    for (const bool of_bodies : {false, true}) {
      Hall tried = make_hall();
      Hall calm = make_hall();
      const std::vector<Call> calls = all_calls(tried, tried.world.snapshot());
      std::vector<std::string> done;
      const auto attempt = [&] {
        for (const auto& [name, call] : calls) {
          if (call(tried.world)) done.emplace_back(name);
        }
        if (Snapshot s = tried.world.snapshot(); calm.world.restore(s).has_value())
          done.emplace_back("snapshot");
        if (tried.world.cast_ray({0, 9, 0}, {0, -9, 0}).has_value()) done.emplace_back("cast_ray");
      };
      const auto add = [&](World& world, const std::function<void()>& what) {
        return of_bodies ? take(world.add_force_law(BodyForceLaw([what](BodyForceView&) { what(); })))
                         : take(world.add_force_law(ForceLaw([what](ForceView&) { what(); })));
      };
      const ForceLawId law = add(tried.world, attempt);
      const ForceLawId idle = add(calm.world, [] {});
      CHECK(tried.world.step(kDt).healthy());
      CHECK(calm.world.step(kDt).healthy());
      CHECK(done == std::vector<std::string>{});
      CHECK(tried.world.state_hash() == calm.world.state_hash());
      CHECK(tried.world.remove(law));
      CHECK(calm.world.remove(idle));
      check_same_future(tried.world, calm.world);
    }
  }

  TEST_CASE("each call says why a force law may not make it") {
    Hall h = make_hall();
    std::string where;
    std::string message;
    take(h.world.add_force_law(ForceLaw([&](ForceView&) {
      const Result<RopeId> added = h.world.add_rope({});
      where = added.error().where;
      message = added.error().message;
    })));
    CHECK(h.world.step(kDt).moved);
    CHECK(where == "world");
    CHECK(message.find("during a step") != std::string::npos);
  }

  TEST_CASE("each of these calls changes a world between steps") {
    const Hall probe = make_hall();
    const std::size_t count = all_calls(probe, {}).size();
    for (std::size_t i = 0; i + 1 < count; ++i) {
      Hall h = make_hall();
      const Call call = all_calls(h, {})[i];
      const bool steers = std::string(call.first) == "set_steering";  // not of a ball
      CHECK_MESSAGE(call.second(h.world) == !steers, call.first);
      CHECK_MESSAGE(h.world.step(kDt).moved, call.first);
    }
  }

  TEST_CASE("a force law may move its world away; the step ends where the world is then") {
    Hall calm = make_hall();
    take(calm.world.add_force_law(ForceLaw([](ForceView&) {})));
    Hall h = make_hall();
    std::unique_ptr<World> elsewhere;
    take(h.world.add_force_law(ForceLaw([&](ForceView&) {
      if (!elsewhere) elsewhere = std::make_unique<World>(std::move(h.world));
      CHECK_FALSE(elsewhere->add_rope({}).has_value());
    })));
    CHECK(h.world.step(kDt).healthy());
    CHECK(calm.world.step(kDt).healthy());
    REQUIRE(elsewhere);
    CHECK(elsewhere->state_hash() == calm.world.state_hash());
    CHECK_FALSE(h.world.step(kDt).moved);
  }

  TEST_CASE("a force law may destroy its world") {
    auto world = std::make_unique<World>(make_world());
    take(world->add_rope({}));
    int calls = 0;
    take(world->add_force_law(ForceLaw([&](ForceView& view) {
      world.reset();
      calls += view.size() == 16 ? 1 : 0;
    })));
    CHECK(world->step(kDt).moved);
    CHECK(calls == 8);
  }

  TEST_CASE("a World that was moved from refuses what changes it and reads as one that holds nothing") {
    Hall h = make_hall();
    const std::vector<Call> calls = all_calls(h, h.world.snapshot());
    const World there = take_away(h.world);
    World& gone = h.world;
    for (const Call& call : calls) CHECK_FALSE_MESSAGE(call.second(gone), call.first);
    CHECK(gone.add_rope({}).error().message.find("moved from") != std::string::npos);
    CHECK_FALSE(gone.cast_ray({0, 9, 0}, {0, -9, 0}).has_value());
    CHECK_FALSE(gone.find_closest({}, 1).has_value());
    CHECK_FALSE(gone.find_place({.body = h.box}).has_value());
    CHECK(gone.pose(h.box).position == DVec3{});
    CHECK(gone.mass(h.box) == Real(0));
    CHECK(gone.positions(h.rope).empty());
    CHECK(gone.surface(h.solid).empty());
    CHECK(gone.triangles(h.cloth).empty());
    CHECK(gone.tensions(h.rope).empty());
    CHECK(gone.body_contacts().empty());
    CHECK(gone.events().hits.empty());
    CHECK(gone.broken_hooks().empty());
    CHECK(gone.hook_anchors(h.hook)[0] == DVec3{});
    CHECK(gone.connection_points({.body = h.box}).empty());
    CHECK(gone.time() == 0);
    CHECK(gone.step_count() == 0);
    CHECK(gone.measure().energy.total() == 0);
    CHECK(gone.memory().particles == 0);
    CHECK(gone.state_hash() == World::create().value().state_hash());
    World other = make_world();
    CHECK_FALSE(other.restore(gone.snapshot()).has_value());
    gone = make_world();  // and can be used again
    CHECK(gone.add_rope({}).has_value());
    CHECK(there.positions(h.rope).size() == 16);
  }

  TEST_CASE("a step that ends by an exception of a force law is taken back") {
    for (const int workers : {1, 2}) {
      for (const int at : {1, 2, 5, 31, 32}) {
        CAPTURE(at);
        Hall h = make_hall(workers);
        Hall calm = make_hall(workers);
        int calls = 0;
        const ForceLawId law = take(h.world.add_force_law(ForceLaw([&](ForceView&) {
          if (++calls == at) throw std::runtime_error("a law of the user's");
        })));
        for (Hall* hall : {&h, &calm}) CHECK(hall->world.apply_force(hall->box, {0, 0, 500}).has_value());
        const Seen before = look(h);
        CHECK_THROWS_AS(h.world.step(kDt), std::runtime_error);
        CHECK(look(h) == before);
        CHECK(h.world.cast_ray({4, 9, 0}, {0, -9, 0}).has_value());
        CHECK(h.world.remove(law));
        // The force still waits, and contacts and the hook find their impulses again.
        for (int i = 0; i < 10; ++i) {
          CHECK(h.world.step(kDt).healthy());
          CHECK(calm.world.step(kDt).healthy());
        }
        CHECK(largest_difference(look(h), look(calm)) < 0.02);
      }
    }
  }

  TEST_CASE("a step that ends by an exception of a law over bodies is taken back, time after time") {
    Hall h = make_hall();
    bool throws = true;
    take(h.world.add_force_law(BodyForceLaw([&](BodyForceView& view) {
      view.add_force(0, {0, 0, 300});
      if (throws) throw std::runtime_error("a law of the user's");
    })));
    const Seen before = look(h);
    for (int i = 0; i < 5; ++i) CHECK_THROWS_AS(h.world.step(kDt), std::runtime_error);
    CHECK(look(h) == before);
    throws = false;
    CHECK(h.world.step(kDt).healthy());
    CHECK(h.world.step_count() == 81);
  }
}

}  // namespace hooke
