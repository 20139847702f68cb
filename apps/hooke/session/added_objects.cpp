#include "hooke/session/added_objects.h"

#include <algorithm>

namespace hooke::app {

namespace {

void move_places(std::vector<ConnectionPointDesc>& points, DVec3 offset) {
  for (ConnectionPointDesc& point : points) point.position += offset;
}

/// Each of these puts an object that was copied from a scene somewhere else.
void put(SceneBody& body, DVec3 place) {
  body.desc.kind = BodyKind::kDynamic;
  body.desc.position = place;
  body.desc.velocity = {};
  body.desc.angular_velocity = {};
  body.desc.motion = {};
}

void put(SceneRope& rope, DVec3 place) {
  RopeDesc& desc = rope.desc;
  const DVec3 along = normalize(vector_cast<double>(desc.direction));
  DVec3 middle = desc.hook_point + 0.5 * static_cast<double>(desc.length_at_rest) * along;
  if (!desc.points.empty()) {
    middle = {};
    for (const DVec3& point : desc.points) middle += 1.0 / static_cast<double>(desc.points.size()) * point;
  }
  const DVec3 offset = place - middle;
  desc.hook_point += offset;
  for (DVec3& point : desc.points) point += offset;
  move_places(desc.connection_points, offset);
  desc.velocity = {};
  rope.pins.clear();
}

void put(SceneCloth& cloth, DVec3 place) {
  ClothDesc& desc = cloth.desc;
  if (cloth.mesh.empty()) {
    const DVec3 middle =
        desc.corner +
        0.5 * static_cast<double>(desc.width) * normalize(vector_cast<double>(desc.column_direction)) +
        0.5 * static_cast<double>(desc.height) * normalize(vector_cast<double>(desc.row_direction));
    desc.corner += place - middle;
    move_places(desc.connection_points, place - middle);
  }
  desc.position = place;
  desc.velocity = {};
  cloth.pins.clear();
}

void put(SceneSolid& solid, DVec3 place) {
  solid.desc.position = place;
  solid.desc.velocity = {};
  solid.pins.clear();
}

void put(SceneParticles& particles, DVec3 place) {
  std::vector<ParticleDesc>& all = particles.desc.particles;
  DVec3 middle;
  for (const ParticleDesc& one : all) middle += 1.0 / static_cast<double>(all.size()) * one.position;
  for (ParticleDesc& one : all) one.position += place - middle;
  move_places(particles.desc.connection_points, place - middle);
  particles.pins.clear();
}

bool can_be_dropped(const SceneBody& body) {
  return body.desc.shape.kind != ShapeKind::kHalfSpace && !body.desc.sensor;
}
template <class Object>
bool can_be_dropped(const Object& /*object*/) {
  return true;
}

/// Calls visit(list, member) for each list of objects that may be dropped.
template <class Visit>
void visit_lists(const SceneObjects& objects, Visit&& visit) {
  visit(objects.bodies, &SceneObjects::bodies);
  visit(objects.ropes, &SceneObjects::ropes);
  visit(objects.cloths, &SceneObjects::cloths);
  visit(objects.solids, &SceneObjects::solids);
  visit(objects.particles, &SceneObjects::particles);
}

}  // namespace

std::vector<std::string> names_to_drop(const Scene& scene) {
  std::vector<std::string> names;
  visit_lists(scene.objects, [&](const auto& list, auto /*member*/) {
    for (const auto& object : list) {
      if (can_be_dropped(object) && !object.tag.name.empty()) names.push_back(object.tag.name);
    }
  });
  return names;
}

std::optional<SceneObjects> copy_of(const Scene& scene, const std::string& name, DVec3 place,
                                    const std::string& new_name) {
  std::optional<SceneObjects> made;
  visit_lists(scene.objects, [&](const auto& list, auto member) {
    for (const auto& object : list) {
      if (made || object.tag.name != name || !can_be_dropped(object)) continue;
      auto copy = object;
      put(copy, place);
      copy.tag.name = new_name;
      copy.tag.array = {};
      made.emplace();
      ((*made).*member).push_back(std::move(copy));
    }
  });
  return made;
}

}  // namespace hooke::app
