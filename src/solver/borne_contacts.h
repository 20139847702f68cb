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
/// The same goes for a light body between the ground and what it is hooked to, as the leg of a heavy table
/// is: the joint brings all the weight, and its contact with the ground takes m v of the leg.
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

/// From this ratio on between a body and one that it is locked to, its contacts with the ground are borne;
/// from the second on between it and all that hang together with it, if it presses on the ground with so many
/// times its weight, or did in the last step and presses with a quarter of that still. Ragdolls
/// (loose_trees.h) are left out.
inline constexpr Real kPressedMass = Real(8);
inline constexpr Real kPressedGroup = Real(25);
inline constexpr Real kPressedLoad = Real(20);

/// How many may be borne in a step: some milliseconds.
inline constexpr std::size_t kMostBorneManifolds = 64;

/// How a body can hold another that lies on it.
enum class Holding : std::uint8_t {
  kNone,
  kHooked,  ///< Part of an articulation that hangs on nothing.
  kHangs,   ///< On a point, or part of an articulation that something holds.
  kBorne,   ///< Lies on such.
};

/// What may press a body on the ground [kg].
struct Burden {
  Real neighbor = Real(0);  ///< The heaviest that a hook holds at its place on it, or at a distance from it.
  Real group = Real(0);     ///< Its articulation, with what lies on that.
};

/// What bodies hold by their hooks, by body row.
struct Holders {
  std::vector<Holding> holding;
  std::vector<Burden> burden;
};

/// To be found again when hooks or bodies come or go. Bodies of nets hold nothing: nets are relaxed.
void find_holders(const Joints& joints, const state::Bodies& bodies, const std::vector<state::Hook>& hooks,
                  Holders& holders);

/// Memory of find_borne_contacts.
struct BorneScratch {
  Holders holders;
  std::vector<Real> load;  ///< By body: the heaviest that lies on it [kg].
  std::vector<std::pair<std::uint32_t, std::uint32_t>> borne_before;
};

/// Fills `pairs.borne`. What is borne by a body that hangs is
/// heavier than it, or presses harder than that; it may be hooked itself (`hooked`, by body row), as the
/// wheel of a cart is, but does not hang. Contacts that bounce are not borne. `impulse_to_force` is that of
/// the impulses that manifolds have from the last step [1/s].
void find_borne_contacts(const ContactStep& step, Real impulse_to_force, const Joints& joints,
                         std::span<const std::uint8_t> hooked, const Holders& holders,
                         const state::Bodies& bodies, const std::vector<state::Hook>& hooks,
                         state::Pairs& pairs, BorneScratch& scratch);

/// Forces and separations by what the manifolds say now.
void place_borne_contacts(Real impulse_to_force, const state::Bodies& bodies, state::Pairs& pairs);

/// Gives the manifolds the impulses of their last substep, of length h [s].
void store_borne_contacts(Real h, state::Pairs& pairs);

}  // namespace hooke::solver
