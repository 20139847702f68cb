#include "solver/soft/pressed_points.h"

#include "base/assert.h"
#include "solver/body/body_motion.h"
#include "solver/soft/soft_tuning.h"
#include "solver/solid/stiff_ties.h"
#include "state/bodies.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace hooke::solver {

namespace {

using math::Symmetric3;
using state::gives_way;

/// W of a point with one more mass m, which moves with it along the unit vector n alone:
/// (W^-1 + m n n^T)^-1 (Sherman and Morrison 1950).
Symmetric3<double> with_mass_along(const Symmetric3<double>& w, DVec3 n, double m) {
  const DVec3 t = w * n;
  const double s = -m / (1 + m * dot(n, t));
  return w + Symmetric3<double>{s * t.x * t.x, s * t.x * t.y, s * t.x * t.z,
                                s * t.y * t.y, s * t.y * t.z, s * t.z * t.z};
}

/// How fast a point that moves with the velocity v would press on what it touches, beyond reaching it: 0 or
/// less if it does not.
Real pressing_speed(const state::Contacts& contacts, std::size_t row, Vec3 v, Real h) {
  return -dot(contacts.normal[row], v - contacts.surface_velocity[row]) -
         std::max(contacts.separation[row], Real(0)) / h;
}

bool presses(const state::Tables& t, std::size_t row, Real h) {
  const Vec3 v = t.particles.velocity[t.contacts.particle[row]].v;
  return t.contacts.normal_force[row] > Real(0) || pressing_speed(t.contacts, row, v, h) > Real(0);
}

/// The mass that moves with the point of a contact.
double mass_behind(const state::Tables& t, std::size_t row, const std::vector<int>& shares,
                   double inverse_mass) {
  const std::uint32_t body = t.contacts.body[row];
  const double most = kMostMassShare / inverse_mass;
  if (!gives_way(t.bodies, body)) return most;
  const int share = std::max(shares[body], 1);
  return std::min(most, 1 / (share * static_cast<double>(t.bodies.motion[body].inverse_mass)));
}

/// Calls visit(row, bit) with the contacts of a point.
template <class Visit>
void for_contacts(const state::Contacts& contacts, const PressedPoint& point, Visit visit) {
  std::uint32_t bit = 1;
  for (std::size_t row = point.contact;
       bit != 0 && row < contacts.particle.size() && contacts.particle[row] == point.particle;
       ++row, bit <<= 1)
    visit(row, bit);
}

/// The bit of a contact in the sets of its point.
std::uint32_t bit_of(const PressedPoint& point, std::size_t row) {
  return std::uint32_t{1} << (row - point.contact);
}

/// The normal, of unit length in double too: projections that are none to 1e-7 let a solution grow without
/// bound where a contact pushes hard.
DVec3 normal_of(const state::Contacts& contacts, std::size_t row) {
  return normalize(vector_cast<double>(contacts.normal[row]));
}

/// The projection on the directions across n.
Symmetric3<double> across(DVec3 n) {
  return {1 - n.x * n.x, -n.x * n.y, -n.x * n.z, 1 - n.y * n.y, -n.y * n.z, 1 - n.z * n.z};
}

/// Lets friction of `most` resist a point that slides across n with `sliding`, with a mass that gives this
/// friction at that speed. Returns false if the point rather sticks.
bool slide(double most, DVec3 sliding, DVec3 n, PressedPoint& point) {
  const double speed = length(sliding);
  const double mobility = static_cast<double>(point.inverse_mass) * point.yielding;
  if (!(speed > 0) || !(most * mobility < kMostDragOfPoints * speed)) return false;
  const double drag = most / speed;
  const Symmetric3<double> p = across(n);
  point.drag = point.drag + Symmetric3<double>{drag * p.xx, drag * p.xy, drag * p.xz,
                                               drag * p.yy, drag * p.yz, drag * p.zz};
  return true;
}

/// Takes what held the point in the substep before, and what it is about to reach.
void hold_at_first(const state::Tables& t, Real h, PressedPoint& point) {
  const state::Contacts& contacts = t.contacts;
  for_contacts(contacts, point, [&](std::size_t row, std::uint32_t bit) {
    if (presses(t, row, h)) point.held |= bit;
    point.stuck |= bit;
    const Real most = contacts.friction[row] * contacts.normal_force[row];
    if (!(length(contacts.friction_force[row]) < kStickingShare * most) && most > Real(0)) {
      const auto n = normal_of(contacts, row);
      const auto relative =
          vector_cast<double>(t.particles.velocity[point.particle].v - contacts.surface_velocity[row]);
      if (slide(static_cast<double>(h * most), relative - dot(n, relative) * n, n, point))
        point.stuck &= ~bit;
    } else if (!(contacts.friction[row] > Real(0))) {
      point.stuck &= ~bit;
    }
  });
}

/// What its contacts give a point in all, friction included [N s].
DVec3 contact_impulse(const PressedPoint& point) {
  return (1 / static_cast<double>(point.inverse_mass)) * point.change - point.impulse;
}

/// Calls visit(row, impulse) with the part of each contact that holds a point of what all give it. The first
/// one has what none of them can give by pushing: its friction.
template <class Visit>
void for_shares(const state::Contacts& contacts, const PressedPoint& point, DVec3 impulse, Visit visit) {
  if (point.held == 0) return;
  const std::size_t first = point.contact + static_cast<std::size_t>(std::countr_zero(point.held));
  DVec3 rest = impulse;
  DVec3 of_first;
  for_contacts(contacts, point, [&](std::size_t row, std::uint32_t bit) {
    if ((point.held & bit) == 0) return;
    const auto n = normal_of(contacts, row);
    const DVec3 part = std::max(dot(n, rest), 0.0) * n;
    rest -= part;
    if (row == first) {
      of_first = part;
    } else {
      visit(row, part);
    }
  });
  visit(first, of_first + rest);
}

/// The velocity of the surface at a contact after the solution.
DVec3 surface_after(const state::Contacts& contacts, std::size_t row, const TetrahedronBlocks& tetrahedra) {
  const HoldingBody* holder = tetrahedra.stiff.find_holder(contacts.body[row]);
  const auto before = vector_cast<double>(contacts.surface_velocity[row]);
  if (holder == nullptr) return before;
  return before + velocity_at(holder->change, vector_cast<double>(contacts.lever[row]));
}

/// Lets go what does not hold a point, and takes hold where it would pass. Bodies do not pull, and friction
/// has a limit. What was let go is held again one round later at the earliest, so that points do not flicker.
void revise(const state::Tables& t, Real h, bool may_hold, const TetrahedronBlocks& tetrahedra,
            PressedPoint& point) {
  const state::Contacts& contacts = t.contacts;
  const DVec3 now = vector_cast<double>(t.particles.velocity[point.particle].v) + point.change;
  const double mobility = static_cast<double>(point.inverse_mass) * point.yielding;
  const DVec3 impulse = contact_impulse(point);
  point.drag = {};
  for_contacts(contacts, point, [&](std::size_t row, std::uint32_t bit) {
    const auto n = normal_of(contacts, row);
    const DVec3 relative = now - surface_after(contacts, row, tetrahedra);
    if ((point.held & bit) == 0) {
      const double reach = static_cast<double>(std::max(contacts.separation[row], Real(0)) / h);
      if (may_hold && dot(n, relative) + reach < 0)
        ((point.let_go & bit) == 0 ? point.held : point.let_go) ^= bit;
      return;
    }
    const double pressed = dot(n, impulse);
    if (!(pressed > 0)) {
      point.held &= ~bit;
      point.let_go |= bit;
      return;
    }
    const double most = static_cast<double>(contacts.friction[row]) * pressed;
    const DVec3 friction = impulse - pressed * n;
    const double size = length(friction);
    if ((point.stuck & bit) == 0) {
      if (slide(most, relative - dot(n, relative) * n, n, point)) return;
      if (most > 0) point.stuck |= bit;
    } else if (size > most) {
      // It would slide with what friction lacks, where stress resists it.
      if (most == 0 || slide(most, (mobility * (most / size - 1)) * friction, n, point)) point.stuck &= ~bit;
    }
  });
}

/// How a held contact changes the velocity of a point that has `before` so far [m/s].
DVec3 start_of(const state::Contacts& contacts, std::size_t row, Real h, bool sticks, DVec3 before) {
  const auto n = normal_of(contacts, row);
  const DVec3 relative = before - vector_cast<double>(contacts.surface_velocity[row]);
  const double along = dot(n, relative);
  const double stopped =
      -along - static_cast<double>(std::max(contacts.separation[row], Real(0))) / static_cast<double>(h);
  const DVec3 start = stopped * n;
  return sticks ? start - (relative - along * n) : start;
}

/// The contact whose body a point becomes one with: the first that holds it, and one that gives way if there
/// is any.
std::size_t holding_contact(const state::Tables& t, const PressedPoint& point) {
  std::size_t chosen = t.contacts.particle.size();
  for_contacts(t.contacts, point, [&](std::size_t row, std::uint32_t bit) {
    if ((point.held & bit) == 0) return;
    const bool is_first = chosen == t.contacts.particle.size();
    if (is_first ||
        (!gives_way(t.bodies, t.contacts.body[chosen]) && gives_way(t.bodies, t.contacts.body[row])))
      chosen = row;
  });
  return chosen;
}

/// Finds what holds a point, how it answers, and how contacts change its velocity before stress does.
void find_answer(const state::Tables& t, const std::vector<int>& shares, Real h, PressedPoint& point) {
  const state::Contacts& contacts = t.contacts;
  const auto inverse_mass = static_cast<double>(point.inverse_mass);
  const DVec3 before = vector_cast<double>(t.particles.velocity[point.particle].v);
  point.answer = Symmetric3<double>::diagonal(inverse_mass);
  point.holder = PressedPoint::kNone;
  point.follows = {};
  point.free = Symmetric3<double>::diagonal(1);
  point.start = point.others_start = {};
  const std::size_t holding = holding_contact(t, point);
  if (holding < contacts.particle.size()) {
    const bool sticks = (point.stuck & bit_of(point, holding)) != 0;
    const bool is_dragged = point.drag.xx + point.drag.yy + point.drag.zz > 0;
    const auto n = normal_of(contacts, holding);
    point.holder = contacts.body[holding];
    point.free = sticks ? Symmetric3<double>{} : across(n);
    point.follows = sticks || is_dragged ? Symmetric3<double>::diagonal(1)
                                         : Symmetric3<double>{n.x * n.x, n.x * n.y, n.x * n.z,
                                                              n.y * n.y, n.y * n.z, n.z * n.z};
    point.lever = vector_cast<double>(contacts.lever[holding]);
    point.start = start_of(contacts, holding, h, sticks, before);
    point.sliding = before - vector_cast<double>(contacts.surface_velocity[holding]);
  }
  for_contacts(contacts, point, [&](std::size_t row, std::uint32_t bit) {
    if ((point.held & bit) == 0 || row == holding) return;
    const bool sticks = (point.stuck & bit) != 0;
    const double mass = mass_behind(t, row, shares, inverse_mass);
    const double share = mass / (mass + 1 / inverse_mass);
    point.others_start +=
        share * start_of(contacts, row, h, sticks, before + point.start + point.others_start);
    if (sticks) {
      for (const DVec3& axis : {DVec3{1, 0, 0}, DVec3{0, 1, 0}, DVec3{0, 0, 1}})
        point.answer = with_mass_along(point.answer, axis, mass);
    } else {
      point.answer = with_mass_along(point.answer, normal_of(contacts, row), mass);
    }
  });
}

/// How much of a body belongs to the points of a group: all of it if it presses on no other.
double share_of_body(const state::Tables& t, std::uint32_t body, const std::vector<int>& shares, Real h,
                     const std::vector<PressedPoint>& pressed) {
  if (shares[body] == 0) return 1;
  int own = 0;
  for (const PressedPoint& point : pressed) {
    for_contacts(t.contacts, point, [&](std::size_t row, std::uint32_t /*bit*/) {
      if (t.contacts.body[row] == body) own += presses(t, row, h);
    });
  }
  return own == 0 ? 1 : static_cast<double>(own) / shares[body];
}

/// Lists the bodies that hold points, with their shares of mass, and finds the one that moves each point.
void list_holders(const state::Tables& t, const std::vector<int>& shares, Real h,
                  TetrahedronBlocks& tetrahedra) {
  std::vector<HoldingBody>& holders = tetrahedra.stiff.holders;
  for (const PressedPoint& point : tetrahedra.pressed) {
    if (point.holder == PressedPoint::kNone || tetrahedra.stiff.find_holder(point.holder) != nullptr)
      continue;
    holders.push_back(
        holding_body(t.bodies, point.holder, share_of_body(t, point.holder, shares, h, tetrahedra.pressed)));
  }
  for (PressedPoint& point : tetrahedra.pressed) {
    const HoldingBody* holder = tetrahedra.stiff.find_holder(point.holder);
    const bool moves = holder != nullptr && holder->moves;
    point.mover = moves ? static_cast<std::uint32_t>(holder - holders.data()) : PressedPoint::kNone;
  }
}

/// Mean of what contacts do to the velocities of points [first, end) of `pressed`: of those that something
/// holds which does not give way, or of all where there are none.
DVec3 mean_start(const TetrahedronBlocks& tetrahedra, std::size_t first, std::size_t end) {
  DVec3 of_ground, of_all;
  int on_ground = 0, count = 0;
  for (std::size_t i = first; i < end; ++i) {
    const PressedPoint& point = tetrahedra.pressed[i];
    const HoldingBody* holder = tetrahedra.stiff.find_holder(point.holder);
    if (holder == nullptr) continue;
    of_all += point.start;
    ++count;
    if (holder->moves) continue;
    of_ground += point.start;
    ++on_ground;
  }
  if (on_ground > 0) return (1.0 / on_ground) * of_ground;
  return count > 0 ? (1.0 / count) * of_all : DVec3{};
}

/// Lets the solution begin with what contacts do to each object as a whole, and to the bodies on it. Without
/// this, what rests begins with all of its stiffness against gravity, and the error that is left of that is
/// as large as the weight of a light load.
void guess_changes(const state::Tables& t, TetrahedronBlocks& tetrahedra) {
  const auto object_of = [&](std::size_t i) { return t.contacts.object[tetrahedra.pressed[i].contact]; };
  for (std::size_t i = 0; i < tetrahedra.pressed.size();) {
    const std::size_t first = i;
    while (i < tetrahedra.pressed.size() && object_of(i) == object_of(first)) ++i;
    const DVec3 mean = mean_start(tetrahedra, first, i);
    const state::Rows rows = t.objects[object_of(first)].particles;
    for (std::uint32_t p = rows.first; p < rows.end(); ++p) {
      const std::size_t own = p - tetrahedra.first_particle;
      if (!(t.particles.velocity[p].inverse_mass > Real(0)) || !(tetrahedra.volume_at[own] > Real(0)))
        continue;
      double* change = tetrahedra.stiff.change.data() + 4 * own;
      change[0] = mean.x;
      change[1] = mean.y;
      change[2] = mean.z;
    }
    for (std::size_t k = first; k < i; ++k) {
      HoldingBody* holder = tetrahedra.stiff.find_holder(tetrahedra.pressed[k].holder);
      if (holder != nullptr && holder->moves) holder->change = {mean.x, mean.y, mean.z, 0, 0, 0};
    }
  }
}

}  // namespace

