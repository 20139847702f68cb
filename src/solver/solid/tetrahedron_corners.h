/// What tetrahedra do to their corners, in Numbers of double. Included anew for each instruction set.

#if defined(HOOKE_SOLVER_SOLID_TETRAHEDRON_CORNERS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_SOLID_TETRAHEDRON_CORNERS_H
#undef HOOKE_SOLVER_SOLID_TETRAHEDRON_CORNERS_H
#else
#define HOOKE_SOLVER_SOLID_TETRAHEDRON_CORNERS_H
#endif

#include "solver/simd/double_records.h"
#include "solver/simd/numbers.h"
#include "solver/simd/symmetric_lanes.h"
#include "solver/solid/tetrahedron_kernels.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

/// Three columns.
template <class Number>
struct Matrix {
  Triple<Number> x, y, z;
};

template <class Number>
HWY_INLINE Matrix<Number> sum(const Matrix<Number>& a, const Matrix<Number>& b) {
  return {sum(a.x, b.x), sum(a.y, b.y), sum(a.z, b.z)};
}
template <class Number>
HWY_INLINE Matrix<Number> difference(const Matrix<Number>& a, const Matrix<Number>& b) {
  return {difference(a.x, b.x), difference(a.y, b.y), difference(a.z, b.z)};
}
template <class Number>
HWY_INLINE Matrix<Number> scaled(Number s, const Matrix<Number>& m) {
  return {scaled(s, m.x), scaled(s, m.y), scaled(s, m.z)};
}
template <class Condition, class Number>
HWY_INLINE Matrix<Number> choose(const Condition& condition, const Matrix<Number>& yes,
                                 const Matrix<Number>& no) {
  const auto column = [&](const Triple<Number>& a, const Triple<Number>& b) HWY_ATTR {
    return Triple<Number>{choose(condition, a.x, b.x), choose(condition, a.y, b.y),
                          choose(condition, a.z, b.z)};
  };
  return {column(yes.x, no.x), column(yes.y, no.y), column(yes.z, no.z)};
}
/// A : B
template <class Number>
HWY_INLINE Number contract(const Matrix<Number>& a, const Matrix<Number>& b) {
  return dot(a.x, b.x) + dot(a.y, b.y) + dot(a.z, b.z);
}
template <class Number>
HWY_INLINE Matrix<Number> cofactors(const Matrix<Number>& m) {
  return {cross(m.y, m.z), cross(m.z, m.x), cross(m.x, m.y)};
}
template <class Number>
HWY_INLINE Matrix<Number> transposed(const Matrix<Number>& m) {
  return {{m.x.x, m.y.x, m.z.x}, {m.x.y, m.y.y, m.z.y}, {m.x.z, m.y.z, m.z.z}};
}
/// a x + b y + c z
template <class Number>
HWY_INLINE Triple<Number> combined(const Matrix<Number>& m, Number a, Number b, Number c) {
  return sum(sum(scaled(a, m.x), scaled(b, m.y)), scaled(c, m.z));
}
template <class Number>
HWY_INLINE Triple<Number> times(const Matrix<Number>& m, const Triple<Number>& v) {
  return combined(m, v.x, v.y, v.z);
}
/// M S for a symmetric S.
template <class Number>
HWY_INLINE Matrix<Number> times(const Matrix<Number>& m, const Scale<Number>& s) {
  return {combined(m, s.xx, s.xy, s.xz), combined(m, s.xy, s.yy, s.yz), combined(m, s.xz, s.yz, s.zz)};
}
/// sum f_c x d_c over the columns: the torque of the impulse D about the present places.
template <class Number>
HWY_INLINE Triple<Number> torque_of(const Matrix<Number>& f, const Matrix<Number>& d) {
  return sum(sum(cross(f.x, d.x), cross(f.y, d.y)), cross(f.z, d.z));
}
/// a x m for each column m.
template <class Number>
HWY_INLINE Matrix<Number> turned(const Triple<Number>& a, const Matrix<Number>& m) {
  return {cross(a, m.x), cross(a, m.y), cross(a, m.z)};
}

/// The corners of the tetrahedra of a block from `lane` on, and their form.
template <class Number>
struct TetrahedronLanes {
  Triple<Number> b[4], v[4];
  Number w[4];
  Matrix<Number> f, rate;

  HWY_INLINE TetrahedronLanes(const TetrahedronBlock& block, int lane, const Real* position,
                              const Real* velocity) {
    Triple<Number> x[4];
    for (int i = 0; i < 4; ++i) {
      Quad<Number> at, moving;
      read_quad_widened(position, block.record[i] + lane, at);
      read_quad_widened(velocity, block.record[i] + lane, moving);
      x[i] = {at.x, at.y, at.z};
      v[i] = {moving.x, moving.y, moving.z};
      w[i] = moving.w;
    }
    for (int i = 0; i < 3; ++i) {
      read_widened(block.b[i][0] + lane, b[i + 1].x);
      read_widened(block.b[i][1] + lane, b[i + 1].y);
      read_widened(block.b[i][2] + lane, b[i + 1].z);
    }
    b[0] = scaled(Number(-1.0), sum(sum(b[1], b[2]), b[3]));
    f = gradient_of(x);
    rate = gradient_of(v);
  }

