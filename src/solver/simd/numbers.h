/// Arithmetic that is written once for one lane (Number is Real or double) and for a vector of lanes.
/// Included anew for each instruction set: Highway compiles what stands between its two macros for one set
/// after another.
///
/// A Number has + - *, Number(Real), and these functions. They are given below for one lane, and in
/// solver/simd/vectors.h and solver/simd/double_vectors.h for vectors:
///   read, write      from and to consecutive lanes; read_anywhere from unaligned ones
///   moved_on         lanes one further, the first from the first of `carried`, which gets the last
///   first_lane       the first of them
///   above, choose    a comparison and a choice by it
///   any              whether a comparison holds in any lane
///   quotient, root   exact division and square root
///   read_quad, write_quad   four numbers of each lane from and to different places
///   read_offset      the difference of two such places
///   kLanesOf         how many lanes it stands for
///   kIsSingle        whether they are float

#if defined(HOOKE_SOLVER_SIMD_NUMBERS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_SIMD_NUMBERS_H
#undef HOOKE_SOLVER_SIMD_NUMBERS_H
#else
#define HOOKE_SOLVER_SIMD_NUMBERS_H
#endif

#include "hooke/math.h"

#include "math/symmetric.h"
#include "solver/simd/lanes.h"

#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

template <class Number>
struct Triple {
  Number x, y, z;
};

template <class Number>
struct Quad {
  Number x, y, z, w;
};

/// Velocity is the half of a motion record that rows write, Displacement the half that they only read.
template <class Number>
struct Velocity {
  Triple<Number> v, omega;
};
template <class Number>
struct Displacement {
  Triple<Number> dx, theta;
};

template <std::floating_point Lane>
HWY_INLINE void read(const Lane* from, Lane& to) {
  to = *from;
}
template <std::floating_point Lane>
HWY_INLINE void write(Lane value, Lane* to) {
  *to = value;
}
/// Does the same where lanes are not aligned.
HWY_INLINE void read_anywhere(const Real* from, Real& to) {
  to = *from;
}
HWY_INLINE Real moved_on(Real value, Real& carried) {
  const Real before = carried;
  carried = value;
  return before;
}
HWY_INLINE Real first_lane(Real value) {
  return value;
}
template <std::floating_point Lane>
HWY_INLINE bool above(Lane a, Lane b) {
  return a > b;
}
HWY_INLINE bool any(bool condition) {
  return condition;
}
template <std::floating_point Lane>
HWY_INLINE Lane choose(bool condition, Lane yes, Lane no) {
  return condition ? yes : no;
}
template <std::floating_point Lane>
HWY_INLINE Lane quotient(Lane a, Lane b) {
  return a / b;
}
template <std::floating_point Lane>
HWY_INLINE Lane root(Lane a) {
  return std::sqrt(a);
}
HWY_INLINE void read_quad(const Real* base, const std::uint32_t* record, Quad<Real>& q) {
  const Real* from = base + *record;
  q = {from[0], from[1], from[2], from[3]};
}
/// The first three numbers of one record less those of another.
HWY_INLINE void read_offset(const Real* base, const std::uint32_t* to, const std::uint32_t* from,
                            Triple<Real>& offset) {
  const Real* end = base + *to;
  const Real* start = base + *from;
  offset = {end[0] - start[0], end[1] - start[1], end[2] - start[2]};
}
HWY_INLINE void write_quad(const Quad<Real>& q, Real* base, const std::uint32_t* record) {
  Real* to = base + *record;
  to[0] = q.x;
  to[1] = q.y;
  to[2] = q.z;
  to[3] = q.w;
}

template <class Number>
constexpr int kLanesOf = 1;

/// Whether the lanes of a Number are float.
template <class Number>
constexpr bool kIsSingle = std::same_as<Number, float>;

template <class Number, class Lane>
HWY_INLINE Number get(const Lane* from) {
  Number value;
  read(from, value);
  return value;
}

/// Moves the lanes of a vector quantity, from lane `i` on.
template <class Number, class Lane, std::size_t kCount>
HWY_INLINE Triple<Number> get3(const Lane (&from)[3][kCount], int i) {
  return {get<Number>(from[0] + i), get<Number>(from[1] + i), get<Number>(from[2] + i)};
}
template <class Number, class Lane, std::size_t kCount>
HWY_INLINE void put3(const Triple<Number>& value, Lane (&to)[3][kCount], int i) {
  write(value.x, to[0] + i);
  write(value.y, to[1] + i);
  write(value.z, to[2] + i);
}

