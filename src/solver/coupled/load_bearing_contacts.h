#pragma once

#include "solver/contact/body_contacts.h"
#include "solver/joint/joints.h"
#include "state/tables.h"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

/// \file
/// Contacts of heavy bodies with light ones that hang on hooks: a ton on the planks of a rope bridge.
///
/// Rows of contacts know only the mass of a plank, and pass on at most what stops it: m v in a substep,
/// however firmly its ropes hold it. So they are rows of the bundle (solver/coupled/coupled_groups.h) of the
/// ropes and hooks that the plank hangs on, and solved with them. What the heavy body lies on through others,
/// a board on the planks, is borne too.
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
inline constexpr Real kLoadBearingMassRatio = Real(2);
inline constexpr Real kLoadBearingLoadRatio = Real(1);

/// From this ratio on between a body and one that it is locked to, its contacts with the ground are borne;
/// from the second on between it and all that hang together with it, if it presses on the ground with so many
/// times its weight, or did in the last step and presses with a quarter of that still. Ragdolls
/// (loose_trees.h) are left out.
inline constexpr Real kPressedMass = Real(8);
inline constexpr Real kPressedGroup = Real(25);
inline constexpr Real kPressedLoad = Real(20);

/// How many may be borne in a step: some milliseconds.
inline constexpr std::size_t kMostLoadBearingManifolds = 512;

/// How a body can hold another that lies on it.
enum class SupportRole : std::uint8_t {
  kNone,
  kHooked,     ///< Part of an articulation that hangs on nothing.
  kHangs,      ///< On a point, or part of an articulation that something holds.
  kSupported,  ///< Lies on such.
};

/// What may press a body on the ground [kg].
struct GroundLoad {
  Real neighbor = Real(0);  ///< The heaviest that a hook holds at its place on it, or at a distance from it.
  Real group = Real(0);     ///< Its articulation, with what lies on that.
  bool driven = false;      ///< A hook's motor or spring moves it.
};

/// What bodies hold by their hooks, by body row.
struct Supports {
  std::vector<SupportRole> support_role;
  std::vector<GroundLoad> ground_load;
};

/// To be found again when hooks or bodies come or go. Bodies of nets hold nothing: nets are relaxed.
void find_supporting_bodies(const Joints& joints, const state::Bodies& bodies,
                            const std::vector<state::Hook>& hooks, Supports& supports);

/// By what a body is carried.
enum class Footing : std::uint8_t {
  kStands,   ///< By contacts under it, or it has no hook.
  kHangs,    ///< By its hooks, or not at all.
  kRagdoll,  ///< Of a ragdoll (loose_trees.h).
};

/// What contacts did to a body in the last step, along gravity.
struct CarriedLoad {
  Real from_below = Real(0);  ///< [N s]
  Real from_above = Real(0);  ///< [N s]
  bool on_something = false;  ///< Something touches it from below.
};

/// A contact that brings weight from one body to another.
struct Prop {
  std::uint32_t upper = 0;  ///< Body row.
  std::uint32_t lower = 0;
  Real impulse = Real(0);  ///< In the last substep, along gravity [N s].
};

/// Memory of find_borne_contacts.
struct LoadBearingScratch {
  Supports supports;
  std::vector<Footing> footing;  ///< By body.
  std::uint32_t refused = 0;     ///< Over kMostBorneManifolds.
  std::vector<Prop> props;
  std::vector<CarriedLoad> carried;      ///< By body.
  std::vector<Real> weights;             ///< By body, in a substep [N s].
  std::vector<std::uint32_t> bore_load;  ///< Bodies of the contacts that were borne, ascending.
  std::vector<Real> load;                ///< By body: the heaviest that lies on it [kg].
  std::vector<std::pair<std::uint32_t, std::uint32_t>> load_bearing_before;
};

/// Fills `pairs.borne`. What is borne by a body that hangs is
/// heavier than it, or presses harder than that; it may be hooked itself (`hooked`, by body row), as the
/// wheel of a cart is, but does not hang. What may bounce is borne once it touches. A body that its contacts
/// carry bears nothing by its hooks: a crate with a slack rope tied to it; and what stands is borne by what
/// it lies on, not by what leans on its side. `impulse_to_force` is that of the impulses that manifolds have
/// from the last step [1/s].
void find_load_bearing_contacts(const ContactStep& step, Real impulse_to_force, const Joints& joints,
                                std::span<const std::uint8_t> hooked, const Supports& supports,
                                const state::Bodies& bodies, const std::vector<state::Hook>& hooks,
                                state::Pairs& pairs, LoadBearingScratch& scratch);

/// Forces and separations by what the manifolds say now.
void update_load_bearing_contacts(Real impulse_to_force, const state::Bodies& bodies, state::Pairs& pairs);

/// Gives the manifolds the impulses of their last substep, of length h [s].
void store_load_bearing_contacts(Real h, state::Pairs& pairs);

}  // namespace hooke::solver
