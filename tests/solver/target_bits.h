#pragma once

#include "solver/soft/particle_kernels.h"

#include <cstring>
#include <doctest/doctest.h>
#include <string>
#include <vector>

namespace hooke::solver {

/// Moves copies of a net of particles with every instruction set of this machine, `step(net)` three times,
/// and checks that their velocities are finite and have the bits of the scalar twins.
template <class Net, class Step>
void check_bits_of_targets(const Net& start, Step step) {
  std::vector<state::VelocityRecord> scalar;
  for (const std::string& target : wide::targets()) {
    REQUIRE(wide::use_target(target));
    Net net = start;
    for (int i = 0; i < 3; ++i) step(net);
    for (const auto& record : net.particles.velocity) CHECK(is_finite(record.v));
    if (scalar.empty()) scalar = net.particles.velocity;
    const std::size_t bytes = scalar.size() * sizeof(scalar[0]);
    CHECK_MESSAGE(std::memcmp(scalar.data(), net.particles.velocity.data(), bytes) == 0, target);
  }
  wide::use_target("");
}

}  // namespace hooke::solver
