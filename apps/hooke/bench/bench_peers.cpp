#include "hooke/bench/bench_peers.h"

#include "hooke/command_line.h"
#include "hooke/output_file.h"
#include "hooke/text_of.h"

#include "process/child.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <sys/wait.h>
#include <unistd.h>

namespace hooke::app {

namespace {

constexpr const char* kColumns =
    "scene,engine,workers,ms_step_min,ms_step_median,ms_step_p99,contacts,max_penetration,kinetic_energy,"
    "state_hash\n";

/// This is one line of CSV, split into values.
struct PeerRow {
  std::string line;
  std::vector<std::string> fields;

  [[nodiscard]] double number(std::size_t i) const { return std::strtod(fields[i].c_str(), nullptr); }
};

std::string read_all(int descriptor) {
  std::string text;
  std::array<char, 4096> buffer;
  for (ssize_t count = 0; (count = ::read(descriptor, buffer.data(), buffer.size())) > 0;)
    text.append(buffer.data(), static_cast<std::size_t>(count));
  return text;
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream in(line);
  for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
  return fields;
}

std::vector<std::string> words_of(const std::string& program, const PeerBench& options, const PeerRow& key) {
  std::vector<std::string> words = {program,       key.fields[0], "--engine",
                                    key.fields[1], "--workers",   key.fields[2]};
  const auto add = [&](const char* name, std::optional<int> value) {
    if (value) words.insert(words.end(), {name, std::to_string(*value)});
  };
  add("--steps", options.steps);
  add("--substeps", options.substeps);
  return words;
}

/// Runs a program and returns what it wrote to standard output; `status` gets its status. Standard error is
/// that of this program.
Result<std::string> run_program(std::vector<std::string> words, int& status) {
  auto pipe = process::make_pipe();
  if (!pipe) return Error{ErrorCode::kUnsupported, words[0], "no pipe"};
  auto child =
      process::Child::start(std::move(words), {.output = pipe->write.number(), .error = STDERR_FILENO});
  if (!child) return child.error();
  pipe->write.close();
  std::string text = read_all(pipe->read.number());
  status = child.value().wait();
  return text;
}

std::string heading() {
  return text_of("%-28s %-7s %7s %9s %9s %7s %9s %9s %11s %11s\n", "scene", "engine", "workers", "ms min",
                 "ms median", "times", "ms 99 %", "contacts", "overlap mm", "kinetic J");
}

/// `reference` is the row of Hooke with which median times are compared.
std::string table_line(const PeerRow& row, const PeerRow& reference) {
  return text_of("%-28s %-7s %7s %9.3f %9.3f %7.2f %9.3f %9s %11.3f %11.4g\n", row.fields[0].c_str(),
                 row.fields[1].c_str(), row.fields[2].c_str(), row.number(3), row.number(4),
                 row.number(4) / reference.number(4), row.number(5), row.fields[6].c_str(),
                 1000 * row.number(7), row.number(8));
}

std::vector<std::string> rigid_scenes() {
  return {"scenes/large_pyramid.json", "scenes/many_pyramids.json", "scenes/pyramid_30.json",
          "scenes/joint_grid.json",    "scenes/pile.json",          "scenes/spheres.json",
          "scenes/hulls_on_mesh.json", "scenes/convex_pile.json",   "scenes/junkyard.json",
          "scenes/washer.json"};
}

/// Returns the runs of one scene: Hooke with each number of workers, its peers with one.
std::vector<PeerRow> runs_of(const std::string& scene, const std::vector<int>& workers) {
  constexpr std::array<const char*, 2> kPeers = {"bullet", "ode"};
  std::vector<PeerRow> runs;
  runs.reserve(workers.size() + kPeers.size());
  for (const int count : workers) runs.push_back({{}, {scene, "hooke", std::to_string(count)}});
  for (const char* peer : kPeers) runs.push_back({{}, {scene, peer, "1"}});
  return runs;
}

}  // namespace

int bench_peers(const PeerBench& options) {
  const std::string program = process::find_beside("hooke-peers");
  if (program.empty()) {
    std::fputs(
        "hooke bench: --peers needs hooke-peers beside hooke: ./dev setup bench, then build with "
        "-DHOOKE_BENCH=ON\n",
        stderr);
    return kMachine;
  }
  std::string csv = kColumns;
  bool same = true;
  std::fputs(heading().c_str(), stdout);
  for (const std::string& scene : options.scenes.empty() ? rigid_scenes() : options.scenes) {
    std::optional<PeerRow> reference;
    for (const PeerRow& key : runs_of(scene, options.workers)) {
      std::fprintf(stderr, "%s by %s ...\n", scene.c_str(), key.fields[1].c_str());
      int status = 0;
      const Result<std::string> line = run_program(words_of(program, options, key), status);
      if (!line) return report(line.error());
      // The program has printed the reason itself.
      if (WIFEXITED(status) && WEXITSTATUS(status) == kMachine) continue;
      const PeerRow row = {line.value(), split(line.value())};
      if (!WIFEXITED(status)) return report({ErrorCode::kUnsupported, scene, key.fields[1] + " crashed"});
      if (status != 0 || row.fields.size() != 10) return kBadInput;
      if (!reference) reference = row;
      same = same && (row.fields[1] != "hooke" || row.fields[9] == reference->fields[9]);
      csv += row.line;
      std::fputs(table_line(row, *reference).c_str(), stdout);
      std::fflush(stdout);
    }
  }
  if (!options.csv.empty()) {
    const auto written = write_file(options.csv, csv);
    if (!written) return report(written.error());
  }
  if (!same) std::fputs("hooke bench: the state hash depends on the number of workers\n", stderr);
  return same ? kGood : kFailed;
}

}  // namespace hooke::app
