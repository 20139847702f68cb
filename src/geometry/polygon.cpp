#include "hooke/geometry.h"

#include "base/float_environment.h"
#include "geometry/closest.h"
#include "geometry/orientation.h"
#include "math/trig.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace hooke {

namespace {

constexpr std::size_t kCornersMax = 65536;
constexpr double kThin = 1e-12;  ///< Lengths below this count as zero, over the longest side.

Error refusal(const char* where, std::string message) {
  return {.code = ErrorCode::kOutOfRange, .where = where, .message = std::move(message)};
}

std::string numbered(const char* text, std::size_t k) {
  return std::string(text).append(std::to_string(k));
}

/// The axis along which the plane is seen largest, and whether it is seen from behind.
struct View {
  int axis = 0;
  bool is_from_behind = false;
};

View view_of(DVec3 normal) {
  const DVec3 size = {std::fabs(normal.x), std::fabs(normal.y), std::fabs(normal.z)};
  if (size.x >= size.y && size.x >= size.z) return {0, normal.x < 0};
  if (size.y >= size.z) return {1, normal.y < 0};
  return {2, normal.z < 0};
}

bool is_on_plane(const Polygon& polygon, DVec3 p, double tolerance) {
  return std::fabs(signed_distance(polygon.plane, p)) <= tolerance;
}

/// Whether `p`, projected onto the plane, is within the tolerance of a side.
bool is_on_outline(const Polygon& polygon, DVec3 p, double tolerance) {
  const DVec3 q = p - signed_distance(polygon.plane, p) * polygon.plane.normal;
  const std::size_t count = polygon.corners.size();
  for (std::size_t k = 0; k < count; ++k) {
    const DVec3 next = polygon.corners[(k + 1) % count];
    const double distance = geometry::closest_on_segment(q, polygon.corners[k], next).distance_squared;
    if (distance <= tolerance * tolerance) return true;
  }
  return false;
}

/// Twice the area, along the normal (Newell).
DVec3 area_of(std::span<const DVec3> corners) {
  DVec3 sum = {};
  for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
    sum += cross(corners[k] - corners[0], corners[k + 1] - corners[0]);
  }
  return sum;
}

/// The largest distance of a corner from the first one. Refuses corners that make no polygon.
Result<double> extent_of(std::span<const DVec3> corners) {
  const std::size_t count = corners.size();
  if (count < 3 || count > kCornersMax) {
    return refusal("corners",
                   std::to_string(count) + " corners; a polygon has 3 to " + std::to_string(kCornersMax));
  }
  double extent = 0;
  for (std::size_t k = 0; k < count; ++k) {
    if (!is_finite(corners[k])) return refusal("corners", numbered("not finite: corner ", k));
    extent = std::max(extent, geometry::safe_length(corners[k] - corners[0]));
    if (corners[k] == corners[(k + 1) % count]) {
      return refusal("corners", numbered("at the same place as the next: corner ", k));
    }
  }
  return extent;
}

/// Whether the outline turns around once at most. A star polygon turns in the same direction at every corner,
/// and more than once around.
bool turns_once(std::span<const DVec3> corners, DVec3 normal) {
  const View view = view_of(normal);
  const std::size_t count = corners.size();
  int falls = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double last = geometry::seen_along(view.axis, corners[(k + count - 1) % count]).y;
    const double here = geometry::seen_along(view.axis, corners[k]).y;
    const double next = geometry::seen_along(view.axis, corners[(k + 1) % count]).y;
    if (here > last && here >= next) ++falls;
  }
  return falls <= 1;
}

}  // namespace

Result<Plane> plane_through(DVec3 a, DVec3 b, DVec3 c) {
  const base::FloatEnvironment environment;
  if (!is_finite(a) || !is_finite(b) || !is_finite(c)) return refusal("points", "a point is not finite");
  const double longest =
      std::max({geometry::safe_length(b - a), geometry::safe_length(c - b), geometry::safe_length(a - c)});
  const DVec3 ab = {(b.x - a.x) / longest, (b.y - a.y) / longest, (b.z - a.z) / longest};
  const DVec3 ac = {(c.x - a.x) / longest, (c.y - a.y) / longest, (c.z - a.z) / longest};
  const DVec3 normal = cross(ab, ac);
  if (!(length(normal) > kThin)) return refusal("points", "the three points lie on one line");
  return plane_across(normal, a);
}

Result<Plane> plane_across(DVec3 normal, DVec3 point) {
  const base::FloatEnvironment environment;
  if (!is_finite(normal) || !is_finite(point)) return refusal("plane", "a number is not finite");
  const DVec3 unit = geometry::direction_or(normal, {});
  if (unit == DVec3{}) return refusal("plane", "the normal has no length");
  return Plane{unit, dot(unit, point)};
}

