#include "collision/narrow_phase/narrow_phase.h"

#include "base/assert.h"
#include "base/take_turns.h"
#include "collision/continuous/continuous_sweep.h"
#include "collision/distance/distance.h"
#include "collision/distance/pair_surface.h"
#include "collision/manifold/manifold_ghosts.h"
#include "collision/manifold/manifold_match.h"
#include "collision/manifold/manifold_mesh.h"
#include "collision/manifold/manifold_points.h"
#include "collision/manifold/shape_placement.h"
#include "collision/narrow_phase/cached_manifolds.h"
#include "collision/narrow_phase/narrow_phase_tuning.h"
#include "state/body_frames.h"
#include "state/sleeping_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace hooke::collision {

namespace {

using parallel::for_items;
using parallel::for_ranges;
using parallel::Range;
using state::ContactRefresh;
using state::Manifold;
using state::Pair;

constexpr int kChunk = 128;  // pairs of one buffer
constexpr int kColliderGrain = 512;
constexpr int kChunkGrain = 1;

/// All data that a step's pairs read.
struct Scene {
  const state::Bodies& bodies;
  const state::Colliders& colliders;
  std::span<const MaterialPairDesc> materials;
  Real dt;  ///< Time that is looked ahead: a step, or a substep.
  int substeps = 1;
  std::span<const Convex> placed_shapes =
      {};  ///< Shapes of colliders in pairs that do not rest, from their body's center.
  std::span<const Manifold> old = {};
  std::span<const SmallMotion> motions = {};          ///< Motion of each body since the last step.
  std::span<const std::uint32_t> sole_neighbor = {};  ///< By body; see find_sole_neighbors.
};

/// The results of the pairs of a chunk, in their order.
struct Chunk {
  std::vector<Manifold> manifolds = {};
  NarrowPhaseCounts counts = {};
  // The fields below belong to the current pair.
  Real margin = Real(0);
  bool is_whole = true;  // the margin is margin_of, for the whole displacement
  Real time = Real(0);   // part of the step after which the pair is tested
  ContactResult result = {};
  MeshScratch mesh = {};
  SweepScratch sweep = {};

  /// Resets to the state of a new object, but keeps the memory.
  void clear() {
    manifolds.clear();
    manifolds.reserve(kChunk);
    counts = {};
    result = {};
    sweep.result = {};
  }
};

/// 2 cm and the displacement by which two points of the bodies can come together in a step.
Real margin_of(const Scene& scene, std::uint32_t a, std::uint32_t b) {
  const state::Bodies& bodies = scene.bodies;
  // No point of a body moves farther by rotation than its diameter.
  const auto turn = [&](std::uint32_t body) {
    return std::min(scene.dt * length(bodies.angular_velocity[body]), Real(2)) * bodies.traits[body].radius;
  };
  return kPointMargin + scene.dt * length(bodies.motion[b].v - bodies.motion[a].v) + turn(a) + turn(b);
}

Vec3 rotated(Quat rotation, Vec3 v) {
  return v == Vec3{} ? v : rotate(rotation, v);
}

/// Fills in everything but the points.
void describe(const Scene& scene, const Pair& pair, std::uint32_t patch, Manifold& m) {
  const ContactDesc& a = scene.colliders.surface[pair.collider_a];
  const ContactDesc& b = scene.colliders.surface[pair.collider_b];
  const PairSurface surface = surface_of(a, b, scene.materials);
  m.collider_a = pair.collider_a;
  m.collider_b = pair.collider_b;
  m.body_a = scene.colliders.body[pair.collider_a];
  m.body_b = scene.colliders.body[pair.collider_b];
  m.patch = patch;
  m.friction = surface.friction;
  m.static_friction = surface.static_friction;
  m.restitution = surface.restitution;
  m.rolling_friction = std::max(a.rolling_friction, b.rolling_friction);
  m.spinning_friction = std::max(a.spinning_friction, b.spinning_friction);
  m.surface_velocity = rotated(scene.bodies.rotation[m.body_b], b.surface_velocity) -
                       rotated(scene.bodies.rotation[m.body_a], a.surface_velocity);
}

/// The manifold of the last step that a patch continues. A patch is named after the lowest of its triangles
/// that are near. When that changes, the normal decides.
const Manifold* find_old(const Scene& scene, const Pair& pair, std::uint32_t patch, Vec3 normal) {
  const Manifold* best = nullptr;
  Real closest = Real(0.99);
  for (std::uint32_t i = pair.first_manifold; i < pair.first_manifold + pair.manifold_count; ++i) {
    const Manifold& old = scene.old[i];
    if (old.patch == patch) return &old;
    const Real cosine = dot(old.normal, normal);
    best = cosine > closest ? &old : best;
    closest = std::max(closest, cosine);
  }
  return best;
}

/// Converts separations at `time` to those at the start of the step. Rows proceed evenly from there, so that
/// they are right at `time`. Points that part have no such past; rolling points only seem to part, by
/// rounding.
void bring_to_start(const Scene& scene, Real time, Manifold& m) {
  const Path a = path_ahead(scene.bodies, m.body_a, scene.dt);
  const Path b = path_ahead(scene.bodies, m.body_b, scene.dt);
  std::int32_t count = 0;
  for (std::int32_t i = 0; i < m.point_count; ++i) {
    state::ContactPoint p = m.point[static_cast<std::size_t>(i)];
    const Vec3 displacement =
        b.displacement + cross(b.turn, p.anchor_b) - a.displacement - cross(a.turn, p.anchor_a);
    const Real before = p.separation - time * dot(m.normal, displacement);
    if (before < -kPartingOverlap && p.separation > Real(0)) continue;
    p.separation = before < Real(0) ? std::max(before, p.separation) : before;
    m.point[static_cast<std::size_t>(count++)] = p;
  }
  m.point_count = count;
}

void append(const Scene& scene, const Pair& pair, std::uint32_t patch, const ContactFrame& frame,
            ContactResult& result, Chunk& chunk) {
  if (result.count == 0) return;
  Manifold& m = chunk.manifolds.emplace_back();
  make_points(result, chunk.margin, frame, find_old(scene, pair, patch, result.normal), m);
  describe(scene, pair, patch, m);
  if (chunk.time > Real(0)) bring_to_start(scene, chunk.time, m);
  if (m.point_count == 0) chunk.manifolds.pop_back();
}

/// Appends manifolds without points, for those that a refreshed pair will have within the step.
void append_spares(const Scene& scene, const Pair& pair, std::uint32_t begin, bool mesh, Chunk& chunk) {
  const std::uint32_t wanted = mesh ? kRefreshedPatches : 1;
  while (chunk.manifolds.size() < begin + wanted) {
    Manifold& m = chunk.manifolds.emplace_back();
    describe(scene, pair, Manifold::kNoPatch, m);
    m.normal = {Real(0), Real(1), Real(0)};
  }
  for (std::size_t i = begin; i < chunk.manifolds.size(); ++i)
    chunk.manifolds[i].refresh = state::ContactRefresh::kEachSubstep;
}

/// The shapes of a pair, each relative to the center of mass of its body.
struct View {
  const Convex& a;
  const Convex& b;
  DVec3 center_a;
  DVec3 center_b;

