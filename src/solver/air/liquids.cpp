#include "solver/air/liquids.h"

#include "base/assert.h"
#include "geometry/convex/immersion.h"
#include "math/root.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace hooke::solver {

namespace {

constexpr double kPi = std::numbers::pi;

/// A part of a simplex: its share of the whole, and the integral of the corners' shape functions over it,
/// also as shares of the whole.
template <std::size_t kCorners>
struct Part {
  double share = 0;
  std::array<double, kCorners> of_corner = {};
};

using Weights = std::array<double, 4>;  // Weights of a point in a tetrahedron.

/// The point at which the edge from corner a to corner b, which lies above, crosses the surface.
Weights crossing(const std::array<double, 4>& depth, std::size_t a, std::size_t b) {
  const double t = depth[a] / (depth[a] - depth[b]);
  Weights weights = {};
  weights[a] = 1 - t;
  weights[b] = t;
  return weights;
}

void add_tetrahedron(double share, const std::array<Weights, 4>& corners, Part<4>& part) {
  part.share += share;
  for (std::size_t i = 0; i < 4; ++i)
    part.of_corner[i] += 0.25 * share * (corners[0][i] + corners[1][i] + corners[2][i] + corners[3][i]);
}

Weights corner(std::size_t i) {
  Weights weights = {};
  weights[i] = 1;
  return weights;
}

/// Adds the tip that the surface cuts off at corner a, times `sign`. The tip is below the surface where a is
/// below and the others are above, and above the surface where a alone is above.
void add_tip(const std::array<double, 4>& depth, std::size_t a, double sign, Part<4>& part) {
  std::array<Weights, 4> corners = {corner(a)};
  double share = sign;
  std::size_t next = 1;
  for (std::size_t b = 0; b < 4; ++b) {
    if (b == a) continue;
    corners[next] = crossing(depth, a, b);
    share *= corners[next++][b];
  }
  add_tetrahedron(share, corners, part);
}

/// Adds the wedge below the surface where a and b are below, c and d above: three tetrahedra.
void add_wedge(const std::array<double, 4>& depth, std::array<std::size_t, 4> order, Part<4>& part) {
  const auto [a, b, c, d] = order;
  const Weights ac = crossing(depth, a, c);
  const Weights ad = crossing(depth, a, d);
  const Weights bc = crossing(depth, b, c);
  const Weights bd = crossing(depth, b, d);
  add_tetrahedron(bc[c] * bd[d], {corner(a), corner(b), bc, bd}, part);
  add_tetrahedron(ac[c] * bc[b] * bd[d], {corner(a), ac, bc, bd}, part);
  add_tetrahedron(ac[c] * ad[d] * bd[b], {corner(a), ac, ad, bd}, part);
}

Part<4> part_below(const std::array<double, 4>& depth) {
  std::array<std::size_t, 4> below = {};
  std::array<std::size_t, 4> above = {};
  std::size_t below_count = 0;
  std::size_t above_count = 0;
  for (std::size_t i = 0; i < 4; ++i) (depth[i] > 0 ? below[below_count++] : above[above_count++]) = i;
  constexpr Part<4> kAll = {1, {0.25, 0.25, 0.25, 0.25}};
  Part<4> part;
  if (below_count == 4) part = kAll;
  if (below_count == 3) part = kAll, add_tip(depth, above[0], -1, part);
  if (below_count == 2) add_wedge(depth, {below[0], below[1], above[0], above[1]}, part);
  if (below_count == 1) add_tip(depth, below[0], 1, part);
  return part;
}

struct Loads {
  const state::Deformable& object;
  const LiquidSurface& surface;
  const state::Particles& particles;
  std::vector<LiquidLoad>& loads;

  /// Place of a particle in the world.
  [[nodiscard]] DVec3 place(std::uint32_t p) const {
    return object.origin + vector_cast<double>(particles.position[p].x);
  }
  [[nodiscard]] LiquidLoad& of(std::uint32_t p) const { return loads[p - object.particles.first]; }

  /// Adds a ball; `scale` is the displaced volume over that of the ball.
  void add_ball(std::uint32_t p, double radius, double scale = 1) const {
    const double cap = std::clamp(radius + surface.depth(place(p)), 0.0, 2 * radius);
    const double volume = scale * geometry::cap_volume(radius, cap);
    LiquidLoad& load = of(p);
    load.volume += volume;
    load.area += scale * kPi * cap * (2 * radius - cap);
    load.push += volume * surface.up;
  }

