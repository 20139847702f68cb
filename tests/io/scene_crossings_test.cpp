#include "hooke/scene_io.h"

#include "validation/crossings.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <doctest/doctest.h>
#include <string>
#include <utility>
#include <vector>

/// Scenes whose cloths, jellies and ropes touch each other, judged in every frame by the checker of
/// validation/crossings.h, which shares no code with the engine. Cloths that are sewn together cross along
/// their seam: no scene here has any.

namespace hooke {
namespace {

constexpr std::array kScenes = {"balloon_burst",     "catch_net",
                                "curtain_and_ball",  "curtain_rings",
                                "cushions",          "dents",
                                "five_sheets",       "folded_blanket",
                                "hair_on_shoulders", "hammock",
                                "jelly_on_net",      "laundry_pile",
                                "noodles",           "rope_on_net",
                                "cake_and_blade",    "squash_ball",
                                "tablecloth",        "tennis_ball",
                                "trampoline",        "twisted_ribbon",
                                "jelly_on_posts",    "dumplings",
                                "balls_in_net",      "cape_and_runner",
                                "beanbag",           "trampoline_and_jelly"};
constexpr std::array kPerturbed = {"cushions", "five_sheets", "folded_blanket", "laundry_pile",
                                   "twisted_ribbon"};

/// Whether the object may cross itself, since nothing keeps it from that.
bool may_cross_itself(const Scene& scene, const SceneObject& object) {
  const std::size_t bracket = object.path.find('[');
  const auto index = static_cast<std::size_t>(std::stoul(object.path.substr(bracket + 1)));
  const std::string kind = object.path.substr(0, bracket);
  if (kind == "cloths") return !scene.objects.cloths[index].desc.self_contact;
  if (kind == "solids") return !scene.objects.solids[index].desc.self_contact;
  return false;
}

void append(const World& world, const SceneObject& object, Surfaces& to) {
  const auto first = static_cast<std::uint32_t>(to.points.size());
  const auto take = [&](const auto& points, const auto& triangles) {
    for (std::size_t i = 0; i < points.size(); ++i) to.points.push_back(points[i]);
    for (const auto& [a, b, c] : triangles) to.triangles.push_back({first + a, first + b, first + c});
  };
  if (object.kind == SceneObject::Kind::kCloth)
    take(world.positions(object.cloth), world.triangles(object.cloth));
  if (object.kind == SceneObject::Kind::kSolid)
    take(world.surface(object.solid), world.triangles(object.solid));
  to.owners.resize(to.points.size(), first);
}

/// The crossings of all cloths and solids in a frame, but for those of objects that may cross themselves.
std::size_t crossings_now(const Simulation& simulation) {
  Surfaces all;
  std::size_t own = 0;
  for (const SceneObject& object : simulation.objects()) {
    append(simulation.world(), object, all);
    if (!may_cross_itself(simulation.scene(), object)) continue;
    Surfaces alone;
    append(simulation.world(), object, alone);
    own += count_crossings(alone).crossing;
  }
  return count_crossings(all).crossing - own;
}

/// Runs a scene, turned as seed `seed` says; 0 leaves it as it is. Returns the largest number of crossings
/// that came up in a frame, those of the start left out.
std::size_t worst_crossings(const std::string& name, std::uint32_t seed, int frames) {
  auto scene = load_scene(HOOKE_SCENES "/" + name + ".json");
  REQUIRE_MESSAGE(scene, name);
  const Placement placement = seed == 0 ? Placement{} : random_placement(seed, scene.value->world.gravity);
  auto simulation = Simulation::create(std::move(*scene.value), placement);
  REQUIRE_MESSAGE(simulation, name);
  CHECK_MESSAGE(crossings_now(*simulation.value) == 0, name << " starts crossed");
  std::size_t worst = 0;
  for (int i = 0; i < frames; ++i) {
    CHECK(simulation.value->step().healthy());
    worst = std::max(worst, crossings_now(*simulation.value));
  }
  return worst;
}

}  // namespace

TEST_SUITE("io/scene_crossings") {
  TEST_CASE("intersect: nothing crosses in the first frames of scenes that touch") {
    for (const char* name : {"twisted_ribbon", "cushions"}) {
      CAPTURE(std::string(name));
      CHECK(worst_crossings(name, 0, 90) == 0);
    }
  }

  TEST_CASE("long: intersect: nothing crosses in 1000 frames of 26 scenes" * doctest::skip()) {
    for (const char* name : kScenes) {
      CAPTURE(std::string(name));
      CHECK(worst_crossings(name, 0, 1000) == 0);
    }
  }

  TEST_CASE("long: intersect: nothing crosses in five scenes, each turned in ten ways" * doctest::skip()) {
    for (const char* name : kPerturbed) {
      for (std::uint32_t seed = 1; seed <= 10; ++seed) {
        CAPTURE(std::string(name));
        CAPTURE(seed);
        CHECK(worst_crossings(name, seed, 300) == 0);
      }
    }
  }
}

}  // namespace hooke
