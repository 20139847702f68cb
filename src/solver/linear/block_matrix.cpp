#include "solver/linear/block_matrix.h"

#include "base/assert.h"
#include "base/reset_lists.h"
#include "base/sort_unique.h"
#include "solver/linear/dense_panel.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <iterator>
#include <limits>

namespace hooke::solver {

namespace {

double cost_of(int own, double below) {
  return own * own * own / 6.0 + own * own * below + 0.5 * own * below * below;
}

void list_updates(BlockPattern& p) {
  p.update.clear();
  p.update_begin.assign(1, 0);
  for (std::uint32_t j = 0; j < p.order.size(); ++j) {
    for (std::uint32_t left = p.column_begin[j] + 1; left < p.column_begin[j + 1]; ++left) {
      for (std::uint32_t right = p.column_begin[j] + 1; right <= left; ++right) {
        p.update.push_back({left, right, find_block(p, p.block[left].row, p.block[right].row)});
      }
    }
    p.update_begin.push_back(static_cast<std::uint32_t>(p.update.size()));
  }
}

/// Finds runs: the rows below a column are the next column and the rows below that.
void list_runs(BlockPattern& p) {
  p.run_begin.assign(1, 0);
  for (std::uint32_t j = 1; j < p.order.size(); ++j) {
    const auto before = p.block.begin() + p.column_begin[j - 1];
    const auto begin = p.block.begin() + p.column_begin[j];
    const auto end = p.block.begin() + p.column_begin[j + 1];
    const bool continues =
        end - begin == begin - before - 1 &&
        std::equal(begin, end, before + 1, [](const auto& a, const auto& b) { return a.row == b.row; });
    if (!continues) p.run_begin.push_back(j);
  }
  p.run_begin.push_back(static_cast<std::uint32_t>(p.order.size()));
}

/// Factors one dense block in place: L D L^T.
void factor_diagonal(double sign, double* a, int n) {
  for (int j = 0; j < n; ++j) {
    double pivot = a[j * n + j];
    for (int k = 0; k < j; ++k) pivot -= a[j * n + k] * a[j * n + k] * a[k * n + k];
    if (!(sign * pivot > 0)) pivot = sign * std::numeric_limits<double>::max();
    a[j * n + j] = pivot;
    for (int i = j + 1; i < n; ++i) {
      double sum = a[i * n + j];
      for (int k = 0; k < j; ++k) sum -= a[i * n + k] * a[j * n + k] * a[k * n + k];
      a[i * n + j] = sum / pivot;
    }
  }
}

/// Computes B := B L^-T D^-1 for a block of m rows below the diagonal block of n.
void factor_below(const double* diagonal, int n, double* b, int m) {
  for (int r = 0; r < m; ++r) {
    double* x = b + static_cast<std::ptrdiff_t>(r) * n;
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < j; ++k) x[j] -= x[k] * diagonal[j * n + k];
    }
    for (int j = 0; j < n; ++j) x[j] /= diagonal[j * n + j];
  }
}

/// The part of a column below its diagonal: its blocks stand one after the other.
struct ColumnBelow {
  const double* numbers;
  std::size_t rows = 0;
};

ColumnBelow below_diagonal(const BlockPattern& p, int column, std::span<const double> numbers) {
  const BlockPattern::Block& diagonal = p.block[p.column_begin[column]];
  const auto n = static_cast<std::size_t>(p.size[column]);
  std::size_t rows = 0;
  for (std::uint32_t b = p.column_begin[column] + 1; b < p.column_begin[column + 1]; ++b)
    rows += static_cast<std::size_t>(p.size[p.block[b].row]);
  return {numbers.data() + diagonal.offset + n * n, rows};
}

