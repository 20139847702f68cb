#include "collision/deformable/body_passes.h"

#include "base/assert.h"
#include "collision/deformable/deformable_tuning.h"
#include "math/rotation.h"
#include "state/body_frames.h"
#include "state/surface_triangles.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hooke::collision {

namespace {

using Passes = BodyPassFinder;

/// Longest edge of an object's elements at rest, so that it is the same after a restore [m].
Real longest_at_rest(const state::Tables& t, const state::Deformable& object, const Passes& finder,
                     const Passes::Object& made) {
  Real longest = Real(0);
  for (std::uint32_t i = 0; i < object.segments.count; ++i)
    longest = std::max(longest, t.segments.rest_length[object.segments.first + i]);
  if (object.segments.count > 0 || !object.surface.rest_points) return longest;
  for (std::uint32_t i = made.first; i < made.end; ++i) {
    const auto x = [&](std::size_t k) {
      return (*object.surface.rest_points)[finder.elements[i].particle[k] - object.particles.first];
    };
    longest = std::max({longest, length(x(1) - x(0)), length(x(2) - x(1)), length(x(0) - x(2))});
  }
  return longest;
}

void list_elements(const state::Tables& t, Passes& finder) {
  finder.elements.clear();
  finder.objects.clear();
  std::uint32_t blocks = 0;
  for (const state::Deformable& object : t.objects) {
    Passes::Object& made = finder.objects.emplace_back();
    made.first = static_cast<std::uint32_t>(finder.elements.size());
    made.first_block = blocks;
    for (std::uint32_t i = 0; i < object.segments.count; ++i) {
      const std::uint32_t p = object.particles.first + i;
      finder.elements.push_back({{p, p + 1, p + 1}, 2});
    }
    for (const std::array<std::uint32_t, 3>& corners : state::surface_triangles(t, object))
      finder.elements.push_back({corners, 3});
    made.end = static_cast<std::uint32_t>(finder.elements.size());
    made.longest = longest_at_rest(t, object, finder, made);
    blocks += (made.end - made.first + Passes::kBlock - 1) / Passes::kBlock;
  }
  finder.blocks.resize(blocks);
}

/// Half-spaces have nothing that points would miss, and compounds are present as their parts. Meshes are left
/// to points, ridges and peaks.
bool is_swept(const Shape& shape) {
  return shape.kind != ShapeKind::kHalfSpace && shape.kind != ShapeKind::kCompound &&
         shape.kind != ShapeKind::kMesh;
}

geometry::Box box_of(const state::Tables& t, const Passes::Element& e) {
  const auto x = [&](std::size_t k) { return t.particles.position[e.particle[k]].x; };
  return geometry::box_of(x(0), x(1), x(2));
}

geometry::Box grown(const geometry::Box& box, Real by) {
  return {box.lower - Vec3{by, by, by}, box.upper + Vec3{by, by, by}};
}

Real speed_of(const state::Tables& t, std::uint32_t body) {
  const Vec3 turning = t.bodies.scale[body] * t.bodies.motion[body].omega_scaled;
  const Real turn = std::max(length(turning), length(t.bodies.angular_velocity[body]));
  return length(t.bodies.motion[body].v) + turn * t.bodies.traits[body].radius;
}

/// Distance that an element keeps from shapes for certain, if there is room [m].
Real nearness_of(const state::Tables& t, const Passes::Element& e) {
  Real radius = t.particles.position[e.particle[0]].radius;
  for (std::size_t k = 1; k < 3; ++k) radius = std::min(radius, t.particles.position[e.particle[k]].radius);
  return kPassedBodyShare * radius;
}

/// Largest speed of some points [m/s].
Real fastest_of(const state::Tables& t, state::Rows points) {
  Real fastest = Real(0);
  for (std::uint32_t p = points.first; p < points.end(); ++p)
    fastest = std::max(fastest, length_squared(t.particles.velocity[p].v));
  return std::sqrt(fastest);
}

/// Largest speed of the object's points, and its box.
struct Extent {
  Real speed = Real(0);
  Real radius = Real(0);
  Real least_radius = std::numeric_limits<Real>::infinity();
  geometry::Box box = {};
};

Extent extent_of(const state::Tables& t, const state::Deformable& object) {
  Extent extent = {.speed = fastest_of(t, object.particles)};
  for (std::uint32_t p = object.particles.first; p < object.particles.end(); ++p) {
    const state::PositionRecord& at = t.particles.position[p];
    extent.radius = std::max(extent.radius, at.radius);
    extent.least_radius = std::min(extent.least_radius, at.radius);
    extent.box = geometry::merge(extent.box, at.x);
  }
  return extent;
}

/// Finds the candidates of all objects. `left` is the rest of the step [s].
class PassSearch {
 public:
  PassSearch(const state::Tables& t, Real left, Passes& finder) : t_(t), left_(left), f_(finder) {}

