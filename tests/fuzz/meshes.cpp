/// Hostile meshes: through the functions of geometry, and into worlds as ground, bodies, cloths and solids
/// that things fall on.

#include "hooke/geometry.h"
#include "hooke/model_io.h"
#include "hooke/world.h"

#include "fuzz/exclusions.h"
#include "fuzz/mesh_maker.h"
#include "fuzz/population.h"
#include "fuzz/scene_checks.h"
#include "fuzz/target.h"

#include <algorithm>
#include <cmath>

namespace hooke::fuzz {

namespace {

constexpr Real kStep = Real(1) / Real(60);

void check_mesh(const MeshDesc& mesh, const char* what) {
  for (const Vec3 p : mesh.positions) expect(is_finite(p), what);
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) expect(v < mesh.positions.size(), what);
  }
}

void try_geometry(Random& random, const MeshDesc& mesh) {
  if (const auto repaired = repair_solid(mesh)) {
    check_mesh(repaired->mesh, "a repaired solid");
    expect(repair_solid(repaired->mesh).has_value(), "a repaired solid that needs repair");
  }
  check_mesh(model_of(mesh).mesh, "a model of a mesh");
  if (random.chance(0.2)) {
    if (const auto parts = decompose_convex(mesh, random.real(0.01, 0.3), random.integer(1, 16))) {
      for (const MeshDesc& part : *parts) check_mesh(part, "a convex part");
    }
  }
  if (random.chance(0.3)) {
    const MeshDesc other = random.chance(0.5) ? fuzz::make_solid(random, 1) : make_hostile_mesh(random, 1);
    const auto operation = random.pick<SolidOperation>(
        {SolidOperation::kUnion, SolidOperation::kIntersection, SolidOperation::kDifference});
    if (const auto combined = combine_solids(mesh, other, operation))
      check_mesh(*combined, "combined solids");
  }
}

constexpr Real kLeastCell = Real(0.02);  ///< Of a mesh: a needle of a million cells takes minutes.

Real extent_of(const MeshDesc& mesh) {
  Real extent = 0;
  for (const Vec3 p : mesh.positions) extent = std::max(extent, length(p - mesh.positions[0]));
  return extent;
}

void add_of_mesh(Random& random, MeshId mesh, Real extent, World& world, Population& all) {
  const auto take = [](auto result, auto& ids, const char* what) {
    note(result ? what : std::string(what) + " refused: " + result.error().message);
    if (result) ids.push_back(*result);
  };
  const Shape shape = random.chance(0.5) ? Shape::of_mesh(mesh) : Shape::hull_of(mesh);
  take(world.add_body({.shape = shape, .rotation = random.turn()}), all.bodies, "ground");
  if (random.chance(0.5)) {
    take(world.add_body({.kind = BodyKind::kDynamic,
                         .shape = random.chance(0.5) ? Shape::of_mesh(mesh) : Shape::hull_of(mesh),
                         .position = {0, 2.5, 0},
                         .rotation = random.turn()}),
         all.bodies, "body");
  }
  if (random.chance(0.3)) {
    ClothDesc cloth = make_cloth(random, {0, 4, 0}, {}, {});
    cloth.mesh = mesh;
    cloth.pins.clear();
    cloth.loads.clear();
    if (random.chance(0.5)) cloth.pressure = random.real(0, 3000);
    take(world.add_cloth(cloth), all.cloths, "cloth");
  }
  if (random.chance(0.3)) {
    SolidDesc solid = fuzz::make_solid(random, {0, -3, 0}, {});
    solid.mesh = mesh;
    solid.pins.clear();
    solid.cell = std::max(random.real(0.2, 0.6), kLeastCell * extent);
    take(world.add_solid(solid), all.solids, "solid");
  }
}

void drop_things(Random& random, World& world, Population& all) {
  const int count = random.integer(1, 4);
  for (int i = 0; i < count; ++i) {
    const DVec3 place = random.place(0.7) + DVec3{0, 1.5, 0};
    if (random.chance(0.7)) {
      BodyDesc body = make_body(random, place, {}, {.may_drive = false});
      body.kind = BodyKind::kDynamic;
      all.bodies.push_back(must(world.add_body(body), "body"));
    } else {
      all.ropes.push_back(must(world.add_rope(make_rope(random, place, {.may_drive = false})), "rope"));
    }
  }
}

void ask(Random& random, const World& world) {
  const DVec3 from = random.place(2);
  const DVec3 way = random.place(4) + DVec3{0, 1e-3, 0};
  if (const auto hit = must(world.cast_ray(from, way), "ray"))
    expect(is_finite(hit->point) && is_finite(hit->normal), "a ray's hit is not finite");
  if (const auto hit = must(world.cast_shape(make_simple_shape(random), {from, random.turn()}, way), "shape"))
    expect(is_finite(hit->point) && is_finite(hit->normal), "a shape's hit is not finite");
  if (const auto near = must(world.find_closest(from, 5), "closest"))
    expect(is_finite(near->point) && is_finite(near->normal), "a closest point is not finite");
  (void)world.find_overlaps(make_simple_shape(random), {from, random.turn()});
}

}  // namespace

void try_meshes(Random& random) {
  const MeshDesc mesh = make_hostile_mesh(random, random.pick<double>({1, 1, 1, 1e-3, 100}));
  try_geometry(random, mesh);
  World world = must(World::create({.substeps = random.pick<int>({2, 4, 8})}), "world");
  const Result<MeshId> id = world.add_mesh(mesh, random.chance(0.3) ? MeshTree::kPlanes : MeshTree::kBoxes);
  if (!id) {
    note("refused: " + id.error().where + ": " + id.error().message);
    return;
  }
  Population all;
  add_of_mesh(random, *id, extent_of(mesh), world, all);
  drop_things(random, world, all);
  const bool is_huge = std::any_of(mesh.positions.begin(), mesh.positions.end(),
                                   [](Vec3 p) { return !(length(p) < Real(1e6)); });
  note(is_huge ? "huge" : "of a size that things have");
  const bool may_be_ill =
      (is_huge && kLeftOut.health_after_huge_values) || (!all.cloths.empty() && kLeftOut.health_of_cloths);
  const int steps = random.integer(3, 30);
  for (int i = 0; i < steps; ++i) {
    expect(world.step(kStep).healthy() || may_be_ill, "an unhealthy step");
    check_tables(world);
    (void)check_finite(world, all);
    ask(random, world);
  }
}

}  // namespace hooke::fuzz
