#include "solver/joint_rows/joint_rows.h"

#include "base/assert.h"
#include "math/rotation.h"
#include "math/trig.h"
#include "solver/body/body_motion.h"
#include "solver/joint_rows/joint_rows_tuning.h"
#include "state/body_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hooke::solver {

namespace {

using math::Symmetric3;
using state::Hook;
using state::HookPlace;

using DQuat = Quaternion<double>;
using DMat3 = Matrix3<double>;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// The freedoms of a hook have numbers from 0 to 5. Balls have a cone besides; their twist has number 3.
constexpr int kTwist = 3;
constexpr int kCone = 6;
constexpr int kFreedoms = 7;

/// Directions and values of a hook's freedoms.
struct Freedoms {
  DVec3 r_a, r_b;  ///< Offsets from the centers of mass to b's anchor.
  std::array<DVec3, kFreedoms> axis;
  std::array<double, kFreedoms> value = {};
};

bool limited(const HookLimits& limits) {
  return std::isfinite(limits.lower) || std::isfinite(limits.upper);
}

bool sprung(const HookSpring& spring) {
  return spring.stiffness > Real(0) || spring.damping > Real(0);
}

/// Calls visit(freedom, role) for each row, always in the same order.
template <class Visit>
void for_each_row(const Hook& hook, Visit&& visit) {
  for (int i = 0; i < 6; ++i) {
    const HookFreedom& f = hook.freedom[i];
    if (f.locked) {
      visit(i, RowRole::kLock);
      continue;
    }
    if (sprung(f.spring)) visit(i, RowRole::kSpring);
    if (f.motor.max_force > Real(0)) visit(i, RowRole::kMotor);
    if (limited(f.limits)) visit(i, RowRole::kLimit);
  }
  if (std::isfinite(hook.cone)) visit(kCone, RowRole::kLimit);
}

/// Takes the rotation from a's axes to b's apart as angles about a's x, then y, then b's z.
void take_apart(const DMat3& a, const DMat3& b, Freedoms& f) {
  const DMat3 r = transpose(a) * b;
  const double alpha = math::atan2(-r.z.y, r.z.z);
  const double beta = math::atan2(r.z.x, std::sqrt(r.z.y * r.z.y + r.z.z * r.z.z));
  const double gamma = math::atan2(-r.y.x, r.x.x);
  f.value[3] = alpha;
  f.value[4] = beta;
  f.value[5] = gamma;
  const math::SinCos<double> turn = math::sin_cos(alpha);
  const DVec3 y = a * DVec3{0, turn.cos, turn.sin};
  const double scale = 1 / std::max(dot(a.x, cross(y, b.z)), kLeastAngleCosine);
  f.axis[3] = scale * cross(y, b.z);
  f.axis[4] = y;
  f.axis[5] = scale * cross(a.x, y);
}

/// Finds the rotation vector of a ball.
void take_apart_ball(const DMat3& axes_a, DQuat a, DQuat b, Freedoms& f) {
  DQuat q = conjugate(a) * b;
  if (q.w < 0) q = {-q.x, -q.y, -q.z, -q.w};
  const DVec3 u = {q.x, q.y, q.z};
  const double s = length(u);
  const double scale = s > 1e-12 ? 2 * math::atan2(s, q.w) / s : 2;
  f.axis[3] = axes_a.x;
  f.axis[4] = axes_a.y;
  f.axis[5] = axes_a.z;
  f.value[3] = scale * q.x;
  f.value[4] = scale * q.y;
  f.value[5] = scale * q.z;
}

DVec3 x_axis(DQuat q) {
  return rotate(q, DVec3{1, 0, 0});
}

/// Puts the twist of a ball in place of the first component of its rotation vector.
void take_twist(DQuat a, DQuat b, Freedoms& f) {
  const DQuat q = conjugate(a) * b;
  const DVec3 sum = x_axis(a) + x_axis(b);
  f.value[kTwist] = 2 * math::atan2(q.x, q.w);
  f.value[kTwist] -= math::whole_turns(f.value[kTwist]);
  f.axis[kTwist] = (2 / std::max(length_squared(sum), kLeastAngleCosine)) * sum;
}

void take_cone(DQuat a, DQuat b, Freedoms& f) {
  const DVec3 across = cross(x_axis(a), x_axis(b));
  f.value[kCone] = math::atan2(length(across), dot(x_axis(a), x_axis(b)));
  f.axis[kCone] = normalize(across);
}

/// Angles go on beyond whole turns: of equivalent angles, the one next to the last value is taken.
void count_turns(const Hook& hook, Freedoms& f) {
  for (int i = 3; i < 6; ++i) f.value[i] += math::whole_turns(hook.value[i] - f.value[i]);
}

Freedoms find_freedoms(const Hook& hook, const JointBody& a, const JointBody& b) {
  Freedoms f;
  const DVec3 arm_a = rotate(a.rotation, hook.a.anchor);
  f.r_b = rotate(b.rotation, hook.b.anchor);
  f.r_a = (b.center - a.center) + f.r_b;
  const DVec3 d = f.r_a - arm_a;
  f.r_a += a.ahead;
  f.r_b += b.ahead;
  const DQuat q_a = a.rotation * math::in_double(hook.a.axes);
  const DQuat q_b = b.rotation * math::in_double(hook.b.axes);
  const DMat3 axes_a = matrix_of(q_a);
  f.axis[0] = axes_a.x;
  f.axis[1] = axes_a.y;
  f.axis[2] = axes_a.z;
  f.value[0] = dot(d, axes_a.x);
  f.value[1] = dot(d, axes_a.y);
  f.value[2] = dot(d, axes_a.z);
  if (hook.kind == HookKind::kDistance) {
    f.value[0] = length(d);
    if (f.value[0] > 1e-9) f.axis[0] = normalize(d);
  }
  if (!rows_turn(hook)) return f;
  if (hook.kind == HookKind::kBall) {
    take_apart_ball(axes_a, q_a, q_b, f);
    take_cone(q_a, q_b, f);
  } else {
    take_apart(axes_a, matrix_of(q_b), f);
    count_turns(hook, f);
  }
  return f;
}

void make_spring(const HookSpring& spring, double h, JointRow& row) {
  const auto k = static_cast<double>(spring.stiffness);
  const auto c = static_cast<double>(spring.damping);
  row.gamma = 1 / (h * (c + h * k));
  row.rate = k / (c + h * k);
  row.target = -row.rate * row.c;
}

/// Weakens an error that is much smaller than `rounding`.
double without_rounding(double c, double rounding) {
  return c == 0 ? 0 : c * std::abs(c) / (std::abs(c) + rounding);
}

void make_limit(const HookLimits& limits, double value, double h, JointRow& row) {
  const double above = value - static_cast<double>(limits.lower);
  const double below = static_cast<double>(limits.upper) - value;
  if (below < above) {
    row.n = -row.n;
    row.axis = -row.axis;
    row.j_a = -row.j_a;
    row.j_b = -row.j_b;
  }
  row.c = std::min(above, below);
  row.low = 0;
  row.rate = (row.c > 0 ? 1 : kJointLimitShare) / h;
  row.target = std::min(-row.rate * row.c, kJointLimitSpeed);
}

}  // namespace