  void run() {
    f_.candidates.clear();
    f_.pairs.clear();
    foresee_bodies();
    for (std::uint32_t row = 0; row < f_.objects.size(); ++row) search_object(row);
  }

 private:
  [[nodiscard]] Real fall() const { return length(t_.desc.gravity) * left_ * left_; }

  void foresee_bodies() {
    f_.body_reach.assign(t_.bodies.motion.size(), Real(0));
    f_.body_gone.resize(t_.bodies.motion.size(), Real(0));
    for (const std::uint32_t body : t_.moving_bodies) {
      if (t_.bodies.asleep[body] == 0)
        f_.body_reach[body] = f_.body_gone[body] + speed_of(t_, body) * left_ + fall() + kParticleMargin;
    }
  }

  void search_object(std::uint32_t row) {
    const state::Deformable& object = t_.objects[row];
    Passes::Object& found = f_.objects[row];
    found.gone = Real(0);
    if (found.first == found.end) return;
    const Extent extent = extent_of(t_, object);
    found.reach = Real(2) * extent.speed * left_ + fall() + kParticleMargin;
    found.near = kPassedBodyShare * extent.radius;
    found.least_near = kPassedBodyShare * extent.least_radius;
    const Real reach = found.reach + extent.radius;
    bool blocks_are_known = false;
    for (const std::uint32_t collider : f_.colliders) {
      const std::uint32_t body = t_.colliders.body[collider];
      const geometry::Box& bounds = t_.colliders.bounds[collider];
      const DVec3 o = object.origin;
      const geometry::Box near = grown({vector_cast<Real>(vector_cast<double>(bounds.lower) - o),
                                        vector_cast<Real>(vector_cast<double>(bounds.upper) - o)},
                                       reach + f_.body_reach[body] + kBoxRounding);
      if (!overlap(near, extent.box)) continue;
      if (!blocks_are_known) set_blocks(found);
      blocks_are_known = true;
      search_pair(row, collider, near);
    }
  }

  void set_blocks(const Passes::Object& object) {
    for (std::uint32_t i = object.first; i < object.end; ++i) {
      const std::uint32_t k = i - object.first;
      geometry::Box& block = f_.blocks[object.first_block + k / Passes::kBlock];
      if (k % Passes::kBlock == 0) block = {};
      block = geometry::merge(block, box_of(t_, f_.elements[i]));
    }
  }

  void search_pair(std::uint32_t row, std::uint32_t collider, const geometry::Box& near) {
    const Passes::Object& object = f_.objects[row];
    const std::uint32_t body = t_.colliders.body[collider];
    const auto first = static_cast<std::uint32_t>(f_.candidates.size());
    for (std::uint32_t i = object.first; i < object.end; ++i) {
      const std::uint32_t k = i - object.first;
      if (k % Passes::kBlock == 0 && !overlap(near, f_.blocks[object.first_block + k / Passes::kBlock])) {
        i += Passes::kBlock - 1;
        continue;
      }
      const Passes::Element& e = f_.elements[i];
      if (is_gap(row, k)) continue;
      if (overlap(near, box_of(t_, e)) && may_touch(e, body)) f_.candidates.push_back({.element = i});
    }
    const auto end = static_cast<std::uint32_t>(f_.candidates.size());
    if (first == end) return;
    const ContactDesc& surface = t_.colliders.surface[collider];
    Passes::Pair pair = {.object = row, .collider = collider, .body = body, .first = first, .end = end};
    pair.friction = std::sqrt(t_.objects[row].friction * surface.friction);
    pair.spans = t_.bodies.traits[body].radius > object.longest;
    pair.may_miss_points = t_.bodies.traits[body].inner_radius < (Real(1) - kPointShare) * object.longest;
    pair.inset = inset_of(body, object.longest);
    f_.pairs.push_back(pair);
  }

