#pragma once

#include "base/disjoint_sets.h"
#include "geometry/box.h"
#include "solver/cloth/cloth_loads.h"
#include "solver/surface/solid_pieces.h"
#include "solver/surface/surface_crossings.h"
#include "solver/surface/surface_mesh.h"
#include "solver/surface/surface_records.h"

#include <array>
#include <cstdint>
#include <vector>

namespace hooke::solver {

/// What a group counts in a step.
struct SurfaceCounts {
  std::uint32_t searches = 0;   ///< How often contacts were found.
  std::uint32_t held_back = 0;  ///< Vertices that were held back, in all substeps.
  std::uint32_t pairs = 0;      ///< Pairs that cages did not keep apart when contacts were found last.
  std::uint32_t uncertain = 0;  ///< Pairs that touched or crossed when they were found.
  std::uint32_t crossings = 0;  ///< Edges that went through triangles when contacts were found last.
};

/// Two surfaces that go through each other.
struct SurfaceTangle {
  std::uint32_t pair = 0;  ///< Index of SurfaceGroup::pairs.
  std::vector<SurfaceCrossing> crossings;
  std::vector<std::uint32_t> passed;  ///< Vertices that are to go back.
};

/// What presses on a point of a rope in a substep: the side of a row of contact that faces it.
struct RopeLoad {
  std::uint32_t particle = 0;   ///< Row of the point.
  std::uint32_t block = 0;      ///< Block of the row in its group.
  int lane = 0;                 ///< Its lane there.
  bool first_side = true;       ///< Whether the rope is the first side of the row.
  Real share = Real(0);         ///< Weight of the point in the row.
  Real inverse_mass = Real(0);  ///< That of the other side along any direction [1/kg]; 0 if it is held.
  Vec3 normal = {};             ///< Unit vector from the other side to the rope.
  Vec3 surface = {};            ///< Velocity of the other side [m/s].
  Real separation = Real(0);    ///< Distance to go until the row acts [m], not negative.
  Real impulse = Real(0);       ///< With which the rope was solved [N s].
  bool solved = false;          ///< Whether the rope was solved with it.
};

/// Surfaces that may touch each other, one or more, with what was found between them. Groups share no
/// particle, and what one does has no influence on another.
struct SurfaceGroup {
  std::vector<std::uint32_t> meshes;                ///< In ascending order.
  std::vector<std::array<std::uint32_t, 2>> pairs;  ///< Meshes that may touch; twice the same for one that
                                                    ///< touches itself.
  bool known = false;                               ///< What stands below was found in this step.
  bool overflows = false;      ///< More pairs were found than there is room for: nothing of it moves.
  bool held = false;           ///< Some vertex is pinned: the group has no motion of its own.
  DVec3 origin = {};           ///< Origin of the positions of its vertices [m].
  Real reserve = Real(0);      ///< Rounding of these positions [m].
  DVec3 displacement = {};     ///< Motion of the group since contacts were found [m].
  Vec3 displacement_now = {};  ///< Its motion in this substep [m].
  int substeps_left = 0;       ///< Particle substeps for which cages were made.
  std::vector<SurfaceRowBlock> rows;
  std::vector<SurfaceRowBlock> spent_rows;  ///< Solved in this substep, until others were found.
  std::vector<SurfaceRow> stiff_rows;       ///< Those between solids that are solved as a whole.
  std::vector<SurfacePairBlock> face_pairs, edge_pairs;
  std::vector<std::vector<SurfaceFound>> found;  ///< By pair of meshes: scratch memory.
  std::vector<SurfaceTangle> tangles;            ///< In the order of pairs.
  std::vector<std::uint32_t> hot;                ///< Scratch memory: pairs that are corrected.
  std::vector<Real> speeds;                      ///< Scratch memory.
  SolidPieces pieces;                            ///< Scratch memory: of stiff solids that are corrected.
  SurfaceCounts counts;
  bool any_rope = false;                                   ///< Some of the surfaces is a rope.
  std::uint32_t first_load = 0, end_load = 0;              ///< Its rows of SurfaceContacts::loads.
  std::uint32_t first_solid_load = 0, end_solid_load = 0;  ///< Its rows of SurfaceContacts::solid_loads.
};

/// All contacts of surfaces. Nothing of it lives from step to step but memory.
struct SurfaceContacts {
  SurfaceMeshes surfaces;
  bool active = false;                         ///< Some surface may touch another, or itself.
  std::vector<geometry::Box3<double>> bounds;  ///< By mesh: where it stays until the step ends [m].
  std::vector<SurfaceBoxes> boxes;             ///< By mesh.
  std::vector<Vec3> shift;  ///< By mesh: from its object's origin to that of its group [m].
  std::vector<state::PositionRecord>
      start;  ///< By vertex: where it began the substep, from its object's origin.
  std::vector<state::PositionRecord> position;  ///< By vertex: where it is, from its group's origin.
  std::vector<state::PositionRecord>
      found_at;  ///< By vertex: where it was when contacts were found, the same.
  std::vector<state::VelocityRecord> velocity;  ///< By vertex.
  std::vector<SurfaceCage> cage;                ///< By vertex.
  std::vector<std::uint32_t> in_open_block;     ///< By vertex: bit k says that a row in open block k has it.
  std::vector<std::uint8_t> stays;              ///< By vertex: it is held back in this substep.
  std::vector<std::uint8_t> may_cross;          ///< By mesh: it is looked at for crossings in this step.
  std::vector<std::uint8_t> crosses;            ///< By mesh: scratch memory.
  std::vector<std::uint8_t> passed;             ///< By vertex: scratch memory, all zero.
  std::vector<DVec3> exact_position;            ///< By vertex: scratch memory.
  std::vector<SurfaceGroup> groups;  ///< The first `live_groups`, in the order of their first meshes.
  std::size_t live_groups = 0;
  std::vector<SurfaceGroup> next_groups;                 ///< Scratch memory.
  std::vector<std::array<std::uint32_t, 2>> next_pairs;  ///< Scratch memory.
  std::vector<std::uint32_t> order;                      ///< Scratch memory.
  base::DisjointSets sets;                               ///< Scratch memory: meshes that share a group.
  int substeps_left = 0;                                 ///< Particle substeps that the step still has.
  std::vector<std::uint8_t> touching;                    ///< By object: it is in a group.
  std::vector<std::uint8_t> stiff;      ///< By object: it is a solid that is solved as a whole.
  bool any_stiff = false;               ///< Some object is.
  bool any_rope = false;                ///< Some surface is a rope.
  bool any_cloth_and_solid = false;     ///< Some are cloths, and some are solids.
  std::vector<std::uint8_t> refreshed;  ///< By object: contacts were found anew in this substep.
  bool keeps_spent_rows = false;        ///< Whether groups are to keep their `spent_rows`.
  std::vector<RopeLoad> loads;          ///< What presses on ropes in this substep, by group and row.
  std::vector<std::array<std::uint32_t, 2>> load_order;  ///< By point: its row, and that of a load.
  std::vector<ClothLoad> solid_loads;  ///< What of solids presses on cloths, by group and row.
  std::vector<Real> load_share;  ///< By vertex: sum of its weights in rows that press, of those listed last.
  bool regroup = false;          ///< All bounds are to be made anew.

  /// Calls `visit` with each group.
  template <class Visit>
  void for_groups(Visit visit) {
    for (std::size_t i = 0; i < live_groups; ++i) visit(groups[i]);
  }
};

/// Calls `visit(vertex, mesh)` with each vertex of the group.
template <class Visit>
void for_vertices(const SurfaceContacts& contacts, const SurfaceGroup& group, Visit visit) {
  for (const std::uint32_t i : group.meshes) {
    const SurfaceMesh& mesh = contacts.surfaces.meshes[i];
    for (std::uint32_t vertex = mesh.first_vertex; vertex < mesh.end_vertex(); ++vertex) visit(vertex, i);
  }
}

/// Whether two surfaces touch each other at all, by their filters and by what they are.
[[nodiscard]] bool surfaces_touch(const state::Tables& tables, const SurfaceMeshes& surfaces, std::uint32_t a,
                                  std::uint32_t b);

/// Says anew which surfaces may meet within the rest of the step, where they leave what was expected or
/// a step begins. Groups that stay as they are keep what was found.
void refresh_surface_groups(const state::Tables& tables, Real h, SurfaceContacts& contacts);

}  // namespace hooke::solver
