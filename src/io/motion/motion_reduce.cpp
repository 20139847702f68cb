#include "io/motion/motion_reduce.h"

#include "hooke/geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hooke::io {

namespace {

/// Largest number of frames between two keys of rotations, all of which are compared for each new key.
constexpr std::size_t kMostBetween = 64;

/// A SlopeGate knows which straight lines from a key pass all numbers since then within a tolerance: those
/// whose slopes are in an interval for each number (the "swinging door" of Bristol, 1990, with keys that are
/// frames themselves).
class SlopeGate {
 public:
  SlopeGate(std::size_t count, double tolerance)
      : start_(count), low_(count), high_(count), tolerance_(tolerance) {}

  /// Begins anew at a key.
  void restart(std::span<const double> values) {
    std::copy(values.begin(), values.end(), start_.begin());
    std::fill(low_.begin(), low_.end(), -std::numeric_limits<double>::infinity());
    std::fill(high_.begin(), high_.end(), std::numeric_limits<double>::infinity());
  }

  /// Tells whether the line to `values`, `frames` after the key, passes all numbers in between.
  [[nodiscard]] bool lets_pass(std::span<const double> values, double frames) const {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double slope = (values[i] - start_[i]) / frames;
      if (slope < low_[i] || slope > high_[i]) return false;
    }
    return true;
  }

  /// Narrows the gate so that later lines pass `values` too.
  void narrow(std::span<const double> values, double frames) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double way = values[i] - start_[i];
      low_[i] = std::max(low_[i], (way - tolerance_) / frames);
      high_[i] = std::min(high_[i], (way + tolerance_) / frames);
    }
  }

 private:
  std::vector<double> start_, low_, high_;
  double tolerance_;
};

/// Returns the keys among `count` frames; `read` gives the numbers of a frame. Each component gets a share of
/// the tolerance, so that the length of a vector of three keeps it.
template <class Read>
std::vector<std::size_t> reduce(std::size_t count, std::size_t numbers, double tolerance, const Read& read) {
  if (count == 0) return {};
  const double share = tolerance / std::sqrt(3.0);
  SlopeGate gate(numbers, share);
  std::vector<double> first = read(std::size_t{0});
  std::vector<double> before = first;
  std::vector<std::size_t> keys = {0};
  gate.restart(first);
  bool moves = false;
  for (std::size_t frame = 1; frame < count; ++frame) {
    std::vector<double> now = read(frame);
    for (std::size_t i = 0; i < now.size() && !moves; ++i) moves = std::abs(now[i] - first[i]) > share;
    if (!gate.lets_pass(now, static_cast<double>(frame - keys.back()))) {
      keys.push_back(frame - 1);
      gate.restart(before);
    }
    gate.narrow(now, static_cast<double>(frame - keys.back()));
    before = std::move(now);
  }
  if (!moves) return {0};
  if (keys.back() != count - 1) keys.push_back(count - 1);
  return keys;
}

/// Returns about the angle between two rotations whose quaternions have one sign [rad].
double angle_between(Quaternion<double> a, Quaternion<double> b) {
  const double x = a.x - b.x, y = a.y - b.y, z = a.z - b.z, w = a.w - b.w;
  return 4 * std::asin(std::min(1.0, 0.5 * std::sqrt(x * x + y * y + z * z + w * w)));
}

Quaternion<double> mix(Quaternion<double> a, double s, Quaternion<double> b, double t) {
  return normalize(
      Quaternion<double>{s * a.x + t * b.x, s * a.y + t * b.y, s * a.z + t * b.z, s * a.w + t * b.w});
}

Quaternion<double> in_double(Quat q) {
  return normalize(Quaternion<double>{static_cast<double>(q.x), static_cast<double>(q.y),
                                      static_cast<double>(q.z), static_cast<double>(q.w)});
}

/// Tells whether both ways of blending from frame `from` to frame `to` pass all frames in between.
bool blends_pass(std::span<const Quat> rotations, std::size_t from, std::size_t to, double angle) {
  const Quaternion<double> a = in_double(rotations[from]);
  const Quaternion<double> b = in_double(rotations[to]);
  const double half = std::acos(std::clamp(a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w, -1.0, 1.0));
  // Beyond a quarter turn the frames between decide the way, which blending does not know.
  if (half > 0.8) return to == from + 1;
  for (std::size_t i = from + 1; i < to; ++i) {
    const double part = static_cast<double>(i - from) / static_cast<double>(to - from);
    const Quaternion<double> blended = mix(a, 1 - part, b, part);
    const Quaternion<double> turned =
        half < 1e-6 ? blended : mix(a, std::sin((1 - part) * half), b, std::sin(part * half));
    const Quaternion<double> wanted = in_double(rotations[i]);
    if (angle_between(blended, wanted) > angle || angle_between(turned, wanted) > angle) return false;
  }
  return true;
}

