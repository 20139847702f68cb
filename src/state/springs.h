#pragma once

#include "hooke/math.h"

#include "state/particles.h"

#include <array>
#include <cstdint>
#include <vector>

/// \file
/// Rows between particles of one object, in the order they were made. The solver keeps its own colored copy
/// (solver/soft/spring_blocks.h), which is built anew for objects whose rows change (Deformable::revision).

namespace hooke::state {

/// The purpose of a spring row. Rows of one class are solved together, classes in this order.
enum class SpringClass : std::uint8_t {
  kStretch,  ///< Along an edge, or given by the user.
  kShear,    ///< Across a cell.
  kBend,     ///< To the second neighbor.
  kTether,   ///< From a free particle (a) to a pinned one (b): only pulls; inextensible.
  kLimit,    ///< Largest length of a stretch spring: only pulls.
};

/// The method that computes the force of a row.
enum class SpringForm : std::uint8_t {
  kExplicit,           ///< The direction is that at the start of the substep.
  kPredicted,          ///< The direction is that where the particles are about to be.
  kExplicitIsotropic,  ///< Damping acts on the whole relative velocity.
  kPredictedIsotropic,
};

struct Springs {
  std::vector<std::uint32_t> particle_a;
  std::vector<std::uint32_t> particle_b;
  std::vector<Real> rest_length;  ///< L [m]; for limits and tethers the largest length.
  std::vector<Real> stiffness;    ///< k [N/m]; infinity is a rigid link.
  std::vector<Real> damping;      ///< c [N s/m]
  std::vector<Real> damped_mass;  ///< Largest mass that c acts on, see solver/soft/spring_solve.h [kg].
  std::vector<SpringClass> kind;
  std::vector<SpringForm> form;

  [[nodiscard]] int count() const { return static_cast<int>(particle_a.size()); }

  template <class Self, class Visit>
  static void for_each_column(Self& self, Visit&& visit) {
    visit(self.particle_a);
    visit(self.particle_b);
    visit(self.rest_length);
    visit(self.stiffness);
    visit(self.damping);
    visit(self.damped_mass);
    visit(self.kind);
    visit(self.form);
  }
};

/// One row per inner edge that resists folding: by the angle between its triangles, or as an isometric bend.
/// A woven cloth has rows along its yarns in place of these, isometric in form: at each inner point of a
/// yarn, with the points before and behind it as wings, which resists a change of direction; and for each
/// cell, with its corners, which resists twist.
struct Bends {
  struct Stencil {
    std::uint32_t edge_a, edge_b;  ///< Ends of the shared edge.
    std::uint32_t wing_a, wing_b;  ///< Opposite vertices of the two triangles.
  };
  std::vector<Stencil> stencil;
  std::vector<Real> rest_angle;  ///< theta_0 [rad]; 0 is flat.
  std::vector<Real> stiffness;   ///< k [N m / rad], of the energy k (theta - theta_0)^2 / 2; or k [N/m], of
                                 ///< the energy k |q|^2 / 2 of an isometric bend.
  std::vector<Real> damping;     ///< c [N m s / rad] of the angle; for an isometric bend tau = c / k [s], of
                                 ///< |q|.
  std::vector<std::array<Real, 4>> weights;  ///< Weights of elements::isometric_bend, or of a row of a woven
                                             ///< cloth; all zero for a bend by angle.

  [[nodiscard]] int count() const { return static_cast<int>(stencil.size()); }
  /// An isometric bend never has a zero weight at a wing.
  [[nodiscard]] bool is_isometric(std::size_t row) const { return weights[row][2] != Real(0); }
  /// Whether a row resists bending along a yarn, at edge_a between its wings. Such a row alone has weights
  /// above zero at its wings, and none at edge_b, a point beside edge_a.
  [[nodiscard]] bool is_along_yarn(std::size_t row) const { return weights[row][2] > Real(0); }
  [[nodiscard]] std::array<double, 4> weights_of(std::size_t row) const {
    const auto& k = weights[row];
    return {static_cast<double>(k[0]), static_cast<double>(k[1]), static_cast<double>(k[2]),
            static_cast<double>(k[3])};
  }

