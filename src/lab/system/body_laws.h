#pragma once

#include "lab/system/system.h"
#include "world/access.h"

#include <algorithm>

namespace hooke::lab {

/// Calls the user's force laws over bodies. Laws see all dynamic bodies, in a copy of the World and in its
/// precision. The body whose load is asked for stands where it is now. The others stand where the last call
/// of place(), at the start of their step, put them, because bodies are integrated one by one.
class BodyLaws {
 public:
  /// Returns null when there is no such law.
  static std::shared_ptr<BodyLaws> create(const state::Tables& tables) {
    const auto asks = [](const state::ForceLawEntry& entry) { return entry.body_law != nullptr; };
    const bool any = std::any_of(tables.force_laws.begin(), tables.force_laws.end(), asks);
    return any ? std::make_shared<BodyLaws>(tables) : nullptr;
  }

  explicit BodyLaws(const state::Tables& tables) {
    world_.tables = tables;
    for (const std::uint32_t row : tables.moving_bodies) {
      if (is_dynamic(tables.bodies, row)) world_.frame.law_bodies.push_back(row);
    }
  }

  [[nodiscard]] std::size_t body_count() const { return world_.frame.law_bodies.size(); }

  void place(std::uint32_t row, const BodyMotion& motion) {
    state::Bodies& bodies = world_.tables.bodies;
    const auto real = [](double value) { return static_cast<Real>(value); };
    const Quaternion<double>& q = motion.rotation;
    const Quat axes = {real(q.x), real(q.y), real(q.z), real(q.w)};
    bodies.center[row] = motion.center;
    bodies.rotation[row] = normalize(axes * conjugate(bodies.mass[row].principal));
    bodies.scale[row] = math::Symmetric3<Real>::diagonal(Real(1));
    state::MotionRecord& record = bodies.motion[row];
    record = {.inverse_mass = record.inverse_mass};
    record.v = vector_cast<Real>(motion.velocity);
    record.omega_scaled = vector_cast<Real>(motion.spin);
  }

  struct Load {
    DVec3 force = {};   ///< [N]
    DVec3 torque = {};  ///< Torque about the center, in world axes [N m].
  };

  /// Returns what all laws together do to the body of `row`.
  Load load(std::uint32_t row, double time, const BodyMotion& now) {
    state::Bodies& bodies = world_.tables.bodies;
    const DVec3 center = bodies.center[row];
    const Quat rotation = bodies.rotation[row];
    const state::MotionRecord record = bodies.motion[row];
    place(row, now);
    for (const std::uint32_t body : world_.frame.law_bodies) {
      bodies.force[body] = {};
      bodies.torque[body] = {};
    }
    BodyForceView view = ForceViewAccess::make(world_, time);
    for (const state::ForceLawEntry& entry : world_.tables.force_laws) {
      if (entry.body_law) entry.body_law(view);
    }
    bodies.center[row] = center;
    bodies.rotation[row] = rotation;
    bodies.motion[row] = record;
    return {vector_cast<double>(bodies.force[row]), vector_cast<double>(bodies.torque[row])};
  }

 private:
  WorldData world_;
};

}  // namespace hooke::lab
