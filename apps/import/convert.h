#pragma once

#include "hooke/model_io.h"

#include "io/model/model_geometry.h"

#include <assimp/scene.h>

namespace hooke::importer {

/// How the file's numbers become Hooke's frame and meters.
struct Frame {
  bool stands_upright = false;  ///< The importer has put a rotation from z up to y up on the root.
  bool stores_srgb = false;     ///< Colors are as on screen, not linear.
  bool names_are_uris = false;  ///< "%20" is a space in the name of an image.
  bool has_materials = true;    ///< Else all is of the default one.
  bool has_normals = true;      ///< Else they are no more than the faces'.
  UpAxis up = UpAxis::kY;       ///< Of the file; not kFormat.
  double scale = 1.0;
  double fit = 0.0;  ///< If positive, replaces `scale`.
};

/// The triangles of all nodes in Hooke's frame. Throws a Refusal for coordinates that are not finite, trees
/// that are too deep and scenes without triangles.
[[nodiscard]] io::Soup convert_scene(const aiScene& scene, const Frame& frame);

}  // namespace hooke::importer
