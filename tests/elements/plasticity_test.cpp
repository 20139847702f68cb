#include "elements/plasticity.h"

#include "elements/tetrahedron.h"
#include "math/random.h"

#include <cmath>
#include <doctest/doctest.h>
#include <random>

namespace hooke::elements {

namespace {

using DMat3 = Matrix3<double>;
using Square = math::Symmetric3<double>;

Square square_of(const DMat3& f) {
  return {dot(f.x, f.x), dot(f.x, f.y), dot(f.x, f.z), dot(f.y, f.y), dot(f.y, f.z), dot(f.z, f.z)};
}

double trace(const Square& c) {
  return c.xx + c.yy + c.zz;
}

double size_of(const DMat3& m) {
  return std::sqrt(contract(m, m));
}

/// 1 plus a random matrix of that size, of determinant above 0.1.
DMat3 random_gradient(std::mt19937_64& random, double size) {
  for (;;) {
    const DMat3 f = DMat3{} + size * DMat3{test::random_vector(random), test::random_vector(random),
                                           test::random_vector(random)};
    if (determinant(f) > 0.1) return f;
  }
}

}  // namespace

TEST_SUITE("elements/plasticity") {
  TEST_CASE(
      "a bar pulled by its end yields at the strain sigma_y / E, one that is sheared at sigma_y / sqrt 3") {
    const double stiffness = 1e5, yield_stress = 50;
    for (const double nu : {0.0, 0.3, 0.45}) {
      const double mu = neo_hookean(stiffness, nu).shear;
      const double limit = yield_limit(yield_stress, mu);
      const double e = yield_stress / stiffness;
      const double across = 1 - nu * e;
      const DMat3 pulled = {{1 + e, 0, 0}, {0, across, 0}, {0, 0, across}};
      CHECK(std::abs(deviator_squared(square_of(pulled)) / limit - 1) < 2e-3);
      const DMat3 sheared = {{1, 0, 0}, {yield_stress / std::sqrt(3.0) / mu, 1, 0}, {0, 0, 1}};
      CHECK(std::abs(deviator_squared(square_of(sheared)) / limit - 1) < 2e-3);
    }
  }

  TEST_CASE("what is returned has its share of the shear stress, its volume, and less energy") {
    std::mt19937_64 random(7);
    const NeoHookean<double> material = neo_hookean(1e5, 0.3);
    for (int i = 0; i < 300; ++i) {
      const DMat3 f = random_gradient(random, i < 100 ? 1e-3 : i < 200 ? 0.3 : 2.0);
      const double share = (i % 10) / 10.0;
      const Square c = square_of(f);
      const Square after = returned(c, share);
      CHECK(determinant(after) == doctest::Approx(determinant(c)).epsilon(1e-10));
      CHECK(std::abs(deviator_squared(after) - share * share * deviator_squared(c)) <
            1e-10 * deviator_squared(c));
      CHECK(trace(after) < trace(c));

      // Shape functions after the flow give the same F^T F, so the gradient F X^T.
      const DMat3 x = flow_between(c, after);
      CHECK(determinant(x) == doctest::Approx(1).epsilon(1e-10));
      const DMat3 flowed = f * transpose(x);
      CHECK(trace(square_of(flowed)) == doctest::Approx(trace(after)).epsilon(1e-9));
      CHECK(energy_density(flowed, material) < energy_density(f, material));

      const auto shear = [&](const DMat3& g) {  // of Kirchhoff's stress, P F^T
        const DMat3 tau = stress(g, material) * transpose(g);
        const double mean = (tau.x.x + tau.y.y + tau.z.z) / 3;
        return size_of(tau - mean * DMat3{});
      };
      CHECK(std::abs(shear(flowed) - share * shear(f)) < 1e-8 * shear(f));
    }
  }

  TEST_CASE("a stretch of 50 and a body without shear return to finite numbers") {
    const DMat3 thread = {{50, 0, 0}, {0, 0.1, 0}, {0, 0, 0.1}};
    const DMat3 sheet = {{0.01, 0, 0}, {0, 10, 0}, {0, 0, 10}};
    for (const DMat3& f : {thread, sheet, 0.5 * DMat3{}}) {
      for (const double share : {0.0, 1e-6, 0.5}) {
        const Square c = square_of(f);
        const Square after = returned(c, share);
        CHECK(std::abs(determinant(after) / determinant(c) - 1) < 1e-4);  // what the stretch leaves of digits
        CHECK(determinant(flow_between(c, after)) == doctest::Approx(1).epsilon(1e-12));
      }
    }
  }
}

}  // namespace hooke::elements
