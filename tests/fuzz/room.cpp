#include "fuzz/room.h"

#include <iterator>

namespace hooke::fuzz {

namespace {

constexpr double kCell = 2.8;   // Side of a cell [m].
constexpr double kCeiling = 3;  // Assemblies stay below it; what falls begins above it [m].

struct Assembly {
  const char* name = nullptr;
  void (*make)(RoomMaker& maker) = nullptr;
};

constexpr Assembly kAssemblies[] = {
    {"stack", make_stack},     {"pyramid", make_pyramid},   {"table", make_table},
    {"rollers", make_rollers}, {"gripper", make_gripper},   {"chain", make_chain},
    {"arm", make_arm},         {"seesaw", make_seesaw},     {"springs", make_springs},
    {"ragdoll", make_ragdoll}, {"cart", make_cart},         {"ball net", make_ball_net},
    {"bridge", make_bridge},   {"pulley", make_pulley},     {"hanging load", make_hanging_load},
    {"hammock", make_hammock}, {"rope net", make_rope_net}, {"covered box", make_covered_box},
    {"jelly", make_jelly},
};

/// Gives each body a surface of five.
void add_materials(Random& random, Scene& scene) {
  for (std::size_t i = 0; i < 5; ++i) {
    SceneMaterial material;
    material.name = test::numbered("material", i);
    material.friction = random.real(0, 1);
    material.restitution = random.pick<Real>({Real(0), Real(0), Real(0), Real(0.01), Real(0.5)});
    scene.materials.push_back(material);
  }
  for (SceneBody& body : scene.objects.bodies)
    body.tag.material = scene.materials[random.below(scene.materials.size())].name;
}

/// An octahedron of unequal corners, about `size` wide.
SceneMesh make_hull(Random& random, std::size_t number, Real size) {
  SceneMesh mesh;
  mesh.name = test::numbered("hull", number);
  for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
    mesh.mesh.positions.push_back(size * (random.real(0.35, 0.55) * axis + random.vector(0.1)));
    mesh.mesh.positions.push_back(size * (random.real(-0.55, -0.35) * axis + random.vector(0.1)));
  }
  mesh.mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                         {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  return mesh;
}

/// Adds floor and walls of a room of these half sizes. Returns the height on which things stand.
double add_walls(Random& random, test::SceneBuilder& room, DVec3 half) {
  const double thick = 0.5;  // Half the thickness [m].
  const double high = 6;     // Half the height [m].
  const auto add = [&](const char* name, DVec3 place, DVec3 half_size) {
    (void)room.box(half_size, place, 0);
    room.scene.objects.bodies.back().tag.name = name;
  };
  const DVec3 across = {thick, high, half.z + 2 * thick};
  const DVec3 along = {half.x + 2 * thick, high, thick};
  add("wall_left", {-half.x - thick, high, 0}, across);
  add("wall_right", {half.x + thick, high, 0}, across);
  add("wall_back", {0, high, -half.z - thick}, along);
  add("wall_front", {0, high, half.z + thick}, along);
  if (random.chance(0.6)) {
    add("floor", {0, -thick, 0}, {half.x + 2 * thick, thick, half.z + 2 * thick});
    return 0;
  }
  const double bump = random.pick<double>({0, 0.01, 0.03});
  room.ground(half, 25, [&](std::uint32_t, std::uint32_t) { return random.between(0, bump); });
  return bump;
}

RoomMaker maker_at(Random& random, test::SceneBuilder& room, double light) {
  RoomMaker maker{.random = Random(random.bits()), .room = &room, .light = light};
  maker.heavy = light * random.pick<double>({1, 3, 10, 30, 100, 300, 1000});
  return maker;
}

/// Something that falls from above the ceiling.
void drop_one(RoomMaker& maker) {
  Random& random = maker.random;
  const DVec3 place = {random.between(-0.5, 0.5), 0, random.between(-0.5, 0.5)};
  const std::size_t kind = random.below(10);
  if (kind == 0) {
    (void)maker.room->rope(test::line(place - DVec3{0.5, 0, 0}, place + DVec3{0.5, 0, 0.2}, 16), maker.light);
  } else if (kind == 1) {
    maker.room->cloth(place, 0.7, 9);
  } else {
    const double mass = random.pick<double>({maker.light, maker.light, maker.heavy});
    add_lump(maker, place, random.between(0.15, 0.5), mass);
    BodyDesc& desc = maker.room->scene.objects.bodies.back().desc;
    if (random.chance(0.5)) desc.velocity = random.vector(3);
    if (random.chance(0.3)) desc.angular_velocity = random.vector(5);
  }
}

/// An assembly in the cell whose floor has its middle at `room.at`, and what falls on it.
void fill_cell(Random& random, test::SceneBuilder& room, double light) {
  const Assembly& assembly = kAssemblies[random.below(std::size(kAssemblies))];
  room.scene.description += (room.scene.description.empty() ? "" : ", ") + std::string(assembly.name);
  RoomMaker maker = maker_at(random, room, light);
  assembly.make(maker);
  const int falling = random.integer(0, 3);
  for (int i = 0; i < falling; ++i) {
    room.at.y = kCeiling + 0.5 + 0.8 * i;
    RoomMaker above = maker_at(random, room, light);
    drop_one(above);
  }
}

}  // namespace

std::string add_lump(RoomMaker& maker, DVec3 place, double size, double mass) {
  Random& random = maker.random;
  test::SceneBuilder& room = *maker.room;
  const auto r = static_cast<Real>(0.5 * size);
  const std::size_t kind = random.below(5);
  if (kind == 0) return room.sphere(0.5 * size, place, mass);
  Shape shape = Shape::box({Real(0.7) * r, random.real(0.3, 0.7) * r, Real(0.5) * r});
  if (kind == 1) shape = Shape::capsule(Real(0.5) * r, Real(0.5) * r);
  if (kind == 2) shape = Shape::cylinder(Real(0.7) * r, Real(0.7) * r);
  if (kind == 3) shape = {.kind = ShapeKind::kHull};
  SceneBody& lump = room.body(shape, place, mass);
  lump.desc.rotation = random.turn();
  if (kind == 3) {
    room.scene.meshes.push_back(make_hull(random, room.scene.meshes.size(), 2 * r));
    lump.mesh = room.scene.meshes.back().name;
  }
  return lump.tag.name;
}

Scene make_room(Random& random) {
  const double seconds = 2 + 0.5 * random.integer(0, 2);
  const int columns = random.integer(1, 3);
  const int rows = random.integer(1, 2);
  return make_room(random, columns, rows, seconds);
}

Scene make_room(Random& random, int columns, int rows, double seconds) {
  test::SceneBuilder room;
  room.scene.title = "Random room";
  room.scene.seconds = seconds;
  const DVec3 half = {0.5 * kCell * columns, 0, 0.5 * kCell * rows};
  const double floor = add_walls(random, room, half);
  const double light = random.pick<double>({0.1, 0.3, 1, 3, 10});
  for (int i = 0; i < columns * rows; ++i) {
    room.at = {kCell * (i % columns + 0.5) - half.x, floor, kCell * (i / columns + 0.5) - half.z};
    fill_cell(random, room, light);
  }
  add_materials(random, room.scene);
  return room.scene;
}

}  // namespace hooke::fuzz
