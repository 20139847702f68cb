#pragma once

#include "solver/solid/tetrahedron_blocks.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Points of several groups of solids that a contact or a hook joins in a stiff solution.

namespace hooke::solver {

using StiffParts = std::span<TetrahedronBlocks* const>;  ///< Groups that are solved at once.

/// Up to N points with weights. Those of a second side are negative.
template <std::size_t N>
struct WeightedPoints {
  std::array<std::uint32_t, N> part = {};   ///< Of the system, by point.
  std::array<std::uint32_t, N> point = {};  ///< Row of each particle, from its part's first one.
  std::array<double, N> weight = {};
  std::size_t count = 0;

  void add(std::uint32_t of_part, std::uint32_t row, double with_weight) {
    part[count] = of_part;
    point[count] = row;
    weight[count++] = with_weight;
  }

  /// The weighted sum of what a vector of the solution has at the points.
  [[nodiscard]] DVec3 sum(StiffParts parts, std::vector<double> StiffSolution::*of) const {
    DVec3 u;
    for (std::size_t k = 0; k < count; ++k) {
      const double* at = (parts[part[k]]->stiff.*of).data() + 4 * point[k];
      u += weight[k] * DVec3{at[0], at[1], at[2]};
    }
    return u;
  }

  /// Adds an impulse to the points, by their weights, in a vector of the solution.
  void push(StiffParts parts, DVec3 impulse, std::vector<double> StiffSolution::*to) const {
    for (std::size_t k = 0; k < count; ++k) {
      double* at = (parts[part[k]]->stiff.*to).data() + 4 * point[k];
      at[0] += weight[k] * impulse.x;
      at[1] += weight[k] * impulse.y;
      at[2] += weight[k] * impulse.z;
    }
  }

  /// With what mass the points resist, each by itself [kg]: its own, and what `of_stress` makes of how rows
  /// of stress resist its motion.
  template <class OfStress>
  [[nodiscard]] double resisting_mass(const state::Particles& particles, StiffParts parts,
                                      OfStress of_stress) const {
    double mobility = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const TetrahedronBlocks& blocks = *parts[part[k]];
      const auto inverse_mass =
          static_cast<double>(particles.velocity[blocks.first_particle + point[k]].inverse_mass);
      if (!(inverse_mass > 0)) continue;
      mobility +=
          weight[k] * weight[k] / (1 / inverse_mass + of_stress(stress_diagonal(blocks.stiff, point[k])));
    }
    return mobility > 0 ? 1 / mobility : 0;
  }
};

}  // namespace hooke::solver
