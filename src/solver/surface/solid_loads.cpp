#include "solver/surface/solid_loads.h"

#include "solver/surface/row_view.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace hooke::solver {

namespace {

class SolidLoadLister {
 public:
  SolidLoadLister(const state::Tables& tables, Real h, SurfaceContacts& contacts)
      : t_(tables), h_(h), c_(contacts) {}

  void list(SurfaceGroup& group) {
    group.pieces.clear();
    const auto presses = [&](const RowView& row) { return joins_both(row) && closes(row, t_, h_, c_); };
    share_out_rows(t_, group, c_, presses);
    for_rows(group, [&](const RowView& row, std::uint32_t block) {
      if (presses(row)) add(group, row, block);
    });
  }

 private:
  [[nodiscard]] PointRef::Kind kind_of(std::uint32_t vertex) const {
    return t_.objects[c_.surfaces.object_of(vertex)].kind;
  }
  /// Whether a row is between a cloth and a solid.
  [[nodiscard]] bool joins_both(const RowView& row) const {
    const PointRef::Kind first = kind_of(row.vertex(0));
    const PointRef::Kind second = kind_of(row.vertex(RowView::kVertices - 1));
    return (first == PointRef::Kind::kCloth && second == PointRef::Kind::kSolid) ||
           (first == PointRef::Kind::kSolid && second == PointRef::Kind::kCloth);
  }

  /// Whether a solid weighs on cloths as a whole, of which `particle` is one: it is in one piece, nothing
  /// pins it, and a wave goes from its middle to its rim within the substep.
  [[nodiscard]] bool is_whole(SurfaceGroup& group, std::uint32_t solid, std::uint32_t particle) {
    if (solid == known_solid_) return known_is_whole_;
    known_solid_ = solid;
    known_is_whole_ = c_.stiff[solid] != 0 && group.pieces.piece_at(t_, solid, particle).inverse_mass > 0 &&
                      is_one_piece(group, solid, particle) && waves_cross(solid);
    return known_is_whole_;
  }
  [[nodiscard]] bool is_one_piece(SurfaceGroup& group, std::uint32_t solid, std::uint32_t particle) const {
    const SolidPiece piece = group.pieces.piece_at(t_, solid, particle);
    const state::Rows rows = t_.objects[solid].particles;
    for (std::uint32_t row = rows.first; row < rows.end(); ++row) {
      if (!group.pieces.has(t_, piece, row)) return false;
    }
    return true;
  }
  /// Its modulus is three times that of shear at most, and its radius of gyration is half of its size at
  /// most.
  [[nodiscard]] bool waves_cross(std::uint32_t solid) const {
    double stiffness = 0;  // Modulus times volume.
    const state::Rows rows = t_.objects[solid].tetrahedra;
    for (std::uint32_t row = rows.first; row < rows.end(); ++row) {
      const auto modulus = 3 * static_cast<double>(t_.tetrahedra.shear_modulus[row]);
      stiffness += modulus * static_cast<double>(t_.tetrahedra.volume[row]);
    }
    const math::Symmetric3<double> inertia = whole_solid(solid, t_).inertia;
    const auto h = static_cast<double>(h_);
    return h * h * stiffness > 0.5 * (inertia.xx + inertia.yy + inertia.zz);
  }

  /// A vertex of a solid shares its mass among the rows that it is in.
  void add(SurfaceGroup& group, const RowView& row, std::uint32_t block) {
    ClothLoad load = {.block = block,
                      .lane = row.lane,
                      .cloth_is_first = kind_of(row.vertex(0)) == PointRef::Kind::kCloth,
                      .friction = static_cast<double>(row.block.friction[row.lane])};
    std::size_t points = 0;
    std::uint32_t of_solid = 0;
    for (std::size_t k = 0; k < RowView::kVertices; ++k) {
      const std::uint32_t vertex = row.vertex(k);
      const std::uint32_t particle = c_.surfaces.particle[vertex];
      const auto w = static_cast<double>(std::abs(row.weight(k)));
      if (w == 0) continue;
      if (row.is_first_side(k) == load.cloth_is_first) {
        load.object = c_.surfaces.object_of(vertex);
        load.particle[points] = particle;
        load.weight[points++] = w;
        continue;
      }
      const state::VelocityRecord& solid = t_.particles.velocity[particle];
      load.solid = c_.surfaces.object_of(vertex);
      of_solid = particle;
      load.place += w * vector_cast<double>(t_.particles.position[particle].x);
      load.inverse_mass += w * w * static_cast<double>(solid.inverse_mass) *
                           std::max(static_cast<double>(c_.load_share[vertex]), 1.0);
      load.surface += w * vector_cast<double>(solid.v);
    }
    load.normal = (load.cloth_is_first ? 1.0 : -1.0) * vector_cast<double>(row.normal());
    load.separation = static_cast<double>(std::max(separation_of(row, t_, c_), Real(0)));
    load.is_whole = is_whole(group, load.solid, of_solid);
    if (points > 0) c_.solid_loads.push_back(load);
  }

