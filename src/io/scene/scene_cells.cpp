#include "geometry/closest.h"
#include "geometry/mesh/winding_number.h"
#include "io/scene/scene_check.h"
#include "io/scene/scene_data.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

/// \file
/// Finds the cell of a fractured body that a hook means.

namespace hooke::io {

namespace {

/// Distance of a place in a mesh's frame from the solid inside it [m]; 0 inside.
double distance_to_solid(const MeshDesc& mesh, DVec3 place) {
  double least = std::numeric_limits<double>::infinity();
  double half_angles = 0;
  for (const auto& t : mesh.triangles) {
    const auto corner = [&](std::size_t k) { return vector_cast<double>(mesh.positions[t[k]]); };
    const std::array<DVec3, 3> corners = {corner(0), corner(1), corner(2)};
    half_angles += geometry::half_solid_angle(corners, place);
    const DVec3 near = geometry::closest_on_triangle(place, corners[0], corners[1], corners[2]).point;
    least = std::min(least, length(place - near));
  }
  return half_angles > std::numbers::pi ? 0 : least;
}

}  // namespace

const SceneObject* find_cell(const SimulationData& data, const EndName& end, DVec3 place) {
  const SceneObject* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const SceneObject& object : data.objects) {
    const std::optional<CopyName> copy = take_copy_name(object.name);
    if (!copy || copy->array != end.object || object.model == nullptr) continue;
    if (!end.connection_point.empty()) {
      const HookEnd named = {.body = object.body, .connection_point = end.connection_point};
      if (data.world.find_place(named)) return &object;
      continue;
    }
    const Pose pose = data.world.pose(object.body);
    const Quat turn = pose.rotation;
    const DVec3 own =
        rotate(conjugate(Quaternion<double>{turn.x, turn.y, turn.z, turn.w}), place - pose.position);
    const double distance = distance_to_solid(object.model->mesh, own);
    if (!(distance < least)) continue;
    least = distance;
    best = &object;
  }
  return best;
}

}  // namespace hooke::io
