#include "hooke/command_line.h"

#include "hooke/progress.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace hooke::app {

std::optional<int> parse(CLI::App& app, Arguments arguments) {
  // The library takes the words from the back.
  std::vector<std::string> words(arguments.rbegin(), arguments.rend());
  try {
    app.parse(std::move(words));
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
      app.exit(error);
      return kGood;
    }
    std::string reason = error.what();
    std::replace(reason.begin(), reason.end(), '\n', ' ');
    std::fprintf(stderr, "%s: %s; see %s --help\n", app.get_name().c_str(), reason.c_str(),
                 app.get_name().c_str());
    return kBadInput;
  }
}

ExitCode report(const Error& error) {
  std::fprintf(stderr, "%s\n", to_line(error).c_str());
  switch (error.code) {
    case ErrorCode::kFileNotWritable:
    case ErrorCode::kUnsupported:
      return kMachine;
    default:
      return kBadInput;
  }
}

void warn(const Error& error) {
  std::fprintf(stderr, "warning: %s\n", to_line(error).c_str());
}

ExitCode report(std::span<const Error> errors, std::span<const Error> warnings) {
  for (const Error& warning : warnings) warn(warning);
  for (const Error& error : errors) report(error);
  return errors.empty() ? kGood : kBadInput;
}

std::optional<Scene> read_scene(const std::string& path) {
  Loaded<Scene> loaded = load_scene(path);
  report(loaded.errors, loaded.warnings);
  return std::move(loaded.value);
}

static std::string cache_folder() {
  if (const char* chosen = std::getenv("HOOKE_CACHE"); chosen != nullptr) return chosen;
  if (const char* caches = std::getenv("XDG_CACHE_HOME"); caches != nullptr && *caches != '\0')
    return std::string(caches) + "/hooke";
  const char* home = std::getenv("HOME");
  return home != nullptr && *home != '\0' ? std::string(home) + "/.cache/hooke" : std::string();
}

LoadOptions load_options() {
  constexpr double kParts = 1000;
  auto shown = std::make_shared<std::optional<Progress>>();
  return {.cache = cache_folder(), .progress = [shown](std::string_view what, double part) {
            if (!*shown) shown->emplace(std::string(what), static_cast<std::uint64_t>(kParts));
            (*shown)->show(static_cast<std::uint64_t>(kParts * part));
            if (part >= 1) shown->reset();
          }};
}

std::optional<Simulation> build_simulation(Scene scene) {
  Loaded<Simulation> loaded = Simulation::create(std::move(scene), {}, load_options());
  report(loaded.errors, loaded.warnings);
  return std::move(loaded.value);
}

void add_overrides(CLI::App& app, SceneOverrides& overrides) {
  app.add_option("--workers", overrides.workers, "Threads; the result does not depend on it")
      ->check(CLI::Range(1, 64));
  app.add_option("--substeps", overrides.substeps, "Solver passes per step")->check(CLI::Range(1, 64));
  app.add_option("--particle-substeps", overrides.particle_substeps, "Passes over deformables per substep")
      ->check(CLI::Range(1, 64));
}

void apply(const SceneOverrides& overrides, WorldDesc& world) {
  world.workers = overrides.workers.value_or(world.workers);
  world.substeps = overrides.substeps.value_or(world.substeps);
  world.particle_substeps = overrides.particle_substeps.value_or(world.particle_substeps);
}

void add_number(CLI::App& app, const std::string& name, std::optional<double>& number, double low,
                double high, const std::string& help) {
  const auto check = [low, high](const std::string& word) -> std::string {
    double value = 0;
    if (CLI::detail::lexical_cast(word, value) && value >= low && value <= high) return "";
    char bounds[80];
    std::snprintf(bounds, sizeof bounds, " is not a number from %g to %g", low, high);
    return word + bounds;
  };
  app.add_option(name, number, help)->check(CLI::Validator(check, ""));
}

CLI::Validator one_or_more() {
  return CLI::Range(std::int64_t{1}, std::int64_t{std::numeric_limits<std::uint32_t>::max()});
}

void add_seconds(CLI::App& app, std::optional<double>& seconds, const std::string& help) {
  add_number(app, "--seconds", seconds, 0, 1e6, help);
}

std::uint64_t steps_in(const Scene& scene, double seconds) {
  return static_cast<std::uint64_t>(std::llround(seconds / static_cast<double>(scene.dt)));
}

}  // namespace hooke::app
