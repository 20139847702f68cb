#include "fuzz/scene_checks.h"

#include "fuzz/exclusions.h"
#include "fuzz/target.h"
#include "state/check_tables.h"
#include "world/access.h"

#include <algorithm>

namespace hooke::fuzz {

namespace {

constexpr std::size_t kFewPoints = 250;

std::size_t cells_of(const SolidDesc& desc) {
  std::size_t cells = 2;
  for (const std::int32_t n : desc.cells) cells *= static_cast<std::size_t>(std::max(n, 1)) + 1;
  return cells;
}

std::size_t points_of(const SceneObjects& objects) {
  std::size_t points = 0;
  for (const SceneBody& body : objects.bodies) points += body.tag.array.count() * (1 + body.parts.size());
  for (const SceneRope& rope : objects.ropes)
    points += rope.tag.array.count() * (static_cast<std::size_t>(rope.desc.masses) + rope.desc.points.size());
  for (const SceneCloth& cloth : objects.cloths)
    points += cloth.tag.array.count() * static_cast<std::size_t>(cloth.desc.columns) *
              static_cast<std::size_t>(cloth.desc.rows);
  for (const SceneSolid& solid : objects.solids)
    points += solid.tag.array.count() * (cells_of(solid.desc) + solid.desc.points.size());
  for (const SceneParticles& particles : objects.particles)
    points += particles.tag.array.count() * particles.desc.particles.size();
  return points;
}

}  // namespace

void check_tables(const World& world) {
  const char* what = state::find_disagreement(WorldAccess::tables(world));
  if (what != nullptr) throw Failure(std::string("tables disagree: ") + what);
}

bool is_small(const Scene& scene) {
  if (!scene.meshes.empty()) return false;
  std::size_t points = points_of(scene.objects);
  for (const SceneEvent& event : scene.timeline) points += points_of(event.add);
  return points < kFewPoints && scene.world.substeps <= 16 && scene.world.particle_substeps <= 4;
}

void run_both(Scene scene, const Scene& written) {
  Loaded<Simulation> first = Simulation::create(std::move(scene));
  Loaded<Simulation> second = Simulation::create(Scene(written));
  expect(first.value.has_value() == second.value.has_value(),
         "only one of a scene and what was written of it runs");
  if (!first) return;
  for (int i = 0; i < 3; ++i) {
    const StepReport report = first.value->step();
    (void)second.value->step();
    check_tables(first.value->world());
    expect(!report.moved || kLeftOut.health_after_huge_values || report.healthy(), "an unhealthy step");
    expect(first.value->world().state_hash() == second.value->world().state_hash(),
           "moves differently from what was written of it");
  }
}

}  // namespace hooke::fuzz
