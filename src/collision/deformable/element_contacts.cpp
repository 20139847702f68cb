#include "collision/deformable/element_contacts.h"

#include "base/assert.h"
#include "collision/deformable/deformable_tuning.h"
#include "collision/distance/distance.h"
#include "collision/distance/protrusion_gap.h"
#include "collision/distance/shape_gap.h"
#include "geometry/closest.h"
#include "state/body_frames.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <tuple>

namespace hooke::collision {

namespace {

using state::ElementContact;

/// A segment of a rope, or a triangle of a cloth or one of its edges.
struct Element {
  std::uint32_t row = 0;
  std::uint32_t count = 0;
  std::array<std::uint32_t, 3> particle = {};
  std::uint32_t edge = 0;  ///< As in state::ElementContact.
};

Element triangle_at(const state::Tables& t, std::uint32_t row) {
  const auto [a, b, c] = t.triangles.corners[row];
  const auto [least, most] = std::minmax({a, b, c});
  return {row, 3, {least, a ^ b ^ c ^ least ^ most, most}};
}

template <class Visit>
void for_each_element(const state::Tables& t, const state::Deformable& object, Visit&& visit) {
  for (std::uint32_t i = 0; i < object.segments.count; ++i) {
    const std::uint32_t p = object.particles.first + i;
    visit(Element{object.segments.first + i, 2, {p, p + 1, p + 1}});
  }
  for (std::uint32_t row = object.triangles.first; row < object.triangles.end(); ++row)
    visit(triangle_at(t, row));
}

/// Visits the edges that a triangle owns; for a segment, the segment itself.
template <class Visit>
void for_each_edge(const state::Tables& t, const Element& e, Visit&& visit) {
  if (e.count == 2) return visit(e);
  const auto [a, b, c] = t.triangles.corners[e.row];
  const std::array<std::uint32_t, 4> around = {a, b, c, a};
  for (std::uint32_t k = 0; k < 3; ++k) {
    if ((t.triangles.own_edges[e.row] >> k & 1U) == 0) continue;
    const auto [low, high] = std::minmax(around[k], around[k + 1]);
    visit(Element{e.row, 2, {low, high, high}, k + 1});
  }
}

Real thinning_of(const state::Deformable& object) {
  return object.kind == PointRef::Kind::kRope ? kRopeThinning : kClothThinning;
}

/// By how much an element is thinner at a point than at its ends, over their radius.
Real thinning_at(const state::Deformable& object, const std::array<Real, 3>& weight) {
  Real between = Real(1);
  for (const Real w : weight) between -= w * w;
  return Real(2) * thinning_of(object) * between;
}

Vec3 position_of(const state::Tables& t, std::uint32_t particle) {
  return t.particles.position[particle].x;
}

/// The longest edge of the object's elements, squared.
Real longest_edge_squared(const state::Tables& t, const state::Deformable& object) {
  Real longest = Real(0);
  for_each_element(t, object, [&](const Element& e) {
    const Vec3 a = position_of(t, e.particle[0]);
    const Vec3 b = position_of(t, e.particle[1]);
    const Vec3 c = position_of(t, e.particle[2]);
    longest = std::max({longest, length_squared(b - a), length_squared(c - b), length_squared(a - c)});
  });
  return longest;
}

/// A half-space has nothing that could pass between points; compounds are present as their parts.
bool can_protrude(const state::ColliderShape& shape) {
  if (shape.shape.kind == ShapeKind::kMesh) return !shape.mesh->protrusions.ends.empty();
  return shape.shape.kind != ShapeKind::kHalfSpace && shape.shape.kind != ShapeKind::kCompound;
}

/// Least radius of curvature of the shape; 0 for an edge.
Real least_radius(const Shape& shape) {
  const bool is_round = shape.kind == ShapeKind::kSphere || shape.kind == ShapeKind::kCapsule;
  return is_round ? shape.radius : Real(0);
}

using Gaps = std::array<const ElementContactFinder::PointGap*, 3>;

/// Lower bound of the distance of the element from the shape: by the gradient at one of its points, or by the
/// mean of all gradients.
Real least_distance(const Gaps& gaps, std::uint32_t count, std::size_t when) {
  const auto at = [&](std::uint32_t of, std::uint32_t where) {
    return gaps[of]->distance[when] + dot(gaps[of]->normal[when], gaps[where]->x[when] - gaps[of]->x[when]);
  };
  constexpr Real kFar = std::numeric_limits<Real>::infinity();
  Real best = -kFar;
  Real mean = kFar;
  for (std::uint32_t i = 0; i < count; ++i) {
    Real least = kFar;
    Real sum = Real(0);
    for (std::uint32_t k = 0; k < count; ++k) {
      least = std::min(least, at(i, k));
      sum += at(k, i);
    }
    best = std::max(best, least);
    mean = std::min(mean, sum / static_cast<Real>(count));
  }
  return std::max(best, mean);
}

/// Finds the rows of one object and one shape.
class PairSearch {
 public:
  PairSearch(const state::Tables& tables, const ElementContactQuery& query, std::size_t index,
             Real longest_edge, ElementContactFinder& finder)
      : t_(tables),
        query_(query),
        object_(tables.objects[query.object]),
        collider_(query.colliders[index]),
        body_(tables.colliders.body[collider_]),
        frame_(query.frames[index]),
        longest_edge_(longest_edge),
        finder_(finder) {}