/// Computes D L^T of a column below its diagonal, by rows.
void scale_transposed(const double* diagonal, std::size_t n, const ColumnBelow& below,
                      std::vector<double>& scaled) {
  if (scaled.size() < n * below.rows) scaled.resize(n * below.rows);
  for (std::size_t k = 0; k < n; ++k) {
    const double d = diagonal[k * n + k];
    for (std::size_t r = 0; r < below.rows; ++r) scaled[k * below.rows + r] = d * below.numbers[r * n + k];
  }
}

/// Subtracts the product of a row of n numbers and n rows of kWidth, `stride` apart.
template <int kWidth>
void subtract_row(const double* x, std::size_t n, const double* y, std::size_t stride, double* target) {
  double sum[kWidth];
  for (int c = 0; c < kWidth; ++c) sum[c] = target[c];
  for (std::size_t k = 0; k < n; ++k) {
    for (int c = 0; c < kWidth; ++c) sum[c] -= x[k] * y[k * stride + static_cast<std::size_t>(c)];
  }
  for (int c = 0; c < kWidth; ++c) target[c] = sum[c];
}

/// Does that for three rows of three numbers, as two joints of points have them.
void subtract_three(const double* x, const double* y, std::size_t stride, double* target) {
  for (int r = 0; r < 3; ++r, x += 3, target += 3) {
    double sum[3] = {target[0], target[1], target[2]};
    for (int k = 0; k < 3; ++k) {
      const double* factor = y + static_cast<std::size_t>(k) * stride;
      for (int c = 0; c < 3; ++c) sum[c] -= x[k] * factor[c];
    }
    for (int c = 0; c < 3; ++c) target[c] = sum[c];
  }
}

/// Subtracts left D right^T from the target; `scaled` comes from scale_transposed. Several numbers are
/// summed side by side, which compilers may not do with a single sum.
void subtract_product(const BlockPattern& p, const BlockPattern::Update& u, const ColumnBelow& below,
                      const std::vector<double>& scaled, std::span<double> numbers) {
  const BlockPattern::Block& left = p.block[u.left];
  const BlockPattern::Block& right = p.block[u.right];
  const auto n = static_cast<std::size_t>(p.size[left.column]);
  const auto rows = static_cast<std::size_t>(p.size[left.row]);
  const auto columns = static_cast<std::size_t>(p.size[right.row]);
  if (n == 0) return;
  const double* x = numbers.data() + left.offset;
  if (n == 3 && rows == 3 && columns == 3) {
    const double* three = scaled.data() + (numbers.data() + right.offset - below.numbers) / 3;
    return subtract_three(x, three, below.rows, numbers.data() + p.block[u.target].offset);
  }
  const double* y = scaled.data() + (numbers.data() + right.offset - below.numbers) / static_cast<int>(n);
  double* target = numbers.data() + p.block[u.target].offset;
  for (std::size_t r = 0; r < rows; ++r, x += n, target += columns) {
    std::size_t c = 0;
    for (; c + 4 <= columns; c += 4) subtract_row<4>(x, n, y + c, below.rows, target + c);
    for (; c + 2 <= columns; c += 2) subtract_row<2>(x, n, y + c, below.rows, target + c);
    for (; c < columns; ++c) subtract_row<1>(x, n, y + c, below.rows, target + c);
  }
}

/// Factors one column, and subtracts its products from later ones.
void factor_column(const BlockPattern& p, std::uint32_t j, std::span<double> numbers,
                   std::vector<double>& scaled) {
  double* diagonal = numbers.data() + p.block[p.column_begin[j]].offset;
  factor_diagonal(p.sign[j], diagonal, p.size[j]);
  for (std::uint32_t b = p.column_begin[j] + 1; b < p.column_begin[j + 1]; ++b)
    factor_below(diagonal, p.size[j], numbers.data() + p.block[b].offset, p.size[p.block[b].row]);
  const ColumnBelow below = below_diagonal(p, static_cast<int>(j), numbers);
  scale_transposed(diagonal, static_cast<std::size_t>(p.size[j]), below, scaled);
  for (std::uint32_t u = p.update_begin[j]; u < p.update_begin[j + 1]; ++u)
    subtract_product(p, p.update[u], below, scaled, numbers);
}

