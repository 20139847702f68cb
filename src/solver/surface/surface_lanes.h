/// The search for contacts of surfaces, and the check of pairs, in the Numbers of solver/simd/numbers.h.
/// Included anew for each instruction set.

#if defined(HOOKE_SOLVER_SURFACE_SURFACE_LANES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_SURFACE_SURFACE_LANES_H
#undef HOOKE_SOLVER_SURFACE_SURFACE_LANES_H
#else
#define HOOKE_SOLVER_SURFACE_SURFACE_LANES_H
#endif

#include "solver/simd/numbers.h"
#include "solver/surface/surface_box_lanes.h"
#include "solver/surface/surface_kernels.h"
#include "solver/surface/surface_tuning.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <hwy/highway.h>
#include <utility>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

/// `yes` where none of the three is negative, else `no`.
template <class Number>
HWY_INLINE Number choose_not_negative(Number a, Number b, Number c, Number yes, Number no) {
  return choose(above(Number(Real(0)), smaller(a, smaller(b, c))), no, yes);
}

/// a / b, or 0 where b is not positive.
template <class Number>
HWY_INLINE Number share_of(Number a, Number b) {
  const Number zero(Real(0));
  return choose(above(b, zero), quotient(a, b), zero);
}

template <class Number>
HWY_INLINE Number clamped(Number a) {
  return smaller(larger(a, Number(Real(0))), Number(Real(1)));
}

template <class Number>
HWY_INLINE Triple<Number> choose3(Number yes_if_positive, const Triple<Number>& yes,
                                  const Triple<Number>& no) {
  const auto condition = above(yes_if_positive, Number(Real(0)));
  return {choose(condition, yes.x, no.x), choose(condition, yes.y, no.y), choose(condition, yes.z, no.z)};
}

/// `a` with the length 1, or up where it has none.
template <class Number>
HWY_INLINE Triple<Number> direction_of(const Triple<Number>& a) {
  const Number zero(Real(0));
  const Number l = root(dot(a, a));
  const Triple<Number> up = {zero, Number(Real(1)), zero};
  return choose3(l, scaled(share_of(Number(Real(1)), l), a), up);
}

/// The nearest points of two features, and the direction between them.
template <class Number>
struct Nearest {
  Triple<Number> normal;
  Number weight[4];
};

/// Of a vertex p and a triangle (a, b, c). Regions that come later win.
template <class Number>
HWY_INLINE Nearest<Number> nearest_of_face(const Triple<Number>& p, const Triple<Number>& a,
                                           const Triple<Number>& b, const Triple<Number>& c) {
  const Number zero(Real(0));
  const Number one(Real(1));
  const Triple<Number> ab = difference(b, a);
  const Triple<Number> ac = difference(c, a);
  const Triple<Number> ap = difference(p, a);
  const Number d1 = dot(ab, ap), d2 = dot(ac, ap);
  const Number across = dot(ab, ac);
  const Number d3 = d1 - dot(ab, ab), d4 = d2 - across;
  const Number d5 = d1 - across, d6 = d2 - dot(ac, ac);
  const Number vc = d1 * d4 - d3 * d2;
  const Number vb = d5 * d2 - d1 * d6;
  const Number va = d3 * d6 - d5 * d4;
  // The weights of b and c over a common denominator, so that one division serves all regions.
  Number v_part = vb, w_part = vc, whole = va + vb + vc;
  Number inside = one, on_bc = zero;
  const auto take = [&](Number x, Number y, Number z, Number new_v, Number new_w, Number new_whole) HWY_ATTR {
    v_part = choose_not_negative(x, y, z, new_v, v_part);
    w_part = choose_not_negative(x, y, z, new_w, w_part);
    whole = choose_not_negative(x, y, z, new_whole, whole);
    inside = choose_not_negative(x, y, z, zero, inside);
    on_bc = choose_not_negative(x, y, z, zero, on_bc);
  };
  const Number from_b = d4 - d3, from_c = d5 - d6;
  take(zero - va, from_b, from_c, from_c, from_b, from_b + from_c);
  on_bc = one - inside;
  take(zero - vb, d2, zero - d6, zero, d2, d2 - d6);
  take(zero - vc, d1, zero - d3, d1, zero, d1 - d3);
  take(d6, d6 - d5, one, zero, one, one);
  take(d3, d3 - d4, one, one, zero, one);
  take(zero - d1, zero - d2, one, zero, zero, one);
  const Number w = share_of(w_part, whole);
  // On the edge from b to c the weight of a is to be exactly zero.
  const Number v = choose(above(on_bc, zero), one - w, share_of(v_part, whole));

  const Triple<Number> face = cross(ab, ac);
  const Number side = dot(face, ap);
  const Triple<Number> turned = choose3(zero - side, scaled(zero - one, face), face);
  const Triple<Number> between = difference(ap, sum(scaled(v, ab), scaled(w, ac)));
  inside = choose(above(dot(face, face), zero), inside, zero);
  return {direction_of(choose3(inside, turned, between)), {one, v + w - one, zero - v, zero - w}};
}

