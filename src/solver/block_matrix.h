#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

/// \file
/// Symmetric matrices of small dense blocks, positive definite or quasi-definite: an order of elimination
/// with little fill, found once, then the factors L D L^T and their solution as a fixed list of operations,
/// in double. Neither depends on anything but the matrix. Quasi-definite matrices (a positive and a negative
/// definite diagonal part) have these factors in any order (Vanderbei 1995, "Symmetric quasi-definite
/// matrices").

namespace hooke::solver {

/// Where the blocks of a matrix and of its factor stand, numbered in order of elimination.
struct BlockPattern {
  /// Block (row, column) of the lower triangle, stored by rows.
  struct Block {
    std::uint32_t row = 0;
    std::uint32_t column = 0;
    std::uint32_t offset = 0;  ///< Of its first number.
  };
  /// target -= left D right^T, D that of the column of both.
  struct Update {
    std::uint32_t left = 0, right = 0, target = 0;  ///< Blocks.
  };

  std::vector<std::uint32_t> order;         ///< The node that is eliminated i-th.
  std::vector<int> size;                    ///< Of block row i.
  std::vector<std::int8_t> sign;            ///< Of block row i's pivots: 1, or -1 by set_signs.
  std::vector<int> first;                   ///< Of block row i's numbers in a vector; one more at the end.
  std::vector<Block> block;                 ///< By column, the diagonal first.
  std::vector<std::uint32_t> column_begin;  ///< Of blocks; one more at the end.
  std::vector<Update> update;               ///< By column.
  std::vector<std::uint32_t> update_begin;  ///< Of each column; one more at the end.
  std::uint32_t number_count = 0;           ///< Of all blocks.
  double operations = 0;                    ///< Multiplications of one factorization.

  [[nodiscard]] int node_count() const { return static_cast<int>(size.size()); }
};

/// Minimum degree, ties to the lowest node: chains and trees have no fill. `neighbors` of each node are
/// sorted, without itself. Nothing if one factorization takes more than `budget` multiplications.
[[nodiscard]] std::optional<BlockPattern> make_block_pattern(
    const std::vector<std::vector<std::uint32_t>>& neighbors, const std::vector<int>& sizes, double budget);

/// Gives the block rows other sizes, which may be 0; `operations` stays what it was.
void resize_blocks(std::span<const int> sizes, BlockPattern& pattern);

/// Makes the matrix quasi-definite: block rows of nodes with sign -1 are negative definite, the others
/// positive.
void set_signs(std::span<const std::int8_t> sign_of_node, BlockPattern& pattern);

/// The block (row, column), which exists; row >= column.
[[nodiscard]] std::uint32_t find_block(const BlockPattern& pattern, std::uint32_t row, std::uint32_t column);

/// A = L D L^T in place: L below the diagonals (unit lower triangles), D on them. A pivot that has not the
/// sign of its row counts as infinite, so that its row gets zero.
void factor(const BlockPattern& pattern, std::span<double> numbers);

/// x := A^-1 x, by the factors.
void solve(const BlockPattern& pattern, std::span<const double> numbers, std::span<double> x);

}  // namespace hooke::solver
