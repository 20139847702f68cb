/// This file implements World::crossings, and what tells of contacts of deformables.

#include "hooke/world.h"

#include "collision/deformable/contact_frames.h"
#include "collision/distance/distance.h"
#include "collision/query/deformable_queries.h"
#include "geometry/box.h"
#include "solver/surface/surface_crossings.h"
#include "solver/surface/surface_groups.h"
#include "solver/surface/surface_tuning.h"
#include "state/body_frames.h"
#include "state/surface_triangles.h"
#include "world/claim.h"
#include "world/object_edits.h"
#include "world/world_data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace hooke {

namespace {

using state::Tables;

PointRef first_point(const Tables& t, std::uint32_t object) {
  return world::point_of(t, t.objects[object], 0);
}

/// Whether someone asks for the deformable at hand: both ids lead to the same object.
bool is_same(PointRef a, PointRef b) {
  return a.kind == b.kind && a.slot == b.slot && a.generation == b.generation;
}

/// Rounding of the positions of two surfaces, as steps count it [m].
double rounding_of(const geometry::Box3<double>& a, const geometry::Box3<double>& b, DVec3 origin) {
  const geometry::Box3<double> both = merge(a, b);
  const DVec3 lower = both.lower - origin;
  const DVec3 upper = both.upper - origin;
  const double largest = std::max({std::abs(lower.x), std::abs(lower.y), std::abs(lower.z), std::abs(upper.x),
                                   std::abs(upper.y), std::abs(upper.z)});
  return static_cast<double>(solver::kSurfaceReserve) * (largest + 0.05);
}

void add_surface_crossings(const Tables& t, std::vector<Crossing>& found) {
  solver::SurfaceMeshes surfaces;
  solver::refresh_surfaces(t, surfaces);
  std::vector<DVec3> position;
  for (std::uint32_t i = 0; i < surfaces.particle.size(); ++i) {
    position.push_back(t.objects[surfaces.object_of(i)].origin +
                       vector_cast<double>(t.particles.position[surfaces.particle[i]].x));
  }
  std::vector<geometry::Box3<double>> bounds(surfaces.meshes.size());
  for (std::uint32_t i = 0; i < position.size(); ++i) {
    geometry::Box3<double>& box = bounds[surfaces.mesh_of[i]];
    box = geometry::merge(box, position[i]);
  }
  std::vector<solver::SurfaceCrossing> crossings;
  for (std::uint32_t a = 0; a < surfaces.meshes.size(); ++a) {
    for (std::uint32_t b = a; b < surfaces.meshes.size(); ++b) {
      const std::uint32_t object = surfaces.meshes[a].object;
      const bool may_touch =
          a == b ? t.objects[object].surface.self_contact : solver::surfaces_touch(t, surfaces, a, b);
      if (!may_touch || !overlap(bounds[a], bounds[b])) continue;
      const double reserve = rounding_of(bounds[a], bounds[b], t.objects[object].origin);
      solver::find_crossings(surfaces, a, b, position, reserve, crossings);
      if (crossings.empty()) continue;
      Crossing& one = found.emplace_back(Crossing{.a = first_point(t, object)});
      one.b = first_point(t, surfaces.meshes[b].object);
      one.pairs = static_cast<std::uint32_t>(crossings.size());
      for (const solver::SurfaceCrossing& crossing : crossings)
        one.place += (1.0 / static_cast<double>(crossings.size())) * crossing.place;
    }
  }
}

/// Looks at bodies that deformables go through, or have inside.
class BodyCrossings {
 public:
  BodyCrossings(const Tables& tables, std::vector<Crossing>& found) : t_(tables), found_(found) {
    collision::list_hooked(t_, hooked_);
  }

  void run() {
    for (std::uint32_t row = 0; row < t_.objects.size(); ++row) {
      list_faces(t_.objects[row]);
      geometry::Box3<double> bounds;
      for (const Face& face : faces_) {
        for (const DVec3& corner : face.corner) bounds = geometry::merge(bounds, corner);
      }
      for (std::uint32_t body = 0; body < t_.bodies.traits.size(); ++body) {
        const state::BodyTraits& traits = t_.bodies.traits[body];
        if (!traits.alive || !collision::is_solid(t_, body)) continue;
        const auto reach = static_cast<double>(traits.radius);
        const DVec3 size = {reach, reach, reach};
        if (overlap(bounds, {t_.bodies.center[body] - size, t_.bodies.center[body] + size})) look(row, body);
      }
    }
  }

 private:
  /// A face, or a segment: the last two points are the same then.
  struct Face {
    std::array<std::uint32_t, 3> particle = {};
    std::array<DVec3, 3> corner = {};  ///< [m]
  };

