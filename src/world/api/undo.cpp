#include "world/api/undo.h"

#include "base/assert.h"

#include <type_traits>
#include <vector>

namespace hooke::world {

namespace {

/// Calls `visit(list)` for each list that calls of the API append to.
template <class Visit>
void for_each_list(state::Tables& t, Visit&& visit) {
  const auto columns_of = [&](auto& table) {
    std::remove_reference_t<decltype(table)>::for_each_column(table, visit);
  };
  columns_of(t.particles);
  columns_of(t.springs);
  columns_of(t.bends);
  columns_of(t.triangles);
  columns_of(t.segments);
  columns_of(t.tetrahedra);
  const auto each = [&](auto&... lists) { (visit(lists), ...); };
  each(t.objects, t.pins, t.hooks, t.meshes, t.hulls, t.convex_parts, t.fields, t.force_laws);
  each(t.mesh_slots, t.hook_slots, t.rope_slots, t.cloth_slots, t.solid_slots, t.particles_slots,
       t.field_slots, t.force_law_slots);
}

template <class T>
void shorten(std::vector<T>& list, std::size_t size) {
  list.erase(list.begin() + static_cast<std::ptrdiff_t>(size), list.end());
}

template <class IdType>
void shorten(state::SlotTable<IdType>& slots, std::size_t size) {
  slots.shorten(size);
}

}  // namespace

Undo::Undo(state::Tables& tables) : tables_(tables) {
  std::size_t i = 0;
  for_each_list(tables_, [&](const auto& list) {
    HOOKE_ASSERT(i < size_.size());
    size_[i++] = list.size();
  });
}

Undo::~Undo() {
  if (kept_) return;
  std::size_t i = 0;
  for_each_list(tables_, [&](auto& list) {
    const std::size_t size = size_[i++];
    if (list.size() <= size) return;
    shorten(list, size);
    ++tables_.revision;
    ++tables_.hook_revision;
  });
}

}  // namespace hooke::world
