/// The kernels in one source for every instruction set, then their dispatch.
///
/// A particle is one 16-byte record {x, y, z, w}; see solver/simd/records.h. A row needs only differences of
/// positions, which are taken before the transposition.

#include "solver/soft/particle_kernels.h"

#include "math/trig.h"

#include <limits>
#include <numbers>

#ifndef HOOKE_DOUBLE_PRECISION

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/soft/particle_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After Highway, which includes this file anew for each instruction set.
#include "solver/simd/records.h"

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR

void solve_springs_here(const SpringRun& run, const SpringMaterial& material,
                        const state::PositionRecord* position, state::VelocityRecord* velocity) {
  solve_springs_scalar(run, material, position, velocity);
}

void solve_bends_here(const BendRun& run, const state::PositionRecord* position,
                      state::VelocityRecord* velocity) {
  solve_bends_scalar(run, position, velocity);
}

void accelerate_here(Vec3 acceleration, float h, parallel::Range rows, state::Particles& particles) {
  accelerate_scalar(acceleration, h, rows, particles);
}

void move_here(float h, parallel::Range rows, state::Particles& particles) {
  move_scalar(h, rows, particles);
}

#else

constexpr float kPi = std::numbers::pi_v<float>;

/// One vector in space for each row.
struct Vectors {
  Vector x, y, z;
};

/// The values of kWidth rows between their loads and their stores.
struct Rows {
  Vector dx, dy, dz, s;
  Columns v_a, v_b;  ///< Velocities, and inverse masses in w.
};

HWY_INLINE void load_rows(const SpringBlock& block, int first, const float* position, const float* velocity,
                          Rows& rows) {
  const std::uint32_t* a = block.record_a + first;
  const std::uint32_t* b = block.record_b + first;
  const Columns d = load_offsets(position, a, b);
  rows.dx = d.x;
  rows.dy = d.y;
  rows.dz = d.z;
  rows.v_a = load_columns(velocity, a);
  rows.v_b = load_columns(velocity, b);
}

/// How springs of a material are solved.
struct Law {
  Vector bias, gamma, recovery, recovery_time;
};

template <bool kOneSided, bool kRigid>
HWY_INLINE void compute_impulses(Rows& rows, Vector rest_length, const Law& law) {
  const Vector l2 =
      hn::Add(hn::Add(hn::Mul(rows.dx, rows.dx), hn::Mul(rows.dy, rows.dy)), hn::Mul(rows.dz, rows.dz));
  const Vector l = hn::Sqrt(l2);
  const Vector rate = hn::Add(hn::Add(hn::Mul(rows.dx, hn::Sub(rows.v_a.x, rows.v_b.x)),
                                      hn::Mul(rows.dy, hn::Sub(rows.v_a.y, rows.v_b.y))),
                              hn::Mul(rows.dz, hn::Sub(rows.v_a.z, rows.v_b.z)));
  Vector error = hn::Mul(l, hn::Sub(l, rest_length));
  if constexpr (kRigid) {
    const Vector none = hn::Zero(kTag);
    const Vector whole = hn::Mul(l, law.recovery);
    const Vector most = hn::Add(whole, hn::Mul(law.recovery_time, hn::Max(rate, none)));
    const Vector least = hn::Sub(hn::Mul(law.recovery_time, hn::Min(rate, none)), whole);
    if constexpr (!kOneSided) error = hn::Max(error, least);
    error = hn::Min(error, most);
  }
  Vector numerator = hn::Add(rate, hn::Mul(law.bias, error));
  const Vector zero = hn::Zero(kTag);
  if constexpr (kOneSided) numerator = hn::IfThenElseZero(hn::Gt(numerator, zero), numerator);
  const Vector denominator = hn::Mul(l2, hn::Add(hn::Add(rows.v_a.w, rows.v_b.w), law.gamma));
  rows.s = hn::IfThenElseZero(hn::Gt(denominator, zero), hn::Div(numerator, denominator));
}

