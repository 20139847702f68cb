#include "process/child.h"

#include <array>
#include <csignal>
#include <cstdio>
#include <doctest/doctest.h>
#include <memory>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace {

using hooke::process::Child;

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, FileCloser>;

std::string text_of(std::FILE* file) {
  std::rewind(file);
  std::array<char, 400> text{};
  return {text.data(), std::fread(text.data(), 1, text.size(), file)};
}

Child start(const std::string& script, const hooke::process::Streams& streams = {}) {
  auto child = Child::start({"sh", "-c", script}, streams);
  REQUIRE(child.has_value());
  return std::move(child).value();
}

}  // namespace

TEST_SUITE("process/child") {
  TEST_CASE("a program reads, writes and ends with its own code") {
    const File input(std::tmpfile());
    const File output(std::tmpfile());
    const File error(std::tmpfile());
    std::fputs("hello\n", input.get());
    std::rewind(input.get());
    Child child = start("read word; echo got $word; echo trouble >&2; exit 7",
                        {::fileno(input.get()), ::fileno(output.get()), ::fileno(error.get())});
    const int status = child.wait();
    CHECK(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 7);
    CHECK(text_of(output.get()) == "got hello\n");
    CHECK(text_of(error.get()) == "trouble\n");
  }

  TEST_CASE("streams that are not given lead nowhere, and nothing else is open") {
    const File output(std::tmpfile());
    Child child = start("read word; ls -l /proc/self/fd | grep -c null; ls /proc/self/fd | wc -l",
                        {.output = ::fileno(output.get())});
    child.wait();
    // `ls` itself opens the folder, as number 3; its own output is a pipe.
    CHECK(text_of(output.get()) == "2\n4\n");
  }

  TEST_CASE("a program that goes on is seen to, and is gone when its child value is") {
    std::array<int, 2> ends = {-1, -1};
    REQUIRE(::pipe(ends.data()) == 0);
    std::array<char, 16> id{};
    {
      // The shell says who it is, and what it starts lives in its group.
      Child child = start("echo $$; sleep 600", {.output = ends[1]});
      REQUIRE(::read(ends[0], id.data(), id.size() - 1) > 0);
      CHECK_FALSE(child.wait_until(std::chrono::steady_clock::now()));
    }
    ::close(ends[0]);
    ::close(ends[1]);
    CHECK(::kill(std::stoi(id.data()), 0) != 0);
  }

  TEST_CASE("a program that does not exist is an error that names it") {
    const auto child = Child::start({"hooke-no-such-program"}, {});
    REQUIRE_FALSE(child.has_value());
    CHECK(child.error().code == hooke::ErrorCode::kUnsupported);
    CHECK(child.error().where == "hooke-no-such-program");
    CHECK_FALSE(Child::start({}, {}).has_value());
  }
}