  [[nodiscard]] Vec3 apart() const { return vector_cast<Real>(center_b - center_a); }
};

/// Tests two convex shapes, in the neighborhood of A.
void test_convex(const Scene& scene, const View& view, Pair& pair, Chunk& chunk) {
  const Vec3 apart = view.apart();
  Convex b = view.b;
  b.center += apart;
  collide(view.a, b, {chunk.margin, pair.axis}, chunk.result);
  append(scene, pair, 0, {{}, apart}, chunk.result, chunk);
}

/// Tests a half-space and a convex shape, in the neighborhood of the shape. The plane is wide, and only the
/// height over it is needed, in double.
void test_half_space(const Scene& scene, const View& view, Pair& pair, Chunk& chunk) {
  const bool is_a = view.a.shape.kind == ShapeKind::kHalfSpace;
  const Convex& plane = is_a ? view.a : view.b;
  const DVec3 from_plane = is_a ? view.center_b - view.center_a : view.center_a - view.center_b;
  const Vec3 n = plane.axes.y;
  const Real height = height_over(plane, from_plane);
  collide_half_space(-height * n, n, is_a ? view.b : view.a, {chunk.margin, pair.axis}, chunk.result);
  if (!is_a) swap_sides(chunk.result);
  append(scene, pair, 0, is_a ? ContactFrame{-view.apart(), {}} : ContactFrame{{}, view.apart()},
         chunk.result, chunk);
}

/// Tests a mesh and a convex shape, in the neighborhood of the shape.
void test_mesh(const Scene& scene, const View& view, Pair& pair, Chunk& chunk) {
  const bool is_a = view.a.shape.kind == ShapeKind::kMesh;
  const state::ColliderShape& mesh = scene.colliders.shape[is_a ? pair.collider_a : pair.collider_b];
  const DVec3 from_mesh = is_a ? view.center_b - view.center_a : view.center_a - view.center_b;
  const PlacedMesh mesh_in_place = place_mesh(mesh, is_a ? view.a : view.b, from_mesh);
  const auto v = [&](std::uint32_t collider) {
    return scene.bodies.motion[scene.colliders.body[collider]].v;
  };
  const Vec3 displacement = scene.dt * (v(pair.collider_b) - v(pair.collider_a));
  const MeshReach reach =
      chunk.is_whole ? MeshReach(chunk.margin, is_a ? displacement : -displacement) : MeshReach(chunk.margin);
  chunk.result.separation = collide_mesh(mesh_in_place, is_a ? view.b : view.a, reach, chunk.mesh);
  for (PatchResult& patch : chunk.mesh.patches) {
    if (!is_a) swap_sides(patch.result);
    append(scene, pair, patch.patch, is_a ? ContactFrame{-view.apart(), {}} : ContactFrame{{}, view.apart()},
           patch.result, chunk);
  }
}

void test_view(const Scene& scene, const View& view, Pair& pair, Chunk& chunk) {
  const auto either = [&](ShapeKind kind) { return view.a.shape.kind == kind || view.b.shape.kind == kind; };
  ContactResult& result = chunk.result;
  result.count = 0;
  result.axis = 0;  // Few kinds of shapes set it; what another pair left here would be hashed.
  if (either(ShapeKind::kMesh)) {
    test_mesh(scene, view, pair, chunk);
  } else if (either(ShapeKind::kHalfSpace)) {
    test_half_space(scene, view, pair, chunk);
  } else {
    test_convex(scene, view, pair, chunk);
  }
  pair.gap = result.separation;
  pair.axis = result.axis;
}

/// Whether the surfaces that are near at the start of the step may not be those that will meet: the shapes
/// come together or rotate farther than they are thick. Half-spaces have the same normal everywhere. The
/// normal of two balls changes with every displacement aside, and to look ahead is cheap for them.
bool is_fast(const SweptCollider& a, const SweptCollider& b, const Convex& shape_a, const Convex& shape_b) {
  const bool flat =
      shape_a.shape.kind == ShapeKind::kHalfSpace || shape_b.shape.kind == ShapeKind::kHalfSpace;
  const bool balls = shape_a.shape.kind == ShapeKind::kSphere && shape_b.shape.kind == ShapeKind::kSphere;
  const Real thick = balls ? Real(0) : thinness_of(shape_a) + thinness_of(shape_b);
  const Real displacement = flat ? Real(0) : length(b.path.displacement - a.path.displacement);
  return displacement + rotation_reach(a) + rotation_reach(b) > kPointMargin + thick;
}

/// Whether a body rotates farther than `angle` [rad] in the step.
bool rotates_beyond(const Path& path, Real angle) {
  return length_squared(path.turn) > angle * angle;
}

/// Whether the pair had contacts whose points hardly come nearer or part: a tip that spins, a wheel that
/// rolls.
bool stays_in_contact(const Scene& scene, const Pair& pair) {
  for (std::uint32_t i = pair.first_manifold; i < pair.first_manifold + pair.manifold_count; ++i) {
    const Manifold& m = scene.old[i];
    for (std::int32_t k = 0; k < m.point_count; ++k) {
      const state::ContactPoint& p = m.point[static_cast<std::size_t>(k)];
      const Vec3 v =
          velocity_at(scene.bodies, m.body_b, p.anchor_b) - velocity_at(scene.bodies, m.body_a, p.anchor_a);
      if (std::fabs(dot(m.normal, v)) * scene.dt > kPointMargin) return false;
    }
  }
  return pair.manifold_count > 0;
}

constexpr Real kMiddle = Real(0.5);  // of the step

Real restitution_of(const Scene& scene, const Pair& pair) {
  return surface_of(scene.colliders.surface[pair.collider_a], scene.colliders.surface[pair.collider_b],
                    scene.materials)
      .restitution;
}

constexpr std::uint32_t kNone = 0xFFFFFFFF;
constexpr std::uint32_t kSeveral = 0xFFFFFFFE;
constexpr std::uint32_t kStandingCollider = 0x80000000;

bool is_moved(const Scene& scene, std::uint32_t collider) {
  return scene.bodies.mass[scene.colliders.body[collider]].inverse_mass > Real(0);
}

/// Finds what each dynamic body is near to: one other body, one collider that nothing moves, or several.
/// Bodies of `has_several_neighbors` always count as near to several. So do sleeping bodies, whose other
/// pairs may be sleeping pairs.
void find_sole_neighbors(const Scene& scene, std::span<const Pair> pairs,
                         std::span<const std::uint8_t> has_several_neighbors,
                         std::vector<std::uint32_t>& sole_neighbor) {
  sole_neighbor.assign(scene.bodies.traits.size(), kNone);
  for (std::size_t body = 0; body < has_several_neighbors.size(); ++body) {
    if (has_several_neighbors[body] != 0) sole_neighbor[body] = kSeveral;
  }
  const auto add_neighbor = [&](std::uint32_t collider, std::uint32_t other) {
    if (!is_moved(scene, collider)) return;
    const std::uint32_t one =
        is_moved(scene, other) ? scene.colliders.body[other] : other | kStandingCollider;
    const std::uint32_t body = scene.colliders.body[collider];
    std::uint32_t& known = sole_neighbor[body];
    known = scene.bodies.asleep[body] == 0 && (known == kNone || known == one) ? one : kSeveral;
  };
  for (const Pair& pair : pairs) {
    add_neighbor(pair.collider_a, pair.collider_b);
    add_neighbor(pair.collider_b, pair.collider_a);
  }
}

/// Whether each of the pair's bodies is near to nothing but the other.
bool is_alone(const Scene& scene, const Pair& pair) {
  return scene.sole_neighbor[scene.colliders.body[pair.collider_a]] != kSeveral &&
         scene.sole_neighbor[scene.colliders.body[pair.collider_b]] != kSeveral;
}

/// Whether the contact point of the shape wanders as it rotates.
bool is_round(ShapeKind kind) {
  return kind == ShapeKind::kSphere || kind == ShapeKind::kCapsule || kind == ShapeKind::kCylinder ||
         kind == ShapeKind::kCone;
}

/// Whether rows of the step's start would be wrong before its end; see update_manifolds. Returns false if a
/// substep is too long for them as well: then the pair is held where it is now, or where the impact will be.
/// Returns false in a dense pile too, where refreshing would cost most and help least. It also does so where
/// several colliders hold a body, because in the middle of the step it is not tested which of them cover
/// which.
bool must_be_refreshed(const Scene& scene, const SweptCollider& a, const SweptCollider& b, Pair& pair,
                       Chunk& chunk) {
  if (!is_alone(scene, pair)) return false;
  const Convex& shape_a = scene.placed_shapes[a.row];
  const Convex& shape_b = scene.placed_shapes[b.row];
  const Real thin_a = thinness_of(shape_a);
  const Real thin_b = thinness_of(shape_b);
  const Real turn_a = rotation_reach(a);
  const Real turn_b = rotation_reach(b);
  const Real displacement = length(b.path.displacement - a.path.displacement);
  if (displacement + turn_a + turn_b >
      static_cast<Real>(scene.substeps) * std::max(kPointMargin, thin_a + thin_b))
    return false;
  const Real far =
      is_round(shape_a.shape.kind) || is_round(shape_b.shape.kind) ? kRollingTurn : kSpinningTurn;
  const bool rolls = (rotates_beyond(a.path, far) && turn_a > kStillSurface) ||
                     (rotates_beyond(b.path, far) && turn_b > kStillSurface);
  const bool flat =
      shape_a.shape.kind == ShapeKind::kHalfSpace || shape_b.shape.kind == ShapeKind::kHalfSpace;
  if (!rolls && (flat || displacement < std::max(kPointMargin, std::min(thin_a, thin_b)))) return false;
  if (restitution_of(scene, pair) > Real(0)) return false;  // rebounds know only the step's start
  if (rolls) return true;
  const std::size_t before = chunk.manifolds.size();
  test_view(scene, {shape_a, shape_b, a.path.center, b.path.center}, pair, chunk);
  const bool in_contact = std::any_of(
      chunk.manifolds.begin() + static_cast<std::ptrdiff_t>(before), chunk.manifolds.end(),
      [](const Manifold& m) {
        return std::any_of(m.point.begin(), m.point.begin() + m.point_count,
                           [](const state::ContactPoint& p) { return p.separation < kSlidingGap; });
      });
  chunk.manifolds.resize(before);
  return in_contact;
}

/// Tests the pair at its present pose; a fast pair is tested where it will meet, if it does.
void test_pair(const Scene& scene, Pair& pair, Chunk& chunk) {
  const Convex& now_a = scene.placed_shapes[pair.collider_a];
  const Convex& now_b = scene.placed_shapes[pair.collider_b];
  const Path path_a = path_ahead(scene.bodies, scene.colliders.body[pair.collider_a], scene.dt);
  const Path path_b = path_ahead(scene.bodies, scene.colliders.body[pair.collider_b], scene.dt);
  const SweptCollider a = {scene.colliders, pair.collider_a, path_a};
  const SweptCollider b = {scene.colliders, pair.collider_b, path_b};
  chunk.time = Real(0);
  chunk.is_whole = true;
  pair.refresh =
      must_be_refreshed(scene, a, b, pair, chunk) ? ContactRefresh::kEachSubstep : ContactRefresh::kAtStart;
  if (!pair.is_refreshed() && is_fast(a, b, now_a, now_b)) {
    chunk.is_whole = false;
    const auto impact =
        find_impact(a, b, std::min(kForeseenOverlap, overlap_allowance(a, b)), Real(0), chunk.sweep);
    chunk.time = impact ? impact->time : Real(0);
    if (impact) pair.refresh = ContactRefresh::kAtImpact;
    const Real beyond = std::min((Real(1) - chunk.time) * (chunk.margin - kPointMargin),
                                 thinness_of(now_a) + thinness_of(now_b));
    chunk.margin = impact ? kPointMargin + beyond : kPointMargin;
  }
  pair.time = chunk.time;
  if (!pair.is_refreshed() && chunk.time < kMiddle &&
      (rotates_beyond(path_a, kSpinningTurn) || rotates_beyond(path_b, kSpinningTurn)) &&
      stays_in_contact(scene, pair)) {
    chunk.time = kMiddle;
    pair.refresh = ContactRefresh::kInTheMiddle;
    chunk.is_whole = false;
    pair.time = Real(0);
  }
  if (!(chunk.time > Real(0))) {
    test_view(scene, {now_a, now_b, path_a.center, path_b.center}, pair, chunk);
    return;
  }
  const Pose pose_a = pose_at(path_a, chunk.time);
  const Pose pose_b = pose_at(path_b, chunk.time);
  const Convex then_a = place(scene.colliders, pair.collider_a, pose_a.rotation);
  const Convex then_b = place(scene.colliders, pair.collider_b, pose_b.rotation);
  test_view(scene, {then_a, then_b, pose_a.position, pose_b.position}, pair, chunk);
}

bool has_mesh(const Scene& scene, const Pair& pair) {
  return scene.placed_shapes[pair.collider_a].shape.kind == ShapeKind::kMesh ||
         scene.placed_shapes[pair.collider_b].shape.kind == ShapeKind::kMesh;
}

/// Whether the manifolds of the last step still hold: the bodies have hardly moved against each other since
/// the last test, and will not reach points that were too far apart to be kept.
bool can_reuse(const Scene& scene, const Pair& pair, std::uint32_t a, std::uint32_t b, Real margin) {
  if (!pair.tested || pair.manifold_count == 0 || pair.time > Real(0) || pair.is_refreshed()) return false;
  if (margin > Real(1.5) * kPointMargin) return false;
  const auto tolerance = [&scene](std::uint32_t body) {
    return is_dynamic(scene.bodies, body) ? scene.motions[body].tolerance : kPointMargin;
  };
  return largest_drift(scene.motions[a], scene.motions[b], pair.drift) < std::min(tolerance(a), tolerance(b));
}

void reuse_manifolds(const Scene& scene, const Pair& pair, Chunk& chunk) {
  const std::uint32_t a = scene.colliders.body[pair.collider_a];
  const std::uint32_t b = scene.colliders.body[pair.collider_b];
  for (std::uint32_t i = pair.first_manifold; i < pair.first_manifold + pair.manifold_count; ++i) {
    Manifold& manifold = chunk.manifolds.emplace_back(scene.old[i]);
    move_cached_manifold(scene.motions[a], scene.motions[b], is_dynamic(scene.bodies, b), manifold);
    describe(scene, pair, manifold.patch, manifold);
  }
}

/// Makes the pair's manifolds at the end of the chunk's; `first_manifold` counts from the chunk's begin.
void update_pair(const Scene& scene, Pair& pair, Chunk& chunk) {
  const std::uint32_t a = scene.colliders.body[pair.collider_a];
  const std::uint32_t b = scene.colliders.body[pair.collider_b];
  const auto begin = static_cast<std::uint32_t>(chunk.manifolds.size());
  add_drift(scene.motions[a], scene.motions[b], pair.drift);
  if (scene.bodies.traits[a].sensor || scene.bodies.traits[b].sensor) {
    // Sensors do not push; overlaps with them are found at the end of the step.
  } else if (state::rests(scene.bodies, scene.colliders, pair)) {
    ++chunk.counts.skipped;
    const auto old = scene.old.begin() + pair.first_manifold;
    chunk.manifolds.insert(chunk.manifolds.end(), old, old + pair.manifold_count);
  } else {
    const Real margin = margin_of(scene, a, b);
    pair.gap = gap_after(scene.motions[a], scene.motions[b], pair.gap);
    if (pair.tested && pair.manifold_count == 0 && pair.gap > margin) {
      ++chunk.counts.skipped;
    } else if (can_reuse(scene, pair, a, b, margin)) {
      ++chunk.counts.cached;
      reuse_manifolds(scene, pair, chunk);
      pair.refresh = ContactRefresh::kAtStart;
    } else {
      ++chunk.counts.tested;
      chunk.margin = margin;
      test_pair(scene, pair, chunk);
      if (pair.is_refreshed()) append_spares(scene, pair, begin, has_mesh(scene, pair), chunk);
      pair.drift = {};
      pair.tested = true;
    }
  }
  pair.first_manifold = begin;
  pair.manifold_count = static_cast<std::uint32_t>(chunk.manifolds.size()) - begin;
}

constexpr std::size_t kRefreshedChunk = 8;  // refreshed pairs of one buffer
constexpr std::uint32_t kMostSlots = 64;    // manifolds of a refreshed pair: more patches than a mesh makes

/// The manifold that a new one replaces: the one of the same patch, else the one of the most similar normal,
/// else a free one. `taken` are those that have been replaced, which are not all.
std::uint32_t find_slot(const Pair& pair, const Manifold& m, std::span<const Manifold> manifolds,
                        std::uint64_t taken) {
  const std::uint32_t count = std::min(pair.manifold_count, kMostSlots);
  std::uint32_t best = 0;
  Real closest = Real(-2);
  for (std::uint32_t i = 0; i < count; ++i) {
    if ((taken >> i & 1u) != 0) continue;
    const Manifold& old = manifolds[pair.first_manifold + i];
    if (old.point_count > 0 && old.patch == m.patch) return i;
    const Real likeness = old.point_count > 0 ? dot(old.normal, m.normal) : Real(0.99);
    if (!(likeness > closest)) continue;
    best = i;
    closest = likeness;
  }
  return best;
}

/// Moves the anchors halfway between the surfaces.
void center_anchors(Manifold& m) {
  for (std::int32_t i = 0; i < m.point_count; ++i) {
    state::ContactPoint& p = m.point[static_cast<std::size_t>(i)];
    const Vec3 half = (Real(0.5) * p.separation) * m.normal;
    p.anchor_a += half;
    p.anchor_b -= half;
  }
}

/// Time until the first of a manifold's points meets at the present velocities [s], and its separation [m].
struct Prospect {
  Real time = std::numeric_limits<Real>::infinity();
  Real separation = std::numeric_limits<Real>::infinity();

