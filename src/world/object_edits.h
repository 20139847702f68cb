#pragma once

#include "hooke/id.h"
#include "hooke/result.h"

#include "state/tables.h"

#include <cstdint>
#include <optional>
#include <vector>

/// \file
/// Finding, removing, holding: the API's work on whole objects and single particles.

namespace hooke::world {

[[nodiscard]] Error stale(const char* what);
/// Of a force [N] or torque [N m], and with what was given for the same step.
[[nodiscard]] Result<void> check_force(const char* what, Vec3 force, Vec3 sum);

struct ParticleRow {
  std::uint32_t particle = 0;  ///< Row of the particle table.
  std::uint32_t object = 0;    ///< Row of the deformable.
};

/// Nothing for a stale id or an index beyond the object's points.
[[nodiscard]] std::optional<ParticleRow> find_particle(const state::Tables& tables, PointRef point);

/// Takes an object's ranges out of every table and moves what stands behind them.
void remove_object(state::Tables& tables, std::uint32_t row);

void pin_particle(state::Tables& tables, ParticleRow row, const MotionDesc& motion);
void unpin_particle(state::Tables& tables, ParticleRow row);

/// Ids that are made from now on say that they are of the World that has this mark.
void mark_ids(std::uint32_t mark, state::Tables& tables);

/// `from` into `to`; ids made since the snapshot become stale, and `to` keeps its number of workers. Where
/// there is not the memory, nothing is left in `to`.
void restore_tables(const state::Tables& from, state::Tables& to);

[[nodiscard]] BodyId id_of(const state::Tables& tables, std::uint32_t body);
/// The body of a collider, and which of its parts that is.
[[nodiscard]] BodyPart part_of(const state::Tables& tables, std::uint32_t collider);
/// Whether b's body was created before a's.
[[nodiscard]] bool is_swapped(const state::Tables& tables, const state::Manifold& manifold);

/// Wakes every body that is near one for which `is(row)`, before that goes or is moved by hand.
template <class Is>
void wake_neighbors(state::Tables& t, Is&& is) {
  for (const std::vector<state::Pair>* pairs : {&t.pairs.pair, &t.pairs.sleeping.pair}) {
    for (const state::Pair& pair : *pairs) {
      const std::uint32_t a = t.colliders.body[pair.collider_a];
      const std::uint32_t b = t.colliders.body[pair.collider_b];
      if (!is(a) && !is(b)) continue;
      for (const std::uint32_t near : {a, b}) state::wake(t.bodies, near);
    }
  }
}

/// Wakes every body: a force on all of them has changed.
void wake_all(state::Tables& tables);

/// Removes one row of a table whose rows know their slot; those behind it move up.
template <class IdType, class Entry>
bool remove_row(state::SlotTable<IdType>& slots, IdType id, std::vector<Entry>& table) {
  const std::uint32_t row = slots.find(id);
  if (row == slots.kNone) return false;
  table.erase(table.begin() + row);
  slots.move(id.slot, slots.kNone);
  for (std::uint32_t i = row; i < table.size(); ++i) slots.move(table[i].slot, i);
  return true;
}

}  // namespace hooke::world
