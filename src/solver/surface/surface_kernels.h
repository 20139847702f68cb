#pragma once

#include "solver/surface/surface_records.h"

#include <span>
#include <vector>

/// \file
/// The kernels of surfaces, over lanes. Every instruction set gives the bits of the scalar twins.

namespace hooke::solver::wide {

/// Appends all pairs of features that are near or whose cages let them meet. Features with a common vertex
/// are no pair. The closest points of a vertex and a triangle are found by Voronoi regions (Ericson 2005,
/// 5.1.5), those of two edges as there in 5.1.9.
void search_surfaces(const SurfaceSearch& search, std::vector<SurfaceFound>& found);
void search_surfaces_scalar(const SurfaceSearch& search, std::vector<SurfaceFound>& found);

/// Writes to `now` how far apart pairs are along their normals, from the nearest vertices of both sides.
/// Returns whether one is nearer than least. If `certain` [m] is positive, least is made first of what `now`
/// was: at least `certain`, else `most` or 90 % of it.
bool measure_pairs(std::span<SurfacePairBlock> blocks, bool edges, Real certain,
                   const state::PositionRecord* position);
bool measure_pairs_scalar(std::span<SurfacePairBlock> blocks, bool edges, Real certain,
                          const state::PositionRecord* position);

/// Sets what rows ask for in a substep of `h` [s] from where vertices are when it begins; see
/// solve_surface_rows of solver/surface/surface_rows.h.
void prepare_surface_rows(std::span<SurfaceRowBlock> blocks, Real h, const state::PositionRecord* position,
                          const state::VelocityRecord* velocity);
void prepare_surface_rows_scalar(std::span<SurfaceRowBlock> blocks, Real h,
                                 const state::PositionRecord* position,
                                 const state::VelocityRecord* velocity);

/// Solves rows once, block by block.
void solve_surface_rows(std::span<SurfaceRowBlock> blocks, state::VelocityRecord* velocity);
void solve_surface_rows_scalar(std::span<SurfaceRowBlock> blocks, state::VelocityRecord* velocity);

}  // namespace hooke::solver::wide