/// Of the edges (a, b) and (c, d).
template <class Number>
HWY_INLINE Nearest<Number> nearest_of_edges(const Triple<Number>& a, const Triple<Number>& b,
                                            const Triple<Number>& c, const Triple<Number>& d) {
  const Number zero(Real(0));
  const Number one(Real(1));
  const Triple<Number> u = difference(b, a);
  const Triple<Number> v = difference(d, c);
  const Triple<Number> r = difference(a, c);
  const Number uu = dot(u, u), vv = dot(v, v), uv = dot(u, v);
  const Number ur = dot(u, r), vr = dot(v, r);
  const Number scale = uu * vv;
  const Number sine = scale - uv * uv;
  // Edges that are parallel within 0.6 degrees have no direction across both.
  const Number turned = sine - Number(Real(1e-4)) * scale;
  Number s = choose(above(turned, zero), clamped(share_of(uv * vr - ur * vv, sine)), zero);
  const Number t_free = share_of(uv * s + vr, vv);
  const Number s_of_end = clamped(share_of(choose(above(zero, t_free), zero, uv) - ur, uu));
  s = choose(above(zero, t_free * (one - t_free)), s_of_end, s);
  const Number t = clamped(t_free);
  const Triple<Number> between = difference(sum(r, scaled(s, u)), scaled(t, v));
  const Triple<Number> across = cross(u, v);
  const Triple<Number> normal = choose3(zero - dot(across, r), scaled(zero - one, across), across);
  const Number inside = smaller(smaller(s * (one - s), t * (one - t)), turned);
  return {direction_of(choose3(inside, normal, between)), {one - s, s, t - one, zero - t}};
}

template <class Number>
HWY_INLINE Triple<Number> position_at(const Real* base, const std::uint32_t* record) {
  Quad<Number> q;
  read_quad(base, record, q);
  return {q.x, q.y, q.z};
}

/// Finds the pairs of two surfaces: a walk down both trees, then batches of candidates over lanes.
template <class Number>
class SurfaceSearcher {
 public:
  SurfaceSearcher(const SurfaceSearch& search, std::vector<SurfaceFound>& found)
      : s_(search), found_(found), is_self_(search.mesh_a == search.mesh_b) {}

  HWY_INLINE void run() {
    push(0, 0);
    while (depth_ > 0) {
      const auto [a, b] = stack_[--depth_];
      visit(a, b);
    }
    flush();
  }

 private:
  using Tests = BoxTests<Number>;

  static constexpr int kDeepest = 256;
  static constexpr std::uint32_t kMostOfPair =
      64;  // Candidates that one pair of cells has, but of torn ropes.
  static constexpr std::uint32_t kMostOfParts = 16;  // Candidates that one pair of parts can have.
  static constexpr std::uint32_t kCell = SurfaceNode::kCell;

  HWY_INLINE void push(std::uint32_t a, std::uint32_t b) { stack_[depth_++] = {a, b}; }

