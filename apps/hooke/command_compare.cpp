#include "hooke/command_line.h"
#include "hooke/compare/page.h"
#include "hooke/compare/plots.h"
#include "hooke/compare/stage.h"
#include "hooke/compare/tables.h"
#include "hooke/compare/trial.h"
#include "hooke/output_file.h"
#include "hooke/progress.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <utility>

namespace hooke::app {

namespace {

struct CompareOptions {
  std::string scene;
  std::vector<std::string> steppers = {"euler", "heun", "rk4", kSolverName};
  std::optional<double> seconds;
  std::optional<double> dt;
  std::string point;
  std::string output;
  bool no_limits = false;
};

std::string footer() {
  std::string text = "Steppers:\n  solver            the real-time solver, as in hooke run\n";
  for (const lab::StepperInfo& info : lab::steppers()) {
    const std::string name(info.name);
    text += "  " + name + std::string(name.size() < 18 ? 18 - name.size() : 1, ' ') + std::string(info.title);
    text += info.available ? "\n" : " (not built in)\n";
  }
  return text +
         "A stepper that diverges is drawn up to where it leaves, with when and why.\n"
         "Rigid ropes and springs become springs that their weight stretches by 0.1 %; solids stand still.\n"
         "A scene that declares an accuracy is also run by what that chooses, as 'declared'.\n\n"
         "Writes into DIR: index.html, summary.csv, order.csv, series_*.csv and each plot as .png and .svg.\n"
         "Exit code 3 if gnuplot is missing: tables and page are then written without pictures.\n\n"
         "Examples:\n"
         "  hooke compare scenes/paper/fig3.json --out fig3\n"
         "  hooke compare scenes/paper/fig2.json --steppers euler,paper,verlet,rk4,solver --out fig2";
}

void describe(CLI::App& app, CompareOptions& options) {
  app.add_option("SCENE", options.scene, "Scene file")->required();
  app.add_option("--steppers", options.steppers, "Names, with commas between")
      ->delimiter(',')
      ->capture_default_str()
      ->option_text("A,B,...");
  add_seconds(app, options.seconds, "Simulated time; the scene's by default");
  add_number(app, "--dt", options.dt, 1e-7, 1, "Step [s]; the scene's by default");
  app.add_option("--point", options.point, "Watched point, as rope:15 or rope:last; the first object's last");
  app.add_flag("--no-limits", options.no_limits, "Do not measure orders and stability limits");
  app.add_option("--out", options.output, "Folder for the results; made if it is missing")->required();
  app.footer(footer());
}

Result<void> check(CompareOptions& options) {
  std::vector<std::string> once;
  for (const std::string& name : options.steppers) {
    auto known = check_stepper(name);
    if (!known && known.error().code != ErrorCode::kUnsupported) return known;
    if (std::find(once.begin(), once.end(), name) == once.end()) once.push_back(name);
  }
  options.steppers = std::move(once);
  return {};
}

/// Tells whether only the solver is asked for, which also runs what the laboratory refuses.
bool only_solver(const CompareOptions& options) {
  return options.steppers.size() == 1 && options.steppers.front() == kSolverName;
}

/// Leaves out, before the long work, the steppers by which the laboratory cannot run this scene at all, and
/// reports them. Those that diverge run. The Error tells that none is left. The laboratory does not know the
/// names of scenes.
Result<std::vector<Skipped>> skip_refused(const Stage& stage, CompareOptions& options) {
  std::vector<Skipped> skipped;
  std::optional<Error> first;
  for (const std::string& name : options.steppers) {
    const auto available = check_stepper(name);
    const auto made =
        available ? make_player(stage, name, stage.dt(), true) : Result<Player>(available.error());
    if (made) continue;
    const Error error = refusal(options.scene, made.error());
    skipped.push_back({name, error.message});
    if (!first) first = error;
  }
  const bool is_declared = stage.scene().accuracy.has_value();
  if (first && skipped.size() == options.steppers.size() && !is_declared) return *first;
  std::erase_if(options.steppers, [&](const std::string& name) {
    return std::any_of(skipped.begin(), skipped.end(), [&](const Skipped& one) { return one.name == name; });
  });
  for (const Skipped& one : skipped) {
    warn({ErrorCode::kUnsupported, options.scene, one.name + " is skipped: " + one.reason});
  }
  return skipped;
}

Result<Comparison> compare(const Stage& stage, const CompareOptions& options) {
  const Scene& scene = stage.scene();
  const Outline outline = make_outline(stage);
  const std::size_t runs = options.steppers.size() + 2;
  const Schedule schedule = make_schedule(scene.seconds, stage.dt(), most_frames(outline, runs));
  Comparison comparison = {.scene = options.scene,
                           .title = scene.title,
                           .description = scene.description,
                           .point = stage.point_name,
                           .seconds = static_cast<double>(schedule.steps) * schedule.dt,
                           .dt = schedule.dt,
                           .reference = no_reference(stage, ""),
                           .rigid = rigid_pendulum(stage),
                           .trials = {},
                           .schedule = schedule,
                           .stability = study_stability(stage, options.steppers),
                           .outline = outline};
  std::vector<std::string> names = options.steppers;
  if (scene.accuracy) {
    comparison.max_error = scene.accuracy->max_error;
    if (!only_solver(options)) names.push_back(kDeclaredName);
  }
  auto reference = make_reference(stage, schedule);
  if (reference) {
    comparison.reference = std::move(reference).value();
  } else {
    comparison.reference = no_reference(stage, refusal("", reference.error()).message);
  }
  for (const std::string& name : names) {
    auto trial = run_trial(stage, name, true, schedule, comparison.reference);
    if (!trial) return trial.error();
    comparison.trials.push_back(std::move(trial).value());
  }
  if (options.no_limits) return comparison;
  Progress progress("limits", names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    comparison.trials[i].limits = measure_limits(stage, names[i], schedule, comparison.reference);
    progress.show(i + 1);
  }
  return comparison;
}

Result<void> write_tables(const Comparison& comparison, const std::filesystem::path& folder) {
  const auto write = [&](const std::string& name, const std::string& text) {
    return write_file((folder / name).string(), text);
  };
  for (const Trial& trial : comparison.trials) {
    auto done = write("series_" + trial.name + ".csv", series_csv(trial.samples));
    if (!done) return done;
  }
  if (!comparison.reference.samples.empty()) {
    auto done = write("series_reference.csv", series_csv(comparison.reference.samples));
    if (!done) return done;
  }
  auto done = write("order.csv", order_csv(comparison));
  if (done) done = write("summary.csv", summary_csv(comparison));
  return done;
}

/// Draws every plot in both formats; stops at the first that fails.
Result<void> write_plots(const Comparison& comparison, const std::filesystem::path& folder,
                         std::vector<Picture>& pictures) {
  const std::vector<Plot> plots = plots_of(comparison);
  Progress progress("drawing", plots.size());
  for (const Plot& plot : plots) {
    for (const PlotFormat format : {PlotFormat::kPng, PlotFormat::kSvg}) {
      const bool svg = format == PlotFormat::kSvg;
      const auto bytes = draw_plot(plot, format);
      if (!bytes) return bytes.error();
      auto written = write_file((folder / (plot.name + (svg ? ".svg" : ".png"))).string(), bytes.value());
      if (!written) return written;
      if (svg) pictures.push_back({plot.name, plot.caption, bytes.value()});
    }
    progress.show(pictures.size());
  }
  return {};
}

Result<void> make_folder(const std::string& path) {
  std::error_code code;
  std::filesystem::create_directories(path, code);
  if (std::filesystem::is_directory(path)) return {};
  return Error{ErrorCode::kFileNotWritable, path, code ? code.message() : "is no folder"};
}

ExitCode write(const Comparison& comparison, const std::string& folder) {
  const auto tables = write_tables(comparison, folder);
  if (!tables) return report(tables.error());
  std::fputs(text_of_table(summary_table(comparison)).c_str(), stdout);
  const std::string& title = comparison.reference.title;
  std::printf("errors are distances from %s\n",
              title.empty() ? ("nothing: " + comparison.reference.missing).c_str() : title.c_str());
  for (const Trial& trial : comparison.trials) {
    std::printf("%s %s\n", trial.name.c_str(), verdict_of(trial, comparison).c_str());
  }
  if (!comparison.stability.methods.empty()) {
    std::printf("%s\n", text_of_motion(comparison.stability.system, comparison.dt).c_str());
  }
  for (const std::string& what : comparison.stability.system.left_out) {
    std::printf("left out or replaced in the laboratory: %s\n", what.c_str());
  }
  for (const Skipped& one : comparison.skipped) {
    std::printf("%s was skipped: %s\n", one.name.c_str(), one.reason.c_str());
  }
  std::vector<Picture> pictures;
  const auto drawn = write_plots(comparison, folder, pictures);
  const std::string note = drawn ? "" : "Pictures are missing: " + to_line(drawn.error());
  const auto page = write_file((std::filesystem::path(folder) / "index.html").string(),
                               make_page(comparison, pictures, note));
  if (!drawn) return report(drawn.error());
  if (!page) return report(page.error());
  std::printf("%s\n", (std::filesystem::path(folder) / "index.html").c_str());
  return kGood;
}

}  // namespace

int command_compare(Arguments arguments) {
  CLI::App app("Runs a scene by several methods of integration, and shows what they make of it.",
               "hooke compare");
  CompareOptions options;
  describe(app, options);
  if (const auto code = parse(app, arguments)) return *code;
  const auto known = check(options);
  if (!known) return report(known.error());

  Loaded<Scene> loaded = load_scene(options.scene);
  if (!loaded) return report(loaded.errors, loaded.warnings);
  Scene scene = std::move(*loaded.value);
  scene.seconds = options.seconds.value_or(scene.seconds);
  if (options.dt) scene.dt = static_cast<Real>(*options.dt);
  if (!scene.timeline.empty()) {
    warn({ErrorCode::kUnsupported, options.scene, "the timeline is left out: nothing happens on the way"});
  }
  auto stage = make_stage(std::move(scene), options.point);
  if (!stage) return report(stage.error());
  auto skipped = skip_refused(stage.value(), options);
  if (!skipped) return report(skipped.error());
  const auto folder = make_folder(options.output);
  if (!folder) return report(folder.error());
  auto comparison = compare(stage.value(), options);
  if (!comparison) return report(comparison.error());
  comparison->skipped = std::move(*skipped);
  return write(comparison.value(), options.output);
}

}  // namespace hooke::app
