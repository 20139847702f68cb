#include "hooke/command_line.h"
#include "hooke/compare/stage.h"
#include "hooke/output_file.h"
#include "hooke/progress.h"
#include "hooke/report/run_page.h"
#include "hooke/run_laboratory.h"
#include "hooke/run_report.h"
#include "hooke/settle/scene_rest.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <utility>

namespace hooke::app {

namespace {

struct RunOptions {
  std::string scene;
  std::optional<double> seconds;
  SceneOverrides overrides;
  std::string csv;
  std::string json;
  std::string page;
  bool hash = false;
  std::uint64_t hash_every = 0;  ///< Steps between hashes; 0 stands for never.
  std::string stepper;           ///< Method of the laboratory; empty for the solver.
  bool force = false;
  bool settle = false;       ///< Whether it starts from rest.
  std::uint32_t turned = 0;  ///< Seed of a placement; 0 for none.
};

void describe(CLI::App& app, RunOptions& options) {
  app.add_option("SCENE", options.scene, "Scene file")->required();
  add_seconds(app, options.seconds, "Simulated time; the scene's by default");
  add_overrides(app, options.overrides);
  app.add_option("--csv", options.csv, "Write one line per step");
  app.add_option("--json", options.json, "Write a report; /dev/stdout or - prints it instead of the summary");
  CLI::Option* stepper = app.add_option(
      "--stepper", options.stepper,
      "Run the laboratory instead: a name from hooke compare --help, auto, or declared for what the "
      "scene's accuracy chooses");
  stepper->check(CLI::Validator(
      [](const std::string& name) { return name.empty() ? std::string("needs a name") : std::string(); },
      ""));
  app.add_flag("--force", options.force, "Run an explicit stepper where it is known to diverge, too")
      ->needs(stepper);
  app.add_option("--report", options.page,
                 "Write a page of HTML: promises, what broke, forces on supports, plots, warnings")
      ->excludes(stepper);
  app.add_flag("--hash", options.hash, "Print only the hash of the last state")->excludes(stepper);
  app.add_option("--hash-every", options.hash_every, "Print step and hash after every so many steps")
      ->check(one_or_more())
      ->excludes(stepper);
  app.add_flag("--settle", options.settle, "Bring the scene to rest first, as hooke settle does")
      ->excludes(stepper);
  app.add_option(
         "--turned", options.turned,
         "Turn the whole scene by a random rotation of this seed, and move it: what it promises stays")
      ->check(one_or_more())
      ->excludes(stepper);
  app.footer(
      "Exit code 1 if an expectation of the scene failed. Expectations later than --seconds do not count.\n"
      "What went wrong on the way is a warning, once, with the object, the worst number, its time and what "
      "helps;\n"
      "in the report also under `problems`.\n\n"
      "Examples:\n"
      "  hooke run scenes/rope.json\n"
      "  hooke run scenes/flag.json --seconds 2 --json report.json --csv steps.csv\n"
      "  hooke run scenes/flag.json --seconds 1 --workers 2 --hash\n"
      "  hooke run scenes/paper/fig3.json --stepper rk4");
}

/// Opens the file of steps and writes its header, if one is asked for.
Result<std::optional<OutputFile>> open_steps(const RunOptions& options) {
  if (options.csv.empty()) return std::optional<OutputFile>();
  Result<OutputFile> created = OutputFile::create(options.csv);
  if (!created) return created.error();
  created.value().write(csv_header());
  return std::optional<OutputFile>(std::move(created).value());
}

/// Prints the hash of the state after step `step`, at the steps that it is asked for.
void print_hash(const Simulation& simulation, const RunOptions& options, std::uint64_t step) {
  if (options.hash_every == 0 || step % options.hash_every != 0) return;
  std::printf("%s %s\n", std::to_string(step).c_str(), hash_text(simulation.world().state_hash()).c_str());
}

/// Steps to the end, and fills the record and the file of steps.
Result<void> simulate(Simulation& simulation, const RunOptions& options, std::uint64_t steps,
                      RunRecord& record) {
  Result<std::optional<OutputFile>> steps_file = open_steps(options);
  if (!steps_file) return steps_file.error();
  std::optional<OutputFile>& csv = steps_file.value();
  record.start = simulation.world().measure().energy;
  RunWatch watch(simulation);
  std::optional<RunSeries> series;
  if (!options.page.empty()) series.emplace(simulation, steps);
  Progress progress("simulating", steps);
  for (std::uint64_t i = 0; i < steps; ++i) {
    const auto start = std::chrono::steady_clock::now();
    const StepReport step = simulation.step();
    const auto elapsed = std::chrono::steady_clock::now() - start;
    if (!step.moved) return Error{ErrorCode::kOutOfRange, options.scene, "the step did not move"};
    record.step_ms.push_back(std::chrono::duration<double, std::milli>(elapsed).count());
    record.last = step;
    note_refused(step, record.worst);
    watch.look(simulation, step);
    if (series) series->look(simulation, step.contacts);
    if (csv) csv->write(csv_line(simulation.world(), step.contacts));
    print_hash(simulation, options, i + 1);
    progress.show(i + 1);
  }
  record.problems = watch.warnings();
  for (const RunWarning& problem : record.problems) record.warnings.push_back(problem.line());
  if (series) {
    auto written = write_file(options.page, run_page(simulation, record, *series));
    if (!written) return written;
  }
  if (csv) return csv->finish();
  return {};
}

void add_lines(const std::vector<Error>& errors, std::vector<std::string>& lines) {
  for (const Error& error : errors) lines.push_back(to_line(error));
}

/// Opens the file of the report, if one is asked for.
Result<std::optional<OutputFile>> open_report(const RunOptions& options) {
  if (options.json.empty()) return std::optional<OutputFile>();
  Result<OutputFile> file = OutputFile::create(options.json);
  if (!file) return file.error();
  return std::optional<OutputFile>(std::move(file).value());
}

/// Brings the scene to rest, and notes how. What breaks on the way is an Error: the scene would not be whole.
Result<void> settle_first(Simulation& simulation, RunRecord& record) {
  const auto settled = simulation.world().settle({.dt = simulation.scene().dt});
  if (!settled) return settled.error();
  const std::string text = "--settle: " + settle_text(simulation, settled.value());
  if (settled.value().end == SettleEnd::kBroke) return Error{ErrorCode::kOutOfRange, record.scene, text};
  (settled.value().converged() ? record.notes : record.warnings).push_back(text);
  return {};
}

/// Prints the results, and writes them to `json`, if it has a file.
ExitCode print_results(const Simulation& simulation, const RunOptions& options, const RunRecord& record,
                       std::optional<OutputFile>& json) {
  for (const std::string& note : record.notes) std::fprintf(stderr, "note: %s\n", note.c_str());
  for (const std::string& warning : record.warnings) std::fprintf(stderr, "warning: %s\n", warning.c_str());
  if (json) {
    json->write(run_json(simulation, record));
    const Result<void> written = json->finish();
    if (!written) return report(written.error());
  }
  if (options.hash) std::printf("%s\n", hash_text(simulation.world().state_hash()).c_str());
  const bool taken = options.hash || options.hash_every > 0 || is_standard_output(options.json) ||
                     is_standard_output(options.csv);
  if (!taken) std::fputs(run_summary(simulation, record).c_str(), stdout);
  for (const Error& error : simulation.errors()) report(error);
  return passed(simulation) ? kGood : kFailed;
}

}  // namespace

int command_run(Arguments arguments) {
  CLI::App app("Simulates a scene, measures it and checks what it promises.", "hooke run");
  RunOptions options;
  describe(app, options);
  if (const auto code = parse(app, arguments)) return *code;
  if (is_standard_output(options.csv) && is_standard_output(options.json)) {
    return report(
        {ErrorCode::kOutOfRange, "hooke run", "--csv and --json cannot both go to the standard output"});
  }

  RunRecord record = {.scene = options.scene};
  Loaded<Scene> loaded = load_scene(options.scene);
  if (!loaded) return report(loaded.errors, loaded.warnings);
  Scene scene = std::move(*loaded.value);
  apply(options.overrides, scene.world);
  if (!options.stepper.empty() && options.stepper != kSolverName) {
    for (const Error& warning : loaded.warnings) warn(warning);
    const double seconds = options.seconds.value_or(scene.seconds);
    return run_laboratory(std::move(scene), {.scene = options.scene,
                                             .stepper = options.stepper,
                                             .seconds = seconds,
                                             .force = options.force,
                                             .csv = options.csv,
                                             .json = options.json});
  }
  // A file that cannot be written is better said before the simulation than after it.
  Result<std::optional<OutputFile>> json = open_report(options);
  if (!json) return report(json.error());
  const std::uint64_t steps = options.seconds ? steps_in(scene, *options.seconds) : scene.step_count();
  const Placement placement =
      options.turned == 0 ? Placement{} : random_placement(options.turned, scene.world.gravity);
  Loaded<Simulation> built = Simulation::create(std::move(scene), placement, load_options());
  if (!built) return report(built.errors, built.warnings);
  add_lines(loaded.warnings, record.warnings);
  add_lines(built.warnings, record.warnings);
  add_lines(built.notes, record.notes);

  Simulation& simulation = *built.value;
  if (options.settle) {
    if (const auto settled = settle_first(simulation, record); !settled) return report(settled.error());
  }
  const auto done = simulate(simulation, options, steps, record);
  if (!done) return report(done.error());
  return print_results(simulation, options, record, json.value());
}

}  // namespace hooke::app
