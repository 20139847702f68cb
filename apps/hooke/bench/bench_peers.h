#pragma once

#include <optional>
#include <string>
#include <vector>

namespace hooke::app {

struct PeerBench {
  /// Empty stands for the scenes of rigid bodies that come with Hooke.
  std::vector<std::string> scenes = {};
  std::vector<int> workers = {1};    ///< Workers of Hooke.
  std::optional<int> steps = {};     ///< The scene's number by default.
  std::optional<int> substeps = {};  ///< Substeps of Hooke; the scene's number by default.
  std::string csv = {};              ///< Empty for no file.
};

/// Runs each scene by Hooke, Bullet and ODE, each in a process of its own (bench/peers). It prints a table
/// with the times relative to Hooke's, and writes the rows as CSV. An engine that cannot express a scene is
/// left out. Returns an ExitCode; kMachine, with a line on how to get it, where the program with the peers
/// was not built.
int bench_peers(const PeerBench& options);

}  // namespace hooke::app
