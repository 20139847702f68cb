#include "hooke/scene_io.h"

#include "io/model_support.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace {

using hooke::MeshDesc;

/// A mesh as the scene format writes it.
std::string text_of(const MeshDesc& mesh, const std::string& more = "") {
  std::ostringstream text;
  text << "{\"vertices\": [";
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const hooke::Vec3 p = mesh.positions[i];
    text << (i > 0 ? ", [" : "[") << p.x << ", " << p.y << ", " << p.z << "]";
  }
  text << "], \"triangles\": [";
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    text << (i > 0 ? ", [" : "[") << a << ", " << b << ", " << c << "]";
  }
  text << "]" << more << "}";
  return text.str();
}

/// A ball of radius 0.5 m without its top.
MeshDesc open_ball() {
  MeshDesc ball = hooke::io_test::sphere(0.5, 12, 24);
  std::erase_if(ball.triangles, [&](const auto& t) {
    return ball.positions[t[0]].y + ball.positions[t[1]].y + ball.positions[t[2]].y > 1.2f;
  });
  return ball;
}

hooke::Loaded<hooke::Simulation> load(const std::string& text) {
  auto scene = hooke::parse_scene(text, "demo.json");
  INFO((scene.errors.empty() ? "" : hooke::to_line(scene.errors.front())));
  REQUIRE(scene);
  return hooke::Simulation::create(std::move(*scene.value));
}

const std::string kGround = R"({"shape": {"half_space": {}}})";

std::string ball_scene(const std::string& more, const std::string& objects) {
  return R"({"version": 1, "seconds": 2, "meshes": {"ball": )" + text_of(open_ball(), more) + "}, " +
         objects + "}";
}

}  // namespace

