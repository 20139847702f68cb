#include "collision/query/deformable_queries.h"

#include "geometry/box.h"
#include "geometry/closest.h"
#include "geometry/line_triangle.h"
#include "geometry/mesh/winding_number.h"
#include "geometry/ray_slabs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace hooke::collision {

namespace {

using Kind = PointRef::Kind;
using geometry::Segment;
using state::Deformable;
using state::Tables;

constexpr double kNothing = std::numeric_limits<double>::infinity();

bool can_be_found(const Deformable& object, const DeformableFilter& filter) {
  switch (object.kind) {
    case Kind::kRope:
      if (!filter.ropes) return false;
      break;
    case Kind::kCloth:
      if (!filter.cloths) return false;
      break;
    case Kind::kSolid:
      if (!filter.solids) return false;
      break;
    case Kind::kParticles:
      if (!filter.particles) return false;
      break;
    case Kind::kNone:
      return false;
  }
  return state::filters_agree(object.surface.filter, filter.filter);
}

/// What queries see of one object: where the corners of its parts are now, relative to its origin. Corners
/// are points in the maker's order, or the vertices of a solid's skin. The memory serves one object after
/// another.
class Form {
 public:
  Form(const Tables& tables, double margin) : tables_(tables), margin_(margin) {}

  void look_at(std::uint32_t row) {
    row_ = row;
    object_ = &tables_.objects[row];
    place_.clear();
    box_ = {};
    largest_radius_ = 0;
    const state::Rows rows = object_->particles;
    for (std::uint32_t i = 0; i < rows.count; ++i) {
      const state::PositionRecord& record = record_of(i);
      place_.push_back(vector_cast<double>(record.x));
      if (is_round()) largest_radius_ = std::max(largest_radius_, radius_of(i));
    }
    if (object_->skin) place_skin();
    for (const DVec3& x : place_) box_ = merge(box_, x);
    if (object_->kind == Kind::kCloth) find_points_of_rows();
  }

  [[nodiscard]] const Deformable& object() const { return *object_; }
  /// Ropes and particles are as thick as their points say.
  [[nodiscard]] bool is_round() const {
    return object_->kind == Kind::kRope || object_->kind == Kind::kParticles;
  }
  [[nodiscard]] std::uint32_t count() const {
    switch (object_->kind) {
      case Kind::kRope:
        return object_->segments.count;
      case Kind::kCloth:
        return object_->triangles.count;
      case Kind::kSolid:
        return static_cast<std::uint32_t>(object_->skin->triangles.size());
      case Kind::kParticles:
        return object_->particles.count;
      case Kind::kNone:
        break;
    }
    return 0;
  }
  [[nodiscard]] std::array<std::uint32_t, 3> corners_of(std::uint32_t element) const {
    if (object_->kind == Kind::kRope) {
      const bool joins = tables_.segments.joins(object_->segments.first + element);
      return {element, joins ? element + 1 : element, element};  // else the point before the gap
    }
    if (object_->kind == Kind::kParticles) return {element, element, element};
    if (object_->kind == Kind::kSolid) return object_->skin->triangles[element];
    const auto [a, b, c] = tables_.triangles.corners[object_->triangles.first + element];
    const std::uint32_t first = object_->particles.first;
    return {point_of_row_[a - first], point_of_row_[b - first], point_of_row_[c - first]};
  }
  [[nodiscard]] std::array<DVec3, 3> places_of(const std::array<std::uint32_t, 3>& corners) const {
    return {place_[corners[0]], place_[corners[1]], place_[corners[2]]};
  }
  /// Radius at point `i` of a rope or group of particles, margin included [m].
  [[nodiscard]] double radius_of(std::uint32_t i) const {
    return static_cast<double>(record_of(i).radius) + margin_;
  }
  /// Radius by which the surface may reach beyond the box [m].
  [[nodiscard]] double largest_radius() const { return largest_radius_; }
  [[nodiscard]] const geometry::Box3<double>& box() const { return box_; }

