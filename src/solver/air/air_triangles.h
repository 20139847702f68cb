/// The air on triangles in the Numbers of solver/simd/numbers.h. Included anew for each instruction set.

#if defined(HOOKE_SOLVER_AIR_AIR_TRIANGLES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_AIR_AIR_TRIANGLES_H
#undef HOOKE_SOLVER_AIR_AIR_TRIANGLES_H
#else
#define HOOKE_SOLVER_AIR_AIR_TRIANGLES_H
#endif

#include "solver/air/air_kernels.h"
#include "solver/simd/numbers.h"

#include <cstdint>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

template <class Number>
HWY_INLINE Triple<Number> read_record(const Real* base, const std::uint32_t* record) {
  Quad<Number> q;
  read_quad(base, record, q);
  return {q.x, q.y, q.z};
}

/// Loads the triangles from `row` on, one for each lane. N is the normal, twice the area long, and
/// c = |N.u| / |N|. The impulse on a corner is
///
///     h rho / 12 |N.u| ((C_d - C_l c / |u|) u + C_l |u| n) / max(1, h rho |N.u| (C_d + C_l) / 4 m)
template <class Number>
HWY_INLINE void load_triangle_lanes(const TriangleAir& air, std::uint32_t row) {
  std::uint32_t record[3][kLanesOf<Number>];
  std::uint32_t out[kLanesOf<Number>];
  alignas(64) Real masses[kLanesOf<Number>];  // a triangle's row may begin anywhere
  for (std::uint32_t k = 0; k < kLanesOf<Number>; ++k) {
    for (int j = 0; j < 3; ++j) record[j][k] = 4 * air.corners[3 * (row + k) + static_cast<std::uint32_t>(j)];
    out[k] = 4 * (row + k);
    masses[k] = air.mass[row + k];
  }
  const auto flow_at = [&](int j) HWY_ATTR {
    return difference(read_record<Number>(air.wind, record[j]), read_record<Number>(air.velocity, record[j]));
  };
  const Number zero(Real(0));
  const Number one(Real(1));
  const Triple<Number> u = scaled(Number(Real(1) / Real(3)), sum(sum(flow_at(0), flow_at(1)), flow_at(2)));
  const Triple<Number> x = read_record<Number>(air.position, record[0]);
  const Triple<Number> normal = cross(difference(read_record<Number>(air.position, record[1]), x),
                                      difference(read_record<Number>(air.position, record[2]), x));
  const Number size = root(dot(normal, normal));
  const Number speed = root(dot(u, u));
  const Number through = dot(normal, u);
  const Number across = larger(through, zero - through);
  const Number per_size = quotient(one, size);
  const Number c = across * per_size;
  const Number rate = Number(air.h * Real(0.25) * air.density * (air.drag + air.lift)) * across;
  const Number mass = get<Number>(masses);
  const Number limit = choose(above(rate, mass), quotient(rate, mass), one);
  const Number lift(air.lift);
  const Number strength = quotient(Number(air.h * air.density / Real(12)) * across, limit);
  // The normal points to the side on which the air comes out.
  const Number turned = choose(above(zero, through), zero - per_size, per_size);
  const Triple<Number> impulse = scaled(strength, sum(scaled(Number(air.drag) - lift * quotient(c, speed), u),
                                                      scaled(lift * speed * turned, normal)));
  // Without area or flow there is no impulse, and the quotients mean nothing.
  const auto loaded = above(smaller(size, speed), zero);
  write_quad(Quad<Number>{choose(loaded, impulse.x, zero), choose(loaded, impulse.y, zero),
                          choose(loaded, impulse.z, zero), zero},
             air.corner_impulse, out);
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
