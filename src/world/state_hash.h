#pragma once

#include "state/tables.h"

#include <cstdint>

namespace hooke::world {

/// Of everything that the bits of later steps depend upon, but for the user's own code; see
/// World::state_hash.
[[nodiscard]] std::uint64_t hash_of(const state::Tables& tables);

/// Of what a mesh is.
[[nodiscard]] std::uint64_t hash_of(const MeshDesc& mesh);

}  // namespace hooke::world