  /// Makes a spot of what was found on `element`, relative to the object's origin.
  [[nodiscard]] DeformableSpot spot(std::uint32_t element, const std::array<double, 3>& weights, DVec3 point,
                                    DVec3 normal, double distance) const {
    return {.object = row_,
            .element = element,
            .corners = corners_of(element),
            .weights = weights,
            .point = object_->origin + point,
            .normal = normal,
            .distance = distance};
  }

 private:
  [[nodiscard]] const state::PositionRecord& record_of(std::uint32_t i) const {
    const std::uint32_t first = object_->particles.first;
    return tables_.particles.position[first + tables_.particles.row_of[first + i]];
  }
  void place_skin() {
    skin_.clear();
    for (const state::Skin::Anchor& anchor : object_->skin->vertices) {
      DVec3 x;
      for (std::size_t k = 0; k < 4; ++k)
        x += static_cast<double>(anchor.weights[k]) * place_[anchor.points[k]];
      skin_.push_back(x);
    }
    place_.swap(skin_);
  }
  void find_points_of_rows() {
    const state::Rows rows = object_->particles;
    point_of_row_.resize(rows.count);
    for (std::uint32_t i = 0; i < rows.count; ++i)
      point_of_row_[tables_.particles.row_of[rows.first + i]] = i;
  }

  const Tables& tables_;
  double margin_;
  std::uint32_t row_ = 0;
  const Deformable* object_ = nullptr;
  std::vector<DVec3> place_;
  std::vector<DVec3> skin_;
  std::vector<std::uint32_t> point_of_row_;
  geometry::Box3<double> box_;
  double largest_radius_ = 0;
};

/// Calls visit(form) for each object that the filter finds, in order of creation.
template <class Visit>
void visit_objects(const Tables& tables, const DeformableFilter& filter, Visit&& visit) {
  Form form(tables, static_cast<double>(filter.margin));
  const std::uint32_t skip = state::object_row(tables, filter.skip);
  for (std::uint32_t row = 0; row < tables.objects.size(); ++row) {
    if (row == skip || !can_be_found(tables.objects[row], filter)) continue;
    form.look_at(row);
    visit(form);
  }
}

/// Normal of a triangle's front; up for a triangle without area.
DVec3 front_of(const std::array<DVec3, 3>& corners) {
  return geometry::direction_or(cross(corners[1] - corners[0], corners[2] - corners[0]), DVec3{0, 1, 0});
}

/// Any direction across another one.
DVec3 across(DVec3 along) {
  const DVec3 axis = std::abs(along.y) > 0.9 * length(along) ? DVec3{1, 0, 0} : DVec3{0, 1, 0};
  return geometry::direction_or(axis - (dot(axis, along) / std::max(dot(along, along), 1e-300)) * along,
                                axis);
}

/// The fraction in [0, 1] at which a path enters the ball about `center`; kNothing if it does not.
double enter_ball(DVec3 origin, DVec3 motion, DVec3 center, double radius) {
  const double speed_squared = dot(motion, motion);
  const double middle = dot(center - origin, motion) / speed_squared;
  const DVec3 nearest = origin + middle * motion - center;
  const double depth = radius * radius - dot(nearest, nearest);
  if (depth < 0) return kNothing;
  const double fraction = middle - std::sqrt(depth / speed_squared);
  return fraction >= 0 && fraction <= 1 ? fraction : kNothing;
}

/// The same for the side of the cylinder of `radius` about a segment.
double enter_side(DVec3 origin, DVec3 motion, const Segment<double>& axis, double radius) {
  const DVec3 along = axis.end - axis.start;
  const double length_squared = dot(along, along);
  if (!(length_squared > 0)) return kNothing;
  const auto part_across = [&](DVec3 v) { return v - (dot(v, along) / length_squared) * along; };
  const DVec3 motion_across = part_across(motion);
  if (!(dot(motion_across, motion_across) > 0)) return kNothing;
  const double fraction = enter_ball(part_across(origin - axis.start), motion_across, {}, radius);
  if (fraction == kNothing) return kNothing;
  const double height = dot(origin + fraction * motion - axis.start, along);
  return height >= 0 && height <= length_squared ? fraction : kNothing;
}

/// The fraction at which a path enters the tube of `radius` about a segment with round ends: 0 from within,
/// kNothing if it does not.
double enter_tube(DVec3 origin, DVec3 motion, const Segment<double>& axis, double radius) {
  if (geometry::closest_on_segment(origin, axis.start, axis.end).distance_squared <= radius * radius)
    return 0;
  return std::min({enter_side(origin, motion, axis, radius), enter_ball(origin, motion, axis.start, radius),
                   enter_ball(origin, motion, axis.end, radius)});
}

/// A ray relative to an object, and the first that it has met so far.
struct RaySearch {
  DVec3 origin = {};
  DVec3 motion = {};
  std::optional<DeformableSpot> best = {};

