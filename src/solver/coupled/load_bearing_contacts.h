#pragma once

#include "solver/contact/body_contacts.h"
#include "solver/coupled/coupled_tuning.h"
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
/// however firmly its ropes hold it. So these contacts are rows of the coupled group
/// (solver/coupled/coupled_groups.h) of the ropes and hooks that the plank hangs on. What lies between, as a
/// board on the planks, has load-bearing contacts too.
///
/// The same goes for a light body between the ground and what it is hooked to, as the leg of a heavy table.
/// The joint brings all the weight, and the leg's contact with the ground takes only m v of the leg.
///
/// The order of calls:
///   find_supporting_bodies                                   when hooks or bodies came or went
///   find_load_bearing_contacts                               once a step, before rows of contacts are made

namespace hooke::solver {

/// How a body can hold another body that lies on it.
enum class SupportRole : std::uint8_t {
  kNone,
  kHooked,     ///< It is part of an articulation that hangs on nothing.
  kHangs,      ///< It hangs on a point, or is part of an articulation that something holds.
  kSupported,  ///< It lies on such a body.
};

/// What may press a body on the ground [kg].
struct GroundLoad {
  /// The heaviest body that a hook holds at its position on this one, or at a distance from it.
  Real neighbor = Real(0);
  Real group = Real(0);  ///< Mass of its articulation, with what lies on that.
  bool driven = false;   ///< A hook's motor or spring moves it.
};

/// What bodies hold by their hooks, by body row.
struct Supports {
  std::vector<SupportRole> support_role;
  std::vector<GroundLoad> ground_load;
};

/// To be called again when hooks or bodies come or go. Bodies of iterative joints hold nothing: these are
/// relaxed.
void find_supporting_bodies(const Joints& joints, const state::Bodies& bodies,
                            const std::vector<state::Hook>& hooks, Supports& supports);

/// What carries a body.
enum class Footing : std::uint8_t {
  kStands,   ///< Contacts under it carry it, or it has no hook.
  kHangs,    ///< Its hooks carry it, or nothing does.
  kRagdoll,  ///< It belongs to a ragdoll (solver/joint/approximate_trees.h).
};

/// What contacts did to a body in the last step, along gravity.
struct CarriedLoad {
  Real from_below = Real(0);  ///< [N s]
  Real from_above = Real(0);  ///< [N s]
  bool on_something = false;  ///< Something touches the body from below.
};

/// A contact that brings weight from one body to another.
struct Prop {
  std::uint32_t upper = 0;  ///< Body row.
  std::uint32_t lower = 0;
  Real impulse = Real(0);  ///< Along gravity, in the last substep [N s].
  bool deep = false;       ///< The upper body is far inside the lower one.
};

/// Memory of find_load_bearing_contacts.
struct LoadBearingScratch {
  Supports supports;
  std::vector<Footing> footing;                  ///< By body row.
  std::vector<std::uint32_t> refused_manifolds;  ///< Rows of those over kMostLoadBearingManifolds.
  std::vector<Prop> props;
  std::vector<CarriedLoad> carried;      ///< By body row.
  std::vector<Real> weights;             ///< By body row, in a substep [N s].
  std::vector<std::uint32_t> bore_load;  ///< Bodies of the contacts that bore load before, ascending.
  std::vector<Real> load;                ///< By body row: the heaviest body that lies on it [kg].
  std::vector<std::pair<std::uint32_t, std::uint32_t>> load_bearing_before;
  std::vector<std::uint32_t> manifolds;  ///< Rows of those that bear load.
};

/// What the choice of load-bearing contacts is made from.
struct LoadBearingInputs {
  const ContactStep& step;
  Real impulse_to_force = Real(0);  ///< Of the impulses that manifolds have from the last step [1/s].
  const Joints& joints;
  std::span<const std::uint8_t> hooked;  ///< Whether a hook holds the body, by body row.
  const Supports& supports;              ///< What bodies hold by their hooks alone.
};

/// Fills `Pairs::coupled` with those that bear load. A body that hangs bears what is heavier than itself or
/// presses harder than that. The upper body may have hooks itself, as the wheel of a cart does, but does not
/// hang. What bounces does so before (solver/contact/impacts.h). A body that its contacts carry bears nothing
/// by its hooks, as a crate with a slack rope. What stands is supported by what it lies on, not by what leans
/// on its side.
void find_load_bearing_contacts(const LoadBearingInputs& inputs, const state::Bodies& bodies,
                                const std::vector<state::Hook>& hooks, state::Pairs& pairs,
                                LoadBearingScratch& scratch);

}  // namespace hooke::solver
