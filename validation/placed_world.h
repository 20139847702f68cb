#pragma once

#include "hooke/clock.h"
#include "hooke/hooke.h"

#include <utility>
#include <vector>

namespace hooke::check {

/// A PlacedWorld is a World that a case sees in the case's own frame, wherever that frame lies in the world.
/// What is added is transformed to the world, and what is read is transformed back.
class PlacedWorld {
 public:
  PlacedWorld(World world, const Placement& at) : world_(std::move(world)), at_(at) {}

  [[nodiscard]] World& in_its_frame() { return world_; }
  [[nodiscard]] const World& in_its_frame() const { return world_; }
  [[nodiscard]] const Placement& placement() const { return at_; }

  Result<MeshId> add_mesh(const MeshDesc& desc) { return world_.add_mesh(desc); }
  Result<BodyId> add_body(const BodyDesc& desc) { return world_.add_body(placed(desc, at_)); }
  Result<RopeId> add_rope(const RopeDesc& desc) { return world_.add_rope(placed(desc, at_)); }
  Result<ClothId> add_cloth(const ClothDesc& desc) { return world_.add_cloth(placed(desc, at_)); }
  Result<SolidId> add_solid(const SolidDesc& desc) { return world_.add_solid(placed(desc, at_)); }
  Result<ParticlesId> add_particles(const ParticlesDesc& desc) {
    return world_.add_particles(placed(desc, at_));
  }
  Result<HookId> add_hook(const HookDesc& desc) { return world_.add_hook(placed(desc, at_)); }
  Result<FieldId> add_field(const FieldDesc& desc) {
    return world_.add_field(placed(desc, at_, world_.desc().gravity));
  }

  template <class IdType>
  [[nodiscard]] std::vector<DVec3> positions(IdType id) const {
    std::vector<DVec3> points = copy_points(world_.positions(id));
    for (DVec3& point : points) point = at_.own_point(point);
    return points;
  }
  template <class IdType>
  [[nodiscard]] std::vector<DVec3> velocities(IdType id) const {
    std::vector<DVec3> velocities = copy_points(world_.velocities(id));
    for (DVec3& velocity : velocities) velocity = at_.own_direction(velocity);
    return velocities;
  }
  [[nodiscard]] std::vector<DVec3> surface(SolidId id) const;
  template <class IdType>
  [[nodiscard]] auto triangles(IdType id) const {
    return world_.triangles(id);
  }
  [[nodiscard]] DVec3 center_of_mass(BodyId id) const { return at_.own_point(world_.center_of_mass(id)); }
  [[nodiscard]] DVec3 velocity(BodyId id) const { return own(world_.velocity(id)); }
  [[nodiscard]] DVec3 angular_velocity(BodyId id) const { return own(world_.angular_velocity(id)); }
  /// Returns a direction of the body's frame in the case's frame.
  [[nodiscard]] DVec3 direction(BodyId id, DVec3 of_body) const;
  [[nodiscard]] Real mass(BodyId id) const { return world_.mass(id); }
  [[nodiscard]] Real pressure(ClothId id) const { return world_.pressure(id); }
  [[nodiscard]] std::vector<Real> tensions(RopeId id) const { return world_.tensions(id); }
  [[nodiscard]] std::vector<Real> twists(RopeId id) const { return world_.twists(id); }
  [[nodiscard]] std::vector<Real> torques(RopeId id) const { return world_.torques(id); }
  [[nodiscard]] std::vector<BodyContact> body_contacts() const;
  [[nodiscard]] HookForce hook_force(HookId id) const;
  [[nodiscard]] Real hook_value(HookId id) const { return world_.hook_value(id); }
  [[nodiscard]] Real hook_gap(HookId id) const { return world_.hook_gap(id); }
  [[nodiscard]] Measurement measure() const;
  [[nodiscard]] const WorldDesc& desc() const { return world_.desc(); }

  template <class Target>
  Result<void> apply_force(Target target, Vec3 force) {
    return world_.apply_force(target, at_.direction(force));
  }
  Result<void> apply_force(BodyId body, Vec3 force, DVec3 place) {
    return world_.apply_force(body, at_.direction(force), at_.point(place));
  }
  Result<void> apply_torque(BodyId body, Vec3 torque) {
    return world_.apply_torque(body, at_.direction(torque));
  }
  template <class Target>
  Result<void> apply_impulse(Target target, Vec3 impulse) {
    return world_.apply_impulse(target, at_.direction(impulse));
  }
  template <class Target>
  Result<void> set_velocity(Target target, Vec3 velocity) {
    return world_.set_velocity(target, at_.direction(velocity));
  }
  Result<void> set_angular_velocity(BodyId body, Vec3 spin) {
    return world_.set_angular_velocity(body, at_.direction(spin));
  }
  Result<void> set_position(PointRef point, DVec3 position) {
    return world_.set_position(point, at_.point(position));
  }
  Result<void> pin(PointRef point, const MotionDesc& motion = {}) {
    return world_.pin(point, placed(motion, at_));
  }
  Result<void> set_gravity(Vec3 gravity) { return world_.set_gravity(at_.direction(gravity)); }
  Result<void> set_wind(const WindDesc& wind) { return world_.set_wind(placed(wind, at_)); }

  [[nodiscard]] Snapshot snapshot() const { return world_.snapshot(); }
  Result<void> restore(const Snapshot& snapshot) { return world_.restore(snapshot); }

 private:
  [[nodiscard]] DVec3 own(Vec3 direction) const { return at_.own_direction(vector_cast<double>(direction)); }

  World world_;
  Placement at_;
};

}  // namespace hooke::check
