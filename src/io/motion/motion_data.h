#pragma once

#include "hooke/motion_io.h"

#include "process/new_file.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// \file
/// Holds a recorded motion: what moves in memory, and its frames in a temporary file that writers read as
/// they need them.

namespace hooke {

/// A MotionTrack says in which frames an object is present, and where its records are.
struct MotionTrack {
  std::uint64_t offset = 0;          ///< Offset of the object's record in each frame [bytes].
  std::size_t size = 0;              ///< Size of a record; 0 for a static body [bytes].
  std::size_t first = 0;             ///< First frame with the object.
  std::size_t end = 0;               ///< Frame after the last one; equal to `first` before the first.
  bool is_set = false;               ///< Whether the frame being made has a state of it.
  MotionState still = {};            ///< State of a static body.
  double fastest_spin = 0;           ///< Largest angular speed of all frames [rad/s].
  double radius = 0;                 ///< Largest distance of a body's vertex from its origin [m].
  std::size_t not_finite = 0;        ///< Number of frames that repeat another one.
  std::vector<std::byte> last = {};  ///< Last record, for a frame that is not finite.
};

/// MotionData is what a MotionRecording holds.
struct MotionData {
  std::string path = {};
  double frames_per_second = 0;
  Vec3 gravity = {Real(0), Real(-9.81), Real(0)};  ///< [m/s^2]
  std::vector<MotionLight> lights = {};
  std::optional<std::array<float, 3>> sky = {};  ///< Luminance [cd/m^2].
  std::vector<MotionCamera> cameras = {};        ///< One for each frame, or none.
  std::optional<MotionCamera> camera = {};       ///< That of the frame being made.
  std::vector<MotionMaterial> materials = {};
  std::vector<MotionMesh> meshes = {};
  std::vector<MotionObject> objects = {};
  std::vector<MotionTrack> tracks = {};  ///< One for each object.
  std::vector<MotionJoint> joints = {};
  std::optional<process::NewFile> file = {};  ///< Frames; it is never finished, so that it vanishes.
  std::vector<std::uint64_t> frames = {};     ///< Offset of each frame in the file [bytes].
  std::uint64_t file_size = 0;                ///< [bytes]
  std::vector<std::byte> frame = {};          ///< The frame being made.

  /// Returns the time of a frame [s].
  [[nodiscard]] double time(std::size_t frame_number) const {
    return static_cast<double>(frame_number) / frames_per_second;
  }
  /// Returns the state of an object in a frame in which it is present. It throws std::system_error if the
  /// temporary file cannot be read.
  [[nodiscard]] MotionState state(std::size_t object, std::size_t frame_number) const;
  /// Returns the vertices of an object of points, likewise.
  [[nodiscard]] std::vector<Vec3> points(std::size_t object, std::size_t frame_number) const;
  /// Returns the mesh of an object of points.
  [[nodiscard]] const MotionMesh& mesh_of(std::size_t object) const { return meshes[objects[object].mesh]; }
  /// Tells whether an object is present in some frame.
  [[nodiscard]] bool is_seen(std::size_t object) const { return tracks[object].end > tracks[object].first; }
};

namespace io {

/// The formats that a path may ask for.
enum class MotionFormat : std::uint8_t { kNone, kGlb, kUsda, kCsv, kObj, kPointCaches };

/// Returns the format by the ending of the path, whatever its case; a slash or a folder that exists means
/// point caches.
[[nodiscard]] MotionFormat motion_format(const std::string& path);

/// Tells whether the name of a sequence of .obj files has at most one place for a number, like %04d.
[[nodiscard]] Result<void> check_sequence(const std::string& path);

}  // namespace io

}  // namespace hooke
