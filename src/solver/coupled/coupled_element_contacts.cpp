/// Contacts between points, as rows of a bundle. Which rows there are: bundles_build.cpp.

#include "geometry/closest.h"
#include "solver/coupled/coupled_group_solution.h"
#include "solver/soft/element_contact_solve.h"
#include "solver/soft/particle_contact_solve.h"
#include "state/body_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hooke::solver {

namespace {

using state::InnerContact;

/// What would take this many times its weight to stop in a substep slides at first: held, it would press so
/// hard where it tips over that the friction there seems to hold it.
constexpr double kMostStopped = 2;

constexpr double kMostDrag = 1e4;  ///< Over the mass at the place: what is dragged harder sticks.
/// The same of ropes, where a light one carries many times its weight.
constexpr double kMostRopeDrag = 1e4;
/// Overlap of ropes leaves no faster than this [m/s]: where one end of a segment is wedged, the other moves
/// many times as fast as the place.
constexpr double kInnerPushOutSpeed = 0.05;

/// Of a body on others, over its lever there: overlap, or gap, that is none. Some roundings' worth.
constexpr double kBorneSlop = 100 * static_cast<double>(std::numeric_limits<Real>::epsilon());

constexpr int kRopeSlidingSolves = 7;
/// By how much a contact of ropes gives way to its force, at most [m/s].
constexpr double kRopeYieldSpeed = 0.02;

/// The normal and two directions across it.
std::array<DVec3, InnerTouch::kRows> axes_of(DVec3 n) {
  const DVec3 far = std::abs(n.x) < 0.6 ? DVec3{1, 0, 0} : DVec3{0, 1, 0};
  const DVec3 across = normalize(cross(n, far));
  return {n, across, cross(n, across)};
}

}  // namespace

bool BundleSolution::has_inner(std::size_t node) const {
  const auto at = incidents_of(node);
  return !at.empty() && at.back().block >= hook_block(static_cast<std::uint32_t>(b_.hooks.size()));
}

/// Mass of the heaviest body that a contact between points may press on a node; 0 without one [kg].
double BundleSolution::heaviest_inner(std::size_t node) const {
  double heaviest = 0;
  for (const Bundle::Incident& at : incidents_of(node)) {
    if (at.block < hook_block(static_cast<std::uint32_t>(b_.hooks.size()))) continue;
    const int body = b_.ends[at.block - vector_count()][0];
    const auto w =
        body < 0
            ? 0
            : static_cast<double>(t_.bodies.motion[b_.bodies[static_cast<std::size_t>(body)]].inverse_mass);
    if (w > 0) heaviest = std::max(heaviest, 1 / w);
  }
  return heaviest;
}

void BundleSolution::load_inner() {
  b_.touches.assign(b_.touch_count(), {});
  if (b_.touches.empty()) return;
  const std::uint32_t first = hook_block(static_cast<std::uint32_t>(b_.hooks.size()));
  // Nodes and points of an element stand in the same order.
  for (std::uint32_t node = 0; node < b_.ropes.nodes.size(); ++node) {
    for (std::uint32_t i = b_.first_incident[node]; i < b_.first_incident[node + 1]; ++i) {
      if (b_.incidents[i].block < first) continue;
      const std::size_t index = b_.incidents[i].block - first;
      InnerTouch& touch = b_.touches[index];
      const Real weight = index < b_.inner.size() ? t_.inner_contacts[b_.inner[index]].weight[touch.count]
                                                  : rope_contact(index).weight[touch.count];
      b_.incidents[i].weight = touch.weight[touch.count] = static_cast<double>(weight);
      touch.node[touch.count++] = node;
    }
  }
  for (std::size_t i = 0; i < b_.inner.size(); ++i) load_inner_touch(i);
  for (std::size_t i = b_.inner.size(); i < b_.first_borne(); ++i) load_rope_touch(i);
  for (std::size_t i = b_.first_borne(); i < b_.touches.size(); ++i) load_borne_touch(i);
}

