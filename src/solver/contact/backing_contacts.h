#pragma once

#include "hooke/math.h"

#include "base/lists_by_key.h"
#include "solver/contact/body_contacts.h"

#include <cstdint>
#include <vector>

/// \file
/// Contacts of bodies that something pushes after their contacts have been solved, as what passes through
/// cloth does (solver/soft/element_contact_solve.h). Without them it would push these bodies into others.

namespace hooke::solver {

class BackingContacts {
 public:
  /// Begins a step, with other contacts.
  void clear() { lanes_.clear(); }

  /// Begins a particle substep of `h` [s]: no body has been pushed yet.
  void begin(Real h, const state::Bodies& bodies, const BodyContacts& contacts);

  /// Lets the contacts of this body be solved from now on.
  void reach(std::uint32_t body);

  /// Solves the contacts of all reached bodies once: a point may close its gap within the substep and no
  /// more. Bodies that are pushed by more than `least` [m/s] are reached. Impulses of soft contacts add to
  /// those of the substep, so that friction has them; others count as free motion. Returns the largest change
  /// of speed along a normal [m/s].
  Real solve(Real least, state::Bodies& bodies, BodyContacts& contacts);

 private:
  void list(const state::Bodies& bodies, const BodyContacts& contacts);

  Real h_ = Real(0);
  base::ListsByKey<ContactLane> lanes_;  ///< By body.
  std::vector<std::uint8_t> reached_;    ///< By body.
  std::vector<std::uint32_t> bodies_;    ///< Those that are reached.
  std::vector<ContactLane> active_;      ///< Contacts of these.
  std::vector<std::uint8_t> is_active_;  ///< By lane of all blocks.
};

}  // namespace hooke::solver
