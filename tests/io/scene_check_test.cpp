#include "hooke/scene_io.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <filesystem>

namespace {

std::vector<std::string> scene_files() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(HOOKE_SCENES)) {
    const bool scene = entry.path().extension() == ".json" && entry.path().filename() != "schema.json";
    if (scene) files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

hooke::Simulation run(hooke::Scene scene, const hooke::Placement& placement = {}) {
  auto simulation = hooke::Simulation::create(std::move(scene), placement);
  INFO((simulation.errors.empty() ? "" : hooke::to_line(simulation.errors.front())));
  REQUIRE(simulation);
  simulation.value->run();
  return std::move(*simulation.value);
}

hooke::Scene load(const std::string& file) {
  auto scene = hooke::load_scene(file);
  INFO((scene.errors.empty() ? "" : hooke::to_line(scene.errors.front())));
  REQUIRE(scene);
  return std::move(*scene.value);
}

std::size_t bodies_of(const hooke::SceneObjects& objects) {
  std::size_t count = 0;
  for (const hooke::SceneBody& body : objects.bodies) count += body.tag.array.count();
  return count;
}

/// Scenes of more bodies than this take minutes: they have a test of their own.
bool is_large(const hooke::Scene& scene) {
  constexpr std::size_t kMany = 600;
  std::size_t count = bodies_of(scene.objects);
  for (const hooke::SceneEvent& event : scene.timeline) count += bodies_of(event.add);
  return count > kMany;
}

enum class Size { kSmall, kLarge };

/// Calls test(scene) for every scene of that size.
template <class Test>
void for_each_scene(Size size, Test&& test) {
  for (const std::string& file : scene_files()) {
    CAPTURE(file);
    hooke::Scene scene = load(file);
    if (is_large(scene) == (size == Size::kLarge)) test(std::move(scene));
  }
}

void check_promises(hooke::Scene scene, const hooke::Placement& placement = {}) {
  const hooke::Simulation done = run(std::move(scene), placement);
  INFO(done.report());
  CHECK(done.passed());
}

}  // namespace

TEST_SUITE("scenes") {
  TEST_CASE("every scene keeps what it promises") {
    for_each_scene(Size::kSmall, [](hooke::Scene scene) { check_promises(std::move(scene)); });
  }

  TEST_CASE("every scene notices when gravity is halved" * doctest::skip()) {
    for_each_scene(Size::kSmall, [](hooke::Scene scene) {
      scene.world.gravity = hooke::Real(0.5) * scene.world.gravity;
      CHECK_FALSE(run(std::move(scene)).passed());
    });
  }

  TEST_CASE("turned and moved, small scenes keep what they promise" * doctest::skip()) {
    for_each_scene(Size::kSmall, [](hooke::Scene scene) {
      const hooke::Placement placement = hooke::random_placement(2, scene.world.gravity);
      check_promises(std::move(scene), placement);
    });
  }

  TEST_CASE("the cloth slides off the ball without friction") {
    hooke::Scene scene = load(HOOKE_SCENES "/cloth_over_sphere.json");
    for (hooke::SceneMaterial& material : scene.materials) material.friction = 0;
    CHECK_FALSE(run(scene).passed());
  }

  TEST_CASE("large scenes keep what they promise" * doctest::skip()) {
    for_each_scene(Size::kLarge, [](hooke::Scene scene) { check_promises(std::move(scene)); });
  }
}
