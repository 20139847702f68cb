#include "base/assert.h"
#include "base/take_turns.h"
#include "world/events.h"
#include "world/object_edits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>

namespace hooke::world {

namespace {

using state::Tables;

bool anything_asks(const Tables& t) {
  return !t.objects.empty() && (t.any_deformable_reports || t.any_reports);
}

/// What asks for contacts and hits of two objects.
struct Asked {
  bool contacts = false;
  Real hit_speed = kRigid;

  [[nodiscard]] bool any() const { return contacts || hit_speed < kRigid; }
};

Asked asked(const Tables& t, std::uint32_t object, std::uint32_t other) {
  const state::Deformable& first = t.objects[object];
  Asked asked = {first.reports_contacts, first.hit_speed};
  if ((other & kIsBody) != 0) {
    const state::BodyTraits& traits = t.bodies.traits[other & ~kIsBody];
    return {asked.contacts || traits.reports_contacts, std::min(asked.hit_speed, traits.hit_speed)};
  }
  const state::Deformable& second = t.objects[other];
  return {asked.contacts || second.reports_contacts, std::min(asked.hit_speed, second.hit_speed)};
}

/// A place where a deformable touches a body or a deformable. The places that touch are sum weight x of the
/// points; of those of the other side weights are negative.
struct TouchRow {
  std::uint32_t object = 0, other = 0;  ///< As in DeformableTouch.
  std::uint32_t count = 0;
  std::array<std::uint32_t, 4> particle = {};
  std::array<Real, 4> weight = {};
  Vec3 normal = {};            ///< Unit vector from the other to the deformable.
  Vec3 surface_velocity = {};  ///< Of the body [m/s].
  Real separation = Real(0);   ///< [m]
  Vec3 impulse = {};           ///< On the deformable, in this particle substep [N s].
  Real along = Real(0);        ///< The part of it along the normal [N s].
};

/// Turns a row of two deformables so that the one with the lower row comes first.
TouchRow in_order(TouchRow row) {
  if (row.object <= row.other) return row;
  std::swap(row.object, row.other);
  for (Real& weight : row.weight) weight = -weight;
  row.normal = -row.normal;
  row.impulse = -row.impulse;
  return row;
}

std::uint32_t object_at(const Tables& t, std::uint32_t particle) {
  const auto after =
      std::upper_bound(t.objects.begin(), t.objects.end(), particle,
                       [](std::uint32_t p, const state::Deformable& o) { return p < o.particles.first; });
  return static_cast<std::uint32_t>(after - t.objects.begin()) - 1;
}

/// Sums what contacts of one particle substep gave.
class TouchSums {
 public:
  TouchSums(WorldData& world, Real h) : w_(world), t_(world.tables), h_(h) {}

  /// Calls `visit(row)` with contacts of points and bodies that someone asks for.
  template <class Visit>
  void for_points(Visit visit) const {
    const state::Contacts& c = t_.contacts;
    for (std::size_t i = 0; i < c.particle.size(); ++i) {
      if (!asks(c.object[i], c.body[i] | kIsBody)) continue;
      visit(TouchRow{.object = c.object[i],
                     .other = c.body[i] | kIsBody,
                     .count = 1,
                     .particle = {c.particle[i]},
                     .weight = {Real(1)},
                     .normal = c.normal[i],
                     .surface_velocity = c.surface_velocity[i],
                     .separation = c.separation[i],
                     .impulse = h_ * (c.normal_force[i] * c.normal[i] + c.friction_force[i]),
                     .along = h_ * c.normal_force[i]});
    }
  }

  /// The same with edges and faces, of which `contacts` are those of bodies.
  template <class Visit>
  void for_elements(std::span<const state::ElementContact> contacts, Visit visit) const {
    for (const state::ElementContact& c : contacts) {
      if (!asks(c.object, c.body | kIsBody)) continue;
      TouchRow row = {.object = c.object, .other = c.body | kIsBody, .count = c.count};
      for (std::uint32_t k = 0; k < c.count; ++k) {
        row.particle[k] = c.particle[k];
        row.weight[k] = c.weight[k];
      }
      row.normal = c.normal;
      row.surface_velocity = c.surface_velocity;
      row.separation = c.separation;
      row.impulse = h_ * (c.normal_force * c.normal + c.friction_force);
      row.along = h_ * c.normal_force;
      visit(row);
    }
  }

