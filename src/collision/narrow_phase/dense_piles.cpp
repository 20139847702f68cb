#include "collision/narrow_phase/dense_piles.h"

#include "base/assert.h"
#include "collision/narrow_phase/narrow_phase.h"
#include "collision/narrow_phase/narrow_phase_tuning.h"

#include <algorithm>

namespace hooke::collision {

namespace {

PileNeighborKey key_of(std::uint32_t body, std::uint32_t other, double distance_squared) {
  return {distance_squared, body < other ? other - body : body - other, other};
}

}  // namespace

void DensePiles::Nearest::add(const PileNeighborKey& key) {
  const auto end = keys.begin() + size;
  HOOKE_ASSERT(std::is_heap(keys.begin(), end));
  if (std::find(keys.begin(), end, key) != end) return;  // it is another shape of the same body
  if (size < kMostNeighborsInPile) {
    keys[size++] = key;
    std::push_heap(keys.begin(), keys.begin() + size);
  } else if (key < keys[0]) {
    std::pop_heap(keys.begin(), keys.end());
    keys.back() = key;
    std::push_heap(keys.begin(), keys.end());
  }
}

bool DensePiles::Nearest::chooses(const PileNeighborKey& key) const {
  return size < kMostNeighborsInPile || !(keys[0] < key);
}

void DensePiles::note(const state::Bodies& bodies, const Deep& deep) {
  HOOKE_ASSERT(deep.a != deep.b);
  if (!gives_way(bodies, deep.a) || !gives_way(bodies, deep.b)) return;
  deep_.push_back(deep);
}

/// Finds the members among the noted bodies. Fills `nearest_` if there are so many that some may be left out.
void DensePiles::find_members(std::size_t body_count) {
  found_.clear();
  nearest_.clear();
  if (deep_.size() < kLeastNeighborsInPile) return;
  count_.assign(body_count, 0);
  for (const Deep& deep : deep_) {
    ++count_[deep.a];
    ++count_[deep.b];
  }
  for (std::uint32_t body = 0; body < count_.size(); ++body) {
    if (count_[body] >= kLeastNeighborsInPile) found_.push_back(body);
  }
  if (found_.size() <= kLeastNeighborsInPile) return;  // they have several shapes, and not so many neighbors
  if (members_.empty()) sets_.reset(count_.size());
  for (const Deep& deep : deep_) sets_.merge(deep.a, deep.b);
  members_.insert(members_.end(), found_.begin(), found_.end());
  if (found_.size() <= kMostNeighborsInPile) return;
  slot_.resize(count_.size());
  nearest_.resize(found_.size());
  for (std::uint32_t i = 0; i < found_.size(); ++i) slot_[found_[i]] = i;
  const auto add = [&](std::uint32_t body, std::uint32_t other, double distance_squared) {
    if (count_[body] >= kLeastNeighborsInPile)
      nearest_[slot_[body]].add(key_of(body, other, distance_squared));
  };
  for (const Deep& deep : deep_) {
    add(deep.a, deep.b, deep.distance_squared);
    add(deep.b, deep.a, deep.distance_squared);
  }
}

template <class Visit>
void DensePiles::for_each_left_out(Visit&& visit) {
  if (nearest_.empty()) return;
  const auto chooses = [&](std::uint32_t body, std::uint32_t other, double distance_squared) {
    return count_[body] < kLeastNeighborsInPile ||
           nearest_[slot_[body]].chooses(key_of(body, other, distance_squared));
  };
  for (const Deep& deep : deep_) {
    if (chooses(deep.a, deep.b, deep.distance_squared) || chooses(deep.b, deep.a, deep.distance_squared))
      continue;
    visit(deep.row);
    ++left_out_;
  }
}

void DensePiles::thin_out(const state::Bodies& bodies, const state::Colliders& colliders,
                          std::vector<ColliderPair>& pairs) {
  members_.clear();
  begins_.clear();
  left_out_ = 0;
  deep_.clear();
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::uint32_t a = colliders.body[pairs[i].first];
    const std::uint32_t b = colliders.body[pairs[i].second];
    const double reach =
        kDeepCenters * static_cast<double>(bodies.traits[a].inner_radius + bodies.traits[b].inner_radius);
    const double distance_squared = length_squared(bodies.center[b] - bodies.center[a]);
    if (distance_squared < reach * reach) note(bodies, {i, a, b, distance_squared});
  }
  find_members(bodies.traits.size());
  goes_.assign(nearest_.empty() ? 0 : pairs.size(), 0);
  for_each_left_out([&](std::size_t row) { goes_[row] = 1; });
  if (left_out_ == 0) return;
  std::size_t remaining = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (goes_[i] == 0) pairs[remaining++] = pairs[i];
  }
  pairs.resize(remaining);
}

void DensePiles::thin_out(const state::Bodies& bodies, state::Pairs& pairs) {
  deep_.clear();
  for (std::size_t i = 0; i < pairs.manifold.size(); ++i) {
    const state::Manifold& m = pairs.manifold[i];
    const Real overlap = state::deepest_overlap(m);
    if (!(overlap > Real(0)) || m.is_refreshed()) continue;
    if (!(overlap > kDeepOverlap * state::thinner_radius(bodies, m.body_a, m.body_b))) continue;
    note(bodies, {i, m.body_a, m.body_b, length_squared(bodies.center[m.body_b] - bodies.center[m.body_a])});
  }
  find_members(bodies.traits.size());
  const std::uint32_t before = left_out_;
  for_each_left_out([&](std::size_t row) { pairs.manifold[row].point_count = 0; });
  if (left_out_ > before) remove_empty(pairs);
  divide();
}

/// Divides the members into dense piles.
void DensePiles::divide() {
  if (members_.empty()) return;
  std::sort(members_.begin(), members_.end(), [&](std::uint32_t a, std::uint32_t b) {
    const auto root_a = sets_.root(a);
    const auto root_b = sets_.root(b);
    return root_a != root_b ? root_a < root_b : a < b;
  });
  members_.erase(std::unique(members_.begin(), members_.end()), members_.end());
  for (std::uint32_t i = 0; i < members_.size(); ++i) {
    if (i == 0 || sets_.root(members_[i]) != sets_.root(members_[i - 1])) begins_.push_back(i);
  }
  begins_.push_back(static_cast<std::uint32_t>(members_.size()));
  HOOKE_ASSERT(begins_.front() == 0);
}

}  // namespace hooke::collision