  [[nodiscard]] double limit() const { return best ? best->distance : 1.0; }
  [[nodiscard]] bool is_better(double fraction) const {
    return fraction >= 0 && (best ? fraction < best->distance : fraction <= 1);
  }
};

void cast_on_round(const Form& form, std::uint32_t element, DVec3 origin, RaySearch& search) {
  const auto corners = form.corners_of(element);
  const auto [a, b, c] = form.places_of(corners);
  const double fraction = enter_tube(origin, search.motion, {a, b}, form.radius_of(corners[0]));
  if (!search.is_better(fraction)) return;
  const DVec3 point = origin + fraction * search.motion;
  const auto axis = geometry::closest_on_segment(point, a, b);
  const DVec3 back = normalize(-search.motion);
  const DVec3 out = fraction > 0 ? geometry::direction_or(point - axis.point, back) : back;
  search.best = form.spot(element, {1 - axis.fraction, axis.fraction, 0}, point, out, fraction);
}

void cast_on_triangle(const Form& form, std::uint32_t element, DVec3 origin, RaySearch& search) {
  const auto corners = form.places_of(form.corners_of(element));
  const geometry::LineHit hit = geometry::line_hits_triangle(origin, search.motion, corners);
  if (!std::isfinite(hit.fraction) || !search.is_better(hit.fraction)) return;
  const DVec3 front = front_of(corners);
  const bool turned = form.object().kind == Kind::kCloth && dot(front, search.motion) > 0;
  const DVec3 point = origin + hit.fraction * search.motion;
  search.best = form.spot(element, hit.weights, point, turned ? -front : front, hit.fraction);
}

/// How often the surface of a solid winds about a point, at least a half: the point is inside.
bool is_in_solid(const Form& form, DVec3 point) {
  if (form.object().kind != Kind::kSolid || distance_squared(form.box(), point) > 0) return false;
  double half_angles = 0;
  for (std::uint32_t i = 0; i < form.count(); ++i)
    half_angles += geometry::half_solid_angle(form.places_of(form.corners_of(i)), point);
  return half_angles > std::numbers::pi;
}

/// The nearest place of an object, if it is nearer than `limit` or has `point` inside.
std::optional<DeformableSpot> closest_on_round(const Form& form, DVec3 point, double limit) {
  std::optional<DeformableSpot> best;
  for (std::uint32_t i = 0; i < form.count(); ++i) {
    const auto corners = form.corners_of(i);
    const auto [a, b, c] = form.places_of(corners);
    const auto axis = geometry::closest_on_segment(point, a, b);
    const double radius = form.radius_of(corners[0]);
    const double distance = std::sqrt(axis.distance_squared) - radius;
    if (!(distance <= limit) || (best && distance >= best->distance)) continue;
    const DVec3 out = geometry::direction_or(point - axis.point, across(b - a));
    best = form.spot(i, {1 - axis.fraction, axis.fraction, 0}, axis.point + radius * out, out, distance);
  }
  return best;
}

std::optional<DeformableSpot> closest_on_surface(const Form& form, DVec3 point, double limit) {
  const bool inside = is_in_solid(form, point);
  double nearest = inside ? kNothing : limit * limit;
  std::optional<std::uint32_t> element;
  geometry::TrianglePoint<double> found;
  for (std::uint32_t i = 0; i < form.count(); ++i) {
    const auto [a, b, c] = form.places_of(form.corners_of(i));
    if (distance_squared(geometry::box_of(a, b, c), point) > nearest) continue;
    const auto near = geometry::closest_on_triangle(point, a, b, c);
    if (!(near.distance_squared <= nearest) || (element && near.distance_squared == nearest)) continue;
    nearest = near.distance_squared;
    element = i;
    found = near;
  }
  if (!element) return {};
  const DVec3 front = front_of(form.places_of(form.corners_of(*element)));
  const double distance = std::sqrt(nearest);
  const DVec3 away = inside ? found.point - point : point - found.point;
  return form.spot(*element, {found.weights.x, found.weights.y, found.weights.z}, found.point,
                   geometry::direction_or(away, front), inside ? -distance : distance);
}

std::optional<DeformableSpot> closest_on(const Form& form, DVec3 point, double limit) {
  const DVec3 x = point - form.object().origin;
  // A point deeper in one object than in another is in the boxes of both, so that no box is left out by it.
  const double reach = std::max(limit, 0.0) + form.largest_radius();
  if (distance_squared(form.box(), x) > reach * reach) return {};
  return form.is_round() ? closest_on_round(form, x, limit)
                         : closest_on_surface(form, x, std::max(limit, 0.0));
}

}  // namespace