int count_joint_rows(const Hook& hook) {
  int count = 0;
  for_each_row(hook, [&](int, RowRole) { ++count; });
  return count;
}

bool rows_turn(const Hook& hook) {
  if (std::isfinite(hook.cone)) return true;
  for (int i = 3; i < 6; ++i) {
    const HookFreedom& f = hook.freedom[i];
    if (f.locked || sprung(f.spring) || f.motor.max_force > Real(0) || limited(f.limits)) return true;
  }
  return false;
}

int list_joint_rows(const Hook& hook, std::span<RowKind, Hook::kMaxRows> kinds) {
  int count = 0;
  for_each_row(hook, [&](int freedom, RowRole role) { kinds[count++] = {freedom, role}; });
  HOOKE_ASSERT(count <= Hook::kMaxRows);
  return count;
}

int make_joint_rows(Hook& hook, const JointBody& a, const JointBody& b, double h,
                    std::span<JointRow, Hook::kMaxRows> rows, double most_push) {
  Freedoms f = find_freedoms(hook, a, b);
  HOOKE_ASSERT(h > 0 && count_joint_rows(hook) <= Hook::kMaxRows);
  for (int i = 0; i < 6; ++i) hook.value[i] = f.value[i];
  const double fastest_translation = std::min(kJointPushSpeed + length(b.v - a.v), most_push);
  const double fastest_rotation =
      std::min(kJointPushSpeed + length(b.scale * b.omega_scaled - a.scale * a.omega_scaled), most_push);
  const double levers = length(f.r_a) + length(f.r_b);
  int count = 0;
  for_each_row(hook, [&](int i, RowRole role) {
    const bool is_translation = i < 3;
    const bool is_twist = hook.kind == HookKind::kBall && i == kTwist && role == RowRole::kLimit;
    if (is_twist)
      take_twist(a.rotation * math::in_double(hook.a.axes), b.rotation * math::in_double(hook.b.axes), f);
    JointRow& row = rows[count++];
    row = {.low = -kInfinite, .high = kInfinite, .role = role};
    (is_translation ? row.n : row.axis) = f.axis[i];
    row.j_a = a.scale * (is_translation ? cross(f.r_a, row.n) : row.axis);
    row.j_b = b.scale * (is_translation ? cross(f.r_b, row.n) : row.axis);
    const double fastest = is_translation ? fastest_translation : fastest_rotation;
    if (i == kCone) {
      row.gamma = hook.compliance[1];
      return make_limit({.upper = hook.cone}, f.value[i], h, row);
    }
    const HookFreedom& freedom = hook.freedom[i];
    row.c = f.value[i] - static_cast<double>(freedom.spring.target);
    switch (role) {
      case RowRole::kLock:
        if (!is_translation) row.c -= math::whole_turns(row.c);
        if (!hook.holds_point())
          row.c = without_rounding(row.c, kLockRounding * (is_translation ? levers : 1));
        row.rate = 1 / h;
        row.target = std::clamp(-row.rate * row.c, -fastest, fastest);
        break;
      case RowRole::kSpring:
        make_spring(freedom.spring, h, row);
        break;
      case RowRole::kMotor:
        row.target = static_cast<double>(freedom.motor.speed);
        row.high = h * static_cast<double>(freedom.motor.max_force);
        row.low = -row.high;
        break;
      case RowRole::kLimit:
        make_limit(freedom.limits, f.value[i], h, row);
        break;
    }
    row.gamma += hook.compliance[is_translation ? 0 : 1];
  });
  return count;
}

