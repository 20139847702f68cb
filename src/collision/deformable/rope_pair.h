#pragma once

#include "hooke/math.h"

#include "state/tables.h"

#include <array>

namespace hooke::collision {

/// The two segments of a row and their ways within a substep. Positions are offsets from the first end of a.
class RopePair {
 public:
  /// Where the two are nearest after a share of the way.
  struct Nearest {
    Real share = Real(0);
    Real distance = Real(0);            ///< Of the lines in the middle of both [m].
    Vec3 normal = {};                   ///< From b to a; zero if they cross.
    std::array<Real, 2> fraction = {};  ///< Of the places along a and b.

    /// Of a positive with the sum 1, of b negative with the sum -1.
    [[nodiscard]] std::array<Real, 4> weights() const {
      return {Real(1) - fraction[0], fraction[0], fraction[1] - Real(1), -fraction[1]};
    }
  };

  /// As they are, and as they go in the next `h` [s].
  RopePair(const state::Tables& tables, Real h, const state::RopeContact& row);

  [[nodiscard]] Nearest nearest(Real share) const;
  /// The farthest that an end of one goes against an end of the other [m].
  [[nodiscard]] Real longest_displacement() const;
  /// By how much the gap along a normal falls at most on the whole way [m].
  [[nodiscard]] Real closing_distance(Vec3 normal) const;
  /// The first place on the way, after that given, where the two are about `distance` apart; where they do
  /// not come so near, the last that was looked at. By conservative advancement along the normal.
  [[nodiscard]] Nearest advance(Nearest from, Real distance) const;
  /// The gap along the normal that the places of `at` have at the start of the way [m].
  [[nodiscard]] Real gap_at_start(const Nearest& at) const;
  /// By how much that grows on the whole way [m].
  [[nodiscard]] Real gap_growth(const Nearest& at) const;

 private:
  std::array<Vec3, 4> corner_ = {};
  std::array<Vec3, 4> displacement_ = {};
};

}  // namespace hooke::collision
