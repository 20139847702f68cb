#include "hooke/motion_io.h"

#include "io/motion/motion_names.h"
#include "io/motion/motion_reduce.h"
#include "io/motion/motion_write.h"
#include "temporary_folder.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <doctest/doctest.h>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <numbers>
#include <string>
#include <sys/resource.h>
#include <vector>

namespace hooke {

namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// A triangle of one part.
MotionMesh triangle(std::uint32_t material) {
  MotionMesh mesh;
  mesh.vertices = {{.position = {0, 0, 0}, .normal = {0, 0, 1}},
                   {.position = {1, 0, 0}, .normal = {0, 0, 1}},
                   {.position = {0, 1, 0}, .normal = {0, 0, 1}}};
  mesh.indices = {0, 1, 2};
  mesh.parts = {{0, 3, material}};
  return mesh;
}

/// Lets files grow to a size and no further, as a full disk does.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit now = {bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &now);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_ = {};
  void (*handler_)(int);
};

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// The line from one key to the next at a frame between them.
DVec3 on_line(const std::vector<DVec3>& places, const std::vector<std::size_t>& keys, std::size_t frame) {
  std::size_t i = 0;
  while (i + 1 < keys.size() && keys[i + 1] < frame) ++i;
  if (i + 1 == keys.size()) return places[keys[i]];
  const double part = static_cast<double>(frame - keys[i]) / static_cast<double>(keys[i + 1] - keys[i]);
  return (1 - part) * places[keys[i]] + part * places[keys[i + 1]];
}

/// A triangle that goes up by 1 m a frame and a body that turns, for some frames.
MotionRecording make_motion(const std::string& path, std::size_t frames) {
  MotionRecording motion = MotionRecording::create(path, 10).value();
  const std::uint32_t material = motion.add_material({.name = "red", .color = {1, 0, 0}});
  const std::uint32_t mesh = motion.add_mesh(triangle(material)).value();
  const std::uint32_t body_mesh = motion.add_mesh(triangle(material)).value();
  const std::uint32_t points =
      motion.add_object({.name = "sheet", .kind = MotionObject::Kind::kPoints, .mesh = mesh}).value();
  const std::uint32_t body =
      motion
          .add_object(
              {.name = "top", .pieces = {{.mesh = body_mesh}}, .body_kind = BodyKind::kDynamic, .mass = 2})
          .value();
  for (std::size_t frame = 0; frame < frames; ++frame) {
    const auto t = static_cast<float>(frame);
    const std::vector<Vec3> vertices = {{0, t, 0}, {1, t, 0}, {0, t + 1, 0}};
    motion.set_points(points, {.position = {0, static_cast<double>(frame), 0}}, vertices);
    motion.set_state(body, {.rotation = quaternion_about(Vec3{0, 1, 0}, 0.3F * t)});
    REQUIRE(motion.finish_frame());
  }
  return motion;
}

}  // namespace

