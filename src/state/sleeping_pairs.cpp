#include "state/sleeping_pairs.h"

#include "base/assert.h"
#include "base/take_turns.h"

#include <array>

namespace hooke::state {

namespace {

/// Resting pairs are put to sleep when they are at least one part in so many of the sleeping pairs.
constexpr std::size_t kSleepingShare = 8;

struct PairTable {
  const std::vector<Pair>& pair;
  const std::vector<Manifold>& manifold;
};

/// Merges the pairs of two tables, each in order, into a third without gaps.
void merge(const PairTable& a, const PairTable& b, std::vector<Pair>& pairs,
           std::vector<Manifold>& manifolds) {
  HOOKE_ASSERT(std::is_sorted(a.pair.begin(), a.pair.end(), comes_before));
  HOOKE_ASSERT(std::is_sorted(b.pair.begin(), b.pair.end(), comes_before));
  pairs.clear();
  manifolds.clear();
  const auto take = [&](const Pair& pair, const std::vector<Manifold>& from) {
    HOOKE_ASSERT(std::size_t{pair.first_manifold} + pair.manifold_count <= from.size());
    const auto first = from.begin() + static_cast<std::ptrdiff_t>(pair.first_manifold);
    pairs.push_back(pair);
    pairs.back().first_manifold = static_cast<std::uint32_t>(manifolds.size());
    manifolds.insert(manifolds.end(), first, first + static_cast<std::ptrdiff_t>(pair.manifold_count));
  };
  auto of_b = b.pair.begin();
  for (const Pair& pair : a.pair) {
    for (; of_b != b.pair.end() && comes_before(*of_b, pair); ++of_b) take(*of_b, b.manifold);
    take(pair, a.manifold);
  }
  for (; of_b != b.pair.end(); ++of_b) take(*of_b, b.manifold);
}

std::array<std::uint32_t, 2> bodies_of(const Colliders& colliders, const Pair& pair) {
  HOOKE_ASSERT(pair.collider_a < pair.collider_b && pair.collider_b < colliders.body.size());
  return {colliders.body[pair.collider_a], colliders.body[pair.collider_b]};
}

std::uint32_t pushing_points(const Pair& pair, const std::vector<Manifold>& manifolds) {
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < pair.manifold_count; ++i)
    count += pushing_points(manifolds[pair.first_manifold + i]);
  return count;
}

/// Moves the pairs for which `goes(pair)` to the end of `moved`, which keeps their order.
template <class Goes>
void split(Goes&& goes, std::vector<Pair>& pairs, std::vector<Pair>& moved) {
  moved.clear();
  std::erase_if(pairs, [&](const Pair& pair) {
    if (!goes(pair)) return false;
    moved.push_back(pair);
    return true;
  });
}

/// Counts the pairs that leave or enter the sleeping table, by body, and their points.
void count_sleeping(std::span<const Pair> moved, const std::vector<Manifold>& manifolds, bool enters,
                    const Colliders& colliders, SleepingPairs& sleeping) {
  for (const Pair& pair : moved) {
    const std::uint32_t points = pushing_points(pair, manifolds);
    HOOKE_ASSERT(enters || sleeping.contacts >= points);
    sleeping.contacts = enters ? sleeping.contacts + points : sleeping.contacts - points;
    for (const std::uint32_t body : bodies_of(colliders, pair)) {
      HOOKE_ASSERT(body < sleeping.of_body.size() && (enters || sleeping.of_body[body] > 0));
      sleeping.of_body[body] = enters ? sleeping.of_body[body] + 1 : sleeping.of_body[body] - 1;
    }
  }
}

/// Closes the gaps that removed pairs left.
void close_gaps(Pairs& pairs, SleepingPairScratch& scratch) {
  const std::vector<Pair> no_pairs;
  merge({pairs.pair, pairs.manifold}, {no_pairs, pairs.manifold}, scratch.pair, scratch.manifold);
  base::take_turns(scratch.pair, pairs.pair);
  base::take_turns(scratch.manifold, pairs.manifold);
}

}  // namespace

bool stands(const Bodies& bodies, std::uint32_t body) {
  if (bodies.asleep[body] != 0 || bodies.traits[body].kind == BodyKind::kStatic) return true;
  return bodies.traits[body].kind == BodyKind::kKinematic && bodies.motion[body].v == Vec3{} &&
         bodies.angular_velocity[body] == Vec3{};
}