/// Returns the rotation of a camera of glTF and USD, which looks along -z and has y up.
Quat rotation_of_camera(const MotionCamera& camera) {
  const DVec3 forward = normalize(camera.target - camera.eye);
  const DVec3 up = std::abs(forward.y) < 0.99999 ? DVec3{0, 1, 0} : DVec3{0, 0, 1};
  const DVec3 right = normalize(cross(forward, up));
  const Quaternion<double> q = quaternion_from(Matrix3<double>{right, cross(right, forward), -forward});
  return {static_cast<Real>(q.x), static_cast<Real>(q.y), static_cast<Real>(q.z), static_cast<Real>(q.w)};
}

}  // namespace

std::vector<std::size_t> reduce_places(std::span<const DVec3> places, double tolerance) {
  return reduce(places.size(), 3, tolerance, [&](std::size_t i) {
    return std::vector<double>{places[i].x, places[i].y, places[i].z};
  });
}

std::vector<std::size_t> reduce_rotations(std::span<const Quat> rotations, double angle) {
  if (rotations.empty()) return {};
  const Quaternion<double> first = in_double(rotations[0]);
  const bool rests = std::all_of(rotations.begin(), rotations.end(),
                                 [&](const Quat& q) { return angle_between(first, in_double(q)) <= angle; });
  std::vector<std::size_t> keys = {0};
  if (rests) return keys;
  for (std::size_t end = 1; end + 1 < rotations.size(); ++end) {
    const bool is_far = end + 1 - keys.back() > kMostBetween;
    if (is_far || !blends_pass(rotations, keys.back(), end + 1, angle)) keys.push_back(end);
  }
  keys.push_back(rotations.size() - 1);
  return keys;
}

void align_signs(std::vector<Quat>& rotations) {
  for (std::size_t i = 1; i < rotations.size(); ++i) {
    const Quat a = rotations[i - 1];
    Quat& b = rotations[i];
    if (a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w < 0) b = {-b.x, -b.y, -b.z, -b.w};
  }
}

BodyWay read_way(const MotionData& data, std::size_t object, double tolerance) {
  const MotionTrack& track = data.tracks[object];
  BodyWay way;
  const std::size_t count = track.size == 0 ? 1 : track.end - track.first;
  way.places.reserve(count);
  way.rotations.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const MotionState state = data.state(object, track.first + i);
    way.places.push_back(state.position);
    way.rotations.push_back(state.rotation);
  }
  align_signs(way.rotations);
  way.place_keys = reduce_places(way.places, tolerance / 2);
  // The farthest vertex moves by the angle times its distance.
  way.rotation_keys =
      reduce_rotations(way.rotations, std::min(tolerance / 2 / std::max(track.radius, 1e-9), 1.0));
  return way;
}

BodyWay camera_way(const MotionData& data, double tolerance) {
  BodyWay way;
  double farthest = 0;
  for (const MotionCamera& camera : data.cameras) {
    way.places.push_back(camera.eye);
    way.rotations.push_back(rotation_of_camera(camera));
    farthest = std::max(farthest, length(camera.target - camera.eye));
  }
  align_signs(way.rotations);
  way.place_keys = reduce_places(way.places, tolerance / 2);
  way.rotation_keys = reduce_rotations(way.rotations, std::min(tolerance / 2 / farthest, 1.0));
  return way;
}

std::vector<std::size_t> from_frame(std::size_t first, std::vector<std::size_t> keys) {
  for (std::size_t& key : keys) key += first;
  return keys;
}

std::vector<std::size_t> reduce_points(const MotionData& data, std::size_t object, double tolerance) {
  const MotionTrack& track = data.tracks[object];
  std::vector<std::size_t> keys = reduce(
      track.end - track.first, 3 * data.mesh_of(object).vertices.size(), tolerance, [&](std::size_t i) {
        std::vector<double> numbers;
        const std::vector<Vec3> points = data.points(object, track.first + i);
        numbers.reserve(3 * points.size());
        for (const Vec3& p : points) {
          numbers.insert(numbers.end(),
                         {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)});
        }
        return numbers;
      });
  return from_frame(track.first, std::move(keys));
}

}  // namespace hooke::io