  void run() {
    ++finder_.pass;
    fall_ = length(t_.desc.gravity) * query_.step * query_.step;
    const Real reach = query_.reach + frame_.speed * query_.step;
    held_ = was_held();
    near_ = {frame_.box.lower - Vec3{reach, reach, reach}, frame_.box.upper + Vec3{reach, reach, reach}};
    const auto first = static_cast<std::ptrdiff_t>(finder_.contacts.size());
    for_each_element(t_, object_, [&](const Element& e) { search_element(e); });
    if (is_supported_by_points())
      finder_.contacts.erase(finder_.contacts.begin() + first, finder_.contacts.end());
  }

 private:
  /// Whether an element held the shape in the step before.
  [[nodiscard]] bool was_held() const {
    const auto pair_of = [](const ElementContact& row) { return std::pair(row.object, row.collider); };
    const std::pair pair = {query_.object, collider_};
    const std::vector<ElementContact>& rows = t_.element_contacts;
    auto row = std::lower_bound(rows.begin(), rows.end(), pair,
                                [&](const ElementContact& r, const auto& p) { return pair_of(r) < p; });
    while (row != rows.end() && pair_of(*row) == pair && !row->joined) ++row;
    return row != rows.end() && pair_of(*row) == pair;
  }

  /// Whether points alone hold the body, because it is wide compared with the cloth's meshes, or near to many
  /// elements. Elements that hold a body are not dropped because it comes near to more of them: it would be
  /// through the cloth when they come back.
  [[nodiscard]] bool is_supported_by_points() const {
    if (object_.triangles.count == 0 || !is_dynamic(t_.bodies, body_)) return false;
    const bool is_wide = t_.bodies.traits[body_].radius > longest_edge_;
    return (is_wide && near_points_ >= kSupportingPoints) || (!held_ && near_elements_ > kMostNearElements);
  }

  void search_element(Element e) {
    if (is_supported_by_points()) return;
    const geometry::Box box = geometry::box_of(position_of(t_, e.particle[0]), position_of(t_, e.particle[1]),
                                               position_of(t_, e.particle[2]));
    if (!overlap(near_, box)) return;
    Real radius = std::numeric_limits<Real>::infinity();
    Real displacement = Real(0);
    bool any_free = is_dynamic(t_.bodies, body_);
    for (std::uint32_t i = 0; i < e.count; ++i) {
      const state::VelocityRecord& record = t_.particles.velocity[e.particle[i]];
      radius = std::min(radius, t_.particles.position[e.particle[i]].radius);
      displacement = std::max(displacement, Real(2) * length(record.v) * query_.step + fall_);
      any_free = any_free || record.inverse_mass > Real(0);
    }
    const Real reach = radius + displacement + frame_.speed * query_.step + kParticleMargin;
    const Vec3 all = {reach, reach, reach};
    if (!overlap(frame_.box, geometry::Box{box.lower - all, box.upper + all}) || !any_free) return;
    if (frame_.shape->shape.kind == ShapeKind::kMesh) {
      search_mesh(e, radius, reach);
    } else {
      search_shape(e, radius, reach);
    }
  }