  friend bool operator<(const Prospect& p, const Prospect& q) {
    return p.time != q.time ? p.time < q.time : p.separation < q.separation;
  }
};

Prospect prospect_of(const state::Bodies& bodies, const Manifold& m) {
  Prospect first;
  for (std::int32_t i = 0; i < m.point_count; ++i) {
    const state::ContactPoint& p = m.point[static_cast<std::size_t>(i)];
    const Real parting = dot(m.normal, state::velocity_now(bodies, m.body_b, p.anchor_b) -
                                           state::velocity_now(bodies, m.body_a, p.anchor_a));
    Prospect of_point = {.separation = p.separation};
    if (!(p.separation > Real(0))) {
      of_point.time = Real(0);
    } else if (parting < Real(0)) {
      of_point.time = p.separation / -parting;
    }
    first = std::min(first, of_point);
  }
  return first;
}

/// If there are more manifolds than the pair has slots, keeps those that meet first. A fast pair searches
/// far, and what is behind the target must not take its slot.
void keep_earliest(const state::Bodies& bodies, std::size_t count, std::vector<Manifold>& manifolds) {
  while (manifolds.size() > count) {
    std::size_t last = 0;
    for (std::size_t i = 1; i < manifolds.size(); ++i) {
      if (!(prospect_of(bodies, manifolds[i]) < prospect_of(bodies, manifolds[last]))) last = i;
    }
    manifolds.erase(manifolds.begin() + static_cast<std::ptrdiff_t>(last));
  }
}

/// Replaces the manifolds of the pair, in place, by those of other poses.
void refresh_pair(const Scene& scene, const Pose& pose_a, const Pose& pose_b, Pair& pair, Chunk& chunk,
                  std::vector<Manifold>& manifolds) {
  const std::uint32_t a = scene.colliders.body[pair.collider_a];
  const std::uint32_t b = scene.colliders.body[pair.collider_b];
  const Convex shape_a = place(scene.colliders, pair.collider_a, pose_a.rotation);
  const Convex shape_b = place(scene.colliders, pair.collider_b, pose_b.rotation);
  chunk.manifolds.clear();
  chunk.margin = margin_of(scene, a, b);
  chunk.is_whole = true;
  chunk.time = Real(0);
  test_view(scene, {shape_a, shape_b, pose_a.position, pose_b.position}, pair, chunk);
  keep_earliest(scene.bodies, std::min(pair.manifold_count, kMostSlots), chunk.manifolds);
  std::uint64_t taken = 0;
  // All manifolds are matched with the old ones before those are replaced.
  std::array<std::uint32_t, kMostSlots> slot_of = {};
  for (std::size_t i = 0; i < chunk.manifolds.size(); ++i) {
    slot_of[i] = find_slot(pair, chunk.manifolds[i], manifolds, taken);
    taken |= std::uint64_t{1} << slot_of[i];
  }
  for (std::uint32_t i = 0; i < pair.manifold_count; ++i) {
    Manifold& m = manifolds[pair.first_manifold + i];
    m.point_count = 0;
    m.friction_impulse = {};
    m.twist_impulse = Real(0);
  }
  for (std::size_t i = 0; i < chunk.manifolds.size(); ++i) {
    Manifold& m = manifolds[pair.first_manifold + slot_of[i]];
    const Real largest = m.largest_impulse;
    const state::ContactRoute route = m.route;
    m = chunk.manifolds[i];
    m.largest_impulse = largest;
    m.refresh = pair.refresh;
    m.route = route;
    center_anchors(m);
  }
}

/// A manifold with something that nothing moves, seen from the collider that it holds.
struct Support {
  std::uint32_t held = 0;  ///< The held collider.
  std::uint32_t manifold = 0;
};

/// Lists the supports. Manifolds of later in the step are left out, because only positions of one time can be
/// compared. So are those that rest: they were tested before.
void find_supports(const Scene& scene, const state::Pairs& pairs, std::vector<Support>& supports) {
  supports.clear();
  for (const Pair& pair : pairs.pair) {
    const bool a_moved = is_moved(scene, pair.collider_a);
    if (pair.time > Real(0) || a_moved == is_moved(scene, pair.collider_b)) continue;
    if (state::rests(scene.bodies, scene.colliders, pair)) continue;
    const std::uint32_t held = a_moved ? pair.collider_a : pair.collider_b;
    for (std::uint32_t i = pair.first_manifold; i < pair.first_manifold + pair.manifold_count; ++i) {
      if (pairs.manifold[i].point_count > 0) supports.push_back({held, i});
    }
  }
  std::sort(supports.begin(), supports.end(), [](const Support& p, const Support& q) {
    return p.held != q.held ? p.held < q.held : p.manifold < q.manifold;
  });
}

/// Memory for empty_ghosts.
struct GhostScratch {
  std::vector<Support> supports = {};
  std::vector<SurfaceContact> contacts = {};
  Ghosts found = {};
  std::vector<std::uint32_t> ghosts = {};  // rows of manifolds
};

/// The manifold as a contact with a piece of surface, in the neighborhood of the held body.
SurfaceContact contact_of(const Scene& scene, const Manifold& m, const Support& support) {
  const bool a_held = support.held == m.collider_a;
  const std::uint32_t piece = a_held ? m.collider_b : m.collider_a;
  const std::uint32_t body = a_held ? m.body_a : m.body_b;
  const DVec3 piece_from = scene.bodies.center[scene.colliders.body[piece]] - scene.bodies.center[body];
  SurfaceContact contact = {scene.placed_shapes[piece], support.manifold, a_held ? -m.normal : m.normal};
  if (contact.piece.shape.kind == ShapeKind::kMesh) {
    contact.piece = place_mesh(scene.colliders.shape[piece], contact.piece, -piece_from).triangle(m.patch);
  } else {
    contact.piece.center += vector_cast<Real>(piece_from);
  }
  const auto* deepest = std::min_element(
      m.point.data(), m.point.data() + m.point_count,
      [](const state::ContactPoint& p, const state::ContactPoint& q) { return p.separation < q.separation; });
  contact.place = (a_held ? deepest->anchor_a : deepest->anchor_b) - deepest->separation * contact.normal;
  const Convex& held = scene.placed_shapes[support.held];
  contact.separation = dot(contact.normal, support_of(held, -contact.normal) - contact.place) - skin_of(held);
  return contact;
}

/// Removes the manifolds that others of the same collider cover. Returns how many it removed.
std::uint32_t empty_ghosts(const Scene& scene, GhostScratch& scratch, state::Pairs& pairs) {
  auto& [supports, contacts, found, ghosts] = scratch;
  find_supports(scene, pairs, supports);
  ghosts.clear();
  for (std::size_t begin = 0, end = 0; begin < supports.size(); begin = end) {
    while (end < supports.size() && supports[end].held == supports[begin].held) ++end;
    if (end - begin < 2) continue;
    contacts.clear();
    for (std::size_t i = begin; i < end; ++i) {
      contacts.push_back(contact_of(scene, pairs.manifold[supports[i].manifold], supports[i]));
    }
    find_ghosts(contacts, Pieces::kOfMany, found);
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      if (found.is_ghost[i] != 0) ghosts.push_back(contacts[i].index);
    }
  }
  for (const std::uint32_t i : ghosts) pairs.manifold[i].point_count = 0;
  if (!ghosts.empty()) remove_empty(pairs);
  return static_cast<std::uint32_t>(ghosts.size());
}

