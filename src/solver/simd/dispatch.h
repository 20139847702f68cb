#pragma once

#include <string>
#include <vector>

/// \file
/// Which instruction set the kernels use. One source serves all of them (Highway), and every one gives the
/// bits of its scalar twin: each lane does the same operations in the same order, with no fused multiply-add
/// and no approximate division. The double twin of the engine runs the scalar twins.

namespace hooke::solver::wide {

/// Instruction sets of this machine, "scalar" first, the widest last.
[[nodiscard]] std::vector<std::string> targets();

/// Runs every kernel with the named set from now on, in the whole process; "" goes back to the widest. For
/// tests and benchmarks: the bits do not depend on it. False, and no change, if this machine does not have
/// it.
bool use_target(const std::string& name);

/// Whether the scalar twins run.
[[nodiscard]] bool is_scalar();

}  // namespace hooke::solver::wide
