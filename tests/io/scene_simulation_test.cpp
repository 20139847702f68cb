#include "hooke/scene_io.h"

#include <array>
#include <cfenv>
#include <cmath>
#include <doctest/doctest.h>
#include <utility>

namespace {

hooke::Simulation simulate(const std::string& text) {
  auto scene = hooke::parse_scene(text, "demo.json");
  INFO((scene.errors.empty() ? "" : hooke::to_line(scene.errors.front())));
  REQUIRE(scene);
  auto simulation = hooke::Simulation::create(std::move(*scene.value));
  INFO((simulation.errors.empty() ? "" : hooke::to_line(simulation.errors.front())));
  REQUIRE(simulation);
  return std::move(*simulation.value);
}

void step(hooke::Simulation& simulation, int count) {
  for (int i = 0; i < count; ++i) REQUIRE(simulation.step().healthy());
}

/// One particle of 2 kg without gravity.
std::string particle_scene(const std::string& rest) {
  return R"({"version": 1, "world": {"gravity": [0, 0, 0]}, "seconds": 1,
    "particles": [{"name": "ball", "particles": [{"position": [0, 1, 0], "mass": 2}]}], )" +
         rest + "}";
}

double speed_x(const hooke::Simulation& simulation) {
  const hooke::SceneObject* ball = simulation.find("ball");
  REQUIRE(ball != nullptr);
  return static_cast<double>(simulation.world().velocities(ball->particles).offset(0).x);
}

}  // namespace

