#include "io/scene/scene_ignored.h"

#include "io/scene/scene_source.h"

#include <algorithm>
#include <initializer_list>

namespace hooke::io {

namespace {

using Keys = std::initializer_list<const char*>;

class IgnoredKeys {
 public:
  explicit IgnoredKeys(const JsonDocument& document) : document_(document) {}

  void check(const SceneMesh& mesh);
  void check(const WindDesc& wind, const std::string& path);
  void check(const SceneBody& body, const std::string& path);
  void check(const SceneRope& rope, const std::string& path);
  void check(const SceneCloth& cloth, const std::string& path);
  void check(const SceneSolid& solid, const std::string& path);
  void check(const SceneParticles& particles, const std::string& path);
  void check(const SceneHook& hook, const std::string& path);
  void check(const SceneObjects& objects, const std::string& prefix);
  void check(const SceneCamera& camera);
  void check(const SceneSky& sky);
  void check(const SceneLight& light, const std::string& path);
  void check(const SceneExpectation& expectation, const std::string& path);

  [[nodiscard]] std::vector<JsonError> take() { return std::move(found_); }

 private:
  /// If `is_so`, reports those of `keys` that the object at `path` has, because they have no use.
  void ignore(const std::string& path, Keys keys, bool is_so, const char* reason) {
    if (!is_so) return;
    const JsonNode& object = document_.find_closest(path);
    for (const char* key : keys) {
      const JsonNode* child = object.find(key);
      if (child == nullptr || found_.size() >= kMostErrors) continue;
      found_.push_back({child->key_offset,
                        {ErrorCode::kOutOfRange, path + "." + key, std::string("has no effect: ") + reason}});
    }
  }
  void check(const HookFreedom& freedom, const std::string& path);
  template <class T>
  void check_all(const std::vector<T>& list, const std::string& name) {
    for (std::size_t i = 0; i < list.size(); ++i) check(list[i], indexed(name, i));
  }

