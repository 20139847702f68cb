#pragma once

#include "hooke/world.h"

#include "fuzz/random.h"

#include <vector>

/// \file
/// Random descriptions that are valid: a few points each, of about a meter, near the place given.

namespace hooke::fuzz {

/// What may put energy into a world is left out where it is false: motion, motors, springs at work, wind,
/// pressure.
struct Taste {
  bool may_drive = true;
};

/// Meshes that bodies, cloths and solids may be made of.
struct Meshes {
  std::vector<MeshId> any = {};
  std::vector<MeshId> solid = {};
};

[[nodiscard]] WorldDesc make_world(Random& random, Taste taste);
[[nodiscard]] MotionDesc make_motion(Random& random);
[[nodiscard]] ContactDesc make_contact(Random& random);
[[nodiscard]] WindDesc make_wind(Random& random);
/// Not a mesh, hull or compound.
[[nodiscard]] Shape make_simple_shape(Random& random);
[[nodiscard]] BodyDesc make_body(Random& random, DVec3 place, const Meshes& meshes, Taste taste);
[[nodiscard]] RopeDesc make_rope(Random& random, DVec3 place, Taste taste);
[[nodiscard]] ClothDesc make_cloth(Random& random, DVec3 place, const Meshes& meshes, Taste taste);
[[nodiscard]] SolidDesc make_solid(Random& random, DVec3 place, const Meshes& meshes);
[[nodiscard]] ParticlesDesc make_particles(Random& random, DVec3 place);
[[nodiscard]] FieldDesc make_field(Random& random, DVec3 place);
/// All but its ends.
[[nodiscard]] HookDesc make_hook(Random& random, DVec3 place, bool of_points, Taste taste);

}  // namespace hooke::fuzz
