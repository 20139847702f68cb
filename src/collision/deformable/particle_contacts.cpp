#include "collision/deformable/particle_contacts.h"

#include "base/assert.h"
#include "base/sort_unique.h"
#include "base/take_turns.h"
#include "collision/deformable/contact_frames.h"
#include "collision/deformable/deformable_tuning.h"
#include "collision/deformable/element_contacts.h"
#include "collision/distance/protrusion_gap.h"
#include "collision/distance/shape_gap.h"
#include "geometry/box.h"
#include "state/body_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace hooke::collision {

namespace {

struct Key {
  std::uint32_t particle, collider, feature;

  // NOLINTNEXTLINE(modernize-use-nullptr): version 14 takes the comparison with 0 for a pointer's
  friend auto operator<=>(const Key&, const Key&) = default;
};

Key key_of(const state::Contacts& contacts, std::size_t row) {
  return {contacts.particle[row], contacts.collider[row], contacts.feature[row]};
}

void append(state::Contacts& contacts, Key key, std::uint32_t object, std::uint32_t body, Real friction) {
  contacts.particle.push_back(key.particle);
  contacts.collider.push_back(key.collider);
  contacts.feature.push_back(key.feature);
  contacts.object.push_back(object);
  contacts.body.push_back(body);
  contacts.friction.push_back(friction);
  contacts.normal.push_back({});
  contacts.separation.push_back(Real(0));
  contacts.lever.push_back({});
  contacts.belt_velocity.push_back({});
  contacts.surface_velocity.push_back({});
  contacts.normal_force.push_back(Real(0));
  contacts.friction_force.push_back({});
  contacts.coupled.push_back(0);
}

}  // namespace

struct ParticleContactScratch::Buffers {
  std::vector<std::uint32_t> colliders;  // colliders that particles may touch
  std::vector<Hooked> hooked;
  std::vector<HookedNear> hooked_near;
  std::vector<std::uint32_t> near;       // colliders near one object
  std::vector<Frame> frames;             // frames of those
  std::vector<std::uint32_t> triangles;  // triangles of one query
  state::Contacts contacts;              // those found; then those of the step before
  std::vector<TriangleGap> gaps;         // one for each contact with a mesh
  ElementContactFinder element_finder;
};

