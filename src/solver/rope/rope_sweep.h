/// A Newton step of ropes in the Numbers of solver/simd/numbers.h. Included anew for each instruction set.
///
/// Put q = K (u_b - u_a - o) with K = E^-1 = k n n^T + b 1 into the momentum of the nodes. What is left is a
/// matrix of 3 x 3 blocks over the nodes' velocities u, in which a node is coupled to the next two: bends
/// span three nodes. Nodes are eliminated in order, in one pass with the linearization. The backward pass
/// finds u, then q.
///
/// A node has the diagonal S + K and the right side f - K o. Its block with the next node is -K + F, and its
/// block with the one behind that is c. S, F and c come from masses, contacts, bends and the nodes
/// eliminated already. k may be 1e7 times as large as S: differences of both would lose that many digits. So
/// its part of rank one is kept apart and only multiplies what is small. The same holds for the part that S
/// has from the node before. With B = F - b 1 and
///
///   P = (S + b 1)^-1,  r = P n,  t' = n + B^T r,  tau = k / (1 + k n.r),
///   eta = r.(f - b o) + n.o,   z = P (f - b o) - tau eta r                (u, if the next two nodes stood)
///
/// (without bends, where B = -b 1: t' = n - b r, -B^T z = b P (f - b o) - tau eta b r)
///
///   the next node gets      S: b 1 - B^T P B + tau t' t'^T       f: b o + tau eta n - B^T z
///   the one behind that     S: -c^2 (P - tau r r^T)              f: -c z
///   between the two         F: -c (P B - tau r t'^T)^T
///   on the way back         w = u_next - o,  g = f + b w - F u_next - c u_second,  delta = r.g - n.w,
///                           u = P g - tau delta r,  n.q = -tau delta - b n.(u - w)
///
/// A node that is held has P = 0 and its given velocity: then tau = k, eta = n.(u + o), delta = n.(u - w).

#if defined(HOOKE_SOLVER_ROPE_ROPE_SWEEP_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_ROPE_ROPE_SWEEP_H
#undef HOOKE_SOLVER_ROPE_ROPE_SWEEP_H
#else
#define HOOKE_SOLVER_ROPE_ROPE_SWEEP_H
#endif

#include "solver/rope/rope_kernels.h"
#include "solver/rope/rope_segments.h"
#include "solver/simd/symmetric_lanes.h"

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
/// a^T b, where the product is symmetric.
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

