/// Tests edges, tips and seams, and bodies that are fast for their size.

#include "validation/cases.h"
#include "validation/rig.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace hooke::check {

namespace {

constexpr double kFloorLength = 6;  ///< [m]

BodyDesc smooth(BodyDesc desc) {
  desc.contact.friction = real(0);
  return desc;
}

/// Makes a floor of strips of 0.25 m that are cut into 3 and 4 cells by turns, so that every second corner of
/// a strip lies within an edge of its neighbor.
MeshDesc floor_with_seams() {
  MeshDesc mesh;
  for (int strip = 0; strip < static_cast<int>(4 * kFloorLength); ++strip) {
    const int cells = 3 + strip % 2;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int k = 0; k <= cells; ++k) {
      const double z = -1 + 2.0 * k / cells;
      mesh.positions.push_back(real(DVec3{0.25 * strip, 0, z}));
      mesh.positions.push_back(real(DVec3{0.25 * (strip + 1), 0, z}));
    }
    for (int k = 0; k < cells; ++k) {
      const std::uint32_t a = first + 2 * static_cast<std::uint32_t>(k);
      mesh.triangles.push_back({a, a + 2, a + 1});
      mesh.triangles.push_back({a + 1, a + 2, a + 3});
    }
  }
  return mesh;
}

void add_mesh_floor(Rig& rig) {
  rig.add(smooth({.shape = Shape::of_mesh(must(rig.world().add_mesh(floor_with_seams())))}));
}

void add_tiles(Rig& rig) {
  for (int i = 0; i < static_cast<int>(2 * kFloorLength); ++i)
    rig.add(smooth({.shape = box_of({0.25, 0.5, 1}), .position = {0.25 + 0.5 * i, -0.5, 0}}));
}

/// Returns the largest change of velocity of a body that has come to rest on a level floor without friction
/// and then gets 3 m/s [m/s].
double bump(const CheckSetting& setting, const std::function<void(Rig&)>& add_floor, const BodyDesc& desc) {
  Rig rig(setting, sleepless());
  add_floor(rig);
  const BodyId id = rig.add(smooth(desc));
  rig.run(2);
  const DVec3 given = {3, 0, 0};
  must(rig.world().set_velocity(id, real(given)));
  double worst = 0;
  rig.run(1.2, [&] { worst = std::max(worst, length(rig.velocity(id) - given)); });
  return worst;
}

Rows seam_rows(const CheckSetting& setting, const std::string& floor,
               const std::function<void(Rig&)>& add_floor) {
  BodyDesc box = moving(box_of({0.15, 0.1, 0.2}), {1, 0.1, 0.07});
  BodyDesc turned = box;
  turned.rotation = quaternion_about(Vec3{Real(0), Real(1), Real(0)}, real(0.3));
  const BodyDesc ball = moving(Shape::sphere(real(0.1)), {1, 0.1, 0.07});
  Rows rows;
  for (const auto& [name, desc] : {std::pair{"box", box}, {"turned box", turned}, {"ball", ball}}) {
    const CheckRow row = absolute_row(std::string("change of velocity of a ") + name + " over " + floor,
                                      "m/s", 0, bump(setting, add_floor, desc), 1e-4);
    rows.push_back(known_miss_turned(
        setting, row, "tops of boxes in line differ by a rounding: a step of 40 nm tilts a ball's normal"));
  }
  return rows;
}

/// This is the result for a body that was released a little above others.
struct Landing {
  double overlap = 0;  ///< Overlap after 3 s [m].
  double gain = 0;     ///< Largest rise of the energy over its start, as a share of m g times 0.2 m.
};

