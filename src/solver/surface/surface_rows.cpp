#include "solver/surface/surface_rows.h"

#include "solver/surface/surface_tuning.h"

#include <algorithm>

namespace hooke::solver {

namespace {

/// A row with the velocities of its vertices.
class RowOfParticles {
 public:
  RowOfParticles(const SurfaceContacts& contacts, const SurfaceRow& row, state::Particles& particles)
      : row_(row) {
    for (std::size_t k = 0; k < 4; ++k) {
      record_[k] = &particles.velocity[contacts.surfaces.particle[row.vertex[k]]];
      velocity_ += row.weight[k] * record_[k]->v;
      inverse_mass_ += row.weight[k] * row.weight[k] * record_[k]->inverse_mass;
    }
  }
  [[nodiscard]] Vec3 velocity() const { return velocity_; }
  [[nodiscard]] Real inverse_mass() const { return inverse_mass_; }

  void push(Vec3 impulse) {
    for (std::size_t k = 0; k < 4; ++k)
      record_[k]->v += (row_.weight[k] * record_[k]->inverse_mass) * impulse;
  }

 private:
  const SurfaceRow& row_;
  std::array<state::VelocityRecord*, 4> record_ = {};
  Vec3 velocity_ = {};
  Real inverse_mass_ = Real(0);
};

void prepare_row(Real h, const SurfaceContacts& contacts, SurfaceRow& row) {
  Vec3 between;
  for (std::size_t k = 0; k < 4; ++k) between += row.weight[k] * contacts.position[row.vertex[k]].x;
  const Real s = dot(row.normal, between) - row.distance;
  row.least_speed = s > Real(0) ? -s / h : std::min(kSurfaceRecovery * -s / h, kSurfaceRecoverySpeed);
  row.pushed = Real(0);
}

void solve_row(const SurfaceContacts& contacts, bool with_friction, SurfaceRow& row,
               state::Particles& particles) {
  RowOfParticles solved(contacts, row, particles);
  const Real w = solved.inverse_mass();
  if (!(w > Real(0))) return;
  const Real speed = dot(row.normal, solved.velocity());
  const Real before = row.pushed;
  row.pushed = std::max(before + (row.least_speed - speed) / w, Real(0));
  Vec3 impulse = (row.pushed - before) * row.normal;
  if (with_friction && row.pushed > Real(0)) {
    const Vec3 sliding = solved.velocity() - speed * row.normal;
    const Real rate = length(sliding);
    if (rate > Real(0)) impulse -= (std::min(rate / w, row.friction * row.pushed) / rate) * sliding;
  }
  solved.push(impulse);
}

}  // namespace

void solve_surface_rows(Real h, const SurfaceContacts& contacts, SurfaceGroup& group,
                        state::Particles& particles) {
  for (SurfaceRow& row : group.rows) prepare_row(h, contacts, row);
  for (int sweep = 1; sweep <= kSurfaceSweeps; ++sweep) {
    for (SurfaceRow& row : group.rows) solve_row(contacts, sweep == kSurfaceSweeps, row, particles);
  }
}

}  // namespace hooke::solver
