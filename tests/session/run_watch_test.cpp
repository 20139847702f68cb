#include "hooke/run_watch.h"

#include "simulation_of.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <string>
#include <vector>

namespace hooke::app {

namespace {

/// Two boxes that begin half in each other, and a ball far away.
const char* const kScene = R"({
  "version": 1, "seconds": 60, "world": {"gravity": [0, 0, 0]},
  "bodies": [
    {"name": "left", "kind": "dynamic", "shape": {"box": {"half_extents": [0.2, 0.2, 0.2]}}, "position": [0, 0, 0]},
    {"name": "right", "kind": "dynamic", "shape": {"box": {"half_extents": [0.2, 0.2, 0.2]}},
     "position": [0.2, 0, 0]},
    {"name": "lamp", "kind": "dynamic", "shape": {"sphere": {"radius": 0.1}}, "position": [5, 0, 0]}]
})";

Simulation make_simulation() {
  return simulation_of(kScene);
}

bool tells(const RunWatch& watch, const std::string& text) {
  const std::vector<RunWarning> warnings = watch.warnings();
  return std::any_of(warnings.begin(), warnings.end(), [&](const RunWarning& warning) {
    return warning.line().find(text) != std::string::npos;
  });
}

}  // namespace

TEST_SUITE("session/run_watch") {
  TEST_CASE("after a way back in time, contacts are looked at again") {
    Simulation simulation = make_simulation();
    const SimulationSnapshot start = simulation.snapshot();
    RunWatch watch(simulation);
    for (int i = 0; i < 300; ++i) (void)simulation.step();
    watch.look(simulation, simulation.step());
    REQUIRE_FALSE(tells(watch, "was pressed"));
    REQUIRE(simulation.restore(start));
    watch.look(simulation, simulation.step());
    CHECK(tells(watch, "was pressed"));
  }

  TEST_CASE("an object that comes under the name of one that went is looked at as a new one") {
    Simulation simulation = make_simulation();
    RunWatch watch(simulation);
    REQUIRE(simulation.remove("lamp"));
    SceneBody lamp;
    lamp.tag.name = "lamp";
    lamp.desc.kind = BodyKind::kDynamic;
    lamp.desc.shape = Shape::sphere(Real(0.1));
    lamp.desc.position = {0.45, 0, 0};
    REQUIRE(simulation.add({.bodies = {lamp}}).empty());
    watch.look(simulation, simulation.step());
    CHECK(tells(watch, "'lamp' was pressed"));
  }
}

}  // namespace hooke::app
