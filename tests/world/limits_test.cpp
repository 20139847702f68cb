/// Numbers and ids that a World does not take: it says which and why, and is as it was.

#include "hooke/limits.h"

#include "world/make.h"

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace hooke {

using namespace test;

namespace {

constexpr Real kDt = Real(1) / Real(60);

struct Lot {
  World world;
  BodyId floor = {}, box = {}, lift = {};
  HookId hook = {};
  RopeId rope = {};
  ClothId cloth = {};
  SolidId solid = {};
  ParticlesId particles = {};
  MeshId mesh = {};
  FieldId field = {};
  ForceLawId law = {};
};

Lot make_lot() {
  Lot l{.world = make_world()};
  World& w = l.world;
  l.mesh = take(w.add_mesh({.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}}));
  l.floor = take(w.add_body({.shape = Shape::half_space()}));
  l.box = take(w.add_body({.kind = BodyKind::kDynamic,
                           .shape = Shape::box({Real(0.2), Real(0.3), Real(0.4)}),
                           .position = {0, 1, 0}}));
  l.lift = take(w.add_body({.kind = BodyKind::kKinematic, .shape = Shape::sphere(1), .position = {9, 2, 0}}));
  l.rope = take(w.add_rope({.hook_point = {0, 3, 0}}));
  l.cloth = take(w.add_cloth({.columns = 4, .rows = 4, .corner = {3, 3, 0}, .pins = {{0}}}));
  l.solid = take(w.add_solid({.cells = {1, 1, 1}, .position = {-3, 2, 0}}));
  l.particles = take(w.add_particles({.particles = {{.position = {0, 5, 5}}}}));
  l.hook = take(w.add_hook({.kind = HookKind::kHinge, .a = {.body = l.box}, .anchor = {0, 2, 0}}));
  l.field = take(w.add_field({}));
  l.law = take(w.add_force_law(BodyForceLaw([](BodyForceView&) {})));
  run(w, 2);
  return l;
}

struct Refusal {
  std::string where, message;
};

template <class T>
Refusal of(const Result<T>& result) {
  return result ? Refusal{"none", ""} : Refusal{result.error().where, result.error().message};
}

struct Case {
  std::string where;
  std::string value, limit;  ///< As the message has them.
  std::function<Refusal(Lot&)> call;
};

std::vector<Case> cases_of_points() {
  return {
      {"position", "1e+300", "1e+09",
       [](Lot& l) {
         return of(l.world.set_position(point(l.rope, 8), {1e300, 0, 0}));
       }},
      {"velocity", "e+38", "1e+09",
       [](Lot& l) {
         return of(l.world.set_velocity(point(l.rope, 8), {0, Real(3e38), 0}));
       }},
      {"force", "e+38", "1e+15",
       [](Lot& l) {
         return of(l.world.apply_force(point(l.cloth, 8), {0, 0, Real(3e38)}));
       }},
      {"impulse", "", "1e+09 m/s",
       [](Lot& l) {
         return of(l.world.apply_impulse(point(l.rope, 8), {Real(1e13), 0, 0}));
       }},
  };
}

std::vector<Case> cases_of_bodies() {
  return {
      {"pose.position", "1e+300", "1e+09",
       [](Lot& l) {
         return of(l.world.set_pose(l.box, {{1e300, 0, 0}}));
       }},
      {"pose.rotation", "", "zero",
       [](Lot& l) {
         return of(l.world.set_pose(l.box, {{}, {0, 0, 0, 0}}));
       }},
      {"velocity", "e+38", "1e+09",
       [](Lot& l) {
         return of(l.world.set_velocity(l.box, {Real(3e38), 0, 0}));
       }},
      {"angular_velocity", "e+38", "1000000",
       [](Lot& l) {
         return of(l.world.set_angular_velocity(l.box, {Real(3e38), 1, 0}));
       }},
      {"force", "e+38", "1e+15",
       [](Lot& l) {
         return of(l.world.apply_force(l.box, {Real(3e38), 0, 0}));
       }},
      {"torque", "e+38", "1e+15",
       [](Lot& l) {
         return of(l.world.apply_torque(l.box, {Real(3e38), 0, 0}));
       }},
      {"at", "1e+300", "1e+09",
       [](Lot& l) {
         return of(l.world.apply_force(l.box, {1, 0, 0}, {0, 1e300, 0}));
       }},
      {"impulse", "e+38", "1e+15",
       [](Lot& l) {
         return of(l.world.apply_impulse(l.box, {Real(3e38), 0, 0}));
       }},
      {"impulse", "", "1e+09 m/s",
       [](Lot& l) {
         return of(l.world.apply_impulse(l.box, {Real(1e14), 0, 0}));
       }},
      {"impulse", "", "1000000 rad/s",
       [](Lot& l) {
         return of(l.world.apply_impulse(l.box, {Real(1e6), 0, 0}, {0, 1e6, 0}));
       }},
      {"motion.velocity", "e+30", "1e+09",
       [](Lot& l) {
         return of(l.world.set_motion(
             l.lift, {.kind = MotionDesc::Kind::kConstantVelocity, .velocity = {Real(1e30), 0, 0}}));
       }},
      {"motion.amplitude", "", "1e+09 m/s",
       [](Lot& l) {
         return of(l.world.set_motion(
             l.lift,
             {.kind = MotionDesc::Kind::kSine, .amplitude = {Real(1e6), 0, 0}, .frequency_hz = Real(1e5)}));
       }},
      {"motor.speed", "e+30", "1e+09",
       [](Lot& l) {
         return of(l.world.set_motor(l.hook, {Real(1e30), 1}));
       }},
      {"spring.target", "e+30", "1e+09",
       [](Lot& l) {
         return of(l.world.set_spring(l.hook, {1, 1, Real(1e30)}));
       }},
      {"angle", "e+30", "1000000", [](Lot& l) { return of(l.world.set_steering(l.hook, Real(1e30))); }},
      {"gravity", "e+38", "1000000",
       [](Lot& l) {
         return of(l.world.set_gravity({0, Real(2e38), 0}));
       }},
      {"wind.velocity", "e+38", "1e+09",
       [](Lot& l) {
         return of(l.world.set_wind({.velocity = {Real(2e38), 0, 0}}));
       }},
  };
}

std::vector<Case> cases_of_descriptions() {
  return {
      {"mesh.positions[1]", "e+30", "1000000",
       [](Lot& l) {
         return of(
             l.world.add_mesh({.positions = {{}, {Real(1e30), 0, 0}, {0, 1, 0}}, .triangles = {{0, 1, 2}}}));
       }},
      {"body.velocity", "e+30", "1e+09",
       [](Lot& l) {
         return of(l.world.add_body({.velocity = {Real(1e30), 0, 0}}));
       }},
      {"body.angular_velocity", "e+30", "1000000",
       [](Lot& l) {
         return of(l.world.add_body({.angular_velocity = {Real(1e30), 0, 0}}));
       }},
      {"body.gravity_scale", "e+30", "1000000",
       [](Lot& l) { return of(l.world.add_body({.gravity_scale = Real(1e30)})); }},
      {"rope.length_at_rest", "e+30", "1000000",
       [](Lot& l) { return of(l.world.add_rope({.length_at_rest = Real(1e30)})); }},
      {"rope.total_mass", "e+30", "1e+12",
       [](Lot& l) { return of(l.world.add_rope({.total_mass = Real(1e30)})); }},
      {"rope.total_mass", "e-30", "1e-09",
       [](Lot& l) { return of(l.world.add_rope({.total_mass = Real(1e-30)})); }},
      {"rope.stiffness", "e+31", "1e30",
       [](Lot& l) { return of(l.world.add_rope({.stiffness = Real(2e31)})); }},
      {"cloth.width", "e+30", "1000000", [](Lot& l) { return of(l.world.add_cloth({.width = Real(1e30)})); }},
      {"cloth.areal_density", "e+30", "1e+09",
       [](Lot& l) { return of(l.world.add_cloth({.areal_density = Real(1e30)})); }},
      {"solid.size.y", "e+30", "1000000",
       [](Lot& l) {
         return of(l.world.add_solid({.size = {1, Real(1e30), 1}}));
       }},
      {"solid.density", "e+30", "1e+09",
       [](Lot& l) { return of(l.world.add_solid({.density = Real(1e30)})); }},
      {"particles.particles[0].mass", "e+30", "1e+12",
       [](Lot& l) { return of(l.world.add_particles({.particles = {{.mass = Real(1e30)}}})); }},
      {"field.vector", "e+30", "1000000",
       [](Lot& l) {
         return of(l.world.add_field({.vector = {Real(1e30), 0, 0}}));
       }},
      {"hook.limits", "e+30", "1e9",
       [](Lot& l) {
         return of(
             l.world.add_hook({.kind = HookKind::kSlider, .a = {.body = l.box}, .limits = {0, Real(1e30)}}));
       }},
  };
}

void check_all(const std::vector<Case>& cases) {
  Lot lot = make_lot();
  const std::uint64_t before = lot.world.state_hash();
  for (const Case& c : cases) {
    const Refusal refusal = c.call(lot);
    CAPTURE(refusal.where);
    CAPTURE(refusal.message);
    CHECK(refusal.where == c.where);
    CHECK(refusal.message.find(c.value) != std::string::npos);
    CHECK(refusal.message.find(c.limit) != std::string::npos);
    CHECK(lot.world.state_hash() == before);
  }
  run(lot.world, 5);
}

}  // namespace

