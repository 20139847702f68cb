#include "hooke/run_report.h"

#include "hooke/json_of.h"
#include "hooke/text_of.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hooke::app {

using Json = nlohmann::ordered_json;

StepTimes step_times(const std::vector<double>& step_ms) {
  if (step_ms.empty()) return {};
  std::vector<double> sorted = step_ms;
  std::sort(sorted.begin(), sorted.end());
  const auto at = [&](double part) {
    return sorted[static_cast<std::size_t>(part * static_cast<double>(sorted.size() - 1))];
  };
  return {.min = sorted.front(), .median = at(0.5), .p99 = at(0.99)};
}

std::string hash_text(std::uint64_t hash) {
  return text_of("%016llx", static_cast<unsigned long long>(hash));
}

bool passed(const Simulation& simulation) {
  const auto verdicts = simulation.verdicts();
  return simulation.errors().empty() &&
         std::all_of(verdicts.begin(), verdicts.end(), [](const SceneVerdict& v) { return v.passed; });
}

static Json json_of_problems(const std::vector<RunWarning>& problems) {
  Json list = Json::array();
  for (const RunWarning& one : problems) {
    list.push_back({{"object", one.object},
                    {"what", one.what},
                    {"worst", one.worst},
                    {"limit", one.limit},
                    {"unit", one.unit},
                    {"time", one.time},
                    {"cure", one.cure}});
  }
  return list;
}

std::string run_json(const Simulation& simulation, const RunRecord& record) {
  const World& world = simulation.world();
  const Measurement end = world.measure();
  const StepTimes times = step_times(record.step_ms);
  Json errors = Json::array();
  for (const Error& error : simulation.errors()) errors.push_back(to_line(error));
  const Json report = {
      {"scene", record.scene},
      {"steps", world.step_count()},
      {"seconds", world.time()},
      {"ms_per_step", {{"min", times.min}, {"median", times.median}, {"p99", times.p99}}},
      {"energy", {{"start", json_of(record.start)}, {"end", json_of(end.energy)}}},
      {"momentum", {end.momentum.x, end.momentum.y, end.momentum.z}},
      {"largest_stretch", end.largest_stretch},
      {"mean_stretch", end.mean_stretch},
      {"largest_penetration", end.largest_penetration},
      {"largest_gap", end.largest_gap},
      {"contacts", record.contacts},
      {"state_hash", hash_text(world.state_hash())},
      {"expect", json_of(simulation, simulation.verdicts())},
      {"passed", passed(simulation)},
      {"errors", errors},
      {"warnings", record.warnings},
      {"problems", json_of_problems(record.problems)},
  };
  // A file's name may be anything, a report is UTF-8.
  return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string run_summary(const Simulation& simulation, const RunRecord& record) {
  const World& world = simulation.world();
  const Measurement end = world.measure();
  const StepTimes times = step_times(record.step_ms);
  const double wall = std::accumulate(record.step_ms.begin(), record.step_ms.end(), 0.0) / 1000;
  std::string text = record.scene + ": " + simulation.scene().title + "\n";
  text += text_of("time      %.6g s in %llu steps, computed in %.3g s", world.time(),
                  static_cast<unsigned long long>(world.step_count()), wall);
  if (wall > 0) text += text_of(" (%.3g x real time)", world.time() / wall);
  text += text_of("\nstep      %.4g ms median, %.4g fastest, %.4g at 99 %%\n", times.median, times.min,
                  times.p99);
  text += text_of("energy    %.6g J kinetic, %.6g potential, %.6g elastic; at the start %.6g, %.6g, %.6g\n",
                  end.energy.kinetic, end.energy.potential, end.energy.elastic, record.start.kinetic,
                  record.start.potential, record.start.elastic);
  text += text_of("stretch   %.3g %% at most, %.3g %% on average\n", 100 * end.largest_stretch,
                  100 * end.mean_stretch);
  text += text_of("contacts  %u, deepest overlap %.3g mm\n", record.contacts, 1000 * end.largest_penetration);
  text += "hash      " + hash_text(world.state_hash()) + "\n";
  text += simulation.report();
  const std::size_t due = simulation.verdicts().size();
  const std::size_t promised = simulation.scene().expect.size();
  if (due < promised) {
    text += text_of("%zu of %zu expectations are due later than this run\n", promised - due, promised);
  }
  return text;
}

std::string csv_header() {
  return "step,time,kinetic,potential,elastic,momentum_x,momentum_y,momentum_z,largest_stretch,"
         "largest_penetration,largest_gap,contacts,state_hash\n";
}

std::string csv_line(const World& world, std::uint32_t contacts) {
  const Measurement m = world.measure();
  return text_of("%llu,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%u,",
                 static_cast<unsigned long long>(world.step_count()), world.time(), m.energy.kinetic,
                 m.energy.potential, m.energy.elastic, m.momentum.x, m.momentum.y, m.momentum.z,
                 m.largest_stretch, m.largest_penetration, m.largest_gap, contacts) +
         hash_text(world.state_hash()) + "\n";
}

}  // namespace hooke::app
