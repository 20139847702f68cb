#pragma once

#include "state/tables.h"

#include <array>
#include <cstddef>

namespace hooke::world {

/// For a call that appends to the tables: takes what it appended out again where it does not come to its end,
/// for want of memory. Bodies are not among it: build::add_body makes room before it changes anything.
class Undo {
 public:
  explicit Undo(state::Tables& tables);
  ~Undo();
  Undo(const Undo&) = delete;
  Undo& operator=(const Undo&) = delete;

  /// What was appended stays.
  void keep() { kept_ = true; }

 private:
  static constexpr std::size_t kMostLists = 64;

  state::Tables& tables_;
  std::array<std::size_t, kMostLists> size_ = {};  ///< Of each list, in the order of for_each_list.
  bool kept_ = false;
};

}  // namespace hooke::world
