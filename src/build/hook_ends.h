#pragma once

#include "hooke/desc.h"
#include "hooke/result.h"

#include "state/tables.h"

namespace hooke::build {

/// An end of a hook, with rows in place of ids.
struct FoundEnd {
  state::HookPlace place = {};  ///< Without anchor and axes.
  bool is_given = false;        ///< Whether the end itself is at a known position, as a point is.
  DVec3 position = {};          ///< That position in the world [m].
};

/// Finds an end. `anchor` [m] is where the search begins for PointRef::kNearest. Errors: a stale id, a point
/// or a name that the object does not have, both a body and a point. `where` names the end.
[[nodiscard]] Result<FoundEnd> find_end(const HookEnd& end, DVec3 anchor, const char* where,
                                        const state::Tables& tables);

/// Appends a hook between ends that were found and that its kind can hold; its slot is not set.
void append_hook(const HookDesc& desc, const FoundEnd& a, const FoundEnd& b, state::Tables& tables);

/// Finds the place of an object that is nearest to `wanted` [m]. It lies in a tetrahedron, on a triangle or
/// on a segment, or at a particle if the object has none of these. The object's row is not set.
[[nodiscard]] state::HookPlace nearest_place(const state::Tables& tables, const state::Deformable& object,
                                             DVec3 wanted);

}  // namespace hooke::build