/// [v] m [v]^T, where [v] w = v x w. Adding a^2 v v^T to m adds a^2 times this to the cofactors of m.
template <class Number>
HWY_INLINE Scale<Number> across(const Triple<Number>& v, const Scale<Number>& m) {
  const Columns3<Number> columns = full(m);
  const Columns3<Number> c = {cross(v, columns.x), cross(v, columns.y), cross(v, columns.z)};  // [v] m
  const Triple<Number> x = {c.x.x, c.y.x, c.z.x};
  const Triple<Number> y = {c.x.y, c.y.y, c.z.y};
  return {v.y * x.z - v.z * x.y, v.z * x.x - v.x * x.z, v.x * x.y - v.y * x.x,
          v.z * y.x - v.x * y.z, v.x * y.y - v.y * y.x, v.x * c.y.z - v.y * c.x.z};
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

/// Sweeps over one lane, or one vector of lanes, of the ropes.
template <class Number, int kCount, bool kBends>
class RopeSweep {
 public:
  HWY_INLINE RopeSweep(double h, const RopeTraits<kCount>& traits, RopeLanes<kCount>& ropes, int lane)
      : traits_(traits),
        ropes_(ropes),
        lane_(lane),
        terms_{Number(h),
               quotient(Number(1.0), Number(h)),
               get<Number>(ropes.compliance + lane),
               quotient(Number(1.0), get<Number>(ropes.compliance + lane)),
               get<Number>(ropes.first + lane),
               get3<Number>(ropes.turning, lane),
               traits.limits},
        all_first_(!any(above(Number(1.0), terms_.first))) {}

  HWY_INLINE void run() {
    forward();
    back();
  }

 private:
  /// A node while it is eliminated: the diagonal, mass + share 1 + firm direction direction^T, and the right
  /// side.
  struct Pivot {
    Scale<Number> mass;
    Number share;
    Triple<Number> impulse;
    Number firm;
    Triple<Number> direction;
  };

  HWY_INLINE SegmentTraits<Number> traits_of(std::size_t i) const {
    const RopeTraitLanes<kCount>& row = traits_.rows[i];
    return {get<Number>(row.rest + lane_),          get<Number>(row.per_rest + lane_),
            get<Number>(row.limit + lane_),         get<Number>(row.damping + lane_),
            get<Number>(row.per_stiffness + lane_), get<Number>(row.bias + lane_),
            get<Number>(row.resistance + lane_),    get<Number>(row.lighter + lane_),
            get<Number>(row.per_lighter + lane_)};
  }

  HWY_INLINE SegmentState<Number> state_of(std::size_t i, const Triple<Number>& relative) const {
    const RopeSegmentLanes<kCount>& s = ropes_.segments[i];
    return {get3<Number>(s.line, lane_), relative, get3<Number>(s.before, lane_),
            get<Number>(s.limited + lane_), get<Number>(s.tension_bound + lane_)};
  }

  /// Gives 1 where a node moves, else 0.
  HWY_INLINE Number moves(std::size_t i) const {
    return one_if_above(get<Number>(traits_.rows[i].w + lane_), Number(0.0));
  }

  /// Adds a node's own mass and impulse, with those of its contacts and anchors.
  HWY_INLINE void add_own(std::size_t i, Pivot& pivot) const {
    const Number mass = get<Number>(traits_.rows[i].mass + lane_);
    pivot.share = pivot.share + mass;
    add(mass, get3<Number>(ropes_.nodes[i].v_free, lane_), pivot.impulse);
    if (ropes_.constrained[i] == 0) return;
    const NodeConstraintLanes<kCount>& constraint = ropes_.constraints[i];
    pivot.mass = sum(pivot.mass, get6<Number>(constraint.mass, lane_));
    pivot.impulse = sum(pivot.impulse, get3<Number>(constraint.impulse, lane_));
  }

  /// K = k n n^T + b 1, o and n.o of a segment.
  struct Segment {
    Triple<Number> n, o;
    Number n_o, k, b;
  };
  HWY_INLINE Segment linearize(std::size_t i) {
    Triple<Number> relative = {Number(0.0), Number(0.0), Number(0.0)};
    if (!all_first_) {
      relative =
          difference(get3<Number>(ropes_.nodes[i + 1].u, lane_), get3<Number>(ropes_.nodes[i].u, lane_));
    }
    const SegmentRow<Number> row = linearized(state_of(i, relative), traits_of(i), terms_, all_first_);
    RopeSegmentLanes<kCount>& segment = ropes_.segments[i];
    put3(row.n, segment.n, lane_);
    put3(row.offset, segment.offset, lane_);
    write(row.n_offset, segment.n_offset + lane_);
    write(row.across, segment.across + lane_);
    return {row.n, row.offset, row.n_offset, row.along - row.across, row.across};
  }

  /// Blocks between nodes that segments do not make: of a node and the next, of the next two, and of the
  /// outer ones.
  struct OffDiagonal {
    Columns3<Number> next, following;
    Number outer;
  };

  /// Adds the bend of the three nodes from i on.
  HWY_INLINE void add_bend(std::size_t i, Pivot& here, Pivot& next, Pivot& second,
                           OffDiagonal& off_diagonal) const {
    const RopeBendLanes<kCount>& bend = traits_.bends[i];
    const Number before = get<Number>(bend.before + lane_);
    const Number behind = get<Number>(bend.behind + lane_);
    const Number middle = Number(0.0) - (before + behind);
    const auto first = above(terms_.first, Number(0.0));
    const Number resistance =
        choose(first, get<Number>(bend.resistance + lane_), get<Number>(bend.whipping_resistance + lane_));
    const Number back = choose(first, get<Number>(bend.back + lane_), Number(0.0));
    const auto line = [&](const RopeSegmentLanes<kCount>& s) HWY_ATTR {
      return difference(get3<Number>(s.line, lane_), scaled(back, get3<Number>(s.before, lane_)));
    };
    const Triple<Number> change =
        difference(scaled(behind, line(ropes_.segments[i + 1])), scaled(before, line(ropes_.segments[i])));
    const Triple<Number> pull = scaled(get<Number>(bend.pull + lane_), change);
    const auto add_to = [&](Number weight, Pivot& pivot) HWY_ATTR {
      pivot.share = pivot.share + resistance * weight * weight;
      add(weight, pull, pivot.impulse);
    };
    add_to(before, here);
    add_to(middle, next);
    add_to(behind, second);
    add_diagonal(resistance * before * middle, off_diagonal.next);
    add_diagonal(resistance * middle * behind, off_diagonal.following);
    off_diagonal.outer = resistance * before * behind;
  }

  static HWY_INLINE void add_diagonal(Number s, Columns3<Number>& to) {
    to.x.x = to.x.x + s;
    to.y.y = to.y.y + s;
    to.z.z = to.z.z + s;
  }
  static HWY_INLINE void add_diagonal(Number s, Scale<Number>& to) {
    to.xx = to.xx + s;
    to.yy = to.yy + s;
    to.zz = to.zz + s;
  }

  HWY_INLINE void forward() {
    const Number zero(0.0);
    const Columns3<Number> no_off_diagonal = full(diagonal(zero));
    const Pivot none = {diagonal(zero), zero, {zero, zero, zero}, zero, {zero, zero, zero}};
    const std::size_t last = ropes_.nodes.size() - 1;
    Pivot here = none;
    Pivot next = none;
    Pivot second = none;
    OffDiagonal off_diagonal = {no_off_diagonal, no_off_diagonal, zero};
    for (std::size_t i = 0; i < last; ++i) {
      if constexpr (kBends) {
        if (i + 1 < last) add_bend(i, here, next, second, off_diagonal);
      }
      add_own(i, here);
      eliminate(i, linearize(i), here, next, second, off_diagonal);
      here = next;
      if constexpr (kBends) {
        next = second;
        second = none;
      }
    }
    add_own(last, here);
    const Cofactors c = cofactors_of(here, zero);
    const Triple<Number> u = scaled(quotient(Number(1.0), c.determinant), c.a.times(here.impulse));
    RopeNodeLanes<kCount>& node = ropes_.nodes[last];
    put3(choose3(moves(last), u, get3<Number>(node.v_free, lane_)), node.u, lane_);
  }

  /// Cofactors A and determinant D of a node's diagonal with b 1. S0 is its part that is not firm, A0 the
  /// cofactors of S0, D0 their determinant: A = A0 + tau [t] S0 [t]^T, D = D0 + tau t.A0 t. Behind a node
  /// that is held tau is all of k, and cofactors of the sum would be differences of numbers 1e14 times as
  /// large.
  struct Cofactors {
    Scale<Number> a;
    Number determinant;
  };
  static HWY_INLINE Cofactors cofactors_of(const Pivot& pivot, Number b) {
    Scale<Number> m = pivot.mass;
    add_diagonal(pivot.share + b, m);
    const Scale<Number> a = cofactors(m);
    return {sum(a, scaled(pivot.firm, across(pivot.direction, m))),
            determinant(m, a) + pivot.firm * dot(pivot.direction, a.times(pivot.direction))};
  }

  /// P, r and tau of a node, by one division: P = A / D, r = A n / D, tau = k D / (D + k n.A n).
  struct Inverse {
    Scale<Number> p;
    Triple<Number> r;
    Number tau;
  };
  static HWY_INLINE Inverse invert(const Pivot& pivot, const Segment& segment) {
    const auto& [n, o, n_o, k, b] = segment;
    const auto [a, d] = cofactors_of(pivot, b);
    const Triple<Number> an = a.times(n);
    const Number whole = d + k * dot(n, an);
    const Number per_both = quotient(Number(1.0), d * whole);
    const Number per_d = per_both * whole;
    return {scaled(per_d, a), scaled(per_d, an), k * d * (per_both * d)};
  }

  /// What a node leaves to the next ones: its inverse, tau eta and z.
  struct Eliminated {
    Inverse inverse;
    Number given;
    Triple<Number> z;
  };

  /// Stores what the backward pass needs, and adds what is left to the next two nodes.
  HWY_INLINE void eliminate(std::size_t i, const Segment& segment, const Pivot& here, Pivot& next,
                            Pivot& second, OffDiagonal& off_diagonal) {
    const auto& [n, o, n_o, k, b] = segment;
    RopeNodeLanes<kCount>& node = ropes_.nodes[i];
    const bool pinned = traits_.pinned[i] != 0;
    const Triple<Number>& f = here.impulse;
    auto [p, r, tau] = invert(here, segment);
    if (pinned) {
      p = scaled(moves(i), p);
      r = scaled(moves(i), r);
      tau = choose(above(moves(i), Number(0.0)), tau, k);
    }
    put6(p, node.inverse, lane_);
    put3(f, node.impulse, lane_);
    put3(r, node.along, lane_);
    write(tau, node.tau + lane_);

    const Triple<Number> free = difference(f, scaled(b, o));
    Number given = tau * (dot(r, free) + n_o);
    Triple<Number> y = p.times(free);
    if (pinned) {
      const Triple<Number> v = get3<Number>(node.v_free, lane_);
      y = choose3(moves(i), y, v);
      given = choose(above(moves(i), Number(0.0)), given, tau * (dot(n, v) + n_o));
    }
    if constexpr (kBends) {
      pass_on_bent(i, segment, {{p, r, tau}, given, difference(y, scaled(given, r))}, next, second,
                   off_diagonal);
    } else {
      const Triple<Number> t = difference(n, scaled(b, r));
      next.mass = scaled(Number(0.0) - b * b, p);
      next.firm = tau;
      next.direction = t;
      next.share = b;
      next.impulse = sum(scaled(b, sum(o, y)), scaled(given, t));
    }
  }

  /// Adds what is left of node i to the next two nodes of a rope with bends.
  HWY_INLINE void pass_on_bent(std::size_t i, const Segment& segment, const Eliminated& left, Pivot& next,
                               Pivot& second, OffDiagonal& off_diagonal) {
    const auto& [n, o, n_o, k, b] = segment;
    const auto& [inverse, given, z] = left;
    const auto& [p, r, tau] = inverse;
    RopeFillLanes<kCount>& fill = ropes_.fills[i];
    put9(off_diagonal.next, fill.next_block, lane_);
    write(off_diagonal.outer, fill.outer + lane_);
    Columns3<Number> next_block = off_diagonal.next;
    add_diagonal(Number(0.0) - b, next_block);
    const Columns3<Number> pb = product(p, next_block);
    const Triple<Number> t = sum(n, next_block.transposed_times(r));
    next.mass = difference(next.mass, symmetric_product(next_block, pb));
    next.firm = tau;
    next.direction = t;
    next.share = next.share + b;
    add(b, o, next.impulse);
    add(given, n, next.impulse);
    next.impulse = difference(next.impulse, next_block.transposed_times(z));
    const Number c = off_diagonal.outer;
    Number moving = tau;
    if (traits_.pinned[i] != 0) moving = moves(i) * tau;
    second.mass = sum(second.mass, scaled(c * c, difference(square(moving, r), p)));
    take(c, z, second.impulse);
    add_fill(c, pb, scaled(tau, r), t, off_diagonal.following);
    off_diagonal = {off_diagonal.following, full(diagonal(Number(0.0))), Number(0.0)};
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
    Results results = {zero, zero, next.x + next.y + next.z};
    for (std::size_t i = last; i-- > 0;) {
      RopeNodeLanes<kCount>& node = ropes_.nodes[i];
      const RopeSegmentLanes<kCount>& segment = ropes_.segments[i];
      const Triple<Number> n = get3<Number>(segment.n, lane_);
      const Number b = get<Number>(segment.across + lane_);
      const Triple<Number> r = get3<Number>(node.along, lane_);
      const Triple<Number> w = difference(next, get3<Number>(segment.offset, lane_));
      Triple<Number> f = get3<Number>(node.impulse, lane_);
      if constexpr (kBends) {
        f = difference(f, get9<Number>(ropes_.fills[i].next_block, lane_).times(next));
        take(get<Number>(ropes_.fills[i].outer + lane_), second, f);
      }
      const Triple<Number> pushed = sum(f, scaled(b, w));
      const Number n_w = dot(n, w);
      const Number tau = get<Number>(node.tau + lane_);
      Number drawn = tau * (dot(r, pushed) - n_w);
      Triple<Number> u = difference(get6<Number>(node.inverse, lane_).times(pushed), scaled(drawn, r));
      if (traits_.pinned[i] != 0) {
        const Triple<Number> v = get3<Number>(node.v_free, lane_);
        u = choose3(moves(i), u, v);
        drawn = choose(above(moves(i), zero), drawn, tau * (dot(n, v) - n_w));
      }
      put3(u, node.u, lane_);
      results.sum = results.sum + (u.x + u.y + u.z);
      const Number n_y = dot(n, u) - n_w;
      const Number pull = zero - (drawn + b * n_y);
      check_segment(i, pull, get<Number>(segment.n_offset + lane_) - n_y, difference(next, u), results);
      second = next;
      next = u;
    }
    write(results.error, ropes_.error + lane_);
    write(results.changed, ropes_.limits_changed + lane_);
    write(zero * results.sum, ropes_.finite + lane_);
  }

  struct Results {
    Number error, changed;
    Number sum;  ///< Sum of all velocities' components: finite if they are.
  };

  HWY_INLINE void check_segment(std::size_t i, Number pull, Number opening, const Triple<Number>& relative,
                                Results& results) {
    RopeSegmentLanes<kCount>& segment = ropes_.segments[i];
    write(pull, segment.pull + lane_);
    const SegmentState<Number> at = state_of(i, relative);
    SegmentCheck<Number> check = checked(at, traits_of(i), pull, opening, terms_);
    if (traits_.pinned[i] != 0 && traits_.pinned[i + 1] != 0) {
      // Between two nodes that do not move, any length is right.
      const Number zero(0.0);
      const auto either_moves = above(moves(i) + moves(i + 1), zero);
      check.error = choose(either_moves, check.error, zero);
      check.limit_changed = choose(either_moves, check.limit_changed, zero);
      check.limited = choose(either_moves, check.limited, at.limited);
    }
    write(check.tension_bound, segment.tension_bound + lane_);
    results.error = larger(check.error, results.error);
    if (!traits_.limits) return;
    write(check.limited, segment.limited + lane_);
    results.changed = larger(check.limit_changed, results.changed);
  }

  const RopeTraits<kCount>& traits_;
  RopeLanes<kCount>& ropes_;
  int lane_;
  RopeTerms<Number> terms_;
  bool all_first_;
};

template <class Number, int kCount>
HWY_INLINE void solve_rope_lanes(double h, const RopeTraits<kCount>& traits, RopeLanes<kCount>& ropes) {
  for (int lane = 0; lane < kCount; lane += kLanesOf<Number>) {
    if (traits.bends.empty()) {
      RopeSweep<Number, kCount, false>(h, traits, ropes, lane).run();
    } else {
      RopeSweep<Number, kCount, true>(h, traits, ropes, lane).run();
    }
  }
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
