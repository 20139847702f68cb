/// A Newton step of ropes in numbers.h's Numbers. Included anew for each instruction set.
///
/// With q = K (u_b - u_a - o), K = E^-1 = k n n^T + b 1, put into the momentum of the nodes, what is left is
/// a matrix of 3 x 3 blocks over the nodes' velocities u, in which a node meets the next two: bends span
/// three nodes. Nodes are eliminated in order, in one pass with the linearization; the way back finds u, then
/// q.
///
/// A node with the diagonal S + K and the right side f - K o meets the next by -K + F and the one behind that
/// by c; S, F and c are of masses, contacts, bends and of what is eliminated already. k may be 1e7 times as
/// large as S: differences of both would lose that many digits. So its rank of one is kept apart, and only
/// multiplies what is small. With B = F - b 1 and
///
///   P = (S + b 1)^-1,  r = P n,  t = n - b r,  t' = n + B^T r,  tau = k / (1 + k n.r),
///   eta = r.f + t.o,   z = P (f - b o) - tau eta r                        (u, if the next two nodes stood)
///
///   the next node gets      S: b 1 - B^T P B + tau t' t'^T       f: b o + tau eta n - B^T z
///   the one behind that     S: -c^2 (P - tau r r^T)              f: -c z
///   between the two         F: -c (P B - tau r t'^T)^T
///   on the way back         w = u_next - o,  x = F u_next + c u_second,  delta = r.f - t.w - r.x,
///                           u = P (f + b w - x) - tau delta r,  q = -tau delta n - b (u - w)
///
/// A node that is held has P = 0 and its velocity: then tau = k, eta = n.(u + o), delta = n.(u - w).

#if defined(HOOKE_SOLVER_WIDE_ROPE_SWEEP_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_WIDE_ROPE_SWEEP_H
#undef HOOKE_SOLVER_WIDE_ROPE_SWEEP_H
#else
#define HOOKE_SOLVER_WIDE_ROPE_SWEEP_H
#endif

#include "solver/wide/rope_segments.h"
#include "solver/wide/ropes.h"
#include "solver/wide/scales.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

/// Columns of a matrix.
template <class Number>
struct Columns3 {
  Triple<Number> x, y, z;

  HWY_INLINE Triple<Number> times(const Triple<Number>& v) const {
    return {x.x * v.x + y.x * v.y + z.x * v.z, x.y * v.x + y.y * v.y + z.y * v.z,
            x.z * v.x + y.z * v.y + z.z * v.z};
  }
  HWY_INLINE Triple<Number> transposed_times(const Triple<Number>& v) const {
    return {dot(x, v), dot(y, v), dot(z, v)};
  }
};

template <class Number>
HWY_INLINE Columns3<Number> full(const Scale<Number>& m) {
  return {{m.xx, m.xy, m.xz}, {m.xy, m.yy, m.yz}, {m.xz, m.yz, m.zz}};
}
template <class Number>
HWY_INLINE Columns3<Number> product(const Scale<Number>& a, const Columns3<Number>& b) {
  return {a.times(b.x), a.times(b.y), a.times(b.z)};
}
/// a^T b of what is symmetric.
template <class Number>
HWY_INLINE Scale<Number> symmetric_product(const Columns3<Number>& a, const Columns3<Number>& b) {
  return {dot(a.x, b.x), dot(a.x, b.y), dot(a.x, b.z), dot(a.y, b.y), dot(a.y, b.z), dot(a.z, b.z)};
}
/// s v v^T
template <class Number>
HWY_INLINE Scale<Number> square(Number s, const Triple<Number>& v) {
  const Triple<Number> w = scaled(s, v);
  return {w.x * v.x, w.x * v.y, w.x * v.z, w.y * v.y, w.y * v.z, w.z * v.z};
}
template <class Number>
HWY_INLINE Scale<Number> difference(const Scale<Number>& a, const Scale<Number>& b) {
  return {a.xx - b.xx, a.xy - b.xy, a.xz - b.xz, a.yy - b.yy, a.yz - b.yz, a.zz - b.zz};
}