namespace {

using Finder = ParticleContactScratch::Buffers;

/// A particle that may touch something within the step.
struct MovingParticle {
  std::uint32_t particle = 0;
  std::uint32_t object = 0;  ///< Row of its object.
  Real reach = Real(0);      ///< Its radius and its displacement within the step [m].
};

/// Appends the rows of one particle against one shape, which moves for `step` seconds.
void find_pair(const state::Tables& t, const MovingParticle& moving, std::uint32_t collider,
               const Frame& frame, Real step, Finder& finder) {
  const state::ColliderShape& shape = *frame.shape;
  const std::uint32_t body = t.colliders.body[collider];
  const Vec3 place = t.particles.position[moving.particle].x;
  const Real reach = moving.reach + frame.speed * step + kParticleMargin;
  const Vec3 reach_to_all = {reach, reach, reach};
  if (!overlap(frame.box, geometry::Box{place - reach_to_all, place + reach_to_all})) return;
  if (is_hooked(finder.hooked, moving.particle, body)) return;
  const Vec3 x = frame.to_shape(place);
  const Real friction = std::sqrt(t.objects[moving.object].friction * t.colliders.surface[collider].friction);
  const auto append_feature = [&](std::uint32_t feature) {
    append(finder.contacts, {moving.particle, collider, feature}, moving.object, body, friction);
  };
  if (shape.shape.kind != ShapeKind::kMesh) {
    if (gap_to_shape(shape, x).distance <= reach) append_feature(0);
    return;
  }
  find_triangles_near(*shape.mesh, x, reach, finder.triangles);
  for (const std::uint32_t triangle : finder.triangles) append_feature(triangle);
  const geometry::Protrusions& protrusions = shape.mesh->protrusions;
  const auto faces = static_cast<std::uint32_t>(shape.mesh->desc.triangles.size());
  for (const std::uint32_t triangle : finder.triangles) {
    const std::uint32_t end = protrusions.triangle_begin[triangle + 1];
    for (std::uint32_t i = protrusions.triangle_begin[triangle]; i < end; ++i) {
      if (find_protrusion_gap(*shape.mesh, i, std::span(&x, 1)).clearance <= reach) append_feature(faces + i);
    }
  }
}

/// Carries the forces over. Rows of both tables stand in order of their keys, so one walk is enough.
void carry_forces(const state::Contacts& from, state::Contacts& to) {
  std::size_t old = 0;
  for (std::size_t row = 0; row < to.particle.size(); ++row) {
    const Key key = key_of(to, row);
    while (old < from.particle.size() && key_of(from, old) < key) ++old;
    if (old == from.particle.size()) return;
    if (key_of(from, old) != key) continue;
    to.normal_force[row] = from.normal_force[old];
    to.friction_force[row] = from.friction_force[old];
  }
}

/// Both tables get room for as many rows as either has had, because they are swapped.
void take_turns(state::Contacts& found, state::Contacts& before) {
  std::size_t room = 0;
  const auto measure = [&](const auto& column) { room = std::max(room, column.capacity()); };
  const auto reserve = [&](auto& column) { column.reserve(room); };
  state::Contacts::for_each_column(found, measure);
  state::Contacts::for_each_column(before, measure);
  state::Contacts::for_each_column(found, reserve);
  state::Contacts::for_each_column(before, reserve);
  std::swap(found, before);
}

void set_row(state::Contacts& contacts, std::size_t row, const Frame& frame, Gap gap, Real radius) {
  contacts.normal[row] = frame.to_world(gap.normal);
  contacts.separation[row] = gap.distance - radius;
}

/// Returns the gap at x. If a sphere there would meet the shape on its `displacement`, returns the gap where
/// it meets it, less that part of the displacement: a plane that is right when it is touched. Uses
/// conservative advancement with a bounded number of rounds; a sphere that has not met the shape by then is
/// taken where it is.
Gap gap_along_displacement(const state::ColliderShape& shape, Vec3 x, Vec3 displacement, Real radius) {
  Gap gap = gap_to_shape(shape, x);
  const Real displacement_length = length(displacement);
  const Real near = Real(0.01) * radius;
  if (!(gap.distance - radius > near) || !(-dot(gap.normal, displacement) > gap.distance - radius))
    return gap;
  Real share = Real(0);
  for (int i = 0; i < kParticleAdvanceRounds && gap.distance - radius > near && share < Real(1); ++i) {
    share = std::min(share + (gap.distance - radius) / displacement_length, Real(1));
    gap = gap_to_shape(shape, x + share * displacement);
  }
  gap.distance -= share * dot(gap.normal, displacement);
  return gap;
}

/// Sets where forces between the two act and how the body moves there, `velocity`. They act at the particle's
/// center, `arm` from the body's: a particle has no rotation that could take the torque of friction at its
/// surface.
void set_surface(state::Contacts& contacts, std::size_t row, Vec3 arm, Vec3 velocity, Vec3 belt_velocity) {
  const Vec3 n = contacts.normal[row];
  contacts.lever[row] = arm;
  contacts.belt_velocity[row] = belt_velocity - dot(belt_velocity, n) * n;
  contacts.surface_velocity[row] = velocity + contacts.belt_velocity[row];
}

/// The gap to the face of a triangle, or to a ridge or a peak, whose numbers follow the triangles. A ridge or
/// a peak acts on a point that is in front and to which no part of the mesh around is nearer.
TriangleGap gap_to_feature(const state::Mesh& mesh, std::uint32_t feature, Vec3 x) {
  const auto faces = static_cast<std::uint32_t>(mesh.desc.triangles.size());
  if (feature < faces) return gap_to_triangle(mesh, feature, x);
  constexpr Real kNotNearest = std::numeric_limits<Real>::infinity();  // a triangle beside it is as near
  const auto found = find_protrusion_gap(mesh, feature - faces, std::span(&x, 1)).gap;
  if (!found || !(found->distance > Real(0))) return {{}, false, kNotNearest};
  return {{found->distance, found->normal}, true, kNotNearest};
}

/// Moves the forces of the rows from `first` to `end` that no longer act to the nearest one that does: the
/// particle has moved on from triangle to triangle.
void move_forces(state::Contacts& contacts, std::size_t first, std::size_t end) {
  std::size_t successor = first;
  for (std::size_t i = first; i < end; ++i) {
    if (contacts.separation[i] < contacts.separation[successor]) successor = i;
  }
  for (std::size_t i = first; i < end; ++i) {
    if (contacts.separation[i] < kNoContact) continue;
    const Real normal_force = std::exchange(contacts.normal_force[i], Real(0));
    const Vec3 friction_force = std::exchange(contacts.friction_force[i], {});
    if (!(contacts.separation[successor] < kNoContact)) continue;
    contacts.normal_force[successor] += normal_force;
    contacts.friction_force[successor] += friction_force;
  }
}

/// Rows from `first` on are features of one mesh near one particle, `gaps` away from it. The nearest triangle
/// says whether the particle is inside; then it alone pushes out. Outside, every feature acts that is nearer
/// than those around it. So nothing of the mesh is met too late, and sliding over the edges between triangles
/// of a flat mesh is not felt. Right above such an edge the nearest triangle acts. A mesh that can tell
/// whether it holds the particle says so in `known`.
void update_mesh_rows(state::Contacts& contacts, std::size_t first, std::span<const TriangleGap> gaps,
                      std::optional<bool> known, const Frame& frame, Real radius) {
  HOOKE_ASSERT(!gaps.empty() && first + gaps.size() <= contacts.separation.size());
  std::size_t nearest = 0;
  Real least = std::numeric_limits<Real>::infinity();
  bool any_holds = false;
  bool inside = false;
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    const TriangleGap& g = gaps[i];
    any_holds = any_holds || (g.over_face && g.gap.distance >= Real(0));
    // Of equally near triangles, one that is below the particle is chosen, not one beside it.
    const bool better = g.unsigned_distance < least || (g.unsigned_distance == least && g.over_face);
    nearest = better ? i : nearest;
    least = better ? g.unsigned_distance : least;
    inside = better ? g.gap.distance < Real(0) : inside;
  }
  inside = known.value_or(inside);
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    const TriangleGap& g = gaps[i];
    const bool holds = g.over_face ? g.gap.distance >= Real(0) : !any_holds && i == nearest;
    const bool active = inside ? i == nearest : holds;
    set_row(contacts, first + i, frame, gap_on_side(g, known), radius);
    if (!active) contacts.separation[first + i] = kNoContact;
  }
  move_forces(contacts, first, first + gaps.size());
}

}  // namespace

