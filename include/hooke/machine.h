#pragma once

#include "hooke/result.h"

#include <string>
#include <vector>

/// \file
/// Which instructions of this machine steps use. The results do not depend on it, to the bit. Choose another
/// set than the widest to verify that, to measure, or to avoid a set that a machine has but runs slowly.
///
/// The environment variable HOOKE_INSTRUCTION_SET names a set for the whole process, until somebody calls
/// use_instruction_set. A name that is not in the list is an Error of World::create.

namespace hooke {

/// Lists the names of the sets that this machine has: "scalar" first, the widest last.
[[nodiscard]] std::vector<std::string> instruction_sets();

/// Makes the steps of all Worlds use that set from now on; "" means the widest. Do not call it while any
/// World steps. Errors: a name that is not in the list.
Result<void> use_instruction_set(const std::string& name);

}  // namespace hooke
