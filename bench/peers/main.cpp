/// hooke-peers SCENE --engine hooke|bullet|ode runs a scene of rigid bodies by one engine and prints one line
/// of CSV. `hooke bench --peers` starts it, once for each engine and number of workers, because the product
/// itself links no other engine. The columns are
///
///   scene,engine,workers,ms_step_min,ms_step_median,ms_step_p99,contacts,max_penetration,kinetic_energy,
///   state_hash
///
/// The first step is not timed. Penetration and kinetic energy are those of the last step, computed by the
/// same code for all.

#include "base/hash.h"
#include "peer_engine.h"
#include "peer_scene.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>

namespace {

using namespace hooke;
using namespace hooke::bench;

constexpr int kBadInput = 2;
constexpr int kUnable = 3;

struct Options {
  std::string scene;
  std::string engine = "hooke";
  int workers = 1;
  std::optional<int> substeps;
  std::optional<int> steps;
};

struct Outcome {
  std::vector<double> ms = {};
  std::uint32_t contacts = 0;
  std::vector<PeerMotion> motions = {};
  std::uint64_t hash = 0;
};

int complain(const Error& error, int code) {
  std::fprintf(stderr, "hooke-peers: %s: %s\n", error.where.c_str(), error.message.c_str());
  return code;
}

/// Returns the milliseconds of each step but the first. `prepare` is not timed.
std::vector<double> time_steps(int steps, const std::function<void()>& prepare,
                               const std::function<void()>& step) {
  std::vector<double> ms;
  for (int i = 0; i < steps; ++i) {
    prepare();
    const auto start = std::chrono::steady_clock::now();
    step();
    const auto elapsed = std::chrono::steady_clock::now() - start;
    if (i > 0) ms.push_back(std::chrono::duration<double, std::milli>(elapsed).count());
  }
  std::sort(ms.begin(), ms.end());
  return ms;
}

/// Returns body `i` of Hooke's world, as its peers describe it.
PeerMotion motion_of(const Simulation& simulation, const PeerScene& scene, std::size_t i) {
  const BodyId id = simulation.objects()[i].body;
  const Pose pose = simulation.world().pose(id);
  const DQuat turn = normalize(DQuat{pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w});
  const PeerPose& own = scene.bodies[i].own;
  return {.pose = {pose.position + rotate(turn, own.position), turn * own.rotation},
          .velocity = vector_cast<double>(simulation.world().velocity(id)),
          .angular_velocity = vector_cast<double>(simulation.world().angular_velocity(id))};
}

Outcome run_hooke(Simulation& simulation, const PeerScene& scene, int steps) {
  Outcome outcome;
  outcome.ms = time_steps(
      steps, [] {}, [&] { outcome.contacts = simulation.step().contacts; });
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    outcome.motions.push_back(motion_of(simulation, scene, i));
  outcome.hash = simulation.world().state_hash();
  return outcome;
}

/// Runs a peer. Kinematic bodies move as in `simulation`, a world of Hooke that holds only these.
Outcome run_peer(PeerEngine& engine, Simulation& simulation, const PeerScene& scene, int steps) {
  std::vector<std::size_t> driven;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].kind == BodyKind::kKinematic) driven.push_back(i);
    if (scene.bodies[i].kind == BodyKind::kDynamic) simulation.world().remove(simulation.objects()[i].body);
  }
  const auto drive = [&] {
    std::vector<PeerMotion> from;
    for (const std::size_t i : driven) from.push_back(motion_of(simulation, scene, i));
    if (!driven.empty()) simulation.step();
    for (std::size_t k = 0; k < driven.size(); ++k)
      engine.drive(driven[k], from[k], motion_of(simulation, scene, driven[k]));
  };
  Outcome outcome;
  outcome.ms = time_steps(steps, drive, [&] { engine.step(scene.dt); });
  outcome.contacts = engine.contacts();
  base::StateHash hash;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    outcome.motions.push_back(engine.motion(i));
    hash.add(outcome.motions.back());
  }
  outcome.hash = hash.value();
  return outcome;
}

Result<std::unique_ptr<PeerEngine>> make_engine(const std::string& name, const PeerScene& scene) {
  return name == "bullet" ? make_bullet(scene) : make_ode(scene);
}

int run(const Options& options) {
  Loaded<Scene> loaded = load_scene(options.scene);
  if (!loaded) return complain(loaded.errors.front(), kBadInput);
  Scene scene = std::move(*loaded.value);
  scene.world.workers = options.workers;
  scene.world.substeps = options.substeps.value_or(scene.world.substeps);
  const int steps = std::max(options.steps.value_or(static_cast<int>(scene.step_count())), 2);
  Loaded<Simulation> made = Simulation::create(scene);
  if (!made) return complain(made.errors.front(), kBadInput);
  Simulation& simulation = *made.value;
  const Result<PeerScene> peer = make_peer_scene(scene, simulation);
  if (!peer) return complain(peer.error(), kUnable);
  Outcome outcome;
  if (options.engine == "hooke") {
    outcome = run_hooke(simulation, peer.value(), steps);
  } else {
    const Result<std::unique_ptr<PeerEngine>> engine = make_engine(options.engine, peer.value());
    if (!engine) return complain(engine.error(), kUnable);
    outcome = run_peer(*engine.value(), simulation, peer.value(), steps);
  }
  const Result<double> overlap = deepest_overlap(scene, peer.value(), outcome.motions);
  if (!overlap) return complain(overlap.error(), kUnable);
  const auto ms = [&](double part) {
    return outcome.ms[static_cast<std::size_t>(part * static_cast<double>(outcome.ms.size() - 1))];
  };
  std::printf("%s,%s,%d,%.4f,%.4f,%.4f,%u,%.3g,%.6g,%016llx\n", options.scene.c_str(), options.engine.c_str(),
              options.workers, ms(0), ms(0.5), ms(0.99), outcome.contacts, overlap.value(),
              kinetic_energy(peer.value(), outcome.motions), static_cast<unsigned long long>(outcome.hash));
  return 0;
}

}  // namespace

int main(int count, char** words) {
  CLI::App app("Times a scene of rigid bodies by Hooke or by another engine.", "hooke-peers");
  Options options;
  app.add_option("SCENE", options.scene, "Scene file")->required();
  app.add_option("--engine", options.engine)->check(CLI::IsMember({"hooke", "bullet", "ode"}));
  app.add_option("--workers", options.workers, "Threads of Hooke; its peers have one")
      ->check(CLI::Range(1, 64));
  app.add_option("--substeps", options.substeps, "Of Hooke; the scene's by default")
      ->check(CLI::Range(1, 64));
  app.add_option("--steps", options.steps, "The scene's by default")->check(CLI::Range(2, 1000000));
  CLI11_PARSE(app, count, words);
  return run(options);
}
