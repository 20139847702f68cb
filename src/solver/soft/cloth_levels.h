#pragma once

#include "parallel/range.h"
#include "solver/soft/spring_blocks.h"
#include "state/tables.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// What holds a cloth within its length as a whole: the same bound on its length at each scale.
///
/// One pass over springs passes on what a single point weighs. So cells of about four points are one point of
/// the next level, cells of those one of the level above, and so on. A cell has the mass of its points, their
/// mean position and mean velocity. Two cells beside each other may be as far apart as at rest, and by a
/// given share more. The rows that say so are solved from the coarsest level to the finest, before the
/// springs, and what a cell is changed by, its points are.
///
/// Such a row is one between weighted means of points, so that it keeps momentum and angular momentum and
/// takes energy, whatever the shape. A cell with held points is held where these are; its other points are
/// left to finer levels.
///
/// The means of two cells of one shape are at most as far apart as at rest in any shape of an inextensible
/// sheet, as each pair of points is. For others the bound grows by (s_a - s_b)^2 / 2 d, with s the deviation
/// of a cell's points across the way between the means, and d the length of it: the points are then paired in
/// the order of their places, and each pair keeps its own distance.

namespace hooke::solver {

/// A point of the level below, or of the cloth.
struct CellMember {
  std::uint32_t point = 0;       ///< Its row on that level; of the cloth, from the object's first particle.
  Real inverse_mass = Real(-1);  ///< w when `weight` was computed [1/kg]; below 0 before that.
  Real weight = Real(0);         ///< Share of the cell's mean; 0 for a free point of a cell that is held.
};

/// One level: its cells as points, with the rows between them.
struct ClothLevel {
  std::vector<std::uint32_t> first_member;  ///< By cell; one more at the end.
  std::vector<CellMember> members;
  std::vector<state::PositionRecord> position;
  std::vector<state::VelocityRecord> velocity;
  std::vector<Vec3> velocity_before;        ///< Before the rows of this level and the coarser ones [m/s].
  std::vector<Vec3> rest;                   ///< Mean position at rest [m].
  std::vector<std::array<Real, 6>> spread;  ///< Mean of xx, yy, zz, xy, yz, zx about it [m^2].
  std::vector<std::uint8_t> is_new;         ///< Masses changed in this substep, so that `rest` did.
  bool any_new = false;
  std::vector<SpringBlock> rows;
  std::vector<SpringPass> passes;  ///< One color each.
};

/// The levels of one cloth, the finest first.
struct ClothLevels {
  std::uint32_t object = 0;  ///< Row of the cloth, from the group's first object.
  Real extension = Real(0);  ///< By this share of its length at rest a part may be longer.
  SpringMaterial material;   ///< Of all rows.
  std::vector<ClothLevel> levels;
};

/// Makes the levels of a cloth, parts of which may be longer than at rest by the share `extension`.
[[nodiscard]] ClothLevels build_cloth_levels(const state::Deformable& cloth, Real extension,
                                             const state::Tables& tables);

/// Sets the coefficients of the rows for a substep of `h` [s].
void prepare_cloth_levels(ClothLevels& cloth, Real h);

/// Solves the rows of all levels and changes the velocities of the cloth's points.
void solve_cloth_levels(const state::Deformable& object, state::Particles& particles, ClothLevels& cloth);

}  // namespace hooke::solver
