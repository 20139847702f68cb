#include "solver/surface/joined_solids.h"

#include "solver/body/joint_body.h"
#include "solver/surface/surface_tuning.h"

#include <algorithm>
#include <array>

namespace hooke::solver {

namespace {

/// Calls `visit(row)` with all contacts that belong to stiff solutions.
template <class Visit>
void for_stiff_rows(const SurfaceContacts& contacts, Visit visit) {
  if (!contacts.active) return;
  for (std::size_t i = 0; i < contacts.live_groups; ++i) {
    if (!contacts.groups[i].known) continue;
    for (const SurfaceRow& row : contacts.groups[i].stiff_rows) visit(row);
  }
}

/// The row of a contact as it stands, for a substep of `h` [s].
StiffRow stiff_row(const state::Tables& t, const SurfaceContacts& contacts, const SoftGroups& soft,
                   const std::vector<std::uint32_t>& part_of, const SurfaceRow& row, Real h) {
  StiffRow result = {.normal = normalize(vector_cast<double>(row.normal)),
                     .friction = static_cast<double>(row.friction)};
  DVec3 between;
  const DVec3 origin = t.objects[contacts.surfaces.object_of(row.vertex[0])].origin;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::uint32_t object = contacts.surfaces.object_of(row.vertex[k]);
    const std::uint32_t particle = contacts.surfaces.particle[row.vertex[k]];
    const SoftGroup& group = soft.groups[soft.group_of[object]];
    const auto weight = static_cast<double>(row.weight[k]);
    result.corners.add(part_of[soft.group_of[object]], particle - group.tetrahedra.first_particle, weight);
    const DVec3 x = t.objects[object].origin - origin + vector_cast<double>(t.particles.position[particle].x);
    between += weight * x;
    result.before += weight * vector_cast<double>(t.particles.velocity[particle].v);
  }
  const double gap = dot(result.normal, between) - static_cast<double>(row.distance);
  const double rate = -gap / static_cast<double>(h);
  result.least_speed = gap > 0 ? rate
                               : std::min(static_cast<double>(kSurfaceRecovery) * rate,
                                          static_cast<double>(kSurfaceRecoverySpeed));
  return result;
}

/// The row of a face and a body as they stand, for a substep of `h` [s].
StiffRow stiff_row(const state::Tables& t, const SoftGroup& group, std::uint32_t part,
                   const state::ElementContact& face, Real h) {
  StiffRow result = {.normal = normalize(vector_cast<double>(face.normal)),
                     .friction = static_cast<double>(face.friction)};
  result.other.lever = vector_cast<double>(face.lever);
  if (state::gives_way(t.bodies, face.body)) result.other.body = face.body;
  const Vec3 surface = state::velocity_now(t.bodies, face.body, face.lever) + face.belt_velocity;
  result.before = -vector_cast<double>(surface);
  for (std::size_t k = 0; k < face.count; ++k) {
    const auto weight = static_cast<double>(face.weight[k]);
    result.corners.add(part, face.particle[k] - group.tetrahedra.first_particle, weight);
    result.before += weight * vector_cast<double>(t.particles.velocity[face.particle[k]].v);
  }
  result.least_speed = -static_cast<double>(std::max(face.separation, Real(0))) / static_cast<double>(h);
  return result;
}

std::uint32_t group_of(const SurfaceContacts& contacts, const SoftGroups& soft, std::uint32_t vertex) {
  return soft.group_of[contacts.surfaces.object_of(vertex)];
}

/// Whether an end of a hook is on a solid that is solved as a whole.
bool is_on_stiff(const SurfaceContacts& contacts, const state::HookPlace& end) {
  return end.is_point() && contacts.stiff[end.object] != 0;
}

/// Whether a hook belongs to the solution: one that holds points of stiff solids to each other, a body or the
/// world. Points of ropes and cloths are too light to matter, and move meanwhile.
bool is_tie(const SurfaceContacts& contacts, const state::Hook& hook) {
  if (hook.kind != HookKind::kBall || hook.broken) return false;
  const bool a = is_on_stiff(contacts, hook.a);
  const bool b = is_on_stiff(contacts, hook.b);
  return (a && (b || !hook.b.is_point())) || (b && !hook.a.is_point());
}

void list_hooks(const state::Tables& t, const SurfaceContacts& contacts, JoinedSolids& joined) {
  joined.hooks.clear();
  for (std::uint32_t i = 0; i < t.hooks.size(); ++i) {
    if (is_tie(contacts, t.hooks[i])) joined.hooks.push_back(i);
  }
}

/// The group of the first point that a hook holds.
std::uint32_t group_of(const SoftGroups& soft, const state::Hook& hook) {
  return soft.group_of[hook.a.is_point() ? hook.a.object : hook.b.object];
}

/// Finds which groups are solved together. A system has the number of its first contact or hook.
void number_systems(const state::Tables& t, const SurfaceContacts& contacts,
                    std::span<const state::ElementContact> faces, const SoftGroups& soft,
                    JoinedSolids& joined) {
  joined.sets.reset(soft.groups.size());
  for_stiff_rows(contacts, [&](const SurfaceRow& row) {
    joined.sets.merge(group_of(contacts, soft, row.vertex[0]), group_of(contacts, soft, row.vertex[3]));
  });
  for (const std::uint32_t i : joined.hooks) {
    const state::Hook& hook = t.hooks[i];
    if (hook.a.is_point() && hook.b.is_point())
      joined.sets.merge(soft.group_of[hook.a.object], soft.group_of[hook.b.object]);
  }
  const auto number = [&](std::uint32_t group) {
    std::uint32_t& system = joined.system_of[joined.sets.root(group)];
    if (system != 0) return;
    joined.systems.emplace_back();
    system = static_cast<std::uint32_t>(joined.systems.size());
  };
  for_stiff_rows(contacts, [&](const SurfaceRow& row) { number(group_of(contacts, soft, row.vertex[0])); });
  for (const std::uint32_t i : joined.hooks) number(group_of(soft, t.hooks[i]));
  for (const state::ElementContact& face : faces) number(soft.group_of[face.object]);
  for (std::uint32_t i = 0; i < soft.groups.size(); ++i)
    joined.system_of[i] = joined.system_of[joined.sets.root(i)];
}

/// Gives each system its range of a list of which it has `end - first` items so far.
void lay_out(std::vector<JoinedSolids::System>& systems, std::size_t JoinedSolids::System::*first,
             std::size_t JoinedSolids::System::*end) {
  std::size_t next = 0;
  for (JoinedSolids::System& system : systems) {
    const std::size_t count = system.*end - system.*first;
    system.*first = system.*end = next;
    next += count;
  }
}

void list_parts(SoftGroups& soft, JoinedSolids& joined) {
  using System = JoinedSolids::System;
  std::size_t count = 0;
  for (const std::uint32_t number : joined.system_of) {
    if (number == 0) continue;
    ++joined.systems[number - 1].end_part;
    ++count;
  }
  lay_out(joined.systems, &System::first_part, &System::end_part);
  joined.parts.resize(count);
  joined.part_of.assign(soft.groups.size(), 0);
  for (std::size_t i = 0; i < soft.groups.size(); ++i) {
    if (joined.system_of[i] == 0) continue;
    System& system = joined.systems[joined.system_of[i] - 1];
    joined.part_of[i] = static_cast<std::uint32_t>(system.end_part - system.first_part);
    joined.parts[system.end_part++] = &soft.groups[i].tetrahedra;
  }
}

/// Gives each body that several groups hold the share of its mass that each of them has.
void share_masses(const state::Tables& t, std::span<const state::ElementContact> faces,
                  const SoftGroups& soft, JoinedSolids& joined) {
  joined.tied.clear();
  for (const std::uint32_t i : joined.hooks) {
    const state::Hook& hook = t.hooks[i];
    const state::HookPlace& other = hook.a.is_point() ? hook.b : hook.a;
    joined.tied.push_back({other.is_point() ? StiffEnd::kNone : other.body, group_of(soft, hook)});
  }
  for (const state::ElementContact& face : faces)
    joined.tied.push_back({face.body, soft.group_of[face.object]});
  std::sort(joined.tied.begin(), joined.tied.end());
}

/// The share of a body's mass that a group has whose hooks or faces hold it.
double share_of(const JoinedSolids& joined, std::uint32_t body, std::uint32_t group) {
  const auto count = [&](std::array<std::uint32_t, 2> first, std::array<std::uint32_t, 2> last) {
    return static_cast<double>(std::upper_bound(joined.tied.begin(), joined.tied.end(), last) -
                               std::lower_bound(joined.tied.begin(), joined.tied.end(), first));
  };
  return count({body, group}, {body, group}) / count({body, 0}, {body, ~std::uint32_t{0}});
}

void list_rows(const state::Tables& t, const SurfaceContacts& contacts,
               std::span<const state::ElementContact> faces, Real h, const SoftGroups& soft,
               JoinedSolids& joined) {
  using System = JoinedSolids::System;
  const auto system_of = [&](const SurfaceRow& row) -> System& {
    return joined.systems[joined.system_of[group_of(contacts, soft, row.vertex[0])] - 1];
  };
  std::size_t count = 0;
  for_stiff_rows(contacts, [&](const SurfaceRow& row) {
    ++system_of(row).end_row;
    ++count;
  });
  const auto system_of_face = [&](const state::ElementContact& face) -> System& {
    return joined.systems[joined.system_of[soft.group_of[face.object]] - 1];
  };
  for (const state::ElementContact& face : faces) ++system_of_face(face).end_row;
  count += faces.size();
  lay_out(joined.systems, &System::first_row, &System::end_row);
  joined.rows.resize(count);
  for_stiff_rows(contacts, [&](const SurfaceRow& row) {
    joined.rows[system_of(row).end_row++] = stiff_row(t, contacts, soft, joined.part_of, row, h);
  });
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const std::uint32_t group = soft.group_of[faces[i].object];
    StiffRow& row = joined.rows[system_of_face(faces[i]).end_row++];
    row = stiff_row(t, soft.groups[group], joined.part_of[group], faces[i], h);
    row.face = static_cast<std::uint32_t>(i);
    if (row.other.body != StiffEnd::kNone) row.other.share = share_of(joined, row.other.body, group);
  }
}

