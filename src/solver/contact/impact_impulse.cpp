#include "solver/contact/impact_impulse.h"

#include "base/assert.h"
#include "math/rotation.h"
#include "solver/body/body_motion.h"
#include "solver/contact/contact_tuning.h"
#include "solver/joint_rows/joint_rows.h"
#include "state/body_frames.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hooke::solver {

namespace {

using state::Bodies;
using state::Manifold;
using state::MotionRecord;

constexpr std::size_t kMostPoints = 32;  // of an impact

/// A body in an impact.
struct ImpactBody {
  JointBody body;  ///< Mass and inertia.
  DVec3 v = {};
  DVec3 omega = {};
  DVec3 v_before = {};
  DVec3 omega_before = {};
  /// Direction along which the body does not give way; zero: it gives way in all directions, and turns.
  DVec3 backed = {};

  [[nodiscard]] DVec3 velocity_at(DVec3 lever) const { return v + cross(omega, lever); }
  [[nodiscard]] DVec3 velocity_before_at(DVec3 lever) const { return v_before + cross(omega_before, lever); }

  /// Change of the velocity at `lever` by an impulse there.
  [[nodiscard]] DVec3 response(DVec3 lever, DVec3 impulse) const {
    if (!(body.inverse_mass > 0)) return {};
    if (!(backed == DVec3{})) return body.inverse_mass * (impulse - dot(backed, impulse) * backed);
    return body.inverse_mass * impulse + cross(body.scale * (body.scale * cross(lever, impulse)), lever);
  }

  void push(DVec3 impulse, DVec3 lever) {
    if (!(body.inverse_mass > 0)) return;
    if (!(backed == DVec3{})) {
      v += response(lever, impulse);
      return;
    }
    v += body.inverse_mass * impulse;
    omega += body.scale * (body.scale * cross(lever, impulse));
  }
};

/// The body `time` from now. A body in a gyroscopic turn has the inertia and the angular velocity of that
/// time, not the mean of the substep. With those of another time the impact would change its energy.
ImpactBody body_at_impact(const Bodies& bodies, std::uint32_t row, Real time) {
  JointBody now = joint_body_now(bodies, row);
  if (!is_moved(bodies, row)) now.inverse_mass = 0;
  const state::FreeMotionRecord motion = state::motion_before_contacts(bodies, row);
  const DVec3 v = vector_cast<double>(motion.v);
  DVec3 omega = vector_cast<double>(bodies.scale[row] * motion.omega_scaled);
  if (now.inverse_mass > 0 && state::is_gyroscopic_now(bodies, row)) {
    const Quat then = state::pose_after(bodies, row, time).rotation;
    now.scale = math::in_double(inertia_scale(bodies.mass[row], then));
    omega = now.scale * (now.scale * vector_cast<double>(bodies.angular_momentum[row]));
  }
  return {.body = now, .v = v, .omega = omega, .v_before = v, .omega_before = omega};
}

/// Offsets from the centers of mass to a point [m].
struct Levers {
  DVec3 a = {};
  DVec3 b = {};
};

struct Point {
  Levers at = {};
  DVec3 n = {};
  std::size_t lane = 0;
  double lag = 0;            ///< Speed at the time of the impact less that of now [m/s].
  double closing_speed = 0;  ///< Speed before the impact, at that time; negative [m/s].
  double target = 0;         ///< Speed of now after the impact [m/s].
  double mass = 0;           ///< Effective mass [kg].
  double impulse = 0;        ///< [N s]
};

/// Friction of a lane's points, at their middle.
struct FrictionRow {
  std::size_t lane = 0;
  Levers at = {};
  DVec3 n = {};
  DVec3 surface = {};                  ///< Velocity of B's surface relative to A's [m/s].
  math::Symmetric3<double> mass = {};  ///< Effective mass across the normal [kg].
  DVec3 before = {};                   ///< Sliding velocity before the impact [m/s].
  DVec3 impulse = {};                  ///< Impulse on B [N s].
  double friction = 0;
  double static_friction = 0;
};

DVec3 across(DVec3 n, DVec3 v) {
  return v - dot(n, v) * n;
}

/// Two bodies during their impact.
struct Impact {
  ImpactBody a;
  ImpactBody b;
  std::array<Point, kMostPoints> point_memory = {};
  std::array<FrictionRow, kMostPoints> friction_row_memory = {};
  std::size_t point_count = 0;
  std::size_t friction_row_count = 0;
  ImpactEffort effort;
  double fastest = 0;  ///< Largest closing speed of the points [m/s].

  [[nodiscard]] std::span<Point> points() { return std::span(point_memory).first(point_count); }
  [[nodiscard]] std::span<FrictionRow> friction_rows() {
    return std::span(friction_row_memory).first(friction_row_count);
  }

  [[nodiscard]] DVec3 velocity(const Levers& at) const { return b.velocity_at(at.b) - a.velocity_at(at.a); }

  /// Change of the relative velocity at a point by an impulse there.
  [[nodiscard]] DVec3 response(const Levers& at, DVec3 impulse) const {
    return b.response(at.b, impulse) + a.response(at.a, impulse);
  }

