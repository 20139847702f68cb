#pragma once

#include "hooke/session/scene_document.h"

#include <cstdint>
#include <string>
#include <vector>

/// \file
/// What may be said about an object of a scene, from the scene format's schema: keys with their units, and
/// the values that a document gives them.

namespace hooke::app {

/// One key of an object of a scene.
struct SceneKey {
  enum class Type : std::uint8_t {
    kNumber,  ///< A number, or "rigid" where the format allows it.
    kVector,  ///< A few numbers.
    kBoolean,
    kWord,  ///< One of `words`.
    kText,
    kGroup,  ///< An object with keys of its own.
  };

  std::string path = {};  ///< As "ropes[0].total_mass".
  std::string key = {};
  std::string unit = {};
  std::string help = {};
  Type type = Type::kNumber;
  std::vector<std::string> words = {};
  std::string value = {};           ///< As JSON: what the document says, else the default; empty for none.
  bool said = false;                ///< Whether the document says it.
  std::vector<SceneKey> keys = {};  ///< Keys of a group.
};

/// Returns the keys of the object at a path such as "world", "ropes[0]" or "materials.rubber", without lists
/// of any length. A path that leads to nothing in the format has none.
std::vector<SceneKey> keys_of(const SceneDocument& document, const std::string& path);

}  // namespace hooke::app
