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

DVec3 origin_near(DVec3 place) {
  const auto snap = [](double x) { return kOriginStep * std::round(x / kOriginStep); };
  return {snap(place.x), snap(place.y), snap(place.z)};
}

render::Light light_of(const SceneLight& light, const DVec3& origin) {
  render::Light drawn;
  switch (light.kind) {
    case SceneLight::Kind::kDirectional:
      drawn.kind = render::Light::Kind::kDirectional;
      break;
    case SceneLight::Kind::kPoint:
      drawn.kind = render::Light::Kind::kPoint;
      break;
    case SceneLight::Kind::kSpot:
      drawn.kind = render::Light::Kind::kSpot;
      break;
  }
  drawn.position = vector_cast<float>(light.position - origin);
  drawn.direction = vector_cast<float>(light.direction);
  drawn.color = srgb_color_of(light.color);
  drawn.intensity = static_cast<float>(light.intensity);
  drawn.inner_deg = static_cast<float>(light.inner_deg);
  drawn.outer_deg = static_cast<float>(light.outer_deg);
  drawn.casts_shadow = light.shadows;
  return drawn;
}

void set_lights(const SceneState& state, const DVec3& origin, render::DrawList& list) {
  list.sun.intensity = static_cast<float>(state.sky.sun);
  list.sun.color = srgb_color_of(state.sky.sun_color);
  list.sun.direction = -vector_cast<float>(state.sky.sun_direction);
  list.sky.brightness = static_cast<float>(state.sky.brightness);
  list.lights.clear();
  for (const SceneLight& light : state.lights) list.lights.push_back(light_of(light, origin));
}

}  // namespace

void SceneDrawing::record(const Simulation& simulation, double time) {
  const double interval = static_cast<double>(simulation.scene().dt);
  record(capture_.capture(simulation, time), interval);
}

void SceneDrawing::record(SceneState state, double step) {
  std::swap(previous_, current_);
  current_ = std::move(state);
  // A step's time is a sum, so that half a step early still counts as in time.
  const double due_time =
      trail_.empty() ? current_.time : trail_.back().time + trail_interval_.value_or(0) - step / 2;
  if (trail_interval_ && current_.time >= due_time) trail_.push_back(current_);
}

Viewpoint SceneDrawing::viewpoint(double time) const {
  return current_.camera ? viewpoint_at(*current_.camera, time) : current_.automatic;
}

SceneState SceneDrawing::between(double time) const {
  SceneState state = current_;
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
  origin_ = origin;
  const auto local = [&](DVec3 p) { return vector_cast<float>(p - origin); };
  list.ground.reset();
  set_lights(current_, origin, list);
  list.camera = {local(view.eye), local(view.target), {0, 1, 0}, view.vertical_fov_deg};
  const float half_fov = 0.5F * view.vertical_fov_deg * std::numbers::pi_v<float> / 180;
  const float pixel = 2 * std::tan(half_fov) / static_cast<float>(std::max(height_px, 1));
  const FigurePlace place = {.pixel = pixel, .eye = list.camera.eye};
  add_trail(origin, place, list);
  const SceneState state = between(time);
  std::vector<Vec3> points;
  std::size_t bounded = 0;
  for (const ObjectState& object : state.objects) {
    points.resize(object.points.size());
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = local(object.points[i]);
    FigurePlace here = place;
    here.position = local(object.pose.position);
    here.rotation = object.pose.rotation;
    here.points = points;
    here.gaps = object.gaps;
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
  for (const SceneState& state : trail_) {
    for (const ObjectState& object : state.objects) {
      const auto kind = object.figure->kind;
      if (kind != SceneObject::Kind::kRope && kind != SceneObject::Kind::kParticles) continue;
      points.clear();
      for (const DVec3& point : object.points) points.push_back(vector_cast<float>(point - origin));
      left.points = points;
      left.gaps = object.gaps;
      add_figure(*object.figure, left, list);
    }
  }
}

std::vector<std::string> SceneDrawing::take_warnings() {
  std::vector<std::string> warnings = capture_.take_warnings();
  warnings.insert(warnings.end(), warnings_.begin(), warnings_.end());
  warnings_.clear();
  return warnings;
}

}  // namespace hooke::app
