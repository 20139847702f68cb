/// Tetrahedra in Numbers of double. Included anew for each instruction set.

#if defined(HOOKE_SOLVER_SOLID_TETRAHEDRON_ROWS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_SOLID_TETRAHEDRON_ROWS_H
#undef HOOKE_SOLVER_SOLID_TETRAHEDRON_ROWS_H
#else
#define HOOKE_SOLVER_SOLID_TETRAHEDRON_ROWS_H
#endif

#include "solver/simd/double_records.h"
#include "solver/simd/numbers.h"
#include "solver/simd/symmetric_lanes.h"
#include "solver/solid/solid_tuning.h"
#include "solver/solid/tetrahedron_corners.h"
#include "solver/solid/tetrahedron_kernels.h"

#include <cstddef>
#include <hwy/highway.h>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

/// The rows of volume and shape at the present form.
template <class Number>
struct ElasticRows {
  Matrix<Number> g;
  Matrix<Number> shape_error;  ///< C_D / h
  Number volume_error;         ///< C_H / h
  Number gamma_volume, gamma_shape;

  HWY_INLINE ElasticRows(const TetrahedronBlock& block, int lane, double inverse_h, const Matrix<Number>& f,
                         Number square)
      : g(cofactors(f)) {
    const Number one(1.0), zero(0.0), rate(inverse_h);
    Number gamma;
    read_widened(block.gamma_volume + lane, gamma_volume);
    read_widened(block.gamma_shape + lane, gamma);
    const Number near = smaller(quotient(Number(3.0), square), one);
    const Number share = quotient(one, one + near);
    gamma_shape = Number(2.0) * share * gamma;
    shape_error = scaled(rate * share, difference(f, scaled(near, g)));
    const Number rest = one + (one - near) * Number(0.5) * quotient(gamma_volume, gamma);
    const Number least = smaller(Number(4.0) - Number(2.0 / 3.0) * square, zero);
    volume_error = rate * (larger(dot(f.x, g.x), least) - rest);
  }
};

/// What rows have done in a substep.
template <class Number>
struct ElasticImpulse {
  Number volume;
  Matrix<Number> shape;

  HWY_INLINE ElasticImpulse(const TetrahedronImpulses& from, int lane)
      : volume(get<Number>(from.volume + lane)),
        shape{get3<Number>(from.shape[0], lane), get3<Number>(from.shape[1], lane),
              get3<Number>(from.shape[2], lane)} {}

  HWY_INLINE void write_to(TetrahedronImpulses& to, int lane) const {
    write(volume, to.volume + lane);
    put3(shape.x, to.shape[0], lane);
    put3(shape.y, to.shape[1], lane);
    put3(shape.z, to.shape[2], lane);
  }
};

/// The stress impulse T of rows with theta = 0: there S = 1 / gamma_D, and D is the stress of the shape
/// alone, which has no torque.
template <class Number, class Corners>
HWY_INLINE Matrix<Number> soft_impulse(const ElasticRows<Number>& rows, const Matrix<Number>& rate,
                                       const Corners& corners) {
  const Matrix<Number> d = scaled(quotient(Number(-1.0), rows.gamma_shape), rows.shape_error);
  const Matrix<Number> g_k = corners.k(rows.g);
  const Number right = Number(0.0) - contract(d, g_k) - contract(rows.g, rate) - rows.volume_error;
  const Number l = quotient(right, rows.gamma_volume + contract(rows.g, g_k));
  return sum(scaled(l, rows.g), d);
}

