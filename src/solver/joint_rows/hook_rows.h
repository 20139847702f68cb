#pragma once

#include "solver/joint_rows/joint_rows.h"
#include "state/tables.h"

#include <span>

/// \file
/// Rows of hooks of which an end is a point of a deformable, or has its motion given.

namespace hooke::solver {

/// The share of a hook row's diagonal that it has as compliance.
inline constexpr double kHookCompliance = 1e-6;

/// An end of a hook now: of a body, the world, or the place between particles, which has no rotation.
[[nodiscard]] JointBody joint_end(const state::Tables& tables, const state::HookPlace& place);

/// Rows of a hook (joint_rows.h) between ends of which some have their motion given: that is in the targets.
int make_rows(state::Hook& hook, const JointBody& a, const JointBody& b, bool a_given, bool b_given, double h,
              std::span<JointRow, state::Hook::kMaxRows> rows);

}  // namespace hooke::solver
