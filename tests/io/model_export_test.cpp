#include "hooke/model_io.h"

#include "io/model_support.h"

#include <doctest/doctest.h>
#include <limits>
#include <sys/stat.h>

using hooke::ErrorCode;
using hooke::export_model;
using hooke::import_model;
using hooke::MeshDesc;
using hooke::Model;
using hooke::model_of;
using hooke::io_test::append;
using hooke::io_test::box;
using hooke::io_test::built_importer;
using hooke::io_test::measure;
using hooke::io_test::Measures;
using hooke::io_test::read_file;
using hooke::io_test::sphere;
using hooke::io_test::TemporaryFolder;
using hooke::io_test::turn_over;

namespace {

const std::array<std::string, 4> kEndings = {".obj", ".stl", ".glb", ".3ds"};

Model round_trip(const Model& model, const std::string& path) {
  const auto written = export_model(model, path);
  if (!written) FAIL(written.error().where, ": ", written.error().message);
  auto back = import_model(path);
  if (!back) FAIL(back.error().where, ": ", back.error().message);
  return std::move(back).value();
}

void check_same_shape(const Model& a, const Model& b) {
  const Measures left = measure(a.mesh);
  const Measures right = measure(b.mesh);
  const double size = length(left.high - left.low);
  CHECK(a.mesh.triangles.size() == b.mesh.triangles.size());
  CHECK(a.mesh.positions.size() == b.mesh.positions.size());
  CHECK(left.volume == doctest::Approx(right.volume).epsilon(1e-5));
  CHECK(left.area == doctest::Approx(right.area).epsilon(1e-5));
  CHECK(left.open_edges == right.open_edges);
  CHECK(length(left.low - right.low) < 1e-6 * size);
  CHECK(length(left.high - right.high) < 1e-6 * size);
}

/// A hollow box and a ball of two materials, one with an image: flat and smooth parts, a cavity, several
/// surfaces.
Model still_life(bool with_uvs) {
  MeshDesc mesh = box({1, 0.5f, 2}, {0.3f, 1, 0});
  MeshDesc cavity = box({0.5f, 0.25f, 1}, {0.3f, 1, 0});
  turn_over(cavity);
  append(mesh, cavity);
  append(mesh, sphere(0.7, 12, 24));
  for (auto& p : mesh.positions) p = p + hooke::Vec3{0, 0, 5};
  Model model = model_of(mesh);
  const auto count = static_cast<std::uint32_t>(model.indices.size());
  model.parts = {{0, 72, 0}, {72, count - 72, 1}};
  model.materials = {{.name = "Paper", .color = {0.2f, 0.4f, 0.6f}, .opacity = 0.5f, .shininess = 40},
                     {.name = "paper", .color = {1, 1, 1}, .texture = "/somewhere/else/my image.png"}};
  for (auto& vertex : model.vertices) {
    if (with_uvs) vertex.uv = {0.5f * vertex.position[0], vertex.position[1] + 0.25f * vertex.position[2]};
  }
  return model;
}

/// Image coordinates as a function of place; 8 bits a color in .3ds make none of this inexact.
double worst_uv_error(const Model& model) {
  double worst = 0.0;
  for (const auto& vertex : model.vertices) {
    worst = std::max(worst, std::abs(vertex.uv[0] - 0.5 * vertex.position[0]));
    worst = std::max(worst, std::abs(vertex.uv[1] - vertex.position[1] - 0.25 * vertex.position[2]));
  }
  return worst;
}

}  // namespace

