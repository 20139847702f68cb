#include "solver/soft/soft_groups.h"

#include "base/assert.h"
#include "solver/soft/soft_tuning.h"

#include <algorithm>

namespace hooke::solver {

namespace {

using state::Deformable;

bool has_soft_rows(const Deformable& object) {
  return object.springs.count + object.bends.count + object.tetrahedra.count + object.triangles.count > 0;
}

/// Moves a group to where its objects are now.
void place(std::span<const Deformable> objects, std::uint32_t first_object, SoftGroup& group) {
  const Deformable& first = objects[first_object];
  group.first_object = first_object;
  group.yarns.first_particle = first.particles.first;
  group.springs.first_particle = first.particles.first;
  group.bends.first_particle = first.particles.first;
  group.bends.first_row = first.bends.first;
  group.isometric_bends.first_particle = first.particles.first;
  group.tetrahedra.first_particle = first.particles.first;
  group.tetrahedra.first_row = first.tetrahedra.first;
  group.air_loads.first_particle = first.particles.first;
  group.air_loads.first_triangle = first.triangles.first;
}

/// Goes through the objects in order and finds for each either a group from before or the objects with which
/// it is copied anew.
class Refresh {
 public:
  Refresh(const state::Tables& tables, SoftGroups& out)
      : tables_(tables), objects_(tables.objects), out_(out) {
    out_.before.swap(out_.groups);
    out_.groups.clear();
    out_.before_by_revision.clear();
    for (std::uint32_t i = 0; i < out_.before.size(); ++i)
      out_.before_by_revision.emplace_back(out_.before[i].revisions.front(), i);
    std::sort(out_.before_by_revision.begin(), out_.before_by_revision.end());
  }

  void run() {
    for (std::size_t i = 0; i < objects_.size();) {
      SoftGroup* known = has_soft_rows(objects_[i]) ? find_known(i) : nullptr;
      const std::size_t end = known != nullptr ? i + known->revisions.size() : i + 1;
      if (known != nullptr) {
        keep(i, *known);
      } else if (has_soft_rows(objects_[i])) {
        copy_anew(i);
      }
      i = end;
    }
    build_pending();
    out_.before.clear();
  }

 private:
  /// The group from before that begins with this object, if none of its objects has changed, come or gone.
  SoftGroup* find_known(std::size_t object) const {
    const std::pair key{objects_[object].revision, std::uint32_t{0}};
    const auto at = std::lower_bound(out_.before_by_revision.begin(), out_.before_by_revision.end(), key);
    if (at == out_.before_by_revision.end() || at->first != key.first) return nullptr;
    SoftGroup& group = out_.before[at->second];
    const std::size_t count = group.revisions.size();
    if (count > objects_.size() - object) return nullptr;
    for (std::size_t i = 0; i < count; ++i) {
      if (objects_[object + i].revision != group.revisions[i]) return nullptr;
      if (count > 1 && is_stiff(object + i)) return nullptr;
    }
    return &group;
  }

  [[nodiscard]] bool is_stiff(std::size_t object) const {
    return std::binary_search(out_.stiff.begin(), out_.stiff.end(), objects_[object].revision);
  }

  /// Number of particles and rows of the objects [first, end).
  [[nodiscard]] std::size_t size_between(std::size_t first, std::size_t end) const {
    const auto count = [&](state::Rows Deformable::*table) -> std::size_t {
      return rows_of(objects_.subspan(first, end - first), table).count;
    };
    return count(&Deformable::particles) + count(&Deformable::springs) + count(&Deformable::bends) +
           count(&Deformable::tetrahedra) + count(&Deformable::triangles);
  }

  /// Whether objects that are copied anew, of this size, take a group beside them in: if there is room, and
  /// if it is not so large that one small object more would cost much. So groups grow by a factor at a time,
  /// as the memory of a vector does.
  static bool takes_in(std::size_t size, std::size_t group, std::size_t together) {
    return together <= kMostRowsOfSharedGroup && group <= kLargestToJoin * size;
  }

  void keep(std::size_t object, SoftGroup& group) {
    const std::size_t end = object + group.revisions.size();
    if (is_pending() && !is_stiff(object) &&
        takes_in(size_between(first_, end_), group.size, size_between(first_, end))) {
      end_ = end;
      return;
    }
    build_pending();
    place(objects_, static_cast<std::uint32_t>(object), group);
    out_.groups.push_back(std::move(group));
  }

  void copy_anew(std::size_t object) {
    const bool alone = is_stiff(object);
    if (is_pending() && (alone || size_between(first_, object + 1) > kMostRowsOfSharedGroup)) build_pending();
    if (!is_pending()) first_ = object;
    end_ = object + 1;
    if (alone) return build_pending();
    while (!out_.groups.empty()) {
      const SoftGroup& last = out_.groups.back();
      if (is_stiff(last.first_object) ||
          !takes_in(size_between(first_, end_), last.size, size_between(last.first_object, end_)))
        break;
      first_ = last.first_object;
      out_.groups.pop_back();
    }
  }