  void search_shape(const Element& e, Real radius, Real reach) {
    Gaps gaps = {};
    for (std::uint32_t i = 0; i < e.count; ++i) gaps[i] = &gap_of(e.particle[i]);
    const Real distance = least_distance(gaps, e.count, 0);
    if (distance > reach) return;
    const Real most = kElementSearchShare * thinning_of(object_) * radius;
    if (!protrudes(gaps, e.count, 0, most) && !protrudes(gaps, e.count, 1, most)) return;
    if (is_hooked_to(e)) return;
    near_elements_ += distance < radius + kParticleMargin ? 1 : 0;
    add_row(e, 0);
  }

  /// Gradients give no bounds for a mesh: how far its ridges and peaks protrude is measured at them.
  void search_mesh(const Element& e, Real radius, Real reach) {
    const state::Mesh& mesh = *frame_.shape->mesh;
    const auto corner = [&](std::uint32_t i) { return frame_.to_shape(position_of(t_, e.particle[i])); };
    const geometry::Box box = geometry::box_of(corner(0), corner(1), corner(2));
    const Vec3 all = {reach, reach, reach};
    geometry::find_triangles(mesh.bvh, {box.lower - all, box.upper + all}, finder_.triangles);
    if (e.count == 3) search_protrusions(e, radius, reach);
    for_each_edge(t_, e, [&](const Element& edge) { search_protrusions(edge, radius, reach); });
  }

  void search_protrusions(const Element& e, Real radius, Real reach) {
    const state::Mesh& mesh = *frame_.shape->mesh;
    std::array<Vec3, 3> corner = {};
    Real displacement = Real(0);
    for (std::uint32_t i = 0; i < e.count; ++i) {
      const Vec3 x = position_of(t_, e.particle[i]);
      const Vec3 surface = state::velocity_at(t_.bodies, body_, x - frame_.center);
      corner[i] = frame_.to_shape(x);
      displacement =
          std::max(displacement, query_.step * length(t_.particles.velocity[e.particle[i]].v - surface));
    }
    const bool is_fast = displacement > kElementSearchShare * thinning_of(object_) * radius;
    Real nearest = Real(-1);
    for (const std::uint32_t triangle : finder_.triangles) {
      const std::uint32_t end = mesh.protrusions.triangle_begin[triangle + 1];
      for (std::uint32_t i = mesh.protrusions.triangle_begin[triangle]; i < end; ++i) {
        if (e.count == 3 && !mesh.protrusions.is_peak(i)) continue;
        const ProtrusionSearch found = find_protrusion_gap(mesh, i, std::span(corner).first(e.count));
        if (found.clearance > reach) continue;
        if (!is_fast) {
          if (!found.gap) continue;
          if (nearest < Real(0)) nearest = nearest_point(e, corner, reach);
          const Real most =
              kElementSearchShare * thinning_at(object_, found.gap->weight) * radius - displacement;
          if (!(nearest - found.gap->distance > most)) continue;
        }
        if (is_hooked_to(e)) return;
        add_row(e, i);
      }
    }
  }

  /// Distance of the nearest of an element's points from the mesh, or `reach`.
  [[nodiscard]] Real nearest_point(const Element& e, const std::array<Vec3, 3>& corner, Real reach) const {
    Real least = reach;
    for (std::uint32_t i = 0; i < e.count; ++i)
      least = std::min(least, distance_to_mesh(*frame_.shape->mesh, corner[i], reach));
    return least;
  }

  [[nodiscard]] bool is_hooked_to(const Element& e) const {
    return std::any_of(e.particle.begin(), e.particle.begin() + e.count,
                       [&](std::uint32_t p) { return is_hooked(query_.hooked, p, body_); });
  }

  void add_row(const Element& e, std::uint32_t feature) {
    HOOKE_ASSERT(std::adjacent_find(e.particle.begin(), e.particle.begin() + e.count,
                                    std::greater_equal<>()) == e.particle.begin() + e.count);
    finder_.contacts.push_back(
        {.object = query_.object,
         .collider = collider_,
         .element = e.row,
         .edge = e.edge,
         .feature = feature,
         .body = body_,
         .count = e.count,
         .particle = e.particle,
         .friction = std::sqrt(object_.friction * t_.colliders.surface[collider_].friction)});
  }

