#include "process/new_file.h"

#include "temporary_folder.h"

#include <csignal>
#include <cstdlib>
#include <doctest/doctest.h>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <string>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fs = std::filesystem;
using hooke::ErrorCode;
using hooke::process::NewFile;
using hooke::process::write_file;
using hooke::test::TemporaryFolder;

namespace {

std::string text_in(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// The signal that ends a process which writes half a file and then is sent `signal`.
int end_in_the_middle(const std::string& path, NewFile::Start start, int signal) {
  const pid_t id = ::fork();
  REQUIRE(id >= 0);
  if (id == 0) {
    for (const int one : {SIGTERM, SIGINT, SIGHUP}) std::signal(one, SIG_DFL);
    hooke::process::remove_unfinished_files_on_signals();
    auto file = NewFile::create(path, start);
    if (!file || !file->write("half")) ::_exit(1);
    ::raise(signal);
    ::_exit(2);
  }
  int status = 0;
  REQUIRE(::waitpid(id, &status, 0) == id);
  return WIFSIGNALED(status) ? WTERMSIG(status) : -WEXITSTATUS(status);
}

}  // namespace

TEST_SUITE("process/new_file") {
  TEST_CASE("a file has its name when it is finished, and not before") {
    for (const auto start : {NewFile::Start::kUnnamed, NewFile::Start::kNamed}) {
      const TemporaryFolder folder;
      auto file = NewFile::create(folder / "a.csv", start);
      REQUIRE(file.has_value());
      REQUIRE(file->write("one,").has_value());
      CHECK_FALSE(fs::exists(folder / "a.csv"));
      REQUIRE(file->write("two").has_value());
      REQUIRE(file->finish().has_value());
      CHECK(text_in(folder / "a.csv") == "one,two");
      CHECK(folder.entries() == 1);
    }
  }

  TEST_CASE("a file that is given up leaves the old one and nothing else") {
    for (const auto start : {NewFile::Start::kUnnamed, NewFile::Start::kNamed}) {
      const TemporaryFolder folder;
      REQUIRE(write_file(folder / "a.csv", std::string_view("old")).has_value());
      {
        auto file = NewFile::create(folder / "a.csv", start);
        REQUIRE(file->write("new").has_value());
        auto moved = std::move(*file);
        CHECK(text_in(folder / "a.csv") == "old");
      }
      CHECK(text_in(folder / "a.csv") == "old");
      CHECK(folder.entries() == 1);
    }
  }

  TEST_CASE("a process that is ended in the middle leaves nothing") {
    const TemporaryFolder folder;
    // Where the file system has files without names, not even the signal that no process sees leaves any.
    if (const auto probe = ::open((folder / ".").c_str(), O_TMPFILE | O_RDWR, 0600); probe >= 0) {
      ::close(probe);
      CHECK(end_in_the_middle(folder / "a", NewFile::Start::kUnnamed, SIGKILL) == SIGKILL);
      CHECK(folder.entries() == 0);
    }
    for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
      CHECK(end_in_the_middle(folder / "a", NewFile::Start::kUnnamed, signal) == signal);
      CHECK(end_in_the_middle(folder / "a", NewFile::Start::kNamed, signal) == signal);
      CHECK(folder.entries() == 0);
    }
  }

  TEST_CASE("what a killed process left does not stand in the way") {
    const TemporaryFolder folder;
    for (const int attempt : {0, 1}) {
      const std::string name = "a.part" + std::to_string(::getpid()) + "-" + std::to_string(attempt);
      const std::ofstream left(folder / name.c_str());
    }
    for (const auto start : {NewFile::Start::kUnnamed, NewFile::Start::kNamed}) {
      auto file = NewFile::create(folder / "a", start);
      REQUIRE(file.has_value());
      REQUIRE(file->finish().has_value());
    }
    CHECK(folder.entries() == 3);
  }

  TEST_CASE("a replaced file keeps its permissions and a link leads to the new content") {
    const TemporaryFolder folder;
    REQUIRE(write_file(folder / "a", std::string_view("old")).has_value());
    REQUIRE(::chmod((folder / "a").c_str(), 0640) == 0);
    fs::create_symlink("a", folder / "link");
    REQUIRE(write_file(folder / "link", std::string_view("new")).has_value());
    CHECK(fs::is_symlink(folder / "link"));
    CHECK(text_in(folder / "a") == "new");
    CHECK((fs::status(folder / "a").permissions() & fs::perms::all) == fs::perms(0640));
  }

  TEST_CASE("what cannot be a file is an error that names it") {
    const TemporaryFolder folder;
    REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
    for (const std::string& path : {folder / ".", folder / "missing/a", folder / "pipe", std::string()}) {
      const auto file = NewFile::create(path);
      REQUIRE_FALSE(file.has_value());
      CHECK(file.error().code == ErrorCode::kFileNotWritable);
      CHECK(file.error().where == path);
    }
  }
}
