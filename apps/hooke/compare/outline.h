#pragma once

#include "hooke/compare/stage.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace hooke::app {

/// An Outline says how the watched object is drawn by a few points and lines.
struct Outline {
  std::vector<std::uint32_t> points;                           ///< Which points of the object are drawn.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> lines;  ///< Pairs of places in `points`.
  std::uint32_t watched = 0;                                   ///< Place of the watched point in `points`.
  std::size_t left_out = 0;                                    ///< How many points are not drawn.
};

/// Takes springs, segments or the grid of a cloth as lines. Of an object with very many points only some are
/// drawn, without lines.
Outline make_outline(const Stage& stage);

/// Returns how many frames each of so many runs may have, so that a page keeps its size.
std::uint64_t most_frames(const Outline& outline, std::size_t runs);

}  // namespace hooke::app
