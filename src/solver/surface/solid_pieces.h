#pragma once

#include "hooke/math.h"

#include "base/disjoint_sets.h"
#include "math/symmetric.h"
#include "state/tables.h"

#include <cstdint>
#include <vector>

/// \file
/// Pieces of stiff solids as rigid bodies. Where surfaces come nearer to each other than they may, they are
/// moved apart after all solutions, and nothing resists what that strains: a point of a ball of 1 GPa that
/// was moved by 2 mm stored 1.6 kJ. So a stiff solid moves as a whole, or that piece of it which tetrahedra
/// join.

namespace hooke::solver {

/// What tetrahedra join of a solid, as one rigid body.
struct SolidPiece {
  std::uint32_t object = 0;  ///< Row of the solid.
  std::uint32_t root = 0;    ///< Its first particle, counted within the solid.
  double inverse_mass = 0;   ///< [1/kg]; 0 if one of its points is held, and it cannot move.
  DVec3 center = {};         ///< Center of mass, from the object's origin [m].
  math::Symmetric3<double> inverse_inertia = {};  ///< [1/(kg m^2)]

  /// How fast an impulse along the unit vector n at a place moves that place along n [1/kg].
  [[nodiscard]] double mobility(DVec3 place, DVec3 n) const;

  /// How an impulse at a place changes the velocity of another point [m/s].
  [[nodiscard]] DVec3 change_at(DVec3 place, DVec3 impulse, DVec3 point) const;
};

/// The pieces that a substep asks for. Memory stays from one to the next.
class SolidPieces {
 public:
  void clear() { solids_used_ = 0, pieces_.clear(); }

  /// Lets the next two calls of piece_at leave pieces where they are.
  void make_room_for_two() {
    if (pieces_.capacity() < pieces_.size() + 2) pieces_.reserve(2 * pieces_.size() + 8);
  }

  /// The piece that has a particle of an object.
  SolidPiece& piece_at(const state::Tables& tables, std::uint32_t object, std::uint32_t particle);

  /// Whether a particle belongs to a piece.
  [[nodiscard]] bool has(const state::Tables& tables, const SolidPiece& piece, std::uint32_t particle);

 private:
  struct Solid {
    std::uint32_t object = 0;
    base::DisjointSets sets;  ///< Of its particles, counted within it.
  };

  Solid& solid_of(const state::Tables& tables, std::uint32_t object);

  std::vector<Solid> solids_;
  std::size_t solids_used_ = 0;
  std::vector<SolidPiece> pieces_;
};

}  // namespace hooke::solver
