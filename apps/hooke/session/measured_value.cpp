#include "hooke/session/measured_value.h"

#include <algorithm>
#include <cmath>

namespace hooke::app {

namespace {

using Values = std::vector<MeasuredValue>;

void add_vector(Values& values, const std::string& name, const std::string& unit, DVec3 vector) {
  values.push_back({name + " x", unit, vector.x});
  values.push_back({name + " y", unit, vector.y});
  values.push_back({name + " z", unit, vector.z});
}

void add_body(Values& values, const World& world, BodyId body) {
  values.push_back({"mass", "kg", static_cast<double>(world.mass(body))});
  add_vector(values, "center", "m", world.center_of_mass(body));
  const Vec3 velocity = world.velocity(body);
  add_vector(values, "velocity", "m/s", vector_cast<double>(velocity));
  values.push_back({"speed", "m/s", static_cast<double>(length(velocity))});
  values.push_back({"spin", "rad/s", static_cast<double>(length(world.angular_velocity(body)))});
  values.push_back({"kinetic energy", "J", world.energy(body).kinetic});
  double pressed = 0;
  for (const BodyContact& contact : world.body_contacts(body))
    pressed += static_cast<double>(contact.normal_force);
  values.push_back({"force of bodies", "N", pressed});
  // Known where the body or the deformable has reports_contacts, as every body of a session has.
  double soft = 0;
  for (const DeformableContact& contact : world.deformable_contacts(body))
    soft += static_cast<double>(contact.normal_force);
  values.push_back({"force of ropes, cloths and solids", "N", soft});
  values.push_back({"asleep", "", world.asleep(body) ? 1.0 : 0.0});
}

/// Adds what all objects of points have: where their middle is, and how fast it moves.
void add_points(Values& values, const World& world, const SceneObject& object) {
  const PointView points = positions_of(world, object);
  const PointView velocities = velocities_of(world, object);
  if (points.empty()) return;
  DVec3 middle;
  DVec3 velocity;
  double fastest = 0;
  const double share = 1 / static_cast<double>(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    middle += share * points[i];
    velocity += share * velocities[i];
    fastest = std::max(fastest, length(velocities[i]));
  }
  add_vector(values, "middle", "m", middle);
  add_vector(values, "mean velocity", "m/s", velocity);
  values.push_back({"largest speed", "m/s", fastest});
}

void add_rope(Values& values, const World& world, const SceneObject& object) {
  values.push_back({"mass", "kg", static_cast<double>(world.mass(object.rope))});
  const PointView points = positions_of(world, object);
  double now = 0;
  for (std::size_t i = 1; i < points.size(); ++i) now += length(points[i] - points[i - 1]);
  values.push_back({"length", "m", now});
  if (object.rest_length > 0) values.push_back({"extension", "%", 100 * (now / object.rest_length - 1)});
  double least = 0;
  double most = 0;
  for (const Real tension : world.tensions(object.rope)) {
    least = std::min(least, static_cast<double>(tension));
    most = std::max(most, static_cast<double>(tension));
  }
  values.push_back({"largest tension", "N", most});
  values.push_back({"largest thrust", "N", 0 - least});
  if (!points.empty()) add_vector(values, "end", "m", points[points.size() - 1]);
}

void add_hook(Values& values, const World& world, const SceneObject& object) {
  const HookForce force = world.hook_force(object.hook);
  values.push_back({"force", "N", static_cast<double>(length(force.force))});
  values.push_back({"torque", "N m", static_cast<double>(length(force.torque))});
  values.push_back({"gap", "mm", 1000 * static_cast<double>(world.hook_gap(object.hook))});
  const bool turns = object.hook_kind == HookKind::kHinge;
  values.push_back(
      {turns ? "angle" : "way", turns ? "rad" : "m", static_cast<double>(world.hook_value(object.hook))});
  values.push_back({"broken", "", object.broken ? 1.0 : 0.0});
}

Values measure_world(const World& world) {
  const Measurement all = world.measure();
  Values values = {{"kinetic energy", "J", all.energy.kinetic},
                   {"potential energy", "J", all.energy.potential},
                   {"elastic energy", "J", all.energy.elastic},
                   {"energy", "J", all.energy.total()}};
  add_vector(values, "momentum", "kg m/s", all.momentum);
  add_vector(values, "angular momentum", "kg m^2/s", all.angular_momentum);
  values.push_back({"largest stretch", "%", 100 * all.largest_stretch});
  values.push_back({"largest overlap", "mm", 1000 * all.largest_penetration});
  values.push_back({"largest gap", "mm", 1000 * all.largest_gap});
  return values;
}

}  // namespace

std::vector<MeasuredValue> measure(const Simulation& simulation, std::string_view name) {
  const World& world = simulation.world();
  if (name.empty()) return measure_world(world);
  const SceneObject* object = simulation.find(name);
  Values values;
  if (object == nullptr) return values;
  switch (object->kind) {
    case SceneObject::Kind::kBody:
      add_body(values, world, object->body);
      break;
    case SceneObject::Kind::kRope:
      add_rope(values, world, *object);
      break;
    case SceneObject::Kind::kCloth:
      values.push_back({"mass", "kg", static_cast<double>(world.mass(object->cloth))});
      values.push_back({"gas pressure", "Pa", static_cast<double>(world.pressure(object->cloth))});
      break;
    case SceneObject::Kind::kSolid:
      values.push_back({"mass", "kg", static_cast<double>(world.mass(object->solid))});
      values.push_back({"volume", "l", 1000 * world.volume(object->solid)});
      break;
    case SceneObject::Kind::kParticles:
      values.push_back({"mass", "kg", static_cast<double>(world.mass(object->particles))});
      break;
    case SceneObject::Kind::kField:
      break;
    case SceneObject::Kind::kHook:
      add_hook(values, world, *object);
      break;
  }
  add_points(values, world, *object);
  return values;
}

}  // namespace hooke::app
