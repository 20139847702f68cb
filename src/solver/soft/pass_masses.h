#pragma once

#include "hooke/math.h"

#include "state/tables.h"

#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Masses of bodies that press on faces and segments (collision/deformable/body_passes.h), lent to their
/// points. A spring gives a light point no more impulse than stops it. Without that mass a heavy body would
/// drag points along, and stretch what it hangs in without being stopped by it.

namespace hooke::solver {

/// A point that has got a body's mass, or a share of it.
struct PassMass {
  std::uint32_t particle = 0;
  std::uint32_t body = 0;
  Real mass = Real(0);          ///< Mass that was added [kg].
  Real inverse_mass = Real(0);  ///< That of the point alone [1/kg].
  Vec3 velocity = {};           ///< Velocity of the body's center before [m/s].
};

/// Shares the mass of each body that gives way out to the rows of `passes` that have it, and from these to
/// their points, by weight. The two go on with their common momentum. Points of objects marked in
/// `solved_whole` get nothing.
void share_pass_masses(std::span<const state::ElementContact> passes,
                       std::span<const std::uint8_t> solved_whole, state::Tables& tables,
                       std::vector<PassMass>& shares);

/// Takes the masses away. A point keeps its velocity; each body gets the impulse that has changed the
/// velocity of its mass, at the point.
void give_back_pass_masses(std::span<const PassMass> shares, state::Tables& tables);

}  // namespace hooke::solver
