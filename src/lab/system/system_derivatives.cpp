/// Computes what a system knows besides f: its Jacobian, its energy, its stiffest part.

#include "lab/system/series.h"
#include "lab/system/system.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace hooke::lab {

namespace {

using Direction = Series<2>;

double& coordinate(DVec3& a, int i) {
  return i == 0 ? a.x : (i == 1 ? a.y : a.z);
}
Direction& coordinate(Vector3<Direction>& a, int i) {
  return i == 0 ? a.x : (i == 1 ? a.y : a.z);
}

/// Calls `visit(output, input, of_velocity, derivative)` for each nonzero derivative of a row's forces.
/// Output and input count the coordinates of the row's points, three for each.
template <class Row, class Visit>
void differentiate(const Row& row, Points<Direction, Row::kPoints> p, Visit&& visit) {
  constexpr int kPoints = Row::kPoints;
  for (int input = 0; input < 6 * kPoints; ++input) {
    const bool of_velocity = input >= 3 * kPoints;
    const int j = input / 3 % kPoints;
    Direction& seed = coordinate(of_velocity ? p.v[j] : p.x[j], input % 3);
    seed.c[1] = 1;
    const auto force = row.force(p);
    seed.c[1] = 0;
    for (int output = 0; output < 3 * kPoints; ++output) {
      Vector3<Direction> f = force[output / 3];
      const double value = coordinate(f, output % 3).c[1];
      if (value != 0) visit(output, input % (3 * kPoints), of_velocity, value);
    }
  }
}

/// Bounds eigenvalues by Gershgorin's theorem: none of M^-1 K is larger than the largest sum of the sizes of
/// a row's blocks. A row's force is k times a gradient G of its length or angle, and its blocks are k G_i
/// G_j^T; for a spring |G| = 1.
class RowSums {
 public:
  RowSums(const std::vector<int>& free_of_row, const std::vector<double>& mass)
      : free_of_row_(free_of_row), mass_(mass), sums_(mass.size()) {}

  template <std::size_t n>
  void add(const std::array<std::uint32_t, n>& at, const std::array<double, n>& gradient, double stiffness,
           double damping, std::size_t number) {
    double total = 0;
    for (std::size_t j = 0; j < n; ++j) total += free_of_row_[at[j]] < 0 ? 0 : gradient[j];
    for (std::size_t i = 0; i < n; ++i) {
      if (free_of_row_[at[i]] < 0) continue;
      const double size = gradient[i] * total / mass_[at[i]];
      Sum& sum = sums_[at[i]];
      sum.omega_squared += stiffness * size;
      sum.damping += damping * size;
      if (stiffness * size + damping * size > sum.largest) sum.number = number;
      sum.largest = std::max(sum.largest, stiffness * size + damping * size);
    }
  }
  void add_damping(std::uint32_t i, double damping) { sums_[i].damping += damping / mass_[i]; }

  struct Sum {
    double omega_squared = 0, damping = 0, largest = 0;
    /// Number of the row that adds most; beyond all rows it stands for air friction.
    std::size_t number = ~std::size_t{0};
  };
  [[nodiscard]] const std::vector<Sum>& sums() const { return sums_; }

 private:
  const std::vector<int>& free_of_row_;
  const std::vector<double>& mass_;
  std::vector<Sum> sums_;
};

}  // namespace

Jacobian System::jacobian(double t, const State& y) const {
  const Motion<double> m = motion_now(t, y);
  const std::vector<DVec3> air = wind(t, m.x);
  Jacobian result;
  for_each_row([&](const auto& row) {
    constexpr int kPoints = std::remove_cvref_t<decltype(row)>::kPoints;
    const Points<Direction, kPoints> p = gather<Direction>(row, m, air);
    differentiate(row, p, [&](int output, int input, bool of_velocity, double value) {
      const std::uint32_t i = row.at[output / 3];
      const std::uint32_t j = row.at[input / 3];
      if (free_of_row_[i] == kHeld || free_of_row_[j] == kHeld) return;
      auto& entries = of_velocity ? result.by_velocity : result.by_position;
      entries.push_back(
          {3 * free_of_row_[i] + output % 3, 3 * free_of_row_[j] + input % 3, value / mass_[i]});
    });
  });
  return result;
}

