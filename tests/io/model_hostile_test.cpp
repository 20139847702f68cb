#include "hooke/model_io.h"

#include "io/model/model_child.h"
#include "io/model_support.h"

#include <cerrno>
#include <cstring>
#include <doctest/doctest.h>
#include <random>
#include <sys/stat.h>
#include <sys/wait.h>

using hooke::Error;
using hooke::ErrorCode;
using hooke::import_model;
using hooke::io_test::built_importer;
using hooke::io_test::read_file;
using hooke::io_test::sample;
using hooke::io_test::ScopedVariable;
using hooke::io_test::TemporaryFolder;

namespace {

std::size_t open_descriptors() {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd"))
    count += entry.exists() ? 1 : 0;
  return count;
}

/// The error for a file that must not come in; one line that names the path.
Error refused(const std::string& path) {
  const auto model = import_model(path);
  REQUIRE_FALSE(model.has_value());
  CHECK(model.error().where == path);
  CHECK_FALSE(model.error().message.empty());
  CHECK(model.error().message.find('\n') == std::string::npos);
  return model.error();
}

template <class T>
std::string bytes_of(T value) {
  return {reinterpret_cast<const char*>(&value), sizeof(value)};
}

std::string chunk(std::uint16_t kind, const std::string& content) {
  return bytes_of(kind) + bytes_of(static_cast<std::uint32_t>(6 + content.size())) + content;
}

/// A keyframer node whose number makes the importer put it below the one before.
std::string node(std::uint16_t number) {
  return chunk(0xB002, chunk(0xB010, "n" + std::to_string(number) + std::string(5, '\0') + bytes_of(number)));
}

std::string stacked_nodes(std::uint16_t count) {
  std::string nodes;
  for (std::uint16_t i = 0; i < count; ++i) nodes += node(i);
  return nodes;
}

std::string with_keyframer(std::string file, const std::string& nodes) {
  file += chunk(0xB000, nodes);
  const auto size = static_cast<std::uint32_t>(file.size());
  file.replace(2, 4, bytes_of(size));
  return file;
}

std::string gltf(const std::string& nodes) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" + nodes + "]}";
}

/// Whether the process of this number is no more, or waits only to be collected.
bool ended(const std::string& number) {
  const std::string status = read_file("/proc/" + std::to_string(std::stoi(number)) + "/stat");
  return status.empty() || status.find(") Z") != std::string::npos;
}

bool has_line(const Error& error, const char* text) {
  return error.message.find(text) != std::string::npos;
}

}  // namespace

