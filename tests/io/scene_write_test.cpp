#include "hooke/scene_io.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

namespace {

const std::filesystem::path kScenes = HOOKE_SCENES;

std::string read(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

std::vector<std::filesystem::path> scene_files() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kScenes)) {
    const bool scene = entry.path().extension() == ".json" && entry.path().filename() != "schema.json";
    if (scene) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// What the schema says against a text; empty if nothing.
std::string schema_complaint(const std::string& text) {
  const nlohmann::json schema_json = nlohmann::json::parse(hooke::scene_schema());
  const valijson::adapters::NlohmannJsonAdapter schema_adapter(schema_json);
  valijson::Schema schema;
  valijson::SchemaParser().populateSchema(schema_adapter, schema);
  const nlohmann::json document = nlohmann::json::parse(text, nullptr, true, true);
  const valijson::adapters::NlohmannJsonAdapter adapter(document);
  valijson::ValidationResults results;
  if (valijson::Validator().validate(schema, adapter, &results)) return "";
  valijson::ValidationResults::Error error;
  std::string complaint;
  while (results.popError(error)) {
    for (const std::string& step : error.context) complaint += step;
    complaint += ": " + error.description + "; ";
  }
  return complaint.empty() ? "not valid" : complaint;
}

/// A scene that uses everything the format has, away from the defaults.
constexpr const char* kEverything = R"({
  "version": 1, "title": "All \"keys\"\nand \u00e9", "description": "d", "dt": 0.004, "seconds": 3,
  "accuracy": {"max_error": 2e-4},
  "laboratory": {"stepper": "verlet", "collider": "faces", "preselection": "sphere_tree", "mesh_search": "all", "rollback": "backward",
                 "sweep": "extruded", "epsilon": 1e-3, "iteration_limit": 5, "regional": false},
  "world": {"gravity": [1, -2, 3], "substeps": 2, "particle_substeps": 3, "workers": 2,
    "contact_hz": 50, "contact_damping_ratio": 6, "bias_sweeps": 2, "sleeping": false,
    "wind": {"velocity": [1, 0, 0.1], "gust": 0.5, "side_gust": 0.25, "correlation_time": 0.7,
             "correlation_length": 3, "seed": 7, "gusts": "paper", "air_density": 1.1}},
  "meshes": {"file": {"file": "a/b.obj", "up": "x", "scale": 0.001},
             "fit": {"file": "c.3ds", "fit": 0.4, "origin": "bottom", "voxel_size": 0.01, "tree": "planes"},
             "inline": {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]],
                        "connection_points": {"tip": 2, "middle": [0.25, 0.25, 0]}}},
  "materials": {"silk": {"color": [0.1, 0.2, 0.3], "texture": "t.png", "normal_map": "n.png", "normal_scale": 2, "roughness_map": "r.png", "shininess": 3, "opacity": 0.5,
                         "friction": 0.9, "static_friction": 1, "restitution": 0.25, "rolling_friction": 0.001,
                         "spinning_friction": 0.002}, "plain": {},
                "unused": {"like": "cotton", "color": [0.5, 0.25, 0.125], "metalness": 0.5, "roughness": 0.25,
                           "transmission": 0.125, "sheen": 0.75, "thread_pitch": 0.001, "hair": true, "tiles": 0.5, "density": 900,
                           "young_modulus": 5000, "poisson_ratio": 0.25, "areal_density": 0.3,
                           "stretch_stiffness": 5000, "shear_stiffness": 50, "bend_stiffness": 0.0001,
                           "linear_density": 0.05, "diameter": 0.02, "strength": 100,
                           "yields": {"impulse": 10, "yield_stress": "rigid"}}},
  "material_pairs": [{"a": "silk", "b": "plain", "friction": 0.3, "static_friction": 0.4, "restitution": 0.75}],
  "bodies": [
    {"name": "ground", "material": "silk", "shape": {"half_space": {}}, "friction": 0.25, "visual": "file",
     "connection_points": {"drain": [1, 0, 2]}},
    {"shape": {"sphere": {"radius": 0.3}}, "position": [1, 2, 3], "rotation": [0, 0, 1, 0], "collides": false,
     "array": {"grid": [2, 3, 4], "spacing": [1, 0.5, 0.25]}},
    {"shape": {"box": {"half_extents": [1, 2, 3]}}, "array": {"pyramid": 4, "spacing": [1, 1, 1.5]}},
    {"shape": {"box": {}}, "array": {"random": 5, "seed": 9, "box": [[-1, -1, -1], [1, 2, 3]]}},
    {"shape": {"mesh": "inline"}},
    {"name": "top", "kind": "dynamic", "shape": {"cone": {"radius": 0.25, "half_height": 1}}, "velocity": [1, 2, 3],
     "angular_velocity": [3, 2, 1], "density": 500, "linear_damping": 0.1, "angular_damping": 0.2,
     "gravity_scale": 0.5, "drag_coefficient": 0.5, "magnus_coefficient": 0.75, "dipole_moment": [1, 2, 3], "category": 2, "mask": 5, "group": -1, "bullet": true, "can_sleep": false,
     "array": {"list": [[0, 0, 0], [1, 0.5, 0]], "rotations": [[0, 0, 1, 0], [0, 1, 0, 0]]}},
    {"kind": "dynamic", "mass": 3, "shape": {"parts": [
      {"shape": {"capsule": {"radius": 0.1, "half_height": 0.25}}, "position": [1, 0, 0], "rotation": [1, 0, 0, 0],
       "density": 700, "material": "plain"},
      {"shape": {"cylinder": {"half_height": 2}}}, {"shape": {"box": {"half_extents": [1, 2, 3]}}},
      {"shape": {"sphere": {"radius": 2}}}, {"shape": {"hull": "inline"}}]}},
    {"kind": "kinematic", "shape": {"hull": "inline"}, "surface_velocity": [0, 0, 1], "motion": {"velocity": [0, 1, 0]},
     "blade": {"edge": [[-0.5, 0, 0], [0.5, 0, 0]], "cuts": ["rope"]}},
    {"name": "glass", "kind": "dynamic", "shape": {"box": {}}, "fracture": {"cells": 5, "seed": 8, "impact": [0.1, 0, 0], "impact_radius": 0.1,
     "least_share": 0.1, "least_face": 0.2, "strength": 5000}},
    {"kind": "dynamic", "shape": {"box": {}}, "fracture": {"seeds": [[0, 0, 0], [0.5, 0, 0]], "strength": "rigid"}},
    {"kind": "dynamic", "shape": {"box": {}}, "section": {"area": 0.01, "second_moment": 1e-5, "young_modulus": 2e11, "yield_stress": 2e8, "length_factor": 0.7}},
    {"kind": "dynamic", "shape": {"box": {}}, "section": {"radius": 0.05, "thickness": 0.01}},
    {"kind": "dynamic", "shape": {"box": {}}, "section": {"width": 0.05, "height": 0.125}},
    {"name": "door", "kind": "dynamic", "shape": {"box": {}}, "yields": {"impulse": 50, "cell": 0.2, "young_modulus": 2e6,
     "poisson_ratio": 0.25, "damping": 0.01, "yield_stress": 2e4, "thickness": 0.003, "freeze_below": 0.02, "freeze_after": 0.5}},
    {"shape": {"capsule": {}}, "sensor": true}, {"shape": {"cylinder": {}}}],
  "ropes": [
    {"name": "rope", "stepper": "verlet", "hook_point": [0, 3, 0], "direction": [0, -1, 0], "total_mass": 2,
     "masses": 9,
     "length_at_rest": 2, "stiffness": 1000, "inner_friction": 0.1, "air_friction": 0.2, "extension_max": 0.05, "strength": 700,
     "stiffness_of": "segment", "axial_stiffness": 500, "bend_stiffness": 0.5, "touches_ropes": true, "touches_surfaces": true,
     "repulsion_strength": 2e-7, "repulsion_range": 0.02, "twist_stiffness": 0.4,
     "twist": 3, "young_modulus": 1e9, "poisson_ratio": 0.25, "radius": 0.01, "drag_coefficient": 1, "charge": 1e-6,
     "velocity": [0, 0, 1], "loads": [{"point": 3, "mass": 0.5}, {"point": "last", "mass": 0}],
     "pins": [0, {"point": "last", "motion": {"velocity": [0, 1, 0]}},
              {"point": 2, "motion": {"sine": {"amplitude": [0, 1, 0], "frequency_hz": 2, "phase": 0.5}}},
              {"topmost": 0.1, "motion": {"keyframes": [{"time": 0, "offset": [0, 0, 0]},
                                                        {"time": 1, "offset": [0, 1, 0]}]}}]},
    {"points": [[0, 0, 0], [1, 0, 0], [1, 1, 0]], "pins": []}],
  "cloths": [
    {"name": "cloth", "columns": 4, "rows": 3, "corner": [0, 1, 0], "column_direction": [0, 0, 1],
     "row_direction": [1, 0, 0], "width": 2, "height": 3, "areal_density": 0.3, "thickness": 0.01,
     "stretch_stiffness": "rigid", "shear_stiffness": 150, "bend_stiffness": 0.5, "damping": 0.1,
     "bend_damping": 0.2, "yield_angle": 0.3, "bend": "none", "extension_max": 0.1, "strength": 50, "tear_strain": 0.2, "tethers": true, "self_contact": true,
     "pressure": 500, "drag_coefficient": 1,
     "lift_coefficient": 0, "air_friction": 0.1, "pins": [{"column": "last"}, {"row": 1}, {"topmost": 0}],
     "loads": [{"point": 1, "mass": 1}], "charge": 1, "velocity": [1, 0, 0]},
    {"mesh": "inline", "position": [0, 1, 0], "rotation": [1, 0, 0, 0], "total_mass": 1}],
  "particles": [{"name": "net", "particles": [
      {"position": [0, 0, 0], "velocity": [1, 0, 0], "mass": 2, "charge": 1, "radius": 0.1},
      {"position": [1, 0, 0]}], "springs": [{"a": 0, "b": 1, "stiffness": 5, "damping": 1, "rest_length": 2}],
     "direction": "predicted", "damping": "isotropic", "air_friction": 0.1, "drag_coefficient": 0.4, "pins": [1]}],
  "fields": [{"name": "up", "uniform": {"acceleration": [0, 1, 0]}},
             {"inverse_square": {"center": [0, 1, 0], "strength": 2}}, {"magnetic": {"flux_density": [0, 0, 1], "gradient": 0.5, "center": [0, 2, 0]}},
             {"liquid": {"height": 0.5, "density": 900, "drag": 2, "flow": [1, 0, 0]}},
             {"suction": {"strength": 3, "reach": 2, "falloff": 2}},
             {"vortex": {"axis": [0, 1, 0], "strength": 3, "reach": 2}},
             {"explosion": {"center": [1, 0, 0], "time": 0.5, "strength": 3, "reach": 2, "falloff": 0}},
             {"dipole": {"center": [0, 1, 0], "moment": [0, 0, 4]}}],
  "hooks": [
    {"name": "hook", "kind": "wheel", "a": "ground", "b": "top[0]", "anchor": [1, 2, 3], "axis": [0, 0, 1],
     "second_axis": [1, 0, 0], "limits": {"lower": -0.5}, "cone": 1.5, "spring": {"stiffness": 5, "damping": 2,
     "target": 0.5}, "motor": {"speed": 3, "max_force": 4}, "break_force": 9, "break_torque": 8, "collide": true,
     "steering": {"locked": false, "limits": {"lower": -1, "upper": 1}, "motor": {"max_force": 0.5}}},
    {"kind": "distance", "b": "top", "anchor": [0, 0, 0], "anchor_b": [0, 1, 0], "limits": {"upper": 2},
     "array": {"grid": [2, 1, 1], "spacing": [1, 2, 1]}},
    {"kind": "six_degrees", "b": "top[1]", "anchor": [0, 0, 0], "freedoms": [{"locked": true}, {"locked": false},
     {"locked": false, "limits": {"upper": 1}}, {"locked": true, "spring": {"target": 0.25}}, {"locked": false},
     {"locked": false, "spring": {"stiffness": 2}}]},
    {"kind": "rope_slide", "a": "rope", "a_point": 1, "b": "jelly", "b_point": "last"}],
  "seams": [
    {"name": "seam", "a": "cloth.left", "b": "jelly", "b_points": [0, 1, 2], "strength": 400},
    {"a": "cloth", "a_points": [0, 1], "b": "cloth.right",
     "array": {"grid": [2, 1, 1], "spacing": [1, 2, 1]}}],
  "solids": [
    {"mesh": "inline", "visual": "fit"},
    {"name": "jelly", "cells": [2, 3, 4], "size": [0.5, 1, 2], "young_modulus": 20000, "poisson_ratio": 0.25,
     "damping": 0.0625, "elasticity": "shape_matching", "match_hz": 5, "match_damping_ratio": 0.5, "yield_stress": 500, "strength": 600, "thickness": 0.25, "self_contact": true, "category": 2, "mask": 6, "group": -1,
     "pins": [{"topmost": 0.5}]},
    {"mesh": "inline", "cell": 0.25, "position": [0, 4, 0], "total_mass": 2}],
  "timeline": [
    {"at_step": 1, "add": {"ropes": [{"name": "late"}], "bodies": [{"shape": {"sphere": {"radius": 0.1}}}]}},
    {"at_step": 2, "remove": "late"},
    {"at_step": 3, "motion": {"object": "rope", "point": "last", "motion": {"velocity": [1, 0, 0]}}},
    {"at_step": 4, "unpin": {"object": "cloth", "point": 2}},
    {"at_step": 5, "force": {"object": "net", "point": 0, "force": [1, 2, 3], "steps": 4}},
    {"at_step": 6, "impulse": {"object": "rope", "point": 1, "impulse": [1, 2, 3]}},
    {"at_step": 6, "impulse": {"object": "top[1]", "at": [1, 2, 3], "impulse": [0, 1, 0]}},
    {"at_step": 6, "force": {"object": "top[0]", "at": [3, 2, 1], "force": [0, 1, 0]}},
    {"at_step": 6, "velocity": {"object": "top[1]", "velocity": [1, 0, 0], "angular_velocity": [0, 2, 0]}},
    {"at_step": 6, "velocity": {"object": "rope", "point": 1, "velocity": [1, 0, 0]}},
    {"at_step": 6, "motor": {"object": "hook", "speed": 2, "max_force": 3}},
    {"at_step": 6, "spring": {"object": "hook", "stiffness": 7, "damping": 2, "target": 0.25}},
    {"at_step": 6, "steering": {"object": "hook", "angle": 0.5}},
    {"at_step": 7, "wind": {"velocity": [2, 0, 0]}},
    {"at_step": 8, "gravity": [0, -1, 0]}],
  "camera": {"eye": [1, 2, 3], "target": [3, 2, 1], "fov_deg": 60,
             "path": [{"time": 0, "eye": [0, 0, 0], "target": [1, 1, 1]},
                      {"time": 2.5, "eye": [0, 1, 0], "target": [1, 1, 1]}]},
  "sky": {"brightness": 0.5, "sun": 2, "sun_direction": [0, -1, -1], "sun_color": [1, 0.5, 0.25]},
  "lights": [
    {"kind": "spot", "position": [1, 2, 3], "direction": [0, -1, 1], "color": [1, 0.5, 0.25], "intensity": 4,
     "inner_deg": 12, "outer_deg": 15, "shadows": false},
    {"kind": "directional", "direction": [1, -1, 0]}],
  "expect": [
    {"quantity": "height", "of": "rope", "point": "last", "op": "==", "value": 1.5, "tolerance": 0.01},
    {"quantity": "tension", "of": "rope", "op": "within", "value": 10, "tolerance": 0.1, "at_step": 5},
    {"quantity": "tilt", "of": "top[0]", "op": "<", "value": 5},
    {"quantity": "angular_speed", "of": "top[1]", "op": ">", "value": 1}, {"quantity": "asleep", "op": ">=", "value": 1},
    {"quantity": "force", "of": "hook", "op": "<", "value": 2}, {"quantity": "gap", "op": "<", "value": 1},
    {"quantity": "total_energy", "op": "<=", "value": 12}]
})";

}  // namespace

