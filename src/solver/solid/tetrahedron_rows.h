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

/// The stress impulse T of rows with theta = 0: there S = 1 / gamma_D, and D is the stress of the shape
/// alone, which has no torque.
template <class Number>
HWY_INLINE Matrix<Number> soft_impulse(const ElasticRows<Number>& rows, const Matrix<Number>& rate,
                                       const Scale<Number>& squares) {
  const Matrix<Number> d = scaled(quotient(Number(-1.0), rows.gamma_shape), rows.shape_error);
  const Matrix<Number> g_k = times(rows.g, squares);
  const Number right = Number(0.0) - contract(d, g_k) - contract(rows.g, rate) - rows.volume_error;
  const Number l = quotient(right, rows.gamma_volume + contract(rows.g, g_k));
  return sum(scaled(l, rows.g), d);
}

/// Solves the rows of a group where none is stiff, one after the other. All loads of a Number come before its
/// stores, so that the copies which fill a block store what their original does.
template <class Number>
HWY_INLINE void solve_tetrahedron_blocks(const TetrahedronRun& run, const state::PositionRecord* positions,
                                         state::VelocityRecord* velocities) {
  const auto* position = reinterpret_cast<const Real*>(positions);
  auto* velocity = reinterpret_cast<Real*>(velocities);
  for (const TetrahedronBlock& block : run.blocks) {
    const int count = &block == &run.blocks.back() ? run.last_count : kTetrahedronLanes;
    for (int lane = 0; lane < count; lane += kLanesOf<Number>) {
      const TetrahedronLanes<Number> lanes(block, lane, position, velocity);
      const Number square = contract(lanes.f, lanes.f);
      const ElasticRows<Number> rows(block, lane, run.inverse_h, lanes.f, square);
      const auto moves = above((lanes.w[0] + lanes.w[1] + lanes.w[2] + lanes.w[3]) * square, Number(0.0));
      lanes.push(soft_impulse(rows, lanes.rate, lanes.squares()), block, lane, moves, velocity);
    }
  }
}

/// The linear law of StressBlock.
template <class Number>
struct LinearStress {
  Matrix<Number> f, g;
  Scale<Number> turns;
  Number volume, shape;

  /// The rate without the turn that minimizes it.
  [[nodiscard]] HWY_INLINE Matrix<Number> without_turn(const Matrix<Number>& rate) const {
    return difference(rate, turned(turns.times(torque_of(f, rate)), f));
  }
  /// The impulse that resists a rate.
  [[nodiscard]] HWY_INLINE Matrix<Number> resist(const Matrix<Number>& rate) const {
    return sum(scaled(volume * contract(g, rate), g), scaled(shape, without_turn(rate)));
  }
  HWY_INLINE void write_to(StressBlock& to, int lane) const {
    put_matrix(f, to.f, lane);
    put_matrix(g, to.g, lane);
    const Number entries[6] = {turns.xx, turns.xy, turns.xz, turns.yy, turns.yz, turns.zz};
    for (int i = 0; i < 6; ++i) write(entries[i], to.turns[i] + lane);
    write(volume, to.volume + lane);
    write(shape, to.shape + lane);
  }
  static HWY_INLINE LinearStress read_from(const StressBlock& from, int lane) {
    const auto at = [&](int i) HWY_ATTR { return get<Number>(from.turns[i] + lane); };
    return {get_matrix(from.f, lane),
            get_matrix(from.g, lane),
            {at(0), at(1), at(2), at(3), at(4), at(5)},
            get<Number>(from.volume + lane),
            get<Number>(from.shape + lane)};
  }

 private:
  static HWY_INLINE void put_matrix(const Matrix<Number>& m, double (&to)[3][3][kTetrahedronLanes],
                                    int lane) {
    put3(m.x, to[0], lane);
    put3(m.y, to[1], lane);
    put3(m.z, to[2], lane);
  }
  static HWY_INLINE Matrix<Number> get_matrix(const double (&from)[3][3][kTetrahedronLanes], int lane) {
    return {get3<Number>(from[0], lane), get3<Number>(from[1], lane), get3<Number>(from[2], lane)};
  }
};

