#include "world/step_report.h"

#include "solver/cluster_counts.h"
#include "solver/routes.h"

#include <algorithm>
#include <utility>

namespace hooke::world {

namespace {

/// Share of the points of surfaces that were held back, over all that may touch and all substeps.
double held_back_share(const WorldData& world, std::uint32_t held_back) {
  const solver::SurfaceContacts& contacts = world.frame.surfaces;
  if (held_back == 0 || !contacts.active) return 0;
  double points = 0;
  for (std::size_t i = 0; i < contacts.live_groups; ++i) {
    for (const std::uint32_t mesh : contacts.groups[i].meshes)
      points += contacts.surfaces.meshes[mesh].vertex_count;
  }
  const WorldDesc& desc = world.tables.desc;
  return held_back / (points * desc.substeps * desc.particle_substeps);
}

void count_refused(WorldData& world, StepReport& report) {
  for (const solver::RopeSystem& rope_system : world.derived.rope_systems) {
    report.rope_solves += rope_system.solves;
    report.ropes_unconverged += rope_system.unconverged ? 1 : 0;
  }
  for (solver::CoupledGroup& group : world.derived.coupled_groups.groups)
    report.coupled_groups_cut_short += std::exchange(group.cut_short, false) ? 1 : 0;
  world.frame.surfaces.for_groups([&](const solver::SurfaceGroup& group) {
    report.points_held_back += group.counts.held_back;
    report.surfaces_touching += group.counts.uncertain;
    report.surfaces_crossing += group.counts.crossings;
    report.surface_searches += group.counts.searches;
    report.surface_pairs += group.counts.pairs;
  });
  report.held_back_share = held_back_share(world, report.points_held_back);
  report.points_held_back += std::exchange(world.frame.passes_held_back, 0);
  report.surfaces_touching += std::exchange(world.frame.passes_left, 0);
  report.cloths_unconverged = std::exchange(world.frame.cloths_unconverged, 0);
  report.cloths_left_to_contacts = std::exchange(world.frame.cloths_left_to_contacts, 0);
  for (solver::SoftGroup& group : world.derived.soft.groups)
    report.solids_unconverged += std::exchange(group.tetrahedra.stiff.unconverged, false) ? 1 : 0;
}

void count_rows(WorldData& world, StepReport& report) {
  const state::Tables& tables = world.tables;
  count_refused(world, report);
  report.contacts = static_cast<std::uint32_t>(std::count_if(tables.contacts.normal_force.begin(),
                                                             tables.contacts.normal_force.end(),
                                                             [](Real n) { return n > Real(0); }));
  for (const state::ElementContact& element_contact : tables.element_contacts)
    report.contacts += element_contact.normal_force > Real(0) ? 1 : 0;
  for (const state::RopeContact& contact : tables.rope_contacts)
    report.contacts += contact.normal_force > Real(0) ? 1 : 0;
  world.frame.surfaces.for_groups([&](const solver::SurfaceGroup& group) {
    for (const solver::SurfaceRowBlock& block : group.rows) {
      report.contacts += static_cast<std::uint32_t>(
          std::count_if(block.pushed, block.pushed + block.count, [](Real p) { return p > Real(0); }));
    }
  });
  report.contacts += tables.pairs.sleeping.contacts;
  for (const state::Manifold& manifold : tables.pairs.manifold) report.contacts += pushing_points(manifold);
  report.pairs = static_cast<std::uint32_t>(tables.pairs.pair.size() + tables.pairs.sleeping.pair.size());
  report.pairs_left_out = world.frame.dense_piles.left_out();
  report.bodies_awake = static_cast<std::uint32_t>(
      std::count_if(world.frame.awake.begin(), world.frame.awake.end(),
                    [&](std::uint32_t body) { return tables.bodies.asleep[body] == 0; }));
}

}  // namespace

void count_routes(const WorldData& world, StepReport& report) {
  report.routes =
      solver::count_routes(world.tables, world.derived.joints, world.derived.rope_systems,
                           world.derived.coupled_groups, world.frame.direct_islands, world.frame.routes);
  const solver::ClusterCounts counts = solver::count_clusters(
      world.tables, world.derived.rope_systems, world.frame.direct_islands,
      {world.derived.joints, world.derived.coupled_groups, world.frame.load_bearing.refused_manifolds});
  report.clusters = counts.clusters;
  report.rows_direct = counts.rows_direct;
  report.rows_refused = counts.rows_refused;
  report.worst_error = counts.worst_error;
}

void end_step(WorldData& world, double dt, StepReport& report) {
  state::Tables& tables = world.tables;
  const int substeps = tables.desc.substeps * tables.desc.particle_substeps;
  const Real share = Real(1) / static_cast<Real>(substeps);
  for (Real& tension : tables.segments.mean_tension) tension *= share;
  for (state::TwistSpan& span : tables.twists) span.mean_torque *= share;
  count_rows(world, report);
  if (tables.any_force) std::fill(tables.particles.force.begin(), tables.particles.force.end(), Vec3{});
  tables.any_force = false;
  tables.time += dt;
  tables.substep = dt / substeps;
  ++tables.step_count;
  report.moved = true;
}

}  // namespace hooke::world
