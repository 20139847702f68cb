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

Path path_of(const state::Tables& t, const SurfaceContacts& contacts, const SurfaceMesh& mesh, Real time) {
  Path path;
  Real fastest = Real(0);
  for (std::uint32_t i = mesh.first_vertex; i < mesh.end_vertex(); ++i) {
    const std::uint32_t particle = contacts.surfaces.particle[i];
    const Vec3 x = t.particles.position[particle].x;
    const Vec3 v = t.particles.velocity[particle].v;
    for (const Vec3 p : {x, x + time * v, contacts.start[i].x}) {
      if (is_finite(p)) path.box = merge(path.box, {p, p});  // Others are quarantined when the step ends.
    }
    if (is_finite(v)) fastest = std::max(fastest, length_squared(v));
  }
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

/// Lists the pairs of surfaces whose bounds overlap, in ascending order.
void list_pairs(const state::Tables& t, SurfaceContacts& contacts) {
  const std::vector<SurfaceMesh>& meshes = contacts.surfaces.meshes;
  auto& order = contacts.order;
  order.clear();
  for (std::uint32_t i = 0; i < meshes.size(); ++i) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(contacts.bounds[a].lower.x, a) < std::pair(contacts.bounds[b].lower.x, b);
  });
  contacts.next_pairs.clear();
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::uint32_t a = order[i];
    const state::Deformable& object = t.objects[meshes[a].object];
    if (object.surface.self_contact) contacts.next_pairs.push_back({a, a});
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const std::uint32_t b = order[j];
      if (contacts.bounds[b].lower.x > contacts.bounds[a].upper.x) break;
      if (!overlap(contacts.bounds[a], contacts.bounds[b])) continue;
      if (!state::filters_agree(object.surface.filter, t.objects[meshes[b].object].surface.filter)) continue;
      contacts.next_pairs.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(contacts.next_pairs.begin(), contacts.next_pairs.end());
}

/// Takes over what was found by a group of the same surfaces and pairs.
void keep_found(SurfaceContacts& contacts, SurfaceGroup& group) {
  for (std::size_t i = 0; i < contacts.live_groups; ++i) {
    SurfaceGroup& old = contacts.groups[i];
    if (!old.known || old.meshes != group.meshes || old.pairs != group.pairs) continue;
    std::swap(old, group);
    return;
  }
}

void make_groups(SurfaceContacts& contacts) {
  const auto mesh_count = static_cast<std::uint32_t>(contacts.surfaces.meshes.size());
  base::DisjointSets& sets = contacts.sets;
  sets.reset(mesh_count);
  for (const auto& [a, b] : contacts.next_pairs) sets.merge(a, b);
  std::size_t count = 0;
  auto& group_of = contacts.order;  // The group of each mesh, by the root of its set.
  group_of.assign(mesh_count, SurfaceNode::kLeaf);
  for (const auto& [a, b] : contacts.next_pairs) {
    std::uint32_t& number = group_of[sets.root(a)];
    if (number == SurfaceNode::kLeaf) {
      number = static_cast<std::uint32_t>(count++);
      if (contacts.next_groups.size() < count) contacts.next_groups.emplace_back();
      SurfaceGroup& group = contacts.next_groups[number];
      group.meshes.clear();
      group.pairs.clear();
      group.known = false;
      group.counts = {};
    }
    contacts.next_groups[number].pairs.push_back({a, b});
  }
  for (std::uint32_t i = 0; i < mesh_count; ++i) {
    const std::uint32_t number = group_of[sets.root(i)];
    if (number != SurfaceNode::kLeaf) contacts.next_groups[number].meshes.push_back(i);
  }
  for (std::size_t i = 0; i < count; ++i) keep_found(contacts, contacts.next_groups[i]);
  std::swap(contacts.groups, contacts.next_groups);
  contacts.live_groups = count;
}

}  // namespace

void refresh_surface_groups(const state::Tables& tables, Real h, SurfaceContacts& contacts) {
  if (!refresh_bounds(tables, h, contacts)) return;
  if (contacts.regroup) contacts.for_groups([](SurfaceGroup& group) { group.known = false; });
  contacts.regroup = false;
  list_pairs(tables, contacts);
  make_groups(contacts);
}

}  // namespace hooke::solver