  void push(DVec3 impulse, const Levers& at) {
    a.push(-impulse, at.a);
    b.push(impulse, at.b);
  }

  [[nodiscard]] DVec3 sliding(const FrictionRow& friction_row) const {
    return across(friction_row.n, velocity(friction_row.at) + friction_row.surface);
  }
  [[nodiscard]] DVec3 sliding_before(const FrictionRow& friction_row) const {
    return across(friction_row.n, b.velocity_before_at(friction_row.at.b) -
                                      a.velocity_before_at(friction_row.at.a) + friction_row.surface);
  }
};

/// Adds the points of a lane's manifold that meet.
void add_points(const Manifold& m, std::size_t lane, double lag, Impact& impact) {
  const DVec3 n = vector_cast<double>(m.normal);
  for (int k = 0; k < m.point_count && impact.point_count < kMostPoints; ++k) {
    const state::ContactPoint& p = m.point[static_cast<std::size_t>(k)];
    const Levers at = {vector_cast<double>(p.anchor_a), vector_cast<double>(p.anchor_b)};
    const double closing_speed = dot(n, impact.velocity(at)) + lag;
    if (static_cast<double>(p.separation) > kImpactSameTimeGap || !(closing_speed < 0)) continue;
    impact.point_memory[impact.point_count++] = {
        .at = at,
        .n = n,
        .lane = lane,
        .lag = lag,
        .closing_speed = closing_speed,
        .target = -static_cast<double>(m.restitution) * closing_speed - lag,
        .mass = 1 / std::max(kLeastImpactResponse, dot(n, impact.response(at, n)))};
    impact.fastest = std::min(impact.fastest, closing_speed);
  }
}

/// Runs a Gauss-Seidel iteration. The velocities it ends with are unique, though impulses may not be.
void push_points(Impact& impact) {
  const double enough = impact.effort.converged * -impact.fastest;
  double change = -impact.fastest;
  for (int sweep = 0; sweep < impact.effort.sweeps && change > enough; ++sweep) {
    change = 0;
    for (Point& p : impact.points()) {
      const double lacks = p.target - dot(p.n, impact.velocity(p.at));
      const double after = std::max(0.0, p.impulse + p.mass * lacks);
      impact.push((after - p.impulse) * p.n, p.at);
      change = std::max(change, std::abs(after - p.impulse) / p.mass);
      p.impulse = after;
    }
  }
}

double load_of(std::size_t lane, Impact& impact) {
  double load = 0;
  for (const Point& p : impact.points()) load += p.lane == lane ? p.impulse : 0;
  return load;
}

/// Inverse of the matrix of response(), with 1 along the normal.
math::Symmetric3<double> mass_across(const Levers& at, DVec3 n, const Impact& impact) {
  const auto column = [&](DVec3 axis) {
    return across(n, impact.response(at, across(n, axis))) + dot(n, axis) * n;
  };
  const DVec3 x = column({1, 0, 0});
  const DVec3 y = column({0, 1, 0});
  const DVec3 z = column({0, 0, 1});
  return math::inverse(math::Symmetric3<double>{x.x, x.y, x.z, y.y, y.z, z.z});
}

void add_friction_row(const Manifold& m, std::size_t lane, Impact& impact) {
  const double load = load_of(lane, impact);
  if (!(load > 0) || !(std::max(m.static_friction, m.friction) > Real(0))) return;
  FrictionRow friction_row = {.lane = lane,
                              .n = vector_cast<double>(m.normal),
                              .surface = vector_cast<double>(m.surface_velocity),
                              .friction = static_cast<double>(m.friction),
                              .static_friction = static_cast<double>(m.static_friction)};
  for (const Point& p : impact.points()) {
    if (p.lane != lane) continue;
    friction_row.at.a += (p.impulse / load) * p.at.a;
    friction_row.at.b += (p.impulse / load) * p.at.b;
  }
  friction_row.mass = mass_across(friction_row.at, friction_row.n, impact);
  friction_row.before = impact.sliding_before(friction_row);
  HOOKE_ASSERT(impact.friction_row_count < kMostPoints);
  impact.friction_row_memory[impact.friction_row_count++] = friction_row;
}

void solve_friction(FrictionRow& friction_row, Impact& impact) {
  const double load = load_of(friction_row.lane, impact);
  DVec3 after = friction_row.impulse - friction_row.mass * impact.sliding(friction_row);
  after = across(friction_row.n, after);
  const double size = length(after);
  if (size > friction_row.static_friction * load) after = (friction_row.friction * load / size) * after;
  impact.push(after - friction_row.impulse, friction_row.at);
  friction_row.impulse = after;
}

/// Whether impulses do more work than rounding explains, without that of conveyors.
bool gains_energy(Impact& impact) {
  double gain = 0;
  double exchanged = 0;
  for (const Point& p : impact.points()) {
    gain += p.impulse * (p.closing_speed + dot(p.n, impact.velocity(p.at)) + p.lag);
    exchanged -= p.impulse * p.closing_speed;
  }
  for (const FrictionRow& friction_row : impact.friction_rows())
    gain += dot(friction_row.impulse, friction_row.before + impact.sliding(friction_row));
  return gain > 1e-9 * exchanged;
}

/// Adds friction, a share of what it may be. True if that gains energy.
bool add_friction(double share, Impact& impact) {
  for (FrictionRow& friction_row : impact.friction_rows()) {
    friction_row.friction *= share;
    friction_row.static_friction *= share;
  }
  for (int round = 0; impact.friction_row_count > 0 && share > 0 && round < impact.effort.friction_rounds;
       ++round) {
    for (FrictionRow& friction_row : impact.friction_rows()) solve_friction(friction_row, impact);
    push_points(impact);
  }
  return gains_energy(impact);
}

/// Changes the body's velocities, and its straight motion as if they had changed only after `time`. A body in
/// a gyroscopic turn goes on from there as a free body does, to the substep's end `rest` later. Its rotation
/// becomes the one from which a steady rotation leads to both.
void set_after_impact(const ImpactBody& after, std::uint32_t row, Real time, Real rest, Bodies& bodies) {
  if (!(after.body.inverse_mass > 0)) return;
  MotionRecord& m = bodies.motion[row];
  state::FreeMotionRecord& free = bodies.free_motion[row];
  const math::Symmetric3<double> root = math::inverse(after.body.scale);  // of the inertia
  const DVec3 turned = after.omega - after.omega_before;
  const Vec3 v = vector_cast<Real>(after.v - after.v_before);
  Vec3 turn = vector_cast<Real>(turned);
  bodies.angular_momentum[row] += vector_cast<Real>(root * (root * turned));
  if (state::is_gyroscopic_now(bodies, row)) {
    const Quat then = state::pose_after(bodies, row, time).rotation;
    const Vec3 omega = mean_velocity(bodies.mass[row], then, bodies.angular_momentum[row], rest);
    turn = omega - bodies.scale[row] * free.omega_scaled;
    bodies.rotation[row] = normalize(math::quaternion_of(-time * omega) * then);
  }
  const Vec3 omega_scaled = math::inverse(bodies.scale[row]) * turn;
  m.v += v;
  free.v += v;
  m.omega_scaled += omega_scaled;
  free.omega_scaled += omega_scaled;
  m.dx -= time * v;
  m.theta_scaled -= time * omega_scaled;
}

}  // namespace

