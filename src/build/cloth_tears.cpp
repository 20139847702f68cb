#include "build/cloth_tears.h"

#include "base/assert.h"
#include "build/cloth_splits.h"
#include "build/point_splits.h"
#include "geometry/convex/mass_properties.h"
#include "math/rotation.h"
#include "state/tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

namespace hooke::build {

namespace {

using state::Deformable;
using state::Tables;
using Corners = std::array<std::uint32_t, 3>;

/// Most points of a cloth that split in one step; the rest waits for the next. Smaller: tears run slower, at
/// most so many points a step. Larger: a step with a tear takes longer. Chosen by hand; no measurement is
/// recorded.
constexpr std::size_t kMostTears = 8;

/// Share of the strain that a cloth can take which a point beside a crack can [ratio]. Threads at the end of
/// a crack carry more than the mean of the triangles there shows. Larger: many short tears in place of one
/// that runs. Smaller: a tear runs on under a load that the cloth should carry. Chosen by hand; no
/// measurement is recorded.
constexpr double kStrainBesideCracks = 0.6;

Corners corners_of(const Tables& t, std::uint32_t triangle) {
  const auto [a, b, c] = t.triangles.corners[triangle];
  return {a, b, c};
}

/// A triangle's form at rest and now.
struct Stretch {
  double area = 0;                ///< At rest [m^2].
  std::array<DVec3, 2> moved;     ///< The columns of F, for an orthonormal basis of the plane at rest.
  double xx = 0, xy = 0, yy = 0;  ///< F^T F

