#pragma once

#include "hooke/desc.h"
#include "hooke/result.h"

#include "state/tables.h"

namespace hooke::build {

/// What an end of a hook names, in rows.
struct FoundEnd {
  state::HookPlace place = {};  ///< Without anchor and axes.
  DVec3 position = {};          ///< Of a point [m].
};

/// Finds an end; `anchor` [m] says which place of an object is meant by PointRef::kNearest. Errors: a stale
/// id, a point the object has not, both a body and a point; `where` names the end.
[[nodiscard]] Result<FoundEnd> find_end(const HookEnd& end, DVec3 anchor, const char* where,
                                        const state::Tables& tables);

}  // namespace hooke::build