  const state::Tables& t_;
  Real h_;
  SurfaceContacts& c_;
  std::uint32_t known_solid_ = std::numeric_limits<std::uint32_t>::max();
  bool known_is_whole_ = false;  ///< Of that solid.
};

/// Calls `visit(load, row)` with each load of a group that cloths may be solved with.
template <class Visit>
void for_loads(SurfaceContacts& contacts, const SurfaceGroup& group, Visit visit) {
  for (std::uint32_t i = group.first_solid_load; i < group.end_solid_load; ++i) {
    ClothLoad& load = contacts.solid_loads[i];
    if (!load.is_left) visit(load, RowView{group.rows[load.block], load.lane});
  }
}

}  // namespace

bool may_load_cloths(const state::Tables& tables, const SurfaceContacts& contacts,
                     const SurfaceGroup& group) {
  const auto has = [&](PointRef::Kind kind) {
    return std::any_of(group.meshes.begin(), group.meshes.end(), [&](std::uint32_t mesh) {
      return tables.objects[contacts.surfaces.meshes[mesh].object].kind == kind;
    });
  };
  return has(PointRef::Kind::kCloth) && has(PointRef::Kind::kSolid);
}

void list_solid_loads(const state::Tables& tables, Real h, SurfaceContacts& contacts) {
  contacts.solid_loads.clear();
  if (!contacts.active) return;
  SolidLoadLister lister(tables, h, contacts);
  contacts.for_groups([&](SurfaceGroup& group) {
    group.first_solid_load = static_cast<std::uint32_t>(contacts.solid_loads.size());
    if (group.known && may_load_cloths(tables, contacts, group)) lister.list(group);
    group.end_solid_load = static_cast<std::uint32_t>(contacts.solid_loads.size());
  });
}

void note_solid_motion(const state::Tables& tables, SurfaceContacts& contacts) {
  contacts.for_groups([&](SurfaceGroup& group) {
    for_loads(contacts, group, [&](ClothLoad& load, const RowView& row) {
      load.surface = {};
      for (std::size_t k = 0; k < RowView::kVertices; ++k) {
        if (row.weight(k) == Real(0) || row.is_first_side(k) == load.cloth_is_first) continue;
        const std::uint32_t particle = contacts.surfaces.particle[row.vertex(k)];
        load.surface += static_cast<double>(std::abs(row.weight(k))) *
                        vector_cast<double>(tables.particles.velocity[particle].v);
      }
    });
  });
}

void apply_solid_loads(SurfaceContacts& contacts, SurfaceGroup& group) {
  for_loads(contacts, group, [&](const ClothLoad& load, const RowView& row) {
    if (!load.is_solved) return;
    // Of the first side of the row.
    const Vec3 impulse = vector_cast<Real>((load.cloth_is_first ? 1.0 : -1.0) * load.impulse);
    const Vec3 normal = row.normal();
    const Real pushed = dot(normal, impulse);
    const Vec3 rubbed = impulse - pushed * normal;
    SurfaceRowBlock& block = group.rows[load.block];
    // Lanes without a row repeat the last one.
    const int end = load.lane == block.count - 1 ? kLanes : load.lane + 1;
    for (int lane = load.lane; lane < end; ++lane) {
      block.pushed[lane] = pushed;
      block.rubbed[0][lane] = rubbed.x;
      block.rubbed[1][lane] = rubbed.y;
      block.rubbed[2][lane] = rubbed.z;
    }
    for (std::size_t k = 0; k < RowView::kVertices && !load.is_whole; ++k) {
      if (row.is_first_side(k) == load.cloth_is_first) continue;
      state::VelocityRecord& solid = contacts.velocity[row.vertex(k)];
      solid.v += (row.weight(k) * solid.inverse_mass) * impulse;
    }
  });
  group.first_solid_load = group.end_solid_load = 0;
}

}  // namespace hooke::solver