/// Adds a corner's own part of the stress's answer, without the turn, to its two records of `diagonal`.
template <class Number>
HWY_INLINE void add_diagonal(const LinearStress<Number>& stress, const Triple<Number>& b,
                             const std::uint32_t* record, double* diagonal) {
  const Triple<Number> u = times(stress.g, b);
  const Number size = stress.shape * dot(b, b);
  const Number xy = stress.volume * (u.x * u.y), xz = stress.volume * (u.x * u.z);
  const Number xx = stress.volume * (u.x * u.x) + size, yy = stress.volume * (u.y * u.y) + size;
  const Number zz = stress.volume * (u.z * u.z) + size, yz = stress.volume * (u.y * u.z);
  std::uint32_t first[kTetrahedronLanes], second[kTetrahedronLanes];
  for (int i = 0; i < kLanesOf<Number>; ++i) {
    first[i] = 2 * record[i];
    second[i] = 2 * record[i] + 4;
  }
  add_triple({xx, xy, xz}, diagonal, first);
  add_triple({yy, yz, zz}, diagonal, second);
}

/// Linearizes rows about the present velocities, and adds up the impulses that they give now.
template <class Number>
HWY_INLINE void linearize_tetrahedron_blocks(const TetrahedronRun& run,
                                             const state::PositionRecord* positions,
                                             const state::VelocityRecord* velocities) {
  const Number zero(0.0), minus(-1.0);
  const auto* position = reinterpret_cast<const Real*>(positions);
  const auto* velocity = reinterpret_cast<const Real*>(velocities);
  for (std::size_t i = 0; i < run.blocks.size(); ++i) {
    const TetrahedronBlock& block = run.blocks[i];
    const int count = i + 1 == run.blocks.size() ? run.last_count : kTetrahedronLanes;
    for (int lane = 0; lane < count; lane += kLanesOf<Number>) {
      const TetrahedronLanes<Number> lanes(block, lane, position, velocity);
      const Number square = contract(lanes.f, lanes.f);
      const ElasticRows<Number> rows(block, lane, run.inverse_h, lanes.f, square);
      Number theta;
      read_widened(block.implicit + lane, theta);
      const Scale<Number> torques = torque_matrix(lanes.f);
      const Number least = Number(kLeastSpinShare) * (torques.xx + torques.yy + torques.zz);
      const Number one(1.0);
      const auto moves = above((lanes.w[0] + lanes.w[1] + lanes.w[2] + lanes.w[3]) * square, zero);
      const Number per_shape = choose(moves, quotient(one, rows.gamma_shape), zero);
      const Number per_volume = choose(moves, quotient(one, rows.gamma_volume), zero);
      const Scale<Number> turns = inverse(sum(torques, diagonal(least)));
      const LinearStress<Number> stress = {
          lanes.f,
          rows.g,
          {choose(moves, turns.xx, zero), choose(moves, turns.xy, zero), choose(moves, turns.xz, zero),
           choose(moves, turns.yy, zero), choose(moves, turns.yz, zero), choose(moves, turns.zz, zero)},
          per_volume,
          per_shape * theta};
      stress.write_to(run.stress[i], lane);
      const Matrix<Number> shape = sum(rows.shape_error, scaled(theta, stress.without_turn(lanes.rate)));
      const Matrix<Number> impulse =
          sum(scaled(per_volume * (rows.volume_error + contract(rows.g, lanes.rate)), rows.g),
              scaled(per_shape, shape));
      for (int k = 0; k < 4; ++k) {
        add_triple(scaled(minus, times(impulse, lanes.b[k])), run.force, block.record[k] + lane);
        add_diagonal(stress, lanes.b[k], block.record[k] + lane, run.diagonal);
      }
    }
  }
}

/// Adds the impulses with which rows resist a motion of the corners.
template <class Number>
HWY_INLINE void resist_tetrahedron_blocks(const TetrahedronRun& run) {
  for (std::size_t i = 0; i < run.blocks.size(); ++i) {
    const TetrahedronBlock& block = run.blocks[i];
    const int count = i + 1 == run.blocks.size() ? run.last_count : kTetrahedronLanes;
    for (int lane = 0; lane < count; lane += kLanesOf<Number>) {
      Triple<Number> b[4], v[4];
      read_gradients(block, lane, b);
      for (int k = 0; k < 4; ++k) read_triple(run.direction, block.record[k] + lane, v[k]);
      const Matrix<Number> impulse =
          LinearStress<Number>::read_from(run.stress[i], lane).resist(gradient_of(v, b));
      for (int k = 0; k < 4; ++k) add_triple(times(impulse, b[k]), run.image, block.record[k] + lane);
    }
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
  lanes.push(rows.impulse(), block, lane, moves, velocity);
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
