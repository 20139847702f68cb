#pragma once

#include <string>
#include <vector>

/// \file
/// The choice of the instruction set that the kernels use. One source serves all of them (Highway), and
/// every one gives the bits of its scalar twin: each lane does the same operations in the same order, with
/// no fused multiply-add and no approximate division. The double twin of the engine runs the scalar twins.

namespace hooke::solver::wide {

/// Instruction sets of this machine, "scalar" first, the widest last.
[[nodiscard]] std::vector<std::string> targets();

/// Runs every kernel with the named set from now on, in the whole process; "" goes back to the widest set.
/// It is for tests and benchmarks: the bits do not depend on it. It returns false and changes nothing if
/// this machine does not have the set.
bool use_target(const std::string& name);

/// Whether the scalar twins run.
[[nodiscard]] bool is_scalar();

}  // namespace hooke::solver::wide
