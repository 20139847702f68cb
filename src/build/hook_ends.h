#pragma once

#include "hooke/desc.h"
#include "hooke/result.h"

#include "state/tables.h"

namespace hooke::build {

/// An end of a hook, in rows.
struct FoundEnd {
  state::HookPlace place = {};  ///< Without anchor and axes.
  bool is_given = false;        ///< Whether the end itself says where it is: it is a point or a named place.
  DVec3 position = {};          ///< Where that is [m].
};

/// Finds an end; `anchor` [m] says which place of an object PointRef::kNearest means. Errors are a stale id,
/// a point or a name that the object has not, and both a body and a point; `where` names the end.
[[nodiscard]] Result<FoundEnd> find_end(const HookEnd& end, DVec3 anchor, const char* where,
                                        const state::Tables& tables);

/// Appends a hook between ends that were found and that its kind can hold; its slot is not set.
void append_hook(const HookDesc& desc, const FoundEnd& a, const FoundEnd& b, state::Tables& tables);

/// The place of an object that is nearest to `wanted` [m]: in a tetrahedron, on a triangle or a segment, or
/// at a particle where the object has none of these. The object's row is not set.
[[nodiscard]] state::HookPlace nearest_place(const state::Tables& tables, const state::Deformable& object,
                                             DVec3 wanted);

}  // namespace hooke::build
