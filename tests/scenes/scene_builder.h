#pragma once

#include "hooke/scene_io.h"

#include <string>
#include <vector>

/// \file
/// Scenes of simple things, in a line each. Names are numbered by kind: body_0, rope_3.

namespace hooke::test {

/// A name with a number.
[[nodiscard]] std::string numbered(const std::string& name, std::size_t number);

/// `count` places from `first` to `last`, evenly.
[[nodiscard]] std::vector<DVec3> line(DVec3 first, DVec3 last, int count);

/// Turns by a right angle about an axis of the frame.
[[nodiscard]] Quat quarter_turn(Vec3 axis);

struct SceneBuilder {
  Scene scene = {};
  DVec3 at = {};  ///< Where the places given below are counted from [m].

  /// Adds a body. A mass of 0 makes it static.
  SceneBody& body(const Shape& shape, DVec3 place, double mass);
  std::string box(DVec3 half, DVec3 place, double mass);
  std::string sphere(double radius, DVec3 place, double mass);
  /// Adds a cylinder that lies along z.
  std::string roller(double radius, double half_length, DVec3 place, double mass);
  /// Adds a rope through `points`, at rest there, with none of them pinned.
  std::string rope(const std::vector<DVec3>& points, double mass, double radius = 0.01);
  /// Pins both ends of the rope that came last.
  void pin_both_ends();
  /// Adds a square of cloth that lies level, its middle at `place`.
  SceneCloth& cloth(DVec3 place, double side, int columns);
  /// Adds a cube of jelly of `cells` along each edge.
  SceneSolid& jelly(DVec3 place, double side, int cells);
  /// Adds a mesh and a static body of it: the ground that lies over `half` to both sides. Its vertices have
  /// the heights that `height_of` gives by column and row.
  template <class HeightOf>
  void ground(DVec3 half, std::uint32_t side, HeightOf&& height_of);

  /// Adds a hook; an empty name is the world. The reference is valid until the next hook comes.
  SceneHook& hook(HookKind kind, const std::string& a, const std::string& b, DVec3 place);
  /// Adds a ball hook at a point of a rope or cloth; an empty name is the world.
  SceneHook& tie(const std::string& to, const std::string& object, std::size_t point);
};

template <class HeightOf>
void SceneBuilder::ground(DVec3 half, std::uint32_t side, HeightOf&& height_of) {
  SceneMesh mesh;
  mesh.name = "ground";
  const double middle = 0.5 * (side - 1.0);
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i)
      mesh.mesh.positions.push_back({static_cast<Real>(half.x * (i / middle - 1)),
                                     static_cast<Real>(height_of(i, j)),
                                     static_cast<Real>(half.z * (j / middle - 1))});
  }
  for (std::uint32_t j = 0; j + 1 < side; ++j) {
    for (std::uint32_t i = 0; i + 1 < side; ++i) {
      const std::uint32_t a = j * side + i;
      const std::uint32_t c = a + side;
      mesh.mesh.triangles.push_back({a, c, c + 1});
      mesh.mesh.triangles.push_back({a, c + 1, a + 1});
    }
  }
  scene.meshes.push_back(mesh);
  body({.kind = ShapeKind::kMesh}, {}, 0).mesh = "ground";
  scene.objects.bodies.back().tag.name = "floor";
}

}  // namespace hooke::test
