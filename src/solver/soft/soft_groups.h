#pragma once

#include "solver/air/air.h"
#include "solver/soft/bending.h"
#include "solver/soft/isometric_bending.h"
#include "solver/soft/plastic_flow.h"
#include "solver/soft/spring_blocks.h"
#include "solver/soft/yarns.h"
#include "solver/solid/tetrahedron_blocks.h"
#include "state/tables.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

/// \file
/// The solver's copies of springs, bends, tetrahedra and triangles, in groups of neighboring objects. A
/// change of one object makes the copies of its group anew and of no other
/// (docs/decisions/0034-soft-groups.md).
///
/// No row joins two objects. So the colors of an object, and the order in which its rows act on its
/// particles, are the same in every group, and which objects share a group changes no bit. A large object is
/// a group of its own. So is a stiff solid, whose rows are solved at once and would have to wait for those of
/// others. Other small ones share groups, because lanes would be empty otherwise.

namespace hooke::solver {

/// The copies of neighboring objects. Rows in it count from the first rows of the group, which may move.
struct SoftGroup {
  std::vector<std::uint64_t> revisions;  ///< state::Deformable::revision of each object.
  std::uint32_t first_object = 0;        ///< Row of the first object.
  std::size_t size = 0;                  ///< Number of particles and rows.
  Yarns yarns;
  SpringBlocks springs;
  BendBlocks bends;
  IsometricBendBlocks isometric_bends;
  TetrahedronBlocks tetrahedra;
  Yields yields;  ///< Bends and tetrahedra that may yield.
  AirLoads air_loads;

  [[nodiscard]] std::size_t end_object() const { return first_object + revisions.size(); }
};

struct SoftGroups {
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  std::vector<SoftGroup> groups;        ///< In the order of objects.
  std::vector<std::uint32_t> group_of;  ///< By row of the object; kNone for one outside all groups.
  std::vector<std::uint32_t> whole;     ///< Groups that one thread at a time solves.
  std::vector<std::uint32_t> divided;   ///< Groups so large that all threads share each of their passes.
  std::size_t whole_size = 0;           ///< Sum of the sizes of `whole`.
  std::uint64_t built_objects = 0;      ///< How often an object was copied, since the beginning.
  std::vector<std::uint64_t> stiff;     ///< Revisions of objects found stiff, ascending: they share no group.

  std::vector<SoftGroup> before;  ///< Scratch memory of refresh_soft_groups, as is all below.
  std::vector<std::pair<std::uint64_t, std::uint32_t>> before_by_revision;
};

/// Makes the copies of objects that came, went or changed anew, and moves those of the others to where their
/// rows are now. `workers` decides which groups are divided, which changes no result.
void refresh_soft_groups(const state::Tables& tables, int workers, SoftGroups& groups);

/// Sets the coefficients of all rows of a group for a substep of `h` [s].
void prepare_soft_group(SoftGroup& group, Real h);

/// Gives each solid with a stiff row, which prepare_soft_group has found, a group of its own. Returns whether
/// any group is new, so that all have to be prepared again.
[[nodiscard]] bool separate_stiff_solids(const state::Tables& tables, int workers, SoftGroups& groups);

}  // namespace hooke::solver
