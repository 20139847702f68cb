#pragma once

#include "hooke/math.h"

#include "math/symmetric.h"
#include "solver/cloth/cloth_loads.h"
#include "solver/cloth/cloth_presses.h"
#include "state/tables.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// A cloth solved as a whole: the velocities v at the end of a substep of length h that make
///
///   sum m |v - u|^2 / 2 + sum E(x + h v)
///
/// least, u being what its points would do without its springs, and E the energies of these (the implicit
/// Euler step as a minimum; Martin, Thomaszewski, Grinspun and Gross 2011). A load of any mass is felt
/// through all of the cloth, and what is stopped short of the minimum can only lose energy. Bodies that press
/// on points are unknowns too (solver/cloth/cloth_presses.h), and solids add to the sum what they resist
/// (solver/cloth/cloth_loads.h).
///
/// Newton's method finds it. Each step solves for the change of velocities by conjugate gradients, which the
/// blocks of three by three on the diagonal precondition (Hestenes and Stiefel 1952), and is halved until the
/// sum becomes less. Springs that are pressed do not buckle in the linear problem, so that it stays definite.
///
/// All sums go in the order of rows: results have the same bits for any number of workers.

namespace hooke::solver {

/// Memory of a solution.
class ClothSolution {
 public:
  /// Gives the points of a cloth the velocities of the solution, or leaves them those that they have where
  /// the solution ends before it is better. `unsprung` holds u [m/s] by point of the cloth, `object` is its
  /// row. `with_bends` says whether isometric bends count among its springs. Bodies of `presses`, which are
  /// in order of particles, hold points, and those of `loads` that are of the cloth press on it; what they
  /// give is written there, and bodies and solids stay as they are. Returns whether the error came down to
  /// kLoadedClothError; the velocities are changed in any case.
  struct Problem {
    std::uint32_t object = 0;
    std::span<const Vec3> unsprung;
    std::span<ClothPress> presses;
    std::span<ClothLoad> loads;
    bool with_bends = false;
    double h = 0;  ///< Length of the substep [s].
  };
  [[nodiscard]] bool solve(const Problem& problem, state::Tables& tables);

 private:
  /// A spring, and its limit if it has one.
  struct Spring {
    std::uint32_t a = 0, b = 0;  ///< Points of the cloth.
    double rest_length = 0;      ///< [m]
    double stiffness = 0;        ///< [N/m]
    double damping = 0;          ///< [N s/m]
    double most_length = 0;      ///< Length from which on it has the stiffness of what is rigid, too [m].
    bool isotropic = false;      ///< Its damping acts on the whole relative velocity.
  };
  /// An isometric bend, of the energy k |q|^2 / 2 (state::Bends).
  struct Bend {
    std::array<std::uint32_t, 4> points = {};
    std::array<double, 4> weight = {};  ///< q is the sum of these times the points.
    double stiffness = 0;               ///< k [N/m]
    double damping = 0;                 ///< tau [s]
  };
  /// How a spring resists changes of its vector, times h: along its direction and across it [kg].
  struct Resistance {
    DVec3 direction = {};
    double along = 0;
    double across = 0;
  };

  void take_points(const state::Deformable& cloth, std::span<const Vec3> unsprung,
                   const state::Tables& tables);
  void take_springs(const state::Deformable& cloth, const state::Springs& springs);
  void take_bends(const state::Deformable& cloth, const state::Bends& bends);
  [[nodiscard]] DVec3 vector_at_end(const Spring& spring, std::span<const DVec3> v) const;
  [[nodiscard]] double tension(const Spring& spring, double length) const;
  [[nodiscard]] double energy(std::span<const DVec3> v) const;
  void linearize_bends();
  void linearize_freely();
  void restrict_to_freedom();
  void set_sizes();
  void resist();
  [[nodiscard]] double precondition();
  [[nodiscard]] double go_along(double size);
  [[nodiscard]] double largest_wanted() const;
  [[nodiscard]] bool lacks_motion() const;
  [[nodiscard]] bool is_turn(std::size_t unknown) const;
  [[nodiscard]] bool may_go_on() const;
  [[nodiscard]] bool find_change();
  [[nodiscard]] bool go_down();
  [[nodiscard]] bool renew_touches();
  [[nodiscard]] bool find_minimum();
  void add_given(const Problem& problem, std::uint32_t first_particle, DVec3 center, DVec3& made,
                 DVec3& spin_made) const;
  void keep_momentum(const Problem& problem, std::uint32_t first_particle);

  double h_ = 0;         ///< Length of the substep [s].
  double rigid_ = 0;     ///< Stiffness of what is rigid [N/m].
  double accepted_ = 0;  ///< Size of the residual that is small enough; below 0 as long as it is not known.
  double accepted_length_ = 0;  ///< What points may still want to move in the substep [m].
  bool is_held_ = false;        ///< Some point is held, or hooked to what does not give way.
  int directions_ = 0;          ///< Conjugate directions so far.
  double energy_ = 0;           ///< The sum at v_ [J].

  std::vector<Spring> springs_;
  std::vector<Resistance> resistances_;  ///< By spring.
  std::vector<Bend> bends_;
  PressingBodies bodies_;
  ClothLoads loads_;
  std::size_t points_ = 0;  ///< Their number.
  // By point.
  std::vector<DVec3> x_;  ///< Positions when the substep begins [m].
  // By unknown: points, then two vectors of each body.
  std::vector<double> mass_;     ///< [kg]; 0 for what is held.
  std::vector<DVec3> unsprung_;  ///< u [m/s]
  std::vector<DVec3> v_;         ///< [m/s]
  std::vector<DVec3> change_;    ///< Of v in this step [m/s].
  std::vector<DVec3> trial_;
  std::vector<DVec3> from_passes_;  ///< What the table held before [m/s].
  std::vector<math::Symmetric3<double>> per_diagonal_;
  std::vector<DVec3> residual_, wanted_, direction_, image_;
};

}  // namespace hooke::solver