/// Bodies of the fixture stand; `desc` falls.
Landing land(const CheckSetting& setting, const std::function<void(Rig&)>& add_fixture,
             const std::function<BodyDesc(Rig&)>& falling) {
  Rig rig(setting, sleepless());
  add_fixture(rig);
  const BodyId id = rig.add(falling(rig));
  const double start = rig.energy().total();
  const double scale = static_cast<double>(rig.world().mass(id)) * kGravity * 0.2;
  Landing landing;
  rig.run(3, [&] { landing.gain = std::max(landing.gain, (rig.energy().total() - start) / scale); });
  landing.overlap = rig.world().measure().largest_penetration;
  return landing;
}

/// Makes a pyramid of four faces, 0.2 m high and as wide, with its tip up (`tip` 1) or down (-1).
Shape spike(Rig& rig, double tip) {
  MeshDesc mesh;
  for (const DVec3 p :
       {DVec3{0.1, 0, 0.1}, {0.1, 0, -0.1}, {-0.1, 0, -0.1}, {-0.1, 0, 0.1}, {0, 0.2 * tip, 0}})
    mesh.positions.push_back(real(p));
  mesh.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {0, 2, 1}, {0, 3, 2}};
  if (tip < 0) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  }
  return Shape::hull_of(must(rig.world().add_mesh(mesh)));
}

/// Makes a roof: two faces that meet along z at the height 0.1 of its frame, up or down by `tip`.
Shape wedge(Rig& rig, double tip) {
  MeshDesc mesh;
  for (const double z : {-0.1, 0.1}) {
    for (const DVec3 p : {DVec3{0.1, 0, z}, {-0.1, 0, z}, {0, 0.2 * tip, z}})
      mesh.positions.push_back(real(p));
  }
  mesh.triangles = {{0, 1, 2}, {3, 5, 4}, {0, 2, 3}, {2, 5, 3}, {1, 4, 2}, {2, 4, 5}, {0, 3, 1}, {1, 3, 4}};
  if (tip > 0) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
  }
  return Shape::hull_of(must(rig.world().add_mesh(mesh)));
}

/// Counts how many of 40 bodies that fly at a wall of 1 cm are behind it after half a second.
double escapes(const CheckSetting& setting, double slowest, double fastest,
               const std::function<BodyDesc(double speed)>& shot) {
  int escaped = 0;
  for (int i = 0; i < 40; ++i) {
    WorldDesc world = sleepless();
    world.gravity = {};
    Rig rig(setting, world);
    rig.add({.shape = box_of({0.005, 5, 5}), .position = {0, 0, 0}});
    const double speed = slowest * std::pow(fastest / slowest, i / 39.0);
    BodyDesc desc = shot(speed);
    desc.position.x = -3 - 0.037 * i;
    const BodyId id = rig.add(desc);
    rig.run(0.5);
    if (rig.center(id).x > 0) ++escaped;
  }
  return escaped;
}

BodyDesc ball_shot(double speed) {
  BodyDesc desc = moving(Shape::sphere(real(0.05)), {});
  desc.velocity = real(DVec3{speed, 0, 0});
  desc.bullet = true;
  return desc;
}

BodyDesc plate_shot(double speed) {
  BodyDesc desc = moving(box_of({0.2, 0.005, 0.2}), {});
  desc.velocity = real(DVec3{speed, 0, 0});
  desc.angular_velocity = real(DVec3{7, 0, 60});
  desc.bullet = true;
  return desc;
}

/// Tests whether the end of a rod of 1 m that rotates beside a wall, 0.35 m from it, comes through.
double rod_escapes(const CheckSetting& setting) {
  WorldDesc world = sleepless();
  world.gravity = {};
  Rig rig(setting, world);
  rig.add({.shape = box_of({0.005, 5, 5}), .position = {0.355, 0, 0}});
  BodyDesc desc = moving(Shape::capsule(real(0.02), real(0.5)), {});
  desc.angular_velocity = real(DVec3{0, 0, 1000});
  desc.bullet = true;
  const BodyId rod = rig.add(desc);
  double farthest = -1;
  rig.run(1, [&] { farthest = std::max(farthest, rig.center(rod).x); });
  return farthest > 0.35 ? 1 : 0;
}

}  // namespace

