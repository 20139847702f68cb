/// Folds of cloth and dents of solids against mechanics: what is left of a deformation is what went beyond
/// the elastic limit.

#include "constants.h"
#include "geometry/meshes.h"
#include "solver/soft/particle_kernels.h"
#include "world/make.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace hooke {

using namespace test;

namespace {

/// |a / b - 1|
double apart(double a, double b) {
  return std::abs(a / b - 1);
}

// ---- Folds

/// Two triangles on either side of an edge along z, flat, with nothing but their bend between them.
struct Hinge {
  World world = make_world(empty_space());
  ClothId cloth;

  explicit Hinge(Real yield_angle) {
    MeshDesc mesh;
    mesh.positions = {{0, 0, Real(-0.1)}, {0, 0, Real(0.1)}, {Real(0.2), 0, 0}, {Real(-0.2), 0, 0}};
    mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
    ClothDesc desc;
    desc.mesh = take(world.add_mesh(mesh));
    desc.bend_stiffness = Real(1e-3);
    desc.bend_damping = Real(0.02);
    desc.air_friction = Real(0.1);
    desc.yield_angle = yield_angle;
    cloth = take(world.add_cloth(desc));
  }

  /// Both wings turned by half of it about the edge.
  void fold(double angle) {
    const double x = 0.2 * std::cos(angle / 2), y = 0.2 * std::sin(angle / 2);
    const DVec3 places[] = {{0, 0, -0.1}, {0, 0, 0.1}, {x, y, 0}, {-x, y, 0}};
    for (std::uint32_t i = 0; i < 4; ++i) REQUIRE(world.set_position(point(cloth, i), places[i]));
  }

  /// Held at this angle for a step.
  void press(double angle) {
    for (std::uint32_t i = 0; i < 4; ++i) REQUIRE(world.pin(point(cloth, i)));
    fold(angle);
    run(world, 1);
  }

  /// Then let go until it stands still.
  double after(double angle) {
    press(angle);
    for (std::uint32_t i = 0; i < 4; ++i) REQUIRE(world.unpin(point(cloth, i)));
    run(world, 600);
    return folded();
  }

  /// Angle between the wings, positive upward, within half a turn.
  [[nodiscard]] double folded() const {
    const PointView x = world.positions(cloth);
    const DVec3 edge = normalize(x[1] - x[0]);
    const auto across = [&](DVec3 wing) { return wing - dot(wing, edge) * edge; };
    const DVec3 a = across(x[2] - x[0]);
    const DVec3 b = across(x[3] - x[0]);
    return std::atan2(dot(cross(a, b), edge), -dot(a, b));
  }
};

// ---- Solids

/// A column of `height` upright about the origin between the plates of a testing machine: a spring, one end
/// of which is moved, pulls at both ends with the same force, evenly.
struct TestingMachine {
  static constexpr double kHeight = 0.3, kWidth = 0.1, kArea = kWidth * kWidth;
  World world;
  SolidId column;
  double stiffness = 0;       // of the machine [N/m]
  std::vector<double> share;  // of each point in the area of the ends; negative below
  double force = 0;           // [N]

  /// The machine is so many times as stiff as the column.
  explicit TestingMachine(const SolidDesc& material, int substeps = 4, double stiffer = 5)
      : world(make_world(machine_room(substeps))) {
    SolidDesc desc = material;
    desc.cells = {1, 3, 1};
    desc.size = {Real(kWidth), Real(kHeight), Real(kWidth)};
    column = take(world.add_solid(desc));
    stiffness = stiffer * d(material.young_modulus) * kArea / kHeight;
    const PointView x = world.positions(column);
    share.assign(x.size(), 0);
    const std::vector<DVec3> surface = world.surface(column);
    for (const auto& t : world.triangles(column)) {
      const double area = length(cross(surface[t[1]] - surface[t[0]], surface[t[2]] - surface[t[0]])) / 2;
      for (const double side : {1.0, -1.0}) {
        const auto at_end = [&](std::uint32_t v) {
          return std::abs(surface[v].y - side * kHeight / 2) < 1e-6;
        };
        if (!at_end(t[0]) || !at_end(t[1]) || !at_end(t[2])) continue;
        for (const std::uint32_t v : t) share[nearest(x, surface[v])] += side * area / (3 * kArea);
      }
    }
  }

  static WorldDesc machine_room(int substeps) {
    WorldDesc desc = empty_space();
    desc.substeps = substeps;
    return desc;
  }

