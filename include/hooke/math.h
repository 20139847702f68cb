#pragma once

#include <cmath>
#include <type_traits>

/// \file
/// Small value types: vectors, quaternions, 3x3 and 4x4 matrices. Every type is an aggregate: no
/// constructors, no hidden state, trivially copyable. Functions are pure and total: a degenerate argument has
/// a documented answer.
///
/// Matrices multiply column vectors: `(a * b) * v == a * (b * v)`. Angles are radians. Products of vectors
/// have names (`dot`, `cross`), never operators.

namespace hooke {

/// The engine's number. The library ships in float; the double twin used by the tests defines the macro.
#ifdef HOOKE_DOUBLE_PRECISION
using Real = double;
#else
using Real = float;
#endif

/// Three numbers. The meaning and unit belong to the variable, not to the type.
template <class T>
struct Vector3 {
  ///@{
  /// Component along the axis of the same name.
  T x = T(0);
  T y = T(0);
  T z = T(0);
  ///@}

  friend constexpr bool operator==(const Vector3&, const Vector3&) = default;
};

using Vec3 = Vector3<Real>;     ///< Velocities, forces, offsets from an object's origin.
using DVec3 = Vector3<double>;  ///< Positions in the world.

/// Sum, component by component.
template <class T>
constexpr Vector3<T> operator+(Vector3<T> a, Vector3<T> b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
/// Difference, component by component.
template <class T>
constexpr Vector3<T> operator-(Vector3<T> a, Vector3<T> b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
/// The vector turned around.
template <class T>
constexpr Vector3<T> operator-(Vector3<T> a) {
  return {-a.x, -a.y, -a.z};
}
/// `a` scaled by `s`. The number stands in front.
template <class T>
constexpr Vector3<T> operator*(std::type_identity_t<T> s, Vector3<T> a) {
  return {s * a.x, s * a.y, s * a.z};
}
/// Adds `b` to `a`, and returns `a`.
template <class T>
constexpr Vector3<T>& operator+=(Vector3<T>& a, Vector3<T> b) {
  return a = a + b;
}
/// Subtracts `b` from `a`, and returns `a`.
template <class T>
constexpr Vector3<T>& operator-=(Vector3<T>& a, Vector3<T> b) {
  return a = a - b;
}
/// Scalar product a . b.
template <class T>
constexpr T dot(Vector3<T> a, Vector3<T> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
/// Vector product a x b, right-handed: x cross y is z.
template <class T>
constexpr Vector3<T> cross(Vector3<T> a, Vector3<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// Component `axis` of a vector: 0 is x, 1 is y, and any other number z.
template <class T>
constexpr T component(Vector3<T> a, int axis) {
  return axis == 0 ? a.x : axis == 1 ? a.y : a.z;
}
/// Square of the length: a . a.
template <class T>
constexpr T length_squared(Vector3<T> a) {
  return dot(a, a);
}
/// Euclidean length. It overflows where length_squared does.
template <class T>
T length(Vector3<T> a) {
  using std::sqrt;  // T may bring its own
  return sqrt(dot(a, a));
}
/// Unit vector along `a`; the zero vector if `a` is zero.
template <class T>
Vector3<T> normalize(Vector3<T> a) {
  const T l = length(a);
  return l > T(0) ? Vector3<T>{a.x / l, a.y / l, a.z / l} : Vector3<T>{};
}
/// Whether no component is infinite or NaN.
template <class T>
bool is_finite(Vector3<T> a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}
/// The same vector in another precision.
template <class To, class From>
constexpr Vector3<To> vector_cast(Vector3<From> a) {
  return {static_cast<To>(a.x), static_cast<To>(a.y), static_cast<To>(a.z)};
}

/// A rotation when of unit length: w = cos(angle/2), (x, y, z) = sin(angle/2) axis.
template <class T>
struct Quaternion {
  ///@{
  /// Imaginary part: the axis, scaled by the sine of half the angle.
  T x = T(0);
  T y = T(0);
  T z = T(0);
  ///@}
  T w = T(1);  ///< Real part: the cosine of half the angle. The default is the identity.

  friend constexpr bool operator==(const Quaternion&, const Quaternion&) = default;
};

using Quat = Quaternion<Real>;  ///< Rotations of bodies and shapes.

/// The rotation that first turns by `b`, then by `a`.
template <class T>
constexpr Quaternion<T> operator*(Quaternion<T> a, Quaternion<T> b) {
  return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}
/// The inverse of a unit quaternion.
template <class T>
constexpr Quaternion<T> conjugate(Quaternion<T> q) {
  return {-q.x, -q.y, -q.z, q.w};
}
/// Unit quaternion along `q`; the identity if `q` is zero.
template <class T>
Quaternion<T> normalize(Quaternion<T> q) {
  const T l = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  return l > T(0) ? Quaternion<T>{q.x / l, q.y / l, q.z / l, q.w / l} : Quaternion<T>{};
}
/// `v` turned by the unit quaternion `q`.
template <class T>
constexpr Vector3<T> rotate(Quaternion<T> q, Vector3<T> v) {
  const Vector3<T> u = {q.x, q.y, q.z};
  const Vector3<T> t = T(2) * cross(u, v);
  return v + q.w * t + cross(u, t);
}
/// Rotation by `angle` [rad] about `axis` (any length; zero gives the identity). Uses the C library's sine:
/// for descriptions, not inside the step.
template <class T>
Quaternion<T> quaternion_about(Vector3<T> axis, std::type_identity_t<T> angle) {
  const Vector3<T> n = normalize(axis);
  if (n == Vector3<T>{}) return {};
  const T s = std::sin(T(0.5) * angle);
  return {s * n.x, s * n.y, s * n.z, std::cos(T(0.5) * angle)};
}

/// 3x3 matrix by columns: `m.y.x` is the element in the first row and the second column. The default is the
/// identity.
template <class T>
struct Matrix3 {
  Vector3<T> x = {T(1), T(0), T(0)};  ///< First column.
  Vector3<T> y = {T(0), T(1), T(0)};  ///< Second column.
  Vector3<T> z = {T(0), T(0), T(1)};  ///< Third column.

  friend constexpr bool operator==(const Matrix3&, const Matrix3&) = default;
};

using Mat3 = Matrix3<Real>;  ///< In the engine's precision.

/// Product of a matrix and a column vector.
template <class T>
constexpr Vector3<T> operator*(const Matrix3<T>& m, Vector3<T> v) {
  return v.x * m.x + v.y * m.y + v.z * m.z;
}
/// Product of two matrices: applies `b` first.
template <class T>
constexpr Matrix3<T> operator*(const Matrix3<T>& a, const Matrix3<T>& b) {
  return {a * b.x, a * b.y, a * b.z};
}
/// Sum, element by element.
template <class T>
constexpr Matrix3<T> operator+(const Matrix3<T>& a, const Matrix3<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
/// Difference, element by element.
template <class T>
constexpr Matrix3<T> operator-(const Matrix3<T>& a, const Matrix3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
/// Every element of `m` times `s`.
template <class T>
constexpr Matrix3<T> operator*(std::type_identity_t<T> s, const Matrix3<T>& m) {
  return {s * m.x, s * m.y, s * m.z};
}
/// The matrix with rows and columns exchanged.
template <class T>
constexpr Matrix3<T> transpose(const Matrix3<T>& m) {
  return {{m.x.x, m.y.x, m.z.x}, {m.x.y, m.y.y, m.z.y}, {m.x.z, m.y.z, m.z.z}};
}
/// Determinant: the triple product of the columns.
template <class T>
constexpr T determinant(const Matrix3<T>& m) {
  return dot(m.x, cross(m.y, m.z));
}
/// The inverse; the zero matrix if the determinant is zero or not a number.
template <class T>
constexpr Matrix3<T> inverse(const Matrix3<T>& m) {
  const T d = determinant(m);
  if (!(d < T(0)) && !(d > T(0))) return {{}, {}, {}};
  const T s = T(1) / d;
  return transpose(Matrix3<T>{s * cross(m.y, m.z), s * cross(m.z, m.x), s * cross(m.x, m.y)});
}
/// Outer product a b^T: element (row, column) is a[row] b[column].
template <class T>
constexpr Matrix3<T> outer(Vector3<T> a, Vector3<T> b) {
  return {b.x * a, b.y * a, b.z * a};
}
/// The matrix of the unit quaternion `q`.
template <class T>
constexpr Matrix3<T> matrix_of(Quaternion<T> q) {
  return {rotate(q, Vector3<T>{T(1), T(0), T(0)}), rotate(q, Vector3<T>{T(0), T(1), T(0)}),
          rotate(q, Vector3<T>{T(0), T(0), T(1)})};
}

/// Homogeneous 4x4 matrix by columns. The default is the identity.
template <class T>
struct Matrix4 {
  /// Elements, as `m[column][row]`: the memory order of OpenGL.
  T m[4][4] = {
      {T(1), T(0), T(0), T(0)}, {T(0), T(1), T(0), T(0)}, {T(0), T(0), T(1), T(0)}, {T(0), T(0), T(0), T(1)}};

  friend constexpr bool operator==(const Matrix4&, const Matrix4&) = default;
};

using Mat4 = Matrix4<Real>;  ///< In the engine's precision.

/// Product of two matrices: applies `b` first.
template <class T>
constexpr Matrix4<T> operator*(const Matrix4<T>& a, const Matrix4<T>& b) {
  Matrix4<T> r;
  for (int c = 0; c < 4; ++c) {
    for (int i = 0; i < 4; ++i) {
      r.m[c][i] =
          a.m[0][i] * b.m[c][0] + a.m[1][i] * b.m[c][1] + a.m[2][i] * b.m[c][2] + a.m[3][i] * b.m[c][3];
    }
  }
  return r;
}
/// The matrix with rows and columns exchanged.
template <class T>
constexpr Matrix4<T> transpose(const Matrix4<T>& a) {
  Matrix4<T> r;
  for (int c = 0; c < 4; ++c) {
    for (int i = 0; i < 4; ++i) r.m[c][i] = a.m[i][c];
  }
  return r;
}
/// The upper left 3x3 block: rotation and scale.
template <class T>
constexpr Matrix3<T> linear_part(const Matrix4<T>& a) {
  return {{a.m[0][0], a.m[0][1], a.m[0][2]},
          {a.m[1][0], a.m[1][1], a.m[1][2]},
          {a.m[2][0], a.m[2][1], a.m[2][2]}};
}
/// The upper three elements of the last column: the translation of an affine matrix.
template <class T>
constexpr Vector3<T> translation_part(const Matrix4<T>& a) {
  return {a.m[3][0], a.m[3][1], a.m[3][2]};
}
/// The affine matrix x -> linear x + translation.
template <class T>
constexpr Matrix4<T> affine(const Matrix3<T>& linear, Vector3<T> translation) {
  return {{{linear.x.x, linear.x.y, linear.x.z, T(0)},
           {linear.y.x, linear.y.y, linear.y.z, T(0)},
           {linear.z.x, linear.z.y, linear.z.z, T(0)},
           {translation.x, translation.y, translation.z, T(1)}}};
}
/// Scale, then rotate, then translate: M = T R S.
template <class T>
constexpr Matrix4<T> make_transform(Vector3<T> translation, Quaternion<T> rotation, Vector3<T> scale) {
  const Matrix3<T> r = matrix_of(rotation);
  return affine(Matrix3<T>{scale.x * r.x, scale.y * r.y, scale.z * r.z}, translation);
}
/// A point moved by an affine matrix (w = 1; the last row is not read).
template <class T>
constexpr Vector3<T> transform_point(const Matrix4<T>& a, Vector3<T> p) {
  return linear_part(a) * p + translation_part(a);
}
/// Determinant, by 2x2 minors of the upper and the lower two rows.
template <class T>
constexpr T determinant(const Matrix4<T>& a) {
  const T s0 = a.m[0][0] * a.m[1][1] - a.m[1][0] * a.m[0][1];
  const T s1 = a.m[0][0] * a.m[2][1] - a.m[2][0] * a.m[0][1];
  const T s2 = a.m[0][0] * a.m[3][1] - a.m[3][0] * a.m[0][1];
  const T s3 = a.m[1][0] * a.m[2][1] - a.m[2][0] * a.m[1][1];
  const T s4 = a.m[1][0] * a.m[3][1] - a.m[3][0] * a.m[1][1];
  const T s5 = a.m[2][0] * a.m[3][1] - a.m[3][0] * a.m[2][1];
  const T c5 = a.m[2][2] * a.m[3][3] - a.m[3][2] * a.m[2][3];
  const T c4 = a.m[1][2] * a.m[3][3] - a.m[3][2] * a.m[1][3];
  const T c3 = a.m[1][2] * a.m[2][3] - a.m[2][2] * a.m[1][3];
  const T c2 = a.m[0][2] * a.m[3][3] - a.m[3][2] * a.m[0][3];
  const T c1 = a.m[0][2] * a.m[2][3] - a.m[2][2] * a.m[0][3];
  const T c0 = a.m[0][2] * a.m[1][3] - a.m[1][2] * a.m[0][3];
  return s0 * c5 - s1 * c4 + s2 * c3 + s3 * c2 - s4 * c1 + s5 * c0;
}
/// The inverse of any 4x4 matrix, by elimination with row pivots; the zero matrix if it has none.
template <class T>
constexpr Matrix4<T> inverse(const Matrix4<T>& a) {
  Matrix4<T> left = a;
  Matrix4<T> right;
  const auto size = [](T v) { return v < T(0) ? -v : v; };
  for (int p = 0; p < 4; ++p) {
    int best = p;
    for (int i = p + 1; i < 4; ++i) best = size(left.m[p][i]) > size(left.m[p][best]) ? i : best;
    const T pivot = left.m[p][best];
    if (!(pivot < T(0)) && !(pivot > T(0))) return {{{}, {}, {}, {}}};
    for (int c = 0; c < 4; ++c) {
      const T l = left.m[c][best];
      const T r = right.m[c][best];
      left.m[c][best] = left.m[c][p];
      right.m[c][best] = right.m[c][p];
      left.m[c][p] = l / pivot;
      right.m[c][p] = r / pivot;
    }
    for (int i = 0; i < 4; ++i) {
      const T factor = i == p ? T(0) : left.m[p][i];
      for (int c = 0; c < 4; ++c) {
        left.m[c][i] -= factor * left.m[c][p];
        right.m[c][i] -= factor * right.m[c][p];
      }
    }
  }
  return right;
}

}  // namespace hooke