/// The stress impulse T of rows for a rate F', beyond what they have done so far.
template <class Number, class Corners>
HWY_INLINE Matrix<Number> stiff_impulse(const ElasticRows<Number>& rows, Number theta,
                                        const TetrahedronLanes<Number>& lanes, Corners& corners,
                                        const ElasticImpulse<Number>& done, ElasticImpulse<Number>& more) {
  const Matrix<Number>& g = rows.g;
  const Matrix<Number>& rate = lanes.rate;
  corners.factorize(theta, rows.gamma_shape);
  const Scale<Number> torques = corners.torque_matrix();
  const Number least = Number(kLeastSpinShare) * (torques.xx + torques.yy + torques.zz);
  const Scale<Number> turns = inverse(sum(torques, diagonal(least)));
  // K and S commute, and S is symmetric.
  const Matrix<Number> g_s = corners.s(g);
  const Matrix<Number> g_k_s = corners.k(g_s);
  const Matrix<Number> lacks = sum(rows.shape_error, scaled(rows.gamma_shape, done.shape));  // besides F'
  const Matrix<Number> r_s = corners.s(sum(scaled(theta, rate), lacks));
  const Triple<Number> torque_g = torque_of(lanes.f, g_k_s);
  const Triple<Number> a_g = scaled(theta, turns.times(torque_g));
  const Triple<Number> a_r = turns.times(torque_of(lanes.f, r_s));
  const Number w = rows.gamma_volume + rows.gamma_shape * contract(g, g_k_s) + dot(a_g, torque_g);
  const Number right = contract(lacks, g_k_s) - rows.gamma_shape * contract(g_s, rate) - dot(a_r, torque_g) -
                       rows.volume_error - rows.gamma_volume * done.volume;
  const Number l = quotient(right, w);
  const Matrix<Number> turn = corners.s_of_turn(sum(a_r, scaled(l, a_g)));
  const Matrix<Number> shape = difference(turn, sum(r_s, scaled(theta * l, g_k_s)));
  more.volume = done.volume + l;
  more.shape = sum(done.shape, shape);
  return sum(scaled(l, g), shape);
}

/// Where rows are: those of a block from `lane` on, one for each lane of a Number.
struct TetrahedronPlace {
  const TetrahedronBlock& block;
  int lane;
  double inverse_h;           ///< [1/s]
  TetrahedronImpulses* done;  ///< Of the block.
  Real* velocity;             ///< Of the particle from which corners count.
};

/// Solves rows where `wanted` is 1.
template <class Number, class Corners>
HWY_INLINE void solve_tetrahedron_lanes(const TetrahedronPlace& at, Number wanted,
                                        const TetrahedronLanes<Number>& lanes, Corners& corners) {
  const Number zero(0.0);
  const Number square = contract(lanes.f, lanes.f);
  const Number w = lanes.w[0] + lanes.w[1] + lanes.w[2] + lanes.w[3];
  const auto moves = above(wanted * w * square, zero);
  Number theta;
  read_widened(at.block.implicit + at.lane, theta);
  const auto is_stiff = above(theta, zero);
  const ElasticRows<Number> rows(at.block, at.lane, at.inverse_h, lanes.f, square);
  Matrix<Number> impulse = {};
  if (any(above(choose(is_stiff, zero, wanted), zero))) impulse = soft_impulse(rows, lanes.rate, corners);
  if (any(above(choose(is_stiff, wanted, zero), zero))) {
    const ElasticImpulse<Number> before(*at.done, at.lane);
    ElasticImpulse<Number> after = before;
    const Matrix<Number> stiff = stiff_impulse(rows, theta, lanes, corners, before, after);
    impulse = choose(is_stiff, stiff, impulse);
    after.volume = choose(moves, after.volume, before.volume);
    after.shape = choose(moves, after.shape, before.shape);
    after.write_to(*at.done, at.lane);
  }
  const Triple<Number> changes[4] = {corners.change(impulse, 0), corners.change(impulse, 1),
                                     corners.change(impulse, 2), corners.change(impulse, 3)};
  lanes.write(at.block, at.lane, moves, changes, at.velocity);
}

/// 1 for lanes that are solved, 0 for others.
struct WantedLanes {
  double of[kTetrahedronLanes];
  bool any = false;