/// A hook as it stands, for a substep of `h` [s].
StiffTie tie_of(const state::Tables& t, const SoftGroups& soft, const std::vector<std::uint32_t>& part_of,
                const state::Hook& hook, Real h) {
  StiffTie tie;
  DVec3 gap;
  double side = 1;
  for (const state::HookPlace* end : {&hook.a, &hook.b}) {
    if (!end->is_point()) continue;
    const std::uint32_t group = soft.group_of[end->object];
    for (std::uint32_t i = 0; i < end->particle_count; ++i) {
      const double weight = side * static_cast<double>(end->weight[i]);
      const std::uint32_t particle = end->particle[i];
      tie.points.add(part_of[group], particle - soft.groups[group].tetrahedra.first_particle, weight);
      gap += weight * (t.objects[end->object].origin + vector_cast<double>(t.particles.position[particle].x));
      tie.before += weight * vector_cast<double>(t.particles.velocity[particle].v);
    }
    side = -1;
  }
  const state::HookPlace& other = hook.a.is_point() ? hook.b : hook.a;
  if (!other.is_point()) {
    const JointBody body = joint_body_now(t.bodies, other.body);
    tie.other.lever = rotate(body.rotation, other.anchor);
    gap -= body.center + tie.other.lever;
    tie.before -= body.v + cross(body.scale * body.omega_scaled, tie.other.lever);
    if (other.body != state::HookPlace::kWorld && state::gives_way(t.bodies, other.body))
      tie.other.body = other.body;
  }
  tie.before += (1 / static_cast<double>(h)) * gap;
  return tie;
}

