#include "build/solid_tears.h"

#include "base/assert.h"
#include "build/point_splits.h"
#include "build/solid_splits.h"
#include "elements/tetrahedron.h"
#include "geometry/convex/mass_properties.h"
#include "math/rotation.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace hooke::build {

namespace {

using state::Deformable;
using state::Tables;
using Stress = math::Symmetric3<double>;

/// Most points of a solid that split in one step; see the like of cloth, kMostTears.
constexpr std::size_t kMostSolidTears = 8;

/// Share of the stress that a solid can take which a point beside a crack can [ratio]; see the like of cloth,
/// kStrainBesideCracks.
constexpr double kStressBesideCracks = 0.6;

/// Below this share of its volume at rest a tetrahedron is crushed, and its stress says nothing of tears
/// [ratio].
constexpr double kCrushed = 0.05;

/// Cauchy's stress of a tetrahedron [Pa]; zero for one that is crushed.
Stress stress_of(const Tables& t, std::uint32_t row) {
  const auto& [a, b, c, d] = t.tetrahedra.corners[row];
  std::array<DVec3, 4> x;
  std::array<DVec3, 4> gradients;
  const std::array<std::uint32_t, 4> corners = {a, b, c, d};
  for (std::size_t k = 0; k < 4; ++k) x[k] = vector_cast<double>(t.particles.position[corners[k]].x);
  for (std::size_t k = 1; k < 4; ++k) {
    gradients[k] = vector_cast<double>(t.tetrahedra.shape_gradient[row][k - 1]);
    gradients[0] -= gradients[k];
  }
  const Matrix3<double> f = elements::gradient_of(x, gradients);
  const double j = determinant(f);
  if (!(j > kCrushed)) return {};
  const elements::NeoHookean<double> material = {static_cast<double>(t.tetrahedra.shear_modulus[row]),
                                                 static_cast<double>(t.tetrahedra.volume_modulus[row])};
  const Matrix3<double> p = elements::stress(f, material);
  // Columns of a matrix are its members: (P F^T)_ik is the sum over columns m of P_im F_km.
  const auto entry = [&](auto i, auto k) {
    return (i(p.x) * k(f.x) + i(p.y) * k(f.y) + i(p.z) * k(f.z)) / j;
  };
  const auto first = [](const DVec3& v) { return v.x; };
  const auto second = [](const DVec3& v) { return v.y; };
  const auto third = [](const DVec3& v) { return v.z; };
  return {.xx = entry(first, first),
          .xy = entry(first, second),
          .xz = entry(first, third),
          .yy = entry(second, second),
          .yz = entry(second, third),
          .zz = entry(third, third)};
}

/// Square of Frobenius' norm, which no principal stress exceeds.
double norm_squared(const Stress& s) {
  return s.xx * s.xx + s.yy * s.yy + s.zz * s.zz + 2 * (s.xy * s.xy + s.xz * s.xz + s.yz * s.yz);
}

/// A point that is stressed too much.
struct StressedPoint {
  std::uint32_t particle = 0;
  double stress = 0;  ///< [Pa]
  double need = 0;    ///< The stress over what the point can take.
  DVec3 direction;
};

/// Whether any tetrahedron is stressed so much that a point of it may split. It takes no memory: most steps
/// end here.
bool any_stressed(const Tables& t, const Deformable& solid) {
  const double least = solid.split_from.empty() ? 1 : kStressBesideCracks;
  const double limit = least * static_cast<double>(solid.tear_stress);
  for (std::uint32_t i = solid.tetrahedra.first; i < solid.tetrahedra.end(); ++i) {
    if (norm_squared(stress_of(t, i)) > limit * limit) return true;
  }
  return false;
}

/// Marks the points of tetrahedra with a point that has split.
std::vector<bool> points_beside_cracks(const Tables& t, const Deformable& solid, const ElementMesh<4>& mesh) {
  std::vector<bool> beside(solid.particles.count, false);
  const std::uint32_t first = solid.particles.first;
  const std::size_t made = solid.particles.count - solid.split_from.size();
  const auto mark = [&](std::size_t index) {
    for (const std::uint32_t e : mesh.incidence.of(first + t.particles.row_of[first + index])) {
      for (const std::uint32_t p : mesh.corners[e]) beside[p - first] = true;
    }
  };
  for (std::size_t i = 0; i < solid.split_from.size(); ++i) {
    mark(solid.split_from[i]);
    mark(made + i);
  }
  return beside;
}

/// The largest principal stress at a particle and its direction.
StressedPoint stress_at(const ElementMesh<4>& mesh, std::span<const Stress> stresses,
                        std::uint32_t particle) {
  Stress sum;
  double volume = 0;
  for (const std::uint32_t e : mesh.incidence.of(particle)) {
    const auto weight = static_cast<double>(mesh.weight[e]);
    const Stress& s = stresses[e];
    sum = sum +
          Stress{weight * s.xx, weight * s.xy, weight * s.xz, weight * s.yy, weight * s.yz, weight * s.zz};
    volume += weight;
  }
  const auto axes = geometry::principal_axes(sum);
  const std::array<double, 3> moments = {axes.moments.x, axes.moments.y, axes.moments.z};
  const auto most = std::max_element(moments.begin(), moments.end());
  constexpr std::array<DVec3, 3> kAxes = {DVec3{1, 0, 0}, DVec3{0, 1, 0}, DVec3{0, 0, 1}};
  return {.particle = particle,
          .stress = *most / volume,
          .direction = rotate(axes.rotation, kAxes[static_cast<std::size_t>(most - moments.begin())])};
}

/// Lists the points that are stressed too much, those first that are so most; equals in order of rows.
std::vector<StressedPoint> find_stressed(const Tables& t, const Deformable& solid,
                                         const ElementMesh<4>& mesh) {
  std::vector<Stress> stresses;
  stresses.reserve(solid.tetrahedra.count);
  for (std::uint32_t i = solid.tetrahedra.first; i < solid.tetrahedra.end(); ++i)
    stresses.push_back(stress_of(t, i));
  const std::vector<bool> beside = points_beside_cracks(t, solid, mesh);
  std::vector<StressedPoint> found;
  for (std::uint32_t i = 0; i < solid.particles.count; ++i) {
    const double limit = (beside[i] ? kStressBesideCracks : 1) * static_cast<double>(solid.tear_stress);
    const std::uint32_t particle = solid.particles.first + i;
    const auto elements = mesh.incidence.of(particle);
    const bool may = std::any_of(elements.begin(), elements.end(),
                                 [&](std::uint32_t e) { return norm_squared(stresses[e]) > limit * limit; });
    if (!may) continue;
    StressedPoint point = stress_at(mesh, stresses, particle);
    point.need = point.stress / limit;
    if (point.need > 1 && std::isfinite(point.need)) found.push_back(point);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const StressedPoint& a, const StressedPoint& b) { return a.need > b.need; });
  return found;
}

