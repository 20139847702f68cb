#include "hooke/command_line.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <utility>
#include <vector>

namespace hooke::app {

int command_validate(Arguments arguments) {
  CLI::App app("Checks scene files and reads the models they use. Nothing is simulated.", "hooke validate");
  std::vector<std::string> paths;
  app.add_option("SCENE", paths, "Scene files")->required();
  app.footer("Examples:\n  hooke validate scenes/rope.json scenes/flag.json");
  if (const auto code = parse(app, arguments)) return *code;

  int result = kGood;
  for (const std::string& path : paths) {
    auto scene = read_scene(path);
    if (scene && build_simulation(std::move(*scene))) {
      std::printf("%s: good\n", path.c_str());
    } else {
      result = kBadInput;
    }
  }
  return result;
}

}  // namespace hooke::app