/// Copies a few numbers, mostly three or six: faster than a call.
void copy_few(const double* from, std::size_t n, double* to) {
  for (; n >= 3; n -= 3, from += 3, to += 3) {
    to[0] = from[0];
    to[1] = from[1];
    to[2] = from[2];
  }
  for (std::size_t i = 0; i < n; ++i) to[i] = from[i];
}

/// A run of columns, factored as a dense panel: the same operations on each number in the same order.
class DenseRun {
 public:
  DenseRun(const BlockPattern& pattern, std::uint32_t begin, std::uint32_t end)
      : p_(pattern), begin_(begin), end_(end) {
    for (std::uint32_t j = begin; j < end; ++j) panel_.columns += size_of(j);
    panel_.rows = panel_.columns;
    for (std::uint32_t b = first_below(); b < p_.column_begin[end_]; ++b)
      panel_.rows += size_of(p_.block[b].row);
    panel_.stride = panel_.rows + wide::kPanelPadding;
    triangle_.stride = panel_.rows_below() + wide::kPanelPadding;
  }

  /// Whether it is large enough for copies to pay.
  [[nodiscard]] bool pays() const {
    return panel_.columns >= kLeastDenseColumns && panel_.rows >= kLeastDenseRows;
  }

  void factor(std::span<double> numbers, std::vector<double>& scratch) {
    const std::size_t panel = panel_.columns * panel_.stride;
    const std::size_t needed = 2 * panel + (panel_.rows_below() + wide::kTriangleRows) * triangle_.stride;
    if (scratch.size() < needed) scratch.resize(needed);
    panel_.numbers = scratch.data();
    triangle_.numbers = scratch.data() + 2 * panel;
    load_panel(numbers);
    eliminate(numbers);
    if (panel_.rows_below() > 0) {
      for_updates(numbers, [](double* row, double* own, std::size_t n) { copy_few(row, n, own); });
      wide::subtract_products(panel_, scratch.data() + panel, triangle_);
      for_updates(numbers, [](double* row, double* own, std::size_t n) { copy_few(own, n, row); });
    }
    store_panel(numbers);
  }

 private:
  static constexpr std::size_t kLeastDenseColumns = 6;
  static constexpr std::size_t kLeastDenseRows = 18;

  [[nodiscard]] std::size_t size_of(std::uint32_t row) const {
    return static_cast<std::size_t>(p_.size[row]);
  }
  [[nodiscard]] std::uint32_t first_below() const { return p_.column_begin[end_ - 1] + 1; }
  [[nodiscard]] std::uint32_t diagonal_of(std::uint32_t j) const {
    return p_.block[p_.column_begin[j]].offset;
  }

  /// Calls visit(in the panel, in the matrix) for each number of the panel.
  template <class Visit>
  void for_panel(std::span<double> numbers, Visit&& visit) const {
    std::size_t first = 0;
    for (std::uint32_t j = begin_; j < end_; ++j) {
      double* own = numbers.data() + diagonal_of(j);
      for (std::size_t r = first; r < panel_.rows; ++r) {
        for (std::size_t k = 0; k < size_of(j); ++k) visit(panel_.column(first + k)[r], *own++);
      }
      first += size_of(j);
    }
  }

  void load_panel(std::span<double> numbers) const {
    for_panel(numbers, [](double& to, const double& from) { to = from; });
    for (std::size_t k = 0; k < panel_.columns; ++k)
      std::fill(panel_.column(k) + panel_.rows, panel_.column(k) + panel_.stride, 0.0);
  }

  void store_panel(std::span<double> numbers) const {
    for_panel(numbers, [](const double& from, double& to) { to = from; });
  }

