#pragma once

#include "solver/soft/soft_groups.h"
#include "solver/solid/stiff_rows.h"
#include "solver/solid/stiff_ties.h"
#include "solver/surface/surface_groups.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace hooke::solver {

/// Groups of solids that are solved at once, since they are stiff and touch, or since hooks hold them.
struct JoinedSolids {
  /// Ranges of `parts`, `rows` and `ties`.
  struct System {
    std::size_t first_part = 0, end_part = 0;
    std::size_t first_row = 0, end_row = 0;
    std::size_t first_tie = 0, end_tie = 0;
  };

  std::vector<System> systems;
  std::vector<TetrahedronBlocks*> parts;  ///< System after system.
  std::vector<StiffRow> rows;             ///< System after system.
  std::vector<StiffTie> ties;             ///< System after system.
  std::vector<std::uint32_t> system_of;   ///< By soft group: 1 + its system; 0 for one that is solved alone.
  std::vector<std::uint32_t> hooks;       ///< Rows of the hooks of stiff solids.
  std::vector<std::array<std::uint32_t, 2>>
      tied;                            ///< By tie and face: its body, and the group of its points.
  base::DisjointSets sets;             ///< Scratch memory, as is all below.
  std::vector<std::uint32_t> part_of;  ///< By soft group: its number within its system.

  /// Whether a group is solved with others.
  [[nodiscard]] bool has(const SoftGroups& soft, const SoftGroup& group) const {
    return system_of[static_cast<std::size_t>(&group - soft.groups.data())] != 0;
  }
  [[nodiscard]] StiffSystem at(const System& system) {
    return {.parts = std::span(parts).subspan(system.first_part, system.end_part - system.first_part),
            .rows = std::span(rows).subspan(system.first_row, system.end_row - system.first_row),
            .ties = std::span(ties).subspan(system.first_tie, system.end_tie - system.first_tie)};
  }
};

/// Marks the solids whose contacts belong to their stiff solution. Call it before contacts are found.
void mark_stiff_solids(const state::Tables& tables, const SoftGroups& soft, SurfaceContacts& contacts);

/// Lists the solids that are solved at once, the contacts between them, those of their `faces` with bodies,
/// and their hooks in a substep of `h` [s].
void list_joined_solids(const state::Tables& tables, const SurfaceContacts& contacts,
                        std::span<const state::ElementContact> faces, Real h, SoftGroups& soft,
                        JoinedSolids& joined);

}  // namespace hooke::solver
