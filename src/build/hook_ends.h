#pragma once

#include "hooke/desc.h"
#include "hooke/result.h"

#include "state/tables.h"

namespace hooke::build {

/// What an end of a hook names, in rows.
struct FoundEnd {
  state::HookPlace place = {};  ///< Without anchor and axes.
  bool is_given = false;        ///< The end says by itself where it is: a point, or a named place.
  DVec3 position = {};          ///< Where that is [m].
};

/// Finds an end; `anchor` [m] says which place of an object is meant by PointRef::kNearest. Errors: a stale
/// id, a point or a name the object has not, both a body and a point; `where` names the end.
[[nodiscard]] Result<FoundEnd> find_end(const HookEnd& end, DVec3 anchor, const char* where,
                                        const state::Tables& tables);

/// Appends a hook of ends that were found and that its kind can hold; its slot is not set.
void append_hook(const HookDesc& desc, const FoundEnd& a, const FoundEnd& b, state::Tables& tables);

/// The place of an object that is nearest to `wanted` [m]: in a tetrahedron, on a triangle or a segment, or
/// at a particle where there are none of them. Without the object's row.
[[nodiscard]] state::HookPlace nearest_place(const state::Tables& tables, const state::Deformable& object,
                                             DVec3 wanted);

}  // namespace hooke::build
