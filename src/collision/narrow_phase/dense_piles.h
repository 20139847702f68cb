#pragma once

#include "base/disjoint_sets.h"
#include "collision/broad_phase/broad_phase.h"
#include "state/bodies.h"
#include "state/colliders.h"
#include "state/manifolds.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Bodies that stand in the middle of each other, as a thousand that were put at one place do. All pairs of
/// them would be half a million manifolds, which push each other to any speed. Nothing that came there by
/// itself is in a crowd: contacts let no two bodies so deep into each other.

namespace hooke::collision {

/// How many others a body of a crowd meets, and from how many on it is in one.
inline constexpr std::uint32_t kMostNeighborsInPile = 8;
inline constexpr std::uint32_t kLeastNeighborsInPile = 4;

/// Which others a body of a crowd meets: the nearest; of equally near ones those whose rows are nearest, so
/// that not all choose the same.
struct PileNeighborKey {
  double distance_squared = 0;
  std::uint32_t row_distance = 0;
  std::uint32_t row = 0;

  friend constexpr auto operator<=>(const PileNeighborKey&, const PileNeighborKey&) = default;
};

/// Leaves out pairs of two bodies of crowds of which neither is among the nearest of the other. Only bodies
/// count that forces move and that are awake.
class DensePiles {
 public:
  /// Before their shapes are looked at: bodies whose centers of mass are nearer than 0.75 of the sum of the
  /// radii of the largest spheres in both. Removes pairs.
  void thin_out(const state::Bodies& bodies, const state::Colliders& colliders,
                std::vector<ColliderPair>& pairs);

  /// After that, in the same step: bodies of which one is deeper in the other than half that radius of the
  /// thinner one. Removes manifolds.
  void thin_out(const state::Bodies& bodies, state::Pairs& pairs);

  /// Rows of the bodies that were in crowds, one crowd after the other.
  [[nodiscard]] std::span<const std::uint32_t> members() const { return members_; }
  /// Of each crowd the index of its first member, and their number at the end.
  [[nodiscard]] std::span<const std::uint32_t> begins() const { return begins_; }
  /// How many pairs and manifolds were left out.
  [[nodiscard]] std::uint32_t left_out() const { return left_out_; }

 private:
  /// The nearest of a body, a heap with the farthest first.
  struct Nearest {
    std::uint32_t size = 0;
    std::array<PileNeighborKey, kMostNeighborsInPile> keys = {};

    void add(const PileNeighborKey& key);
    [[nodiscard]] bool chooses(const PileNeighborKey& key) const;
  };
  /// Two bodies that are deep in each other.
  struct Deep {
    std::size_t row = 0;  ///< Of the pair, or of the manifold.
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
  base::DisjointSets sets_ = {};  ///< Of bodies that are deep in each other.
  std::uint32_t left_out_ = 0;
  std::vector<Deep> deep_ = {};
  std::vector<std::uint32_t> count_ = {};  ///< Of these, by body row; a body of several shapes counts often.
  std::vector<std::uint32_t> found_ = {};  ///< Rows of bodies with kLeastInCrowd of them.
  std::vector<std::uint32_t> slot_ = {};   ///< In `found_`, by body row.
  std::vector<Nearest> nearest_ = {};      ///< Of `found_`.
  std::vector<std::uint8_t> goes_ = {};    ///< By pair.
};

}  // namespace hooke::collision
