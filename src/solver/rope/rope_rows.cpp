#include "solver/rope/rope_rows.h"

#include "base/assert.h"
#include "solver/rope/rope_segments.h"
#include "solver/rope/rope_tuning.h"
#include "solver/rope/segment_breaks.h"
#include "solver/soft/particle_contact_solve.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hooke::solver {

namespace {

using V = DVec3;
using M = math::Symmetric3<double>;

constexpr double kLargestFinite = 1e300;  ///< A larger stiffness is infinite [N/m].
constexpr double kNoBend = 1e30;          ///< Compliance of a bend that bends nothing [1/(kg m^2)].

V across(V n, V v) {
  return v - dot(n, v) * n;
}

using Lane = wide::HWY_NAMESPACE::Triple<double>;

Lane lane_of(V v) {
  return {v.x, v.y, v.z};
}
V vector_of(const Lane& lane) {
  return {lane.x, lane.y, lane.z};
}

wide::HWY_NAMESPACE::SegmentState<double> state_of(const RopeSegment& e, const RopeNode& a,
                                                   const RopeNode& b) {
  return {lane_of(b.x - a.x), lane_of(b.u - a.u), lane_of(b.v_before - a.v_before), e.limited ? 1.0 : 0.0,
          e.tension_bound};
}

/// Speed at which a contact opens [m/s], its gap counted as the speed that would close it in one substep.
double opening_speed_of(const RopeContactRow& t, V u, double h) {
  return dot(t.n, u - t.surface) + std::max(t.separation / h, -kParticlePushOutSpeed);
}

/// Whether friction that slides drives its node: it does where N was not right yet, or the sliding has
/// turned.
bool drives_by_friction(const RopeContactRow& t, V sliding) {
  return t.slides && !t.dragged && is_work(dot(t.f, sliding), t.rho_across / kRopeContactStiffness);
}

/// Friction that a contact starts from: that of the last substep, as far as N allows it now.
V carried_friction(const RopeContactRow& t) {
  const double most = t.friction * t.normal;
  const double size = length(t.f0);
  return size > most ? (most / size) * t.f0 : t.f0;
}

void slide(V trial, double size, RopeContactRow& t) {
  t.slides = true;
  t.trial = size;
  t.against = (1.0 / size) * trial;
}

/// Change of a sliding node's friction for each unit by which the trial force changes across its direction.
double turned_share(const RopeContactRow& t) {
  return t.trial > 0 ? t.friction * t.normal / t.trial : 0;
}

/// Updates the friction of an active contact. It holds with f0 - rho u_t up to mu N; beyond that it is mu N
/// in the same direction, the nearest force that Coulomb's cone allows. A `dragged` contact has mu N over
/// its speed instead, which never drives, but takes many solutions to come to the force.
void update_friction(RopeContactRow& t, V sliding) {
  const double most = t.friction * t.normal;
  if (t.dragged) {
    const double speed = length(sliding);
    t.f = -t.drag * sliding;
    t.drag = most < t.rho_across * speed ? most / speed : t.rho_across;
    return;
  }
  t.f = carried_friction(t) - t.rho_across * sliding;
  const double size = length(t.f);
  t.slides = size > most;
  if (!t.slides) return;
  slide(t.f, size, t);
  t.f = most * t.against;
}

/// Friction of a point that slides at some speed: it sticks with rho, or is dragged with mu N over its speed.
double drag_of(const RopeContactRow& t, double speed) {
  if (!(t.normal > 0)) return 0;
  return speed * t.rho_across > t.friction * t.normal ? t.friction * t.normal / speed : t.rho_across;
}
double sliding_speed(const RopeContactRow& t, V u) {
  return length(across(t.n, u - t.surface));
}

/// Returns whether the contact switched on or off, or its friction is not yet what its force allows.
bool update_point_contact_row(double h, bool let_go, V u, RopeContactRow& t) {
  const bool was_active = t.active;
  const double drag = t.drag;
  const double opening_speed = opening_speed_of(t, u, h);
  t.normal = t.active ? std::max(0.0, -t.rho * opening_speed) : 0;
  t.active = t.active ? t.normal > 0 : opening_speed < 0 && !let_go;
  t.drag = drag_of(t, sliding_speed(t, u));
  t.f = -drag * across(t.n, u - t.surface);
  return was_active != t.active || (!let_go && std::abs(t.drag - drag) > kRopeConvergedDrag * drag);
}

wide::HWY_NAMESPACE::RopeTerms<double> terms_of(const RopeSetting& setting, double h) {
  return {h,
          1 / h,
          setting.compliance,
          1 / setting.compliance,
          setting.first ? 1.0 : 0.0,
          lane_of(setting.turning),
          true};
}

/// Turns a force from across the last normal to across the present one. It keeps its size while its node
/// goes round what it touches; at a new place only the part that is across there too remains.
V friction_across(V n, V force) {
  const V now = across(n, force);
  const double size = length(now);
  const double before = length(force);
  return size > kSameFrictionPlace * before ? (before / size) * now : now;
}

/// Stiffness along the normal that a node needs to hold a body which gives way; 0 for one that does not.
double stiffness_against(const state::Tables& tables, std::uint32_t body, std::uint32_t particle) {
  const auto w = static_cast<double>(tables.bodies.motion[body].inverse_mass);
  const auto own = static_cast<double>(tables.particles.mass[particle]);
  return w > 0 ? std::min(kPointStiffnessOnBody / w, kMostPointStiffness * own) : 0;
}

RopeContactRow load_contact_row(std::size_t row, std::uint32_t node, double h, const state::Tables& tables) {
  const state::Contacts& contacts = tables.contacts;
  RopeContactRow t;
  t.row = static_cast<std::uint32_t>(row);
  t.node = node;
  t.rho_across = kRopeContactStiffness * static_cast<double>(tables.particles.mass[contacts.particle[row]]);
  t.rho = std::max(t.rho_across, stiffness_against(tables, contacts.body[row], contacts.particle[row]));
  t.n = vector_cast<double>(contacts.normal[row]);
  t.surface = vector_cast<double>(contacts.surface_velocity[row]);
  t.lever = vector_cast<double>(contacts.lever[row]);
  t.belt = vector_cast<double>(contacts.belt_velocity[row]);
  t.separation = static_cast<double>(contacts.separation[row]);
  t.friction = static_cast<double>(contacts.friction[row]);
  t.n0 = h * static_cast<double>(contacts.normal_force[row]);
  t.f0 = friction_across(t.n, h * vector_cast<double>(contacts.friction_force[row]));
  t.active = t.n0 > 0 || t.separation <= 0;
  const double size = length(t.f0);
  t.normal = t.n0;
  if (size > 0 && size >= kRopeSlidingShare * t.friction * t.n0) slide(t.f0, size, t);
  // A whole rope would stop if it were held in the first solution.
  if (!(t.friction > 0)) t.slides = true;
  return t;
}

/// Loads a tether: a spring row from a free particle to a pin.
RopeContactRow load_tether(std::uint32_t row, std::uint32_t node, double h, const state::Tables& tables) {
  const state::Springs& springs = tables.springs;
  const std::uint32_t particle = springs.particle_a[row];
  const std::uint32_t pin = springs.particle_b[row];
  const V displacement =
      vector_cast<double>(tables.particles.position[pin].x - tables.particles.position[particle].x);
  const double distance = length(displacement);
  RopeContactRow t;
  t.row = RopeContactRow::kTether;
  t.node = node;
  t.n = distance > 0 ? (1.0 / distance) * displacement : V{0, 1, 0};
  t.surface = vector_cast<double>(tables.particles.velocity[pin].v);
  const double slack = static_cast<double>(springs.rest_length[row]) - distance;
  t.active = slack <= 0;
  // A heavy body that is drawn back at once would gain energy by it.
  t.separation = slack > 0 ? slack : h * std::max(slack * kTetherRecovery, -kTetherSpeed);
  return t;
}

}  // namespace

