#include "world/make.h"

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace hooke {

using namespace test;

namespace {

constexpr Real kNan = std::numeric_limits<Real>::quiet_NaN();
constexpr Real kInf = std::numeric_limits<Real>::infinity();

/// Numbers that no positive finite field may take.
const std::vector<Real> kBad = {kNan, -kNan, kInf, -kInf, Real(0), -Real(0), Real(-1), Real(-1e30)};

template <class Desc>
struct Field {
  const char* where;
  std::function<void(Desc&, Real)> set;
  bool may_be_infinite = false;
  bool may_be_zero = false;
};

template <class Desc, class Add>
void refuses_bad_numbers(const std::vector<Field<Desc>>& fields, Add&& add) {
  World world = make_world();
  const std::uint64_t untouched = world.state_hash();
  for (const auto& field : fields) {
    for (const Real bad : kBad) {
      if (field.may_be_infinite && bad == kInf) continue;
      if (field.may_be_zero && bad == Real(0)) continue;
      Desc desc = {};
      field.set(desc, bad);
      const auto result = add(world, desc);
      REQUIRE_FALSE_MESSAGE(result.has_value(), field.where);
      CHECK(result.error().where == field.where);
      CHECK_FALSE(result.error().message.empty());
    }
  }
  CHECK(world.state_hash() == untouched);
  CHECK(world.memory().particles == 0);
}

}  // namespace

TEST_SUITE("world/api") {
  TEST_CASE("a rope refuses every number out of range and names it") {
    refuses_bad_numbers<RopeDesc>(
        {{"rope.total_mass", [](RopeDesc& d, Real v) { d.total_mass = v; }},
         {"rope.length_at_rest", [](RopeDesc& d, Real v) { d.length_at_rest = v; }},
         {"rope.stiffness", [](RopeDesc& d, Real v) { d.stiffness = v; }, true},
         {"rope.inner_friction", [](RopeDesc& d, Real v) { d.inner_friction = v; }, false, true},
         {"rope.air_friction", [](RopeDesc& d, Real v) { d.air_friction = v; }, false, true},
         {"rope.extension_max", [](RopeDesc& d, Real v) { d.extension_max = v; }, true},
         {"rope.radius", [](RopeDesc& d, Real v) { d.radius = v; }},
         {"rope.axial_stiffness", [](RopeDesc& d, Real v) { d.axial_stiffness = v; }, true},
         {"rope.strength", [](RopeDesc& d, Real v) { d.strength = v; }},
         {"rope.loads[0].mass",
          [](RopeDesc& d, Real v) {
            d.loads = {{3, v}};
          },
          false, true},
         {"rope.direction",
          [](RopeDesc& d, Real v) {
            d.direction = {Real(0), Real(0), std::abs(v) < kInf ? Real(0) : v};
          }}},
        [](World& world, const RopeDesc& desc) { return world.add_rope(desc); });
  }

  TEST_CASE("a cloth refuses every number out of range and names it") {
    refuses_bad_numbers<ClothDesc>(
        {{"cloth.width", [](ClothDesc& d, Real v) { d.width = v; }},
         {"cloth.areal_density", [](ClothDesc& d, Real v) { d.areal_density = v; }},
         {"cloth.total_mass", [](ClothDesc& d, Real v) { d.total_mass = v; }},
         {"cloth.thickness", [](ClothDesc& d, Real v) { d.thickness = v; }},
         {"cloth.stretch_stiffness", [](ClothDesc& d, Real v) { d.stretch_stiffness = v; }, true},
         {"cloth.shear_stiffness", [](ClothDesc& d, Real v) { d.shear_stiffness = v; }, true, true},
         {"cloth.bend_stiffness", [](ClothDesc& d, Real v) { d.bend_stiffness = v; }, false, true},
         {"cloth.extension_max", [](ClothDesc& d, Real v) { d.extension_max = v; }, true},
         {"cloth.strength", [](ClothDesc& d, Real v) { d.strength = v; }},
         {"cloth.tear_strain", [](ClothDesc& d, Real v) { d.tear_strain = v; }}},
        [](World& world, const ClothDesc& desc) { return world.add_cloth(desc); });
  }

  TEST_CASE("particles, fields, bodies, wind and the world refuse what they cannot use") {
    World world = make_world();
    CHECK_FALSE(world.add_particles({}).has_value());
    CHECK(world.add_particles({.particles = {{.mass = Real(0)}}}).error().where ==
          "particles.particles[0].mass");
    CHECK(world.add_particles({.particles = {{}}, .springs = {{0, 1}}}).error().where ==
          "particles.springs[0].b");
    CHECK(world.add_particles({.particles = {{}, {}}, .springs = {{1, 1}}}).error().where ==
          "particles.springs[0].b");
    CHECK(world.add_field({.vector = {kNan, 0, 0}}).error().where == "field.vector");
    CHECK(world.add_body({.shape = Shape::sphere(Real(-1))}).error().where == "body.shape.radius");
    CHECK(world.add_body({.rotation = {0, 0, 0, 0}}).error().where == "body.rotation");
    CHECK(world.add_body({.shape = Shape::of_mesh({7, 1})}).error().code == ErrorCode::kStaleId);
    CHECK(world.add_body({.position = {2e9, 0, 0}}).error().where == "body.position");
    CHECK(world.add_mesh({}).has_value() == false);
    CHECK(world.add_mesh({.positions = {{}, {}, {}}, .triangles = {{0, 1, 3}}}).error().where ==
          "mesh.triangles[0]");
    CHECK(world.add_force_law(ForceLaw{}).error().where == "force_law");
    WindDesc wind;
    wind.correlation_time = Real(0);
    CHECK(world.set_wind(wind).error().where == "wind.correlation_time");
    CHECK_FALSE(world.set_gravity({0, kInf, 0}).has_value());
    CHECK_FALSE(world.set_workers(0).has_value());
    CHECK(World::create({.substeps = 0}).error().where == "world.substeps");
    CHECK(World::create({.workers = 65}).error().where == "world.workers");
    CHECK(world.memory().particles == 0);
  }

  TEST_CASE("sizes are checked before anything is allocated") {
    World world = make_world();
    RopeDesc rope;
    rope.masses = std::numeric_limits<int>::max();
    CHECK(world.add_rope(rope).error().where == "rope.masses");
    ClothDesc cloth;
    cloth.columns = 1;
    CHECK(world.add_cloth(cloth).error().where == "cloth.columns");
    cloth.columns = std::numeric_limits<int>::max();
    CHECK(world.add_cloth(cloth).error().where == "cloth.columns");
    rope.masses = 3;
    rope.pins = {{3}};
    CHECK(world.add_rope(rope).error().where == "rope.pins[0].point");
    rope.pins = {{0, {.kind = MotionDesc::Kind::kKeyframes}}};
    CHECK(world.add_rope(rope).error().where == "rope.pins[0].motion.keyframes");
    rope = {};
    rope.points = {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}};
    CHECK(world.add_rope(rope).error().where == "rope.points[2]");
  }

  TEST_CASE("stale, null and foreign ids do no harm") {
    World world = make_world();
    const RopeId rope = take(world.add_rope({}));
    CHECK(world.remove(rope));
    CHECK_FALSE(world.remove(rope));
    CHECK(world.positions(rope).empty());
    CHECK(world.velocities(rope).empty());
    CHECK(world.tensions(rope).empty());
    CHECK(world.positions(RopeId{}).empty());
    CHECK(world.positions(RopeId{900, 1})[5] == DVec3{});
    CHECK(world.triangles(ClothId{1, 1}).empty());
    CHECK_FALSE(world.apply_force(point(rope, 0), {}).has_value());
    CHECK_FALSE(world.set_velocity(PointRef{}, {}).has_value());
    CHECK(world.pose(BodyId{3, 3}).position == DVec3{});
    CHECK_FALSE(world.remove(MeshId{}));
    CHECK_FALSE(world.remove(FieldId{2, 1}));
    CHECK_FALSE(world.pin(PointRef{PointRef::Kind::kRope, 1, 1, 0}).has_value());
  }

  TEST_CASE("indices beyond an object and numbers that are not finite are refused") {
    World world = make_world();
    const RopeId rope = take(world.add_rope({}));
    const std::uint64_t hash = world.state_hash();
    CHECK_FALSE(world.apply_impulse(point(rope, 16), {}).has_value());
    CHECK_FALSE(world.apply_impulse(point(rope, 3), {kNan, 0, 0}).has_value());
    CHECK_FALSE(world.set_velocity(point(rope, 3), {0, kInf, 0}).has_value());
    CHECK_FALSE(
        world.set_position(point(rope, 3), {0, std::numeric_limits<double>::infinity(), 0}).has_value());
    CHECK_FALSE(world.apply_force(point(rope, 3), {0, 0, -kInf}).has_value());
    CHECK(world.state_hash() == hash);
  }

  TEST_CASE("a step of no or impossible length moves nothing") {
    World world = make_world();
    take(world.add_rope({}));
    const std::uint64_t hash = world.state_hash();
    for (const Real dt : {Real(0), Real(-1), kNan, kInf}) CHECK_FALSE(world.step(dt).moved);
    CHECK(world.state_hash() == hash);
    CHECK(world.step_count() == 0);
  }

  TEST_CASE("a step inside a step does nothing") {
    World world = make_world();
    take(world.add_rope({}));
    bool inner_moved = true;
    bool restored = true;
    const Snapshot snapshot = world.snapshot();
    take(world.add_force_law([&](ForceView&) {
      inner_moved = world.step(Real(1) / Real(60)).moved;
      restored = world.restore(snapshot).has_value();
    }));
    CHECK(world.step(Real(1) / Real(60)).moved);
    CHECK_FALSE(inner_moved);
    CHECK_FALSE(restored);
    CHECK(world.step_count() == 1);
  }

  TEST_CASE("very long and very short steps stay finite") {
    for (const double dt : {1e-7, 1.0, 100.0}) {
      World world = make_world();
      take(world.add_rope({}));
      take(world.add_cloth({.pins = {{0}}}));
      for (int i = 0; i < 50; ++i) world.step(static_cast<Real>(dt));
      CHECK(is_finite(world.measure().momentum));
      CHECK(std::isfinite(world.measure().energy.total()));
    }
  }
}

}  // namespace hooke