template <class Number, std::size_t kCount>
HWY_INLINE Scale<Number> get6(const double (&from)[6][kCount], int i) {
  return {get<Number>(from[0] + i), get<Number>(from[1] + i), get<Number>(from[2] + i),
          get<Number>(from[3] + i), get<Number>(from[4] + i), get<Number>(from[5] + i)};
}
template <class Number, std::size_t kCount>
HWY_INLINE void put6(const Scale<Number>& m, double (&to)[6][kCount], int i) {
  write(m.xx, to[0] + i);
  write(m.xy, to[1] + i);
  write(m.xz, to[2] + i);
  write(m.yy, to[3] + i);
  write(m.yz, to[4] + i);
  write(m.zz, to[5] + i);
}
template <class Number, std::size_t kCount>
HWY_INLINE Columns3<Number> get9(const double (&from)[3][3][kCount], int i) {
  return {get3<Number>(from[0], i), get3<Number>(from[1], i), get3<Number>(from[2], i)};
}
template <class Number, std::size_t kCount>
HWY_INLINE void put9(const Columns3<Number>& m, double (&to)[3][3][kCount], int i) {
  put3(m.x, to[0], i);
  put3(m.y, to[1], i);
  put3(m.z, to[2], i);
}

/// One lane, or vector of lanes, of the ropes.
template <class Number, int kCount, bool kBends>
class RopeSweep {
 public:
  HWY_INLINE RopeSweep(double h, RopeLanes<kCount>& ropes, int lane)
      : ropes_(ropes),
        lane_(lane),
        terms_{Number(h), quotient(Number(1.0), Number(h)),
               quotient(Number(1.0), get<Number>(ropes.compliance + lane)), get<Number>(ropes.first + lane),
               get3<Number>(ropes.turning, lane)} {}

  HWY_INLINE void run() {
    forward();
    back();
  }

 private:
  /// A node while it is eliminated: the diagonal and the right side.
  struct Pivot {
    Scale<Number> mass;
    Triple<Number> impulse;

    HWY_INLINE void add(const Pivot& other) {
      mass = sum(mass, other.mass);
      impulse = sum(impulse, other.impulse);
    }
  };

  HWY_INLINE SegmentState<Number> state_of(std::size_t i, const Triple<Number>& relative) const {
    const RopeNodeLanes<kCount>& a = ropes_.nodes[i];
    const RopeNodeLanes<kCount>& b = ropes_.nodes[i + 1];
    const RopeSegmentLanes<kCount>& s = ropes_.segments[i];
    return {difference(get3<Number>(b.x, lane_), get3<Number>(a.x, lane_)),
            relative,
            difference(get3<Number>(b.v_before, lane_), get3<Number>(a.v_before, lane_)),
            get<Number>(s.rest + lane_),
            get<Number>(s.stiffness + lane_),
            get<Number>(s.damping + lane_),
            get<Number>(s.limit + lane_),
            get<Number>(s.lighter + lane_),
            get<Number>(s.limited + lane_),
            get<Number>(s.tension_bound + lane_)};
  }

  HWY_INLINE Pivot load_pivot(std::size_t i) const {
    if (ropes_.held[i] != 0) {
      const RopeHoldLanes<kCount>& hold = ropes_.holds[i];
      return {get6<Number>(hold.mass, lane_), get3<Number>(hold.impulse, lane_)};
    }
    const RopeNodeLanes<kCount>& node = ropes_.nodes[i];
    const Number mass = get<Number>(node.mass + lane_);
    return {diagonal(mass), scaled(mass, get3<Number>(node.v_free, lane_))};
  }

  /// K = k n n^T + b 1 and o of a segment.
  struct Segment {
    Triple<Number> n, o;
    Number k, b;
  };
  HWY_INLINE Segment linearize(std::size_t i) {
    const Triple<Number> relative =
        difference(get3<Number>(ropes_.nodes[i + 1].u, lane_), get3<Number>(ropes_.nodes[i].u, lane_));
    const SegmentRow<Number> row = linearized(state_of(i, relative), terms_);
    RopeSegmentLanes<kCount>& segment = ropes_.segments[i];
    put3(row.n, segment.n, lane_);
    put3(row.offset, segment.offset, lane_);
    write(row.along, segment.along + lane_);
    write(row.across, segment.across + lane_);
    return {row.n, row.offset, row.along - row.across, row.across};
  }

  /// How nodes meet but for segments: a node and the next, the next two, and the outer ones.
  struct Meeting {
    Columns3<Number> next, following;
    Number outer;
  };

