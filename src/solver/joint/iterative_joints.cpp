#include "solver/joint/iterative_joints.h"

#include "base/assert.h"
#include "solver/joint/hook_breaks.h"
#include "solver/joint_rows/soft_locks.h"
#include "solver/linear/sweep_order.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hooke::solver {

namespace {

using parallel::Range;
using state::Hook;
using state::HookPlace;

constexpr int kGrain = 32;

/// The velocities of a joint's ends, read from the columns and written back.
struct Ends {
  JointBody a;
  JointBody b;
};

void load_velocity(const state::Bodies& bodies, std::uint32_t row, JointBody& body) {
  if (row == HookPlace::kWorld) return;
  body.v = vector_cast<double>(bodies.motion[row].v);
  body.omega_scaled = vector_cast<double>(bodies.motion[row].omega_scaled);
  body.inverse_mass = static_cast<double>(bodies.motion[row].inverse_mass);
}

void store_velocity(const JointBody& body, std::uint32_t row, state::Bodies& bodies) {
  if (!is_dynamic(bodies, row)) return;
  bodies.motion[row].v = vector_cast<Real>(body.v);
  bodies.motion[row].omega_scaled = vector_cast<Real>(body.omega_scaled);
}

void apply(const JointImpulse& p, Ends& ends) {
  ends.a.v -= ends.a.inverse_mass * p.linear;
  ends.b.v += ends.b.inverse_mass * p.linear;
  if (ends.a.inverse_mass > 0) ends.a.omega_scaled -= p.angular_a;
  if (ends.b.inverse_mass > 0) ends.b.omega_scaled += p.angular_b;
}

JointImpulse impulse_of(const JointRow& row, double lambda) {
  return {lambda * row.n, lambda * row.j_a, lambda * row.j_b};
}

void add(const JointImpulse& p, JointImpulse& sum) {
  sum.linear += p.linear;
  sum.angular_a += p.angular_a;
  sum.angular_b += p.angular_b;
}

/// K of solver/joint/iterative_joints.h.
double diagonal_of(const JointRow& row, const Ends& ends, const ExtraHooks& extra_hooks) {
  const auto part = [&](const JointBody& body, DVec3 j) {
    return body.inverse_mass > 0 ? body.inverse_mass * dot(row.n, row.n) + dot(j, j) : 0;
  };
  const double a = part(ends.a, row.j_a);
  const double b = part(ends.b, row.j_b);
  return a + b > 0 ? a + b + (extra_hooks.a * a * a + extra_hooks.b * b * b) / (a + b) : 0;
}

/// The change of a row's impulse.
double solve_row(const JointRow& row, const Ends& ends, double diagonal, double lambda, double h,
                 const LockSoftness& soft) {
  if (!(diagonal > 0)) return 0;
  const double v =
      dot(row.n, ends.b.v - ends.a.v) + dot(row.j_b, ends.b.omega_scaled) - dot(row.j_a, ends.a.omega_scaled);
  const bool is_free = row.role == RowRole::kSpring || row.role == RowRole::kMotor;
  double change = 0;
  if (is_free) {
    change = (row.target - v - row.gamma * lambda) / (diagonal + row.gamma);
  } else if (row.role == RowRole::kLimit && row.c > 0) {
    change = (-row.c / h - v) / diagonal;
  } else {
    change = -soft.mass_scale * (v + soft.rate * row.c) / diagonal - soft.impulse_scale * lambda;
  }
  return std::clamp(lambda + change, row.low, row.high) - lambda;
}

/// Calls visit(i) for every iterative joint that holds a body awake, color after color.
template <class Visit>
void for_each_joint(parallel::ThreadPool& pool, const std::vector<Hook>& hooks, const state::Bodies& bodies,
                    const IterativeJoints& iterative, SweepOrder order, Visit&& visit) {
  for_each_color(static_cast<int>(iterative.color_begin.size()) - 1, order, [&](int color) {
    const int first = iterative.color_begin[color];
    parallel::for_ranges(pool, iterative.color_begin[color + 1] - first, kGrain, [&](Range range) {
      for (int i = first + range.begin; i < first + range.end; ++i) {
        if (is_awake(hooks[iterative.hooks[i]], bodies)) visit(i);
      }
    });
  });
}

/// Makes the present rows, and applies along them the impulses that carry over.
void begin_joint(int i, double h, Hook& hook, state::Bodies& bodies, IterativeJoints& iterative) {
  Ends ends = {joint_body(bodies, hook.a.body), joint_body(bodies, hook.b.body)};
  std::array<JointRow, Hook::kMaxRows> rows;
  const int count = make_joint_rows(hook, ends.a, ends.b, h, rows);
  HOOKE_ASSERT(iterative.first_row[i] + count == iterative.first_row[i + 1]);
  std::copy_n(rows.begin(), count, iterative.rows.begin() + iterative.first_row[i]);
  JointImpulse warm;
  for (int k = 0; k < count; ++k) add(impulse_of(rows[k], static_cast<double>(hook.row_impulse[k])), warm);
  const JointImpulse& done = iterative.done[i];
  apply({warm.linear - done.linear, warm.angular_a - done.angular_a, warm.angular_b - done.angular_b}, ends);
  iterative.done[i] = warm;
  store_velocity(ends.a, hook.a.body, bodies);
  store_velocity(ends.b, hook.b.body, bodies);
}

/// The load that the rows of a hook take.
HookLoad load_of(std::span<const JointRow> rows, const Hook& hook) {
  DVec3 linear;
  DVec3 angular;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    linear += static_cast<double>(hook.row_impulse[k]) * rows[k].n;
    angular += static_cast<double>(hook.row_impulse[k]) * rows[k].axis;
  }
  return {length(linear), length(angular)};
}