template <class Number>
HWY_INLINE Number larger(Number a, Number b) {
  return choose(above(a, b), a, b);
}
template <class Number>
HWY_INLINE Number smaller(Number a, Number b) {
  return choose(above(b, a), a, b);
}
template <class Number>
HWY_INLINE Number dot(const Triple<Number>& a, const Triple<Number>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Number>
HWY_INLINE Triple<Number> cross(const Triple<Number>& a, const Triple<Number>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Number>
HWY_INLINE Triple<Number> sum(const Triple<Number>& a, const Triple<Number>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Number>
HWY_INLINE Triple<Number> difference(const Triple<Number>& a, const Triple<Number>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Number>
HWY_INLINE Triple<Number> scaled(Number s, const Triple<Number>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
/// to += s a
template <class Number>
HWY_INLINE void add(Number s, const Triple<Number>& a, Triple<Number>& to) {
  to = {to.x + s * a.x, to.y + s * a.y, to.z + s * a.z};
}
/// to -= s a
template <class Number>
HWY_INLINE void take(Number s, const Triple<Number>& a, Triple<Number>& to) {
  to = {to.x - s * a.x, to.y - s * a.y, to.z - s * a.z};
}

/// Reads the motion records of bodies: the three quarters of each that rows need.
template <class Number>
HWY_INLINE void read_motion(const Real* base, const std::uint32_t* record, Velocity<Number>& motion,
                            Displacement<Number>& moved) {
  Quad<Number> first, second, third;
  read_quad(base, record, first);
  read_quad(base + 4, record, second);
  read_quad(base + 8, record, third);
  motion = {{first.x, first.y, first.z}, {first.w, second.x, second.y}};
  moved = {{second.z, second.w, third.x}, {third.y, third.z, third.w}};
}

template <class Number>
HWY_INLINE void write_motion(const Velocity<Number>& motion, const Displacement<Number>& moved, Real* base,
                             const std::uint32_t* record) {
  write_quad(Quad<Number>{motion.v.x, motion.v.y, motion.v.z, motion.omega.x}, base, record);
  write_quad(Quad<Number>{motion.omega.y, motion.omega.z, moved.dx.x, moved.dx.y}, base + 4, record);
}

/// Where free-motion records begin, by where motion records begin.
template <class Number>
struct FreeMotionRecords {
  std::uint32_t at[kLanesOf<Number>];

  HWY_INLINE explicit FreeMotionRecords(const std::uint32_t* record) {
    for (int i = 0; i < kLanesOf<Number>; ++i) at[i] = record[i] / 2;
  }
};

template <class Number>
HWY_INLINE void read_free(const Real* base, const std::uint32_t* record, Velocity<Number>& motion) {
  const FreeMotionRecords<Number> free(record);
  Quad<Number> first, second;
  read_quad(base, free.at, first);
  read_quad(base + 4, free.at, second);
  motion = {{first.x, first.y, first.z}, {first.w, second.x, second.y}};
}

template <class Number>
HWY_INLINE void write_free(const Velocity<Number>& motion, Real* base, const std::uint32_t* record) {
  const FreeMotionRecords<Number> free(record);
  const Number zero(Real(0));
  write_quad(Quad<Number>{motion.v.x, motion.v.y, motion.v.z, motion.omega.x}, base, free.at);
  write_quad(Quad<Number>{motion.omega.y, motion.omega.z, zero, zero}, base + 4, free.at);
}

/// Two bodies of the lanes from `lane` on, and how rows push them. Body b of an anchored block is only read.
template <class Number, bool kAnchored>
struct Bodies {
  Velocity<Number> a, b;

  /// Relative velocity along a row of Jacobians j_a, j_b whose linear part is given.
  HWY_INLINE Number rate(Number linear, const Triple<Number>& j_a, const Triple<Number>& j_b) const {
    return linear + (dot(j_b, b.omega) - dot(j_a, a.omega));
  }
  HWY_INLINE void turn(Number impulse, const Triple<Number>& j_a, const Triple<Number>& j_b) {
    take(impulse, j_a, a.omega);
    if constexpr (!kAnchored) add(impulse, j_b, b.omega);
  }
  HWY_INLINE void push(Number impulse, const Triple<Number>& direction, Number w_a, Number w_b) {
    take(w_a * impulse, direction, a.v);
    if constexpr (!kAnchored) add(w_b * impulse, direction, b.v);
  }
};

/// The contents of two bodies' motion records, and how they are written back.
template <class Number, bool kAnchored>
struct MovingBodies {
  Bodies<Number, kAnchored> velocity;
  Displacement<Number> moved_a, moved_b;

  template <class Block>
  HWY_INLINE MovingBodies(const Block& block, int lane, const Real* motion) {
    read_motion(motion, block.record_a + lane, velocity.a, moved_a);
    read_motion(motion, block.record_b + lane, velocity.b, moved_b);
  }
  template <class Block>
  HWY_INLINE void write_back(const Block& block, int lane, Real* motion) const {
    write_motion(velocity.a, moved_a, motion, block.record_a + lane);
    if constexpr (!kAnchored) write_motion(velocity.b, moved_b, motion, block.record_b + lane);
  }
};

/// A symmetric matrix.
template <class Number>
struct Scale {
  Number xx, xy, xz, yy, yz, zz;

  HWY_INLINE Triple<Number> times(const Triple<Number>& x) const {
    return {xx * x.x + xy * x.y + xz * x.z, xy * x.x + yy * x.y + yz * x.z, xz * x.x + yz * x.y + zz * x.z};
  }
};

template <class Number>
HWY_INLINE Scale<Number> read_scale(const math::Symmetric3<Real>* scale, const std::uint32_t* motion_record) {
  std::uint32_t at[kLanesOf<Number>];
  for (int i = 0; i < kLanesOf<Number>; ++i) at[i] = motion_record[i] / 16 * 6;
  const auto* base = reinterpret_cast<const Real*>(scale);
  Quad<Number> first, last;
  read_quad(base, at, first);
  read_quad(base + 2, at, last);
  return {first.x, first.y, first.z, first.w, last.z, last.w};
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