  /// The bend of the three nodes from i on.
  HWY_INLINE void add_bend(std::size_t i, Pivot (&pivots)[3], Meeting& meeting) const {
    const RopeBendLanes<kCount>& bend = ropes_.bends[i];
    const Number weights[3] = {
        get<Number>(bend.before + lane_),
        Number(0.0) - (get<Number>(bend.before + lane_) + get<Number>(bend.behind + lane_)),
        get<Number>(bend.behind + lane_)};
    const Number grip = get<Number>(bend.grip + lane_);
    const Triple<Number> x[3] = {get3<Number>(ropes_.nodes[i].x, lane_),
                                 get3<Number>(ropes_.nodes[i + 1].x, lane_),
                                 get3<Number>(ropes_.nodes[i + 2].x, lane_)};
    const Triple<Number> change =
        difference(scaled(weights[2], difference(x[2], x[1])), scaled(weights[0], difference(x[1], x[0])));
    const Triple<Number> pull = scaled(get<Number>(bend.pull + lane_), change);
    for (int k = 0; k < 3; ++k)
      pivots[k].add({diagonal(grip * weights[k] * weights[k]), scaled(weights[k], pull)});
    add_diagonal(grip * weights[0] * weights[1], meeting.next);
    add_diagonal(grip * weights[1] * weights[2], meeting.following);
    meeting.outer = grip * weights[0] * weights[2];
  }

  static HWY_INLINE void add_diagonal(Number s, Columns3<Number>& to) {
    to.x.x = to.x.x + s;
    to.y.y = to.y.y + s;
    to.z.z = to.z.z + s;
  }

  HWY_INLINE void forward() {
    const Number zero(0.0);
    const Columns3<Number> none = full(diagonal(zero));
    const std::size_t last = ropes_.nodes.size() - 1;
    Pivot pivots[3] = {load_pivot(0), load_pivot(1), {}};
    Meeting meeting = {none, none, zero};
    for (std::size_t i = 0; i < last; ++i) {
      pivots[2] = i + 1 < last ? load_pivot(i + 2) : Pivot{diagonal(zero), {zero, zero, zero}};
      if constexpr (kBends) {
        if (i + 1 < last) add_bend(i, pivots, meeting);
      }
      const Segment segment = linearize(i);
      eliminate(ropes_.nodes[i], segment, pivots, meeting);
      pivots[0] = pivots[1];
      pivots[1] = pivots[2];
    }
    RopeNodeLanes<kCount>& node = ropes_.nodes[last];
    const Number moves = one_if_above(get<Number>(node.w + lane_), zero);
    put3(choose3(moves, inverse(pivots[0].mass).times(pivots[0].impulse), get3<Number>(node.v_free, lane_)),
         node.u, lane_);
  }

  /// Notes what the way back needs; adds what is left to the next two nodes.
  HWY_INLINE void eliminate(RopeNodeLanes<kCount>& node, const Segment& segment, Pivot (&pivots)[3],
                            Meeting& meeting) {
    const auto& [n, o, k, b] = segment;
    const Triple<Number>& f = pivots[0].impulse;
    const Triple<Number> v = get3<Number>(node.v_free, lane_);
    const Number moves = one_if_above(get<Number>(node.w + lane_), Number(0.0));
    const Scale<Number> p = scaled(moves, inverse(sum(pivots[0].mass, diagonal(b))));
    const Triple<Number> r = p.times(n);
    const Number tau = quotient(k, Number(1.0) + k * dot(n, r));
    put6(p, node.inverse, lane_);
    put3(f, node.impulse, lane_);
    put3(r, node.along, lane_);
    write(tau, node.tau + lane_);

    const auto is_free = above(moves, Number(0.0));
    const Triple<Number> t = difference(n, scaled(b, r));
    const Number eta = choose(is_free, dot(r, f) + dot(t, o), dot(n, sum(v, o)));
    const Triple<Number> z =
        choose3(moves, difference(p.times(difference(f, scaled(b, o))), scaled(tau * eta, r)), v);
    const Triple<Number> given = sum(scaled(b, o), scaled(tau * eta, n));
    if constexpr (kBends) {
      put9(meeting.next, node.meets, lane_);
      write(meeting.outer, node.outer + lane_);
      Columns3<Number> meets = meeting.next;
      add_diagonal(Number(0.0) - b, meets);
      const Columns3<Number> pb = product(p, meets);
      const Triple<Number> t_bent = sum(n, meets.transposed_times(r));
      pivots[1].add({sum(difference(diagonal(b), symmetric_product(meets, pb)), square(tau, t_bent)),
                     difference(given, meets.transposed_times(z))});
      const Number c = meeting.outer;
      const Scale<Number> far = difference(p, square(moves * tau, r));
      pivots[2].add({scaled(Number(0.0) - c * c, far), scaled(Number(0.0) - c, z)});
      add_fill(c, pb, scaled(tau, r), t_bent, meeting.following);
      meeting = {meeting.following, full(diagonal(Number(0.0))), Number(0.0)};
    } else {
      pivots[1].add(
          {sum(difference(diagonal(b), scaled(b * b, p)), square(tau, t)), sum(given, scaled(b, z))});
    }
  }

