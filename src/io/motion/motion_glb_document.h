#pragma once

#include "io/motion/motion_write.h"

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

namespace hooke::io {

using Json = nlohmann::ordered_json;

/// What a view of the binary chunk is for, by the constants of OpenGL that glTF uses.
enum class GlbTarget : int { kNone = 0, kVertices = 34962, kIndices = 34963 };

/// A GlbDocument is the two chunks of a .glb file: JSON in memory, numbers in a temporary file.
class GlbDocument {
 public:
  /// Begins a document whose numbers are kept beside `path` until write().
  explicit GlbDocument(const std::string& path);

  /// Returns the JSON, to which nodes, meshes and animations are added.
  [[nodiscard]] Json& json() { return json_; }

  /// Adds numbers and returns their accessor: `type` is SCALAR, VEC2, VEC3 or VEC4. `has_bounds` adds the
  /// least and the largest of each component, which glTF asks for of positions and times.
  std::size_t add_floats(std::span<const float> numbers, const char* type, GlbTarget target, bool has_bounds);
  /// Adds indices, as 16 bits where they fit, and returns their accessor.
  std::size_t add_indices(std::span<const std::uint32_t> indices);
  /// Adds bytes, such as an image, and returns their view.
  std::size_t add_bytes(std::span<const std::byte> bytes);
  /// Appends an object to a list of the document, which is made if there is none, and returns its number.
  std::size_t append(const char* list, Json object);

  /// Puts the file together. Errors: kLimitExceeded beyond 4 GiB, kFileNotWritable.
  Result<void> write(const MotionJob& job, const std::string& path);

 private:
  /// Begins a view of the next bytes at a multiple of four, and returns its number.
  std::size_t begin_view(std::size_t bytes, GlbTarget target);

  Json json_;
  OutputSink numbers_;
};

}  // namespace hooke::io