TEST_SUITE("io/scene_meshes") {
  TEST_CASE(
      "an open mesh falls and lies on the ground, drawn as it was given, and a warning has the figures") {
    auto loaded = load(ball_scene("", R"("bodies": [)" + kGround + R"(,
        {"name": "ball", "kind": "dynamic", "shape": {"mesh": "ball"}, "position": [0, 1, 0]}])"));
    REQUIRE(loaded);
    REQUIRE(loaded.warnings.size() == 1);
    CHECK(loaded.warnings[0].message.find("closed for physics by voxels of 0.0156 m") != std::string::npos);
    CHECK(loaded.warnings[0].message.find("voxel_size") != std::string::npos);
    hooke::Simulation& simulation = *loaded.value;
    const hooke::SceneObject* ball = simulation.find("ball");
    REQUIRE(ball->model != nullptr);
    CHECK(ball->model->mesh.triangles.size() == open_ball().triangles.size());
    // The ball of radius 0.5 m, but for a cap of at most 0.1 m.
    const double whole = 4.0 / 3 * 3.14159265 * 0.125;
    const double mass = static_cast<double>(simulation.world().mass(ball->body));
    CHECK(mass > 0.93 * 1000 * whole);
    CHECK(mass < 1000 * whole);
    simulation.run();
    CHECK(simulation.world().pose(simulation.find("ball")->body).position.y ==
          doctest::Approx(0.5).epsilon(0.05));
  }

  TEST_CASE("a mesh of voxels that the scene asks for is a note and no warning") {
    const auto loaded = load(ball_scene(R"(, "voxel_size": 0.05)", R"("bodies": [
        {"kind": "dynamic", "shape": {"mesh": "ball"}}, {"kind": "dynamic", "shape": {"mesh": "ball"}}])"));
    REQUIRE(loaded);
    CHECK(loaded.warnings.empty());
    REQUIRE(loaded.notes.size() == 1);  // Once, however many bodies it has.
    CHECK(loaded.notes[0].message.find("voxels of 0.05 m") != std::string::npos);
    CHECK(loaded.notes[0].where.find("meshes.ball") != std::string::npos);
    const auto fine = load(ball_scene(R"(, "voxel_size": 1e-5)", R"("bodies": [
        {"kind": "dynamic", "shape": {"mesh": "ball"}}])"));
    CHECK_FALSE(fine);
    REQUIRE(fine.errors.size() == 1);
    CHECK(hooke::to_line(fine.errors[0]).find("meshes.ball.voxel_size: is too small") != std::string::npos);
  }

  TEST_CASE("an open mesh becomes jelly of its closed form, and carries its own triangles along") {
    const auto loaded = load(ball_scene("", R"("solids": [{"name": "jelly", "mesh": "ball", "cell": 0.2}])"));
    REQUIRE(loaded);
    CHECK(loaded.warnings.size() == 1);
    const hooke::Simulation& simulation = *loaded.value;
    const hooke::SceneObject* jelly = simulation.find("jelly");
    CHECK(simulation.world().triangles(jelly->solid).size() == open_ball().triangles.size());
    const double whole = 4.0 / 3 * 3.14159265 * 0.125;
    CHECK(jelly->mesh_volume == doctest::Approx(whole).epsilon(0.07));
    // At rest the drawn surface is where it was given.
    const auto places = simulation.world().surface(jelly->solid);
    const auto& given = jelly->model->mesh.positions;
    REQUIRE(places.size() == given.size());
    for (std::size_t i = 0; i < places.size(); ++i)
      CHECK(length(places[i] - hooke::vector_cast<double>(given[i])) < 1e-5);
  }

  TEST_CASE("a body and a solid collide as one thing and are drawn as another") {
    const auto loaded = load(ball_scene("", R"(
        "bodies": [{"name": "body", "kind": "dynamic", "shape": {"box": {"half_extents": [1, 1, 1]}}, "visual": "ball"}],
        "solids": [{"name": "box", "cells": [2, 2, 2], "position": [5, 0, 0], "visual": "ball"}])"));
    REQUIRE(loaded);
    CHECK(loaded.warnings.empty());  // Nothing collides as the open mesh.
    const hooke::Simulation& simulation = *loaded.value;
    CHECK(simulation.find("body")->visual != nullptr);
    CHECK(simulation.find("body")->shape.kind == hooke::ShapeKind::kBox);
    CHECK(static_cast<double>(simulation.world().mass(simulation.find("body")->body)) ==
          doctest::Approx(8000));
    CHECK(simulation.world().triangles(simulation.find("box")->solid).size() == open_ball().triangles.size());
    CHECK(simulation.world().positions(simulation.find("box")->solid).size() == 27 + 8);
    auto wrong = hooke::parse_scene(R"({"version": 1, "bodies": [{"shape": {"sphere": {}}, "visual": "bal"}],
                                        "meshes": {"ball": {"file": "ball.obj"}}})",
                                    "demo.json");
    REQUIRE_FALSE(wrong);
    CHECK(hooke::to_line(wrong.errors[0]).find("bodies[0].visual: there is no mesh 'bal'") !=
          std::string::npos);
  }

  TEST_CASE("convex parts are kept in a file and give the same bits; a broken file is as none") {
    const hooke::io_test::TemporaryFolder folder;
    std::vector<double> shown;
    const auto hash_with = [&](const std::string& cache) {
      const std::string text = ball_scene("", R"("bodies": [)" + kGround + R"(,
          {"name": "ball", "kind": "dynamic", "shape": {"mesh": "ball"}, "position": [0, 0.6, 0]}])");
      auto scene = hooke::parse_scene(text, "demo.json");
      shown.clear();
      auto loaded = hooke::Simulation::create(
          std::move(*scene.value), {},
          {.cache = cache, .progress = [&](std::string_view, double part) { shown.push_back(part); }});
      REQUIRE(loaded);
      for (int i = 0; i < 30; ++i) loaded.value->step();
      return loaded.value->world().state_hash();
    };
    const auto without = hash_with("");
    CHECK(shown.size() > 3);
    CHECK(std::is_sorted(shown.begin(), shown.end()));
    CHECK(shown.back() == 1);
    const std::string cache = folder / "cache/deep";
    CHECK(hash_with(cache) == without);
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(cache)) files.push_back(entry.path());
    REQUIRE(files.size() == 1);
    CHECK(hash_with(cache) == without);
    CHECK(shown.empty());  // Nothing had to be made.
    const std::string good = hooke::io_test::read_file(files[0].string());
    for (const std::size_t at : {std::size_t{9}, std::size_t{40}, good.size() - 1}) {
      std::string broken = good;
      broken[at] = static_cast<char>(broken[at] ^ 4);
      std::ofstream(files[0], std::ios::binary) << broken;
      CHECK(hash_with(cache) == without);
      CHECK(shown.size() > 3);
      CHECK(hooke::io_test::read_file(files[0].string()) == good);
    }
    CHECK(hash_with("/proc/no/such/folder") == without);
  }

  TEST_CASE("jelly that needs cells to stay whole says how many") {
    MeshDesc dumbbell = hooke::io_test::box({0.2f, 0.2f, 0.2f}, {0, 0, 0});
    hooke::io_test::append(dumbbell, hooke::io_test::box({0.2f, 0.2f, 0.2f}, {1, 0, 0}));
    hooke::io_test::append(dumbbell, hooke::io_test::box({0.4f, 0.01f, 0.01f}, {0.5f, 0, 0}));
    const auto loaded = load(R"({"version": 1, "meshes": {"dumbbell": )" + text_of(dumbbell) +
                             R"(}, "solids": [{"mesh": "dumbbell", "cell": 0.1}]})");
    REQUIRE(loaded);
    REQUIRE(loaded.notes.size() == 1);
    CHECK(loaded.notes[0].where.find("solids[0]") != std::string::npos);
    CHECK(loaded.notes[0].message.find("cells were added along thin parts") != std::string::npos);
  }

  TEST_CASE("an image that a model names and that is not there is a warning, and the scene goes on") {
    const auto importer = hooke::io_test::built_importer();
    const hooke::io_test::TemporaryFolder folder;
    (void)folder.file("tip.mtl", "newmtl a\nKd 1 0 0\nmap_Kd gone.png\nnorm gone_too.png\n");
    (void)folder.file("tip.obj", "mtllib tip.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n");
    auto scene = hooke::parse_scene(
        R"({"version": 1, "meshes": {"tip": {"file": "tip.obj"}}, "bodies": [{"shape": {"mesh": "tip"}}]})",
        (folder.path() / "demo.json").string());
    REQUIRE(scene);
    const auto loaded = hooke::Simulation::create(std::move(*scene.value));
    REQUIRE(loaded);
    std::vector<std::string> lines;
    for (const hooke::Error& warning : loaded.warnings) {
      CHECK(warning.where.ends_with("meshes.tip.file"));
      lines.push_back(warning.message);
    }
    std::sort(lines.begin(), lines.end());
    CHECK(lines == std::vector<std::string>{
                       "its image 'gone.png' is not beside it, and is left out: put it there",
                       "its image 'gone_too.png' is not beside it, and is left out: put it there"});
  }
}