  template <class Self, class Visit>
  static void for_each_column(Self& self, Visit&& visit) {
    visit(self.stencil);
    visit(self.rest_angle);
    visit(self.stiffness);
    visit(self.damping);
    visit(self.weights);
  }
};

/// Stiffness of a bend: twice as much along a yarn where one thing holds the link on one side, for then only
/// the half that belongs to the other link bends.
[[nodiscard]] inline Real stiffness_beside_clamp(const Bends& bends, std::size_t row,
                                                 const Particles& particles) {
  const Bends::Stencil& s = bends.stencil[row];
  const auto is_held = [&](std::uint32_t particle) {
    return !(particles.velocity[particle].inverse_mass > Real(0));
  };
  const bool clamped =
      bends.is_along_yarn(row) && is_held(s.edge_a) && is_held(s.wing_a) != is_held(s.wing_b);
  return clamped ? Real(2) * bends.stiffness[row] : bends.stiffness[row];
}

/// Triangles of cloths, which the wind pushes and which are drawn.
struct Triangles {
  struct Corners {
    std::uint32_t a, b, c;
  };
  std::vector<Corners> corners;
  /// Bit k says that the edge from corner k to the next belongs to this triangle, of all that share the edge.
  std::vector<std::uint8_t> own_edges;
  std::vector<Real> mass;  ///< [kg]

  [[nodiscard]] int count() const { return static_cast<int>(corners.size()); }

  template <class Self, class Visit>
  static void for_each_column(Self& self, Visit&& visit) {
    visit(self.corners);
    visit(self.own_edges);
    visit(self.mass);
  }
};

/// Whether a segment joins its nodes.
enum class SegmentHold : std::uint8_t {
  kHolds,
  kBroken,  ///< It broke in this step and transmits nothing. The solver still counts its nodes as one rope.
  kGone,    ///< It broke in an earlier step: its nodes are ends of two chains (state/rope_chains.h).
};

/// Segments of ropes: segment row s of a rope joins its nodes s and s + 1.
struct Segments {
  std::vector<Real> rest_length;   ///< L [m]
  std::vector<Real> stiffness;     ///< k [N/m] of the segment; infinity is rigid.
  std::vector<Real> damping;       ///< c [N s/m] of the segment.
  std::vector<Real> length_limit;  ///< Largest length [m]; infinity for none.
  std::vector<Real> tension;       ///< Tension at the end of the last substep [N]; written by
                                   ///< solve_rope_systems.
  std::vector<Real> mean_tension;  ///< Mean tension over the last step [N]; written by solve_rope_systems.
  std::vector<std::uint8_t>
      limited;  ///< 1 while the segment is held at its largest length; written by solve_rope_systems.
  std::vector<std::uint8_t> clamped;  ///< 1 if one thing holds both ends; written by note_clamps.
  std::vector<SegmentHold> hold;      ///< Written by solve_coupled_group and drop_broken_segments.
  std::vector<Real> needed_force;     ///< Tension that a broken segment needed [N]; else 0.
  std::vector<double> broke_at;       ///< Time at which a segment broke [s]; else 0.

  [[nodiscard]] int count() const { return static_cast<int>(rest_length.size()); }
  [[nodiscard]] bool joins(std::size_t row) const { return hold[row] == SegmentHold::kHolds; }

  template <class Self, class Visit>
  static void for_each_column(Self& self, Visit&& visit) {
    visit(self.rest_length);
    visit(self.stiffness);
    visit(self.damping);
    visit(self.length_limit);
    visit(self.tension);
    visit(self.mean_tension);
    visit(self.limited);
    visit(self.clamped);
    visit(self.hold);
    visit(self.needed_force);
    visit(self.broke_at);
  }
};

}  // namespace hooke::state
