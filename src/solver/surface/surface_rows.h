#pragma once

#include "solver/surface/surface_groups.h"

#include <array>
#include <cstdint>
#include <vector>

namespace hooke::solver {

/// Puts rows into blocks whose rows share no vertex. A row goes into the first open block that has none of
/// its vertices; a block that is full is closed, or the fullest one if all have some.
class SurfaceRowPacker {
 public:
  /// `in_open_block` is scratch memory by vertex, zero for those of the rows to come; it is zero again in the
  /// end.
  SurfaceRowPacker(std::vector<std::uint32_t>& in_open_block, std::vector<SurfaceRowBlock>& blocks)
      : in_open_block_(in_open_block), blocks_(blocks) {}

  void add(const SurfaceRow& row);
  /// Closes all blocks.
  void finish();

 private:
  static constexpr std::uint32_t kOpenBlocks = 32;

  void close(std::uint32_t number);

  std::array<SurfaceRowBlock, kOpenBlocks> open_ = {};
  std::vector<std::uint32_t>& in_open_block_;
  std::vector<SurfaceRowBlock>& blocks_;
};

/// Solves the rows of a group for a particle substep of `h` [s]: with s the gap less the distance that is
/// kept, at the start of the substep,
///
///     apart (s > 0)       n.v >= -s / h
///     overlapping         n.v >= min(0.3 (-s) / h, 1 m/s)
///     friction            |v_t| falls by at most mu times the change of n.v
///
/// with v = sum weight v of the four vertices. An impulse p changes v_i by weight_i w_i p. `again` goes on
/// with the impulses that rows have in this substep.
void solve_surface_rows(Real h, bool again, SurfaceContacts& contacts, SurfaceGroup& group,
                        state::Particles& particles);

}  // namespace hooke::solver
