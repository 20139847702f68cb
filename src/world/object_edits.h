#pragma once

#include "hooke/id.h"
#include "hooke/result.h"

#include "state/tables.h"

#include <cstdint>
#include <optional>
#include <vector>

/// \file
/// These functions do the API's work on whole objects and on single particles: they find, remove, pin and
/// wake.

namespace hooke::world {

[[nodiscard]] Error stale(const char* what);
/// Checks a force [N] or torque [N m], alone and in sum with what was given for the same step.
[[nodiscard]] Result<void> check_force(const char* what, Vec3 force, Vec3 sum);

struct ParticleRow {
  std::uint32_t particle = 0;  ///< Row of the particle table.
  std::uint32_t object = 0;    ///< Row of the deformable.
};

/// Finds the rows of a point; nothing for a stale id or an index beyond the object's points.
[[nodiscard]] std::optional<ParticleRow> find_particle(const state::Tables& tables, PointRef point);

/// Removes an object with its hooks and all its rows. The rows behind them move up.
void remove_object(state::Tables& tables, std::uint32_t row);

void pin_particle(state::Tables& tables, ParticleRow row, const MotionDesc& motion);
void unpin_particle(state::Tables& tables, ParticleRow row);

/// Marks the ids that are made from now on as those of the World with this mark.
void mark_ids(std::uint32_t mark, state::Tables& tables);

/// Assigns `from` to `to`. Ids that were made since the snapshot become stale, and `to` keeps its number of
/// workers. If memory runs out, `to` is left empty and the exception passes on.
void restore_tables(const state::Tables& from, state::Tables& to);

[[nodiscard]] BodyId id_of(const state::Tables& tables, std::uint32_t body);
/// The id of an object, as that of its point `index`.
[[nodiscard]] PointRef point_of(const state::Tables& tables, const state::Deformable& object,
                                std::uint32_t index);
/// Returns the body of a collider, and the index of the collider among the body's parts.
[[nodiscard]] BodyPart part_of(const state::Tables& tables, std::uint32_t collider);
/// Whether the body of collider b was created before that of collider a.
[[nodiscard]] bool is_swapped(const state::Tables& tables, const state::Manifold& manifold);

/// Wakes all bodies that have a pair with one for which `is(row)` is true. It is called before that one is
/// removed, or when it is placed by hand.
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

/// Wakes every body, because a force on all of them has changed.
void wake_all(state::Tables& tables);

/// Removes one row of a table whose rows contain their slots; the rows behind it move up.
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