TEST_SUITE("io/motion") {
  TEST_CASE("places between two keys are within the tolerance of the straight line between them") {
    std::vector<DVec3> places;
    for (int i = 0; i < 400; ++i) {
      const double t = 0.05 * i;
      places.push_back({std::sin(t), 0.3 * std::cos(2.7 * t), i > 200 && i < 260 ? 1.5 : 0.01 * t * t});
    }
    std::size_t before = places.size() + 1;
    for (const double tolerance : {1e-4, 1e-3, 1e-2, 0.1}) {
      const std::vector<std::size_t> keys = io::reduce_places(places, tolerance);
      CHECK(keys.front() == 0);
      CHECK(keys.back() == places.size() - 1);
      double worst = 0;
      for (std::size_t i = 0; i < places.size(); ++i) {
        worst = std::max(worst, length(on_line(places, keys, i) - places[i]));
      }
      CHECK(worst <= tolerance * (1 + 1e-9));
      CHECK(keys.size() < before);
      before = keys.size();
    }
    CHECK(before < 60);
  }

  TEST_CASE("what moves evenly needs two keys, and what rests needs one") {
    std::vector<DVec3> places;
    for (int i = 0; i < 1000; ++i) places.push_back({0.25 * i, -0.5 * i, 1});
    CHECK(io::reduce_places(places, 1e-9) == std::vector<std::size_t>{0, 999});
    CHECK(io::reduce_places(std::vector<DVec3>(50, DVec3{1, 2, 3}), 0) == std::vector<std::size_t>{0});
    CHECK(io::reduce_places({}, 1).empty());
    CHECK(io::reduce_places(std::vector<DVec3>{{1, 2, 3}}, 1) == std::vector<std::size_t>{0});
  }

  TEST_CASE("rotations between two keys are within the angle, for readers that blend components too") {
    std::vector<Quat> rotations;
    for (int i = 0; i < 300; ++i) {
      const float t = 0.02F * static_cast<float>(i);
      const Quat q =
          quaternion_about(Vec3{0, 1, 0}, 3 * t) * quaternion_about(Vec3{1, 0, 0}, std::sin(2 * t));
      // Signs as no program promises them.
      rotations.push_back(i % 7 == 0 ? Quat{-q.x, -q.y, -q.z, -q.w} : q);
    }
    io::align_signs(rotations);
    const double angle = 0.01;
    const std::vector<std::size_t> keys = io::reduce_rotations(rotations, angle);
    CHECK(keys.size() < 100);
    double worst = 0;
    for (std::size_t k = 0; k + 1 < keys.size(); ++k) {
      for (std::size_t i = keys[k]; i <= keys[k + 1]; ++i) {
        const float part = static_cast<float>(i - keys[k]) / static_cast<float>(keys[k + 1] - keys[k]);
        const Quat a = rotations[keys[k]];
        const Quat b = rotations[keys[k + 1]];
        const Quat blended = normalize(Quat{a.x + part * (b.x - a.x), a.y + part * (b.y - a.y),
                                            a.z + part * (b.z - a.z), a.w + part * (b.w - a.w)});
        const Quat turn = conjugate(rotations[i]) * blended;
        worst = std::max(
            worst, 2 * std::asin(std::min(1.0, static_cast<double>(length(Vec3{turn.x, turn.y, turn.z})))));
      }
    }
    CHECK(worst <= angle + 1e-5);
    CHECK(worst > angle / 4);
  }

  TEST_CASE("neighboring quaternions get one sign") {
    std::vector<Quat> rotations;
    for (int i = 0; i < 40; ++i)
      rotations.push_back(quaternion_about(Vec3{0, 0, 1}, 0.5F * static_cast<float>(i)));
    for (std::size_t i = 0; i < rotations.size(); i += 3) {
      rotations[i] = {-rotations[i].x, -rotations[i].y, -rotations[i].z, -rotations[i].w};
    }
    io::align_signs(rotations);
    for (std::size_t i = 1; i < rotations.size(); ++i) {
      const Quat a = rotations[i - 1];
      const Quat b = rotations[i];
      CHECK(a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w > 0);
    }
  }

  TEST_CASE("names fit their format, and no two are the same") {
    io::NameBook prims(io::NameStyle::kIdentifier);
    CHECK(prims.take("ball", "x") == "ball");
    CHECK(prims.take("ball", "x") == "ball_2");
    CHECK(prims.take("rope[3]", "x") == "rope_3_");
    CHECK(prims.take("3 balls", "x") == "_3_balls");
    CHECK(prims.take("", "object") == "object");
    io::NameBook files(io::NameStyle::kFile);
    CHECK(files.take("Flag", "x") == "Flag");
    CHECK(files.take("flag", "x") == "flag.2");
    CHECK(files.take("../../etc/passwd", "x") == "_._.._etc_passwd");
    CHECK(files.take("..", "x") == "_.");
    CHECK(files.take("image.png", "x") == "image.png");
    CHECK(files.take("image.png", "x") == "image.2.png");
    CHECK(files.take(std::string(300, 'a') + "[7]", "x").size() == 64);
    io::NameBook texts(io::NameStyle::kText);
    CHECK(texts.take("a \"b\"\n\xC3\xA4", "x") == "a \"b\"_\xC3\xA4");
  }

  TEST_CASE("a normal is that of the triangles around a vertex, whatever has shrunk to nothing") {
    MotionMesh mesh = triangle(0);
    const std::vector<Vec3> up = io::normals_of(mesh, std::vector<Vec3>{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}});
    CHECK(up[0] == Vec3{0, 1, 0});
    const std::vector<Vec3> none = io::normals_of(mesh, std::vector<Vec3>(3, Vec3{1, 1, 1}));
    CHECK(length(none[2]) == doctest::Approx(1));
  }

  TEST_CASE("a recording refuses meshes and objects that fit nothing") {
    const test::TemporaryFolder folder;
    MotionRecording motion = MotionRecording::create(folder / "x.glb", 30).value();
    CHECK_FALSE(motion.add_mesh(triangle(0)));  // There is no material yet.
    const std::uint32_t material = motion.add_material({});
    MotionMesh mesh = triangle(material);
    mesh.indices[2] = 3;
    CHECK_FALSE(motion.add_mesh(mesh));
    mesh = triangle(material);
    mesh.vertices[1].position[0] = kNaN;
    CHECK_FALSE(motion.add_mesh(mesh));
    mesh = triangle(material);
    mesh.parts = {{0, 6, material}};
    CHECK_FALSE(motion.add_mesh(mesh));
    mesh = triangle(material);
    mesh.indices = {0, 1, 2, 0, 2, 1};  // The second part has vertices of the first.
    mesh.parts = {{0, 3, material}, {3, 3, material}};
    CHECK_FALSE(motion.add_mesh(mesh));
    CHECK_FALSE(motion.add_object({.name = "x", .kind = MotionObject::Kind::kPoints, .mesh = 7}));
    CHECK_FALSE(motion.add_joint({.a = 3}));
    CHECK(motion.add_mesh(triangle(material)));
  }

  TEST_CASE("a recording refuses lights that shine nowhere or not at all like light") {
    const test::TemporaryFolder folder;
    MotionRecording motion = MotionRecording::create(folder / "x.glb", 30).value();
    using Kind = MotionLight::Kind;
    CHECK_FALSE(motion.add_light({.direction = {}}));
    CHECK_FALSE(motion.add_light({.position = {0, static_cast<double>(kNaN), 0}}));
    CHECK_FALSE(motion.add_light({.color = {1, -1, 1}}));
    CHECK_FALSE(motion.add_light({.color = {1, 1.5F, 1}}));
    CHECK_FALSE(motion.add_light({.color = {kNaN, 1, 1}}));
    CHECK_FALSE(motion.add_light({.strength = -1}));
    CHECK_FALSE(motion.add_light({.kind = Kind::kSpot, .inner_angle = 0.5F, .outer_angle = 0.5F}));
    CHECK_FALSE(motion.add_light({.kind = Kind::kSpot, .outer_angle = 1.6F}));
    CHECK_FALSE(motion.set_sky({1, 1, -1}));
    CHECK(motion.data().lights.empty());
    CHECK_FALSE(motion.data().sky);
    CHECK(motion.add_light({.kind = Kind::kSpot}));
    CHECK(motion.set_sky({0, 1, 2}));
    CHECK(motion.data().lights.size() == 1);
  }

  TEST_CASE("what cannot be begun is an error that says why, and leaves no file") {
    const test::TemporaryFolder folder;
    CHECK(MotionRecording::create(folder / "x.fbx", 30).error().code == ErrorCode::kOutOfRange);
    CHECK(MotionRecording::create(folder / "x.glb", 0).error().code == ErrorCode::kOutOfRange);
    CHECK(MotionRecording::create(folder / "x.glb", std::numeric_limits<double>::quiet_NaN()).error().code ==
          ErrorCode::kOutOfRange);
    CHECK(MotionRecording::create(folder / "nowhere/x.glb", 30).error().code == ErrorCode::kFileNotWritable);
    const MotionRecording empty = MotionRecording::create(folder / "x.glb", 30).value();
    CHECK(write_motion(empty, folder / "x.glb").error().code == ErrorCode::kOutOfRange);
    CHECK(folder.entries() == 0);
  }

  TEST_CASE("a recording is gone with its object, and the output is the one file") {
    const test::TemporaryFolder folder;
    {
      const MotionRecording motion = make_motion(folder / "x.glb", 5);
      CHECK(motion.frame_count() == 5);
      const auto summary = write_motion(motion, folder / "x.glb");
      REQUIRE(summary);
      CHECK(summary->frames == 5);
      CHECK(summary->objects == 2);
      CHECK(summary->bytes == std::filesystem::file_size(folder / "x.glb"));
    }
    CHECK(folder.entries() == 1);
  }

  TEST_CASE("a sheet that rises evenly needs one morph target, and all its frames are counted") {
    const test::TemporaryFolder folder;
    const MotionRecording motion = make_motion(folder / "x.glb", 21);
    const auto summary = write_motion(motion, folder / "x.glb");
    REQUIRE(summary);
    REQUIRE(summary->notes.size() == 1);
    CHECK(summary->notes[0].find("19 of 21 shapes") == 0);
    CHECK(content_of(folder / "x.glb").find("\"targetNames\":[\"frame_20\"]") != std::string::npos);
  }

  TEST_CASE("a state that is no number repeats the one before, and is said to") {
    const test::TemporaryFolder folder;
    MotionRecording motion = make_motion(folder / "x.csv", 2);
    motion.set_state(1, {.position = {0, std::numeric_limits<double>::infinity(), 0}});
    const std::vector<Vec3> bad = {{0, 2, 0}, {1, kNaN, 0}, {0, 3, 0}};
    motion.set_points(0, {.position = {0, 2, 0}}, bad);
    REQUIRE(motion.finish_frame());
    CHECK(motion.data().points(0, 2)[1] == Vec3{1, 1, 0});
    CHECK(motion.data().state(1, 2).position == DVec3{});
    const auto summary = write_motion(motion, folder / "x.csv");
    REQUIRE(summary);
    REQUIRE(summary->notes.size() == 2);
    CHECK(summary->notes[0].find("'sheet' was not finite in 1 frame,") == 0);
    const std::string text = content_of(folder / "x.csv");
    CHECK(text.find("nan") == std::string::npos);
    CHECK(text.find("inf") == std::string::npos);
  }

  TEST_CASE("an object that is never a number is not there") {
    const test::TemporaryFolder folder;
    MotionRecording motion = MotionRecording::create(folder / "x.glb", 30).value();
    const std::uint32_t body =
        motion.add_object({.name = "lost", .body_kind = BodyKind::kDynamic, .mass = 1}).value();
    motion.set_state(body, {.position = {std::numeric_limits<double>::quiet_NaN(), 0, 0}});
    REQUIRE(motion.finish_frame());
    CHECK(write_motion(motion, folder / "x.glb").error().message == "there is no object to write");
  }

  TEST_CASE("a point cache is as long as the recording, also for what comes late") {
    const test::TemporaryFolder folder;
    MotionRecording motion = make_motion(folder / "caches/", 3);
    const std::uint32_t mesh = motion.add_mesh(triangle(0)).value();
    const std::uint32_t late =
        motion.add_object({.name = "late", .kind = MotionObject::Kind::kPoints, .mesh = mesh}).value();
    for (const float x : {5.0F, 6.0F}) {
      motion.set_points(late, {}, std::vector<Vec3>{{x, 1, 2}, {x, 0, 0}, {0, x, 0}});
      REQUIRE(motion.finish_frame());
    }
    REQUIRE(write_motion(motion, folder / "caches/"));
    const std::string cache = content_of(folder / "caches/late.pc2");
    REQUIRE(cache.size() == 32 + 5 * 3 * 12);
    const auto first_of = [&](std::size_t frame) {
      Vec3 v;
      std::memcpy(&v, cache.data() + 32 + frame * 36, sizeof v);
      return v;
    };
    CHECK(first_of(0) == Vec3{5, -2, 1});  // z up
    CHECK(first_of(3) == Vec3{5, -2, 1});
    CHECK(first_of(4) == Vec3{6, -2, 1});
    // What is not there any more in the last frames keeps its last shape.
    const std::string sheet = content_of(folder / "caches/sheet.pc2");
    CHECK(sheet.substr(32 + 2 * 36, 36) == sheet.substr(32 + 4 * 36, 36));
  }

  TEST_CASE("a disk that is full ends a recording with advice, and leaves the old file") {
    const test::TemporaryFolder folder;
    const std::string path = folder.file("x.csv", "old");
    const MotionRecording whole = make_motion(path, 3);
    MotionRecording motion = make_motion(path, 1);
    const FileSizeLimit limit(4096);
    Result<void> stored;
    for (int frame = 0; frame < 1000 && stored; ++frame) {
      motion.set_state(1, {});
      stored = motion.finish_frame();
    }
    REQUIRE_FALSE(stored);
    CHECK(stored.error().code == ErrorCode::kFileNotWritable);
    CHECK(stored.error().message.find("record fewer frames a second") != std::string::npos);
    const FileSizeLimit smaller(16);
    const auto summary = write_motion(whole, path);
    REQUIRE_FALSE(summary);
    CHECK(summary.error().code == ErrorCode::kFileNotWritable);
    CHECK(content_of(path) == "old");
    CHECK(folder.entries() == 1);
  }

  TEST_CASE("what does not fit on the disk is known before it is full") {
    const test::TemporaryFolder folder;
    CHECK(io::check_space(folder / "x.obj", 1000));
    const auto space = io::check_space(folder / "x.obj", 1e18);
    REQUIRE_FALSE(space);
    CHECK(space.error().message.find("would take about 931322575 GiB") == 0);
    CHECK(io::check_space("nowhere/at/all/x.obj", 1e18));
  }

  TEST_CASE("points without triangles are for tables alone") {
    const test::TemporaryFolder folder;
    MotionRecording motion = MotionRecording::create(folder / "x.csv", 30).value();
    MotionMesh mesh;
    mesh.vertices.resize(1);
    const std::uint32_t number = motion.add_mesh(mesh).value();
    const std::uint32_t point =
        motion.add_object({.name = "dust", .kind = MotionObject::Kind::kPoints, .mesh = number}).value();
    motion.set_points(point, {}, std::vector<Vec3>{{1, 2, 3}});
    REQUIRE(motion.finish_frame());
    CHECK(write_motion(motion, folder / "x.csv", {.with_points = true}));
    CHECK(content_of(folder / "x.csv").find("0,0,dust,0,1,2,3,") != std::string::npos);
    CHECK(write_motion(motion, folder / "x.glb").error().where == "dust");
  }
}

}  // namespace hooke
