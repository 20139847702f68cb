#include "world/point_contact_stages.h"

#include "base/assert.h"
#include "collision/deformable/element_contacts.h"
#include "collision/deformable/particle_contacts.h"
#include "collision/deformable/rope_contacts.h"
#include "collision/deformable/rope_passes.h"
#include "parallel/thread_pool.h"
#include "solver/soft/element_contact_solve.h"
#include "solver/soft/particle_contact_solve.h"
#include "solver/soft/pressed_points.h"
#include "solver/surface/surface_contacts.h"
#include "solver/surface/surface_tuning.h"
#include "state/check_contacts.h"

#include <vector>

namespace hooke::world {

namespace {

using parallel::for_ranges;
using parallel::Range;

// Jobs of fewer contacts stay on one thread.
constexpr int kContactGrain = 256;
constexpr int kElementContactGrain = 32;

/// Removes contacts of bodies with segments of ropes that are gone.
void remove_contacts_of_gaps(state::Tables& t) {
  std::erase_if(t.element_contacts, [&](const state::ElementContact& contact) {
    const state::Deformable& object = t.objects[contact.object];
    return object.has_gaps && !t.segments.joins(contact.element);
  });
}

/// Keeps contacts of ropes with segments that are gone out of what is solved together.
void release_gaps(state::Tables& t) {
  const auto is_gone = [&](std::uint32_t object, std::uint32_t segment) {
    return t.objects[object].has_gaps && !t.segments.joins(segment);
  };
  for (state::RopeContact& contact : t.rope_contacts) {
    if (is_gone(contact.object_a, contact.segment_a) || is_gone(contact.object_b, contact.segment_b))
      contact.joined = false;
  }
}

}  // namespace

void find_point_contacts(WorldData& world, double dt) {
  collision::find_contacts(dt, world.frame.particle_contacts, world.tables);
  remove_contacts_of_gaps(world.tables);
  collision::find_rope_contacts(*world.pool, static_cast<Real>(dt), world.frame.rope_contacts, world.tables);
  HOOKE_VALIDATE(state::find_in_point_contacts(world.tables));
}

void update_point_contacts(WorldData& world, Real h) {
  state::Tables& t = world.tables;
  for_ranges(*world.pool, t.contacts.count(), kContactGrain,
             [&](Range rows) { collision::update_contacts(rows, h, world.frame.particle_contacts, t); });
  for_ranges(*world.pool, static_cast<int>(t.element_contacts.size()), kElementContactGrain,
             [&](Range rows) { collision::update_element_contacts(rows, h, t); });
  collision::update_rope_contacts(*world.pool, h, world.frame.rope_contacts, t);
  release_gaps(t);
  solver::find_contacts_of_stiff_solids(*world.pool, h, world.frame.surfaces, t);
}

void solve_point_contacts(WorldData& world, Real h) {
  state::Tables& t = world.tables;
  collision::stop_rope_passes(*world.pool, h, world.frame.rope_contacts, t);
  // Surfaces come before bodies: what is pressed between two bodies yields to them, and is cut off last.
  solver::SurfaceContacts& surfaces = world.frame.surfaces;
  solver::solve_surfaces(*world.pool, h, false, surfaces, t);
  solver::solve_element_contacts(h, t);
  for_ranges(*world.pool, t.contacts.count(), kContactGrain, [&](Range rows) {
    solver::solve_contacts(t.objects, rows, h, t.bodies, t.contacts, t.particles);
  });
  const auto solve_again = [&](const std::vector<std::uint8_t>& objects) {
    for_ranges(*world.pool, t.contacts.count(), kContactGrain, [&](Range rows) {
      solver::solve_contacts_again(t, objects, rows, h, t.contacts, t.particles);
    });
  };
  if (solver::refresh_surface_contacts(*world.pool, h, surfaces, t)) solve_again(surfaces.refreshed);
  for (int round = 2; surfaces.active && round <= solver::kSurfaceRounds; ++round) {
    solver::solve_surfaces(*world.pool, h, true, surfaces, t);
    solve_again(surfaces.touching);
  }
  for (solver::SoftGroup& group : world.derived.soft.groups)
    solver::settle_pressed_points(h, group.tetrahedra, t);
}

}  // namespace hooke::world
