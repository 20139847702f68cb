/// This file reads bodies that yield (BodyDesc::yields): what they are now, and the surface that they have.

#include "hooke/world.h"

#include "math/rotation.h"
#include "world/claim.h"
#include "world/object_edits.h"

namespace hooke {

namespace {

using state::Tables;
using state::Yielding;

const Yielding* find_yielding(const Tables& t, BodyId id) {
  const std::uint32_t body = t.body_slots.find(id);
  if (body == Tables::kNoRow) return nullptr;
  const std::uint32_t row = state::yielding_row(t, body);
  return row == Tables::kNoRow ? nullptr : &t.yielding[row];
}

/// Where a rigid body has the vertices of its skin [m].
std::vector<DVec3> rigid_surface(const Yielding& yielding, const Tables& t) {
  const Quaternion<double> rotation = math::in_double(t.bodies.rotation[yielding.body]);
  std::vector<DVec3> places;
  for (const state::Skin::Anchor& anchor : yielding.form->skin->vertices) {
    DVec3 sum;
    for (std::size_t k = 0; k < anchor.points.size(); ++k) {
      const Vec3 point = yielding.form->points[anchor.points[k]];
      sum += static_cast<double>(anchor.weights[k]) * vector_cast<double>(point);
    }
    places.push_back(t.bodies.center[yielding.body] + rotate(rotation, sum));
  }
  return places;
}

}  // namespace

SolidId World::soft_form(BodyId id) const {
  const world::Reading reading(data_);
  const Yielding* yielding = find_yielding(reading.tables(), id);
  if (yielding == nullptr || !yielding->is_soft()) return {};
  return reading.tables().solid_slots.id_of(yielding->solid);
}

BodyId World::body_of(SolidId id) const {
  const world::Reading reading(data_);
  const Tables& t = reading.tables();
  if (t.solid_slots.find(id) == Tables::kNoRow) return {};
  for (const Yielding& yielding : t.yielding) {
    if (yielding.solid == id.slot) return world::id_of(t, yielding.body);
  }
  return {};
}

BodyId World::body_of(PointRef point) const {
  if (point.kind != PointRef::Kind::kSolid) return {};
  return body_of(SolidId{point.slot, point.generation, point.world});
}

std::vector<DVec3> World::surface(BodyId id) const {
  const world::Reading reading(data_);
  const Yielding* yielding = find_yielding(reading.tables(), id);
  if (yielding == nullptr) return {};
  return yielding->is_soft() ? surface(soft_form(id)) : rigid_surface(*yielding, reading.tables());
}

std::vector<std::array<std::uint32_t, 3>> World::triangles(BodyId id) const {
  const world::Reading reading(data_);
  const Yielding* yielding = find_yielding(reading.tables(), id);
  if (yielding == nullptr) return {};
  return yielding->is_soft() ? triangles(soft_form(id)) : yielding->form->skin->triangles;
}

bool World::is_reshaped(BodyId id) const {
  const world::Reading reading(data_);
  const Yielding* yielding = find_yielding(reading.tables(), id);
  return yielding != nullptr && (yielding->reshaped || yielding->is_soft());
}

}  // namespace hooke
