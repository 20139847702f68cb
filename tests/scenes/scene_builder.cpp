#include "scenes/scene_builder.h"

namespace hooke::test {

std::string numbered(const std::string& name, std::size_t number) {
  return name + "_" + std::to_string(number);
}

std::vector<DVec3> line(DVec3 first, DVec3 last, int count) {
  std::vector<DVec3> places;
  for (int i = 0; i < count; ++i) places.push_back(first + (i / (count - 1.0)) * (last - first));
  return places;
}

Quat quarter_turn(Vec3 axis) {
  return normalize(Quat{axis.x, axis.y, axis.z, Real(1)});
}

SceneBody& SceneBuilder::body(const Shape& shape, DVec3 place, double mass) {
  SceneBody added;
  added.tag.name = numbered("body", scene.objects.bodies.size());
  added.desc.shape = shape;
  added.desc.position = at + place;
  if (mass > 0) {
    added.desc.kind = BodyKind::kDynamic;
    added.desc.mass = static_cast<Real>(mass);
  }
  scene.objects.bodies.push_back(added);
  return scene.objects.bodies.back();
}

std::string SceneBuilder::box(DVec3 half, DVec3 place, double mass) {
  return body(Shape::box(vector_cast<Real>(half)), place, mass).tag.name;
}

std::string SceneBuilder::sphere(double radius, DVec3 place, double mass) {
  return body(Shape::sphere(static_cast<Real>(radius)), place, mass).tag.name;
}

std::string SceneBuilder::roller(double radius, double half_length, DVec3 place, double mass) {
  SceneBody& added =
      body(Shape::cylinder(static_cast<Real>(radius), static_cast<Real>(half_length)), place, mass);
  added.desc.rotation = quarter_turn({1, 0, 0});
  return added.tag.name;
}

std::string SceneBuilder::rope(const std::vector<DVec3>& points, double mass, double radius) {
  SceneRope added;
  added.tag.name = numbered("rope", scene.objects.ropes.size());
  for (const DVec3& place : points) added.desc.points.push_back(at + place);
  added.desc.total_mass = static_cast<Real>(mass);
  added.desc.radius = static_cast<Real>(radius);
  added.pins = {};
  scene.objects.ropes.push_back(added);
  return added.tag.name;
}

void SceneBuilder::pin_both_ends() {
  scene.objects.ropes.back().pins = {{.point = {.index = 0}}, {.point = {.last = true}}};
}

SceneCloth& SceneBuilder::cloth(DVec3 place, double side, int columns) {
  SceneCloth added;
  added.tag.name = numbered("cloth", scene.objects.cloths.size());
  added.desc.columns = columns;
  added.desc.rows = columns;
  added.desc.corner = at + place - DVec3{0.5 * side, 0, 0.5 * side};
  added.desc.row_direction = {0, 0, 1};
  added.desc.width = added.desc.height = static_cast<Real>(side);
  added.desc.thickness = Real(0.01);
  added.desc.stretch_stiffness = Real(1e3);  // what eight substeps of 1/480 s carry
  added.desc.shear_stiffness = Real(200);
  scene.objects.cloths.push_back(added);
  return scene.objects.cloths.back();
}

SceneSolid& SceneBuilder::jelly(DVec3 place, double side, int cells) {
  SceneSolid added;
  const auto length = static_cast<Real>(side);
  added.tag.name = numbered("jelly", scene.objects.solids.size());
  added.desc.cells = {cells, cells, cells};
  added.desc.size = {length, length, length};
  added.desc.position = at + place;
  added.desc.damping = Real(0.02);
  scene.objects.solids.push_back(added);
  return scene.objects.solids.back();
}

SceneHook& SceneBuilder::hook(HookKind kind, const std::string& a, const std::string& b, DVec3 place) {
  SceneHook added;
  added.name = numbered("hook", scene.objects.hooks.size());
  added.desc.kind = kind;
  added.a = a;
  added.b = b;
  added.anchor = at + place;
  scene.objects.hooks.push_back(added);
  return scene.objects.hooks.back();
}

SceneHook& SceneBuilder::tie(const std::string& to, const std::string& object, std::size_t point) {
  SceneHook& added = hook(HookKind::kBall, to, object, {});
  added.anchor.reset();
  added.b_point = ScenePoint{.index = static_cast<std::uint32_t>(point)};
  return added;
}

}  // namespace hooke::test
