#include "solver/surface/rope_loads.h"

#include "solver/surface/row_view.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hooke::solver {

namespace {

class LoadLister {
 public:
  LoadLister(const state::Tables& tables, Real h, SurfaceContacts& contacts)
      : t_(tables), h_(h), c_(contacts) {}

  void list(SurfaceGroup& group) {
    const auto presses = [&](const RowView& row) { return has_rope(row) && closes(row, t_, h_, c_); };
    share_out_rows(t_, group, c_, presses);
    for_rows(group, [&](const RowView& row, std::uint32_t block) {
      if (presses(row)) add(row, block);
    });
  }

 private:
  [[nodiscard]] bool is_rope(std::uint32_t vertex) const {
    return c_.surfaces.meshes[c_.surfaces.mesh_of[vertex]].is_rope();
  }
  [[nodiscard]] bool has_rope(const RowView& row) const {
    return is_rope(row.vertex(0)) || is_rope(row.vertex(3));
  }
  [[nodiscard]] const state::VelocityRecord& velocity(std::uint32_t vertex) const {
    return t_.particles.velocity[c_.surfaces.particle[vertex]];
  }

  /// Adds the loads of the points of ropes in a row. A vertex shares its mass among the rows that it is in.
  void add(const RowView& row, std::uint32_t block) {
    for (const bool first : {true, false}) {
      Real inverse = Real(0);
      Vec3 surface;
      for (std::size_t k = 0; k < RowView::kVertices; ++k) {
        if (row.is_first_side(k) == first) continue;
        const state::VelocityRecord& other = velocity(row.vertex(k));
        const Real w = std::abs(row.weight(k));
        inverse += w * w * other.inverse_mass * std::max(c_.load_share[row.vertex(k)], Real(1));
        surface += w * other.v;
      }
      const Real separation = std::max(separation_of(row, t_, c_), Real(0));
      for (std::size_t k = 0; k < RowView::kVertices; ++k) {
        const std::uint32_t vertex = row.vertex(k);
        if (row.is_first_side(k) != first || row.weight(k) == Real(0) || !is_rope(vertex)) continue;
        const std::uint32_t particle = c_.surfaces.particle[vertex];
        c_.loads.push_back({.particle = particle,
                            .block = block,
                            .lane = row.lane,
                            .first_side = first,
                            .share = std::abs(row.weight(k)),
                            .inverse_mass = inverse,
                            .normal = (first ? Real(1) : Real(-1)) * row.normal(),
                            .surface = surface,
                            .separation = separation});
      }
    }
  }

  const state::Tables& t_;
  Real h_;
  SurfaceContacts& c_;
};

}  // namespace

void list_rope_loads(const state::Tables& tables, Real h, SurfaceContacts& contacts) {
  contacts.loads.clear();
  contacts.load_order.clear();
  if (!contacts.active) return;
  LoadLister lister(tables, h, contacts);
  contacts.for_groups([&](SurfaceGroup& group) {
    group.first_load = static_cast<std::uint32_t>(contacts.loads.size());
    if (group.known && group.any_rope) lister.list(group);
    group.end_load = static_cast<std::uint32_t>(contacts.loads.size());
  });
  for (std::uint32_t i = 0; i < contacts.loads.size(); ++i)
    contacts.load_order.push_back({contacts.loads[i].particle, i});
  std::sort(contacts.load_order.begin(), contacts.load_order.end());
}

void apply_rope_loads(SurfaceContacts& contacts, SurfaceGroup& group) {
  for (std::uint32_t i = group.first_load; i < group.end_load;) {
    const RopeLoad& load = contacts.loads[i];
    SurfaceRowBlock& block = group.rows[load.block];
    const RowView row = {block, load.lane};
    // Impulses with which the first and the second side were solved.
    std::array<Real, 2> impulse = {};
    std::array<bool, 2> solved = {};
    for (; i < group.end_load && contacts.loads[i].block == load.block && contacts.loads[i].lane == load.lane;
         ++i) {
      const RopeLoad& one = contacts.loads[i];
      const std::size_t side = one.first_side ? 0 : 1;
      impulse[side] += one.impulse;
      solved[side] = solved[side] || one.solved;
    }
    if (!solved[0] && !solved[1]) continue;
    const Real both =
        solved[0] && solved[1] ? Real(0.5) * (impulse[0] + impulse[1]) : impulse[0] + impulse[1];
    block.pushed[load.lane] = both;
    // Lanes without a row repeat the last one in all.
    for (int lane = block.count; lane < kLanes; ++lane) block.pushed[lane] = block.pushed[block.count - 1];
    for (std::size_t k = 0; k < RowView::kVertices; ++k) {
      const Real missing = both - impulse[row.is_first_side(k) ? 0 : 1];
      state::VelocityRecord& record = contacts.velocity[row.vertex(k)];
      record.v += (row.weight(k) * record.inverse_mass * missing) * row.normal();
    }
  }
  group.first_load = group.end_load = 0;
}

}  // namespace hooke::solver
