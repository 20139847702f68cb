#pragma once

#include "io/motion/motion_data.h"

#include <cstddef>
#include <span>
#include <vector>

/// \file
/// Chooses which frames of a track to keep, so that straight motion between them is near enough. Each key is
/// a frame as it was recorded. The search is greedy: a key is as late as the keys before it allow.

namespace hooke::io {

/// Returns the keys of places: between two keys each place is within `tolerance` of the straight line. The
/// first and the last frame are keys; where nothing moves by more than `tolerance` the first one is alone.
[[nodiscard]] std::vector<std::size_t> reduce_places(std::span<const DVec3> places, double tolerance);

/// Returns the keys of rotations: within `angle` [rad] of each frame, whether readers turn at constant speed
/// (slerp) or blend the components of quaternions (nlerp). Neighbors must have the same sign.
[[nodiscard]] std::vector<std::size_t> reduce_rotations(std::span<const Quat> rotations, double angle);

/// Gives quaternions the signs by which each is nearer to the one before it: q and -q are one rotation, and
/// blending takes the short way between equal signs only.
void align_signs(std::vector<Quat>& rotations);

/// A BodyWay is the way of a body or of the camera, and the keys that suffice for it, from its first frame
/// on.
struct BodyWay {
  std::vector<DVec3> places;  ///< [m]
  std::vector<Quat> rotations;
  std::vector<std::size_t> place_keys;     ///< Indices into `places`.
  std::vector<std::size_t> rotation_keys;  ///< Indices into `rotations`.
};

/// Reads the way of a body. Places and rotations have half of the tolerance each, so that no vertex of the
/// body is off by more than all of it [m].
[[nodiscard]] BodyWay read_way(const MotionData& data, std::size_t object, double tolerance);

/// Returns the way of the camera of glTF and USD, which looks along -z and has y up. What it looks at is off
/// by no more than the tolerance [m]. There must be cameras.
[[nodiscard]] BodyWay camera_way(const MotionData& data, double tolerance);

/// Returns keys as numbers of frames of the recording.
[[nodiscard]] std::vector<std::size_t> from_frame(std::size_t first, std::vector<std::size_t> keys);

/// Returns the keys of the vertices of an object of points, as numbers of frames in which it is present,
/// likewise. It reads the frames once.
[[nodiscard]] std::vector<std::size_t> reduce_points(const MotionData& data, std::size_t object,
                                                     double tolerance);

}  // namespace hooke::io
