#include "lab/implicit.h"

#include "lab/methods/methods.h"

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <cstdio>

namespace hooke::lab {

namespace {

using Matrix = Eigen::SparseMatrix<double>;

constexpr int kMostNewtonSteps = 60;
constexpr int kMostHalvings = 30;
constexpr int kMostLeaps = 10;
constexpr int kMostStartUpParts = 10000;

Matrix residual_slope(const Jacobian& jacobian, double gamma, Eigen::Index size) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(size) + jacobian.by_velocity.size() + jacobian.by_position.size());
  for (int i = 0; i < size; ++i) entries.emplace_back(i, i, 1.0);
  for (const Jacobian::Entry& e : jacobian.by_velocity)
    entries.emplace_back(e.row, e.column, -gamma * e.value);
  for (const Jacobian::Entry& e : jacobian.by_position)
    entries.emplace_back(e.row, e.column, -gamma * gamma * e.value);
  Matrix matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Error not_converged(const System& f, double t) {
  char text[96];
  std::snprintf(text, sizeof(text), "Newton's method did not converge at t = %.6g s; a smaller dt may help",
                t);
  return {ErrorCode::kLimitExceeded, f.name(), text};
}

}  // namespace

void solve_implicit(const System& f, double t, double gamma, const State& known, State& y, Workspace& work) {
  // Force laws know single precision only: nothing smaller than their rounding can be reached.
  const double tolerance = f.has_laws() ? 1e-5 : 1e-10;
  State residual;
  const auto set = [&](const State& velocity) {
    f.v(y) = velocity;
    f.x(y) = f.x(known) + gamma * velocity;
    residual = velocity - f.v(known) - gamma * f.acceleration(t, y);
    return residual.norm();
  };
  State velocity = f.v(y);
  double size = set(velocity);
  Eigen::SparseLU<Matrix> solver;
  int leaps = 0;
  for (int iteration = 0; iteration < kMostNewtonSteps && std::isfinite(size); ++iteration) {
    solver.compute(residual_slope(f.jacobian(t, y), gamma, f.coordinates()));
    if (solver.info() != Eigen::Success) break;
    const State step = solver.solve(-residual);
    double share = 1;
    double next = set(velocity + step);
    for (int i = 0; i < kMostHalvings && !(next <= size); ++i) {
      share *= 0.5;
      next = set(velocity + share * step);
    }
    const bool small = step.norm() <= tolerance * (1 + velocity.norm());
    if (next <= size) velocity += share * step;
    if (small) {
      set(velocity);
      return;
    }
    if (!(next <= size)) {
      // A kink (a spring gone slack, a contact) can wall off the way down; the whole step lands behind it.
      if (++leaps > kMostLeaps) break;
      velocity += step;
      next = set(velocity);
    }
    size = next;
  }
  work.error = not_converged(f, t);
}

void start_up(const System& f, double t, double h, State& y, Workspace& work) {
  double rate = 0;
  for (const Oscillation& o : f.oscillations(t, y))
    rate = std::max(rate, std::sqrt(o.omega_squared) + o.damping);
  const int parts = static_cast<int>(std::clamp(std::ceil(rate * h), 1.0, double{kMostStartUpParts}));
  for (int i = 0; i < parts; ++i) step_rk4(f, t + i * (h / parts), h / parts, y, work);
}

}  // namespace hooke::lab
