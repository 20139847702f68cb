/// This file implements World::cut, and what is read of points that have split.

#include "hooke/world.h"

#include "base/sort_unique.h"
#include "build/blade.h"
#include "build/checks.h"
#include "world/claim.h"
#include "world/hook_stages.h"
#include "world/object_edits.h"
#include "world/sleep.h"

#include <algorithm>
#include <string>

namespace hooke {

namespace {

using build::SweptBlade;
using state::Deformable;
using state::Tables;

/// Appends the rows of objects that ids lead to. Returns an Error that names an id that is stale.
template <class IdType>
Result<void> append_rows(const state::SlotTable<IdType>& slots, const std::vector<IdType>& ids,
                         const char* name, std::vector<std::uint32_t>& rows) {
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const std::uint32_t row = slots.find(ids[i]);
    if (row == slots.kNone) return world::stale(build::indexed("cut." + std::string(name), i).c_str());
    rows.push_back(row);
  }
  return {};
}

/// Lists the rows of the objects that may be cut, in order of creation.
Result<std::vector<std::uint32_t>> list_objects(const CutDesc& desc, const Tables& t) {
  std::vector<std::uint32_t> rows;
  if (const auto good = append_rows(t.rope_slots, desc.ropes, "ropes", rows); !good) return good.error();
  if (const auto good = append_rows(t.cloth_slots, desc.cloths, "cloths", rows); !good) return good.error();
  if (const auto good = append_rows(t.solid_slots, desc.solids, "solids", rows); !good) return good.error();
  if (rows.empty()) {
    for (std::uint32_t i = 0; i < t.objects.size(); ++i) rows.push_back(i);
  }
  base::sort_unique(rows);
  return rows;
}

bool may_meet(const Deformable& object, const SweptBlade& blade, const Tables& t) {
  geometry::Box3<double> box;
  for (std::uint32_t i = object.particles.first; i < object.particles.end(); ++i) {
    const DVec3 x = object.origin + vector_cast<double>(t.particles.position[i].x);
    box = geometry::merge(box, x);
  }
  return blade.may_meet(box);
}

void cut_object(std::uint32_t row, const SweptBlade& blade, Tables& t, CutResult& result) {
  const Deformable& object = t.objects[row];
  if (object.kind == PointRef::Kind::kRope) {
    std::vector<std::uint32_t> segments = build::find_cut_segments(object, blade, t);
    if (segments.empty()) return;
    world::cut_segments(row, segments, t);
    result.ropes.push_back({t.rope_slots.id_of(object.slot), std::move(segments)});
  }
  if (object.kind == PointRef::Kind::kCloth) {
    auto cut = build::cut_cloth(row, blade, t);
    if (!cut) return;
    cut->cloth = t.cloth_slots.id_of(t.objects[row].slot);
    result.cloths.push_back(*cut);
  }
  if (object.kind == PointRef::Kind::kSolid) {
    if (object.tetrahedra.count == 0) {
      result.refused.push_back({{.kind = object.kind,
                                 .slot = object.slot,
                                 .generation = t.solid_slots.id_of(object.slot).generation,
                                 .index = 0,
                                 .world = t.solid_slots.world()},
                                "it is matched as a whole and has no tetrahedra to part; a solid with "
                                "SolidDesc::Elasticity::kTetrahedra can be cut"});
      return;
    }
    auto cut = build::cut_solid(row, blade, t);
    if (!cut) return;
    cut->solid = t.solid_slots.id_of(t.objects[row].slot);
    result.solids.push_back(*cut);
  }
  world::wake_near_points(t.objects[row], t);
}

}  // namespace

Result<CutResult> World::cut(const CutDesc& desc) {
  const world::Claim claim(data_);
  if (!claim) return claim.error();
  Tables& t = claim.tables();
  const auto checked = build::Checks("cut")
                           .place("from[0]", desc.from[0])
                           .place("from[1]", desc.from[1])
                           .place("to[0]", desc.to[0])
                           .place("to[1]", desc.to[1])
                           .result();
  if (!checked) return checked.error();
  const Result<std::vector<std::uint32_t>> rows = list_objects(desc, t);
  if (!rows) return rows.error();
  const SweptBlade blade(desc.from, desc.to);
  CutResult result;
  for (const std::uint32_t row : rows.value()) {
    if (may_meet(t.objects[row], blade, t)) cut_object(row, blade, t, result);
  }
  return result;
}

std::vector<std::uint32_t> World::splits(ClothId id) const {
  const world::Reading reading(data_);
  const std::uint32_t row = reading.tables().cloth_slots.find(id);
  if (row == reading.tables().cloth_slots.kNone) return {};
  return reading.tables().objects[row].split_from;
}

std::vector<std::uint32_t> World::splits(SolidId id) const {
  const world::Reading reading(data_);
  const std::uint32_t row = reading.tables().solid_slots.find(id);
  if (row == reading.tables().solid_slots.kNone) return {};
  return reading.tables().objects[row].split_from;
}

}  // namespace hooke