  /// f -= c (P B - tau r t'^T)^T
  static HWY_INLINE void add_fill(Number c, const Columns3<Number>& pb, const Triple<Number>& r,
                                  const Triple<Number>& t, Columns3<Number>& f) {
    take(c, Triple<Number>{pb.x.x - t.x * r.x, pb.y.x - t.y * r.x, pb.z.x - t.z * r.x}, f.x);
    take(c, Triple<Number>{pb.x.y - t.x * r.y, pb.y.y - t.y * r.y, pb.z.y - t.z * r.y}, f.y);
    take(c, Triple<Number>{pb.x.z - t.x * r.z, pb.y.z - t.y * r.z, pb.z.z - t.z * r.z}, f.z);
  }

  HWY_INLINE void back() {
    const Number zero(0.0);
    const std::size_t last = ropes_.nodes.size() - 1;
    Triple<Number> next = get3<Number>(ropes_.nodes[last].u, lane_);
    Triple<Number> second = {zero, zero, zero};
    Number error = zero;
    Number changed = zero;
    Number finite = zero * (next.x + next.y + next.z);
    for (std::size_t i = last; i-- > 0;) {
      RopeNodeLanes<kCount>& node = ropes_.nodes[i];
      const RopeSegmentLanes<kCount>& segment = ropes_.segments[i];
      const Number moves = one_if_above(get<Number>(node.w + lane_), zero);
      const Triple<Number> v = get3<Number>(node.v_free, lane_);
      const Triple<Number> n = get3<Number>(segment.n, lane_);
      const Number b = get<Number>(segment.across + lane_);
      const Triple<Number> r = get3<Number>(node.along, lane_);
      const Triple<Number> w = difference(next, get3<Number>(segment.offset, lane_));
      Triple<Number> f = get3<Number>(node.impulse, lane_);
      if constexpr (kBends) {
        f = difference(f, get9<Number>(node.meets, lane_).times(next));
        take(get<Number>(node.outer + lane_), second, f);
      }
      const Number delta = choose(above(moves, zero), dot(r, f) - dot(difference(n, scaled(b, r)), w),
                                  dot(n, difference(v, w)));
      const Number pull = get<Number>(node.tau + lane_) * delta;
      const Triple<Number> pushed = sum(f, scaled(b, w));
      const Triple<Number> u =
          choose3(moves, difference(get6<Number>(node.inverse, lane_).times(pushed), scaled(pull, r)), v);
      put3(u, node.u, lane_);
      finite = finite + zero * (u.x + u.y + u.z);
      const Triple<Number> q = difference(scaled(zero - pull, n), scaled(b, difference(u, w)));
      check_segment(i, q, difference(next, u), error, changed);
      second = next;
      next = u;
    }
    write(error, ropes_.error + lane_);
    write(changed, ropes_.limits_changed + lane_);
    write(finite, ropes_.finite + lane_);
  }

  HWY_INLINE void check_segment(std::size_t i, const Triple<Number>& q, const Triple<Number>& relative,
                                Number& error, Number& changed) {
    RopeSegmentLanes<kCount>& segment = ropes_.segments[i];
    const SegmentRow<Number> row = {get3<Number>(segment.n, lane_), get3<Number>(segment.offset, lane_),
                                    get<Number>(segment.along + lane_), get<Number>(segment.across + lane_)};
    put3(q, segment.q, lane_);
    const SegmentCheck<Number> check =
        checked(state_of(i, relative), row, dot(row.n, q), get<Number>(segment.held + lane_), terms_);
    write(check.tension_bound, segment.tension_bound + lane_);
    write(check.limited, segment.limited + lane_);
    error = larger(check.error, error);
    changed = larger(check.limit_changed, changed);
  }

  RopeLanes<kCount>& ropes_;
  int lane_;
  RopeTerms<Number> terms_;
};

template <class Number, int kCount>
HWY_INLINE void solve_rope_lanes(double h, RopeLanes<kCount>& ropes) {
  for (int lane = 0; lane < kCount; lane += kLanesOf<Number>) {
    if (ropes.bends.empty()) {
      RopeSweep<Number, kCount, false>(h, ropes, lane).run();
    } else {
      RopeSweep<Number, kCount, true>(h, ropes, lane).run();
    }
  }
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
