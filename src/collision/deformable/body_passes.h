#pragma once

#include "hooke/math.h"

#include "collision/deformable/contact_frames.h"
#include "collision/deformable/element_sweep.h"
#include "geometry/box.h"
#include "parallel/thread_pool.h"
#include "state/body_frames.h"
#include "state/tables.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Keeps bodies from passing through the faces and segments of deformables, whatever the solver has left:
/// convex shapes, also between points, at any speed. docs/decisions/0044-bodies-that-pass-nothing.md.

namespace hooke::collision {

/// Memory of the stages that keep bodies from passing. Nothing in it lives from step to step but memory:
/// which normal proves that two are apart decides, within a tenth of the distance they keep, whether they
/// have a row.
struct BodyPassFinder {
  /// A face of a cloth or solid, or a segment of a rope.
  struct Element {
    std::array<std::uint32_t, 3> particle = {};  ///< For a segment the last two are the same.
    std::uint32_t count = 0;
  };

  static constexpr std::uint32_t kNoRow = 0xFFFFFFFF;

  /// An element and a shape that may meet.
  struct Candidate {
    std::uint32_t element = 0;
    Vec3 normal = {};  ///< Unit vector from the shape to the element; zero when none is known.
    /// The two are apart while the pair has used less than this [m]: their distance when it was found, and
    /// what was used by then.
    Real free = Real(0);
    std::uint32_t row = kNoRow;  ///< Its row of `passes` in this particle substep.
    bool crossed = false;        ///< They cross each other since the step began, so that no side is known.
  };

  /// An object and a shape, with a row of candidates.
  struct Pair {
    std::uint32_t object = 0;
    std::uint32_t collider = 0;
    std::uint32_t body = 0;
    std::uint32_t first = 0, end = 0;  ///< Rows of `candidates`.
    Real friction = Real(0);
    Real inset = Real(0);  ///< How far within its surface the shape is kept from elements [m].
    Real moves = Real(0);  ///< Upper bound of how far two of its points move relative to each other [m].
    Real used = Real(0);   ///< Sum of these distances since candidates were listed [m].
    bool spans = false;    ///< The body is larger than any element.
    /// The body is so thin that it may touch beside a point, nearer to it than kPointShare, and miss it.
    bool may_miss_points = false;
    bool strays = false;     ///< Points or body do not move as they did when they were swept.
    MovingShape shape = {};  ///< From the object's origin, with its motion in this particle substep.
    Pose begin = {};         ///< Center of mass and rotation of the body when that began.
  };

  /// What an object does in a step.
  struct Object {
    std::uint32_t first = 0, end = 0;  ///< Rows of `elements`.
    std::uint32_t first_block = 0;     ///< Row of `blocks`; one for each `kBlock` elements.
    Real longest = Real(0);            ///< Longest edge of its elements at rest [m].
    Real reach = Real(0);              ///< Candidates are complete until points have gone this far [m].
    Real gone = Real(0);               ///< Upper bound of how far they have gone [m].
    Real moves = Real(0);              ///< Upper bound of how far they move in this particle substep [m].
    Real near = Real(0);               ///< Largest distance that one of its elements keeps [m].
    Real least_near = Real(0);         ///< The least of these [m].
    Real strays = Real(0);             ///< Largest distance of a point from where it was expected [m].
  };

  /// A suspect that meets.
  struct Found {
    bool met = false;
    Real share = Real(0);  ///< Share of the substep after which they meet.
    state::ElementContact row = {};
  };

  static constexpr std::uint32_t kBlock = 16;

  std::uint64_t revision = ~std::uint64_t{0};
  std::vector<Element> elements;  ///< Of all objects, in order.
  std::vector<Object> objects;
  std::vector<geometry::Box> blocks;  ///< From the object's origin.
  bool strayed = false;               ///< Zones have moved things otherwise than was foreseen.
  std::vector<Pair> pairs;            ///< In order of object and collider.
  std::vector<Candidate> candidates;
  std::vector<Real> body_reach;  ///< By body: candidates are complete until it has gone this far [m].
  std::vector<Real> body_gone;   ///< By body: upper bound of how far it has gone in this step [m].
  std::vector<state::ElementContact> passes;  ///< Those that would meet within the substep, by time.
  std::vector<state::PositionRecord> start;   ///< By particle: where it began the particle substep [m].
  std::vector<state::BodyMotion> body_start;  ///< By body, when the particle substep began.
  std::vector<std::uint8_t> flags;            ///< By candidate: scratch memory.
  std::vector<std::uint32_t> suspects;        ///< Scratch memory: candidates that may meet.
  std::vector<std::uint32_t> suspect_pair;    ///< Scratch memory.
  std::vector<Found> found;                   ///< Scratch memory: by suspect.
  std::vector<std::uint32_t> colliders;       ///< Those that deformables may touch.
  std::vector<Hooked> hooked;                 ///< Points that may be in bodies.
};

/// A particle substep in which bodies might pass.
struct PassSubstep {
  Real h = Real(0);     ///< Length of the particle substep [s].
  Real left = Real(0);  ///< Rest of the step, this substep included [s].
  bool first = false;   ///< It has not been swept yet.
  /// By object: not 0 if it is solved as a whole, with the contacts of its points.
  std::span<const std::uint8_t> solved_whole = {};
};

/// Lists the elements and shapes that may meet within `dt` [s].
void find_body_passes(const state::Tables& tables, Real dt, BodyPassFinder& finder);

/// Notes where points and bodies begin a particle substep, before anything moves them.
void begin_body_passes(const state::Tables& tables, BodyPassFinder& finder);

/// Makes a row of `passes` for each element and shape that would come nearer to each other in this substep
/// than they may, at their velocities. New ones follow those that there are, in order of time. `separation`
/// is how much nearer they may come along the normal. Lists candidates anew if something is faster than was
/// foreseen. Returns whether there are rows that were not there before, or not so.
bool sweep_body_passes(parallel::ThreadPool& pool, const state::Tables& tables, const PassSubstep& substep,
                       BodyPassFinder& finder);

/// Lists the faces of objects that are solved as a whole and the shapes that press on them within this
/// substep, or are nearly so near that stress may press them together, as rows that keep the two apart. Left
/// out is what moves by more than a share of an edge (kSlowFaceShare): where that will touch is not known
/// before it has been stopped. Changes nothing that sweeps look at.
void find_pressed_faces(parallel::ThreadPool& pool, const state::Tables& tables, const PassSubstep& substep,
                        BodyPassFinder& finder, std::vector<state::ElementContact>& faces);

/// After points and bodies have moved by a particle substep of `h` [s]: lists in `suspects` and
/// `suspect_pair` the candidates that have come through each other, or nearer than they may for certain.
/// Looks at those that have rows, and at all of a pair that has not moved as it was swept.
void look_at_body_passes(parallel::ThreadPool& pool, const state::Tables& tables, Real h,
                         BodyPassFinder& finder);

/// Makes the next sweep begin without rows. `passes` stay until then.
void forget_body_passes(BodyPassFinder& finder);

/// Ends a particle substep. With `forget`, nothing is known of how far candidates are apart.
void end_body_passes(bool forget, BodyPassFinder& finder);

}  // namespace hooke::collision