ParticleContactScratch::ParticleContactScratch() : buffers_(std::make_unique<Buffers>()) {}
ParticleContactScratch::~ParticleContactScratch() = default;
ParticleContactScratch::ParticleContactScratch(ParticleContactScratch&&) noexcept = default;
ParticleContactScratch& ParticleContactScratch::operator=(ParticleContactScratch&&) noexcept = default;

void note_hooked_points(const state::Tables& t, state::Hook& hook) {
  hook.inside.clear();
  const std::uint32_t body = hook.other_end().body;
  if (!hook.holds_point() || body == state::HookPlace::kWorld || !is_solid(t, body)) return;
  const state::Deformable& object = t.objects[hook.point_end().object];
  if (hook.collide && (object.tetrahedra.count == 0 || hook.kind != HookKind::kBall)) return;
  if (hook.collide) hook.rest_distance = kRigid;
  for (const std::uint32_t c : colliders_of(t.bodies, body)) {
    const Frame frame = frame_of(t, c, object);
    for (std::uint32_t i = 0; i < object.particles.count; ++i) {
      const state::PositionRecord& at = t.particles.position[object.particles.first + i];
      const Real distance = distance_to(frame, at.x, at.radius);
      if (distance < (hook.collide ? Real(0) : Real(0.5) * at.radius)) {
        hook.inside.push_back(i);
      } else if (hook.collide) {
        hook.rest_distance = std::min(hook.rest_distance, distance);
      }
    }
  }
  base::sort_unique(hook.inside);
}

