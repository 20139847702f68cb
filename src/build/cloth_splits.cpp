#include "build/cloth_splits.h"

#include "base/assert.h"
#include "build/split_tethers.h"

#include <cmath>
#include <limits>
#include <memory>
#include <optional>

namespace hooke::build {

namespace {

using state::Deformable;
using state::SpringClass;
using state::Tables;

/// A spring between two particles after splits, with its share in the spring before.
struct SplitSpring {
  std::uint32_t a = 0, b = 0;
  double share = 0;

  [[nodiscard]] bool joins(std::uint32_t x, std::uint32_t y) const { return a == x && b == y; }
};

/// Triangles before and after splits, and what follows for rows between their points.
class SplitTriangles {
 public:
  SplitTriangles(const Deformable& cloth, const ElementMesh<3>& mesh, std::span<const PointSplit> splits)
      : mesh_(mesh),
        after_(corners_after(mesh, cloth.particles, splits)),
        rest_points_(cloth.surface.rest_points),
        first_(cloth.particles.first),
        kind_(cloth.particles.count, kFar) {
    for (const PointSplit& split : splits) {
      for (const std::uint32_t element : mesh.incidence.of(split.particle)) {
        for (const std::uint32_t p : mesh.corners[element])
          kind_[p - first_] = std::max(kind_[p - first_], kNear);
      }
    }
    for (const PointSplit& split : splits) kind_[split.particle - first_] = kSplit;
  }

  [[nodiscard]] std::span<const std::array<std::uint32_t, 3>> after() const { return after_; }
  [[nodiscard]] bool splits(std::uint32_t p) const { return kind_[p - first_] == kSplit; }

  /// Whether a spring may change.
  [[nodiscard]] bool concerns(std::uint32_t a, std::uint32_t b) const {
    return splits(a) || splits(b) || (kind_[a - first_] == kNear && kind_[b - first_] == kNear);
  }

  /// The springs that come of one: along an edge, across one, or over one point. None if it goes.
  [[nodiscard]] std::vector<SplitSpring> split_spring(std::uint32_t a, std::uint32_t b) const {
    std::vector<SplitSpring> springs;
    for (const std::uint32_t e : mesh_.incidence.of(a)) {
      if (mesh_.has(e, b)) add({at(e, a), at(e, b), static_cast<double>(mesh_.weight[e])}, springs);
    }
    if (springs.empty() && !across(a, b, springs)) over(a, b, springs);
    double sum = 0;
    for (const SplitSpring& spring : springs) sum += spring.share;
    for (SplitSpring& spring : springs)
      spring.share = sum > 0 ? spring.share / sum : 1 / static_cast<double>(springs.size());
    return springs;
  }