  /// The same with segments of ropes that touch ropes.
  template <class Visit>
  void for_ropes(Visit visit) const {
    for (const state::RopeContact& c : t_.rope_contacts) {
      if (c.adjacent || c.normal == Vec3{} || !asks(c.object_a, c.object_b)) continue;
      visit(in_order({.object = c.object_a,
                      .other = c.object_b,
                      .count = 4,
                      .particle = c.particle,
                      .weight = c.weight,
                      .normal = c.normal,
                      .surface_velocity = {},
                      .separation = c.separation,
                      .impulse = h_ * (c.normal_force * c.normal + c.friction_force),
                      .along = h_ * c.normal_force}));
    }
  }

  /// The same with rows between surfaces: those of now, or those that were solved before others were found in
  /// this substep. `visit(row, vertices, group)` also gets their vertices.
  template <class Visit>
  void for_surfaces(std::vector<solver::SurfaceRowBlock> solver::SurfaceGroup::*rows, Visit visit) const {
    const solver::SurfaceContacts& c = w_.frame.surfaces;
    if (!c.active) return;
    for (std::size_t i = 0; i < c.live_groups; ++i) {
      if (!c.groups[i].known || !any_asks(c.groups[i])) continue;
      for (const solver::SurfaceRowBlock& block : c.groups[i].*rows) {
        for (int lane = 0; lane < block.count; ++lane) visit_lane(c.groups[i], block, lane, visit);
      }
    }
  }

  /// The same with contacts of stiff solids, without friction.
  template <class Visit>
  void for_stiff_rows(Visit visit) const {
    const solver::JoinedSolids& joined = w_.frame.joined_solids;
    for (const solver::JoinedSolids::System& system : joined.systems) {
      for (std::size_t i = system.first_row; i < system.end_row; ++i) {
        const solver::StiffRow& found = joined.rows[i];
        TouchRow row = {.count = static_cast<std::uint32_t>(found.corners.count)};
        for (std::uint32_t k = 0; k < row.count; ++k) {
          row.particle[k] = joined.parts[system.first_part + found.corners.part[k]]->first_particle +
                            found.corners.point[k];
          row.weight[k] = static_cast<Real>(found.corners.weight[k]);
          (row.weight[k] > Real(0) ? row.object : row.other) = object_at(t_, row.particle[k]);
        }
        if (!asks(row.object, row.other)) continue;
        row.normal = vector_cast<Real>(found.normal);
        row.along = found.pushes ? static_cast<Real>(found.carried) : Real(0);
        row.impulse = row.along * row.normal;
        visit(in_order(row));
      }
    }
  }

  /// Notes that a place will meet, at the velocities `v(k)` of its points.
  template <class Velocity>
  void approach(const TouchRow& row, Velocity v) {
    Vec3 relative = -row.surface_velocity;
    for (std::uint32_t k = 0; k < row.count; ++k) relative += row.weight[k] * v(k);
    const Real closing = -dot(row.normal, relative);
    if (!(closing > Real(0)) || row.separation > h_ * closing) return;
    DeformableTouch& touch = at(row.object, row.other);
    if (touch.meets && !(closing > touch.closing)) return;
    touch.meets = true;
    touch.closing = closing;
    touch.closing_at = place_of(row);
    touch.closing_normal = -row.normal;
  }

  void add(const TouchRow& row) {
    if (!(row.along > Real(0))) return;
    DeformableTouch& touch = at(row.object, row.other);
    const auto along = static_cast<double>(row.along);
    ++touch.points;
    if (row.object != row.other) touch.impulse += vector_cast<double>(row.impulse);
    touch.normal_impulse += along;
    touch.substep_impulse += along;
    touch.weighted_place += along * (place_of(row) - t_.objects[row.object].origin);
    for (std::uint32_t k = 0; k < row.count; ++k)
      w_.frame.contact_impulses[row.particle[k]] += row.weight[k] * row.impulse;
  }

  /// The velocity of a point of a row now.
  [[nodiscard]] Vec3 velocity(const TouchRow& row, std::uint32_t k) const {
    return t_.particles.velocity[row.particle[k]].v;
  }

 private:
  [[nodiscard]] bool asks(std::uint32_t object, std::uint32_t other) const {
    return asked(t_, object, other).any();
  }

  [[nodiscard]] bool any_asks(const solver::SurfaceGroup& group) const {
    return std::any_of(group.meshes.begin(), group.meshes.end(), [&](std::uint32_t mesh) {
      const std::uint32_t object = w_.frame.surfaces.surfaces.meshes[mesh].object;
      return asks(object, object);
    });
  }

