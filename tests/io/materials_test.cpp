#include "hooke/scene_io.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace {

hooke::Scene scene_of(const std::string& objects) {
  auto loaded = hooke::parse_scene(R"({"version": 1, "seconds": 2, )" + objects + "}", "materials.json");
  for (const auto& error : loaded.errors) FAIL_CHECK(hooke::to_line(error));
  REQUIRE(loaded);
  CHECK(loaded.warnings.empty());
  return std::move(*loaded.value);
}

hooke::Simulation simulate(const std::string& objects) {
  auto simulation = hooke::Simulation::create(scene_of(objects));
  REQUIRE(simulation);
  return std::move(*simulation.value);
}

const hooke::SceneMaterial& material(const hooke::Scene& scene, const std::string& name) {
  const auto found = std::find_if(scene.materials.begin(), scene.materials.end(),
                                  [&](const hooke::SceneMaterial& one) { return one.name == name; });
  REQUIRE(found != scene.materials.end());
  return *found;
}

/// How far a box slides in two seconds down a plane whose slope has that tangent [m].
double slide(const std::string& box, const std::string& plane, double slope, const std::string& more = "") {
  const double angle = std::atan(slope);
  hooke::Simulation simulation =
      simulate(R"("world": {"gravity": [)" + std::to_string(9.81 * std::sin(angle)) + ", " +
               std::to_string(-9.81 * std::cos(angle)) + R"(, 0]}, "bodies": [
        {"name": "plane", "shape": {"half_space": {}}, "material": ")" +
               plane + R"("},
        {"name": "box", "kind": "dynamic", "shape": {"box": {"half_extents": [0.2, 0.05, 0.2]}},
         "position": [0, 0.05, 0], "material": ")" +
               box + "\"}]" + more);
  const hooke::BodyId id = simulation.find("box")->body;
  for (int i = 0; i < 120; ++i) simulation.step();
  return simulation.world().pose(id).position.x;
}

}  // namespace

