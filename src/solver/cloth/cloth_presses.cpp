#include "solver/cloth/cloth_presses.h"

#include "base/assert.h"
#include "math/symmetric.h"
#include "solver/body/body_motion.h"
#include "solver/cloth/cloth_tuning.h"
#include "state/bodies.h"

#include <algorithm>
#include <iterator>

namespace hooke::solver {

namespace {

using math::Symmetric3;

/// (1 - n n^T) a (1 - n n^T), with s along n.
Symmetric3<double> across(const Symmetric3<double>& a, DVec3 n, double s) {
  const DVec3 t = a * n;
  const DVec3 u = t - (0.5 * (dot(n, t) + s)) * n;
  return {a.xx - 2 * n.x * u.x, a.xy - n.x * u.y - u.x * n.y, a.xz - n.x * u.z - u.x * n.z,
          a.yy - 2 * n.y * u.y, a.yz - n.y * u.z - u.y * n.z, a.zz - 2 * n.z * u.z};
}

bool is_of_cloth(const state::Tables& t, std::size_t row) {
  const state::Deformable& object = t.objects[t.contacts.object[row]];
  return object.kind == PointRef::Kind::kCloth && object.springs.count > 0 &&
         t.particles.velocity[t.contacts.particle[row]].inverse_mass > Real(0);
}

/// Which of two contacts holds a point: the higher one.
int rank_of(const ClothPress& press) {
  return (press.presses ? 1 : 0) + (press.gives_way ? 0 : 1);
}

ClothPress press_of(const state::Tables& t, std::size_t row, Real h) {
  const state::Contacts& contacts = t.contacts;
  const Vec3 n = contacts.normal[row];
  const Real closing = std::max(contacts.separation[row], Real(0)) / h;
  const Real approach =
      dot(n, contacts.surface_velocity[row] - t.particles.velocity[contacts.particle[row]].v);
  const Real most = contacts.friction[row] * contacts.normal_force[row];
  ClothPress press = {.particle = contacts.particle[row],
                      .body = contacts.body[row],
                      .normal = normalize(vector_cast<double>(n)),
                      .lever = vector_cast<double>(contacts.lever[row]),
                      .belt = vector_cast<double>(contacts.belt_velocity[row]),
                      .closing = static_cast<double>(closing),
                      .friction = static_cast<double>(contacts.friction[row]),
                      .contact = row};
  press.gives_way = state::gives_way(t.bodies, press.body);
  if (!press.gives_way) press.belt = vector_cast<double>(contacts.surface_velocity[row]);
  press.presses = contacts.normal_force[row] > Real(0) || approach > closing;
  press.slides = most > Real(0) &&
                 !(length(contacts.friction_force[row]) < static_cast<Real>(kStickingShareOnCloth) * most);
  if (!press.slides) return press;
  const Vec3 relative = t.particles.velocity[contacts.particle[row]].v - contacts.surface_velocity[row];
  const Real speed = length(relative - dot(n, relative) * n);
  press.slides = speed > Real(0);
  if (press.slides) press.drag = static_cast<double>(h * most / speed);
  return press;
}

}  // namespace

void find_cloth_presses(const state::Tables& t, Real h, std::vector<ClothPress>& presses) {
  presses.clear();
  for (std::size_t row = 0; row < t.contacts.particle.size(); ++row) {
    if (is_of_cloth(t, row)) presses.push_back(press_of(t, row, h));
  }
}

void share_out_bodies(const state::Tables& t, std::span<ClothPress> presses,
                      std::vector<std::uint32_t>& pressing) {
  pressing.clear();
  for (const ClothPress& press : presses) {
    if (press.presses && press.gives_way) pressing.push_back(press.body);
  }
  std::sort(pressing.begin(), pressing.end());
  for (ClothPress& press : presses) {
    if (!press.presses || !press.gives_way) continue;
    const auto [first, end] = std::equal_range(pressing.begin(), pressing.end(), press.body);
    const double inverse_mass = static_cast<double>(t.bodies.motion[press.body].inverse_mass);
    press.share = 1 / (static_cast<double>(end - first) * inverse_mass);
  }
}

void release_cloth_presses(std::span<const ClothPress> presses, state::Tables& t) {
  for (const ClothPress& press : presses) {
    if (press.push == DVec3{} && press.turn == DVec3{}) continue;
    push_and_turn_body(press.body, vector_cast<Real>(press.push), vector_cast<Real>(press.turn), t.bodies);
  }
}

void settle_cloth_presses(std::span<const ClothPress> presses, Real h, state::Contacts& contacts) {
  for (const ClothPress& press : presses) {
    const double along = dot(press.normal, press.impulse);
    if (!(along > 0)) continue;
    contacts.normal_force[press.contact] += static_cast<Real>(along) / h;
    contacts.friction_force[press.contact] +=
        (Real(1) / h) * vector_cast<Real>(press.impulse - along * press.normal);
  }
}

void PressingBodies::take(std::uint32_t first_particle, std::span<const ClothPress> presses,
                          const state::Tables& t, std::vector<DVec3>& velocities,
                          std::vector<double>& masses) {
  const std::size_t points = velocities.size();
  presses_.clear();
  bodies_.clear();
  is_held_ = false;
  for (const ClothPress& press : presses) {
    const std::size_t point = press.particle - first_particle;
    const std::size_t index = static_cast<std::size_t>(&press - presses.data());
    // A point is held by one body at most: by what does not give way, or by the first that presses.
    if (!presses_.empty() && presses_.back().point == point) {
      const ClothPress& other = presses_.back().of;
      if (rank_of(other) >= rank_of(press)) continue;
      presses_.pop_back();
    }
    const auto known = std::find_if(bodies_.begin(), bodies_.end(),
                                    [&](const Body& body) { return body.row == press.body; });
    const auto body = static_cast<std::size_t>(known - bodies_.begin());
    if (!press.gives_way) {
      is_held_ = is_held_ || press.presses;
    } else if (known == bodies_.end()) {
      const state::MotionRecord& motion = t.bodies.motion[press.body];
      const double mass = 1 / (press.cloths * static_cast<double>(motion.inverse_mass));
      bodies_.push_back(
          {.row = press.body, .scale = math::in_double(t.bodies.scale[press.body]), .mass = mass});
      velocities.push_back(vector_cast<double>(motion.v));
      velocities.push_back(vector_cast<double>(motion.omega_scaled));
      masses.push_back(mass);
      masses.push_back(1.0 / press.cloths);
    }
    if (press.gives_way) bodies_[body].presses = bodies_[body].presses || press.presses;
    const bool sticks = press.friction > 0 && !press.slides;
    presses_.push_back({.of = press,
                        .index = index,
                        .point = point,
                        .row = press.gives_way ? points + 2 * body : kHeld,
                        .body = body,
                        .touch = !press.presses ? Touch::kFree
                                 : sticks       ? Touch::kSticks
                                                : Touch::kSlides,
                        .drag = press.drag});
  }
}

double PressingBodies::mass() const {
  double sum = 0;
  for (const Body& body : bodies_) sum += body.presses ? body.mass : 0;
  return sum;
}

/// How the body of a press moves at the point, by its two vectors.
DVec3 PressingBodies::motion_at(const Press& press, std::span<const DVec3> of) const {
  if (press.row == kHeld) return {};
  return of[press.row] + cross(bodies_[press.body].scale * of[press.row + 1], press.of.lever);
}

/// Velocity of the point across the normal, relative to the surface [m/s].
DVec3 PressingBodies::sliding(const Press& press, std::span<const DVec3> velocities) const {
  const DVec3 n = press.of.normal;
  const DVec3 relative = velocities[press.point] - motion_at(press, velocities) - press.of.belt;
  return relative - dot(n, relative) * n;
}

void PressingBodies::push_body(const Press& press, DVec3 impulse, std::span<DVec3> impulses) const {
  if (press.row == kHeld) return;
  impulses[press.row] += impulse;
  impulses[press.row + 1] += bodies_[press.body].scale * cross(press.of.lever, impulse);
}

void PressingBodies::follow(std::span<DVec3> changes) const {
  for (const Press& press : presses_) {
    if (press.touch == Touch::kFree) continue;
    const DVec3 along = motion_at(press, changes);
    DVec3& own = changes[press.point];
    own = press.touch == Touch::kSticks ? along : own + dot(press.of.normal, along - own) * press.of.normal;
  }
}

void PressingBodies::move_along(std::span<DVec3> velocities) const {
  for (const Press& press : presses_) {
    if (press.touch == Touch::kFree) continue;
    const DVec3 n = press.of.normal;
    const DVec3 along = motion_at(press, velocities) + press.of.belt - press.of.closing * n;
    DVec3& own = velocities[press.point];
    own = press.touch == Touch::kSticks ? along : own + dot(n, along - own) * n;
  }
}

void PressingBodies::gather(std::span<DVec3> impulses) const {
  for (const Press& press : presses_) {
    if (press.touch == Touch::kFree) continue;
    DVec3& own = impulses[press.point];
    const DVec3 part = press.touch == Touch::kSticks ? own : dot(press.of.normal, own) * press.of.normal;
    push_body(press, part, impulses);
    own -= part;
  }
}

void PressingBodies::restrict_resistances(std::span<Symmetric3<double>> resistances) const {
  for (const Press& press : presses_) {
    if (press.touch == Touch::kFree) continue;
    const DVec3 n = press.of.normal;
    Symmetric3<double>& own = resistances[press.point];
    const Symmetric3<double> felt =
        press.touch == Touch::kSticks ? own : math::axial(n, dot(n, own * n), 0.0);
    own = across(own, n, own.xx + own.yy + own.zz);
    if (press.row == kHeld) continue;
    resistances[press.row] = resistances[press.row] + felt;
    const Symmetric3<double>& scale = bodies_[press.body].scale;
    const auto turned = [&](DVec3 axis) {
      return scale * cross(press.of.lever, felt * cross(scale * axis, press.of.lever));
    };
    const DVec3 x = turned({1, 0, 0});
    const DVec3 y = turned({0, 1, 0});
    const DVec3 z = turned({0, 0, 1});
    resistances[press.row + 1] =
        resistances[press.row + 1] + Symmetric3<double>{x.x, x.y, x.z, y.y, y.z, z.z};
  }
}

double PressingBodies::friction_energy(std::span<const DVec3> velocities) const {
  double sum = 0;
  for (const Press& press : presses_) {
    if (press.touch == Touch::kSlides) sum += 0.5 * press.drag * length_squared(sliding(press, velocities));
  }
  return sum;
}

void PressingBodies::add_friction(std::span<const DVec3> velocities, std::span<DVec3> impulses,
                                  std::span<Symmetric3<double>> resistances) const {
  for (const Press& press : presses_) {
    if (press.touch != Touch::kSlides) continue;
    const DVec3 impulse = -press.drag * sliding(press, velocities);
    impulses[press.point] += impulse;
    push_body(press, -impulse, impulses);
    resistances[press.point] = resistances[press.point] + math::axial(press.of.normal, 0.0, press.drag);
  }
}

void PressingBodies::resist(std::span<const DVec3> changes, std::span<DVec3> impulses) const {
  for (const Press& press : presses_) {
    if (press.touch != Touch::kSlides) continue;
    const DVec3 relative = changes[press.point] - motion_at(press, changes);
    const DVec3 impulse = press.drag * (relative - dot(press.of.normal, relative) * press.of.normal);
    impulses[press.point] += impulse;
    push_body(press, -impulse, impulses);
  }
}

/// As the public one, for one press.
bool PressingBodies::renew(Press& press, std::span<const DVec3> velocities, DVec3 residual,
                           double resistance) const {
  const DVec3 n = press.of.normal;
  const double push = -dot(n, residual);
  if (press.touch == Touch::kFree) {
    const DVec3 surface = motion_at(press, velocities) + press.of.belt;
    if (!(dot(n, velocities[press.point] - surface) < -press.of.closing)) return false;
    press.touch = press.of.friction > 0 ? Touch::kSticks : Touch::kSlides;
    press.drag = 0;
    return true;
  }
  if (push < 0) {
    press.touch = Touch::kFree;
    return true;
  }
  const double most = press.of.friction * push;
  if (press.touch == Touch::kSticks) {
    // What friction lacks moves the point against its resistance.
    const double lacking = length(residual + push * n) - most;
    if (!(lacking > 0)) return false;
    press.touch = Touch::kSlides;
    press.drag = most * resistance / lacking;
    return true;
  }
  const double speed = length(sliding(press, velocities));
  if (most > kMostDragOnCloth * resistance * speed) {
    press.touch = Touch::kSticks;
    return press.of.friction > 0;
  }
  const double drag = speed > 0 ? most / speed : 0;
  if (std::abs(press.drag - drag) <= kFrictionErrorOnCloth * drag) return false;
  press.drag = drag;
  return true;
}

bool PressingBodies::renew(std::span<const DVec3> velocities, std::span<const DVec3> residual,
                           std::span<const Symmetric3<double>> resistances) {
  bool any = false;
  for (Press& press : presses_) {
    const Symmetric3<double>& own = resistances[press.point];
    const double resistance = (own.xx + own.yy + own.zz) / 3;
    any = renew(press, velocities, residual[press.point], resistance) || any;
  }
  return any;
}

void PressingBodies::note_impulses(std::span<const DVec3> velocities, std::span<const DVec3> before,
                                   std::span<const DVec3> residual, bool is_solved,
                                   std::span<ClothPress> presses) {
  is_noted_.assign(bodies_.size(), 0);
  held_.assign(bodies_.size(), 0);
  for (const Press& press : presses_) {
    if (press.row != kHeld) held_[press.body] += press.touch != Touch::kFree;
  }
  for (const Press& press : presses_) {
    DVec3 push;
    if (press.row != kHeld) {
      const Body& body = bodies_[press.body];
      push = body.mass * (velocities[press.row] - before[press.row]);
      if (is_noted_[press.body] == 0) {
        const DVec3 turned = velocities[press.row + 1] - before[press.row + 1];
        presses[press.index].push = push;
        presses[press.index].turn = (1.0 / press.of.cloths) * (math::inverse(body.scale) * turned);
        is_noted_[press.body] = 1;
      }
    }
    if (press.touch == Touch::kFree) continue;
    const DVec3 n = press.of.normal;
    const bool shares = !is_solved && press.row != kHeld;
    const DVec3 given = shares ? (-1.0 / held_[press.body]) * push : -residual[press.point];
    const double along = std::max(dot(n, given), 0.0);
    const DVec3 friction =
        press.touch == Touch::kSticks ? given - dot(n, given) * n : -press.drag * sliding(press, velocities);
    const double most = press.of.friction * along;
    const double size = length(friction);
    presses[press.index].impulse = along * n + (size > most ? most / size : 1.0) * friction;
  }
}

}  // namespace hooke::solver
