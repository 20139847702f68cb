#pragma once

#include "parallel/range.h"
#include "state/objects.h"
#include "state/particles.h"
#include "state/tetrahedra.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace hooke::solver {

/// A tetrahedron in the form that the kernel takes. The coefficients are those of one substep.
struct TetrahedronRow {
  std::array<std::uint32_t, 4> particle = {};  ///< Counted from TetrahedronRows::first_particle.
  std::array<Vec3, 3> b = {};                  ///< Gradients of the shape functions of corners 1 to 3 [1/m].
  Real shift = Real(0);         ///< 1 + mu / lambda; this and all below are written by prepare_tetrahedra.
  Real gamma_volume = Real(0);  ///< 1 / (h^2 lambda V).
  Real gamma_shape = Real(0);   ///< 1 / (h^2 mu V).
  Real gamma_trace =
      Real(0);  ///< 1 / (h tau (lambda - mu) V), for the rate of volume; infinite without damping.
  Real gamma_rate = Real(0);  ///< 1 / (h tau mu V), for the rates of strain; infinite without damping.
};

/// The law from which prepare_tetrahedra makes the coefficients of a row.
struct TetrahedronLaw {
  std::uint32_t row = 0;  ///< Row of the table, counted from TetrahedronRows::first_row.
  Real volume = Real(0);
  Real shear_modulus = Real(0);
  Real volume_modulus = Real(0);
  Real damping_time = Real(0);
  Real stiffest = Real(0);  ///< Largest h^2 mu that a substep carries [Pa s^2].
};

/// A pass of rows of one color, which share no particle. Passes follow each other.
struct TetrahedronPass {
  int first = 0;
  int end = 0;
};

struct TetrahedronRows {
  std::uint32_t first_particle = 0;  ///< Row of the particle that corners count from.
  std::uint32_t first_row = 0;       ///< Row of the table that laws count from.
  std::vector<TetrahedronRow> rows;
  std::vector<TetrahedronLaw> laws;  ///< One per row.
  std::vector<TetrahedronPass> passes;
  std::vector<Real>
      volume_at;             ///< Volume of the tetrahedra about each particle, from the first one on [m^3].
  Real inverse_h = Real(0);  ///< 1 / h [1/s]; written by prepare_tetrahedra.
  bool any_damping = false;  ///< Whether any row is damped.
};

/// Colors the tetrahedra of these objects greedily in the order of the table.
void build_tetrahedra(std::span<const state::Deformable> objects, const state::Tetrahedra& tetrahedra,
                      const state::Particles& particles, TetrahedronRows& rows);

/// Takes the shape at rest of `row` from the table, and finds how stiff it may be.
void take_shape(const state::Tetrahedra& tetrahedra, const state::Particles& particles, std::size_t row,
                TetrahedronRows& rows);

/// Sets the coefficients of every row for a substep of `h` [s].
///
/// Shear is explicit in solve_tetrahedra, which is stable while h^2 w^2 < 4 for the fastest mode of shear.
/// Where a tetrahedron is stiffer, its mu is lowered to what keeps h^2 w^2 at 2; lambda, which is implicit,
/// keeps its value. More substeps carry a stiffer jelly.
void prepare_tetrahedra(TetrahedronRows& tetrahedra, Real h);
/// Sets the coefficients of one row.
void prepare_tetrahedron(const TetrahedronLaw& law, Real h, TetrahedronRow& row);

/// mu of a row in a substep of `h` [s], lowered or not [Pa].
[[nodiscard]] Real shear_modulus_of(const TetrahedronLaw& law, Real h);

/// Corrects velocities by the stress of each tetrahedron, in one pass.
///
/// Constraints  C_H = det F - (1 + mu / lambda),  gradient G_H = cof F
///              C_D = sqrt(tr F^T F),             gradient G_D = F / C_D
/// with F at the start of the substep; the energy is V (lambda C_H^2 + mu C_D^2) / 2
/// (elements/tetrahedron.h).
///
/// Impulse      of corner i: T b_i with T = L_H G_H + L_D G_D, where with B = sum w_i b_i b_i^T
///
///     (G_H : G_H B + gamma_H) L_H +  G_H : G_D B            L_D = -(G_H : F' + C_H / h)
///      G_H : G_D B            L_H + (G_D : G_D B + gamma_D) L_D = -(G_D : F' + C_D / h)
///
/// where F' = sum v_i b_i^T. At rest the two answers cancel, which they would not do one after the other:
/// hence the coupled solution. There is no decomposition of F: C_H turns a tetrahedron back that is inside
/// out. There det F counts as no less than min(0, 4 - 2/3 tr F^T F). By the full law a solid folded through
/// itself keeps some tetrahedra inside out, pressed by their neighbors; with the bound none is left of a
/// mirrored solid, at any nu that is allowed. Both gradients are those of rotations about the present
/// places, so that linear and angular momentum are kept to rounding. The method follows Macklin and Müller
/// 2021, but with directions at the start of the substep, as springs have (solver/soft/spring_solve.h): with
/// directions at the places where the particles are about to be, a spinning solid would lose its spin.
void solve_tetrahedra(const TetrahedronRows& tetrahedra, parallel::Range rows, state::Particles& particles);

/// Damps rates of strain E' = (F^T F' + F'^T F) / 2 by the stress tau times the rate of the elastic stress
/// at rest, 2 mu E' + (lambda - mu) tr(E') 1, in one pass.
///
/// It solves seven rows, the trace and the six rates, one after the other: L = -E'_kl / (W_kl + gamma s^2).
/// They are implicit, so that no row does more than stop its rate. s = max(1, tr(F^T F) / 3): viscosity does
/// not hold what is torn out of all shape.
///
/// It is a pass of its own, before the substep's forces: what hangs still has no velocity then, and stays
/// where the stress alone holds it. Within one pass it would sag by about tau / h times the error that the
/// stress makes.
void damp_tetrahedra(const TetrahedronRows& tetrahedra, parallel::Range rows, state::Particles& particles);

}  // namespace hooke::solver
