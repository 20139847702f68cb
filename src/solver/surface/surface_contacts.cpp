#include "solver/surface/surface_contacts.h"

#include "solver/surface/solid_loads.h"
#include "solver/surface/surface_detection.h"
#include "solver/surface/surface_rows.h"
#include "solver/surface/surface_truncation.h"

#include <algorithm>
#include <atomic>

namespace hooke::solver {

namespace {

std::size_t vertex_count(const SurfaceContacts& contacts, const SurfaceGroup& group) {
  std::size_t count = 0;
  for (const std::uint32_t mesh : group.meshes) count += contacts.surfaces.meshes[mesh].vertex_count;
  return count;
}

bool has_surface(const state::Deformable& object) {
  if (object.kind == PointRef::Kind::kRope) return object.touches_surfaces;
  return object.surface.rest_points != nullptr;
}

/// Whether some surface may touch another, or itself.
bool may_touch(const state::Tables& t) {
  const auto count = [&](auto condition) {
    return std::count_if(t.objects.begin(), t.objects.end(), [&](const state::Deformable& object) {
      return has_surface(object) && condition(object);
    });
  };
  const auto all = count([](const state::Deformable&) { return true; });
  const bool any_pair =
      all > 1 && count([](const state::Deformable& object) { return object.touches_ropes; }) < all &&
      count([](const state::Deformable& object) { return object.repulsion_strength > Real(0); }) < all;
  return any_pair || count([](const state::Deformable& object) { return object.surface.self_contact; }) > 0;
}

/// Calls `work(group)` with each group, on several threads.
template <class Work>
void for_groups(parallel::ThreadPool& pool, SurfaceContacts& contacts, Work work) {
  parallel::for_items(pool, static_cast<int>(contacts.live_groups),
                      [&](int i) { work(contacts.groups[static_cast<std::size_t>(i)]); });
}

/// Calls `work(group, pool)` with each group. One that has more than a thread's share of all points gets the
/// pool, to divide its own work; of the others each is the work of one thread, and gets none.
template <class Work>
void for_groups_divided(parallel::ThreadPool& pool, SurfaceContacts& contacts, Work work) {
  std::size_t all = 0;
  contacts.for_groups([&](const SurfaceGroup& group) { all += vertex_count(contacts, group); });
  const auto is_large = [&](const SurfaceGroup& group) {
    return vertex_count(contacts, group) * static_cast<std::size_t>(pool.workers()) > all;
  };
  for_groups(pool, contacts, [&](SurfaceGroup& group) {
    if (!is_large(group)) work(group, nullptr);
  });
  contacts.for_groups([&](SurfaceGroup& group) {
    if (is_large(group)) work(group, &pool);
  });
}

/// Whether contacts are not known, or vertices are about to leave their cages.
bool needs_contacts(const state::Tables& tables, Real h, const SurfaceContacts& contacts,
                    const SurfaceGroup& group) {
  return !group.known || group.substeps_left == 0 || leaves_cages(tables, h, contacts, group);
}

/// Takes the positions with which the group begins the substep.
void place_vertices(SurfaceContacts& contacts, const SurfaceGroup& group) {
  for_vertices(contacts, group, [&](std::uint32_t vertex, std::uint32_t mesh) {
    contacts.position[vertex].x = contacts.start[vertex].x + contacts.shift[mesh];
  });
}

/// Notes which objects are to be looked at in the next step.
void note_crossings(const SurfaceContacts& contacts, state::Tables& tables) {
  for (state::Deformable& object : tables.objects) object.surface.may_cross = false;
  if (!contacts.active) return;
  for (std::size_t i = 0; i < contacts.live_groups; ++i) {
    for (const std::uint32_t mesh : contacts.groups[i].meshes)
      tables.objects[contacts.surfaces.meshes[mesh].object].surface.may_cross = contacts.may_cross[mesh] != 0;
  }
}

}  // namespace

void begin_surface_step(const state::Tables& tables, int substeps, SurfaceContacts& contacts) {
  contacts.active = may_touch(tables);
  contacts.substeps_left = substeps;
  if (!contacts.active) {
    contacts.live_groups = 0;
    return;
  }
  const bool changed = refresh_surfaces(tables, contacts.surfaces);
  contacts.for_groups([](SurfaceGroup& group) {
    group.known = false;
    group.counts = {};
  });
  contacts.regroup = true;
  contacts.may_cross.resize(contacts.surfaces.meshes.size());
  for (std::size_t i = 0; i < contacts.may_cross.size(); ++i)
    contacts.may_cross[i] = tables.objects[contacts.surfaces.meshes[i].object].surface.may_cross ? 1 : 0;
  if (!changed) return;
  contacts.any_rope = std::any_of(contacts.surfaces.meshes.begin(), contacts.surfaces.meshes.end(),
                                  [](const SurfaceMesh& mesh) { return mesh.is_rope(); });
  const auto has = [&](PointRef::Kind kind) {
    return std::any_of(contacts.surfaces.meshes.begin(), contacts.surfaces.meshes.end(),
                       [&](const SurfaceMesh& mesh) { return tables.objects[mesh.object].kind == kind; });
  };
  contacts.any_cloth_and_solid = has(PointRef::Kind::kCloth) && has(PointRef::Kind::kSolid);
  const std::size_t count = contacts.surfaces.particle.size();
  const std::size_t meshes = contacts.surfaces.meshes.size();
  contacts.live_groups = 0;
  contacts.bounds.assign(meshes, {});
  contacts.boxes.resize(meshes);
  contacts.shift.assign(meshes, {});
  contacts.start.assign(count, {});
  contacts.position.assign(count, {});
  contacts.found_at.assign(count, {});
  contacts.velocity.assign(count, {});
  contacts.cage.assign(count, {});
  contacts.stays.assign(count, 0);
  contacts.passed.assign(count, 0);
  contacts.exact_position.resize(count);
  contacts.crosses.assign(meshes, 0);
  contacts.load_share.assign(count, {});
  contacts.in_open_block.assign(count, 0);
  contacts.refreshed.assign(tables.objects.size(), 0);
  contacts.touching.assign(tables.objects.size(), 0);
}

void begin_surface_substep(const state::Tables& tables, SurfaceContacts& contacts) {
  if (!contacts.active) return;
  if (contacts.keeps_spent_rows) contacts.for_groups([](SurfaceGroup& group) { group.spent_rows.clear(); });
  for (std::size_t i = 0; i < contacts.start.size(); ++i)
    contacts.start[i] = tables.particles.position[contacts.surfaces.particle[i]];
}

void solve_surfaces(parallel::ThreadPool& pool, Real h, bool again, SurfaceContacts& contacts,
                    state::Tables& tables) {
  if (!contacts.active) return;
  for_groups(pool, contacts, [&](SurfaceGroup& group) {
    if (!group.known) return;
    if (!again) place_vertices(contacts, group);
    solve_surface_rows(h, again, contacts, group, tables.particles);
  });
}

void find_contacts_before_solutions(parallel::ThreadPool& pool, Real h, SurfaceContacts& contacts,
                                    const state::Tables& tables) {
  if (!contacts.active) return;
  // All groups are made at the same time in a step, whether a rope or a stiff solid is somewhere or not.
  if (contacts.regroup || contacts.any_stiff) refresh_surface_groups(tables, h, contacts);
  if (!contacts.any_stiff && !contacts.any_rope && !contacts.any_cloth_and_solid) return;
  for_groups_divided(pool, contacts, [&](SurfaceGroup& group, parallel::ThreadPool* workers) {
    const bool any_stiff = std::any_of(group.meshes.begin(), group.meshes.end(), [&](std::uint32_t mesh) {
      return contacts.stiff[contacts.surfaces.meshes[mesh].object] != 0;
    });
    if (!any_stiff && !group.any_rope && !may_load_cloths(tables, contacts, group)) return;
    // Planes that are out of date move what rolls or slides over an edge, which strains what is stiff.
    if (needs_contacts(tables, h, contacts, group) ||
        (any_stiff && pairs_would_meet(tables, h, contacts, group)))
      find_group_contacts(workers, tables, h, contacts, group);
  });
}

bool refresh_surface_contacts(parallel::ThreadPool& pool, Real h, SurfaceContacts& contacts,
                              state::Tables& tables) {
  if (!contacts.active) return false;
  refresh_surface_groups(tables, h, contacts);
  std::fill(contacts.refreshed.begin(), contacts.refreshed.end(), std::uint8_t{0});
  std::fill(contacts.touching.begin(), contacts.touching.end(), std::uint8_t{0});
  std::atomic<bool> any = false;
  for_groups_divided(pool, contacts, [&](SurfaceGroup& group, parallel::ThreadPool* workers) {
    for (const std::uint32_t mesh : group.meshes)
      contacts.touching[contacts.surfaces.meshes[mesh].object] = 1;
    if (!needs_contacts(tables, h, contacts, group)) return;
    any = true;
    for (const std::uint32_t mesh : group.meshes)
      contacts.refreshed[contacts.surfaces.meshes[mesh].object] = 1;
    if (contacts.keeps_spent_rows && group.known) group.spent_rows = group.rows;
    find_group_contacts(workers, tables, h, contacts, group);
    solve_surface_rows(h, false, contacts, group, tables.particles);
  });
  return any;
}

Real largest_overlap(const state::Tables& tables, const SurfaceContacts& contacts) {
  Real largest = Real(0);
  if (!contacts.active || contacts.surfaces.revision != tables.revision) return largest;
  for (std::size_t i = 0; i < contacts.live_groups; ++i) {
    const SurfaceGroup& group = contacts.groups[i];
    if (!group.known) continue;
    const DVec3 origin = tables.objects[contacts.surfaces.meshes[group.meshes.front()].object].origin;
    const auto place_of = [&](std::uint32_t vertex) {
      const Vec3 shift =
          vector_cast<Real>(tables.objects[contacts.surfaces.object_of(vertex)].origin - origin);
      return tables.particles.position[contacts.surfaces.particle[vertex]].x + shift;
    };
    for (const SurfaceRowBlock& block : group.rows) {
      for (int lane = 0; lane < block.count; ++lane) {
        const Vec3 normal = {block.normal[0][lane], block.normal[1][lane], block.normal[2][lane]};
        Real overlap = block.distance[lane];
        for (std::size_t k = 0; k < 4; ++k)
          overlap -= block.weight[k][lane] * dot(normal, place_of(block.record[k][lane] / 4));
        largest = std::max(largest, overlap);
      }
    }
  }
  return largest;
}

void truncate_surfaces(parallel::ThreadPool& pool, Real h, SurfaceContacts& contacts, state::Tables& tables) {
  if (contacts.active) {
    for_groups(pool, contacts, [&](SurfaceGroup& group) {
      truncate_group(h, contacts, group, tables);
      --group.substeps_left;
    });
  }
  if (--contacts.substeps_left == 0) note_crossings(contacts, tables);
}

}  // namespace hooke::solver