/// Marks the colliders of pairs that do not rest.
void find_tested(const state::Bodies& bodies, const state::Colliders& colliders, std::span<const Pair> pairs,
                 std::vector<std::uint8_t>& tested) {
  tested.assign(colliders.body.size(), 0);
  for (const Pair& pair : pairs) {
    if (!state::rests(bodies, colliders, pair)) tested[pair.collider_a] = tested[pair.collider_b] = 1;
  }
}

void place_tested_shapes(parallel::ThreadPool& pool, const state::Bodies& bodies,
                         const state::Colliders& colliders, std::span<const std::uint8_t> tested,
                         std::vector<Convex>& placed_shapes) {
  placed_shapes.resize(colliders.body.size());
  for_ranges(pool, colliders.count(), kColliderGrain, [&](Range range) {
    for (int i = range.begin; i < range.end; ++i) {
      const auto row = static_cast<std::uint32_t>(i);
      if (tested[row] != 0) placed_shapes[row] = place(colliders, row, bodies.rotation[colliders.body[row]]);
    }
  });
}

Range pairs_of(std::size_t chunk, std::size_t pair_count) {
  const int begin = static_cast<int>(chunk) * kChunk;
  return {begin, std::min(begin + kChunk, static_cast<int>(pair_count))};
}

/// Joins the chunks' manifolds in order. Returns the sum of their counts.
NarrowPhaseCounts join(parallel::ThreadPool& pool, std::span<const Chunk> chunks,
                       std::vector<std::size_t>& first, state::Pairs& pairs) {
  NarrowPhaseCounts counts;
  first.assign(1, 0);
  for (const Chunk& chunk : chunks) {
    first.push_back(first.back() + chunk.manifolds.size());
    counts.tested += chunk.counts.tested;
    counts.cached += chunk.counts.cached;
    counts.skipped += chunk.counts.skipped;
  }
  pairs.manifold.resize(first.back());
  for_ranges(pool, static_cast<int>(chunks.size()), kChunkGrain, [&](Range range) {
    for (auto c = static_cast<std::size_t>(range.begin); c < static_cast<std::size_t>(range.end); ++c) {
      std::copy(chunks[c].manifolds.begin(), chunks[c].manifolds.end(),
                pairs.manifold.begin() + static_cast<std::ptrdiff_t>(first[c]));
      const Range of = pairs_of(c, pairs.pair.size());
      for (int i = of.begin; i < of.end; ++i) {
        pairs.pair[static_cast<std::size_t>(i)].first_manifold += static_cast<std::uint32_t>(first[c]);
      }
    }
  });
  return counts;
}

}  // namespace