void load_rope(const RopeSystem& rope_system, const std::vector<state::VelocityRecord>& before, double h,
               const state::Tables& tables, RopeScratch& s) {
  const auto first = static_cast<std::uint32_t>(s.nodes.size());
  for (std::uint32_t i = 0; i < rope_system.node_count; ++i) {
    const std::uint32_t row = rope_system.first_particle + i;
    s.nodes.push_back(load_node(row, before[row].v, tables.particles));
  }
  for (std::uint32_t i = 0; i + 1 < rope_system.node_count; ++i) {
    const std::size_t row = rope_system.first_segment + i;
    const RopeNode& a = s.nodes[first + i];
    const RopeNode& b = s.nodes[first + i + 1];
    RopeSegment e;
    e.a = first + i;
    e.traits = segment_traits(row, lighter_end(a.mass, a.w, b.mass, b.w), h, tables.segments);
    e.tension_bound = first_tension_bound(row, tables.segments);
    e.limited = tables.segments.limited[row] != 0;
    s.segments.push_back(e);
  }
  HOOKE_ASSERT(rope_system.end_contact <= tables.contacts.particle.size());
  load_contact_rows(rope_system, first, h, tables, s.contact_rows);
}

wide::SegmentTraits<double> segment_traits(std::size_t row, double lighter, double h,
                                           const state::Segments& segments) {
  const auto rest = static_cast<double>(segments.rest_length[row]);
  const auto limit = static_cast<double>(segments.length_limit[row]);
  const auto k = static_cast<double>(segments.stiffness[row]);
  const auto c = static_cast<double>(segments.damping[row]);
  const double s = c + h * k;
  const bool rigid = k > kLargestFinite;
  const wide::SegmentTraits<double> traits = {.rest = rest,
                                              .per_rest = 1 / rest,
                                              .limit = limit,
                                              .damping = c,
                                              .per_stiffness = 1 / k,
                                              .bias = rigid ? 1 / h : k / s,
                                              .resistance = h * s,
                                              .lighter = lighter,
                                              .per_lighter = 1 / lighter};
  return segments.joins(row) ? traits : dashpot_traits(0, traits);
}

