#pragma once

#include "math/symmetric.h"
#include "solver/simd/lanes.h"
#include "state/objects.h"
#include "state/particles.h"
#include "state/tetrahedra.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Tetrahedra in the order of the kernels: blocks of 8 rows that share no particle, and the blocks of one
/// color after another.

namespace hooke::solver {

inline constexpr int kTetrahedronLanes = wide::kDoubleLanes;

/// 8 rows of one color. The last block of a pass may hold fewer: copies of its last row fill it. The
/// coefficients are those of one substep of length h.
struct TetrahedronBlock {
  /// 4 times the row of each corner's particle, counted from TetrahedronBlocks::first_particle: where its
  /// record begins, in numbers.
  std::uint32_t record[4][kTetrahedronLanes];
  Real b[3][3][kTetrahedronLanes];  ///< Gradients of the shape functions of corners 1 to 3 [1/m].
  // All below are written by prepare_tetrahedra.
  Real gamma_volume[kTetrahedronLanes];  ///< 1 / (h^2 lambda V).
  Real gamma_shape[kTetrahedronLanes];   ///< 1 / (2 h^2 mu V).
  Real gamma_trace[kTetrahedronLanes];   ///< 1 / (h tau (lambda - mu) V), for the rate of volume; infinite
                                         ///< without damping.
  Real gamma_rate[kTetrahedronLanes];    ///< 1 / (h tau mu V), for the rates of strain; infinite without
                                         ///< damping.
  Real implicit[kTetrahedronLanes];      ///< theta, from 0 where h^2 w^2 of its shear is at most 1, to 1 from
                                         ///< 2 on. Rows above 0 are stiff: all of a group with such a row
                                         ///< is solved as a whole.

  [[nodiscard]] bool is_stiff(int lane) const { return implicit[lane] > Real(0); }
};

/// The stress of a block's rows as a linear law, found by linearize_tetrahedra: a change dF' of the rate of F
/// adds the impulse -volume (G : dF') G - shape (dF' - [a] F), where a takes the torque out of it.
struct StressBlock {
  double f[3][3][kTetrahedronLanes];   ///< F, by columns.
  double g[3][3][kTetrahedronLanes];   ///< G = cof F, by columns.
  double turns[6][kTetrahedronLanes];  ///< a for a torque.
  double volume[kTetrahedronLanes];    ///< 1 / gamma_H [N s^2 m].
  double shape[kTetrahedronLanes];     ///< theta / gamma_D [N s^2 m].
};

/// The law from which prepare_tetrahedra makes the coefficients of a row.
struct TetrahedronLaw {
  std::uint32_t row = 0;  ///< Row of the table, counted from TetrahedronBlocks::first_row.
  Real volume = Real(0);
  Real shear_modulus = Real(0);
  Real volume_modulus = Real(0);
  Real damping_time = Real(0);
  Real mobility = Real(0);  ///< sum b_i^2 / m_i with the corners' shares of their masses [1 / (m^2 kg)].
};

/// Blocks [first, end) hold rows of one color, which share no particle. Passes follow each other.
struct TetrahedronPass {
  int first = 0;
  int end = 0;
  int last_count = kTetrahedronLanes;  ///< Rows in the last block.
};

/// A point of a solid that touches bodies. While solids are solved, what holds it is one with it.
struct PressedPoint {
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  std::uint32_t particle = 0;
  std::size_t contact = 0;       ///< Row of its first contact.
  std::uint32_t held = 0;        ///< Bit i: contact i holds it along the normal.
  std::uint32_t stuck = 0;       ///< Bit i: contact i holds it across the normal, too.
  std::uint32_t let_go = 0;      ///< Bit i: contact i has let it go, and does not hold it in the next round.
  std::uint32_t holder = kNone;  ///< Body of a contact that holds it.
  std::uint32_t mover = kNone;   ///< That body in StiffSolution::holders, if it gives way.
  /// The projection on the directions in which it follows the motion of its holder; 0 where nothing holds it.
  math::Symmetric3<double> follows = {};
  /// The projection on those in which it moves by itself. Where friction drags it, it does both.
  math::Symmetric3<double> free = math::Symmetric3<double>::diagonal(1);
  DVec3 lever = {};  ///< From the center of mass of the holder [m].
  Real inverse_mass = Real(0);
  DVec3 start = {};         ///< By how much its holder changes its velocity before stress does [m/s].
  DVec3 others_start = {};  ///< The same of other contacts that hold it [m/s].
  DVec3 change = {};        ///< By how much all does so far [m/s].
  DVec3 impulse = {};       ///< What stress has given it [N s].
  /// Where it slides, friction resists its velocity with this mass across each normal [kg]: mu N h / |v|.
  math::Symmetric3<double> drag = {};
  DVec3 sliding = {};     ///< Its velocity relative to what holds it, before all changes [m/s].
  DVec3 drag_lacks = {};  ///< Impulse of the drag at the change so far [N s].
  double yielding = 1;    ///< Its own mass over that with which stress resists its motion, 1 at most [ratio].
  /// W: an impulse I changes its velocity by W I [1/kg]. It has the masses of all but its holder.
  math::Symmetric3<double> answer = {};
};

/// A body that holds points of a group, with the share of its mass that they have. Six numbers are a velocity
/// and an angular velocity about its center of mass, or an impulse and an angular impulse.
struct HoldingBody {
  using Six = std::array<double, 6>;