/// Whatever its speed, nothing passes a wall.
Rows fast_bodies(const CheckSetting& setting) {
  return {absolute_row("balls of 5 cm through a wall of 1 cm, 20 to 1000 m/s, of 40", "", 0,
                       escapes(setting, 20, 1000, ball_shot), 0),
          absolute_row("spinning plates of 1 cm through it, 20 to 1000 m/s, of 40", "", 0,
                       escapes(setting, 20, 1000, plate_shot), 0),
          absolute_row("rods with 1000 rad/s through it, of 1", "", 0, rod_escapes(setting), 0)};
}

/// Pairs without a clear normal (Erleben 2018, "Methodology for assessing mesh-based contact point methods")
/// must overlap at rest by less than 0.5 % of 0.2 m, and must not throw anything up.
Rows degenerate_pairs(const CheckSetting& setting) {
  const auto ground = [](Rig& rig) { rig.add(level_ground(0.5)); };
  const auto cliff = [](Rig& rig) {
    rig.add({.shape = box_of({0.5, 0.5, 0.5}), .position = {0.5, -0.5, 0}});
  };
  const auto seam = [](Rig& rig) {
    for (const double x : {-0.5, 0.5}) rig.add({.shape = box_of({0.5, 0.5, 0.5}), .position = {x, -0.5, 0}});
  };
  const auto spike_up = [](Rig& rig) {
    rig.add(level_ground(0.5));
    rig.add({.shape = spike(rig, 1)});
  };
  const auto roof = [](Rig& rig) {
    rig.add(level_ground(0.5));
    rig.add({.shape = wedge(rig, 1)});
  };
  const auto box_at = [](DVec3 place) {
    return [place](Rig&) { return moving(box_of({0.1, 0.1, 0.1}), place); };
  };
  const auto spike_at = [](DVec3 place) {
    return [place](Rig& rig) { return moving(spike(rig, -1), place); };
  };
  struct Fixture {
    const char* title;
    std::function<void(Rig&)> fixture;
    std::function<BodyDesc(Rig&)> falling;
  };
  const std::vector<Fixture> fixtures = {
      {"a spike, tip down, on the ground", ground, spike_at({0, 0.3, 0})},
      {"a spike on a spike", spike_up, spike_at({0, 0.45, 0})},
      {"a spike on a ridge", roof, spike_at({0, 0.45, 0})},
      {"a ridge across a ridge", roof,
       [](Rig& rig) {
         BodyDesc desc = moving(wedge(rig, -1), {0, 0.45, 0});
         desc.rotation = quaternion_about(Vec3{Real(0), Real(1), Real(0)}, real(kTau / 4));
         return desc;
       }},
      {"a box on the edge of a cliff", cliff, box_at({0.02, 0.15, 0})},
      {"a box on the seam of two", seam, box_at({0, 0.15, 0})},
      {"a spike in the seam of two", seam, spike_at({0, 0.3, 0})}};
  Rows rows;
  for (const Fixture& f : fixtures) {
    const Landing landing = land(setting, f.fixture, f.falling);
    rows.push_back(absolute_row(std::string("overlap of ") + f.title, "mm", 0, 1000 * landing.overlap, 1));
    rows.push_back(
        absolute_row(std::string("energy gained by ") + f.title + ", share", "", 0, landing.gain, 0.005));
  }
  return rows;
}

/// A body that slides over a level floor feels no edge within it (godot issue 102544).
Rows seams_in_floors(const CheckSetting& setting) {
  Rows rows = seam_rows(setting, "triangles and T-junctions", add_mesh_floor);
  const Rows more = seam_rows(setting, "boxes side by side", add_tiles);
  rows.insert(rows.end(), more.begin(), more.end());
  return rows;
}

}  // namespace hooke::check