void load_contact_rows(const RopeSystem& rope_system, std::uint32_t first_node, double h,
                       const state::Tables& tables, std::vector<RopeContactRow>& contact_rows) {
  for (std::uint32_t row = rope_system.first_contact; row < rope_system.end_contact; ++row) {
    const std::uint32_t particle = tables.contacts.particle[row];
    if (!(tables.particles.velocity[particle].inverse_mass > Real(0))) continue;
    const std::uint32_t node = first_node + particle - rope_system.first_particle;
    HOOKE_ASSERT(particle >= rope_system.first_particle && node - first_node < rope_system.node_count);
    contact_rows.push_back(load_contact_row(row, node, h, tables));
  }
}

void load_loads(const RopeSystem& rope_system, std::uint32_t first_node, double h,
                const SurfaceContacts& surfaces, const state::Tables& tables,
                std::vector<RopeContactRow>& contact_rows) {
  const std::size_t own = contact_rows.size();
  auto at = std::lower_bound(surfaces.load_order.begin(), surfaces.load_order.end(),
                             std::array<std::uint32_t, 2>{rope_system.first_particle, 0});
  for (; at != surfaces.load_order.end() && (*at)[0] < rope_system.first_particle + rope_system.node_count;
       ++at) {
    const auto [particle, number] = *at;
    const RopeLoad& load = surfaces.loads[number];
    const state::VelocityRecord& velocity = tables.particles.velocity[particle];
    if (!(velocity.inverse_mass > Real(0))) continue;
    const double most = kRopeContactStiffness * static_cast<double>(tables.particles.mass[particle]);
    const auto w = static_cast<double>(load.inverse_mass);
    RopeContactRow t;
    t.row = RopeContactRow::kTether;
    t.load = number;
    t.node = first_node + particle - rope_system.first_particle;
    t.rho = w * most > static_cast<double>(load.share) ? static_cast<double>(load.share) / w : most;
    t.n = vector_cast<double>(load.normal);
    t.surface = vector_cast<double>(load.surface);
    t.separation = static_cast<double>(load.separation);
    t.of_point = true;
    t.active = opening_speed_of(t, vector_cast<double>(velocity.v), h) < 0;
    contact_rows.push_back(t);
  }
  if (contact_rows.size() == own) return;
  const auto first =
      std::partition_point(contact_rows.begin(), contact_rows.begin() + static_cast<std::ptrdiff_t>(own),
                           [&](const RopeContactRow& t) { return t.node < first_node; });
  std::stable_sort(first, contact_rows.end(),
                   [](const RopeContactRow& a, const RopeContactRow& b) { return a.node < b.node; });
}

bool update_load(double h, V u, RopeContactRow& t) {
  return update_point_contact_row(h, false, u, t);
}

void store_loads(std::span<const RopeContactRow> contact_rows, SurfaceContacts& surfaces) {
  for (const RopeContactRow& t : contact_rows) {
    if (!t.is_load()) continue;
    surfaces.loads[t.load].impulse = static_cast<Real>(t.normal);
    surfaces.loads[t.load].solved = true;
  }
}

