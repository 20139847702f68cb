#include "hooke/geometry.h"

#include "math/random.h"

#include <cmath>
#include <doctest/doctest.h>

using hooke::compose;
using hooke::decompose;
using hooke::DVec3;
using hooke::Matrix3;
using hooke::Matrix4;
using hooke::Quaternion;
using hooke::quaternion_from;
using hooke::TransformParts;
using hooke::test::random_vector;

namespace {

Quaternion<double> random_rotation(std::mt19937_64& random) {
  const DVec3 v = random_vector(random);
  return normalize(Quaternion<double>{v.x, v.y, v.z, hooke::test::signed_unit(random)});
}

double difference(const Matrix4<double>& a, const Matrix4<double>& b) {
  double largest = 0;
  for (int i = 0; i < 16; ++i) largest = std::fmax(largest, std::fabs(a.m[i / 4][i % 4] - b.m[i / 4][i % 4]));
  return largest;
}

double difference(const Quaternion<double>& a, const Quaternion<double>& b) {
  const double same = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
  return 1 - std::fabs(same);
}

/// The parts make the matrix again, with a rotation of length one.
TransformParts parts_of(const Matrix4<double>& m) {
  const TransformParts parts = decompose(m);
  CHECK(difference(compose(parts), m) < 1e-14);
  const Quaternion<double> q = parts.rotation;
  CHECK(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w == doctest::Approx(1).epsilon(1e-14));
  return parts;
}

}  // namespace

TEST_SUITE("geometry/transform_parts") {
  TEST_CASE("a rotation comes back from its matrix, half turns too") {
    std::mt19937_64 random(1);
    for (int i = 0; i < 500; ++i) {
      Quaternion<double> q = random_rotation(random);
      if (i % 5 == 1) q = normalize(Quaternion<double>{q.x, q.y, q.z, 0});
      if (i % 5 == 2) q = normalize(Quaternion<double>{0, q.y, 0, q.w * 1e-9});
      REQUIRE(difference(quaternion_from(matrix_of(q)), q) < 1e-15);
      REQUIRE(quaternion_from(matrix_of(q)).w >= 0);
    }
    CHECK(quaternion_from({}) == Quaternion<double>{});
    for (const DVec3& half : {DVec3{1, 0, 0}, DVec3{0, 1, 0}, DVec3{0, 0, 1}}) {
      const Quaternion<double> q = {half.x, half.y, half.z, 0};
      CHECK(difference(quaternion_from(matrix_of(q)), q) < 1e-15);
    }
  }

  TEST_CASE("T R S is taken apart into what it was made of") {
    std::mt19937_64 random(2);
    for (int i = 0; i < 500; ++i) {
      const DVec3 move = random_vector(random);
      const Quaternion<double> q = random_rotation(random);
      const DVec3 scale = {0.1 + std::fabs(hooke::test::signed_unit(random)),
                           0.1 + std::fabs(hooke::test::signed_unit(random)),
                           0.1 + std::fabs(hooke::test::signed_unit(random))};
      const TransformParts parts = parts_of(make_transform(move, q, scale));
      REQUIRE(parts.translation == move);
      REQUIRE(difference(parts.rotation, q) < 1e-14);
      REQUIRE(length(parts.scale - scale) < 1e-14);
      REQUIRE(std::fabs(parts.shear_xy) + std::fabs(parts.shear_xz) + std::fabs(parts.shear_yz) < 1e-14);
    }
  }

  TEST_CASE("any affine matrix is made again by its parts") {
    std::mt19937_64 random(3);
    for (int i = 0; i < 500; ++i) {
      const DVec3 x = random_vector(random);
      const DVec3 y = random_vector(random);
      const DVec3 z = random_vector(random);
      const TransformParts parts = parts_of(affine(Matrix3<double>{x, y, z}, random_vector(random)));
      REQUIRE(parts.scale.x > 0);
      REQUIRE(parts.scale.y > 0);
      REQUIRE((parts.scale.z < 0) == (determinant(Matrix3<double>{x, y, z}) < 0));
    }
  }

  TEST_CASE("a reflection has its negative scale in z, whatever axis it was made with") {
    for (const DVec3& mirror : {DVec3{-1, 1, 1}, DVec3{1, -1, 1}, DVec3{1, 1, -1}, DVec3{-1, -1, -1}}) {
      const TransformParts parts = parts_of(make_transform(DVec3{}, Quaternion<double>{}, mirror));
      CHECK(parts.scale == DVec3{1, 1, -1});
    }
    // Two are a half turn.
    CHECK(parts_of(make_transform(DVec3{}, Quaternion<double>{}, DVec3{-1, -1, 1})).scale == DVec3{1, 1, 1});
  }

  TEST_CASE("scales of zero leave the directions that are there") {
    std::mt19937_64 random(4);
    const Quaternion<double> q = random_rotation(random);
    for (int zeros = 0; zeros < 8; ++zeros) {
      const DVec3 scale = {(zeros & 1) != 0 ? 0.0 : 2.0, (zeros & 2) != 0 ? 0.0 : 3.0,
                           (zeros & 4) != 0 ? 0.0 : 4.0};
      const TransformParts parts = parts_of(make_transform(DVec3{}, q, scale));
      CHECK(std::fabs(std::fabs(parts.scale.z) - scale.z) < 1e-14);
      CHECK(std::fabs(parts.scale.x - scale.x) < 1e-14);
      CHECK(std::fabs(parts.scale.y - scale.y) < 1e-14);
    }
    // With two columns left they are told from their mirror.
    for (const DVec3& scale : {DVec3{0, 3, 4}, DVec3{2, 0, 4}}) {
      CHECK(parts_of(make_transform(DVec3{}, q, scale)).scale.z == doctest::Approx(4));
    }
    const Matrix4<double> zero = {{{}, {}, {}, {}}};
    CHECK(decompose(zero).rotation == Quaternion<double>{});
    CHECK(decompose(zero).scale == DVec3{});
  }

  TEST_CASE("shear is told from scale; columns along one line are shear alone") {
    const Matrix3<double> sheared = {{2, 0, 0}, {1, 3, 0}, {0, 0, 1}};
    const TransformParts parts = parts_of(affine(sheared, DVec3{}));
    CHECK(parts.rotation == Quaternion<double>{});
    CHECK(parts.scale == DVec3{2, 3, 1});
    CHECK(parts.shear_xy == 1);
    const TransformParts line = parts_of(affine(Matrix3<double>{{1, 1, 0}, {2, 2, 0}, {-1, -1, 0}}, DVec3{}));
    CHECK(line.scale.x == doctest::Approx(std::sqrt(2.0)));
    CHECK(std::fabs(line.scale.y) < 1e-15);
    CHECK(line.shear_xy == doctest::Approx(std::sqrt(8.0)));
    CHECK(line.shear_xz == doctest::Approx(-std::sqrt(2.0)));
  }
}
