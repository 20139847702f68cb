#pragma once

#include "hooke/math.h"

#include "solver/simd/lanes.h"
#include "state/objects.h"
#include "state/particles.h"
#include "state/springs.h"

#include <cstdint>
#include <span>
#include <vector>

/// \file
/// The points and rows of one cloth as grids, from its own points to ever fewer cells of them: how the
/// solution of cloths under loads (solver/cloth/cloth_solution.h) sees them.

namespace hooke::solver {

/// One number for each of 16 points.
struct alignas(64) PointLanes {
  Real of[kLanes];
};

/// A velocity or an impulse of a point, in one load and store.
struct alignas(4 * sizeof(Real)) PointVector {
  Vec3 of = {};
  Real unused = Real(0);
};

/// How 16 points of a grid, each with one of its neighbors, resist moving apart. What is not there has the
/// point itself as neighbor and resists nothing.
struct alignas(64) NeighborLanes {
  std::uint32_t record[kLanes];  ///< 4 times the neighbor: where its PointVector begins, in numbers.
  Real resist[6][kLanes];        ///< Symmetric matrix B [kg]: the impulse B (v - v_neighbor) resists.
};

/// The law of the rows between 16 points and one neighbor of each. The coefficients are those of one substep.
struct alignas(64) RowLanes {
  Real rest_length[kLanes];  ///< L [m]
  Real gain[kLanes];         ///< h (c + h k) [kg]
  Real bias[kLanes];         ///< k / (c + h k) [1/s]
  Real limit[kLanes];        ///< Largest length [m]; very large for none.
  Real limit_gain[kLanes];   ///< The gain of the limit [kg].
  Real limited[kLanes];      ///< 1 where the limit acts, otherwise 0; written by linearize.
};

/// A symmetric matrix for each of 16 points.
struct alignas(64) MatrixLanes {
  Real of[6][kLanes];
};

/// A grid: the points of a cloth, or cells of points of the finer grid, which move as one. Points stand in
/// blocks of 16, and the last block is filled with points that have no mass. Behind them all stands one more
/// point, which never moves: on coarser grids it stands for all that is pinned.
struct ClothGrid {
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  std::uint32_t count = 0;                ///< Number of points.
  std::vector<std::uint32_t> first_lane;  ///< By block, and one more: its first entry of `neighbors`.
  std::vector<NeighborLanes> neighbors;
  std::vector<PointLanes> mass;      ///< By block [kg]; 0 for what does not move.
  std::vector<MatrixLanes> inverse;  ///< By block: kSmoothing (mass + sum B)^-1 [1/kg].
  std::vector<std::uint32_t> cell;   ///< By point: its point on the next grid; kNone for what is pinned.
  std::vector<std::uint32_t> first_member;  ///< By point of the next grid, and one more: its first member.
  std::vector<std::uint32_t> member;
  /// By lane of `neighbors`, and one more: its first entry of `source`. Not on the finest grid.
  std::vector<std::uint32_t> first_source;
  std::vector<std::uint32_t> source;  ///< Lane of the finer grid's neighbors.
  std::vector<PointVector> residual, velocity, scratch;

  [[nodiscard]] int blocks() const { return static_cast<int>(mass.size()); }
};

/// The stiffness of a row, from which its coefficients are made.
struct ClothRowLaw {
  Real stiffness = Real(0);  ///< k [N/m]; infinity is rigid.
  Real damping = Real(0);    ///< c [N s/m]
  bool has_limit = false;
};

/// The stretch springs and limits of one cloth, on all of its grids.
struct ClothGrids {
  std::uint32_t first_particle = 0;
  std::vector<RowLanes> rows;        ///< One for each entry of the finest grid's neighbors.
  std::vector<ClothRowLaw> laws;     ///< By lane of `rows`.
  std::vector<ClothGrid> grids;      ///< The finest first.
  std::vector<std::uint8_t> held;    ///< By point: 1 if it was pinned when grids were made.
  std::vector<std::uint32_t> order;  ///< Points in the order in which cells are made of them.
  bool has_limits = false;
  Real edge = Real(0);  ///< Mean length of a spring at rest [m].

  [[nodiscard]] ClothGrid& finest() { return grids.front(); }
};

/// Makes the finest grid of a cloth and the laws of its rows.
void build_cloth_grids(const state::Deformable& object, const state::Springs& springs,
                       const state::Particles& particles, ClothGrids& cloth);

/// Sets the coefficients of rows for a substep of `h` [s], and makes coarser grids anew if other points are
/// pinned than before. Call it once a step.
void prepare_cloth_grids(const state::Particles& particles, Real h, ClothGrids& cloth);

/// Takes masses from particles, whose number `grid` has.
void take_masses(const state::Particles& particles, std::uint32_t first_particle, ClothGrid& grid);

/// Finds the rows of a coarser grid from those of the finer one.
void coarsen_rows(const ClothGrid& finer, ClothGrid& grid);

}  // namespace hooke::solver
