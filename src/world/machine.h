#pragma once

#include "hooke/result.h"

namespace hooke::world {

/// Does what HOOKE_INSTRUCTION_SET asks for, once; see hooke/machine.h. Errors: it names no set.
[[nodiscard]] Result<void> heed_environment();

}  // namespace hooke::world
