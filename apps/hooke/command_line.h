#pragma once

#include "hooke/commands.h"
#include "hooke/result.h"
#include "hooke/scene_io.h"

#include <optional>
#include <span>
#include <string>

namespace CLI {
class App;
class Validator;
}  // namespace CLI

namespace hooke::app {

/// This is what the program returns to its caller.
enum ExitCode : int {
  kGood = 0,
  /// The program ran, and an expectation or a check failed.
  kFailed = 1,
  kBadInput = 2,  ///< A file or an argument is wrong.
  /// The machine lacks something: OpenGL, a display, ffmpeg or gnuplot, or a write failed.
  kMachine = 3,
};

/// Reads the words into the options of `app`. Returns an exit code when the command is over: after --help, or
/// after an error, which is printed.
std::optional<int> parse(CLI::App& app, Arguments arguments);

/// Prints the error in one line to stderr and returns the exit code for it.
ExitCode report(const Error& error);

/// Prints "warning: " and the error in one line to stderr.
void warn(const Error& error);

/// Prints every error and warning; errors count as bad input.
ExitCode report(std::span<const Error> errors, std::span<const Error> warnings);

/// Returns the scene, or nothing after its errors were printed.
std::optional<Scene> read_scene(const std::string& path);

/// Returns the simulation, or nothing after the errors were printed.
/// Returns how programs make simulations: with convex parts kept in $HOOKE_CACHE, else $XDG_CACHE_HOME/hooke,
/// else ~/.cache/hooke, and nowhere if HOOKE_CACHE is set and empty; with a line of progress.
[[nodiscard]] LoadOptions load_options();

std::optional<Simulation> build_simulation(Scene scene);

/// These are settings of a scene that the command line may replace.
struct SceneOverrides {
  std::optional<int> workers;
  std::optional<int> substeps;
  std::optional<int> particle_substeps;
};

/// Adds the options --workers, --substeps and --particle-substeps. `overrides` must outlive the parsing.
void add_overrides(CLI::App& app, SceneOverrides& overrides);
void apply(const SceneOverrides& overrides, WorldDesc& world);

/// Adds an option for a number within the bounds. Unlike the library's own check it refuses text that is not
/// a number.
void add_number(CLI::App& app, const std::string& name, std::optional<double>& number, double low,
                double high, const std::string& help);

/// Accepts whole numbers from 1 on. The library's own check of them names a bound of 309 digits.
CLI::Validator one_or_more();

/// Adds --seconds, within the range that a scene may have.
void add_seconds(CLI::App& app, std::optional<double>& seconds, const std::string& help);

/// Returns the number of steps of `scene` in `seconds`.
std::uint64_t steps_in(const Scene& scene, double seconds);

}  // namespace hooke::app
