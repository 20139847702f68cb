#pragma once

#include "hooke/math.h"

#include "solver/contact/body_contacts.h"
#include "state/bodies.h"
#include "state/hooks.h"
#include "state/manifolds.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

/// \file
/// Hits that bounce, one by one in the order of their times within a substep, each where the bodies are then.
///
/// In free flight a semi-implicit substep of length h from the velocity v (that of the middle of the substep)
/// is the parabola x(t) = x_0 + (v - a h/2) t + a t^2/2 at both of its ends, with the speed v + a (t - h/2)
/// between them. So, along the normal,
///
///   time       0 = g_0 + (v - a h/2) t + a t^2/2
///   speed      u = v + a (t - h/2)
///   rebound    u' >= -e u for all points that meet then, with impulses >= 0 and their friction
///   position   dx += t (v - v'), so that the rest of the substep ends on the parabola after the hit
///
/// which keeps the energy of that flight to rounding. Impulses act on both bodies at one place, halfway
/// between the surfaces at the time of the hit: that keeps linear and angular momentum. Neighbors that a
/// struck body reaches within the same substep are struck by it then, one after the other.
///
/// In crowds that is not affordable, nor would it be right: impulses run to and fro in a heap. There only
/// pairs bounce that did not touch in the last step, once in a step, and from a higher speed on.
///
/// A body that rests against something that does not bounce is not struck alone. If what is behind it,
/// directly or through others, does not give way, it does not either: the ground takes the impulse. Only
/// across it can such a body be pushed.
///
/// A body on hooks is struck as if it were free, and its joints then say with what speed v" it goes on. Where
/// they go against the hit, as on a rail at an angle to the wall, it is not moved by t (v - v'): they would
/// find it off the rail, and the speed with which they bring it back would be energy that nobody gave. So its
/// joints are solved where it was before the hits, and it is moved by t (v - v") after them, t the mean of
/// its times.

namespace hooke::solver {

/// A pair of colliders that may bounce.
struct ImpactPair {
  std::uint32_t pair = 0;  ///< Row.
  std::uint32_t a = 0;     ///< Bodies.
  std::uint32_t b = 0;
  std::uint32_t first_lane = 0;
  std::uint32_t lane_count = 0;
  bool a_is_backed = false;  ///< By what does not give way, against the impulse.
  bool b_is_backed = false;
  bool a_is_hooked = false;
  bool b_is_hooked = false;
  bool in_dense_pile = false;
  // Of the substep.
  Real time = Real(0);  ///< Of its next hit, as its rows have it [s]; kNever.
  int refreshes = 0;    ///< At its shapes, for that hit.
  int count = 0;        ///< Of its hits; in a crowd, of the step.
};

/// A body on hooks that is hit in a substep.
struct HookedImpact {
  struct Motion {
    state::MotionRecord record = {};
    Quat rotation = {};
  };
  std::uint32_t body = 0;
  int count = 0;            ///< Of its hits.
  Real time_sum = Real(0);  ///< [s]
  Motion before = {};       ///< As it was before the first.
  bool is_reset = false;    ///< Its joints go against its hits.
};

/// What is next.
struct NextImpact {
  std::uint32_t index = 0;  ///< In Hits::pairs.
  Real time = Real(0);      ///< [s]
};

struct Impacts {
  static constexpr Real kNever = Real(1e30);

  std::vector<ImpactPair> pairs;  ///< In order of their rows.
  std::vector<ContactLane> lanes;
  std::vector<std::uint32_t> pairs_of_body;  ///< Those of body i begin at pairs_begin[i].
  std::vector<std::uint32_t> pairs_begin;
  // Of the substep.
  std::vector<NextImpact> queue;  ///< A heap; one whose time is no longer that of its pair is void.
  std::vector<Real> since;        ///< Of each body: when it was hit last [s].
  std::vector<std::uint32_t> impacted;
  std::vector<HookedImpact> hooked_impacts;
  // Memory of list_hits.
  struct Support {
    std::uint32_t body = 0;
    std::uint32_t other = 0;  ///< What holds it.
    Vec3 outward = {};
  };
  std::vector<Support> supports;
  std::vector<std::int32_t> lane_of;
};

/// Lanes of the pair's manifolds.
[[nodiscard]] std::span<const ContactLane> lanes_of(const ImpactPair& pair, const Impacts& impacts);

/// Once a step, after prepare_body_contacts: the pairs that may bounce. `hooked`: 1 for each body on hooks.
void list_impact_pairs(const state::Pairs& pairs, const state::Bodies& bodies,
                       const std::vector<std::uint8_t>& hooked, const BodyContacts& contacts,
                       Impacts& impacts);

/// After accelerate_bodies: when the rows of each pair meet within the substep. False if none do. Velocities
/// are those before contacts: what is repeated of their impulses would be taken for motion. The rows of pairs
/// that are not at rest begin the substep without them.
[[nodiscard]] bool predict_impacts(const ContactStep& step, BodyContacts& contacts, state::Bodies& bodies,
                                   Impacts& impacts);

/// The earliest; of two at one time the one of the lower row.
[[nodiscard]] std::optional<NextImpact> next_impact(Impacts& impacts);

/// Takes the hit of a pair whose manifolds are those of that time; if its rows now say another time, it waits
/// for that one. Brings the rows of the pair up to date.
void resolve_impact(const NextImpact& impact, const ContactStep& step, const state::Pairs& pairs,
                    BodyContacts& contacts, state::Bodies& bodies, Impacts& impacts);

/// After the last hit: bodies whose hooks go against their hits are where they were, with the velocities that
/// hits gave them. The others are forgotten.
void reset_hooked_bodies(const std::vector<state::Hook>& hooks, Real h, state::Bodies& bodies,
                         Impacts& impacts);

/// After solve_joints: the lines of these bodies lead from their hits on.
void propagate_impacts(state::Bodies& bodies, Impacts& impacts);

}  // namespace hooke::solver