  /// Whether the element is nearer than its nearest point by more than `most`.
  [[nodiscard]] bool protrudes(const Gaps& gaps, std::uint32_t count, std::size_t when, Real most) const {
    Real nearest = gaps[0]->distance[when];
    Vec3 sum = gaps[0]->x[when];
    for (std::uint32_t i = 1; i < count; ++i) {
      nearest = std::min(nearest, gaps[i]->distance[when]);
      sum += gaps[i]->x[when];
    }
    if (!(nearest - least_distance(gaps, count, when) > most)) return false;
    // Over a curve the gradients at the points give twice the true protrusion.
    const Vec3 middle = (Real(1) / static_cast<Real>(count)) * sum;
    const Gap gap = gap_to_shape(*frame_.shape, middle);
    Real least = std::numeric_limits<Real>::infinity();
    for (std::uint32_t i = 0; i < count; ++i)
      least = std::min(least, gap.distance + dot(gap.normal, gaps[i]->x[when] - middle));
    return nearest - least > most;
  }

  /// A point that would enter the shape is taken to slide along it.
  const ElementContactFinder::PointGap& gap_of(std::uint32_t particle) {
    HOOKE_ASSERT(particle - object_.particles.first < finder_.gaps.size());
    ElementContactFinder::PointGap& of = finder_.gaps[particle - object_.particles.first];
    if (of.pass == finder_.pass) return of;
    of.pass = finder_.pass;
    const state::PositionRecord& at = t_.particles.position[particle];
    const Vec3 surface = state::velocity_at(t_.bodies, body_, at.x - frame_.center);
    Vec3 displacement = query_.step * frame_.to_shape_direction(t_.particles.velocity[particle].v - surface);
    of.x[0] = frame_.to_shape(at.x);
    const Gap now = gap_to_shape(*frame_.shape, of.x[0]);
    const Real free_distance = std::max(now.distance - at.radius, Real(0));
    const Real into = -dot(now.normal, displacement) - free_distance;
    if (into > Real(0)) displacement += into * now.normal;
    of.x[1] = of.x[0] + displacement;
    const Gap then = gap_to_shape(*frame_.shape, of.x[1]);
    of.distance = {now.distance, then.distance};
    of.normal = {now.normal, then.normal};
    near_points_ += std::min(now.distance, then.distance) < Real(2) * at.radius ? 1 : 0;
    return of;
  }

  const state::Tables& t_;
  const ElementContactQuery& query_;
  const state::Deformable& object_;
  std::uint32_t collider_, body_;
  const Frame& frame_;
  Real longest_edge_;  ///< Longest edge of the object [m].
  ElementContactFinder& finder_;
  Real fall_ = Real(0);
  geometry::Box near_ = {};  ///< Elements outside this box stay away from the shape.
  bool held_ = false;        ///< An element held the shape in the step before.
  int near_elements_ = 0;    ///< Number of near elements that have rows.
  int near_points_ = 0;      ///< Number of points that touch now or at the end of the step, or nearly.
};

/// Marks whether the rows of the last object, from `first` on, are few.
void mark_few(const state::Tables& t, std::size_t first, std::vector<ElementContact>& contacts) {
  const std::span<ElementContact> rows = std::span(contacts).subspan(first);
  const auto pressed = std::count_if(
      rows.begin(), rows.end(), [&](const ElementContact& row) { return is_dynamic(t.bodies, row.body); });
  for (ElementContact& row : rows) row.few = pressed <= kFewElementContacts;
}

auto key_of(const ElementContact& row) {
  return std::tie(row.object, row.collider, row.element, row.edge, row.feature);
}

void leave(ElementContact& row) {
  row.separation = kNoContact;
  row.normal_force = Real(0);
  row.friction_force = {};
}

/// Displacements of an element's points relative to the body within a substep [m].
struct Displacements {
  std::array<Vec3, 3> displacement = {};
  Real longest = Real(0);
};

Displacements displacements_of(const state::Tables& t, const ElementContact& row, Vec3 center, Real h) {
  Displacements displacements;
  for (std::uint32_t i = 0; i < 3; ++i) {
    const std::uint32_t p = row.particle[std::min(i, row.count - 1)];
    const Vec3 surface = state::velocity_now(t.bodies, row.body, position_of(t, p) - center);
    displacements.displacement[i] = h * (t.particles.velocity[p].v - surface);
    displacements.longest = std::max(displacements.longest, length(displacements.displacement[i]));
  }
  return displacements;
}

/// Whether the two cannot have met since their distance was found, and will not within `h`.
bool stay_apart(const state::Tables& t, Real h, ElementContact& row) {
  if (!(row.clearance > Real(0))) return false;
  const Vec3 center =
      vector_cast<Real>(state::pose_now(t.bodies, row.body).position - t.objects[row.object].origin);
  const Real displacement = Real(2) * displacements_of(t, row, center, h).longest + kElementApartSpeed * h;
  row.clearance -= displacement;
  return row.clearance > displacement;
}

/// The update of one row. Positions are offsets from the element's first point.
class RowUpdate {
 public:
  RowUpdate(state::Tables& tables, ElementContact& row, Real h)
      : t_(tables),
        row_(row),
        frame_(frame_of(tables, row.collider, tables.objects[row.object])),
        origin_(position_of(tables, row.particle[0])),
        shape_{.shape = frame_.shape->shape,
               .center = frame_.offset - origin_,
               .axes = matrix_of(normalize(frame_.rotation)),
               .hull = frame_.shape->hull.get()} {
    const Displacements displacements = displacements_of(t_, row, frame_.center, h);
    displacement_ = displacements.displacement;
    longest_displacement_ = displacements.longest;
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint32_t p = row.particle[std::min(i, row.count - 1)];
      corner_[i] = position_of(t_, p) - origin_;
      radius_ = std::min(radius_, t_.particles.position[p].radius);
    }
  }