  void eliminate(std::span<double> numbers) const {
    std::size_t first = 0;
    for (std::uint32_t j = begin_; j < end_; ++j) {
      const std::size_t n = size_of(j);
      double* block = numbers.data() + diagonal_of(j);
      for (std::size_t r = 0; r < n; ++r) {
        for (std::size_t k = 0; k <= r; ++k) block[r * n + k] = panel_.column(first + k)[first + r];
      }
      factor_diagonal(p_.sign[j], block, p_.size[j]);
      for (std::size_t r = 0; r < n; ++r) {
        for (std::size_t k = 0; k <= r; ++k) panel_.column(first + k)[first + r] = block[r * n + k];
      }
      wide::eliminate_columns({block, first, n}, panel_);
      first += n;
    }
  }

  /// Calls visit(row of a target block, its place in the triangle, width) for each block below the columns.
  template <class Visit>
  void for_updates(std::span<double> numbers, Visit&& visit) const {
    std::uint32_t update = p_.update_begin[end_ - 1];
    std::size_t row = 0;
    for (std::uint32_t left = first_below(); left < p_.column_begin[end_]; ++left) {
      const std::size_t height = size_of(p_.block[left].row);
      std::size_t column = 0;
      for (std::uint32_t right = first_below(); right <= left; ++right) {
        const std::size_t width = size_of(p_.block[right].row);
        double* target = numbers.data() + p_.block[p_.update[update++].target].offset;
        for (std::size_t r = 0; r < height; ++r)
          visit(target + r * width, triangle_.row(row + r) + column, width);
        column += width;
      }
      row += height;
    }
  }

  const BlockPattern& p_;
  std::uint32_t begin_;
  std::uint32_t end_;
  wide::DensePanel panel_;
  wide::DenseTriangle triangle_;
};

/// below -= L own, for the rows of a column below its diagonal that belong to one block. The numbers of
/// `own`, mostly three, five or six, are kept in registers where their count is known in advance.
template <int kSize>
void subtract_forward(const double* l, const double* own, int rows, double* below) {
  double x[kSize];
  for (int k = 0; k < kSize; ++k) x[k] = own[k];
  for (int r = 0; r < rows; ++r, l += kSize) {
    double sum = below[r];
    for (int k = 0; k < kSize; ++k) sum -= l[k] * x[k];
    below[r] = sum;
  }
}
void subtract_forward(const double* l, const double* own, int size, int rows, double* below) {
  if (size == 3) return subtract_forward<3>(l, own, rows, below);
  if (size == 5) return subtract_forward<5>(l, own, rows, below);
  if (size == 6) return subtract_forward<6>(l, own, rows, below);
  for (int r = 0; r < rows; ++r, l += size) {
    for (int k = 0; k < size; ++k) below[r] -= l[k] * own[k];
  }
}

/// own -= L^T below, for the same rows.
template <int kSize>
void subtract_back(const double* l, const double* below, int rows, double* own) {
  double sum[kSize];
  for (int k = 0; k < kSize; ++k) sum[k] = own[k];
  for (int r = 0; r < rows; ++r, l += kSize) {
    for (int k = 0; k < kSize; ++k) sum[k] -= l[k] * below[r];
  }
  for (int k = 0; k < kSize; ++k) own[k] = sum[k];
}
void subtract_back(const double* l, const double* below, int size, int rows, double* own) {
  if (size == 3) return subtract_back<3>(l, below, rows, own);
  if (size == 5) return subtract_back<5>(l, below, rows, own);
  if (size == 6) return subtract_back<6>(l, below, rows, own);
  for (int r = 0; r < rows; ++r, l += size) {
    for (int k = 0; k < size; ++k) own[k] -= l[k] * below[r];
  }
}