  HWY_INLINE WantedLanes(const TetrahedronBlock& block, unsigned skipped, bool stiff_alone) {
    for (int i = 0; i < kTetrahedronLanes; ++i) {
      const bool wanted = ((skipped >> i) & 1) == 0 && (!stiff_alone || block.implicit[i] > Real(0));
      of[i] = wanted ? 1.0 : 0.0;
      any = any || wanted;
    }
  }
};

/// All loads of a Number come before its stores, so that the copies which fill a block store what their
/// original does.
template <class Number>
HWY_INLINE void solve_free_tetrahedron_blocks(const TetrahedronRun& run,
                                              const state::PositionRecord* positions,
                                              state::VelocityRecord* velocities) {
  const auto* position = reinterpret_cast<const Real*>(positions);
  auto* velocity = reinterpret_cast<Real*>(velocities);
  for (std::size_t i = 0; i < run.blocks.size(); ++i) {
    const TetrahedronBlock& block = run.blocks[i];
    const WantedLanes wanted(block, run.skipped[i], run.again);
    if (!wanted.any) continue;
    const int count = i + 1 == run.blocks.size() ? run.last_count : kTetrahedronLanes;
    for (int lane = 0; lane < count; lane += kLanesOf<Number>) {
      const TetrahedronLanes<Number> lanes(block, lane, position, velocity);
      FreeCorners<Number> corners(lanes);
      solve_tetrahedron_lanes({block, lane, run.inverse_h, run.done + i, velocity},
                              get<Number>(wanted.of + lane), lanes, corners);
    }
  }
}

template <class Number>
HWY_INLINE void solve_pressed_tetrahedron_rows(double inverse_h, PressedTetrahedra& rows,
                                               const state::PositionRecord* positions,
                                               state::VelocityRecord* velocities) {
  const auto* position = reinterpret_cast<const Real*>(positions);
  auto* velocity = reinterpret_cast<Real*>(velocities);
  for (int lane = 0; lane < rows.count; lane += kLanesOf<Number>) {
    const TetrahedronLanes<Number> lanes(rows.rows, lane, position, velocity);
    PressedCorners<Number> corners(lanes, rows.answer, lane);
    solve_tetrahedron_lanes({rows.rows, lane, inverse_h, &rows.done, velocity}, Number(1.0), lanes, corners);
  }
}

/// Rows of the viscosity, solved one after the other.
template <class Number>
class Viscosity {
 public:
  HWY_INLINE Viscosity(const TetrahedronLanes<Number>& lanes, const Scale<Number>& b)
      : f_{lanes.f.x, lanes.f.y, lanes.f.z},
        rate_{lanes.rate.x, lanes.rate.y, lanes.rate.z},
        b_{{b.xx, b.xy, b.xz}, {b.xy, b.yy, b.yz}, {b.xz, b.yz, b.zz}} {
    const Number zero(0.0);
    for (Triple<Number>& column : sum_) column = {zero, zero, zero};
  }

