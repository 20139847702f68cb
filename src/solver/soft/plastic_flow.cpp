#include "solver/soft/plastic_flow.h"

#include "base/assert.h"
#include "elements/dihedral.h"
#include "elements/plasticity.h"
#include "elements/tetrahedron.h"
#include "solver/simd/lane_arrays.h"
#include "solver/soft/soft_tuning.h"

#include <algorithm>
#include <cmath>

namespace hooke::solver {

namespace {

/// The object that owns `row` in `part`, of those listed in order of their rows; null if none does.
const state::Deformable* owner_of(const std::vector<const state::Deformable*>& objects,
                                  state::Rows state::Deformable::*part, std::uint32_t row) {
  const auto after =
      std::upper_bound(objects.begin(), objects.end(), row,
                       [part](std::uint32_t r, const auto* object) { return r < (object->*part).first; });
  if (after == objects.begin()) return nullptr;
  const state::Deformable* object = *(after - 1);
  return row < (object->*part).end() ? object : nullptr;
}

void find_bends(const std::vector<const state::Deformable*>& cloths, const BendBlocks& bends,
                std::vector<BendYield>& yields) {
  if (cloths.empty()) return;
  for (std::uint32_t block = 0; block < bends.laws.size(); ++block) {
    const std::uint32_t(&rows)[kLanes] = bends.laws[block].row;
    std::uint32_t end = 0;
    for (std::uint32_t lane = 0; lane < kLanes; lane = end) {
      for (end = lane + 1; end < kLanes && rows[end] == rows[lane]; ++end) continue;
      const state::Deformable* cloth =
          owner_of(cloths, &state::Deformable::bends, bends.first_row + rows[lane]);
      if (cloth != nullptr) yields.push_back({rows[lane], block, lane, end, cloth->yield_angle});
    }
  }
}

void find_tetrahedra(const std::vector<const state::Deformable*>& solids, const TetrahedronBlocks& tetrahedra,
                     std::vector<TetrahedronYield>& yields) {
  if (solids.empty()) return;
  const std::vector<TetrahedronLaw>& laws = tetrahedra.laws;
  for (std::uint32_t lane = 0, end = 0; lane < laws.size(); lane = end) {
    for (end = lane + 1; end < laws.size() && laws[end].row == laws[lane].row; ++end) continue;
    const std::uint32_t row = tetrahedra.first_row + laws[lane].row;
    const state::Deformable* solid = owner_of(solids, &state::Deformable::tetrahedra, row);
    if (solid == nullptr) continue;
    HOOKE_ASSERT(solid->rest_edges->size() == solid->tetrahedra.count);
    yields.push_back({lane, end, solid->yield_stress, (*solid->rest_edges)[row - solid->tetrahedra.first]});
  }
}

/// A^T A
template <class T>
math::Symmetric3<T> square_of(const Matrix3<T>& a) {
  return {dot(a.x, a.x), dot(a.x, a.y), dot(a.x, a.z), dot(a.y, a.y), dot(a.y, a.z), dot(a.z, a.z)};
}

/// Whether the shape at rest of these gradients is near enough to the shape in which it was made. With the
/// edges e_k of the latter, F_p^-T = sum b_k e_k^T.
bool is_in_reach(const std::array<DVec3, 3>& b, const std::array<Vec3, 3>& edges) {
  Matrix3<double> p = {{}, {}, {}};
  for (std::size_t k = 0; k < 3; ++k) {
    const DVec3 e = vector_cast<double>(edges[k]);
    p = p + Matrix3<double>{e.x * b[k], e.y * b[k], e.z * b[k]};
  }
  const auto squares = [](const Matrix3<double>& m) { return elements::contract(m, m); };
  // The determinant is 1, so that the inverse is the transposed matrix of cofactors. NaN is not in reach.
  return squares(p) <= kMostPlasticSquare && squares(elements::cofactors(p)) <= kMostPlasticSquare;
}

/// Finds the gradients after the flow for a gradient F_e whose |dev C|^2 is to fall to `limit`; false if
/// they stay.
bool flow(const Mat3& f, double limit, const std::array<Vec3, 3>& edges, std::array<Vec3, 3>& gradients) {
  const Matrix3<double> exact = {vector_cast<double>(f.x), vector_cast<double>(f.y),
                                 vector_cast<double>(f.z)};
  if (!(determinant(exact) > kFlattestThatFlows)) return false;
  const math::Symmetric3<double> c = square_of(exact);
  const double share = std::sqrt(limit / elements::deviator_squared(c));
  if (!(share < 1)) return false;
  const Matrix3<double> x = elements::flow_between(c, elements::returned(c, share));
  std::array<DVec3, 3> after = {};
  for (std::size_t k = 0; k < 3; ++k) after[k] = x * vector_cast<double>(gradients[k]);
  if (!is_in_reach(after, edges)) return false;
  for (std::size_t k = 0; k < 3; ++k) gradients[k] = vector_cast<Real>(after[k]);
  return true;
}

/// F of a lane, counted through all blocks.
Mat3 gradient_of(const TetrahedronBlocks& tetrahedra, std::uint32_t lane, const state::Particles& particles) {
  const TetrahedronBlock& block = tetrahedra.blocks[lane / kTetrahedronLanes];
  const auto i = static_cast<int>(lane % kTetrahedronLanes);
  std::array<Vec3, 4> x;
  for (std::size_t k = 0; k < 4; ++k)
    x[k] = particles.position[tetrahedra.first_particle + block.record[k][i] / 4].x;
  return elements::gradient_of(x, {Vec3{}, get(block.b[0], i), get(block.b[1], i), get(block.b[2], i)});
}

}  // namespace

void find_yields(std::span<const state::Deformable> objects, const BendBlocks& bends,
                 const TetrahedronBlocks& tetrahedra, Yields& yields) {
  yields = {};
  std::vector<const state::Deformable*> cloths, solids;
  for (const state::Deformable& object : objects) {
    if (object.yield_angle < kRigid) cloths.push_back(&object);
    if (object.yield_stress < kRigid) solids.push_back(&object);
  }
  find_bends(cloths, bends, yields.bends);
  find_tetrahedra(solids, tetrahedra, yields.tetrahedra);
}

void flow_bends(const Yields& yields, parallel::Range rows, state::Tables& tables, BendBlocks& bends) {
  const auto& position = tables.particles.position;
  for (int i = rows.begin; i < rows.end; ++i) {
    const BendYield& yield = yields.bends[i];
    HOOKE_ASSERT(yield.block < bends.blocks.size() && yield.lane < yield.end_lane &&
                 yield.end_lane <= kLanes);
    const std::size_t row = bends.first_row + yield.row;
    const state::Bends::Stencil& s = tables.bends.stencil[row];
    const auto d = elements::dihedral(position[s.edge_a].x, position[s.edge_b].x, position[s.wing_a].x,
                                      position[s.wing_b].x);
    Real& rest = tables.bends.rest_angle[row];
    const Real error = elements::wrapped(d.angle - rest);
    if (!d.valid || !(std::abs(error) > yield.angle)) continue;
    rest = elements::wrapped(rest + (error > Real(0) ? error - yield.angle : error + yield.angle));
    Real* lanes = bends.blocks[yield.block].rest_angle;
    std::fill(lanes + yield.lane, lanes + yield.end_lane, rest);
  }
}

void flow_tetrahedra(const Yields& yields, parallel::Range rows, Real h, state::Tables& tables,
                     TetrahedronBlocks& tetrahedra) {
  for (int i = rows.begin; i < rows.end; ++i) {
    const TetrahedronYield& yield = yields.tetrahedra[i];
    const TetrahedronLaw& law = tetrahedra.laws[yield.lane];
    const Mat3 f = gradient_of(tetrahedra, yield.lane, tables.particles);
    const Real limit = elements::yield_limit(yield.stress, law.shear_modulus);
    if (!(elements::deviator_squared(square_of(f)) > limit)) continue;
    std::array<Vec3, 3>& gradients = tables.tetrahedra.shape_gradient[tetrahedra.first_row + law.row];
    if (!flow(f, static_cast<double>(limit), yield.edges, gradients)) continue;
    for (std::uint32_t lane = yield.lane; lane < yield.end_lane; ++lane) {
      take_shape(tables.tetrahedra, tables.particles, lane, tetrahedra);
      prepare_tetrahedron(tetrahedra, lane, h);
    }
  }
}

}  // namespace hooke::solver