  void run() {
    const Vec3 before = row_.normal;
    const bool known = before != Vec3{};
    if (find(Real(0))) {
      advance();
      if (!known && body_is_dynamic() && row_.separation < -kDeepestNewOverlap * radius_) reset();
    } else if (overlap_ && (known || !body_is_dynamic())) {
      find_deepest(known);
    } else {
      leave(row_);
    }
    const bool changed_direction = dot(row_.normal, before) < kElementSameSide;
    if (changed_direction) row_.normal_force = Real(0);
    if (changed_direction) row_.friction_force = {};
    if (row_.separation < kNoContact && !gives_way()) leave(row_);
    row_.joined = row_.joined || row_.separation < kNoContact;
    set_surface();
  }

 private:
  /// Thickness of the element at the row's position.
  [[nodiscard]] Real thickness() const {
    return (Real(1) - thinning_at(t_.objects[row_.object], row_.weight)) * radius_;
  }

  /// Resets the row: a body that overlaps from the start has no side yet on which it belongs.
  void reset() {
    leave(row_);
    row_.normal = {};
  }

  [[nodiscard]] Convex element_at(Real share) const {
    Convex element = {.shape = {.kind = ShapeKind::kMesh}};
    for (std::size_t i = 0; i < 3; ++i) element.corners[i] = corner_[i] + share * displacement_[i];
    return element;
  }

  /// Finds the position, normal and separation after a share of the displacement. Returns false if the two
  /// are too far apart to meet, or overlap.
  bool find(Real share) {
    if (frame_.shape->shape.kind == ShapeKind::kMesh) return find_at_protrusion(share);
    const Convex element = element_at(share);
    const Real enough = radius_ + Real(2) * longest_displacement_;
    const Distance found = distance_between(element, shape_, enough + kParticleMargin);
    overlap_ = found.cores_overlap && !any_point_inside();
    row_.clearance = found.cores_overlap ? Real(0) : found.distance - radius_;
    if (found.cores_overlap || found.normal == Vec3{} || found.distance > enough) return false;
    row_.normal = -found.normal;
    const auto& [a, b, c] = element.corners;
    if (row_.count == 2) {
      const Real along = geometry::closest_on_segment(found.point_a, a, b).fraction;
      row_.weight = {Real(1) - along, along, Real(0)};
    } else {
      const Vec3 w = geometry::closest_on_triangle(found.point_a, a, b, c).weights;
      row_.weight = {w.x, w.y, w.z};
    }
    row_.separation = found.distance - thickness();
    return true;
  }

