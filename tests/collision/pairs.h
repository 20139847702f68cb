#pragma once

#include "collision/distance/distance.h"
#include "collision/manifold/manifold_points.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace hooke::test {

/// Uniform in [low, high].
inline Real uniform(std::mt19937& random, double low, double high) {
  return static_cast<Real>(low + (high - low) * (static_cast<double>(random()) / 4294967296.0));
}
inline Vec3 random_unit(std::mt19937& random) {
  for (;;) {
    const Real x = uniform(random, -1, 1);
    const Real y = uniform(random, -1, 1);
    const Vec3 v = {x, y, uniform(random, -1, 1)};
    const Real size = length(v);
    if (size > Real(0.1) && size < Real(1)) return normalize(v);
  }
}
inline Quat random_turn(std::mt19937& random) {
  const Vec3 axis = random_unit(random);
  return quaternion_about(axis, uniform(random, 0, 6.28));
}
inline Shape random_shape(ShapeKind kind, std::mt19937& random) {
  Shape shape = {.kind = kind};
  shape.radius = uniform(random, 0.2, 1);
  shape.half_height = uniform(random, 0.2, 1);
  const Real x = uniform(random, 0.2, 1);
  const Real y = uniform(random, 0.2, 1);
  shape.half_extents = {x, y, uniform(random, 0.2, 1)};
  return shape;
}
inline collision::Convex placed(const Shape& shape, Vec3 center, Quat turn,
                                const geometry::ConvexHull* hull = nullptr) {
  return {.shape = shape, .center = center, .axes = matrix_of(turn), .hull = hull};
}

/// The largest separation along any axis, by trying directions all around and refining the best: the signed
/// distance of two shapes, apart or overlapping.
inline Real sampled_separation(const collision::Convex& a, const collision::Convex& b) {
  Real best = -std::numeric_limits<Real>::infinity();
  Vec3 direction = {Real(0), Real(1), Real(0)};
  const auto offer = [&](Vec3 n) {
    const Real s = collision::separation_along(a, b, n);
    direction = s > best ? n : direction;
    best = std::max(best, s);
  };
  constexpr int kSamples = 2000;
  for (int i = 0; i < kSamples; ++i) {  // a spiral over the sphere
    const double y = 1 - (2 * i + 1.0) / kSamples;
    const double r = std::sqrt(1 - y * y);
    const double angle = 2.399963 * i;
    offer({static_cast<Real>(r * std::cos(angle)), static_cast<Real>(y),
           static_cast<Real>(r * std::sin(angle))});
  }
  std::mt19937 random(1);
  for (Real reach = Real(0.1); reach > Real(1e-5); reach *= Real(0.7)) {
    for (int i = 0; i < 12; ++i) offer(normalize(direction + reach * random_unit(random)));
  }
  return best;
}

inline collision::ContactResult meeting_of(const collision::Convex& a, const collision::Convex& b,
                                           Real margin = Real(0.02)) {
  collision::ContactResult result;
  collision::collide(a, b, {.margin = margin}, result);
  return result;
}

}  // namespace hooke::test