  /// Whether the element is a segment of a rope that has broken.
  [[nodiscard]] bool is_gap(std::uint32_t row, std::uint32_t element) const {
    const state::Deformable& object = t_.objects[row];
    return object.has_gaps && element < object.segments.count &&
           !t_.segments.joins(object.segments.first + element);
  }

  /// Bodies wider than an element are carried by points, between which chords cut into them.
  [[nodiscard]] Real inset_of(std::uint32_t body, Real edge) const {
    const state::BodyTraits& traits = t_.bodies.traits[body];
    if (!(Real(2) * traits.inner_radius > edge)) return Real(0);
    return std::min(kChordShare * edge, Real(0.5) * traits.inner_radius);
  }

  /// Whether something of the two gives way, and no hook holds them together.
  [[nodiscard]] bool may_touch(const Passes::Element& e, std::uint32_t body) const {
    bool any_free = is_dynamic(t_.bodies, body);
    for (std::uint32_t k = 0; k < e.count; ++k) {
      any_free = any_free || t_.particles.velocity[e.particle[k]].inverse_mass > Real(0);
      if (is_hooked(f_.hooked, e.particle[k], body)) return false;
    }
    return any_free;
  }

  const state::Tables& t_;
  Real left_;
  Passes& f_;
};

/// Makes a shape thinner on all sides. A hull becomes a ball in its middle.
void take_in(Real inset, Real inner_radius, Convex& convex) {
  Shape& shape = convex.shape;
  const auto less = [inset](Real& size) { size = std::max(size - inset, Real(0.5) * size); };
  switch (shape.kind) {
    case ShapeKind::kHull:
      convex.center = middle_of(convex);
      convex.hull = nullptr;
      shape = Shape::sphere(std::max(inner_radius - inset, Real(0.5) * inner_radius));
      return;
    case ShapeKind::kBox:
      less(shape.half_extents.x);
      less(shape.half_extents.y);
      less(shape.half_extents.z);
      return;
    case ShapeKind::kSphere:
      return less(shape.radius);
    case ShapeKind::kCapsule:
      return less(shape.radius);
    default:
      less(shape.radius);
      return less(shape.half_height);
  }
}

/// The shape of a pair where it is, from the object's origin.
MovingShape shape_of(const state::Tables& t, const Passes::Pair& pair) {
  const Frame frame = frame_of(t, pair.collider, t.objects[pair.object]);
  const Shape& shape = frame.shape->shape;
  MovingShape made;
  made.convex = {.shape = shape, .center = frame.offset, .axes = matrix_of(normalize(frame.rotation))};
  if (shape.kind == ShapeKind::kHull) made.convex.hull = frame.shape->hull.get();
  const Real inner = t.bodies.traits[pair.body].inner_radius;
  if (pair.inset > Real(0)) take_in(pair.inset, inner, made.convex);
  made.pivot = frame.center;
  made.reach = t.bodies.traits[pair.body].radius;
  if (made.convex.shape.kind == ShapeKind::kSphere) made.reach = length(made.convex.center - frame.center);
  return made;
}

/// Least distance along the unit vector `n`, which points to the element [m].
Real separation(const MovingElement& element, const MovingShape& shape, Vec3 n) {
  Real least = dot(n, element.corner[0]);
  for (std::size_t k = 1; k < 3; ++k) least = std::min(least, dot(n, element.corner[k]));
  return least - dot(n, support_of(shape.convex, n)) - skin_of(shape.convex);
}

/// The same after the whole motion.
Real separation_after(const MovingElement& element, const MovingShape& shape, Vec3 n) {
  MovingElement moved = element;
  for (std::size_t k = 0; k < 3; ++k) moved.corner[k] += element.displacement[k];
  MovingShape then = shape;
  then.convex = shape.at(Real(1));
  return separation(moved, then, n);
}

/// The element from where it began the particle substep, with the motion that it has made, as contacts move
/// points, and that at its velocities.
MovingElement element_ahead(const state::Tables& t, Real h, const Passes& finder, const Passes::Element& e) {
  MovingElement element = {.count = e.count};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t p = e.particle[k];
    element.corner[k] = finder.start[p].x;
    element.displacement[k] = (t.particles.position[p].x - finder.start[p].x) + h * t.particles.velocity[p].v;
  }
  return element;
}

