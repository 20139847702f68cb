#pragma once

#include "hooke/desc.h"
#include "hooke/event.h"

#include "state/bodies.h"
#include "state/colliders.h"
#include "state/contacts.h"
#include "state/hooks.h"
#include "state/manifolds.h"
#include "state/mesh.h"
#include "state/objects.h"
#include "state/particles.h"
#include "state/slot_table.h"
#include "state/springs.h"
#include "state/tetrahedra.h"
#include "state/twists.h"
#include "state/yielding.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace hooke::state {

/// Everything of a World that a copy must hold. A snapshot copies the tables, a restoration assigns them, and
/// the state hash walks over them.
struct Tables {
  static constexpr std::uint32_t kNoRow = 0xFFFFFFFF;

  WorldDesc desc;
  double time = 0.0;          ///< [s]
  double body_substep = 0.0;  ///< Length of the last substep of bodies [s]; 0 before the first step.
  double substep = 0.0;       ///< Length of the last substep of particles [s]; 0 before the first step.
  std::uint64_t step_count = 0;
  std::uint64_t revision = 0;  ///< Grows when rows are added or removed or change what they join; derived
                               ///< tables follow. Deformable::revision says which objects changed.

  std::vector<Deformable> objects;  ///< In order of creation.
  Particles particles;
  Springs springs;
  Bends bends;
  Triangles triangles;
  Segments segments;
  Tetrahedra tetrahedra;
  std::vector<TwistSpan> twists;  ///< In order of ropes, then along each rope.
  Contacts contacts;
  std::vector<ElementContact> element_contacts;
  std::vector<RopeContact> rope_contacts;
  std::vector<Pin> pins;  ///< In order of particle.
  Bodies bodies;
  Colliders colliders;
  Pairs pairs;
  bool any_reports = false;           ///< Some body was added that asks for contacts, hits or visitors.
  std::vector<ContactEvent> touches;  ///< Contacts of the last step, of bodies that ask for them; in order of
                                      ///< creation.
  bool any_deformable_reports = false;  ///< Some deformable was added that asks for contacts or hits.
  std::vector<DeformableContactEvent> deformable_touches;  ///< Contacts of deformables in the last step, of
                                                           ///< those that ask for them; in order.
  std::vector<SensorEvent> visits;           ///< Lists who is in which sensor; in order of creation.
  std::vector<Hook> hooks;                   ///< In order of creation.
  std::vector<Yielding> yielding;            ///< Bodies that may become soft; in order of creation.
  std::vector<HeldHook> held_hooks;          ///< Hooks of those that are soft.
  std::uint64_t hook_revision = 0;           ///< Grows when hooks are added or removed or change their rows.
  std::vector<std::uint32_t> moving_bodies;  ///< Rows of bodies that are not static, in ascending order.
  std::vector<std::uint32_t> free_bodies;    ///< Holes of the body table; the last is filled first.
  std::vector<Rows> free_colliders;          ///< Holes of the collider table.
  std::vector<std::shared_ptr<const Mesh>> meshes;  ///< By slot; null once removed.
  /// Convex hulls of the points of the same meshes; null until a body asks for one.
  std::vector<std::shared_ptr<const geometry::ConvexHull>> hulls;
  /// Convex parts of the same meshes; empty until a dynamic body asks for them.
  std::vector<std::vector<std::shared_ptr<const geometry::ConvexHull>>> convex_parts;
  std::vector<Field> fields;
  std::vector<ForceLawEntry> force_laws;
  bool any_force = false;  ///< Some particle has an external force for the coming step.

  SlotTable<MeshId> mesh_slots;
  SlotTable<BodyId> body_slots;
  SlotTable<HookId> hook_slots;
  SlotTable<RopeId> rope_slots;
  SlotTable<ClothId> cloth_slots;
  SlotTable<SolidId> solid_slots;
  SlotTable<ParticlesId> particles_slots;
  SlotTable<FieldId> field_slots;
  SlotTable<ForceLawId> force_law_slots;
};

/// Notes that the rows of an object, or what they join, have changed: what is derived from them is made anew.
inline void note_change(Tables& t, Deformable& object) {
  object.revision = ++t.revision;
}

/// Notes the same of every object.
inline void note_change_of_all(Tables& t) {
  ++t.revision;
  for (Deformable& object : t.objects) note_change(t, object);
}

/// The row of the object that has this point; Tables::kNoRow for a stale or null reference.
inline std::uint32_t object_row(const Tables& t, PointRef point) {
  switch (point.kind) {
    case PointRef::Kind::kRope:
      return t.rope_slots.find({point.slot, point.generation, point.world});
    case PointRef::Kind::kCloth:
      return t.cloth_slots.find({point.slot, point.generation, point.world});
    case PointRef::Kind::kSolid:
      return t.solid_slots.find({point.slot, point.generation, point.world});
    case PointRef::Kind::kParticles:
      return t.particles_slots.find({point.slot, point.generation, point.world});
    case PointRef::Kind::kNone:
      break;
  }
  return Tables::kNoRow;
}

/// The row of Tables::yielding of a body; Tables::kNoRow for a body that does not yield.
inline std::uint32_t yielding_row(const Tables& t, std::uint32_t body) {
  for (std::uint32_t i = 0; i < t.yielding.size(); ++i) {
    if (t.yielding[i].body == body) return i;
  }
  return Tables::kNoRow;
}

/// The row of the solid that a body is now; Tables::kNoRow if it is rigid.
inline std::uint32_t soft_object(const Tables& t, const Yielding& yielding) {
  return yielding.is_soft() ? t.solid_slots.find(t.solid_slots.id_of(yielding.solid)) : Tables::kNoRow;
}

}  // namespace hooke::state
