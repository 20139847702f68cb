#include "lab/methods/implicit.h"

#include "lab/methods/methods.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace hooke::lab {

namespace {

constexpr int kMostNewtonSteps = 60;
constexpr int kMostHalvings = 30;
constexpr int kMostLeaps = 10;
constexpr int kMostStartUpParts = 10000;
constexpr int kMostStepsByKept = 8;
/// Largest share of the residual that a step by an earlier matrix may leave.
constexpr double kFastByKept = 0.1;
/// A step by an earlier matrix leaves an error of its own size, unlike Newton's.
constexpr double kOfTolerance = 1e-3;
constexpr double kSolved = 1e-15;  ///< Relative residual that is only rounding.

Error not_converged(const System& f, double t) {
  char text[96];
  std::snprintf(text, sizeof(text), "Newton's method did not converge at t = %.6g s; a smaller dt may help",
                t);
  return {ErrorCode::kLimitExceeded, f.name(), text};
}

/// Evaluates r(v) of implicit.h at one v after the other.
class Residual {
 public:
  Residual(const System& f, double t, double gamma, const State& known, State& y)
      : f_(f), t_(t), gamma_(gamma), known_(known), y_(y) {}

  /// Moves y to this velocity and evaluates r. \return |r|.
  double set(const State& velocity) {
    f_.v(y_) = velocity;
    f_.x(y_) = f_.x(known_) + gamma_ * velocity;
    value = velocity - f_.v(known_) - gamma_ * f_.acceleration(t_, y_);
    return value.norm();
  }

  State value;

 private:
  const System& f_;
  double t_;
  double gamma_;
  const State& known_;
  State& y_;
};

/// Makes Newton's steps by the matrix of an earlier state, as long as each leaves little of the residual.
/// While the motion is smooth no other matrix is needed. \return Whether they converged; if not, y is where
/// they ended.
bool solve_by_kept(const ImplicitMatrix& matrix, Residual& r, double tolerance, State& velocity) {
  double size = r.set(velocity);
  for (int i = 0; i < kMostStepsByKept; ++i) {
    const State step = matrix.solve(-r.value);
    const double next = r.set(velocity + step);
    const double scale = 1 + velocity.norm();
    const bool arrived =
        (i > 0 && step.norm() <= kOfTolerance * tolerance * scale) || next <= kSolved * scale;
    if (arrived || next <= size) velocity += step;
    if (arrived) return true;
    if (!(next <= kFastByKept * size)) return false;
    size = next;
  }
  return false;
}

}  // namespace

bool ImplicitMatrix::factor(const System& f, double t, const State& y, double gamma) {
  const Eigen::Index size = f.coordinates();
  const Jacobian jacobian = f.jacobian(t, y);
  const auto matrix_of = [&](const std::vector<Jacobian::Entry>& entries) {
    std::vector<Eigen::Triplet<double>> triplets;
    triplets.reserve(entries.size());
    for (const Jacobian::Entry& e : entries) triplets.emplace_back(e.row, e.column, e.value);
    Matrix matrix(size, size);
    matrix.setFromTriplets(triplets.begin(), triplets.end());
    return matrix;
  };
  Matrix one(size, size);
  one.setIdentity();
  by_position_ = matrix_of(jacobian.by_position);
  factors_.compute(one - gamma * matrix_of(jacobian.by_velocity) - gamma * gamma * by_position_);
  gamma_ = factors_.info() == Eigen::Success ? gamma : 0;
  return gamma_ != 0;
}

State ImplicitMatrix::solve_whole(const System& f, const State& right) const {
  State result = right;
  f.v(result) = factors_.solve(f.v(right) + gamma_ * (by_position_ * f.x(right)));
  f.x(result) = f.x(right) + gamma_ * f.v(result);
  return result;
}

void solve_implicit(const System& f, double t, double gamma, const State& known, State& y, Workspace& work) {
  // Force laws compute in single precision, so that nothing smaller than their rounding can be reached.
  const double tolerance = f.has_laws() ? 1e-5 : 1e-10;
  if (work.matrix == nullptr) work.matrix = std::make_shared<ImplicitMatrix>();
  ImplicitMatrix& matrix = *work.matrix;
  Residual r(f, t, gamma, known, y);
  State velocity = f.v(y);
  if (matrix.gamma() == gamma && solve_by_kept(matrix, r, tolerance, velocity)) return;
  double size = r.set(velocity);
  int leaps = 0;
  for (int iteration = 0; iteration < kMostNewtonSteps && std::isfinite(size); ++iteration) {
    if (!matrix.factor(f, t, y, gamma)) break;
    const State step = matrix.solve(-r.value);
    double share = 1;
    double next = r.set(velocity + step);
    for (int i = 0; i < kMostHalvings && !(next <= size); ++i) {
      share *= 0.5;
      next = r.set(velocity + share * step);
    }
    const bool small = step.norm() <= tolerance * (1 + velocity.norm());
    if (next <= size) velocity += share * step;
    if (small) {
      r.set(velocity);
      return;
    }
    if (!(next <= size)) {
      // A kink (a spring going slack, a contact) may keep |r| from falling; the whole step lands behind it.
      if (++leaps > kMostLeaps) break;
      velocity += step;
      next = r.set(velocity);
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
