#include "solver/contact/dense_pile_limit.h"

#include "base/assert.h"
#include "solver/contact/contact_tuning.h"

#include <algorithm>
#include <cmath>

namespace hooke::solver {

namespace {

/// The mean velocity, weighted by mass.
Vec3 velocity_of(std::span<const std::uint32_t> pile, const state::Bodies& bodies) {
  Vec3 momentum;
  Real mass = Real(0);
  for (const std::uint32_t body : pile) {
    momentum += bodies.mass[body].mass * bodies.motion[body].v;
    mass += bodies.mass[body].mass;
  }
  return (Real(1) / mass) * momentum;
}

}  // namespace

void limit_dense_pile(std::span<const std::uint32_t> pile, state::Bodies& bodies) {
  HOOKE_ASSERT(!pile.empty());  // its mass is divided by
  const Vec3 mean = velocity_of(pile, bodies);
  for (const std::uint32_t body : pile) {
    state::MotionRecord& m = bodies.motion[body];
    const state::FreeMotionRecord& free = bodies.free_motion[body];
    const Real fastest = std::max(kContactPushOutSpeed, length(free.v - mean));
    const Real speed = length(m.v - mean);
    if (speed > fastest) m.v = mean + (fastest / speed) * (m.v - mean);
    // The rotation may have the energy of that speed.
    const Real most =
        std::max(kContactPushOutSpeed * std::sqrt(bodies.mass[body].mass), length(free.omega_scaled));
    if (length(m.omega_scaled) > most) m.omega_scaled = free.omega_scaled;
  }
  const Vec3 lost = mean - velocity_of(pile, bodies);
  for (const std::uint32_t body : pile) bodies.motion[body].v += lost;
}

}  // namespace hooke::solver
