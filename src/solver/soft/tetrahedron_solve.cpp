#include "solver/soft/tetrahedron_solve.h"

#include "base/assert.h"
#include "base/counting_sort.h"
#include "elements/tetrahedron.h"
#include "math/symmetric.h"
#include "solver/soft/soft_tuning.h"
#include "solver/soft/spring_blocks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace hooke::solver {

namespace {

using elements::contract;

std::array<Vec3, 4> all_gradients(const std::array<Vec3, 3>& b) {
  return {-(b[0] + b[1] + b[2]), b[0], b[1], b[2]};
}

using Symmetric = math::Symmetric3<Real>;

/// sum s_i b_i b_i^T.
Symmetric weighted_squares(const std::array<Vec3, 4>& b, const std::array<Real, 4>& s) {
  Symmetric sum;
  for (int i = 0; i < 4; ++i) {
    const Vec3 t = s[i] * b[i];
    sum = sum + Symmetric{t.x * b[i].x, t.x * b[i].y, t.x * b[i].z, t.y * b[i].y, t.y * b[i].z, t.z * b[i].z};
  }
  return sum;
}

/// M B for a symmetric B.
Mat3 times(const Mat3& m, const Symmetric& s) {
  return {s.xx * m.x + s.xy * m.y + s.xz * m.z, s.xy * m.x + s.yy * m.y + s.yz * m.z,
          s.xz * m.x + s.yz * m.y + s.zz * m.z};
}

Real inverse_or_infinite(Real x) {
  return x > Real(0) ? Real(1) / x : std::numeric_limits<Real>::infinity();
}

/// The largest mu with which all modes of a tetrahedron's shear are stable, with its own share of its
/// corners' masses: w^2 <= 2 mu V lambda_max(sum b b^T / m). The trace bounds lambda_max.
Real stiffest_of(const state::Tetrahedra& t, std::size_t row, const TetrahedronRows& of,
                 const state::Particles& particles) {
  const state::Tetrahedra::Corners& c = t.corners[row];
  const std::uint32_t ends[4] = {c.a, c.b, c.c, c.d};
  const std::array<Vec3, 4> b = all_gradients(t.shape_gradient[row]);
  Real sum = Real(0);
  for (int i = 0; i < 4; ++i) {
    const Real volume_at = of.volume_at[ends[i] - of.first_particle];
    HOOKE_ASSERT(volume_at > Real(0));
    const Real share = particles.mass[ends[i]] * t.volume[row] / volume_at;
    sum += length_squared(b[i]) / share;
  }
  return kLargestShearStiffness / (Real(2) * t.volume[row] * sum);
}

}  // namespace

void build_tetrahedra(std::span<const state::Deformable> objects, const state::Tetrahedra& t,
                      const state::Particles& particles, TetrahedronRows& out) {
  const state::Rows source = rows_of(objects, &state::Deformable::tetrahedra);
  const state::Rows points = rows_of(objects, &state::Deformable::particles);
  out = {};
  out.first_particle = points.first;
  out.first_row = source.first;
  const std::span corners = std::span(t.corners).subspan(source.first, source.count);
  const std::vector<int> color = color_fours(corners, points);
  std::vector<std::size_t> order(color.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  base::counting_sort(order, count_colors(color), [&](std::size_t i) { return color[i]; });

  out.volume_at.assign(points.count, Real(0));
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (const std::uint32_t p : {corners[i].a, corners[i].b, corners[i].c, corners[i].d})
      out.volume_at[p - points.first] += t.volume[source.first + i];
  }
  for (const std::size_t i : order) {
    const int row = static_cast<int>(out.rows.size());
    if (out.passes.empty() || color[order[out.passes.back().first]] != color[i])
      out.passes.push_back({row, row});
    out.passes.back().end = row + 1;
    const state::Tetrahedra::Corners& c = corners[i];
    HOOKE_ASSERT(c.a != c.b && c.a != c.c && c.a != c.d && c.b != c.c && c.b != c.d && c.c != c.d);
    const std::uint32_t first = points.first;
    out.rows.push_back({.particle = {c.a - first, c.b - first, c.c - first, c.d - first}});
    const std::size_t at = source.first + i;
    out.laws.push_back({.row = static_cast<std::uint32_t>(i),
                        .volume = t.volume[at],
                        .shear_modulus = t.shear_modulus[at],
                        .volume_modulus = t.volume_modulus[at],
                        .damping_time = t.damping_time[at]});
    take_shape(t, particles, out.rows.size() - 1, out);
  }
}

