#pragma once

#include "parallel/range.h"
#include "state/tables.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace hooke::collision {

/// Memory of find_contacts, and data that it leaves to update_contacts.
class ParticleContactScratch {
 public:
  struct Buffers;  // particle_contacts.cpp

  ParticleContactScratch();
  ~ParticleContactScratch();
  ParticleContactScratch(ParticleContactScratch&&) noexcept;
  ParticleContactScratch& operator=(ParticleContactScratch&&) noexcept;

  [[nodiscard]] Buffers& buffers() { return *buffers_; }

 private:
  std::unique_ptr<Buffers> buffers_;
};

/// Finds the particles that may touch the shape of a body within the next `dt` and makes their contact rows,
/// in order of particle, body and triangle. Rows that existed before keep their forces.
///
/// The reach is twice the displacement of the particle at its speed, plus those by gravity and of the body,
/// plus 2 cm. A particle that is pulled farther than that within one step is found one step late.
void find_contacts(double dt, ParticleContactScratch& scratch, state::Tables& tables);

/// Finds the normal, separation and surface of each row from where the particle and the body are now. If a
/// particle comes to a convex shape within the next `h` [s], the row is taken at the point where it will
/// touch: what slides along a face, past its rim, must not be stopped by an earlier normal of the rim.
/// `range` counts contact rows and may begin anywhere: the rows of a particle and a collider belong to the
/// range that holds the first of them.
void update_contacts(parallel::Range range, Real h, ParticleContactScratch& scratch, state::Tables& tables);

/// Notes which points of the object at one end of a hook are inside the body at the other end, or less than
/// half their radius outside it if the two may not touch anyhow. Of a ball it also notes how near the others
/// are, which is where they touch that body.
void note_hooked_points(const state::Tables& tables, state::Hook& hook);

/// Deepest overlap of any particle's sphere with any colliding body [m]; 0 if there is none. Tests all pairs.
[[nodiscard]] double largest_penetration(const state::Tables& tables);

}  // namespace hooke::collision
