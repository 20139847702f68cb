#include "collision/query/queries_ray.h"

#include "geometry/closest.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hooke::collision {

namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();
constexpr DVec3 kUp = {0, 1, 0};

/// The part of a segment that is in all pieces by which it was clipped. A convex solid is what its pieces
/// have in common, so the segment enters it where it enters the last of them.
class RayClip {
 public:
  RayClip(DVec3 origin, DVec3 motion) : motion_(motion) {
    // Fractions count from the point nearest to the shape's origin: a ray from afar keeps its digits.
    const auto nearest = geometry::closest_on_segment({}, origin, origin + motion);
    origin_ = nearest.point;
    start_ = -nearest.fraction;
    enter_ = start_;
    leave_ = 1 - nearest.fraction;
  }

  /// Clips by the half-space dot(normal, x) <= offset.
  void by_plane(DVec3 normal, double offset) {
    const double height = dot(normal, origin_) - offset;
    const double speed = dot(normal, motion_);
    if (speed < 0 && -height / speed >= enter_) {
      enter_ = -height / speed;
      normal_ = normal;
    }
    if (speed > 0) leave_ = std::min(leave_, -height / speed);
    if (speed == 0 && height > 0) miss();
  }

  void by_sphere(double radius) { by_round(origin_, motion_, radius); }
  /// Clips by the endless cylinder about y.
  void by_cylinder(double radius) { by_round({origin_.x, 0, origin_.z}, {motion_.x, 0, motion_.z}, radius); }
  void by_cone(double radius, double half_height);

  [[nodiscard]] std::optional<ShapeHit> hit() const {
    if (!(enter_ <= leave_)) return {};
    if (normal_ == DVec3{}) return ShapeHit{.normal = normalize(-motion_)};
    return ShapeHit{.fraction = std::clamp(enter_ - start_, 0.0, 1.0), .normal = normal_};
  }

 private:
  void miss() { leave_ = -kForever; }
  /// Clips by the points within `radius` of zero, for the ray as it is or as seen along an axis.
  void by_round(DVec3 origin, DVec3 motion, double radius);

  DVec3 origin_ = {};
  DVec3 motion_ = {};
  DVec3 normal_ = {};  // normal where the segment enters; zero while it begins inside
  double start_ = 0;
  double enter_ = 0;
  double leave_ = 0;
};

void RayClip::by_round(DVec3 origin, DVec3 motion, double radius) {
  const double speed_squared = length_squared(motion);
  if (!(speed_squared > 0)) {
    if (length_squared(origin) > radius * radius) miss();
    return;
  }
  const double middle = -dot(origin, motion) / speed_squared;
  const DVec3 nearest = origin + middle * motion;
  const double depth = radius * radius - length_squared(nearest);
  if (depth < 0) return miss();
  const double half = std::sqrt(depth / speed_squared);
  if (middle - half >= enter_) {
    enter_ = middle - half;
    normal_ = normalize(nearest - half * motion);
  }
  leave_ = std::min(leave_, middle + half);
}

/// Clips by the endless cone below its tip. With u the height below the tip and s = radius / (2 half_height),
/// it is f(t) = x^2 + z^2 - s^2 u^2 = a t^2 + 2 b t + c <= 0 and u >= 0.
void RayClip::by_cone(double radius, double half_height) {
  const double s = radius / (2 * half_height);
  const double u = half_height - origin_.y;
  const double u_speed = -motion_.y;
  const double a = motion_.x * motion_.x + motion_.z * motion_.z - s * s * u_speed * u_speed;
  const double b = origin_.x * motion_.x + origin_.z * motion_.z - s * s * u * u_speed;
  const double c = origin_.x * origin_.x + origin_.z * origin_.z - s * s * u * u;
  const double discriminant = b * b - a * c;
  double from = -kForever;
  double to = kForever;
  if (a > 0) {
    // The ray is flatter than the side: it goes in and out again, through the cone or through its mirror
    // image above the tip.
    if (discriminant < 0 || u - b / a * u_speed < 0) return miss();
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    from = q == 0 ? 0 : std::min(q / a, c / q);
    to = q == 0 ? 0 : std::max(q / a, c / q);
  } else if (u_speed == 0) {
    if (c > 0 || u < 0) return miss();  // no motion
  } else {
    // The ray is steeper: it stays in the cone on its descent. Along the side (a = 0) one of the roots is far
    // away.
    const double q = -(b + std::copysign(std::sqrt(std::max(0.0, discriminant)), b));
    if (q == 0 && a == 0) return miss();
    const double roots[2] = {q == 0 ? 0 : c / q, a < 0 ? q / a : -q * kForever};
    from = u_speed > 0 ? std::max(roots[0], roots[1]) : from;
    to = u_speed < 0 ? std::min(roots[0], roots[1]) : to;
  }
  if (from >= enter_) {
    const DVec3 place = origin_ + from * motion_;
    const DVec3 out = geometry::direction_or(DVec3{place.x, 0, place.z}, DVec3{1, 0, 0});
    enter_ = from;
    normal_ = normalize(2 * half_height * out + radius * kUp);
  }
  leave_ = std::min(leave_, to);
}

