#pragma once

#include "hooke/desc.h"
#include "hooke/id.h"
#include "hooke/math.h"
#include "hooke/result.h"
#include "hooke/shape.h"
#include "hooke/world.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

/// \file
/// Bodies that are broken beforehand. A solid is divided into the Voronoi cells of seeds inside it, and the
/// cells are glued where they share a face. The glue is made of hooks, so that the solver's own impulses
/// break it. docs/decisions/0045-bodies-broken-beforehand.md says why.
///
///     Fracture pieces = fracture(mesh, {.cells = 40}).value();
///     FracturedBody pane = add_fractured(world, pieces, {.kind = BodyKind::kDynamic}, 3e7f).value();

namespace hooke {

/// How a solid is divided. All places are in the frame of its mesh.
struct FractureDesc {
  int cells = 16;          ///< Number of seeds that are spread at random. [1, 4096]
  std::uint32_t seed = 1;  ///< Seed of the random numbers; any value.
  /// Places of the seeds [m], in place of `cells` random ones: 1 to 4096. They may lie outside the solid;
  /// what cell is empty then counts as merged.
  std::vector<DVec3> seeds = {};
  /// A place in or on the solid, about which the random seeds crowd [m]: cells are small there, and grow in
  /// proportion to the distance from it.
  std::optional<DVec3> impact = {};
  /// Distance from `impact` within which cells grow no smaller, as a share of the diagonal of the box around
  /// the solid. [0.001, 1]
  double impact_radius = 0.02;
  /// Cells of less than this share of the mean volume (that of the solid over the number of seeds) give their
  /// volume to their neighbors. [0, 0.5]
  double least_share = 0.05;
  /// Faces that are smaller than this share of the largest face of each of their cells are no bonds: the
  /// cells touch there and are not glued. Rigid glue at several faces shares a load with no regard to their
  /// areas, so that small ones would break first. [0, 1]
  double least_face = 0.25;
};

/// A piece of a solid.
struct FractureCell {
  /// Marks a triangle that is part of the surface of the whole solid.
  static constexpr std::uint32_t kSurface = 0xFFFFFFFF;

  MeshDesc mesh = {};  ///< Closed surface of the piece, about `center`.
  DVec3 center = {};   ///< Center of its volume in the frame of the whole [m].
  double volume = 0;   ///< Its volume, found before corners were rounded for `mesh` [m^3].
  /// For each triangle of `mesh` the cell on its other side, or kSurface: what is not kSurface is an inner
  /// face, which is seen only when the solid breaks.
  std::vector<std::uint32_t> across = {};
  std::uint32_t seed = 0;  ///< Index of the seed that the cell belongs to.
  DVec3 seed_place = {};   ///< Place of that seed, in the frame of the whole [m].
  bool is_convex = true;   ///< Whether the piece is convex, as all pieces of a convex solid are.
};

/// A face that two cells share, along which they can be glued.
struct FractureBond {
  std::uint32_t a = 0;  ///< The one cell; `a` is less than `b`.
  std::uint32_t b = 0;  ///< The other cell.
  double area = 0;      ///< Area of the face [m^2].
  DVec3 center = {};    ///< Center of the area, in the frame of the whole [m].
  DVec3 normal = {};    ///< Unit normal of the face, from `a` to `b`.
  /// Section modulus of the face [m^3]: I / c, the second moment of area about an axis through the center
  /// over the distance of the farthest corner from it; of the two principal axes the smaller value. A
  /// rectangle has b h^2 / 6, with h the shorter side.
  double section_modulus = 0;
};

/// A solid divided into cells.
struct Fracture {
  std::vector<FractureCell> cells = {};  ///< The cells, ordered by their seeds.
  std::vector<FractureBond> bonds = {};  ///< The faces between them that are glued, ordered by (a, b).
  /// Share of the area of all faces between cells that is left without a bond, by FractureDesc::least_face.
  double unbonded_share = 0;
  std::uint32_t merged =
      0;  ///< Number of seeds whose cell was empty or too small, and went to its neighbors.
  /// Number of pieces below FractureDesc::least_share that are left: parts of a cell that a concave surface
  /// cuts off.
  std::uint32_t small_pieces = 0;
};

/// Divides a solid into the Voronoi cells of seeds: each cell has the points that are nearer to its seed than
/// to any other. The same mesh and description give the same bits on every machine.
///
/// - A convex solid is cut by planes in double: the cells are convex, share their faces, and their volumes
///   sum to that of the solid to 1e-12 of it.
/// - Of any other solid each cell is the exact intersection with the solid (combine_solids), and what that
///   leaves in several pieces are several cells. Volumes sum to 1e-10. The time grows with the number of
///   seeds times that of the triangles.
/// - A cell that is too small (FractureDesc::least_share) loses its seed, and everything is divided anew.
///
/// 1000 cells of a box take 0.1 s.
///
/// Errors: a mesh that is open, inside out or crosses itself, or that has no volume (repair_solid and
/// remesh_solid help); a number out of range or not finite; an `impact` so far from the solid that no seed
/// falls into it.
[[nodiscard]] Result<Fracture> fracture(const MeshDesc& mesh, const FractureDesc& desc);

/// Index of the cell in which a place of the whole's frame lies [m], or which is nearest to it. 0 without
/// cells.
[[nodiscard]] std::size_t cell_at(const Fracture& fracture, DVec3 place);

/// Describes the body of one cell, without its mesh: that is FractureCell::mesh, a hull or, of a cell that is
/// not convex, a mesh. Position, rotation, velocities and surface are those that `whole` gives to it; the
/// mass is that of its volume, by density or as a share of BodyDesc::mass. Connection points go to the cell
/// in which they lie. `index` is below the number of cells, or
/// the description is that of no body.
[[nodiscard]] BodyDesc describe_cell(const Fracture& fracture, std::size_t index, const BodyDesc& whole);

/// Describes the glue of one bond, without its bodies: a HookKind::kFixed at the center of the face that
/// takes the force strength x area and the torque strength x section modulus, the bending moment at which the
/// stress of an elastic section reaches `strength` [Pa] at its edge. A hook judges force and torque each by
/// itself. `whole` says where the bodies are; `index` is below the number of bonds, or
/// the description is that of no hook.
[[nodiscard]] HookDesc describe_bond(const Fracture& fracture, std::size_t index, const BodyDesc& whole,
                                     Real strength);

/// The bodies that a fractured body consists of.
struct FracturedBody {
  std::vector<BodyId> bodies = {};  ///< One for each of Fracture::cells.
  std::vector<HookId> hooks = {};   ///< One for each of Fracture::bonds; stale once it has broken.
  std::vector<MeshId> meshes = {};  ///< One for each of Fracture::cells; may be removed, bodies keep them.
};

/// Adds a body that stands as one and breaks along its cells.
///
/// - `whole` describes it. Its shape and parts do not count: the cells have its place. The masses of all
///   cells sum to its mass within the rounding of one of them.
/// - `strength` is the stress at which the glue breaks [Pa], positive; with kRigid it never does.
/// - Neighbors collide with each other only when the glue between them has broken.
///
/// Errors: those of add_body and add_hook, with the number of the cell or bond; a `whole` that forces do not
/// move; a strength that is not positive. Nothing is added then.
[[nodiscard]] Result<FracturedBody> add_fractured(World& world, const Fracture& fracture,
                                                  const BodyDesc& whole, Real strength);

}  // namespace hooke
