#include "hooke/math.h"

#include "math/random.h"
#include "math/symmetric.h"

#include <cmath>
#include <cstdint>
#include <doctest/doctest.h>
#include <limits>
#include <random>

using hooke::DVec3;
using DMat3 = hooke::Matrix3<double>;
using DMat4 = hooke::Matrix4<double>;
using DQuat = hooke::Quaternion<double>;

using hooke::test::random_vector;
using hooke::test::signed_unit;

namespace {

constexpr double kTolerance = 1e-12;  // a few hundred roundings of numbers near one

DQuat random_rotation(std::mt19937_64& random) {
  const DVec3 v = random_vector(random);
  return hooke::normalize(DQuat{v.x, v.y, v.z, signed_unit(random)});
}
DMat3 random_matrix(std::mt19937_64& random) {
  const DVec3 x = random_vector(random);
  const DVec3 y = random_vector(random);
  return {x, y, random_vector(random)};
}

double difference(DVec3 a, DVec3 b) {
  return hooke::length(a - b);
}
double difference(const DMat3& a, const DMat3& b) {
  return difference(a.x, b.x) + difference(a.y, b.y) + difference(a.z, b.z);
}
double difference(const DMat4& a, const DMat4& b) {
  double sum = 0.0;
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) sum += std::fabs(a.m[c][r] - b.m[c][r]);
  }
  return sum;
}

const DMat4 kZero4 = {{{}, {}, {}, {}}};

}  // namespace

TEST_SUITE("math/vector") {
  TEST_CASE("the cross product follows the right hand and is normal to both") {
    CHECK(hooke::cross(DVec3{1, 0, 0}, DVec3{0, 1, 0}) == DVec3{0, 0, 1});
    CHECK(hooke::cross(DVec3{0, 1, 0}, DVec3{0, 0, 1}) == DVec3{1, 0, 0});
    const DVec3 a = {1, 2, 3};
    const DVec3 b = {-4, 5, 0.5};
    CHECK(hooke::dot(hooke::cross(a, b), a) == doctest::Approx(0.0));
    CHECK(hooke::dot(hooke::cross(a, b), b) == doctest::Approx(0.0));
  }

  TEST_CASE("a vector of no length has no direction") {
    CHECK(hooke::normalize(DVec3{}) == DVec3{});
    CHECK(hooke::normalize(DVec3{0, -3, 4}) == DVec3{0, -0.6, 0.8});
  }

  TEST_CASE("one bad component makes a vector not finite") {
    const double infinity = std::numeric_limits<double>::infinity();
    CHECK(hooke::is_finite(DVec3{1, 2, 3}));
    CHECK_FALSE(hooke::is_finite(DVec3{1, infinity, 3}));
    CHECK_FALSE(hooke::is_finite(DVec3{1, 2, std::nan("")}));
  }
}

TEST_SUITE("math/quaternion") {
  TEST_CASE("a quarter turn about y takes z to x") {
    const DQuat q = hooke::quaternion_about(DVec3{0, 7, 0}, std::acos(0.0));
    CHECK(difference(hooke::rotate(q, DVec3{0, 0, 1}), {1, 0, 0}) < kTolerance);
  }

  TEST_CASE("a product turns by the right factor first") {
    std::mt19937_64 random(1);
    for (int i = 0; i < 100; ++i) {
      const DQuat a = random_rotation(random);
      const DQuat b = random_rotation(random);
      const DVec3 v = random_vector(random);
      CHECK(difference(hooke::rotate(a * b, v), hooke::rotate(a, hooke::rotate(b, v))) < kTolerance);
    }
  }

  TEST_CASE("the conjugate turns back and lengths are kept") {
    std::mt19937_64 random(2);
    for (int i = 0; i < 100; ++i) {
      const DQuat q = random_rotation(random);
      const DVec3 v = random_vector(random);
      CHECK(difference(hooke::rotate(hooke::conjugate(q), hooke::rotate(q, v)), v) < kTolerance);
      CHECK(hooke::length(hooke::rotate(q, v)) == doctest::Approx(hooke::length(v)).epsilon(kTolerance));
    }
  }

  TEST_CASE("a rotation about nothing, and a quaternion of no length, are the identity") {
    CHECK(hooke::quaternion_about(DVec3{}, 1.0) == DQuat{});
    CHECK(hooke::normalize(DQuat{0, 0, 0, 0}) == DQuat{});
  }
}

