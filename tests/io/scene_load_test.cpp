#include "hooke/scene_io.h"

#include <cmath>
#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>

namespace {

/// A folder that is gone after the test.
struct Folder {
  std::filesystem::path path = std::filesystem::temp_directory_path() / "hooke_scene_load_test";
  Folder() {
    std::filesystem::remove_all(path);
    std::filesystem::create_directories(path / "scene" / "models");
  }
  ~Folder() { std::filesystem::remove_all(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path / name) << text;
    return (path / name).string();
  }
};

std::string first_line(const hooke::Loaded<hooke::Scene>& loaded) {
  return loaded.errors.empty() ? "" : hooke::to_line(loaded.errors.front());
}

}  // namespace

TEST_SUITE("io/scene_load") {
  TEST_CASE("every kind of object arrives in its descriptor") {
    const auto loaded = hooke::parse_scene(R"({
      "$schema": "schema.json",
      "version": 1,  // a comment
      "world": {"gravity": [0, -1.62, 0], "substeps": 4, "wind": {"velocity": [3, 0, 0], "gusts": "paper"}},
      "dt": 0.01, "seconds": 2, "accuracy": {"max_error": 1e-4},
      "laboratory": {"stepper": "verlet", "collider": "faces", "preselection": "sphere_tree",
                     "rollback": "halving", "sweep": "none", "epsilon": 1e-3, "iteration_limit": 5,
                     "regional": false},
      "bodies": [{"shape": {"sphere": {"radius": 0.25}}, "rotation": {"axis": [0, 0, 2], "angle_deg": 90}}],
      "ropes": [{"masses": 32, "stiffness": 1e4, "stiffness_of": "segment", "extension_max": "rigid", "stepper": "rk4",
                 "pins": [0, {"point": "last", "motion": {"sine": {"amplitude": [0, 0, 0.1]}}}]}],
      "cloths": [{"columns": 5, "rows": 4, "bend": "spring", "total_mass": 0.5, "pins": [{"row": "last"}]}],
      "particles": [{"particles": [{"position": [0, 0, 0], "mass": 2}, {"position": [1, 0, 0]}],
                     "springs": [{"a": 0, "b": 1, "rest_length": 0.5}]}],
      "fields": [{"inverse_square": {"strength": 4}},
                 {"explosion": {"time": 0.5, "strength": 3, "reach": 2}}]
    })",
                                           "demo.json");
    INFO(first_line(loaded));
    REQUIRE(loaded);
    const hooke::Scene& scene = *loaded.value;
    CHECK(scene.world.gravity == hooke::Vec3{0, hooke::Real(-1.62), 0});
    CHECK(scene.world.wind.gusts == hooke::WindDesc::Gusts::kPaper);
    CHECK(scene.step_count() == 200);
    REQUIRE(scene.laboratory.has_value());
    const hooke::lab::CollisionOptions& collisions = scene.laboratory->collisions;
    CHECK(scene.laboratory->stepper == "verlet");
    CHECK(collisions.collider == hooke::lab::CollisionOptions::Collider::kFaces);
    CHECK(collisions.preselection == hooke::Preselection::kSphereTree);
    CHECK(collisions.search == hooke::lab::CollisionOptions::Search::kHalving);
    CHECK(collisions.sweep == hooke::lab::CollisionOptions::Sweep::kNone);
    CHECK(collisions.epsilon == doctest::Approx(1e-3));
    CHECK(collisions.iteration_limit == 5);
    CHECK_FALSE(collisions.regional);
    REQUIRE(scene.accuracy.has_value());
    CHECK(scene.accuracy->max_error == doctest::Approx(1e-4));
    const hooke::BodyDesc& body = scene.objects.bodies.at(0).desc;
    CHECK(body.shape.kind == hooke::ShapeKind::kSphere);
    CHECK(body.shape.radius == hooke::Real(0.25));
    CHECK(static_cast<double>(body.rotation.z) == doctest::Approx(std::sqrt(0.5)));
    const hooke::SceneRope& rope = scene.objects.ropes.at(0);
    CHECK(rope.tag.stepper == "rk4");
    CHECK(scene.objects.cloths.at(0).tag.stepper.empty());
    CHECK(rope.desc.masses == 32);
    CHECK(rope.desc.stiffness_of == hooke::RopeDesc::StiffnessOf::kSegment);
    CHECK(rope.desc.extension_max == hooke::kRigid);
    CHECK(rope.pins.at(1).point.last);
    CHECK(rope.pins.at(1).motion.kind == hooke::MotionDesc::Kind::kSine);
    const hooke::SceneCloth& cloth = scene.objects.cloths.at(0);
    CHECK(cloth.desc.total_mass == hooke::Real(0.5));
    CHECK(cloth.pins.at(0).pick == hooke::ScenePin::Pick::kRow);
    const hooke::ParticlesDesc& particles = scene.objects.particles.at(0).desc;
    CHECK(particles.particles.at(0).mass == hooke::Real(2));
    CHECK(particles.springs.at(0).rest_length == hooke::Real(0.5));
    CHECK(scene.objects.fields.at(0).desc.kind == hooke::FieldDesc::Kind::kInverseSquare);
    CHECK(scene.objects.fields.at(1).desc.kind == hooke::FieldDesc::Kind::kExplosion);
    CHECK(scene.objects.fields.at(1).desc.time == 0.5);
  }

  TEST_CASE("a body that moves arrives in its descriptor, with its parts and what two materials do") {
    const auto loaded = hooke::parse_scene(R"({
      "version": 1,
      "world": {"contact_hz": 30, "sleeping": false},
      "meshes": {"rock": {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], "triangles": [[0, 1, 2]]}},
      "materials": {"ice": {"friction": 0.02, "static_friction": 0.05, "restitution": 0.5}, "steel": {}},
      "material_pairs": [{"a": "ice", "b": "steel", "friction": 0.01}],
      "bodies": [
        {"kind": "dynamic", "shape": {"parts": [
           {"shape": {"cylinder": {"radius": 0.2, "half_height": 3}}, "position": [0, 1, 0]},
           {"shape": {"hull": "rock"}, "density": 7800, "material": "ice"}]},
         "velocity": [1, 0, 0], "angular_velocity": [0, 2, 0], "mass": 5, "mask": 6, "bullet": true},
        {"kind": "kinematic", "shape": {"box": {}}, "motion": {"velocity": [0, 1, 0]}, "surface_velocity": [3, 0, 0]}]
    })",
                                           "demo.json");
    INFO(first_line(loaded));
    REQUIRE(loaded);
    const hooke::Scene& scene = *loaded.value;
    CHECK(scene.world.contact_hz == hooke::Real(30));
    CHECK_FALSE(scene.world.sleeping);
    CHECK(scene.materials.at(0).static_friction == hooke::Real(0.05));
    CHECK(scene.material_pairs.at(0).b == "steel");
    const hooke::SceneBody& body = scene.objects.bodies.at(0);
    CHECK(body.desc.kind == hooke::BodyKind::kDynamic);
    CHECK(body.desc.shape.kind == hooke::ShapeKind::kCompound);
    CHECK(body.desc.velocity == hooke::Vec3{1, 0, 0});
    CHECK(body.desc.angular_velocity == hooke::Vec3{0, 2, 0});
    CHECK(body.desc.mass == hooke::Real(5));
    CHECK(body.desc.filter.mask == 6);
    CHECK(body.desc.bullet);
    REQUIRE(body.parts.size() == 2);
    CHECK(body.parts[0].desc.shape.kind == hooke::ShapeKind::kCylinder);
    CHECK(body.parts[0].desc.shape.half_height == hooke::Real(3));
    CHECK(body.parts[0].desc.position == hooke::Vec3{0, 1, 0});
    CHECK(body.parts[1].desc.shape.kind == hooke::ShapeKind::kHull);
    CHECK(body.parts[1].mesh == "rock");
    CHECK(body.parts[1].material == "ice");
    CHECK(body.parts[1].desc.density == hooke::Real(7800));
    CHECK(scene.objects.bodies.at(1).desc.kind == hooke::BodyKind::kKinematic);
    CHECK(scene.objects.bodies.at(1).desc.motion.kind == hooke::MotionDesc::Kind::kConstantVelocity);
    CHECK(scene.objects.bodies.at(1).desc.contact.surface_velocity == hooke::Vec3{3, 0, 0});
  }

  TEST_CASE("turns about the fixed axes come in the order x, y, z") {
    const auto loaded = hooke::parse_scene(
        R"({"version": 1, "bodies": [{"shape": {"box": {}}, "rotation": {"euler_deg": [90, 0, 90]}}]})",
        "demo.json");
    REQUIRE(loaded);
    // About x the y axis goes to z, which the turn about z leaves alone.
    const hooke::Vec3 turned =
        hooke::rotate(loaded.value->objects.bodies[0].desc.rotation, hooke::Vec3{0, 1, 0});
    CHECK(static_cast<double>(turned.z) == doctest::Approx(1.0));
  }

  TEST_CASE("an event after the end is a warning") {
    const auto loaded = hooke::parse_scene(
        R"({"version": 1, "seconds": 1, "timeline": [{"at_step": 60, "gravity": [0, 0, 0]}]})", "demo.json");
    REQUIRE(loaded);
    REQUIRE(loaded.warnings.size() == 1);
    CHECK(hooke::to_line(loaded.warnings[0]) ==
          "demo.json:1:55: timeline[0].at_step: never happens: the scene ends at step 60");
  }

  TEST_CASE("what a scene says in vain is a warning, with its place and the reason") {
    struct Vain {
      const char* content;  ///< Of the scene.
      std::vector<const char*> lines;
    };
    const std::string head = R"({"version": 1, )";
    const Vain cases[] = {
        {R"("bodies": [{"shape": {"box": {}}, "mass": 3, "velocity": [1, 0, 0]}])",
         {"1:50: bodies[0].mass: has no effect: forces do not move this body, which is not dynamic",
          "1:61: bodies[0].velocity: has no effect: a static body never moves"}},
        {R"("bodies": [{"kind": "kinematic", "shape": {"box": {}}, "velocity": [1, 0, 0], "motion": {"velocity": [0, 1, 0]}}])",
         {"1:71: bodies[0].velocity: has no effect: 'motion' replaces it"}},
        {R"("bodies": [{"kind": "dynamic", "shape": {"box": {}}, "mass": 1, "density": 2}])",
         {"1:80: bodies[0].density: has no effect: 'mass' replaces it"}},
        {R"("ropes": [{"points": [[0, 0, 0], [1, 0, 0]], "masses": 4, "poisson_ratio": 0.3}])",
         {"1:61: ropes[0].masses: has no effect: 'points' replaces it",
          "1:74: ropes[0].poisson_ratio: has no effect: it is for 'young_modulus'"}},
        {R"("cloths": [{"bend": "none", "bend_stiffness": 1, "position": [1, 0, 0]}])",
         {"1:44: cloths[0].bend_stiffness: has no effect: 'bend' is \"none\"",
          "1:65: cloths[0].position: has no effect: it is for a mesh; a grid has a 'corner'"}},
        {R"("solids": [{"match_hz": 3, "cell": 0.2}])",
         {"1:28: solids[0].match_hz: has no effect: it is for shape matching",
          "1:43: solids[0].cell: has no effect: it is for a mesh; a box has 'cells'"}},
        {R"("world": {"wind": {"gust": 0.5}})",
         {"1:35: world.wind.gust: has no effect: gusts are relative to 'velocity', which is zero"}},
        {R"("bodies": [{"name": "b", "kind": "dynamic", "shape": {"box": {}}}], "hooks": [{"b": "b", "kind": "fixed",)"
         R"( "anchor": [0, 0, 0], "motor": {"max_force": 3}}])",
         {"1:143: hooks[0].motor: has no effect: this kind of hook has none"}},
        {R"("ropes": [{}], "hooks": [{"a": "ropes[0].end", "b": "ropes[0].start", "cone": 1}])",
         {"1:94: hooks[0].cone: has no effect: a point has no rotation"}},
        {R"("bodies": [{"name": "b", "kind": "dynamic", "shape": {"box": {}}}], )"
         R"("timeline": [{"at_step": 1, "impulse": {"object": "b", "point": 0, "impulse": [1, 0, 0]}}])",
         {"1:148: timeline[0].impulse.point: has no effect: 'b' is a body, which has no points"}},
        {R"("bodies": [{"name": "b", "kind": "dynamic", "shape": {"box": {}}}], )"
         R"("expect": [{"quantity": "y", "of": "b", "point": 0, "op": "<", "value": 1, "tolerance": 1}])",
         {"1:133: expect[0].point: has no effect: 'b' is a body, which has no points",
          "1:159: expect[0].tolerance: has no effect: it is for \"==\" and \"within\""}},
        {R"("sky": {"sun": 0, "sun_color": [1, 0, 0]})",
         {"1:34: sky.sun_color: has no effect: there is no sun"}},
        {R"("sky": {"sun": 0, "sun_direction": [1, 0, 0]}, "lights": [{"direction": [1, 0, 0], "inner_deg": 3}, )"
         R"({"kind": "directional", "position": [1, 0, 0], "outer_deg": 40}])",
         {"1:34: sky.sun_direction: has no effect: there is no sun",
          "1:75: lights[0].direction: has no effect: its light goes to all sides",
          "1:99: lights[0].inner_deg: has no effect: it is for a spot",
          "1:140: lights[1].position: has no effect: its light comes from far away",
          "1:163: lights[1].outer_deg: has no effect: it is for a spot"}},
        {R"("ropes": [{"stiffness": 100, "masses": 4, "repulsion_strength": 1, "repulsion_range": 0.1}])",
         {}},
    };
    for (const Vain& one : cases) {
      INFO(one.content);
      const auto loaded = hooke::parse_scene(head + one.content + "}", "demo.json");
      REQUIRE(loaded);
      std::vector<std::string> lines;
      for (const hooke::Error& warning : loaded.warnings) lines.push_back(hooke::to_line(warning));
      REQUIRE(lines.size() == one.lines.size());
      for (std::size_t i = 0; i < lines.size(); ++i)
        CHECK(lines[i] == std::string("demo.json:") + one.lines[i]);
    }
  }

  TEST_CASE("a byte order mark is not part of the first line") {
    CHECK(hooke::parse_scene("\xEF\xBB\xBF{\"version\": 1}", "demo.json"));
  }

  TEST_CASE("a file that is not there, or is a folder, is an error") {
    CHECK(first_line(hooke::load_scene("/nowhere/demo.json")) == "/nowhere/demo.json: no such file");
    CHECK(first_line(hooke::load_scene("/dev/zero")) == "/dev/zero: is not a file");
    CHECK(first_line(hooke::load_scene("/tmp")) == "/tmp: is not a file");
  }

  TEST_CASE("files of a scene stay in its folder and are there") {
    const Folder folder;
    const std::string outside = folder.write("secret.obj", "v 0 0 0");
    const std::string inside = folder.write("scene/models/a.obj", "v 0 0 0");
    std::filesystem::create_symlink(outside, folder.path / "scene" / "link.obj");
    const auto load = [&](const std::string& file) {
      const std::string path =
          folder.write("scene/demo.json", R"({"version": 1, "meshes": {"m": {"file": ")" + file + "\"}}}");
      std::string line = first_line(hooke::load_scene(path));
      return line.substr(std::min(line.find("meshes"), line.size()));
    };
    CHECK(load("models/a.obj").empty());
    CHECK(load("models/../models/a.obj").empty());
    CHECK(load("models/b.obj") == "meshes.m.file: no such file 'models/b.obj'");
    CHECK(load("../secret.obj") == "meshes.m.file: '../secret.obj' is outside of the scene's folder");
    CHECK(load("models/../../secret.obj") ==
          "meshes.m.file: 'models/../../secret.obj' is outside of the scene's folder");
    CHECK(load(inside).find("is outside of the scene's folder") != std::string::npos);
    CHECK(load("link.obj") == "meshes.m.file: 'link.obj' is outside of the scene's folder");
    CHECK(load("..\\\\secret.obj") ==
          "meshes.m.file: '..\\secret.obj' has a character that a path must not have");
  }
}

