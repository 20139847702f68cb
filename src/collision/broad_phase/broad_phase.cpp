#include "collision/broad_phase/broad_phase.h"

#include "base/assert.h"
#include "base/take_turns.h"
#include "collision/broad_phase/broad_phase_tuning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace hooke::collision {

using geometry::Box;
using geometry::merge;

namespace {

constexpr int kSearchesPerBlock = 64;
constexpr int kCandidatesPerBlock = 4096;

Real mean_side(const Box& box) {
  const Vec3 size = box.upper - box.lower;
  return (size.x + size.y + size.z) / Real(3);
}

Vec3 center_of(const Box& box) {
  return Real(0.5) * (box.lower + box.upper);
}

Box grown(const Box& box, Real margin) {
  const Vec3 m = {margin, margin, margin};
  return {box.lower - m, box.upper + m};
}

/// The box with its margin, extended along its `displacement` in one step.
Box fattened(const Box& box, Vec3 displacement) {
  const Real side = mean_side(box);
  const Vec3 longest = {kMostFatForesight * side, kMostFatForesight * side, kMostFatForesight * side};
  const Vec3 drawn = geometry::max_of(-longest, geometry::min_of(longest, kFatForesight * displacement));
  const Box fat = grown(box, kFatMargin * side);
  return {fat.lower + geometry::min_of(Vec3{}, drawn), fat.upper + geometry::max_of(Vec3{}, drawn)};
}

/// Whether a fat box still fits its tight one: it must hold it, and must not be so much larger that a box
/// that shrank or stopped would keep others searching in vain.
bool still_fits(const Box& fat, const Box& tight) {
  return contains(fat, tight) && mean_side(fat) <= kMostFatness * mean_side(tight);
}

bool is_bounded(const Box& box) {
  const auto within = [](Vec3 v) {
    return std::fabs(v.x) <= BroadPhase::kHuge && std::fabs(v.y) <= BroadPhase::kHuge &&
           std::fabs(v.z) <= BroadPhase::kHuge;
  };
  return within(box.lower) && within(box.upper);
}

[[maybe_unused]] bool is_in_order(const Box& box) {
  return box.lower.x <= box.upper.x && box.lower.y <= box.upper.y && box.lower.z <= box.upper.z;
}

/// geometry::overlap without branches: about every other candidate overlaps.
bool overlap_unpredictably(const Box& a, const Box& b) {
  return static_cast<bool>(
      static_cast<int>(a.lower.x <= b.upper.x) & static_cast<int>(b.lower.x <= a.upper.x) &
      static_cast<int>(a.lower.y <= b.upper.y) & static_cast<int>(b.lower.y <= a.upper.y) &
      static_cast<int>(a.lower.z <= b.upper.z) & static_cast<int>(b.lower.z <= a.upper.z));
}

/// Sorts by second, then by first, 11 bits at a time from the lowest. Digits that are all alike cost only the
/// test.
void sort_pairs(std::vector<ColliderPair>& pairs, std::vector<ColliderPair>& scratch) {
  constexpr std::uint32_t kDigits = 1 << 11;
  if (pairs.size() < kFewestSortedByDigits) {
    std::sort(pairs.begin(), pairs.end());
    return;
  }
  scratch.resize(pairs.size());
  for (const auto column : {&ColliderPair::second, &ColliderPair::first}) {
    for (unsigned shift = 0; shift < 32; shift += 11) {
      const auto digit = [=](const ColliderPair& pair) { return (pair.*column >> shift) % kDigits; };
      std::array<std::uint32_t, kDigits> begin = {};
      for (const ColliderPair& pair : pairs) ++begin[digit(pair)];
      if (begin[digit(pairs[0])] == pairs.size()) continue;
      std::uint32_t sum = 0;
      for (std::uint32_t& b : begin) {
        const std::uint32_t count = b;
        b = sum;
        sum += count;
      }
      for (const ColliderPair& pair : pairs) scratch[begin[digit(pair)]++] = pair;
      pairs.swap(scratch);
    }
  }
}

std::size_t blocks_of(std::size_t count, int size) {
  return (count + static_cast<std::size_t>(size) - 1) / static_cast<std::size_t>(size);
}

/// Calls `kernel(block, begin, end)` for blocks of `size` rows. The blocks are the same for any number of
/// workers.
template <class Kernel>
void for_blocks(parallel::ThreadPool& pool, std::size_t count, int size, Kernel&& kernel) {
  parallel::for_ranges(pool, static_cast<int>(blocks_of(count, size)), 1, [&](parallel::Range blocks) {
    for (auto block = static_cast<std::size_t>(blocks.begin); block < static_cast<std::size_t>(blocks.end);
         ++block) {
      const std::size_t begin = block * static_cast<std::size_t>(size);
      kernel(block, begin, std::min(count, begin + static_cast<std::size_t>(size)));
    }
  });
}

}  // namespace