std::optional<DeformableSpot> cast_ray(const Tables& tables, const DeformableFilter& filter, DVec3 origin,
                                       DVec3 motion) {
  RaySearch search = {origin, motion};
  visit_objects(tables, filter, [&](const Form& form) {
    const DVec3 from = origin - form.object().origin;
    const auto slabs = geometry::RaySlabs::of(from, motion);
    if (!(slabs.enter(form.box(), form.largest_radius()) <= search.limit())) return;
    for (std::uint32_t i = 0; i < form.count(); ++i) {
      form.is_round() ? cast_on_round(form, i, from, search) : cast_on_triangle(form, i, from, search);
    }
  });
  return search.best;
}

std::optional<DeformableSpot> find_closest(const Tables& tables, const DeformableFilter& filter, DVec3 point,
                                           double reach) {
  std::optional<DeformableSpot> best;
  visit_objects(tables, filter, [&](const Form& form) {
    const auto spot = closest_on(form, point, best ? best->distance : reach);
    if (spot && (!best || spot->distance < best->distance)) best = spot;
  });
  return best;
}

void find_near(const Tables& tables, const DeformableFilter& filter, DVec3 point, double reach,
               std::vector<DeformableSpot>& spots) {
  spots.clear();
  visit_objects(tables, filter, [&](const Form& form) {
    if (const auto spot = closest_on(form, point, reach)) spots.push_back(*spot);
  });
}

std::uint32_t point_with_most_weight(const Tables& tables, const DeformableSpot& spot) {
  const Deformable& object = tables.objects[spot.object];
  if (!object.skin) {
    const auto largest = std::max_element(spot.weights.begin(), spot.weights.end());
    return spot.corners[static_cast<std::size_t>(largest - spot.weights.begin())];
  }
  // The three corners of a skin's triangle hang on up to four points each, of which they share some.
  std::array<std::uint32_t, 12> points = {};
  std::array<double, 12> shares = {};
  std::size_t count = 0;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    const state::Skin::Anchor& anchor = object.skin->vertices[spot.corners[corner]];
    for (std::size_t k = 0; k < 4; ++k) {
      const auto* end = points.begin() + count;
      const auto place =
          static_cast<std::size_t>(std::find(points.cbegin(), end, anchor.points[k]) - points.cbegin());
      if (place == count) points[count++] = anchor.points[k];
      shares[place] += spot.weights[corner] * static_cast<double>(anchor.weights[k]);
    }
  }
  return points[static_cast<std::size_t>(std::max_element(shares.begin(), shares.end()) - shares.begin())];
}

}  // namespace hooke::collision
