/// The search for contacts of surfaces, and the check of pairs, in the Numbers of solver/simd/numbers.h.
/// Included anew for each instruction set.

#if defined(HOOKE_SOLVER_SURFACE_SURFACE_LANES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_SURFACE_SURFACE_LANES_H
#undef HOOKE_SOLVER_SURFACE_SURFACE_LANES_H
#else
#define HOOKE_SOLVER_SURFACE_SURFACE_LANES_H
#endif

#include "solver/simd/numbers.h"
#include "solver/surface/surface_kernels.h"
#include "solver/surface/surface_tuning.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <hwy/highway.h>
#include <utility>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

/// How boxes are compared: one with one, one with four, and two with two, each of which gives four bits.
template <class Number>
struct BoxTests {
  static HWY_INLINE bool overlap(const SurfaceBox& a, const SurfaceBox& b) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(a.lower[k] + b.negated_upper[k] <= Real(0)) || !(b.lower[k] + a.negated_upper[k] <= Real(0)))
        return false;
    }
    return true;
  }
  static HWY_INLINE unsigned overlap_four(const SurfaceBox& a, const SurfaceBox4& b) {
    unsigned bits = 0;
    for (unsigned lane = 0; lane < 4; ++lane) {
      bool all = true;
      for (std::size_t k = 0; k < 3; ++k) {
        all = all && a.lower[k] + b.negated_upper[k][lane] <= Real(0) &&
              b.lower[k][lane] + a.negated_upper[k] <= Real(0);
      }
      bits |= all ? 1U << lane : 0U;
    }
    return bits;
  }
  /// Bit 2 i + j tells whether child i of a overlaps child j of b.
  static HWY_INLINE unsigned overlap_children(const SurfaceBox4& a, const SurfaceBox4& b) {
    unsigned bits = 0;
    for (unsigned lane = 0; lane < 4; ++lane) {
      bool all = true;
      for (std::size_t k = 0; k < 3; ++k) {
        all = all && a.lower[k][lane / 2] + b.negated_upper[k][lane] <= Real(0) &&
              b.lower[k][lane] + a.negated_upper[k][lane / 2] <= Real(0);
      }
      bits |= all ? 1U << lane : 0U;
    }
    return bits;
  }
};

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
    if (!Tests::overlap(s_.boxes_a->nodes[0], s_.boxes_b->nodes[0])) return;
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
  static constexpr std::uint32_t kRoom = 512;       // Candidates in a batch.
  static constexpr std::uint32_t kMostOfPair = 64;  // Candidates that one pair of cells can have.

  struct Batch {
    alignas(64) std::uint32_t record[4][kRoom + kLanes];
    std::uint32_t feature[2][kRoom];
    std::uint8_t turned[kRoom];  // The first feature is of the second surface.
    std::uint32_t count = 0;
  };

  HWY_INLINE void push(std::uint32_t a, std::uint32_t b) { stack_[depth_++] = {a, b}; }

  /// The bits of lanes that hold one of `count` features. A box without bounds, of a point that flies off,
  /// overlaps empty lanes, too.
  static HWY_INLINE unsigned lanes_of(std::uint32_t count) { return count < 4 ? (1U << count) - 1U : 15U; }

  /// Goes on below two nodes that overlap.
  HWY_INLINE void visit(std::uint32_t a, std::uint32_t b) {
    const SurfaceNode& node_a = s_.mesh_a->nodes[a];
    const SurfaceNode& node_b = s_.mesh_b->nodes[b];
    const bool leaf_a = node_a.left == SurfaceNode::kLeaf;
    const bool leaf_b = node_b.left == SurfaceNode::kLeaf;
    if (leaf_a && leaf_b) return test_cells(node_a.right, node_b.right);
    if (leaf_a) {
      const unsigned bits = Tests::overlap_four(s_.boxes_a->nodes[a], s_.boxes_b->children[b]);
      if ((bits & 2U) != 0) push(a, node_b.right);
      if ((bits & 1U) != 0) push(a, node_b.left);
    } else if (leaf_b) {
      const unsigned bits = Tests::overlap_four(s_.boxes_b->nodes[b], s_.boxes_a->children[a]);
      if ((bits & 2U) != 0) push(node_a.right, b);
      if ((bits & 1U) != 0) push(node_a.left, b);
    } else {
      push_children(node_a, node_b, Tests::overlap_children(s_.boxes_a->children[a], s_.boxes_b->children[b]),
                    is_self_ && a == b);
    }
  }

  /// Of a node with itself, the right child with the left one is the left with the right.
  HWY_INLINE void push_children(const SurfaceNode& a, const SurfaceNode& b, unsigned bits, bool same) {
    if ((bits & 8U) != 0) push(a.right, b.right);
    if ((bits & 4U) != 0 && !same) push(a.right, b.left);
    if ((bits & 2U) != 0) push(a.left, b.right);
    if ((bits & 1U) != 0) push(a.left, b.left);
  }

  [[nodiscard]] HWY_INLINE bool are_joined(std::uint32_t a, std::uint32_t b) const {
    return s_.joined[a] == s_.joined[b];
  }

  static HWY_INLINE void append(Batch& batch, const std::array<std::uint32_t, 4>& vertex, std::uint32_t first,
                                std::uint32_t second, bool turned) {
    const std::uint32_t i = batch.count++;
    for (std::size_t k = 0; k < 4; ++k) batch.record[k][i] = 4 * vertex[k];
    batch.feature[0][i] = first;
    batch.feature[1][i] = second;
    batch.turned[i] = turned ? 1 : 0;
  }

  /// A cell of one of the two surfaces.
  struct Side {
    const SurfaceMesh& mesh;
    const SurfaceBoxes& boxes;
    std::uint32_t cell;
  };

  /// Tests the vertices of one side with the triangles of the other; `turned` if those are of the first
  /// surface.
  HWY_INLINE void test_faces(const Side& points, const Side& faces, bool turned) {
    const SurfaceCell& a = points.mesh.cells[points.cell];
    const SurfaceCell& b = faces.mesh.cells[faces.cell];
    for (std::uint32_t i = a.first_vertex; i < a.end_vertex; ++i) {
      unsigned bits = Tests::overlap_four(points.boxes.vertices[i], faces.boxes.triangles[faces.cell]) &
                      lanes_of(b.end_triangle - b.first_triangle);
      const std::uint32_t v = points.mesh.vertices[i];
      for (std::uint32_t j = b.first_triangle; bits != 0; ++j, bits >>= 1U) {
        if ((bits & 1U) == 0) continue;
        const auto& [p, q, r] = faces.mesh.triangles[j].vertex;
        if (are_joined(v, p) || are_joined(v, q) || are_joined(v, r)) continue;
        append(faces_, {v, p, q, r}, i, j, turned);
      }
    }
  }

  HWY_INLINE void test_edges(const SurfaceCell& a, const SurfaceCell& b, bool same) {
    for (std::uint32_t i = a.first_edge; i < a.end_edge; ++i) {
      for (std::uint32_t group = 0; 4 * group < b.end_edge - b.first_edge; ++group) {
        unsigned bits =
            Tests::overlap_four(s_.boxes_a->edges[i], s_.boxes_b->edge_groups[b.first_group + group]) &
            lanes_of(b.end_edge - b.first_edge - 4 * group);
        const auto& [p, q] = s_.mesh_a->edges[i].vertex;
        for (std::uint32_t j = b.first_edge + 4 * group; bits != 0; ++j, bits >>= 1U) {
          if ((bits & 1U) == 0 || (same && j <= i)) continue;
          const auto& [r, t] = s_.mesh_b->edges[j].vertex;
          if (are_joined(p, r) || are_joined(p, t) || are_joined(q, r) || are_joined(q, t)) continue;
          append(edges_, {p, q, r, t}, i, j, false);
        }
      }
    }
  }

  HWY_INLINE void test_cells(std::uint32_t a, std::uint32_t b) {
    const SurfaceCell& cell_a = s_.mesh_a->cells[a];
    const SurfaceCell& cell_b = s_.mesh_b->cells[b];
    const bool same = is_self_ && a == b;
    if (std::max(faces_.count, edges_.count) + kMostOfPair > kRoom) flush();
    const Side side_a = {*s_.mesh_a, *s_.boxes_a, a};
    const Side side_b = {*s_.mesh_b, *s_.boxes_b, b};
    test_faces(side_a, side_b, false);
    if (!same) test_faces(side_b, side_a, true);
    test_edges(cell_a, cell_b, same);
  }

  HWY_INLINE void flush() {
    narrow<1>(faces_, s_.face_near);
    narrow<2>(edges_, s_.edge_near);
  }

  template <int kFirstSide>
  HWY_INLINE void narrow(Batch& batch, Real near) {
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
  HWY_INLINE void narrow_lanes(const Batch& batch, std::uint32_t i, Real near) {
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

  /// Whether other features speak for a pair that is only near: where the nearest points are ends of edges,
  /// or an edge or a corner that another triangle owns.
  template <int kFirstSide>
  HWY_INLINE bool is_left_to_others(const Batch& batch, std::uint32_t i, const Real (&lane)[9][kLanes],
                                    std::uint32_t j) const {
    unsigned zeros = 0;
    for (unsigned k = 0; k < 4; ++k) zeros |= lane[5 + k][j] == Real(0) ? 1U << k : 0U;
    if (zeros == 0) return false;
    if constexpr (kFirstSide == 2) return !s_.mesh_a->is_rope() && !s_.mesh_b->is_rope();
    const SurfaceMesh& mesh = batch.turned[i] != 0 ? *s_.mesh_a : *s_.mesh_b;
    const SurfaceTriangle& triangle = mesh.triangles[batch.feature[1][i]];
    for (unsigned k = 0; k < 3; ++k) {
      const unsigned next = (k + 1) % 3;
      if (zeros == 1U << (k + 1)) return (triangle.owns_edge >> next & 1U) == 0;
      if (zeros == (14U & ~(1U << (k + 1)))) {
        if ((triangle.owns_vertex >> k & 1U) == 0) return true;
        const SurfaceMesh& points = batch.turned[i] != 0 ? *s_.mesh_b : *s_.mesh_a;
        return batch.record[0][i] > 4 * triangle.vertex[k] && !points.is_rope();
      }
    }
    return false;
  }

  template <int kFirstSide>
  HWY_INLINE void emit(const Batch& batch, std::uint32_t i, const Nearest<Number>& nearest, Number gap,
                       Number flags) {
    alignas(64) Real lane[9][kLanes];
    write(flags, lane[0]);
    write(gap, lane[1]);
    write(nearest.normal.x, lane[2]);
    write(nearest.normal.y, lane[3]);
    write(nearest.normal.z, lane[4]);
    for (int k = 0; k < 4; ++k) write(nearest.weight[k], lane[5 + k]);
    const std::uint32_t count = std::min<std::uint32_t>(kLanesOf<Number>, batch.count - i);
    for (std::uint32_t j = 0; j < count; ++j) {
      if (!(lane[0][j] > Real(0))) continue;
      if (lane[0][j] == Real(SurfaceFound::kNear) && is_left_to_others<kFirstSide>(batch, i + j, lane, j))
        continue;
      if (found_.size() == kMostFound) return;
      SurfaceFound& found = found_.emplace_back();
      for (std::size_t k = 0; k < 4; ++k) {
        found.vertex[k] = batch.record[k][i + j] / 4;
        found.weight[k] = lane[5 + k][j];
      }
      found.normal = {lane[2][j], lane[3][j], lane[4][j]};
      found.gap = lane[1][j];
      found.flags = static_cast<std::uint32_t>(lane[0][j]);
      found.first_feature = batch.feature[0][i + j];
      found.second_feature = batch.feature[1][i + j];
      const bool turned = batch.turned[i + j] != 0;
      found.first_mesh = turned ? s_.number_b : s_.number_a;
      found.second_mesh = turned ? s_.number_a : s_.number_b;
      found.is_edges = kFirstSide == 2;
    }
  }

  const SurfaceSearch& s_;
  std::vector<SurfaceFound>& found_;
  bool is_self_;
  Batch faces_, edges_;
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
HWY_INLINE bool measure_pair_blocks(std::span<SurfacePairBlock> blocks, Real slack,
                                    const state::PositionRecord* positions) {
  const auto* position = reinterpret_cast<const Real*>(positions);
  bool any_near = false;
  for (SurfacePairBlock& block : blocks) {
    for (int lane = 0; lane < block.count; lane += kLanesOf<Number>) {
      const Number now = distance_now<Number, kFirstSide>(block, lane, position);
      write(now, block.now + lane);
      const Number least = get<Number>(block.least + lane) + Number(slack);
      any_near = any(above(least, now)) || any_near;
    }
  }
  return any_near;
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
