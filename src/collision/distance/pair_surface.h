#pragma once

#include "hooke/desc.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace hooke::collision {

/// Friction and restitution of two surfaces in contact.
struct PairSurface {
  Real friction = Real(0);
  Real static_friction = Real(0);  ///< Not below `friction`.
  Real restitution = Real(0);
};

/// The values come from the table where it lists the two materials, otherwise from the rule at ContactDesc.
inline PairSurface surface_of(const ContactDesc& a, const ContactDesc& b,
                              std::span<const MaterialPairDesc> materials) {
  for (const MaterialPairDesc& m : materials) {
    if ((m.a == a.material && m.b == b.material) || (m.a == b.material && m.b == a.material)) {
      return {m.friction, std::max(m.friction, m.static_friction.value_or(m.friction)), m.restitution};
    }
  }
  const Real friction = std::sqrt(a.friction * b.friction);
  const Real at_rest =
      std::sqrt(a.static_friction.value_or(a.friction) * b.static_friction.value_or(b.friction));
  return {friction, std::max(friction, at_rest), std::max(a.restitution, b.restitution)};
}

}  // namespace hooke::collision
