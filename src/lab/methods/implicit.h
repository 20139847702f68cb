#pragma once

#include "lab/methods/method.h"

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

namespace hooke::lab {

/// 1 - gamma J at some state, J = df/dy, factored: what every implicit method solves with. Of
///
///     dx - gamma dv = a,   dv - gamma (da/dx dx + da/dv dv) = b
///
/// dx = a + gamma dv is eliminated, so that half the size is left (Eigen's SparseLU; drag in wind makes it
/// unsymmetric):
///
///     (1 - gamma da/dv - gamma^2 da/dx) dv = b + gamma da/dx a
class ImplicitMatrix {
 public:
  /// \return Whether it is regular.
  bool factor(const System& f, double t, const State& y, double gamma);
  /// 0 before a matrix was factored.
  [[nodiscard]] double gamma() const { return gamma_; }

  /// dv where a = 0.
  [[nodiscard]] State solve(const State& b) const { return factors_.solve(b); }
  /// (dx, dv) of (a, b).
  [[nodiscard]] State solve_whole(const System& f, const State& right) const;

 private:
  using Matrix = Eigen::SparseMatrix<double>;
  Matrix by_position_;
  Eigen::SparseLU<Matrix> factors_;
  double gamma_ = 0;
};

/// Solves y = known + gamma f(t, y), from `y` as a first guess: one step of any implicit method of this
/// laboratory. With x = X + gamma v eliminated, for the velocities alone:
///
///     r(v) = v - V - gamma a(t, X + gamma v, v) = 0,   r' = 1 - gamma da/dv - gamma^2 da/dx
///
/// Newton, first by the matrix kept from an earlier step (work.matrix), while each step leaves a tenth of
/// |r|; then by a new one each time, halving a step until |r| falls, or taking it whole where no part of it
/// lets |r| fall. Without convergence in 60 steps work.error is set.
void solve_implicit(const System& f, double t, double gamma, const State& known, State& y, Workspace& work);

/// One step of rk4, in as many parts as keep it stable: what multistep methods begin with.
void start_up(const System& f, double t, double h, State& y, Workspace& work);

}  // namespace hooke::lab
