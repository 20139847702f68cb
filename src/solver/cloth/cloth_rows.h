/// Rows and grids of cloths under loads in the Numbers of solver/simd/numbers.h. Included anew for each
/// instruction set.

#if defined(HOOKE_SOLVER_CLOTH_CLOTH_ROWS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_CLOTH_CLOTH_ROWS_H
#undef HOOKE_SOLVER_CLOTH_CLOTH_ROWS_H
#else
#define HOOKE_SOLVER_CLOTH_CLOTH_ROWS_H
#endif

#include "solver/cloth/cloth_kernels.h"
#include "solver/cloth/cloth_tuning.h"
#include "solver/simd/numbers.h"

#include <cstdint>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

/// Where the records of 16 points that follow each other begin.
constexpr std::uint32_t kOwnRecords[kLanes] = {0, 4, 8, 12, 16, 20, 24, 28, 32, 36, 40, 44, 48, 52, 56, 60};

/// The points of a block, from `lane` on, in an array with four numbers for each point.
template <class Number, class Record>
HWY_INLINE Quad<Number> own_points(const Record* of, int block, int lane) {
  Quad<Number> q;
  read_quad(reinterpret_cast<const Real*>(of) + 4 * kLanes * block, kOwnRecords + lane, q);
  return q;
}
/// The same from a table of particles, which has no more records than the cloth has points.
template <class Number, class Record>
HWY_INLINE Quad<Number> own_particles(const Record* of, const ClothGrid& grid, int block, int lane) {
  std::uint32_t records[kLanesOf<Number>];
  for (int i = 0; i < kLanesOf<Number>; ++i) {
    const auto point = static_cast<std::uint32_t>(kLanes * block + lane + i);
    records[i] = 4 * (point < grid.count ? point : grid.count - 1);
  }
  Quad<Number> q;
  read_quad(reinterpret_cast<const Real*>(of), records, q);
  return q;
}
template <class Number>
HWY_INLINE void write_points(const Triple<Number>& v, PointVector* to, int block, int lane) {
  write_quad(Quad<Number>{v.x, v.y, v.z, Number(Real(0))}, reinterpret_cast<Real*>(to) + 4 * kLanes * block,
             kOwnRecords + lane);
}

template <class Number>
HWY_INLINE Scale<Number> matrix_at(const Real (&of)[6][kLanes], int lane) {
  return {get<Number>(of[0] + lane), get<Number>(of[1] + lane), get<Number>(of[2] + lane),
          get<Number>(of[3] + lane), get<Number>(of[4] + lane), get<Number>(of[5] + lane)};
}
template <class Number>
HWY_INLINE void put_matrix(const Scale<Number>& m, Real (&of)[6][kLanes], int lane) {
  write(m.xx, of[0] + lane);
  write(m.xy, of[1] + lane);
  write(m.xz, of[2] + lane);
  write(m.yy, of[3] + lane);
  write(m.yz, of[4] + lane);
  write(m.zz, of[5] + lane);
}

