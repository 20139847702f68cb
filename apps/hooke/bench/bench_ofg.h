#pragma once

#include <string>

namespace hooke::app {

/// Opposing face geometry against brute force, over k and mesh size (bench/ofg, in a process of its own): a
/// table on standard output, or CSV in the file. An ExitCode; kMachine, and a line that says how to get it,
/// where that program was not built.
int bench_ofg(const std::string& csv);

}  // namespace hooke::app
