#pragma once

#include "hooke/scene_io.h"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace hooke::app {

/// What a member of a structure is.
enum class MemberKind {
  kBar,    ///< A body that hooks hold at exactly two places.
  kRod,    ///< A distance hook.
  kRope,   ///< A rope.
  kJoint,  ///< Any other hook.
};

/// A HookEndOf is an end of a bar: the hooks that hold it there.
struct BarEnd {
  std::vector<std::size_t> hooks = {};  ///< Indices of joints among the members.
  std::vector<bool> on_b = {};          ///< Whether the bar is side b of that hook.
};

/// A part of a structure that carries force.
struct Member {
  std::string name;
  MemberKind kind = MemberKind::kJoint;
  HookId hook = {};                 ///< Hook of a rod or a joint.
  RopeId rope = {};                 ///< The rope.
  std::array<BarEnd, 2> ends = {};  ///< Ends of a bar.
  double strength = 0;  ///< Force that it breaks at [N]; 0 for none. Of a bar that of its weakest hook.
  double torque_strength = 0;  ///< Torque that it breaks at [N m]; 0 for none.
  double yield_force = 0;      ///< Force along it at which its section yields [N]; 0 for none.
  double buckling_force = 0;   ///< Compression at which it buckles by Euler's formula [N]; 0 for none.
  bool is_end = false;         ///< Whether it is a joint that holds the end of a bar.
};

/// What a member carries.
struct MemberForce {
  /// Force along a bar or rod, the mean of its ends, or the largest along a rope [N]: tension is positive,
  /// compression negative. Of a joint the size of its force.
  double force = 0;
  double shear = 0;     ///< Of a bar the largest force across it at an end [N].
  double moment = 0;    ///< Largest torque of a joint, or of a joint at the ends of a bar [N m].
  double yielding = 0;  ///< Force along it, of either sign, over Member::yield_force; 0 without one.
  double buckling = 0;  ///< Compression over Member::buckling_force; 0 in tension or without one.
  /// Largest ratio of force or torque to what breaks the member, or of the two above; 0 where nothing has a
  /// limit.
  double utilization = 0;
  bool broken = false;
};

/// Whether anything limits what a member can carry.
[[nodiscard]] inline bool has_limit(const Member& member) {
  return member.strength > 0 || member.torque_strength > 0 || member.yield_force > 0 ||
         member.buckling_force > 0;
}

/// Finds the members of a simulation: rods, ropes and joints in the order of creation, then bars.
[[nodiscard]] std::vector<Member> find_members(const Simulation& simulation);

/// Returns what the members carry after a step, in the same order.
[[nodiscard]] std::vector<MemberForce> member_forces(const Simulation& simulation,
                                                     const std::vector<Member>& members);

/// Returns the word for a kind: "bar", "rod", "rope", "joint".
[[nodiscard]] const char* word_of(MemberKind kind);

}  // namespace hooke::app
