#include "hooke/command_line.h"
#include "hooke/load/load_picture.h"
#include "hooke/load/load_report.h"
#include "hooke/load/movers.h"
#include "hooke/load/push.h"
#include "hooke/load/raise.h"
#include "hooke/output_file.h"
#include "hooke/text_of.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <utility>

namespace hooke::app {

namespace {

struct LoadWords {
  std::string scene;
  std::vector<std::string> on;
  std::vector<double> at, direction;
  std::string until = "collapse";
  std::optional<double> nominal, first, tolerance, way, patience;
  std::string csv, json, plot, picture;
  SceneOverrides overrides;
};

/// Share of the extent by which a loaded place moves in one step of the load until that counts as collapse.
constexpr double kUsualWay = 0.02;
/// Without another end the load goes up to so many times the weight of all that moves.
constexpr double kMostWeights = 1e4;
constexpr double kUsualFirst = 0.01;  ///< First step of the load, as a share of the weight.

void describe(CLI::App& app, LoadWords& words) {
  app.add_option("SCENE", words.scene, "Scene file; what its timeline does is left out")->required();
  app.add_option("--on", words.on, "What is loaded: bodies, points as rope:3 or rope:last, or whole objects")
      ->required()
      ->delimiter(',')
      ->option_text("NAME[,NAME]");
  app.add_option("--at", words.at, "Place of the force [m]; the center of mass by default")
      ->delimiter(',')
      ->expected(3)
      ->option_text("X,Y,Z");
  app.add_option("--direction", words.direction, "Direction of the force; that of gravity by default")
      ->delimiter(',')
      ->expected(3)
      ->option_text("X,Y,Z");
  app.add_option("--until", words.until, "collapse, break, yield, or the largest load [N]")
      ->capture_default_str()
      ->option_text("WHAT");
  add_number(app, "--nominal", words.nominal, 1e-9, 1e12,
             "Load that it is made for [N]: the reserve factor is told, and below 1 the exit code is 1");
  add_number(app, "--first", words.first, 1e-9, 1e12,
             "First step of the load [N]; a hundredth of the weight by default");
  add_number(app, "--tolerance", words.tolerance, 1e-5, 0.5,
             "Width of the interval to which a breaking load is narrowed; 0.001 by default");
  add_number(app, "--way", words.way, 1e-9, 1e9,
             "A loaded place that moves farther in one step of the load has collapsed [m]; 0.02 of the "
             "extent by default");
  add_number(app, "--patience", words.patience, 0.1, 1e5,
             "What finds no rest in this time has collapsed [s]; 30 by default");
  app.add_option("--csv", words.csv, "Write a line for each equilibrium; - prints it");
  app.add_option("--json", words.json, "Write all as JSON; - prints it");
  app.add_option("--plot", words.plot, "Draw the members' forces over the load: .png or .svg");
  app.add_option("--picture", words.picture,
                 "Draw the last equilibrium before a break, members colored by how much they are used: .png");
  add_overrides(app, words.overrides);
  app.footer(
      "Brings the scene to rest, raises the force in steps that wait for rest, and goes back where "
      "something\n"
      "breaks, until the breaking load is known. Exit code 1 for a mechanism, or below the nominal load.\n\n"
      "Examples:\n"
      "  hooke load scenes/crane.json --on load --until 20000\n"
      "  hooke load scenes/truss_bridge.json --on load --nominal 10000 --csv forces.csv");
}

DVec3 vector_of(const std::vector<double>& words) {
  return {words[0], words[1], words[2]};
}

/// Returns the scene as it is loaded: nothing sleeps, and nothing happens at a time. Bodies are not damped:
/// within a substep of h seconds a damping of c takes c h of the weight of a body at rest.
Scene still_scene(Scene scene, const LoadWords& words) {
  apply(words.overrides, scene.world);
  scene.world.sleeping = false;
  if (!scene.timeline.empty()) {
    warn({ErrorCode::kOutOfRange, words.scene, "its timeline is left out: a load has no time"});
    scene.timeline.clear();
  }
  scene.expect.clear();
  for (SceneBody& body : scene.objects.bodies) {
    body.desc.linear_damping = Real(0);
    body.desc.angular_damping = Real(0);
  }
  return scene;
}

/// Fills in what the words leave open. The Error says which of them is wrong.
Result<RaiseOptions> raise_options(const LoadWords& words, double weight, double extent) {
  RaiseOptions options;
  options.tolerance = words.tolerance.value_or(options.tolerance);
  options.patience = words.patience.value_or(options.patience);
  options.way = words.way.value_or(kUsualWay * extent);
  options.until_break = words.until == "break" || words.until == "yield";
  options.until_limit = words.until == "yield";
  options.most = kMostWeights * weight;
  if (words.nominal) options.most = std::max(options.most, 100 * *words.nominal);
  if (words.until != "break" && words.until != "yield" && words.until != "collapse") {
    char* end = nullptr;
    options.most = std::strtod(words.until.c_str(), &end);
    if (*end != '\0' || !(options.most > 0) || !(options.most <= 1e12)) {
      return Error{
          ErrorCode::kOutOfRange, "--until",
          "'" + words.until + "' is neither collapse, nor break, nor yield, nor a force up to 1e12 N"};
    }
  }
  options.first = words.first.value_or(std::min(kUsualFirst * weight, options.most));
  if (!(options.first > 0)) {
    return Error{ErrorCode::kOutOfRange, "--first", "is needed where nothing has weight: the first load [N]"};
  }
  if (!(options.most > 0)) options.most = 1e6 * options.first;
  return options;
}

Result<void> write_all(const Raised& raised, const LoadTitle& title, const LoadWords& words) {
  if (!words.csv.empty()) {
    if (auto written = write_file(words.csv, load_csv(raised)); !written) return written;
  }
  if (!words.json.empty()) {
    if (auto written = write_file(words.json, load_json(raised, title)); !written) return written;
  }
  if (words.plot.empty() || raised.equilibria.empty()) return {};
  const auto drawn = load_plot(raised, title, words.plot);
  if (!drawn) return drawn.error();
  return write_file(words.plot, drawn.value());
}

/// Tells whether a scene has anything that breaks: hooks, seams, ropes or cloths with a limit.
bool can_break(const SceneObjects& objects) {
  const auto any = [](const auto& list, const auto& breaks) {
    return std::any_of(list.begin(), list.end(), breaks);
  };
  return any(objects.hooks,
             [](const SceneHook& hook) {
               return std::isfinite(hook.desc.break_force) || std::isfinite(hook.desc.break_torque);
             }) ||
         any(objects.seams, [](const SceneSeam& seam) { return std::isfinite(seam.strength); }) ||
         any(objects.ropes, [](const SceneRope& rope) { return rope.desc.strength.has_value(); }) ||
         any(objects.cloths, [](const SceneCloth& cloth) {
           return cloth.desc.strength.has_value() || cloth.desc.tear_strain.has_value();
         });
}

/// Tells whether a scene has a bar that may yield or buckle.
bool has_section(const SceneObjects& objects) {
  const auto any = [](const auto& list) {
    return std::any_of(list.begin(), list.end(), [](const auto& one) { return one.section.has_value(); });
  };
  return any(objects.bodies) || any(objects.hooks);
}

/// Warns of sections that nothing is evaluated by, because their object is no bar.
void warn_of_sections(const Scene& scene, const Raised& raised, const std::string& path) {
  std::set<std::string> evaluated;
  for (const Member& member : raised.members) {
    if (member.yield_force > 0 || member.buckling_force > 0) evaluated.insert(member.name);
  }
  const auto look = [&](const std::string& name, bool has) {
    const bool is_evaluated = std::any_of(evaluated.begin(), evaluated.end(), [&](const std::string& one) {
      return one == name || one.starts_with(name + "[");
    });
    if (!has || name.empty() || is_evaluated) return;
    warn({ErrorCode::kOutOfRange, path,
          "the section of '" + name +
              "' has no effect: it needs a yield_stress, or a young_modulus and a second moment, and its "
              "object must be "
              "a distance hook or a body that hooks hold at exactly two places"});
  };
  for (const SceneBody& body : scene.objects.bodies) look(body.tag.name, body.section.has_value());
  for (const SceneHook& hook : scene.objects.hooks) look(hook.name, hook.section.has_value());
}

ExitCode run_load(Simulation& simulation, const LoadWords& words) {
  Movers movers(simulation);
  const DVec3 gravity = vector_cast<double>(simulation.world().desc().gravity);
  const DVec3 down = length(gravity) > 0 ? gravity : DVec3{0, -1, 0};
  const DVec3 direction = words.direction.empty() ? down : vector_of(words.direction);
  std::optional<DVec3> at;
  if (!words.at.empty()) at = vector_of(words.at);
  const auto push = Push::create(simulation, movers, words.on, at, direction);
  if (!push) return report(push.error());
  const auto options = raise_options(words, movers.mass() * length(gravity), movers.extent(simulation));
  if (!options) return report(options.error());
  const auto raised = raise_load(simulation, movers, push.value(), options.value());
  if (!raised) return report(raised.error());
  warn_of_sections(simulation.scene(), raised.value(), words.scene);
  LoadTitle title = {.scene = words.scene,
                     .direction = push.value().direction(),
                     .nominal = words.nominal,
                     .most = options.value().most,
                     .tolerance = options.value().tolerance};
  for (const std::string& word : words.on) title.on += (title.on.empty() ? "'" : ", '") + word + "'";
  const bool taken = is_standard_output(words.csv) || is_standard_output(words.json);
  if (!taken) std::fputs(load_summary(raised.value(), title).c_str(), stdout);
  if (const auto written = write_all(raised.value(), title, words); !written) return report(written.error());
  if (!words.picture.empty() && !raised.value().equilibria.empty()) {
    const auto drawn = draw_load(simulation, raised.value(), words.picture);
    if (!drawn) return report(drawn.error());
  }
  const auto reserve = reserve_of(raised.value(), title);
  return raised.value().equilibria.empty() || (reserve && *reserve < 1) ? kFailed : kGood;
}

}  // namespace

int command_load(Arguments arguments) {
  CLI::App app("Raises a load on a scene until it breaks or collapses, and tells every member's force.",
               "hooke load");
  LoadWords words;
  describe(app, words);
  if (const auto code = parse(app, arguments)) return *code;
  if (is_standard_output(words.csv) && is_standard_output(words.json)) {
    return report(
        {ErrorCode::kOutOfRange, "hooke load", "--csv and --json cannot both go to the standard output"});
  }
  if (!words.plot.empty() && !words.plot.ends_with(".png") && !words.plot.ends_with(".svg")) {
    return report(
        {ErrorCode::kOutOfRange, "--plot", "'" + words.plot + "' ends neither in .png nor in .svg"});
  }
  if (!words.picture.empty() && !words.picture.ends_with(".png")) {
    return report({ErrorCode::kOutOfRange, "--picture", "'" + words.picture + "' does not end in .png"});
  }
  std::optional<Scene> scene = read_scene(words.scene);
  if (!scene) return kBadInput;
  if (words.until == "break" && !can_break(scene->objects)) {
    return report(
        {ErrorCode::kOutOfRange, "--until break",
         "nothing in the scene can break: hooks need a break_force or break_torque, ropes and cloths "
         "a strength"});
  }
  if (words.until == "yield" && !has_section(scene->objects)) {
    return report(
        {ErrorCode::kOutOfRange, "--until yield",
         "no body and no distance hook of the scene has a section with what it yields or buckles at"});
  }
  std::optional<Simulation> simulation = build_simulation(still_scene(std::move(*scene), words));
  if (!simulation) return kBadInput;
  return run_load(*simulation, words);
}

}  // namespace hooke::app