struct NarrowPhase::Buffers {
  std::vector<std::uint8_t> tested = {};
  std::vector<Convex> placed_shapes = {};
  std::vector<Manifold> old = {};
  SmallMotions motions = {};
  std::vector<std::uint32_t> all_bodies = {};  ///< Rows of all bodies, for a step that has no moved set.
  std::vector<std::uint32_t> sole_neighbor = {};
  std::vector<Chunk> chunks = {};
  std::vector<std::size_t> first_manifold = {};  ///< First manifold of each chunk; one more at the end.
  GhostScratch ghosts = {};
  std::vector<std::uint32_t> refreshed = {};  ///< Rows of refreshed pairs, ascending.
  std::vector<Chunk> refreshed_chunks = {};
  Chunk single_chunk = {};  ///< Chunk of refresh_at.
};

NarrowPhase::NarrowPhase() : buffers_(std::make_unique<Buffers>()) {}
NarrowPhase::~NarrowPhase() = default;
NarrowPhase::NarrowPhase(NarrowPhase&&) noexcept = default;
NarrowPhase& NarrowPhase::operator=(NarrowPhase&&) noexcept = default;

NarrowPhaseCounts NarrowPhase::update_manifolds(parallel::ThreadPool& pool, const state::Bodies& bodies,
                                                const state::Colliders& colliders,
                                                std::span<const MaterialPairDesc> materials,
                                                const NarrowPhaseStep& step, state::Pairs& pairs) {
  auto& [tested, placed_shapes, old, motions, all_bodies, sole_neighbor, all_chunks, first_manifold, ghosts,
         refreshed, refreshed_chunks, single_chunk] = *buffers_;
  if (!step.moved_set) {
    all_bodies.resize(bodies.traits.size());
    std::iota(all_bodies.begin(), all_bodies.end(), std::uint32_t{0});
  }
  find_tested(bodies, colliders, pairs.pair, tested);
  place_tested_shapes(pool, bodies, colliders, tested, placed_shapes);
  motions.find(pool, bodies, step.moved_set.value_or(all_bodies), pairs.seen);
  base::take_turns(pairs.manifold, old);
  Scene scene = {bodies,        colliders,     materials, step.dt,
                 step.substeps, placed_shapes, old,       motions.of_bodies()};
  find_sole_neighbors(scene, pairs.pair, step.has_several_neighbors, sole_neighbor);
  scene.sole_neighbor = sole_neighbor;
  const std::size_t chunk_count = (pairs.pair.size() + kChunk - 1) / kChunk;
  if (all_chunks.size() < chunk_count) all_chunks.resize(chunk_count);
  const std::span<Chunk> chunks = std::span(all_chunks).first(chunk_count);
  // Pairs of a mesh stand next to each other, and cost more than others.
  for_items(pool, static_cast<int>(chunks.size()), [&](int item) {
    Chunk& chunk = chunks[static_cast<std::size_t>(item)];
    const Range of = pairs_of(static_cast<std::size_t>(item), pairs.pair.size());
    chunk.clear();
    for (int i = of.begin; i < of.end; ++i)
      update_pair(scene, pairs.pair[static_cast<std::size_t>(i)], chunk);
  });
  NarrowPhaseCounts counts = join(pool, chunks, first_manifold, pairs);
  counts.ghosts = empty_ghosts(scene, ghosts, pairs);
  return counts;
}