template <class Number>
HWY_INLINE Triple<Number> from_quads(const Quad<Number>& a, const Quad<Number>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

/// m v + sum B (v - v_neighbor)
template <class Number>
HWY_INLINE Triple<Number> resisted(const GridJob& job, int block, int lane, const Quad<Number>& own) {
  const auto* from = reinterpret_cast<const Real*>(job.from);
  const Number mass = get<Number>(job.grid->mass[block].of + lane);
  Triple<Number> sum = {mass * own.x, mass * own.y, mass * own.z};
  for (std::uint32_t e = job.grid->first_lane[block]; e < job.grid->first_lane[block + 1]; ++e) {
    const NeighborLanes& neighbor = job.grid->neighbors[e];
    Quad<Number> other;
    read_quad(from, neighbor.record + lane, other);
    const Triple<Number> b = matrix_at<Number>(neighbor.resist, lane).times(from_quads(own, other));
    sum = {sum.x + b.x, sum.y + b.y, sum.z + b.z};
  }
  return sum;
}

/// Adds a . b to the sums of the job.
template <class Number>
HWY_INLINE void add_product(const GridJob& job, int lane, const Triple<Number>& a, const Triple<Number>& b) {
  if (job.sums != nullptr) write(get<Number>(job.sums->of + lane) + dot(a, b), job.sums->of + lane);
}

template <class Number>
HWY_INLINE void resist_points(const GridJob& job, int block, int lane) {
  const Quad<Number> own = own_points<Number>(job.from, block, lane);
  const Triple<Number> image = resisted(job, block, lane, own);
  write_points(image, job.to, block, lane);
  add_product(job, lane, Triple<Number>{own.x, own.y, own.z}, image);
}

template <class Number>
HWY_INLINE void begin_points(const GridJob& job, int block, int lane) {
  const Quad<Number> r = own_points<Number>(job.residual, block, lane);
  const Scale<Number> s = matrix_at<Number>(job.grid->inverse[block].of, lane);
  write_points(s.times(Triple<Number>{r.x, r.y, r.z}), job.to, block, lane);
}

template <class Number>
HWY_INLINE Triple<Number> left_over(const GridJob& job, int block, int lane, const Quad<Number>& own) {
  const Quad<Number> r = own_points<Number>(job.residual, block, lane);
  const Triple<Number> image = resisted(job, block, lane, own);
  return {r.x - image.x, r.y - image.y, r.z - image.z};
}

template <class Number>
HWY_INLINE void leave_points(const GridJob& job, int block, int lane) {
  const Quad<Number> own = own_points<Number>(job.from, block, lane);
  const Triple<Number> left = left_over(job, block, lane, own);
  const Number zero(Real(0));
  const auto moves = above(get<Number>(job.grid->mass[block].of + lane), zero);
  write_points(
      Triple<Number>{choose(moves, left.x, zero), choose(moves, left.y, zero), choose(moves, left.z, zero)},
      job.to, block, lane);
}

template <class Number>
HWY_INLINE void smooth_points(const GridJob& job, int block, int lane) {
  const Quad<Number> own = own_points<Number>(job.from, block, lane);
  const Scale<Number> s = matrix_at<Number>(job.grid->inverse[block].of, lane);
  const Triple<Number> step = s.times(left_over(job, block, lane, own));
  const Triple<Number> v = {own.x + step.x, own.y + step.y, own.z + step.z};
  write_points(v, job.to, block, lane);
  if (job.sums == nullptr) return;
  const Quad<Number> r = own_points<Number>(job.residual, block, lane);
  add_product(job, lane, Triple<Number>{r.x, r.y, r.z}, v);
}

/// kSmoothing (m + sum B)^-1 by the factors L D L^T. A pivot below a share of the mass, which rounding of
/// stiff rows may leave, counts as that share.
template <class Number>
HWY_INLINE void invert_points(const GridJob& job, int block, int lane) {
  const Number mass = get<Number>(job.grid->mass[block].of + lane);
  const Number zero(Real(0)), one(Real(1));
  Scale<Number> a = {mass, zero, zero, mass, zero, mass};
  for (std::uint32_t e = job.grid->first_lane[block]; e < job.grid->first_lane[block + 1]; ++e) {
    const Scale<Number> b = matrix_at<Number>(job.grid->neighbors[e].resist, lane);
    a = {a.xx + b.xx, a.xy + b.xy, a.xz + b.xz, a.yy + b.yy, a.yz + b.yz, a.zz + b.zz};
  }
  const auto moves = above(mass, zero);
  const Number least = choose(moves, Number(Real(0.5)) * mass, one);
  const Number i1 = quotient(one, larger(a.xx, least));
  const Number l21 = a.xy * i1;
  const Number l31 = a.xz * i1;
  const Number i2 = quotient(one, larger(a.yy - l21 * a.xy, least));
  const Number rest = a.yz - l31 * a.xy;
  const Number l32 = rest * i2;
  const Number i3 = quotient(one, larger(a.zz - l31 * a.xz - l32 * rest, least));
  // The inverse of L: k21 = -l21, k32 = -l32, k31 = l21 l32 - l31.
  const Number k31 = l21 * l32 - l31;
  const Number share = choose(moves, Number(kSmoothing), zero);
  const Scale<Number> inverse = {share * (i1 + l21 * l21 * i2 + k31 * k31 * i3),
                                 share * (zero - l21 * i2 - k31 * l32 * i3),
                                 share * (k31 * i3),
                                 share * (i2 + l32 * l32 * i3),
                                 share * (zero - l32 * i3),
                                 share * i3};
  put_matrix(inverse, job.grid->inverse[block].of, lane);
}

/// Makes the rows of 16 points with one neighbor each, and returns the impulses that they give the points.
template <class Number>
HWY_INLINE Triple<Number> linearize_rows(const GridJob& job, std::uint32_t entry, int lane,
                                         const Quad<Number>& x, const Quad<Number>& v,
                                         const Quad<Number>& u) {
  NeighborLanes& neighbor = job.grid->neighbors[entry];
  RowLanes& row = job.rows[entry];
  const Number zero(Real(0)), one(Real(1));
  Quad<Number> x_other, v_other, u_other;
  read_quad(reinterpret_cast<const Real*>(job.position), neighbor.record + lane, x_other);
  read_quad(reinterpret_cast<const Real*>(job.velocity), neighbor.record + lane, v_other);
  read_quad(reinterpret_cast<const Real*>(job.guess), neighbor.record + lane, u_other);
  const Triple<Number> d = from_quads(x, x_other);
  const Triple<Number> dv = from_quads(v, v_other);
  const Number l = root(dot(d, d));
  const Number inverse_l = choose(above(l, zero), quotient(one, l), zero);
  const Triple<Number> n = scaled(inverse_l, d);
  const Number rate = dot(n, dv);
  const Number most(kClothRecoverySpeed);
  const Number gain = get<Number>(row.gain + lane);
  const Number error = smaller(
      larger(get<Number>(row.bias + lane) * (l - get<Number>(row.rest_length + lane)), zero - most), most);
  // A limit acts if the row would else be longer at the end of the substep.
  const Number h(job.h);
  const Number beyond = quotient(l - get<Number>(row.limit + lane), h);
  const auto acts = above(beyond + rate + dot(n, from_quads(u, u_other)), zero);
  const Number limited = choose(acts, one, zero);
  const Number limit_gain = limited * get<Number>(row.limit_gain + lane);
  const Number limit_error = smaller(larger(beyond, zero - most), most);
  if (job.sums != nullptr) {
    const Number before = get<Number>(row.limited + lane);
    write(get<Number>(job.sums->of + lane) + (limited - before) * (limited - before), job.sums->of + lane);
  }
  write(limited, row.limited + lane);

  const Number along = gain + limit_gain;
  const Number tension = gain * error + limit_gain * limit_error;
  // h T h / l resists motion across the row; explicit where that is stable, up to 1/4 of the mass.
  const Number across = larger(tension, zero) * h * inverse_l;
  const Number answer = v.w + v_other.w;
  const Number share =
      smaller(larger(Number(Real(4)) * across * Number(Real(0.5)) * answer - one, zero), one);
  const Number turned = share * across;
  const Number only = along - turned;
  const Triple<Number> m = scaled(only, n);
  put_matrix(Scale<Number>{m.x * n.x + turned, m.x * n.y, m.x * n.z, m.y * n.y + turned, m.y * n.z,
                           m.z * n.z + turned},
             neighbor.resist, lane);
  const Number pull = only * rate + tension;
  return {zero - (pull * n.x + turned * dv.x), zero - (pull * n.y + turned * dv.y),
          zero - (pull * n.z + turned * dv.z)};
}

template <class Number>
HWY_INLINE void linearize_points(const GridJob& job, int block, int lane) {
  const Quad<Number> x = own_particles<Number>(job.position, *job.grid, block, lane);
  const Quad<Number> v = own_particles<Number>(job.velocity, *job.grid, block, lane);
  const Quad<Number> u = own_points<Number>(job.guess, block, lane);
  const Number zero(Real(0));
  Triple<Number> sum = {zero, zero, zero};
  for (std::uint32_t e = job.grid->first_lane[block]; e < job.grid->first_lane[block + 1]; ++e) {
    const Triple<Number> impulse = linearize_rows(job, e, lane, x, v, u);
    sum = {sum.x + impulse.x, sum.y + impulse.y, sum.z + impulse.z};
  }
  const auto moves = above(get<Number>(job.grid->mass[block].of + lane), zero);
  write_points(
      Triple<Number>{choose(moves, sum.x, zero), choose(moves, sum.y, zero), choose(moves, sum.z, zero)},
      job.to, block, lane);
}

template <class Number>
HWY_INLINE void run_grid(const GridJob& job) {
  const auto each = [&job](auto work) HWY_ATTR {
    for (int block = job.blocks.begin; block < job.blocks.end; ++block) {
      for (int lane = 0; lane < kLanes; lane += kLanesOf<Number>) work(block, lane);
    }
  };
  switch (job.work) {
    case GridWork::kLinearize:
      return each([&job](int block, int lane) HWY_ATTR { linearize_points<Number>(job, block, lane); });
    case GridWork::kInvert:
      return each([&job](int block, int lane) HWY_ATTR { invert_points<Number>(job, block, lane); });
    case GridWork::kResist:
      return each([&job](int block, int lane) HWY_ATTR { resist_points<Number>(job, block, lane); });
    case GridWork::kBegin:
      return each([&job](int block, int lane) HWY_ATTR { begin_points<Number>(job, block, lane); });
    case GridWork::kLeave:
      return each([&job](int block, int lane) HWY_ATTR { leave_points<Number>(job, block, lane); });
    case GridWork::kSmooth:
      return each([&job](int block, int lane) HWY_ATTR { smooth_points<Number>(job, block, lane); });
  }
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
