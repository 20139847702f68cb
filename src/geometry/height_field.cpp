#include "hooke/geometry.h"

#include "base/float_environment.h"

#include <cmath>
#include <string>
#include <utility>

namespace hooke {

namespace {

constexpr int kPerSideMax = 4096;

Error field_error(const std::string& where, std::string message) {
  return {.where = "height_field." + where, .message = std::move(message)};
}

Result<void> validate_count(const char* name, int count) {
  if (count >= 2 && count <= kPerSideMax) return {};
  return field_error(name, std::to_string(count) + " is outside [2, " + std::to_string(kPerSideMax) + "]");
}

Result<void> validate_field(int columns, int rows, Real cell, std::span<const Real> heights) {
  if (Result<void> counted = validate_count("columns", columns); !counted) return counted;
  if (Result<void> counted = validate_count("rows", rows); !counted) return counted;
  if (!(cell > Real(0)) || !std::isfinite(cell * Real(kPerSideMax))) {
    return field_error("cell", "a cell's side is positive and finite");
  }
  const auto count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  if (heights.size() != count) {
    return field_error("heights",
                       std::to_string(heights.size()) + " heights for " + std::to_string(count) + " points");
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!std::isfinite(heights[i])) {
      return field_error("heights[" + std::to_string(i) + "]", "a height is not finite");
    }
  }
  return {};
}

}  // namespace

Result<MeshDesc> make_height_field(int columns, int rows, Real cell, std::span<const Real> heights) {
  const base::FloatEnvironment environment;
  if (const Result<void> valid = validate_field(columns, rows, cell, heights); !valid) return valid.error();
  MeshDesc mesh;
  mesh.positions.reserve(heights.size());
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      mesh.positions.push_back({cell * Real(column), heights[mesh.positions.size()], cell * Real(row)});
    }
  }
  const auto stride = static_cast<std::uint32_t>(columns);
  const auto row_end = static_cast<std::uint32_t>(rows - 1) * stride;
  for (std::uint32_t row_begin = 0; row_begin < row_end; row_begin += stride) {
    for (std::uint32_t corner = row_begin; corner + 1 < row_begin + stride; ++corner) {
      mesh.triangles.push_back({corner, corner + stride, corner + stride + 1});
      mesh.triangles.push_back({corner, corner + stride + 1, corner + 1});
    }
  }
  return mesh;
}

}  // namespace hooke
