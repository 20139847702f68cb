#pragma once

#include "hooke/math.h"
#include "hooke/result.h"
#include "hooke/shape.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// \file
/// Models from files and to files: .3ds .obj .stl .ply .gltf .glb. Part of the library `hooke::io`.
///
/// A file from outside is never parsed in this process: `hooke-import`, a child process with limits on
/// memory, time, depth and size, reads it, and this library reads back one flat, checked format.

namespace hooke {

/// How a surface looks.
struct ModelMaterial {
  std::string name = {};
  std::array<float, 3> color = {0.8f, 0.8f, 0.8f};  ///< Linear base color, each [0, 1].
  float opacity = 1.0f;                             ///< [0, 1]
  float shininess = 16.0f;                          ///< Blinn-Phong exponent.
  std::string texture = {};                         ///< Path of an image beside the model; empty for none.
};

struct ModelVertex {
  std::array<float, 3> position = {};
  std::array<float, 3> normal = {};  ///< Unit length.
  std::array<float, 2> uv = {};
};

/// Triangles of one material: `count` indices from `first` on.
struct ModelPart {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  std::uint32_t material = 0;
};

/// A model as drawn, and as simulated. Hooke's frame: y up, right-handed, counter-clockwise front faces,
/// meters.
struct Model {
  std::vector<ModelVertex> vertices;     ///< As drawn: seams and creases keep their own vertices.
  std::vector<std::uint32_t> indices;    ///< Three per triangle, into `vertices`.
  std::vector<ModelPart> parts;          ///< Cover `indices`.
  std::vector<ModelMaterial> materials;  ///< At least one.
  MeshDesc mesh;  ///< As simulated: vertices welded by position, degenerate triangles gone.
  std::vector<std::uint32_t> welded_of;  ///< For each drawn vertex, its vertex in `mesh`.
};

enum class UpAxis : std::uint8_t {
  kFormat,  ///< What the format says: z for .3ds and .stl, y for the others.
  kX,
  kY,
  kZ,
};

struct ImportOptions {
  UpAxis up = UpAxis::kFormat;
  double scale = 1.0;  ///< Meters per unit of the file. Positive.
  std::optional<double> fit =
      {};  ///< Replaces `scale`: the longest side of the bounding box becomes this long [m].
};

/// Reads a model. Errors carry the path; nothing is left behind. Limits: 1 GiB and 10 s for the child, 256
/// MiB for the file, 2^24 vertices, 2^25 triangles.
[[nodiscard]] Result<Model> import_model(const std::string& path, const ImportOptions& options = {});

/// Writes .obj, .stl, .glb or .3ds by the path's ending: to a temporary file first, renamed when it is
/// complete.
[[nodiscard]] Result<void> export_model(const Model& model, const std::string& path);

/// A model of one gray material from triangles, flat-shaded where the surface turns more than `crease` [rad].
[[nodiscard]] Model model_of(const MeshDesc& mesh, double crease = 0.7);

}  // namespace hooke
