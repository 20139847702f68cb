#pragma once

#include "world/claim.h"
#include "world/world_data.h"

#include <cstddef>

/// \file
/// This header shows Hooke's own libraries what the API's classes keep private.

namespace hooke {

struct WorldAccess {
  /// Returns the tables of a World, or empty ones if it was moved from.
  static const state::Tables& tables(const World& world) { return world::Reading(world.data_).tables(); }
  /// For tests, which look at what a step has left, and damage it.
  static WorldData& data(World& world) { return *world.data_; }
};

/// Only this struct fills force views, so that programs cannot make one.
struct ForceViewAccess {
  static ForceView make(const state::Tables& tables, const state::Deformable& object, double time,
                        Vec3* forces) {
    const std::size_t first = object.particles.first;
    const state::Particles& p = tables.particles;
    const auto* positions = reinterpret_cast<const std::byte*>(p.position.data() + first);
    const auto* velocities = reinterpret_cast<const std::byte*>(p.velocity.data() + first);
    const std::uint32_t* row_of = p.row_of.data() + first;
    ForceView view;
    view.positions_ =
        PointView(object.origin, positions, object.particles.count, sizeof(state::PositionRecord), row_of);
    view.velocities_ =
        PointView({}, velocities, object.particles.count, sizeof(state::VelocityRecord), row_of);
    view.records_ = velocities;
    view.forces_ = forces + first;
    view.row_of_ = row_of;
    view.kind_ = object.kind;
    view.slot_ = object.slot;
    view.time_ = time;
    return view;
  }

  /// Makes the view of the bodies in `law_bodies`. It is valid during one call of a law.
  static BodyForceView make(WorldData& world, double time) {
    BodyForceView view;
    view.world_ = &world;
    view.rows_ = world.frame.law_bodies;
    view.time_ = time;
    return view;
  }
};

}  // namespace hooke
