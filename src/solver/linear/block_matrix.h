#pragma once

#include "base/assert.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

/// \file
/// Symmetric matrices of small dense blocks, positive definite or quasi-definite, in double. An order of
/// elimination with little fill is found once. The factors L D L^T and their solution then are a fixed list
/// of operations; columns with the same rows below them are factored together, as a dense panel. Neither
/// depends on anything but the matrix. Quasi-definite matrices (a positive and a negative definite diagonal
/// part) have these factors in any order (Vanderbei 1995, "Symmetric quasi-definite matrices").

namespace hooke::solver {

/// Where the blocks of a matrix and of its factor stand, numbered in order of elimination.
struct BlockPattern {
  /// Block (row, column) of the lower triangle, stored by rows.
  struct Block {
    std::uint32_t row = 0;
    std::uint32_t column = 0;
    std::uint32_t offset = 0;  ///< Position of its first number.
  };
  /// target -= left D right^T, where D belongs to the column of both.
  struct Update {
    std::uint32_t left = 0, right = 0, target = 0;  ///< Blocks.
  };

  std::vector<std::uint32_t> order;  ///< The node that is eliminated i-th.
  std::vector<int> size;             ///< Size of each block row.
  std::vector<std::int8_t> sign;     ///< Sign of each block row's pivots: 1, or -1 by set_signs.
  std::vector<int> first;            ///< First number of each block row in a vector; one more at the end.
  std::vector<Block> block;          ///< Blocks by column, the diagonal first.
  std::vector<std::uint32_t> column_begin;  ///< First block of each column; one more at the end.
  std::vector<Update> update;               ///< Updates by column.
  std::vector<std::uint32_t> update_begin;  ///< First update of each column; one more at the end.
  /// First column of each run of columns that have the same rows below the run; one more at the end.
  std::vector<std::uint32_t> run_begin;
  std::uint32_t number_count = 0;  ///< Numbers in all blocks.
  double operations = 0;           ///< Multiplications of one factorization.

  [[nodiscard]] int node_count() const { return static_cast<int>(size.size()); }
};

/// The graph of the nodes of a matrix that share a block, and the memory to find an order of elimination.
class BlockGraph {
 public:
  /// Starts with `count` nodes without neighbors.
  void reset(std::size_t count);
  /// Makes nodes a and b neighbors. Each pair may be told often; a node and itself never.
  void join(std::uint32_t a, std::uint32_t b) {
    HOOKE_ASSERT(a != b && a < count_ && b < count_);
    neighbors_[a].push_back(b);
    neighbors_[b].push_back(a);
  }
  [[nodiscard]] std::size_t count() const { return count_; }

 private:
  friend bool make_block_pattern(BlockGraph& graph, std::span<const int> sizes, double budget,
                                 BlockPattern& pattern);

  void sort();
  bool eliminate(std::span<const int> sizes, double budget, BlockPattern& pattern);
  void list_blocks(BlockPattern& pattern);
  void eliminate_node(std::uint32_t node);

  std::size_t count_ = 0;
  /// Neighbors of each node. Once a node is eliminated, they are the remaining nodes that were adjacent to
  /// it by then, its column of the factor.
  std::vector<std::vector<std::uint32_t>> neighbors_;
  // Scratch, to be used again.
  std::vector<std::pair<std::size_t, std::uint32_t>> queue_;  ///< A heap, with entries that are out of date.
  std::vector<std::uint8_t> eliminated_;                      ///< By node.
  std::vector<std::uint32_t> joined_;
  std::vector<std::uint32_t> place_;
  std::vector<int> sizes_in_order_;
};

/// Replaces `pattern` by minimum degree, with ties to the lowest node: chains and trees have no fill. It
/// uses the graph up. It returns false, and a pattern of no use, if one factorization takes more than
/// `budget` multiplications.
[[nodiscard]] bool make_block_pattern(BlockGraph& graph, std::span<const int> sizes, double budget,
                                      BlockPattern& pattern);

/// Gives the block rows other sizes, which may be 0; `operations` stays what it was.
void resize_blocks(std::span<const int> sizes, BlockPattern& pattern);

/// Makes the matrix quasi-definite: block rows of nodes with sign -1 are negative definite, the others
/// positive.
void set_signs(std::span<const std::int8_t> sign_of_node, BlockPattern& pattern);

/// The block (row, column), which must exist; row >= column.
[[nodiscard]] std::uint32_t find_block(const BlockPattern& pattern, std::uint32_t row, std::uint32_t column);

/// Factors A = L D L^T in place: L below the diagonals (unit lower triangles), D on them. A pivot without
/// the sign of its row counts as infinite, so that its row gets zero.
void factor(const BlockPattern& pattern, std::span<double> numbers, std::vector<double>& scratch);

/// Computes x := A^-1 x by the factors.
void solve(const BlockPattern& pattern, std::span<const double> numbers, std::span<double> x);

/// Computes x := x - A^-1 C x, with a diagonal C that A contains: of a solution x, that takes out what A - C
/// takes to zero, and twofold C elsewhere. `scratch` gets the part that is taken out
/// (docs/decisions/0033-impulses-that-no-body-feels.md).
void remove_unfelt(const BlockPattern& pattern, std::span<const double> numbers,
                   std::span<const double> compliance, std::span<double> x, std::vector<double>& scratch);

}  // namespace hooke::solver
