#pragma once

#include "hooke/result.h"

namespace hooke::world {

/// Chooses the instruction set that the environment variable HOOKE_INSTRUCTION_SET names, unless one was
/// chosen before; see hooke/machine.h. Errors: a name that is not in the list.
[[nodiscard]] Result<void> heed_environment();

}  // namespace hooke::world