TEST_SUITE("io/scene_write") {
  TEST_CASE("a scene that uses everything comes back equal") {
    const auto loaded = hooke::parse_scene(kEverything, "all.json");
    INFO((loaded.errors.empty() ? "" : hooke::to_line(loaded.errors.front())));
    REQUIRE(loaded);
    const std::string text = hooke::write_scene(*loaded.value);
    const auto again = hooke::parse_scene(text, "all.json");
    INFO((again.errors.empty() ? "" : hooke::to_line(again.errors.front())));
    REQUIRE(again);
    CHECK(*again.value == *loaded.value);
    CHECK(hooke::write_scene(*again.value) == text);
    CHECK(schema_complaint(kEverything).empty());
    CHECK(schema_complaint(text).empty());
  }

  TEST_CASE("a scene without defaults is written as it was read") {
    const auto loaded = hooke::parse_scene(kEverything, "all.json");
    REQUIRE(loaded);
    const nlohmann::json written = nlohmann::json::parse(hooke::write_scene(*loaded.value));
    CHECK(nlohmann::json::diff(nlohmann::json::parse(kEverything), written).dump() == "[]");
  }

  TEST_CASE("the scene that uses everything does use every key") {
    const nlohmann::json schema = nlohmann::json::parse(hooke::scene_schema());
    for (const auto& [kind, definition] : schema["definitions"].items()) {
      if (kind == "rotation") continue;  // always written as a quaternion
      for (const auto& property : definition["properties"].items()) {
        const std::string& key = property.key();
        CAPTURE(key);
        const bool used = std::string_view(kEverything).find('"' + key + '"') != std::string_view::npos;
        CHECK((used || key == "$schema"));
      }
    }
  }

  TEST_CASE("a change of any value makes scenes unequal") {
    const auto loaded = hooke::parse_scene(kEverything, "all.json");
    REQUIRE(loaded);
    hooke::Scene other = *loaded.value;
    CHECK(other == *loaded.value);
    other.objects.ropes[0].pins[2].motion.phase += 1;
    CHECK_FALSE(other == *loaded.value);
    other = *loaded.value;
    other.objects.bodies[6].parts[1].desc.shape.half_height += 1;
    CHECK_FALSE(other == *loaded.value);
    other = *loaded.value;
    other.objects.bodies[5].tag.array.rotations.pop_back();
    CHECK_FALSE(other == *loaded.value);
  }

  TEST_CASE("a negative zero keeps its sign, also where the default is zero") {
    hooke::Scene scene;
    scene.world.gravity = {-0.0f, -9.81f, 0};
    scene.objects.bodies.push_back({.desc = {.position = {-0.0, 0, -0.0}}});
    const auto again = hooke::parse_scene(hooke::write_scene(scene), "zero.json");
    REQUIRE(again);
    CHECK(std::signbit(again.value->world.gravity.x));
    CHECK_FALSE(std::signbit(again.value->world.gravity.z));
    const hooke::DVec3 position = again.value->objects.bodies[0].desc.position;
    CHECK(std::signbit(position.x));
    CHECK_FALSE(std::signbit(position.y));
    CHECK(std::signbit(position.z));
    CHECK(*again.value == scene);
    scene.world.gravity.x = 0;
    CHECK_FALSE(*again.value == scene);
  }

  TEST_CASE("the largest number there is comes back, and one of the next power of two does not") {
    hooke::Scene scene;
    scene.world.gravity = {-std::numeric_limits<hooke::Real>::max(), 0, 0};
    const auto again = hooke::parse_scene(hooke::write_scene(scene), "most.json");
    REQUIRE(again);
    CHECK(again.value->world.gravity == scene.world.gravity);
    CHECK_FALSE(
        hooke::parse_scene(R"({"version": 1, "world": {"gravity": [3.40283e38, 0, 0]}})", "more.json"));
  }

  TEST_CASE("an empty scene is written as its version alone") {
    CHECK(hooke::write_scene({}) == "{\n  \"version\": 1\n}\n");
  }

  TEST_CASE("the starter scenes are valid and come back equal") {
    for (const char* kind : {"empty", "rope", "flag"}) {
      CAPTURE(kind);
      const std::string text = *hooke::starter_scene(kind);
      const auto loaded = hooke::parse_scene(text, "new.json");
      REQUIRE(loaded);
      const auto again = hooke::parse_scene(hooke::write_scene(*loaded.value), "new.json");
      REQUIRE(again);
      CHECK(*again.value == *loaded.value);
      CHECK(schema_complaint(text).empty());
    }
    CHECK_FALSE(hooke::starter_scene("car").has_value());
  }

  TEST_CASE("every scene of the collection is valid and comes back equal") {
    REQUIRE(scene_files().size() >= 12);
    for (const auto& file : scene_files()) {
      CAPTURE(file);
      const auto loaded = hooke::parse_scene(read(file), file.string());
      INFO((loaded.errors.empty() ? "" : hooke::to_line(loaded.errors.front())));
      REQUIRE(loaded);
      CHECK_FALSE(loaded.value->expect.empty());
      CHECK(loaded.value->camera.has_value());
      const auto again = hooke::parse_scene(hooke::write_scene(*loaded.value), file.string());
      REQUIRE(again);
      CHECK(*again.value == *loaded.value);
      CHECK(schema_complaint(read(file)).empty());
    }
  }

  TEST_CASE("a default that the library of materials would replace is written") {
    const auto loaded = hooke::parse_scene(R"({
      "version": 1,
      "materials": {"dull": {"like": "steel", "metalness": 0}},
      "bodies": [
        {"name": "box", "kind": "dynamic", "material": "steel", "density": 1000, "shape": {"sphere": {"radius": 0.1}}},
        {"name": "parts", "kind": "dynamic", "material": "steel",
         "shape": {"parts": [{"shape": {"sphere": {"radius": 0.1}}, "density": 1000}]}}],
      "ropes": [{"name": "rope", "material": "nylon_rope", "radius": 0.01, "total_mass": 1}],
      "cloths": [{"name": "cloth", "material": "silk", "areal_density": 0.2, "shear_stiffness": 100}],
      "solids": [{"name": "solid", "material": "gelatine", "density": 1000, "poisson_ratio": 0.3}],
      "timeline": [{"at_step": 3, "add": {"cloths": [{"name": "late", "material": "silk",
                    "areal_density": 0.2}]}}]})",
                                           "scene.json");
    INFO((loaded.errors.empty() ? "" : hooke::to_line(loaded.errors.front())));
    REQUIRE(loaded);
    const auto again = hooke::parse_scene(hooke::write_scene(*loaded.value), "scene.json");
    REQUIRE(again);
    CHECK(*again.value == *loaded.value);
    CHECK(again.warnings.empty());
  }

  TEST_CASE("saving replaces the file as a whole or not at all") {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "hooke_scene_write_test";
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    const std::string path = (folder / "scene.json").string();
    hooke::Scene scene;
    scene.title = "saved";
    REQUIRE(hooke::save_scene(scene, path));
    CHECK(read(path) == hooke::write_scene(scene));
    CHECK(std::distance(std::filesystem::directory_iterator(folder), {}) == 1);
    const auto failed = hooke::save_scene(scene, (folder / "nowhere" / "scene.json").string());
    REQUIRE_FALSE(failed);
    CHECK(failed.error().code == hooke::ErrorCode::kFileNotWritable);
    std::filesystem::remove_all(folder);
  }
}

