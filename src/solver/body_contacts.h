#pragma once

#include "hooke/desc.h"
#include "hooke/math.h"

#include "parallel/thread_pool.h"
#include "state/bodies.h"
#include "state/manifolds.h"

#include <cstdint>
#include <vector>

/// \file
/// Contacts between bodies: soft rows at velocity level, in colors, 16 manifolds to a block.
///
/// The order of calls in a step:
///   color_body_contacts, prepare_body_contacts                     once
///   [accelerate_bodies, solve_body_contacts x sweeps, move_bodies,
///    relax_body_contacts] x substeps
///   restitute_body_contacts, store_body_contacts                   once

namespace hooke::solver {

inline constexpr int kContactLanes = 16;

/// Rows of 16 manifolds of one color: no two of them share a body that moves. Lanes without a manifold and
/// points that a manifold lacks have zero masses and change nothing.
struct ContactBlock;

struct BodyContacts {
  std::vector<ContactBlock> blocks;
  std::vector<int> color_begin = {0};      ///< Blocks of color c are [color_begin[c], color_begin[c + 1]).
  std::vector<std::uint32_t> manifold_of;  ///< Row of each lane's manifold; kNoManifold where there is none.
  static constexpr std::uint32_t kNoManifold = 0xFFFFFFFF;

  BodyContacts();
  ~BodyContacts();
  BodyContacts(const BodyContacts&) = delete;
  BodyContacts& operator=(const BodyContacts&) = delete;

  [[nodiscard]] int color_count() const { return static_cast<int>(color_begin.size()) - 1; }
};

}  // namespace hooke::solver
