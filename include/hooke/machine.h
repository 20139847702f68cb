#pragma once

#include "hooke/result.h"

#include <string>
#include <vector>

/// \file
/// Which instructions of this machine steps use. The results do not depend on it, to the bit: choose another
/// set than the widest to see that, to measure, or to keep clear of one that a machine has and cannot run
/// well.
///
/// The environment variable HOOKE_INSTRUCTION_SET names a set for the whole process, as far as nobody calls
/// use_instruction_set; a name that is not in the list is an Error of World::create.

namespace hooke {

/// The names of the sets that this machine has: "scalar" first, the widest last.
[[nodiscard]] std::vector<std::string> instruction_sets();

/// Steps of all Worlds use that set from now on; "" means the widest. Not while any World steps. Errors: a
/// name that is not in the list.
Result<void> use_instruction_set(const std::string& name);

}  // namespace hooke