  static std::size_t nearest(const PointView& x, DVec3 place) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < x.size(); ++i)
      best = length(x[i] - place) < length(x[best] - place) ? i : best;
    return best;
  }

  [[nodiscard]] double length_now() const {
    const PointView x = world.positions(column);
    double sum = 0;
    for (std::size_t i = 0; i < share.size(); ++i) sum += share[i] * x[i].y;
    return sum;
  }
  [[nodiscard]] double strain() const { return length_now() / kHeight - 1; }

  /// Moves the far end of the spring from one place to another in a second and waits for another.
  void pull(double from, double to) {
    constexpr int kSteps = 480;
    for (int i = 0; i < 2 * kSteps; ++i) {
      const double end = from + (to - from) * std::min(1.0, (i + 1.0) / kSteps);
      force = stiffness * (kHeight + end - length_now());
      for (std::uint32_t p = 0; p < share.size(); ++p)
        REQUIRE(world.apply_force(point(column, p), {0, static_cast<Real>(share[p] * force), 0}));
      run(world, 1, Real(1) / Real(kSteps));
    }
  }
};

SolidDesc metal() {
  SolidDesc desc;
  desc.young_modulus = Real(1e5);
  desc.poisson_ratio = Real(0.3);
  desc.yield_stress = Real(1e3);
  desc.damping = Real(0.005);
  return desc;
}

double height_of(const World& world, SolidId id) {
  const PointView x = world.positions(id);
  double low = x[0].y, high = x[0].y;
  for (std::size_t i = 1; i < x.size(); ++i) {
    low = std::min(low, x[i].y);
    high = std::max(high, x[i].y);
  }
  return high - low;
}

double lowest_of(const World& world, SolidId id) {
  const PointView x = world.positions(id);
  double low = x[0].y;
  for (std::size_t i = 1; i < x.size(); ++i) low = std::min(low, x[i].y);
  return low;
}

SolidDesc cube_of(Real young_modulus, Real yield_stress) {
  SolidDesc desc;
  desc.cells = {3, 3, 3};
  desc.size = {Real(0.3), Real(0.3), Real(0.3)};
  desc.position = {0, 0.15, 0};
  desc.young_modulus = young_modulus;
  desc.yield_stress = yield_stress;
  return desc;
}

/// A jelly cube of 0.3 m on a plate, pressed by another to `height` and let go. Without friction.
struct Press {
  World world;
  SolidId solid;

  Press(const SolidDesc& desc, double height, const WorldDesc& room) : world(make_world(room)) {
    const auto plate = [&](double y, const MotionDesc& motion) {
      BodyDesc body = {
          .kind = BodyKind::kKinematic, .shape = Shape::box({2, Real(0.1), 2}), .position = {0, y, 0}};
      body.contact.friction = Real(0);
      body.motion = motion;
      take(world.add_body(body));
    };
    const Real down = static_cast<Real>(height - 0.31);
    plate(-0.102, {});
    plate(0.412, {.kind = MotionDesc::Kind::kKeyframes,
                  .keyframes = {{0, {}}, {1, {0, down, 0}}, {1.2, {0, down, 0}}, {1.7, {0, Real(1), 0}}}});
    solid = take(world.add_solid(desc));
    run(world, 72);
  }
};

/// A ball of radius 0.15 m, half a meter above the ground.
struct Drop {
  World world = make_world(without_air());
  SolidId ball;

  explicit Drop(Real yield_stress) {
    take(world.add_body({.shape = Shape::half_space()}));
    SolidDesc desc;
    MeshDesc mesh = test::make_sphere(2);
    for (Vec3& p : mesh.positions) p = Real(0.15) * p;
    desc.mesh = take(world.add_mesh(mesh));
    desc.cell = Real(0.06);
    desc.position = {0, 0.65, 0};
    desc.young_modulus = Real(1e5);
    desc.poisson_ratio = Real(0.4);
    desc.yield_stress = yield_stress;
    ball = take(world.add_solid(desc));
  }

  /// Of the lowest point after it met the ground.
  double rebound() {
    double highest = 0;
    run(world, 24);
    for (int i = 0; i < 60; ++i) {
      run(world, 1);
      highest = std::max(highest, lowest_of(world, ball));
    }
    return highest;
  }
};

/// Kinetic and elastic, which must not rise in so many steps by more than the scheme's share of `start`.
double least_energy(World& world, int steps, double start) {
  double least = start;
  for (int i = 0; i < steps; ++i) {
    run(world, 1);
    const Energy energy = world.measure().energy;
    CHECK(energy.kinetic + energy.elastic < least + 2e-3 * start);
    least = std::min(least, energy.kinetic + energy.elastic);
  }
  return least;
}