TEST_SUITE("io/materials") {
  TEST_CASE("a body of a material has the mass of its density and volume") {
    const hooke::Simulation simulation = simulate(R"("bodies": [
      {"name": "steel", "kind": "dynamic", "shape": {"box": {"half_extents": [0.1, 0.2, 0.05]}}, "material": "steel"},
      {"name": "light", "kind": "dynamic", "shape": {"box": {"half_extents": [0.1, 0.2, 0.05]}}, "material": "steel",
       "density": 100, "position": [2, 0, 0]},
      {"name": "heavy", "kind": "dynamic", "shape": {"box": {}}, "material": "steel", "mass": 3, "position": [4, 0, 0]},
      {"name": "hammer", "kind": "dynamic", "material": "oak", "position": [6, 0, 0], "shape": {"parts": [
        {"shape": {"box": {"half_extents": [0.01, 0.1, 0.01]}}},
        {"shape": {"box": {"half_extents": [0.05, 0.02, 0.02]}}, "position": [0, 0.12, 0], "material": "steel"}]}}])");
    const auto mass = [&](const char* name) {
      return static_cast<double>(simulation.world().mass(simulation.find(name)->body));
    };
    CHECK(mass("steel") == doctest::Approx(7850 * 0.2 * 0.4 * 0.1));
    CHECK(mass("light") == doctest::Approx(100 * 0.2 * 0.4 * 0.1));
    CHECK(mass("heavy") == doctest::Approx(3));
    CHECK(mass("hammer") == doctest::Approx(750 * 0.02 * 0.2 * 0.02 + 7850 * 0.1 * 0.04 * 0.04));
  }

  TEST_CASE("ropes, cloths and solids have the weight and stiffness of their material") {
    const std::string objects = R"("ropes": [
      {"name": "hanging", "hook_point": [0, 9, 0], "length_at_rest": 5, "material": "nylon_rope"},
      {"name": "laid", "points": [[0, 5, 3], [3, 5, 3], [3, 5, 7]], "material": "nylon_rope", "radius": 0.01},
      {"name": "own", "hook_point": [9, 9, 0], "total_mass": 2, "strength": 5, "material": "nylon_rope"}],
      "cloths": [{"name": "trousers", "corner": [0, 3, 0], "width": 2, "height": 1.5, "material": "denim"},
                 {"name": "light", "corner": [5, 3, 0], "areal_density": 0.05, "material": "denim",
                  "stretch_stiffness": 700, "bend": "spring"}],
      "solids": [{"name": "jelly", "size": [0.1, 0.1, 0.1], "position": [-3, 1, 0], "material": "gelatine"},
                 {"name": "firm", "size": [0.1, 0.1, 0.1], "position": [-4, 1, 0], "young_modulus": 90000,
                  "material": "gelatine"}])";
    const hooke::Scene scene = scene_of(objects);
    const hooke::Simulation simulation = simulate(objects);
    const auto& ropes = scene.objects.ropes;
    // 94 g a meter, 12 mm, 25.2 kN; the second rope is 3 m and 4 m long.
    CHECK(static_cast<double>(simulation.world().mass(simulation.find("hanging")->rope)) ==
          doctest::Approx(0.47));
    CHECK(static_cast<double>(simulation.world().mass(simulation.find("laid")->rope)) ==
          doctest::Approx(0.658));
    CHECK(static_cast<double>(simulation.world().mass(simulation.find("own")->rope)) == doctest::Approx(2));
    CHECK(static_cast<double>(ropes[0].desc.radius) == doctest::Approx(0.006));
    CHECK(static_cast<double>(ropes[1].desc.radius) == doctest::Approx(0.01));
    CHECK(static_cast<double>(*ropes[0].desc.strength) == doctest::Approx(25200));
    CHECK(static_cast<double>(*ropes[2].desc.strength) == doctest::Approx(5));
    CHECK(static_cast<double>(simulation.world().mass(simulation.find("trousers")->cloth)) ==
          doctest::Approx(0.475 * 2 * 1.5));
    // 500 gf/cm stretch it by 5.21 %, 1.96 gf/cm shear it by a degree, and 0.174 gf cm^2/cm bend it.
    const hooke::ClothDesc& trousers = scene.objects.cloths[0].desc;
    CHECK(static_cast<double>(trousers.stretch_stiffness) ==
          doctest::Approx(490.3 / 0.0521).epsilon(0.01).scale(0));
    CHECK(static_cast<double>(trousers.shear_stiffness) ==
          doctest::Approx(1.96 * 0.980665 * 57.3).epsilon(0.01).scale(0));
    CHECK(static_cast<double>(trousers.bend_stiffness) ==
          doctest::Approx(0.174 * 9.80665e-5).epsilon(0.01).scale(0));
    CHECK(static_cast<double>(scene.objects.cloths[1].desc.areal_density) == doctest::Approx(0.05));
    // What it says itself holds, and bends by springs have another unit.
    CHECK(static_cast<double>(scene.objects.cloths[1].desc.stretch_stiffness) == doctest::Approx(700));
    CHECK(scene.objects.cloths[1].desc.bend_stiffness == hooke::ClothDesc{}.bend_stiffness);
    CHECK(static_cast<double>(simulation.world().mass(simulation.find("jelly")->solid)) ==
          doctest::Approx(1019 * 0.001));
    CHECK(static_cast<double>(scene.objects.solids[0].desc.young_modulus) == doctest::Approx(15200));
    CHECK(static_cast<double>(scene.objects.solids[1].desc.young_modulus) == doctest::Approx(90000));
    CHECK(static_cast<double>(scene.objects.solids[1].desc.poisson_ratio) == doctest::Approx(0.49));
  }

  TEST_CASE(
      "steel stays on ice below its angle of friction, and slides beyond it with a fiftieth of its weight") {
    CHECK(std::abs(slide("steel", "ice", 0.36)) < 0.01);
    // g (sin - 0.02 cos) over two seconds, at a slope of 0.42.
    const double angle = std::atan(0.42);
    const double expected = 0.5 * 9.81 * (std::sin(angle) - 0.02 * std::cos(angle)) * 4;
    CHECK(slide("steel", "ice", 0.42) == doctest::Approx(expected).epsilon(0.02));
  }

  TEST_CASE("two materials without a pair take the geometric mean of their frictions") {
    // Oak 0.3 and ice 0.03 while they slide; 0.3 is more than the pair takes at rest, sqrt(0.5 x 0.1).
    const double angle = std::atan(0.3);
    const double mean = std::sqrt(0.3 * 0.03);
    const double expected = 0.5 * 9.81 * (std::sin(angle) - mean * std::cos(angle)) * 4;
    CHECK(slide("oak", "ice", 0.3) == doctest::Approx(expected).epsilon(0.02));
  }

  TEST_CASE("a pair of the scene and a friction of its own go before the library's") {
    const std::string pair = R"(, "material_pairs": [{"a": "ice", "b": "steel", "friction": 0.6}])";
    CHECK(std::abs(slide("steel", "ice", 0.5, pair)) < 0.01);
    const std::string own = R"(, "materials": {"rough": {"like": "steel", "friction": 12}})";
    CHECK(std::abs(slide("rough", "ice", 0.5, own)) < 0.01);
    // A name without a figure of its own is the library's, and so are its pairs.
    const std::string named = R"(, "materials": {"skate": {"like": "steel", "color": [1, 0, 0]}})";
    CHECK(slide("skate", "ice", 0.42, named) > 5);
  }

  TEST_CASE("a material of the scene is its own, also under a name of the library") {
    const hooke::Scene scene = scene_of(R"("materials": {"steel": {"friction": 0.9}, "dark": {"like": "oak",
      "color": [0.1, 0.1, 0.1]}}, "bodies": [{"shape": {"box": {}}, "material": "steel"}])");
    CHECK(material(scene, "steel").metalness == 0);
    CHECK_FALSE(material(scene, "steel").density.has_value());
    CHECK(material(scene, "dark").color[0] == doctest::Approx(0.1F));
    CHECK(static_cast<double>(material(scene, "dark").friction) == doctest::Approx(0.3));
    CHECK(static_cast<double>(*material(scene, "dark").density) == doctest::Approx(750));
  }

  TEST_CASE("an unknown material is an error that names the nearest one or all") {
    const auto line = [](const std::string& objects) {
      const auto loaded = hooke::parse_scene(R"({"version": 1, )" + objects + "}", "m.json");
      REQUIRE(loaded.errors.size() == 1);
      return hooke::to_line(loaded.errors[0]);
    };
    CHECK(line(R"("ropes": [{"material": "nylon_rop"}])").find("did you mean 'nylon_rope'?") !=
          std::string::npos);
    CHECK(line(R"("ropes": [{"material": "unobtainium"}])").find("the library has brass, clay, concrete") !=
          std::string::npos);
    CHECK(line(R"("materials": {"x": {"like": "stell"}})").find("materials.x.like") != std::string::npos);
  }

  TEST_CASE("a scene with materials of the library is written so that it reads back equal") {
    const hooke::Scene scene = scene_of(R"("bodies": [
      {"shape": {"half_space": {}}, "material": "ice"},
      {"kind": "dynamic", "shape": {"box": {}}, "material": "steel", "position": [0, 2, 0]}],
      "ropes": [{"material": "steel_cable", "hook_point": [0, 9, 0]}])");
    REQUIRE(scene.material_pairs.size() == 1);
    const auto again = hooke::parse_scene(hooke::write_scene(scene), "again.json");
    REQUIRE(again);
    CHECK(*again.value == scene);
  }

  TEST_CASE("the library has what a world is made of, and a source for each figure") {
    const std::vector<std::string> names = hooke::library_materials();
    CHECK(std::is_sorted(names.begin(), names.end()));
    std::string objects;
    for (const std::string& name : names) {
      objects += (objects.empty() ? "" : ", ") +
                 std::string(R"({"kind": "dynamic", "shape": {"box": {}}, "material": ")") + name +
                 R"(", "position": [)" + std::to_string(3 * objects.size()) + ", 5, 0]}";
    }
    const hooke::Scene scene = scene_of("\"bodies\": [" + objects + "]");
    CHECK(scene.materials.size() == names.size());
    std::set<std::string> seen;
    for (const char* group : {"solids", "sheets", "ropes", "pairs"}) {
      std::ifstream file(std::string(HOOKE_MATERIALS) + "/" + group + ".json");
      REQUIRE(file);
      const nlohmann::json records = nlohmann::json::parse(file, nullptr, true, true);
      for (const auto& [name, record] : records.items()) {
        CAPTURE(name);
        REQUIRE(record.contains("source"));
        CHECK(record["source"].get<std::string>().size() > 10);
        if (records.is_object()) seen.insert(name);
      }
    }
    CHECK(seen == std::set<std::string>(names.begin(), names.end()));
  }
}
