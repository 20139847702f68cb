#pragma once

#include "hooke/desc.h"
#include "hooke/result.h"

#include "state/tables.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

/// \file
/// Makes rows of the tables from descriptions. Each function checks the whole description before it appends
/// anything. On an Error no row has changed; only the hulls and convex parts of meshes, which the tables
/// cache, may have been added. A new deformable is the last of `tables.objects`; its slot is not set.

namespace hooke::build {

Result<void> add_rope(const RopeDesc& desc, state::Tables& tables);
Result<void> add_cloth(const ClothDesc& desc, state::Tables& tables);
Result<void> add_solid(const SolidDesc& desc, state::Tables& tables);
Result<void> add_particles(const ParticlesDesc& desc, state::Tables& tables);

/// Adds a body and returns its row; its slot is not set.
Result<std::uint32_t> add_body(const BodyDesc& desc, state::Tables& tables);
/// Makes the shape of a collider, and the hull of a mesh if the tables have none. `where` begins the place in
/// an Error, like "body.".
[[nodiscard]] Result<state::ColliderShape> make_shape(const Shape& shape, const std::string& where,
                                                      const state::Tables& tables);
/// Removes bodies and the pairs of their colliders. Their rows become holes in the tables of bodies and
/// colliders. `goes` says by body row which bodies go.
void remove_bodies(const std::vector<std::uint8_t>& goes, state::Tables& tables);

/// Gives a body hulls about its center of mass in place of its colliders, with the surface of the first one.
/// The pairs of its colliders must have been removed.
void reshape_body(std::uint32_t row, std::span<const std::shared_ptr<const geometry::ConvexHull>> hulls,
                  state::Tables& tables);

/// Adds a hook, as the last of `tables.hooks`; its slot is not set.
Result<void> add_hook(const HookDesc& desc, state::Tables& tables);

/// Adds the stitches of a seam, as the last of `tables.hooks`, and returns their number; their slots are not
/// set.
Result<std::uint32_t> sew(const SeamDesc& desc, state::Tables& tables);

/// Returns the one freedom of a kDistance hook whose anchors were `distance` apart [m]. Its target becomes a
/// length. Without other settings it is locked, as a rod.
[[nodiscard]] HookFreedom line_freedom(HookFreedom line, Real distance);
/// Whether limits leave one value only.
[[nodiscard]] bool is_closed(const HookLimits& limits);

[[nodiscard]] Result<void> validate(const WorldDesc& desc);
[[nodiscard]] Result<void> validate(const WindDesc& wind);
[[nodiscard]] Result<void> validate(const FieldDesc& field);
[[nodiscard]] Result<void> validate(const Shape& shape);
[[nodiscard]] Result<void> validate(const BodyDesc& body);
[[nodiscard]] Result<void> validate(const HookDesc& desc);
[[nodiscard]] Result<void> validate(const HookMotor& motor);
[[nodiscard]] Result<void> validate(const HookSpring& spring);
[[nodiscard]] Result<void> validate(const MotionDesc& motion, const std::string& where);

}  // namespace hooke::build
