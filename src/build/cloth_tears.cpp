#include "build/cloth_tears.h"

#include "base/assert.h"
#include "geometry/convex/mass_properties.h"
#include "math/rotation.h"
#include "state/particle_numbers.h"
#include "state/tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <span>

namespace hooke::build {

namespace {

using state::Deformable;
using state::SpringClass;
using state::Tables;
using Corners = std::array<std::uint32_t, 3>;

/// Most points of a cloth that split in one step; the rest waits for the next. Smaller: tears run slower, at
/// most so many edges a step. Larger: a step with a tear takes longer. Chosen by hand; no measurement is
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

bool has(const Corners& corners, std::uint32_t particle) {
  return corners[0] == particle || corners[1] == particle || corners[2] == particle;
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

/// Where a point splits.
struct Crack {
  std::uint32_t point = 0;           ///< Row of the particle that splits.
  std::uint32_t added = 0;           ///< Row of the new one.
  std::vector<std::uint32_t> kept;   ///< Triangles that keep the point.
  std::vector<std::uint32_t> moved;  ///< Triangles that get the new one.
  double kept_area = 0, moved_area = 0;
};

/// Parts the triangles of a point by the plane across a direction; nothing if all are on one side.
std::optional<Crack> part_triangles(const Tables& t, const Deformable& cloth, const Candidate& at) {
  Crack crack;
  crack.point = at.particle;
  crack.added = cloth.particles.end();
  const auto x = [&](std::uint32_t p) { return vector_cast<double>(t.particles.position[p].x); };
  for (std::uint32_t i = cloth.triangles.first; i < cloth.triangles.end(); ++i) {
    const Corners corners = corners_of(t, i);
    if (!has(corners, at.particle)) continue;
    const DVec3 middle = x(corners[0]) + x(corners[1]) + x(corners[2]) - 3.0 * x(at.particle);
    const bool ahead = dot(middle, at.direction) > 0;
    (ahead ? crack.kept : crack.moved).push_back(i);
    (ahead ? crack.kept_area : crack.moved_area) += stretch_of(t, cloth, i).area;
  }
  if (!(crack.kept_area > 0) || !(crack.moved_area > 0)) return std::nullopt;
  if (crack.moved_area > crack.kept_area) {
    std::swap(crack.moved, crack.kept);
    std::swap(crack.moved_area, crack.kept_area);
  }
  return crack;
}

/// Whether one of the triangles has all of these particles.
bool any_has(const Tables& t, const std::vector<std::uint32_t>& triangles,
             std::span<const std::uint32_t> particles) {
  return std::any_of(triangles.begin(), triangles.end(), [&](std::uint32_t triangle) {
    const Corners corners = corners_of(t, triangle);
    return std::all_of(particles.begin(), particles.end(), [&](std::uint32_t p) { return has(corners, p); });
  });
}

enum class CrackSide : std::uint8_t { kNone, kKept, kMoved, kBoth };

/// On which sides of a crack the triangles are that have the point and these particles.
CrackSide side_of(const Tables& t, const Crack& crack, std::span<const std::uint32_t> particles) {
  const bool kept = any_has(t, crack.kept, particles);
  const bool moved = any_has(t, crack.moved, particles);
  if (kept) return moved ? CrackSide::kBoth : CrackSide::kKept;
  return moved ? CrackSide::kMoved : CrackSide::kNone;
}

/// Across which edge, opposite of the split point, which particle lies.
struct Opposite {
  std::uint32_t particle = 0;
  CrackSide side = CrackSide::kNone;
};

/// Lists the particles across the outer edges of the triangles of a crack.
std::vector<Opposite> list_opposites(const Tables& t, const Deformable& cloth, const Crack& crack) {
  std::vector<bool> near(cloth.particles.count, false);
  for (const std::vector<std::uint32_t>* side : {&crack.kept, &crack.moved}) {
    for (const std::uint32_t triangle : *side) {
      for (const std::uint32_t p : corners_of(t, triangle)) near[p - cloth.particles.first] = true;
    }
  }
  std::vector<Opposite> opposites;
  for (std::uint32_t i = cloth.triangles.first; i < cloth.triangles.end(); ++i) {
    const Corners corners = corners_of(t, i);
    if (has(corners, crack.point)) continue;
    const auto is_near = [&](std::uint32_t p) { return near[p - cloth.particles.first]; };
    if (std::count_if(corners.begin(), corners.end(), is_near) < 2) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::array<std::uint32_t, 2> edge = {corners[k], corners[(k + 1) % 3]};
      const CrackSide side = side_of(t, crack, edge);
      if (side != CrackSide::kNone) opposites.push_back({corners[(k + 2) % 3], side});
    }
  }
  return opposites;
}

/// Pairs of particles that lie beside an edge along the crack, on its two sides.
std::vector<std::array<std::uint32_t, 2>> list_wings(const Tables& t, const Crack& crack) {
  std::vector<std::array<std::uint32_t, 2>> wings;
  for (const std::uint32_t kept : crack.kept) {
    for (const std::uint32_t moved : crack.moved) {
      const Corners a = corners_of(t, kept);
      const Corners b = corners_of(t, moved);
      for (const std::uint32_t shared : a) {
        if (shared == crack.point || !has(b, shared)) continue;
        const std::uint32_t left = a[0] ^ a[1] ^ a[2] ^ crack.point ^ shared;
        const std::uint32_t right = b[0] ^ b[1] ^ b[2] ^ crack.point ^ shared;
        wings.push_back({std::min(left, right), std::max(left, right)});
      }
    }
  }
  return wings;
}

/// Inserts a copy of row `from` at `at`.
template <class Table>
void insert_copy(Table& table, std::uint32_t from, std::uint32_t at) {
  Table::for_each_column(table, [&](auto& column) {
    const auto value = column[from];
    column.insert(column.begin() + at, value);
  });
}

/// Erases rows, in ascending order.
template <class Table>
void erase_rows(Table& table, const std::vector<std::uint32_t>& rows) {
  if (rows.empty()) return;
  Table::for_each_column(table, [&](auto& column) {
    auto to = column.begin() + rows.front();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto end = i + 1 < rows.size() ? column.begin() + rows[i + 1] : column.end();
      to = std::move(column.begin() + rows[i] + 1, end, to);
    }
    column.erase(to, column.end());
  });
}

/// Raises the numbers of particles behind those of an object, for one that is added to it. Only later
/// objects, and what holds them, have such numbers.
void shift_particles(std::uint32_t object, Tables& t) {
  if (object + 1 == t.objects.size()) return;
  const std::uint32_t at = t.objects[object].particles.end();
  const auto shift = [at](std::uint32_t& p) { p += p >= at ? 1 : 0; };
  state::for_each_particle_number(t, t.objects[object + 1], shift);
  for (std::uint32_t& p : t.contacts.particle) shift(p);
  for (state::ElementContact& contact : t.element_contacts) {
    for (std::uint32_t i = 0; i < contact.count; ++i) shift(contact.particle[i]);
  }
  for (state::RopeContact& contact : t.rope_contacts) {
    for (std::uint32_t& p : contact.particle) shift(p);
  }
  for (std::size_t i = object + 1; i < t.objects.size(); ++i) ++t.objects[i].particles.first;
}

/// Appends the new particle, and shares what the split one had between the two.
void add_particle(std::uint32_t object, const Crack& crack, Tables& t) {
  shift_particles(object, t);
  Deformable& cloth = t.objects[object];
  state::Particles& particles = t.particles;
  insert_copy(particles, crack.point, crack.added);
  particles.row_of[crack.added] = cloth.particles.count;
  ++cloth.particles.count;
  const double share = crack.moved_area / (crack.kept_area + crack.moved_area);
  const auto divide = [&](auto& column) {
    const Real all = column[crack.point];
    column[crack.added] = static_cast<Real>(share * static_cast<double>(all));
    column[crack.point] = all - column[crack.added];
  };
  divide(particles.mass);
  divide(particles.charge);
  divide(particles.viscous_drag);
  divide(particles.drag_area);
  particles.force[crack.added] = static_cast<Real>(share) * particles.force[crack.point];
  particles.force[crack.point] -= particles.force[crack.added];
  const bool held = !(particles.velocity[crack.point].inverse_mass > Real(0));
  particles.velocity[crack.added].inverse_mass = Real(1) / particles.mass[crack.added];
  if (!held) particles.velocity[crack.point].inverse_mass = Real(1) / particles.mass[crack.point];
  auto rest = std::make_shared<std::vector<Vec3>>(*cloth.surface.rest_points);
  rest->push_back((*rest)[crack.point - cloth.particles.first]);
  cloth.surface.rest_points = std::move(rest);
}

/// Erases rows of an object, in ascending order; rows of later objects move up.
template <class Table>
void erase_rows_of(std::uint32_t object, state::Rows Deformable::*rows,
                   const std::vector<std::uint32_t>& gone, Table& table, Tables& t) {
  erase_rows(table, gone);
  const auto count = static_cast<std::uint32_t>(gone.size());
  (t.objects[object].*rows).count -= count;
  for (std::size_t i = object + 1; i < t.objects.size(); ++i) (t.objects[i].*rows).first -= count;
}

/// Springs that do not just stay or move with the point.
struct PartedSprings {
  std::vector<std::uint32_t> gone;     ///< Those across the crack.
  std::vector<std::uint32_t> doubled;  ///< Those along it.
};

/// Moves springs of the point to the side that they are on, and lists the others.
PartedSprings move_springs(const Deformable& cloth, const Crack& crack, Tables& t) {
  state::Springs& springs = t.springs;
  const std::vector<Opposite> opposites = list_opposites(t, cloth, crack);
  const auto wings = list_wings(t, crack);
  const auto side_across = [&](std::uint32_t other) {
    const auto at = std::find_if(opposites.begin(), opposites.end(),
                                 [other](const Opposite& o) { return o.particle == other; });
    return at != opposites.end() ? at->side : CrackSide::kNone;
  };
  PartedSprings parted;
  for (std::uint32_t i = cloth.springs.first; i < cloth.springs.end(); ++i) {
    std::uint32_t& a = springs.particle_a[i];
    std::uint32_t& b = springs.particle_b[i];
    if (a != crack.point && b != crack.point) {
      if (springs.kind[i] != SpringClass::kShear) continue;
      const std::array<std::uint32_t, 2> pair = {std::min(a, b), std::max(a, b)};
      const bool crosses = std::find(wings.begin(), wings.end(), pair) != wings.end();
      if (crosses) parted.gone.push_back(i);
      continue;
    }
    const std::uint32_t other = a == crack.point ? b : a;
    CrackSide side = side_of(t, crack, {&other, 1});
    if (side == CrackSide::kNone) side = side_across(other);
    if (side == CrackSide::kMoved) (a == crack.point ? a : b) = crack.added;
    if (side == CrackSide::kBoth) parted.doubled.push_back(i);
    if (side == CrackSide::kNone) parted.gone.push_back(i);
  }
  return parted;
}

/// Moves springs of the point to the side that they are on. Those along the crack are there twice, and those
/// across it go.
void part_springs(std::uint32_t object, const Crack& crack, Tables& t) {
  Deformable& cloth = t.objects[object];
  state::Springs& springs = t.springs;
  const PartedSprings parted = move_springs(cloth, crack, t);
  for (const std::uint32_t i : parted.doubled) {
    const std::uint32_t copy = cloth.springs.end();
    insert_copy(springs, i, copy);
    (springs.particle_a[copy] == crack.point ? springs.particle_a : springs.particle_b)[copy] = crack.added;
    ++cloth.springs.count;
  }
  for (std::size_t i = object + 1; i < t.objects.size(); ++i)
    t.objects[i].springs.first += static_cast<std::uint32_t>(parted.doubled.size());
  erase_rows_of(object, &Deformable::springs, parted.gone, springs, t);
}

/// Moves bends likewise. Those about an edge along the crack go.
void part_bends(std::uint32_t object, const Crack& crack, Tables& t) {
  const Deformable& cloth = t.objects[object];
  std::vector<std::uint32_t> gone;
  for (std::uint32_t i = cloth.bends.first; i < cloth.bends.end(); ++i) {
    state::Bends::Stencil& s = t.bends.stencil[i];
    std::uint32_t* const at[] = {&s.edge_a, &s.edge_b, &s.wing_a, &s.wing_b};
    const auto own =
        std::find_if(std::begin(at), std::end(at), [&](const std::uint32_t* p) { return *p == crack.point; });
    if (own == std::end(at)) continue;
    const bool is_edge = own - std::begin(at) < 2;
    const std::uint32_t end = *own == &s.edge_a ? s.edge_b : s.edge_a;
    const CrackSide first = is_edge ? side_of(t, crack, std::array{end, s.wing_a})
                                    : side_of(t, crack, std::array{s.edge_a, s.edge_b});
    const CrackSide second = is_edge ? side_of(t, crack, std::array{end, s.wing_b}) : first;
    if (first != second || first == CrackSide::kNone) {
      gone.push_back(i);
    } else if (first == CrackSide::kMoved) {
      **own = crack.added;
    }
  }
  erase_rows_of(object, &Deformable::bends, gone, t.bends, t);
}

/// Bit of the triangle's edge from or to `point`, to or from `end`; 0 if it has none.
std::uint8_t edge_bit(const Corners& corners, std::uint32_t point, std::uint32_t end) {
  for (unsigned k = 0; k < 3; ++k) {
    const std::uint32_t from = corners[k];
    const std::uint32_t to = corners[(k + 1) % 3];
    if ((from == point && to == end) || (from == end && to == point))
      return static_cast<std::uint8_t>(1U << k);
  }
  return 0;
}

/// Each edge along the crack belongs to a triangle of this side of it.
void own_edges(const Crack& crack, const std::vector<std::uint32_t>& side, Tables& t) {
  for (const std::uint32_t triangle : side) {
    const Corners corners = corners_of(t, triangle);
    for (const std::uint32_t end : corners) {
      if (end == crack.point || side_of(t, crack, {&end, 1}) != CrackSide::kBoth) continue;
      const auto owns = [&](std::uint32_t other) {
        return (t.triangles.own_edges[other] & edge_bit(corners_of(t, other), crack.point, end)) != 0;
      };
      if (std::none_of(side.begin(), side.end(), owns))
        t.triangles.own_edges[triangle] |= edge_bit(corners, crack.point, end);
    }
  }
}

/// A hook between points follows the triangles that have them all. One at the point stays with it.
void part_hooks(std::uint32_t object, const Crack& crack, Tables& t) {
  for (state::Hook& hook : t.hooks) {
    for (state::HookPlace* end : {&hook.a, &hook.b}) {
      if (end->particle_count < 2 || end->object != object) continue;
      const std::span particles = std::span(end->particle).first(end->particle_count);
      const auto own = std::find(particles.begin(), particles.end(), crack.point);
      if (own != particles.end() && side_of(t, crack, particles) == CrackSide::kMoved) *own = crack.added;
    }
  }
  ++t.hook_revision;
}

void move_corners(const Crack& crack, Tables& t) {
  for (const std::uint32_t triangle : crack.moved) {
    state::Triangles::Corners& c = t.triangles.corners[triangle];
    for (std::uint32_t* corner : {&c.a, &c.b, &c.c}) {
      if (*corner == crack.point) *corner = crack.added;
    }
  }
}

/// Index of a particle in the order of the maker.
std::uint32_t index_of(const Tables& t, const Deformable& cloth, std::uint32_t particle) {
  const auto first = t.particles.row_of.begin() + cloth.particles.first;
  const auto at = std::find(first, first + cloth.particles.count, particle - cloth.particles.first);
  HOOKE_ASSERT(at != first + cloth.particles.count);
  return static_cast<std::uint32_t>(at - first);
}

void split(std::uint32_t object, const Crack& crack, Tables& t) {
  const std::uint32_t from = index_of(t, t.objects[object], crack.point);
  add_particle(object, crack, t);
  part_springs(object, crack, t);
  part_bends(object, crack, t);
  own_edges(crack, crack.kept, t);
  own_edges(crack, crack.moved, t);
  part_hooks(object, crack, t);
  move_corners(crack, t);
  Deformable& cloth = t.objects[object];
  cloth.split_from.push_back(from);
  cloth.gas = 0;
  std::erase_if(t.element_contacts, [object](const state::ElementContact& c) { return c.object == object; });
  state::note_change(t, cloth);
}

}  // namespace

