#include "hooke/bench/bench_ofg.h"

#include "hooke/command_line.h"

#include "process/child.h"

#include <cstdio>
#include <sys/wait.h>
#include <unistd.h>

namespace hooke::app {

int bench_ofg(const std::string& csv) {
  const std::string program = process::find_beside("hooke-ofg");
  if (program.empty()) {
    std::fputs(
        "hooke bench: ofg needs hooke-ofg beside hooke: ./dev setup bench, then build with "
        "-DHOOKE_BENCH=ON\n",
        stderr);
    return kMachine;
  }
  std::vector<std::string> words = {program};
  if (!csv.empty()) words.push_back(csv);
  auto child = process::Child::start(words, {.output = STDOUT_FILENO, .error = STDERR_FILENO});
  if (!child) return report(child.error());
  const int status = child.value().wait();
  return WIFEXITED(status) ? WEXITSTATUS(status) : static_cast<int>(kFailed);
}

}  // namespace hooke::app
