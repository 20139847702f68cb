#include "world/point_contact_stages.h"

#include "base/assert.h"
#include "collision/deformable/body_passes.h"
#include "collision/deformable/element_contacts.h"
#include "collision/deformable/particle_contacts.h"
#include "collision/deformable/pass_zones.h"
#include "collision/deformable/rope_contacts.h"
#include "collision/deformable/rope_passes.h"
#include "parallel/thread_pool.h"
#include "solver/contact/stop_passes.h"
#include "solver/rope/rope_spread.h"
#include "solver/soft/element_contact_solve.h"
#include "solver/soft/particle_contact_solve.h"
#include "solver/soft/pass_masses.h"
#include "solver/soft/pressed_points.h"
#include "solver/soft/soft_tuning.h"
#include "solver/surface/surface_contacts.h"
#include "solver/surface/surface_tuning.h"
#include "state/check_contacts.h"
#include "world/events.h"

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

collision::PassSubstep pass_substep(const WorldData& world, Real h) {
  const WorldDesc& desc = world.tables.desc;
  return {.h = h,
          .left = h * static_cast<Real>(desc.substeps * desc.particle_substeps),
          .first = true,
          .solved_whole = world.frame.surfaces.stiff};
}

}  // namespace

void find_point_contacts(WorldData& world, double dt) {
  begin_deformable_touches(world, dt);
  collision::find_contacts(dt, world.frame.particle_contacts, world.tables);
  remove_contacts_of_gaps(world.tables);
  collision::find_rope_contacts(*world.pool, static_cast<Real>(dt), world.frame.rope_contacts, world.tables);
  collision::find_body_passes(world.tables, static_cast<Real>(dt), world.frame.body_passes);
  world.frame.bodies_quarantined = false;
  world.frame.body_manifolds.clear();
  world.frame.backing_contacts.clear();
  HOOKE_VALIDATE(state::find_in_point_contacts(world.tables));
}

void update_point_contacts(WorldData& world, Real h) {
  state::Tables& t = world.tables;
  collision::begin_body_passes(t, world.frame.body_passes);
  for_ranges(*world.pool, t.contacts.count(), kContactGrain,
             [&](Range rows) { collision::update_contacts(rows, h, world.frame.particle_contacts, t); });
  for_ranges(*world.pool, static_cast<int>(t.element_contacts.size()), kElementContactGrain,
             [&](Range rows) { collision::update_element_contacts(rows, h, t); });
  collision::update_rope_contacts(*world.pool, h, world.frame.rope_contacts, t);
  release_gaps(t);
  solver::find_contacts_before_solutions(*world.pool, h, world.frame.surfaces, t);
  note_closing_deformables(world, h);
}

void solve_point_contacts(WorldData& world, Real h) {
  state::Tables& t = world.tables;
  collision::stop_rope_passes(*world.pool, h, world.frame.rope_contacts, t);
  // Surfaces come before bodies: what is pressed between two bodies yields to them, and is cut off last.
  solver::SurfaceContacts& surfaces = world.frame.surfaces;
  solver::begin_rope_spread(world.derived.rope_systems, surfaces, t, world.frame.rope_spread);
  const auto spread = [&] {
    solver::spread_over_ropes(h, world.derived.rope_systems, world.frame.rope_spread, t);
  };
  solver::solve_surfaces(*world.pool, h, false, surfaces, t);
  spread();
  solver::solve_element_contacts(h, t);
  for_ranges(*world.pool, t.contacts.count(), kContactGrain, [&](Range rows) {
    solver::solve_contacts(t.objects, rows, h, t.bodies, t.contacts, t.particles);
  });
  const auto solve_again = [&](const std::vector<std::uint8_t>& objects) {
    for_ranges(*world.pool, t.contacts.count(), kContactGrain, [&](Range rows) {
      solver::solve_contacts_again(t, objects, rows, h, t.contacts, t.particles);
    });
  };
  if (solver::refresh_surface_contacts(*world.pool, h, surfaces, t)) {
    spread();
    solve_again(surfaces.refreshed);
  }
  for (int round = 2; surfaces.active && round <= solver::kSurfaceRounds; ++round) {
    solver::solve_surfaces(*world.pool, h, true, surfaces, t);
    spread();
    solve_again(surfaces.touching);
  }
  for (solver::SoftGroup& group : world.derived.soft.groups)
    solver::settle_pressed_points(h, group.tetrahedra, t);
  if (!world.frame.loaded_cloths.cloths.empty())
    solver::settle_cloth_presses(world.frame.loaded_cloths.presses, h, t.contacts);
}

void find_pressed_faces(WorldData& world, Real h) {
  world.frame.pressed_faces.clear();
  if (!world.frame.surfaces.any_stiff) return;
  collision::find_pressed_faces(*world.pool, world.tables, pass_substep(world, h), world.frame.body_passes,
                                world.frame.pressed_faces);
}

void share_passing_masses(WorldData& world, Real h, bool first) {
  state::Tables& t = world.tables;
  collision::BodyPassFinder& finder = world.frame.body_passes;
  world.frame.pass_masses.clear();
  if (finder.pairs.empty()) return;
  if (first) {
    collision::sweep_body_passes(*world.pool, t, pass_substep(world, h), finder);
    collision::forget_body_passes(finder);
  }
  solver::share_pass_masses(finder.passes, world.frame.surfaces.stiff, world.frame.loaded_cloths.pressing, t,
                            world.frame.pass_masses);
}

void give_back_passing_masses(WorldData& world) {
  solver::give_back_pass_masses(world.frame.pass_masses, world.tables);
}

void stop_body_passes(WorldData& world, Real h) {
  state::Tables& t = world.tables;
  collision::BodyPassFinder& finder = world.frame.body_passes;
  collision::PassSubstep substep = pass_substep(world, h);
  for (int round = 0; round < solver::kPassRounds; ++round) {
    if (!collision::sweep_body_passes(*world.pool, t, substep, finder)) break;
    substep.first = false;
    solver::stop_passes(h, finder.passes, world.frame.backing_contacts, world.frame.body_contacts, t);
  }
  if (!substep.first) add_pass_impulses(world, h, finder.passes);
}

void hold_back_passes(WorldData& world, Real h) {
  if (world.frame.bodies_quarantined) return;  // These are not where their substep began.
  const collision::HeldBack held =
      collision::hold_back_passes(*world.pool, h, world.frame.surfaces.stiff, world.frame.body_manifolds,
                                  world.frame.body_passes, world.tables);
  world.frame.passes_held_back += held.moved;
  world.frame.passes_left += held.left;
}

}  // namespace hooke::world