bool apply_impact(const ImpactLanes& pair, const std::vector<Manifold>& manifolds, Real time,
                  const ContactStep& step, BodyContacts& contacts, Bodies& bodies) {
  const std::span<const ContactLane> lanes = pair.lanes;
  const Manifold& first = manifolds[lanes.front().manifold];
  Impact impact = {.a = body_at_impact(bodies, first.body_a, time),
                   .b = body_at_impact(bodies, first.body_b, time),
                   .effort = pair.in_dense_pile ? kImpactEffortInPile : kImpactEffort};
  // One of them has to give way: a backed body gives way only where the other does not. The direction is a
  // unit vector in double, lest a heavy partner give way less than rounding takes back.
  const DVec3 n = normalize(vector_cast<double>(first.normal));
  const bool a_gives_way = impact.a.body.inverse_mass > 0 && !pair.a_is_backed;
  const bool b_gives_way = impact.b.body.inverse_mass > 0 && !pair.b_is_backed;
  if (pair.a_is_backed && b_gives_way) impact.a.backed = n;
  if (pair.b_is_backed && a_gives_way) impact.b.backed = n;
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    const Manifold& m = manifolds[lanes[i].manifold];
    HOOKE_ASSERT(m.body_a == first.body_a && m.body_b == first.body_b);
    const Vec3 pull =
        free_acceleration(bodies, m.body_b, step.gravity) - free_acceleration(bodies, m.body_a, step.gravity);
    const Real lag = dot(m.normal, pull) * (time - Real(0.5) * step.h);
    add_points(m, i, static_cast<double>(lag), impact);
  }
  if (!(impact.fastest <
        -static_cast<double>(pair.in_dense_pile ? kLeastImpactSpeedInPile : kLeastImpactSpeed)))
    return false;
  push_points(impact);
  for (std::size_t i = 0; i < lanes.size() && impact.friction_row_count < kMostPoints; ++i)
    add_friction_row(manifolds[lanes[i].manifold], i, impact);
  const Impact smooth = impact;
  bool gains = add_friction(1, impact);
  for (const double share : {0.5, 0.25, 0.0}) {
    if (!gains) break;
    impact = smooth;
    gains = add_friction(share, impact);
  }
  const Real rest = std::max(Real(0), step.h - time);
  set_after_impact(impact.a, first.body_a, time, rest, bodies);
  set_after_impact(impact.b, first.body_b, time, rest, bodies);
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    Real& pushed = contacts.blocks[static_cast<std::size_t>(lanes[i].block)].pushed[lanes[i].lane];
    pushed = std::max(pushed, static_cast<Real>(load_of(i, impact)));
  }
  return true;
}

}  // namespace hooke::solver