template <bool kAnchored>
HWY_INLINE void apply_impulses(const Rows& rows, const SpringBlock& block, int first, float* velocity) {
  const Vector x = hn::Mul(rows.dx, rows.s);
  const Vector y = hn::Mul(rows.dy, rows.s);
  const Vector z = hn::Mul(rows.dz, rows.s);
  const Columns& a = rows.v_a;
  store_columns(
      {hn::Sub(a.x, hn::Mul(a.w, x)), hn::Sub(a.y, hn::Mul(a.w, y)), hn::Sub(a.z, hn::Mul(a.w, z)), a.w},
      velocity, block.record_a + first);
  if constexpr (kAnchored) return;
  const Columns& b = rows.v_b;
  store_columns(
      {hn::Add(b.x, hn::Mul(b.w, x)), hn::Add(b.y, hn::Mul(b.w, y)), hn::Add(b.z, hn::Mul(b.w, z)), b.w},
      velocity, block.record_b + first);
}

/// A vector of rows: the lanes of a block from `first` on.
template <class Block>
struct BlockLanes {
  const Block* block;
  int first;
};

template <class Block>
HWY_INLINE int count_vectors(const Run<Block>& run) {
  const int rows = kLanes * (static_cast<int>(run.blocks.size()) - 1) + run.last_count;
  return (rows + kWidth - 1) / kWidth;
}

template <class Block>
HWY_INLINE BlockLanes<Block> lanes_at(const Run<Block>& run, int vector) {
  return {&run.blocks[vector * kWidth / kLanes], vector * kWidth % kLanes};
}

/// Solves `kCount` vectors in three stages together: the processor works on one while it waits for the roots
/// and quotients of the other. All loads come before the first store, so the copies of the last row that
/// fill a partial block store what that row stores.
template <int kCount, bool kOneSided, bool kAnchored, bool kRigid>
HWY_INLINE void solve_vectors(const BlockLanes<SpringBlock> (&at)[kCount], const Law& law,
                              const float* position, float* velocity) {
  Rows rows, more;
  load_rows(*at[0].block, at[0].first, position, velocity, rows);
  if constexpr (kCount > 1) load_rows(*at[1].block, at[1].first, position, velocity, more);
  compute_impulses<kOneSided, kRigid>(rows, hn::LoadU(kTag, at[0].block->rest_length + at[0].first), law);
  if constexpr (kCount > 1) {
    compute_impulses<kOneSided, kRigid>(more, hn::LoadU(kTag, at[1].block->rest_length + at[1].first), law);
  }
  apply_impulses<kAnchored>(rows, *at[0].block, at[0].first, velocity);
  if constexpr (kCount > 1) apply_impulses<kAnchored>(more, *at[1].block, at[1].first, velocity);
}

template <bool kOneSided, bool kAnchored, bool kRigid>
void solve_run(const SpringRun& run, const SpringMaterial& material, const float* position, float* velocity) {
  const Law law = {hn::Set(kTag, material.bias), hn::Set(kTag, material.gamma),
                   hn::Set(kTag, material.recovery), hn::Set(kTag, material.recovery_time)};
  const int vectors = count_vectors(run);
  int i = 0;
  for (; i + 1 < vectors; i += 2) {
    solve_vectors<2, kOneSided, kAnchored, kRigid>({lanes_at(run, i), lanes_at(run, i + 1)}, law, position,
                                                   velocity);
  }
  if (i < vectors)
    solve_vectors<1, kOneSided, kAnchored, kRigid>({lanes_at(run, i)}, law, position, velocity);
}

template <bool kRigid>
void solve_kind(const SpringRun& run, const SpringMaterial& material, const float* position,
                float* velocity) {
  if (material.anchored) {
    solve_run<true, true, kRigid>(run, material, position, velocity);
  } else if (material.one_sided) {
    solve_run<true, false, kRigid>(run, material, position, velocity);
  } else {
    solve_run<false, false, kRigid>(run, material, position, velocity);
  }
}

void solve_springs_here(const SpringRun& run, const SpringMaterial& material,
                        const state::PositionRecord* positions, state::VelocityRecord* velocities) {
  const auto* position = reinterpret_cast<const float*>(positions);
  auto* velocity = reinterpret_cast<float*>(velocities);
  if (material.is_rigid()) {
    solve_kind<true>(run, material, position, velocity);
  } else {
    solve_kind<false>(run, material, position, velocity);
  }
}

HWY_INLINE Vectors subtract(Vectors a, Vectors b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

HWY_INLINE Vectors add(Vectors a, Vectors b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}

HWY_INLINE Vectors scale(Vector s, Vectors a) {
  return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)};
}