void find_contacts(double dt, ParticleContactScratch& scratch, state::Tables& t) {
  const auto step = static_cast<Real>(dt);
  const Real fall = length(t.desc.gravity) * step * step;
  const auto displacement_of = [&](std::uint32_t p) {
    return Real(2) * length(t.particles.velocity[p].v) * step + fall;
  };
  Finder& finder = scratch.buffers();
  auto& [colliders, hooked, hooked_near, near, frames, triangles, contacts, gaps, element_finder] = finder;
  list_solid_colliders(t, colliders);
  list_hooked(t, hooked);
  list_hooked_near(t, hooked_near);
  state::Contacts::for_each_column(contacts, [](auto& column) { column.clear(); });
  element_finder.contacts.clear();
  for (std::uint32_t o = 0; !colliders.empty() && o < t.objects.size(); ++o) {
    const state::Rows particles = t.objects[o].particles;
    Real reach = Real(0);
    for (std::uint32_t p = particles.first; p < particles.end(); ++p)
      reach = std::max(reach, t.particles.position[p].radius + displacement_of(p) + kParticleMargin);
    list_near_colliders(t, colliders, t.objects[o], reach, near);
    make_frames(t, near, t.objects[o], frames);
    for (std::uint32_t p = particles.first; p < particles.end() && !near.empty(); ++p) {
      const MovingParticle moving = {p, o, t.particles.position[p].radius + displacement_of(p)};
      for (std::size_t i = 0; i < near.size(); ++i) find_pair(t, moving, near[i], frames[i], step, finder);
    }
    if (!near.empty()) find_element_contacts(t, {o, near, frames, hooked, step, reach}, element_finder);
  }
  carry_element_forces(t.element_contacts, element_finder.contacts);
  base::take_turns(t.element_contacts, element_finder.contacts);
  carry_forces(t.contacts, contacts);
  take_turns(contacts, t.contacts);
  gaps.resize(t.contacts.particle.size());
}

void update_contacts(parallel::Range range, Real h, ParticleContactScratch& scratch, state::Tables& t) {
  state::Contacts& contacts = t.contacts;
  const std::size_t count = contacts.particle.size();
  HOOKE_ASSERT(scratch.buffers().gaps.size() == count && static_cast<std::size_t>(range.end) <= count);
  const auto same_pair = [&](std::size_t a, std::size_t b) {
    return contacts.particle[a] == contacts.particle[b] && contacts.collider[a] == contacts.collider[b];
  };
  auto row = static_cast<std::size_t>(range.begin);
  while (row > 0 && row < count && same_pair(row, row - 1)) ++row;
  Frame frame;
  std::size_t made_for = count;  // row for which `frame` was made; most of an object touch one shape
  while (row < static_cast<std::size_t>(range.end)) {
    const std::size_t first = row;
    while (row < count && same_pair(row, first)) ++row;
    const std::uint32_t particle = contacts.particle[first];
    if (made_for == count || contacts.collider[made_for] != contacts.collider[first] ||
        contacts.object[made_for] != contacts.object[first])
      frame = frame_of(t, contacts.collider[first], t.objects[contacts.object[first]]);
    made_for = first;
    const state::ColliderShape& shape = *frame.shape;
    const Vec3 place = t.particles.position[particle].x;
    const Vec3 x = frame.to_shape(place);
    const Real radius = touching_radius(scratch.buffers().hooked_near, contacts.object[first],
                                        contacts.body[first], t.particles.position[particle].radius);
    const Vec3 arm = place - frame.center;
    const Vec3 velocity = state::velocity_now(t.bodies, contacts.body[first], arm);
    if (shape.shape.kind != ShapeKind::kMesh) {
      const Vec3 displacement = h * frame.to_shape_direction(t.particles.velocity[particle].v - velocity);
      set_row(contacts, first, frame, gap_along_displacement(shape, x, displacement, radius), radius);
    } else {
      const std::span<TriangleGap> gaps = std::span(scratch.buffers().gaps).subspan(first, row - first);
      for (std::size_t i = first; i < row; ++i)
        gaps[i - first] = gap_to_feature(*shape.mesh, contacts.feature[i], x);
      update_mesh_rows(contacts, first, gaps, is_inside(*shape.mesh, x), frame, radius);
    }
    for (std::size_t i = first; i < row; ++i) set_surface(contacts, i, arm, velocity, frame.belt_velocity);
  }
}