  /// Does the same at a ridge or a peak of a mesh. An element can be behind it only if it has just come
  /// there, or by about the skin's depth: farther in, other sides of the mesh are nearer.
  bool find_at_protrusion(Real share) {
    const state::Mesh& mesh = *frame_.shape->mesh;
    std::array<Vec3, 3> corner = {};
    for (std::size_t i = 0; i < row_.count; ++i)
      corner[i] = frame_.to_shape(origin_ + corner_[i] + share * displacement_[i]);
    auto [gap, clearance] =
        find_protrusion_gap(mesh, row_.feature, std::span<const Vec3>(corner).first(row_.count));
    row_.clearance = clearance - radius_;
    if (!gap || gap->distance > radius_ + Real(2) * longest_displacement_) return false;
    Vec3 normal = frame_.to_world(gap->normal);
    const bool acts = row_.separation < kNoContact && row_.normal != Vec3{};
    const bool flips = acts && dot(normal, row_.normal) < -kElementSameSide;  // around the end of a surface
    if (flips) normal = -normal;
    if (flips) gap->distance = -gap->distance;
    const bool is_deep = gap->distance < -kDeepestNewOverlap * radius_;
    if (is_deep && !(acts && dot(normal, row_.normal) > kElementSameSide)) return false;
    if (gap->distance < Real(0) && !flips && !(distance_to_mesh(mesh, gap->place, radius_) < Real(0)))
      return false;
    row_.normal = normal;
    row_.weight = gap->weight;
    row_.separation = gap->distance - thickness();
    return true;
  }

  /// Advances to where they meet, as gap_along_displacement does for particles
  /// (collision/deformable/particle_contacts.cpp).
  void advance() {
    Real share = Real(0);
    for (int i = 0; i < kElementAdvanceRounds && share < Real(1); ++i) {
      Real closing_distance = Real(0);
      for (const Vec3 displacement : displacement_)
        closing_distance = std::max(closing_distance, -dot(row_.normal, displacement));
      const bool in_contact = !(row_.separation > kElementTouchingShare * radius_);
      if (in_contact || !(closing_distance * (Real(1) - share) > row_.separation)) break;
      share = std::min(share + row_.separation / closing_distance, Real(1));
      const ElementContact before = row_;
      if (find(share)) continue;
      row_ = before;
      break;
    }
    if (share == Real(0)) return;
    for (std::size_t i = 0; i < row_.count; ++i)
      row_.separation -= share * row_.weight[i] * dot(row_.normal, displacement_[i]);
  }

  /// Whether a point is inside: such a point is pushed out by itself.
  [[nodiscard]] bool any_point_inside() const {
    for (std::uint32_t i = 0; i < row_.count; ++i) {
      const Vec3 x = frame_.to_shape(origin_ + corner_[i]);
      if (gap_to_shape(*frame_.shape, x).distance < Real(0)) return true;
    }
    return false;
  }

  [[nodiscard]] Gap gap_at(Real b, Real c) const {
    const Vec3 x = corner_[0] + b * (corner_[1] - corner_[0]) + c * (corner_[2] - corner_[0]);
    return gap_to_shape(*frame_.shape, frame_.to_shape(origin_ + x));
  }

  /// Position between 0 and `end` of the least `value`, which is convex. Searches by thirds, to 1e-3 of the
  /// interval.
  template <class Value>
  static Real least_of(Real end, const Value& value) {
    Real low = Real(0);
    Real high = end;
    for (int i = 0; i < kDeepestPointRounds; ++i) {
      const Real third = (high - low) / Real(3);
      if (value(low + third) <= value(high - third)) {
        high -= third;
      } else {
        low += third;
      }
    }
    return Real(0.5) * (low + high);
  }

  /// For a shape that crosses the element, finds its deepest point. The normal stays the one by which it came
  /// if that is `known`, otherwise it is the nearest way out.
  void find_deepest(bool known) {
    const auto along = [&](Real b) {
      return row_.count == 2 ? Real(0) : least_of(Real(1) - b, [&](Real c) { return gap_at(b, c).distance; });
    };
    const Real b = least_of(Real(1), [&](Real at) { return gap_at(at, along(at)).distance; });
    const Real c = along(b);
    row_.weight = {Real(1) - b - c, b, c};
    if (!known) row_.normal = frame_.to_world(gap_at(b, c).normal);
    row_.separation = separation_along(element_at(Real(0)), shape_, -row_.normal) - thickness();
  }

