#pragma once

#include "hooke/math.h"

#include <cstddef>

/// \file
/// Constants of the broad phase that decide cost. They change no result: pairs are those of tight boxes.
/// docs/tuning.md says how to try another value.

namespace hooke::collision {

// How much larger than its tight box the fat box of what moves is. Larger: boxes are searched for less often,
// but overlap more in vain.

/// Margin on every side, in mean sides of the box [ratio]. Chosen by hand; no measurement is recorded.
inline constexpr Real kFatMargin = Real(0.05);

/// Number of steps of the last motion that the box foresees, and the most of that in mean sides of the box
/// [ratio]. Chosen by hand; no measurement is recorded.
inline constexpr Real kFatForesight = Real(4);
inline constexpr Real kMostFatForesight = Real(0.75);

/// Mean side of a fat box over that of the tight one, above which it is made anew [ratio]: a box that shrank
/// or stopped would keep others searching in vain. A new fat box must fit. Chosen by hand; no measurement is
/// recorded.
inline constexpr Real kMostFatness = Real(2);
static_assert(Real(1) + Real(2) * kFatMargin + kMostFatForesight < kMostFatness, "a new fat box fits");

// When the tree is fitted or built anew.

/// All nodes are fitted once there is a change for so many leaves: a fit of all nodes costs about as much as
/// 16 moves of a leaf up its path.
inline constexpr std::size_t kLeavesPerChange = 16;

/// The tree is built anew once there is an insertion for so many leaves. Chosen by hand; no measurement is
/// recorded.
inline constexpr std::size_t kLeavesPerInsertion = 4;

/// Cost of a search over that of the tree when it was built, above which it is built anew [ratio]. Building
/// costs about ten times as much as fitting. Smaller: it does not pay. Larger: searches are longer. No
/// measurement of the value itself is recorded.
inline constexpr double kTreePoorness = 1.5;

// How pairs are sorted.

/// Fewest pairs that are sorted by digits; fewer are sorted by comparison. Chosen by hand; no measurement is
/// recorded.
inline constexpr std::size_t kFewestSortedByDigits = 512;

}  // namespace hooke::collision