/// Speed that friction takes from a point of a solid: N is known there already
/// (solver/soft/pressed_points.h).
double stopped_by_friction(const RopeContactRow& t, double w, const state::Tables& tables) {
  if (t.row == RopeContactRow::kTether) return 0;
  const state::Deformable& object = tables.objects[tables.contacts.object[t.row]];
  return object.tetrahedra.count > 0 ? t.friction * t.normal * w : 0;
}

void load_point_contact_rows(const PointInContact& point, double h, const state::Tables& tables,
                             std::vector<RopeContactRow>& contact_rows) {
  const double own = point.node.mass;
  HOOKE_ASSERT(own > 0 && point.first <= point.end && point.end <= tables.contacts.particle.size());
  double heaviest = std::max(point.heaviest, own);
  for (std::size_t row = point.first; row < point.end; ++row) {
    const auto w = static_cast<double>(tables.bodies.motion[tables.contacts.body[row]].inverse_mass);
    if (w > 0) heaviest = std::max(heaviest, 1 / w);
  }
  const std::size_t first_contact_row = contact_rows.size();
  for (std::size_t row = point.first; row < point.end; ++row) {
    RopeContactRow t = load_contact_row(row, point.index, h, tables);
    t.separation = std::max(t.separation, 0.0);
    t.n0 = 0;
    t.f0 = {};
    t.slides = false;
    contact_rows.push_back(t);
  }
  for (const std::uint32_t row : point.tethers) {
    const bool still_pinned =
        tables.particles.velocity[tables.springs.particle_b[row]].inverse_mass == Real(0);
    if (still_pinned) contact_rows.push_back(load_tether(row, point.index, h, tables));
  }
  for (RopeContactRow& t : std::span(contact_rows).subspan(first_contact_row)) {
    t.of_point = true;
    t.rho = t.rho_across = std::min(kPointStiffnessOnBody * heaviest, kMostPointStiffness * own);
    t.drag = drag_of(t, sliding_speed(t, point.node.v_free) - stopped_by_friction(t, point.node.w, tables));
  }
}

RopeBend load_bend(const RopeSystem& rope_system, std::size_t row, const state::Segments& segments) {
  HOOKE_ASSERT(row + 1 < segments.rest_length.size());
  const auto before = static_cast<double>(segments.rest_length[row]);
  const auto behind = static_cast<double>(segments.rest_length[row + 1]);
  const double length =
      0.5 * ((segments.clamped[row] != 0 ? 0 : before) + (segments.clamped[row + 1] != 0 ? 0 : behind));
  RopeBend bend;
  bend.before = 1 / before;
  bend.behind = 1 / behind;
  bend.stiffness = rope_system.bend_stiffness / (length > 0 ? length : 0.5 * (before + behind));
  if (!segments.joins(row) || !segments.joins(row + 1)) bend.stiffness = 0;
  bend.damping = rope_system.bend_damping * bend.stiffness;
  return bend;
}

void load_bends(const RopeSystem& rope_system, std::size_t first_node, const state::Segments& segments,
                RopeScratch& s) {
  if (!(rope_system.bend_stiffness > 0)) return;
  for (std::size_t i = 1; i + 1 < rope_system.node_count; ++i) {
    RopeBend bend = load_bend(rope_system, rope_system.first_segment + i - 1, segments);
    bend.node = static_cast<std::uint32_t>(first_node + i);
    s.bends.push_back(bend);
  }
}

void linearize(const RopeSetting& setting, double h, const std::vector<RopeNode>& nodes, RopeBend& bend) {
  const bool whips = !setting.first;
  const double resistance = bend.resistance(h, whips);
  const double back = whips ? 0 : kBendNewmark * h;
  HOOKE_ASSERT(bend.node > 0 && std::size_t{bend.node} + 1 < nodes.size());
  const RopeNode* node = &nodes[bend.node];
  const auto line = [&](int i) {
    return node[i + 1].x - node[i].x - back * (node[i + 1].v_before - node[i].v_before);
  };
  if (!(resistance > 0)) {  // beside a segment that breaks
    bend.gamma = kNoBend;
    bend.target = {};
    return;
  }
  bend.gamma = 1 / (h * resistance);
  bend.target = (-bend.stiffness / resistance) * (bend.behind * line(0) - bend.before * line(-1));
}

