/// The arithmetic of solver/linear/dense_panel.h in Numbers of solver/simd/numbers.h. Included again for each
/// instruction set.

#if defined(HOOKE_SOLVER_LINEAR_DENSE_PANEL_SWEEP_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_LINEAR_DENSE_PANEL_SWEEP_H
#undef HOOKE_SOLVER_LINEAR_DENSE_PANEL_SWEEP_H
#else
#define HOOKE_SOLVER_LINEAR_DENSE_PANEL_SWEEP_H
#endif

#include "solver/linear/dense_panel.h"
#include "solver/simd/numbers.h"

#include <cstddef>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

template <class Number>
class PanelSweep {
 public:
  static constexpr std::size_t kWidth = kLanesOf<Number>;

  HWY_INLINE explicit PanelSweep(const DensePanel& panel) : panel_(panel) {}

  /// Computes X := X L^-T D^-1 of the rows below the block.
  HWY_INLINE void divide_below(const FactoredBlock& block) const {
    for (std::size_t r = block.first + block.size; r < panel_.rows; r += kWidth) {
      for (std::size_t j = 1; j < block.size; ++j) {
        Number x = get<Number>(at(block, j) + r);
        for (std::size_t k = 0; k < j; ++k)
          x = x - get<Number>(at(block, k) + r) * Number(block.numbers[j * block.size + k]);
        write(x, at(block, j) + r);
      }
      for (std::size_t j = 0; j < block.size; ++j) {
        const Number pivot(block.numbers[j * block.size + j]);
        write(quotient(get<Number>(at(block, j) + r), pivot), at(block, j) + r);
      }
    }
  }

  /// Subtracts the products of the block's columns from one later column, from its diagonal on.
  HWY_INLINE void subtract_from(std::size_t column, const FactoredBlock& block) const {
    std::size_t k = 0;
    for (; k + 3 <= block.size; k += 3) subtract_columns<3>(column, k, block);
    for (; k < block.size; ++k) subtract_columns<1>(column, k, block);
  }

  /// Computes D L^T of the rows below the columns.
  HWY_INLINE void scale(double* scaled) const {
    for (std::size_t k = 0; k < panel_.columns; ++k) {
      const double* x = panel_.column(k);
      const Number d(x[k]);
      double* to = scaled + k * panel_.stride;
      for (std::size_t r = 0; r < panel_.rows_below(); r += kWidth)
        write(d * get<Number>(x + panel_.columns + r), to + r);
    }
  }

  /// Subtracts products from kTriangleRows rows of a triangle, and kVectors vectors of columns.
  template <int kVectors>
  HWY_INLINE void subtract_tile(std::size_t row, std::size_t column, const double* scaled,
                                const DenseTriangle& triangle) const {
    Number sum[kTriangleRows][kVectors];
    for (std::size_t i = 0; i < kTriangleRows; ++i) {
      for (int v = 0; v < kVectors; ++v) read(triangle.row(row + i) + column + v * kWidth, sum[i][v]);
    }
    const double* x = panel_.numbers + panel_.columns + row;
    const double* y = scaled + column;
    for (std::size_t k = 0; k < panel_.columns; ++k, x += panel_.stride, y += panel_.stride) {
      Number factor[kVectors];
      for (int v = 0; v < kVectors; ++v) read(y + v * kWidth, factor[v]);
      for (std::size_t i = 0; i < kTriangleRows; ++i) {
        const Number own(x[i]);
        for (int v = 0; v < kVectors; ++v) sum[i][v] = sum[i][v] - own * factor[v];
      }
    }
    for (std::size_t i = 0; i < kTriangleRows; ++i) {
      for (int v = 0; v < kVectors; ++v) write(sum[i][v], triangle.row(row + i) + column + v * kWidth);
    }
  }

  HWY_INLINE void subtract_products(const double* scaled, const DenseTriangle& triangle) const {
    for (std::size_t row = 0; row < panel_.rows_below(); row += kTriangleRows) {
      const std::size_t end = row + kTriangleRows;  // of the columns up to the diagonal
      std::size_t column = 0;
      for (; column + kWidth < end; column += 2 * kWidth) subtract_tile<2>(row, column, scaled, triangle);
      for (; column < end; column += kWidth) subtract_tile<1>(row, column, scaled, triangle);
    }
  }

 private:
  /// Subtracts the products of kColumns columns of the block from one later column.
  template <int kColumns>
  HWY_INLINE void subtract_columns(std::size_t column, std::size_t first, const FactoredBlock& block) const {
    const double* x[kColumns];
    Number factor[kColumns];
    for (int i = 0; i < kColumns; ++i) {
      const std::size_t k = first + static_cast<std::size_t>(i);
      x[i] = at(block, k);
      factor[i] = Number(block.numbers[k * block.size + k] * x[i][column]);
    }
    double* to = panel_.column(column);
    for (std::size_t r = column; r < panel_.rows; r += kWidth) {
      Number sum = get<Number>(to + r);
      for (int i = 0; i < kColumns; ++i) sum = sum - get<Number>(x[i] + r) * factor[i];
      write(sum, to + r);
    }
  }

  [[nodiscard]] HWY_INLINE double* at(const FactoredBlock& block, std::size_t k) const {
    return panel_.column(block.first + k);
  }

  const DensePanel& panel_;
};

template <class Number>
HWY_INLINE void eliminate_panel_columns(const FactoredBlock& block, const DensePanel& panel) {
  const PanelSweep<Number> sweep(panel);
  sweep.divide_below(block);
  for (std::size_t c = block.first + block.size; c < panel.columns; ++c) sweep.subtract_from(c, block);
}

template <class Number>
HWY_INLINE void subtract_panel_products(const DensePanel& panel, double* scaled,
                                        const DenseTriangle& triangle) {
  const PanelSweep<Number> sweep(panel);
  sweep.scale(scaled);
  sweep.subtract_products(scaled, triangle);
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
