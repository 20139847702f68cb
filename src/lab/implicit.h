#pragma once

#include "lab/method.h"

namespace hooke::lab {

/// Solves y = known + gamma f(t, y), from `y` as a first guess: one step of any implicit method of this
/// laboratory. With x = X + gamma v eliminated, for the velocities alone:
///
///     r(v) = v - V - gamma a(t, X + gamma v, v) = 0,   r' = 1 - gamma da/dv - gamma^2 da/dx
///
/// Newton with this exact sparse matrix (Eigen's SparseLU; drag in wind makes it unsymmetric), halving a step
/// until |r| falls, or taking it whole where no part of it lets |r| fall. Without convergence in 60 steps
/// work.error is set.
void solve_implicit(const System& f, double t, double gamma, const State& known, State& y, Workspace& work);

/// One step of rk4, in as many parts as keep it stable: what multistep methods begin with.
void start_up(const System& f, double t, double h, State& y, Workspace& work);

}  // namespace hooke::lab
