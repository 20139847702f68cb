#include "constants.h"
#include "world/make.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace hooke {

using namespace test;

namespace {

using Line = std::vector<std::uint32_t>;

SeamEdge edge(ClothId cloth, const char* name) {
  SeamEdge made;
  made.object = point(cloth, 0);
  made.edge = name;
  return made;
}

template <class IdType>
SeamEdge line(IdType object, Line points) {
  SeamEdge made;
  made.object = point(object, 0);
  made.points = std::move(points);
  return made;
}

std::vector<HookId> sew(World& world, const SeamEdge& a, const SeamEdge& b, Real strength = kRigid) {
  SeamDesc desc;
  desc.a = a;
  desc.b = b;
  desc.strength = strength;
  return take(world.sew(desc));
}

double largest_gap(const World& world, const std::vector<HookId>& stitches) {
  double gap = 0;
  for (const HookId stitch : stitches) gap = std::max(gap, d(world.hook_gap(stitch)));
  return gap;
}

DVec3 sum_of_forces(const World& world, const std::vector<HookId>& stitches) {
  DVec3 sum;
  for (const HookId stitch : stitches) sum += vector_cast<double>(world.hook_force(stitch).force);
  return sum;
}

double force_of(const World& world, HookId stitch) {
  return length(vector_cast<double>(world.hook_force(stitch).force));
}

/// A vertical cloth of 1 m x 1 m or a part of it, in the plane z = 0, its upper edge at y = 0.
ClothDesc sheet(double left, double right, double top, double bottom, int columns, int rows) {
  ClothDesc desc = {.columns = columns, .rows = rows, .corner = {left, top, 0}};
  desc.width = static_cast<Real>(right - left);
  desc.height = static_cast<Real>(top - bottom);
  desc.stretch_stiffness = Real(1e5);
  desc.shear_stiffness = Real(2e4);
  desc.bend = ClothDesc::Bend::kNone;
  desc.air_friction = Real(0.3);
  return desc;
}

std::vector<PinDesc> pins_in_column(int columns, int rows, int column, const MotionDesc& motion = {}) {
  std::vector<PinDesc> pins;
  for (int row = 0; row < rows; ++row)
    pins.push_back({static_cast<std::uint32_t>(row * columns + column), motion});
  return pins;
}

/// Seats of a hammock: what is pinned on the right moves 0.2 m inward within a second.
MotionDesc inward() {
  MotionDesc motion;
  motion.kind = MotionDesc::Kind::kKeyframes;
  motion.keyframes = {{0, {}}, {1, {Real(-0.2), 0, 0}}};
  return motion;
}

double lowest(const PointView& points) {
  double y = points[0].y;
  for (std::size_t i = 0; i < points.size(); ++i) y = std::min(y, points[i].y);
  return y;
}

/// A tube about x as a mesh, open at its ends; closed around, or slit along the angle zero.
MeshDesc tube(int around, int along, double radius, double from, double to, bool slit) {
  MeshDesc mesh;
  const int columns = slit ? around + 1 : around;
  for (int j = 0; j < along; ++j) {
    for (int i = 0; i < columns; ++i) {
      const double angle = 2 * std::numbers::pi * i / around;
      mesh.positions.push_back({static_cast<Real>(from + (to - from) * j / (along - 1)),
                                static_cast<Real>(radius * std::cos(angle)),
                                static_cast<Real>(radius * std::sin(angle))});
    }
  }
  for (int j = 0; j + 1 < along; ++j) {
    for (int i = 0; i < around; ++i) {
      const auto at = [&](int column, int row) {
        return static_cast<std::uint32_t>(row * columns + column % columns);
      };
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

/// Pressure from inside on all triangles of the one cloth there is.
ForceLaw pressure(std::vector<std::array<std::uint32_t, 3>> triangles, double p) {
  return [triangles = std::move(triangles), p](ForceView& view) {
    for (const auto& [a, b, c] : triangles) {
      const DVec3 area =
          0.5 * cross(view.position(b) - view.position(a), view.position(c) - view.position(a));
      for (const std::uint32_t i : {a, b, c}) view.add_force(i, vector_cast<Real>(p / 3 * area));
    }
  };
}

std::string complaint(World& world, const SeamEdge& a, const SeamEdge& b, Real strength = kRigid) {
  SeamDesc desc;
  desc.a = a;
  desc.b = b;
  desc.strength = strength;
  const auto sewn = world.sew(desc);
  return sewn ? "" : sewn.error().where + ": " + sewn.error().message;
}

}  // namespace

TEST_SUITE("world/seams") {
  TEST_CASE("the seam of a tube of a strip carries p R of its length") {
    constexpr int kAround = 48;
    constexpr int kAlong = 13;
    constexpr double kPressure = 200;
    WorldDesc world_desc = empty_space();
    world_desc.particle_substeps = 4;
    World world = make_world(world_desc);
    ClothDesc desc = {.mesh = take(world.add_mesh(tube(kAround, kAlong, 0.3, 0, 0.5, true)))};
    desc.stretch_stiffness = Real(1e5);
    desc.shear_stiffness = Real(1e4);
    desc.bend = ClothDesc::Bend::kNone;
    desc.areal_density = Real(5);
    desc.air_friction = Real(20);
    const ClothId cloth = take(world.add_cloth(desc));
    Line first, last;
    for (std::uint32_t j = 0; j < kAlong; ++j) {
      first.push_back(j * (kAround + 1));
      last.push_back(j * (kAround + 1) + kAround);
    }
    const std::vector<HookId> stitches = sew(world, line(cloth, first), line(cloth, last));
    CHECK(stitches.size() == kAlong);
    (void)take(world.add_force_law(pressure(world.triangles(cloth), kPressure)));
    run(world, 600);
    const PointView points = world.positions(cloth);
    const auto radius = [&](std::uint32_t i) { return std::hypot(points[i].y, points[i].z); };
    const double length = points[last.back()].x - points[last.front()].x;
    // Of a polygon, the radius of the circle inside it: a corner has (p s / 2) cos from each of two sides.
    const double expected = kPressure * radius(last[kAlong / 2]) * std::cos(std::numbers::pi / kAround);
    double sum = 0;
    for (const HookId stitch : stitches) sum += force_of(world, stitch);
    INFO("p R = " << expected << " N/m, seam " << sum / length << " N/m, gap " << largest_gap(world, stitches)
                  << " m");
    CHECK(std::abs(sum / length - expected) < 0.01 * expected);
    CHECK(largest_gap(world, stitches) < 1e-5);
  }

  TEST_CASE("two halves hang as the whole does, also where one is finer") {
    const auto depth = [](int right_columns, int right_rows) {
      WorldDesc world_desc = without_air();
      world_desc.particle_substeps = 4;
      World world = make_world(world_desc);
      std::vector<HookId> stitches;
      double low = 0;
      if (right_columns == 0) {
        ClothDesc whole = sheet(0, 1, 0, -1, 21, 21);
        whole.row_direction = {0, 0, 1};
        whole.pins = pins_in_column(21, 21, 0);
        for (const PinDesc& pin : pins_in_column(21, 21, 20, inward())) whole.pins.push_back(pin);
        const ClothId cloth = take(world.add_cloth(whole));
        run(world, 480);
        low = lowest(world.positions(cloth));
      } else {
        ClothDesc left = sheet(0, 0.5, 0, -1, 11, 21);
        ClothDesc right = sheet(0.5, 1, 0, -1, right_columns, right_rows);
        left.row_direction = right.row_direction = {0, 0, 1};
        left.air_friction = right.air_friction = Real(0.15);
        left.pins = pins_in_column(11, 21, 0);
        right.pins = pins_in_column(right_columns, right_rows, right_columns - 1, inward());
        const ClothId a = take(world.add_cloth(left));
        const ClothId b = take(world.add_cloth(right));
        stitches = sew(world, edge(a, "right"), edge(b, "left"));
        CHECK(stitches.size() == static_cast<std::size_t>(std::max(21, right_rows)));
        double gap = 0;
        for (int i = 0; i < 480; ++i) {
          REQUIRE(world.step(Real(1) / Real(60)).healthy());
          gap = std::max(gap, largest_gap(world, stitches));
        }
        CHECK(gap < 1e-4);
        low = std::min(lowest(world.positions(a)), lowest(world.positions(b)));
      }
      return -low;
    };
    const double whole = depth(0, 0);
    const double same = depth(11, 21);
    const double finer = depth(16, 31);
    INFO("depth of the whole " << whole << " m, of halves " << same << ", with a finer half " << finer);
    CHECK(whole > 0.2);
    CHECK(std::abs(same - whole) < 0.005 * whole);
    CHECK(std::abs(finer - whole) < 0.02 * whole);
  }

  TEST_CASE("a seam carries what hangs on it, evenly, and parts at its strength") {
    WorldDesc world_desc = without_air();
    world_desc.particle_substeps = 4;
    World world = make_world(world_desc);
    constexpr double kWidth = 0.8;
    ClothDesc upper = sheet(0, kWidth, 0, -0.5, 21, 11);
    for (std::uint32_t i = 0; i < 21; ++i) upper.pins.push_back({.point = i});
    ClothDesc lower = sheet(0, kWidth, -0.5, -1, 21, 11);
    upper.areal_density = lower.areal_density = Real(2);
    upper.shear_stiffness = lower.shear_stiffness = Real(0);  // threads alone: nothing draws the sides in
    lower.air_friction = Real(10);
    for (std::uint32_t i = 0; i < 21; ++i)
      lower.loads.push_back({10 * 21 + i, i == 0 || i == 20 ? Real(0.1) : Real(0.2)});
    const ClothId a = take(world.add_cloth(upper));
    const ClothId b = take(world.add_cloth(lower));
    const double mass = 4 + 2 * 0.5 * kWidth;
    const std::vector<HookId> stitches = sew(world, edge(a, "bottom"), edge(b, "top"), Real(75));
    double gravity = 0;
    const auto grow_to = [&](double most, double by) {
      while (world.broken_hooks().empty() && gravity < most) {
        gravity += by;
        REQUIRE(world.set_gravity({0, static_cast<Real>(-gravity), 0}).has_value());
        run(world, 1);
      }
    };
    grow_to(kGravity, 0.004 * kGravity);  // slowly: a load that is let go pulls twice as hard
    run(world, 200);
    const double weight = mass * gravity;
    CHECK(std::abs(sum_of_forces(world, stitches).y - weight) < 0.002 * weight);
    for (std::size_t i = 1; i < 20; ++i)
      CHECK(std::abs(force_of(world, stitches[i]) - weight / 20) < 0.05 * weight / 20);
    CHECK(std::abs(force_of(world, stitches[0]) - weight / 40) < 0.1 * weight / 40);
    grow_to(3 * kGravity, 0.01);
    INFO("75 N/m parts at " << mass * gravity / kWidth << " N/m");
    CHECK(std::abs(mass * gravity / kWidth - 75) < 0.02 * 75);
    run(world, 60);
    for (const HookId stitch : stitches) CHECK(d(world.hook_gap(stitch)) == 0);  // all have gone
    CHECK(lowest(world.positions(b)) < -3);
  }

  TEST_CASE("closed borders are sewn all around, whatever their points and where they begin") {
    World world = make_world(empty_space());
    ClothDesc desc = {.mesh = take(world.add_mesh(tube(24, 4, 0.3, 0, 0.3, false)))};
    const ClothId a = take(world.add_cloth(desc));
    desc.mesh = take(world.add_mesh(tube(36, 4, 0.3, 0.3, 0.6, false)));
    const ClothId b = take(world.add_cloth(desc));
    // The second border of a is at its far end, the first of b at its near end. They run against each other.
    const std::vector<HookId> stitches = sew(world, edge(a, "border_1"), edge(b, "border_0"));
    CHECK(stitches.size() == 36);
    CHECK(largest_gap(world, stitches) < 0.004);  // corners of 36 beside sides of 24: 0.3 (1 - cos 7.5 deg)
    REQUIRE(world.apply_impulse(point(b, 36 * 3), {Real(0.05), Real(0.1), 0}).has_value());
    run(world, 120);
    CHECK(largest_gap(world, stitches) < 1e-5);
  }

  TEST_CASE("cloth is sewn to jelly; a dart begins at a point that both lines share") {
    World world = make_world(without_air());
    SolidDesc box = {.cells = {4, 1, 1}, .size = {Real(1), Real(0.1), Real(0.1)}, .position = {0.5, 0.05, 0}};
    box.pins = {{5}, {9}, {15}, {19}};  // what is not at its bottom stays
    const SolidId jelly = take(world.add_solid(box));
    const PointView points = world.positions(jelly);
    Line bottom;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      if (std::abs(points[i].y) < 1e-6 && points[i].z < 0) bottom.push_back(i);
    }
    REQUIRE(bottom.size() == 5);
    ClothDesc desc = sheet(0, 1, 0, -0.5, 9, 5);
    desc.corner.z = -0.05;
    const ClothId cloth = take(world.add_cloth(desc));
    const std::vector<HookId> stitches = sew(world, edge(cloth, "top"), line(jelly, bottom));
    CHECK(stitches.size() == 9);
    run(world, 600);  // It rings while less.
    CHECK(largest_gap(world, stitches) < 1e-5);
    CHECK(std::abs(sum_of_forces(world, stitches).y + 0.1 * kGravity) < 0.02 * kGravity * 0.1);
    const ClothId dart = take(world.add_cloth(sheet(2, 3, 0, -1, 5, 5)));
    CHECK(sew(world, line(dart, {12, 7, 2}), line(dart, {12, 13, 14})).size() == 2);
  }

  TEST_CASE("seams have the same bits with any number of workers, and after a restore") {
    test::check_same_bits(without_air(), [](World& world) {
      ClothDesc left = sheet(0, 0.5, 0, -1, 6, 11);
      left.pins = {{0}};
      const ClothId a = take(world.add_cloth(left));
      const ClothId b = take(world.add_cloth(sheet(0.5, 1, 0, -1, 8, 16)));
      (void)sew(world, edge(a, "right"), edge(b, "left"), Real(400));
    });
  }

  TEST_CASE("an impossible seam is an error that says why") {
    World world = make_world();
    const ClothId a = take(world.add_cloth({.columns = 4, .rows = 3}));
    const ClothId b = take(world.add_cloth({.columns = 4, .rows = 3, .corner = {2, 0, 0}}));
    const ClothId tubular = take(world.add_cloth({.mesh = take(world.add_mesh(tube(8, 3, 1, 0, 1, false)))}));
    const RopeId rope = take(world.add_rope({}));
    CHECK(complaint(world, edge(a, "right"), edge(b, "outer")) ==
          "seam.b: has no edge 'outer', there are left, right, top, bottom, border");
    CHECK(complaint(world, edge(tubular, "border"), edge(b, "left")) ==
          "seam.a: has no edge 'border', there are border_0, border_1");
    CHECK(complaint(world, edge(a, "right"), edge(b, "border")) == "seam.b: must be open, as a is");
    CHECK(complaint(world, edge(a, "border"), edge(b, "left")) == "seam.b: must be closed, as a is");
    CHECK(complaint(world, edge(a, "right"), edge(a, "right")) == "seam.b: must be another line than a");
    CHECK(complaint(world, edge(a, ""), edge(b, "left")) ==
          "seam.a: needs either the name of an edge or points");
    CHECK(complaint(world, line(a, {1}), edge(b, "left")) == "seam.a.points: needs at least 2 points");
    CHECK(complaint(world, line(a, {1, 12}), edge(b, "left")) ==
          "seam.a.points: names point 12 of 12; the first is 0");
    CHECK(complaint(world, line(a, {1, 1}), edge(b, "left")) == "seam.a.points: are all at the same place");
    CHECK(complaint(world, line(rope, {0, 1}), edge(b, "left")) == "seam.a: must be of a cloth or a solid");
    CHECK(complaint(world, edge(ClothId{99, 1}, "left"), edge(b, "left")) ==
          "seam.a: refers to nothing that is in the world");
    CHECK(complaint(world, edge(a, "right"), edge(b, "left"), Real(0)) ==
          "seam.strength: 0 is out of range, must be positive, or rigid");
    CHECK(complaint(world, edge(a, "right"), edge(b, "left")) == "");
  }
}

}  // namespace hooke
