#pragma once

#include "state/bodies.h"
#include "state/hooks.h"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace hooke::solver {

/// Hooks that are solved at the same time: those of one color share no body that forces move.
struct HookColors {
  std::vector<std::uint32_t>& hooks;  ///< Rows, color after color; in each, in their given order.
  std::vector<int>& begin;            ///< Color c is [begin[c], begin[c + 1]). No color is empty.
};

/// Memory of color_hooks.
struct ColorScratch {
  std::vector<std::uint64_t> used;  ///< Colors in use at each body.
  std::vector<std::pair<int, std::uint32_t>> colored;
};

/// Whether a hook holds a body that moves.
[[nodiscard]] bool is_awake(const state::Hook& hook, const state::Bodies& bodies);

/// Replaces `colors`. Takes hooks in the given order; each gets the first color that is free in both bodies.
/// Where a body has more than 64, each of the rest has a color of its own.
void color_hooks(std::span<const std::uint32_t> hook_rows, const std::vector<state::Hook>& hooks,
                 const state::Bodies& bodies, ColorScratch& scratch, HookColors colors);

}  // namespace hooke::solver
