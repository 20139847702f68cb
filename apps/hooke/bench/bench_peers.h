#pragma once

#include <optional>
#include <string>
#include <vector>

namespace hooke::app {

struct PeerBench {
  std::vector<std::string> scenes = {};  ///< None for those of rigid bodies that come with Hooke.
  std::vector<int> workers = {1};        ///< Of Hooke.
  std::optional<int> steps = {};         ///< The scene's by default.
  std::optional<int> substeps = {};      ///< Of Hooke; the scene's by default.
  std::string csv = {};                  ///< Empty for none.
};

/// Runs each scene by Hooke, Bullet and ODE, each in a process of its own (bench/peers), prints a table with
/// the time over Hooke's, and writes the rows as CSV. An engine that cannot express a scene is left out. An
/// ExitCode; kMachine, and a line that says how to get it, where the program with the peers was not built.
int bench_peers(const PeerBench& options);

}  // namespace hooke::app