State System::jacobian_times(double t, const State& y, const State& direction) const {
  const State dx = x(direction);
  const State dv = v(direction);
  Motion<double> now = motion_now(t, y);
  Motion<Direction> m = {{now.x.size(), Vector3<Direction>{}}, {now.v.size(), Vector3<Direction>{}}};
  for (std::size_t row = 0; row < now.x.size(); ++row) {
    const int free = free_of_row_[row];
    for (int i = 0; i < 3; ++i) {
      coordinate(m.x[row], i) = {coordinate(now.x[row], i), free == kHeld ? 0 : dx[3 * free + i]};
      coordinate(m.v[row], i) = {coordinate(now.v[row], i), free == kHeld ? 0 : dv[3 * free + i]};
    }
  }
  std::vector<Vector3<Direction>> a = accelerations(m, wind(t, now.x));
  State result(y.size());
  result.head(coordinates_) = dv;
  for (Eigen::Index free = 0; free < coordinates_ / 3; ++free) {
    for (int i = 0; i < 3; ++i) result[coordinates_ + 3 * free + i] = coordinate(a[free_rows_[free]], i).c[1];
  }
  return result;
}

Energy System::energy(double t, const State& y) const {
  const Motion<double> m = motion_now(t, y);
  Energy energy;
  for (const PointRow& row : points_) {
    const std::uint32_t i = row.at[0];
    energy.kinetic += 0.5 * row.mass * length_squared(m.v[i]);
    energy.potential -= row.mass * dot(row.uniform, m.x[i]);
    for (const FieldDesc& field : *attractors_) {
      const double r = length(m.x[i] - field.center);
      if (r > 0) energy.potential -= row.mass * field.strength / r;
    }
  }
  for (const RotationRow& row : turns_) {
    const std::uint32_t i = row.at[0];
    const DVec3 own = row.in_axes(turned(-m.x[i], spin_of(m.x[i], m.v[i])));
    energy.kinetic += 0.5 * dot(own, {row.inertia.x * own.x, row.inertia.y * own.y, row.inertia.z * own.z});
  }
  for (const SpringRow& row : springs_) {
    const double extension = length(m.x[row.at[0]] - m.x[row.at[1]]) - row.spring.rest_length;
    energy.elastic += 0.5 * row.spring.stiffness * extension * extension;
  }
  for (const BendRow& row : bends_) {
    const auto& at = row.at;
    const auto bend = elements::dihedral(m.x[at[0]], m.x[at[1]], m.x[at[2]], m.x[at[3]]);
    const double opening = bend.valid ? row.opening(bend.angle) : 0.0;
    energy.elastic += 0.5 * row.stiffness * opening * opening;
  }
  for (const CurvatureRow& row : curvatures_) {
    const auto& at = row.at;
    const DVec3 q =
        elements::curvature<double>(row.weights, {m.x[at[0]], m.x[at[1]], m.x[at[2]], m.x[at[3]]});
    energy.elastic += 0.5 * row.stiffness * length_squared(q);
  }
  return energy;
}

std::vector<Oscillation> System::oscillations(double t, const State& y) const {
  const Motion<double> m = motion_now(t, y);
  RowSums rows(free_of_row_, mass_);
  std::size_t number = 0;
  for (const SpringRow& row : springs_)
    rows.add<2>(row.at, {1, 1}, row.spring.stiffness, row.spring.damping, number++);
  for (const BendRow& row : bends_) {
    const auto& at = row.at;
    const auto bend = elements::dihedral(m.x[at[0]], m.x[at[1]], m.x[at[2]], m.x[at[3]]);
    std::array<double, 4> size = {};
    for (int i = 0; i < 4 && bend.valid; ++i) size[i] = length(bend.gradient[i]);
    rows.add<4>(at, size, row.stiffness, row.damping, number++);
  }
  for (const CurvatureRow& row : curvatures_) {
    std::array<double, 4> size = {};
    for (int i = 0; i < 4; ++i) size[i] = std::abs(row.weights[i]);
    rows.add<4>(row.at, size, row.stiffness, row.damping * row.stiffness, number++);
  }
  for (const PointRow& row : points_) rows.add_damping(row.at[0], row.viscous);

  std::vector<Oscillation> result;
  for (const RowSums::Sum& sum : rows.sums()) {
    if (sum.omega_squared > 0 || sum.damping > 0)
      result.push_back({sum.omega_squared, sum.damping, sum.number});
  }
  return result;
}

std::string System::row_name(std::size_t number) const {
  char text[96];
  if (number < springs_.size()) {
    std::snprintf(text, sizeof(text), "%s of %s (k = %.4g N/m)", spring_names_[number].c_str(),
                  name().c_str(), springs_[number].spring.stiffness);
  } else if (number - springs_.size() < bends_.size()) {
    std::snprintf(text, sizeof(text), "bend %zu of %s (k = %.4g N m)", number - springs_.size(),
                  name().c_str(), bends_[number - springs_.size()].stiffness);
  } else if (const std::size_t i = number - springs_.size() - bends_.size(); i < curvatures_.size()) {
    std::snprintf(text, sizeof(text), "bend %zu of %s (k = %.4g N/m)", i, name().c_str(),
                  curvatures_[i].stiffness);
  } else {
    return "air friction of " + name();
  }
  return text;
}

}  // namespace hooke::lab
