#include "build/solid_splits.h"

#include "base/assert.h"
#include "base/sort_unique.h"
#include "geometry/solid/tetrahedral_mesh.h"

#include <map>
#include <memory>
#include <set>

namespace hooke::build {

namespace {

using geometry::Tetrahedron;
using geometry::Triangle;
using state::Deformable;
using state::Skin;
using state::Tables;
using Tetrahedra = std::span<const Tetrahedron>;

constexpr std::uint32_t kNoElement = 0xFFFFFFFF;

/// Makes the skin of a solid that parts anew.
class SplitSkin {
 public:
  /// `index` is that of each row in the maker's order, after the splits.
  SplitSkin(const Deformable& solid, const ElementMesh<4>& mesh, Tetrahedra after,
            std::span<const std::uint32_t> index, const Tables& t)
      : solid_(solid), mesh_(mesh), after_(after), index_(index), t_(t), skin_(*solid.skin) {}

  std::shared_ptr<const Skin> make() {
    const std::size_t count = skin_.vertices.size();
    std::vector<std::uint32_t> element_of(count);
    for (std::uint32_t v = 0; v < count; ++v)
      element_of[v] = is_point(v) ? kNoElement : element_at(anchored(v));
    for (Triangle& triangle : skin_.triangles) {
      const std::uint32_t owner = owner_of(triangle, element_of);
      if (owner == kNoElement) continue;
      for (std::uint32_t& v : triangle) v = vertex_on(owner, v, v < count ? element_of[v] : kNoElement);
    }
    append_open_faces();
    return std::make_shared<const Skin>(std::move(skin_));
  }

 private:
  [[nodiscard]] static bool is_point(const Skin::Anchor& anchor) {
    return anchor.weights[1] == Real(0) && anchor.points[0] == anchor.points[1];
  }
  [[nodiscard]] bool is_point(std::uint32_t v) const { return is_point(old_anchor(v)); }
  [[nodiscard]] std::uint32_t row_of(std::uint32_t point) const {
    return solid_.particles.first + t_.particles.row_of[solid_.particles.first + point];
  }
  [[nodiscard]] Tetrahedron anchored(std::uint32_t v) const {
    const Tetrahedron& points = old_anchor(v).points;
    return {row_of(points[0]), row_of(points[1]), row_of(points[2]), row_of(points[3])};
  }
  [[nodiscard]] const Skin::Anchor& old_anchor(std::uint32_t v) const { return solid_.skin->vertices[v]; }

  /// The first tetrahedron that had all these rows.
  template <std::size_t N>
  [[nodiscard]] std::uint32_t element_at(const std::array<std::uint32_t, N>& rows) const {
    for (const std::uint32_t e : mesh_.incidence.of(rows[0])) {
      if (std::all_of(rows.begin(), rows.end(), [&](std::uint32_t p) { return mesh_.has(e, p); })) return e;
    }
    return kNoElement;
  }

  /// The tetrahedron that a triangle of the skin goes with: that of its face, or of its first vertex.
  [[nodiscard]] std::uint32_t owner_of(const Triangle& triangle,
                                       std::span<const std::uint32_t> element_of) const {
    if (!is_point(triangle[0]) || !is_point(triangle[1]) || !is_point(triangle[2])) {
      for (const std::uint32_t v : triangle) {
        if (element_of[v] != kNoElement) return element_of[v];
      }
      return kNoElement;
    }
    std::array<std::uint32_t, 3> rows = {};
    for (std::size_t k = 0; k < 3; ++k) rows[k] = row_of(old_anchor(triangle[k]).points[0]);
    return element_at(rows);
  }

  [[nodiscard]] static bool have_common(const Tetrahedron& a, const Tetrahedron& b) {
    return std::any_of(a.begin(), a.end(),
                       [&](std::uint32_t p) { return std::find(b.begin(), b.end(), p) != b.end(); });
  }

  /// Whether two tetrahedra hang together no more by those around them.
  [[nodiscard]] bool have_parted(std::uint32_t a, std::uint32_t b) const {
    if (a == b) return false;
    std::vector<std::uint32_t> around;
    for (const std::uint32_t element : {a, b}) {
      for (const std::uint32_t p : mesh_.corners[element]) {
        const auto elements = mesh_.incidence.of(p);
        around.insert(around.end(), elements.begin(), elements.end());
      }
    }
    base::sort_unique(around);
    const bool changed = std::any_of(around.begin(), around.end(),
                                     [&](std::uint32_t e) { return after_[e] != mesh_.corners[e]; });
    return changed && !are_joined(a, b, around);
  }

