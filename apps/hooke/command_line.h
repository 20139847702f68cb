#pragma once

#include "hooke/commands.h"
#include "hooke/result.h"
#include "hooke/scene_io.h"

#include <optional>
#include <span>
#include <string>

namespace CLI {
class App;
}

namespace hooke::app {

/// What the program tells its caller.
enum ExitCode : int {
  kGood = 0,
  kFailed = 1,    ///< It ran, and an expectation or a check failed.
  kBadInput = 2,  ///< A file or an argument is wrong.
  kMachine = 3,   ///< The machine cannot: no OpenGL, no display, no ffmpeg or gnuplot, a write that failed.
};

/// Reads the words into what `app` was told about. An exit code when the command is over: after --help, or
/// after an error, which is printed.
std::optional<int> parse(CLI::App& app, Arguments arguments);

/// Prints one line to stderr, and says how to leave.
ExitCode report(const Error& error);

/// Prints "warning: " and one line to stderr.
void warn(const Error& error);

/// Prints every error and warning; errors are bad input.
ExitCode report(std::span<const Error> errors, std::span<const Error> warnings);

/// The scene, or nothing after its errors were printed.
std::optional<Scene> read_scene(const std::string& path);

/// The simulation, or nothing after the errors were printed.
std::optional<Simulation> build_simulation(Scene scene);

/// Settings of a scene that the command line may replace.
struct SceneOverrides {
  std::optional<int> workers;
  std::optional<int> substeps;
  std::optional<int> particle_substeps;
};

/// Adds the options --workers, --substeps and --particle-substeps. `overrides` must outlive the parsing.
void add_overrides(CLI::App& app, SceneOverrides& overrides);
void apply(const SceneOverrides& overrides, WorldDesc& world);

/// Adds an option for a number within the bounds; unlike the library's own check it refuses what is no
/// number.
void add_number(CLI::App& app, const std::string& name, std::optional<double>& number, double low,
                double high, const std::string& help);

/// Adds --seconds, within what a scene may say.
void add_seconds(CLI::App& app, std::optional<double>& seconds, const std::string& help);

/// Number of steps of `scene` in `seconds`.
std::uint64_t steps_in(const Scene& scene, double seconds);

}  // namespace hooke::app
