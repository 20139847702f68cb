#include "state/sleeping_pairs.h"

#include "base/take_turns.h"

#include <array>

namespace hooke::state {

namespace {

/// Resting pairs that are parked at once, in parts of those that are.
constexpr std::size_t kParkedShare = 8;

struct PairTable {
  const std::vector<Pair>& pair;
  const std::vector<Manifold>& manifold;
};

/// Merges the pairs of two tables, each in order, into a third without gaps.
void merge(const PairTable& a, const PairTable& b, std::vector<Pair>& pairs,
           std::vector<Manifold>& manifolds) {
  pairs.clear();
  manifolds.clear();
  const auto take = [&](const Pair& pair, const std::vector<Manifold>& from) {
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

/// What leaves a table, or enters it, by body and by point.
void count_parked(std::span<const Pair> moved, const std::vector<Manifold>& manifolds, bool enters,
                  const Colliders& colliders, ParkedPairs& parked) {
  for (const Pair& pair : moved) {
    const std::uint32_t points = pushing_points(pair, manifolds);
    parked.contacts = enters ? parked.contacts + points : parked.contacts - points;
    for (const std::uint32_t body : bodies_of(colliders, pair))
      parked.of_body[body] = enters ? parked.of_body[body] + 1 : parked.of_body[body] - 1;
  }
}

/// Leaves no gaps where pairs were.
void close_gaps(Pairs& pairs, ParkingScratch& scratch) {
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

void reserve_parking(Pairs& pairs, ParkingScratch& scratch) {
  for (std::vector<Pair>* table : {&pairs.parked.pair, &scratch.moved, &scratch.pair})
    table->reserve(pairs.pair.capacity());
  for (std::vector<Manifold>* table : {&pairs.parked.manifold, &scratch.manifold})
    table->reserve(pairs.manifold.capacity());
  pairs.parked.of_body.reserve(pairs.seen.capacity());
}

void park_pairs(const Bodies& bodies, const Colliders& colliders, Pairs& pairs, ParkingScratch& scratch) {
  const auto may_be_parked = [&](const Pair& pair) {
    const auto [a, b] = bodies_of(colliders, pair);
    return rests(bodies, colliders, pair) && !bodies.traits[a].sensor && !bodies.traits[b].sensor;
  };
  const auto resting =
      static_cast<std::size_t>(std::count_if(pairs.pair.begin(), pairs.pair.end(), may_be_parked));
  ParkedPairs& parked = pairs.parked;
  const bool is_worth_it = resting == parked.waiting || kParkedShare * resting >= parked.pair.size();
  parked.waiting = is_worth_it ? 0 : resting;
  if (resting == 0 || !is_worth_it) return;
  parked.of_body.resize(bodies.traits.size());
  split(may_be_parked, pairs.pair, scratch.moved);
  for (const Pair& pair : scratch.moved) {
    // Marks of the step are taken off by who made them, who will not find these.
    for (std::uint32_t i = 0; i < pair.manifold_count; ++i)
      pairs.manifold[pair.first_manifold + i].borne = false;
  }
  count_parked(scratch.moved, pairs.manifold, true, colliders, parked);
  merge({parked.pair, parked.manifold}, {scratch.moved, pairs.manifold}, scratch.pair, scratch.manifold);
  base::take_turns(scratch.pair, parked.pair);
  base::take_turns(scratch.manifold, parked.manifold);
  close_gaps(pairs, scratch);
}

bool unpark_pairs(std::span<const std::uint32_t> moving, const Bodies& bodies, const Colliders& colliders,
                  Pairs& pairs, ParkingScratch& scratch) {
  ParkedPairs& parked = pairs.parked;
  const bool any = std::any_of(moving.begin(), moving.end(), [&](std::uint32_t body) {
    return body < parked.of_body.size() && parked.of_body[body] > 0 && !stands(bodies, body);
  });
  if (!any) return false;
  split([&](const Pair& pair) { return !rests(bodies, colliders, pair); }, parked.pair, scratch.moved);
  count_parked(scratch.moved, parked.manifold, false, colliders, parked);
  merge({pairs.pair, pairs.manifold}, {scratch.moved, parked.manifold}, scratch.pair, scratch.manifold);
  base::take_turns(scratch.pair, pairs.pair);
  base::take_turns(scratch.manifold, pairs.manifold);
  return true;
}

void remove_pairs(std::span<const std::uint8_t> goes, const Colliders& colliders, Pairs& pairs) {
  const auto is_one_gone = [&](const Pair& pair) {
    const auto [a, b] = bodies_of(colliders, pair);
    return goes[a] != 0 || goes[b] != 0;
  };
  std::erase_if(pairs.pair, is_one_gone);
  std::vector<Pair> gone;
  split(is_one_gone, pairs.parked.pair, gone);
  count_parked(gone, pairs.parked.manifold, false, colliders, pairs.parked);
}

}  // namespace hooke::state