  /// Goes on below two nodes or cells that overlap. What is to come first is pushed last.
  HWY_INLINE void visit(std::uint32_t a, std::uint32_t b) {
    if ((a & b & kCell) != 0) return test_cells(a & ~kCell, b & ~kCell);
    if ((a & kCell) != 0) {
      const unsigned bits = Tests::overlap_one(s_.boxes_a->cells[a & ~kCell], s_.boxes_b->children[b]);
      for (unsigned lane = 4; lane-- > 0;) {
        if ((bits >> lane & 1U) != 0) push(a, s_.mesh_b->nodes[b].child[lane]);
      }
    } else if ((b & kCell) != 0) {
      const unsigned bits = Tests::overlap_one(s_.boxes_b->cells[b & ~kCell], s_.boxes_a->children[a]);
      for (unsigned lane = 4; lane-- > 0;) {
        if ((bits >> lane & 1U) != 0) push(s_.mesh_a->nodes[a].child[lane], b);
      }
    } else {
      unsigned bits = Tests::overlap_children(s_.boxes_a->children[a], s_.boxes_b->children[b]);
      if (is_self_ && a == b) bits &= ChildPair::in_one_node();
      push_children(s_.mesh_a->nodes[a], s_.mesh_b->nodes[b], bits);
    }
  }

  HWY_INLINE void push_children(const SurfaceNode& a, const SurfaceNode& b, unsigned bits) {
    while (bits != 0) {
      const auto lane = static_cast<unsigned>(std::bit_width(bits)) - 1U;
      bits ^= 1U << lane;
      push(a.child[ChildPair::first(lane)], b.child[ChildPair::second(lane)]);
    }
  }

  HWY_INLINE void test_cells(std::uint32_t a, std::uint32_t b) {
    const SurfaceCell& cell_a = s_.mesh_a->cells[a];
    const SurfaceCell& cell_b = s_.mesh_b->cells[b];
    const bool same = is_self_ && a == b;
    if (std::max(faces_.count, edges_.count) + kMostOfPair + kMostOfParts > SurfaceCandidates::kRoom) flush();
    for (std::uint32_t i = cell_a.first_part; i < cell_a.end_part; ++i) {
      const std::uint32_t first = same ? i : cell_b.first_part;
      for (std::uint32_t j = first; j < cell_b.end_part; ++j) {
        const SurfaceSide side_b = {s_.mesh_b->parts[j], s_.boxes_b->parts[j]};
        make_room_in(faces_);
        Tests::add_faces({s_.mesh_a->parts[i], s_.boxes_a->parts[i]}, side_b, same && i == j, faces_);
      }
      if (cell_b.end_part - cell_b.first_part == 1) {
        test_edges(i, first, same, kAllPairs);
        continue;
      }
      // Each edge is compared with all of the other cell before the next one is.
      for (unsigned edge = 0; edge < 4; ++edge) {
        for (std::uint32_t j = first; j < cell_b.end_part; ++j)
          test_edges(i, j, same && i == j, 15U << 4U * edge);
      }
    }
  }

  /// Cells of a torn rope may have any number of parts, and more candidates than others.
  HWY_INLINE void make_room_in(const SurfaceCandidates& batch) {
    if (batch.count + kMostOfParts > SurfaceCandidates::kRoom) flush();
  }

  HWY_INLINE void test_edges(std::uint32_t a, std::uint32_t b, bool same, unsigned pairs) {
    const SurfaceSide side_b = {s_.mesh_b->parts[b], s_.boxes_b->parts[b]};
    make_room_in(edges_);
    Tests::add_edges({s_.mesh_a->parts[a], s_.boxes_a->parts[a]}, side_b, same ? pairs & kPairsOfOne : pairs,
                     edges_);
  }

  HWY_INLINE void flush() {
    narrow<1>(faces_, s_.face_near);
    narrow<2>(edges_, s_.edge_near);
  }

  template <int kFirstSide>
  HWY_INLINE void narrow(SurfaceCandidates& batch, Real near) {
    // Lanes behind the last candidate repeat it.
    for (std::uint32_t i = batch.count; batch.count > 0 && i % kLanes != 0; ++i) {
      for (std::size_t k = 0; k < 4; ++k) batch.record[k][i] = batch.record[k][batch.count - 1];
    }
    for (std::uint32_t i = 0; i < batch.count; i += kLanesOf<Number>)
      narrow_lanes<kFirstSide>(batch, i, near);
    batch.count = 0;
  }