void count_pressing_points(const state::Tables& t, std::span<const std::uint8_t> solved_whole, Real h,
                           std::vector<int>& shares) {
  shares.assign(t.bodies.motion.size(), 0);
  for (std::size_t row = 0; row < t.contacts.particle.size(); ++row) {
    if (solved_whole[t.contacts.object[row]] != 0) shares[t.contacts.body[row]] += presses(t, row, h);
  }
}

void note_pressed_points(const state::Tables& t, const std::vector<int>& shares, Real h,
                         TetrahedronBlocks& tetrahedra) {
  HOOKE_ASSERT(tetrahedra.pressed.empty());
  const state::Contacts& contacts = t.contacts;
  const std::uint32_t first = tetrahedra.first_particle;
  auto row =
      static_cast<std::size_t>(std::lower_bound(contacts.particle.begin(), contacts.particle.end(), first) -
                               contacts.particle.begin());
  while (row < contacts.particle.size() && contacts.particle[row] - first < tetrahedra.volume_at.size()) {
    const std::uint32_t particle = contacts.particle[row];
    const std::size_t first_row = row;
    while (row < contacts.particle.size() && contacts.particle[row] == particle) ++row;
    const Real inverse_mass = t.particles.velocity[particle].inverse_mass;
    if (!(inverse_mass > Real(0)) || !(tetrahedra.volume_at[particle - first] > Real(0))) continue;
    PressedPoint point = {.particle = particle, .contact = first_row, .inverse_mass = inverse_mass};
    hold_at_first(t, h, point);
    find_answer(t, shares, h, point);
    tetrahedra.pressed.push_back(point);
    tetrahedra.pressed_of[particle - first] = static_cast<std::uint32_t>(tetrahedra.pressed.size());
  }
  tetrahedra.stiff.holders.clear();
  list_holders(t, shares, h, tetrahedra);
  guess_changes(t, tetrahedra);
}

