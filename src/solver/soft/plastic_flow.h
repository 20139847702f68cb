#pragma once

#include "parallel/range.h"
#include "solver/soft/bending.h"
#include "solver/solid/tetrahedron_blocks.h"
#include "state/tables.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// What is bent or pressed beyond its limit keeps a part of its new form. The state consists of the rest
/// angles and shape gradients of the tables; the solver's copies follow row by row.

namespace hooke::solver {

/// A bend that yields: its row in the table and its position in the solver's copy.
struct BendYield {
  std::uint32_t row = 0;  ///< Counted from BendBlocks::first_row.
  std::uint32_t block = 0;
  std::uint32_t lane = 0;
  std::uint32_t end_lane = 0;  ///< End of its lane and of the copies that fill the block behind it.
  Real angle = Real(0);        ///< Largest |theta - theta_0| [rad].
};

/// A tetrahedron that can yield.
struct TetrahedronYield {
  std::uint32_t lane = 0;          ///< In the solver's copy, counted through all blocks.
  std::uint32_t end_lane = 0;      ///< End of its lane and of the copies that fill the block behind it.
  Real stress = Real(0);           ///< sigma_y [Pa]
  std::array<Vec3, 3> edges = {};  ///< Edges of the tetrahedron as it was made, state::RestEdges.
};

struct Yields {
  std::vector<BendYield> bends;
  std::vector<TetrahedronYield> tetrahedra;
};

/// Lists all rows of objects that can yield, with their positions in the solver's copies, which are of these
/// objects.
void find_yields(std::span<const state::Deformable> objects, const BendBlocks& bends,
                 const TetrahedronBlocks& tetrahedra, Yields& yields);

/// Applies perfect plasticity: where |theta - theta_0| is above the limit, theta_0 follows until the
/// difference is at the limit. Degenerate triangles keep their theta_0.
void flow_bends(const Yields& yields, parallel::Range rows, state::Tables& tables, BendBlocks& bends);

/// Applies von Mises plasticity without hardening, with the gradient divided as F = F_e F_p (Lee 1969; for
/// tetrahedra Irving, Teran and Fedkiw 2004). F_e = sum x_i b_i^T uses the b_i of the present shape at rest,
/// so that they contain F_p. Where the stress is above sigma_y, b_i becomes X b_i (elements/plasticity.h):
/// det F_e and the volume at rest stay, and dev F_e F_e^T falls to what sigma_y carries. mu is that of the
/// substep (prepare_tetrahedra).
///
/// Tetrahedra that are inside out, or pressed to less than a hundredth of their volume, keep their shape at
/// rest. So do those whose F_p would come to tr F_p F_p^T or tr (F_p F_p^T)^-1 above 25: no plastic stretch
/// leaves [1/5, 5].
void flow_tetrahedra(const Yields& yields, parallel::Range rows, Real h, state::Tables& tables,
                     TetrahedronBlocks& tetrahedra);

}  // namespace hooke::solver