TEST_SUITE("io/scene_simulation") {
  TEST_CASE("a scene becomes a world with names, looks and instances") {
    const hooke::Simulation simulation = simulate(R"({
      "version": 1,
      "materials": {"red": {"color": [1, 0, 0]}},
      "bodies": [{"name": "box", "material": "red", "shape": {"box": {}},
                  "array": {"grid": [2, 1, 3], "spacing": [2, 1, 5]}}],
      "ropes": [{"masses": 5}]
    })");
    REQUIRE(simulation.objects().size() == 7);
    const hooke::SceneObject* box = simulation.find("box[5]");
    REQUIRE(box != nullptr);
    CHECK(box->look.color[0] == 1.0f);
    CHECK(box->look.color[1] == 0.0f);
    CHECK(box->path == "bodies[0]");
    CHECK(simulation.world().pose(box->body).position == hooke::DVec3{2, 0, 10});
    const hooke::SceneObject* rope = simulation.find("ropes[0]");
    REQUIRE(rope != nullptr);
    CHECK(simulation.world().positions(rope->rope).size() == 5);
    CHECK(simulation.find("box") == nullptr);
  }

  TEST_CASE("a scene is the same under every rounding mode of the host") {
    const auto life = [] {
      auto scene = hooke::load_scene(HOOKE_SCENES "/plank_bridge.json");
      REQUIRE(scene);
      const hooke::Placement at = hooke::random_placement(4, scene.value->world.gravity);
      auto simulation = hooke::Simulation::create(std::move(*scene.value), at);
      REQUIRE(simulation);
      step(*simulation.value, 20);
      const auto found = simulation.value->check(0);
      return std::pair(simulation.value->world().state_hash(), found.achieved);
    };
    const auto expected = life();
    for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
      CAPTURE(mode);
      std::fesetround(mode);
      const auto got = life();
      const int after = std::fegetround();
      std::fesetround(FE_TONEAREST);
      CHECK(got == expected);
      CHECK(after == mode);
    }
  }

  TEST_CASE("a pyramid narrows by one in each row and is centered") {
    const hooke::SceneArray array = {
        .kind = hooke::SceneArray::Kind::kPyramid, .pyramid = 3, .spacing = {2, 1, 0}};
    REQUIRE(array.count() == 6);
    CHECK(array.offset(0) == hooke::DVec3{0, 0, 0});
    CHECK(array.offset(2) == hooke::DVec3{4, 0, 0});
    CHECK(array.offset(3) == hooke::DVec3{1, 1, 0});
    CHECK(array.offset(5) == hooke::DVec3{2, 2, 0});
    CHECK(array.offset(6) == hooke::DVec3{});
  }

  TEST_CASE("a random array fills its box the same way everywhere") {
    const hooke::SceneArray array = {.kind = hooke::SceneArray::Kind::kRandom,
                                     .random = 1000,
                                     .seed = 7,
                                     .box = {hooke::DVec3{-1, 0, 2}, hooke::DVec3{1, 1, 3}}};
    hooke::DVec3 sum;
    for (std::size_t i = 0; i < 1000; ++i) {
      const hooke::DVec3 p = array.offset(i);
      CHECK((p.x >= -1 && p.x < 1 && p.y >= 0 && p.y < 1 && p.z >= 2 && p.z < 3));
      sum += p;
    }
    // The mean of 1000 uniform numbers is off by 0.0091 of the width in the standard deviation.
    CHECK(0.001 * sum.x == doctest::Approx(0).epsilon(0.06));
    CHECK(0.001 * sum.y == doctest::Approx(0.5).epsilon(0.06));
    CHECK(0.001 * sum.z == doctest::Approx(2.5).epsilon(0.02));
  }

  TEST_CASE("a list places and turns each copy, after the turn of the body itself") {
    const hooke::Simulation simulation = simulate(R"({
      "version": 1,
      "bodies": [{"name": "box", "shape": {"box": {}}, "position": [1, 0, 0],
                  "rotation": {"axis": [1, 0, 0], "angle_deg": 90},
                  "array": {"list": [[0, 0, 0], [0, 2, 5]],
                            "rotations": [[0, 0, 0, 1], {"axis": [0, 1, 0], "angle_deg": 90}]}}]
    })");
    REQUIRE(simulation.objects().size() == 2);
    const hooke::Pose first = simulation.world().pose(simulation.find("box[0]")->body);
    const hooke::Pose second = simulation.world().pose(simulation.find("box[1]")->body);
    CHECK(second.position == hooke::DVec3{1, 2, 5});
    // About x the y axis goes to z; from there the copy's own turn about y takes it to x.
    CHECK(static_cast<double>(hooke::rotate(first.rotation, hooke::Vec3{0, 1, 0}).z) == doctest::Approx(1));
    CHECK(static_cast<double>(hooke::rotate(second.rotation, hooke::Vec3{0, 1, 0}).x) == doctest::Approx(1));
  }

  TEST_CASE("a hull is drawn as its faces, flat, without the points inside it") {
    const hooke::Simulation simulation = simulate(R"({
      "version": 1,
      "meshes": {"spiky": {
        "vertices": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1],
                     [0.5, 0.5, 0.5]],
        "triangles": [[0, 1, 8], [1, 2, 8], [2, 3, 8], [3, 0, 8], [4, 5, 8], [5, 6, 8], [6, 7, 8], [7, 4, 8]]}},
      "bodies": [{"name": "one", "kind": "dynamic", "shape": {"hull": "spiky"}},
                 {"name": "other", "shape": {"hull": "spiky"}}, {"name": "mesh", "shape": {"mesh": "spiky"}}]
    })");
    const auto& model = simulation.find("one")->model;
    REQUIRE(model != nullptr);
    CHECK(model->vertices.size() == 24);  // a corner has a normal on each of its three faces
    CHECK(model->indices.size() == 3 * 12);
    for (const hooke::ModelVertex& vertex : model->vertices) {
      // A face of this cube is at 0 or 1 along its normal.
      const float along = vertex.normal[0] * vertex.position[0] + vertex.normal[1] * vertex.position[1] +
                          vertex.normal[2] * vertex.position[2];
      const float sum = vertex.normal[0] + vertex.normal[1] + vertex.normal[2];
      CHECK(static_cast<double>(along) == doctest::Approx(sum > 0 ? 1 : 0));
    }
    CHECK(simulation.find("other")->model == model);
    CHECK(simulation.find("mesh")->model != model);
    CHECK(static_cast<double>(simulation.world().mass(simulation.find("one")->body)) ==
          doctest::Approx(1000));
  }

  TEST_CASE("what the world says against a hook stands at its place in the file") {
    const auto complaint = [](const std::string& hook) {
      auto scene = hooke::parse_scene(
          R"({"version": 1, "bodies": [
  {"name": "ball", "kind": "dynamic", "shape": {"sphere": {}}}, {"name": "wall", "shape": {"box": {}}}],
  "hooks": [{)" +
              hook + R"(, "anchor": [0, 0, 0]}]})",
          "demo.json");
      REQUIRE(scene);
      const auto simulation = hooke::Simulation::create(std::move(*scene.value));
      REQUIRE(simulation.errors.size() == 1);
      return hooke::to_line(simulation.errors.front());
    };
    CHECK(complaint(R"("b": "wall")") ==
          "demo.json:3:13: hooks[0]: needs a dynamic body at one end at least");
    CHECK(complaint(R"("a": "ball", "b": "ball")") ==
          "demo.json:3:32: hooks[0].b: must be another body than `a`, or the world");
    CHECK(complaint(R"("b": "ball", "axis": [0, 0, 0])") ==
          "demo.json:3:35: hooks[0].axis: must not be zero");
    CHECK(complaint(R"("b": "ball", "limits": {"lower": 1, "upper": 0})") ==
          "demo.json:3:37: hooks[0].limits: must have lower not above upper");
    CHECK(complaint(R"("b": "ball", "kind": "distance", "limits": {"upper": -1})") ==
          "demo.json:3:57: hooks[0].limits: must allow some distance");
    CHECK(complaint(R"("b": "ball.tip")") ==
          "demo.json:3:19: hooks[0].b: has no connection point 'tip', there are center, origin, left, right, "
          "bottom, top, back, front");
  }

  TEST_CASE("what the world says against a connection point stands at its place in the file") {
    const auto complaint = [](const std::string& rest) {
      auto scene = hooke::parse_scene(R"({"version": 1, )" + rest + "}", "demo.json");
      REQUIRE(scene);
      const auto simulation = hooke::Simulation::create(std::move(*scene.value));
      REQUIRE(simulation.errors.size() == 1);
      return hooke::to_line(simulation.errors.front());
    };
    CHECK(complaint(R"("ropes": [{"masses": 3, "connection_points": {"eye": 3}}])") ==
          "demo.json:1:69: ropes[0].connection_points.eye: 3 is out of range, must be 0 to 2");
    CHECK(complaint(R"("bodies": [{"shape": {"box": {}}, "connection_points": {"eye": 3}}])") ==
          "demo.json:1:79: bodies[0].connection_points.eye: must be a place [x, y, z]: a body has no points");
    CHECK(complaint(R"("cloths": [{"name": "silk"}], "seams": [{"a": "silk.edge", "b": "silk.left"}])") ==
          "demo.json:1:62: seams[0].a: has no edge 'edge', there are left, right, top, bottom, border");
    CHECK(complaint(R"("meshes": {"leaf": {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
                       "triangles": [[0, 1, 2]], "connection_points": {"eye": 3}}})") ==
          "demo.json:2:79: meshes.leaf.connection_points.eye: 3 is out of range, must be 0 to 2");
  }

  TEST_CASE("a fractured body becomes cells and glue, which may be named, hooked and expected to break") {
    hooke::Simulation simulation = simulate(R"({
      "version": 1, "seconds": 1,
      "materials": {"glass": {"color": [0, 1, 0]}},
      "meshes": {"kite": {"vertices": [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]],
        "triangles": [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]}},
      "bodies": [
        {"name": "bar", "kind": "dynamic", "material": "glass", "shape": {"box": {"half_extents": [2, 0.1, 0.1]}},
         "connection_points": {"eye": [1.7, 0, 0]}, "density": 100,
         "fracture": {"seeds": [[-1.5, 0, 0], [-0.5, 0, 0], [0.5, 0, 0], [1.5, 0, 0]], "strength": 1e6},
         "array": {"grid": [1, 1, 2], "spacing": [0, 0, 3]}},
        {"name": "gem", "kind": "dynamic", "shape": {"mesh": "kite"}, "position": [0, 9, 0],
         "fracture": {"cells": 6, "seed": 2}},
        {"name": "hull", "kind": "dynamic", "shape": {"hull": "kite"}, "position": [9, 9, 0],
         "fracture": {"cells": 6, "seed": 2, "strength": "rigid"}}],
      "hooks": [{"name": "left", "kind": "fixed", "b": "bar", "anchor": [-1.9, 0, 0]},
                {"name": "right", "kind": "fixed", "b": "bar.eye"},
                {"name": "second", "kind": "fixed", "b": "bar[4]", "anchor": [-1.9, 0, 3]}],
      "expect": [{"quantity": "broken", "op": "<=", "value": 1},
                 {"quantity": "broken", "of": "bar_glue[0]", "op": "==", "value": 0}]
    })");
    std::size_t bars = 0;
    std::size_t gems = 0;
    for (const hooke::SceneObject& object : simulation.objects()) {
      if (object.name.starts_with("bar[")) ++bars;
      if (object.name.starts_with("gem[")) ++gems;
    }
    CHECK(bars == 8);
    CHECK(gems == 6);
    CHECK(simulation.find("bar[7]")->look.color[1] == 1);
    CHECK(simulation.find("bar[7]")->shape.kind == hooke::ShapeKind::kHull);
    CHECK(simulation.find("bar[8]") == nullptr);
    CHECK(simulation.find("bar_glue[5]")->hooked == std::array<std::string, 2>{"bar[6]", "bar[7]"});
    CHECK(simulation.find("bar_glue[6]") == nullptr);
    CHECK(simulation.find("left")->hooked[1] == "bar[0]");
    CHECK(simulation.find("right")->hooked[1] == "bar[3]");
    CHECK(simulation.find("second")->hooked[1] == "bar[4]");
    // Each cell has 4 kg, and all hang on the one that is held.
    simulation.run();
    CHECK(simulation.passed());
    const auto force = [&](const char* hook) {
      return static_cast<double>(length(simulation.world().hook_force(simulation.find(hook)->hook).force));
    };
    CHECK(force("second") == doctest::Approx(16 * 9.81).epsilon(1e-3));
    CHECK(force("bar_glue[3]") == doctest::Approx(12 * 9.81).epsilon(1e-3));
    hooke::Simulation again = simulate(hooke::write_scene(simulation.scene()));
    again.run();
    CHECK(again.world().state_hash() == simulation.world().state_hash());
    REQUIRE(simulation.remove("bar").has_value());
    CHECK(simulation.find("bar[2]") == nullptr);
    CHECK(simulation.find("bar_glue[2]") == nullptr);
  }

  TEST_CASE("a blade cuts what it names where it sweeps, and a restoration cuts again alike") {
    const char* const text = R"({
      "version": 1, "seconds": 1, "world": {"gravity": [0, 0, 0]},
      "bodies": [{"name": "knife", "kind": "kinematic", "shape": {"box": {"half_extents": [0.01, 0.3, 0.01]}},
                  "position": [-0.5, -0.52, 0], "velocity": [3, 0, 0], "collides": false,
                  "blade": {"edge": [[0, 0, -0.3], [0, 0, 0.45]], "cuts": ["sheet", "block", "rope"]}}],
      "cloths": [{"name": "sheet", "columns": 11, "rows": 11, "tethers": false, "array": {"grid": [1, 1, 2], "spacing": [1, 1, 0.1]}},
                 {"name": "other", "columns": 11, "rows": 11, "corner": [0, 0, -0.1]}],
      "solids": [{"name": "block", "cells": [3, 3, 3], "size": [0.3, 0.3, 0.3], "position": [0.5, -0.5, 0.27],
                  "young_modulus": 10000}],
      "ropes": [{"name": "rope", "hook_point": [0.5, 0, 0.25], "direction": [0, -1, 0]}],
      "expect": [{"quantity": "broken", "of": "sheet[1]", "op": "==", "value": 11},
                 {"quantity": "broken", "of": "other", "op": "==", "value": 0},
                 {"quantity": "broken", "of": "rope", "op": "==", "value": 1},
                 {"quantity": "broken", "of": "block", "op": ">", "value": 15}]
    })";
    hooke::Simulation simulation = simulate(text);
    for (int i = 0; i < 15; ++i) simulation.step();
    const hooke::SimulationSnapshot middle = simulation.snapshot();
    simulation.run();
    CHECK(simulation.passed());
    const std::uint64_t hash = simulation.world().state_hash();
    const hooke::SceneObject* sheet = simulation.find("sheet[0]");
    CHECK(sheet->broken);
    CHECK(sheet->cut_by == "knife");
    CHECK(sheet->broke.time == doctest::Approx(1.0 / 6).epsilon(0.1));
    CHECK(simulation.find("block")->cut_by == "knife");
    CHECK(simulation.find("rope")->cut_by == "knife");
    CHECK(!simulation.find("other")->broken);
    REQUIRE(simulation.restore(middle).has_value());
    simulation.run();
    CHECK(simulation.world().state_hash() == hash);
    hooke::Simulation again = simulate(hooke::write_scene(simulation.scene()));
    again.run();
    CHECK(again.world().state_hash() == hash);
  }

  TEST_CASE("a body yields by its own keys or its material's, and a restoration yields again alike") {
    const char* const text = R"({
      "version": 1, "seconds": 1.5, "world": {"gravity": [0, 0, 0]},
      "materials": {"tin": {"yields": {"impulse": 20, "cell": 0.2, "young_modulus": 3e6, "damping": 0.02,
                                       "yield_stress": 3e4}}, "iron": {}},
      "bodies": [
        {"name": "plate", "kind": "dynamic", "material": "tin", "mass": 12, "shape": {"box": {"half_extents": [0.3, 0.3, 0.03]}}},
        {"name": "still", "material": "tin", "shape": {"box": {"half_extents": [0.3, 0.3, 0.03]}}, "position": [5, 0, 0]},
        {"name": "own", "kind": "dynamic", "material": "tin", "mass": 12, "shape": {"box": {"half_extents": [0.3, 0.3, 0.03]}},
         "position": [2, 0, 0], "yields": {"impulse": 1e6}},
        {"name": "ball", "kind": "dynamic", "mass": 6, "shape": {"sphere": {"radius": 0.08}}, "position": [0.1, 0, -0.5],
         "velocity": [0, 0, 10], "array": {"list": [[0, 0, 0], [2, 0, 0]]}}],
      "expect": [{"quantity": "soft", "of": "plate", "op": "==", "value": 1, "at_step": 5},
                 {"quantity": "soft", "of": "plate", "op": "==", "value": 0},
                 {"quantity": "yielded", "of": "plate", "op": "==", "value": 1},
                 {"quantity": "yielded", "of": "own", "op": "==", "value": 0},
                 {"quantity": "yielded", "op": "==", "value": 1}]
    })";
    hooke::Simulation simulation = simulate(text);
    for (int i = 0; i < 6; ++i) simulation.step();
    const hooke::SimulationSnapshot middle = simulation.snapshot();
    simulation.run();
    CHECK(simulation.passed());
    const std::uint64_t hash = simulation.world().state_hash();
    const hooke::SceneObject* plate = simulation.find("plate");
    REQUIRE(plate->blow.has_value());
    CHECK(plate->blow->impulse > 20);
    REQUIRE(plate->froze.has_value());
    CHECK(plate->froze->time > plate->blow->time);
    CHECK(simulation.world().is_reshaped(plate->body));
    REQUIRE(simulation.restore(middle).has_value());
    CHECK(simulation.world().soft_form(simulation.find("plate")->body) != hooke::SolidId{});
    CHECK(!simulation.find("plate")->froze.has_value());
    simulation.run();
    CHECK(simulation.world().state_hash() == hash);
    hooke::Simulation again = simulate(hooke::write_scene(simulation.scene()));
    again.run();
    CHECK(again.world().state_hash() == hash);
  }

  TEST_CASE("what is no blade is said at its place") {
    const auto complaint = [](const std::string& rest) {
      const std::string text =
          R"({"version": 1, "ropes": [{"name": "rope"}], "bodies": [{"name": "knife", "shape": {"box": {}}, )" +
          rest + "}]}";
      const auto scene = hooke::parse_scene(text, "demo.json");
      REQUIRE(!scene);
      return hooke::to_line(scene.errors.front());
    };
    CHECK(complaint(R"("blade": {"edge": [[0, 0, 0], [1, 0, 0]]})")
              .ends_with("bodies[0]: 'blade' is for a kinematic body, which nothing stops"));
    CHECK(complaint(R"("kind": "kinematic", "blade": {"edge": [[1, 0, 0], [1, 0, 0]]})")
              .ends_with("the two ends of the 'edge' of 'blade' must not be equal"));
    CHECK(complaint(R"("kind": "kinematic", "blade": {"edge": [[0, 0, 0], [1, 0, 0]], "cuts": ["knife"]})")
              .ends_with("'knife' is neither a rope nor a cloth nor a solid"));
    CHECK(complaint(R"("kind": "kinematic", "blade": {"edge": [[0, 0, 0], [1, 0, 0]], "cuts": ["rop"]})")
              .find("rope") != std::string::npos);
  }

  TEST_CASE("what cannot be fractured is said at its place") {
    const auto complaint = [](const std::string& rest) {
      auto scene =
          hooke::parse_scene(R"({"version": 1, "bodies": [{"name": "b", )" + rest + "}]}", "demo.json");
      if (!scene) return hooke::to_line(scene.errors.front());
      const auto simulation = hooke::Simulation::create(std::move(*scene.value));
      return simulation ? std::string() : hooke::to_line(simulation.errors.front());
    };
    CHECK(
        complaint(R"("shape": {"box": {}}, "fracture": {})") ==
        "demo.json:1:27: bodies[0]: 'fracture' is for a dynamic body; hooks to the world may hold its cells");
    CHECK(complaint(R"("kind": "dynamic", "shape": {"sphere": {}}, "fracture": {})") ==
          "demo.json:1:27: bodies[0]: 'fracture' is for a box, a hull or a mesh");
    CHECK(complaint(R"("kind": "dynamic", "shape": {"box": {}}, "fracture": {"strength": 0})") ==
          "demo.json:1:107: bodies[0].fracture.strength: 0 is out of range, must be greater than 0 or "
          "\"rigid\"");
    CHECK(complaint(R"("kind": "dynamic", "shape": {"box": {}}, "fracture": {"impact": [9, 0, 0]})") ==
          "demo.json:1:105: bodies[0].fracture.impact: lies outside the box around the solid; it should lie "
          "in or on it");
  }

  TEST_CASE("hooks hold points by number, the last one, and the place nearest to their anchor") {
    const hooke::Simulation simulation = simulate(R"({
      "version": 1,
      "ropes": [{"name": "rope", "hook_point": [0, 2, 0], "direction": [1, 0, 0], "masses": 5, "length_at_rest": 4}],
      "bodies": [{"name": "ball", "kind": "dynamic", "shape": {"sphere": {}}, "position": [4, 1, 0]}],
      "hooks": [{"name": "end", "a": "ball", "b": "rope", "b_point": "last"},
                {"name": "second", "a": "rope", "a_point": 1, "b": "ball", "kind": "distance", "anchor_b": [4, 1, 0]},
                {"name": "between", "b": "rope", "anchor": [2.25, 1, 0], "spring": {"stiffness": 5}}]
    })");
    const auto anchors = [&](const char* hook) {
      return simulation.world().hook_anchors(simulation.find(hook)->hook);
    };
    CHECK(anchors("end") == std::array{hooke::DVec3{4, 2, 0}, hooke::DVec3{4, 2, 0}});
    CHECK(anchors("second") == std::array{hooke::DVec3{1, 2, 0}, hooke::DVec3{4, 1, 0}});
    CHECK(anchors("between")[1] == hooke::DVec3{2.25, 2, 0});
  }

  TEST_CASE("hooks hold connection points by their names, of copies and of what is made of a mesh too") {
    const hooke::Simulation simulation = simulate(R"({
      "version": 1,
      "meshes": {"kite": {"vertices": [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]],
        "triangles": [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]],
        "connection_points": {"tip": 2, "tail": [0, -1, 0]}}},
      "ropes": [{"name": "rope", "hook_point": [0, 9, 0], "direction": [1, 0, 0], "masses": 5,
                 "length_at_rest": 4, "connection_points": {"second": 1, "low": [3.25, 8, 0]},
                 "array": {"grid": [1, 1, 2], "spacing": [0, 0, 3]}}],
      "bodies": [{"name": "kite", "kind": "dynamic", "shape": {"hull": "kite"}, "position": [0, 5, 0],
                  "rotation": {"axis": [0, 0, 1], "angle_deg": 90},
                  "array": {"grid": [2, 1, 1], "spacing": [20, 0, 0]}},
                 {"name": "pair", "kind": "dynamic", "position": [0, 20, 0], "shape": {"parts": [
                   {"shape": {"box": {}}}, {"shape": {"hull": "kite"}, "position": [0, 2, 0]}]},
                  "connection_points": {"tail": [0, 0.5, 0]}}],
      "cloths": [{"name": "skin", "mesh": "kite", "position": [0, 0, 7]}],
      "solids": [{"name": "jelly", "mesh": "kite", "cell": 0.4, "position": [0, 0, -9],
                  "rotation": {"axis": [1, 0, 0], "angle_deg": 180}}],
      "timeline": [{"at_step": 0, "add": {"ropes": [{"hook_point": [0, 30, 0]}],
                    "hooks": [{"name": "late", "a": "timeline[0].add.ropes[0].end", "b": "kite[0].tip"}]}}],
      "hooks": [{"name": "one", "a": "rope[1].low", "b": "kite[1].tip"},
                {"name": "each", "a": "rope.second", "b": "kite.tail", "array": {"grid": [2, 1, 1]}},
                {"name": "on", "b": "pair.tip"}, {"name": "own", "b": "pair.tail"},
                {"name": "sewn", "a": "skin.tip", "b": "jelly.tip"}]
    })");
    const auto anchors = [&](const char* hook) {
      return simulation.world().hook_anchors(simulation.find(hook)->hook);
    };
    const auto near = [](hooke::DVec3 a, hooke::DVec3 b) { return length(a - b) < 2e-6; };
    CHECK(near(anchors("one")[0], {3.25, 9, 3}));
    CHECK(near(anchors("one")[1], {19, 5, 0}));
    CHECK(near(anchors("each[0]")[0], {1, 9, 0}));
    CHECK(near(anchors("each[1]")[0], {1, 9, 3}));
    CHECK(near(anchors("each[1]")[1], {21, 5, 0}));
    CHECK(simulation.find("each[1]")->hooked == std::array<std::string, 2>{"rope[1]", "kite[1]"});
    CHECK(near(anchors("on")[1], {0, 23, 0}));
    CHECK(near(anchors("own")[1], {0, 20.5, 0}));
    CHECK(near(anchors("sewn")[0], {0, 1, 7}));
    CHECK(length(anchors("sewn")[1] - hooke::DVec3{0, -1, -9}) < 0.1);  // cells of 0.4 m round the tip off
    hooke::Simulation later = simulate(hooke::write_scene(simulation.scene()));
    step(later, 1);
    CHECK(later.errors().empty());
    REQUIRE(later.find("late") != nullptr);
    CHECK(later.find("late")->hooked[0] == "timeline[0].add.ropes[0]");
  }

  TEST_CASE("a seam's stitches are hooks of its name, through arrays, and go with what they hold") {
    hooke::Simulation simulation = simulate(R"({
      "version": 1, "seconds": 1,
      "cloths": [{"name": "left", "columns": 3, "rows": 5, "pins": [{"row": 0}],
                  "array": {"grid": [1, 1, 3], "spacing": [1, 1, 2]}},
                 {"name": "right", "columns": 3, "rows": 4, "corner": [1, 0, 2],
                  "array": {"grid": [1, 1, 2], "spacing": [1, 1, 2]}}],
      "seams": [{"name": "seam", "a": "left[1].right", "b": "right.left", "array": {"grid": [1, 1, 2]}}],
      "timeline": [{"at_step": 2, "remove": "right[1]"}, {"at_step": 4, "remove": "seam"}],
      "expect": [{"quantity": "gap", "of": "seam[9]", "op": "<", "value": 1e-5, "at_step": 1}]
    })");
    CHECK(simulation.objects().size() == 3 + 2 + 10);
    REQUIRE(simulation.find("seam[7]") != nullptr);
    CHECK(simulation.find("seam[7]")->hooked == std::array<std::string, 2>{"left[2]", "right[1]"});
    const auto anchors = simulation.world().hook_anchors(simulation.find("seam[7]")->hook);
    CHECK(length(anchors[0] - hooke::DVec3{1, -0.5, 4}) < 1e-6);
    CHECK(length(anchors[1] - hooke::DVec3{1, -0.5, 4}) < 1e-6);
    step(simulation, 3);
    CHECK(simulation.verdicts().front().passed);
    CHECK(simulation.objects().size() == 3 + 1 + 5);
    step(simulation, 2);
    CHECK(simulation.errors().empty());
    CHECK(simulation.objects().size() == 3 + 1);
  }

  TEST_CASE("an array of hooks counts through arrays of bodies, from the copy that is named") {
    const hooke::Simulation simulation = simulate(R"({
      "version": 1,
      "bodies": [{"kind": "dynamic", "shape": {"box": {}}, "position": [9, 0, 0]},
                 {"name": "link", "kind": "dynamic", "shape": {"sphere": {"radius": 0.1}},
                  "array": {"grid": [1, 4, 1], "spacing": [1, -1, 1]}}],
      "hooks": [{"name": "top", "b": "link[0]", "anchor": [0, 0.5, 0]},
                {"name": "joint", "a": "link", "b": "link[1]", "anchor": [0, -0.5, 0],
                 "array": {"grid": [1, 3, 1], "spacing": [1, -1, 1]}},
                {"name": "spoke", "kind": "distance", "a": "bodies[0]", "b": "link[2]", "anchor": [9, 0, 0],
                 "anchor_b": [0, -2, 0], "array": {"list": [[0, 0, 0], [0, -1, 0]]}}]
    })");
    const auto holds = [&](const char* hook, const char* a, const char* b) {
      const hooke::SceneObject* object = simulation.find(hook);
      REQUIRE(object != nullptr);
      CHECK(object->hooked == std::array<std::string, 2>{a, b});
      return simulation.world().hook_anchors(object->hook);
    };
    CHECK(holds("top", "", "link[0]")[0] == hooke::DVec3{0, 0.5, 0});
    CHECK(holds("joint[0]", "link[0]", "link[1]")[1] == hooke::DVec3{0, -0.5, 0});
    CHECK(holds("joint[2]", "link[2]", "link[3]")[1] == hooke::DVec3{0, -2.5, 0});
    CHECK(holds("spoke[1]", "bodies[0]", "link[3]")[1] == hooke::DVec3{0, -3, 0});
  }

  TEST_CASE("solids have pins by place, copies, points by number, and go when they are told") {
    hooke::Simulation simulation = simulate(R"({
      "version": 1, "seconds": 1,
      "meshes": {"kite": {"vertices": [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]],
        "triangles": [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]}},
      "solids": [
        {"name": "jelly", "cells": [2, 3, 2], "size": [0.2, 0.3, 0.2], "pins": [{"topmost": 0.01}],
         "array": {"grid": [2, 1, 1], "spacing": [1, 1, 1]}},
        {"name": "kite", "mesh": "kite", "cell": 0.4, "poisson_ratio": 0.3}],
      "timeline": [{"at_step": 20, "remove": "kite"}],
      "expect": [{"quantity": "height", "of": "jelly[1]", "point": "last", "op": "<", "value": 0.2}]
    })");
    REQUIRE(simulation.objects().size() == 3);
    const hooke::SceneObject* jelly = simulation.find("jelly[1]");
    REQUIRE(jelly != nullptr);
    CHECK(hooke::positions_of(simulation.world(), *jelly).size() == 3 * 4 * 3 + 12);
    const hooke::SolidId kite = simulation.find("kite")->solid;
    CHECK(simulation.world().surface(kite).size() == 6);
    step(simulation, 30);
    CHECK(simulation.find("kite") == nullptr);
    CHECK(simulation.world().surface(kite).empty());
    // The top hangs where it was, the rest under it.
    const hooke::DVec3 top = hooke::positions_of(simulation.world(), *jelly)[9];
    CHECK(top.y == doctest::Approx(0.15));
    CHECK(simulation.check(0).passed);
  }

  TEST_CASE("what is wrong with a solid stands at its place in the file") {
    const auto first_error = [](const std::string& solid) {
      auto scene =
          hooke::parse_scene(R"({"version": 1, "seconds": 1, "solids": [)" + solid + "]}", "demo.json");
      if (!scene) return hooke::to_line(scene.errors.front());
      const auto simulation = hooke::Simulation::create(std::move(*scene.value));
      return simulation ? std::string() : hooke::to_line(simulation.errors.front());
    };
    CHECK(first_error(R"({"poisson_ratio": 0.5})").find("solids[0].poisson_ratio") != std::string::npos);
    CHECK(first_error(R"({"cells": [0, 1, 1]})").find("solids[0].cells") != std::string::npos);
    CHECK(first_error(R"({"size": [1, -1, 1]})").find("solids[0].size") != std::string::npos);
    CHECK(first_error(R"({"mesh": "none"})").find("solids[0].mesh") != std::string::npos);
    CHECK(first_error(R"({"pins": [{"row": 0}]})").find("solids[0].pins[0]") != std::string::npos);
    CHECK(first_error(R"({"pins": [27]})").find("solids[0].pins[0]") == std::string::npos);
    CHECK(first_error(R"({"pins": [200]})").find("solids[0].pins[0]") != std::string::npos);
  }

  TEST_CASE("an array is removed as a whole, and its hooks with it") {
    hooke::Simulation simulation = simulate(R"({
      "version": 1,
      "bodies": [{"name": "hub", "kind": "dynamic", "shape": {"sphere": {}}},
                 {"name": "leaf", "kind": "dynamic", "shape": {"sphere": {}}, "array": {"grid": [3, 1, 1]}}],
      "hooks": [{"a": "hub", "b": "leaf", "anchor": [0, 0, 0], "array": {"grid": [3, 1, 1]}}],
      "timeline": [{"at_step": 1, "remove": "leaf[1]"}, {"at_step": 2, "remove": "leaf"}]
    })");
    REQUIRE(simulation.objects().size() == 7);
    step(simulation, 2);
    CHECK(simulation.objects().size() == 5);
    step(simulation, 1);
    REQUIRE(simulation.objects().size() == 1);
    CHECK(simulation.objects()[0].name == "hub");
    CHECK(simulation.errors().empty());
  }

  TEST_CASE("hooks are measured, break, and go with their bodies") {
    hooke::Simulation simulation = simulate(R"({
      "version": 1, "seconds": 2,
      "bodies": [{"name": "heavy", "kind": "dynamic", "shape": {"sphere": {}}, "mass": 10},
                 {"name": "light", "kind": "dynamic", "shape": {"sphere": {}}, "mass": 1, "position": [3, 0, 0]},
                 {"name": "arm", "kind": "dynamic", "shape": {"sphere": {}}, "mass": 1, "position": [6, 0, 0]},
                 {"name": "bead", "kind": "dynamic", "shape": {"sphere": {}}, "position": [9, 0, 0]}],
      "hooks": [{"name": "weak", "b": "heavy", "anchor": [0, 1, 0], "break_force": 98},
                {"name": "strong", "b": "light", "anchor": [3, 1, 0], "break_force": 98},
                {"name": "beam", "kind": "fixed", "b": "arm", "anchor": [5, 0, 0]},
                {"name": "slider", "kind": "slider", "b": "bead", "anchor": [9, 0, 0], "limits": {"lower": -0.25}}],
      "timeline": [{"at_step": 100, "remove": "light"}],
      "expect": [{"quantity": "broken", "of": "weak", "op": "==", "value": 1, "at_step": 1},
                 {"quantity": "broken", "op": "==", "value": 1, "at_step": 60},
                 {"quantity": "broken", "of": "strong", "op": "==", "value": 0, "at_step": 60},
                 {"quantity": "force", "of": "strong", "op": "within", "value": 9.81, "tolerance": 1e-4,
                  "at_step": 60},
                 {"quantity": "torque", "of": "beam", "op": "within", "value": 9.81, "tolerance": 1e-2,
                  "at_step": 60},
                 {"quantity": "way", "of": "slider", "op": "==", "value": -0.25, "tolerance": 1e-3, "at_step": 60},
                 {"quantity": "gap", "op": "<", "value": 1e-3, "at_step": 60},
                 {"quantity": "y", "of": "heavy", "op": "<", "value": -4, "at_step": 60}]
    })");
    simulation.run();
    INFO(simulation.report());
    CHECK(simulation.passed());
    CHECK(simulation.find("strong") == nullptr);
    CHECK(simulation.find("beam") != nullptr);
  }

  TEST_CASE("parts have looks of their own, or that of the body") {
    const hooke::Simulation simulation = simulate(R"({
      "version": 1,
      "materials": {"red": {"color": [1, 0, 0]}, "blue": {"color": [0, 0, 1]}},
      "bodies": [{"name": "hammer", "kind": "dynamic", "material": "red", "shape": {"parts": [
        {"shape": {"cylinder": {}}, "position": [0, 1, 0]}, {"shape": {"box": {}}, "material": "blue"}]}}]
    })");
    const hooke::SceneObject& hammer = *simulation.find("hammer");
    REQUIRE(hammer.parts.size() == 2);
    CHECK(hammer.parts[0].look.color[0] == 1.0f);
    CHECK(hammer.parts[0].position == hooke::Vec3{0, 1, 0});
    CHECK(hammer.parts[1].look.color[2] == 1.0f);
    CHECK(hammer.parts[1].material == "blue");
  }

  TEST_CASE("a hull of points in a plane is an error at its place") {
    auto scene = hooke::parse_scene(R"({"version": 1,
"meshes": {"flat": {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]]}},
"bodies": [{"shape": {"hull": "flat"}}]})",
                                    "demo.json");
    REQUIRE(scene);
    const auto simulation = hooke::Simulation::create(std::move(*scene.value));
    REQUIRE(simulation.errors.size() == 1);
    CHECK(hooke::to_line(simulation.errors[0]).starts_with("demo.json:3:"));
  }

  TEST_CASE("figures of a body are measured: speed, spin and tilt") {
    const hooke::Simulation simulation = simulate(R"({
      "version": 1,
      "bodies": [{"name": "top", "kind": "dynamic", "shape": {"box": {}}, "velocity": [3, 0, 4],
                  "angular_velocity": [0, 0, 2], "rotation": {"axis": [1, 0, 0], "angle_deg": 30}}],
      "expect": [{"quantity": "speed", "of": "top", "op": "==", "value": 5, "tolerance": 1e-5},
                 {"quantity": "angular_speed", "of": "top", "op": "==", "value": 2, "tolerance": 1e-5},
                 {"quantity": "tilt", "of": "top", "op": "==", "value": 30, "tolerance": 1e-4}]
    })");
    for (std::size_t i = 0; i < 3; ++i) {
      INFO(simulation.check(i).text);
      CHECK(simulation.check(i).passed);
    }
  }

  TEST_CASE("pins hold a column, a row, the topmost points and the last one") {
    hooke::Simulation simulation = simulate(R"({
      "version": 1,
      "cloths": [
        {"name": "column", "columns": 4, "rows": 3, "pins": [{"column": "last"}]},
        {"name": "free", "columns": 4, "rows": 3, "corner": [0, 0, 1]},
        {"name": "row", "columns": 4, "rows": 3, "corner": [0, 0, 2], "pins": [{"row": 0}]},
        {"name": "top", "columns": 4, "rows": 3, "corner": [0, 0, 3], "pins": [{"topmost": 0.001}]}],
      "ropes": [{"name": "rope", "masses": 4, "pins": [0, "last"]}]
    })");
    step(simulation, 10);
    const hooke::World& world = simulation.world();
    const hooke::PointView column = world.positions(simulation.find("column")->cloth);
    const hooke::PointView free = world.positions(simulation.find("free")->cloth);
    const hooke::PointView row = world.positions(simulation.find("row")->cloth);
    const hooke::PointView top = world.positions(simulation.find("top")->cloth);
    for (std::size_t i = 0; i < 12; ++i) {
      const double from = -0.5 * static_cast<double>(i / 4);
      CAPTURE(i);
      if (i % 4 == 3) CHECK(column[i].y == doctest::Approx(from));
      CHECK(free[i].y < from - 0.1);
      if (i < 4) CHECK(row[i].y == doctest::Approx(from));
      if (i < 4) CHECK(top[i].y == doctest::Approx(from));
    }
    const hooke::PointView rope = world.positions(simulation.find("rope")->rope);
    CHECK(rope[3].y == doctest::Approx(0));
    CHECK(rope[3].x == doctest::Approx(-1));
  }

  TEST_CASE("an impulse changes the velocity by impulse / mass just before its step") {
    hooke::Simulation simulation = simulate(particle_scene(
        R"("timeline": [{"at_step": 3, "impulse": {"object": "ball", "point": 0, "impulse": [1, 0, 0]}}])"));
    step(simulation, 3);
    CHECK(speed_x(simulation) == 0.0);
    step(simulation, 1);
    CHECK(speed_x(simulation) == doctest::Approx(0.5));
    CHECK(simulation.errors().empty());
  }

  TEST_CASE("a body is hit, pushed and given velocities without a point") {
    // A cube of 1 m and 6 kg: its moment about any axis is 1 kg m^2.
    const std::string box = R"({"version": 1, "world": {"gravity": [0, 0, 0]}, "seconds": 1,
      "bodies": [{"name": "box", "kind": "dynamic", "mass": 6, "shape": {"box": {"half_extents": [0.5, 0.5, 0.5]}}}],
      "timeline": [{"at_step": 1, )";
    const auto after = [&](const std::string& event) {
      hooke::Simulation simulation = simulate(box + event + "}]}");
      step(simulation, 40);
      const hooke::BodyId id = simulation.find("box")->body;
      return std::array{simulation.world().velocity(id), simulation.world().angular_velocity(id)};
    };
    const auto center = after(R"("impulse": {"object": "box", "impulse": [12, 0, 0]})");
    CHECK(static_cast<double>(center[0].x) == doctest::Approx(2));
    CHECK(center[1] == hooke::Vec3{});
    const auto top = after(R"("impulse": {"object": "box", "at": [0, 0.5, 0], "impulse": [2, 0, 0]})");
    CHECK(static_cast<double>(top[0].x) == doctest::Approx(1.0 / 3));
    CHECK(static_cast<double>(top[1].z) == doctest::Approx(-1).epsilon(1e-5));
    const auto pushed = after(R"("force": {"object": "box", "force": [0, 0, 18], "steps": 30})");
    CHECK(static_cast<double>(pushed[0].z) == doctest::Approx(1.5).epsilon(1e-5));
    const auto spun =
        after(R"("velocity": {"object": "box", "velocity": [0, 3, 0], "angular_velocity": [0, 0, 2]})");
    CHECK(static_cast<double>(spun[0].y) == doctest::Approx(3));
    CHECK(static_cast<double>(spun[1].z) == doctest::Approx(2));
  }

  TEST_CASE("a point is given a velocity") {
    hooke::Simulation simulation = simulate(particle_scene(
        R"("timeline": [{"at_step": 3, "velocity": {"object": "ball", "point": 0, "velocity": [5, 0, 0]}}])"));
    step(simulation, 10);
    CHECK(speed_x(simulation) == doctest::Approx(5));
  }

  TEST_CASE("the timeline drives, brakes and steers hooks") {
    const std::string wheel = R"({"version": 1, "world": {"gravity": [0, 0, 0]}, "seconds": 4,
      "bodies": [{"name": "wheel", "kind": "dynamic", "mass": 6, "shape": {"box": {"half_extents": [0.5, 0.5, 0.5]}}}],
      "hooks": [{"name": "hook", "b": "wheel", "anchor": [0, 0, 0], )";
    hooke::Simulation hinge = simulate(wheel + R"("kind": "hinge", "axis": [0, 0, 1]}], "timeline": [
      {"at_step": 1, "motor": {"object": "hook", "speed": 3, "max_force": 6}},
      {"at_step": 100, "motor": {"object": "hook", "max_force": 0}},
      {"at_step": 120, "motor": {"object": "hook", "max_force": 1.5}}]})");
    const auto spin = [&] {
      return static_cast<double>(hinge.world().angular_velocity(hinge.find("wheel")->body).z);
    };
    step(hinge, 16);  // 15 steps of 6 N m on 1 kg m^2
    CHECK(spin() == doctest::Approx(1.5).epsilon(0.001));
    step(hinge, 100);
    CHECK(spin() == doctest::Approx(3).epsilon(0.001));
    step(hinge, 64);  // a second of a brake of 1.5 N m
    CHECK(spin() == doctest::Approx(1.5).epsilon(0.001));

    hooke::Simulation slider = simulate(wheel + R"("kind": "slider", "axis": [1, 0, 0]}], "timeline": [
      {"at_step": 1, "spring": {"object": "hook", "stiffness": 600, "damping": 120, "target": 0.25}}]})");
    step(slider, 240);  // critically damped, at 10 / s
    CHECK(slider.world().pose(slider.find("wheel")->body).position.x == doctest::Approx(0.25).epsilon(0.001));

    hooke::Simulation car =
        simulate(wheel + R"("kind": "wheel", "axis": [0, 1, 0], "second_axis": [0, 0, 1]}],
      "timeline": [{"at_step": 1, "steering": {"object": "hook", "angle": 0.5}}]})");
    step(car, 120);
    const hooke::Quat turn = car.world().pose(car.find("wheel")->body).rotation;
    CHECK(static_cast<double>(2 * std::atan2(turn.y, turn.w)) == doctest::Approx(0.5).epsilon(0.001));
  }

  TEST_CASE("a kinematic body takes the path that the timeline tells, from where it is") {
    hooke::Simulation simulation = simulate(R"({"version": 1, "seconds": 3,
      "bodies": [{"name": "lift", "kind": "kinematic", "position": [1, 2, 3], "shape": {"box": {}}}],
      "timeline": [
        {"at_step": 30, "motion": {"object": "lift", "motion": {"velocity": [0, 2, 0]}}},
        {"at_step": 60, "motion": {"object": "lift", "motion": {"keyframes": [
          {"time": 0, "offset": [0, 0, 0]}, {"time": 0.5, "offset": [4, 0, 0]}]}}},
        {"at_step": 120, "velocity": {"object": "lift", "angular_velocity": [0, 1, 0]}},
        {"at_step": 150, "motion": {"object": "lift"}}]})");
    const auto place = [&] { return simulation.world().pose(simulation.find("lift")->body).position; };
    step(simulation, 30);
    CHECK(place() == hooke::DVec3{1, 2, 3});
    step(simulation, 30);
    CHECK(length(place() - hooke::DVec3{1, 3, 3}) < 1e-5);
    step(simulation, 60);
    CHECK(length(place() - hooke::DVec3{5, 3, 3}) < 1e-5);
    step(simulation, 60);
    CHECK(length(place() - hooke::DVec3{5, 3, 3}) < 1e-5);
    const hooke::Quat turn = simulation.world().pose(simulation.find("lift")->body).rotation;
    CHECK(static_cast<double>(2 * std::atan2(turn.y, turn.w)) == doctest::Approx(1).epsilon(0.001));
    CHECK(simulation.errors().empty());
  }

  TEST_CASE("a force acts for its steps and no longer") {
    hooke::Simulation simulation = simulate(particle_scene(
        R"("timeline": [{"at_step": 2, "force": {"object": "ball", "point": "last", "force": [6, 0, 0], "steps": 10}}])"));
    step(simulation, 30);
    // 6 N x 10/60 s / 2 kg
    CHECK(speed_x(simulation) == doctest::Approx(0.5));
  }

  TEST_CASE("objects come and go by the timeline") {
    hooke::Simulation simulation = simulate(particle_scene(R"("timeline": [
      {"at_step": 4, "remove": "rope"},
      {"at_step": 2, "add": {"ropes": [{"name": "rope"}]}},
      {"at_step": 5, "gravity": [0, -6, 0]}])"));
    step(simulation, 2);
    CHECK(simulation.find("rope") == nullptr);
    step(simulation, 1);
    CHECK(simulation.find("rope") != nullptr);
    step(simulation, 2);
    CHECK(simulation.find("rope") == nullptr);
    CHECK(simulation.world().desc().gravity.y == 0);
    step(simulation, 1);
    CHECK(simulation.world().desc().gravity.y == hooke::Real(-6));
    CHECK(simulation.errors().empty());
  }

  TEST_CASE("an event on an object that is not there is recorded with its place") {
    hooke::Simulation simulation = simulate(particle_scene(R"(
      "timeline": [{"at_step": 1, "remove": "ball"}, {"at_step": 2, "remove": "ball"}])"));
    step(simulation, 3);
    REQUIRE(simulation.errors().size() == 1);
    CHECK(hooke::to_line(simulation.errors()[0]) ==
          "demo.json:3:54: timeline[1]: there is no object 'ball' any more");
    CHECK_FALSE(simulation.passed());
  }

  TEST_CASE("what only the world can refuse gets its place in the file") {
    auto scene =
        hooke::parse_scene("{\"version\": 1,\n \"ropes\": [{\"direction\": [0, 0, 0]}]}", "demo.json");
    REQUIRE(scene);
    const auto simulation = hooke::Simulation::create(std::move(*scene.value));
    REQUIRE(simulation.errors.size() == 1);
    CHECK(simulation.errors[0].where == "demo.json:2:26: ropes[0].direction");
  }

  TEST_CASE("a scene made in code is checked as one from a file") {
    hooke::Scene scene;
    scene.objects.cloths.push_back({.mesh = "nowhere"});
    scene.objects.ropes.push_back({.tag = {.material = "nothing"}});
    scene.expect.push_back({.of = "rope", .point = hooke::ScenePoint{}, .at_step = 601});
    const auto simulation = hooke::Simulation::create(scene);
    REQUIRE(simulation.errors.size() == 3);
    CHECK(hooke::to_line(simulation.errors[0])
              .starts_with("ropes[0].material: there is no material 'nothing'; the library has brass, clay"));
    CHECK(hooke::to_line(simulation.errors[1]) == "cloths[0].mesh: there is no mesh 'nowhere'");
    CHECK(hooke::to_line(simulation.errors[2]) ==
          "expect[0].at_step: 601 is after the end of the scene, step 600");
    hooke::Scene large;
    large.objects.ropes.push_back({.desc = {.masses = 1'000'000'000}});
    CHECK(hooke::Simulation::create(large).errors.at(0).code == hooke::ErrorCode::kLimitExceeded);
  }

  TEST_CASE("expectations are judged at their step") {
    hooke::Simulation simulation = simulate(R"({
      "version": 1, "seconds": 1,
      "particles": [{"name": "ball", "particles": [{"position": [0, 10, 0]}]}],
      "expect": [
        {"quantity": "height", "of": "ball", "point": 0, "op": "==", "value": 10, "tolerance": 0, "at_step": 0},
        {"quantity": "speed", "of": "ball", "point": 0, "op": "within", "value": 9.81, "tolerance": 0.001},
        {"quantity": "kinetic_energy", "op": ">", "value": 1000},
        {"quantity": "height", "of": "ball", "point": 0, "op": "<", "value": 10, "at_step": 1}]
    })");
    CHECK(simulation.verdicts().size() == 1);
    CHECK_FALSE(simulation.passed());
    simulation.run();
    CHECK(simulation.world().step_count() == 60);
    REQUIRE(simulation.verdicts().size() == 4);
    const auto verdicts = simulation.verdicts();
    CHECK((verdicts[0].index == 0 && verdicts[0].passed));
    CHECK((verdicts[1].index == 3 && verdicts[1].passed && verdicts[1].step == 1));
    CHECK((verdicts[2].index == 1 && verdicts[2].passed));
    CHECK((verdicts[3].index == 2 && !verdicts[3].passed));
    CHECK(verdicts[2].achieved == doctest::Approx(9.81));
    CHECK(verdicts[2].text.starts_with("speed of 'ball' point 0 = 9.81"));
    CHECK(verdicts[2].text.ends_with(", expected 9.81 within 0.1 %"));
    CHECK_FALSE(simulation.passed());
    CHECK(simulation.report().find("FAIL demo.json:7:9: expect[2]: kinetic energy = ") != std::string::npos);
  }

  TEST_CASE("the same scene gives the same bits") {
    const std::string text = *hooke::starter_scene("rope");
    hooke::Simulation a = simulate(text);
    hooke::Simulation b = simulate(text);
    step(a, 30);
    step(b, 30);
    CHECK(a.world().state_hash() == b.world().state_hash());
  }

  TEST_CASE("a mesh in place becomes a body and a cloth") {
    const hooke::Simulation simulation = simulate(R"({
      "version": 1,
      "meshes": {"roof": {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]]}},
      "bodies": [{"name": "body", "shape": {"mesh": "roof"}}],
      "cloths": [{"name": "cloth", "mesh": "roof", "pins": [{"topmost": 0.1}]}]
    })");
    const hooke::SceneObject* cloth = simulation.find("cloth");
    REQUIRE(cloth != nullptr);
    CHECK(simulation.world().positions(cloth->cloth).size() == 3);
    CHECK(cloth->model != nullptr);
    REQUIRE(simulation.find("body") != nullptr);
    CHECK(simulation.find("body")->shape.kind == hooke::ShapeKind::kMesh);
  }
}
