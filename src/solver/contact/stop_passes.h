#pragma once

#include "solver/contact/backing_contacts.h"
#include "state/tables.h"

#include <span>

namespace hooke::solver {

/// Solves rows of collision/deformable/body_passes.h, in order of time, in sweeps, together with the contacts
/// of the bodies that they push. `h` is the particle substep [s].
void stop_passes(Real h, std::span<state::ElementContact> passes, BackingContacts& backing,
                 BodyContacts& contacts, state::Tables& tables);

}  // namespace hooke::solver
