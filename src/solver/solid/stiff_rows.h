#pragma once

#include "math/symmetric.h"
#include "solver/solid/solid_tuning.h"
#include "solver/solid/stiff_ties.h"
#include "solver/solid/weighted_points.h"

#include <cstdint>
#include <span>

/// \file
/// Contacts of solids with each other in the stiff solution, and of their faces with bodies. Stopped after
/// it, as light points, they strain what is stiff: cubes of 100 MPa that fell on each other by 2 cm gained
/// ten times their energy.

namespace hooke::solver {

/// A contact of points of solids, of which two sides keep apart along a normal, or of a place of a face, by
/// its three points, that keeps apart from a body. It resists the velocity u at
/// which they part as a stiff damper that only pushes, and friction as one that slides:
///
///   p = max(0, carried - stiffness (n.u - least_speed)),   |f| = min(stiffness, mu p / |u_t|) |u_t|
///
/// both at the velocities after the solution, so that they take energy and give none. `carried` is what the
/// solution before found, so that the sides come to keep their least speed (augmented Lagrangian, Hestenes
/// 1969).
struct StiffRow {
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  WeightedPoints<4> corners = {};
  StiffEnd other = {};         ///< The body or what does not give way, if the points are of one side alone.
  std::uint32_t face = kNone;  ///< Row of the face's contact with a body, if it is one.
  DVec3 normal = {};           ///< Unit vector from the second side to the first.
  double friction = 0;         ///< Coefficient of the pair.
  double least_speed = 0;      ///< At which the sides are to part, at least [m/s].
  DVec3 before = {};           ///< Velocity of the first side relative to the second [m/s].
  double stiffness = 0;        ///< [kg]
  double drag = 0;             ///< Of friction, across the normal [kg].
  double carried = 0;          ///< Impulse along the normal that is given anyway [N s].
  bool pushes = false;
  bool let_go = false;  ///< It does not push in the next solution either.

  /// The impulse on the first side for a velocity at which the sides part [N s].
  [[nodiscard]] DVec3 resistance(DVec3 u) const {
    const double along = dot(normal, u);
    return (stiffness * along) * normal + drag * (u - along * normal);
  }
};

/// What is solved at once: groups of solids, the contacts between them, and their hooks.
struct StiffSystem {
  StiffParts parts;
  std::span<StiffRow> rows;
  std::span<StiffTie> ties;
  double size = 0;                       ///< Square of the residual, by per_diagonal [J].
  double first_size = 0;                 ///< That of the forces.
  double error = kFirstStiffSolidError;  ///< Share of the first residual down to which it is solved [ratio].
  int solutions = 0;                     ///< Directions taken in this substep.
};

/// Chooses how stiff each row is, by its corners, and which ones push at first. Call it after rows of stress
/// have been linearized.
void prepare_stiff_rows(const state::Tables& tables, const StiffSystem& system);

/// Adds what rows add to the diagonals of their corners.
void add_row_diagonals(const StiffSystem& system);

/// Adds the impulses of rows at the velocities before to the residuals.
void add_row_forces(const StiffSystem& system);

/// Adds the impulses by which rows resist the direction to the images.
void resist_stiff_rows(const StiffSystem& system);

/// Lets go what pulls, and finds friction anew. Takes hold of what would pass if `may_hold`; otherwise
/// friction only falls. Returns whether the rows are to be solved once more.
[[nodiscard]] bool renew_stiff_rows(bool may_hold, const StiffSystem& system);

/// Gives bodies the opposite of what the solution has given the faces that they press on, and notes the
/// forces of these contacts, in a substep of `h` [s]. It changes bodies: call it for one system after the
/// other.
void release_stiff_rows(Real h, const StiffSystem& system, std::span<state::ElementContact> faces,
                        state::Tables& tables);

}  // namespace hooke::solver