  template <class Visit>
  void visit_lane(const solver::SurfaceGroup& group, const solver::SurfaceRowBlock& block, int lane,
                  Visit& visit) const {
    const solver::SurfaceContacts& c = w_.frame.surfaces;
    std::array<std::uint32_t, 4> vertex = {};
    TouchRow row = {.count = 4};
    for (std::size_t k = 0; k < 4; ++k) {
      vertex[k] = block.record[k][lane] / 4;
      row.weight[k] = block.weight[k][lane];
      row.particle[k] = c.surfaces.particle[vertex[k]];
    }
    // A vertex or an edge is the first side: its first point is never of the second one.
    row.object = c.surfaces.object_of(vertex[0]);
    row.other = c.surfaces.object_of(vertex[3]);
    if (!asks(row.object, row.other)) return;
    row.normal = {block.normal[0][lane], block.normal[1][lane], block.normal[2][lane]};
    row.separation = -block.distance[lane];
    for (std::size_t k = 0; k < 4; ++k) {
      row.separation +=
          row.weight[k] * dot(row.normal, c.start[vertex[k]].x + c.shift[c.surfaces.mesh_of[vertex[k]]]);
    }
    row.along = block.pushed[lane];
    row.impulse =
        row.along * row.normal + Vec3{block.rubbed[0][lane], block.rubbed[1][lane], block.rubbed[2][lane]};
    visit(in_order(row), vertex, group);
  }

  /// Where the side of the deformable touches, in the world [m].
  [[nodiscard]] DVec3 place_of(const TouchRow& row) const {
    DVec3 place;
    for (std::uint32_t k = 0; k < row.count; ++k) {
      if (!(row.weight[k] > Real(0))) continue;
      place +=
          static_cast<double>(row.weight[k]) * vector_cast<double>(t_.particles.position[row.particle[k]].x);
    }
    return t_.objects[row.object].origin + place;
  }

  DeformableTouch& at(std::uint32_t object, std::uint32_t other) {
    std::vector<DeformableTouch>& all = w_.frame.deformable_touches;
    const auto is = [&](const DeformableTouch& touch) {
      return touch.object == object && touch.other == other;
    };
    if (last_ < all.size() && is(all[last_])) return all[last_];
    last_ = static_cast<std::size_t>(std::find_if(all.begin(), all.end(), is) - all.begin());
    if (last_ == all.size()) all.push_back({.object = object, .other = other});
    return all[last_];
  }

