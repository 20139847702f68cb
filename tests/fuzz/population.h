#pragma once

#include "hooke/world.h"

#include "fuzz/descs.h"
#include "fuzz/target.h"

#include <string>
#include <vector>

namespace hooke::fuzz {

/// What is in a world, by ids.
struct Population {
  Meshes meshes = {};
  std::vector<BodyId> bodies = {};
  std::vector<RopeId> ropes = {};
  std::vector<ClothId> cloths = {};
  std::vector<SolidId> solids = {};
  std::vector<ParticlesId> particles = {};
  std::vector<HookId> hooks = {};
  std::vector<FieldId> fields = {};
};

/// Calls visit(positions, velocities) for each deformable object.
template <class Visit>
void for_each_view(const World& world, const Population& all, Visit&& visit) {
  const auto visit_ids = [&](const auto& ids) {
    for (const auto id : ids) visit(world.positions(id), world.velocities(id));
  };
  visit_ids(all.ropes);
  visit_ids(all.cloths);
  visit_ids(all.solids);
  visit_ids(all.particles);
}

/// The value, or a failure: a description that is valid must come in.
template <class T>
T must(Result<T> result, const char* what) {
  if (!result)
    throw Failure(std::string(what) + " refused: " + result.error().where + ": " + result.error().message);
  return std::move(result).value();
}

/// A point of any object of points; a null reference where there is none.
[[nodiscard]] PointRef pick_point(Random& random, const World& world, const Population& all);

/// How fast the fastest thing is [m/s]; throws where something is not finite.
[[nodiscard]] double check_finite(const World& world, const Population& all);

}  // namespace hooke::fuzz
