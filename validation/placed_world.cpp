#include "validation/placed_world.h"

namespace hooke::check {

std::vector<DVec3> PlacedWorld::surface(SolidId id) const {
  std::vector<DVec3> points = world_.surface(id);
  for (DVec3& point : points) point = at_.own_point(point);
  return points;
}

DVec3 PlacedWorld::direction(BodyId id, DVec3 of_body) const {
  return own(rotate(world_.pose(id).rotation, vector_cast<Real>(of_body)));
}

std::vector<BodyContact> PlacedWorld::body_contacts() const {
  std::vector<BodyContact> contacts = world_.body_contacts();
  for (BodyContact& contact : contacts) {
    contact.point = at_.own_point(contact.point);
    contact.normal = vector_cast<Real>(own(contact.normal));
    contact.friction_force = vector_cast<Real>(own(contact.friction_force));
  }
  return contacts;
}

HookForce PlacedWorld::hook_force(HookId id) const {
  const HookForce force = world_.hook_force(id);
  return {.force = vector_cast<Real>(own(force.force)), .torque = vector_cast<Real>(own(force.torque))};
}

/// Angular momentum is about the origin of the case's frame.
Measurement PlacedWorld::measure() const {
  Measurement measured = world_.measure();
  measured.angular_momentum =
      at_.own_direction(measured.angular_momentum - cross(at_.position, measured.momentum));
  measured.momentum = at_.own_direction(measured.momentum);
  return measured;
}

}  // namespace hooke::check