void take_shape(const state::Tetrahedra& t, const state::Particles& particles, std::size_t row,
                TetrahedronRows& out) {
  TetrahedronLaw& law = out.laws[row];
  const std::size_t of_table = out.first_row + law.row;
  out.rows[row].b = t.shape_gradient[of_table];
  law.stiffest = stiffest_of(t, of_table, out, particles);
}

Real shear_modulus_of(const TetrahedronLaw& law, Real h) {
  return std::min(law.shear_modulus, law.stiffest / (h * h));
}

void prepare_tetrahedron(const TetrahedronLaw& law, Real h, TetrahedronRow& row) {
  const Real shear = shear_modulus_of(law, h);
  const Real stiffness = h * law.volume;  // Times a modulus and a time it is 1 / gamma.
  const Real damping = stiffness * law.damping_time;
  row.shift = Real(1) + shear / law.volume_modulus;
  row.gamma_volume = Real(1) / (stiffness * h * law.volume_modulus);
  row.gamma_shape = Real(1) / (stiffness * h * shear);
  row.gamma_trace = inverse_or_infinite(damping * (law.volume_modulus - shear));
  row.gamma_rate = inverse_or_infinite(damping * shear);
}

void prepare_tetrahedra(TetrahedronRows& tetrahedra, Real h) {
  HOOKE_ASSERT(tetrahedra.laws.size() == tetrahedra.rows.size());
  tetrahedra.inverse_h = Real(1) / h;
  tetrahedra.any_damping = false;
  for (std::size_t i = 0; i < tetrahedra.rows.size(); ++i) {
    prepare_tetrahedron(tetrahedra.laws[i], h, tetrahedra.rows[i]);
    tetrahedra.any_damping = tetrahedra.any_damping || tetrahedra.laws[i].damping_time > Real(0);
  }
}