  void list_faces(const state::Deformable& object) {
    faces_.clear();
    const auto add = [&](std::array<std::uint32_t, 3> particle) {
      Face face = {.particle = particle};
      for (std::size_t k = 0; k < 3; ++k)
        face.corner[k] = object.origin + vector_cast<double>(t_.particles.position[particle[k]].x);
      faces_.push_back(face);
    };
    for (std::uint32_t i = 0; i < object.segments.count; ++i) {
      const std::uint32_t first = object.particles.first + i;
      if (t_.segments.joins(object.segments.first + i)) add({first, first + 1, first + 1});
    }
    for (const auto& triangle : state::surface_triangles(t_, object)) add(triangle);
  }

  /// Whether something of the two gives way, and no hook holds them together.
  [[nodiscard]] bool may_touch(const Face& face, std::uint32_t body) const {
    bool any_free = is_dynamic(t_.bodies, body);
    for (const std::uint32_t particle : face.particle) {
      any_free = any_free || t_.particles.velocity[particle].inverse_mass > Real(0);
      if (collision::is_hooked(hooked_, particle, body)) return false;
    }
    return any_free;
  }

  void look(std::uint32_t row, std::uint32_t body) {
    Crossing one = {.a = first_point(t_, row), .b = {}, .body = world::id_of(t_, body)};
    bool all_within = true;
    for (const std::uint32_t collider : colliders_of(t_.bodies, body)) {
      const state::ColliderShape& shape = t_.colliders.shape[collider];
      if (shape.shape.kind == ShapeKind::kHalfSpace || shape.shape.kind == ShapeKind::kMesh) return;
      const Pose frame = state::frame_of_collider(t_.bodies, t_.colliders, collider);
      collision::Convex convex = {
          .shape = shape.shape, .center = {}, .axes = matrix_of(normalize(frame.rotation))};
      if (shape.shape.kind == ShapeKind::kHull) convex.hull = shape.hull.get();
      for (const Face& face : faces_) {
        if (!is_deep(convex, frame.position, face) || !may_touch(face, body)) continue;
        ++one.pairs;
        one.place += (1.0 / 3) * (face.corner[0] + face.corner[1] + face.corner[2]);
      }
      const DVec3 middle = frame.position + vector_cast<double>(collision::middle_of(convex));
      all_within = all_within && one.pairs == 0 && is_within(row, middle);
      if (all_within) one.place = middle;
    }
    one.inside = all_within && one.pairs == 0;
    if (one.pairs > 0) one.place = (1.0 / one.pairs) * one.place;
    if (one.pairs > 0 || one.inside) found_.push_back(one);
  }

  /// Whether a face comes nearer to the middle of a convex shape than halfway from its surface: stretched to
  /// twice its size about the middle, it would still touch the shape.
  [[nodiscard]] static bool is_deep(const collision::Convex& convex, DVec3 origin, const Face& face) {
    collision::Convex stretched = {.shape = {.kind = ShapeKind::kMesh}};
    const Vec3 middle = collision::middle_of(convex);
    for (std::size_t k = 0; k < 3; ++k)
      stretched.corners[k] = Real(2) * vector_cast<Real>(face.corner[k] - origin) - middle;
    const collision::Distance found = collision::distance_between(stretched, convex);
    return found.cores_overlap || found.distance < Real(0);
  }

  /// Whether a solid has a place inside.
  [[nodiscard]] bool is_within(std::uint32_t row, DVec3 place) {
    if (t_.objects[row].kind != PointRef::Kind::kSolid) return false;
    collision::find_near(t_, {}, place, 0, spots_);
    return std::any_of(spots_.begin(), spots_.end(), [&](const collision::DeformableSpot& spot) {
      return spot.object == row && spot.distance < 0;
    });
  }

  const Tables& t_;
  std::vector<Crossing>& found_;
  std::vector<collision::Hooked> hooked_;
  std::vector<Face> faces_;
  std::vector<collision::DeformableSpot> spots_;
};

}  // namespace

std::vector<Crossing> World::crossings() const {
  const world::Reading reading(data_);
  std::vector<Crossing> found;
  if (data_ && data_->stepping) return found;
  add_surface_crossings(reading.tables(), found);
  BodyCrossings(reading.tables(), found).run();
  return found;
}

std::vector<DeformableContact> World::deformable_contacts() const {
  const world::Reading reading(data_);
  return reading->last_step.deformable_contacts;
}

std::vector<DeformableContact> World::deformable_contacts(PointRef of) const {
  std::vector<DeformableContact> all = deformable_contacts();
  std::erase_if(all, [&](const DeformableContact& c) { return !is_same(c.a, of) && !is_same(c.b, of); });
  return all;
}

std::vector<DeformableContact> World::deformable_contacts(BodyId id) const {
  std::vector<DeformableContact> all = deformable_contacts();
  std::erase_if(all, [&](const DeformableContact& c) { return !c.body || c.body != id; });
  return all;
}

Vec3 World::contact_force(PointRef point) const {
  const world::Reading reading(data_);
  const Tables& t = reading.tables();
  const auto row = world::find_particle(t, point);
  const world::LastStep& last = reading->last_step;
  if (!row || last.contact_forces_revision != t.revision || row->particle >= last.contact_forces.size())
    return {};
  return last.contact_forces[row->particle];
}

}  // namespace hooke