TEST_SUITE("math/matrix3") {
  TEST_CASE("a product applies the right factor first") {
    std::mt19937_64 random(3);
    const DMat3 a = random_matrix(random);
    const DMat3 b = random_matrix(random);
    const DVec3 v = random_vector(random);
    CHECK(difference((a * b) * v, a * (b * v)) < kTolerance);
  }

  TEST_CASE("the determinant is the volume of the columns and multiplies") {
    CHECK(hooke::determinant(DMat3{{2, 0, 0}, {0, 3, 0}, {0, 0, 4}}) == 24.0);
    CHECK(hooke::determinant(DMat3{{0, 1, 0}, {1, 0, 0}, {0, 0, 1}}) == -1.0);
    std::mt19937_64 random(4);
    const DMat3 a = random_matrix(random);
    const DMat3 b = random_matrix(random);
    CHECK(hooke::determinant(a * b) ==
          doctest::Approx(hooke::determinant(a) * hooke::determinant(b)).epsilon(kTolerance));
    CHECK(hooke::determinant(hooke::transpose(a)) ==
          doctest::Approx(hooke::determinant(a)).epsilon(kTolerance));
  }

  TEST_CASE("the inverse undoes the matrix from both sides") {
    std::mt19937_64 random(5);
    for (int i = 0; i < 100; ++i) {
      const DMat3 a = random_matrix(random);
      const double tolerance = 1e-13 / std::fabs(hooke::determinant(a));
      CHECK(difference(a * hooke::inverse(a), DMat3{}) < tolerance);
      CHECK(difference(hooke::inverse(a) * a, DMat3{}) < tolerance);
    }
  }

  TEST_CASE("the inverse of a symmetric matrix of tiny or huge numbers is finite") {
    for (const float size : {1e-30F, 1e-14F, 1e14F, 1e30F}) {
      const hooke::math::Symmetric3<float> m = {2 * size, size, 0, 2 * size, 0, 4 * size};
      const auto back = hooke::math::inverse(m);
      CHECK(back.xx * size == doctest::Approx(2.0 / 3));
      CHECK(back.xy * size == doctest::Approx(-1.0 / 3));
      CHECK(back.zz * size == doctest::Approx(0.25));
    }
  }

  TEST_CASE("a singular matrix has the zero matrix for inverse") {
    const DMat3 zero = {{}, {}, {}};
    CHECK(hooke::inverse(DMat3{{1, 2, 3}, {2, 4, 6}, {0, 0, 1}}) == zero);
    CHECK(hooke::inverse(DMat3{{std::nan(""), 0, 0}, {0, 1, 0}, {0, 0, 1}}) == zero);
  }

  TEST_CASE("the outer product maps v to a times b dot v") {
    const DVec3 a = {1, 2, 3};
    const DVec3 b = {-1, 0.5, 4};
    const DVec3 v = {2, 7, -3};
    CHECK(difference(hooke::outer(a, b) * v, hooke::dot(b, v) * a) < kTolerance);
  }

  TEST_CASE("the matrix of a rotation turns as its quaternion does and its transpose is its inverse") {
    std::mt19937_64 random(6);
    const DQuat q = random_rotation(random);
    const DVec3 v = random_vector(random);
    const DMat3 m = hooke::matrix_of(q);
    CHECK(difference(m * v, hooke::rotate(q, v)) < kTolerance);
    CHECK(difference(hooke::transpose(m) * m, DMat3{}) < kTolerance);
    CHECK(hooke::determinant(m) == doctest::Approx(1.0).epsilon(kTolerance));
  }
}

