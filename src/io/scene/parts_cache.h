#pragma once

#include "hooke/scene_io.h"

#include "geometry/solid/parts_listener.h"

#include <cstdint>
#include <string>

namespace hooke::io {

/// Keeps the convex parts of meshes in files of a folder, one for each mesh and its limits, so that they are
/// made once. A file that is missing, broken or of another version is as none; a folder that cannot be
/// written keeps nothing. Meshes of less than `kCachedTriangles` are not worth a file.
class PartsCache : public geometry::PartsListener {
 public:
  /// Reports to `options.progress` and keeps files in `options.cache`; either may be empty.
  explicit PartsCache(const LoadOptions& options) : options_(options) {}

  std::vector<MeshDesc> recall(const MeshDesc& mesh, Real concavity_max, int parts_max) override;
  void keep(const MeshDesc& mesh, Real concavity_max, int parts_max,
            const std::vector<MeshDesc>& parts) override;
  void advance(double part) override;

  static constexpr std::size_t kCachedTriangles = 500;

 private:
  const LoadOptions& options_;
};

}  // namespace hooke::io
