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
/// Impacts that bounce, one by one in the order of their times within a substep, each where the bodies are
/// then.
///
/// In free flight a semi-implicit substep of length h from the velocity v (that of the middle of the substep)
/// is the parabola x(t) = x_0 + (v - a h/2) t + a t^2/2 at both of its ends, with the speed v + a (t - h/2)
/// between them. So, along the normal,
///
///   time       0 = g_0 + (v - a h/2) t + a t^2/2
///   speed      u = v + a (t - h/2)
///   rebound    u' >= -e u for all points that meet then, with impulses >= 0 and their friction
///   position   dx += t (v - v'), so that the rest of the substep ends on the parabola after the impact
///
/// which keeps the energy of that flight to rounding. Impulses act on both bodies at one position, halfway
/// between the surfaces at the time of the impact: that keeps linear and angular momentum. If a body then
/// reaches its neighbors within the same substep, it collides with them too, one after the other.
///
/// In dense piles that is not affordable, nor would it be right: impulses run to and fro in a heap. There
/// only pairs bounce that did not touch in the last step, once in a step, and from a higher speed on.
///
/// A body that rests against something that does not bounce does not take an impact alone. If what is behind
/// it, directly or through others, does not give way, it does not either: the ground takes the impulse. Such
/// a body can only be pushed across that direction.
///
/// A body on hooks takes an impact as if it were free, and its joints then give the speed v" with which it
/// goes on. Joints may go against the impact, as on a rail at an angle to the wall. Then the body is not
/// moved by t (v - v'): its joints would find it off the rail, and the speed with which they bring it back
/// would be energy from nothing. So its joints are solved where it was before the impacts, and it is moved by
/// t (v - v") after them, with t the mean time of its impacts.

namespace hooke::solver {

/// A pair of colliders that may bounce.
struct ImpactPair {
  std::uint32_t pair = 0;  ///< Row of the pair.
  std::uint32_t a = 0;     ///< Body row.
  std::uint32_t b = 0;
  std::uint32_t first_lane = 0;
  std::uint32_t lane_count = 0;
  bool a_is_backed = false;  ///< Something that does not give way holds the body against the impulse.
  bool b_is_backed = false;
  bool a_is_hooked = false;
  bool b_is_hooked = false;
  bool in_dense_pile = false;
  // Valid for one substep.
  Real time = Real(0);  ///< Time of its next impact by its rows [s]; or kNever.
  int refreshes = 0;    ///< How often its manifolds were refreshed for that impact.
  int count = 0;        ///< Number of its impacts; in a dense pile, in the whole step.
};

/// A body on hooks with impacts in a substep.
struct HookedImpact {
  struct Motion {
    state::MotionRecord record = {};
    Quat rotation = {};
  };
  std::uint32_t body = 0;
  int count = 0;            ///< Number of its impacts.
  Real time_sum = Real(0);  ///< Sum of their times [s].
  Motion before = {};       ///< Motion before the first impact.
  bool is_reset = false;    ///< Its joints go against its impacts.
};

/// The next impact.
struct NextImpact {
  std::uint32_t index = 0;  ///< Index into Impacts::pairs.
  Real time = Real(0);      ///< [s]
};

struct Impacts {
  static constexpr Real kNever = Real(1e30);

  std::vector<ImpactPair> pairs;  ///< In order of their rows.
  std::vector<ContactLane> lanes;
  std::vector<std::uint32_t> pairs_of_body;  ///< Those of body i begin at pairs_begin[i].
  std::vector<std::uint32_t> pairs_begin;
  // Valid for one substep.
  std::vector<NextImpact> queue;  ///< A heap; entries whose time is no longer that of their pair are void.
  std::vector<Real> since;        ///< For each body: the time of its last impact [s].
  std::vector<std::uint32_t> impacted;
  std::vector<HookedImpact> hooked_impacts;
  // Memory of list_impact_pairs.
  struct Support {
    std::uint32_t body = 0;
    std::uint32_t other = 0;  ///< The body that holds it.
    Vec3 outward = {};
  };
  std::vector<Support> supports;
  std::vector<std::int32_t> lane_of;
};

/// Lanes of the pair's manifolds.
[[nodiscard]] std::span<const ContactLane> lanes_of(const ImpactPair& pair, const Impacts& impacts);

/// Lists the pairs that may bounce. Once a step, after prepare_body_contacts. `hooked` is 1 for each body on
/// hooks.
void list_impact_pairs(const state::Pairs& pairs, const state::Bodies& bodies,
                       const std::vector<std::uint8_t>& hooked, const BodyContacts& contacts,
                       Impacts& impacts);

/// Predicts when the rows of each pair meet within the substep. False if none do. It follows
/// accelerate_bodies. Velocities are those before contacts: repeated impulses of contacts would be taken for
/// motion. The rows of pairs that are not at rest begin the substep without these impulses.
[[nodiscard]] bool predict_impacts(const ContactStep& step, const std::vector<state::Manifold>& manifolds,
                                   BodyContacts& contacts, state::Bodies& bodies, Impacts& impacts);

/// Returns the earliest impact; of two at one time, that of the lower row.
[[nodiscard]] std::optional<NextImpact> next_impact(Impacts& impacts);

/// Solves the impact of a pair whose manifolds are those of that time. If its rows now give another time, the
/// pair waits for that one. Brings the rows of the pair up to date.
void resolve_impact(const NextImpact& impact, const ContactStep& step, const state::Pairs& pairs,
                    BodyContacts& contacts, state::Bodies& bodies, Impacts& impacts);

/// Called after the last impact. Bodies whose hooks go against their impacts are put back to where they were,
/// with the velocities that the impacts gave them. The others are removed from the list.
void reset_hooked_bodies(const std::vector<state::Hook>& hooks, Real h, state::Bodies& bodies,
                         Impacts& impacts);

/// Called after solve_joints: continues the straight motion of these bodies from their impacts on.
void propagate_impacts(state::Bodies& bodies, Impacts& impacts);

}  // namespace hooke::solver
