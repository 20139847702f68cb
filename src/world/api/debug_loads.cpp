#include "world/api/debug_loads.h"

#include "elements/tetrahedron.h"
#include "geometry/convex/mass_properties.h"
#include "math/symmetric.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace hooke::world {

namespace {

using state::Deformable;
using state::Tables;

/// Where a particle is, from its object's origin [m].
DVec3 offset_of(const Tables& t, std::uint32_t particle) {
  return vector_cast<double>(t.particles.position[particle].x);
}

double larger_by_size(double a, double b) {
  return std::abs(b) > std::abs(a) ? b : a;
}

/// Of the two principal strains in the plane of a triangle that which is larger by size; 0 for one without
/// area.
double strain_of_triangle(const std::array<DVec3, 3>& rest, const std::array<DVec3, 3>& now) {
  const DVec3 e1 = rest[1] - rest[0];
  const DVec3 e2 = rest[2] - rest[0];
  const double base = length(e1);
  const double height = length(cross(e1, e2)) / base;
  if (!(base > 0 && height > 0)) return 0;
  // The columns of F for a basis of the plane at rest, the first along its first edge.
  const DVec3 first = 1 / base * (now[1] - now[0]);
  const DVec3 second = 1 / height * (now[2] - now[0] - dot(e1, e2) / base * first);
  const double xx = length_squared(first);
  const double xy = dot(first, second);
  const double yy = length_squared(second);
  const double mean = 0.5 * (xx + yy);
  const double spread = std::sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy);
  return larger_by_size(std::sqrt(mean + spread) - 1, std::sqrt(std::max(0.0, mean - spread)) - 1);
}

/// Of the three principal strains of a tetrahedron that which is largest by size.
double strain_of_tetrahedron(const Tables& t, std::uint32_t row) {
  const auto [a, b, c, d] = t.tetrahedra.corners[row];
  std::array<DVec3, 4> gradients = {};
  for (std::size_t k = 0; k < 3; ++k)
    gradients[k + 1] = vector_cast<double>(t.tetrahedra.shape_gradient[row][k]);
  const Matrix3<double> f =
      elements::gradient_of({offset_of(t, a), offset_of(t, b), offset_of(t, c), offset_of(t, d)}, gradients);
  const math::Symmetric3<double> square = {.xx = dot(f.x, f.x),
                                           .xy = dot(f.x, f.y),
                                           .xz = dot(f.x, f.z),
                                           .yy = dot(f.y, f.y),
                                           .yz = dot(f.y, f.z),
                                           .zz = dot(f.z, f.z)};
  const DVec3 moments = geometry::principal_axes(square).moments;
  const auto strain = [](double moment) { return std::sqrt(std::max(0.0, moment)) - 1; };
  return larger_by_size(larger_by_size(strain(moments.x), strain(moments.y)), strain(moments.z));
}