  [[nodiscard]] bool is_pending() const { return first_ < end_; }

  void build_pending() {
    if (!is_pending()) return;
    const std::span<const Deformable> objects = objects_.subspan(first_, end_ - first_);
    SoftGroup& group = out_.groups.emplace_back();
    for (const Deformable& object : objects) group.revisions.push_back(object.revision);
    group.size = size_between(first_, end_);
    TakenRows taken = {.springs = std::vector<std::uint8_t>(rows_of(objects, &Deformable::springs).count, 0),
                       .bends = std::vector<std::uint8_t>(rows_of(objects, &Deformable::bends).count, 0)};
    build_yarns(objects, tables_.springs, tables_.bends, tables_.particles, taken, group.yarns);
    build_isometric_bend_blocks(objects, tables_.bends, tables_.springs, taken, group.isometric_bends);
    build_spring_blocks(objects, tables_.springs, tables_.particles, taken.springs, group.springs);
    build_bend_blocks(objects, tables_.bends, group.bends);
    build_tetrahedra(objects, tables_.tetrahedra, tables_.particles, group.tetrahedra);
    find_yields(objects, group.bends, group.tetrahedra, group.yields);
    build_air_loads(objects, tables_.triangles, group.air_loads);
    place(objects_, static_cast<std::uint32_t>(first_), group);
    out_.built_objects += objects.size();
    first_ = end_ = 0;
  }

  const state::Tables& tables_;
  std::span<const Deformable> objects_;
  SoftGroups& out_;
  std::size_t first_ = 0;  ///< The objects [first_, end_) wait to be copied anew, as one group.
  std::size_t end_ = 0;
};

/// Most groups are each solved by one thread. A group that is more than a worker's share of the work would
/// keep the others waiting, so all share its rows, color by color. Of large objects, whose passes divide
/// well, half a share is enough.
void divide_work(int workers, SoftGroups& groups) {
  std::size_t all = 0;
  for (const SoftGroup& group : groups.groups) all += group.size;
  groups.whole.clear();
  groups.divided.clear();
  groups.whole_size = 0;
  for (std::uint32_t i = 0; i < groups.groups.size(); ++i) {
    const std::size_t size = groups.groups[i].size;
    const std::size_t share = all / static_cast<std::size_t>(workers);
    const bool divided = size > (size > kMostRowsOfSharedGroup ? share / 2 : share);
    (divided ? groups.divided : groups.whole).push_back(i);
    if (!divided) groups.whole_size += size;
  }
}

}  // namespace

void refresh_soft_groups(const state::Tables& tables, int workers, SoftGroups& groups) {
  Refresh(tables, groups).run();
  groups.group_of.assign(tables.objects.size(), SoftGroups::kNone);
  for (std::uint32_t i = 0; i < groups.groups.size(); ++i) {
    const SoftGroup& group = groups.groups[i];
    for (std::size_t object = group.first_object; object < group.end_object(); ++object)
      groups.group_of[object] = i;
  }
  divide_work(workers, groups);
}

bool separate_stiff_solids(const state::Tables& tables, int workers, SoftGroups& groups) {
  const std::span<const Deformable> objects = tables.objects;
  const std::size_t known = groups.stiff.size();
  for (const SoftGroup& group : groups.groups) {
    if (group.revisions.size() == 1 || !group.tetrahedra.any_stiff) continue;
    for (std::size_t lane = 0; lane < group.tetrahedra.laws.size(); ++lane) {
      if (!group.tetrahedra.is_stiff(lane)) continue;
      const std::uint32_t row = group.tetrahedra.first_row + group.tetrahedra.laws[lane].row;
      const auto after = std::upper_bound(
          objects.begin(), objects.end(), row,
          [](std::uint32_t of, const Deformable& object) { return of < object.tetrahedra.first; });
      groups.stiff.push_back((after - 1)->revision);
    }
  }
  if (groups.stiff.size() == known) return false;
  std::sort(groups.stiff.begin(), groups.stiff.end());
  std::vector<std::uint64_t> present;
  for (const Deformable& object : objects) {
    if (std::binary_search(groups.stiff.begin(), groups.stiff.end(), object.revision))
      present.push_back(object.revision);
  }
  std::sort(present.begin(), present.end());
  groups.stiff = std::move(present);
  refresh_soft_groups(tables, workers, groups);
  return true;
}

void prepare_soft_group(SoftGroup& group, Real h) {
  prepare_yarns(group.yarns, h);
  prepare_springs(group.springs.materials, h);
  prepare_isometric_bends(group.isometric_bends, h);
  prepare_bends(group.bends, h);
  prepare_tetrahedra(group.tetrahedra, h);
}

}  // namespace hooke::solver