  /// Adds a volume at a particle that comes and goes over the thickness of the particle.
  void add_volume(std::uint32_t p, double volume) const {
    const double r = radius(p);
    add_ball(p, r, volume / geometry::cap_volume(r, 2 * r));
  }

  void add_tetrahedra(const state::Tetrahedra& tetrahedra) const {
    for (std::uint32_t i = object.tetrahedra.first; i < object.tetrahedra.end(); ++i) {
      const auto [a, b, c, d] = tetrahedra.corners[i];
      const std::array<std::uint32_t, 4> row = {a, b, c, d};
      const std::array<DVec3, 4> x = {place(a), place(b), place(c), place(d)};
      const double volume = dot(x[1] - x[0], cross(x[2] - x[0], x[3] - x[0])) / 6;
      if (!(volume > 0)) continue;  // It is inside out for now.
      const Part<4> part =
          part_below({surface.depth(x[0]), surface.depth(x[1]), surface.depth(x[2]), surface.depth(x[3])});
      const bool cut = part.share > 0 && part.share < 1;
      for (std::size_t k = 0; k < 4; ++k) {
        const double share = volume * part.of_corner[k];
        LiquidLoad& load = of(row[k]);
        load.volume += share;
        load.push += share * surface.up;
        if (cut) load.area += 0.25 * math::cube_root(volume * volume);
      }
    }
  }

  /// Adds the pressure on one triangle from its right-hand side, which is outside.
  void press(const std::array<std::uint32_t, 3>& row) const {
    const std::array<DVec3, 3> x = {place(row[0]), place(row[1]), place(row[2])};
    const DVec3 area = 0.5 * cross(x[1] - x[0], x[2] - x[0]);
    std::array<std::array<double, 3>, 4> weights = {};  // Weights of the corners of the part below.
    std::array<double, 4> depth = {};
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t next = (i + 1) % 3;
      const double here = surface.depth(x[i]);
      const double there = surface.depth(x[next]);
      if (here > 0) {
        weights[count][i] = 1;
        depth[count++] = here;
      }
      if ((here > 0) == (there > 0)) continue;
      const double t = here / (here - there);
      weights[count][i] = 1 - t;
      weights[count++][next] = t;
    }
    HOOKE_ASSERT(count <= depth.size());
    for (std::size_t k = 2; k < count; ++k) {
      press_part(row, area, {weights[0], weights[k - 1], weights[k]}, {depth[0], depth[k - 1], depth[k]},
                 count == 3 && weights[0][0] == 1 && weights[1][1] == 1 && weights[2][2] == 1);
    }
  }

  /// Over a triangle of area A, the integral of a product of two linear functions is A / 12 times the sum of
  /// the products at its corners and the product of the sums.
  void press_part(const std::array<std::uint32_t, 3>& row, DVec3 area,
                  const std::array<std::array<double, 3>, 3>& at, const std::array<double, 3>& depth,
                  bool whole) const {
    const auto& [a, b, c] = at;
    const double share = std::abs(a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
                                  a[2] * (b[0] * c[1] - b[1] * c[0]));
    const double sum = depth[0] + depth[1] + depth[2];
    for (std::size_t i = 0; i < 3; ++i) {
      const double products = depth[0] * a[i] + depth[1] * b[i] + depth[2] * c[i];
      const double integral = share / 12 * (products + sum * (a[i] + b[i] + c[i]));
      LiquidLoad& load = of(row[i]);
      load.push -= integral * area;
      if (!whole) load.area += share / 3 * length(area);
    }
  }

  void press_triangles(const state::Triangles& triangles) const {
    for (std::uint32_t i = object.triangles.first; i < object.triangles.end(); ++i) {
      const auto [a, b, c] = triangles.corners[i];
      press({a, b, c});
    }
    // For the drag, the displaced volume belongs to all points of the skin alike.
    double volume = 0;
    for (const LiquidLoad& load : loads) volume += dot(load.push, surface.up);
    for (LiquidLoad& load : loads) load.volume = std::max(volume, 0.0) / static_cast<double>(loads.size());
  }