Result<Plane> plane_of_equation(double a, double b, double c, double d) {
  const base::FloatEnvironment environment;
  const DVec3 normal = {a, b, c};
  const double scale = geometry::safe_length(normal);
  if (!is_finite(normal) || !std::isfinite(d / scale)) {
    return refusal("plane", "A, B and C are all zero, or a number is not finite");
  }
  return Plane{geometry::direction_or(normal, {}), -d / scale};
}

int side_of(const Plane& plane, DVec3 p, double tolerance) {
  const double height = signed_distance(plane, p);
  return height > tolerance ? 1 : height < -tolerance ? -1 : 0;
}

Result<Polygon> make_polygon(std::span<const DVec3> corners, double tolerance) {
  const base::FloatEnvironment environment;
  const Result<double> found_extent = extent_of(corners);
  if (!found_extent) return found_extent.error();
  const double extent = found_extent.value();
  const std::size_t count = corners.size();
  Polygon polygon = {.corners = {corners.begin(), corners.end()}};
  const DVec3 area = area_of(corners);
  if (!(geometry::safe_length(area) > kThin * extent * extent) || !is_finite(area)) {
    return refusal("corners", "the polygon has no area");
  }
  DVec3 mean = {};
  for (const DVec3& p : corners) mean += 1 / static_cast<double>(count) * (p - corners[0]);
  const DVec3 normal = geometry::direction_or(area, {});
  polygon.plane = {normal, dot(normal, corners[0] + mean)};
  for (std::size_t k = 0; k < count; ++k) {
    if (!is_on_plane(polygon, corners[k], tolerance)) {
      return refusal("corners", numbered("farther from the plane than the tolerance: corner ", k));
    }
    const DVec3 inward = geometry::direction_or(cross(normal, corners[(k + 1) % count] - corners[k]), {});
    polygon.sides.push_back({inward, dot(inward, corners[k])});
    polygon.is_convex =
        polygon.is_convex && side_of(polygon.sides[k], corners[(k + 2) % count], kThin * extent) >= 0;
  }
  polygon.is_convex = polygon.is_convex && turns_once(corners, normal);
  return polygon;
}

bool is_inside_by_cross_products(const Polygon& polygon, DVec3 p, double tolerance) {
  const base::FloatEnvironment environment;
  if (!is_on_plane(polygon, p, tolerance)) return false;
  const std::size_t count = polygon.corners.size();
  for (std::size_t k = 0; k < count; ++k) {
    const DVec3 side = polygon.corners[(k + 1) % count] - polygon.corners[k];
    const double area = dot(cross(side, p - polygon.corners[k]), polygon.plane.normal);
    if (area < -tolerance * length(side)) return false;
  }
  return true;
}

bool is_inside_by_side_planes(const Polygon& polygon, DVec3 p, double tolerance) {
  const base::FloatEnvironment environment;
  return is_on_plane(polygon, p, tolerance) &&
         std::all_of(polygon.sides.begin(), polygon.sides.end(),
                     [&](const Plane& side) { return side_of(side, p, tolerance) >= 0; });
}

bool is_inside_by_angles(const Polygon& polygon, DVec3 p, double tolerance) {
  const base::FloatEnvironment environment;
  if (!is_on_plane(polygon, p, tolerance)) return false;
  if (is_on_outline(polygon, p, tolerance)) return true;
  const DVec3 normal = polygon.plane.normal;
  const DVec3 q = p - signed_distance(polygon.plane, p) * normal;
  const std::size_t count = polygon.corners.size();
  double sum = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const DVec3 from = polygon.corners[k] - q;
    const DVec3 to = polygon.corners[(k + 1) % count] - q;
    sum += math::atan2(dot(cross(from, to), normal), dot(from, to));
  }
  return std::fabs(sum) > std::numbers::pi;
}

int winding_number(const Polygon& polygon, DVec3 p) {
  const base::FloatEnvironment environment;
  using geometry::Point2;
  const View view = view_of(polygon.plane.normal);
  const Point2 q = geometry::seen_along(view.axis, p);
  const std::size_t count = polygon.corners.size();
  int winding = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const Point2 a = geometry::seen_along(view.axis, polygon.corners[k]);
    const Point2 b = geometry::seen_along(view.axis, polygon.corners[(k + 1) % count]);
    if (a.y <= q.y && b.y > q.y && geometry::orientation(a, b, q) > 0) ++winding;
    if (a.y > q.y && b.y <= q.y && geometry::orientation(a, b, q) < 0) --winding;
  }
  return view.is_from_behind ? -winding : winding;
}

bool is_inside_by_winding(const Polygon& polygon, DVec3 p, double tolerance) {
  const base::FloatEnvironment environment;
  if (!is_on_plane(polygon, p, tolerance)) return false;
  // A point that is off the plane is seen along the normal, as in the other tests.
  const DVec3 q = p - signed_distance(polygon.plane, p) * polygon.plane.normal;
  return winding_number(polygon, q) != 0 || is_on_outline(polygon, p, tolerance);
}

}  // namespace hooke
