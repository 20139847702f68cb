#pragma once

#include "solver/surface/surface_groups.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace hooke::solver {

/// One row of a block.
struct RowView {
  static constexpr std::size_t kVertices = 4;

  const SurfaceRowBlock& block;
  int lane;

  [[nodiscard]] std::uint32_t vertex(std::size_t k) const { return block.record[k][lane] / 4; }
  [[nodiscard]] Real weight(std::size_t k) const { return block.weight[k][lane]; }
  [[nodiscard]] bool is_first_side(std::size_t k) const { return weight(k) > Real(0); }
  [[nodiscard]] Vec3 normal() const {
    return {block.normal[0][lane], block.normal[1][lane], block.normal[2][lane]};
  }
};

/// Calls `visit(row, number of its block)` with each row of a group.
template <class Visit>
void for_rows(const SurfaceGroup& group, Visit visit) {
  for (std::uint32_t i = 0; i < group.rows.size(); ++i) {
    for (int lane = 0; lane < group.rows[i].count; ++lane) visit(RowView{group.rows[i], lane}, i);
  }
}

/// Gap beyond the distance that the row keeps [m]. SurfaceContacts::shift is that of this substep.
inline Real separation_of(const RowView& row, const state::Tables& tables, const SurfaceContacts& contacts) {
  const SurfaceMeshes& surfaces = contacts.surfaces;
  Vec3 between;
  for (std::size_t k = 0; k < RowView::kVertices; ++k) {
    const std::uint32_t vertex = row.vertex(k);
    const Vec3 x =
        tables.particles.position[surfaces.particle[vertex]].x + contacts.shift[surfaces.mesh_of[vertex]];
    between += row.weight(k) * x;
  }
  return dot(row.normal(), between) - row.block.distance[row.lane];
}

/// Whether the row may act in this substep of `h` [s].
inline bool closes(const RowView& row, const state::Tables& tables, Real h, const SurfaceContacts& contacts) {
  constexpr Real kMargin = Real(0.05);  // Over the distance that is kept.
  Vec3 relative;
  for (std::size_t k = 0; k < RowView::kVertices; ++k) {
    const std::uint32_t particle = contacts.surfaces.particle[row.vertex(k)];
    relative += row.weight(k) * tables.particles.velocity[particle].v;
  }
  const Real approach = std::max(-dot(row.normal(), relative) * h, Real(0));
  return separation_of(row, tables, contacts) < approach + kMargin * row.block.distance[row.lane];
}

/// Notes how many rows that press share each vertex, by their weights. Sets SurfaceContacts::shift of the
/// group. Rows for which `presses(row)` holds count.
template <class Presses>
void share_out_rows(const state::Tables& tables, const SurfaceGroup& group, SurfaceContacts& contacts,
                    Presses presses) {
  for_vertices(contacts, group, [&](std::uint32_t vertex, std::uint32_t mesh) {
    contacts.load_share[vertex] = Real(0);
    const DVec3 origin = tables.objects[contacts.surfaces.meshes[mesh].object].origin;
    contacts.shift[mesh] = vector_cast<Real>(origin - group.origin);
  });
  for_rows(group, [&](const RowView& row, std::uint32_t) {
    if (!presses(row)) return;
    for (std::size_t k = 0; k < RowView::kVertices; ++k)
      contacts.load_share[row.vertex(k)] += row.is_first_side(k) ? row.weight(k) : -row.weight(k);
  });
}

}  // namespace hooke::solver