TEST_SUITE("math/matrix4") {
  TEST_CASE("a transform scales, then turns, then moves") {
    const DQuat quarter_about_z = hooke::quaternion_about(DVec3{0, 0, 1}, std::acos(0.0));
    const DMat4 m = hooke::make_transform(DVec3{10, 20, 30}, quarter_about_z, DVec3{2, 3, 4});
    CHECK(difference(hooke::transform_point(m, {1, 0, 0}), {10, 22, 30}) < kTolerance);
    CHECK(difference(hooke::transform_point(m, {0, 1, 0}), {7, 20, 30}) < kTolerance);
    CHECK(difference(hooke::transform_point(m, {0, 0, 1}), {10, 20, 34}) < kTolerance);
    CHECK(hooke::translation_part(m) == DVec3{10, 20, 30});
    CHECK(hooke::determinant(m) == doctest::Approx(24.0).epsilon(kTolerance));
  }

  TEST_CASE("the inverse of T R S is the product of the inverses in opposite order") {
    std::mt19937_64 random(7);
    for (int i = 0; i < 100; ++i) {
      const DVec3 t = 10.0 * random_vector(random);
      const DQuat q = random_rotation(random);
      const DVec3 s = DVec3{1.5, 2.0, 3.0} + random_vector(random);
      const DMat4 back_scale = hooke::make_transform(DVec3{}, DQuat{}, DVec3{1 / s.x, 1 / s.y, 1 / s.z});
      const DMat4 back_turn = hooke::make_transform(DVec3{}, hooke::conjugate(q), DVec3{1, 1, 1});
      const DMat4 back_move = hooke::make_transform(-t, DQuat{}, DVec3{1, 1, 1});
      const DMat4 expected = back_scale * back_turn * back_move;
      CHECK(difference(hooke::inverse(hooke::make_transform(t, q, s)), expected) < 1e-11);
    }
  }

  TEST_CASE("the inverse of a matrix of any kind undoes it, zero pivots included") {
    std::mt19937_64 random(8);
    for (int i = 0; i < 100; ++i) {
      DMat4 a;
      for (auto& column : a.m) {
        for (double& element : column) element = signed_unit(random);
      }
      const double tolerance = 1e-12 / std::fabs(hooke::determinant(a));
      CHECK(difference(a * hooke::inverse(a), DMat4{}) < tolerance);
    }
    const DMat4 swap = {{{0, 1, 0, 0}, {1, 0, 0, 0}, {0, 0, 0, 1}, {0, 0, 1, 0}}};
    CHECK(hooke::inverse(swap) == swap);
    CHECK(hooke::determinant(swap) == 1.0);
  }

  TEST_CASE("determinants of 4x4 matrices multiply and do not see a transpose") {
    std::mt19937_64 random(9);
    DMat4 a;
    DMat4 b;
    for (int i = 0; i < 16; ++i) {
      a.m[i / 4][i % 4] = signed_unit(random);
      b.m[i / 4][i % 4] = signed_unit(random);
    }
    const double product = hooke::determinant(a) * hooke::determinant(b);
    CHECK(hooke::determinant(a * b) == doctest::Approx(product).epsilon(1e-11));
    CHECK(hooke::determinant(hooke::transpose(a)) ==
          doctest::Approx(hooke::determinant(a)).epsilon(kTolerance));
  }

  TEST_CASE("a singular 4x4 matrix has the zero matrix for inverse") {
    CHECK(hooke::inverse(hooke::make_transform(DVec3{1, 2, 3}, DQuat{}, DVec3{1, 0, 1})) == kZero4);
    CHECK(hooke::inverse(kZero4) == kZero4);
    CHECK(hooke::determinant(kZero4) == 0.0);
  }

  TEST_CASE("an affine matrix has the parts it was made of") {
    std::mt19937_64 random(10);
    const DMat3 linear = random_matrix(random);
    const DVec3 move = random_vector(random);
    const DMat4 m = hooke::affine(linear, move);
    const DVec3 v = random_vector(random);
    CHECK(hooke::linear_part(m) == linear);
    CHECK(hooke::translation_part(m) == move);
    CHECK(hooke::transform_point(m, v) == linear * v + move);
  }
}
