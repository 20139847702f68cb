#include "solver/surface/surface_groups.h"

#include "solver/surface/surface_tuning.h"
#include "state/bodies.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hooke::solver {

namespace {

using geometry::Box;
using geometry::Box3;

/// The box of a surface's vertices and their displacement within `time` [s].
struct Path {
  Box box;
  Real fastest = Real(0);
};

/// Grows a box by a point, unless a coordinate is not a number. Branches on each would cost more than all
/// else.
void take(Vec3 p, Box& box) {
  const auto least = [](Real a, Real b) { return a < b ? a : b; };
  const auto most = [](Real a, Real b) { return a > b ? a : b; };
  box.lower = {least(p.x, box.lower.x), least(p.y, box.lower.y), least(p.z, box.lower.z)};
  box.upper = {most(p.x, box.upper.x), most(p.y, box.upper.y), most(p.z, box.upper.z)};
}

/// Calls `visit(x, v, start)` with each vertex of a surface.
template <class Visit>
void for_paths(const state::Tables& t, const SurfaceContacts& contacts, const SurfaceMesh& mesh,
               Visit visit) {
  for (std::uint32_t i = mesh.first_vertex; i < mesh.end_vertex(); ++i) {
    const std::uint32_t particle = contacts.surfaces.particle[i];
    visit(t.particles.position[particle].x, t.particles.velocity[particle].v, contacts.start[i].x);
  }
}

Path path_of(const state::Tables& t, const SurfaceContacts& contacts, const SurfaceMesh& mesh, Real time) {
  Path path;
  Real fastest = Real(0);
  for_paths(t, contacts, mesh, [&](Vec3 x, Vec3 v, Vec3 start) {
    for (const Vec3 p : {x, x + time * v, start}) take(p, path.box);
    const Real squared = length_squared(v);
    fastest = squared > fastest ? squared : fastest;
  });
  path.fastest = std::sqrt(fastest);
  if (is_finite(path.box.upper - path.box.lower) && std::isfinite(fastest)) return path;
  // Some point is infinite; it is quarantined when the step ends.
  path = {};
  fastest = Real(0);
  for_paths(t, contacts, mesh, [&](Vec3 x, Vec3 v, Vec3 start) {
    for (const Vec3 p : {x, x + time * v, start}) {
      if (is_finite(p)) take(p, path.box);
    }
    if (is_finite(v)) fastest = std::max(fastest, length_squared(v));
  });
  path.fastest = std::sqrt(fastest);
  return path;
}

Box3<double> bounds_of(const Path& path, DVec3 origin, Real room) {
  const auto r = static_cast<double>(room);
  return {origin + vector_cast<double>(path.box.lower) - DVec3{r, r, r},
          origin + vector_cast<double>(path.box.upper) + DVec3{r, r, r}};
}

/// Makes the bounds of surfaces anew that left theirs, or of all. Returns whether there were any.
bool refresh_bounds(const state::Tables& t, Real h, SurfaceContacts& contacts) {
  const Real time = h * static_cast<Real>(contacts.substeps_left);
  const Real fall = length(t.desc.gravity) * time * time;
  bool any = false;
  for (std::uint32_t i = 0; i < contacts.surfaces.meshes.size(); ++i) {
    const SurfaceMesh& mesh = contacts.surfaces.meshes[i];
    const state::Deformable& object = t.objects[mesh.object];
    const Real reach = Real(1.5) * object.surface.radius;
    if (!contacts.regroup) {
      const Path path = path_of(t, contacts, mesh, h);
      if (contains(contacts.bounds[i], bounds_of(path, object.origin, reach))) continue;
    }
    const Path path = path_of(t, contacts, mesh, time);
    const Real room = reach + kCageDisplacement * (object.surface.edge + path.fastest * time) + fall;
    contacts.bounds[i] = bounds_of(path, object.origin, room);
    any = true;
  }
  return any;
}

/// Whether it is a rope that repels others: of these no two touch (surfaces_touch).
bool repels(const state::Tables& t, const SurfaceContacts& contacts, std::uint32_t mesh) {
  return t.objects[contacts.surfaces.meshes[mesh].object].repulsion_strength > Real(0);
}

/// Lists the pairs of surfaces whose bounds overlap, in ascending order.
void list_pairs(const state::Tables& t, SurfaceContacts& contacts) {
  const std::vector<SurfaceMesh>& meshes = contacts.surfaces.meshes;
  auto& order = contacts.order;
  order.clear();
  for (std::uint32_t i = 0; i < meshes.size(); ++i) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(contacts.bounds[a].lower.x, a) < std::pair(contacts.bounds[b].lower.x, b);
  });
  // Hair is looked at only against what is no hair, which stands once more behind all: all pairs of some
  // thousand strands would take longer than all else.
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const std::uint32_t mesh = order[i];
    if (!repels(t, contacts, mesh)) order.push_back(mesh);
  }
  std::size_t next_other = meshes.size();
  contacts.next_pairs.clear();
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const std::uint32_t a = order[i];
    const state::Deformable& object = t.objects[meshes[a].object];
    if (object.surface.self_contact) contacts.next_pairs.push_back({a, a});
    const bool is_hair = repels(t, contacts, a);
    if (!is_hair) ++next_other;
    const std::size_t end = is_hair ? order.size() : meshes.size();
    for (std::size_t j = is_hair ? next_other : i + 1; j < end; ++j) {
      const std::uint32_t b = order[j];
      if (contacts.bounds[b].lower.x > contacts.bounds[a].upper.x) break;
      if (!overlap(contacts.bounds[a], contacts.bounds[b])) continue;
      if (!surfaces_touch(t, contacts.surfaces, a, b)) continue;
      contacts.next_pairs.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(contacts.next_pairs.begin(), contacts.next_pairs.end());
}