bool rests(const Bodies& bodies, const Colliders& colliders, const Pair& pair) {
  const auto [a, b] = bodies_of(colliders, pair);
  return pair.tested && stands(bodies, a) && stands(bodies, b);
}

void reserve_sleeping_pairs(Pairs& pairs, SleepingPairScratch& scratch) {
  for (std::vector<Pair>* table : {&pairs.sleeping.pair, &scratch.moved, &scratch.pair})
    table->reserve(pairs.pair.capacity());
  for (std::vector<Manifold>* table : {&pairs.sleeping.manifold, &scratch.manifold})
    table->reserve(pairs.manifold.capacity());
  pairs.sleeping.of_body.reserve(pairs.seen.capacity());
}

void put_pairs_to_sleep(const Bodies& bodies, const Colliders& colliders, Pairs& pairs,
                        SleepingPairScratch& scratch) {
  const auto may_sleep = [&](const Pair& pair) {
    const auto [a, b] = bodies_of(colliders, pair);
    return rests(bodies, colliders, pair) && !bodies.traits[a].sensor && !bodies.traits[b].sensor;
  };
  const auto resting =
      static_cast<std::size_t>(std::count_if(pairs.pair.begin(), pairs.pair.end(), may_sleep));
  SleepingPairs& sleeping = pairs.sleeping;
  const bool is_worth_it = resting == sleeping.waiting || kSleepingShare * resting >= sleeping.pair.size();
  sleeping.waiting = is_worth_it ? 0 : resting;
  if (resting == 0 || !is_worth_it) return;
  sleeping.of_body.resize(bodies.traits.size());
  split(may_sleep, pairs.pair, scratch.moved);
  for (const Pair& pair : scratch.moved) {
    // Whoever set the marks of this step also clears them, but will not find these manifolds.
    for (std::uint32_t i = 0; i < pair.manifold_count; ++i)
      pairs.manifold[pair.first_manifold + i].route = ContactRoute::kSoft;
  }
  count_sleeping(scratch.moved, pairs.manifold, true, colliders, sleeping);
  merge({sleeping.pair, sleeping.manifold}, {scratch.moved, pairs.manifold}, scratch.pair, scratch.manifold);
  base::take_turns(scratch.pair, sleeping.pair);
  base::take_turns(scratch.manifold, sleeping.manifold);
  close_gaps(pairs, scratch);
}

bool wake_pairs(std::span<const std::uint32_t> moving, const Bodies& bodies, const Colliders& colliders,
                Pairs& pairs, SleepingPairScratch& scratch) {
  SleepingPairs& sleeping = pairs.sleeping;
  const bool any = std::any_of(moving.begin(), moving.end(), [&](std::uint32_t body) {
    return body < sleeping.of_body.size() && sleeping.of_body[body] > 0 && !stands(bodies, body);
  });
  if (!any) return false;
  split([&](const Pair& pair) { return !rests(bodies, colliders, pair); }, sleeping.pair, scratch.moved);
  count_sleeping(scratch.moved, sleeping.manifold, false, colliders, sleeping);
  merge({pairs.pair, pairs.manifold}, {scratch.moved, sleeping.manifold}, scratch.pair, scratch.manifold);
  base::take_turns(scratch.pair, pairs.pair);
  base::take_turns(scratch.manifold, pairs.manifold);
  return true;
}

// It allocates nothing, so that removing a body cannot fail halfway.
void remove_pairs(std::span<const std::uint8_t> goes, const Colliders& colliders, Pairs& pairs) {
  const auto is_one_gone = [&](const Pair& pair) {
    const auto [a, b] = bodies_of(colliders, pair);
    return goes[a] != 0 || goes[b] != 0;
  };
  std::erase_if(pairs.pair, is_one_gone);
  // A new body in the row of one that is gone must not inherit what that one carried.
  std::erase_if(pairs.coupled, [&](const CoupledManifold& contact) {
    return goes[contact.body_a] != 0 || goes[contact.body_b] != 0;
  });
  for (const Pair& pair : pairs.sleeping.pair) {
    if (is_one_gone(pair))
      count_sleeping(std::span(&pair, 1), pairs.sleeping.manifold, false, colliders, pairs.sleeping);
  }
  std::erase_if(pairs.sleeping.pair, is_one_gone);
}

}  // namespace hooke::state
