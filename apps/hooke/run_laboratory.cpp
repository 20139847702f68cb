#include "hooke/run_laboratory.h"

#include "hooke/compare/stage.h"
#include "hooke/json_of.h"
#include "hooke/lab.h"
#include "hooke/output_file.h"
#include "hooke/progress.h"
#include "hooke/text_of.h"
#include "hooke/version.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace hooke::app {

namespace {

using Json = nlohmann::ordered_json;

std::string name_of(const Simulation& simulation, const lab::ObjectReport& report) {
  for (const SceneObject& object : simulation.objects())
    if (is_of(report, object)) return object.name;
  return "?";
}

std::string csv_line(const lab::Run& run) {
  const Energy energy = run.energy();
  return text_of("%.17g,%.17g,%.17g,%.17g,%llu\n", run.time(), energy.kinetic, energy.potential,
                 energy.elastic, static_cast<unsigned long long>(run.evaluations()));
}

using Quantity = SceneExpectation::Quantity;

/// Tells whether only a step of the solver gives the figure.
bool is_of_solver(Quantity quantity) {
  constexpr Quantity kFigures[] = {
      Quantity::kTension, Quantity::kPenetration, Quantity::kContacts, Quantity::kAsleep, Quantity::kForce,
      Quantity::kTorque,  Quantity::kTwist,       Quantity::kAngle,    Quantity::kWay,    Quantity::kGap,
      Quantity::kBroken,  Quantity::kYielded,     Quantity::kSoft};
  return std::find(std::begin(kFigures), std::end(kFigures), quantity) != std::end(kFigures);
}

/// Checks the scene's expectations in the laboratory's run, if the scene has `laboratory` and the run is as
/// it declares.
class Promises {
 public:
  Promises(Simulation& simulation, bool are_kept) : simulation_(simulation), are_kept_(are_kept) {}

  /// Checks those that are due after so many steps. Errors are those of show_run.
  Result<void> check(const lab::Run& run, std::uint64_t step) {
    const Scene& scene = simulation_.scene();
    bool is_shown = false;
    for (std::size_t i = 0; i < scene.expect.size() && are_kept_; ++i) {
      const SceneExpectation& wanted = scene.expect[i];
      if (is_of_solver(wanted.quantity) || wanted.at_step.value_or(scene.step_count()) != step) continue;
      if (!is_shown) {
        if (auto shown = show_run(run, simulation_); !shown) return shown;
        is_shown = true;
      }
      verdicts_.push_back(simulation_.check(i));
      verdicts_.back().step = step;
    }
    return {};
  }
  [[nodiscard]] const std::vector<SceneVerdict>& verdicts() const { return verdicts_; }
  [[nodiscard]] bool passed() const {
    return std::all_of(verdicts_.begin(), verdicts_.end(), [](const SceneVerdict& v) { return v.passed; });
  }
  [[nodiscard]] std::string text() const {
    std::string text;
    for (const SceneVerdict& v : verdicts_)
      text += (v.passed ? "pass expect[" : "FAIL expect[") + std::to_string(v.index) + "]: " + v.text + "\n";
    return text;
  }