  /// Largest and least eigenvalue of F^T F.
  [[nodiscard]] std::array<double, 2> squares() const {
    const double mean = 0.5 * (xx + yy);
    const double spread = std::sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy);
    return {mean + spread, std::max(0.0, mean - spread)};
  }
  /// Unit vector in the plane at rest whose stretch is the root of an eigenvalue.
  [[nodiscard]] DVec3 direction(double square) const {
    const double x = std::abs(xx - square) < std::abs(yy - square) ? yy - square : -xy;
    const double y = std::abs(xx - square) < std::abs(yy - square) ? -xy : xx - square;
    const double size = std::sqrt(x * x + y * y);
    const DVec3 d = size > 0 ? (x / size) * moved[0] + (y / size) * moved[1] : moved[0];
    return normalize(d);
  }
};

Stretch stretch_of(const Tables& t, const Deformable& cloth, std::uint32_t triangle) {
  const Corners at = corners_of(t, triangle);
  const std::vector<Vec3>& rest = *cloth.surface.rest_points;
  const auto rest_at = [&](std::size_t k) {
    return vector_cast<double>(rest[at[k] - cloth.particles.first]);
  };
  const auto now_at = [&](std::size_t k) { return vector_cast<double>(t.particles.position[at[k]].x); };
  const DVec3 e1 = rest_at(1) - rest_at(0);
  const DVec3 e2 = rest_at(2) - rest_at(0);
  const double l = length(e1);
  Stretch s;
  s.area = 0.5 * length(cross(e1, e2));
  if (!(s.area > 0)) return s;
  const double along = dot(e1, e2) / l;
  const double height = 2 * s.area / l;
  const DVec3 d1 = now_at(1) - now_at(0);
  const DVec3 d2 = now_at(2) - now_at(0);
  s.moved = {(1 / l) * d1, (1 / height) * (d2 - (along / l) * d1)};
  s.xx = length_squared(s.moved[0]);
  s.xy = dot(s.moved[0], s.moved[1]);
  s.yy = length_squared(s.moved[1]);
  return s;
}

/// A point that is strained too much.
struct Candidate {
  std::uint32_t particle = 0;  ///< Its row.
  double strain = 0;
  double need = 0;  ///< The strain over what the point can take.
  DVec3 direction;  ///< In which it is strained most.
};

/// Sums of strain times area, and of areas, at a point.
struct PointStrain {
  math::Symmetric3<double> strain;
  double area = 0;
  bool beside_crack = false;
};

void add(const Stretch& s, PointStrain& to) {
  to.area += s.area;
  const std::array<double, 2> squares = s.squares();
  for (const double square : squares) {
    const double strain = std::sqrt(square) - 1;
    if (!(strain > 0)) continue;
    const DVec3 d = s.direction(square);
    to.strain = to.strain + math::axial(d, strain * s.area, 0.0);
  }
}

/// Whether any triangle is strained so much that a point of it may split. It takes no memory: most steps end
/// here.
bool any_strained(const Tables& t, const Deformable& cloth) {
  const double least = cloth.split_from.empty() ? 1 : kStrainBesideCracks;
  const double stretch = 1 + least * static_cast<double>(cloth.tear_strain);
  for (std::uint32_t i = cloth.triangles.first; i < cloth.triangles.end(); ++i) {
    if (stretch_of(t, cloth, i).squares()[0] > stretch * stretch) return true;
  }
  return false;
}

/// Marks the points of triangles with a point that has split.
void mark_beside_cracks(const Tables& t, const Deformable& cloth, std::vector<PointStrain>& points) {
  const std::size_t made = cloth.particles.count - cloth.split_from.size();
  std::vector<bool> has_split(points.size(), false);
  for (std::size_t i = 0; i < cloth.split_from.size(); ++i) {
    const std::size_t first = cloth.particles.first;
    has_split[t.particles.row_of[first + cloth.split_from[i]]] = true;
    has_split[t.particles.row_of[first + made + i]] = true;
  }
  for (std::uint32_t i = cloth.triangles.first; i < cloth.triangles.end(); ++i) {
    const Corners at = corners_of(t, i);
    const bool beside = std::any_of(at.begin(), at.end(),
                                    [&](std::uint32_t p) { return has_split[p - cloth.particles.first]; });
    for (const std::uint32_t p : at) {
      PointStrain& point = points[p - cloth.particles.first];
      point.beside_crack = point.beside_crack || beside;
    }
  }
}

double limit_of(const Deformable& cloth, const PointStrain& point) {
  return (point.beside_crack ? kStrainBesideCracks : 1) * static_cast<double>(cloth.tear_strain);
}

/// Sums the strains of points with a triangle that is strained too much for them; others cannot be. Returns
/// whether there are any.
bool sum_strains(const Tables& t, const Deformable& cloth, std::vector<PointStrain>& points) {
  const std::uint32_t first = cloth.particles.first;
  std::vector<bool> may_split(points.size(), false);
  bool any = false;
  for (std::uint32_t i = cloth.triangles.first; i < cloth.triangles.end(); ++i) {
    const double square = stretch_of(t, cloth, i).squares()[0];
    for (const std::uint32_t p : corners_of(t, i)) {
      const double stretch = 1 + limit_of(cloth, points[p - first]);
      if (!(square > stretch * stretch)) continue;
      may_split[p - first] = any = true;
    }
  }
  for (std::uint32_t i = cloth.triangles.first; any && i < cloth.triangles.end(); ++i) {
    const Corners at = corners_of(t, i);
    if (std::none_of(at.begin(), at.end(), [&](std::uint32_t p) { return may_split[p - first]; })) continue;
    const Stretch stretch = stretch_of(t, cloth, i);
    for (const std::uint32_t p : at) {
      if (may_split[p - first]) add(stretch, points[p - first]);
    }
  }
  return any;
}

/// Lists the points that are strained too much, those first that are so most; equals in order of rows.
std::vector<Candidate> find_candidates(const Tables& t, const Deformable& cloth) {
  std::vector<PointStrain> points(cloth.particles.count);
  if (!cloth.split_from.empty()) mark_beside_cracks(t, cloth, points);
  std::vector<Candidate> found;
  if (!sum_strains(t, cloth, points)) return found;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const PointStrain& point = points[i];
    if (!(point.area > 0)) continue;
    const double limit = limit_of(cloth, point);
    const double sum = point.strain.xx + point.strain.yy + point.strain.zz;
    if (!(sum > limit * point.area)) continue;
    const auto axes = geometry::principal_axes(point.strain);
    const std::array<double, 3> moments = {axes.moments.x, axes.moments.y, axes.moments.z};
    const auto most = std::max_element(moments.begin(), moments.end());
    const double strain = *most / point.area;
    if (!(strain > limit) || !std::isfinite(strain)) continue;
    constexpr std::array<DVec3, 3> kAxes = {DVec3{1, 0, 0}, DVec3{0, 1, 0}, DVec3{0, 0, 1}};
    const DVec3 axis = kAxes[static_cast<std::size_t>(most - moments.begin())];
    found.push_back({.particle = cloth.particles.first + i,
                     .strain = strain,
                     .need = strain / limit,
                     .direction = rotate(axes.rotation, axis)});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Candidate& a, const Candidate& b) { return a.need > b.need; });
  return found;
}

/// The split of a point across a direction; nothing if all its triangles are on one side.
std::optional<PointSplit> split_across(const Tables& t, const ElementMesh<3>& mesh, const Candidate& at) {
  const auto x = [&](std::uint32_t p) { return vector_cast<double>(t.particles.position[p].x); };
  std::vector<std::vector<std::uint32_t>> sides(2);
  for (const std::uint32_t element : mesh.incidence.of(at.particle)) {
    const Corners& corners = mesh.corners[element];
    const DVec3 middle = x(corners[0]) + x(corners[1]) + x(corners[2]) - 3.0 * x(at.particle);
    sides[dot(middle, at.direction) > 0 ? 0 : 1].push_back(element);
  }
  if (sides[0].empty() || sides[1].empty()) return std::nullopt;
  std::vector<PointSplit> splits;
  append_splits(mesh, at.particle, std::move(sides), splits);
  if (splits.empty()) return std::nullopt;
  return splits.front();
}

