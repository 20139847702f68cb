#include "hooke/bench/bench_ofg.h"
#include "hooke/bench/bench_peers.h"
#include "hooke/command_line.h"
#include "hooke/output_file.h"
#include "hooke/progress.h"
#include "hooke/run_report.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <vector>

namespace hooke::app {

namespace {

struct BenchOptions {
  std::vector<std::string> scenes;
  std::vector<int> workers = {1};
  std::optional<int> steps = {};
  std::optional<int> substeps = {};
  std::string csv = {};
  bool peers = false;
};

struct BenchRow {
  StepTimes ms;
  std::uint32_t contacts = 0;
  std::uint64_t hash = 0;
  Measurement figures;
};

constexpr int kSteps = 300;

/// The first tenth of the steps warms up and is not timed.
BenchRow measure(Simulation& simulation, int steps) {
  BenchRow row;
  std::vector<double> times;
  for (int i = 0; i < steps; ++i) {
    const auto start = std::chrono::steady_clock::now();
    row.contacts = simulation.step().contacts;
    const auto elapsed = std::chrono::steady_clock::now() - start;
    if (i >= steps / 10) times.push_back(std::chrono::duration<double, std::milli>(elapsed).count());
  }
  row.ms = step_times(times);
  row.hash = simulation.world().state_hash();
  row.figures = simulation.world().measure();
  return row;
}

std::string line(const std::string& scene, int workers, const BenchRow& row) {
  char text[512];
  std::snprintf(text, sizeof(text), "%s,hooke,%d,%.4f,%.4f,%.4f,%u,%.3g,%.3g,%.6g,%s\n", scene.c_str(),
                workers, row.ms.min, row.ms.median, row.ms.p99, row.contacts, row.figures.mean_stretch,
                row.figures.largest_penetration, row.figures.energy.kinetic, hash_text(row.hash).c_str());
  return text;
}

void describe(CLI::App& app, BenchOptions& options) {
  app.add_option("SCENE", options.scenes,
                 "Scene files; with --peers rigid ones by default; ofg for opposing face geometry");
  app.add_option("--workers", options.workers, "Numbers of threads to try")
      ->delimiter(',')
      ->check(CLI::Range(1, 64));
  app.add_option("--steps", options.steps, "Steps of each run; 300 by default, with --peers the scene's")
      ->check(CLI::Range(10, 1000000));
  app.add_option("--substeps", options.substeps, "Of Hooke; the scene's by default")
      ->check(CLI::Range(1, 64));
  app.add_option("--csv", options.csv, "Where the rows go; printed by default");
  app.add_flag("--peers", options.peers, "Also by Bullet and ODE, with one thread each; bodies only");
  app.footer(
      "Examples:\n  hooke bench scenes/flag.json scenes/rope.json --workers 1,2 --csv bench.csv\n  hooke "
      "bench ofg");
}

struct BenchTable {
  std::string csv =
      "scene,engine,workers,ms_step_min,ms_step_median,ms_step_p99,contacts,mean_stretch,max_penetration,"
      "kinetic_energy,state_hash\n";
  bool same_hashes = true;  ///< Whether no scene's hash depends on the number of workers.
};

/// Runs one scene; returns nothing if it cannot be read or built, which has then been reported.
std::optional<BenchRow> time_scene(const std::string& path, int workers, const BenchOptions& options) {
  std::optional<Scene> scene = read_scene(path);
  if (!scene) return std::nullopt;
  scene->world.workers = workers;
  scene->world.substeps = options.substeps.value_or(scene->world.substeps);
  std::optional<Simulation> simulation = build_simulation(std::move(*scene));
  if (!simulation) return std::nullopt;
  return measure(*simulation, options.steps.value_or(kSteps));
}

/// Times every scene with every number of workers; returns nothing if one cannot be read or built.
std::optional<BenchTable> time_scenes(const BenchOptions& options) {
  BenchTable table;
  Progress progress("timing", options.scenes.size() * options.workers.size());
  std::uint64_t done = 0;
  for (const std::string& path : options.scenes) {
    std::optional<std::uint64_t> hash;
    for (const int workers : options.workers) {
      const std::optional<BenchRow> row = time_scene(path, workers, options);
      if (!row) return std::nullopt;
      table.same_hashes = table.same_hashes && (!hash || *hash == row->hash);
      hash = row->hash;
      table.csv += line(path, workers, *row);
      progress.show(++done);
    }
  }
  return table;
}

}  // namespace

int command_bench(Arguments arguments) {
  CLI::App app("Times scenes. A hash that depends on the number of workers fails.", "hooke bench");
  BenchOptions options;
  describe(app, options);
  if (const auto code = parse(app, arguments)) return *code;
  if (options.scenes == std::vector<std::string>{"ofg"}) return bench_ofg(options.csv);
  if (options.peers) {
    return bench_peers({.scenes = options.scenes,
                        .workers = options.workers,
                        .steps = options.steps,
                        .substeps = options.substeps,
                        .csv = options.csv});
  }
  if (options.scenes.empty()) {
    std::fputs("hooke bench: name a scene, or say --peers\n", stderr);
    return kBadInput;
  }

  const std::optional<BenchTable> table = time_scenes(options);
  if (!table) return kBadInput;
  const auto written = write_file(options.csv.empty() ? "-" : options.csv, table->csv);
  if (!written) return report(written.error());
  if (!table->same_hashes) {
    std::fputs("hooke bench: the state hash depends on the number of workers\n", stderr);
  }
  return table->same_hashes ? kGood : kFailed;
}

}  // namespace hooke::app