  /// Whether common corners lead from one tetrahedron to another through those in a list.
  [[nodiscard]] bool are_joined(std::uint32_t from, std::uint32_t to,
                                std::vector<std::uint32_t> through) const {
    std::vector<std::uint32_t> reached = {from};
    for (std::size_t i = 0; i < reached.size(); ++i) {
      if (reached[i] == to) return true;
      const auto next = std::partition(through.begin(), through.end(), [&](std::uint32_t e) {
        return !have_common(after_[reached[i]], after_[e]);
      });
      reached.insert(reached.end(), next, through.end());
      through.erase(next, through.end());
    }
    return false;
  }

  /// The vertex in place of `v` on the side of a tetrahedron. `own` is the tetrahedron of `v`, if it has one.
  std::uint32_t vertex_on(std::uint32_t owner, std::uint32_t v, std::uint32_t own) {
    if (own == kNoElement) {
      const std::uint32_t row = row_of(old_anchor(v).points[0]);
      const std::uint32_t point = index_[corner_after<4>(mesh_, after_, owner, row) - solid_.particles.first];
      return vertex_with(v, {.points = {point, point, point, point}, .weights = {Real(1)}});
    }
    const bool parted = have_parted(owner, own);
    Skin::Anchor anchor = old_anchor(v);
    if (parted) {
      anchor.weights = weights_in(owner, v);
      for (std::size_t k = 0; k < 4; ++k) anchor.points[k] = point_of(after_[owner][k]);
    } else {
      for (std::uint32_t& p : anchor.points) p = point_of(corner_after<4>(mesh_, after_, own, row_of(p)));
    }
    return vertex_with(v, anchor);
  }

  [[nodiscard]] std::uint32_t point_of(std::uint32_t row) const {
    return index_[row - solid_.particles.first];
  }

  /// The vertex `v` itself if it has the anchor, or a copy of it that has.
  std::uint32_t vertex_with(std::uint32_t v, const Skin::Anchor& anchor) {
    const auto [known, is_new] = vertex_of_.try_emplace({v, anchor.points}, v);
    if (!is_new) return known->second;
    if (taken_.insert(v).second) {
      skin_.vertices[v] = anchor;  // The first triangle of a vertex keeps it.
      return v;
    }
    known->second = static_cast<std::uint32_t>(skin_.vertices.size());
    skin_.vertices.push_back(anchor);
    return known->second;
  }

  /// Weights of the corners of a tetrahedron at rest for the place of a vertex.
  [[nodiscard]] std::array<Real, 4> weights_in(std::uint32_t element, std::uint32_t v) const {
    const std::vector<Vec3>& rest = *solid_.surface.rest_points;
    const auto at = [&](std::uint32_t row) {
      return vector_cast<double>(rest[row - solid_.particles.first]);
    };
    DVec3 place;
    for (std::size_t k = 0; k < 4; ++k)
      place += static_cast<double>(old_anchor(v).weights[k]) * at(row_of(old_anchor(v).points[k]));
    std::array<DVec3, 4> x;
    for (std::size_t k = 0; k < 4; ++k) x[k] = at(mesh_.corners[element][k]);
    const double whole = geometry::volume6(x[0], x[1], x[2], x[3]);
    std::array<Real, 4> weights = {};
    Real sum = Real(0);
    for (std::size_t k = 1; k < 4; ++k) {
      std::array<DVec3, 4> moved = x;
      moved[k] = place;
      weights[k] = static_cast<Real>(geometry::volume6(moved[0], moved[1], moved[2], moved[3]) / whole);
      sum += weights[k];
    }
    weights[0] = Real(1) - sum;
    return weights;
  }

  /// The rows that added ones split from.
  [[nodiscard]] std::map<std::uint32_t, std::uint32_t> rows_before() const {
    std::map<std::uint32_t, std::uint32_t> before;
    for (std::size_t e = 0; e < after_.size(); ++e) {
      for (std::size_t k = 0; k < 4; ++k) {
        if (after_[e][k] != mesh_.corners[e][k]) before[after_[e][k]] = mesh_.corners[e][k];
      }
    }
    return before;
  }

