#pragma once

#include "base/assert.h"
#include "base/make_room.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace hooke::state {

/// Maps ids to dense rows. Slots only grow. The generation of new slots rises when a snapshot is restored, so
/// that an id made between the snapshot and its restoration never means a later object. A snapshot may be
/// restored in another World, where ids of the first World keep their meaning.
template <class IdType>
class SlotTable {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  /// Makes the id of a new object that lives in `row`.
  IdType add(std::uint32_t row) {
    entries_.push_back({row, generation_, world_});
    return id_of(static_cast<std::uint32_t>(entries_.size()));
  }

  /// Returns the row, or kNone for a null, stale or foreign id.
  [[nodiscard]] std::uint32_t find(IdType id) const {
    if (id.slot == 0 || id.slot > entries_.size()) return kNone;
    const Entry& entry = entries_[id.slot - 1];
    const bool is_same = entry.generation == id.generation && (entry.world == id.world || id.world == 0);
    return is_same ? entry.row : kNone;
  }

  /// Returns the id that has this slot.
  [[nodiscard]] IdType id_of(std::uint32_t slot) const {
    HOOKE_ASSERT(slot > 0 && slot <= entries_.size());
    const Entry& entry = entries_[slot - 1];
    return {.slot = slot, .generation = entry.generation, .world = entry.world};
  }

  [[nodiscard]] std::size_t size() const { return entries_.size(); }
  /// Makes room for one more slot.
  void make_room() { base::make_room(entries_); }
  /// Removes the slots after the first `size`, as though they had never been.
  void shorten(std::size_t size) {
    HOOKE_ASSERT(size <= entries_.size());
    entries_.resize(size);
  }

  void move(std::uint32_t slot, std::uint32_t row) {
    HOOKE_ASSERT(slot > 0 && slot <= entries_.size());
    entries_[slot - 1].row = row;
  }

  [[nodiscard]] std::uint32_t generation() const { return generation_; }
  void set_generation(std::uint32_t generation) { generation_ = generation; }

  /// The World of this table; ids that are made from now on contain it.
  [[nodiscard]] std::uint32_t world() const { return world_; }
  void set_world(std::uint32_t world) { world_ = world; }

 private:
  struct Entry {
    std::uint32_t row = 0;
    std::uint32_t generation = 0;
    std::uint32_t world = 0;
  };
  std::vector<Entry> entries_;
  std::uint32_t generation_ = 1;
  std::uint32_t world_ = 0;
};

}  // namespace hooke::state
