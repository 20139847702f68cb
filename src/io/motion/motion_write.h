#pragma once

#include "hooke/motion_io.h"

#include "io/motion/motion_data.h"
#include "process/new_file.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

/// \file
/// What the writers of motions share. Each writer reads a recording and puts files together; errors are
/// values, but for reading the temporary file, which throws std::system_error.

namespace hooke::io {

/// An OutputSink writes a file through a buffer, and remembers the first error.
class OutputSink {
 public:
  /// Opens the file; finish() gives it its name.
  explicit OutputSink(const std::string& path);

  void put(std::span<const std::byte> bytes);
  void put(std::string_view text) { put(std::as_bytes(std::span(text))); }
  /// Writes a value as it lies in memory, little-endian.
  template <class T>
  void put_value(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    put(std::as_bytes(std::span(&value, 1)));
  }
  /// Writes a number as the shortest text of at most `digits` significant digits, whatever the locale.
  void put_number(double value, int digits = 7);

  /// Returns the number of bytes that were put.
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Returns the first error, if there is one.
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }
  /// Appends what another sink has written, which must be unfinished.
  void append(OutputSink& other);
  /// Completes the file and adds it to the summary.
  Result<void> finish(MotionSummary& summary);

 private:
  void flush();

  std::string path_;
  std::optional<process::NewFile> file_;
  std::vector<std::byte> buffer_;
  std::uint64_t size_ = 0;
  std::optional<Error> error_;
};

/// A MotionJob is one call of write_motion.
struct MotionJob {
  const MotionData& data;
  std::string path;
  const MotionOptions& options;
  MotionSummary& summary;

  /// Tells the caller how far the work is, in [0, 1].
  void show(double part) const {
    if (options.progress) options.progress(part);
  }
};

/// Returns the unit normals of a mesh whose vertices are at `points`: of each group of vertices the sum over
/// its triangles, by area. (0, 1, 0) where all triangles have shrunk to nothing.
[[nodiscard]] std::vector<Vec3> normals_of(const MotionMesh& mesh, std::span<const Vec3> points);

/// Returns the unit tangents of a mesh whose vertices are at `points` with `normals`: of each vertex the
/// direction in which its texture goes to the right, at right angles to the normal. Any such direction where
/// the texture has none.
[[nodiscard]] std::vector<Vec3> tangents_of(const MotionMesh& mesh, std::span<const Vec3> points,
                                            std::span<const Vec3> normals);

/// Returns for each vertex 1 if its texture goes up along cross(normal, tangent), and -1 if it is mirrored.
[[nodiscard]] std::vector<float> mirrors_of(const MotionMesh& mesh);

/// Returns the positions of the vertices of a mesh.
[[nodiscard]] std::vector<Vec3> positions_of(const MotionMesh& mesh);

/// Tells whether a mesh has texture coordinates other than zero.
[[nodiscard]] bool has_uvs(const MotionMesh& mesh);

/// Writes a length with a unit that suits it, such as "0.1 mm".
[[nodiscard]] std::string length_text(double meters);

/// Returns the roughness of a material, by its shininess if it has none of its own.
[[nodiscard]] float roughness_of(const MotionMaterial& material);

/// Tells whether a material has an image of any kind, which needs texture coordinates.
[[nodiscard]] bool has_images(const MotionMaterial& material);

/// Returns the smallest rotation from -z, along which lights of glTF and USD shine, to `direction`.
[[nodiscard]] Quaternion<double> rotation_of_light(Vec3 direction);

/// What is nearer to a camera or farther from it than these [m] is not seen.
inline constexpr double kCameraNear = 0.01;
inline constexpr double kCameraFar = 1000;

/// Notes that a format keeps the angle of the first frame, if the angle changes.
void note_camera_angle(const MotionJob& job);

/// Names of the files of a material's images; empty for none.
struct MaterialImages {
  std::string color;
  std::string normals;
  std::string roughness;
};

/// Writes the images of materials beside the file at `path`, as "FILE_IMAGE", so that those of two scenes do
/// not overwrite each other. Returns their names for each material.
[[nodiscard]] Result<std::vector<MaterialImages>> write_images(const MotionJob& job, const std::string& path);

/// Returns an Error if the disk of a file has no room for so many bytes. Where that cannot be told there is
/// none.
[[nodiscard]] Result<void> check_space(const std::string& path, double bytes);

/// Which halves of a motion a .glb file holds.
enum class GlbContent : std::uint8_t {
  kAll,
  /// Objects of points stand still, and name their point caches.
  kBodiesMove,
};

/// Writes one .glb file. `caches` has the name of the point cache of each object, for kBodiesMove.
Result<void> write_glb_motion(const MotionJob& job, GlbContent content,
                              const std::vector<std::string>& caches = {});
Result<void> write_usda_motion(const MotionJob& job);
Result<void> write_csv_motion(const MotionJob& job);
Result<void> write_obj_motion(const MotionJob& job);
Result<void> write_point_caches(const MotionJob& job);

}  // namespace hooke::io
