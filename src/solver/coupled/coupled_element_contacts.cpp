/// Element contacts and rope contacts, as rows of a coupled group. Which rows exist:
/// coupled_groups_build.cpp.

#include "base/assert.h"
#include "geometry/closest.h"
#include "solver/coupled/coupled_group_solution.h"
#include "solver/coupled/coupled_tuning.h"
#include "solver/soft/element_contact_solve.h"
#include "solver/soft/particle_contact_solve.h"
#include "state/body_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hooke::solver {

namespace {

using state::ElementContact;

/// The normal and two directions across it.
std::array<DVec3, CoupledContact::kRows> axes_of(DVec3 n) {
  const DVec3 far = std::abs(n.x) < 0.6 ? DVec3{1, 0, 0} : DVec3{0, 1, 0};
  const DVec3 across = normalize(cross(n, far));
  return {n, across, cross(n, across)};
}

}  // namespace

bool CoupledGroupSolution::has_coupled_contact(std::size_t node) const {
  const auto at = incidents_of(node);
  return !at.empty() && at.back().block >= hook_block(static_cast<std::uint32_t>(b_.hooks.size()));
}

/// Mass of the heaviest body that a contact of the group may press on a node; 0 if there is none [kg].
double CoupledGroupSolution::heaviest_in_contact(std::size_t node) const {
  double heaviest = 0;
  for (const CoupledGroup::Incident& at : incidents_of(node)) {
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

void CoupledGroupSolution::load_coupled_contacts() {
  b_.contact_rows.assign(b_.contact_count(), {});
  if (b_.contact_rows.empty()) return;
  const std::uint32_t first = hook_block(static_cast<std::uint32_t>(b_.hooks.size()));
  // Nodes and points of an element are in the same order.
  for (std::uint32_t node = 0; node < b_.ropes.nodes.size(); ++node) {
    for (std::uint32_t i = b_.first_incident[node]; i < b_.first_incident[node + 1]; ++i) {
      if (b_.incidents[i].block < first) continue;
      const std::size_t index = b_.incidents[i].block - first;
      CoupledContact& coupled = b_.contact_rows[index];
      HOOKE_ASSERT(index < b_.contact_count() && coupled.count < coupled.node.size());
      const Real weight = index < b_.element_contacts.size()
                              ? t_.element_contacts[b_.element_contacts[index]].weight[coupled.count]
                              : rope_contact(index).weight[coupled.count];
      b_.incidents[i].weight = coupled.weight[coupled.count] = static_cast<double>(weight);
      coupled.node[coupled.count++] = node;
    }
  }
  for (std::size_t i = 0; i < b_.element_contacts.size(); ++i) load_element_contact(i);
  for (std::size_t i = b_.element_contacts.size(); i < b_.contact_count(); ++i) load_rope_contact(i);
}

void CoupledGroupSolution::load_element_contact(std::size_t index) {
  const ElementContact& contact = t_.element_contacts[b_.element_contacts[index]];
  CoupledContact& coupled = b_.contact_rows[index];
  HOOKE_ASSERT(coupled.count == contact.count);  // each point is a node of the group
  const bool given = b_.ends[b_.hooks.size() + index][0] < 0;
  coupled.firm = t_.objects[contact.object].kind == PointRef::Kind::kRope;
  coupled.push_out = coupled.firm ? kElementPushOutSpeed : 0;
  coupled.near = is_near(contact);
  coupled.separation = static_cast<double>(contact.separation);
  coupled.friction = static_cast<double>(contact.friction);
  coupled.surface = vector_cast<double>(given ? contact.surface_velocity : contact.belt_velocity);
  coupled.lever = vector_cast<double>(contact.lever);
  make_contact_rows(index, {.n = vector_cast<double>(contact.normal),
                            .normal = static_cast<double>(contact.normal_force),
                            .friction = vector_cast<double>(contact.friction_force)});
}

const state::RopeContact& CoupledGroupSolution::rope_contact(std::size_t index) const {
  return t_.rope_contacts[b_.rope_contacts[index - b_.element_contacts.size()]];
}

void CoupledGroupSolution::load_rope_contact(std::size_t index) {
  const state::RopeContact& contact = rope_contact(index);
  CoupledContact& coupled = b_.contact_rows[index];
  HOOKE_ASSERT(coupled.count == contact.particle.size());
  coupled.firm = true;
  coupled.push_out = kElementPushOutSpeed;
  coupled.near = contact.normal != Vec3{};
  coupled.separation = static_cast<double>(contact.separation);
  coupled.friction = static_cast<double>(contact.friction);
  make_contact_rows(index, {.n = vector_cast<double>(contact.normal),
                            .normal = static_cast<double>(contact.normal_force),
                            .friction = vector_cast<double>(contact.friction_force)});
}

/// Makes the rows along the normal and across it, and finds the mobility along the normal.
void CoupledGroupSolution::make_contact_directions(std::size_t index, DVec3 n) {
  CoupledContact& coupled = b_.contact_rows[index];
  const int body = b_.ends[b_.hooks.size() + index][0];
  const auto axes = axes_of(n);
  const std::size_t first = b_.first_row[b_.hooks.size() + index];
  for (std::uint32_t i = 0; i < coupled.count; ++i)
    coupled.mobility += coupled.weight[i] * coupled.weight[i] * b_.ropes.nodes[coupled.node[i]].w;
  const double inf = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < CoupledContact::kRows; ++k) {
    JointRow& row = b_.rows[first + k] = {};
    row.n = axes[k];
    row.low = -inf;
    row.high = inf;
    row.target = dot(axes[k], coupled.surface);
    if (body < 0) continue;
    const JointBody& of = b_.moving[static_cast<std::size_t>(body)].body;
    row.j_a = of.scale * cross(coupled.lever, axes[k]);
    if (k == 0) coupled.mobility += of.inverse_mass + length_squared(row.j_a);
  }
}

/// Lets the contact begin as the last substep left it: with its force, and sliding or not.
void CoupledGroupSolution::give_last_force(std::size_t index, const ContactForce& last) {
  CoupledContact& coupled = b_.contact_rows[index];
  JointRow& along_normal = b_.rows[b_.first_row[b_.hooks.size() + index]];
  coupled.normal = h_ * last.normal;
  if (coupled.firm) {
    double& gamma = along_normal.gamma;
    gamma = coupled.mobility / kRopeContactStiffness;
    // What presses a light rope with many times its weight would otherwise push through it.
    const bool of_ropes = index >= b_.element_contacts.size();
    if (of_ropes && gamma * coupled.normal > kRopeYieldSpeed) gamma = kRopeYieldSpeed / coupled.normal;
    along_normal.target += std::min(gamma * coupled.normal, kElementPushOutSpeed);
  }
  const DVec3 friction = h_ * last.friction;
  coupled.f = friction - dot(last.n, friction) * last.n;
  coupled.active = coupled.near && (coupled.normal > 0 || coupled.separation <= 0);
  const double size = length(coupled.f);
  coupled.slides = size > 0 && size >= kRopeSlidingShare * coupled.friction * coupled.normal;
  if (coupled.slides) {
    const double speed = length(sliding_of(index, true));
    coupled.slides = speed > 0;
    coupled.drag = speed > 0 ? coupled.friction * coupled.normal / speed : 0;
  }
}

void CoupledGroupSolution::make_contact_rows(std::size_t index, const ContactForce& last) {
  CoupledContact& coupled = b_.contact_rows[index];
  make_contact_directions(index, last.n);
  b_.rows[b_.first_row[b_.hooks.size() + index]].target -= gap_speed(coupled);
  give_last_force(index, last);
  set_coupled_rows(index);
  if (!coupled.active || !coupled.firm || coupled.count == 0) return;
  note_rope_in_contact(coupled.node[0]);
  note_rope_in_contact(coupled.node[coupled.count - 1]);
}

/// Overlap of ropes is removed by speed, that of cloths by displacement, as in particle contacts.
double CoupledGroupSolution::gap_speed(const CoupledContact& coupled) const {
  return std::max(coupled.separation / h_, -coupled.push_out);
}

void CoupledGroupSolution::note_rope_in_contact(std::uint32_t node) {
  std::size_t rope_system = 0;
  std::uint32_t end = 0;
  while ((end += b_.rope_node_counts[rope_system]) <= node) ++rope_system;
  HOOKE_ASSERT(rope_system < b_.settings.size());
  b_.settings[rope_system].compliance = kComplianceInContact;
  b_.settings[rope_system].turning = {};
}

/// Chooses which rows of a contact are solved; the others do nothing.
void CoupledGroupSolution::set_coupled_rows(std::size_t index) {
  const CoupledContact& coupled = b_.contact_rows[index];
  const std::size_t first = b_.first_row[b_.hooks.size() + index];
  HOOKE_ASSERT(first + CoupledContact::kRows <= b_.bound.size());
  b_.bound[first] = coupled.active ? 0 : 1;
  b_.lambda[first] = 0;
  const bool held = coupled.active && coupled.friction > 0 && (!coupled.slides || coupled.drag > 0);
  for (std::size_t row = first + 1; row < first + CoupledContact::kRows; ++row) {
    b_.rows[row].gamma = held && coupled.slides ? 1 / coupled.drag : 0;
    b_.bound[row] = held ? 0 : 1;
    b_.lambda[row] = 0;
  }
}

/// Velocity of the contact relative to the surface: as the forces left it, or as the solution has it. Bodies
/// have the velocity of the solution, or before the first one what they had.
DVec3 CoupledGroupSolution::velocity_at(std::size_t index, bool before) const {
  const CoupledContact& coupled = b_.contact_rows[index];
  DVec3 v = -coupled.surface;
  for (std::uint32_t i = 0; i < coupled.count; ++i) {
    const RopeNode& node = b_.ropes.nodes[coupled.node[i]];
    v += coupled.weight[i] * (before ? node.v_free : node.u);
  }
  const int body = b_.ends[b_.hooks.size() + index][0];
  if (body < 0) return v;
  return v - b_.moving[static_cast<std::size_t>(body)].velocity_at(coupled.lever);
}

DVec3 CoupledGroupSolution::sliding_of(std::size_t index, bool before) const {
  const DVec3 n = b_.rows[b_.first_row[b_.hooks.size() + index]].n;
  const DVec3 v = velocity_at(index, before);
  return v - dot(n, v) * n;
}

/// Updates friction of an active contact: whether it sticks, and its drag if not. True if that has not
/// converged. A sliding contact sticks only if it `may_stick`.
bool CoupledGroupSolution::update_coupled_friction(std::size_t index, bool may_stick) {
  CoupledContact& coupled = b_.contact_rows[index];
  const std::size_t first = b_.first_row[b_.hooks.size() + index];
  const double most = coupled.friction * coupled.normal;
  const DVec3 sliding = sliding_of(index, false);
  const double speed = length(sliding);
  if (!coupled.slides) {
    coupled.f = {};
    for (std::size_t k = 1; k < CoupledContact::kRows; ++k)
      coupled.f += b_.lambda[first + k] * b_.rows[first + k].n;
    const double size = length(coupled.f);
    coupled.slides = size > most;
    if (!coupled.slides) return false;
    coupled.drag = most / ((size - most) * coupled.mobility);
    coupled.f = (most / size) * coupled.f;
    return true;
  }
  const double drag = coupled.drag;
  coupled.f = -drag * sliding;
  coupled.slides = speed > 0 && (!may_stick || most * coupled.mobility < kMostDrag * speed);
  coupled.drag = coupled.slides ? most / speed : 0;
  return !coupled.slides || std::abs(coupled.drag - drag) > kRopeConvergedDrag * drag;
}

Unconverged CoupledGroupSolution::update_coupled_contact(std::size_t index, bool let_go) {
  CoupledContact& coupled = b_.contact_rows[index];
  Unconverged unconverged;
  if (!coupled.near) return unconverged;
  const std::size_t first = b_.first_row[b_.hooks.size() + index];
  bool& of = coupled.firm ? unconverged.ropes : unconverged.points;
  if (coupled.active) {
    coupled.normal = std::max(0.0, b_.lambda[first]);
    coupled.active = coupled.normal > 0;
    const bool slides_otherwise =
        coupled.active && coupled.friction > 0 && update_coupled_friction(index, true);
    const double pull = -b_.lambda[first];
    unconverged.pulls =
        coupled.firm && pull > 0 && is_work(pull * coupled.separation / h_, 1 / coupled.mobility);
    coupled.let_go = let_go && unconverged.pulls;
    of = !coupled.active || (slides_otherwise && (coupled.firm || !let_go));
  } else {
    coupled.normal = 0;
    const double closing_speed = dot(b_.rows[first].n, velocity_at(index, false)) + gap_speed(coupled);
    coupled.active = closing_speed < 0 && !(coupled.firm ? coupled.let_go : let_go);
    coupled.slides = false;
    of = coupled.active;
    unconverged.impacts = of && coupled.firm && closing_speed < -kRopeImpactSpeed;
  }
  if (!coupled.active) coupled.f = {};
  return unconverged;
}

Unconverged CoupledGroupSolution::update_coupled_contacts(bool let_go) {
  Unconverged unconverged;
  for (std::size_t i = 0; i < b_.contact_rows.size(); ++i) unconverged.add(update_coupled_contact(i, let_go));
  return unconverged;
}

/// Before the next solution: applies what update_coupled_contacts found.
void CoupledGroupSolution::revise_coupled_contacts() {
  for (std::size_t i = 0; i < b_.contact_rows.size(); ++i) set_coupled_rows(i);
}

int CoupledGroupSolution::least_solves_of_contacts() const {
  const bool any = std::any_of(b_.contact_rows.begin(), b_.contact_rows.end(),
                               [](const CoupledContact& t) { return t.firm && t.active; });
  const bool slide =
      std::any_of(b_.contact_rows.begin() + static_cast<std::ptrdiff_t>(b_.element_contacts.size()),
                  b_.contact_rows.end(), [](const CoupledContact& t) { return t.active && t.slides; });
  if (slide) return kRopeSlidingSolves;
  return any ? kLeastRopeContactSolves : 1;
}

/// The same as calm_contacts, of element contacts and rope contacts.
void CoupledGroupSolution::calm_coupled_contacts() {
  for (std::size_t i = 0; i < b_.contact_rows.size(); ++i) {
    CoupledContact& coupled = b_.contact_rows[i];
    JointRow& along_normal = b_.rows[b_.first_row[b_.hooks.size() + i]];
    const double opening = dot(along_normal.n, velocity_at(i, true)) + coupled.separation / h_;
    coupled.active = coupled.near && (coupled.separation <= 0 || opening < 0);
    coupled.separation = std::max(coupled.separation, 0.0);
    coupled.normal = coupled.friction = 0;
    coupled.slides = false;
    coupled.f = {};
    along_normal.gamma = 0;
    along_normal.target = dot(along_normal.n, coupled.surface) - coupled.separation / h_;
    set_coupled_rows(i);
  }
}

/// Contacts of a jammed rope get no friction for the rest of the substep (solve_again in
/// solver/rope/rope_rows.h).
bool CoupledGroupSolution::let_contacts_slide() {
  bool any = false;
  for (CoupledContact& coupled : b_.contact_rows) {
    if (!coupled.firm) continue;
    any = true;
    coupled.friction = 0;
    coupled.slides = false;
    coupled.f = {};
  }
  return any;
}

void CoupledGroupSolution::store_coupled_contacts() {
  for (std::size_t i = 0; i < b_.rope_contacts.size(); ++i) {
    const CoupledContact& coupled = b_.contact_rows[b_.element_contacts.size() + i];
    state::RopeContact& contact = t_.rope_contacts[b_.rope_contacts[i]];
    contact.normal_force = static_cast<Real>(coupled.normal / h_);
    contact.friction_force = vector_cast<Real>((1 / h_) * coupled.f);
  }
  for (std::size_t i = 0; i < b_.element_contacts.size(); ++i) {
    const CoupledContact& coupled = b_.contact_rows[i];
    ElementContact& contact = t_.element_contacts[b_.element_contacts[i]];
    contact.normal_force = static_cast<Real>(coupled.normal / h_);
    contact.friction_force = vector_cast<Real>((1 / h_) * coupled.f);
    if (!coupled.firm) push_out(contact, static_cast<Real>(h_), t_);
  }
}

}  // namespace hooke::solver