/// The element with the motion that it has made.
MovingElement element_moved(const state::Tables& t, const Passes& finder, const Passes::Element& e) {
  MovingElement element = {.count = e.count};
  for (std::size_t k = 0; k < 3; ++k) {
    element.corner[k] = finder.start[e.particle[k]].x;
    element.displacement[k] = t.particles.position[e.particle[k]].x - element.corner[k];
  }
  return element;
}

/// Both seen from the element's first point, so that rounding is that of small numbers.
void bring_near(MovingElement& element, MovingShape& shape) {
  const Vec3 from = element.corner[0];
  for (Vec3& corner : element.corner) corner -= from;
  shape.convex.center -= from;
  shape.pivot -= from;
}

/// Whether a plane across `normal` separates the two by more than `near` [m] in the whole motion, if it does
/// so by `begin` at first. What moves straight is nearest to the plane at one end; a rotation leaves its
/// chord by an eighth of the angle squared.
bool stay_apart_along(const MovingElement& element, const MovingShape& shape, Real near, Real begin,
                      Vec3 normal) {
  const Real swing = length_squared(shape.turn) * shape.reach;
  return begin > near + swing && separation_after(element, shape, normal) > near + swing;
}

/// Whether the two are certainly farther apart than `near` in the whole motion. A candidate that is known to
/// be apart keeps the proof; `used` is what its pair has used.
bool stay_apart(const MovingElement& element, const MovingShape& shape, Real near, Real used,
                Passes::Candidate& candidate) {
  const Real farthest = relative_displacement(element, shape);
  if (candidate.free > used + near + farthest) return true;
  if (candidate.normal == Vec3{}) {
    const Vec3 middle = (Real(1) / Real(3)) * (element.corner[0] + element.corner[1] + element.corner[2]);
    const Vec3 between = middle - middle_of(shape.convex);
    if (!(length_squared(between) > Real(0))) return false;
    candidate.normal = normalize(between);
  }
  const Real apart = separation(element, shape, candidate.normal);
  candidate.free = std::max(candidate.free, used + apart);
  if (apart > near + farthest) return true;
  // Rows leave what they push at its distance, but for rounding and for what other rows do. Looked at again
  // for less, a load at rest cost three times as much.
  const Real enough = candidate.row == Passes::kNoRow ? Real(0.9) : Real(0.3);
  return stay_apart_along(element, shape, enough * near, apart, candidate.normal);
}

/// Calls `visit(pair, candidate, row)` with all candidates, on several threads.
template <class Visit>
void for_candidates(parallel::ThreadPool& pool, Passes& finder, Visit visit) {
  constexpr int kGrain = 256;
  parallel::for_ranges(pool, static_cast<int>(finder.candidates.size()), kGrain, [&](parallel::Range range) {
    auto row = static_cast<std::uint32_t>(range.begin);
    auto pair = std::upper_bound(finder.pairs.begin(), finder.pairs.end(), row,
                                 [](std::uint32_t r, const Passes::Pair& p) { return r < p.end; });
    for (; row < static_cast<std::uint32_t>(range.end); ++row) {
      while (row >= pair->end) ++pair;
      visit(*pair, finder.candidates[row], row);
    }
  });
}

/// Lists the candidates that are flagged.
void list_suspects(Passes& finder) {
  finder.suspects.clear();
  finder.suspect_pair.clear();
  for (std::uint32_t i = 0; i < finder.pairs.size(); ++i) {
    for (std::uint32_t row = finder.pairs[i].first; row < finder.pairs[i].end; ++row) {
      if (finder.flags[row] == 0) continue;
      finder.suspects.push_back(row);
      finder.suspect_pair.push_back(i);
    }
  }
}

/// Calls `visit(i, pair, candidate)` with all suspects, on several threads.
template <class Visit>
void for_suspects(parallel::ThreadPool& pool, Passes& finder, Visit visit) {
  constexpr int kGrain = 8;
  parallel::for_ranges(pool, static_cast<int>(finder.suspects.size()), kGrain, [&](parallel::Range range) {
    for (int i = range.begin; i < range.end; ++i) {
      const auto k = static_cast<std::size_t>(i);
      visit(k, finder.pairs[finder.suspect_pair[k]], finder.candidates[finder.suspects[k]]);
    }
  });
}