RopeSetting first_setting(std::span<const RopeContactRow> contact_rows, double rest, V line, V speed) {
  if (std::any_of(contact_rows.begin(), contact_rows.end(), [](const RopeContactRow& t) { return t.active; }))
    return {.compliance = kComplianceInContact};
  RopeSetting setting = {.compliance = kComplianceInAir};
  // The line between the ends means nothing if the rope is folded to less than a quarter of its length.
  const double square = length_squared(line);
  if (square >= rest * rest / 16) setting.turning = (1.0 / square) * cross(line, speed);
  return setting;
}

RopeSetting first_setting(std::size_t first_node, std::size_t first_segment, std::size_t first_contact_row,
                          const RopeScratch& s) {
  double rest = 0;
  for (std::size_t i = first_segment; i < s.segments.size(); ++i) rest += s.segments[i].traits.rest;
  const RopeNode& first = s.nodes[first_node];
  const RopeNode& last = s.nodes.back();
  return first_setting(std::span(s.contact_rows).subspan(first_contact_row), rest, last.x - first.x,
                       last.v_before - first.v_before);
}

void linearize(const RopeSetting& setting, double h, const std::vector<RopeNode>& nodes, RopeSegment& e) {
  const auto row = wide::HWY_NAMESPACE::linearized<double>(state_of(e, nodes[e.a], nodes[e.a + 1]), e.traits,
                                                           terms_of(setting, h), setting.first);
  e.n = vector_of(row.n);
  e.offset = vector_of(row.offset);
  e.along = row.along;
  e.across = row.across;
  e.compliance = math::axial(e.n, 1.0 / e.along, 1.0 / e.across);
}

/// A contact that slides is free in its direction. Beside it a change of velocity turns the force: by mu N
/// over the trial force.
M contact_stiffness(const RopeContactRow& t) {
  if (!t.slides || t.of_point || t.dragged)
    return math::axial(t.n, t.rho, t.of_point || t.dragged ? t.drag : t.rho_across);
  return math::axial(t.n, t.rho, 0.0) +
         math::axial(cross(t.n, t.against), t.rho_across * turned_share(t), 0.0);
}

V push_of(const RopeContactRow& t, double h) {
  const V normal = (t.n0 - t.rho * std::max(t.separation / h, -kParticlePushOutSpeed)) * t.n;
  if (t.dragged) return normal;
  const V held = carried_friction(t);
  if (!t.slides) return normal + held;
  const V beside = cross(t.n, t.against);
  return normal + (t.friction * t.normal) * t.against + (turned_share(t) * dot(beside, held)) * beside;
}

NodeConstraint node_constraint(std::span<const RopeContactRow> at_node, const RopeNode& node, double h) {
  NodeConstraint constraint = {M::diagonal(node.mass), node.mass * node.v_free};
  for (const RopeContactRow& t : at_node) {
    if (!t.active) continue;
    const M resistance = contact_stiffness(t);
    constraint.mass = constraint.mass + resistance;
    constraint.impulse += push_of(t, h) + resistance * (t.body < 0 ? t.surface : t.belt);
  }
  return constraint;
}

void constrain_nodes(double h, RopeScratch& s) {
  for (RopeNode& node : s.nodes) {
    node.inverse = M::diagonal(node.w);
    node.target = node.v_free;
  }
  for_each_node_in_contact(s.contact_rows, [&](std::span<RopeContactRow> at_node) {
    RopeNode& node = s.nodes[at_node.front().node];
    const NodeConstraint constraint = node_constraint(at_node, node, h);
    node.inverse = math::inverse(constraint.mass);
    node.target = node.inverse * constraint.impulse;
  });
}

Unconverged update_contact_row(double h, bool let_go, const RopeNode& node, RopeContactRow& t) {
  const double opening_speed = opening_speed_of(t, node.u, h);
  const bool was_active = t.active;
  const bool slid = t.slides;
  Unconverged unconverged;
  if (t.active) {
    const double push = t.n0 - t.rho * opening_speed;
    const V sliding = across(t.n, node.u - t.surface);
    const bool pulls = push < 0 && is_work(-push * t.separation / h, t.rho_across / kRopeContactStiffness);
    const bool drags_on = drives_by_friction(t, sliding);
    t.normal = std::max(0.0, push);
    t.active = t.normal > 0;
    t.let_go = let_go && pulls;
    t.dragged = t.dragged || drags_on;
    if (t.active) update_friction(t, sliding);
    unconverged.pulls = pulls || drags_on;
  } else {
    t.normal = 0;
    t.active = opening_speed < 0 && !t.let_go;
    unconverged.impacts = t.active && opening_speed < -kRopeImpactSpeed;
  }
  if (!t.active) t.f = {};
  unconverged.ropes = was_active != t.active || slid != t.slides || t.slides || t.dragged;
  return unconverged;
}

