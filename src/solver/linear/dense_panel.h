#pragma once

#include <cstddef>

/// \file
/// The dense arithmetic of sparse factorizations: columns of the factor that have the same rows below them
/// are eliminated together. Every number gets the products of its columns one after the other, in their
/// order, as if they were eliminated alone.

namespace hooke::solver::wide {

/// Numbers without meaning behind each column of a panel and each row of a triangle: kernels read and write
/// whole vectors.
inline constexpr std::size_t kPanelPadding = 16;

/// Consecutive columns of a factor, stored by columns. The first rows are those of the columns themselves.
struct DensePanel {
  double* numbers = nullptr;
  std::size_t columns = 0;
  std::size_t rows = 0;    ///< Those of the columns included.
  std::size_t stride = 0;  ///< From one column to the next; at least `rows` and the padding.

  [[nodiscard]] double* column(std::size_t k) const { return numbers + k * stride; }
  [[nodiscard]] std::size_t rows_below() const { return rows - columns; }
};

/// A lower triangle stored by rows, of as many rows as a panel has below its columns, rounded up to
/// kTriangleRows.
struct DenseTriangle {
  double* numbers = nullptr;
  std::size_t stride = 0;  ///< From one row to the next; at least the rows and the padding.

  [[nodiscard]] double* row(std::size_t r) const { return numbers + r * stride; }
};

/// Rows of a triangle that are computed together.
inline constexpr std::size_t kTriangleRows = 4;

/// A diagonal block of a panel, factored: L below its diagonal and D on it, by rows.
struct FactoredBlock {
  const double* numbers = nullptr;
  std::size_t first = 0;  ///< Its first column.
  std::size_t size = 0;
};

/// Computes the columns of L below the block, and subtracts their products from all later columns.
void eliminate_columns(const FactoredBlock& block, const DensePanel& panel);

/// Subtracts L D L^T of the rows below the columns from the triangle. `scaled` is scratch of the panel's
/// size.
void subtract_products(const DensePanel& panel, double* scaled, const DenseTriangle& triangle);

// The scalar twins.
void eliminate_columns_scalar(const FactoredBlock& block, const DensePanel& panel);
void subtract_products_scalar(const DensePanel& panel, double* scaled, const DenseTriangle& triangle);

}  // namespace hooke::solver::wide