TEST_SUITE("io/model_export") {
  TEST_CASE("every format brings back the shape, with image coordinates and without") {
    const auto importer = built_importer();
    const TemporaryFolder folder;
    for (const bool with_uvs : {false, true}) {
      for (const std::string& ending : kEndings) {
        CAPTURE(ending);
        CAPTURE(with_uvs);
        const Model model = still_life(with_uvs);
        const Model back = round_trip(model, folder / ("still" + ending));
        check_same_shape(model, back);
        if (with_uvs && ending != ".stl") CHECK(worst_uv_error(back) < 1e-4);
      }
    }
  }

  TEST_CASE("every format but .stl brings back materials and the image beside the file") {
    const auto importer = built_importer();
    const TemporaryFolder folder;
    (void)folder.file("my image.png", "image");
    for (const std::string ending : {".obj", ".glb", ".3ds"}) {
      CAPTURE(ending);
      const Model back = round_trip(still_life(true), folder / ("still" + ending));
      REQUIRE(back.materials.size() == 2);
      REQUIRE(back.parts.size() == 2);
      CHECK(back.parts[0].count == 72);
      CHECK(back.materials[0].name == "Paper");
      CHECK(back.materials[0].opacity == doctest::Approx(0.5));
      CHECK(back.materials[0].shininess == doctest::Approx(40).epsilon(1e-3));
      CHECK(back.materials[0].color[0] == doctest::Approx(0.2).epsilon(0.02));  // 8 bits in .3ds
      CHECK(back.materials[0].color[2] == doctest::Approx(0.6).epsilon(0.02));
      CHECK(back.materials[0].texture.empty());
      CHECK(back.materials[1].texture == folder / "my image.png");
    }
  }

  TEST_CASE("a .glb holds its image, and what is made of it elsewhere has the image beside it") {
    const auto importer = built_importer();
    const TemporaryFolder folder;
    const std::string png = "\x89PNG\r\n\x1a\n and what follows";
    Model model = still_life(true);
    model.materials[1].texture = folder.file("my image.png", png);
    std::filesystem::create_directory(folder / "away");
    const Model held = round_trip(model, folder / "away/still.glb");
    CHECK_FALSE(std::filesystem::exists(folder / "away/my image.png"));
    REQUIRE(held.materials[1].image != nullptr);
    CHECK(std::string(reinterpret_cast<const char*>(held.materials[1].image->data()),
                      held.materials[1].image->size()) == png);
    check_same_shape(model, held);
    for (const std::string ending : {".obj", ".3ds"}) {
      CAPTURE(ending);
      std::filesystem::create_directory(folder / ("to" + ending));
      const Model back = round_trip(held, folder / ("to" + ending + "/still" + ending));
      CHECK(std::filesystem::path(back.materials[1].texture).parent_path() == folder / ("to" + ending));
      CHECK(read_file(back.materials[1].texture) == png);
    }
  }

  TEST_CASE("an image is copied beside the model, and no other file of its name is written over") {
    const auto importer = built_importer();
    const TemporaryFolder folder;
    Model model = still_life(true);
    model.materials[1].texture = folder.file("my image.bmp", "BM first");
    std::filesystem::create_directory(folder / "away");
    (void)folder.file("away/my image.bmp", "BM another");
    const Model back = round_trip(model, folder / "away/still.obj");
    CHECK(read_file(folder / "away/my image.bmp") == "BM another");
    CHECK(back.materials[1].texture == folder / "away/my image-2.bmp");
    CHECK(read_file(back.materials[1].texture) == "BM first");
    // The second time the copy is there already.
    CHECK(round_trip(model, folder / "away/still.obj").materials[1].texture == back.materials[1].texture);
    CHECK_FALSE(std::filesystem::exists(folder / "away/my image-3.bmp"));
  }

  TEST_CASE("the origin can be put in the center or the bottom of the box") {
    const auto importer = built_importer();
    const TemporaryFolder folder;
    REQUIRE(export_model(still_life(false), folder / "still.obj").has_value());
    const auto bounds = [&](hooke::ModelOrigin origin) {
      const auto model = import_model(folder / "still.obj", {.fit = 2.0, .origin = origin});
      REQUIRE(model.has_value());
      return measure(model.value().mesh);
    };
    const Measures center = bounds(hooke::ModelOrigin::kCenter);
    CHECK(length(center.low + center.high) < 1e-6);
    const Measures bottom = bounds(hooke::ModelOrigin::kBottom);
    CHECK(std::abs(bottom.low.y) < 1e-6);
    CHECK(std::abs(bottom.low.x + bottom.high.x) < 1e-6);
    CHECK(length(bottom.high - bottom.low - (center.high - center.low)) < 1e-6);
    const Measures file = bounds(hooke::ModelOrigin::kFile);
    CHECK(length(file.low + file.high) > 1);
  }

  TEST_CASE("creases and smooth places come back the same") {
    const auto importer = built_importer();
    const TemporaryFolder folder;
    const Model model = still_life(false);
    for (const std::string& ending : kEndings) {
      CAPTURE(ending);
      const Model back = round_trip(model, folder / ("still" + ending));
      CHECK(back.vertices.size() == model.vertices.size());  // each crease has its vertices twice
    }
  }

  TEST_CASE("a .3ds of more than 65535 vertices becomes several objects and one model again") {
    const auto importer = built_importer();
    const TemporaryFolder folder;
    const Model large = model_of(sphere(1, 260, 256));
    REQUIRE(large.vertices.size() > 65535);
    check_same_shape(large, round_trip(large, folder / "large.3ds"));
  }

  TEST_CASE("the same model gives the same bytes") {
    const TemporaryFolder folder;
    for (const std::string& ending : kEndings) {
      const std::string first = folder / ("a" + ending);
      const std::string second = folder / ("a2" + ending);
      REQUIRE(export_model(still_life(true), first).has_value());
      const std::string bytes = read_file(first);
      REQUIRE(export_model(still_life(true), first).has_value());
      CHECK(read_file(first) == bytes);
      CHECK(bytes.size() > 1000);
    }
  }

  TEST_CASE("a failed export leaves the old file and nothing else") {
    const TemporaryFolder folder;
    Model broken = still_life(false);
    broken.indices[7] = 1000000;
    for (const std::string& ending : kEndings) {
      const std::string path = folder.file("kept" + ending, "old");
      const auto written = export_model(broken, path);
      REQUIRE_FALSE(written.has_value());
      CHECK(written.error().where == path);
      CHECK(read_file(path) == "old");
    }
    std::filesystem::create_directory(folder.path() / "taken.stl");
    CHECK_FALSE(export_model(still_life(false), folder / "taken.stl").has_value());
    const auto nowhere = export_model(still_life(false), folder / "no/such/folder.glb");
    REQUIRE_FALSE(nowhere.has_value());
    CHECK(nowhere.error().code == ErrorCode::kFileNotWritable);
    CHECK_FALSE(export_model(still_life(false), folder / "model.fbx").has_value());
    CHECK_FALSE(export_model(Model{}, folder / "empty.obj").has_value());
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
      count += entry.exists() ? 1 : 0;
    CHECK(count == kEndings.size() + 1);
  }

  TEST_CASE("names of materials cannot add lines to a file") {
    const TemporaryFolder folder;
    Model model = still_life(false);
    model.materials[0].texture = "a\nnewmtl evil";
    REQUIRE(export_model(model, folder / "a.obj").has_value());
    CHECK(read_file(folder / "a.mtl").find("evil") == std::string::npos);
    model.materials[0].name = "a\nb";
    CHECK_FALSE(export_model(model, folder / "a.obj").has_value());
  }
}
