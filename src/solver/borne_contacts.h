#pragma once

#include "solver/body_contacts.h"
#include "solver/joints.h"
#include "state/tables.h"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

/// \file
/// Contacts of heavy bodies with light ones that hang on hooks: a ton on the planks of a rope bridge.
///
/// Rows of contacts know only the mass of a plank, and pass on at most what stops it: m v in a substep,
/// however firmly its ropes hold it. So they are rows of the bundle (solver/bundles.h) of the ropes and hooks
/// that the plank hangs on, and solved with them. What the heavy body lies on through others, a board on the
/// planks, is borne too.
///
/// Light bodies turn far within a step, and are thin: such pairs are looked at anew in each substep.
///
/// The order of calls:
///   find_holding                                       when hooks or bodies came or went
///   find_borne_contacts                                once a step, before rows of contacts are made
///   store_borne_contacts, then place_borne_contacts    each substep, before and after that look
///   store_borne_contacts                               once a step

namespace hooke::solver {

/// From this ratio of masses on contacts are borne; and from this ratio of the load to the weight of what
/// hangs.
inline constexpr Real kBorneMass = Real(2);
inline constexpr Real kBorneLoad = Real(1);

/// How many may be borne in a step: some milliseconds.
inline constexpr std::size_t kMostBorneManifolds = 64;

/// How a body can hold another that lies on it.
enum class Holding : std::uint8_t {
  kNone,
  kHooked,  ///< Part of an articulation that hangs on nothing.
  kHangs,   ///< On a point, or part of an articulation that something holds.
  kBorne,   ///< Lies on such.
};

/// What each body holds by its hooks; to be found again when hooks or bodies come or go. Bodies of nets hold
/// nothing: nets are relaxed.
void find_holding(const Joints& joints, const state::Bodies& bodies, const std::vector<state::Hook>& hooks,
                  std::vector<Holding>& holding);

/// Memory of find_borne_contacts.
struct BorneScratch {
  std::vector<Holding> holding;  ///< By body.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> borne_before;
  std::vector<std::uint8_t> bears;  ///< By body: whether it is in a borne contact.
};

/// Fills `pairs.borne`, and says which hooks between bodies bear. What is borne by a body that hangs is
/// heavier than it, or presses harder than that; it may be hooked itself (`hooked`, by body row), as the
/// wheel of a cart is, but does not hang. Contacts that bounce are not borne. `impulse_to_force` is that of
/// the impulses that manifolds have from the last step [1/s].
void find_borne_contacts(const ContactStep& step, Real impulse_to_force, const Joints& joints,
                         std::span<const std::uint8_t> hooked, std::span<const Holding> holding,
                         const state::Bodies& bodies, std::vector<state::Hook>& hooks, state::Pairs& pairs,
                         BorneScratch& scratch);

/// Forces and separations by what the manifolds say now.
void place_borne_contacts(Real impulse_to_force, const state::Bodies& bodies, state::Pairs& pairs);

/// Gives the manifolds the impulses of their last substep, of length h [s].
void store_borne_contacts(Real h, state::Pairs& pairs);

}  // namespace hooke::solver
