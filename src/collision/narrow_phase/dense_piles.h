#pragma once

#include "base/disjoint_sets.h"
#include "collision/broad_phase/broad_phase.h"
#include "collision/narrow_phase/narrow_phase_tuning.h"
#include "state/bodies.h"
#include "state/colliders.h"
#include "state/manifolds.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Handles bodies that stand deep inside each other, as a thousand that were put at one place do. All their
/// pairs would be half a million manifolds, which push each other to any speed. Bodies that came together by
/// themselves are never in a dense pile: contacts let no two bodies so deep into each other.

namespace hooke::collision {

/// Order in which a body of a dense pile chooses its neighbors: the nearest first. Of equally near ones those
/// with the nearest rows come first, so that not all bodies choose the same.
struct PileNeighborKey {
  double distance_squared = 0;
  std::uint32_t row_distance = 0;
  std::uint32_t row = 0;

  friend constexpr auto operator<=>(const PileNeighborKey&, const PileNeighborKey&) = default;
};

/// Leaves out pairs of two bodies of dense piles of which neither is among the nearest of the other. Only
/// bodies that are dynamic and awake count.
class DensePiles {
 public:
  /// Removes pairs before their shapes are tested. It counts bodies whose centers of mass are nearer than
  /// 0.75 of the sum of the radii of the largest spheres in both.
  void thin_out(const state::Bodies& bodies, const state::Colliders& colliders,
                std::vector<ColliderPair>& pairs);

  /// Removes manifolds after the test, in the same step. It counts bodies of which one is deeper in the other
  /// than half that radius of the thinner one.
  void thin_out(const state::Bodies& bodies, state::Pairs& pairs);

  /// Rows of the bodies that were in dense piles, one pile after the other.
  [[nodiscard]] std::span<const std::uint32_t> members() const { return members_; }
  /// Index of the first member of each pile, and the number of members at the end.
  [[nodiscard]] std::span<const std::uint32_t> begins() const { return begins_; }
  /// Number of pairs and manifolds that were left out.
  [[nodiscard]] std::uint32_t left_out() const { return left_out_; }

 private:
  /// The nearest neighbors of a body, a heap with the farthest first.
  struct Nearest {
    std::uint32_t size = 0;
    std::array<PileNeighborKey, kMostNeighborsInPile> keys = {};

    void add(const PileNeighborKey& key);
    [[nodiscard]] bool chooses(const PileNeighborKey& key) const;
  };
  /// Two bodies that are deep in each other.
  struct Deep {
    std::size_t row = 0;  ///< Row of the pair, or of the manifold.
    std::uint32_t a = 0, b = 0;
    double distance_squared = 0;
  };

  void divide();
  void note(const state::Bodies& bodies, const Deep& deep);
  void find_members(std::size_t body_count);
  /// Calls visit(row) for those of `deep_` that neither body chooses.
  template <class Visit>
  void for_each_left_out(Visit&& visit);

  std::vector<std::uint32_t> members_ = {};
  std::vector<std::uint32_t> begins_ = {};
  base::DisjointSets sets_ = {};  ///< Sets of bodies that are deep in each other.
  std::uint32_t left_out_ = 0;
  std::vector<Deep> deep_ = {};
  std::vector<std::uint32_t> count_ = {};  ///< Number of such neighbors, by body row; a body of several
                                           ///< shapes counts often.
  std::vector<std::uint32_t> found_ = {};  ///< Rows of bodies with kLeastNeighborsInPile of them.
  std::vector<std::uint32_t> slot_ = {};   ///< Index in `found_`, by body row.
  std::vector<Nearest> nearest_ = {};      ///< Nearest neighbors of each body in `found_`.
  std::vector<std::uint8_t> goes_ = {};    ///< Flags of pairs to remove.
};

}  // namespace hooke::collision