  /// `kFirstSide` vertices are the first side of the pair.
  template <int kFirstSide>
  HWY_INLINE void narrow_lanes(const SurfaceCandidates& batch, std::uint32_t i, Real near) {
    const auto* position = reinterpret_cast<const Real*>(s_.position);
    const auto* cages = reinterpret_cast<const Real*>(s_.cage);
    const Number zero(Real(0));
    Triple<Number> x[4];
    for (int k = 0; k < 4; ++k) x[k] = position_at<Number>(position, batch.record[k] + i);
    Nearest<Number> nearest;
    if constexpr (kFirstSide == 1) {
      nearest = nearest_of_face(x[0], x[1], x[2], x[3]);
    } else {
      nearest = nearest_of_edges(x[0], x[1], x[2], x[3]);
    }
    const Triple<Number>& n = nearest.normal;
    Number gap = zero, cage_gap = zero, side = zero, cage_side = zero;
    Number displacement = zero;
    for (int k = 0; k < 4; ++k) {
      Quad<Number> cage;
      read_quad(cages, batch.record[k] + i, cage);
      const Number at = dot(n, x[k]);
      const Number drift = dot(n, Triple<Number>{cage.x, cage.y, cage.z});
      displacement = displacement + nearest.weight[k] * drift;
      if (k < kFirstSide) {
        const Number least = at + smaller(drift, zero) - cage.w;
        gap = k == 0 ? at : smaller(gap, at);
        cage_gap = k == 0 ? least : smaller(cage_gap, least);
      } else {
        const Number most = at + larger(drift, zero) + cage.w;
        side = k == kFirstSide ? at : larger(side, at);
        cage_side = k == kFirstSide ? most : larger(cage_side, most);
      }
    }
    gap = gap - side;
    cage_gap = cage_gap - cage_side;
    const Number nearly = smaller(gap, gap + displacement);
    const Number flags = choose(above(Number(near), nearly), Number(Real(1)), zero) +
                         choose(above(cage_gap, Number(Real(4) * s_.reserve)), zero, Number(Real(2))) +
                         choose(above(gap, Number(s_.reserve)), zero, Number(Real(4)));
    if (!any(above(flags, zero))) return;
    emit<kFirstSide>(batch, i, nearest, gap, flags);
  }

  static HWY_INLINE bool is_turned(const SurfaceCandidates& batch, std::uint32_t i) {
    return (batch.feature[1][i] & SurfaceCandidates::kTurned) != 0;
  }
  static HWY_INLINE std::uint32_t second_of(const SurfaceCandidates& batch, std::uint32_t i) {
    return batch.feature[1][i] & ~SurfaceCandidates::kTurned;
  }

  /// Whether other features speak for a pair that is only near: where the nearest points are ends of edges,
  /// or an edge or a corner that another triangle owns.
  template <int kFirstSide>
  HWY_INLINE bool is_left_to_others(const SurfaceCandidates& batch, std::uint32_t i,
                                    const Real (&lane)[9][kLanes], std::uint32_t j) const {
    unsigned zeros = 0;
    for (unsigned k = 0; k < 4; ++k) zeros |= lane[5 + k][j] == Real(0) ? 1U << k : 0U;
    if (zeros == 0) return false;
    if constexpr (kFirstSide == 2) return !s_.mesh_a->is_rope() && !s_.mesh_b->is_rope();
    const SurfaceMesh& mesh = is_turned(batch, i) ? *s_.mesh_a : *s_.mesh_b;
    const SurfaceTriangle& triangle = mesh.triangles[second_of(batch, i)];
    for (unsigned k = 0; k < 3; ++k) {
      const unsigned next = (k + 1) % 3;
      if (zeros == 1U << (k + 1)) return (triangle.owns_edge >> next & 1U) == 0;
      if (zeros == (14U & ~(1U << (k + 1)))) {
        if ((triangle.owns_vertex >> k & 1U) == 0) return true;
        const SurfaceMesh& points = is_turned(batch, i) ? *s_.mesh_b : *s_.mesh_a;
        return batch.record[0][i] > 4 * triangle.vertex[k] && !points.is_rope();
      }
    }
    return false;
  }