Unconverged update_contact_rows(double h, bool let_go, RopeScratch& s) {
  Unconverged unconverged;
  for (RopeContactRow& t : s.contact_rows) {
    const RopeNode& node = s.nodes[t.node];
    if (t.is_load()) {
      unconverged.ropes = update_load(h, node.u, t) || unconverged.ropes;
    } else if (t.of_point) {
      unconverged.points = update_point_contact_row(h, let_go, node.u, t) || unconverged.points;
    } else {
      unconverged.add(update_contact_row(h, let_go, node, t));
    }
  }
  return unconverged;
}

double check_segments(const RopeSetting& setting, double h, const std::vector<RopeNode>& nodes,
                      std::span<RopeSegment> segments, bool& limits_changed) {
  const auto terms = terms_of(setting, h);
  double worst = 0;
  for (RopeSegment& e : segments) {
    const RopeNode& a = nodes[e.a];
    const RopeNode& b = nodes[e.a + 1];
    const auto check = wide::HWY_NAMESPACE::checked<double>(state_of(e, a, b), e.traits, dot(e.n, e.q),
                                                            dot(e.n, b.u - a.u), terms);
    e.tension_bound = check.tension_bound;
    if (!(a.w > 0) && !(b.w > 0)) continue;
    e.limited = check.limited > 0;
    limits_changed = limits_changed || check.limit_changed > 0;
    worst = std::max(worst, check.error);
  }
  return worst;
}

int least_solves(std::span<const RopeContactRow> contact_rows, const Unconverged& unconverged) {
  if (unconverged.pulls) return 2 * kMostRopeSolves;
  if (unconverged.impacts) return kMostRopeSolves;
  if (unconverged.ropes) return kLeastRopeSlidingSolves;
  const bool active =
      std::any_of(contact_rows.begin(), contact_rows.end(), [](const RopeContactRow& t) { return t.active; });
  return active ? kLeastRopeContactSolves : 1;
}

bool solve_again(int solves, double error, bool pulls, std::span<RopeContactRow> contact_rows) {
  if (solves != kMostRopeSolves) return solves < 2 * kMostRopeSolves;
  if (error <= kRopeReportedError || contact_rows.empty()) return pulls;
  for (RopeContactRow& t : contact_rows) {
    t.friction = t.drag = 0;
    t.f0 = t.f = {};
    t.slides = true;
  }
  return true;
}

bool is_finite(const RopeScratch& s) {
  return std::all_of(s.nodes.begin(), s.nodes.end(),
                     [](const RopeNode& node) { return hooke::is_finite(node.u); });
}

void store_tension(std::size_t row, double tension, bool limited, state::Segments& segments) {
  segments.tension[row] = static_cast<Real>(tension);
  segments.mean_tension[row] += segments.tension[row];
  segments.limited[row] = limited ? 1 : 0;
}

void store_rope(const RopeSystem& rope_system, std::size_t first_node, std::size_t first_segment, double h,
                const RopeScratch& s, state::Tables& tables) {
  for (std::uint32_t i = 0; i < rope_system.node_count; ++i) {
    const RopeNode& node = s.nodes[first_node + i];
    if (node.w > 0) tables.particles.velocity[rope_system.first_particle + i].v = vector_cast<Real>(node.u);
  }
  for (std::uint32_t i = 0; i + 1 < rope_system.node_count; ++i) {
    const RopeSegment& e = s.segments[first_segment + i];
    store_tension(rope_system.first_segment + i, dot(e.n, e.q) / h, e.limited, tables.segments);
  }
}

void store_contact_rows(double h, std::span<const RopeContactRow> contact_rows, state::Contacts& contacts) {
  for (const RopeContactRow& t : contact_rows) {
    if (t.row == RopeContactRow::kTether) continue;
    HOOKE_ASSERT(t.row < contacts.normal_force.size());
    contacts.normal_force[t.row] = static_cast<Real>(t.normal / h);
    contacts.friction_force[t.row] = vector_cast<Real>((1.0 / h) * t.f);
  }
}

}  // namespace hooke::solver
