#pragma once

#include "hooke/math.h"

#include "solver/simd/lanes.h"
#include "solver/surface/surface_mesh.h"
#include "state/particles.h"

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

/// \file
/// What the kernels of surfaces read and write. Positions are those of a group of surfaces, from one origin.

namespace hooke::solver {

/// Where a vertex may go until contacts are found again, relative to where it was and to the motion of its
/// group: within `room` of a line of which one end is where it was, the other `drift` away.
struct alignas(4 * sizeof(Real)) SurfaceCage {
  Vec3 drift = {};      ///< [m]
  Real room = Real(0);  ///< [m]
};

/// A box, with its upper corner negated, so that one addition and one comparison tell whether two overlap.
struct alignas(4 * sizeof(Real)) SurfaceBox {
  std::array<Real, 4> lower = {};
  std::array<Real, 4> negated_upper = {};
};

/// Four boxes side by side. Lanes without a box hold none().
struct alignas(4 * sizeof(Real)) SurfaceBox4 {
  std::array<std::array<Real, 4>, 3> lower = {};
  std::array<std::array<Real, 4>, 3> negated_upper = {};

  void set(std::size_t lane, const SurfaceBox& box) {
    for (std::size_t k = 0; k < 3; ++k) {
      lower[k][lane] = box.lower[k];
      negated_upper[k][lane] = box.negated_upper[k];
    }
  }
  /// A box that overlaps nothing, not even a box without bounds of a point that flies off.
  static SurfaceBox none() {
    constexpr Real kNot = std::numeric_limits<Real>::quiet_NaN();
    return {{kNot, kNot, kNot, Real(0)}, {kNot, kNot, kNot, Real(0)}};
  }
};

/// The boxes of the features of a part; lanes 2 and 3 of the triangles repeat 0 and 1.
struct SurfacePartBoxes {
  SurfaceBox4 vertices, edges, triangles;
};

/// The boxes of a surface: its nodes and features with all that their cages let them reach.
struct SurfaceBoxes {
  std::vector<SurfaceBox> nodes;
  std::vector<SurfaceBox4> children;  ///< By node.
  std::vector<SurfaceBox> cells;
  std::vector<SurfacePartBoxes> parts;
  std::vector<SurfaceBox> by_vertex;  ///< Scratch memory.
  std::vector<SurfaceBox> by_end;     ///< Scratch memory: those of vertices as ends of edges.
};

/// A vertex and a triangle, or two edges, that may come near each other.
struct SurfaceFound {
  static constexpr std::uint32_t kNear = 1;  ///< They are or come so near that a row may hold them apart.
  static constexpr std::uint32_t kReachable = 2;  ///< Their cages do not keep them apart.
  static constexpr std::uint32_t kUncertain = 4;  ///< The normal does not separate them beyond rounding.

  std::array<std::uint32_t, 4> vertex = {};  ///< The vertex and the corners, or the ends of the edges.
  std::array<Real, 4> weight = {};   ///< Weights of the nearest points; the second side's are negative.
  Vec3 normal = {};                  ///< Unit vector from the second side to the first.
  Real gap = Real(0);                ///< Distance of the two along the normal [m].
  std::uint32_t first_feature = 0;   ///< Index of the vertex or of the first edge in its surface.
  std::uint32_t second_feature = 0;  ///< Index of the triangle or of the second edge.
  std::uint32_t first_mesh = 0, second_mesh = 0;
  std::uint32_t flags = 0;
  Real share = Real(0);  ///< Share of the thickness that a row keeps; 0 without a row.
  bool is_edges = false;
};

/// Two surfaces, or one twice, that are searched for what may touch.
struct SurfaceSearch {
  const SurfaceMesh* mesh_a = nullptr;
  const SurfaceMesh* mesh_b = nullptr;  ///< The same as `mesh_a` for contacts within one surface.
  const SurfaceBoxes* boxes_a = nullptr;
  const SurfaceBoxes* boxes_b = nullptr;
  std::uint32_t number_a = 0, number_b = 0;         ///< Numbers of the meshes.
  const state::PositionRecord* position = nullptr;  ///< By vertex.
  const SurfaceCage* cage = nullptr;                ///< By vertex.
  Real face_near = Real(0);                         ///< Distance at which a vertex and a face are near [m].
  Real edge_near = Real(0);                         ///< The same of two edges [m].
  Real reserve = Real(0);                           ///< Rounding of positions [m].
};

/// What a row of contact says; see SurfaceRowBlock.
struct SurfaceRow {
  std::array<std::uint32_t, 4> vertex = {};
  std::array<Real, 4> weight = {};
  Vec3 normal = {};
  Real distance = Real(0);
  Real friction = Real(0);
};

/// Rows that keep vertices and triangles apart, or edges, side by side. The points sum weight x of the two
/// sides differ by the gap. Rows of a block share no vertex; lanes without a row repeat the last one.
struct alignas(64) SurfaceRowBlock {
  std::uint32_t record[4][kLanes] = {};  ///< Four times the vertices.
  Real weight[4][kLanes] = {};           ///< Those of the second side are negative.
  Real normal[3][kLanes] = {};           ///< From the second side to the first.
  Real distance[kLanes] = {};            ///< Distance that is kept [m].
  Real friction[kLanes] = {};            ///< Friction coefficient of the pair.
  Real mass[kLanes] = {};                ///< Mass that resists along any direction [kg]; 0 if nothing moves.
  Real least_speed[kLanes] = {};         ///< Least speed along the normal in this substep [m/s].
  Real pushed[kLanes] = {};              ///< Impulse along the normal in this substep [N s].
  Real rubbed[3][kLanes] = {};           ///< Impulse of friction in this substep [N s].
  std::int32_t count = 0;
};

/// Pairs that must not cross, side by side. Those of edges and those of vertices and triangles have blocks of
/// their own.
struct alignas(64) SurfacePairBlock {
  std::uint32_t record[4][kLanes] = {};  ///< Four times the vertices; unused lanes repeat the first one.
  Real normal[3][kLanes] = {};
  Real most[kLanes] = {};   ///< Distance that is kept for certain where there is room for it [m].
  Real least[kLanes] = {};  ///< Distance that is kept for certain in this substep [m].
  Real now[kLanes] = {};    ///< Distance at the positions looked at last [m].
  std::int32_t count = 0;
};

}  // namespace hooke::solver
