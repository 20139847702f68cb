#pragma once

#include "parallel/thread_pool.h"
#include "solver/surface/surface_groups.h"

namespace hooke::solver {

/// Finds the contacts of a group from where its vertices began the substep, and from their velocities now:
/// cages in which they are expected to stay for as many of the `substeps` left as they move little, rows for
/// what comes near, and the pairs that cages do not keep apart. Surfaces and pairs of them are divided among
/// the threads of `pool`, unless it is null.
void find_group_contacts(parallel::ThreadPool* pool, const state::Tables& tables, Real h,
                         SurfaceContacts& contacts, SurfaceGroup& group);

/// What clip_to_cage does where the vertex has gone farther than its room.
bool clip_out_of_start(const SurfaceCage& cage, Vec3& displacement);

/// Clips the displacement of a vertex to its cage: where it is, relative to where contacts were found and to
/// the motion of the group. Returns whether it was outside.
inline bool clip_to_cage(const SurfaceCage& cage, Vec3& displacement) {
  // Most vertices have gone less than their room, which is certain without a division and a root.
  constexpr Real kCertain = Real(0.999);
  if (length_squared(displacement) < kCertain * cage.room * cage.room) return false;
  return clip_out_of_start(cage, displacement);
}

/// Mean velocity of the vertices of a group, of which `velocity_of(vertex)` is each; zero where one is held.
template <class VelocityOf>
Vec3 mean_velocity(const SurfaceContacts& contacts, const SurfaceGroup& group, VelocityOf velocity_of) {
  DVec3 sum;
  double count = 0;
  if (group.held) return {};
  for_vertices(contacts, group, [&](std::uint32_t vertex, std::uint32_t) {
    const Vec3 v = velocity_of(vertex);
    if (!is_finite(v)) return;
    sum += vector_cast<double>(v);
    count += 1;
  });
  return count > 0 ? vector_cast<Real>((1 / count) * sum) : Vec3{};
}

}  // namespace hooke::solver
