#pragma once

#include "collision/narrow_phase/narrow_phase.h"
#include "geometry/convex/convex_hull.h"

#include <memory>
#include <utility>
#include <vector>

namespace hooke::test {

/// Bodies of one shape each, and the pairs of all of them, without a world around them.
struct PairScene {
  state::Bodies bodies;
  state::Colliders colliders;
  state::Pairs pairs;
  std::vector<MaterialPairDesc> materials;
  parallel::ThreadPool pool{1};
  collision::NarrowPhase narrow_phase;
  collision::NarrowPhaseCounts counts;

  std::uint32_t add(BodyKind kind, const Shape& shape, DVec3 position, Quat rotation = {}) {
    const auto row = static_cast<std::uint32_t>(bodies.motion.size());
    state::Bodies::for_each_column(bodies, [](auto& column) { column.emplace_back(); });
    bodies.center[row] = position;
    bodies.rotation[row] = rotation;
    bodies.traits[row].kind = kind;
    bodies.traits[row].alive = true;
    bodies.traits[row].radius = length(shape.half_extents);
    bodies.mass[row].inverse_mass = kind == BodyKind::kDynamic ? Real(1) : Real(0);
    bodies.motion[row].inverse_mass = bodies.mass[row].inverse_mass;
    state::Colliders::for_each_column(colliders, [](auto& column) { column.emplace_back(); });
    colliders.body[row] = row;
    colliders.shape[row].shape = shape;
    return row;
  }
  std::uint32_t add_dynamic(const Shape& shape, DVec3 position, Quat rotation = {}) {
    return add(BodyKind::kDynamic, shape, position, rotation);
  }
  std::uint32_t add_static(const Shape& shape, DVec3 position, Quat rotation = {}) {
    return add(BodyKind::kStatic, shape, position, rotation);
  }
  std::uint32_t add_mesh(const MeshDesc& desc, DVec3 position = {}) {
    const std::uint32_t row = add_static({.kind = ShapeKind::kMesh}, position);
    auto mesh = std::make_shared<state::Mesh>();
    mesh->desc = desc;
    mesh->bvh = geometry::build_bvh(mesh->desc.positions, mesh->desc.triangles);
    colliders.shape[row].mesh = mesh;
    return row;
  }
  /// Moves a body as a step does.
  void move(std::uint32_t body, DVec3 way) { bodies.center[body] = bodies.center[body] + way; }
  /// Pairs all bodies that are not both static with each other, and updates their manifolds.
  void update(Real dt = Real(1) / Real(60)) {
    std::vector<collision::ColliderPair> found;
    for (std::uint32_t a = 0; a < bodies.motion.size(); ++a) {
      for (std::uint32_t b = a + 1; b < bodies.motion.size(); ++b) {
        const bool moves =
            bodies.traits[a].kind == BodyKind::kDynamic || bodies.traits[b].kind == BodyKind::kDynamic;
        if (moves) found.push_back({a, b});
      }
    }
    narrow_phase.merge_pairs(found, pairs);
    counts =
        narrow_phase.update_manifolds(pool, bodies, colliders, materials, {.dt = dt, .substeps = 8}, pairs);
  }
};

}  // namespace hooke::test
