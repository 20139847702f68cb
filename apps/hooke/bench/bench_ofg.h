#pragma once

#include <string>

namespace hooke::app {

/// Compares opposing face geometry with brute force, over k and mesh size (bench/ofg, in a process of its
/// own). It writes a table to standard output, or CSV to the file. Returns an ExitCode; kMachine, with a line
/// on how to get it, where that program was not built.
int bench_ofg(const std::string& csv);

}  // namespace hooke::app