namespace {

/// The stress impulse T of the two constraints for a rate F'.
Mat3 elastic_impulse(const TetrahedronRow& row, Real inverse_h, const Mat3& f, const Mat3& rate,
                     const Symmetric& b) {
  const Real size = std::sqrt(contract(f, f));
  if (!(size > Real(0))) return {{}, {}, {}};
  const Mat3 g_h = elements::cofactors(f);
  const Mat3 g_d = (Real(1) / size) * f;
  const Real least = std::min(Real(4) - Real(2) / Real(3) * size * size, Real(0));
  const Real volume = std::max(dot(f.x, g_h.x), least);
  const Mat3 g_d_b = times(g_d, b);
  const Real w_hh = contract(g_h, times(g_h, b)) + row.gamma_volume;
  const Real w_hd = contract(g_h, g_d_b);
  const Real w_dd = contract(g_d, g_d_b) + row.gamma_shape;
  const Real r_h = -(contract(g_h, rate) + inverse_h * (volume - row.shift));
  const Real r_d = -(contract(g_d, rate) + inverse_h * size);
  // prepare_tetrahedra keeps gamma_shape comparable to its w: w_hh stays larger than what is taken off.
  const Real share = w_hd / w_dd;
  const Real l_h = (r_h - share * r_d) / (w_hh - share * w_hd);
  const Real l_d = (r_d - w_hd * l_h) / w_dd;
  return l_h * g_h + l_d * g_d;
}

/// Solves one row of the viscosity: adds its impulse to `sum` and its change to `rate`.
void damp_row(const Mat3& gradient, Real gamma, const Symmetric& b, Mat3& rate, Mat3& sum) {
  const Mat3 response = times(gradient, b);
  const Real impulse = -contract(gradient, rate) / (contract(gradient, response) + gamma);
  sum = sum + impulse * gradient;
  rate = rate + impulse * response;
}

Mat3 viscous_impulse(const TetrahedronRow& row, const Mat3& f, Mat3 rate, const Symmetric& b) {
  Mat3 sum = {{}, {}, {}};
  const Real stretch = std::max(contract(f, f) / Real(3), Real(1));
  const Real softening = stretch * stretch;
  // The gradient of tr E by F is F.
  damp_row(f, softening * row.gamma_trace, b, rate, sum);
  const Vec3 columns[3] = {f.x, f.y, f.z};
  for (int k = 0; k < 3; ++k) {
    for (int l = k; l < 3; ++l) {
      // The gradient of E_kl has f_l / 2 in column k and f_k / 2 in column l.
      Vec3 g[3] = {};
      g[k] += Real(0.5) * columns[l];
      g[l] += Real(0.5) * columns[k];
      // E_kl and E_lk are two of the nine components, but one row.
      const Real share = k == l ? Real(0.5) : Real(0.25);
      damp_row({g[0], g[1], g[2]}, share * softening * row.gamma_rate, b, rate, sum);
    }
  }
  return sum;
}

/// The state and the motion of a row's corners.
struct Corners {
  std::array<Vec3, 4> x, v, b;
  std::array<Real, 4> w = {};
  Symmetric squares;  ///< B

  Corners(const TetrahedronRow& row, std::uint32_t first, const state::Particles& particles)
      : b(all_gradients(row.b)) {
    for (int i = 0; i < 4; ++i) {
      const state::VelocityRecord& record = particles.velocity[first + row.particle[i]];
      x[i] = particles.position[first + row.particle[i]].x;
      v[i] = record.v;
      w[i] = record.inverse_mass;
    }
    squares = weighted_squares(b, w);
  }

  [[nodiscard]] bool is_held() const { return !(squares.xx + squares.yy + squares.zz > Real(0)); }

  void push(const TetrahedronRow& row, std::uint32_t first, const Mat3& impulse,
            state::Particles& particles) const {
    for (int i = 0; i < 4; ++i)
      particles.velocity[first + row.particle[i]].v = v[i] + w[i] * (impulse * b[i]);
  }
};

}  // namespace

void solve_tetrahedra(const TetrahedronRows& tetrahedra, parallel::Range rows, state::Particles& particles) {
  for (int i = rows.begin; i < rows.end; ++i) {
    const TetrahedronRow& row = tetrahedra.rows[i];
    const Corners c(row, tetrahedra.first_particle, particles);
    if (c.is_held()) continue;
    const Mat3 f = elements::gradient_of(c.x, c.b);
    const Mat3 rate = elements::gradient_of(c.v, c.b);
    c.push(row, tetrahedra.first_particle, elastic_impulse(row, tetrahedra.inverse_h, f, rate, c.squares),
           particles);
  }
}

void damp_tetrahedra(const TetrahedronRows& tetrahedra, parallel::Range rows, state::Particles& particles) {
  for (int i = rows.begin; i < rows.end; ++i) {
    const TetrahedronRow& row = tetrahedra.rows[i];
    if (row.gamma_rate == std::numeric_limits<Real>::infinity()) continue;
    const Corners c(row, tetrahedra.first_particle, particles);
    if (c.is_held()) continue;
    const Mat3 f = elements::gradient_of(c.x, c.b);
    c.push(row, tetrahedra.first_particle,
           viscous_impulse(row, f, elements::gradient_of(c.v, c.b), c.squares), particles);
  }
}

}  // namespace hooke::solver