  [[nodiscard]] double radius(std::uint32_t p) const {
    return static_cast<double>(particles.position[p].radius);
  }

  void add_sheet(const state::Triangles& triangles) const {
    for (std::uint32_t i = object.triangles.first; i < object.triangles.end(); ++i) {
      const auto [a, b, c] = triangles.corners[i];
      const double third = length(cross(place(b) - place(a), place(c) - place(a))) / 6;
      for (const std::uint32_t p : {a, b, c}) of(p).area += third;
    }
    for (std::uint32_t p = object.particles.first; p < object.particles.end(); ++p) {
      const double volume = 2 * radius(p) * of(p).area;
      of(p).area = 0;
      add_volume(p, volume);
    }
  }

  void add_rope(const state::Segments& segments) const {
    const std::uint32_t count = object.segments.count;
    const auto half = [&](std::uint32_t k) {
      return 0.5 * static_cast<double>(segments.rest_length[object.segments.first + k]);
    };
    for (std::uint32_t k = 0; k < object.particles.count; ++k) {
      const std::uint32_t p = object.particles.first + k;
      const double length = (k > 0 ? half(k - 1) : 0.0) + (k < count ? half(k) : 0.0);
      add_volume(p, kPi * radius(p) * radius(p) * length);
    }
  }

  void add_matched(const state::RestShape& rest) const {
    for (std::uint32_t p = object.particles.first; p < object.particles.end(); ++p) {
      const auto w = static_cast<double>(particles.velocity[p].inverse_mass);
      if (w > 0) add_ball(p, math::cube_root(0.75 / kPi * rest.volume / (w * rest.mass)));
    }
  }

  void add_balls() const {
    for (std::uint32_t p = object.particles.first; p < object.particles.end(); ++p) add_ball(p, radius(p));
  }
};

}  // namespace

LiquidSurface::LiquidSurface(const FieldDesc& liquid, Vec3 gravity_of_world) : height(liquid.height) {
  const DVec3 g = vector_cast<double>(gravity_of_world);
  gravity = length(g);
  if (gravity > 0) up = (-1 / gravity) * g;
}

void find_liquid_loads(const state::Deformable& object, const LiquidRows& rows, const LiquidSurface& surface,
                       const state::Particles& particles, std::vector<LiquidLoad>& loads) {
  loads.assign(object.particles.count, {});
  const Loads sum = {object, surface, particles, loads};
  if (object.tetrahedra.count > 0) {
    sum.add_tetrahedra(rows.tetrahedra);
  } else if (object.gas > 0) {
    sum.press_triangles(rows.triangles);
  } else if (object.kind == PointRef::Kind::kRope) {
    sum.add_rope(rows.segments);
  } else if (object.kind == PointRef::Kind::kCloth) {
    sum.add_sheet(rows.triangles);
  } else if (object.rest_shape && object.rest_shape->volume > 0) {
    sum.add_matched(*object.rest_shape);
  } else {
    sum.add_balls();
  }
}

void apply_liquid(const FieldDesc& liquid, const LiquidSurface& surface, const state::Deformable& object,
                  const std::vector<LiquidLoad>& loads, Real h, state::Particles& particles) {
  HOOKE_ASSERT(loads.size() == object.particles.count);
  const auto step = static_cast<double>(h);
  const double weight = liquid.density * surface.gravity;  // [N/m^3]
  for (std::uint32_t k = 0; k < object.particles.count; ++k) {
    state::VelocityRecord& record = particles.velocity[object.particles.first + k];
    const LiquidLoad& load = loads[k];
    if (!(record.inverse_mass > Real(0))) continue;
    const auto w = static_cast<double>(record.inverse_mass);
    const double rate = liquid.drag * liquid.density * load.volume * w;
    const DVec3 flow = vector_cast<double>(liquid.vector);
    DVec3 v = flow + (1 / (1 + step * rate)) * (vector_cast<double>(record.v) - flow);
    v += (step * weight * w) * load.push;
    const double excess = step * step * weight * load.area * w - 1;
    if (excess > 0) v -= excess / (1 + excess) * dot(v, surface.up) * surface.up;
    record.v = vector_cast<Real>(v);
  }
}

}  // namespace hooke::solver
