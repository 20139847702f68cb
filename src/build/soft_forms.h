#pragma once

#include "hooke/desc.h"
#include "hooke/result.h"

#include "state/tables.h"

#include <cstdint>
#include <memory>
#include <vector>

/// \file
/// The soft forms of rigid bodies (BodyDesc::yields): tetrahedra that are made with the body, so that
/// yielding costs little.

namespace hooke::build {

/// Checks BodyDesc::yields, and whether such a body can yield.
[[nodiscard]] Result<void> validate_yields(const BodyDesc& desc);

/// Makes the tetrahedra of a body, in its frame about its center of mass. Their points have the mass, the
/// center and the inertia of `mass`. Errors: a shape that cannot be filled.
[[nodiscard]] Result<std::shared_ptr<const state::SoftForm>> make_soft_form(const BodyDesc& desc,
                                                                            const state::BodyMass& mass,
                                                                            const state::Tables& tables);

/// Checks whether the tetrahedra of a form, with the material of `yields`, make a solid.
[[nodiscard]] Result<void> validate_soft_form(const state::SoftForm& form, const YieldsDesc& yields);

/// Says how the solid of a form is added where the body is.
[[nodiscard]] SolidDesc describe_soft_form(const state::SoftForm& form, const YieldsDesc& yields);

/// Appends the solid of a body that yields, as the last object, in the body's place and with its motion. Its
/// slot is not set. Errors: those of add_solid.
Result<void> append_soft_form(const state::Yielding& yielding, state::Tables& tables);

}  // namespace hooke::build