TEST_SUITE("io/scene_reference") {
  // After a change of the tables, HOOKE_UPDATE=1 in the environment writes both files anew.

  TEST_CASE("the committed schema is the one that the tables give") {
    const std::filesystem::path file = kScenes / "schema.json";
    if (std::getenv("HOOKE_UPDATE") != nullptr) std::ofstream(file) << hooke::scene_schema();
    CHECK(read(file) == hooke::scene_schema());
  }

  TEST_CASE("the documentation holds the tables as they are") {
    const std::filesystem::path file = kScenes.parent_path() / "docs" / "scene_format.md";
    constexpr std::string_view kMark = "<!-- Generated from here on. -->\n\n";
    const std::string page = read(file);
    const std::size_t start = page.find(kMark);
    REQUIRE(start != std::string::npos);
    const std::string text = page.substr(0, start + kMark.size());
    if (std::getenv("HOOKE_UPDATE") != nullptr) std::ofstream(file) << text << hooke::scene_reference();
    CHECK(read(file) == text + hooke::scene_reference());
  }

  TEST_CASE("the schema refuses what the loader refuses") {
    for (const char* text :
         {R"({})", R"({"version": 1, "dt": 0})", R"({"version": 1, "ropes": [{"masses": 1}]})",
          R"({"version": 1, "ropes": [{"mases": 2}]})",
          R"({"version": 1, "ropes": [{"stiffness": "stiff"}]})",
          R"({"version": 1, "bodies": [{"shape": {}}]})",
          R"({"version": 1, "bodies": [{"shape": {"box": {}, "sphere": {}}}]})",
          R"({"version": 1, "world": {"gravity": [0, 1]}})"}) {
      CAPTURE(text);
      CHECK_FALSE(schema_complaint(text).empty());
      CHECK_FALSE(hooke::parse_scene(text, "demo.json"));
    }
  }
}
