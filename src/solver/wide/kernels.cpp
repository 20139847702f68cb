/// The kernels in one source for every instruction set, then their dispatch.
///
/// A particle is one 16-byte line {x, y, z, w}; see lines.h. Differences of two lines are taken before the
/// transposition, so that a row costs two transpositions in (d with w_a + w_b in its fourth lane, dv) and one
/// out (the impulse).

#include "solver/wide/wide.h"

#ifndef HOOKE_DOUBLE_PRECISION

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/wide/kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// After Highway, which includes this file anew for each instruction set.
#include "solver/wide/lines.h"

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR

void solve_springs_here(const SpringRun& run, const SpringMaterial& material,
                        const state::PositionLine* position, state::VelocityLine* velocity) {
  solve_springs_scalar(run, material, position, velocity);
}

void accelerate_here(Vec3 acceleration, float h, parallel::Range rows, state::Particles& particles) {
  accelerate_scalar(acceleration, h, rows, particles);
}

void move_here(float h, parallel::Range rows, state::Particles& particles) {
  move_scalar(h, rows, particles);
}

#else

/// kWidth rows between their loads and their stores.
struct Rows {
  Vector dx, dy, dz, s;
  Columns v_a, v_b;  ///< Velocities, and inverse masses in w.
};

HWY_INLINE void load_rows(const SpringBlock& block, int first, const float* position, const float* velocity,
                          Rows& rows) {
  const std::uint32_t* a = block.line_a + first;
  const std::uint32_t* b = block.line_b + first;
  const auto separation = [&](int j) HWY_ATTR {
    return hn::Sub(load_lines(kTag, position, a + j), load_lines(kTag, position, b + j));
  };
  rows.dx = separation(0);
  rows.dy = separation(1);
  rows.dz = separation(2);
  Vector radii = separation(3);
  transpose(rows.dx, rows.dy, rows.dz, radii);
  rows.v_a = load_columns(velocity, a);
  rows.v_b = load_columns(velocity, b);
}

template <bool kOneSided>
HWY_INLINE void compute_impulses(Rows& rows, Vector rest_length, Vector bias, Vector gamma) {
  const Vector l2 =
      hn::Add(hn::Add(hn::Mul(rows.dx, rows.dx), hn::Mul(rows.dy, rows.dy)), hn::Mul(rows.dz, rows.dz));
  const Vector l = hn::Sqrt(l2);
  const Vector rate = hn::Add(hn::Add(hn::Mul(rows.dx, hn::Sub(rows.v_a.x, rows.v_b.x)),
                                      hn::Mul(rows.dy, hn::Sub(rows.v_a.y, rows.v_b.y))),
                              hn::Mul(rows.dz, hn::Sub(rows.v_a.z, rows.v_b.z)));
  Vector numerator = hn::Add(rate, hn::Mul(bias, hn::Mul(l, hn::Sub(l, rest_length))));
  const Vector zero = hn::Zero(kTag);
  if constexpr (kOneSided) numerator = hn::IfThenElseZero(hn::Gt(numerator, zero), numerator);
  const Vector denominator = hn::Mul(l2, hn::Add(hn::Add(rows.v_a.w, rows.v_b.w), gamma));
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
      velocity, block.line_a + first);
  if constexpr (kAnchored) return;
  const Columns& b = rows.v_b;
  store_columns(
      {hn::Add(b.x, hn::Mul(b.w, x)), hn::Add(b.y, hn::Mul(b.w, y)), hn::Add(b.z, hn::Mul(b.w, z)), b.w},
      velocity, block.line_b + first);
}

/// A vector of rows: the lanes of a block from `first` on.
struct Place {
  const SpringBlock* block;
  int first;
};

/// Solves `kCount` vectors in three stages, not one after the other: the processor works on one while it
/// waits for the roots and quotients of the other. All loads come before the first store, so the copies of
/// the last row that fill a partial block store what that row stores.
template <int kCount, bool kOneSided, bool kAnchored>
HWY_INLINE void solve_vectors(const Place (&at)[kCount], Vector bias, Vector gamma, const float* position,
                              float* velocity) {
  Rows rows, more;
  load_rows(*at[0].block, at[0].first, position, velocity, rows);
  if constexpr (kCount > 1) load_rows(*at[1].block, at[1].first, position, velocity, more);
  compute_impulses<kOneSided>(rows, hn::LoadU(kTag, at[0].block->rest_length + at[0].first), bias, gamma);
  if constexpr (kCount > 1) {
    compute_impulses<kOneSided>(more, hn::LoadU(kTag, at[1].block->rest_length + at[1].first), bias, gamma);
  }
  apply_impulses<kAnchored>(rows, *at[0].block, at[0].first, velocity);
  if constexpr (kCount > 1) apply_impulses<kAnchored>(more, *at[1].block, at[1].first, velocity);
}

template <bool kOneSided, bool kAnchored>
void solve_run(const SpringRun& run, const SpringMaterial& material, const float* position, float* velocity) {
  const Vector bias = hn::Set(kTag, material.bias);
  const Vector gamma = hn::Set(kTag, material.gamma);
  const auto place = [&](int vector) {
    return Place{&run.blocks[vector * kWidth / kLanes], vector * kWidth % kLanes};
  };
  const int rows = kLanes * (static_cast<int>(run.blocks.size()) - 1) + run.last_count;
  const int vectors = (rows + kWidth - 1) / kWidth;
  int i = 0;
  for (; i + 1 < vectors; i += 2) {
    solve_vectors<2, kOneSided, kAnchored>({place(i), place(i + 1)}, bias, gamma, position, velocity);
  }
  if (i < vectors) solve_vectors<1, kOneSided, kAnchored>({place(i)}, bias, gamma, position, velocity);
}