/// Takes over what was found by a group of the same surfaces and pairs. Groups stand in the order of their
/// first surfaces.
void keep_found(SurfaceContacts& contacts, SurfaceGroup& group) {
  const auto end = contacts.groups.begin() + static_cast<std::ptrdiff_t>(contacts.live_groups);
  const auto old =
      std::lower_bound(contacts.groups.begin(), end, group.meshes.front(),
                       [](const SurfaceGroup& g, std::uint32_t mesh) { return g.meshes.front() < mesh; });
  if (old != end && old->known && old->meshes == group.meshes && old->pairs == group.pairs)
    std::swap(*old, group);
}

void make_groups(SurfaceContacts& contacts) {
  const auto mesh_count = static_cast<std::uint32_t>(contacts.surfaces.meshes.size());
  base::DisjointSets& sets = contacts.sets;
  sets.reset(mesh_count);
  for (const auto& [a, b] : contacts.next_pairs) sets.merge(a, b);
  std::size_t count = 0;
  auto& group_of = contacts.order;  // The group of each mesh, by the root of its set.
  group_of.assign(mesh_count, SurfaceNode::kNone);
  for (const auto& [a, b] : contacts.next_pairs) {
    std::uint32_t& number = group_of[sets.root(a)];
    if (number == SurfaceNode::kNone) {
      number = static_cast<std::uint32_t>(count++);
      if (contacts.next_groups.size() < count) contacts.next_groups.emplace_back();
      SurfaceGroup& group = contacts.next_groups[number];
      group.meshes.clear();
      group.pairs.clear();
      group.known = false;
      group.counts = {};
      group.spent_rows.clear();
    }
    contacts.next_groups[number].pairs.push_back({a, b});
  }
  for (std::uint32_t i = 0; i < mesh_count; ++i) {
    const std::uint32_t number = group_of[sets.root(i)];
    if (number != SurfaceNode::kNone) contacts.next_groups[number].meshes.push_back(i);
  }
  for (std::size_t i = 0; i < count; ++i) {
    SurfaceGroup& group = contacts.next_groups[i];
    group.any_rope = std::any_of(group.meshes.begin(), group.meshes.end(), [&](std::uint32_t mesh) {
      return contacts.surfaces.meshes[mesh].is_rope();
    });
    group.first_load = group.end_load = 0;
  }
  for (std::size_t i = 0; i < count; ++i) keep_found(contacts, contacts.next_groups[i]);
  std::swap(contacts.groups, contacts.next_groups);
  contacts.live_groups = count;
}

}  // namespace

// Ropes that both touch ropes are solved as one (docs/decisions/0024-ropes-that-touch.md), and those that
// both repel keep their distance.
bool surfaces_touch(const state::Tables& tables, const SurfaceMeshes& surfaces, std::uint32_t a,
                    std::uint32_t b) {
  const state::Deformable& first = tables.objects[surfaces.meshes[a].object];
  const state::Deformable& second = tables.objects[surfaces.meshes[b].object];
  if (!state::filters_agree(first.surface.filter, second.surface.filter)) return false;
  if (first.touches_ropes && second.touches_ropes) return false;
  if (first.repulsion_strength > Real(0) && second.repulsion_strength > Real(0)) return false;
  const std::array<std::uint32_t, 2> pair = {std::min(a, b), std::max(a, b)};
  return !std::binary_search(surfaces.sewn.begin(), surfaces.sewn.end(), pair);
}

void refresh_surface_groups(const state::Tables& tables, Real h, SurfaceContacts& contacts) {
  if (!refresh_bounds(tables, h, contacts)) return;
  if (contacts.regroup) contacts.for_groups([](SurfaceGroup& group) { group.known = false; });
  contacts.regroup = false;
  list_pairs(tables, contacts);
  make_groups(contacts);
}

}  // namespace hooke::solver
