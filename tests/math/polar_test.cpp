#include "math/polar.h"

#include "math/random.h"

#include <cmath>
#include <doctest/doctest.h>

namespace hooke::math {
namespace {

using DMat3 = Matrix3<double>;
using DQuat = Quaternion<double>;

DMat3 random_turn(std::mt19937_64& random) {
  const DVec3 v = test::random_vector(random);
  return matrix_of(normalize(DQuat{v.x, v.y, v.z, test::signed_unit(random)}));
}

DMat3 diagonal(double x, double y, double z) {
  return {{x, 0, 0}, {0, y, 0}, {0, 0, z}};
}

double distance(const DMat3& a, const DMat3& b) {
  return std::sqrt(length_squared(a.x - b.x) + length_squared(a.y - b.y) + length_squared(a.z - b.z));
}

/// tr(R^T A)
double fit(const DMat3& r, const DMat3& a) {
  return dot(r.x, a.x) + dot(r.y, a.y) + dot(r.z, a.z);
}

}  // namespace

TEST_SUITE("math/polar") {
  TEST_CASE("R S gives back R, also of thin bars and sheets, whatever its size") {
    std::mt19937_64 random(7);
    const DMat3 stretches[] = {diagonal(1, 1, 1),
                               diagonal(3, 2, 1),
                               diagonal(1, 1e-3, 1e-3),
                               diagonal(1, 1, 1e-4),
                               diagonal(1e-12, 2e-12, 1e-12),
                               diagonal(1e9, 1e9, 1)};
    for (int i = 0; i < 200; ++i) {
      const DMat3 r = random_turn(random);
      const DMat3 axes = random_turn(random);
      for (const DMat3& stretch : stretches) {
        const DMat3 s = axes * stretch * transpose(axes);
        CHECK(distance(matrix_of(closest_rotation(r * s)), r) < 1e-9);
      }
    }
  }

  TEST_CASE("of what is mirrored or flat it is the rotation that fits best") {
    std::mt19937_64 random(8);
    for (const DMat3& stretch : {diagonal(3, 2, -1), diagonal(-3, -2, -1), diagonal(2, 1, 0)}) {
      const DMat3 left = random_turn(random);
      const DMat3 a = left * stretch * transpose(random_turn(random));
      const double best = fit(matrix_of(closest_rotation(a)), a);
      // |s1| + |s2| + s3 of the singular values, the least with the sign of the determinant.
      const double known = std::abs(stretch.x.x) + std::abs(stretch.y.y) +
                           (determinant(stretch) < 0 ? -1 : 1) * std::abs(stretch.z.z);
      CHECK(best == doctest::Approx(known).epsilon(1e-9));
      for (int i = 0; i < 1000; ++i) CHECK(fit(random_turn(random), a) < best + 1e-12);
    }
  }

  TEST_CASE("nothing, and a line, still give a unit quaternion") {
    const double tiny = 1e-200;
    for (const DMat3& a : {diagonal(0, 0, 0), diagonal(1, 0, 0), diagonal(1, -1, 0),
                           diagonal(tiny, tiny, tiny), diagonal(1, -1, -1), diagonal(1, 1, -1)}) {
      const DQuat q = closest_rotation(a);
      CHECK(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w == doctest::Approx(1));
    }
  }
}

}  // namespace hooke::math
