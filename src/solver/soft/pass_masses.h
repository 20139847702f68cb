#pragma once

#include "hooke/math.h"

#include "state/tables.h"

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Masses of bodies that press on faces and segments (collision/deformable/body_passes.h), lent to their
/// points. A spring gives a light point no more impulse than stops it. Without that mass a heavy body would
/// drag points along, and stretch what it hangs in without being stopped by it.

namespace hooke::solver {

/// A body that presses on points of a cloth which is solved with it.
struct PressingBody {
  std::uint32_t object = 0;  ///< Row of the cloth.
  std::uint32_t body = 0;

  friend auto operator<=>(const PressingBody&, const PressingBody&) = default;
};

/// A point that has got a body's mass, or a share of it.
struct PassMass {
  std::uint32_t particle = 0;
  std::uint32_t body = 0;
  Real mass = Real(0);          ///< Mass that was added [kg].
  Real inverse_mass = Real(0);  ///< That of the point alone [1/kg].
  Vec3 velocity = {};           ///< Velocity of the body there, before [m/s].
  Vec3 lever = {};              ///< Vector from the body's center of mass to the point [m].
};

/// Gives the points of `passes` what resists of the body that presses there along the direction in which it
/// resists least, divided by the number of rows that have the body. So all impulses together turn the body no
/// farther than any point wants it: with the mass that resists along the normal energy grew without bound.
/// The two go on with their common momentum. Points of objects marked in `solved_whole` get nothing, nor do
/// those that are solved with the body, which `pressing` lists in ascending order.
void share_pass_masses(std::span<const state::ElementContact> passes,
                       std::span<const std::uint8_t> solved_whole, std::span<const PressingBody> pressing,
                       state::Tables& tables, std::vector<PassMass>& shares);

/// Takes the masses away. A point keeps its velocity; each body gets the impulse that has changed the
/// velocity of its share, at the point.
void give_back_pass_masses(std::span<const PassMass> shares, state::Tables& tables);

}  // namespace hooke::solver