TEST_SUITE("io/scene_hostile") {
  TEST_CASE("deep nesting ends at its limit") {
    const std::string text = R"({"version": 1, "a": )" + std::string(100000, '[');
    CHECK(first_line(hooke::parse_scene(text, "demo.json")) ==
          "demo.json:1:84: nested deeper than 64 levels");
  }

  TEST_CASE("a file of too many values ends at its limit") {
    std::string text = "[";
    for (int i = 0; i < 2'500'000; ++i) text += "0,";
    text.back() = ']';
    CHECK(first_line(hooke::parse_scene(text, "demo.json")) ==
          "demo.json:1:4000000: more than 2000000 values in one file");
  }

  TEST_CASE("a file of too many empty lines is not parsed") {
    CHECK(first_line(hooke::parse_scene(std::string(9'000'000, '\n'), "demo.json")) ==
          "demo.json:1:1: more than 8000000 line ends and tabs in one file");
  }

  TEST_CASE("a file that is too large is not parsed") {
    CHECK(first_line(hooke::parse_scene(std::string((std::size_t{64} << 20U) + 1, ' '), "demo.json")) ==
          "demo.json:1:1: the file is larger than 64 MiB");
  }

  TEST_CASE("an array that overflows every counter is refused before anything is allocated") {
    const auto loaded = hooke::parse_scene(
        R"({"version": 1, "ropes": [{"masses": 65536, "array": {"grid": [1000000, 1000000, 1000000]}}]})",
        "demo.json");
    CHECK(first_line(loaded) ==
          "demo.json:1:26: ropes[0]: with this object the scene has more than 1000000 points");
  }

  TEST_CASE("many objects with many unknown names do not take the square of their number") {
    std::string text = R"({"version": 1, "materials": {)";
    for (int i = 0; i < 20000; ++i) text += "\"material" + std::to_string(i) + "\": {},";
    text.back() = '}';
    text += ", \"ropes\": [";
    for (int i = 0; i < 50000; ++i) text += R"({"material": "material19999"},)";
    text.back() = ']';
    const auto loaded = hooke::parse_scene(text + "}", "demo.json");
    INFO(first_line(loaded));
    CHECK(loaded);
  }

  TEST_CASE("a text cut off anywhere is an error or nothing, never a crash") {
    const std::string text = *hooke::starter_scene("flag");
    std::size_t accepted = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
      accepted += hooke::parse_scene(text.substr(0, i), "demo.json") ? 1 : 0;
    }
    // Only the closing line feed can be missing.
    CHECK(accepted == 1);
  }

  TEST_CASE("no single damaged byte makes a message of two lines") {
    const std::string text = *hooke::starter_scene("rope");
    for (std::size_t i = 0; i < text.size(); ++i) {
      for (const char byte : {'\0', '\n', '"', '\x7F', '\xC3', '9', '['}) {
        std::string damaged = text;
        damaged[i] = byte;
        for (const hooke::Error& error : hooke::parse_scene(damaged, "demo.json").errors) {
          const std::string line = hooke::to_line(error);
          CHECK(line.find('\n') == std::string::npos);
          CHECK(line.size() < 1000);
        }
      }
    }
  }
}
