#pragma once

#include "hooke/math.h"

#include "math/symmetric.h"
#include "solver/body/joint_body.h"
#include "solver/joint_rows/joint_rows_tuning.h"
#include "state/bodies.h"
#include "state/hooks.h"

#include <array>
#include <cstdint>
#include <limits>
#include <span>

/// \file
/// From a hook between bodies to rows: the present values of its freedoms, and the directions along which
/// they change.

namespace hooke::solver {

enum class RowRole : std::uint8_t {
  kLock,
  kSpring,
  kMotor,
  kLimit,
};

/// One row asks for an impulse lambda in [low, high] such that
///
///   n.(v_b - v_a) + j_b.omega~_b - j_a.omega~_a + gamma lambda = target,
///
/// or lambda is at a bound and the left side is beyond the target on that side.
struct JointRow {
  DVec3 n = {};     ///< Direction; zero for angles.
  DVec3 axis = {};  ///< Axis of an angle; zero for displacements.
  DVec3 j_a = {};   ///< S_a (r_a x n), or S_a axis.
  DVec3 j_b = {};
  double c = 0;      ///< Value minus target [m or rad]; for a limit, the gap to the nearer bound.
  double start = 0;  ///< c at the start of the substep.
  double rate = 0;   ///< b: share of c that the target takes back, per time [1/s].
  double target = 0;
  double gamma = 0;
  double low = 0;
  double high = 0;
  RowRole role = RowRole::kLock;
};

/// The purpose of a row.
struct RowKind {
  int freedom = 0;  ///< 0 to 5 as in state::Hook; 6 is the cone of a ball.
  RowRole role = RowRole::kLock;
  [[nodiscard]] bool turns() const { return freedom >= 3; }
};

/// How many rows a hook has. It depends on its settings only, not on the state of its ends.
[[nodiscard]] int count_joint_rows(const state::Hook& hook);

/// Whether the rows of a hook need the angles of its freedoms.
[[nodiscard]] bool rows_turn(const state::Hook& hook);

/// Lists the kinds of these rows, displacements before angles; returns how many they are.
int list_joint_rows(const state::Hook& hook, std::span<RowKind, state::Hook::kMaxRows> kinds);

/// Makes the rows of a hook for a substep of length h [s], as many as count_joint_rows says; stores the
/// values of its freedoms in the hook.
///
/// Impulses along displacements act on both ends at b's anchor, so that the hook's total moment is zero to
/// rounding even while the anchors are apart. Errors are removed within the substep (b = 1/h), at most 10
/// m/s or 10 rad/s faster than the ends move already. Limits stop within the substep what would cross them.
/// What is beyond a limit comes back by a fifth in each substep, at 2 m/s or 2 rad/s at most, because the
/// bodies keep that speed. Springs act as in solver/soft/spring_solve.h. Angles are those of the rotation
/// taken apart about a's x, then y, then b's z. Their rates are the dual basis of these axes, which ends
/// where the second angle comes to 87 degrees. A ball's spring and friction act on the rotation vector, its
/// cone on the angle between the x axes, and its twist on the rest: rate omega.(x_a + x_b) / (1 + x_a.x_b).
/// Rows of a hook that gives way have its compliance in series (solver/joint/hook_breaks.h). Errors of locks
/// are taken back at `most_push` at most [m/s] or [rad/s].
int make_joint_rows(state::Hook& hook, const JointBody& a, const JointBody& b, double h,
                    std::span<JointRow, state::Hook::kMaxRows> rows,
                    double most_push = std::numeric_limits<double>::infinity());

/// Compliance of a hook without hold: a row with it is as one that is not there [1/kg, 1/(kg m^2)].
inline constexpr double kNoHold = 1e15;

/// -1 below the bounds, 1 above them.
[[nodiscard]] std::int8_t side_of(double value, double low, double high);

/// Whether a row stays at its bound (-1 or 1) if its speed there `lacks` so much [m/s].
[[nodiscard]] bool stays_at(std::int8_t bound, double lacks);

/// The bound at which a row begins a substep: the one at which it ended the last, with the impulse `last`.
[[nodiscard]] std::int8_t first_bound(const JointRow& row, double last);

/// Distance of b's anchor from the nearest place that locks and limits leave to it [m].
[[nodiscard]] double joint_gap(const state::Hook& hook, const JointBody& a, const JointBody& b);

/// Adds the impulses of a substep of length h [s] to those of the step. A hook that gave way in the substep
/// is broken: it takes nothing from then on.
void add_up_impulses(Real h, state::Hook& hook);

/// Stores the impulses of a substep in the hook.
void store_joint_impulses(std::span<const JointRow> rows, std::span<const double> lambda, state::Hook& hook);

}  // namespace hooke::solver
