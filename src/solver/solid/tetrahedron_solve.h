#pragma once

#include "parallel/range.h"
#include "solver/solid/tetrahedron_blocks.h"
#include "state/particles.h"

namespace hooke::solver {

/// Corrects velocities by the stress of each tetrahedron, in one pass, where no row of the group is stiff.
///
/// Volume       C_H = det F - 1 - (1 - k) mu / lambda,  gradient G = cof F
/// Shape        C_D = (F - k G) / (1 + k), nine rows whose gradients are one component of F each
///
/// with F at the start of the substep. For every k that is the law of the energy
/// V (lambda (det F - 1 - mu / lambda)^2 + mu |F|^2) / 2 (elements/tetrahedron.h): stress moves from one row
/// to the other. k is 1 near the form at rest, where C_D then vanishes and nothing cancels, and 3 / |F|^2
/// where the solid is drawn out, as explicit cofactors would make energy there.
///
/// Impulse      of corner i: T b_i with T = L G + D,
///
///     gamma_H L = -(G : F'' + C_H / h)
///     gamma_D D = -(theta (F'' - [a] F) + C_D / h),   torque of D = 0
///
/// F'' = sum v_i b_i^T with the velocities after it, and gamma_D = 1 / ((1 + k) h^2 mu V). The rate of
/// rotation a is minimized out, since a rotation is no change of shape. theta goes from 0 to 1 as h^2 w^2 of
/// the shear goes from 1 to 2: soft rows are explicit and lose no energy, stiff ones are implicit and make
/// none.
///
/// In this pass theta is 0 and D is known, so that L follows from F'' = F' + sum 1 / m_i T b_i b_i^T of the
/// row alone. Groups with a stiff row are solved as a whole instead (solver/solid/stiff_solution.h).
///
/// There is no decomposition of F: C_H turns a tetrahedron back that is inside out. There det F counts as no
/// less than min(0, 4 - 2/3 tr F^T F). By the full law a solid folded through itself keeps some tetrahedra
/// inside out, pressed by their neighbors; with the bound none is left of a mirrored solid, at any nu that is
/// allowed. Impulses keep linear momentum to rounding. Directions are those at the start of the substep, as
/// springs have (solver/soft/spring_solve.h): with directions at the places where the particles are about to
/// be, a spinning solid would lose its spin. The arithmetic is in double over lanes
/// (solver/solid/tetrahedron_rows.h).
void solve_tetrahedra(TetrahedronBlocks& tetrahedra, const TetrahedronPass& pass, parallel::Range blocks,
                      state::Particles& particles);

/// Finds the linear law of each row about the present velocities, and adds up the impulses that rows give
/// now: a pass of solver/solid/stiff_solution.h.
void linearize_tetrahedra(TetrahedronBlocks& tetrahedra, const TetrahedronPass& pass, parallel::Range blocks,
                          state::Particles& particles);

/// Adds the impulses by which rows resist the direction of the solution: a pass of
/// solver/solid/stiff_solution.h.
void resist_tetrahedra(TetrahedronBlocks& tetrahedra, const TetrahedronPass& pass, parallel::Range blocks,
                       state::Particles& particles);

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
void damp_tetrahedra(const TetrahedronBlocks& tetrahedra, const TetrahedronPass& pass, parallel::Range blocks,
                     state::Particles& particles);

}  // namespace hooke::solver