TEST_SUITE("io/model_hostile") {
  TEST_CASE("files that crash or bloat importers are errors, and leave no process and no descriptor") {
    const auto importer = built_importer();
    const std::size_t before = open_descriptors();
    for (const char* name : {"BoxWithInfinites.glb", "crash.ply", "empty.3ds", "malformed.obj",
                             "malformed2.obj", "out_of_memory.off"}) {
      const std::string path = sample(std::string("hostile/") + name);
      if (!path.empty()) (void)refused(path);
    }
    CHECK(open_descriptors() == before);
    CHECK(::waitpid(-1, nullptr, WNOHANG) == -1);
    CHECK(errno == ECHILD);
  }

  TEST_CASE("twenty thousand stacked nodes in a .3ds are refused before they take the stack") {
    const auto importer = built_importer();
    const TemporaryFolder folder;
    const std::string crate = read_file(std::string(HOOKE_OWN_MODELS) + "/crate.3ds");
    const Error error = refused(folder.file("bomb.3ds", with_keyframer(crate, stacked_nodes(20000))));
    CHECK(error.code == ErrorCode::kLimitExceeded);
    CHECK(has_line(error, "more than 64 deep"));
    CHECK(import_model(folder.file("deep.3ds", with_keyframer(crate, stacked_nodes(60)))).has_value());
  }

  TEST_CASE("nested, empty and oversized chunks of a .3ds are refused") {
    const auto importer = built_importer();
    const TemporaryFolder folder;
    std::string nested;
    for (int i = 0; i < 1000; ++i) nested = chunk(0x3D3D, nested);
    CHECK(has_line(refused(folder.file("nested.3ds", chunk(0x4D4D, nested))), "nested"));
    for (const std::uint32_t size : {0u, 5u, 0x7FFFFFFFu, 0xFFFFFFFFu}) {
      const std::string inner = bytes_of(std::uint16_t{0x3D3D}) + bytes_of(size);
      CHECK(refused(folder.file("size.3ds", chunk(0x4D4D, inner))).code == ErrorCode::kBadSyntax);
    }
    std::string many;
    for (int i = 0; i < 1100000; ++i) many += chunk(0x0001, "");
    CHECK(has_line(refused(folder.file("many.3ds", chunk(0x4D4D, many))), "million"));
  }

  TEST_CASE("deep JSON and deep, circular or shared nodes of a .gltf are refused") {
    const auto importer = built_importer();
    const TemporaryFolder folder;
    CHECK(has_line(refused(folder.file("deep.gltf", std::string(100000, '['))), "64 deep"));
    std::string chain;
    for (int i = 0; i < 5000; ++i) chain += R"({"children":[)" + std::to_string(i + 1) + "]},";
    CHECK(has_line(refused(folder.file("chain.gltf", gltf(chain + "{}"))), "64 deep"));
    const std::string circle = R"({"children":[1]},{"children":[0]})";
    CHECK(has_line(refused(folder.file("circle.gltf", gltf(circle))), "contain each other"));
    const std::string shared = R"({"children":[1,2]},{"children":[3]},{"children":[3]},{})";
    CHECK(has_line(refused(folder.file("shared.gltf", gltf(shared))), "two parents"));
    (void)refused(folder.file("short.glb", "glTF"));
    (void)refused(folder.file("none.gltf", "{}"));
  }

  TEST_CASE("counts that promise more than the file holds are errors") {
    const auto importer = built_importer();
    const TemporaryFolder folder;
    (void)refused(folder.file("huge.stl", std::string(80, ' ') + bytes_of(0xFFFFFFFFu)));
    (void)refused(folder.file("huge.ply",
                              "ply\nformat binary_little_endian 1.0\nelement vertex 2000000000\n"
                              "property float x\nproperty float y\nproperty float z\n"
                              "element face 2000000000\nproperty list int int vertex_indices\nend_header\n"));
    std::string polygon = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf";
    for (int i = 0; i < 100000; ++i) polygon += " 1 2 3";
    CHECK(has_line(refused(folder.file("polygon.obj", polygon + "\n")), "4096 corners"));
    (void)refused(folder.file("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\nl 1 2\n"));
  }

  TEST_CASE("a header of a .ply that does not end is refused before the importer looks for its end") {
    const auto importer = built_importer();
    const TemporaryFolder folder;
    const std::string head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n";
    CHECK(has_line(refused(folder.file("cut.ply", head)), "without an end"));
    CHECK(has_line(refused(folder.file("cut.ply", head + "end_header\n1\n")), "shorter"));
    CHECK(has_line(refused(folder.file("type.ply", head + "property real y\nend_header\n")), "type"));
  }

  TEST_CASE("what the importer would lose without a word is refused with what helps") {
    const auto importer = built_importer();
    const TemporaryFolder folder;
    const std::string strips =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n1 1 0\n4 0 1 2 3\n";
    CHECK(has_line(refused(folder.file("strips.ply", strips)), "save it with faces"));
    const std::string points = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n";
    CHECK(has_line(refused(folder.file("points.ply", points)), "points alone"));
    const std::string old = R"({"asset":{},"nodes":{"node_1":{"children":[]}}})";
    CHECK(has_line(refused(folder.file("old.gltf", old)), "save it as glTF 2"));
  }

  TEST_CASE("what is no regular file is not opened") {
    const auto importer = built_importer();
    const TemporaryFolder folder;
    REQUIRE(::mkfifo((folder / "pipe.obj").c_str(), 0600) == 0);
    CHECK(has_line(refused(folder / "pipe.obj"), "regular"));
    std::filesystem::create_directory(folder.path() / "folder.obj");
    CHECK(has_line(refused(folder / "folder.obj"), "regular"));
    std::filesystem::create_symlink("/dev/zero", folder.path() / "zero.obj");
    CHECK(has_line(refused(folder / "zero.obj"), "out of its folder"));
    CHECK(refused(folder / "missing.obj").code == ErrorCode::kFileNotReadable);
    CHECK(refused(folder / "model.fbx").code == ErrorCode::kBadSyntax);
    CHECK(refused(folder / "obj").code == ErrorCode::kBadSyntax);
    CHECK(refused("").code == ErrorCode::kFileNotReadable);
    CHECK(refused(std::string("a\0.obj", 6)).code == ErrorCode::kFileNotReadable);
    const std::string large = folder.file("large.stl", "");
    std::filesystem::resize_file(large, (std::uintmax_t{256} << 20u) + 1);  // sparse
    CHECK(refused(large).code == ErrorCode::kLimitExceeded);
  }

  TEST_CASE("a file of one format under the ending of another is not read as what it is") {
    const auto importer = built_importer();
    const TemporaryFolder folder;
    const std::string crate = read_file(std::string(HOOKE_OWN_MODELS) + "/crate.3ds");
    (void)refused(folder.file("crate.ply", crate));
    (void)refused(folder.file("crate.stl", crate));
    (void)refused(folder.file("crate.glb", crate));
  }

  TEST_CASE("cut files are errors or smaller models") {
    const auto importer = built_importer();
    const TemporaryFolder folder;
    const std::string own = HOOKE_OWN_MODELS;
    for (const std::string& path : {own + "/crate.3ds", sample("other/BoxTextured.glb"),
                                    sample("other/box.obj"), sample("other/cube.ply")}) {
      if (path.empty()) continue;
      const std::string whole = read_file(path);
      for (std::size_t cut = 0; cut < 40; ++cut) {
        const std::string name = "cut" + std::filesystem::path(path).extension().string();
        const auto model = import_model(folder.file(name, whole.substr(0, whole.size() * cut / 40)));
        if (!model) CHECK(model.error().message.find('\n') == std::string::npos);
      }
    }
  }

  TEST_CASE("changed bytes of a .3ds never reach this process as more than an error") {
    const auto importer = built_importer();
    const TemporaryFolder folder;
    const std::string whole = read_file(std::string(HOOKE_OWN_MODELS) + "/crate.3ds");
    std::mt19937 random(11);
    for (int run = 0; run < 60; ++run) {
      std::string changed = whole;
      for (int i = 0; i < 8; ++i) changed[random() % changed.size()] = static_cast<char>(random());
      const auto model = import_model(folder.file("changed.3ds", changed));
      if (model) CHECK_FALSE(model.value().mesh.triangles.empty());
    }
  }

  TEST_CASE("whatever the importer does instead of its work is an error") {
    const TemporaryFolder folder;
    const std::string model = folder.file("model.obj", "");
    const auto acting = [&](const std::string& script) {
      const std::string program = folder.file("act", "#!/bin/sh\n" + script + "\n");
      REQUIRE(::chmod(program.c_str(), 0700) == 0);
      const ScopedVariable chosen("HOOKE_IMPORT", program);
      return refused(model);
    };
    const std::size_t before = open_descriptors();
    CHECK(has_line(acting("exit 0"), "unusable"));
    CHECK(has_line(acting("echo garbage"), "unusable"));
    CHECK(has_line(acting("head -c 3000000 /dev/zero"), "unusable"));
    CHECK(has_line(acting("kill -SEGV $$"), "signal 11"));
    CHECK(has_line(acting("exit 3"), "exit 3"));
    CHECK(has_line(acting("exit 65"), "refused"));
    CHECK(acting("printf 'first\\nlast \\033[1m word\\n' >&2; exit 68").message == "last _[1m word");
    (void)acting("exec 1>&-; yes >&2");
    CHECK(open_descriptors() == before);
    const ScopedVariable none("HOOKE_IMPORT", folder / "no such program");
    CHECK(has_line(refused(model), "cannot start"));
  }

  TEST_CASE("an importer that hangs is ended, and what it started with it") {
    const TemporaryFolder folder;
    const std::string program = folder.file("hang", "#!/bin/sh\nsleep 1000 & echo $! > \"$1.child\"; wait\n");
    REQUIRE(::chmod(program.c_str(), 0700) == 0);
    const ScopedVariable chosen("HOOKE_IMPORT", program);
    const auto bytes = hooke::io::run_importer(folder / "model.obj", {}, std::chrono::milliseconds(300));
    REQUIRE_FALSE(bytes.has_value());
    CHECK(bytes.error().code == ErrorCode::kLimitExceeded);
    CHECK(has_line(bytes.error(), "too long"));
    CHECK(::waitpid(-1, nullptr, WNOHANG) == -1);
    const std::string started = read_file(folder / "model.obj.child");
    REQUIRE_FALSE(started.empty());
    bool is_gone = false;  // the signal is sent; being gone takes the system a moment
    for (int i = 0; i < 1000000 && !is_gone; ++i) is_gone = ended(started);
    CHECK(is_gone);
  }
}