void list_ties(const state::Tables& t, Real h, const SoftGroups& soft, JoinedSolids& joined) {
  using System = JoinedSolids::System;
  const auto system_of = [&](std::uint32_t hook) -> System& {
    return joined.systems[joined.system_of[group_of(soft, t.hooks[hook])] - 1];
  };
  for (const std::uint32_t i : joined.hooks) ++system_of(i).end_tie;
  lay_out(joined.systems, &System::first_tie, &System::end_tie);
  joined.ties.resize(joined.hooks.size());
  for (const std::uint32_t i : joined.hooks) {
    StiffTie& tie = joined.ties[system_of(i).end_tie++];
    tie = tie_of(t, soft, joined.part_of, t.hooks[i], h);
    if (tie.other.body != StiffEnd::kNone)
      tie.other.share = share_of(joined, tie.other.body, group_of(soft, t.hooks[i]));
  }
}

}  // namespace

void mark_stiff_solids(const state::Tables& t, const SoftGroups& soft, SurfaceContacts& contacts) {
  contacts.stiff.assign(t.objects.size(), 0);
  contacts.any_stiff = false;
  for (const SoftGroup& group : soft.groups) {
    if (!group.tetrahedra.any_stiff) continue;
    contacts.any_stiff = true;
    // Small cloths share groups with solids.
    for (std::size_t i = group.first_object; i < group.end_object(); ++i)
      contacts.stiff[i] = t.objects[i].tetrahedra.count > 0 ? 1 : 0;
  }
}

void list_joined_solids(const state::Tables& t, const SurfaceContacts& contacts,
                        std::span<const state::ElementContact> faces, Real h, SoftGroups& soft,
                        JoinedSolids& joined) {
  joined.systems.clear();
  joined.parts.clear();
  joined.rows.clear();
  joined.system_of.assign(soft.groups.size(), 0);
  joined.ties.clear();
  if (!contacts.any_stiff) return;
  list_hooks(t, contacts, joined);
  number_systems(t, contacts, faces, soft, joined);
  list_parts(soft, joined);
  share_masses(t, faces, soft, joined);
  list_rows(t, contacts, faces, h, soft, joined);
  list_ties(t, h, soft, joined);
}

}  // namespace hooke::solver
