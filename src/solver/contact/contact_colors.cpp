#include "solver/contact/contact_colors.h"

#include "base/assert.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace hooke::solver {

namespace {

using state::Manifold;

constexpr int kPairColors = 56;
constexpr int kColors = 64;  // bits of a mask; manifolds that find none free are numbered from here on

void find_moving(const state::Bodies& bodies, std::vector<std::uint8_t>& moves) {
  moves.resize(bodies.motion.size());
  for (std::uint32_t i = 0; i < moves.size(); ++i) moves[i] = is_moved(bodies, i) ? 1 : 0;
}

/// Takes the color of one manifold and marks it as used by its bodies that move; kColors if none is free.
int take_color(const Manifold& m, ContactColors& colors) {
  const bool moves_a = colors.moves[m.body_a] != 0;
  const bool moves_b = colors.moves[m.body_b] != 0;
  HOOKE_ASSERT((moves_a || moves_b) && m.body_a != m.body_b);
  std::uint64_t& a = colors.used[moves_a ? m.body_a : m.body_b];
  std::uint64_t& b = colors.used[moves_b ? m.body_b : m.body_a];
  const std::uint64_t free = ~(a | b);
  int color = kColors;
  if (moves_a && moves_b) {
    const int lowest = std::countr_zero(free);
    color = lowest < kPairColors ? lowest : kColors;
  } else if (free != 0) {
    color = kColors - 1 - std::countl_zero(free);
  }
  if (color == kColors) return color;
  const std::uint64_t bit = std::uint64_t{1} << color;
  a |= bit;
  b |= bit;
  return color;
}

/// Whether the manifold has rows of its own. Its way says it, which costs less than to ask its bodies again.
bool is_colored(const Manifold& m) {
  return m.route != state::ContactRoute::kNone;
}

/// Takes the colors of all manifolds. Returns how many of these are alone in their own.
int take_colors(const std::vector<Manifold>& manifolds, const state::Bodies& bodies, ContactColors& colors) {
  colors.used.assign(bodies.motion.size(), 0);
  colors.color.resize(manifolds.size());
  int lone = 0;
  for (std::size_t i = 0; i < manifolds.size(); ++i) {
    HOOKE_ASSERT(is_colored(manifolds[i]) == has_contact_rows(manifolds[i], bodies));
    colors.color[i] = is_colored(manifolds[i]) ? take_color(manifolds[i], colors) : -1;
    if (colors.color[i] == kColors) colors.color[i] += lone++;
  }
  return lone;
}

/// The order of the members: by color, with lone manifolds between the two kinds of colors, then by kind.
struct MemberOrder {
  static constexpr int kKinds = 6 * Manifold::kMaxPoints;  ///< Number of kinds of members in a color.

  const std::vector<std::uint8_t>& moves;  ///< As ContactColors::moves.
  int lone = 0;                            ///< Number of manifolds that are alone in their color.

  [[nodiscard]] bool is_anchored(const Manifold& m) const {
    return moves[m.body_a] == 0 || moves[m.body_b] == 0;
  }
  [[nodiscard]] static int rank(state::ContactRoute route) {
    return static_cast<int>(route) - static_cast<int>(state::ContactRoute::kSoft);
  }
  [[nodiscard]] int rank(int color) const {
    if (color < kPairColors) return color;
    return color < kColors ? color + lone : color - kColors + kPairColors;
  }
  [[nodiscard]] int key(const Manifold& m, int color) const {
    HOOKE_ASSERT(color < kColors + lone && m.point_count <= Manifold::kMaxPoints);
    const int kind = 2 * rank(m.route) + (is_anchored(m) ? 1 : 0);
    return kKinds * rank(color) + kind * Manifold::kMaxPoints + Manifold::kMaxPoints -
           std::max(m.point_count, 1);
  }
  [[nodiscard]] std::size_t key_count() const {
    return static_cast<std::size_t>(kKinds) * static_cast<std::size_t>(kColors + lone);
  }
};

/// Fills `members` and `begin` by a counting sort.
void sort_members(const std::vector<Manifold>& manifolds, const MemberOrder& order, ContactColors& colors) {
  const auto key = [&](std::size_t i) { return order.key(manifolds[i], colors.color[i]); };
  colors.next_slot.assign(order.key_count() + 1, 0);
  for (std::size_t i = 0; i < manifolds.size(); ++i) {
    if (colors.color[i] >= 0) ++colors.next_slot[key(i) + 1];
  }
  std::partial_sum(colors.next_slot.begin(), colors.next_slot.end(), colors.next_slot.begin());
  colors.begin = {0};
  constexpr int kKinds = MemberOrder::kKinds;
  for (int rank_end = kKinds; rank_end < static_cast<int>(colors.next_slot.size()); rank_end += kKinds) {
    if (colors.next_slot[rank_end] > colors.begin.back()) colors.begin.push_back(colors.next_slot[rank_end]);
  }
  HOOKE_ASSERT(colors.begin.back() == colors.next_slot.back());  // all keys belong to a color
  colors.members.resize(static_cast<std::size_t>(colors.begin.back()));
  for (std::size_t i = 0; i < manifolds.size(); ++i) {
    if (colors.color[i] < 0) continue;
    const Manifold& m = manifolds[i];
    colors.members[colors.next_slot[key(i)]++] = {static_cast<std::uint32_t>(i), order.is_anchored(m),
                                                  m.route};
  }
}

}  // namespace

bool is_moved(const state::Bodies& bodies, std::uint32_t row) {
  return bodies.motion[row].inverse_mass > Real(0) && bodies.asleep[row] == 0;
}

bool has_contact_rows(const Manifold& m, const state::Bodies& bodies) {
  if (m.point_count == 0 && !m.is_refreshed()) return false;
  if (bodies.traits[m.body_a].sensor || bodies.traits[m.body_b].sensor) return false;
  return is_moved(bodies, m.body_a) || is_moved(bodies, m.body_b);
}

void color_contacts(const std::vector<Manifold>& manifolds, const state::Bodies& bodies,
                    ContactColors& colors) {
  find_moving(bodies, colors.moves);
  const int lone = take_colors(manifolds, bodies, colors);
  sort_members(manifolds, {colors.moves, lone}, colors);
}

}  // namespace hooke::solver
