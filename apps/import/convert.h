#pragma once

#include "hooke/model_io.h"

#include "io/model/model_geometry.h"

#include <assimp/scene.h>

namespace hooke::importer {

/// A Frame says how the file's numbers become Hooke's frame and meters.
struct Frame {
  bool stands_upright = false;  ///< Whether the importer has put a rotation from z up to y up on the root.
  bool stores_srgb = false;     ///< Whether colors are sRGB and not linear.
  bool names_are_uris = false;  ///< Whether "%20" is a space in the name of an image.
  bool has_materials = true;    ///< If false, everything has the default material.
  bool has_normals = true;      ///< If false, normals are only those of the faces.
  UpAxis up = UpAxis::kY;       ///< Axis of the file; not kFormat.
  double scale = 1.0;
  double fit = 0.0;  ///< If positive, replaces `scale`.
  ModelOrigin origin = ModelOrigin::kFile;
};

/// Returns the triangles of all nodes in Hooke's frame. Throws a Refusal for coordinates that are not finite,
/// trees that are too deep and scenes without triangles.
[[nodiscard]] io::Soup convert_scene(const aiScene& scene, const Frame& frame);

}  // namespace hooke::importer
