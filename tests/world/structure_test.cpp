/// Worlds in which objects come, go and are pinned while they move: what each step keeps from the step before
/// is what a restored world, which keeps nothing, makes anew.

#include "world/make.h"

#include <array>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

namespace hooke {

using namespace test;

namespace {

constexpr std::array kBends = {ClothDesc::Bend::kAngle, ClothDesc::Bend::kSpring, ClothDesc::Bend::kIsometric,
                               ClothDesc::Bend::kNone, ClothDesc::Bend::kYarn};

ClothDesc cloth_at(DVec3 corner, int side, ClothDesc::Bend bend) {
  ClothDesc cloth;
  cloth.columns = cloth.rows = side;
  cloth.corner = corner;
  cloth.bend = bend;
  cloth.tethers = true;
  cloth.extension_max = Real(0.1);
  if (bend == ClothDesc::Bend::kAngle) cloth.yield_angle = Real(0.2);
  if (bend == ClothDesc::Bend::kIsometric) cloth.bend_damping = Real(0.1);
  cloth.pins = {{.point = 0}};
  return cloth;
}

/// A world whose structure changes at random, always in the same way.
class Changing {
 public:
  explicit Changing(int workers) : world_(make_world(windy(workers))) {}

  void change() {
    const DVec3 place = {0.7 * static_cast<double>(random_() % 10), 2,
                         0.9 * static_cast<double>(random_() % 10)};
    switch (random_() % 8) {
      case 0:
      case 1: {
        const std::uint32_t kind = random_() % kBends.size();
        const int side = random_() % 4 == 0 ? 26 : 3 + static_cast<int>(random_() % 6);
        cloths_.push_back(take(world_.add_cloth(cloth_at(place, side, kBends[kind]))));
        break;
      }
      case 2:
        solids_.push_back(take(world_.add_solid(jelly_at(place))));
        break;
      case 3:
        ropes_.push_back(take(world_.add_rope({.hook_point = place, .masses = 6})));
        break;
      case 4:
        add_particles(place);
        break;
      case 5:
        remove_one(cloths_);
        remove_one(solids_);
        break;
      case 6:
        remove_one(ropes_);
        remove_one(particles_);
        break;
      default:
        if (!cloths_.empty()) pin_one(point(cloths_[random_() % cloths_.size()], random_() % 4 == 0 ? 1 : 0));
    }
  }

  /// Makes the next step copy everything anew.
  void restore_itself() { REQUIRE(world_.restore(world_.snapshot())); }
  std::uint64_t step() {
    run(world_, 1, Real(1) / Real(120));
    return world_.state_hash();
  }

 private:
  static WorldDesc windy(int workers) {
    WorldDesc desc;
    desc.wind = {.velocity = {Real(3), 0, Real(1)}, .gust = Real(0.3)};
    desc.workers = workers;
    desc.substeps = 4;
    return desc;
  }

  SolidDesc jelly_at(DVec3 place) {
    SolidDesc solid;
    solid.cells = {2, 2, 2};
    solid.size = {Real(0.3), Real(0.3), Real(0.3)};
    solid.position = place;
    if (random_() % 2 == 0) solid.yield_stress = Real(50);
    if (random_() % 3 == 0) solid.young_modulus = Real(1e8);  // Stiff: solved as a whole.
    solid.damping = random_() % 2 == 0 ? Real(0.01) : Real(0);
    return solid;
  }

  void add_particles(DVec3 place) {
    ParticlesDesc desc;
    desc.particles = {{.position = place}, {.position = place + DVec3{0, 1, 0}}};
    if (random_() % 2 == 0) desc.springs = {{0, 1, Real(50)}};
    particles_.push_back(take(world_.add_particles(desc)));
  }

  void pin_one(PointRef point) {
    if (random_() % 2 == 0) {
      REQUIRE(world_.pin(point, {}));
    } else {
      REQUIRE(world_.unpin(point));
    }
  }

  template <class Id>
  void remove_one(std::vector<Id>& ids) {
    if (ids.empty()) return;
    const auto at = ids.begin() + static_cast<std::ptrdiff_t>(random_() % ids.size());
    CHECK(world_.remove(*at));
    ids.erase(at);
  }

  World world_;
  std::minstd_rand random_{4711};
  std::vector<ClothId> cloths_;
  std::vector<SolidId> solids_;
  std::vector<RopeId> ropes_;
  std::vector<ParticlesId> particles_;
};

/// Where the points of a cloth are after half a second in which it falls on its pin, alone or with another
/// cloth far away that was added before it or after it.
std::vector<DVec3> fallen(std::optional<Real> stiffness_before, std::optional<Real> stiffness_after) {
  World world = make_world();
  ClothDesc cloth = cloth_at({}, 6, ClothDesc::Bend::kIsometric);
  cloth.bend_damping = Real(10);  // More than counts.
  const auto add_other = [&](std::optional<Real> stiffness) {
    if (!stiffness) return;
    ClothDesc other = cloth;
    other.corner.x = 20;
    other.bend_stiffness = *stiffness;
    take(world.add_cloth(other));
  };
  add_other(stiffness_before);
  const ClothId id = take(world.add_cloth(cloth));
  add_other(stiffness_after);
  run(world, 30);
  std::vector<DVec3> places;
  const PointView view = world.positions(id);
  for (std::size_t i = 0; i < view.size(); ++i) places.push_back(view[i]);
  return places;
}

/// Where the points of a soft jelly are that swings on a hook for half a second, alone or with another one
/// far away.
std::vector<DVec3> swung(std::optional<Real> young_modulus_of_other) {
  World world = make_world();
  SolidDesc solid;
  solid.cells = {2, 2, 2};
  solid.size = {Real(0.3), Real(0.3), Real(0.3)};
  const SolidId id = take(world.add_solid(solid));
  HookDesc hook;
  hook.a.point = point(id, 0);
  hook.anchor = world.positions(id)[0];
  take(world.add_hook(hook));
  if (young_modulus_of_other) {
    solid.position.x = 20;
    solid.young_modulus = *young_modulus_of_other;
    take(world.add_solid(solid));
  }
  run(world, 30);
  std::vector<DVec3> places;
  const PointView view = world.positions(id);
  for (std::size_t i = 0; i < view.size(); ++i) places.push_back(view[i]);
  return places;
}

}  // namespace

TEST_SUITE("world/structure") {
  TEST_CASE("a world that changes one object at a time moves as one that derives everything anew") {
    Changing kept(1), divided(3), anew(1);
    for (int i = 0; i < 120; ++i) {
      CAPTURE(i);
      for (Changing* world : {&kept, &divided, &anew}) world->change();
      anew.restore_itself();
      const std::uint64_t hash = kept.step();
      REQUIRE(divided.step() == hash);
      REQUIRE(anew.step() == hash);
    }
  }

  TEST_CASE("a cloth moves to the bit as it does without another cloth far away") {
    const std::vector<DVec3> alone = fallen({}, {});
    CHECK(fallen(Real(1e-4), {}) == alone);
    for (const Real other : {Real(1e-6), Real(1e-2)}) {
      CHECK(fallen(other, {}) == alone);
      CHECK(fallen({}, other) == alone);
    }
  }

  TEST_CASE("a jelly moves to the bit as it does without another one far away, however stiff that is") {
    const std::vector<DVec3> alone = swung({});
    for (const Real other : {Real(1e4), Real(1e7), Real(1e10)}) CHECK(swung(other) == alone);
  }
}

}  // namespace hooke
