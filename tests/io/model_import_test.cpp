#include "hooke/model_io.h"

#include "geometry/mesh/preselection.h"
#include "io/model_support.h"

#include <algorithm>
#include <array>
#include <doctest/doctest.h>
#include <limits>
#include <string>
#include <vector>

using hooke::ErrorCode;
using hooke::import_model;
using hooke::ImportOptions;
using hooke::Model;
using hooke::UpAxis;
using hooke::geometry::triangles_overlap;
using hooke::io_test::built_importer;
using hooke::io_test::measure;
using hooke::io_test::Measures;
using hooke::io_test::sample;
using hooke::io_test::TemporaryFolder;

namespace {

/// A tetrahedron with corners at the origin and 1, 2, 3 along x, y, z: no axis like another.
constexpr const char* kTetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

Model imported(const std::string& path, const ImportOptions& options = {}) {
  auto model = import_model(path, options);
  if (!model) FAIL(model.error().where, ": ", model.error().message);
  CHECK(model.value().welded_of.size() == model.value().vertices.size());
  return std::move(model).value();
}

void check_bounds(const Measures& m, hooke::DVec3 low, hooke::DVec3 high) {
  CHECK(length(m.low - low) == doctest::Approx(0).epsilon(1e-5));
  CHECK(length(m.high - high) == doctest::Approx(0).epsilon(1e-5));
}

std::string own(const std::string& name) {
  return std::string(HOOKE_OWN_MODELS) + "/" + name;
}

}  // namespace