  const JsonDocument& document_;
  std::vector<JsonError> found_;
};

void IgnoredKeys::check(const SceneMesh& mesh) {
  const std::string path = "meshes." + mesh.name;
  ignore(path, {"scale"}, mesh.import.fit.has_value(), "'fit' replaces it");
  ignore(path, {"up", "scale", "fit", "origin"}, mesh.file.empty(), "it is for a file");
}

void IgnoredKeys::check(const WindDesc& wind, const std::string& path) {
  const Keys gusts = {"correlation_time", "correlation_length", "seed", "gusts"};
  const bool is_still = wind.velocity == Vec3{};
  ignore(path, {"gust", "side_gust"}, is_still, "gusts are relative to 'velocity', which is zero");
  ignore(path, gusts, is_still || (wind.gust == Real(0) && wind.side_gust == Real(0)), "there are no gusts");
}

void IgnoredKeys::check(const SceneBody& body, const std::string& path) {
  const BodyDesc& desc = body.desc;
  const Keys forces = {"mass",          "density",          "linear_damping",    "angular_damping",
                       "gravity_scale", "drag_coefficient", "magnus_coefficient"};
  const Keys motions = {"velocity", "angular_velocity", "bullet", "can_sleep"};
  ignore(path, forces, desc.kind != BodyKind::kDynamic, "forces do not move this body, which is not dynamic");
  ignore(path, motions, desc.kind == BodyKind::kStatic, "a static body never moves");
  ignore(path, {"motion"}, desc.kind != BodyKind::kKinematic, "it is for a kinematic body");
  const bool has_path = desc.kind == BodyKind::kKinematic && desc.motion.kind != MotionDesc::Kind::kStill;
  ignore(path, {"velocity"}, has_path, "'motion' replaces it");
  if (body.fracture) {
    ignore(path, {"visual"}, true, "the cells are drawn");
    const std::string inner = path + ".fracture";
    ignore(inner, {"cells", "seed", "impact", "impact_radius"}, !body.fracture->desc.seeds.empty(),
           "'seeds' replaces it");
    ignore(inner, {"impact_radius"}, body.fracture->desc.seeds.empty() && !body.fracture->desc.impact,
           "it is for 'impact'");
  }
  ignore(path, {"section"}, desc.kind != BodyKind::kDynamic, "a bar is a dynamic body between two hooks");
  if (desc.kind != BodyKind::kDynamic) return;
  ignore(path, {"density"}, !body.parts.empty(), "its parts have their own");
  ignore(path, {"density"}, body.parts.empty() && desc.mass.has_value(), "'mass' replaces it");
}

void IgnoredKeys::check(const SceneRope& rope, const std::string& path) {
  const RopeDesc& desc = rope.desc;
  const bool is_material = desc.young_modulus.has_value();
  ignore(path, {"hook_point", "direction", "masses", "length_at_rest"}, !desc.points.empty(),
         "'points' replaces it");
  ignore(path, {"stiffness", "axial_stiffness", "stiffness_of", "bend_stiffness", "twist_stiffness"},
         is_material, "'young_modulus' replaces it");
  ignore(path, {"stiffness", "stiffness_of"}, !is_material && desc.axial_stiffness.has_value(),
         "'axial_stiffness' replaces it");
  ignore(path, {"stiffness_of"},
         !is_material && !desc.axial_stiffness.has_value() && desc.stiffness == kRigid, "the rope is rigid");
  ignore(path, {"poisson_ratio"}, !is_material, "it is for 'young_modulus'");
  ignore(path, {"bend_damping"}, !is_material && desc.bend_stiffness == Real(0),
         "there is no bend_stiffness");
  ignore(path, {"twist"}, !is_material && desc.twist_stiffness == Real(0), "there is no twist_stiffness");
  ignore(path, {"repulsion_range"}, desc.repulsion_strength == Real(0), "there is no repulsion_strength");
}

void IgnoredKeys::check(const SceneCloth& cloth, const std::string& path) {
  const ClothDesc& desc = cloth.desc;
  const Keys grid = {"columns", "rows", "corner", "column_direction", "row_direction", "width", "height"};
  ignore(path, grid, !cloth.mesh.empty(), "'mesh' replaces the grid");
  ignore(path, {"position", "rotation"}, cloth.mesh.empty(), "it is for a mesh; a grid has a 'corner'");
  ignore(path, {"areal_density"}, desc.total_mass.has_value(), "'total_mass' replaces it");
  ignore(path, {"bend_stiffness", "bend_damping"}, desc.bend == ClothDesc::Bend::kNone, "'bend' is \"none\"");
  ignore(path, {"tethers"}, desc.tethers.value_or(false) && cloth.pins.empty(),
         "there are no 'pins'; hooks do not count");
}

void IgnoredKeys::check(const SceneSolid& solid, const std::string& path) {
  const SolidDesc& desc = solid.desc;
  const bool is_matched = desc.elasticity == SolidDesc::Elasticity::kShapeMatching;
  ignore(path, {"cells", "size"}, !solid.mesh.empty(), "'mesh' replaces the box");
  ignore(path, {"cell"}, solid.mesh.empty(), "it is for a mesh; a box has 'cells'");
  ignore(path, {"cell"}, !solid.mesh.empty() && is_matched, "the points are the mesh's vertices");
  ignore(path, {"density"}, desc.total_mass.has_value(), "'total_mass' replaces it");
  ignore(path, {"young_modulus", "poisson_ratio", "damping"}, is_matched, "shape matching has 'match_hz'");
  ignore(path, {"match_hz", "match_damping_ratio"}, !is_matched, "it is for shape matching");
}

void IgnoredKeys::check(const SceneParticles& particles, const std::string& path) {
  ignore(path, {"direction", "damping"}, particles.desc.springs.empty(), "there are no springs");
}

void IgnoredKeys::check(const HookFreedom& freedom, const std::string& path) {
  ignore(path, {"limits", "motor"}, freedom.locked, "the freedom is locked");
  ignore(path + ".spring", {"stiffness", "damping"}, freedom.locked && freedom.spring != HookSpring{},
         "the freedom is locked");
}

void IgnoredKeys::check(const SceneHook& hook, const std::string& path) {
  const HookDesc& desc = hook.desc;
  const HookKind kind = desc.kind;
  const bool moves_one_way = kind == HookKind::kBall || kind == HookKind::kHinge ||
                             kind == HookKind::kSlider || kind == HookKind::kDistance ||
                             kind == HookKind::kWheel;
  ignore(path, {"limits", "spring", "motor"}, !moves_one_way, "this kind of hook has none");
  ignore(path + ".spring", {"target"}, kind == HookKind::kBall && desc.spring != HookSpring{},
         "a ball's spring is towards how things stood");
  ignore(path, {"cone"}, kind != HookKind::kBall, "it is for a ball");
  ignore(path, {"anchor_b", "section"}, kind != HookKind::kDistance, "it is for a distance");
  ignore(path, {"steering"}, kind != HookKind::kWheel, "it is for a wheel");
  ignore(path, {"freedoms"}, kind != HookKind::kSixDegrees, "it is for six_degrees");
  const bool has_axis =
      kind != HookKind::kFixed && kind != HookKind::kDistance && kind != HookKind::kRopeSlide;
  ignore(path, {"axis"}, !has_axis, "this kind of hook has none");
  ignore(path, {"second_axis"}, kind != HookKind::kWheel && kind != HookKind::kSixDegrees,
         "it is for a wheel or six_degrees");
  if (kind == HookKind::kWheel) check(desc.steering, path + ".steering");
  if (kind != HookKind::kSixDegrees) return;
  for (std::size_t i = 0; i < desc.freedoms.size(); ++i) {
    check(desc.freedoms[i], indexed(path + ".freedoms", i));
  }
}

void IgnoredKeys::check(const SceneObjects& objects, const std::string& prefix) {
  check_all(objects.bodies, prefix + "bodies");
  check_all(objects.ropes, prefix + "ropes");
  check_all(objects.cloths, prefix + "cloths");
  check_all(objects.solids, prefix + "solids");
  check_all(objects.particles, prefix + "particles");
  check_all(objects.hooks, prefix + "hooks");
}

void IgnoredKeys::check(const SceneCamera& camera) {
  ignore("camera", {"eye", "target"}, !camera.path.empty(), "'path' replaces it");
}

void IgnoredKeys::check(const SceneSky& sky) {
  ignore("sky", {"sun_direction", "sun_color"}, sky.sun == Real(0), "there is no sun");
}

void IgnoredKeys::check(const SceneLight& light, const std::string& path) {
  ignore(path, {"position"}, light.kind == SceneLight::Kind::kDirectional, "its light comes from far away");
  ignore(path, {"direction"}, light.kind == SceneLight::Kind::kPoint, "its light goes to all sides");
  ignore(path, {"inner_deg", "outer_deg"}, light.kind != SceneLight::Kind::kSpot, "it is for a spot");
}

void IgnoredKeys::check(const SceneExpectation& expectation, const std::string& path) {
  const bool has_tolerance =
      expectation.op == SceneExpectation::Op::kEqual || expectation.op == SceneExpectation::Op::kWithin;
  ignore(path, {"tolerance"}, !has_tolerance, "it is for \"==\" and \"within\"");
}

}  // namespace

std::vector<JsonError> find_ignored_keys(const Scene& scene, const JsonDocument& document) {
  IgnoredKeys ignored(document);
  for (const SceneMesh& mesh : scene.meshes) ignored.check(mesh);
  if (document.root.find("world") != nullptr) ignored.check(scene.world.wind, "world.wind");
  ignored.check(scene.objects, "");
  for (std::size_t i = 0; i < scene.timeline.size(); ++i) {
    const std::string path = indexed("timeline", i);
    ignored.check(scene.timeline[i].add, path + ".add.");
    if (scene.timeline[i].kind == SceneEvent::Kind::kWind) {
      ignored.check(scene.timeline[i].wind, path + ".wind");
    }
  }
  if (scene.camera) ignored.check(*scene.camera);
  if (document.root.find("sky") != nullptr) ignored.check(scene.sky);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) ignored.check(scene.lights[i], indexed("lights", i));
  for (std::size_t i = 0; i < scene.expect.size(); ++i) {
    ignored.check(scene.expect[i], indexed("expect", i));
  }
  return ignored.take();
}

}  // namespace hooke::io
