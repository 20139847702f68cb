#include "hooke/drawing/scene_drawing.h"

#include "hooke/clock.h"
#include "hooke/drawing/figure.h"

#include "render/bounding_lines.h"
#include "render/image.h"
#include "render/painter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace hooke::app {

namespace {

/// The list's origin moves in steps, so that shadows and cached buffers stand still while the camera does
/// not.
constexpr double kOriginStep = 64;
constexpr double kFar = 1e30;  ///< A length beyond everything [m].

/// Fields are not drawn, and of hooks only distances are, because others lie within what they hold.
bool is_drawn(const SceneObject& object) {
  if (object.kind == SceneObject::Kind::kHook) {
    return object.hook_kind == HookKind::kDistance && !object.broken;
  }
  return object.kind != SceneObject::Kind::kField;
}

DVec3 origin_near(DVec3 place) {
  const auto snap = [](double x) { return kOriginStep * std::round(x / kOriginStep); };
  return {snap(place.x), snap(place.y), snap(place.z)};
}

}  // namespace

std::shared_ptr<const render::Image> SceneDrawing::find_texture(const std::string& path,
                                                                const ImageBytes& bytes) {
  const auto [entry, is_new] = textures_.try_emplace({path, bytes});
  if (!is_new) return entry->second;
  auto image = bytes ? render::decode_image(*bytes, path) : render::load_image(path);
  if (image) {
    entry->second = std::make_shared<render::Image>(std::move(image).value());
  } else {
    warnings_.push_back(to_line(image.error()));
  }
  return entry->second;
}

std::shared_ptr<Figure> SceneDrawing::find_figure(const Simulation& simulation, const SceneObject& object) {
  std::shared_ptr<Figure>& figure = figures_[key_of(object)];
  if (figure == nullptr) {
    figure = std::make_shared<Figure>(make_figure(
        simulation, object,
        [this](const std::string& path, const ImageBytes& bytes) { return find_texture(path, bytes); },
        geometries_));
  }
  return figure;
}

void SceneDrawing::record(const Simulation& simulation, double time) {
  std::swap(previous_, current_);
  current_.time = time;
  current_.objects.clear();
  for (const SceneObject& object : simulation.objects()) {
    if (!is_drawn(object)) continue;
    ObjectState& state = current_.objects.emplace_back();
    state.figure = find_figure(simulation, object);
    if (object.kind == SceneObject::Kind::kBody) state.pose = simulation.world().pose(object.body);
    if (object.kind == SceneObject::Kind::kHook) {
      const std::array<DVec3, 2> anchors = simulation.world().hook_anchors(object.hook);
      state.points.assign(anchors.begin(), anchors.end());
      continue;
    }
    if (object.kind == SceneObject::Kind::kSolid) {
      state.points = simulation.world().surface(object.solid);
      continue;
    }
    const PointView points = positions_of(simulation.world(), object);
    state.points.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) state.points[i] = points[i];
  }
  // A step's time is a sum, so that half a step early still counts as in time.
  const double half_step = static_cast<double>(simulation.scene().dt) / 2;
  const bool due = trail_.empty() || time >= trail_.back().time + trail_interval_.value_or(0) - half_step;
  if (trail_interval_ && due) trail_.push_back(current_);
  camera_ = simulation.scene().camera;
  if (!camera_ && !automatic_) measure(current_);
}

void SceneDrawing::measure(const State& state) {
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
  automatic_ = low.x <= high.x ? viewpoint_of_box(low, high) : Viewpoint{};
}

Viewpoint SceneDrawing::viewpoint(double time) const {
  if (camera_) return viewpoint_at(*camera_, time);
  return automatic_.value_or(Viewpoint{});
}

SceneDrawing::State SceneDrawing::between(double time) const {
  State state = current_;
  const double span = current_.time - previous_.time;
  if (!(span > 0) || time >= current_.time) return state;
  const double part = std::max(0.0, (time - previous_.time) / span);
  for (std::size_t i = 0; i < state.objects.size(); ++i) {
    ObjectState& object = state.objects[i];
    // Most often the objects are the same in the same order.
    const auto same = [&](const ObjectState& other) { return other.figure == object.figure; };
    const auto& before = previous_.objects;
    const auto found = i < before.size() && same(before[i])
                           ? before.begin() + static_cast<std::ptrdiff_t>(i)
                           : std::find_if(before.begin(), before.end(), same);
    if (found == before.end()) continue;
    object.pose = blend(found->pose, object.pose, part);
    object.points = blend(found->points, object.points, part);
  }
  return state;
}

void SceneDrawing::fill(double time, int height_px, render::DrawList& list) {
  const Viewpoint view = viewpoint(time);
  const DVec3 origin = origin_near(view.target);
  const auto local = [&](DVec3 p) { return vector_cast<float>(p - origin); };
  list.ground.reset();
  list.camera = {local(view.eye), local(view.target), {0, 1, 0}, view.vertical_fov_deg};
  const float half_fov = 0.5F * view.vertical_fov_deg * std::numbers::pi_v<float> / 180;
  const float pixel = 2 * std::tan(half_fov) / static_cast<float>(std::max(height_px, 1));
  const FigurePlace place = {.pixel = pixel, .eye = list.camera.eye};
  add_trail(origin, place, list);
  const State state = between(time);
  std::vector<Vec3> points;
  std::size_t bounded = 0;
  for (const ObjectState& object : state.objects) {
    points.resize(object.points.size());
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = local(object.points[i]);
    FigurePlace here = place;
    here.position = local(object.pose.position);
    here.rotation = object.pose.rotation;
    here.points = points;
    add_figure(*object.figure, here, list);
    if (!object.figure->solids.empty() && !object.figure->half_space) {
      add_bounds(*object.figure, here, bounded++, list);
    }
  }
  if (!style_.painter) return;
  const auto painted = render::paint_in_order(list);
  if (!painted) warnings_.push_back(to_line(painted.error()));
}

void SceneDrawing::add_bounds(const Figure& figure, const FigurePlace& place, std::size_t number,
                              render::DrawList& list) const {
  const std::vector<Preselection>& bounds = style_.bounds;
  if (bounds.empty()) return;
  const Mat4 body = make_transform(place.position, place.rotation, Vec3{1, 1, 1});
  for (const FigureSolid& solid : figure.solids) {
    if (solid.geometry.levels[0] == nullptr) continue;
    render::add_bounding_lines(*solid.geometry.levels[0], transform_of(solid), body,
                               bounds[number % bounds.size()], list.lines);
  }
}

void SceneDrawing::add_trail(const DVec3& origin, const FigurePlace& place, render::DrawList& list) const {
  FigurePlace left = place;
  std::vector<Vec3> points;
  for (const State& state : trail_) {
    for (const ObjectState& object : state.objects) {
      const auto kind = object.figure->kind;
      if (kind != SceneObject::Kind::kRope && kind != SceneObject::Kind::kParticles) continue;
      points.clear();
      for (const DVec3& point : object.points) points.push_back(vector_cast<float>(point - origin));
      left.points = points;
      add_figure(*object.figure, left, list);
    }
  }
}

std::vector<std::string> SceneDrawing::take_warnings() {
  return std::exchange(warnings_, {});
}

}  // namespace hooke::app
