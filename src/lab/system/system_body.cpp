/// Represents a rigid body as a system of two points: its center of mass and its rotation.

#include "lab/system/body_laws.h"
#include "lab/system/system.h"
#include "math/rotation.h"

#include <cmath>
#include <utility>

namespace hooke::lab {

namespace {

constexpr std::uint32_t kCenter = 0;  ///< Table rows of the system.
constexpr std::uint32_t kTurn = 1;
constexpr double kMostTurn = 8;  ///< Largest |p| after a step: 152 degrees.
constexpr double kFarTurn = 1;   ///< |p| beyond which a new chart is laid: 53 degrees.

std::array<DVec3, 3> axes_of(Quaternion<double> rotation) {
  return {rotate(rotation, DVec3{1, 0, 0}), rotate(rotation, DVec3{0, 1, 0}),
          rotate(rotation, DVec3{0, 0, 1})};
}

/// Returns the path of a kinematic body: its own, or a straight one at its present velocity.
state::Pin path_of(const state::Tables& tables, std::uint32_t row) {
  const state::Bodies& bodies = tables.bodies;
  state::Pin pin;
  if (bodies.path[row].kind != MotionDesc::Kind::kStill) {
    pin.motion = bodies.path[row];
    pin.start = bodies.path_start[row];
    pin.start_time = bodies.path_time[row];
    return pin;
  }
  pin.motion = {.kind = MotionDesc::Kind::kConstantVelocity, .velocity = bodies.motion[row].v};
  pin.start = bodies.center[row];
  pin.start_time = tables.time;
  return pin;
}

}  // namespace

System System::create_body(const state::Tables& tables, std::uint32_t row, std::shared_ptr<BodyLaws> laws) {
  const state::Bodies& bodies = tables.bodies;
  const state::BodyMass& mass = bodies.mass[row];
  const state::BodyTraits& traits = bodies.traits[row];
  System system;
  system.slot_ = bodies.slot[row];
  PointRow center = system.add_fields(tables);
  system.chart_ = math::in_double(math::in_double(bodies.rotation[row]) * math::in_double(mass.principal));
  system.start_x_ = {bodies.center[row], {}};
  const DVec3 spin = vector_cast<double>(bodies.angular_velocity[row]);
  system.start_v_ = {vector_cast<double>(bodies.motion[row].v), spin};
  system.radius_ = {static_cast<double>(traits.radius), 0};
  system.mass_ = {static_cast<double>(mass.mass), 1};
  system.pins_.resize(2);
  system.free_of_row_ = {kHeld, kHeld};
  if (traits.kind != BodyKind::kDynamic) {
    system.pins_[kCenter] = path_of(tables, row);
    system.pins_[kTurn].start_time = tables.time;
    system.kinematic_spin_ = spin;
    return system;
  }
  system.free_of_row_ = {0, 1};
  system.free_rows_ = {kCenter, kTurn};
  system.coordinates_ = 6;
  center.at = {kCenter};
  center.mass = system.mass_[kCenter];
  center.uniform +=
      (static_cast<double>(traits.gravity_scale) - 1) * vector_cast<double>(tables.desc.gravity);
  center.viscous = static_cast<double>(traits.linear_damping) * center.mass;
  system.points_ = {center};
  system.turns_ = {{.at = {kTurn},
                    .axes = axes_of(system.chart_),
                    .inertia = vector_cast<double>(mass.inertia),
                    .damping = static_cast<double>(traits.angular_damping)}};
  system.velocity_dependent_ = true;  // This is because of the gyroscopic term.
  system.body_row_ = row;
  system.body_laws_ = std::move(laws);
  if (system.body_laws_ != nullptr && system.body_laws_->body_count() > 1) {
    system.left_out_.emplace_back(
        "the motion of other bodies in force laws: they see them where the step began");
  }
  if (bodies.force[row] != Vec3{} || bodies.torque[row] != Vec3{})
    system.left_out_.emplace_back("forces of World::apply_force: they last one step of a World");
  system.add_axle(tables, row, spin);
  system.note_loads(tables, row);
  return system;
}

void System::add_axle(const state::Tables& tables, std::uint32_t row, DVec3 spin) {
  axle_ = axle_of(tables, row);
  if (axle_) {
    start_v_ = {{}, dot(axle_->axis, spin) * axle_->axis};
    // With the same moment about every axis nothing gyroscopic is left, and the moment about the axle is
    // unchanged.
    const double inertia = axle_->inertia;
    turns_[0].inertia = {inertia, inertia, inertia};
    set_load({}, {});
  } else if (is_hooked(tables, row)) {
    left_out_.emplace_back("hooks: of bodies only hinges to the world hold here, through the center of mass");
  }
}

void System::note_loads(const state::Tables& tables, std::uint32_t row) {
  const state::BodyTraits& traits = tables.bodies.traits[row];
  note_fields(tables);
  if (traits.drag_coefficient != Real(0) || traits.magnus_volume != Real(0))
    left_out_.emplace_back("air: bodies do not feel it here");
  if (traits.dipole_moment != Vec3{}) left_out_.emplace_back("dipole moments: bodies are not magnetic here");
}

BodyMotion System::body(double t, const State& y) const {
  return body_of(motion_now(t, y), t);
}

BodyMotion System::body_of(const Motion<double>& m, double t) const {
  const DVec3 p = m.x[kTurn];
  if (kinematic_spin_) {
    const DVec3 turn = (t - pins_[kTurn].start_time) * *kinematic_spin_;
    return {m.x[kCenter], normalize(math::quaternion_of(turn) * chart_), m.v[kCenter], *kinematic_spin_};
  }
  return {m.x[kCenter], normalize(rotation_of(p) * chart_), m.v[kCenter], spin_of(p, m.v[kTurn])};
}

void System::show_laws(double t, const State& y) const {
  if (body_laws_ != nullptr) body_laws_->place(body_row_, body(t, y));
}

void System::add_body_laws(double t, const Motion<double>& m, std::vector<DVec3>& accelerations) const {
  BodyLaws::Load load = body_laws_->load(body_row_, t, body_of(m, t));
  RotationRow turn = turns_[0];
  Points<double, 1> point = {.x = {m.x[kTurn]}, .v = {m.v[kTurn]}, .wind = {}};
  if (axle_) {  // The bearings take the other components.
    load = {.torque = dot(axle_->axis, load.torque) * axle_->axis};
  }
  turn.torque += load.torque;
  accelerations[kCenter] += (1 / mass_[kCenter]) * load.force;
  accelerations[kTurn] = turn.force(point)[0];
}

std::array<DVec3, 2> System::body_acceleration(double t, const State& y) const {
  const State a = acceleration(t, y);
  const Motion<double> m = motion_now(t, y);
  const DVec3 p = m.x[kTurn], rate = m.v[kTurn];
  const DVec3 second = {a[3 * kTurn], a[3 * kTurn + 1], a[3 * kTurn + 2]};
  // This is omega s = p' + p x p' / 2, differentiated.
  const DVec3 spin_up = second + 0.5 * cross(p, second) - (0.5 * dot(p, rate)) * spin_of(p, rate);
  return {DVec3{a[0], a[1], a[2]}, (1 / rotation_scale(p)) * spin_up};
}

std::vector<DVec3> System::body_positions(double t, const State& y) const {
  const BodyMotion now = body(t, y);
  std::vector<DVec3> result = {now.center};
  for (const DVec3 axis : axes_of(now.rotation)) result.push_back(now.center + radius_[kCenter] * axis);
  return result;
}

void System::set_velocity(State& y, DVec3 velocity, DVec3 spin) const {
  auto all = v(y);
  const auto turn = x(y).segment<3>(3 * kTurn);
  const DVec3 rate = rotation_rate({turn[0], turn[1], turn[2]}, spin);
  all.segment<3>(3 * kCenter) = Eigen::Vector3d(velocity.x, velocity.y, velocity.z);
  all.segment<3>(3 * kTurn) = Eigen::Vector3d(rate.x, rate.y, rate.z);
}

void System::move_center(State& y, DVec3 displacement) const {
  x(y).segment<3>(3 * kCenter) += Eigen::Vector3d(displacement.x, displacement.y, displacement.z);
}

void System::rotate_by(State& y, DVec3 turn) const {
  const BodyMotion now = body(0, y);
  auto old = x(y).segment<3>(3 * kTurn);
  const DVec3 p = {old[0], old[1], old[2]};
  // This is Rodrigues' rule for two rotations in sequence.
  const DVec3 both = (1 / (1 - 0.25 * dot(turn, p))) * (turn + p + 0.5 * cross(turn, p));
  old = Eigen::Vector3d(both.x, both.y, both.z);
  set_velocity(y, now.velocity, now.spin);
}

void System::set_load(DVec3 force, DVec3 torque) {
  if (axle_) {
    force = -points_[0].mass * points_[0].uniform;
    torque = dot(axle_->axis, torque) * axle_->axis;
  }
  for (PointRow& row : points_) row.load = force;
  for (RotationRow& row : turns_) row.torque = torque;
}

bool System::rotation_is_known(const State& y) const {
  return turns_.empty() || x(y).segment<3>(3 * kTurn).norm() <= kMostTurn;
}

bool System::lay_chart(State& y) {
  if (turns_.empty()) return false;
  const auto turn = x(y).segment<3>(3 * kTurn);
  const DVec3 p = {turn[0], turn[1], turn[2]};
  if (!(length_squared(p) > kFarTurn * kFarTurn)) return false;
  const BodyMotion now = body(0, y);
  chart_ = now.rotation;
  turns_[0].axes = axes_of(chart_);
  x(y).segment<3>(3 * kTurn).setZero();
  set_velocity(y, now.velocity, now.spin);
  return true;
}

}  // namespace hooke::lab
