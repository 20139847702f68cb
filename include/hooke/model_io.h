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
/// memory, time, depth and size and, where the kernel allows it, without files and network, reads it, and
/// this library reads back one flat, checked format.

namespace hooke {

/// How a surface looks.
struct ModelMaterial {
  std::string name = {};
  std::array<float, 3> color = {0.8f, 0.8f, 0.8f};  ///< Linear base color, each [0, 1].
  float opacity = 1.0f;                             ///< [0, 1]
  float shininess = 16.0f;                          ///< Blinn-Phong exponent.
  std::string texture = {};  ///< Path of an image, which the color multiplies; empty for none.
};

struct ModelVertex {
  std::array<float, 3> position = {};
  std::array<float, 3> normal = {};  ///< Unit length.
  std::array<float, 2> uv = {};  ///< u to the right, v up: v = 0 is the image's bottom row. May leave [0, 1].
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
  std::vector<ModelPart> parts;          ///< Cover `indices`, in order, without gaps.
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

/// Reads a model: all nodes of all meshes, moved to their places; keyframes, lights and cameras are left out.
///
/// - Polygons become triangles; points, lines and triangles without height are dropped.
/// - A closed surface gets its outside outside, whatever way the file winds it; a cavity stays a cavity.
/// - Normals are the file's (from smoothing groups in .3ds) where they agree with the faces; else they are
///   made, flat where the surface turns more than 0.7 rad. .stl has none worth reading.
/// - A texture is looked up by its bare name, upper and lower case being the same, in the model's own folder
///   and nowhere else; one that is missing, or embedded in a .glb, is left out and the color stays. In .3ds
///   and .obj the image stands for the color, which becomes white. Colors of vertices are not read.
///
/// Errors name the path, and the reason in one line; no process, file or descriptor is left behind. Limits:
/// 1 GiB and 10 s for the child, 15 s in all, 256 MiB for the file and those it needs, which must be regular
/// files beside it, 2^24 vertices, 2^25 triangles, nodes 64 deep. Symbolic links that lead out of the model's
/// folder are refused: of the model, with an Error; of what belongs to it, as if it were missing. Any thread
/// may call it, several at a time.
///
/// The child is $HOOKE_IMPORT if that is set; else `hooke-import` beside the running program; else the one
/// installed with this library, as find_package(Hooke) found it or as it was configured; else the one in
/// PATH.
[[nodiscard]] Result<Model> import_model(const std::string& path, const ImportOptions& options = {});

/// Writes the drawn half of a model in meters: .obj (and .mtl beside it), .glb (y up), .stl or .3ds (z up),
/// by the path's ending. To a temporary file first, flushed and renamed when complete: an Error leaves the
/// old file. Refuses a model without triangles, with indices or parts out of range, or with a coordinate that
/// is not finite. Images are named, not copied. .3ds keeps creases as smoothing groups and 8 bits a color;
/// .stl keeps the shape alone.
[[nodiscard]] Result<void> export_model(const Model& model, const std::string& path);

/// A model of one gray material from triangles, flat-shaded where the surface turns more than `crease` [rad].
/// Wound and cleaned as by import_model; triangles with a bad index or a coordinate that is not finite are
/// left out, so the model may be empty.
[[nodiscard]] Model model_of(const MeshDesc& mesh, double crease = 0.7);

/// Names the folder of the installed importer; the first call counts. Always true.
bool set_importer_folder(const char* folder) noexcept;

#ifdef HOOKE_IMPORTER_FOLDER
/// find_package(Hooke COMPONENTS io) knows where it found the package, which may be under any prefix.
[[maybe_unused]] inline const bool kImporterFolderIsSet = set_importer_folder(HOOKE_IMPORTER_FOLDER);
#endif

}  // namespace hooke
