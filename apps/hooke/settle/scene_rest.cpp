#include "hooke/settle/scene_rest.h"

#include "hooke/command_line.h"
#include "hooke/load/movers.h"
#include "hooke/load/rest.h"
#include "hooke/output_file.h"
#include "hooke/text_of.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

namespace hooke::app {

namespace {

using SceneJson = nlohmann::ordered_json;

constexpr std::size_t kMostNamed = 5;  ///< Moves in the text for people.

struct SceneRestWords {
  std::string scene;
  std::optional<double> seconds, residual, drift, force;
  std::string json;
  bool hash = false;
  SceneOverrides overrides;
};

void add_words(CLI::App& app, SceneRestWords& words) {
  app.add_option("SCENE", words.scene, "Scene file; what its timeline does is left out")->required();
  add_number(app, "--residual", words.residual, 1e-9, 1,
             "Sum of unbalanced forces that counts as rest, over the weight; 1e-5 by default");
  add_number(app, "--drift", words.drift, 0, 1e3,
             "What moves less in a second is at rest, too [m]; 1e-6 by default");
  add_number(app, "--force", words.force, 1e-12, 1e12,
             "Force that unbalanced ones are compared with [N]; the weight by default");
  add_number(app, "--seconds", words.seconds, 1e-3, 1e5, "Time for it [s]; 60 by default");
  app.add_option("--json", words.json, "Write where everything rests as JSON; - prints it");
  app.add_flag("--hash", words.hash, "Print only the hash of the rest");
  add_overrides(app, words.overrides);
  app.footer(
      "Steps without sleep and damping of bodies, and takes all speed away when the kinetic energy has\n"
      "passed a peak. Exit code 1 if there is no rest. hooke run --settle starts from there.\n\n"
      "Examples:\n"
      "  hooke settle scenes/mobile.json\n"
      "  hooke settle scenes/truss_bridge.json --json rest.json");
}

std::string name_of_unrest(const Simulation& simulation, const Unrest& unrest) {
  for (const SceneObject& object : simulation.objects()) {
    const PointRef point = point_of(object, unrest.point.index);
    const bool is_it = unrest.body ? object.body == unrest.body
                                   : point.kind != PointRef::Kind::kNone && point == unrest.point;
    if (is_it) return object.name + (unrest.body ? "" : text_of(":%u", unrest.point.index));
  }
  return {};
}

SceneJson json_of_point(DVec3 v) {
  return {v.x, v.y, v.z};
}

const char* end_word(SettleEnd end) {
  static constexpr const char* kWords[] = {"balanced", "still", "broke", "out of time", "diverged"};
  return kWords[static_cast<std::size_t>(end)];
}

std::string scene_rest_json(const Simulation& simulation, const SceneRestWords& words,
                            const SettleReport& found, const Movers& movers) {
  const World& world = simulation.world();
  SceneJson report = {{"scene", words.scene},       {"converged", found.converged()},
                      {"end", end_word(found.end)}, {"residual", found.residual},
                      {"sum", found.sum},           {"steps", found.steps}};
  if (!found.converged()) report["fastest"] = name_of_unrest(simulation, found.unrest);
  SceneJson& list = report["objects"] = SceneJson::array();
  for (const Mover& mover : movers.all()) {
    SceneJson one = {{"name", mover.name}};
    if (mover.body) {
      const Pose pose = world.pose(mover.body);
      const Quat q = pose.rotation;
      one["position"] = json_of_point(pose.position);
      one["rotation"] = {q.x, q.y, q.z, q.w};
    } else {
      SceneJson& points = one["points"] = SceneJson::array();
      const PointView places = positions_of(world, mover.object);
      for (std::size_t i = 0; i < places.size(); ++i) points.push_back(json_of_point(places[i]));
    }
    list.push_back(std::move(one));
  }
  return report.dump(2, ' ', false, SceneJson::error_handler_t::replace) + "\n";
}

void print_moves(const std::vector<Move>& moves) {
  for (std::size_t i = 0; i < std::min(moves.size(), kMostNamed); ++i) {
    const double way = length(moves[i].way);
    if (!(way > 1e-9)) break;
    std::printf("  '%s' moved by (%.6g, %.6g, %.6g) m\n", moves[i].name.c_str(), moves[i].way.x,
                moves[i].way.y, moves[i].way.z);
  }
}

}  // namespace

std::string settle_text(const Simulation& simulation, const SettleReport& found) {
  const std::string balance = text_of("the largest unbalanced force is %.3g of the weight, all sum to %.3g",
                                      found.residual, found.sum);
  const std::string fastest = name_of_unrest(simulation, found.unrest);
  const auto steps = static_cast<unsigned long long>(found.steps);
  switch (found.end) {
    case SettleEnd::kBalanced:
      return text_of("at rest after %llu steps: ", steps) + balance;
    case SettleEnd::kStill:
      return text_of("still after %llu steps, though it jitters: ", steps) + balance + ", most on '" +
             fastest + "'";
    case SettleEnd::kBroke: {
      const std::vector<LoadBreak> breaks = breaks_of(simulation);
      const std::string what =
          breaks.empty() ? "something" : "'" + breaks[0].object + "' (" + breaks[0].what + ")";
      return "no rest: " + what +
             text_of(" broke after %llu steps; it needs more strength, or support", steps);
    }
    case SettleEnd::kDiverged:
      return text_of("no rest: what moves is no longer finite after %llu steps; more --substeps may help",
                     steps);
    case SettleEnd::kOutOfTime:
      break;
  }
  return text_of("no rest in %llu steps: ", steps) + balance + ", and '" + fastest +
         text_of("' moves at %.3g m/s; hold it, or give more --seconds", found.unrest.speed);
}

int settle_scene(Arguments arguments) {
  CLI::App app("Brings a scene to rest under the forces that act, and tells where everything is then.",
               "hooke settle");
  SceneRestWords words;
  add_words(app, words);
  if (const auto code = parse(app, arguments)) return *code;
  std::optional<Scene> scene = read_scene(words.scene);
  if (!scene) return kBadInput;
  apply(words.overrides, scene->world);
  if (!scene->timeline.empty()) {
    warn({ErrorCode::kOutOfRange, words.scene, "its timeline is left out: rest has no time"});
    scene->timeline.clear();
  }
  scene->expect.clear();
  std::optional<Simulation> simulation = build_simulation(std::move(*scene));
  if (!simulation) return kBadInput;
  Movers movers(*simulation);
  SettleDesc desc = {.dt = simulation->scene().dt};
  desc.residual = words.residual.value_or(desc.residual);
  desc.drift = words.drift.value_or(desc.drift);
  desc.force = words.force.value_or(desc.force);
  desc.seconds = words.seconds.value_or(desc.seconds);
  const auto settled = simulation->world().settle(desc);
  if (!settled) return report(settled.error());
  const SettleReport& found = settled.value();
  if (words.hash) {
    std::printf("%016llx\n", static_cast<unsigned long long>(simulation->world().state_hash()));
  } else if (!is_standard_output(words.json)) {
    std::printf("%s: %s\n", words.scene.c_str(), settle_text(*simulation, found).c_str());
    print_moves(movers.moves(simulation->world()));
  }
  if (!words.json.empty()) {
    const auto written = write_file(words.json, scene_rest_json(*simulation, words, found, movers));
    if (!written) return report(written.error());
  }
  return found.converged() ? kGood : kFailed;
}

}  // namespace hooke::app