  WorldData& w_;
  const Tables& t_;
  Real h_;
  std::size_t last_ = 0;
};

auto order_of(PointRef p) {
  return std::tuple(p.kind, p.slot, p.generation);
}
auto order_of(const DeformableContactEvent& e) {
  return std::tuple_cat(order_of(e.a), std::tuple(static_cast<bool>(e.body)), order_of(e.b),
                        std::tuple(e.body.slot, e.body.generation));
}

DeformableContactEvent parts_of(const Tables& t, const DeformableTouch& touch) {
  DeformableContactEvent parts = {.a = point_of(t, t.objects[touch.object], 0)};
  if ((touch.other & kIsBody) != 0) {
    parts.body = id_of(t, touch.other & ~kIsBody);
  } else {
    parts.b = point_of(t, t.objects[touch.other], 0);
  }
  return parts;
}

/// A touch with its parts, in the order of events.
struct Listed {
  DeformableContactEvent parts;
  DeformableTouch touch;
};

/// Turns a touch so that the object that comes first in events is `a`.
Listed listed(const Tables& t, DeformableTouch touch) {
  DeformableContactEvent parts = parts_of(t, touch);
  if (parts.body || order_of(parts.a) <= order_of(parts.b)) return {parts, touch};
  std::swap(parts.a, parts.b);
  touch.normal = -touch.normal;
  touch.impulse = -touch.impulse;
  return {parts, touch};
}

void list_touch(const Tables& t, const Listed& one, double dt, LastStep& to) {
  const auto& [parts, touch] = one;
  const DVec3 origin = t.objects[touch.object].origin;
  to.deformable_contacts.push_back({.a = parts.a,
                                    .b = parts.b,
                                    .body = parts.body,
                                    .points = touch.points,
                                    .point = origin + (1 / touch.normal_impulse) * touch.weighted_place,
                                    .force = vector_cast<Real>((1 / dt) * touch.impulse),
                                    .normal_force = static_cast<Real>(touch.normal_impulse / dt)});
  if (!(touch.speed > asked(t, touch.object, touch.other).hit_speed)) return;
  to.events.deformable_hits.push_back({.a = parts.a,
                                       .b = parts.b,
                                       .body = parts.body,
                                       .point = touch.met_at,
                                       .normal = touch.normal,
                                       .speed = touch.speed,
                                       .impulse = static_cast<Real>(touch.largest_impulse)});
}

}  // namespace

void begin_deformable_touches(WorldData& world, double dt) {
  world.frame.deformable_touches.clear();
  world.frame.step_length = dt;
  const bool asks = anything_asks(world.tables);
  world.frame.surfaces.keeps_spent_rows = asks;
  if (asks) world.frame.contact_impulses.assign(world.tables.particles.position.size(), {});
}

void note_closing_deformables(WorldData& world, Real h) {
  if (!anything_asks(world.tables)) return;
  for (DeformableTouch& touch : world.frame.deformable_touches) {
    touch.points = 0;
    touch.substep_impulse = 0;
    touch.meets = false;
  }
  TouchSums sums(world, h);
  const auto look = [&](const TouchRow& row, const auto&...) {
    sums.approach(row, [&](std::uint32_t k) { return sums.velocity(row, k); });
  };
  sums.for_points(look);
  sums.for_elements(world.tables.element_contacts, look);
  sums.for_ropes(look);
  sums.for_surfaces(&solver::SurfaceGroup::rows, look);
}

void add_pass_impulses(WorldData& world, Real h, std::span<const state::ElementContact> passes) {
  if (!anything_asks(world.tables)) return;
  TouchSums sums(world, h);
  sums.for_elements(passes, [&](const TouchRow& row) { sums.add(row); });
}

void add_touch_impulses(WorldData& world, Real h) {
  if (!anything_asks(world.tables)) return;
  const solver::SurfaceContacts& surfaces = world.frame.surfaces;
  TouchSums sums(world, h);
  const auto add = [&](const TouchRow& row, const auto&...) { sums.add(row); };
  sums.for_points(add);
  sums.for_elements(world.tables.element_contacts, add);
  sums.for_ropes(add);
  sums.for_stiff_rows(add);
  sums.for_surfaces(&solver::SurfaceGroup::spent_rows, add);
  sums.for_surfaces(&solver::SurfaceGroup::rows, [&](const TouchRow& row, const auto& vertex,
                                                     const solver::SurfaceGroup& group) {
    // What was found in this substep has not been looked at before. Cages tell the velocities of then, less
    // the mean of the group, which is of no account for the difference of two sides.
    const Real time = h * static_cast<Real>(group.substeps_left + 1);
    if (surfaces.refreshed[row.object] != 0)
      sums.approach(row, [&](std::uint32_t k) { return (1 / time) * surfaces.cage[vertex[k]].drift; });
    sums.add(row);
  });
  for (DeformableTouch& touch : world.frame.deformable_touches) {
    touch.largest_impulse = std::max(touch.largest_impulse, touch.substep_impulse);
    if (!(touch.substep_impulse > 0) || !touch.meets || !(touch.closing > touch.speed)) continue;
    touch.speed = touch.closing;
    touch.met_at = touch.closing_at;
    touch.normal = touch.closing_normal;
  }
}

void gather_deformable_events(WorldData& world) {
  Tables& t = world.tables;
  LastStep& last = world.last_step;
  clear_deformable_contacts(last);
  last.events.deformable_begins.clear();
  last.events.deformable_ends.clear();
  last.events.deformable_hits.clear();
  if (!anything_asks(t) && t.deformable_touches.empty()) return;
  std::vector<Listed> all;
  for (const DeformableTouch& touch : world.frame.deformable_touches) {
    if (touch.normal_impulse > 0) all.push_back(listed(t, touch));
  }
  std::sort(all.begin(), all.end(),
            [](const Listed& a, const Listed& b) { return order_of(a.parts) < order_of(b.parts); });
  std::vector<DeformableContactEvent>& now = world.frame.deformable_touches_now;
  now.clear();
  for (const Listed& one : all) {
    list_touch(t, one, world.frame.step_length, last);
    if (asked(t, one.touch.object, one.touch.other).contacts) now.push_back(one.parts);
  }
  const auto comes_first = [](const auto& a, const auto& b) { return order_of(a) < order_of(b); };
  const auto& before = t.deformable_touches;
  std::set_difference(now.begin(), now.end(), before.begin(), before.end(),
                      std::back_inserter(last.events.deformable_begins), comes_first);
  std::set_difference(before.begin(), before.end(), now.begin(), now.end(),
                      std::back_inserter(last.events.deformable_ends), comes_first);
  base::take_turns(now, t.deformable_touches);
  if (all.empty()) return;
  const Real per_step = static_cast<Real>(1 / world.frame.step_length);
  for (const Vec3& impulse : world.frame.contact_impulses) last.contact_forces.push_back(per_step * impulse);
  last.contact_forces_revision = t.revision;
}

void clear_deformable_contacts(LastStep& last_step) {
  last_step.deformable_contacts.clear();
  last_step.contact_forces.clear();
}

}  // namespace hooke::world
