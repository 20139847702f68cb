/// hooke_fuzz TARGET --seed A --count N [--seconds S]: random trials, each made from its seed alone. A child
/// process tries one seed after the other and says in shared memory which; where it dies or does not come
/// back, its parent names the seed and goes on behind it.

#include "fuzz/target.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace hooke::fuzz {

namespace {

using Clock = std::chrono::steady_clock;

constexpr Target kTargets[] = {
    {"api", try_api},       {"scenes", try_scene}, {"json", try_json},
    {"flat", try_flat},     {"bsp", try_bsp},      {"meshes", try_meshes},
    {"import", try_import}, {"rooms", try_room},   {"hands", try_hands},
};

constexpr int kFailed = 3;  // how a child ends that found something
constexpr std::size_t kMostFigures = 16;

/// What the child tells its parent.
struct Shared {
  volatile std::uint64_t seed = 0;
  volatile std::uint64_t done = 0;
  volatile std::uint64_t parts = 0;
  char why[4000] = {};
  WorstFigure worst[kMostFigures] = {};  ///< The first without a name ends the list.
};

struct Options {
  const Target* target = nullptr;
  std::uint64_t seed = 1;
  std::uint64_t count = 1000;
  double seconds = 1e9;
  double patience = 30;         ///< For one seed [s].
  double memory_gib = 0;        ///< Of the child; 0: no bound.
  std::uint64_t failures = 20;  ///< After so many it ends.
};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void keep_why(Shared& shared, const std::string& why) {
  std::string text = why;
  const std::size_t shown = std::min<std::size_t>(notes().size(), 12);
  for (std::size_t i = notes().size() - shown; i < notes().size(); ++i) text += "\n    " + notes()[i];
  text.resize(std::min(text.size(), sizeof(shared.why) - 1));
  std::memcpy(shared.why, text.c_str(), text.size() + 1);
}

/// Keeps the figures of a trial that are worse than those of all before.
void keep_worst(Shared& shared, std::uint64_t seed) {
  for (const WorstFigure& figure : figures()) {
    for (WorstFigure& worst : shared.worst) {
      const bool is_free = worst.name[0] == '\0';
      if (!is_free && std::strcmp(worst.name, figure.name) != 0) continue;
      if (is_free || figure.value > worst.value) worst = figure;
      if (worst.value == figure.value && worst.seed == 0) worst.seed = seed;
      break;
    }
  }
}

/// Tries one seed. Whether it was well.
bool try_seed(const Target& target, std::uint64_t seed, Shared& shared) {
  shared.seed = seed;
  notes().clear();
  figures().clear();
  part_count() = 0;
  Random random(seed);
  bool is_well = true;
  try {
    target.run(random);
  } catch (const std::exception& error) {
    keep_why(shared, error.what());
    is_well = false;
  }
  shared.parts = part_count();
  keep_worst(shared, seed);
  return is_well;
}

[[noreturn]] void run_child(const Options& options, std::uint64_t first, Clock::time_point start,
                            Shared& shared) {
  if (options.memory_gib > 0) {
    const auto bytes = static_cast<rlim_t>(options.memory_gib * 1073741824.0);
    const rlimit limit = {bytes, bytes};
    ::setrlimit(RLIMIT_AS, &limit);
  }
  const rlimit no_core = {0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  for (std::uint64_t seed = first; seed < options.seed + options.count; ++seed) {
    if (!try_seed(*options.target, seed, shared)) std::_Exit(kFailed);
    shared.done = shared.done + 1;
    if (seconds_since(start) > options.seconds) break;
  }
  std::_Exit(0);
}

/// How the child ended; "" is well.
std::string wait_for(pid_t child, const Options& options, Shared& shared) {
  std::uint64_t seed = shared.seed;
  Clock::time_point since = Clock::now();
  int status = 0;
  while (::waitpid(child, &status, WNOHANG) == 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    if (shared.seed != seed) {
      seed = shared.seed;
      since = Clock::now();
    }
    if (seconds_since(since) < options.patience) continue;
    ::kill(child, SIGKILL);
    ::waitpid(child, &status, 0);
    return "takes more than " + std::to_string(static_cast<int>(options.patience)) + " s";
  }
  if (WIFSIGNALED(status)) return std::string("signal ") + ::strsignal(WTERMSIG(status));
  if (WEXITSTATUS(status) == kFailed) return shared.why;
  return WEXITSTATUS(status) == 0 ? "" : "ended with status " + std::to_string(WEXITSTATUS(status));
}

int run(const Options& options, Shared& shared) {
  const Clock::time_point start = Clock::now();
  std::uint64_t failures = 0;
  for (std::uint64_t seed = options.seed; seed < options.seed + options.count; seed = shared.seed + 1) {
    shared.seed = seed;
    shared.why[0] = '\0';
    std::fflush(nullptr);
    const pid_t child = ::fork();
    if (child == 0) run_child(options, seed, start, shared);
    const std::string why = wait_for(child, options, shared);
    if (why.empty()) break;
    ++failures;
    std::printf("FAILED %s --seed %llu: %s\n", options.target->name,
                static_cast<unsigned long long>(shared.seed), why.c_str());
    if (failures >= options.failures || seconds_since(start) > options.seconds) break;
  }
  std::printf("%s: %llu trials from seed %llu, %llu failed, %.1f s\n", options.target->name,
              static_cast<unsigned long long>(shared.done + failures),
              static_cast<unsigned long long>(options.seed), static_cast<unsigned long long>(failures),
              seconds_since(start));
  for (const WorstFigure& worst : shared.worst) {
    if (worst.name[0] != '\0')
      std::printf("%-20s %12.6g in seed %llu\n", worst.name, worst.value,
                  static_cast<unsigned long long>(worst.seed));
  }
  return failures == 0 ? 0 : 1;
}

/// Why the one seed fails; "" if it does not.
std::string try_once(const Options& options, Shared& shared) {
  Options once = options;
  once.count = 1;
  shared.why[0] = '\0';
  std::fflush(nullptr);
  const pid_t child = ::fork();
  if (child == 0) run_child(once, once.seed, Clock::now(), shared);
  return wait_for(child, once, shared);
}

/// What failed, without figures: a smaller trial that fails in another way is another failure.
std::string_view kind_of(std::string_view why) {
  return why.substr(0, why.find_first_of("0123456789"));
}

/// Leaves out parts of a trial, many at once and then fewer, as long as it still fails in the same way.
int minimize(const Options& options, Shared& shared) {
  std::string why = try_once(options, shared);
  if (why.empty()) return std::puts("well") >= 0 ? 0 : 2;
  std::vector<bool>& left_out = setting().left_out;
  left_out.assign(std::max(static_cast<std::size_t>(shared.parts), std::size_t{256}),
                  false);  // a crash does not say how many there are
  for (std::size_t size = left_out.size() / 2; size > 0; size /= 2) {
    for (std::size_t first = 0; first < left_out.size(); first += size) {
      const std::vector<bool> before = left_out;
      for (std::size_t i = first; i < std::min(first + size, left_out.size()); ++i) left_out[i] = true;
      if (before == left_out) continue;
      const std::string now = try_once(options, shared);
      if (kind_of(now) != kind_of(why))
        left_out = before;
      else
        why = now;
    }
  }
  std::printf("%s\n--only", why.c_str());
  for (std::size_t i = 0; i < left_out.size(); ++i) {
    if (!left_out[i]) std::printf("%c%zu", i == 0 ? ' ' : ',', i);
  }
  std::printf("\n");
  return 1;
}

/// Leaves out all but the parts named, "3,4,17".
void keep_only(const char* list) {
  setting().left_out.assign(4096, true);
  for (const char* at = list; *at != '\0';) {
    char* end = nullptr;
    const unsigned long number = std::strtoul(at, &end, 10);
    if (end == at) return;
    if (number < setting().left_out.size()) setting().left_out[number] = false;
    at = *end == ',' ? end + 1 : end;
  }
}

int usage() {
  std::fputs(
      "hooke_fuzz TARGET [--seed A] [--count N] [--seconds S] [--patience S] [--memory GIB] [--failures N]\n"
      "                  [--scenes DIR] [--corpus DIR] [--importer FILE] [--save FILE] [--only PARTS]\n"
      "                  [--figure NAME] [--above X] [--verbose | --minimize]\n"
      "Targets: api scenes json flat bsp meshes import rooms hands\n"
      "--verbose tries one seed in this process and says each step: for a debugger. --minimize finds the "
      "parts of a\n"
      "trial that fail together, --only keeps those. --figure asks for one figure of a room alone, as "
      "overlap,\n"
      "--above for more than its limit.\n",
      stderr);
  return 2;
}

/// Whether the option was one of those that every trial may ask for.
bool take_setting(std::string_view name, const char* value) {
  if (name == "--scenes")
    setting().scenes = value;
  else if (name == "--corpus")
    setting().corpus = value;
  else if (name == "--importer")
    setting().importer = value;
  else if (name == "--save")
    setting().save = value;
  else if (name == "--figure")
    setting().figure = value;
  else if (name == "--above")
    setting().above = std::strtod(value, nullptr);
  else if (name == "--only")
    keep_only(value);
  else
    return false;
  return true;
}

/// Whether the option was one.
bool take_option(std::string_view name, const char* value, Options& options) {
  if (name == "--seed")
    options.seed = std::strtoull(value, nullptr, 10);
  else if (name == "--count")
    options.count = std::strtoull(value, nullptr, 10);
  else if (name == "--seconds")
    options.seconds = std::strtod(value, nullptr);
  else if (name == "--patience")
    options.patience = std::strtod(value, nullptr);
  else if (name == "--memory")
    options.memory_gib = std::strtod(value, nullptr);
  else if (name == "--failures")
    options.failures = std::strtoull(value, nullptr, 10);
  else
    return take_setting(name, value);
  return true;
}

int main_of(int argc, char** argv) {
  if (argc < 2) return usage();
  Options options;
  for (const Target& target : kTargets) {
    if (target.name == std::string_view(argv[1])) options.target = &target;
  }
  if (options.target == nullptr) return usage();
  bool is_minimizing = false;
  for (int i = 2; i < argc; ++i) {
    if (argv[i] == std::string_view("--verbose")) {
      setting().verbose = true;
    } else if (argv[i] == std::string_view("--minimize")) {
      is_minimizing = true;
    } else if (i + 1 >= argc || !take_option(argv[i], argv[i + 1], options)) {
      return usage();
    } else {
      ++i;
    }
  }
  void* memory = ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return 2;
  Shared& shared = *new (memory) Shared;
  if (is_minimizing) return minimize(options, shared);
  if (!setting().verbose) return run(options, shared);
  const bool well = try_seed(*options.target, options.seed, shared);
  std::printf("%s\n", well ? "well" : shared.why);
  return well ? 0 : 1;
}

}  // namespace

}  // namespace hooke::fuzz

int main(int argc, char** argv) {
  return hooke::fuzz::main_of(argc, argv);
}
