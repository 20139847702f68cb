#include "hinged_sheet.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace hooke::check {

namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Matrix = std::vector<std::vector<double>>;

/// By point: what its height adds.
using Weights = std::map<std::uint32_t, double>;

double twice_area(const HingedSheet& sheet, const Triangle& t) {
  const DVec3 p = sheet.points[t[0]];
  return length(cross(sheet.points[t[1]] - p, sheet.points[t[2]] - p));
}

/// Adds `sign` times the slope of a triangle along the unit vector n.
void add_slope(const HingedSheet& sheet, const Triangle& t, DVec3 n, double sign, Weights& weights) {
  const DVec3 p = sheet.points[t[0]];
  const DVec3 q = sheet.points[t[1]] - p;
  const DVec3 r = sheet.points[t[2]] - p;
  const double whole = q.x * r.z - q.z * r.x;
  const double of_q = sign * (n.x * r.z - n.z * r.x) / whole;
  const double of_r = sign * (n.z * q.x - n.x * q.z) / whole;
  weights[t[1]] += of_q;
  weights[t[2]] += of_r;
  weights[t[0]] -= of_q + of_r;
}

/// The second derivatives of the energy with respect to heights.
Matrix stiffness_of(const HingedSheet& sheet) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Triangle>> sides;
  for (const Triangle& t : sheet.triangles) {
    for (std::size_t i = 0; i < 3; ++i) sides[std::minmax(t[i], t[(i + 1) % 3])].push_back(t);
  }
  Matrix stiffness(sheet.points.size(), std::vector<double>(sheet.points.size()));
  for (const auto& [edge, triangles] : sides) {
    if (triangles.size() != 2) continue;
    const DVec3 along = sheet.points[edge.second] - sheet.points[edge.first];
    const DVec3 across = normalize(DVec3{along.z, 0, -along.x});
    Weights angle;
    add_slope(sheet, triangles[0], across, 1, angle);
    add_slope(sheet, triangles[1], across, -1, angle);
    const double areas = 0.5 * (twice_area(sheet, triangles[0]) + twice_area(sheet, triangles[1]));
    const double k = sheet.rigidity * dot(along, along) / areas;
    for (const auto& [i, of_i] : angle) {
      for (const auto& [j, of_j] : angle) stiffness[i][j] += k * of_i * of_j;
    }
  }
  return stiffness;
}

/// Of a symmetric positive matrix, in place.
void solve(Matrix& a, std::vector<double>& x) {
  const std::size_t n = x.size();
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t k = 0; k < j; ++k) a[j][j] -= a[j][k] * a[j][k];
    a[j][j] = std::sqrt(a[j][j]);
    for (std::size_t i = j + 1; i < n; ++i) {
      for (std::size_t k = 0; k < j; ++k) a[i][j] -= a[i][k] * a[j][k];
      a[i][j] /= a[j][j];
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) x[i] -= a[i][k] * x[k];
    x[i] /= a[i][i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) x[i] -= a[k][i] * x[k];
    x[i] /= a[i][i];
  }
}

}  // namespace

std::vector<double> sag_of(const HingedSheet& sheet, double load) {
  Matrix stiffness = stiffness_of(sheet);
  std::vector<double> sag(sheet.points.size());
  for (const Triangle& t : sheet.triangles) {
    for (const std::uint32_t i : t) sag[i] += load * twice_area(sheet, t) / 6;
  }
  for (std::size_t i = 0; i < sag.size(); ++i) {
    if (sheet.is_fixed[i] == 0) continue;
    for (std::size_t j = 0; j < sag.size(); ++j) stiffness[i][j] = stiffness[j][i] = 0;
    stiffness[i][i] = 1;
    sag[i] = 0;
  }
  solve(stiffness, sag);
  return sag;
}

}  // namespace hooke::check
