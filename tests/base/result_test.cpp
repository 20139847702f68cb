#include "hooke/result.h"

#include <array>
#include <csignal>
#include <cstdio>
#include <doctest/doctest.h>
#include <memory>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

using hooke::Error;
using hooke::ErrorCode;
using hooke::Result;

namespace {

const Error kBad = {ErrorCode::kOutOfRange, "world.workers", "0 is not within 1 and 64"};

struct Ending {
  int signal = 0;  ///< 0 when it ended by itself.
  std::string said = {};
};

/// What becomes of a process that calls `act`, and what it wrote to stderr.
template <class Act>
Ending ending_of(const Act& act) {
  std::array<int, 2> ends = {};
  REQUIRE(::pipe(ends.data()) == 0);
  const pid_t id = ::fork();
  REQUIRE(id >= 0);
  if (id == 0) {
    std::signal(SIGABRT, SIG_DFL);  // not the test program's, which would go on with the other tests
    ::dup2(ends[1], STDERR_FILENO);
    act();
    ::_exit(0);
  }
  ::close(ends[1]);
  Ending ending;
  std::array<char, 256> text = {};
  for (ssize_t size = 0; (size = ::read(ends[0], text.data(), text.size())) > 0;) {
    ending.said.append(text.data(), static_cast<std::size_t>(size));
  }
  ::close(ends[0]);
  int status = 0;
  REQUIRE(::waitpid(id, &status, 0) == id);
  ending.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  return ending;
}

}  // namespace

TEST_SUITE("base/result") {
  TEST_CASE("a value is reached by every way, copied or moved") {
    Result<std::string> word = std::string("rope");
    CHECK(word.value() == "rope");
    CHECK(*word == "rope");
    CHECK(word->size() == 4);
    CHECK(word.value_or("none") == "rope");
    *word = "cloth";
    word->push_back('s');
    CHECK(std::as_const(word).value() == "cloths");
    Result<std::unique_ptr<int>> owner = std::make_unique<int>(7);
    CHECK(**owner == 7);
    const std::unique_ptr<int> taken = std::move(owner).value_or(nullptr);
    CHECK(*taken == 7);
    Result<std::unique_ptr<int>> other = std::make_unique<int>(8);
    CHECK(*std::unique_ptr<int>(*std::move(other)) == 8);
  }

  TEST_CASE("an error has a substitute") {
    const Result<int> none = kBad;
    CHECK(none.value_or(3) == 3);
    CHECK(none.error().where == "world.workers");
    CHECK(Result<std::unique_ptr<int>>(kBad).value_or(nullptr) == nullptr);
    CHECK(Result<std::string>(kBad).value_or("none") == "none");
  }

  TEST_CASE("what lacks a value says why and aborts") {
    Result<std::string> none = kBad;
    const Result<void> failed = kBad;
    const std::string line = "hooke: world.workers: 0 is not within 1 and 64\n";
    const auto says_why = [&](const auto& act) {
      const Ending ending = ending_of(act);
      CHECK(ending.signal == SIGABRT);
      CHECK(ending.said == line);
    };
    says_why([&] { static_cast<void>(none.value()); });
    says_why([&] { static_cast<void>(std::as_const(none).value()); });
    says_why([&] { static_cast<void>(std::move(none).value()); });
    says_why([&] { static_cast<void>(*none); });
    says_why([&] { static_cast<void>(none->size()); });
    says_why([&] { static_cast<void>(std::as_const(none)->size()); });
    says_why([&] { failed.value(); });
  }

  TEST_CASE("what has no error says so and aborts") {
    const Result<int> seven = 7;
    const Result<void> done;
    done.value();
    CHECK(ending_of([&] { static_cast<void>(seven.error()); }).signal == SIGABRT);
    CHECK(ending_of([&] { static_cast<void>(done.error()); }).said.find("without one") != std::string::npos);
  }
}