/// The row of a meeting.
state::ElementContact row_of(const state::Tables& t, const Passes& finder, const Passes::Pair& pair,
                             const Passes::Candidate& candidate, const ElementMeeting& meeting, Real near) {
  const Passes::Element& e = finder.elements[candidate.element];
  state::ElementContact row = {.object = pair.object, .collider = pair.collider, .body = pair.body};
  row.element = candidate.element;
  row.count = e.count;
  row.particle = e.particle;
  row.friction = pair.friction;
  row.weight = meeting.weight;
  row.normal = meeting.normal;
  const Vec3 belt = rotate(state::pose_now(t.bodies, pair.body).rotation,
                           t.colliders.surface[pair.collider].surface_velocity);
  row.belt_velocity = belt - dot(belt, row.normal) * row.normal;
  row.separation = meeting.distance - near;
  return row;
}

/// Takes the motion until the meeting out of the gap, so that it is that of the start.
Real gap_at_start(const MovingElement& element, const MovingShape& shape, const ElementMeeting& meeting,
                  Vec3 lever) {
  Vec3 moved = -(shape.displacement + cross(shape.turn, lever));
  for (std::size_t k = 0; k < element.count; ++k) moved += meeting.weight[k] * element.displacement[k];
  return -meeting.share * dot(meeting.normal, moved);
}

/// Upper bound of how far two points of a pair move relative to each other, and the distance they keep.
Real bound_of(const Passes::Object& object, const MovingShape& shape) {
  return object.moves + object.near + length(shape.displacement) + length(shape.turn) * shape.reach;
}

/// Longest way of some points in this particle substep, at their velocities [m].
Real longest_ahead(const state::Tables& t, Real h, const Passes& finder, state::Rows points) {
  Real longest = Real(0);
  for (std::uint32_t p = points.first; p < points.end(); ++p) {
    const Vec3 made = t.particles.position[p].x - finder.start[p].x;
    longest = std::max(longest, length_squared(made + h * t.particles.velocity[p].v));
  }
  return std::sqrt(longest);
}

/// Says how points and bodies will move.
void foresee_motion(const state::Tables& t, Real h, Passes& finder) {
  std::uint32_t known = ~std::uint32_t{0};
  for (Passes::Pair& pair : finder.pairs) {
    const state::MotionRecord& m = t.bodies.motion[pair.body];
    pair.shape.displacement = h * m.v;
    pair.shape.turn = h * (t.bodies.scale[pair.body] * m.omega_scaled);
    Passes::Object& object = finder.objects[pair.object];
    if (known != pair.object) object.moves = longest_ahead(t, h, finder, t.objects[pair.object].particles);
    known = pair.object;
    pair.moves = bound_of(object, pair.shape);
  }
}

/// Says how an object's points have moved since the particle substep began.
void note_ways(const state::Tables& t, Real h, const Passes& finder, state::Rows points,
               Passes::Object& object) {
  Real longest = Real(0);
  Real farthest = Real(0);
  for (std::uint32_t p = points.first; p < points.end(); ++p) {
    const Vec3 way = t.particles.position[p].x - finder.start[p].x;
    longest = std::max(longest, length_squared(way));
    farthest = std::max(farthest, length_squared(way - h * t.particles.velocity[p].v));
  }
  object.moves = std::sqrt(longest);
  object.strays = std::sqrt(farthest);
}

/// Says how points and bodies have moved since the particle substep began.
void note_motion(const state::Tables& t, Real h, Passes& finder) {
  std::uint32_t known = ~std::uint32_t{0};
  for (Passes::Pair& pair : finder.pairs) {
    const Pose now = state::pose_now(t.bodies, pair.body);
    MovingShape& shape = pair.shape;
    const Vec3 displacement = vector_cast<Real>(now.position - pair.begin.position);
    const bool turned = !(now.rotation == pair.begin.rotation);
    const Vec3 turn = turned ? math::turn_between(pair.begin.rotation, now.rotation, shape.turn) : Vec3{};
    Passes::Object& object = finder.objects[pair.object];
    if (known != pair.object) note_ways(t, h, finder, t.objects[pair.object].particles, object);
    known = pair.object;
    const Real strays =
        object.strays + length(displacement - shape.displacement) + length(turn - shape.turn) * shape.reach;
    constexpr Real kLittle = Real(0.25);
    pair.strays = finder.strayed || !(strays < kLittle * object.least_near);
    shape.displacement = displacement;
    shape.turn = turn;
    pair.moves = bound_of(object, shape);
  }
}