double joint_gap(const Hook& hook, const JointBody& a, const JointBody& b) {
  const Freedoms f = find_freedoms(hook, a, b);
  DVec3 gap;
  for (int i = 0; i < 3; ++i) {
    const HookFreedom& freedom = hook.freedom[i];
    const auto target = static_cast<double>(freedom.spring.target);
    const double nearest = freedom.locked ? target
                                          : std::clamp(f.value[i], static_cast<double>(freedom.limits.lower),
                                                       static_cast<double>(freedom.limits.upper));
    gap += (f.value[i] - nearest) * f.axis[i];
  }
  return length(gap);
}

bool stays_at(std::int8_t bound, double lacks) {
  return bound < 0 ? lacks <= kJointRoundingSpeed : lacks >= -kJointRoundingSpeed;
}

std::int8_t side_of(double value, double low, double high) {
  if (value < low) return -1;
  return value > high ? std::int8_t{1} : std::int8_t{0};
}

std::int8_t first_bound(const JointRow& row, double last) {
  if (row.role == RowRole::kLimit) return last > 0 || row.c <= 0 ? 0 : -1;
  if (row.role != RowRole::kMotor) return 0;
  const double nearly = 0.999 * row.high;
  return side_of(last, -nearly, nearly);
}

void add_up_impulses(Real h, Hook& hook) {
  if (hook.broken) {
    hook.impulse = {};
    hook.angular_impulse = {};
    hook.row_impulse = {};
    return;
  }
  hook.impulse_sum += hook.impulse;
  hook.angular_impulse_sum += hook.angular_impulse;
  hook.held += static_cast<double>(h);
  hook.broken = hook.giving != Hook::Giving::kHolds;
  if (hook.broken) hook.compliance = {kNoHold, kNoHold};
}

void store_joint_impulses(std::span<const JointRow> rows, std::span<const double> lambda, Hook& hook) {
  HOOKE_ASSERT(rows.size() == lambda.size() && rows.size() <= hook.row_impulse.size());
  DVec3 linear;
  DVec3 angular;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    linear += lambda[i] * rows[i].n;
    angular += lambda[i] * rows[i].axis;
    hook.row_impulse[i] = static_cast<Real>(lambda[i]);
  }
  hook.impulse = vector_cast<Real>(linear);
  hook.angular_impulse = vector_cast<Real>(angular);
}

}  // namespace hooke::solver