void BundleSolution::load_inner_touch(std::size_t index) {
  const InnerContact& contact = t_.inner_contacts[b_.inner[index]];
  InnerTouch& touch = b_.touches[index];
  const bool given = b_.ends[b_.hooks.size() + index][0] < 0;
  touch.firm = t_.objects[contact.object].kind == PointRef::Kind::kRope;
  touch.push_out = touch.firm ? kInnerPushOutSpeed : 0;
  touch.near = is_near(contact);
  touch.separation = static_cast<double>(contact.separation);
  touch.friction = static_cast<double>(contact.friction);
  touch.surface = vector_cast<double>(given ? contact.surface_velocity : contact.belt_velocity);
  touch.lever = vector_cast<double>(contact.lever);
  make_touch_rows(index, {.n = vector_cast<double>(contact.normal),
                          .normal = static_cast<double>(contact.normal_force),
                          .friction = vector_cast<double>(contact.friction_force)});
}

const state::RopeContact& BundleSolution::rope_contact(std::size_t index) const {
  return t_.rope_contacts[b_.rope_contacts[index - b_.inner.size()]];
}

void BundleSolution::load_rope_touch(std::size_t index) {
  const state::RopeContact& contact = rope_contact(index);
  InnerTouch& touch = b_.touches[index];
  touch.firm = true;
  touch.push_out = kInnerPushOutSpeed;
  touch.near = contact.normal != Vec3{};
  touch.separation = static_cast<double>(contact.separation);
  touch.friction = static_cast<double>(contact.friction);
  make_touch_rows(index, {.n = vector_cast<double>(contact.normal),
                          .normal = static_cast<double>(contact.normal_force),
                          .friction = vector_cast<double>(contact.friction_force)});
}

/// Its separation goes along with the bodies from the start of the step, as that of other rows of bodies
/// does.
void BundleSolution::load_borne_touch(std::size_t index) {
  const state::BorneContact& contact = t_.pairs.borne[b_.borne[index - b_.first_borne()]];
  const state::Manifold& m = t_.pairs.manifold[contact.manifold];
  const state::ContactPoint& point = m.point[static_cast<std::size_t>(contact.point)];
  InnerTouch& touch = b_.touches[index];
  touch.firm = true;
  touch.near = contact.point < m.point_count;
  touch.friction = static_cast<double>(m.friction);
  touch.surface = vector_cast<double>(m.surface_velocity);
  touch.lever = vector_cast<double>(point.anchor_a);
  touch.lever_b = vector_cast<double>(point.anchor_b);
  const Vec3 way = way_between(t_.bodies, m, point);
  const double separation = touch.near ? static_cast<double>(contact.separation + dot(m.normal, way)) : 0;
  // Where it stands on several feet their loads must not hang on how each was rounded.
  const double slop = kBorneSlop * std::min(length(touch.lever), length(touch.lever_b));
  touch.separation = separation - std::clamp(separation, -slop, slop);
  // What does not give way moves as it is told.
  const auto [a, b] = b_.ends[b_.hooks.size() + index];
  if (a < 0) touch.surface += velocity_of(contact.body_a, touch.lever);
  if (b < 0) touch.surface -= velocity_of(contact.body_b, touch.lever_b);
  // What hangs is held: it is the heavier body that slides.
  touch.resistance = 1 / static_cast<double>(contact.load);
  // Where it is wedged in, leaving at the full speed would be work: no more than to lift it.
  const auto gravity = static_cast<double>(length(t_.desc.gravity));
  const double weight = gravity / touch.resistance;
  const double force = static_cast<double>(contact.normal_force);
  touch.push_out = kInnerPushOutSpeed * (force > weight ? weight / force : 1);
  make_touch_rows(index, {.n = vector_cast<double>(m.normal),
                          .normal = force,
                          .friction = vector_cast<double>(contact.friction_force),
                          .slides = contact.slides,
                          .fast = kMostStopped * touch.friction * h_ * gravity});
}

DVec3 BundleSolution::velocity_of(std::uint32_t body, DVec3 lever) const {
  const JointBody now = joint_body_now(t_.bodies, body);
  return now.v + cross(now.scale * now.omega_scaled, lever);
}