  template <int kFirstSide>
  HWY_INLINE void emit(const SurfaceCandidates& batch, std::uint32_t i, const Nearest<Number>& nearest,
                       Number gap, Number flags) {
    alignas(64) Real lane[9][kLanes];
    write(flags, lane[0]);
    write(gap, lane[1]);
    write(nearest.normal.x, lane[2]);
    write(nearest.normal.y, lane[3]);
    write(nearest.normal.z, lane[4]);
    for (int k = 0; k < 4; ++k) write(nearest.weight[k], lane[5 + k]);
    const std::uint32_t count = std::min<std::uint32_t>(kLanesOf<Number>, batch.count - i);
    SurfaceFound all[kLanes];
    std::size_t size = 0;
    for (std::uint32_t j = 0; j < count; ++j) {
      if (!(lane[0][j] > Real(0))) continue;
      if (lane[0][j] == Real(SurfaceFound::kNear) && is_left_to_others<kFirstSide>(batch, i + j, lane, j))
        continue;
      SurfaceFound& found = all[size++];
      for (std::size_t k = 0; k < 4; ++k) {
        found.vertex[k] = batch.record[k][i + j] / 4;
        found.weight[k] = lane[5 + k][j];
      }
      found.normal = {lane[2][j], lane[3][j], lane[4][j]};
      found.gap = lane[1][j];
      found.flags = static_cast<std::uint32_t>(lane[0][j]);
      found.first_feature = batch.feature[0][i + j];
      found.second_feature = second_of(batch, i + j);
      const bool turned = is_turned(batch, i + j);
      found.first_mesh = turned ? s_.number_b : s_.number_a;
      found.second_mesh = turned ? s_.number_a : s_.number_b;
      found.is_edges = kFirstSide == 2;
    }
    size = std::min(size, kMostFound - found_.size());
    found_.insert(found_.end(), all, all + size);
  }

  const SurfaceSearch& s_;
  std::vector<SurfaceFound>& found_;
  bool is_self_;
  SurfaceCandidates faces_, edges_;
  std::pair<std::uint32_t, std::uint32_t> stack_[kDeepest];  // Pairs of nodes that overlap.
  int depth_ = 0;
};

/// How far apart pairs are along their normals, from the nearest vertices of both sides.
template <class Number, int kFirstSide>
HWY_INLINE Number distance_now(const SurfacePairBlock& block, int lane, const Real* position) {
  const Triple<Number> n = get3<Number>(block.normal, lane);
  Number first(Real(0)), second(Real(0));
  for (int k = 0; k < 4; ++k) {
    const Number at = dot(n, position_at<Number>(position, block.record[k] + lane));
    if (k < kFirstSide) {
      first = k == 0 ? at : smaller(first, at);
    } else {
      second = k == kFirstSide ? at : larger(second, at);
    }
  }
  return first - second;
}

template <class Number, int kFirstSide>
HWY_INLINE bool measure_pair_blocks(std::span<SurfacePairBlock> blocks, Real certain,
                                    const state::PositionRecord* positions) {
  const auto* position = reinterpret_cast<const Real*>(positions);
  bool any_near = false;
  for (SurfacePairBlock& block : blocks) {
    for (int lane = 0; lane < block.count; lane += kLanesOf<Number>) {
      if (certain > Real(0)) {
        const Number kept = Number(kKeptOfGap) * get<Number>(block.now + lane);
        write(larger(Number(certain), smaller(kept, get<Number>(block.most + lane))), block.least + lane);
      }
      const Number now = distance_now<Number, kFirstSide>(block, lane, position);
      write(now, block.now + lane);
      any_near = any(above(get<Number>(block.least + lane), now)) || any_near;
    }
  }
  return any_near;
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
