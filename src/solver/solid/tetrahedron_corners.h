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

/// tr M - M for M = F F^T: it takes a turn a to the torque of [a] F.
template <class Number>
HWY_INLINE Scale<Number> torque_matrix(const Matrix<Number>& columns) {
  const Matrix<Number> f = transposed(columns);
  const Number xx = dot(f.x, f.x), yy = dot(f.y, f.y), zz = dot(f.z, f.z);
  const Number xy = dot(f.x, f.y), xz = dot(f.x, f.z), yz = dot(f.y, f.z);
  const Number zero(0.0);
  return {yy + zz, zero - xy, zero - xz, zz + xx, zero - yz, xx + yy};
}

/// The gradients of the shape functions of a block's tetrahedra from `lane` on.
template <class Number>
HWY_INLINE void read_gradients(const TetrahedronBlock& block, int lane, Triple<Number> (&b)[4]) {
  for (int i = 0; i < 3; ++i) {
    read_widened(block.b[i][0] + lane, b[i + 1].x);
    read_widened(block.b[i][1] + lane, b[i + 1].y);
    read_widened(block.b[i][2] + lane, b[i + 1].z);
  }
  b[0] = scaled(Number(-1.0), sum(sum(b[1], b[2]), b[3]));
}

/// sum x_i b_i^T. Differences are used, because a common part of the four would cost digits.
template <class Number>
HWY_INLINE Matrix<Number> gradient_of(const Triple<Number> (&x)[4], const Triple<Number> (&b)[4]) {
  const Matrix<Number> d = {difference(x[1], x[0]), difference(x[2], x[0]), difference(x[3], x[0])};
  return {combined(d, b[1].x, b[2].x, b[3].x), combined(d, b[1].y, b[2].y, b[3].y),
          combined(d, b[1].z, b[2].z, b[3].z)};
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
    read_gradients(block, lane, b);
    f = gradient_of(x, b);
    rate = gradient_of(v, b);
  }

  /// B = sum w_i b_i b_i^T: F' changes by T B for a stress impulse T.
  [[nodiscard]] HWY_INLINE Scale<Number> squares() const {
    Scale<Number> squares = diagonal(Number(0.0));
    for (int i = 0; i < 4; ++i) squares = sum(squares, square(w[i], b[i]));
    return squares;
  }

  /// Writes the velocities after the stress impulse T, where `moves` holds.
  template <class Condition>
  HWY_INLINE void push(const Matrix<Number>& impulse, const TetrahedronBlock& block, int lane,
                       const Condition& moves, Real* velocity) const {
    for (int i = 0; i < 4; ++i) {
      const Triple<Number> after = sum(v[i], scaled(w[i], times(impulse, b[i])));
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
};

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
