#pragma once

#include "elements/isometric_bend.h"
#include "state/objects.h"
#include "state/particles.h"
#include "state/springs.h"

#include <cstdint>
#include <limits>
#include <vector>

/// \file
/// Makes scene "cloth" as a list of particles and springs, the same for Hooke and its peers: 100 x 100
/// points, spacing 2 cm, 1 kg each, hanging flat, two top corners held; structural and shear springs rigid,
/// bend springs soft.

namespace hooke::bench {

struct ClothList {
  state::Particles particles;
  state::Springs springs;
};

/// One object that owns all rows of the list, and these bends.
inline std::vector<state::Deformable> owner_of_all(const ClothList& list, const state::Bends& bends = {}) {
  const auto all = [](int count) { return state::Rows{0, static_cast<std::uint32_t>(count)}; };
  return {{.particles = {0, static_cast<std::uint32_t>(list.particles.position.size())},
           .springs = all(list.springs.count()),
           .bends = all(bends.count())}};
}

inline ClothList cloth_100(int side = 100) {
  constexpr Real kSpacing = Real(0.02);
  ClothList list;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const bool held = row == 0 && (column == 0 || column == side - 1);
      list.particles.position.push_back(
          {{kSpacing * static_cast<Real>(column), -kSpacing * static_cast<Real>(row), Real(0)}});
      list.particles.velocity.push_back({{}, held ? Real(0) : Real(1)});
    }
  }
  const auto add = [&](int column, int row, int columns, int rows, state::SpringClass kind) {
    if (column + columns < 0 || column + columns >= side || row + rows >= side) return;
    const auto a = static_cast<std::uint32_t>(row * side + column);
    const auto b = static_cast<std::uint32_t>((row + rows) * side + column + columns);
    const bool bend = kind == state::SpringClass::kBend;
    list.springs.particle_a.push_back(a);
    list.springs.particle_b.push_back(b);
    list.springs.rest_length.push_back(length(list.particles.position[a].x - list.particles.position[b].x));
    list.springs.stiffness.push_back(bend ? Real(1e4) : std::numeric_limits<Real>::infinity());
    list.springs.damping.push_back(Real(0));
    list.springs.damped_mass.push_back(std::numeric_limits<Real>::infinity());
    list.springs.kind.push_back(kind);
    list.springs.form.push_back(state::SpringForm::kExplicit);
  };
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      add(column, row, 1, 0, state::SpringClass::kStretch);
      add(column, row, 0, 1, state::SpringClass::kStretch);
      add(column, row, 1, 1, state::SpringClass::kShear);
      add(column, row, -1, 1, state::SpringClass::kShear);
      add(column, row, 2, 0, state::SpringClass::kBend);
      add(column, row, 0, 2, state::SpringClass::kBend);
    }
  }
  return list;
}

/// Makes bends at the inner edges of the same cloth with both diagonals by turns. Its rows are waved by 5 mm
/// so that they fold. Bends are by angle, or isometric.
inline state::Bends wave_cloth(ClothList& list, bool isometric, int side = 100) {
  state::Bends bends;
  const auto point = [side](int column, int row) { return static_cast<std::uint32_t>(row * side + column); };
  const std::vector<state::PositionRecord> flat = list.particles.position;
  for (auto& record : list.particles.position) {
    const auto row = static_cast<int>(&record - list.particles.position.data()) * 7 / 3 % 5;
    record.x.z = Real(0.005) * static_cast<Real>(row);
  }
  const auto add = [&](std::uint32_t edge_a, std::uint32_t edge_b, std::uint32_t wing_a,
                       std::uint32_t wing_b) {
    bends.stencil.push_back({edge_a, edge_b, wing_a, wing_b});
    bends.rest_angle.push_back(Real(0));
    bends.stiffness.push_back(Real(1e-3));
    bends.damping.push_back(Real(1e-5));
    bends.weights.push_back({});
    if (!isometric) return;
    const auto weights =
        elements::isometric_bend(flat[edge_a].x, flat[edge_b].x, flat[wing_a].x, flat[wing_b].x);
    bends.weights.back() = weights;
  };
  for (int row = 0; row + 1 < side; ++row) {
    for (int column = 0; column + 1 < side; ++column) {
      const std::uint32_t a = point(column, row);
      const std::uint32_t b = point(column + 1, row);
      const std::uint32_t c = point(column, row + 1);
      const std::uint32_t d = point(column + 1, row + 1);
      const bool even = (row + column) % 2 == 0;
      even ? add(d, a, c, b) : add(b, c, a, d);
      // The opposite vertices of an edge between two cells are where their diagonals do not end.
      if (column > 0) even ? add(a, c, point(column - 1, row), d) : add(a, c, point(column - 1, row + 1), b);
      if (row > 0) even ? add(b, a, point(column + 1, row - 1), d) : add(b, a, point(column, row - 1), c);
    }
  }
  return bends;
}

}  // namespace hooke::bench