  /// B = sum w_i b_i b_i^T
  [[nodiscard]] HWY_INLINE Scale<Number> squares() const {
    Scale<Number> squares = diagonal(Number(0.0));
    for (int i = 0; i < 4; ++i) squares = sum(squares, square(w[i], b[i]));
    return squares;
  }

  /// Writes velocities where `moves` holds.
  template <class Condition>
  HWY_INLINE void write(const TetrahedronBlock& block, int lane, const Condition& moves,
                        const Triple<Number> (&changes)[4], Real* velocity) const {
    for (int i = 0; i < 4; ++i) {
      const Triple<Number> after = sum(v[i], changes[i]);
      write_quad_narrowed(Quad<Number>{choose(moves, after.x, v[i].x), choose(moves, after.y, v[i].y),
                                       choose(moves, after.z, v[i].z), w[i]},
                          velocity, block.record[i] + lane);
    }
  }

  /// s a a^T
  static HWY_INLINE Scale<Number> square(Number s, const Triple<Number>& a) {
    const Triple<Number> t = scaled(s, a);
    return {t.x * a.x, t.x * a.y, t.x * a.z, t.y * a.y, t.y * a.z, t.z * a.z};
  }

 private:
  /// sum x_i b_i^T. Differences are used, because a common part of the four would cost digits.
  HWY_INLINE Matrix<Number> gradient_of(const Triple<Number> (&x)[4]) const {
    const Matrix<Number> d = {difference(x[1], x[0]), difference(x[2], x[0]), difference(x[3], x[0])};
    return {combined(d, b[1].x, b[2].x, b[3].x), combined(d, b[1].y, b[2].y, b[3].y),
            combined(d, b[1].z, b[2].z, b[3].z)};
  }
};

/// How the corners of a row answer a stress impulse T: F' changes by K(T). All of them move alike in all
/// directions, so that K(T) = T B.
template <class Number>
class FreeCorners {
 public:
  HWY_INLINE explicit FreeCorners(const TetrahedronLanes<Number>& lanes)
      : lanes_(lanes), squares_(lanes.squares()) {}

  /// Prepares S = (theta K + gamma)^-1.
  HWY_INLINE void factorize(Number theta, Number gamma) {
    s_ = inverse(sum(scaled(theta, squares_), diagonal(gamma)));
    f_s_ = times(lanes_.f, s_);
  }
  [[nodiscard]] HWY_INLINE Matrix<Number> k(const Matrix<Number>& m) const { return times(m, squares_); }
  [[nodiscard]] HWY_INLINE Matrix<Number> s(const Matrix<Number>& m) const { return times(m, s_); }
  /// S(a x F)
  [[nodiscard]] HWY_INLINE Matrix<Number> s_of_turn(const Triple<Number>& a) const { return turned(a, f_s_); }
  /// The matrix that takes a to the torque of S(a x F): tr M - M for M = F S F^T.
  [[nodiscard]] HWY_INLINE Scale<Number> torque_matrix() const {
    const Matrix<Number> f = transposed(lanes_.f), f_s = transposed(f_s_);
    const Number xx = dot(f.x, f_s.x), yy = dot(f.y, f_s.y), zz = dot(f.z, f_s.z);
    const Number xy = dot(f.x, f_s.y), xz = dot(f.x, f_s.z), yz = dot(f.y, f_s.z);
    const Number zero(0.0);
    return {yy + zz, zero - xy, zero - xz, zz + xx, zero - yz, xx + yy};
  }
  /// What T does to the velocity of a corner.
  [[nodiscard]] HWY_INLINE Triple<Number> change(const Matrix<Number>& impulse, int corner) const {
    return scaled(lanes_.w[corner], times(impulse, lanes_.b[corner]));
  }

 private:
  const TetrahedronLanes<Number>& lanes_;
  Scale<Number> squares_;  ///< B
  Scale<Number> s_;
  Matrix<Number> f_s_;  ///< F S
};

/// The same where something presses on corners, which then move more easily in some directions than in
/// others: K(T) = sum W_i T b_i b_i^T, a matrix of nine rows.
template <class Number>
class PressedCorners {
 public:
  HWY_INLINE PressedCorners(const TetrahedronLanes<Number>& lanes,
                            const double (&answer)[4][6][kTetrahedronLanes], int lane)
      : lanes_(lanes) {
    for (int i = 0; i < 4; ++i) {
      w_[i] = {get<Number>(answer[i][0] + lane), get<Number>(answer[i][1] + lane),
               get<Number>(answer[i][2] + lane), get<Number>(answer[i][3] + lane),
               get<Number>(answer[i][4] + lane), get<Number>(answer[i][5] + lane)};
    }
  }

