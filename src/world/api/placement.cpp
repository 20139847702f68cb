#include "hooke/placement.h"

#include "base/float_environment.h"

#include <cmath>
#include <numbers>
#include <random>

namespace hooke {

namespace {

bool is_identity(const Placement& at) {
  return at == Placement{};
}

Quat turned(Quat own, const Placement& at) {
  const Quat unit = normalize(own);
  const Quaternion<double> q = at.rotation * Quaternion<double>{unit.x, unit.y, unit.z, unit.w};
  return {static_cast<Real>(q.x), static_cast<Real>(q.y), static_cast<Real>(q.z), static_cast<Real>(q.w)};
}

void place(std::vector<PinDesc>& pins, const Placement& at) {
  for (PinDesc& pin : pins) pin.motion = placed(pin.motion, at);
}

/// Places connection points that are given in the world's frame; those of a mesh are given in its own.
void place(std::vector<ConnectionPointDesc>& points, const Placement& at) {
  for (ConnectionPointDesc& point : points) point.position = at.point(point.position);
}

}  // namespace

WorldDesc placed(WorldDesc desc, const Placement& at) {
  const base::FloatEnvironment environment;
  if (is_identity(at)) return desc;
  desc.gravity = at.direction(desc.gravity);
  desc.wind = placed(desc.wind, at);
  return desc;
}

WindDesc placed(WindDesc desc, const Placement& at) {
  const base::FloatEnvironment environment;
  if (!is_identity(at)) desc.velocity = at.direction(desc.velocity);
  return desc;
}

MotionDesc placed(MotionDesc desc, const Placement& at) {
  const base::FloatEnvironment environment;
  if (is_identity(at)) return desc;
  desc.velocity = at.direction(desc.velocity);
  desc.amplitude = at.direction(desc.amplitude);
  for (MotionDesc::Keyframe& key : desc.keyframes) key.offset = at.direction(key.offset);
  return desc;
}

BodyDesc placed(BodyDesc desc, const Placement& at) {
  const base::FloatEnvironment environment;
  if (is_identity(at)) return desc;
  desc.position = at.point(desc.position);
  desc.rotation = turned(desc.rotation, at);
  desc.velocity = at.direction(desc.velocity);
  desc.angular_velocity = at.direction(desc.angular_velocity);
  desc.motion = placed(desc.motion, at);
  return desc;
}

RopeDesc placed(RopeDesc desc, const Placement& at) {
  const base::FloatEnvironment environment;
  if (is_identity(at)) return desc;
  desc.hook_point = at.point(desc.hook_point);
  desc.direction = at.direction(desc.direction);
  for (DVec3& point : desc.points) point = at.point(point);
  place(desc.pins, at);
  place(desc.connection_points, at);
  desc.velocity = at.direction(desc.velocity);
  return desc;
}

ClothDesc placed(ClothDesc desc, const Placement& at) {
  const base::FloatEnvironment environment;
  if (is_identity(at)) return desc;
  if (!desc.mesh) place(desc.connection_points, at);
  desc.corner = at.point(desc.corner);
  desc.column_direction = at.direction(desc.column_direction);
  desc.row_direction = at.direction(desc.row_direction);
  desc.position = at.point(desc.position);
  desc.rotation = turned(desc.rotation, at);
  place(desc.pins, at);
  desc.velocity = at.direction(desc.velocity);
  return desc;
}

SolidDesc placed(SolidDesc desc, const Placement& at) {
  const base::FloatEnvironment environment;
  if (is_identity(at)) return desc;
  desc.position = at.point(desc.position);
  desc.rotation = turned(desc.rotation, at);
  place(desc.pins, at);
  desc.velocity = at.direction(desc.velocity);
  return desc;
}

ParticlesDesc placed(ParticlesDesc desc, const Placement& at) {
  const base::FloatEnvironment environment;
  if (is_identity(at)) return desc;
  for (ParticleDesc& particle : desc.particles) {
    particle.position = at.point(particle.position);
    particle.velocity = at.direction(particle.velocity);
  }
  place(desc.pins, at);
  place(desc.connection_points, at);
  return desc;
}

HookDesc placed(HookDesc desc, const Placement& at) {
  const base::FloatEnvironment environment;
  if (is_identity(at)) return desc;
  desc.anchor = at.point(desc.anchor);
  if (desc.anchor_b) desc.anchor_b = at.point(*desc.anchor_b);
  desc.axis = at.direction(desc.axis);
  if (desc.second_axis) desc.second_axis = at.direction(*desc.second_axis);
  return desc;
}

FieldDesc placed(FieldDesc desc, const Placement& at, Vec3 gravity) {
  const base::FloatEnvironment environment;
  if (is_identity(at)) return desc;
  const DVec3 up = -1.0 * normalize(vector_cast<double>(gravity));
  desc.vector = at.direction(desc.vector);
  desc.center = at.point(desc.center);
  desc.height += dot(at.position, up);
  return desc;
}

/// The rotation is made from three uniform numbers, so that every rotation is equally likely (Shoemake,
/// Uniform random rotations, 1992).
Placement random_placement(std::uint32_t seed, Vec3 gravity) {
  const base::FloatEnvironment environment;
  std::mt19937 bits(seed);
  const auto draw = [&] { return static_cast<double>(bits()) / 4294967296.0; };
  const auto angle = [&] { return 2 * std::numbers::pi * draw(); };
  const double share = draw();
  const double first = angle();
  const double second = angle();
  const double sine = std::sqrt(1 - share);
  const double cosine = std::sqrt(share);
  Placement at = {.rotation = {sine * std::sin(first), sine * std::cos(first), cosine * std::sin(second),
                               cosine * std::cos(second)}};
  const DVec3 way = {200 * draw() - 100, 200 * draw() - 100, 200 * draw() - 100};
  const DVec3 up = normalize(at.direction(vector_cast<double>(gravity)));
  at.position = way - dot(way, up) * up;
  return at;
}

}  // namespace hooke