/// Splits points that a blade has scored, where a tear has reached them.
void open_scored(std::uint32_t object, Tables& t) {
  if (t.objects[object].scored.empty()) return;
  const ElementMesh<3> mesh = triangles_of(t, t.objects[object]);
  const std::vector<ElementPair> scored = t.objects[object].scored;
  const std::vector<PointSplit> splits = find_splits<3>(mesh, scored, scored);
  const auto after = corners_after(mesh, t.objects[object].particles, splits);
  split_cloth(object, mesh, splits, t);
  t.objects[object].scored = still_joined<3>(scored, after);
}

/// The event of a point that gets the split of this number, of those made at once.
ClothTearEvent event_of(const Tables& t, const Deformable& cloth, std::span<const std::uint32_t> index,
                        std::uint32_t particle, std::size_t split) {
  return {.cloth = t.cloth_slots.id_of(cloth.slot),
          .point = index[particle - cloth.particles.first],
          .added = cloth.particles.count + static_cast<std::uint32_t>(split),
          .place = cloth.origin + vector_cast<double>(t.particles.position[particle].x)};
}

/// A point that a tear has reached.
struct Reached {
  std::uint32_t particle = 0;  ///< Its row.
  double strain = 0;           ///< Of the point that has split beside it.
};

/// Splits points whose triangles hang together by nothing but the point, as where a tear has reached the rim
/// or another tear: no force goes through a point alone.
void part_fans(std::uint32_t object, double time, std::vector<Reached>& reached, Tables& t,
               std::vector<ClothTearEvent>& events) {
  if (reached.empty()) return;
  const Deformable& cloth = t.objects[object];
  const auto by_row = [](const Reached& a, const Reached& b) { return a.particle < b.particle; };
  std::stable_sort(reached.begin(), reached.end(), by_row);
  const ElementMesh<3> mesh = triangles_of(t, cloth);
  const std::vector<std::uint32_t> index = indices_of(t, cloth);
  std::vector<PointSplit> splits;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const std::uint32_t particle = reached[i].particle;
    if (i > 0 && particle == reached[i - 1].particle) continue;
    const std::size_t first = splits.size();
    append_splits(mesh, particle, parts_at<3>(mesh, particle, {}), splits);
    for (std::size_t k = first; k < splits.size(); ++k) {
      events.push_back(event_of(t, cloth, index, particle, k));
      events.back().strain = static_cast<Real>(reached[i].strain);
      events.back().time = time;
    }
  }
  if (!splits.empty()) split_cloth(object, mesh, splits, t);
}

}  // namespace

void tear_cloth(std::uint32_t object, double time, Tables& t, std::vector<ClothTearEvent>& events) {
  HOOKE_ASSERT(object < t.objects.size() && t.objects[object].surface.rest_points != nullptr);
  if (!any_strained(t, t.objects[object])) return;
  const std::vector<Candidate> candidates = find_candidates(t, t.objects[object]);
  if (candidates.empty()) return;
  const Deformable& cloth = t.objects[object];
  const ElementMesh<3> mesh = triangles_of(t, cloth);
  const std::vector<std::uint32_t> index = indices_of(t, cloth);
  std::vector<Reached> near;  // Points that split in this step, and those beside, which that relieves.
  std::vector<PointSplit> splits;
  for (const Candidate& candidate : candidates) {
    if (splits.size() == kMostTears) break;
    const auto is_it = [&](const Reached& point) { return point.particle == candidate.particle; };
    if (std::any_of(near.begin(), near.end(), is_it)) continue;
    std::optional<PointSplit> split = split_across(t, mesh, candidate);
    if (!split) continue;
    for (const std::uint32_t element : mesh.incidence.of(candidate.particle)) {
      for (const std::uint32_t p : mesh.corners[element]) near.push_back({p, candidate.strain});
    }
    events.push_back(event_of(t, cloth, index, candidate.particle, splits.size()));
    events.back().strain = static_cast<Real>(candidate.strain);
    events.back().time = time;
    events.back().burst = splits.empty() && cloth.gas > 0;
    near.push_back({cloth.particles.end() + static_cast<std::uint32_t>(splits.size()), candidate.strain});
    splits.push_back(std::move(*split));
  }
  split_cloth(object, mesh, splits, t);
  open_scored(object, t);
  part_fans(object, time, near, t, events);
}

}  // namespace hooke::build