void BundleSolution::make_touch_rows(std::size_t index, const TouchForce& last) {
  InnerTouch& touch = b_.touches[index];
  const auto [a, b] = b_.ends[b_.hooks.size() + index];
  const auto axes = axes_of(last.n);
  const std::size_t first = b_.first_row[b_.hooks.size() + index];
  for (std::uint32_t i = 0; i < touch.count; ++i)
    touch.mobility += touch.weight[i] * touch.weight[i] * b_.ropes.nodes[touch.node[i]].w;
  const double inf = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < InnerTouch::kRows; ++k) {
    JointRow& row = b_.rows[first + k] = {};
    row.n = axes[k];
    row.low = -inf;
    row.high = inf;
    row.target = dot(axes[k], touch.surface);
    const auto turns = [&](int body, DVec3 lever, DVec3& j) {
      if (body < 0) return;
      const JointBody& of = b_.moving[static_cast<std::size_t>(body)].body;
      j = of.scale * cross(lever, axes[k]);
      if (k == 0) touch.mobility += of.inverse_mass + length_squared(j);
    };
    turns(a, touch.lever, row.j_a);
    turns(b, touch.lever_b, row.j_b);
  }
  b_.rows[first].target -= gap_speed(touch);
  if (touch.count > 0) touch.resistance = touch.mobility;

  touch.normal = h_ * last.normal;
  if (touch.firm) {
    double& gamma = b_.rows[first].gamma;
    gamma = touch.mobility / kContactStiffness;
    // What presses a light rope with many times its weight would push on through it.
    const bool of_ropes = index >= b_.inner.size() && index < b_.first_borne();
    if (of_ropes && gamma * touch.normal > kRopeYieldSpeed) gamma = kRopeYieldSpeed / touch.normal;
    b_.rows[first].target += std::min(gamma * touch.normal, kInnerPushOutSpeed);
  }
  const DVec3 friction = h_ * last.friction;
  touch.f = friction - dot(axes[0], friction) * axes[0];
  touch.active = touch.near && (touch.normal > 0 || touch.separation <= 0);
  const double size = length(touch.f);
  const double speed = length(sliding_of(index, true));
  const bool at_bound = size > 0 && size >= kSlidingShare * touch.friction * touch.normal;
  touch.slides = last.slides || at_bound || speed > last.fast;
  if (touch.slides) {
    touch.slides = speed > 0;
    touch.drag = speed > 0 ? touch.friction * touch.normal / speed : 0;
  }
  set_inner_rows(index);
  if (!touch.active || !touch.firm || touch.count == 0) return;
  note_rope_in_contact(touch.node[0]);
  note_rope_in_contact(touch.node[touch.count - 1]);
}

/// Overlap of ropes leaves by speed, that of cloths by place, as with the contacts of points.
double BundleSolution::gap_speed(const InnerTouch& touch) const {
  return std::max(touch.separation / h_, -touch.push_out);
}

void BundleSolution::note_rope_in_contact(std::uint32_t node) {
  std::size_t chain = 0;
  std::uint32_t end = 0;
  while ((end += b_.chain_nodes[chain]) <= node) ++chain;
  b_.settings[chain].compliance = kComplianceInContact;
  b_.settings[chain].turning = {};
}

/// Which rows of a contact are solved for; the others do nothing.
void BundleSolution::set_inner_rows(std::size_t index) {
  const InnerTouch& touch = b_.touches[index];
  const std::size_t first = b_.first_row[b_.hooks.size() + index];
  b_.bound[first] = touch.active ? 0 : 1;
  b_.lambda[first] = 0;
  const bool held = touch.active && touch.friction > 0 && (!touch.slides || touch.drag > 0);
  for (std::size_t row = first + 1; row < first + InnerTouch::kRows; ++row) {
    b_.rows[row].gamma = held && touch.slides ? 1 / touch.drag : 0;
    b_.bound[row] = held ? 0 : 1;
    b_.lambda[row] = 0;
  }
}

