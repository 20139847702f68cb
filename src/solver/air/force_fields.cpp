#include "solver/air/force_fields.h"

#include "base/assert.h"
#include "elements/fields.h"
#include "math/trig.h"

#include <algorithm>
#include <numbers>

namespace hooke::solver {

namespace {

/// Turns `v` about the flux density b by the angle by which a charge of q/m turns in h.
Vec3 turn(Vec3 v, DVec3 b, double charge_per_mass, double h) {
  const double size = length(b);
  if (!(size > 0)) return v;
  const DVec3 axis = (1.0 / size) * b;
  const DVec3 d = vector_cast<double>(v);
  const math::SinCos<double> angle = math::sin_cos(-charge_per_mass * size * h);
  const DVec3 along = dot(axis, d) * axis;
  return vector_cast<Real>(along + angle.cos * (d - along) + angle.sin * cross(axis, d));
}

}  // namespace

void apply_forces(const state::Deformable& object, const ForceInputs& inputs, Real h, parallel::Range range,
                  state::Particles& particles) {
  HOOKE_ASSERT(!object.points_drag || inputs.wind.size() == particles.velocity.size());
  for (int i = range.begin; i < range.end; ++i) {
    const std::size_t p = object.particles.first + static_cast<std::size_t>(i);
    const Real w = particles.velocity[p].inverse_mass;
    if (!(w > Real(0))) continue;
    Vec3& v = particles.velocity[p].v;
    if (object.points_drag) {
      const Vec3 flow = v - inputs.wind[p].v;
      const Real drag =
          particles.viscous_drag[p] + inputs.air_density * particles.drag_area[p] * length(flow);
      v = inputs.wind[p].v + (Real(1) / (Real(1) + h * w * drag)) * flow;
    }
    if (inputs.any_force) v += (h * w) * particles.force[p];
    for (const state::Field& field : inputs.fields) {
      const DVec3 x = object.origin + vector_cast<double>(particles.position[p].x);
      v += h * vector_cast<Real>(elements::acceleration(field.desc, x));
      if (particles.charge[p] != Real(0)) {
        v = turn(v, elements::flux_density(field.desc, x),
                 static_cast<double>(particles.charge[p]) * static_cast<double>(w), static_cast<double>(h));
      }
    }
  }
}

DVec3 motion_offset(const MotionDesc& motion, double t) {
  switch (motion.kind) {
    case MotionDesc::Kind::kStill:
      return {};
    case MotionDesc::Kind::kConstantVelocity:
      return t * vector_cast<double>(motion.velocity);
    case MotionDesc::Kind::kSine: {
      const auto phase = static_cast<double>(motion.phase);
      const double turn = 2.0 * std::numbers::pi * static_cast<double>(motion.frequency_hz) * t;
      const double s = math::sin_cos(turn + phase).sin - math::sin_cos(phase).sin;
      return s * vector_cast<double>(motion.amplitude);
    }
    case MotionDesc::Kind::kKeyframes:
      break;
  }
  const auto& keys = motion.keyframes;
  if (keys.empty()) return {};
  const auto after = std::upper_bound(keys.begin(), keys.end(), t,
                                      [](double time, const auto& key) { return time < key.time; });
  if (after == keys.begin()) return vector_cast<double>(keys.front().offset);
  if (after == keys.end()) return vector_cast<double>(keys.back().offset);
  const auto before = after - 1;
  const double share = (t - before->time) / (after->time - before->time);
  const DVec3 from = vector_cast<double>(before->offset);
  return from + share * (vector_cast<double>(after->offset) - from);
}

void drive_pins(const std::vector<state::Pin>& pins, const std::vector<state::Deformable>& objects,
                double time, Real h, state::Particles& particles) {
  for (const state::Pin& pin : pins) {
    HOOKE_ASSERT(pin.object < objects.size() && pin.particle < particles.velocity.size());
    if (pin.motion.kind == MotionDesc::Kind::kStill) {
      particles.velocity[pin.particle].v = {};
      continue;
    }
    const DVec3 goal =
        pin.start + motion_offset(pin.motion, time - pin.start_time) - objects[pin.object].origin;
    const DVec3 displacement = goal - vector_cast<double>(particles.position[pin.particle].x);
    particles.velocity[pin.particle].v = vector_cast<Real>((1.0 / static_cast<double>(h)) * displacement);
  }
}

}  // namespace hooke::solver