/// The split of a point across a direction; nothing if all its tetrahedra are on one side.
std::optional<PointSplit> split_solid_point(const Tables& t, const ElementMesh<4>& mesh,
                                            const StressedPoint& at) {
  const auto x = [&](std::uint32_t p) { return vector_cast<double>(t.particles.position[p].x); };
  std::vector<std::vector<std::uint32_t>> sides(2);
  for (const std::uint32_t e : mesh.incidence.of(at.particle)) {
    DVec3 middle = -4.0 * x(at.particle);
    for (const std::uint32_t p : mesh.corners[e]) middle += x(p);
    sides[dot(middle, at.direction) > 0 ? 0 : 1].push_back(e);
  }
  if (sides[0].empty() || sides[1].empty()) return std::nullopt;
  std::vector<PointSplit> splits;
  append_splits(mesh, at.particle, std::move(sides), splits);
  if (splits.empty()) return std::nullopt;
  return splits.front();
}

/// Splits points near those that have split, where tetrahedra hang together by an edge or a point alone: what
/// carries nothing but has no cross-section would go on as a chain. `near` is by particle, as before the
/// splits.
void open_loose_parts(std::uint32_t object, const std::vector<bool>& near, Tables& t) {
  const Deformable& solid = t.objects[object];
  const ElementMesh<4> mesh = tetrahedra_of(t, solid);
  std::vector<PointSplit> splits;
  for (std::uint32_t i = 0; i < solid.particles.count; ++i) {
    if (i < near.size() && !near[i]) continue;
    const std::uint32_t particle = solid.particles.first + i;
    append_splits(mesh, particle, parts_at(mesh, particle, {}), splits);
  }
  part_solid(object, mesh, splits, solid.scored, t);
}

}  // namespace

void tear_solid(std::uint32_t object, double time, Tables& t, std::vector<SolidTearEvent>& events) {
  HOOKE_ASSERT(object < t.objects.size() && t.objects[object].tetrahedra.count > 0);
  if (!any_stressed(t, t.objects[object])) return;
  const Deformable& solid = t.objects[object];
  const ElementMesh<4> mesh = tetrahedra_of(t, solid);
  const std::vector<StressedPoint> stressed = find_stressed(t, solid, mesh);
  if (stressed.empty()) return;
  const std::vector<std::uint32_t> index = indices_of(t, solid);
  std::vector<bool> near(solid.particles.count, false);  // Beside a point that splits, which relieves it.
  std::vector<PointSplit> splits;
  for (const StressedPoint& point : stressed) {
    if (splits.size() == kMostSolidTears) break;
    if (near[point.particle - solid.particles.first]) continue;
    std::optional<PointSplit> split = split_solid_point(t, mesh, point);
    if (!split) continue;
    for (const std::uint32_t e : mesh.incidence.of(point.particle)) {
      for (const std::uint32_t p : mesh.corners[e]) near[p - solid.particles.first] = true;
    }
    events.push_back({.solid = t.solid_slots.id_of(solid.slot),
                      .point = index[point.particle - solid.particles.first],
                      .added = solid.particles.count + static_cast<std::uint32_t>(splits.size()),
                      .place = solid.origin + vector_cast<double>(t.particles.position[point.particle].x),
                      .stress = static_cast<Real>(point.stress),
                      .time = time});
    splits.push_back(std::move(*split));
  }
  if (splits.empty()) return;
  part_solid(object, mesh, splits, solid.scored, t);
  open_loose_parts(object, near, t);
}

}  // namespace hooke::build