std::optional<ShapeHit> first_of(const std::optional<ShapeHit>& a, const std::optional<ShapeHit>& b) {
  return !a || (b && b->fraction < a->fraction) ? b : a;
}

std::optional<ShapeHit> cast_ray_on_capsule(double radius, double half_height, DVec3 origin, DVec3 motion) {
  const DVec3 tip = half_height * kUp;
  RayClip upper(origin - tip, motion);
  RayClip lower(origin + tip, motion);
  RayClip side(origin, motion);
  upper.by_sphere(radius);
  lower.by_sphere(radius);
  side.by_cylinder(radius);
  side.by_plane(kUp, half_height);
  side.by_plane(-kUp, half_height);
  // A ray that enters the side through an end entered the sphere of that end before.
  return first_of(first_of(upper.hit(), lower.hit()), side.hit());
}

std::optional<ShapeHit> cast_ray_on_solid(const state::Mesh& mesh, DVec3 origin, DVec3 motion) {
  if (is_solid_at(mesh.planes, origin)) {
    const auto nearest = geometry::find_closest(mesh.bvh, vector_cast<Real>(origin));
    const DVec3 back = motion == DVec3{} ? DVec3{} : normalize(-motion);
    return ShapeHit{.normal = back, .triangle = nearest.value().triangle};
  }
  const auto crossing = cast_ray(mesh.planes, origin, motion, 1.0);
  if (!crossing) return {};
  const DVec3 normal = mesh.planes.nodes[crossing->node].normal;
  return ShapeHit{crossing->fraction, dot(normal, motion) < 0 ? normal : -normal,
                  triangle_at(mesh.planes, crossing->node, origin + crossing->fraction * motion)};
}

std::optional<ShapeHit> cast_ray_on_mesh(const state::Mesh& mesh, DVec3 origin, DVec3 motion) {
  if (mesh.is_solid()) return cast_ray_on_solid(mesh, origin, motion);
  const auto hit = geometry::cast_ray(mesh.bvh, origin, motion, 1.0);
  if (!hit) return {};
  const auto [ia, ib, ic] = mesh.desc.triangles[hit->triangle];
  const auto corner = [&](std::uint32_t i) { return vector_cast<double>(mesh.desc.positions[i]); };
  const DVec3 front = normalize(cross(corner(ib) - corner(ia), corner(ic) - corner(ia)));
  return ShapeHit{hit->fraction, front, hit->triangle};
}

void clip_by_box(RayClip& clip, DVec3 half_extents) {
  const DVec3 h = half_extents;
  for (const double side : {-1.0, 1.0}) {
    clip.by_plane({side, 0, 0}, h.x);
    clip.by_plane({0, side, 0}, h.y);
    clip.by_plane({0, 0, side}, h.z);
  }
}

}  // namespace

std::optional<ShapeHit> cast_ray_on_shape(const state::ColliderShape& collider, DVec3 origin, DVec3 motion) {
  const Shape& shape = collider.shape;
  const auto radius = static_cast<double>(shape.radius);
  const auto half_height = static_cast<double>(shape.half_height);
  RayClip clip(origin, motion);
  switch (shape.kind) {
    case ShapeKind::kHalfSpace:
      clip.by_plane(kUp, 0);
      return clip.hit();
    case ShapeKind::kSphere:
      clip.by_sphere(radius);
      return clip.hit();
    case ShapeKind::kBox:
      clip_by_box(clip, vector_cast<double>(shape.half_extents));
      return clip.hit();
    case ShapeKind::kCylinder:
      clip.by_cylinder(radius);
      clip.by_plane(kUp, half_height);
      clip.by_plane(-kUp, half_height);
      return clip.hit();
    case ShapeKind::kCone:
      clip.by_cone(radius, half_height);
      clip.by_plane(-kUp, half_height);
      return clip.hit();
    case ShapeKind::kHull:
      for (const geometry::ConvexHull::Face& face : collider.hull->faces) {
        clip.by_plane(vector_cast<double>(face.normal), static_cast<double>(face.offset));
      }
      return clip.hit();
    case ShapeKind::kCapsule:
      return cast_ray_on_capsule(radius, half_height, origin, motion);
    case ShapeKind::kMesh:
      return cast_ray_on_mesh(*collider.mesh, origin, motion);
    case ShapeKind::kCompound:
      break;
  }
  return {};
}

}  // namespace hooke::collision