void tear_cloth(std::uint32_t object, double time, Tables& t, std::vector<ClothTearEvent>& events) {
  HOOKE_ASSERT(object < t.objects.size() && t.objects[object].surface.rest_points != nullptr);
  if (!any_strained(t, t.objects[object])) return;
  const std::vector<Candidate> candidates = find_candidates(t, t.objects[object]);
  std::vector<std::uint32_t> near;  // Points beside those that split in this step, which relieves them.
  std::size_t count = 0;
  for (const Candidate& candidate : candidates) {
    if (count == kMostTears) return;
    if (std::find(near.begin(), near.end(), candidate.particle) != near.end()) continue;
    const std::optional<Crack> crack = part_triangles(t, t.objects[object], candidate);
    if (!crack) continue;
    for (const std::vector<std::uint32_t>* side : {&crack->kept, &crack->moved}) {
      for (const std::uint32_t triangle : *side) {
        for (const std::uint32_t p : corners_of(t, triangle)) near.push_back(p);
      }
    }
    const Deformable& cloth = t.objects[object];
    const DVec3 offset = vector_cast<double>(t.particles.position[candidate.particle].x);
    events.push_back({.cloth = t.cloth_slots.id_of(cloth.slot),
                      .point = index_of(t, cloth, candidate.particle),
                      .added = cloth.particles.count,
                      .place = cloth.origin + offset,
                      .strain = static_cast<Real>(candidate.strain),
                      .time = time});
    split(object, *crack, t);
    ++count;
  }
}

}  // namespace hooke::build