/// Whether the two come nearer than `near` [m] in the motion that they have made. Those that begin nearer may
/// come as near as half of what they had; what is in a skin by then may lose a tenth of the way to its core.
std::uint8_t comes_through(const MovingElement& element, const MovingShape& shape, Real near) {
  ElementMeeting meeting = meet(element, shape, near);
  if (meeting.crossed || !meeting.met) return 0;
  if (meeting.share > Real(0)) return 1;
  const Real skin = skin_of(shape.convex);
  const Real begin = meeting.distance;
  meeting = meet(element, shape, begin > Real(0) ? Real(0.5) * begin : begin - Real(0.1) * (skin + begin));
  return meeting.met && !meeting.crossed ? 1 : 0;
}

void place_body_passes(const state::Tables& t, BodyPassFinder& finder) {
  for (Passes::Pair& pair : finder.pairs) {
    pair.begin = state::pose_now(t.bodies, pair.body);
    pair.shape = shape_of(t, pair);
  }
}

/// Whether an object is solved as a whole. Where its points go is known, with their contacts.
bool is_whole(const PassSubstep& substep, std::uint32_t object) {
  return object < substep.solved_whole.size() && substep.solved_whole[object] != 0;
}

/// Whether what meets an element at one of its points, or nearly so, is left to that point. What is so thin
/// that it may miss the point, as a needle, is left to it only if the point touches, too.
bool is_left_to_point(const Passes::Pair& pair, const MovingElement& element, const MovingShape& shape,
                      const ElementMeeting& meeting, Real near) {
  const auto most = std::max_element(meeting.weight.begin(), meeting.weight.end());
  if (!pair.spans || !(*most > kPointShare)) return false;
  if (!pair.may_miss_points) return true;
  const auto heavy = static_cast<std::size_t>(most - meeting.weight.begin());
  MovingElement point = {.count = element.count};
  point.corner.fill(element.corner[heavy]);
  point.displacement.fill(element.displacement[heavy]);
  return meet(point, shape, near).met;
}

/// Whether a face of an object that is solved as a whole may be pressed by a shape in this substep.
bool may_be_pressed(const state::Tables& t, Real h, const Passes& finder, const Passes::Pair& pair,
                    const Passes::Candidate& c) {
  if (c.crossed) return false;
  const Passes::Element& e = finder.elements[c.element];
  const MovingElement element = element_ahead(t, h, finder, e);
  const Real longest = finder.objects[pair.object].longest;
  const Real farthest = relative_displacement(element, pair.shape);
  if (farthest > kSlowFaceShare * longest) return false;
  const Real near = nearness_of(t, e) + kNearFaceShare * longest;
  if (c.free > pair.used + near + farthest) return false;
  return c.normal == Vec3{} || !(separation(element, pair.shape, c.normal) > near + farthest);
}

/// Looks at a face that may be pressed exactly.
void find_pressed_face(const state::Tables& t, const PassSubstep& substep, const Passes& finder,
                       const Passes::Pair& pair, const Passes::Candidate& c, Passes::Found& found) {
  const Passes::Element& e = finder.elements[c.element];
  MovingElement element = element_ahead(t, substep.h, finder, e);
  MovingShape shape = pair.shape;
  bring_near(element, shape);
  const Real near = nearness_of(t, e);
  const Real reach = near + kNearFaceShare * finder.objects[pair.object].longest;
  const ElementMeeting meeting = meet(element, shape, reach);
  if (!meeting.met || meeting.crossed || meeting.normal == Vec3{}) return;
  if (is_left_to_point(pair, element, shape, meeting, reach)) return;
  found.met = true;
  found.row = row_of(t, finder, pair, c, meeting, near);
  found.row.lever = meeting.place - (shape.pivot + meeting.share * shape.displacement);
  found.row.separation += gap_at_start(element, shape, meeting, found.row.lever);
}

