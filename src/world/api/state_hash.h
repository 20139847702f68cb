#pragma once

#include "state/tables.h"

#include <cstdint>

namespace hooke::world {

/// Hash of everything that the bits of later steps depend upon, except the functions of force laws; see
/// World::state_hash.
[[nodiscard]] std::uint64_t hash_of(const state::Tables& tables);

/// Hash of a mesh: its positions and triangles.
[[nodiscard]] std::uint64_t hash_of(const MeshDesc& mesh);

}  // namespace hooke::world