  /// Solves the trace of E', whose gradient by F' is F.
  HWY_INLINE void damp_trace(Number gamma) {
    const Matrix<Number> f = {f_[0], f_[1], f_[2]};
    const Matrix<Number> response =
        times(f, Scale<Number>{b_[0][0], b_[0][1], b_[0][2], b_[1][1], b_[1][2], b_[2][2]});
    const Number along = dot(f_[0], rate_[0]) + dot(f_[1], rate_[1]) + dot(f_[2], rate_[2]);
    const Number impulse = quotient(Number(0.0) - along, contract(f, response) + gamma);
    for (int i = 0; i < 3; ++i) add(impulse, f_[i], sum_[i]);
    add(impulse, response.x, rate_[0]);
    add(impulse, response.y, rate_[1]);
    add(impulse, response.z, rate_[2]);
  }
  /// Solves E'_kk, whose gradient is f_k in column k.
  HWY_INLINE void damp_stretch(int k, Number gamma) {
    const Number w = b_[k][k] * dot(f_[k], f_[k]);
    const Number impulse = quotient(Number(0.0) - dot(f_[k], rate_[k]), w + gamma);
    add(impulse, f_[k], sum_[k]);
    for (int i = 0; i < 3; ++i) add(impulse * b_[k][i], f_[k], rate_[i]);
  }
  /// Solves 2 E'_kl, whose gradient is f_l in column k and f_k in column l.
  HWY_INLINE void damp_shear(int k, int l, Number gamma) {
    Triple<Number> response[3];
    for (int i = 0; i < 3; ++i) response[i] = sum(scaled(b_[k][i], f_[l]), scaled(b_[l][i], f_[k]));
    const Number w = dot(f_[l], response[k]) + dot(f_[k], response[l]);
    const Number along = dot(f_[l], rate_[k]) + dot(f_[k], rate_[l]);
    const Number impulse = quotient(Number(0.0) - along, w + gamma);
    add(impulse, f_[l], sum_[k]);
    add(impulse, f_[k], sum_[l]);
    for (int i = 0; i < 3; ++i) add(impulse, response[i], rate_[i]);
  }
  [[nodiscard]] HWY_INLINE Matrix<Number> impulse() const { return {sum_[0], sum_[1], sum_[2]}; }

 private:
  Triple<Number> f_[3], rate_[3], sum_[3];
  Number b_[3][3];
};

template <class Number>
HWY_INLINE void damp_tetrahedron_lanes(const TetrahedronBlock& block, int lane, const Real* position,
                                       Real* velocity) {
  const Number zero(0.0), one(1.0), infinity(std::numeric_limits<double>::infinity());
  Number gamma_trace, gamma_rate;
  read_widened(block.gamma_trace + lane, gamma_trace);
  read_widened(block.gamma_rate + lane, gamma_rate);
  const auto is_damped = above(infinity, gamma_rate);
  if (!any(is_damped)) return;
  const TetrahedronLanes<Number> lanes(block, lane, position, velocity);
  const Scale<Number> b = lanes.squares();
  const auto moves = above(choose(is_damped, b.xx + b.yy + b.zz, zero), zero);
  const Number stretch = larger(contract(lanes.f, lanes.f) * Number(1.0 / 3.0), one);
  const Number softening = stretch * stretch;
  Viscosity<Number> rows(lanes, b);
  rows.damp_trace(softening * gamma_trace);
  // E_kl and E_lk are two of the nine components, but one row, and its double is solved.
  const Number gamma_stretch = Number(0.5) * softening * gamma_rate;
  const Number gamma_shear = softening * gamma_rate;
  rows.damp_stretch(0, gamma_stretch);
  rows.damp_shear(0, 1, gamma_shear);
  rows.damp_shear(0, 2, gamma_shear);
  rows.damp_stretch(1, gamma_stretch);
  rows.damp_shear(1, 2, gamma_shear);
  rows.damp_stretch(2, gamma_stretch);
  Triple<Number> changes[4];
  for (int i = 0; i < 4; ++i) changes[i] = scaled(lanes.w[i], times(rows.impulse(), lanes.b[i]));
  lanes.write(block, lane, moves, changes, velocity);
}

template <class Number>
HWY_INLINE void damp_tetrahedron_blocks(const TetrahedronRun& run, const state::PositionRecord* positions,
                                        state::VelocityRecord* velocities) {
  const auto* position = reinterpret_cast<const Real*>(positions);
  auto* velocity = reinterpret_cast<Real*>(velocities);
  for (const TetrahedronBlock& block : run.blocks) {
    const int count = &block == &run.blocks.back() ? run.last_count : kTetrahedronLanes;
    for (int lane = 0; lane < count; lane += kLanesOf<Number>)
      damp_tetrahedron_lanes<Number>(block, lane, position, velocity);
  }
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