/// Removes from the impulses of a hook what is more than it can take.
void cap_joint(std::span<const JointRow> rows, double need, Ends& ends, JointImpulse& done, Hook& hook) {
  if (!hook.broken && !(need > 1)) return;
  HOOKE_ASSERT(rows.size() <= hook.row_impulse.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Real before = hook.row_impulse[k];
    hook.row_impulse[k] = hook.broken ? Real(0) : static_cast<Real>(static_cast<double>(before) / need);
    const JointImpulse p = impulse_of(rows[k], static_cast<double>(hook.row_impulse[k] - before));
    apply(p, ends);
    add(p, done);
  }
}

/// How one pass solves the rows of all joints.
struct JointPass {
  double h = 0;  ///< Length of the substep [s].
  LockSoftness soft = {};
  SweepOrder order = SweepOrder::kForward;
};

/// Solves the rows of a joint once. Returns what the hook needed.
HookLoad solve_joint(int i, const JointPass& pass, Hook& hook, state::Bodies& bodies,
                     IterativeJoints& iterative) {
  Ends ends;
  load_velocity(bodies, hook.a.body, ends.a);
  load_velocity(bodies, hook.b.body, ends.b);
  const int count = iterative.first_row[i + 1] - iterative.first_row[i];
  for (int step = 0; step < count; ++step) {
    const int k = pass.order == SweepOrder::kForward ? step : count - 1 - step;
    const JointRow& row = iterative.rows[iterative.first_row[i] + k];
    Real& lambda = hook.row_impulse[k];
    const double diagonal = diagonal_of(row, ends, iterative.extra_hooks[i]);
    const double change = solve_row(row, ends, diagonal, static_cast<double>(lambda), pass.h, pass.soft);
    lambda += static_cast<Real>(change);
    const JointImpulse p = impulse_of(row, change);
    apply(p, ends);
    add(p, iterative.done[i]);
  }
  HookLoad load;
  if (hook.can_break()) {
    const auto rows =
        std::span(iterative.rows)
            .subspan(static_cast<std::size_t>(iterative.first_row[i]), static_cast<std::size_t>(count));
    load = load_of(rows, hook);
    cap_joint(rows, need_of(hook, load, pass.h), ends, iterative.done[i], hook);
  }
  store_velocity(ends.a, hook.a.body, bodies);
  store_velocity(ends.b, hook.b.body, bodies);
  return load;
}

