#include "hooke/command_line.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <utility>
#include <vector>

namespace hooke::app {

namespace {

/// Tells whether a scene has no errors and no keys without effect; warnings count as errors here.
bool is_good(const std::string& path) {
  Loaded<Scene> scene = load_scene(path);
  report(scene.errors, {});
  report(scene.warnings, {});
  if (!scene) return false;
  const bool was_silent = scene.warnings.empty();
  const Loaded<Simulation> simulation = Simulation::create(std::move(*scene.value), {}, load_options());
  report(simulation.errors, {});
  report(simulation.warnings, {});
  return simulation && simulation.warnings.empty() && was_silent;
}

}  // namespace

int command_validate(Arguments arguments) {
  CLI::App app(
      "Checks scene files and reads the models they use; what a scene says in vain is an error, too. Nothing "
      "is "
      "simulated.",
      "hooke validate");
  std::vector<std::string> paths;
  app.add_option("SCENE", paths, "Scene files")->required();
  app.footer("Examples:\n  hooke validate scenes/rope.json scenes/flag.json");
  if (const auto code = parse(app, arguments)) return *code;

  int result = kGood;
  for (const std::string& path : paths) {
    if (is_good(path)) {
      std::printf("%s: good\n", path.c_str());
    } else {
      result = kBadInput;
    }
  }
  return result;
}

}  // namespace hooke::app
