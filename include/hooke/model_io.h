#pragma once

#include "hooke/fracture.h"
#include "hooke/math.h"
#include "hooke/result.h"
#include "hooke/shape.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// \file
/// Reads models from files and writes them: .3ds .obj .stl .ply .gltf .glb. Part of the library `hooke::io`.
///
/// A file from outside is never parsed in this process: `hooke-import`, a child process with limits on
/// memory, time, depth and size and, where the kernel allows it, without files and network, reads it, and
/// this library reads back one flat, checked format.

namespace hooke {

/// The bytes of an image's file, shared by all that show it; null for none.
using ImageBytes = std::shared_ptr<const std::vector<std::byte>>;

/// An image that gives figures of a surface, not its color.
struct ModelMap {
  std::string file = {};  ///< Path of the image; of one in `bytes` its name; empty for none.
  ImageBytes bytes = {};  ///< The file of the image, where the model file holds it; null otherwise.
};

/// How a surface looks.
struct ModelMaterial {
  std::string name = {};                            ///< The name in the file; may be empty.
  std::array<float, 3> color = {0.8f, 0.8f, 0.8f};  ///< Linear red, green and blue, each in [0, 1].
  float opacity = 1.0f;                             ///< Opacity; 1 hides what is behind. [0, 1]
  float shininess = 16.0f;                          ///< Blinn-Phong exponent.
  /// Path of an image, which the color multiplies; of one in `image` its name; empty for none.
  std::string texture = {};
  /// The file of the image, where the model file holds it (.glb, data in a .gltf); null for a file of its
  /// own.
  ImageBytes image = {};
  float metalness = 0.0f;               ///< 0 for an insulator, 1 for a metal. [0, 1]
  std::optional<float> roughness = {};  ///< 0 for a mirror, 1 for chalk; by `shininess` without it. [0, 1]
  /// Normals in the frame of the surface: red to the right of the texture, green up, blue outward. An image
  /// of grays is one of heights.
  ModelMap normal_map = {};
  float normal_scale = 1.0f;    ///< Factor of its red and green. [-100, 100]
  ModelMap roughness_map = {};  ///< Its green multiplies the roughness, its blue the metalness (glTF).
};

/// A vertex as it is drawn.
struct ModelVertex {
  std::array<float, 3> position = {};  ///< Place in the model's frame [m].
  std::array<float, 3> normal = {};    ///< Outward normal, of unit length.
  /// Texture coordinates u to the right and v up: v = 0 is the image's bottom row. They may leave [0, 1].
  std::array<float, 2> uv = {};
};

/// The triangles of one material.
struct ModelPart {
  std::uint32_t first = 0;     ///< Position in Model::indices of the first index.
  std::uint32_t count = 0;     ///< Number of indices, three for each triangle.
  std::uint32_t material = 0;  ///< Index into Model::materials.
};

/// A model as it is drawn, and as it is simulated. Its frame is Hooke's: y up, right-handed,
/// counter-clockwise front faces, meters.
struct Model {
  std::vector<ModelVertex> vertices;     ///< Vertices as drawn: seams and creases keep their own.
  std::vector<std::uint32_t> indices;    ///< Three indices into `vertices` for each triangle.
  std::vector<ModelPart> parts;          ///< Parts by material; they cover `indices` in order, without gaps.
  std::vector<ModelMaterial> materials;  ///< At least one material.
  MeshDesc mesh;  ///< The mesh as simulated: vertices welded by position, without degenerate triangles.
  std::vector<std::string> missing_images =
      {};                                ///< Names of images that the file names and that are not there.
  std::vector<std::uint32_t> welded_of;  ///< For each drawn vertex, the index of its vertex in `mesh`.
};

/// The axis of a file that points up.
enum class UpAxis : std::uint8_t {
  kFormat,  ///< The axis of the format: z for .3ds and .stl, y for the others.
  kX,       ///< The x axis.
  kY,       ///< The y axis.
  kZ,       ///< The z axis.
};

/// Where the origin of a model's frame is put.
enum class ModelOrigin : std::uint8_t {
  kFile,    ///< Where the file has it.
  kCenter,  ///< In the center of the bounding box.
  kBottom,  ///< In the center of the lower face of the bounding box, so that the model stands on it.
};

/// How a file is brought into Hooke's frame.
struct ImportOptions {
  UpAxis up = UpAxis::kFormat;  ///< The file's axis that becomes y.
  double scale = 1.0;           ///< Meters per unit of the file, positive.
  /// Replaces `scale`: the longest side of the bounding box becomes this long [m].
  std::optional<double> fit = {};
  ModelOrigin origin = ModelOrigin::kFile;  ///< Where the origin is put, after the axes and the scale.
};

/// Reads a model: all nodes of all meshes, moved to their places. Keyframes, lights and cameras are left out.
///
/// - Polygons become triangles; points, lines and triangles without height are dropped.
/// - A closed surface gets its outside outside, whatever way the file winds it; a cavity stays a cavity.
/// - Normals are the file's (from smoothing groups in .3ds) where they agree with the faces; else they are
///   made, flat where the surface turns more than 0.7 rad. .stl has none worth reading.
/// - A texture is looked up by its bare name, upper and lower case being the same, in the model's own folder
///   and nowhere else; one that is missing is left out, named in Model::missing_images, and the color stays.
///   One in the file itself (.glb) comes with the material. In .3ds and .obj the image stands for the color,
///   which becomes white. Colors of vertices are not read.
/// - Normal maps are those of `normalTexture` (.gltf, .glb), and of `norm`, `map_Bump` and `bump` (.obj);
///   metalness and roughness are those of `pbrMetallicRoughness` with its image, and of `Pm` and `Pr`.
///
/// Errors name the path, and the reason in one line; no process, file or descriptor is left behind. Limits:
/// 1 GiB and 10 s for the child, 15 s in all, 256 MiB for the file and those it needs, which must be regular
/// files beside it, 2^24 vertices, 2^25 triangles, nodes 64 deep. A symbolic link that leads out of the
/// model's folder is refused: with an Error if it is the model, otherwise as if the file were missing. Any
/// thread may call this function, several at a time.
///
/// The child is $HOOKE_IMPORT if that is set; else `hooke-import` beside the running program; else the one
/// installed with this library, as find_package(Hooke) found it or as it was configured; else the one in
/// PATH.
[[nodiscard]] Result<Model> import_model(const std::string& path, const ImportOptions& options = {});

/// Writes the drawn half of a model in meters: .obj (and .mtl beside it), .glb (y up), .stl or .3ds (z up),
/// by the path's ending. It writes a temporary file, and flushes and renames it when it is complete: an Error
/// leaves the old file. PNG and JPEG images go into a .glb, others are copied beside the model, under another
/// name if there is another file of that name; an image that cannot be read is only named. .3ds keeps creases
/// as smoothing groups and 8 bits a color; .stl keeps the shape alone.
///
/// Errors: another ending, a file that cannot be written, a model without triangles, with indices or parts
/// out of range, or with a coordinate that is not finite.
[[nodiscard]] Result<void> export_model(const Model& model, const std::string& path);

/// Writes the cells of a solid (hooke/fracture.h) as an .obj file, each as an object of its own: `cell_0`,
/// ..., in the frame of the whole. Faces of the surface have the material `outside`, and what is seen only
/// when the solid breaks has `inside`; both are in a .mtl file beside it. Files are written as by
/// export_model.
///
/// Errors: another ending, a file that cannot be written.
[[nodiscard]] Result<void> export_cells(const Fracture& fracture, const std::string& path);

/// Makes a model of one gray material from triangles, flat-shaded where the surface turns more than `crease`
/// [rad]. It is wound and cleaned as by import_model. Triangles with a bad index or a coordinate that is not
/// finite are left out, so that the model may be empty.
[[nodiscard]] Model model_of(const MeshDesc& mesh, double crease = 0.7);

/// Names the folder of the installed importer. Only the first call counts. Returns true, so that a constant
/// can call it.
bool set_importer_folder(const char* folder) noexcept;

#ifdef HOOKE_IMPORTER_FOLDER
/// Names the folder in which find_package(Hooke COMPONENTS io) found the package, which may be under any
/// prefix.
[[maybe_unused]] inline const bool kImporterFolderIsSet = set_importer_folder(HOOKE_IMPORTER_FOLDER);
#endif

}  // namespace hooke
