#pragma once

#include "lab/methods/method.h"

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

namespace hooke::lab {

/// Holds the factors of 1 - gamma J at some state, with J = df/dy, which every implicit method solves with.
/// In
///
/// dx - gamma dv = a,   dv - gamma (da/dx dx + da/dv dv) = b
///
/// dx = a + gamma dv is eliminated, so that half the size is left:
///
/// (1 - gamma da/dv - gamma^2 da/dx) dv = b + gamma da/dx a
///
/// Eigen's SparseLU factors it, because drag in wind makes it unsymmetric.
class ImplicitMatrix {
 public:
  /// Factors the matrix at (t, y). \return Whether it is regular.
  bool factor(const System& f, double t, const State& y, double gamma);
  /// Gamma of the matrix, or 0 before one was factored.
  [[nodiscard]] double gamma() const { return gamma_; }

  /// Returns dv for a = 0.
  [[nodiscard]] State solve(const State& b) const { return factors_.solve(b); }
  /// Returns (dx, dv) for right = (a, b).
  [[nodiscard]] State solve_whole(const System& f, const State& right) const;

 private:
  using Matrix = Eigen::SparseMatrix<double>;
  Matrix by_position_;
  Eigen::SparseLU<Matrix> factors_;
  double gamma_ = 0;
};

/// Solves y = known + gamma f(t, y), which is one step of any implicit method here; `y` is the first guess.
/// With x = X + gamma v eliminated, only the velocities are unknown:
///
/// r(v) = v - V - gamma a(t, X + gamma v, v) = 0,   r' = 1 - gamma da/dv - gamma^2 da/dx
///
/// Newton's method first uses the matrix of an earlier step (work.matrix), while each step leaves at most a
/// tenth of |r|. Then it factors a new matrix each time, and halves a step until |r| falls; if no part of a
/// step lets |r| fall, it takes the whole step. It sets work.error without convergence in 60 steps, after ten
/// such whole steps, or when the matrix is singular.
void solve_implicit(const System& f, double t, double gamma, const State& known, State& y, Workspace& work);

/// Makes one step by rk4, in as many parts as keep it stable. Multistep methods begin with it.
void start_up(const System& f, double t, double h, State& y, Workspace& work);

}  // namespace hooke::lab
