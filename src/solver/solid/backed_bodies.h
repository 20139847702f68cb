#pragma once

#include "solver/solid/tetrahedron_blocks.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

/// \file
/// Bodies that hold points of stiff solids, with what they bear, lie on and are hooked to. A stiff solid on
/// a light plate, or under one that bears a load, feels more than the plate: with the plate's mass alone a
/// cube of 1 MPa on 1 kg gained ten times its energy, and stiffer ones exploded.
///
/// Touching contacts and hooks are links without give, from body to body outwards. What is behind a link is
/// eliminated (Schur complement): it adds to the mass of the body before it. A body behind several links is
/// shared out evenly among them. The ground adds nearly infinite mass along what holds.

namespace hooke::solver {

struct BackedBody {
  using Six = HoldingBody::Six;

  std::uint32_t body = 0;
  std::array<Six, 6> own = {};     ///< Its mass alone [kg, kg m, kg m^2].
  std::array<Six, 6> mass = {};    ///< With what backs it.
  std::array<Six, 6> factor = {};  ///< L D L^T of `mass`.
  Six expected = {};  ///< Impulse that solids gave it in the particle substep before: it has had it already.
  Six impulse = {};   ///< Impulse that they give it in this one.
  int parents = 0;    ///< Number of links before it.
  bool is_held = false;  ///< Something that does not give way backs it.
};

/// Rows between two bodies, or between one and what does not give way.
struct BackingLink {
  static constexpr std::uint32_t kGround = 0xFFFFFFFF;
  using Six = HoldingBody::Six;

  std::uint32_t parent = 0;       ///< Index of the body before it.
  std::uint32_t child = kGround;  ///< Index of the body behind it.
  std::size_t first = 0;          ///< First row in BackedBodies::rows.
  std::size_t count = 0;
  std::size_t factor = 0;  ///< Where its factor begins in BackedBodies::numbers.
};

/// The rate of a row is of_parent . V_p + of_child . V_c.
struct BackingRow {
  HoldingBody::Six of_parent = {};
  HoldingBody::Six of_child = {};
};

struct BackedBodies {
  std::vector<BackedBody> bodies;  ///< Those that touch solids, then outwards.
  std::vector<BackingLink> links;  ///< In the order of their parents.
  std::vector<BackingRow> rows;
  std::vector<double> numbers;
  std::vector<std::uint32_t> index_of;  ///< 1 + the index of each body, by its row; 0 for those not listed.

  /// The body in a row of the table, null if it is not listed.
  [[nodiscard]] BackedBody* find(std::uint32_t row) {
    return row < index_of.size() && index_of[row] != 0 ? &bodies[index_of[row] - 1] : nullptr;
  }
  [[nodiscard]] const BackedBody* find(std::uint32_t row) const {
    return row < index_of.size() && index_of[row] != 0 ? &bodies[index_of[row] - 1] : nullptr;
  }
};

/// What stiff solids press a body with, about its center of mass [N, N m].
struct CarriedForce {
  std::uint32_t body = 0;
  HoldingBody::Six force = {};
};

}  // namespace hooke::solver
