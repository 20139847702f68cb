#include "solver/solid/tetrahedron_blocks.h"

#include "base/assert.h"
#include "base/counting_sort.h"
#include "solver/linear/coloring.h"
#include "solver/simd/lane_arrays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace hooke::solver {

namespace {

/// Bodies that may hold points of a group before its list of them has to grow.
constexpr std::size_t kLikelyHolders = 16;

Real inverse_or_infinite(Real x) {
  return x > Real(0) ? Real(1) / x : std::numeric_limits<Real>::infinity();
}

/// How easily the corners of a tetrahedron move, with its own share of their masses: w^2 of its fastest mode
/// of shear is at most 2 mu V times that.
Real mobility_of(const state::Tetrahedra& t, std::size_t row, const TetrahedronBlocks& of,
                 const state::Particles& particles) {
  const state::Tetrahedra::Corners& c = t.corners[row];
  const std::uint32_t ends[4] = {c.a, c.b, c.c, c.d};
  const std::array<Vec3, 3>& gradients = t.shape_gradient[row];
  const std::array<Vec3, 4> b = {-(gradients[0] + gradients[1] + gradients[2]), gradients[0], gradients[1],
                                 gradients[2]};
  Real sum = Real(0);
  for (int i = 0; i < 4; ++i) {
    const Real volume_at = of.volume_at[ends[i] - of.first_particle];
    HOOKE_ASSERT(volume_at > Real(0));
    const Real share = particles.mass[ends[i]] * t.volume[row] / volume_at;
    sum += length_squared(b[i]) / share;
  }
  return sum;
}

/// The octave of each row's stiffness.
std::vector<int> octaves_of(const state::Tetrahedra& t, state::Rows rows, const TetrahedronBlocks& of,
                            const state::Particles& particles) {
  std::vector<int> octaves;
  octaves.reserve(rows.count);
  for (std::size_t row = rows.first; row < rows.end(); ++row)
    octaves.push_back(std::ilogb(mobility_of(t, row, of, particles) * t.volume[row] * t.shear_modulus[row]));
  return octaves;
}

/// Writes a row of the table, counted from the first one, to the end of the laws and to its lane.
void add_row(const state::Tetrahedra& t, const state::Particles& particles, std::size_t row,
             TetrahedronBlocks& out) {
  const std::size_t at = out.first_row + row;
  const std::size_t lane = out.laws.size();
  const state::Tetrahedra::Corners& c = t.corners[at];
  HOOKE_ASSERT(c.a != c.b && c.a != c.c && c.a != c.d && c.b != c.c && c.b != c.d && c.c != c.d);
  const std::array<std::uint32_t, 4> ends = {c.a, c.b, c.c, c.d};
  for (std::size_t i = 0; i < 4; ++i)
    out.blocks.back().record[i][lane % kTetrahedronLanes] = 4 * (ends[i] - out.first_particle);
  out.laws.push_back({.row = static_cast<std::uint32_t>(row),
                      .volume = t.volume[at],
                      .shear_modulus = t.shear_modulus[at],
                      .volume_modulus = t.volume_modulus[at],
                      .damping_time = t.damping_time[at]});
  take_shape(t, particles, lane, out);
}

}  // namespace

void build_tetrahedra(std::span<const state::Deformable> objects, const state::Tetrahedra& t,
                      const state::Particles& particles, TetrahedronBlocks& out) {
  const state::Rows source = rows_of(objects, &state::Deformable::tetrahedra);
  const state::Rows points = rows_of(objects, &state::Deformable::particles);
  out = {};
  out.first_particle = points.first;
  out.first_row = source.first;
  const std::span corners = std::span(t.corners).subspan(source.first, source.count);
  out.volume_at.assign(points.count, Real(0));
  out.pressed_of.assign(points.count, 0);
  out.pressed.reserve(points.count);  // as many as there may be: a step allocates nothing
  out.stiff.holders.reserve(kLikelyHolders);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (const std::uint32_t p : {corners[i].a, corners[i].b, corners[i].c, corners[i].d})
      out.volume_at[p - points.first] += t.volume[source.first + i];
  }
  const std::vector<int> color = color_fours(corners, points);
  const std::vector<int> octave = octaves_of(t, source, out, particles);
  std::vector<std::size_t> order(color.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return octave[a] < octave[b]; });
  base::counting_sort(order, count_colors(color), [&](std::size_t i) { return color[i]; });

  std::size_t i = 0;
  while (i < order.size()) {
    const int of_pass = color[order[i]];
    TetrahedronPass pass{.first = static_cast<int>(out.blocks.size())};
    const auto more = [&] { return i < order.size() && color[order[i]] == of_pass; };
    while (more()) {
      out.blocks.emplace_back();
      pass.last_count = 0;
      for (int lane = 0; lane < kTetrahedronLanes; ++lane) {
        const bool own = more();
        add_row(t, particles, order[own ? i++ : i - 1], out);
        if (own) ++pass.last_count;
      }
    }
    pass.end = static_cast<int>(out.blocks.size());
    out.passes.push_back(pass);
  }
}

void take_shape(const state::Tetrahedra& t, const state::Particles& particles, std::size_t lane,
                TetrahedronBlocks& out) {
  TetrahedronLaw& law = out.laws[lane];
  const std::size_t of_table = out.first_row + law.row;
  TetrahedronBlock& block = out.blocks[lane / kTetrahedronLanes];
  for (std::size_t k = 0; k < 3; ++k)
    put(t.shape_gradient[of_table][k], block.b[k], static_cast<int>(lane % kTetrahedronLanes));
  law.mobility = mobility_of(t, of_table, out, particles);
}

void prepare_tetrahedron(TetrahedronBlocks& tetrahedra, std::size_t lane, Real h) {
  const TetrahedronLaw& law = tetrahedra.laws[lane];
  TetrahedronBlock& block = tetrahedra.blocks[lane / kTetrahedronLanes];
  const std::size_t i = lane % kTetrahedronLanes;
  const Real shear = law.shear_modulus;
  const Real stiffness = h * law.volume;  // Times a modulus and a time it is 1 / gamma.
  const Real damping = stiffness * law.damping_time;
  block.gamma_volume[i] = Real(1) / (stiffness * h * law.volume_modulus);
  block.gamma_shape[i] = Real(1) / (Real(2) * stiffness * h * shear);
  block.gamma_trace[i] = inverse_or_infinite(damping * (law.volume_modulus - shear));
  block.gamma_rate[i] = inverse_or_infinite(damping * shear);
  block.implicit[i] = std::clamp(law.mobility / block.gamma_shape[i] - Real(1), Real(0), Real(1));
}

void prepare_tetrahedra(TetrahedronBlocks& tetrahedra, Real h) {
  HOOKE_ASSERT(tetrahedra.laws.size() == kTetrahedronLanes * tetrahedra.blocks.size());
  tetrahedra.inverse_h = Real(1) / h;
  tetrahedra.any_damping = false;
  tetrahedra.any_stiff = false;
  for (std::size_t i = 0; i < tetrahedra.laws.size(); ++i) {
    prepare_tetrahedron(tetrahedra, i, h);
    tetrahedra.any_damping = tetrahedra.any_damping || tetrahedra.laws[i].damping_time > Real(0);
    tetrahedra.any_stiff = tetrahedra.any_stiff || tetrahedra.is_stiff(i);
  }
}

}  // namespace hooke::solver
