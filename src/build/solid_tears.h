#pragma once

#include "hooke/event.h"

#include "state/tables.h"

#include <cstdint>
#include <vector>

/// \file
/// Solids that tear, as cloth does (build/cloth_tears.h). The stress of a point is the mean of those of its
/// tetrahedra, by volume: Cauchy's stress P F^T / det F of the material, without viscosity. Where the largest
/// principal stress exceeds what the solid can take, the point splits: its tetrahedra before and behind the
/// plane across that stress part along the faces between them. What holds by an edge or a point alone then
/// comes apart with it. Compare O'Brien and Hodgins 1999, "Graphical
/// modeling and animation of brittle fracture".

namespace hooke::build {

/// Splits points of a solid of tetrahedra that are stressed too much: at most eight, those first that are
/// stressed most over what they take, none beside another. Rows of later objects move. Appends an event for
/// each, with `time` [s].
void tear_solid(std::uint32_t object, double time, state::Tables& tables,
                std::vector<SolidTearEvent>& events);

}  // namespace hooke::build