/// Velocity of the place against the surface: as the forces left it, or as the solution has it. Of bodies it
/// is the solution's, or before that what they had.
DVec3 BundleSolution::velocity_at(std::size_t index, bool before) const {
  const InnerTouch& touch = b_.touches[index];
  DVec3 v = -touch.surface;
  for (std::uint32_t i = 0; i < touch.count; ++i) {
    const RopeNode& node = b_.ropes.nodes[touch.node[i]];
    v += touch.weight[i] * (before ? node.v_free : node.u);
  }
  const auto velocity = [&](int body, DVec3 lever) {
    if (body < 0) return DVec3{};
    const BundleBody& m = b_.moving[static_cast<std::size_t>(body)];
    return m.v + cross(m.body.scale * m.omega_scaled, lever);
  };
  const auto [a, b] = b_.ends[b_.hooks.size() + index];
  return v + velocity(b, touch.lever_b) - velocity(a, touch.lever);
}

DVec3 BundleSolution::sliding_of(std::size_t index, bool before) const {
  const DVec3 n = b_.rows[b_.first_row[b_.hooks.size() + index]].n;
  const DVec3 v = velocity_at(index, before);
  return v - dot(n, v) * n;
}

/// Friction of an active contact: whether it sticks, and what drags it if not. True if it is not yet what it
/// should be. What slides sticks only if it `may_stick`.
bool BundleSolution::update_inner_friction(std::size_t index, bool may_stick) {
  InnerTouch& touch = b_.touches[index];
  const std::size_t first = b_.first_row[b_.hooks.size() + index];
  const double most = touch.friction * touch.normal;
  const DVec3 sliding = sliding_of(index, false);
  const double speed = length(sliding);
  if (!touch.slides) {
    touch.f = {};
    for (std::size_t k = 1; k < InnerTouch::kRows; ++k)
      touch.f += b_.lambda[first + k] * b_.rows[first + k].n;
    const double size = length(touch.f);
    touch.slides = size > most;
    if (!touch.slides) return false;
    touch.drag = most / ((size - most) * touch.resistance);
    touch.f = (most / size) * touch.f;
    return true;
  }
  const double drag = touch.drag;
  touch.f = -drag * sliding;
  const double most_drag = index < b_.inner.size() ? kMostDrag : kMostRopeDrag;
  touch.slides = speed > 0 && (!may_stick || most * touch.mobility < most_drag * speed);
  touch.drag = touch.slides ? most / speed : 0;
  return !touch.slides || std::abs(touch.drag - drag) > kSettledDrag * drag;
}

/// Of what is borne, rows join and leave until they are right. From some number of solutions on they only
/// join, and what slides does not stick again: what is left out is gone through, what holds too long makes no
/// energy, but friction that holds a substep too long takes all the speed there is.
Unsettled BundleSolution::update_borne_touch(std::size_t index, bool only_join) {
  InnerTouch& touch = b_.touches[index];
  const std::size_t first = b_.first_row[b_.hooks.size() + index];
  const bool was_active = touch.active;
  bool slides_otherwise = false;
  if (touch.active) {
    touch.normal = std::max(0.0, b_.lambda[first]);
    touch.active = touch.normal > 0 || only_join;
    const bool stuck = !touch.slides;
    slides_otherwise = touch.active && touch.friction > 0 && update_inner_friction(index, !only_join);
    if (only_join) slides_otherwise = stuck && touch.slides;
  } else {
    touch.normal = 0;
    touch.active = dot(b_.rows[first].n, velocity_at(index, false)) + gap_speed(touch) < 0;
    touch.slides = false;
  }
  if (!touch.active) touch.f = {};
  Unsettled unsettled;
  unsettled.points = touch.active != was_active || slides_otherwise;
  return unsettled;
}