/// Computes x := L^-1 x.
void substitute_forward(const BlockPattern& p, std::span<const double> numbers, std::span<double> x) {
  for (int j = 0; j < p.node_count(); ++j) {
    const int n = p.size[j];
    double* own = x.data() + p.first[j];
    const double* diagonal = numbers.data() + p.block[p.column_begin[j]].offset;
    for (int i = 1; i < n; ++i) {
      for (int k = 0; k < i; ++k) own[i] -= diagonal[i * n + k] * own[k];
    }
    for (std::uint32_t b = p.column_begin[j] + 1; b < p.column_begin[j + 1]; ++b) {
      double* below = x.data() + p.first[p.block[b].row];
      const double* l = numbers.data() + p.block[b].offset;
      subtract_forward(l, own, n, p.size[p.block[b].row], below);
    }
  }
}

/// Computes x := L^-T D^-1 x.
void substitute_back(const BlockPattern& p, std::span<const double> numbers, std::span<double> x) {
  for (int j = p.node_count() - 1; j >= 0; --j) {
    const int n = p.size[j];
    double* own = x.data() + p.first[j];
    const double* diagonal = numbers.data() + p.block[p.column_begin[j]].offset;
    for (int i = 0; i < n; ++i) own[i] /= diagonal[i * n + i];
    for (std::uint32_t b = p.column_begin[j] + 1; b < p.column_begin[j + 1]; ++b) {
      const double* below = x.data() + p.first[p.block[b].row];
      const double* l = numbers.data() + p.block[b].offset;
      subtract_back(l, below, n, p.size[p.block[b].row], own);
    }
    for (int i = n - 1; i >= 0; --i) {
      for (int k = i + 1; k < n; ++k) own[i] -= diagonal[k * n + i] * own[k];
    }
  }
}

}  // namespace

void BlockGraph::reset(std::size_t count) {
  count_ = count;
  base::reset_lists(count, neighbors_);
}

void BlockGraph::sort() {
  for (std::size_t i = 0; i < count_; ++i) base::sort_unique(neighbors_[i]);
}

/// Eliminates a node, whereby its neighbors become adjacent to each other.
void BlockGraph::eliminate_node(std::uint32_t node) {
  const std::vector<std::uint32_t>& clique = neighbors_[node];
  for (const std::uint32_t i : clique) {
    std::vector<std::uint32_t>& own = neighbors_[i];
    joined_.clear();
    std::set_union(own.begin(), own.end(), clique.begin(), clique.end(), std::back_inserter(joined_));
    std::erase_if(joined_, [&](std::uint32_t k) { return k == i || k == node; });
    own.assign(joined_.begin(), joined_.end());
    queue_.emplace_back(own.size(), i);
    std::push_heap(queue_.begin(), queue_.end(), std::greater<>());
  }
}

bool BlockGraph::eliminate(std::span<const int> sizes, double budget, BlockPattern& p) {
  HOOKE_ASSERT(sizes.size() == count_);
  eliminated_.assign(count_, 0);
  queue_.clear();
  for (std::uint32_t i = 0; i < count_; ++i) queue_.emplace_back(neighbors_[i].size(), i);
  std::make_heap(queue_.begin(), queue_.end(), std::greater<>());
  p.order.clear();
  p.operations = 0;
  while (!queue_.empty()) {
    const auto [degree, node] = queue_.front();
    std::pop_heap(queue_.begin(), queue_.end(), std::greater<>());
    queue_.pop_back();
    if (eliminated_[node] != 0 || degree != neighbors_[node].size()) continue;
    eliminated_[node] = 1;
    double below = 0;
    for (const std::uint32_t i : neighbors_[node]) below += sizes[i];
    p.operations += cost_of(sizes[node], below);
    if (p.operations > budget) return false;
    eliminate_node(node);
    p.order.push_back(node);
  }
  HOOKE_ASSERT(p.order.size() == count_);
  return true;
}

