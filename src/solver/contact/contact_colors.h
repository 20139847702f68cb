#pragma once

#include "state/bodies.h"
#include "state/manifolds.h"

#include <cstdint>
#include <vector>

namespace hooke::solver {

/// Which manifolds are solved together: no two of a color share a body that moves.
struct ContactColors {
  struct Member {
    std::uint32_t manifold = 0;
    bool anchored = false;  ///< Only one of its bodies moves.
    state::ContactRoute route = state::ContactRoute::kSoft;
  };

  /// Color after color. In each color soft ones come first, then direct ones, then coupled ones; of these,
  /// pairs that both move come first, then more points before fewer, then the order of the manifolds.
  std::vector<Member> members;
  std::vector<int> begin = {0};     ///< Color c is [begin[c], begin[c + 1]). No color is empty.
  std::vector<std::uint8_t> moves;  ///< Whether contacts move a body, by body row.
  std::vector<std::uint64_t> used;  ///< Colors of a body, by body row.
  std::vector<int> color;           ///< Color of each manifold as taken; -1 if it has no rows.
  std::vector<int> next_slot;       ///< Where the next member of each kind goes.
};

/// Whether contacts move the body in `row`.
[[nodiscard]] bool is_moved(const state::Bodies& bodies, std::uint32_t row);

/// Whether the manifold has points that push, or may get some within the step, and a body that they move.
[[nodiscard]] bool has_contact_rows(const state::Manifold& manifold, const state::Bodies& bodies);

/// Takes the manifolds with rows in order. A manifold with two bodies that move takes
/// the lowest color free in both, below 56. One with a single such body takes the highest free color: it is
/// solved last and so holds best. A manifold that finds no free color is alone in its own, between the two.
/// Each call starts from nothing: colors depend on the manifolds alone.
void color_contacts(const std::vector<state::Manifold>& manifolds, const state::Bodies& bodies,
                    ContactColors& colors);

}  // namespace hooke::solver
