#pragma once

#include "hooke/desc.h"
#include "hooke/math.h"
#include "hooke/shape.h"

#include "geometry/box.h"
#include "geometry/convex/convex_hull.h"
#include "state/mesh.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace hooke::state {

/// Data of a collider that depend on the kind of its shape.
struct ColliderShape {
  Shape shape = {};
  std::shared_ptr<const Mesh> mesh;                  ///< Set for kMesh.
  std::shared_ptr<const geometry::ConvexHull> hull;  ///< Set for kHull, and for kBox as the hull that it is.
  std::shared_ptr<const Mesh> whole = {};  ///< For kHull: the concave solid that the hull is a part of, or
                                           ///< null.
};

/// Shapes of bodies, in columns. A body's colliders are consecutive rows; a removed body leaves holes.
struct Colliders {
  static constexpr std::uint32_t kNoBody = 0xFFFFFFFF;

  std::vector<std::uint32_t> body;  ///< Row of the body; kNoBody for a hole.
  std::vector<ColliderShape> shape;
  std::vector<Vec3> position;  ///< Position of the shape's frame from the body's center of mass, in the
                               ///< body's frame [m].
  std::vector<Quat> rotation;  ///< Rotation of the shape's frame in the body's.
  std::vector<ContactDesc> surface;
  std::vector<geometry::Box> bounds;  ///< Box in the world, with margin, rounded outward; written by detect.

  [[nodiscard]] int count() const { return static_cast<int>(body.size()); }

  template <class Self, class Visit>
  static void for_each_column(Self& self, Visit&& visit) {
    visit(self.body);
    visit(self.shape);
    visit(self.position);
    visit(self.rotation);
    visit(self.surface);
    visit(self.bounds);
  }
};

}  // namespace hooke::state