void solve_springs_here(const SpringRun& run, const SpringMaterial& material,
                        const state::PositionLine* positions, state::VelocityLine* velocities) {
  const auto* position = reinterpret_cast<const float*>(positions);
  auto* velocity = reinterpret_cast<float*>(velocities);
  if (material.anchored) {
    solve_run<true, true>(run, material, position, velocity);
  } else if (material.one_sided) {
    solve_run<true, false>(run, material, position, velocity);
  } else {
    solve_run<false, false>(run, material, position, velocity);
  }
}

template <class D>
HWY_INLINE void accelerate_lines(D tag, const float* change, float* velocity) {
  alignas(16) static constexpr float kSettled[4] = {1e-20f, 1e-20f, 1e-20f, 0.0f};
  const auto line = hn::LoadU(tag, velocity);
  const auto moves = hn::Gt(hn::Broadcast<3>(line), hn::Zero(tag));
  const auto v = hn::Add(line, hn::IfThenElseZero(moves, hn::LoadDup128(tag, change)));
  hn::StoreU(hn::IfThenZeroElse(hn::Lt(hn::Abs(v), hn::LoadDup128(tag, kSettled)), v), tag, velocity);
}

void accelerate_here(Vec3 acceleration, float h, parallel::Range rows, state::Particles& particles) {
  const Vec3 step = h * acceleration;
  alignas(16) const float change[4] = {step.x, step.y, step.z, 0.0f};
  auto* velocity = reinterpret_cast<float*>(particles.velocity.data());
  int i = rows.begin;
  for (; i + kLineCount <= rows.end; i += kLineCount) accelerate_lines(kTag, change, velocity + 4 * i);
  for (; i < rows.end; ++i) accelerate_lines(Line(), change, velocity + 4 * i);
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
  for (; i + kLineCount <= rows.end; i += kLineCount) advance(kTag, i);
  for (; i < rows.end; ++i) advance(Line(), i);
}

#endif  // HWY_TARGET == HWY_SCALAR

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <cctype>

namespace hooke::solver::wide {

HWY_EXPORT(solve_springs_here);
HWY_EXPORT(accelerate_here);
HWY_EXPORT(move_here);

namespace {

bool scalar_only = false;

std::string name_of(std::int64_t target) {
  std::string name = hwy::TargetName(target);
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name == "avx3" ? "avx512" : name;
}

}  // namespace

void solve_springs(const SpringRun& run, const SpringMaterial& material, const state::PositionLine* position,
                   state::VelocityLine* velocity) {
  if (run.blocks.empty()) return;
  if (scalar_only) return solve_springs_scalar(run, material, position, velocity);
  HWY_DYNAMIC_DISPATCH(solve_springs_here)(run, material, position, velocity);
}

void accelerate(Vec3 acceleration, Real h, parallel::Range rows, state::Particles& particles) {
  if (scalar_only) return accelerate_scalar(acceleration, h, rows, particles);
  HWY_DYNAMIC_DISPATCH(accelerate_here)(acceleration, h, rows, particles);
}

void move(Real h, parallel::Range rows, state::Particles& particles) {
  if (scalar_only) return move_scalar(h, rows, particles);
  HWY_DYNAMIC_DISPATCH(move_here)(h, rows, particles);
}

std::vector<std::string> targets() {
  std::vector<std::string> names;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
    names.insert(names.begin(), name_of(target));
  names.insert(names.begin(), "scalar");
  return names;
}

bool is_scalar() {
  return scalar_only;
}

bool use_target(const std::string& name) {
  if (name == "scalar") {
    scalar_only = true;
    return true;
  }
  hwy::SetSupportedTargetsForTest(0);
  std::int64_t chosen = 0;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    if (name_of(target) == name) chosen = target;
  }
  if (chosen == 0 && !name.empty()) return false;
  scalar_only = false;
  hwy::SetSupportedTargetsForTest(chosen);
  hwy::GetChosenTarget().DeInit();
  return true;
}

}  // namespace hooke::solver::wide

#endif  // HWY_ONCE

#else  // HOOKE_DOUBLE_PRECISION: the scalar twins are the kernels

namespace hooke::solver::wide {

void solve_springs(const SpringRun& run, const SpringMaterial& material, const state::PositionLine* position,
                   state::VelocityLine* velocity) {
  solve_springs_scalar(run, material, position, velocity);
}

void accelerate(Vec3 acceleration, Real h, parallel::Range rows, state::Particles& particles) {
  accelerate_scalar(acceleration, h, rows, particles);
}

void move(Real h, parallel::Range rows, state::Particles& particles) {
  move_scalar(h, rows, particles);
}

std::vector<std::string> targets() {
  return {"scalar"};
}

bool is_scalar() {
  return true;
}

bool use_target(const std::string& name) {
  return name.empty() || name == "scalar";
}

}  // namespace hooke::solver::wide

#endif  // HOOKE_DOUBLE_PRECISION