namespace {

/// Radius about a body's center of mass beyond which a collider of it does not reach. Bodies may have been
/// moved since their boxes were made.
Real reach_of(const state::Tables& t, std::uint32_t collider) {
  const ShapeKind kind = t.colliders.shape[collider].shape.kind;
  if (kind == ShapeKind::kHalfSpace || kind == ShapeKind::kMesh) return HUGE_VALF;
  return t.bodies.traits[t.colliders.body[collider]].radius + kBoxRounding;
}

/// Lists those of `colliders` that come so near to the object's points that one may touch.
void list_reached(const state::Tables& t, std::span<const std::uint32_t> colliders,
                  const state::Deformable& object, std::vector<std::uint32_t>& reached) {
  DVec3 lower = {HUGE_VAL, HUGE_VAL, HUGE_VAL};
  DVec3 upper = -lower;
  for (std::uint32_t p = object.particles.first; p < object.particles.end(); ++p) {
    const DVec3 x = vector_cast<double>(t.particles.position[p].x);
    const auto radius = static_cast<double>(t.particles.position[p].radius);
    lower = geometry::min_of(lower, x - DVec3{radius, radius, radius});
    upper = geometry::max_of(upper, x + DVec3{radius, radius, radius});
  }
  reached.clear();
  for (const std::uint32_t c : colliders) {
    const DVec3 center = state::pose_now(t.bodies, t.colliders.body[c]).position - object.origin;
    const DVec3 nearest = geometry::max_of(lower, geometry::min_of(upper, center));
    if (length(center - nearest) <= static_cast<double>(reach_of(t, c))) reached.push_back(c);
  }
}

}  // namespace

double largest_penetration(const state::Tables& t) {
  double deepest = 0;
  std::vector<std::uint32_t> colliders;
  std::vector<std::uint32_t> reached;
  std::vector<Hooked> hooked;
  std::vector<Frame> frames;
  list_solid_colliders(t, colliders);
  list_hooked(t, hooked);
  for (const state::Deformable& object : t.objects) {
    list_reached(t, colliders, object, reached);
    make_frames(t, reached, object, frames);
    for (std::uint32_t p = object.particles.first; p < object.particles.end(); ++p) {
      const Vec3 x = t.particles.position[p].x;
      const Real radius = t.particles.position[p].radius;
      for (std::size_t i = 0; i < frames.size(); ++i) {
        if (length(x - frames[i].center) > reach_of(t, reached[i]) + radius) continue;
        if (is_hooked(hooked, p, t.colliders.body[reached[i]])) continue;
        const Real distance = distance_to(frames[i], x, radius);
        deepest = std::max(deepest, static_cast<double>(radius - distance));
      }
    }
  }
  return deepest;
}

}  // namespace hooke::collision