void BroadPhase::set(std::uint32_t collider, const Box& box, bool moves, std::int32_t group) {
  HOOKE_ASSERT(is_in_order(box));
  if (collider >= entries_.size()) {
    entries_.resize(collider + std::size_t{1});
    // Each collider is marked once at most: with this room, to remove one allocates nothing.
    if (changed_.capacity() < entries_.size()) changed_.reserve(entries_.capacity());
    tight_.resize(entries_.size());
    fat_.resize(entries_.size());
  }
  Entry& entry = entries_[collider];
  const Home home = !is_bounded(box) ? Home::kUnbounded : moves ? Home::kMoving : Home::kStanding;
  const bool stays = entry.home == home && entry.moves == moves;
  const Box before = tight_[collider];
  tight_[collider] = box;
  const bool grows_fat = home == Home::kMoving;
  if (stays && (grows_fat ? still_fits(fat_[collider], box) : fat_[collider] == box)) return;
  fat_[collider] = grows_fat ? fattened(box, stays ? center_of(box) - center_of(before) : Vec3{}) : box;
  mark_changed(collider);
  if (stays) {
    if (home == Home::kStanding) standing_.move(collider, fat_[collider]);
    if (home == Home::kMoving) moving_.move(collider, fat_[collider]);
    return;
  }
  leave_home(collider);
  if (entry.home == Home::kNone) entry.group = number_of(group);
  entry.home = home;
  entry.moves = moves;
  enter_home(collider);
}

void BroadPhase::remove(std::uint32_t collider) {
  if (collider >= entries_.size() || entries_[collider].home == Home::kNone) return;
  leave_home(collider);
  entries_[collider].home = Home::kNone;
  mark_changed(collider);
}

void BroadPhase::clear() {
  entries_.clear();
  tight_.clear();
  fat_.clear();
  groups_.clear();
  standing_.clear();
  moving_.clear();
  unbounded_.clear();
  changed_.clear();
  candidates_.clear();
}

void BroadPhase::update() {
  standing_.update();
  moving_.update();
}

void BroadPhase::find_pairs(parallel::ThreadPool& pool, std::vector<ColliderPair>& pairs) {
  filter_candidates(
      pool, [](ColliderPair) { return true; }, pairs);
}

void BroadPhase::find_pairs_of(parallel::ThreadPool& pool, std::span<const std::uint8_t> asked,
                               std::vector<ColliderPair>& pairs) {
  if (asked.empty()) return find_pairs(pool, pairs);
  const auto is_asked = [asked](ColliderPair p) { return (asked[p.first] | asked[p.second]) != 0; };
  filter_candidates(pool, is_asked, pairs);
}

template <class IsAsked>
void BroadPhase::filter_candidates(parallel::ThreadPool& pool, IsAsked&& is_asked,
                                   std::vector<ColliderPair>& pairs) {
  update();
  if (!changed_.empty()) {
    find_new_candidates(pool);
    merge_candidates();
  }
  pairs.resize(candidates_.size());
  ends_.resize(blocks_of(candidates_.size(), kCandidatesPerBlock));
  for_blocks(pool, candidates_.size(), kCandidatesPerBlock,
             [&](std::size_t block, std::size_t begin, std::size_t end) {
               std::size_t passed = begin;
               for (std::size_t i = begin; i < end; ++i) {
                 const ColliderPair pair = candidates_[i];
                 if (!is_asked(pair)) continue;
                 pairs[passed] = pair;
                 passed += overlap_unpredictably(tight_[pair.first], tight_[pair.second]) ? 1 : 0;
               }
               ends_[block] = passed;
             });
  auto out = pairs.begin();
  for (std::size_t block = 0; block < ends_.size(); ++block) {
    const auto begin = pairs.begin() + static_cast<std::ptrdiff_t>(block * kCandidatesPerBlock);
    out = std::move(begin, pairs.begin() + static_cast<std::ptrdiff_t>(ends_[block]), out);
  }
  pairs.erase(out, pairs.end());
}

void BroadPhase::query(const Box& box, std::vector<std::uint32_t>& found) const {
  query_without(0, box, found);
}

void BroadPhase::query_for(std::uint32_t collider, const Box& box, std::vector<std::uint32_t>& found) const {
  HOOKE_ASSERT(collider < entries_.size());
  query_without(entries_[collider].group, box, found);
}