  std::uint32_t body = 0;
  bool moves = false;              ///< Whether it gives way.
  std::array<Six, 6> mass = {};    ///< [kg, kg m, kg m^2]
  std::array<Six, 6> factor = {};  ///< L D L^T of mass and diagonal; what is not positive counts as infinite.
  std::array<Six, 6> own_factor = {};  ///< The same of mass alone.
  std::array<Six, 6> tied = {};        ///< How hooks resist its motion by themselves [as mass].
  Six image = {};                      ///< Impulse by which hooks resist `direction`.
  double error = 0;                    ///< Square of the impulse that is lacking, over mass [J].
  Six change = {};                     ///< Change of its motion so far.
  Six residual = {};                   ///< Impulse that is lacking, without that of its points.
  Six direction = {};
  Six wanted = {};  ///< What the residual asks for.
};

/// The velocity at a lever [m] of a body that moves by the six numbers `motion`.
inline DVec3 velocity_at(const HoldingBody::Six& motion, DVec3 lever) {
  return DVec3{motion[0], motion[1], motion[2]} + cross(DVec3{motion[3], motion[4], motion[5]}, lever);
}

/// Adds an impulse [N s] at a lever [m] to an impulse and an angular impulse.
inline void add_impulse(DVec3 impulse, DVec3 lever, HoldingBody::Six& to) {
  const DVec3 angular = cross(lever, impulse);
  const HoldingBody::Six parts = {impulse.x, impulse.y, impulse.z, angular.x, angular.y, angular.z};
  for (std::size_t i = 0; i < 6; ++i) to[i] += parts[i];
}

/// Adds the mass M of a point at a lever, so that the six numbers m y + ... are its impulses.
inline void add_mass(const math::Symmetric3<double>& m, DVec3 lever, std::array<HoldingBody::Six, 6>& to) {
  for (std::size_t k = 0; k < 6; ++k) {
    HoldingBody::Six motion = {};
    motion[k] = 1;
    HoldingBody::Six impulse = {};
    add_impulse(m * velocity_at(motion, lever), lever, impulse);
    for (std::size_t i = 0; i < 6; ++i) to[i][k] += impulse[i];
  }
}

/// A solution of all rows of a group at once, see solver/solid/stiff_solution.h. Vectors have four numbers
/// for each particle, counted from TetrahedronBlocks::first_particle, of which the last is 0.
struct StiffSolution {
  std::vector<StressBlock> stress;  ///< One per block.
  std::vector<double> force;        ///< Impulse of the stress at the velocities before [N s].
  std::vector<double> change;       ///< Change of velocity found so far [m/s].
  std::vector<double> residual;     ///< Impulse that is lacking for that change [N s].
  std::vector<double> direction;    ///< In which the change is looked for [m/s].
  std::vector<double> image;        ///< Impulse by which the stress resists `direction` [N s].
  std::vector<double> diagonal;  ///< Two times four numbers: the stress's answer to a particle's own motion,
                                 ///< the six of a symmetric matrix [kg].
  std::vector<math::Symmetric3<double>> contact_diagonal;  ///< That of contacts with other solids [kg].
  std::vector<math::Symmetric3<double>> mass;              ///< W^-1 of each particle [kg].
  std::vector<math::Symmetric3<double>> per_diagonal;  ///< Inverse of mass and diagonal [1/kg]; 0 for what
                                                       ///< does not move.
  std::vector<HoldingBody> holders;                    ///< In the order in which points name them.
  bool is_anchored = false;  ///< Something that does not move holds points, or hooks do.
  bool unconverged =
      false;  ///< Whether directions were too few in some substep; read and cleared by end_step.

