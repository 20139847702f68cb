#include "solver/joint/ball_joints.h"

#include "base/assert.h"
#include "math/rotation.h"
#include "solver/body/body_motion.h"
#include "solver/joint/ball_joint_kernels.h"
#include "solver/joint_rows/joint_rows.h"
#include "solver/joint_rows/soft_locks.h"
#include "solver/linear/sweep_order.h"
#include "state/body_frames.h"

#include <algorithm>
#include <span>
#include <utility>

namespace hooke::solver {

namespace {

using parallel::Range;
using state::Bodies;
using state::Hook;
using state::HookPlace;

constexpr int kFillGrain = 8;
constexpr int kSolveGrain = 4;

bool may_be_in_block(const Bodies& bodies, std::uint32_t body) {
  return body != HookPlace::kWorld && (!is_dynamic(bodies, body) || !is_gyroscopic(bodies.mass[body]));
}

/// A hook as the block has it.
struct BallEnds {
  const HookPlace& a;
  const HookPlace& b;
  Real sign = Real(1);  ///< Sign of impulses and gaps: -1 where the ends are swapped.
  bool anchored = false;
};

BallEnds ends_of(const Hook& hook, const Bodies& bodies) {
  if (!is_dynamic(bodies, hook.a.body)) return {hook.b, hook.a, Real(-1), true};
  return {hook.a, hook.b, Real(1), !is_dynamic(bodies, hook.b.body)};
}

/// The axes along which a hook's rows are: those of its end a.
Mat3 row_axes(const Hook& hook, const Bodies& bodies) {
  return matrix_of(normalize(bodies.rotation[hook.a.body] * hook.a.axes));
}

Vec3 row_impulse(const Hook& hook) {
  return {hook.row_impulse[0], hook.row_impulse[1], hook.row_impulse[2]};
}

template <int kCount>
void put(const std::array<Real, kCount>& value, Real (&to)[kCount][kLanes], int lane) {
  for (int i = 0; i < kCount; ++i) to[i][lane] = value[i];
}
void put(Vec3 value, Real (&to)[3][kLanes], int lane) {
  put<3>({value.x, value.y, value.z}, to, lane);
}
Vec3 vector_at(const Real (&from)[3][kLanes], int lane) {
  return {from[0][lane], from[1][lane], from[2][lane]};
}

void put_scale(const Bodies& bodies, std::uint32_t body, Real (&to)[6][kLanes], int lane) {
  const math::Symmetric3<Real> s =
      is_dynamic(bodies, body) ? bodies.scale[body] : math::Symmetric3<Real>::diagonal(Real(1));
  put<6>({s.xx, s.xy, s.xz, s.yy, s.yz, s.zz}, to, lane);
}

/// The vector from the center of mass to the anchor at the start of the step.
DVec3 arm_of(const HookPlace& end, const Bodies& bodies) {
  return rotate(math::in_double(bodies.rotation[end.body]), end.anchor);
}

void fill_lane(Real h, Hook& hook, const Bodies& bodies, BallBlock& block, int lane) {
  const BallEnds ends = ends_of(hook, bodies);
  HOOKE_ASSERT(is_dynamic(bodies, ends.a.body) && ends.b.body != HookPlace::kWorld);
  const DVec3 arm_a = arm_of(ends.a, bodies);
  const DVec3 arm_b = arm_of(ends.b, bodies);
  const DVec3 gap = (bodies.center[ends.b.body] - bodies.center[ends.a.body]) + (arm_b - arm_a);
  block.record_a[lane] = 16 * ends.a.body;
  block.record_b[lane] = 16 * ends.b.body;
  block.w_a[lane] = bodies.motion[ends.a.body].inverse_mass;
  block.w_b[lane] = bodies.motion[ends.b.body].inverse_mass;
  put_scale(bodies, ends.a.body, block.scale_a, lane);
  put_scale(bodies, ends.b.body, block.scale_b, lane);
  put(vector_cast<Real>(arm_a), block.arm_a, lane);
  put(vector_cast<Real>(arm_b), block.arm_b, lane);
  put(vector_cast<Real>(gap), block.gap, lane);
  const Mat3 axes = row_axes(hook, bodies);
  put(ends.sign * (axes * row_impulse(hook)), block.impulse, lane);
  block.size[lane] = hook.last_impulse;
  block.strength[lane] = h * hook.break_force;
  const Vec3 error = ends.sign * (transpose(axes) * vector_cast<Real>(gap));
  hook.value[0] = static_cast<double>(error.x);
  hook.value[1] = static_cast<double>(error.y);
  hook.value[2] = static_cast<double>(error.z);
}

/// Fills the block with the hooks of `rows`, which begin at lane `first` of the plan.
void fill_block(Real h, std::span<const std::uint32_t> rows, std::size_t first, std::vector<Hook>& hooks,
                const Bodies& bodies, BallBlock& block) {
  HOOKE_ASSERT(!rows.empty() && rows.size() <= kLanes);
  block = {};
  block.first = first;
  block.count = static_cast<int>(rows.size());
  block.anchored = ends_of(hooks[rows[0]], bodies).anchored;
  for (int lane = 0; lane < kLanes; ++lane) {
    fill_lane(h, hooks[rows[std::min<std::size_t>(lane, rows.size() - 1)]], bodies, block, lane);
  }
}

void store_lane(const BallBlock& block, int lane, Real h, const Bodies& bodies, Hook& hook) {
  const Real sign = ends_of(hook, bodies).sign;
  hook.impulse = sign * vector_at(block.impulse, lane);
  hook.impulse_sum = sign * vector_at(block.impulse_sum, lane);
  hook.last_impulse = block.size[lane];
  hook.broken = block.broken[lane] > Real(0);
  hook.held = static_cast<double>(h * block.held[lane]);
  hook.needed_force = block.needed[lane] / h;
  const Vec3 rows = transpose(row_axes(hook, bodies)) * hook.impulse;
  hook.row_impulse[0] = rows.x;
  hook.row_impulse[1] = rows.y;
  hook.row_impulse[2] = rows.z;
}

/// Calls visit(blocks) for ranges of blocks, color after color.
template <class Visit>
void for_each_range(parallel::ThreadPool& pool, BallJoints& joints, SweepOrder order, Visit&& visit) {
  for_each_color(static_cast<int>(joints.block_begin.size()) - 1, order, [&](int color) {
    const int first = joints.block_begin[color];
    const auto of_color = std::span(joints.blocks).subspan(static_cast<std::size_t>(first));
    parallel::for_ranges(pool, joints.block_begin[color + 1] - first, kSolveGrain, [&](Range range) {
      visit(of_color.subspan(static_cast<std::size_t>(range.begin), static_cast<std::size_t>(range.count())));
    });
  });
}

/// Plans the blocks of the hooks of one color that are awake: first those with two bodies that move, then the
/// others.
void plan_color(int color, const std::vector<Hook>& hooks, const Bodies& bodies, BallJoints& joints) {
  for (const bool anchored : {false, true}) {
    std::size_t begin = joints.hook_of.size();
    for (int i = joints.color_begin[color]; i < joints.color_begin[color + 1]; ++i) {
      const std::uint32_t row = joints.hooks[i];
      if (ends_of(hooks[row], bodies).anchored != anchored) continue;
      if (!is_awake(hooks[row], bodies)) {
        joints.resting.push_back(row);
        continue;
      }
      joints.hook_of.push_back(row);
      if (joints.hook_of.size() - begin < kLanes) continue;
      joints.plan.emplace_back(begin, kLanes);
      begin = joints.hook_of.size();
    }
    if (joints.hook_of.size() > begin) joints.plan.emplace_back(begin, joints.hook_of.size() - begin);
  }
  joints.block_begin.push_back(static_cast<int>(joints.plan.size()));
}

}  // namespace

bool is_plain_ball(const Hook& hook, const Bodies& bodies) {
  if (hook.kind == HookKind::kDistance || count_joint_rows(hook) != 3) return false;
  for (int axis = 0; axis < 3; ++axis) {
    if (!hook.freedom[axis].locked || hook.freedom[axis].spring.target != Real(0)) return false;
  }
  return may_be_in_block(bodies, hook.a.body) && may_be_in_block(bodies, hook.b.body) &&
         (is_dynamic(bodies, hook.a.body) || is_dynamic(bodies, hook.b.body));
}

void build_ball_joints(std::span<const std::uint32_t> hook_rows, const std::vector<Hook>& hooks,
                       const Bodies& bodies, ColorScratch& scratch, BallJoints& joints) {
  color_hooks(hook_rows, hooks, bodies, scratch, {joints.hooks, joints.color_begin});
}

void prepare_ball_joints(parallel::ThreadPool& pool, Real h, std::vector<Hook>& hooks, const Bodies& bodies,
                         BallJoints& joints) {
  joints.hook_of.clear();
  joints.resting.clear();
  joints.block_begin.assign(1, 0);
  joints.fresh = true;
  joints.plan.clear();
  for (int color = 0; color + 1 < static_cast<int>(joints.color_begin.size()); ++color)
    plan_color(color, hooks, bodies, joints);
  HOOKE_ASSERT(joints.hook_of.size() + joints.resting.size() == joints.hooks.size());
  joints.blocks.resize(joints.plan.size());
  parallel::for_ranges(pool, static_cast<int>(joints.plan.size()), kFillGrain, [&](Range range) {
    for (int i = range.begin; i < range.end; ++i) {
      const auto [begin, count] = joints.plan[i];
      fill_block(h, std::span(joints.hook_of).subspan(begin, count), begin, hooks, bodies, joints.blocks[i]);
    }
  });
}

void solve_ball_joints(parallel::ThreadPool& pool, Real h, Bodies& bodies, BallJoints& joints) {
  const LockSoftness soft = lock_softness(static_cast<double>(h));
  constexpr SweepOrder kForward = SweepOrder::kForward;
  const wide::BallPass pass = {static_cast<Real>(soft.rate), static_cast<Real>(soft.mass_scale),
                               static_cast<Real>(soft.impulse_scale)};
  if (joints.fresh) {
    for_each_range(pool, joints, kForward,
                   [&](auto blocks) { wide::warm_start_balls(blocks, bodies.motion.data()); });
  }
  for_each_range(pool, joints, kForward,
                 [&](auto blocks) { wide::solve_balls(blocks, pass, bodies.motion.data()); });
  joints.fresh = false;
}

void relax_ball_joints(parallel::ThreadPool& pool, Bodies& bodies, BallJoints& joints) {
  for_each_range(pool, joints, SweepOrder::kBackward,
                 [&](auto blocks) { wide::relax_balls(blocks, bodies.motion.data()); });
}

void store_ball_joints(parallel::ThreadPool& pool, Real dt, int substeps, const Bodies& bodies,
                       const BallJoints& joints, std::vector<Hook>& hooks) {
  parallel::for_ranges(pool, static_cast<int>(joints.blocks.size()), kFillGrain, [&](Range range) {
    for (int i = range.begin; i < range.end; ++i) {
      const BallBlock& block = joints.blocks[i];
      for (int lane = 0; lane < block.count; ++lane) {
        store_lane(block, lane, dt / static_cast<Real>(substeps), bodies,
                   hooks[joints.hook_of[block.first + static_cast<std::size_t>(lane)]]);
      }
    }
  });
  for (const std::uint32_t row : joints.resting)
    hooks[row].impulse_sum = static_cast<Real>(substeps) * hooks[row].impulse;
}

}  // namespace hooke::solver