  /// Appends the faces that were inside and are outside now.
  void append_open_faces() {
    std::set<Triangle> was_outside;
    for (Triangle face : geometry::surface_of(mesh_.corners)) {
      std::sort(face.begin(), face.end());
      was_outside.insert(face);
    }
    const std::map<std::uint32_t, std::uint32_t> before = rows_before();
    std::map<std::uint32_t, std::uint32_t> vertex;  // Those at points, by row.
    for (std::uint32_t v = 0; v < skin_.vertices.size(); ++v) {
      if (is_point(skin_.vertices[v])) vertex.try_emplace(row_of(skin_.vertices[v].points[0]), v);
    }
    for (Triangle face : geometry::surface_of(after_)) {
      Triangle old = face;
      for (std::uint32_t& p : old) {
        const auto from = before.find(p);
        if (from != before.end()) p = from->second;
      }
      std::sort(old.begin(), old.end());
      if (was_outside.contains(old)) continue;
      for (std::uint32_t& p : face) {
        const auto next = static_cast<std::uint32_t>(skin_.vertices.size());
        const auto [entry, is_new] = vertex.try_emplace(p, next);
        const std::uint32_t point = point_of(p);
        if (is_new) skin_.vertices.push_back({.points = {point, point, point, point}, .weights = {Real(1)}});
        p = entry->second;
      }
      skin_.triangles.push_back(face);
    }
  }

  const Deformable& solid_;
  const ElementMesh<4>& mesh_;
  Tetrahedra after_;
  std::span<const std::uint32_t> index_;
  const Tables& t_;
  Skin skin_;
  std::map<std::pair<std::uint32_t, Tetrahedron>, std::uint32_t> vertex_of_;  ///< By vertex and its points.
  std::set<std::uint32_t> taken_;  ///< Vertices that a triangle has kept.
};

/// Changes the forms at rest of tetrahedra of which corners were moved, from `before` to where they are now,
/// so that they are strained as before: F = Ds G^T, with edges Ds and gradients G, stays. With the old form a
/// cut through 8 l of 100 MPa made 0.77 J.
void keep_strain(const Deformable& solid, std::span<const std::array<std::uint32_t, 4>> after,
                 std::span<const Vec3> before, Tables& t) {
  for (std::uint32_t i = 0; i < solid.tetrahedra.count; ++i) {
    std::array<DVec3, 3> old = {};
    std::array<DVec3, 3> now = {};
    bool moved = false;
    const auto place = [&](std::uint32_t p) { return vector_cast<double>(t.particles.position[p].x); };
    const auto place_before = [&](std::uint32_t p) {
      return vector_cast<double>(before[p - solid.particles.first]);
    };
    const DVec3 first = place(after[i][0]);
    const DVec3 first_before = place_before(after[i][0]);
    for (std::size_t k = 0; k < 3; ++k) {
      now[k] = place(after[i][k + 1]) - first;
      old[k] = place_before(after[i][k + 1]) - first_before;
      moved = moved || now[k] != old[k];
    }
    const double volume = dot(now[0], cross(now[1], now[2]));
    if (!moved || volume == 0) continue;
    auto& gradient = t.tetrahedra.shape_gradient[solid.tetrahedra.first + i];
    std::array<DVec3, 3> changed = {};
    for (std::size_t k = 0; k < 3; ++k) {
      const DVec3 row = (1 / volume) * cross(now[(k + 1) % 3], now[(k + 2) % 3]);
      for (std::size_t m = 0; m < 3; ++m) changed[k] += dot(row, old[m]) * vector_cast<double>(gradient[m]);
    }
    for (std::size_t k = 0; k < 3; ++k) gradient[k] = vector_cast<Real>(changed[k]);
  }
}

}  // namespace

void part_solid(std::uint32_t object, const ElementMesh<4>& mesh, std::span<const PointSplit> splits,
                std::span<const ElementPair> parted, Tables& t) {
  const auto after = corners_after(mesh, t.objects[object].particles, splits);
  t.objects[object].scored = still_joined<4>(parted, after);
  if (splits.empty()) return;
  append_split_particles(object, splits, t);
  Deformable& solid = t.objects[object];
  const auto first_added = solid.particles.end() - static_cast<std::uint32_t>(splits.size());
  if (solid.surface.self_contact) {
    std::vector<Vec3> before;
    for (std::uint32_t p = solid.particles.first; p < solid.particles.end(); ++p)
      before.push_back(t.particles.position[p].x);
    draw_apart<4>(after, mesh, splits, first_added, t);
    keep_strain(solid, after, before, t);
  }
  const std::vector<std::uint32_t> index = indices_of(t, solid);
  part_hooks<4>(object, mesh, after, t);
  part_places<4>(mesh, after, index, t, solid);
  if (solid.skin) solid.skin = SplitSkin(solid, mesh, after, index, t).make();
  for (std::uint32_t i = 0; i < solid.tetrahedra.count; ++i) {
    const auto& [a, b, c, d] = after[i];
    t.tetrahedra.corners[solid.tetrahedra.first + i] = {a, b, c, d};
  }
  std::erase_if(t.element_contacts, [object](const state::ElementContact& c) { return c.object == object; });
  state::note_change(t, solid);
}

}  // namespace hooke::build
