#pragma once

#include "hooke/session/session.h"

#include <cstddef>
#include <set>
#include <string>
#include <vector>

namespace hooke::app {

/// One line of the list of objects: an object, or the head of those of one array, "brick" of "brick[0]" and
/// so on.
struct ObjectRow {
  std::string name = {};    ///< Of the object, or of the array.
  std::size_t members = 0;  ///< Of the array; 0 for an object.
  bool is_open = false;     ///< Whether the lines of the array's members follow.
};

/// Returns the lines of a list in its order. Arrays are one line each, but for those in `open` and for that
/// of the object `selected`. A text to find that is not empty leaves the objects with it in their name, upper
/// or lower case, and no array.
[[nodiscard]] std::vector<ObjectRow> object_rows(const std::vector<const ListedObject*>& objects,
                                                 const std::string& find, const std::set<std::string>& open,
                                                 const std::string& selected);

}  // namespace hooke::app