TEST_SUITE("io/model_import") {
  TEST_CASE("the lantern hangs upright, is closed, and has its four materials") {
    const auto importer = built_importer();
    const Model lantern = imported(own("lantern.3ds"));
    const Measures m = measure(lantern.mesh);
    CHECK(lantern.mesh.triangles.size() == 760);
    CHECK(m.open_edges == 0);
    CHECK(m.volume == doctest::Approx(0.0303).epsilon(0.01).scale(0));
    CHECK(m.high.y == doctest::Approx(0.195));
    CHECK(m.low.y == doctest::Approx(-0.300));
    REQUIRE(lantern.materials.size() == 4);
    CHECK(lantern.materials[0].name == "paper");
    CHECK(lantern.materials[0].texture == own("lantern.png"));
    CHECK(lantern.materials[0].color == std::array{1.0f, 1.0f, 1.0f});
    CHECK(lantern.materials[1].color[0] ==
          doctest::Approx(0.048).epsilon(0.02).scale(0));  // 62/255 made linear
    CHECK(lantern.materials[1].shininess == 30);
    // v grows with height: the paper's image stands the right way up.
    for (std::uint32_t i = 0; i < lantern.parts[0].count; ++i) {
      const auto& vertex = lantern.vertices[lantern.indices[i]];
      CHECK(vertex.uv[1] == doctest::Approx(0.5 + 0.5 * vertex.position[1] / 0.165).epsilon(1e-3));
    }
  }

  TEST_CASE("the crate is a closed box with one texture") {
    const auto importer = built_importer();
    const Model crate = imported(own("crate.3ds"));
    CHECK(measure(crate.mesh).open_edges == 0);
    CHECK(measure(crate.mesh).volume == doctest::Approx(0.5 * 0.5 * 0.5 - 6 * 0.39 * 0.39 * 0.018));
    check_bounds(measure(crate.mesh), {-0.25, -0.25, -0.25}, {0.25, 0.25, 0.25});
    REQUIRE(crate.materials.size() == 1);
    CHECK(crate.materials[0].texture == own("crate.png"));
  }

  TEST_CASE("each up axis turns to y without mirroring") {
    const auto importer = built_importer();
    const TemporaryFolder folder;
    const std::string path = folder.file("corner.obj", kTetrahedron);
    const auto measured = [&](UpAxis up) { return measure(imported(path, {.up = up}).mesh); };
    check_bounds(measured(UpAxis::kFormat), {0, 0, 0}, {1, 2, 3});
    check_bounds(measured(UpAxis::kY), {0, 0, 0}, {1, 2, 3});
    check_bounds(measured(UpAxis::kZ), {0, 0, -2}, {1, 3, 0});
    check_bounds(measured(UpAxis::kX), {-2, 0, 0}, {0, 1, 3});
    for (const UpAxis up : {UpAxis::kX, UpAxis::kY, UpAxis::kZ})
      CHECK(measured(up).volume == doctest::Approx(1));
  }

  TEST_CASE("scale multiplies and fit decides the longest side") {
    const auto importer = built_importer();
    const TemporaryFolder folder;
    const std::string path = folder.file("corner.OBJ", kTetrahedron);
    check_bounds(measure(imported(path, {.scale = 0.01}).mesh), {0, 0, 0}, {0.01, 0.02, 0.03});
    check_bounds(measure(imported(path, {.scale = 7, .fit = 1.5}).mesh), {0, 0, 0}, {0.5, 1, 1.5});
  }

  TEST_CASE("options that make no sense are refused with the path") {
    const double infinity = std::numeric_limits<double>::infinity();
    for (const ImportOptions& options :
         {ImportOptions{.scale = 0}, ImportOptions{.scale = -1}, ImportOptions{.scale = infinity},
          ImportOptions{.fit = 0}, ImportOptions{.fit = infinity - infinity},
          ImportOptions{.up = static_cast<UpAxis>(9)}}) {
      const auto model = import_model("x.obj", options);
      REQUIRE_FALSE(model.has_value());
      CHECK(model.error().code == ErrorCode::kOutOfRange);
      CHECK(model.error().where == "x.obj");
    }
  }

  TEST_CASE("a tetrahedron wound inside out comes in outside out, with normals that agree") {
    const auto importer = built_importer();
    const TemporaryFolder folder;
    const std::string path =
        folder.file("inverted.obj",
                    "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nvn 0 0 1\nvn 0 1 0\nvn 1 0 0\nvn -1 -1 -1\n"
                    "f 1//1 2//1 3//1\nf 1//2 4//2 2//2\nf 1//3 3//3 4//3\nf 2//4 4//4 3//4\n");
    const Model model = imported(path);
    CHECK(measure(model.mesh).volume == doctest::Approx(1));
    for (std::size_t i = 0; i < model.indices.size(); i += 3) {
      std::array<hooke::DVec3, 3> p = {};
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& v = model.vertices[model.indices[i + k]].position;
        p[k] = {v[0], v[1], v[2]};
      }
      const auto& n = model.vertices[model.indices[i]].normal;
      CHECK(dot(cross(p[1] - p[0], p[2] - p[0]), hooke::DVec3{n[0], n[1], n[2]}) > 0);
    }
  }

  TEST_CASE("text of 16-bit characters and marks of the byte order come in as other text does") {
    const auto importer = built_importer();
    const TemporaryFolder folder;
    const std::string obj = std::string("mtllib look.mtl\nusemtl green\n") + kTetrahedron;
    const std::string mtl = "newmtl green\nKd 0 1 0\n";
    const auto wide = [](const std::string& text, bool big_end_first) {
      std::string result = big_end_first ? "\xFE\xFF" : "\xFF\xFE";
      for (const char c : text) result += big_end_first ? std::string{'\0', c} : std::string{c, '\0'};
      return result;
    };
    const std::string texts[][2] = {{wide(obj, true), wide(mtl, true)},
                                    {wide(obj, false), wide(mtl, false)},
                                    {"\xEF\xBB\xBF" + std::string(kTetrahedron), ""},
                                    {"\xEF\xBB\xBF" + obj, "\xEF\xBB\xBF" + mtl}};
    for (const auto& [shape, look] : texts) {
      CAPTURE(shape);
      (void)folder.file("look.mtl", look);
      const Model model = imported(folder.file("text.obj", shape));
      CHECK(measure(model.mesh).volume == doctest::Approx(1));
      if (!look.empty()) CHECK(model.materials.back().color == std::array<float, 3>{0, 1, 0});
    }
    // A lone half of a pair, and half a character at the end.
    const std::string torn =
        wide(kTetrahedron, false) + std::string("#\0", 2) + std::string("\x00\xD8", 2) + "x";
    CHECK(measure(imported(folder.file("torn.obj", torn)).mesh).volume == doctest::Approx(1));
  }

  TEST_CASE("metalness, roughness, normals and their strength of a .gltf come with its images") {
    const auto importer = built_importer();
    const TemporaryFolder folder;
    (void)folder.file("bumps.png", "no picture, but a file");
    const std::string path = folder.file("plate.gltf", R"({"asset": {"version": "2.0"}, "scene": 0,
      "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
      "materials": [{"name": "steel", "normalTexture": {"index": 0, "scale": 2},
        "pbrMetallicRoughness": {"metallicFactor": 0.5, "roughnessFactor": 0.25,
                                 "metallicRoughnessTexture": {"index": 1}}}],
      "textures": [{"source": 0}, {"source": 1}], "images": [{"uri": "bumps.png"}, {"uri": "worn.png"}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                     "min": [0, 0, 0], "max": [1, 1, 0]}],
      "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36,
        "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
    const Model plate = imported(path);
    const auto found =
        std::find_if(plate.materials.begin(), plate.materials.end(),
                     [](const hooke::ModelMaterial& material) { return material.name == "steel"; });
    REQUIRE(found != plate.materials.end());
    CHECK(found->metalness == 0.5f);
    REQUIRE(found->roughness.has_value());
    CHECK(*found->roughness == 0.25f);
    CHECK(found->normal_map.file.ends_with("/bumps.png"));
    CHECK(found->normal_scale == 2.0f);
    // What is not there is named, and the rest goes on.
    CHECK(found->roughness_map.file.empty());
    CHECK(plate.missing_images == std::vector<std::string>{"worn.png"});
  }

  TEST_CASE("the relief of a .mtl is that of norm or map_Bump, and a missing image is named once") {
    const auto importer = built_importer();
    const TemporaryFolder folder;
    (void)folder.file("bumps.png", "no picture, but a file");
    (void)folder.file("two.mtl",
                      "newmtl a\nKd 1 0 0\nnorm bumps.png\nPm 0.5\nPr 0.25\nnewmtl b\nKd 0 1 0\n"
                      "map_Bump -bm 0.5 BUMPS.png\nmap_Kd gone.png\nnewmtl c\nKd 0 0 1\nmap_Kd gone.png\n");
    const std::string path = folder.file(
        "two.obj", std::string("mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nusemtl a\nf 1 3 2\n") +
                       "usemtl b\nf 1 2 4\nusemtl c\nf 1 4 3\nf 2 3 4\n");
    const Model model = imported(path);
    const auto named = [&](const char* name) -> const hooke::ModelMaterial& {
      const auto found =
          std::find_if(model.materials.begin(), model.materials.end(),
                       [&](const hooke::ModelMaterial& material) { return material.name == name; });
      REQUIRE(found != model.materials.end());
      return *found;
    };
    CHECK(named("a").normal_map.file.ends_with("/bumps.png"));
    CHECK(named("a").metalness == 0.5f);
    CHECK(named("a").roughness == 0.25f);
    CHECK(named("b").normal_map.file.ends_with("/bumps.png"));
    CHECK(named("b").normal_scale == 0.5f);
    CHECK(named("b").color == std::array{0.0f, 1.0f, 0.0f});
    CHECK(named("c").normal_map.file.empty());
    CHECK(model.missing_images == std::vector<std::string>{"gone.png"});
  }

  TEST_CASE("a mirrored node of a .gltf keeps its outside outside, and open sheets turn with it") {
    const auto importer = built_importer();
    const TemporaryFolder folder;
    // One triangle with +z as its front, once as it is and once mirrored in x.
    const std::string buffer("\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80?\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80?\0\0\0\0",
                             36);
    (void)folder.file("triangle.bin", buffer);
    const std::string path = folder.file("mirrored.gltf",
                                         R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],
            "nodes":[{"mesh":0},{"mesh":0,"scale":[-1,1,1],"translation":[5,0,0]}],
            "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
            "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
                          "min":[0,0,0],"max":[1,1,0]}],
            "bufferViews":[{"buffer":0,"byteLength":36}],
            "buffers":[{"uri":"triangle.bin","byteLength":36}]})");
    const Model model = imported(path);
    CHECK(model.indices.size() == 6);
    check_bounds(measure(model.mesh), {0, 0, 0}, {5, 1, 0});
    for (const auto& vertex : model.vertices) CHECK(vertex.normal[2] == doctest::Approx(1));
  }

  TEST_CASE("a texture is found beside the model whatever its case, and nowhere else") {
    const auto importer = built_importer();
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder.path() / "sub");
    (void)folder.file("Brick Wall.PNG", "image");
    (void)folder.file("secret.png", "image");
    const std::string faces = std::string("mtllib m.mtl\n") + kTetrahedron;
    const auto textured = [&](const std::string& name) {
      (void)folder.file("m.mtl", "newmtl a\nKd 0.5 0.5 0.5\nmap_Kd " + name + "\n");
      (void)folder.file("sub/m.mtl", "newmtl a\nKd 0.5 0.5 0.5\nmap_Kd " + name + "\n");
      return "mtllib m.mtl\nusemtl a\n" + std::string(kTetrahedron);
    };
    const Model found = imported(folder.file("a.obj", textured("C:\\art\\brick wall.png")));
    CHECK(found.materials[0].texture == folder / "Brick Wall.PNG");
    CHECK(found.materials[0].color[0] == 1.0f);
    const Model lost = imported(folder.file("sub/a.obj", textured("../secret.png")));
    CHECK(lost.materials[0].texture.empty());
    CHECK(lost.materials[0].color[0] == doctest::Approx(0.214).epsilon(0.01));
  }

  TEST_CASE("a material library outside the folder is not read") {
    const auto importer = built_importer();
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder.path() / "sub");
    (void)folder.file("m.mtl", "newmtl a\nKd 0 1 0\n");
    const std::string text = "mtllib ../m.mtl\nusemtl a\n" + std::string(kTetrahedron);
    CHECK(imported(folder.file("sub/a.obj", text)).materials[0].color[0] > 0.1f);
    CHECK(imported(folder.file("a.obj", text)).materials[0].color[0] == 0.0f);
  }

  TEST_CASE("a polygon with a hole comes in with its area and its material") {
    const auto importer = built_importer();
    const std::string path = sample("other/concave_polygon.obj");
    if (path.empty()) return;
    const Model ring = imported(path);
    CHECK(ring.mesh.triangles.size() == 64);
    // Between regular 32-gons of radius 0.7425 and 0.6875.
    const double area = 16 * std::sin(2 * 3.14159265358979 / 32) * (0.7425 * 0.7425 - 0.6875 * 0.6875);
    CHECK(measure(ring.mesh).area == doctest::Approx(area).epsilon(1e-3));
    REQUIRE(ring.materials.size() == 1);
    CHECK(ring.materials[0].color[2] == doctest::Approx(0.141).epsilon(0.01));  // 0.4118 made linear
    CHECK(ring.materials[0].shininess == 400);
  }

  TEST_CASE("models of other programs come in with the size, sides and looks they have") {
    const auto importer = built_importer();
    if (const std::string path = sample("3ds/cube_with_diffuse_texture.3DS"); !path.empty()) {
      const Model cube = imported(path);
      CHECK(measure(cube.mesh).volume == doctest::Approx(125000));
      CHECK(measure(cube.mesh).open_edges == 0);
      CHECK(cube.vertices.size() == 24);
      CHECK(cube.materials[0].texture == sample("3ds/test.png"));
    }
    if (const std::string path = sample("3ds/cubes_with_alpha.3DS"); !path.empty()) {
      const Model cubes = imported(path);
      CHECK(cubes.parts.size() == 5);
      CHECK(cubes.materials[4].opacity == doctest::Approx(0.83));
      CHECK(measure(cubes.mesh).volume == doctest::Approx(2.25e8));
    }
    if (const std::string path = sample("3ds/fels.3ds"); !path.empty()) {
      const Model rock = imported(path);
      CHECK(rock.vertices.size() == rock.mesh.positions.size());  // smooth all over
      CHECK(measure(rock.mesh).volume == doctest::Approx(37.215).epsilon(1e-3));
    }
    if (const std::string path = sample("other/BoxTextured.glb"); !path.empty()) {
      check_bounds(measure(imported(path).mesh), {-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
      const hooke::ModelMaterial material = imported(path).materials[0];
      REQUIRE(material.image != nullptr);  // The file holds it: a PNG.
      CHECK(std::to_integer<int>((*material.image)[1]) == 'P');
      CHECK(material.texture.ends_with(".png"));
    }
    if (const std::string path = sample("other/cube.ply"); !path.empty()) {
      CHECK(measure(imported(path).mesh).volume == doctest::Approx(1));
    }
    if (const std::string path = sample("other/WusonOBJ.obj"); !path.empty()) {
      const Measures wuson = measure(imported(path).mesh);
      CHECK(wuson.volume > 1);  // open, and still wound outward
      CHECK(wuson.high.y == doctest::Approx(1.51525));
    }
  }

  TEST_CASE("no preselection loses triangles of the sample models that overlap") {
    using hooke::DVec3;
    using hooke::geometry::RigidPose;
    const auto importer = built_importer();
    for (const std::string name : {"3ds/fels.3ds", "3ds/cubes_with_alpha.3DS", "3ds/test1.3ds"}) {
      CAPTURE(name);
      const std::string path = sample(name);
      if (path.empty()) continue;
      const hooke::MeshDesc mesh = imported(path).mesh;
      std::vector<DVec3> points;
      for (const auto& p : mesh.positions) points.push_back(hooke::vector_cast<double>(p));
      const hooke::geometry::MeshView view = {points, mesh.triangles};
      const auto volumes = make_bounding_volumes(view);
      // Half a radius aside, and turned by 106 degrees.
      const RigidPose pose = {{0.5 * volumes.sphere.radius, 0.1 * volumes.sphere.radius, 0},
                              {0.8, 0, 0, 0.6}};
      std::vector<DVec3> moved;
      for (const DVec3& p : points) moved.push_back(to_world(pose, p));
      const hooke::geometry::MeshView placed = {moved, mesh.triangles};
      std::uint64_t overlapping = 0;
      for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k) {
          overlapping += triangles_overlap(view.corners(i), placed.corners(k)) ? 1 : 0;
        }
      }
      CHECK(overlapping > 0);
      std::uint64_t by_boxes = 0;
      for (const auto preselection : hooke::kPreselections) {
        const auto count = count_candidates(preselection, volumes, {}, volumes, pose);
        CHECK(count.pairs_left >= overlapping);
        by_boxes = count.pairs_left;
      }
      CHECK(by_boxes < 20 * overlapping);  // by the last, trees of oriented boxes
    }
  }
}