  /// Holds for a sleeping body too: it stays as it lies, and what it overlaps does not throw it.
  [[nodiscard]] bool body_is_dynamic() const { return is_dynamic(t_.bodies, row_.body); }
  [[nodiscard]] bool pushes_body() const { return state::gives_way(t_.bodies, row_.body); }

  [[nodiscard]] bool gives_way() const {
    if (pushes_body()) return true;
    Real share = Real(0);
    for (std::uint32_t i = 0; i < row_.count; ++i) {
      if (t_.particles.velocity[row_.particle[i]].inverse_mass > Real(0)) share += row_.weight[i];
    }
    return share >= kLeastFreeShare;
  }

  void set_surface() {
    Vec3 place = origin_;
    for (std::uint32_t i = 0; i < row_.count; ++i) place += row_.weight[i] * corner_[i];
    const Vec3 belt = frame_.belt_velocity;
    row_.lever = place - frame_.center;
    row_.belt_velocity = belt - dot(belt, row_.normal) * row_.normal;
    row_.surface_velocity = state::velocity_now(t_.bodies, row_.body, row_.lever) + row_.belt_velocity;
  }

  state::Tables& t_;
  ElementContact& row_;
  Frame frame_;
  Vec3 origin_;
  Convex shape_;
  std::array<Vec3, 3> corner_ = {};
  std::array<Vec3, 3> displacement_ = {};  ///< Displacement relative to the body within the substep [m].
  Real longest_displacement_ = Real(0);
  Real radius_ = std::numeric_limits<Real>::infinity();
  bool overlap_ = false;  ///< The shape crosses the element, and no point is inside.
};

}  // namespace

void find_element_contacts(const state::Tables& t, const ElementContactQuery& query,
                           ElementContactFinder& finder) {
  const state::Deformable& object = t.objects[query.object];
  if (object.segments.count + object.triangles.count == 0) return;
  const std::size_t first = finder.contacts.size();
  Real longest = Real(-1);
  for (std::size_t i = 0; i < query.colliders.size(); ++i) {
    const Shape& shape = query.frames[i].shape->shape;
    if (!can_protrude(*query.frames[i].shape)) continue;
    if (longest < Real(0)) {
      longest = longest_edge_squared(t, object);
      // Pass 0 means none. When the count wraps around, gaps of earlier passes must not count as new.
      if (finder.pass > 0xF0000000) finder.gaps.clear(), finder.pass = 0;
      if (finder.gaps.size() < object.particles.count) finder.gaps.resize(object.particles.count);
    }
    // An edge of length l that is inscribed into a ball of radius R is l^2 / 8 R deep in it, and an
    // equilateral triangle 4/3 of that. A triangle is thinner by the same factor.
    const Real radius = t.particles.position[object.particles.first].radius;
    const Real most = (object.segments.count > 0 ? kRopeGentleDepth : kClothGentleDepth) * radius;
    if (longest < Real(8) * least_radius(shape) * most) continue;
    PairSearch(t, query, i, std::sqrt(longest), finder).run();
  }
  mark_few(t, first, finder.contacts);
}

void carry_element_forces(std::span<const ElementContact> from, std::span<ElementContact> to) {
  auto old = from.begin();
  for (ElementContact& row : to) {
    while (old != from.end() && key_of(*old) < key_of(row)) ++old;
    if (old == from.end()) return;
    if (key_of(*old) != key_of(row)) continue;
    row.weight = old->weight;
    row.normal = old->normal;
    row.separation = old->separation;
    row.normal_force = old->normal_force;
    row.friction_force = old->friction_force;
    row.joined = row.joined || old->separation < kNoContact;
  }
}

void update_element_contacts(parallel::Range range, Real h, state::Tables& t) {
  for (ElementContact& row : std::span(t.element_contacts).subspan(range.begin, range.count())) {
    if (stay_apart(t, h, row)) {
      leave(row);
    } else {
      RowUpdate(t, row, h).run();
    }
  }
}

}  // namespace hooke::collision
