#include "hooke/drawing/scene_capture.h"

#include "render/image.h"

#include <algorithm>
#include <array>

namespace hooke::app {

namespace {

constexpr double kFar = 1e30;  ///< A length beyond everything [m].

/// Fields are not drawn, and of hooks only distances are, because others lie within what they hold.
bool is_drawn(const SceneObject& object) {
  if (object.kind == SceneObject::Kind::kHook) {
    return object.hook_kind == HookKind::kDistance && !object.broken;
  }
  return object.kind != SceneObject::Kind::kField;
}

/// Returns a view of everything but half-spaces.
Viewpoint view_of(const SceneState& state) {
  DVec3 low = {kFar, kFar, kFar};
  DVec3 high = {-kFar, -kFar, -kFar};
  const auto extend = [&](DVec3 p) {
    if (!is_finite(p)) return;
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  };
  for (const ObjectState& object : state.objects) {
    for (const DVec3& point : object.points) extend(point);
    if (object.figure->half_space) continue;
    for (const FigureSolid& solid : object.figure->solids) {
      if (solid.geometry.levels.back() == nullptr) continue;
      const Mat4 transform = transform_of(solid);
      for (const render::Vertex& vertex : solid.geometry.levels.back()->vertices) {
        extend(
            object.pose.position +
            vector_cast<double>(rotate(object.pose.rotation, transform_point(transform, vertex.position))));
      }
    }
  }
  return low.x <= high.x ? viewpoint_of_box(low, high) : Viewpoint{};
}

/// Copies where an object is.
void copy_place(const World& world, const SceneObject& object, ObjectState& state) {
  if (object.kind == SceneObject::Kind::kBody) state.pose = world.pose(object.body);
  if (state.figure->reshaped) {
    state.points = world.surface(object.body);
  } else if (object.kind == SceneObject::Kind::kHook) {
    const std::array<DVec3, 2> anchors = world.hook_anchors(object.hook);
    state.points.assign(anchors.begin(), anchors.end());
  } else if (object.kind == SceneObject::Kind::kSolid) {
    state.points = world.surface(object.solid);
  } else {
    const PointView points = positions_of(world, object);
    state.points.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) state.points[i] = points[i];
    if (object.kind == SceneObject::Kind::kRope) state.gaps = world.broken_segments(object.rope);
  }
}

}  // namespace

std::shared_ptr<const render::Image> SceneCapture::find_texture(const std::string& path,
                                                                const ImageBytes& bytes, ImageUse use) {
  const auto [entry, is_new] = textures_.try_emplace({path, bytes, use});
  if (!is_new) return entry->second;
  auto image = bytes ? render::decode_image(*bytes, path) : render::load_image(path);
  if (!image) {
    warnings_.push_back(to_line(image.error()));
    return entry->second;
  }
  entry->second = std::make_shared<render::Image>(
      use == ImageUse::kNormals ? render::normals_of(image.value()) : std::move(image).value());
  return entry->second;
}

namespace {

void paint_ranges(render::Color color, std::vector<PaintedRange>& ranges) {
  for (PaintedRange& range : ranges) range.finish = {.color = color};
}

void paint_figure(render::Color color, Figure& figure) {
  paint_ranges(color, figure.ranges);
  for (FigureSolid& solid : figure.solids) paint_ranges(color, solid.ranges);
}

}  // namespace

std::shared_ptr<Figure> SceneCapture::find_figure(const Simulation& simulation, const SceneObject& object) {
  std::shared_ptr<Figure>& figure = figures_[key_of(object)];
  // What has torn, was cut or has a dent is a new figure; who draws may still have the one before.
  const World& world = simulation.world();
  const std::size_t splits = world.splits(object.cloth).size() + world.splits(object.solid).size();
  const bool is_torn = figure != nullptr && figure->splits != splits;
  const bool is_other = figure != nullptr && figure->reshaped != world.is_reshaped(object.body);
  if (figure == nullptr || is_torn || is_other) {
    figure = std::make_shared<Figure>(make_figure(
        simulation, object,
        [this](const std::string& path, const ImageBytes& bytes, ImageUse use) {
          return find_texture(path, bytes, use);
        },
        geometries_));
    const auto painted = colors_.find(object.name);
    if (painted != colors_.end()) paint_figure(painted->second, *figure);
  }
  return figure;
}

SceneState SceneCapture::capture(const Simulation& simulation, double time) {
  SceneState state;
  state.time = time;
  state.camera = simulation.scene().camera;
  state.sky = simulation.scene().sky;
  state.lights = simulation.scene().lights;
  for (const SceneObject& object : simulation.objects()) {
    if (!is_drawn(object)) continue;
    ObjectState& entry = state.objects.emplace_back();
    entry.figure = find_figure(simulation, object);
    copy_place(simulation.world(), object, entry);
  }
  if (!automatic_) automatic_ = state.camera ? Viewpoint{} : view_of(state);
  state.automatic = *automatic_;
  return state;
}

}  // namespace hooke::app
