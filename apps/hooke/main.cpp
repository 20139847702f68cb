#include "hooke/command_line.h"
#include "hooke/commands.h"
#include "hooke/machine.h"
#include "hooke/version.h"

#include "process/new_file.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

namespace hooke::app {

namespace {

struct Command {
  const char* name;
  const char* summary;
  int (*function)(Arguments);
};

constexpr std::array kCommands = {
    Command{"run", "simulate a scene, measure it, check what it promises", command_run},
    Command{"view", "show a scene or a model in a window", command_view},
    Command{"render", "draw a scene to a film or to pictures, without a display", command_render},
    Command{"export", "record a scene's motion as .glb .usda .obj .csv or point caches", command_export},
    Command{"check", "run cases with known answers", command_check},
    Command{"compare", "run a scene by several methods of integration, and plot them", command_compare},
    Command{"bench", "time scenes", command_bench},
    Command{"convert", "convert a model from .3ds .obj .stl .ply .gltf .glb to .3ds .obj .stl .glb",
            command_convert},
    Command{"settle", "find the poses in which a model lies still, and their probabilities", command_settle},
    Command{"load", "raise a load until something breaks or collapses; forces in every member", command_load},
    Command{"validate", "check scene files and the models they use; nothing may be in vain",
            command_validate},
    Command{"new", "write a scene to start from", command_new},
};

int print_help() {
  std::printf("hooke: a physics engine for rigid bodies, ropes, cloth and jelly in one world\n\n");
  std::printf(
      "Usage: hooke COMMAND [ARGUMENTS]\n       hooke COMMAND --help\n       hooke --version\n\nCommands:\n");
  for (const Command& command : kCommands) std::printf("  %-10s %s\n", command.name, command.summary);
  std::printf("\nOf every command:\n");
  std::printf(
      "  --instruction-set NAME  steps use those instructions, not the widest; the bits are the same:\n");
  std::printf("                         ");
  for (const std::string& set : instruction_sets()) std::printf(" %s", set.c_str());
  std::printf("\n");
  std::printf(
      "\nExit codes:\n"
      "  0  good\n"
      "  1  an expectation or a check failed\n"
      "  2  bad input: a file or an argument\n"
      "  3  the machine cannot: no OpenGL, no display, no ffmpeg, gnuplot or SUNDIALS, a write that failed\n"
      "\nExamples:\n"
      "  hooke run scenes/rope.json\n"
      "  hooke render scenes/rope.json -o rope.png --at 1\n"
      "  hooke validate scenes/rope.json\n");
  return kGood;
}

int print_version() {
  std::printf("hooke %s\n", kVersion);
  return kGood;
}

bool use_instructions(const std::string& name, const char* said_by) {
  const Result<void> used =
      name.empty() ? Error{ErrorCode::kOutOfRange, "", "needs a name"} : use_instruction_set(name);
  if (!used) std::fprintf(stderr, "hooke: %s %s\n", said_by, used.error().message.c_str());
  return static_cast<bool>(used);
}

/// Removes `--instruction-set NAME` from the arguments, wherever it stands, and applies it. Without it the
/// environment decides.
bool choose_instructions(std::vector<std::string>& arguments) {
  const auto option = std::find(arguments.begin(), arguments.end(), "--instruction-set");
  if (option == arguments.end()) {
    const char* name = std::getenv("HOOKE_INSTRUCTION_SET");
    return name == nullptr || *name == '\0' || use_instructions(name, "HOOKE_INSTRUCTION_SET");
  }
  const std::string name = option + 1 == arguments.end() ? "" : option[1];
  if (!use_instructions(name, "--instruction-set")) return false;
  arguments.erase(option, option + 2);
  return true;
}

int dispatch(Arguments arguments) {
  if (arguments.empty()) {
    std::fputs("hooke: a command is required; see hooke --help\n", stderr);
    return kBadInput;
  }
  const std::string_view name = arguments.front();
  if (name == "--help" || name == "-h" || name == "help") return print_help();
  if (name == "--version") return print_version();
  for (const Command& command : kCommands) {
    if (name == command.name) return command.function(arguments.subspan(1));
  }
  std::fprintf(stderr, "hooke: there is no command '%s'; see hooke --help\n", arguments.front().c_str());
  return kBadInput;
}

}  // namespace

}  // namespace hooke::app

int main(int argument_count, char** argument_values) {
  hooke::process::remove_unfinished_files_on_signals();
  try {
    std::vector<std::string> arguments(argument_values + (argument_count > 0 ? 1 : 0),
                                       argument_values + argument_count);
    if (!hooke::app::choose_instructions(arguments)) return hooke::app::kBadInput;
    const int code = hooke::app::dispatch(arguments);
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
    std::fputs("standard output: cannot be written\n", stderr);
    return hooke::app::kMachine;
  } catch (const std::exception& exception) {
    std::fprintf(stderr, "hooke: %s\n", exception.what());
    return hooke::app::kMachine;
  }
}
