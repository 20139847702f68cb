/// How the boxes of surfaces are compared, in the Numbers of solver/simd/numbers.h: here for one lane, in
/// solver/surface/surface_box_vectors.h for vectors. Included anew for each instruction set.

#if defined(HOOKE_SOLVER_SURFACE_SURFACE_BOX_LANES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_SURFACE_SURFACE_BOX_LANES_H
#undef HOOKE_SOLVER_SURFACE_SURFACE_BOX_LANES_H
#else
#define HOOKE_SOLVER_SURFACE_SURFACE_BOX_LANES_H
#endif

#include "solver/surface/surface_records.h"

#include <cstdint>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

/// Pairs of features whose boxes overlap, of one kind, until their nearest points are found.
struct SurfaceCandidates {
  static constexpr std::uint32_t kRoom = 528;
  static constexpr std::uint32_t kTurned = 0x80000000;

  alignas(64) std::uint32_t record[4][kRoom + kLanes];  // Four times the vertices.
  /// Rows of the features in their surfaces. kTurned in the second says that the first is of the second
  /// surface.
  alignas(64) std::uint32_t feature[2][kRoom + kLanes];
  std::uint32_t count = 0;
};

/// A part of a cell with its boxes.
struct SurfaceSide {
  const SurfacePart& part;
  const SurfacePartBoxes& boxes;
};

/// Pairs of children of two nodes, in the order in which they are looked at: that of a walk down two binary
/// trees.
struct ChildPair {
  static constexpr unsigned first(unsigned i) { return (i >> 2U & 2U) | (i >> 1U & 1U); }
  static constexpr unsigned second(unsigned i) { return (i >> 1U & 2U) | (i & 1U); }
  /// Bits of the pairs that are looked at if both nodes are one.
  static constexpr unsigned in_one_node() {
    unsigned bits = 0;
    for (unsigned i = 0; i < 16; ++i) bits |= first(i) <= second(i) ? 1U << i : 0U;
    return bits;
  }
};

/// Bits of pairs of four edges with four others, of which 4 i + j stands for edges i and j: all of them, and
/// those of a part with itself.
constexpr unsigned kAllPairs = 0xFFFF;
constexpr unsigned kPairsOfOne = 0x08CE;

/// Which of four boxes overlap which of four others, and what follows from it.
template <class Number>
struct BoxTests {
  static HWY_INLINE bool overlap(const SurfaceBox4& a, std::size_t i, const SurfaceBox4& b, std::size_t j) {
    bool all = true;
    for (std::size_t k = 0; k < 3; ++k) {
      all = all && a.lower[k][i] + b.negated_upper[k][j] <= Real(0) &&
            b.lower[k][j] + a.negated_upper[k][i] <= Real(0);
    }
    return all;
  }

  /// Bit i tells whether a overlaps box i of b.
  static HWY_INLINE unsigned overlap_one(const SurfaceBox& a, const SurfaceBox4& b) {
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

  /// Which children of two nodes overlap: a bit for each ChildPair.
  static HWY_INLINE unsigned overlap_children(const SurfaceBox4& a, const SurfaceBox4& b) {
    unsigned bits = 0;
    for (unsigned lane = 0; lane < 16; ++lane) {
      if (overlap(a, ChildPair::first(lane), b, ChildPair::second(lane))) bits |= 1U << lane;
    }
    return bits;
  }

  /// Appends those of the pairs of edges of both sides whose boxes overlap.
  static HWY_INLINE void add_edges(const SurfaceSide& a, const SurfaceSide& b, unsigned pairs,
                                   SurfaceCandidates& to) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      for (std::uint32_t j = 0; j < 4; ++j) {
        if ((pairs >> (4 * i + j) & 1U) == 0 || !overlap(a.boxes.edges, i, b.boxes.edges, j)) continue;
        bool joined = false;
        for (std::size_t k = 0; k < 4; ++k)
          joined = joined || a.part.joined_edge[k / 2][i] == b.part.joined_edge[k % 2][j];
        if (joined) continue;
        for (std::size_t k = 0; k < 2; ++k) {
          to.record[k][to.count] = 4 * a.part.edge[k][i];
          to.record[2 + k][to.count] = 4 * b.part.edge[k][j];
        }
        to.feature[0][to.count] = a.part.first_edge + i;
        to.feature[1][to.count] = b.part.first_edge + j;
        ++to.count;
      }
    }
  }

  /// Appends the vertices of one side and the triangles of the other whose boxes overlap; the other way round
  /// too, unless the sides are one.
  static HWY_INLINE void add_faces(const SurfaceSide& a, const SurfaceSide& b, bool same,
                                   SurfaceCandidates& to) {
    add_faces_of(a, b, 0, to);
    if (!same) add_faces_of(b, a, SurfaceCandidates::kTurned, to);
  }

 private:
  static HWY_INLINE void add_faces_of(const SurfaceSide& points, const SurfaceSide& faces,
                                      std::uint32_t turned, SurfaceCandidates& to) {
    for (std::uint32_t i = 0; i < 4; ++i) {
      for (std::uint32_t j = 0; j < 2; ++j) {
        if (!overlap(points.boxes.vertices, i, faces.boxes.triangles, j)) continue;
        bool joined = false;
        for (std::size_t k = 0; k < 3; ++k)
          joined = joined || points.part.joined_vertex[i] == faces.part.joined_triangle[k][j];
        if (joined) continue;
        to.record[0][to.count] = 4 * points.part.vertex[i];
        for (std::size_t k = 0; k < 3; ++k) to.record[1 + k][to.count] = 4 * faces.part.triangle[k][j];
        to.feature[0][to.count] = points.part.first_vertex + i;
        to.feature[1][to.count] = (faces.part.first_triangle + j) | turned;
        ++to.count;
      }
    }
  }
};

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