void BlockGraph::list_blocks(BlockPattern& p) {
  place_.resize(count_);
  for (std::uint32_t i = 0; i < p.order.size(); ++i) place_[p.order[i]] = i;
  p.block.clear();
  p.column_begin.assign(1, 0);
  for (std::uint32_t j = 0; j < p.order.size(); ++j) {
    joined_.assign(1, j);
    for (const std::uint32_t node : neighbors_[p.order[j]]) joined_.push_back(place_[node]);
    std::sort(joined_.begin(), joined_.end());
    for (const std::uint32_t i : joined_) p.block.push_back({i, j});
    p.column_begin.push_back(static_cast<std::uint32_t>(p.block.size()));
  }
}

bool make_block_pattern(BlockGraph& graph, std::span<const int> sizes, double budget, BlockPattern& p) {
  graph.sort();
  if (!graph.eliminate(sizes, budget, p)) return false;
  graph.list_blocks(p);
  graph.sizes_in_order_.clear();
  for (const std::uint32_t node : p.order) graph.sizes_in_order_.push_back(sizes[node]);
  resize_blocks(graph.sizes_in_order_, p);
  p.sign.assign(p.order.size(), 1);
  list_updates(p);
  list_runs(p);
  return true;
}

void resize_blocks(std::span<const int> sizes, BlockPattern& p) {
  HOOKE_ASSERT(sizes.size() == p.order.size());
  HOOKE_ASSERT(std::all_of(sizes.begin(), sizes.end(), [](int size) { return size >= 0; }));
  p.size.assign(sizes.begin(), sizes.end());
  p.first.assign(1, 0);
  for (const int size : sizes) p.first.push_back(p.first.back() + size);
  p.number_count = 0;
  for (BlockPattern::Block& block : p.block) {
    block.offset = p.number_count;
    p.number_count += static_cast<std::uint32_t>(p.size[block.row] * p.size[block.column]);
  }
}

void set_signs(std::span<const std::int8_t> sign_of_node, BlockPattern& p) {
  HOOKE_ASSERT(sign_of_node.size() == p.order.size());
  for (std::size_t i = 0; i < p.order.size(); ++i) p.sign[i] = sign_of_node[p.order[i]];
}

std::uint32_t find_block(const BlockPattern& p, std::uint32_t row, std::uint32_t column) {
  HOOKE_ASSERT(column <= row && row < p.order.size());
  const auto begin = p.block.begin() + p.column_begin[column];
  const auto end = p.block.begin() + p.column_begin[column + 1];
  const auto found = std::lower_bound(
      begin, end, row, [](const BlockPattern::Block& block, std::uint32_t r) { return block.row < r; });
  HOOKE_ASSERT(found != end && found->row == row);
  return static_cast<std::uint32_t>(found - p.block.begin());
}

void factor(const BlockPattern& p, std::span<double> numbers, std::vector<double>& scratch) {
  HOOKE_ASSERT(numbers.size() >= p.number_count);
  for (std::size_t run = 0; run + 1 < p.run_begin.size(); ++run) {
    DenseRun dense(p, p.run_begin[run], p.run_begin[run + 1]);
    if (dense.pays()) {
      dense.factor(numbers, scratch);
      continue;
    }
    for (std::uint32_t j = p.run_begin[run]; j < p.run_begin[run + 1]; ++j)
      factor_column(p, j, numbers, scratch);
  }
}

void solve(const BlockPattern& p, std::span<const double> numbers, std::span<double> x) {
  HOOKE_ASSERT(numbers.size() >= p.number_count && x.size() >= static_cast<std::size_t>(p.first.back()));
  substitute_forward(p, numbers, x);
  substitute_back(p, numbers, x);
}

void remove_unfelt(const BlockPattern& p, std::span<const double> numbers, std::span<const double> compliance,
                   std::span<double> x, std::vector<double>& scratch) {
  HOOKE_ASSERT(compliance.size() == x.size());
  scratch.resize(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) scratch[i] = compliance[i] * x[i];
  solve(p, numbers, scratch);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] -= scratch[i];
}

}  // namespace hooke::solver