HWY_INLINE Vector dot(Vectors a, Vectors b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

HWY_INLINE Vectors cross(Vectors a, Vectors b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

/// math::quick_atan2.
HWY_INLINE Vector angle_of(Vector sine, Vector cosine) {
  const Vector zero = hn::Zero(kTag);
  const Vector size_x = hn::Abs(cosine);
  const Vector size_y = hn::Abs(sine);
  const auto is_steep = hn::Gt(size_y, size_x);
  const Vector larger = hn::IfThenElse(is_steep, size_y, size_x);
  const Vector smaller = hn::IfThenElse(is_steep, size_x, size_y);
  const Vector t = hn::IfThenElseZero(hn::Gt(larger, zero), hn::Div(smaller, larger));
  const Vector z = hn::Mul(t, t);
  const Vector z2 = hn::Mul(z, z);
  const auto k = [](int i) HWY_ATTR { return hn::Set(kTag, math::kArctangent[i]); };
  const auto pair = [&](int i) HWY_ATTR { return hn::Add(k(i), hn::Mul(z, k(i + 1))); };
  const Vector high = hn::Add(pair(4), hn::Mul(z2, k(6)));
  const Vector p = hn::Add(pair(0), hn::Mul(z2, hn::Add(pair(2), hn::Mul(z2, high))));
  Vector angle = hn::Add(t, hn::Mul(hn::Mul(t, z), p));
  angle = hn::IfThenElse(is_steep, hn::Sub(hn::Set(kTag, kPi / 2), angle), angle);
  angle = hn::IfThenElse(hn::Lt(cosine, zero), hn::Sub(hn::Set(kTag, kPi), angle), angle);
  return hn::CopySign(angle, sine);
}

/// theta - theta_0 in (-pi, pi].
HWY_INLINE Vector wrapped_error(Vector angle, Vector rest_angle) {
  const Vector turn = hn::Set(kTag, 2 * kPi);
  Vector c = hn::Sub(angle, rest_angle);
  c = hn::IfThenElse(hn::Gt(c, hn::Set(kTag, kPi)), hn::Sub(c, turn), c);
  return hn::IfThenElse(hn::Le(c, hn::Set(kTag, -kPi)), hn::Add(c, turn), c);
}

/// A vector of bend rows between its loads and its stores, with the names of solver/soft/bending.h.
struct BendVectors {
  Vector l, l2, inverse_aa, inverse_bb;
  Vector error;            ///< theta - theta_0
  Vectors g0, g1, ua, ub;  ///< Gradients divided by l: g0, g1, -ua, -ub.
  Columns v0, v1, v2, v3;
  Vector s;  ///< -l lambda
};

HWY_INLINE void load_bend_vectors(BlockLanes<BendBlock> at, const float* position, BendVectors& rows) {
  const std::uint32_t* x0 = at.block->record[0] + at.first;
  const auto from_x0 = [&](int k) HWY_ATTR {
    const Columns d = load_offsets(position, at.block->record[k] + at.first, x0);
    return Vectors{d.x, d.y, d.z};
  };
  const Vectors e = from_x0(1);
  const Vectors d2 = from_x0(2);
  const Vectors d3 = from_x0(3);
  const Vectors na = cross(e, d2);
  const Vectors nb = cross(d3, e);
  const Vector aa = dot(na, na);
  const Vector bb = dot(nb, nb);
  rows.l2 = dot(e, e);
  rows.l = hn::Sqrt(rows.l2);
  const Vector one = hn::Set(kTag, 1.0f);
  const Vector least = hn::Set(kTag, std::numeric_limits<float>::min());
  const auto has_extent = hn::And(hn::And(hn::Ge(rows.l2, least), hn::Ge(aa, least)), hn::Ge(bb, least));
  const auto inverse = [&](Vector size)
                           HWY_ATTR { return hn::IfThenElseZero(has_extent, hn::Div(one, size)); };
  const Vector inverse_l2 = inverse(rows.l2);
  const Vector alpha = hn::Mul(dot(d2, e), inverse_l2);
  const Vector beta = hn::Mul(dot(d3, e), inverse_l2);
  rows.inverse_aa = inverse(aa);
  rows.inverse_bb = inverse(bb);
  rows.ua = scale(rows.inverse_aa, na);
  rows.ub = scale(rows.inverse_bb, nb);
  rows.g0 = add(scale(hn::Sub(one, alpha), rows.ua), scale(hn::Sub(one, beta), rows.ub));
  rows.g1 = add(scale(alpha, rows.ua), scale(beta, rows.ub));
  const Vector angle = angle_of(hn::Neg(hn::Mul(rows.l, dot(na, d3))), dot(na, nb));
  rows.error = wrapped_error(angle, hn::LoadU(kTag, at.block->rest_angle + at.first));
}

HWY_INLINE Vector rate_of(Vectors g, const Columns& v) {
  return dot(g, {v.x, v.y, v.z});
}

/// Velocities are loaded only now, when most numbers that positions needed have left the registers. Rows
/// without extent have no gradients, so that their impulse is zero whatever s is.
HWY_INLINE void compute_impulses(BlockLanes<BendBlock> at, const float* velocity, BendVectors& rows) {
  rows.v0 = load_columns(velocity, at.block->record[0] + at.first);
  rows.v1 = load_columns(velocity, at.block->record[1] + at.first);
  rows.v2 = load_columns(velocity, at.block->record[2] + at.first);
  rows.v3 = load_columns(velocity, at.block->record[3] + at.first);
  const Vector rate = hn::Sub(hn::Add(rate_of(rows.g0, rows.v0), rate_of(rows.g1, rows.v1)),
                              hn::Add(rate_of(rows.ua, rows.v2), rate_of(rows.ub, rows.v3)));
  const Vector w =
      hn::Add(hn::Add(hn::Mul(rows.v0.w, dot(rows.g0, rows.g0)), hn::Mul(rows.v1.w, dot(rows.g1, rows.g1))),
              hn::Add(hn::Mul(rows.v2.w, rows.inverse_aa), hn::Mul(rows.v3.w, rows.inverse_bb)));
  const Vector bias = hn::LoadU(kTag, at.block->bias + at.first);
  const Vector gamma = hn::LoadU(kTag, at.block->gamma + at.first);
  const Vector numerator = hn::Add(hn::Mul(rows.l, rate), hn::Mul(bias, rows.error));
  const Vector denominator = hn::Add(hn::Mul(rows.l2, w), gamma);
  const auto holds = hn::Gt(denominator, hn::Zero(kTag));
  rows.s = hn::IfThenElseZero(holds, hn::Mul(rows.l, hn::Div(numerator, denominator)));
}

template <class Combine>
HWY_INLINE Columns changed(const Columns& v, Vectors g, Vector s, Combine combine) {
  const Vectors after = combine(Vectors{v.x, v.y, v.z}, scale(hn::Mul(v.w, s), g));
  return {after.x, after.y, after.z, v.w};
}

HWY_INLINE void apply_impulses(const BendVectors& rows, BlockLanes<BendBlock> at, float* velocity) {
  store_columns(changed(rows.v0, rows.g0, rows.s, subtract), velocity, at.block->record[0] + at.first);
  store_columns(changed(rows.v1, rows.g1, rows.s, subtract), velocity, at.block->record[1] + at.first);
  store_columns(changed(rows.v2, rows.ua, rows.s, add), velocity, at.block->record[2] + at.first);
  store_columns(changed(rows.v3, rows.ub, rows.s, add), velocity, at.block->record[3] + at.first);
}

void solve_bends_here(const BendRun& run, const state::PositionRecord* positions,
                      state::VelocityRecord* velocities) {
  const auto* position = reinterpret_cast<const float*>(positions);
  auto* velocity = reinterpret_cast<float*>(velocities);
  const int vectors = count_vectors(run);
  for (int i = 0; i < vectors; i += 2) {
    // The last of an odd number of vectors is solved twice: both store the same.
    const bool is_pair = i + 1 < vectors;
    const BlockLanes<BendBlock> at = lanes_at(run, i);
    const BlockLanes<BendBlock> next = lanes_at(run, is_pair ? i + 1 : i);
    BendVectors rows, more;
    load_bend_vectors(at, position, rows);
    load_bend_vectors(next, position, more);
    compute_impulses(at, velocity, rows);
    compute_impulses(next, velocity, more);
    apply_impulses(rows, at, velocity);
    apply_impulses(more, next, velocity);
  }
}

template <class D>
HWY_INLINE void accelerate_records(D tag, const float* change, float* velocity) {
  alignas(16) static constexpr float kFlushed[4] = {1e-20f, 1e-20f, 1e-20f, 0.0f};
  const auto record = hn::LoadU(tag, velocity);
  const auto moves = hn::Gt(hn::Broadcast<3>(record), hn::Zero(tag));
  const auto v = hn::Add(record, hn::IfThenElseZero(moves, hn::LoadDup128(tag, change)));
  hn::StoreU(hn::IfThenZeroElse(hn::Lt(hn::Abs(v), hn::LoadDup128(tag, kFlushed)), v), tag, velocity);
}

void accelerate_here(Vec3 acceleration, float h, parallel::Range rows, state::Particles& particles) {
  const Vec3 step = h * acceleration;
  alignas(16) const float change[4] = {step.x, step.y, step.z, 0.0f};
  auto* velocity = reinterpret_cast<float*>(particles.velocity.data());
  int i = rows.begin;
  for (; i + kRecordCount <= rows.end; i += kRecordCount) accelerate_records(kTag, change, velocity + 4 * i);
  for (; i < rows.end; ++i) accelerate_records(Line(), change, velocity + 4 * i);
}

void move_here(float h, parallel::Range rows, state::Particles& particles) {
  alignas(16) const float step[4] = {h, h, h, 0.0f};
  auto* position = reinterpret_cast<float*>(particles.position.data());
  const auto* velocity = reinterpret_cast<const float*>(particles.velocity.data());
  const auto advance = [&](auto tag, int i) HWY_ATTR {
    const auto change = hn::Mul(hn::LoadDup128(tag, step), hn::LoadU(tag, velocity + 4 * i));
    hn::StoreU(hn::Add(hn::LoadU(tag, position + 4 * i), change), tag, position + 4 * i);
  };
  int i = rows.begin;
  for (; i + kRecordCount <= rows.end; i += kRecordCount) advance(kTag, i);
  for (; i < rows.end; ++i) advance(Line(), i);
}

#endif  // HWY_TARGET == HWY_SCALAR

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace hooke::solver::wide {

HWY_EXPORT(solve_springs_here);
HWY_EXPORT(solve_bends_here);
HWY_EXPORT(accelerate_here);
HWY_EXPORT(move_here);

void solve_springs(const SpringRun& run, const SpringMaterial& material,
                   const state::PositionRecord* position, state::VelocityRecord* velocity) {
  if (run.blocks.empty()) return;
  if (is_scalar()) return solve_springs_scalar(run, material, position, velocity);
  HWY_DYNAMIC_DISPATCH(solve_springs_here)(run, material, position, velocity);
}

void solve_bends(const BendRun& run, const state::PositionRecord* position, state::VelocityRecord* velocity) {
  if (run.blocks.empty()) return;
  if (is_scalar()) return solve_bends_scalar(run, position, velocity);
  HWY_DYNAMIC_DISPATCH(solve_bends_here)(run, position, velocity);
}

void accelerate(Vec3 acceleration, Real h, parallel::Range rows, state::Particles& particles) {
  if (is_scalar()) return accelerate_scalar(acceleration, h, rows, particles);
  HWY_DYNAMIC_DISPATCH(accelerate_here)(acceleration, h, rows, particles);
}

void move(Real h, parallel::Range rows, state::Particles& particles) {
  if (is_scalar()) return move_scalar(h, rows, particles);
  HWY_DYNAMIC_DISPATCH(move_here)(h, rows, particles);
}

}  // namespace hooke::solver::wide

#endif  // HWY_ONCE

#else  // HOOKE_DOUBLE_PRECISION: the scalar twins are the kernels

namespace hooke::solver::wide {

void solve_springs(const SpringRun& run, const SpringMaterial& material,
                   const state::PositionRecord* position, state::VelocityRecord* velocity) {
  solve_springs_scalar(run, material, position, velocity);
}

void solve_bends(const BendRun& run, const state::PositionRecord* position, state::VelocityRecord* velocity) {
  solve_bends_scalar(run, position, velocity);
}

void accelerate(Vec3 acceleration, Real h, parallel::Range rows, state::Particles& particles) {
  accelerate_scalar(acceleration, h, rows, particles);
}

void move(Real h, parallel::Range rows, state::Particles& particles) {
  move_scalar(h, rows, particles);
}

}  // namespace hooke::solver::wide

#endif  // HOOKE_DOUBLE_PRECISION
