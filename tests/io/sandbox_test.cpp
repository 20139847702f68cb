#include "../../apps/import/sandbox.h"

#include "hooke/model_io.h"

#include "../../apps/import/limits.h"
#include "io/model_support.h"
#include "process/child.h"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

using hooke::import_model;
using hooke::importer::kIsSanitized;
using hooke::importer::Seal;
using hooke::io_test::built_importer;
using hooke::io_test::read_file;
using hooke::io_test::TemporaryFolder;
namespace fs = std::filesystem;

namespace {

constexpr int kNoSeal = 100;  // of the kernel

/// What a process gives as its exit code that seals itself and then calls `act`; by a signal, its negative.
template <class Act>
int sealed(const Act& act) {
  const pid_t id = ::fork();
  REQUIRE(id >= 0);
  if (id == 0) {
    ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    ::_exit(hooke::importer::seal_process() == Seal::kDone ? act() : kNoSeal);
  }
  int status = 0;
  REQUIRE(::waitpid(id, &status, 0) == id);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

/// Whether a call failed because the seal forbids it.
int is_refused(long result) {
  return result == -1 && errno == EPERM ? 0 : 1;
}

bool can_seal() {
  const bool can = !kIsSanitized && sealed([] { return 0; }) == 0;
  if (!can) MESSAGE("skipped, this kernel or build has no filter of system calls");
  return can;
}

std::string triangles(int count) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  for (int i = 0; i < count; ++i) {
    const std::string z = std::to_string(i + 1);
    text += "v 0 0 " + z + "\nv 1 0 " + z + "\nv 0 1 " + z + "\nf -3 -2 -1\n";
  }
  return text;
}

/// The word after `key` in a process's status.
std::string status_of(pid_t id, const std::string& key) {
  const std::string text = read_file("/proc/" + std::to_string(id) + "/status");
  const std::size_t at = text.find(key);
  return at == std::string::npos ? "" : text.substr(at + key.size(), 1);
}

/// Waits until `done` or a minute.
template <class Done>
bool eventually(const Done& done) {
  for (int i = 0; i < 6000 && !done(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return done();
}

}  // namespace

TEST_SUITE("io/sandbox") {
  TEST_CASE("a sealed process computes, writes and ends") {
    if (!can_seal()) return;
    CHECK(sealed([] {
            std::vector<std::vector<int>> memory;
            for (std::size_t size = 1; size < 10'000'000; size *= 3) memory.emplace_back(size, 7);
            try {
              throw std::bad_alloc();
            } catch (const std::bad_alloc&) {
              return memory.back().back();
            }
          }) == 7);
    const auto pipe = hooke::process::make_pipe();
    CHECK(sealed([] { return static_cast<int>(::write(STDERR_FILENO, "", 0)); }) == 0);
    CHECK(sealed([]() -> int { std::abort(); }) == -SIGABRT);
  }

  TEST_CASE("a sealed process opens no file, reads none and makes no connection") {
    if (!can_seal()) return;
    CHECK(sealed([] { return is_refused(::open("/etc/passwd", O_RDONLY)); }) == 0);
    CHECK(sealed([] { return is_refused(::open("/tmp", O_TMPFILE | O_RDWR, 0600)); }) == 0);
    CHECK(sealed([] { return is_refused(::unlink("/tmp/hooke none")); }) == 0);
    CHECK(sealed([] {
            char byte = 0;
            return is_refused(::read(STDIN_FILENO, &byte, 1));
          }) == 0);
    CHECK(sealed([] { return is_refused(::socket(AF_INET, SOCK_STREAM, 0)); }) == 0);
    CHECK(sealed([] { return is_refused(::socket(AF_UNIX, SOCK_DGRAM, 0)); }) == 0);
    const auto pipe = hooke::process::make_pipe();
    REQUIRE(pipe.has_value());
    const int other = pipe->write.number();  // a descriptor that it was not to have
    CHECK(sealed([other] { return is_refused(::write(other, "x", 1)); }) == 0);
  }

  TEST_CASE("a sealed process starts nothing, signals nobody and makes no code") {
    if (!can_seal()) return;
    const pid_t parent = ::getpid();
    CHECK(sealed([] { return is_refused(::fork()); }) == 0);
    CHECK(sealed([] { return is_refused(::execl("/bin/sh", "sh", "-c", "exit 0", nullptr)); }) == 0);
    CHECK(sealed([parent] { return is_refused(::kill(parent, 0)); }) == 0);
    CHECK(sealed([parent] { return is_refused(::ptrace(PTRACE_ATTACH, parent, nullptr, nullptr)); }) == 0);
    constexpr int kCode = PROT_READ | PROT_WRITE | PROT_EXEC;
    CHECK(sealed([] {
            void* memory = ::mmap(nullptr, 4096, kCode, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
            return is_refused(memory == MAP_FAILED ? -1 : 0);
          }) == 0);
    CHECK(sealed([] {
            void* memory = ::mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
            return memory == MAP_FAILED ? 1 : is_refused(::mprotect(memory, 4096, kCode));
          }) == 0);
  }

  TEST_CASE("the importer has sealed itself when it understands a file") {
    if (!can_seal()) return;
    const TemporaryFolder folder;
    const std::string model = folder.file("model.obj", triangles(3000));
    auto pipe = hooke::process::make_pipe();
    REQUIRE(pipe.has_value());
    // Nobody reads the pipe: it stands still in the middle of its answer.
    auto child =
        hooke::process::Child::start({HOOKE_BUILT_IMPORTER, model, "format", "1", "none", "file"},
                                     {.output = pipe->write.number(), .error = pipe->write.number()});
    REQUIRE(child.has_value());
    CHECK(eventually([&] { return status_of(child->number(), "Seccomp:\t") == "2"; }));
    CHECK(status_of(child->number(), "NoNewPrivs:\t") == "1");
  }

  TEST_CASE("files beside a model come with it, and no link brings another folder's") {
    const auto importer = built_importer();
    const TemporaryFolder outside;
    const TemporaryFolder folder;
    const std::string red = "newmtl m\nKd 1 0 0\n";
    const std::string obj = "usemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    const auto red_of = [](const hooke::Result<hooke::Model>& model) {
      REQUIRE(model.has_value());
      REQUIRE_FALSE(model->materials.empty());
      return model->materials.front().color[1] == 0.0f;
    };
    (void)folder.file("own.mtl", red);
    const std::string own = folder.file("own.obj", "mtllib own.mtl\n" + obj);
    CHECK(red_of(import_model(own)));
    fs::create_symlink("own.mtl", folder.path() / "inside.mtl");
    CHECK(red_of(import_model(folder.file("inside.obj", "mtllib inside.mtl\n" + obj))));
    fs::create_symlink(outside.file("secret.mtl", red), folder.path() / "out.mtl");
    CHECK_FALSE(red_of(import_model(folder.file("out.obj", "mtllib out.mtl\n" + obj))));
    CHECK_FALSE(red_of(import_model(
        folder.file("up.obj", "mtllib ../" + outside.path().filename().string() + "/secret.mtl\n" + obj))));

    // The model itself is no way out either; a folder that is a link is.
    fs::create_symlink(outside.file("model.obj", obj), folder.path() / "model.obj");
    const auto refused = import_model(folder / "model.obj");
    REQUIRE_FALSE(refused.has_value());
    CHECK(refused.error().code == hooke::ErrorCode::kFileNotReadable);
    CHECK(refused.error().message.find("out of its folder") != std::string::npos);
    fs::create_directory_symlink(outside.path(), folder.path() / "elsewhere");
    CHECK(import_model(folder / "elsewhere/model.obj").has_value());
  }

  TEST_CASE("a texture that is a link out of the model's folder is not taken") {
    const auto importer = built_importer();
    const TemporaryFolder outside;
    const TemporaryFolder folder;
    const std::string obj = "mtllib m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n";
    (void)folder.file("m.mtl", "newmtl m\nmap_Kd image.png\n");
    const std::string model = folder.file("m.obj", obj);
    const auto texture = [&] {
      const auto read = import_model(model);
      REQUIRE(read.has_value());
      REQUIRE_FALSE(read->materials.empty());
      return read->materials.front().texture;
    };
    (void)folder.file("IMAGE.png", "");
    CHECK(texture() == folder / "IMAGE.png");
    fs::remove(folder / "IMAGE.png");
    fs::create_symlink(outside.file("image.png", ""), folder.path() / "IMAGE.png");
    CHECK(texture().empty());
    fs::rename(folder / "IMAGE.png", folder / "image.png");
    CHECK(texture().empty());
  }

  TEST_CASE("buffers of a glTF are found by their names, however these are written") {
    const auto importer = built_importer();
    const TemporaryFolder folder;
    const float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::string bytes(reinterpret_cast<const char*>(corners), sizeof(corners));
    (void)folder.file("a b.bin", bytes);
    const auto model_of = [&](const std::string& uri) {
      return import_model(folder.file(
          "m.gltf",
          R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
          R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,)"
          R"("componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],)"
          R"("bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri" : ")" +
              uri + "\"}]}"));
    };
    CHECK(model_of("a b.bin").has_value());
    CHECK(model_of("a\\u0020b.bin").has_value());
    CHECK(model_of("../x\\/a b.bin").has_value());
    CHECK_FALSE(model_of("none.bin").has_value());
  }
}
