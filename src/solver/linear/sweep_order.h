#pragma once

#include <cstdint>

namespace hooke::solver {

/// Rows are solved one after the other, twice in a substep, and begin with the impulses of the substep
/// before. Let G give the part of the violation r that one sweep leaves. In the velocities u = J v,
///
///     r' = 2 G r - u,   u' = G r,   so that an eigenvalue g of G gives  mu^2 = 2 g mu - g,
///
/// which is stable for 0 <= g < 1 (|mu|^2 = g) and not for g < -1/3. A sweep always in the same order has
/// complex g, as far as -1, where many rows share one body: a hub with 60 arms flew apart. One sweep forward
/// and one backward have real g >= 0.
enum class SweepOrder : std::uint8_t { kForward, kBackward };

/// Calls visit(color) for 0 to count - 1, or for count - 1 to 0.
template <class Visit>
void for_each_color(int count, SweepOrder order, Visit&& visit) {
  for (int i = 0; i < count; ++i) visit(order == SweepOrder::kForward ? i : count - 1 - i);
}

}  // namespace hooke::solver
