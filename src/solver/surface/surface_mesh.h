#pragma once

#include "hooke/math.h"

#include "state/tables.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// The surfaces of deformables, as contacts between them see them: the triangles of a cloth and the outer
/// faces of a solid, with their edges and vertices; of a rope, its segments. All of it follows from what rows
/// join and from the form at rest, so that a World that was restored makes the same again, in the same order.

namespace hooke::solver {

/// Up to two triangles that share an edge, with the vertices and edges that they own, or a few segments of a
/// rope. Each vertex and each edge is owned by one cell. Rows [first, end) of the features and parts of a
/// mesh.
struct SurfaceCell {
  std::uint32_t first_vertex = 0, end_vertex = 0;
  std::uint32_t first_edge = 0, end_edge = 0;
  std::uint32_t first_triangle = 0, end_triangle = 0;
  std::uint32_t first_part = 0, end_part = 0;
};

/// Up to four vertices, four edges and two triangles of a cell, side by side, as kernels compare them with
/// those of another part. Most cells have one part.
struct alignas(16) SurfacePart {
  std::array<std::uint32_t, 4> vertex = {};
  std::array<std::array<std::uint32_t, 4>, 2> edge = {};  ///< Their ends.
  std::array<std::array<std::uint32_t, 4>, 3> triangle =
      {};  ///< Their corners; lanes 2 and 3 repeat 0 and 1.
  /// SurfaceMeshes::joined of the same vertices.
  std::array<std::uint32_t, 4> joined_vertex = {};
  std::array<std::array<std::uint32_t, 4>, 2> joined_edge = {};
  std::array<std::array<std::uint32_t, 4>, 3> joined_triangle = {};
  std::uint32_t first_vertex = 0, first_edge = 0, first_triangle = 0;  ///< Rows of the features of the mesh.
  std::uint8_t vertices = 0, edges = 0, triangles = 0;                 ///< How many it has.
};

/// A node of the tree over cells, with up to four children. Children stand after their parent. They are those
/// of two levels of a binary tree: the left ones of its children are 0 and 2.
struct SurfaceNode {
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  static constexpr std::uint32_t kCell = 0x80000000;  ///< Added to the index of a cell.

  std::array<std::uint32_t, 4> child = {kNone, kNone, kNone, kNone};  ///< Nodes and cells.
};

/// A triangle with its edges. Flags say which of its parts it speaks for, so that an edge or a corner of
/// several triangles touches once.
struct SurfaceTriangle {
  std::array<std::uint32_t, 3> vertex = {};
  std::array<std::uint32_t, 3> edge = {};  ///< Edge k joins corners k and k + 1.
  std::uint8_t owns_edge = 0;              ///< Bit k for edge k.
  std::uint8_t owns_vertex = 0;            ///< Bit k for corner k.
};

struct SurfaceEdge {
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;

  std::array<std::uint32_t, 2> vertex = {};
  std::array<std::uint32_t, 2> opposite = {kNone, kNone};  ///< Third corners of the triangles at it.
  std::uint8_t owns_vertex = 0;  ///< Bit k says that of the edges at end k this one speaks for it.
};

/// The surface of one object. Vertices are numbered through all surfaces, other parts within their surface.
struct SurfaceMesh {
  std::uint32_t object = 0;          ///< Row of the deformable.
  std::uint64_t revision = 0;        ///< Deformable::revision that this was made from.
  std::uint32_t first_particle = 0;  ///< Of the deformable.
  std::uint32_t first_vertex = 0;
  std::uint32_t vertex_count = 0;
  std::vector<std::uint32_t> vertices;  ///< In the order of cells.
  std::vector<SurfaceEdge> edges;       ///< In the order of cells.
  std::vector<SurfaceTriangle> triangles;
  std::vector<SurfaceCell> cells;
  std::vector<SurfacePart> parts;  ///< In the order of cells.
  std::vector<SurfaceNode> nodes;  ///< The first one is the root.
  /// Vertices that share an edge with each vertex: neighbors[neighbor_begin[i] .. neighbor_begin[i + 1]), i
  /// counted from first_vertex.
  std::vector<std::uint32_t> neighbor_begin;
  std::vector<std::uint32_t> neighbors;

  [[nodiscard]] std::uint32_t end_vertex() const { return first_vertex + vertex_count; }
  [[nodiscard]] bool is_rope() const { return triangles.empty(); }
  [[nodiscard]] std::span<const std::uint32_t> neighbors_of(std::uint32_t vertex) const {
    const std::uint32_t i = vertex - first_vertex;
    return std::span(neighbors).subspan(neighbor_begin[i], neighbor_begin[i + 1] - neighbor_begin[i]);
  }
};

/// The surfaces of all deformables that have one, in the order of objects.
struct SurfaceMeshes {
  std::uint64_t revision = ~std::uint64_t{0};       ///< Revision of the tables that this was made from.
  std::uint64_t hook_revision = ~std::uint64_t{0};  ///< That of hooks, from which `joined` was made.
  std::vector<SurfaceMesh> meshes;
  std::vector<std::uint32_t> particle;  ///< Row of each vertex.
  std::vector<std::uint32_t> mesh_of;   ///< Surface of each vertex.
  /// Vertices with the same number are held together by hooks, and touch each other as little as one vertex
  /// touches itself.
  std::vector<std::uint32_t> joined;
  /// Pairs of a rope and another surface that do not touch, since a hook slides along the rope or three hooks
  /// or more sew them together; each in ascending order, and all.
  std::vector<std::array<std::uint32_t, 2>> sewn;

  [[nodiscard]] std::uint32_t object_of(std::uint32_t vertex) const { return meshes[mesh_of[vertex]].object; }
};

/// Makes the surfaces anew of objects whose rows have changed, moves the others to where their objects are
/// now, and finds what hooks join. Returns whether any surface was made, came, went or was moved.
bool refresh_surfaces(const state::Tables& tables, SurfaceMeshes& surfaces);

}  // namespace hooke::solver