TEST_SUITE("world/limits") {
  TEST_CASE("numbers beyond the limits are refused with value and limit") {
    check_all(cases_of_points());
    check_all(cases_of_bodies());
    check_all(cases_of_descriptions());
  }

  TEST_CASE("a kind outside its enumeration is refused") {
    Lot l = make_lot();
    const std::uint64_t before = l.world.state_hash();
    const auto none = [](auto kind) { return static_cast<decltype(kind)>(200); };
    CHECK(of(l.world.add_body({.shape = {.kind = none(ShapeKind())}})).where == "body.shape.kind");
    CHECK(of(l.world.add_body({.kind = none(BodyKind())})).where == "body.kind");
    CHECK(of(l.world.add_hook({.kind = none(HookKind()), .a = {.body = l.box}})).where == "hook.kind");
    CHECK(of(l.world.add_field({.kind = none(FieldDesc::Kind())})).where == "field.kind");
    CHECK(of(l.world.add_cloth({.bend = none(ClothDesc::Bend())})).where == "cloth.bend");
    CHECK(of(l.world.add_solid({.elasticity = none(SolidDesc::Elasticity())})).where == "solid.elasticity");
    CHECK(of(l.world.set_motion(l.lift, {.kind = none(MotionDesc::Kind())})).where == "motion.kind");
    CHECK(of(l.world.set_wind({.gusts = none(WindDesc::Gusts())})).where == "wind.gusts");
    CHECK(of(l.world.find_overlaps({.kind = none(ShapeKind())}, {})).where == "shape.kind");
    CHECK(l.world.state_hash() == before);
  }

  TEST_CASE("forces add up to the limit and no further") {
    Lot l = make_lot();
    for (int i = 0; i < 2; ++i) CHECK(l.world.apply_force(l.box, {Real(4e14), 0, 0}).has_value());
    const Result<void> third = l.world.apply_force(l.box, {Real(4e14), 0, 0});
    REQUIRE_FALSE(third.has_value());
    CHECK(third.error().message.find("given before") != std::string::npos);
    CHECK(l.world.apply_force(l.floor, {Real(1e15), 0, 0}).has_value());
    CHECK(l.world.apply_force(l.floor, {Real(1e15), 0, 0}).has_value());  // nothing moves it
  }

  TEST_CASE("a world refuses a pair of materials whose numbers mean nothing") {
    const auto refused = [](const MaterialPairDesc& pair) {
      return of(World::create({.materials = {{.a = 1, .b = 2}, pair}})).where;
    };
    CHECK(refused({.friction = Real(-0.1)}) == "world.materials[1].friction");
    CHECK(refused({.friction = Real(std::nan(""))}) == "world.materials[1].friction");
    CHECK(refused({.static_friction = Real(101)}) == "world.materials[1].static_friction");
    CHECK(refused({.restitution = Real(1.01)}) == "world.materials[1].restitution");
    CHECK(refused({.friction = Real(100), .static_friction = Real(0), .restitution = Real(1)}) == "none");
  }

  TEST_CASE("a step takes between a nanosecond and a thousand seconds") {
    Lot l = make_lot();
    const std::uint64_t before = l.world.state_hash();
    for (const double dt : {1e-44, 9e-10, 1.1e3, 1e30, -1.0, std::nan("")}) {
      CHECK_FALSE(l.world.step(static_cast<Real>(dt)).moved);
      CHECK(l.world.state_hash() == before);
    }
    CHECK(l.world.step(static_cast<Real>(limits::kShortestStep)).moved);
    CHECK(l.world.step(static_cast<Real>(limits::kLongestStep)).moved);
  }

  TEST_CASE("at the limits everything stays finite") {
    const auto most = [](double limit) { return static_cast<Real>(limit); };
    const std::vector<std::function<Result<void>(Lot&)>> calls = {
        [&](Lot& l) {
          return l.world.set_position(point(l.rope, 8), {limits::kPlace, 0, 0});
        },
        [&](Lot& l) {
          return l.world.set_velocity(point(l.cloth, 8), {most(limits::kSpeed), 0, 0});
        },
        [&](Lot& l) {
          return l.world.apply_force(point(l.solid, 0), {0, most(limits::kForce), 0});
        },
        [&](Lot& l) {
          return l.world.set_pose(l.box, {{-limits::kPlace, limits::kPlace, 0}});
        },
        [&](Lot& l) {
          return l.world.set_velocity(l.box, {0, most(-limits::kSpeed), 0});
        },
        [&](Lot& l) {
          return l.world.set_angular_velocity(l.box, {most(limits::kSpin), 1, 0});
        },
        [&](Lot& l) {
          return l.world.apply_force(l.box, {0, most(-limits::kForce), 1});
        },
        [&](Lot& l) {
          return l.world.apply_torque(l.box, {0, most(-limits::kForce), 1});
        },
        [&](Lot& l) {
          return l.world.set_gravity({0, most(-limits::kAcceleration), 0});
        },
        [&](Lot& l) {
          return l.world.set_wind({.velocity = {most(limits::kSpeed), 0, 0}});
        },
        [&](Lot& l) {
          return l.world.set_motor(l.hook, {most(limits::kSpeed), Real(1e30)});
        },
        [&](Lot& l) {
          return l.world.set_spring(l.hook, {most(limits::kStiffness), 1, 1});
        },
    };
    for (std::size_t i = 0; i < calls.size(); ++i) {
      CAPTURE(i);
      Lot l = make_lot();
      CHECK(calls[i](l).has_value());
      for (int k = 0; k < 30; ++k) CHECK(l.world.step(kDt).moved);
      CHECK(is_finite(l.world.pose(l.box).position));
      CHECK(is_finite(l.world.velocity(l.box)));
      CHECK(is_finite(l.world.angular_velocity(l.box)));
      for (const PointView& view : {l.world.positions(l.rope), l.world.velocities(l.rope),
                                    l.world.positions(l.cloth), l.world.positions(l.solid)}) {
        for (std::size_t p = 0; p < view.size(); ++p) CHECK(is_finite(view[p]));
      }
      CHECK(l.world.cast_ray({0, 5, 0}, {0, -9, 0}).has_value());
    }
  }

  TEST_CASE("an id of another world is refused, whatever it would mean here") {
    Lot a = make_lot();
    Lot b = make_lot();
    const std::uint64_t before = b.world.state_hash();
    CHECK_FALSE(b.world.add_body({.shape = Shape::of_mesh(a.mesh)}).has_value());
    CHECK_FALSE(b.world.add_hook({.kind = HookKind::kFixed, .a = {.body = a.box}}).has_value());
    CHECK_FALSE(b.world.add_hook({.a = {.point = point(a.rope, 3)}}).has_value());
    CHECK_FALSE(b.world.set_velocity(point(a.particles, 0), {}).has_value());
    CHECK_FALSE(b.world.pin(point(a.cloth, 5)).has_value());
    CHECK_FALSE(b.world.set_velocity(a.box, {}).has_value());
    CHECK_FALSE(b.world.set_motor(a.hook, {}).has_value());
    CHECK_FALSE(b.world.cast_ray({0, 9, 0}, {0, -9, 0}, {.skip = a.box}).has_value());
    CHECK(b.world.mass(a.box) == Real(0));
    CHECK(b.world.positions(a.rope).empty());
    CHECK(b.world.surface(a.solid).empty());
    CHECK_FALSE(b.world.remove(a.mesh));
    CHECK_FALSE(b.world.remove(a.box));
    CHECK_FALSE(b.world.remove(a.hook));
    CHECK_FALSE(b.world.remove(a.rope));
    CHECK_FALSE(b.world.remove(a.cloth));
    CHECK_FALSE(b.world.remove(a.solid));
    CHECK_FALSE(b.world.remove(a.particles));
    CHECK_FALSE(b.world.remove(a.field));
    CHECK_FALSE(b.world.remove(a.law));
    CHECK(b.world.state_hash() == before);
    CHECK(a.world.state_hash() == before);  // which world it is does not show
    // One from a file names no world.
    CHECK(b.world.mass(BodyId{.slot = a.box.slot, .generation = a.box.generation}) > Real(0));
  }

  TEST_CASE("ids of a snapshot keep their meaning in another world that restores it") {
    Lot a = make_lot();
    Lot b = make_lot();
    const BodyId late = take(b.world.add_body({.kind = BodyKind::kDynamic, .shape = Shape::sphere(1)}));
    REQUIRE(b.world.restore(a.world.snapshot()).has_value());
    CHECK(b.world.mass(a.box) > Real(0));
    CHECK(b.world.mass(b.box) == Real(0));
    CHECK(b.world.mass(late) == Real(0));
    const BodyId in_b = take(b.world.add_body({.kind = BodyKind::kDynamic, .shape = Shape::sphere(1)}));
    const BodyId in_a = take(a.world.add_body({.kind = BodyKind::kDynamic, .shape = Shape::sphere(2)}));
    CHECK(in_a.slot == in_b.slot);
    CHECK(b.world.mass(in_a) == Real(0));
    CHECK(a.world.mass(in_b) == Real(0));
    CHECK(b.world.mass(in_b) > Real(0));
  }
}

}  // namespace hooke