/// Mean strain of the tetrahedra at each particle of a solid, by their volumes at rest.
std::vector<double> strains_at_points(const Tables& t, const Deformable& solid) {
  std::vector<double> sum(solid.particles.count, 0);
  std::vector<double> volume(solid.particles.count, 0);
  for (std::uint32_t i = solid.tetrahedra.first; i < solid.tetrahedra.end(); ++i) {
    const auto [a, b, c, d] = t.tetrahedra.corners[i];
    const auto share = static_cast<double>(t.tetrahedra.volume[i]);
    const double strain = strain_of_tetrahedron(t, i);
    for (const std::uint32_t p : {a, b, c, d}) {
      sum[p - solid.particles.first] += share * strain;
      volume[p - solid.particles.first] += share;
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = volume[i] > 0 ? sum[i] / volume[i] : 0;
  return sum;
}

/// The mean over what a vertex of a skin follows. `value` takes a particle, counted within the object.
template <class Value>
auto mean_at(const Tables& t, const Deformable& solid, const state::Skin::Anchor& anchor, Value value) {
  decltype(value(std::uint32_t{0})) mean = {};
  for (std::size_t k = 0; k < 4; ++k) {
    const std::uint32_t particle = t.particles.row_of[solid.particles.first + anchor.points[k]];
    mean += static_cast<double>(anchor.weights[k]) * value(particle);
  }
  return mean;
}

/// Corners of a triangle of a skin, by where the points of its solid are: `place` takes a point, counted
/// within the object.
template <class Place>
std::array<DVec3, 3> corners_of(const Tables& t, const Deformable& solid,
                                const std::array<std::uint32_t, 3>& triangle, Place place) {
  const auto at = [&](std::size_t k) { return mean_at(t, solid, solid.skin->vertices[triangle[k]], place); };
  return {at(0), at(1), at(2)};
}

/// The surface of a solid. A solid that is matched as a whole has no tetrahedra, and is judged by its
/// surface.
void load_skin(const Tables& t, const Deformable& solid, Loads& loads) {
  const bool is_filled = solid.tetrahedra.count > 0;
  if (!solid.skin || (!is_filled && !solid.rest_shape)) return;
  const std::vector<double> strains = strains_at_points(t, solid);
  const auto strain_at = [&](std::uint32_t p) { return strains[p]; };
  const auto rest_at = [&](std::uint32_t p) { return solid.rest_shape->place[p]; };
  const auto now_at = [&](std::uint32_t p) { return offset_of(t, solid.particles.first + p); };
  for (const auto& triangle : solid.skin->triangles) {
    LoadedTriangle loaded = {.corners = corners_of(t, solid, triangle, now_at)};
    if (!is_filled) loaded.load = strain_of_triangle(corners_of(t, solid, triangle, rest_at), loaded.corners);
    for (std::size_t k = 0; is_filled && k < 3; ++k)
      loaded.load += mean_at(t, solid, solid.skin->vertices[triangle[k]], strain_at) / 3;
    for (DVec3& corner : loaded.corners) corner += solid.origin;
    loads.triangles.push_back(loaded);
  }
}

void load_cloth(const Tables& t, const Deformable& cloth, Loads& loads) {
  if (!cloth.surface.rest_points) return;
  for (std::uint32_t i = cloth.triangles.first; i < cloth.triangles.end(); ++i) {
    const auto [a, b, c] = t.triangles.corners[i];
    const std::array<std::uint32_t, 3> at = {a, b, c};
    LoadedTriangle loaded;
    std::array<DVec3, 3> rest = {};
    for (std::size_t k = 0; k < 3; ++k) {
      rest[k] = vector_cast<double>((*cloth.surface.rest_points)[at[k] - cloth.particles.first]);
      loaded.corners[k] = cloth.origin + offset_of(t, at[k]);
    }
    loaded.load = strain_of_triangle(rest, loaded.corners);
    loads.triangles.push_back(loaded);
  }
}

void load_rope(const Tables& t, const Deformable& rope, Loads& loads) {
  for (std::uint32_t i = 0; i < rope.segments.count; ++i) {
    const std::size_t segment = std::size_t{rope.segments.first} + i;
    if (!t.segments.joins(segment)) continue;
    const std::uint32_t particle = rope.particles.first + i;
    loads.lines.push_back({rope.origin + offset_of(t, particle), rope.origin + offset_of(t, particle + 1),
                           static_cast<double>(t.segments.mean_tension[segment])});
  }
}

void load_springs(const Tables& t, const Deformable& object, Loads& loads) {
  for (std::uint32_t i = object.springs.first; i < object.springs.end(); ++i) {
    const auto rest = static_cast<double>(t.springs.rest_length[i]);
    if (t.springs.kind[i] != state::SpringClass::kStretch || !(rest > 0)) continue;
    const DVec3 from = offset_of(t, t.springs.particle_a[i]);
    const DVec3 to = offset_of(t, t.springs.particle_b[i]);
    loads.lines.push_back({object.origin + from, object.origin + to, length(to - from) / rest - 1});
  }
}

}  // namespace

Loads loads_of(const Tables& tables, const Deformable& object) {
  Loads loads;
  switch (object.kind) {
    case PointRef::Kind::kRope:
      load_rope(tables, object, loads);
      break;
    case PointRef::Kind::kCloth:
      load_cloth(tables, object, loads);
      break;
    case PointRef::Kind::kSolid:
      load_skin(tables, object, loads);
      break;
    case PointRef::Kind::kParticles:
      load_springs(tables, object, loads);
      break;
    case PointRef::Kind::kNone:
      break;
  }
  return loads;
}

}  // namespace hooke::world