/// Clay, paper and jelly fall on a ball.
World make_heap(int workers) {
  WorldDesc desc = without_air();
  desc.workers = workers;
  World world = make_world(desc);
  take(world.add_body({.shape = Shape::sphere(Real(0.1))}));
  SolidDesc jelly = cube_of(Real(3e4), kRigid);
  jelly.position = {0, 0.35, 0};
  take(world.add_solid(jelly));
  SolidDesc clay = cube_of(Real(3e4), Real(1e3));
  clay.position = {0, 0.75, 0};
  take(world.add_solid(clay));
  ClothDesc paper;
  paper.columns = paper.rows = 20;
  paper.corner = {-0.3, 0.12, -0.3};
  paper.row_direction = {0, 0, 1};
  paper.width = paper.height = Real(0.6);
  paper.yield_angle = Real(0.1);
  paper.bend_stiffness = Real(2e-3);
  take(world.add_cloth(paper));
  return world;
}

std::vector<std::uint64_t> hashes(World& world, int steps) {
  std::vector<std::uint64_t> result;
  for (int i = 0; i < steps; ++i) {
    run(world, 1);
    result.push_back(world.state_hash());
  }
  return result;
}

}  // namespace

TEST_SUITE("world/plasticity") {
  TEST_CASE("a fold is left open by the yield angle; below it nothing is left") {
    for (const double yield : {0.2, 0.8}) {
      for (const double angle : {kPi / 2, -kPi / 2, 2.5}) {
        const double left = (angle > 0 ? 1 : -1) * (std::abs(angle) - yield);
        CHECK(apart(Hinge(static_cast<Real>(yield)).after(angle), left) < 2e-3);
      }
      CHECK(std::abs(Hinge(static_cast<Real>(yield)).after(0.95 * yield)) < 1e-3);
    }
    CHECK(std::abs(Hinge(kRigid).after(kPi / 2)) < 1e-3);
  }

  TEST_CASE("a sheet folded flat and on through itself keeps the fold of the other side") {
    Hinge hinge(Real(0.4));
    CHECK(apart(hinge.after(2.8), 2.4) < 2e-3);
    CHECK(apart(hinge.after(3.5), 3.1) < 2e-3);  // 3.5 is -2.78 on the other side
    CHECK(apart(hinge.after(4.0), 3.6 - 2 * kPi) < 2e-3);
    CHECK(apart(hinge.after(3.3), 3.6 - 2 * kPi) < 2e-3);
    CHECK(apart(hinge.after(6.0), 5.6 - 2 * kPi) < 2e-3);
    CHECK(apart(hinge.after(8.0), 7.6 - 2 * kPi) < 2e-3);
    CHECK(apart(hinge.after(9.5), 9.1 - 2 * kPi) < 2e-3);
    CHECK(hinge.world.measure().energy.elastic < 1e-7);
  }

  TEST_CASE("a fold opens again by what it is bent back beyond the yield angle") {
    Hinge hinge(Real(0.3));
    CHECK(apart(hinge.after(1.5), 1.2) < 2e-3);
    CHECK(apart(hinge.after(0.95), 1.2) < 2e-3);
    CHECK(apart(hinge.after(0.5), 0.8) < 2e-3);
  }

  TEST_CASE("the hash tells a sheet that was folded and pressed flat again from one that was not") {
    for (const Real yield : {Real(0.3), kRigid}) {
      Hinge folded(yield), plain(yield);
      folded.press(1);
      folded.press(0);
      plain.press(0);
      plain.press(0);
      CHECK((folded.world.state_hash() == plain.world.state_hash()) == (yield == kRigid));
    }
  }

  TEST_CASE("a metal bar: Hooke's law, then a constant force, then a strain that stays") {
    const SolidDesc material = metal();
    const double e = d(material.yield_stress) / d(material.young_modulus);
    TestingMachine machine(material);
    // The bar takes 5/6 of the machine's way.
    const auto way = [&](double strain) { return 1.2 * strain * TestingMachine::kHeight; };
    machine.pull(0, way(0.9 * e));
    const double hooke = d(material.young_modulus) * machine.strain();
    CHECK(apart(machine.force / TestingMachine::kArea, hooke) < 0.02);
    CHECK(apart(machine.strain(), 0.9 * e) < 0.02);
    machine.pull(way(0.9 * e), way(2 * e));
    const double most = machine.strain();
    CHECK(most > 2 * e);
    // True stress: the cross-section shrinks by as much as the length grows.
    const double stress = machine.force / TestingMachine::kArea * (1 + most);
    CHECK(apart(stress, d(material.yield_stress)) < 0.01);
    double end = way(2 * e);
    for (int i = 0; i < 3; ++i) {  // Newton's method: until there is no force
      const double next = end - 6 * machine.force / machine.stiffness;
      machine.pull(end, next);
      end = next;
    }
    CHECK(std::abs(machine.force) < 1e-3 * d(material.yield_stress) * TestingMachine::kArea);
    CHECK(apart(machine.strain(), most - e) < 0.01);
  }

  TEST_CASE("a bar that is too stiff for its substeps, and acts as a softer one, yields at the same stress") {
    SolidDesc material = metal();
    material.young_modulus = Real(1e6);
    material.yield_stress = Real(1e4);
    TestingMachine machine(material, 1, 1);
    machine.pull(0, 0.03);
    CHECK(machine.strain() > 0.05);
    CHECK(apart(machine.force / TestingMachine::kArea * (1 + machine.strain()), 1e4) < 0.1);
  }

  TEST_CASE("a tetrahedron keeps its form at rest while it is flat or inside out") {
    for (const Real height : {Real(1.5), Real(0.005), Real(-1.5)}) {
      World world = make_world(empty_space());
      SolidDesc desc;
      desc.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
      desc.tetrahedra = {{0, 1, 2, 3}};
      desc.yield_stress = Real(1e3);
      for (std::uint32_t i = 0; i < 4; ++i) desc.pins.push_back({i});
      const SolidId id = take(world.add_solid(desc));
      for (const Real z : {height, Real(1)}) {
        REQUIRE(world.set_position(point(id, 3), {0, 0, d(z)}));
        run(world, 1);
      }
      CHECK((world.measure().energy.elastic > 0.01) == (height > 1));
    }
  }

  TEST_CASE("below the yield stress a solid moves to the bit as without one") {
    World plain = make_world();
    World strong = make_world();
    std::array<SolidId, 2> ids;
    for (World* world : {&plain, &strong}) {
      take(world->add_body({.shape = Shape::half_space()}));
      SolidDesc desc = cube_of(Real(3e4), world == &plain ? kRigid : Real(1e9));
      desc.position.y = 0.6;
      ids[world == &plain ? 0 : 1] = take(world->add_solid(desc));
      run(*world, 90);
    }
    for (std::size_t i = 0; i < plain.positions(ids[0]).size(); ++i)
      CHECK(plain.positions(ids[0])[i] == strong.positions(ids[1])[i]);
  }

  TEST_CASE("clay pressed to a third keeps its new form and its volume") {
    Press clay(cube_of(Real(1e5), Real(500)), 0.1, empty_space());
    run(clay.world, 60);  // It turns slowly in empty space.
    CHECK(height_of(clay.world, clay.solid) < 0.13);
    CHECK(apart(clay.world.volume(clay.solid), 0.027) < 1e-3);
    Press jelly(cube_of(Real(1e5), kRigid), 0.1, without_air());
    run(jelly.world, 240);
    CHECK(apart(height_of(jelly.world, jelly.solid), 0.3) < 0.02);  // its weight takes 1.5 %
  }

  TEST_CASE("clay pressed to a tenth stays finite and comes back to a fifth") {
    Press clay(cube_of(Real(1e5), Real(5e3)), 0.03, without_air());
    run(clay.world, 240);
    CHECK(height_of(clay.world, clay.solid) < 0.135);
    CHECK(height_of(clay.world, clay.solid) > 0.04);
    CHECK(apart(clay.world.volume(clay.solid), 0.027) < 0.01);
    CHECK(clay.world.measure().energy.kinetic < 1e-3);
  }

  TEST_CASE("a ball of clay stays where it fell, flattened; one of rubber jumps") {
    Drop clay(Real(5e3));
    Drop rubber(kRigid);
    CHECK(rubber.rebound() > 0.15);
    CHECK(clay.rebound() < 0.02);
    run(clay.world, 120);
    run(rubber.world, 240);
    CHECK(height_of(clay.world, clay.ball) < 0.26);
    CHECK(height_of(rubber.world, rubber.ball) > 0.26);
    const double height = height_of(clay.world, clay.ball);
    run(clay.world, 300);
    CHECK(apart(height_of(clay.world, clay.ball), height) < 1e-3);
  }

  TEST_CASE("folding takes energy and never gives any") {
    for (const Real yield_angle : {Real(0.03), kRigid}) {
      WorldDesc space = empty_space();
      space.particle_substeps = 8;
      World world = make_world(space);
      ClothDesc desc;
      desc.columns = 9;
      desc.rows = 6;
      desc.corner = {-0.2, 0, 0};
      desc.row_direction = {0, 0, 1};
      desc.width = Real(0.4);
      desc.height = Real(0.25);
      desc.stretch_stiffness = Real(500);
      desc.shear_stiffness = Real(100);
      desc.bend_stiffness = Real(0.02);
      desc.yield_angle = yield_angle;
      const ClothId id = take(world.add_cloth(desc));
      const PointView x = world.positions(id);
      for (std::uint32_t i = 0; i < x.size(); ++i) {
        const auto bending = static_cast<Real>(20 * (x[i].x * x[i].x - 0.0133));
        REQUIRE(world.set_velocity(point(id, i), {0, bending, 0}));
      }
      const double start = world.measure().energy.kinetic;
      CHECK((least_energy(world, 240, start) < 0.15 * start) == (yield_angle < kRigid));
    }
  }

  TEST_CASE("flow takes energy and never gives any") {
    for (const Real yield_stress : {Real(300), Real(3000), kRigid}) {
      World world = make_world(empty_space());
      SolidDesc desc = cube_of(Real(3e4), yield_stress);
      desc.damping = Real(0);
      const SolidId id = take(world.add_solid(desc));
      const PointView x = world.positions(id);
      for (std::uint32_t i = 0; i < x.size(); ++i) {
        const Vec3 from = vector_cast<Real>(x[i] - DVec3{0, 0.15, 0});
        REQUIRE(world.set_velocity(point(id, i), {-8 * from.x, 16 * from.y, 3 * from.x - 8 * from.z}));
      }
      const double start = world.measure().energy.kinetic;
      const double least = least_energy(world, 120, start);
      if (yield_stress == kRigid) CHECK(least > 0.3 * start);
      if (yield_stress == Real(300)) CHECK(least < 0.02 * start);
    }
  }

  TEST_CASE("dents and folds have the same bits for any workers and instructions, and after a restoration") {
    World one = make_heap(1);
    const auto expected = hashes(one, 90);
    for (const int workers : {2, 3}) {
      World other = make_heap(workers);
      CHECK(hashes(other, 90) == expected);
    }
    REQUIRE(solver::wide::use_target("scalar"));
    World plain = make_heap(1);
    CHECK(hashes(plain, 90) == expected);
    solver::wide::use_target("");
    World again = make_heap(2);
    hashes(again, 40);
    const Snapshot snapshot = again.snapshot();
    const std::uint64_t at_snapshot = again.state_hash();
    hashes(again, 20);
    REQUIRE(again.restore(snapshot));
    CHECK(again.state_hash() == at_snapshot);
    const auto rest = hashes(again, 50);
    CHECK(std::equal(rest.begin(), rest.end(), expected.begin() + 40));
  }

  TEST_CASE("an object that yields keeps its bits when an object before it is removed") {
    std::vector<DVec3> expected;
    for (const bool removed : {false, true}) {
      World world = make_world();
      take(world.add_body({.shape = Shape::half_space()}));
      SolidDesc other = cube_of(Real(3e4), Real(10));
      other.position.x = 2;
      const SolidId first = removed ? take(world.add_solid(other)) : SolidId{};
      SolidDesc clay = cube_of(Real(3e4), Real(1e3));
      clay.position.y = 0.5;
      const SolidId id = take(world.add_solid(clay));
      if (removed) REQUIRE(world.remove(first));
      run(world, 60);
      const PointView x = world.positions(id);
      for (std::size_t i = 0; i < x.size(); ++i) {
        if (removed) CHECK(x[i] == expected[i]);
        expected.push_back(x[i]);
      }
    }
  }

  TEST_CASE("limits that make no sense are errors that name the field") {
    World world = make_world();
    SolidDesc solid;
    solid.yield_stress = Real(0);
    CHECK(world.add_solid(solid).error().where == "solid.yield_stress");
    ClothDesc cloth;
    cloth.yield_angle = Real(-1);
    CHECK(world.add_cloth(cloth).error().where == "cloth.yield_angle");
    cloth.yield_angle = Real(0.1);
    cloth.bend = ClothDesc::Bend::kSpring;
    CHECK(world.add_cloth(cloth).error().where == "cloth.yield_angle");
  }
}

}  // namespace hooke