  /// The holder with this body, null if it holds no point.
  [[nodiscard]] const HoldingBody* find_holder(std::uint32_t body) const {
    const auto found = std::find_if(holders.begin(), holders.end(),
                                    [&](const HoldingBody& one) { return one.body == body; });
    return found == holders.end() ? nullptr : &*found;
  }
  [[nodiscard]] HoldingBody* find_holder(std::uint32_t body) {
    const auto found = std::find_if(holders.begin(), holders.end(),
                                    [&](const HoldingBody& one) { return one.body == body; });
    return found == holders.end() ? nullptr : &*found;
  }
};

/// How rows of stress resist the motion of a particle by itself [kg].
inline math::Symmetric3<double> stress_diagonal(const StiffSolution& stiff, std::size_t i) {
  const double* d = stiff.diagonal.data() + 8 * i;
  return {d[0], d[1], d[2], d[4], d[5], d[6]};
}

struct TetrahedronBlocks {
  std::uint32_t first_particle = 0;  ///< Row of the particle that records count from.
  std::uint32_t first_row = 0;       ///< Row of the table that laws count from.
  std::vector<TetrahedronBlock> blocks;
  std::vector<TetrahedronLaw> laws;  ///< One per lane of the blocks.
  std::vector<TetrahedronPass> passes;
  std::vector<Real> volume_at;  ///< Volume of the tetrahedra about each particle, from the first on [m^3].
  Real inverse_h = Real(0);     ///< 1 / h [1/s]; written by prepare_tetrahedra.
  bool any_damping = false;     ///< Whether any row is damped.
  bool any_stiff = false;  ///< Whether any row was stiff when they were prepared: all are solved at once.
  std::vector<PressedPoint> pressed;  ///< In the order of particles. Lives until contacts are solved.
  /// 1 + the row in `pressed` of each particle, from the first one on; 0 for those that nothing presses on.
  std::vector<std::uint32_t> pressed_of;
  StiffSolution stiff;  ///< Empty until a row is stiff.

  /// Of a lane, counted through all blocks.
  [[nodiscard]] bool is_stiff(std::size_t lane) const {
    return blocks[lane / kTetrahedronLanes].is_stiff(static_cast<int>(lane % kTetrahedronLanes));
  }
};

/// Colors the tetrahedra of these objects greedily in the order of the table, 8 of a color to a block. Rows
/// of a color that are about as stiff as each other stand together, so that few blocks are stiff in part.
void build_tetrahedra(std::span<const state::Deformable> objects, const state::Tetrahedra& tetrahedra,
                      const state::Particles& particles, TetrahedronBlocks& blocks);

/// Takes the shape at rest of a lane, counted through all blocks, from the table, and finds how easily it
/// moves.
void take_shape(const state::Tetrahedra& tetrahedra, const state::Particles& particles, std::size_t lane,
                TetrahedronBlocks& blocks);

/// Sets the coefficients of every row for a substep of `h` [s], and finds which rows are stiff.
void prepare_tetrahedra(TetrahedronBlocks& tetrahedra, Real h);
/// Sets the coefficients of one lane, counted through all blocks.
void prepare_tetrahedron(TetrahedronBlocks& tetrahedra, std::size_t lane, Real h);

}  // namespace hooke::solver