/// Looks at a suspect exactly.
void find_pass(const state::Tables& t, const PassSubstep& substep, const Passes& finder,
               const Passes::Pair& pair, Passes::Candidate& c, Passes::Found& found) {
  const Passes::Element& e = finder.elements[c.element];
  MovingElement element = element_ahead(t, substep.h, finder, e);
  MovingShape shape = pair.shape;
  bring_near(element, shape);
  const Real near = nearness_of(t, e);
  const ElementMeeting meeting = meet(element, shape, near);
  c.crossed = meeting.crossed;
  if (meeting.normal != Vec3{}) c.normal = meeting.normal;
  if (!meeting.met) c.free = std::max(c.free, pair.used + meeting.distance);
  if (!meeting.met || meeting.normal == Vec3{}) return;
  if (is_whole(substep, pair.object) && is_left_to_point(pair, element, shape, meeting, near)) return;
  found.met = true;
  found.share = meeting.share;
  found.row = row_of(t, finder, pair, c, meeting, near);
  found.row.lever = meeting.place - (shape.pivot + meeting.share * shape.displacement);
  found.row.separation += gap_at_start(element, shape, meeting, found.row.lever);
  // What contacts have moved is not left to the velocities.
  for (std::size_t k = 0; k < e.count; ++k) {
    const Vec3 moved = t.particles.position[e.particle[k]].x - finder.start[e.particle[k]].x;
    found.row.separation += meeting.weight[k] * dot(meeting.normal, moved);
  }
}

/// Appends the rows that were found, in order of time. Returns whether there are any.
bool append_passes(Passes& finder) {
  std::vector<std::uint32_t>& order = finder.suspect_pair;
  order.clear();
  for (std::uint32_t i = 0; i < finder.found.size(); ++i) {
    if (finder.found[i].met) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return finder.found[a].share < finder.found[b].share;
  });
  for (const std::uint32_t i : order) {
    std::uint32_t& row = finder.candidates[finder.suspects[i]].row;
    if (row == Passes::kNoRow) {
      row = static_cast<std::uint32_t>(finder.passes.size());
      finder.passes.push_back(finder.found[i].row);
    } else {
      finder.passes[row] = finder.found[i].row;
    }
  }
  return !order.empty();
}

void note_travel(const state::Tables& t, Real h, Real left, Passes& finder) {
  bool astray = finder.strayed;
  finder.strayed = false;
  for (const std::uint32_t body : t.moving_bodies) {
    if (t.bodies.asleep[body] != 0) continue;
    finder.body_gone[body] += speed_of(t, body) * h;
    astray = astray || finder.body_gone[body] > finder.body_reach[body];
  }
  for (std::size_t row = 0; row < finder.objects.size(); ++row) {
    Passes::Object& object = finder.objects[row];
    if (object.first == object.end) continue;
    object.moves = fastest_of(t, t.objects[row].particles) * h;
    object.gone += object.moves;
    astray = astray || object.gone > object.reach;
  }
  if (!astray) return;
  PassSearch(t, left, finder).run();
  place_body_passes(t, finder);
}

}  // namespace

void find_body_passes(const state::Tables& t, Real dt, BodyPassFinder& finder) {
  finder.pairs.clear();
  finder.candidates.clear();
  if (t.objects.empty()) return;
  if (finder.revision != t.revision) {
    finder.revision = t.revision;
    list_elements(t, finder);
  }
  list_solid_colliders(t, finder.colliders);
  std::erase_if(finder.colliders, [&](std::uint32_t c) { return !is_swept(t.colliders.shape[c].shape); });
  list_hooked(t, finder.hooked);
  finder.body_gone.assign(t.bodies.motion.size(), Real(0));
  finder.strayed = false;
  PassSearch(t, dt, finder).run();
}

void begin_body_passes(const state::Tables& t, BodyPassFinder& finder) {
  if (finder.colliders.empty() || t.objects.empty()) return;
  finder.start = t.particles.position;
  finder.body_start.resize(t.bodies.motion.size());
  for (std::uint32_t i = 0; i < finder.body_start.size(); ++i)
    finder.body_start[i] = state::motion_now(t.bodies, i);
  place_body_passes(t, finder);
}