Unsettled BundleSolution::update_inner_touch(std::size_t index, bool let_go) {
  InnerTouch& touch = b_.touches[index];
  Unsettled unsettled;
  if (!touch.near) return unsettled;
  if (index >= b_.first_borne()) return update_borne_touch(index, let_go);
  const std::size_t first = b_.first_row[b_.hooks.size() + index];
  bool& of = touch.firm ? unsettled.ropes : unsettled.points;
  if (touch.active) {
    touch.normal = std::max(0.0, b_.lambda[first]);
    touch.active = touch.normal > 0;
    const bool slides_otherwise = touch.active && touch.friction > 0 && update_inner_friction(index, true);
    const double pull = -b_.lambda[first];
    unsettled.pulls = touch.firm && pull > 0 && is_work(pull * touch.separation / h_, 1 / touch.mobility);
    touch.let_go = let_go && unsettled.pulls;
    of = !touch.active || (slides_otherwise && (touch.firm || !let_go));
  } else {
    touch.normal = 0;
    const double approach = dot(b_.rows[first].n, velocity_at(index, false)) + gap_speed(touch);
    touch.active = approach < 0 && !(touch.firm ? touch.let_go : let_go);
    touch.slides = false;
    of = touch.active;
    unsettled.meets = of && touch.firm && approach < -kMeetingSpeed;
  }
  if (!touch.active) touch.f = {};
  return unsettled;
}

Unsettled BundleSolution::update_inner(bool let_go) {
  Unsettled unsettled;
  for (std::size_t i = 0; i < b_.touches.size(); ++i) unsettled.add(update_inner_touch(i, let_go));
  return unsettled;
}

/// Before the next solution: what update_inner found comes into effect.
void BundleSolution::revise_inner() {
  for (std::size_t i = 0; i < b_.touches.size(); ++i) set_inner_rows(i);
}

int BundleSolution::least_solves_of_inner() const {
  const bool any = std::any_of(b_.touches.begin(), b_.touches.end(),
                               [](const InnerTouch& t) { return t.firm && t.active; });
  const bool slide = std::any_of(b_.touches.begin() + static_cast<std::ptrdiff_t>(b_.inner.size()),
                                 b_.touches.begin() + static_cast<std::ptrdiff_t>(b_.first_borne()),
                                 [](const InnerTouch& t) { return t.active && t.slides; });
  if (slide) return kRopeSlidingSolves;
  return any ? kLeastContactSolves : 1;
}

/// A rope that is jammed gets no friction for the rest of the substep (solve_again in rope_rows.h).
bool BundleSolution::let_inner_slide() {
  bool any = false;
  for (InnerTouch& touch : b_.touches) {
    if (!touch.firm) continue;
    any = true;
    touch.friction = 0;
    touch.slides = false;
    touch.f = {};
  }
  return any;
}

void BundleSolution::store_inner() {
  for (std::size_t i = 0; i < b_.rope_contacts.size(); ++i) {
    const InnerTouch& touch = b_.touches[b_.inner.size() + i];
    state::RopeContact& contact = t_.rope_contacts[b_.rope_contacts[i]];
    contact.normal_force = static_cast<Real>(touch.normal / h_);
    contact.friction_force = vector_cast<Real>((1 / h_) * touch.f);
  }
  for (std::size_t i = 0; i < b_.inner.size(); ++i) {
    const InnerTouch& touch = b_.touches[i];
    InnerContact& contact = t_.inner_contacts[b_.inner[i]];
    contact.normal_force = static_cast<Real>(touch.normal / h_);
    contact.friction_force = vector_cast<Real>((1 / h_) * touch.f);
    if (!touch.firm) push_out(contact, static_cast<Real>(h_), t_.particles);
  }
  for (std::size_t i = 0; i < b_.borne.size(); ++i) {
    const InnerTouch& touch = b_.touches[b_.first_borne() + i];
    state::BorneContact& contact = t_.pairs.borne[b_.borne[i]];
    contact.normal_force = static_cast<Real>(touch.normal / h_);
    contact.friction_force = vector_cast<Real>((1 / h_) * touch.f);
    contact.slides = touch.active && touch.slides;
    contact.largest_force = std::max(contact.largest_force, contact.normal_force);
  }
}

}  // namespace hooke::solver
