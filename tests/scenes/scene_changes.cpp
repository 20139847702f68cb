#include "scenes/scene_changes.h"

#include <algorithm>
#include <utility>

namespace hooke::test {

namespace {

/// A place, a direction or a velocity.
template <class T>
void mirror(Vector3<T>& v) {
  v.x = -v.x;
}

/// What goes around an axis turns the other way in a mirror that contains the axis.
template <class T>
void mirror_axis(Vector3<T>& axis) {
  axis.y = -axis.y;
  axis.z = -axis.z;
}

void mirror(Quat& rotation) {
  rotation.y = -rotation.y;
  rotation.z = -rotation.z;
}

void mirror(SceneMesh& mesh) {
  for (Vec3& place : mesh.mesh.positions) mirror(place);
  for (auto& triangle : mesh.mesh.triangles) std::swap(triangle[1], triangle[2]);
}

void mirror(SceneHook& hook) {
  if (hook.anchor) mirror(*hook.anchor);
  if (hook.desc.anchor_b) mirror(*hook.desc.anchor_b);
  if (hook.desc.kind == HookKind::kHinge)
    mirror_axis(hook.desc.axis);
  else
    mirror(hook.desc.axis);
}

}  // namespace

Scene mirrored(Scene scene) {
  for (SceneMesh& mesh : scene.meshes) mirror(mesh);
  for (SceneBody& body : scene.objects.bodies) {
    mirror(body.desc.position);
    mirror(body.desc.rotation);
    mirror(body.desc.velocity);
    mirror_axis(body.desc.angular_velocity);
  }
  for (SceneRope& rope : scene.objects.ropes) {
    for (DVec3& place : rope.desc.points) mirror(place);
  }
  for (SceneCloth& cloth : scene.objects.cloths) {
    mirror(cloth.desc.corner);
    mirror(cloth.desc.column_direction);
    mirror(cloth.desc.row_direction);
  }
  for (SceneSolid& solid : scene.objects.solids) mirror(solid.desc.position);
  for (SceneHook& hook : scene.objects.hooks) mirror(hook);
  return scene;
}

Scene reordered(Scene scene) {
  const auto reverse = [](auto& objects) { std::reverse(objects.begin(), objects.end()); };
  reverse(scene.objects.bodies);
  reverse(scene.objects.ropes);
  reverse(scene.objects.cloths);
  reverse(scene.objects.solids);
  reverse(scene.objects.hooks);
  return scene;
}

}  // namespace hooke::test
