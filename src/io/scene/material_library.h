#pragma once

#include "io/json/json_node.h"

#include <string>

/// \file
/// The materials that come with the engine, from the files of the folder `materials`, which are part of the
/// program.

namespace hooke::io {

/// Gives a scene that was read what it takes from the library, in the tree of its file:
/// - Materials that it names but does not say are added to its `materials`, and what a material with the key
/// `like`
///   leaves out is taken from there.
/// - Objects get the density, stiffness and size of their material, unless they say them.
/// - Pairs of the library are added to `material_pairs`, unless the scene says them or one of the two
/// frictions.
///
/// New nodes stand where the name of the material stands, so that errors lead there.
void take_from_library(JsonNode& root);

/// Returns ", did you mean 'silk'?" if a name of the library is near, and otherwise all names of the library.
[[nodiscard]] std::string library_hint(const std::string& name);

/// Tells whether the library has a material of that name.
[[nodiscard]] bool is_in_library(const std::string& name);

/// The files of the folder `materials`; the build writes this function.
struct MaterialTexts {
  const char* solids;
  const char* sheets;
  const char* ropes;
  const char* pairs;
};
[[nodiscard]] MaterialTexts material_texts();

}  // namespace hooke::io
