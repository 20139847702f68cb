/// This file measures snapshots. World::snapshot and World::restore are in world.cpp.

#include "hooke/world.h"

#include "world/world_data.h"

#include <cstddef>
#include <vector>

namespace hooke {

namespace {

/// Adds up the memory of lists [bytes].
class ByteCount {
 public:
  template <class T>
  void operator()(const std::vector<T>& list) {
    sum_ += list.size() * sizeof(T);
  }
  template <class Table>
  void add_columns(const Table& table) {
    Table::for_each_column(table, *this);
  }
  template <class... Lists>
  void add(const Lists&... lists) {
    ((*this)(lists), ...);
  }
  [[nodiscard]] std::size_t sum() const { return sum_; }

 private:
  std::size_t sum_ = 0;
};

std::size_t bytes_of(const state::Tables& t) {
  ByteCount count;
  count.add_columns(t.particles);
  count.add_columns(t.springs);
  count.add_columns(t.bends);
  count.add_columns(t.triangles);
  count.add_columns(t.segments);
  count.add_columns(t.tetrahedra);
  count.add_columns(t.contacts);
  count.add_columns(t.bodies);
  count.add_columns(t.colliders);
  const state::Pairs& pairs = t.pairs;
  count.add(t.objects, t.twists, t.element_contacts, t.rope_contacts, t.pins, t.touches, t.visits, t.hooks,
            t.yielding, t.held_hooks);
  count.add(pairs.pair, pairs.manifold, pairs.coupled, pairs.seen, pairs.sleeping.pair,
            pairs.sleeping.manifold);
  for (const state::Hook& hook : t.hooks) count.add(hook.inside);
  return sizeof(state::Tables) + count.sum();
}

}  // namespace

std::size_t Snapshot::bytes() const {
  return data_ ? bytes_of(data_->tables) : 0;
}

}  // namespace hooke
