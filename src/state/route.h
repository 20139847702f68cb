#pragma once

#include <cstdint>

/// \file
/// Which way a row is solved in this step. Tables carry the way; solver/routes.h says what each way is, when
/// it is taken, and at what cost.

namespace hooke::state {

/// How a contact of two bodies is solved. Blocks of contacts are in this order.
enum class ContactRoute : std::uint8_t {
  kNone,     ///< It has no rows in this step.
  kSoft,     ///< By soft rows, color after color.
  kDirect,   ///< With all contacts of its island, by a factorization.
  kCoupled,  ///< With the hooks and ropes of what it presses on.
};

/// When a contact of two bodies is looked for.
enum class ContactRefresh : std::uint8_t {
  kAtStart,      ///< Where the bodies are as the step begins.
  kInTheMiddle,  ///< Where they will be in the middle of the step.
  kAtImpact,     ///< Where they will meet within the step.
  kEachSubstep,  ///< Where they are as the step begins, and again after each substep.
};

/// How a hook is solved.
enum class JointRoute : std::uint8_t {
  kNone,             ///< Nothing that it holds is moved by forces.
  kTree,             ///< With its tree of bodies, exactly.
  kApproximateTree,  ///< With its tree of bodies, once a substep in float: ragdolls.
  kLoop,             ///< With its group of bodies, which has loops, by a factorization.
  kBlock,            ///< By iterations, as one of 16 plain ball hooks side by side.
  kIterative,        ///< By iterations, row after row.
  kCoupled,          ///< With the ropes, points and contacts that its bodies depend on.
};

}  // namespace hooke::state
