#include "hooke/command_line.h"
#include "hooke/export/motion_recorder.h"
#include "hooke/motion_io.h"
#include "hooke/progress.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string_view>
#include <utility>

namespace hooke::app {

namespace {

/// Number of frames that a recording may have: their offsets alone then take 8 MB.
constexpr double kMostFrames = 1e6;

struct ExportOptions {
  std::string scene;
  std::string output;
  std::optional<double> frames_per_second;
  std::optional<double> seconds;
  std::optional<double> tolerance;  ///< [m]
  std::size_t most_targets = MotionOptions{}.most_targets;
  bool with_points = false;
  SceneOverrides overrides;
};

void describe(CLI::App& app, ExportOptions& options) {
  app.add_option("SCENE", options.scene, "Scene file")->required();
  app.add_option("-o,--output", options.output,
                 "X.glb, X.usda, X_%04d.obj, X.csv, or X/ for a folder of point caches")
      ->required();
  add_seconds(app, options.seconds, "Time to record; the scene's by default");
  add_number(app, "--fps", options.frames_per_second, 0.01, 1000,
             "Frames per simulated second; 30 by default");
  add_number(app, "--tolerance", options.tolerance, 0, 1e6,
             "Leave out frames of .glb and .usda that those around them blend to within this [m]; 0.0001 by "
             "default");
  app.add_option(
         "--morph-targets", options.most_targets,
         "Shapes that a .glb keeps of each rope, cloth or solid at most; more tolerance makes them do")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  app.add_flag("--points", options.with_points, "Write each point of ropes, cloths and solids to .csv, too");
  add_overrides(app, options.overrides);
  app.footer(
      "X.glb      glTF 2.0: bodies as animated nodes, all else as morph targets, images inside\n"
      "X.usda     USD as text: the same, with colliders, masses and joints of UsdPhysics\n"
      "X_%04d.obj a file for each frame, and one .mtl\n"
      "X.csv      place, velocity, rotation, spin and energy of each object in each frame\n"
      "X/         a .pc2 for each rope, cloth and solid, bodies.glb, and a script that loads all in "
      "Blender\n\n"
      "Examples:\n"
      "  hooke export scenes/pendulum.json -o pendulum.glb\n"
      "  hooke export scenes/flag.json -o flag.usda --seconds 2 --fps 60\n"
      "  hooke export scenes/showcase.json -o showcase/\n"
      "  hooke export scenes/rope.json -o rope.csv --points");
}

/// Returns the number of frames, both ends counted.
Result<std::size_t> count_frames(double seconds, double frames_per_second) {
  const double frames = std::round(seconds * frames_per_second);
  if (frames < 1) {
    return Error{ErrorCode::kOutOfRange, "--seconds",
                 "is shorter than a frame: nothing would move; record a longer time or more --fps"};
  }
  if (frames > kMostFrames) {
    return Error{ErrorCode::kLimitExceeded, "--seconds",
                 "would be more than a million frames; record a shorter time or less --fps"};
  }
  return static_cast<std::size_t>(frames) + 1;
}

/// Steps to the end, and records each frame between the two steps around it.
Result<void> record_frames(Simulation& simulation, MotionRecorder& recorder, std::size_t frames,
                           double frames_per_second) {
  const auto dt = static_cast<double>(simulation.scene().dt);
  recorder.take(simulation, 0);
  std::optional<Progress> progress;
  progress.emplace("recording", frames);
  std::uint64_t steps = 0;
  std::size_t unhealthy = 0;
  for (std::size_t frame = 0; frame < frames; ++frame) {
    const double time = static_cast<double>(frame) / frames_per_second;
    // A time that is a whole number of steps, except for rounding, needs no step beyond.
    const auto last = static_cast<std::uint64_t>(std::ceil(std::max(time / dt - 1e-4, 0.0)));
    while (steps < last) {
      const StepReport step = simulation.step();
      if (!step.moved) return Error{ErrorCode::kOutOfRange, simulation.scene().path, "the step did not move"};
      ++steps;
      if (!step.healthy()) ++unhealthy;
      if (last - steps <= 1) recorder.take(simulation, static_cast<double>(steps) * dt);
    }
    if (auto recorded = recorder.record(simulation, time); !recorded) return recorded;
    progress->show(frame + 1);
  }
  progress.reset();  // Its line goes before others come.
  if (unhealthy > 0) {
    std::fprintf(stderr,
                 "warning: in %zu steps something was put back that was no number; hooke run says what\n",
                 unhealthy);
  }
  return {};
}

void print(const MotionSummary& summary) {
  const double mebibytes = static_cast<double>(summary.bytes) / 1048576;
  for (const std::string& file : summary.files) std::printf("%s\n", file.c_str());
  std::printf("%zu objects, %zu frames, %.2f MiB\n", summary.objects, summary.frames, mebibytes);
  for (const std::string& note : summary.notes) std::printf("%s\n", note.c_str());
}

bool is_table(const std::string& output) {
  constexpr std::string_view kEnding = ".csv";
  return output.size() > kEnding.size() &&
         std::equal(kEnding.begin(), kEnding.end(),
                    output.end() - static_cast<std::ptrdiff_t>(kEnding.size()),
                    [](char a, char b) { return a == std::tolower(static_cast<unsigned char>(b)); });
}

int write_recorded(const MotionRecorder& recorder, const ExportOptions& options) {
  constexpr std::uint64_t kParts = 1000;
  std::optional<Progress> progress;
  progress.emplace("writing", kParts);
  MotionOptions writing;
  writing.tolerance = options.tolerance.value_or(writing.tolerance);
  writing.most_targets = options.most_targets;
  writing.with_points = options.with_points;
  writing.progress = [&](double part) { progress->show(static_cast<std::uint64_t>(part * kParts)); };
  const auto summary = write_motion(recorder.motion(), options.output, writing);
  progress.reset();  // Its line goes before others come.
  if (!summary) return report(summary.error());
  print(summary.value());
  return kGood;
}

}  // namespace

int command_export(Arguments arguments) {
  CLI::App app("Records how a scene moves, and writes it for other programs.", "hooke export");
  ExportOptions options;
  describe(app, options);
  if (const auto code = parse(app, arguments)) return *code;
  if (options.with_points && !is_table(options.output)) {
    return report(
        {ErrorCode::kOutOfRange, "--points", "is for X.csv; all other formats have every point anyway"});
  }
  const double frames_per_second = options.frames_per_second.value_or(30);
  auto scene = read_scene(options.scene);
  if (!scene) return kBadInput;
  apply(options.overrides, scene->world);
  const auto frames = count_frames(options.seconds.value_or(scene->seconds), frames_per_second);
  if (!frames) return report(frames.error());
  // A file that cannot be written is better said before the simulation than after it.
  auto motion = MotionRecording::create(options.output, frames_per_second);
  if (!motion) return report(motion.error());
  auto simulation = build_simulation(std::move(*scene));
  if (!simulation) return kBadInput;
  const auto detail =
      is_table(options.output) ? MotionRecorder::Detail::kPoints : MotionRecorder::Detail::kSkins;
  MotionRecorder recorder(std::move(motion).value(), detail);
  const auto recorded = record_frames(*simulation, recorder, frames.value(), frames_per_second);
  for (const std::string& warning : recorder.warnings())
    std::fprintf(stderr, "warning: %s\n", warning.c_str());
  if (!recorded) return report(recorded.error());
  for (const Error& error : simulation->errors()) warn(error);
  if (!recorder.has_objects()) {
    return report({ErrorCode::kOutOfRange, options.scene,
                   "holds nothing that moves or stands: add bodies, ropes, cloths, solids or particles"});
  }
  return write_recorded(recorder, options);
}

}  // namespace hooke::app