bool renew_pressed_points(const std::vector<int>& shares, const state::Tables& t, Real h, bool may_hold,
                          TetrahedronBlocks& tetrahedra) {
  bool any = false;
  for (PressedPoint& point : tetrahedra.pressed) {
    const std::uint32_t held = point.held;
    const std::uint32_t stuck = point.stuck;
    const Symmetric3<double> drag = point.drag;
    revise(t, h, may_hold, tetrahedra, point);
    const double size = drag.xx + drag.yy + drag.zz;
    const double change = point.drag.xx + point.drag.yy + point.drag.zz - size;
    const bool slides_alike = std::abs(change) <= kFrictionError * size;
    if (slides_alike && point.held == held && (point.stuck & point.held) == (stuck & point.held)) {
      point.drag = drag;
      continue;
    }
    find_answer(t, shares, h, point);
    any = true;
  }
  list_holders(t, shares, h, tetrahedra);
  return any;
}

void release_pressed_points(Real h, TetrahedronBlocks& tetrahedra, state::Tables& t) {
  const Real most = Real(kParticlePushOutSpeed) * h;
  for (PressedPoint& point : tetrahedra.pressed) {
    Vec3& v = t.particles.velocity[point.particle].v;
    v += vector_cast<Real>(point.change);
    for_shares(t.contacts, point, contact_impulse(point), [&](std::size_t row, DVec3 impulse) {
      if (!gives_way(t.bodies, t.contacts.body[row])) return;
      push_body(t.contacts.body[row], vector_cast<Real>(-impulse), t.contacts.lever[row], t.bodies);
    });
    tetrahedra.pressed_of[point.particle - tetrahedra.first_particle] = 0;
  }
  for (const PressedPoint& point : tetrahedra.pressed) {
    const Real deepest = -static_cast<Real>(point.yielding) * most;
    const Vec3 v = t.particles.velocity[point.particle].v;
    for_contacts(t.contacts, point, [&](std::size_t row, std::uint32_t bit) {
      Real& separation = t.contacts.separation[row];
      separation = std::max(separation, deepest);
      if ((point.held & bit) != 0) return;
      const Vec3 surface = gives_way(t.bodies, t.contacts.body[row])
                               ? velocity_now(t.bodies, t.contacts.body[row], t.contacts.lever[row]) +
                                     t.contacts.belt_velocity[row]
                               : t.contacts.surface_velocity[row];
      separation = std::max(separation, h * dot(t.contacts.normal[row], surface - v));
      t.contacts.normal_force[row] = Real(0);
      t.contacts.friction_force[row] = {};
    });
  }
}

