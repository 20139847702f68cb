#pragma once

#include "solver/joint_rows/joint_rows.h"
#include "solver/joint_rows/joint_rows_tuning.h"
#include "state/tables.h"

#include <limits>
#include <span>

/// \file
/// Rows of hooks of which an end is a point of a deformable, or has its motion given.

namespace hooke::solver {

/// The present state of a hook's end: a body, the world, or a place between particles, which has no
/// rotation.
[[nodiscard]] JointBody joint_end(const state::Tables& tables, const state::HookPlace& place);

/// An end of a hook for which rows are made.
struct RowEnd {
  JointBody body;
  bool given = false;  ///< Its motion is given: the targets contain it.
};

/// Makes the rows of a hook (solver/joint_rows/joint_rows.h) between ends of which some have their motion
/// given, and errors are taken back at `most_push` at most.
int make_rows(state::Hook& hook, const RowEnd& a, const RowEnd& b, double h,
              std::span<JointRow, state::Hook::kMaxRows> rows,
              double most_push = std::numeric_limits<double>::infinity());

}  // namespace hooke::solver
