#include "math/polar.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hooke::math {

namespace {

/// Newton's iteration from above converges quadratically; where the two largest roots nearly coincide, each
/// step only halves the distance.
constexpr int kIterations = 20;

/// Returns Horn's matrix for quaternions in the order (w, x, y, z).
Matrix4<double> horn_matrix(const Matrix3<double>& a) {
  const double xx = a.x.x, yy = a.y.y, zz = a.z.z;
  // The first letter names the component of q (a column of A), the second that of p.
  const double xy = a.x.y, xz = a.x.z, yx = a.y.x, yz = a.y.z, zx = a.z.x, zy = a.z.y;
  const double rows[4][4] = {{xx + yy + zz, yz - zy, zx - xz, xy - yx},
                             {yz - zy, xx - yy - zz, xy + yx, zx + xz},
                             {zx - xz, xy + yx, yy - xx - zz, yz + zy},
                             {xy - yx, zx + xz, yz + zy, zz - xx - yy}};
  Matrix4<double> n;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) n.m[i][j] = rows[i][j];
  }
  return n;
}

/// Returns the determinant of n without row i and column j, with the sign of the cofactor.
double cofactor(const Matrix4<double>& n, std::size_t i, std::size_t j) {
  const auto& m = n.m;
  std::array<std::size_t, 3> r = {}, c = {};
  for (std::size_t k = 0; k < 3; ++k) {
    r[k] = k < i ? k : k + 1;
    c[k] = k < j ? k : k + 1;
  }
  const double minor = m[r[0]][c[0]] * (m[r[1]][c[1]] * m[r[2]][c[2]] - m[r[1]][c[2]] * m[r[2]][c[1]]) -
                       m[r[0]][c[1]] * (m[r[1]][c[0]] * m[r[2]][c[2]] - m[r[1]][c[2]] * m[r[2]][c[0]]) +
                       m[r[0]][c[2]] * (m[r[1]][c[0]] * m[r[2]][c[1]] - m[r[1]][c[1]] * m[r[2]][c[0]]);
  return (i + j) % 2 == 0 ? minor : -minor;
}

/// Returns the largest root for |A| = 1; no root is above sqrt(3).
double largest_eigenvalue(double determinant_of_a, double determinant_of_n) {
  double l = 1.7320508075688773;
  for (int i = 0; i < kIterations; ++i) {
    const double value = ((l * l - 2) * l - 8 * determinant_of_a) * l + determinant_of_n;
    const double slope = (4 * l * l - 4) * l - 8 * determinant_of_a;
    l -= std::max(value, 0.0) / std::max(slope, 1e-9);
  }
  return l;
}

}  // namespace

Quaternion<double> closest_rotation(const Matrix3<double>& a) {
  constexpr double kNothing = 1e-24;
  const double size = std::sqrt(length_squared(a.x) + length_squared(a.y) + length_squared(a.z));
  if (!(size > 0)) return {0, 0, 0, 1};
  const Matrix3<double> unit = (1 / size) * a;
  Matrix4<double> n = horn_matrix(unit);
  const double eigenvalue = largest_eigenvalue(determinant(unit), determinant(n));
  for (std::size_t i = 0; i < 4; ++i) n.m[i][i] -= eigenvalue;
  // Columns of the adjugate are multiples of the eigenvector; the longest one has the least rounding error.
  std::size_t best = 0;
  double most = -1;
  for (std::size_t i = 0; i < 4; ++i) {
    const double diagonal = std::abs(cofactor(n, i, i));
    best = diagonal > most ? i : best;
    most = std::max(most, diagonal);
  }
  if (!(most > kNothing)) return {0, 0, 0, 1};
  return normalize(Quaternion<double>{cofactor(n, 1, best), cofactor(n, 2, best), cofactor(n, 3, best),
                                      cofactor(n, 0, best)});
}

}  // namespace hooke::math