  HWY_INLINE void factorize(Number theta, Number gamma) {
    for (auto& row : factor_) {
      for (Number& entry : row) entry = Number(0.0);
    }
    for (int i = 0; i < 4; ++i) add_corner(lanes_.square(theta, lanes_.b[i]), w_[i]);
    for (int i = 0; i < 9; ++i) factor_[i][i] = factor_[i][i] + gamma;
    for (int i = 0; i < 9; ++i) {
      for (int j = 0; j <= i; ++j) {
        Number entry = factor_[i][j];
        for (int k = 0; k < j; ++k) entry = entry - factor_[i][k] * factor_[j][k];
        if (j < i) factor_[i][j] = entry * inverse_[j];
        if (j == i) inverse_[i] = quotient(Number(1.0), root(entry));
      }
    }
  }
  [[nodiscard]] HWY_INLINE Matrix<Number> k(const Matrix<Number>& m) const {
    const Number zero(0.0);
    const Triple<Number> none = {zero, zero, zero};
    Matrix<Number> sum = {none, none, none};
    for (int i = 0; i < 4; ++i) {
      const Triple<Number> moved = change(m, i);
      add(lanes_.b[i].x, moved, sum.x);
      add(lanes_.b[i].y, moved, sum.y);
      add(lanes_.b[i].z, moved, sum.z);
    }
    return sum;
  }
  [[nodiscard]] HWY_INLINE Matrix<Number> s(const Matrix<Number>& m) const {
    Nine x;
    halfway(m, x);
    for (int i = 8; i >= 0; --i) {
      for (int k = i + 1; k < 9; ++k) x.of[i] = x.of[i] - factor_[k][i] * x.of[k];
      x.of[i] = x.of[i] * inverse_[i];
    }
    return {{x.of[0], x.of[1], x.of[2]}, {x.of[3], x.of[4], x.of[5]}, {x.of[6], x.of[7], x.of[8]}};
  }
  [[nodiscard]] HWY_INLINE Matrix<Number> s_of_turn(const Triple<Number>& a) const {
    return s(turned(a, lanes_.f));
  }
  [[nodiscard]] HWY_INLINE Scale<Number> torque_matrix() const {
    const Number zero(0.0), one(1.0);
    Nine x, y, z;
    halfway(turned({one, zero, zero}, lanes_.f), x);
    halfway(turned({zero, one, zero}, lanes_.f), y);
    halfway(turned({zero, zero, one}, lanes_.f), z);
    return {product(x, x), product(x, y), product(x, z), product(y, y), product(y, z), product(z, z)};
  }
  [[nodiscard]] HWY_INLINE Triple<Number> change(const Matrix<Number>& impulse, int corner) const {
    return w_[corner].times(times(impulse, lanes_.b[corner]));
  }

 private:
  struct Nine {
    Number of[9];
  };

  static HWY_INLINE Number product(const Nine& a, const Nine& b) {
    Number sum = a.of[0] * b.of[0];
    for (int i = 1; i < 9; ++i) sum = sum + a.of[i] * b.of[i];
    return sum;
  }

  /// L^-1 m
  HWY_INLINE void halfway(const Matrix<Number>& m, Nine& x) const {
    x = {{m.x.x, m.x.y, m.x.z, m.y.x, m.y.y, m.y.z, m.z.x, m.z.y, m.z.z}};
    for (int i = 0; i < 9; ++i) {
      for (int k = 0; k < i; ++k) x.of[i] = x.of[i] - factor_[i][k] * x.of[k];
      x.of[i] = x.of[i] * inverse_[i];
    }
  }

  /// Adds b b^T times W, of which the upper triangles on the diagonal are not needed, but do no harm.
  HWY_INLINE void add_corner(const Scale<Number>& b, const Scale<Number>& w) {
    const Number of_b[3][3] = {{b.xx, b.xy, b.xz}, {b.xy, b.yy, b.yz}, {b.xz, b.yz, b.zz}};
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j <= i; ++j) {
        const Scale<Number> part = scaled(of_b[i][j], w);
        add_row(part.xx, part.xy, part.xz, factor_[3 * i] + 3 * j);
        add_row(part.xy, part.yy, part.yz, factor_[3 * i + 1] + 3 * j);
        add_row(part.xz, part.yz, part.zz, factor_[3 * i + 2] + 3 * j);
      }
    }
  }
  static HWY_INLINE void add_row(Number x, Number y, Number z, Number* to) {
    to[0] = to[0] + x;
    to[1] = to[1] + y;
    to[2] = to[2] + z;
  }

  const TetrahedronLanes<Number>& lanes_;
  Scale<Number> w_[4];
  Number factor_[9][9];  ///< The lower triangle of Cholesky's factor, but for its diagonal.
  Number inverse_[9];    ///< The inverse of its diagonal.
};

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
