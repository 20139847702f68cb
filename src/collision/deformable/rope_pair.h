#pragma once

#include "hooke/math.h"

#include "state/tables.h"

#include <array>

namespace hooke::collision {

/// The two segments of a row and their displacements within a substep. Positions are offsets from the first
/// end of a.
class RopePair {
 public:
  /// The nearest points of the two after a share of the displacement.
  struct Nearest {
    Real share = Real(0);
    Real distance = Real(0);            ///< Distance of the center lines [m].
    Vec3 normal = {};                   ///< Unit vector from b to a; zero if they cross.
    std::array<Real, 2> fraction = {};  ///< Fractions of the nearest points along a and b.

    /// Weights of the points of a, with the sum 1, and of b, with the sum -1.
    [[nodiscard]] std::array<Real, 4> weights() const {
      return {Real(1) - fraction[0], fraction[0], fraction[1] - Real(1), -fraction[1]};
    }
  };

  /// The segments as they are, and their motion in the next `h` [s].
  RopePair(const state::Tables& tables, Real h, const state::RopeContact& row);

  [[nodiscard]] Nearest nearest(Real share) const;
  /// Largest displacement of an end of one relative to an end of the other [m].
  [[nodiscard]] Real longest_displacement() const;
  /// Upper bound of how much the gap along a normal shrinks in the whole motion [m].
  [[nodiscard]] Real closing_distance(Vec3 normal) const;
  /// The first state in the motion, after the given one, in which the two are about `distance` apart. If they
  /// do not come so near, the last state that was tested. Uses conservative advancement along the normal.
  [[nodiscard]] Nearest advance(Nearest from, Real distance) const;
  /// The gap along the normal that the points of `at` have at the start of the motion [m].
  [[nodiscard]] Real gap_at_start(const Nearest& at) const;
  /// By how much that gap grows in the whole motion [m].
  [[nodiscard]] Real gap_growth(const Nearest& at) const;

 private:
  std::array<Vec3, 4> corner_ = {};
  std::array<Vec3, 4> displacement_ = {};
};

}  // namespace hooke::collision