/// Sweeps sometimes need more than there is, until they have converged: two consecutive substeps count.
void note_need(double h, const HookLoad& load, Hook& hook) {
  const HookLoad last = {static_cast<double>(hook.last_impulse),
                         static_cast<double>(hook.last_angular_impulse)};
  const double need = need_of(hook, load, h);
  if (std::min(need, need_of(hook, last, h)) > 1) let_go(h, need, load, hook);
  hook.last_impulse = static_cast<Real>(load.impulse);
  hook.last_angular_impulse = static_cast<Real>(load.angular_impulse);
}

}  // namespace

void count_hooks(std::span<const std::uint32_t> hook_rows, const std::vector<Hook>& hooks,
                 const state::Bodies& bodies, std::vector<int>& degree) {
  degree.assign(bodies.motion.size(), 0);
  for (const std::uint32_t row : hook_rows) {
    for (const std::uint32_t body : {hooks[row].a.body, hooks[row].b.body}) {
      if (is_dynamic(bodies, body)) ++degree[body];
    }
  }
}

void build_iterative_joints(std::span<const std::uint32_t> hook_rows, const std::vector<Hook>& hooks,
                            const state::Bodies& bodies, const std::vector<int>& degree,
                            ColorScratch& scratch, IterativeJoints& iterative) {
  color_hooks(hook_rows, hooks, bodies, scratch, {iterative.hooks, iterative.color_begin});
  iterative.first_row.assign(1, 0);
  for (const std::uint32_t row : iterative.hooks)
    iterative.first_row.push_back(iterative.first_row.back() + count_joint_rows(hooks[row]));
  iterative.rows.resize(static_cast<std::size_t>(iterative.first_row.back()));
  iterative.done.resize(iterative.hooks.size());
  iterative.extra_hooks.clear();
  const auto beyond = [&](std::uint32_t body) {
    return is_dynamic(bodies, body) ? static_cast<double>(std::max(0, degree[body] - kMostFreeHooks)) : 0.0;
  };
  for (const std::uint32_t row : iterative.hooks)
    iterative.extra_hooks.push_back({beyond(hooks[row].a.body), beyond(hooks[row].b.body)});
}

void prepare_iterative_joints(IterativeJoints& iterative) {
  HOOKE_ASSERT(iterative.done.size() == iterative.hooks.size());
  HOOKE_ASSERT(iterative.first_row.size() == iterative.hooks.size() + 1);
  std::fill(iterative.done.begin(), iterative.done.end(), JointImpulse{});
}

void solve_iterative_joints(parallel::ThreadPool& pool, double h, std::vector<Hook>& hooks,
                            state::Bodies& bodies, IterativeJoints& iterative) {
  const JointPass pass = {.h = h, .soft = lock_softness(h), .order = SweepOrder::kForward};
  for_each_joint(pool, hooks, bodies, iterative, pass.order,
                 [&](int i) { begin_joint(i, h, hooks[iterative.hooks[i]], bodies, iterative); });
  for_each_joint(pool, hooks, bodies, iterative, pass.order,
                 [&](int i) { solve_joint(i, pass, hooks[iterative.hooks[i]], bodies, iterative); });
}

void relax_iterative_joints(parallel::ThreadPool& pool, double h, std::vector<Hook>& hooks,
                            state::Bodies& bodies, IterativeJoints& iterative) {
  const JointPass pass = {.h = h, .soft = {}, .order = SweepOrder::kBackward};
  for_each_joint(pool, hooks, bodies, iterative, pass.order, [&](int i) {
    Hook& hook = hooks[iterative.hooks[i]];
    const HookLoad load = solve_joint(i, pass, hook, bodies, iterative);
    if (hook.can_break()) note_need(h, load, hook);
    std::array<double, Hook::kMaxRows> lambda = {};
    std::copy(hook.row_impulse.begin(), hook.row_impulse.end(), lambda.begin());
    const auto first = static_cast<std::size_t>(iterative.first_row[i]);
    const auto count = static_cast<std::size_t>(iterative.first_row[i + 1]) - first;
    store_joint_impulses({iterative.rows.data() + first, count}, {lambda.data(), count}, hook);
  });
}

}  // namespace hooke::solver