bool sweep_body_passes(parallel::ThreadPool& pool, const state::Tables& t, const PassSubstep& substep,
                       BodyPassFinder& finder) {
  if (substep.first) finder.passes.clear();
  if (finder.colliders.empty() || t.objects.empty()) return false;
  if (substep.first) note_travel(t, substep.h, substep.left, finder);
  foresee_motion(t, substep.h, finder);
  finder.flags.assign(finder.candidates.size(), 0);
  for_candidates(pool, finder, [&](const Passes::Pair& pair, Passes::Candidate& c, std::uint32_t row) {
    if (c.free > pair.used + pair.moves || c.crossed) return;
    const Passes::Element& e = finder.elements[c.element];
    const MovingElement element = element_ahead(t, substep.h, finder, e);
    finder.flags[row] = stay_apart(element, pair.shape, nearness_of(t, e), pair.used, c) ? 0 : 1;
  });
  list_suspects(finder);
  if (finder.suspects.empty()) return false;
  finder.found.assign(finder.suspects.size(), {});
  for_suspects(pool, finder, [&](std::size_t i, const Passes::Pair& pair, Passes::Candidate& c) {
    find_pass(t, substep, finder, pair, c, finder.found[i]);
  });
  return append_passes(finder);
}

void find_pressed_faces(parallel::ThreadPool& pool, const state::Tables& t, const PassSubstep& substep,
                        BodyPassFinder& finder, std::vector<state::ElementContact>& faces) {
  faces.clear();
  const auto is_of_whole = [&](const Passes::Pair& pair) { return is_whole(substep, pair.object); };
  if (std::none_of(finder.pairs.begin(), finder.pairs.end(), is_of_whole)) return;
  foresee_motion(t, substep.h, finder);
  finder.flags.assign(finder.candidates.size(), 0);
  for_candidates(pool, finder, [&](const Passes::Pair& pair, const Passes::Candidate& c, std::uint32_t row) {
    finder.flags[row] = is_of_whole(pair) && may_be_pressed(t, substep.h, finder, pair, c) ? 1 : 0;
  });
  list_suspects(finder);
  finder.found.assign(finder.suspects.size(), {});
  for_suspects(pool, finder, [&](std::size_t i, const Passes::Pair& pair, const Passes::Candidate& c) {
    find_pressed_face(t, substep, finder, pair, c, finder.found[i]);
  });
  for (const Passes::Found& found : finder.found) {
    if (found.met) faces.push_back(found.row);
  }
}

void look_at_body_passes(parallel::ThreadPool& pool, const state::Tables& t, Real h, BodyPassFinder& finder) {
  finder.suspects.clear();
  if (finder.pairs.empty()) return;
  note_motion(t, h, finder);
  const bool any = !finder.passes.empty() || std::any_of(finder.pairs.begin(), finder.pairs.end(),
                                                         [](const Passes::Pair& p) { return p.strays; });
  if (!any) return;
  finder.flags.assign(finder.candidates.size(), 0);
  for_candidates(pool, finder, [&](const Passes::Pair& pair, Passes::Candidate& c, std::uint32_t row) {
    if ((!pair.strays && c.row == Passes::kNoRow) || c.crossed || c.free > pair.used + pair.moves) return;
    const Passes::Element& e = finder.elements[c.element];
    const MovingElement element = element_moved(t, finder, e);
    const Real near = kPassedBodyLeast * nearness_of(t, e);
    if (c.free > pair.used + near + relative_displacement(element, pair.shape)) return;
    const bool apart =
        c.normal != Vec3{} &&
        stay_apart_along(element, pair.shape, near, separation(element, pair.shape, c.normal), c.normal);
    finder.flags[row] = apart ? 0 : 1;
  });
  list_suspects(finder);
  if (finder.suspects.empty()) return;
  for_suspects(pool, finder, [&](std::size_t i, const Passes::Pair& pair, Passes::Candidate& c) {
    const Passes::Element& e = finder.elements[c.element];
    MovingElement element = element_moved(t, finder, e);
    MovingShape shape = pair.shape;
    bring_near(element, shape);
    finder.flags[finder.suspects[i]] = comes_through(element, shape, kPassedBodyLeast * nearness_of(t, e));
  });
  list_suspects(finder);
}

void forget_body_passes(BodyPassFinder& finder) {
  for (Passes::Candidate& candidate : finder.candidates) candidate.row = Passes::kNoRow;
}

void end_body_passes(bool forget, BodyPassFinder& finder) {
  for (Passes::Pair& pair : finder.pairs) pair.used += pair.moves;
  finder.strayed = finder.strayed || forget;
  if (!forget && finder.passes.empty()) return;
  for (Passes::Candidate& candidate : finder.candidates) {
    candidate.row = Passes::kNoRow;
    if (forget) candidate.free = Real(0);
  }
}

}  // namespace hooke::collision
