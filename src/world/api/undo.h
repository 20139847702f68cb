#pragma once

#include "state/tables.h"

#include <array>
#include <cstddef>

namespace hooke::world {

/// Removes what a call has appended to the tables if an exception or an Error ends the call early. The tables
/// of bodies need no Undo, because build::add_body makes room before it changes them.
class Undo {
 public:
  explicit Undo(state::Tables& tables);
  ~Undo();
  Undo(const Undo&) = delete;
  Undo& operator=(const Undo&) = delete;

  /// Keeps what was appended.
  void keep() { kept_ = true; }

 private:
  static constexpr std::size_t kMostLists = 64;

  state::Tables& tables_;
  std::array<std::size_t, kMostLists> size_ = {};  ///< Sizes at the start, in the order of for_each_list.
  bool kept_ = false;
};

}  // namespace hooke::world