void BroadPhase::query_without(std::uint16_t group, const Box& box, std::vector<std::uint32_t>& found) const {
  found.clear();
  const auto visit = [&](std::uint32_t collider) {
    if (overlap(tight_[collider], box)) found.push_back(collider);
  };
  standing_.visit_overlaps(box, group, visit);
  moving_.visit_overlaps(box, group, visit);
  for (const std::uint32_t collider : unbounded_) {
    if (group == 0 || entries_[collider].group != group) visit(collider);
  }
  std::sort(found.begin(), found.end());
}

void BroadPhase::query_sweep(DVec3 origin, DVec3 motion, Real radius,
                             std::vector<std::uint32_t>& found) const {
  found.clear();
  visit_sweep(origin, motion, radius, [&](std::uint32_t collider) {
    found.push_back(collider);
    return 1.0;
  });
  std::sort(found.begin(), found.end());
}

std::uint16_t BroadPhase::number_of(std::int32_t group) {
  if (group == 0) return 0;
  const std::size_t next = groups_.size() + 1;
  if (next > std::numeric_limits<std::uint16_t>::max()) {
    const auto known = groups_.find(group);
    return known == groups_.end() ? std::uint16_t{0} : known->second;
  }
  return groups_.try_emplace(group, static_cast<std::uint16_t>(next)).first->second;
}

void BroadPhase::enter_home(std::uint32_t collider) {
  const auto& [home, moves, changed, group] = entries_[collider];
  if (home == Home::kStanding) standing_.insert({fat_[collider], collider, group});
  if (home == Home::kMoving) moving_.insert({fat_[collider], collider, group});
  if (home == Home::kUnbounded) unbounded_.push_back(collider);
}

void BroadPhase::leave_home(std::uint32_t collider) {
  const Home home = entries_[collider].home;
  if (home == Home::kStanding) standing_.erase(collider);
  if (home == Home::kMoving) moving_.erase(collider);
  if (home == Home::kUnbounded) std::erase(unbounded_, collider);
}

void BroadPhase::mark_changed(std::uint32_t collider) {
  if (entries_[collider].changed) return;
  entries_[collider].changed = true;
  changed_.push_back(collider);
}

/// Whether a collider that changed reports a pair with one whose fat box overlaps its own. If both changed,
/// the lower one reports the pair.
bool BroadPhase::is_candidate(std::uint32_t changed, std::uint32_t other) const {
  const Entry& a = entries_[changed];
  const Entry& b = entries_[other];
  const bool may_collide = (a.moves || b.moves) && (a.group == 0 || a.group != b.group);
  return may_collide && other != changed && !(b.changed && other < changed);
}

void BroadPhase::find_candidates_of(std::uint32_t collider, std::vector<ColliderPair>& found) const {
  const Entry& entry = entries_[collider];
  if (entry.home == Home::kNone) return;
  const Box& box = fat_[collider];
  const auto visit = [&](std::uint32_t other) {
    if (is_candidate(collider, other))
      found.push_back({std::min(collider, other), std::max(collider, other)});
  };
  moving_.visit_overlaps(box, entry.group, visit);
  if (entry.moves) standing_.visit_overlaps(box, entry.group, visit);
  for (const std::uint32_t other : unbounded_) {
    if (overlap(fat_[other], box)) visit(other);
  }
}

void BroadPhase::find_new_candidates(parallel::ThreadPool& pool) {
  const std::size_t block_count = blocks_of(changed_.size(), kSearchesPerBlock);
  if (found_.size() < block_count) found_.resize(block_count);
  for_blocks(pool, changed_.size(), kSearchesPerBlock,
             [&](std::size_t block, std::size_t begin, std::size_t end) {
               found_[block].clear();
               for (std::size_t i = begin; i < end; ++i) find_candidates_of(changed_[i], found_[block]);
             });
  fresh_.clear();
  for (std::size_t block = 0; block < block_count; ++block) {
    fresh_.insert(fresh_.end(), found_[block].begin(), found_[block].end());
  }
  sort_pairs(fresh_, sorted_);
}

/// Drops the candidates of colliders that changed and adds the fresh ones, in order.
void BroadPhase::merge_candidates() {
  std::erase_if(candidates_, [&](const ColliderPair& pair) {
    return entries_[pair.first].changed || entries_[pair.second].changed;
  });
  HOOKE_ASSERT(std::is_sorted(fresh_.begin(), fresh_.end()));
  sorted_.resize(candidates_.size() + fresh_.size());
  std::merge(candidates_.begin(), candidates_.end(), fresh_.begin(), fresh_.end(), sorted_.begin());
  base::take_turns(sorted_, candidates_);
  HOOKE_ASSERT(std::adjacent_find(candidates_.begin(), candidates_.end()) == candidates_.end());
  fresh_.reserve(sorted_.capacity());  // sort_pairs swaps the two
  for (const std::uint32_t collider : changed_) entries_[collider].changed = false;
  changed_.clear();
}

}  // namespace hooke::collision