 private:
  Simulation& simulation_;
  bool are_kept_ = false;
  std::vector<SceneVerdict> verdicts_;
};

Result<void> simulate(lab::Run& run, const LaboratoryRun& options, std::uint64_t steps, Promises& promises) {
  std::optional<OutputFile> csv;
  if (!options.csv.empty()) {
    auto created = OutputFile::create(options.csv);
    if (!created) return created.error();
    csv.emplace(std::move(created).value());
    csv->write("time,kinetic,potential,elastic,evaluations\n");
  }
  Progress progress("simulating", steps);
  for (std::uint64_t i = 0; i < steps; ++i) {
    auto done = run.advance();
    if (!done) return done;
    if (csv) csv->write(csv_line(run));
    if (auto checked = promises.check(run, i + 1); !checked) return checked;
    progress.show(i + 1);
  }
  if (csv) return csv->finish();
  return {};
}

Json json_of_collisions(const lab::CollisionReport& report) {
  return {{"hits", report.hits},
          {"rollbacks", report.rollbacks},
          {"resimulated_seconds", report.resimulated_seconds},
          {"limit_reached", report.limit_reached},
          {"zeno", report.zeno},
          {"deepest", report.deepest},
          {"last_hit", report.last_hit},
          {"candidates", report.candidates},
          {"touching", report.touching},
          {"backward_error", report.backward_error}};
}

std::string json_text(const Simulation& simulation, const lab::Run& run, const LaboratoryRun& options,
                      const Energy& start, const Promises& promises) {
  Json objects = Json::array();
  for (const lab::ObjectReport& report : run.report()) {
    Json object = {{"name", name_of(simulation, report)},
                   {"stepper", report.stepper},
                   {"dt", report.dt},
                   {"steps", report.steps},
                   {"evaluations", report.evaluations},
                   {"left_out", report.left_out}};
    object["error"] = report.error ? Json(*report.error) : Json(nullptr);
    objects.push_back(std::move(object));
  }
  const Json report = {{"version", kVersion},
                       {"scene", options.scene},
                       {"stepper", options.stepper},
                       {"seconds", run.time()},
                       {"evaluations", run.evaluations()},
                       {"energy", {{"start", json_of(start)}, {"end", json_of(run.energy())}}},
                       {"collisions", json_of_collisions(run.collisions())},
                       {"expect", json_of(simulation, promises.verdicts())},
                       {"objects", objects}};
  return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string summary_text(const Simulation& simulation, const lab::Run& run, const LaboratoryRun& options,
                         const Energy& start) {
  const Energy end = run.energy();
  std::string text = options.scene + ": " + simulation.scene().title + "\n";
  text += text_of("time      %.6g s in the laboratory, %llu evaluations of the forces\n", run.time(),
                  static_cast<unsigned long long>(run.evaluations()));
  text += text_of("energy    %.6g J kinetic, %.6g potential, %.6g elastic; at the start %.6g, %.6g, %.6g\n",
                  end.kinetic, end.potential, end.elastic, start.kinetic, start.potential, start.elastic);
  const lab::CollisionReport& hits = run.collisions();
  if (hits.candidates > 0) {
    const auto count = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
    text += text_of(
        "collisions %llu hits, the last at %.9g s; %llu rollbacks, %.4g s taken again, %llu at the "
        "limit, %llu Zeno; deepest overlap %.2g m; of %llu pairs that the preselection left %llu touched\n",
        count(hits.hits), hits.last_hit, count(hits.rollbacks), hits.resimulated_seconds,
        count(hits.limit_reached), count(hits.zeno), hits.deepest, count(hits.candidates),
        count(hits.touching));
  }
  for (const lab::ObjectReport& report : run.report()) {
    text += name_of(simulation, report) + ": " + report.stepper;
    text += text_of(", %llu steps of %.4g s", static_cast<unsigned long long>(report.steps), report.dt);
    if (report.error) text += text_of(", estimated error %.2g m", *report.error);
    for (const std::string& word : report.left_out) text += "; without " + word;
    text += "\n";
  }
  return text;
}

}  // namespace

ExitCode run_laboratory(Scene scene, const LaboratoryRun& options) {
  const std::uint64_t steps = steps_in(scene, options.seconds);
  const bool keeps = options.stepper == kDeclaredName && scene.laboratory;
  if (!scene.timeline.empty() || (!keeps && !scene.expect.empty())) {
    const std::string what =
        keeps ? "the timeline is the solver's" : "timeline and expectations are the solver's";
    warn({ErrorCode::kUnsupported, options.scene, what + ", and left out"});
    scene.timeline.clear();
  }
  auto simulation = build_simulation(std::move(scene));
  if (!simulation) return kBadInput;
  auto run = make_run(*simulation, options.stepper, options.seconds, options.force);
  if (!run) return report(run.error());
  const Energy start = run.value().energy();
  Promises promises(*simulation, keeps);
  const auto done = simulate(run.value(), options, steps, promises);
  if (!done) return report(done.error());
  const ExitCode verdict = promises.passed() ? kGood : kFailed;
  if (!options.json.empty()) {
    const auto written =
        write_file(options.json, json_text(*simulation, run.value(), options, start, promises));
    return written ? verdict : report(written.error());
  }
  if (!is_standard_output(options.csv)) {
    std::fputs(summary_text(*simulation, run.value(), options, start).c_str(), stdout);
    std::fputs(promises.text().c_str(), stdout);
  }
  return verdict;
}

}  // namespace hooke::app