  /// The triangle after splits of a wing of a bend and its edge.
  [[nodiscard]] std::optional<std::array<std::uint32_t, 3>> find(std::uint32_t wing, std::uint32_t edge_a,
                                                                 std::uint32_t edge_b) const {
    for (const std::uint32_t e : mesh_.incidence.of(wing)) {
      if (mesh_.has(e, edge_a) && mesh_.has(e, edge_b))
        return std::array{at(e, wing), at(e, edge_a), at(e, edge_b)};
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] const Vec3& rest_at(std::uint32_t particle) const {
    return (*rest_points_)[particle - first_];
  }

  static constexpr std::uint8_t kFar = 0, kNear = 1, kSplit = 2;

  [[nodiscard]] std::uint32_t at(std::uint32_t element, std::uint32_t particle) const {
    return corner_after<3>(mesh_, after_, element, particle);
  }

  static void add(const SplitSpring& spring, std::vector<SplitSpring>& springs) {
    for (SplitSpring& known : springs) {
      if (!known.joins(spring.a, spring.b)) continue;
      known.share += spring.share;
      return;
    }
    springs.push_back(spring);
  }

  /// Finds what comes of a spring across an edge, and returns whether it is one.
  bool across(std::uint32_t a, std::uint32_t b, std::vector<SplitSpring>& springs) const {
    bool is_one = false;
    for (const std::uint32_t e : mesh_.incidence.of(a)) {
      for (const std::uint32_t f : mesh_.incidence.of(b)) {
        if (!mesh_.are_neighbors(e, f)) continue;
        is_one = true;
        bool joined = true;
        for (const std::uint32_t p : mesh_.corners[e]) joined = joined && (p == a || at(e, p) == at(f, p));
        if (joined && springs.empty()) springs.push_back({at(e, a), at(f, b), 1});
      }
    }
    return is_one;
  }

  /// Finds what comes of a spring to a second neighbor, which leads over the point nearest to its middle.
  void over(std::uint32_t a, std::uint32_t b, std::vector<SplitSpring>& springs) const {
    const std::optional<std::uint32_t> middle = point_between(a, b);
    if (!middle) {
      if (!splits(a) && !splits(b)) springs.push_back({a, b, 1});
      return;
    }
    for (const std::uint32_t e : mesh_.incidence.of(a)) {
      if (!mesh_.has(e, *middle)) continue;
      for (const std::uint32_t f : mesh_.incidence.of(b)) {
        if (mesh_.has(f, *middle) && at(e, *middle) == at(f, *middle)) add({at(e, a), at(f, b), 1}, springs);
      }
    }
  }

  [[nodiscard]] std::optional<std::uint32_t> point_between(std::uint32_t a, std::uint32_t b) const {
    const Vec3 sum = rest_at(a) + rest_at(b);
    std::optional<std::uint32_t> nearest;
    Real least = std::numeric_limits<Real>::infinity();
    for (const std::uint32_t e : mesh_.incidence.of(a)) {
      for (const std::uint32_t p : mesh_.corners[e]) {
        const auto of_b = mesh_.incidence.of(b);
        if (p == a || std::none_of(of_b.begin(), of_b.end(), [&](auto f) { return mesh_.has(f, p); }))
          continue;
        const Real distance = length_squared(Real(2) * rest_at(p) - sum);
        if (!(distance < least)) continue;
        least = distance;
        nearest = p;
      }
    }
    return nearest;
  }

  const ElementMesh<3>& mesh_;
  std::vector<std::array<std::uint32_t, 3>> after_;
  std::shared_ptr<const std::vector<Vec3>> rest_points_;
  std::uint32_t first_;
  std::vector<std::uint8_t> kind_;  ///< By particle of the object.
};

/// Takes a share of a stiffness or damping, which may be rigid.
Real share_of(Real all, double share) {
  return std::isfinite(all) ? static_cast<Real>(share * static_cast<double>(all)) : all;
}

/// A spring that a row gives a share to.
struct CopiedSpring {
  SplitSpring spring;
  Real stiffness = Real(0);
  Real damping = Real(0);
};

/// Which rows of a table are copied and which go.
struct RowChanges {
  std::vector<std::uint32_t> copied;
  std::vector<CopiedSpring> copies;  ///< What the copied rows become.
  std::vector<std::uint32_t> gone;
};

/// Gives a row and its copies their ends and shares.
void share_out(std::uint32_t row, std::span<const SplitSpring> parts, state::Springs& springs,
               RowChanges& changes) {
  const Real stiffness = springs.stiffness[row];
  const Real damping = springs.damping[row];
  springs.particle_a[row] = parts.front().a;
  springs.particle_b[row] = parts.front().b;
  for (const SplitSpring& part : parts.subspan(1)) {
    changes.copied.push_back(row);
    const CopiedSpring copy = {part, share_of(stiffness, part.share), share_of(damping, part.share)};
    changes.copies.push_back(copy);
    if (std::isfinite(stiffness)) springs.stiffness[row] -= copy.stiffness;
    if (std::isfinite(damping)) springs.damping[row] -= copy.damping;
  }
}

/// Changes the springs of a cloth, all but tethers. A bend spring over a point counts as often as it finds
/// a way beside it: its share is that of each.
void split_springs(std::uint32_t object, const SplitTriangles& triangles, Tables& t) {
  const Deformable& cloth = t.objects[object];
  state::Springs& springs = t.springs;
  RowChanges changes;
  for (std::uint32_t i = cloth.springs.first; i < cloth.springs.end(); ++i) {
    const std::uint32_t a = springs.particle_a[i];
    const std::uint32_t b = springs.particle_b[i];
    if (springs.kind[i] == SpringClass::kTether || !triangles.concerns(a, b)) continue;
    const std::vector<SplitSpring> parts = triangles.split_spring(a, b);
    if (parts.empty()) {
      changes.gone.push_back(i);
    } else {
      share_out(i, parts, springs, changes);
    }
  }
  const std::uint32_t first_copy = cloth.springs.end();
  change_rows(object, &Deformable::springs, springs, changes.copied, {}, t);
  for (std::size_t i = 0; i < changes.copies.size(); ++i) {
    const CopiedSpring& copy = changes.copies[i];
    springs.particle_a[first_copy + i] = copy.spring.a;
    springs.particle_b[first_copy + i] = copy.spring.b;
    springs.stiffness[first_copy + i] = copy.stiffness;
    springs.damping[first_copy + i] = copy.damping;
  }
  change_rows(object, &Deformable::springs, springs, {}, changes.gone, t);
}

/// Changes the bends of a cloth. Those about an edge whose triangles have parted go.
void split_bends(std::uint32_t object, const SplitTriangles& triangles, Tables& t) {
  const Deformable& cloth = t.objects[object];
  std::vector<std::uint32_t> gone;
  for (std::uint32_t i = cloth.bends.first; i < cloth.bends.end(); ++i) {
    state::Bends::Stencil& s = t.bends.stencil[i];
    if (!triangles.splits(s.edge_a) && !triangles.splits(s.edge_b) && !triangles.splits(s.wing_a) &&
        !triangles.splits(s.wing_b))
      continue;
    const auto a = triangles.find(s.wing_a, s.edge_a, s.edge_b);
    const auto b = triangles.find(s.wing_b, s.edge_a, s.edge_b);
    if (a && b && (*a)[1] == (*b)[1] && (*a)[2] == (*b)[2]) {
      s = {(*a)[1], (*a)[2], (*a)[0], (*b)[0]};
    } else {
      gone.push_back(i);
    }
  }
  change_rows(object, &Deformable::bends, t.bends, {}, gone, t);
}

/// Bit of the edge between two corners of a triangle; 0 if it has none.
std::uint8_t edge_bit(const std::array<std::uint32_t, 3>& corners, std::uint32_t a, std::uint32_t b) {
  for (unsigned k = 0; k < 3; ++k) {
    const std::uint32_t from = corners[k];
    const std::uint32_t to = corners[(k + 1) % 3];
    if ((from == a && to == b) || (from == b && to == a)) return static_cast<std::uint8_t>(1U << k);
  }
  return 0;
}

/// Each edge belongs to one of the triangles that still have it.
void own_edges(const Deformable& cloth, const ElementMesh<3>& mesh,
               std::span<const std::array<std::uint32_t, 3>> after, std::span<const PointSplit> splits,
               Tables& t) {
  std::uint8_t* const own = t.triangles.own_edges.data() + cloth.triangles.first;
  const auto own_edges_of = [&](std::uint32_t element) {
    for (unsigned k = 0; k < 3; ++k) {
      const auto near = mesh.incidence.of(mesh.corners[element][k]);
      const bool owned = std::any_of(near.begin(), near.end(), [&](std::uint32_t e) {
        return (own[e] & edge_bit(after[e], after[element][k], after[element][(k + 1) % 3])) != 0;
      });
      if (!owned) own[element] |= static_cast<std::uint8_t>(1U << k);
    }
  };
  for (const PointSplit& split : splits) {
    for (const std::uint32_t element : mesh.incidence.of(split.particle)) own_edges_of(element);
  }
}

}  // namespace

void split_cloth(std::uint32_t object, const ElementMesh<3>& mesh, std::span<const PointSplit> splits,
                 Tables& t) {
  if (splits.empty()) return;
  HOOKE_ASSERT(t.objects[object].surface.rest_points != nullptr);
  const SplitTriangles triangles(t.objects[object], mesh, splits);
  split_tethers(object, mesh, triangles.after(), splits, t);
  split_springs(object, triangles, t);
  split_bends(object, triangles, t);
  append_split_particles(object, splits, t);
  Deformable& cloth = t.objects[object];
  const auto first_added = cloth.particles.end() - static_cast<std::uint32_t>(splits.size());
  if (cloth.surface.self_contact) draw_apart(triangles.after(), mesh, splits, first_added, t);
  own_edges(cloth, mesh, triangles.after(), splits, t);
  part_hooks(object, mesh, triangles.after(), t);
  part_places(mesh, triangles.after(), indices_of(t, cloth), t, cloth);
  for (std::uint32_t i = 0; i < cloth.triangles.count; ++i) {
    const auto& [a, b, c] = triangles.after()[i];
    t.triangles.corners[cloth.triangles.first + i] = {a, b, c};
  }
  cloth.gas = 0;
  std::erase_if(t.element_contacts, [object](const state::ElementContact& c) { return c.object == object; });
  state::note_change(t, cloth);
}

}  // namespace hooke::build