void NarrowPhase::list_refreshed(const state::Pairs& pairs) {
  std::vector<std::uint32_t>& refreshed = buffers_->refreshed;
  refreshed.clear();
  for (std::uint32_t i = 0; i < pairs.pair.size(); ++i) {
    if (pairs.pair[i].is_refreshed() && pairs.pair[i].manifold_count > 0) refreshed.push_back(i);
  }
}

void NarrowPhase::refresh_manifolds(parallel::ThreadPool& pool, const state::Bodies& bodies,
                                    const state::Colliders& colliders,
                                    std::span<const MaterialPairDesc> materials, Real h,
                                    state::Pairs& pairs) {
  const std::vector<std::uint32_t>& rows = buffers_->refreshed;
  std::vector<Chunk>& chunks = buffers_->refreshed_chunks;
  const Scene scene = {
      .bodies = bodies, .colliders = colliders, .materials = materials, .dt = h, .old = pairs.manifold};
  const std::size_t count = (rows.size() + kRefreshedChunk - 1) / kRefreshedChunk;
  if (chunks.size() < count) chunks.resize(count);
  for_items(pool, static_cast<int>(count), [&](int item) {
    const std::size_t begin = static_cast<std::size_t>(item) * kRefreshedChunk;
    for (std::size_t i = begin; i < std::min(begin + kRefreshedChunk, rows.size()); ++i) {
      HOOKE_ASSERT(rows[i] < pairs.pair.size());
      Pair& pair = pairs.pair[rows[i]];
      HOOKE_ASSERT(pair.is_refreshed() && pair.manifold_count > 0);
      HOOKE_ASSERT(pair.first_manifold + pair.manifold_count <= pairs.manifold.size());
      const Pose a = state::pose_now(bodies, colliders.body[pair.collider_a]);
      const Pose b = state::pose_now(bodies, colliders.body[pair.collider_b]);
      refresh_pair(scene, a, b, pair, chunks[static_cast<std::size_t>(item)], pairs.manifold);
    }
  });
}

void NarrowPhase::refresh_at(const state::Bodies& bodies, const state::Colliders& colliders,
                             std::span<const MaterialPairDesc> materials, Real h, const PosedPair& posed,
                             state::Pairs& pairs) {
  const Scene scene = {
      .bodies = bodies, .colliders = colliders, .materials = materials, .dt = h, .old = pairs.manifold};
  refresh_pair(scene, posed.a, posed.b, pairs.pair[posed.pair], buffers_->single_chunk, pairs.manifold);
}

}  // namespace hooke::collision