void settle_pressed_points(Real h, TetrahedronBlocks& tetrahedra, state::Tables& t) {
  state::Contacts& contacts = t.contacts;
  for (const PressedPoint& point : tetrahedra.pressed) {
    if (point.held == 0) continue;
    const DVec3 given = contact_impulse(point);
    for_shares(contacts, point, given, [&](std::size_t row, DVec3 impulse) {
      const auto n = normal_of(contacts, row);
      const double along = dot(n, impulse);
      contacts.normal_force[row] += static_cast<Real>(along) / h;
      contacts.friction_force[row] += (Real(1) / h) * vector_cast<Real>(impulse - along * n);
    });
    if (point.holder == PressedPoint::kNone || !gives_way(t.bodies, point.holder)) continue;
    const std::size_t row = holding_contact(t, point);
    const Vec3 n = contacts.normal[row];
    Vec3& v = t.particles.velocity[point.particle].v;
    const Vec3 relative =
        v - velocity_now(t.bodies, point.holder, contacts.lever[row]) - contacts.belt_velocity[row];
    const Real along = dot(n, relative);
    const Vec3 sliding = relative - along * n;
    const Real rate = length(sliding);
    // Both yield by their masses: a light body that got all of what a heavy point lost would gain energy.
    const auto mass = [&](Vec3 direction) {
      return Real(1) /
             (point.inverse_mass + inverse_mass_at(t.bodies, point.holder, direction, contacts.lever[row]));
    };
    Vec3 impulse = mass(n) * (-along - std::max(contacts.separation[row], Real(0)) / h) * n;
    if ((point.stuck & bit_of(point, row)) != 0 && rate > Real(0))
      impulse -= mass((Real(1) / rate) * sliding) * sliding;
    v += point.inverse_mass * impulse;
    push_body(point.holder, -impulse, contacts.lever[row], t.bodies);
  }
  tetrahedra.pressed.clear();
}

}  // namespace hooke::solver
