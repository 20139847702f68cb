#include "validation/hinged_sheet.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <map>
#include <utility>

namespace hooke::check {

namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// Contribution of each point's height, by point.
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

/// Returns the second derivatives of the energy with respect to heights.
Eigen::MatrixXd stiffness_of(const HingedSheet& sheet) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Triangle>> sides;
  for (const Triangle& t : sheet.triangles) {
    for (std::size_t i = 0; i < 3; ++i) sides[std::minmax(t[i], t[(i + 1) % 3])].push_back(t);
  }
  const auto size = static_cast<Eigen::Index>(sheet.points.size());
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(size, size);
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
      for (const auto& [j, of_j] : angle) stiffness(i, j) += k * of_i * of_j;
    }
  }
  return stiffness;
}

}  // namespace

std::vector<double> sag_of(const HingedSheet& sheet, double load) {
  Eigen::MatrixXd stiffness = stiffness_of(sheet);
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(stiffness.rows());
  for (const Triangle& t : sheet.triangles) {
    for (const std::uint32_t i : t) forces[i] += load * twice_area(sheet, t) / 6;
  }
  for (Eigen::Index i = 0; i < forces.size(); ++i) {
    if (sheet.is_fixed[static_cast<std::size_t>(i)] == 0) continue;
    stiffness.row(i).setZero();
    stiffness.col(i).setZero();
    stiffness(i, i) = 1;
    forces[i] = 0;
  }
  const Eigen::VectorXd sag = stiffness.llt().solve(forces);
  return {sag.begin(), sag.end()};
}

}  // namespace hooke::check
