#include "io/motion/motion_names.h"
#include "io/motion/motion_reduce.h"
#include "io/motion/motion_usda_looks.h"
#include "io/motion/motion_usda_physics.h"
#include "io/motion/motion_usda_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace hooke::io {

namespace {

/// Number of vertices that copies of one mesh may have together: some 5 MB of text.
constexpr std::size_t kMostCopied = 100'000;
constexpr double kCameraAspect = 16.0 / 9;
constexpr int kNormalDigits = 4;
constexpr int kPlaceDigits = 7;
constexpr int kBodyDigits = 10;
constexpr const char* kPerVertex = " (\n    interpolation = \"vertex\"\n)";  ///< Metadata of an attribute.

/// A UsdaWriter makes the prims of one file.
class UsdaWriter {
 public:
  explicit UsdaWriter(const MotionJob& job) : job_(job), data_(job.data), sink_(job.path), text_(sink_) {}

  Result<void> write();

 private:
  void put_header();
  void put_materials(const std::vector<MaterialImages>& images);
  void choose_shared();
  void put_still_mesh(const MotionMesh& mesh);
  void put_shared_meshes();
  void put_topology(const MotionMesh& mesh);
  void put_bindings(const MotionMesh& mesh);
  void put_body(std::size_t object);
  void put_pieces(const MotionObject& body);
  void put_way(std::size_t first, const BodyWay& way);
  void put_points(std::size_t object);
  void put_presence(std::size_t object);
  void put_camera();
  void put_joints();
  void put_extent(std::span<const Vec3> points);
  [[nodiscard]] std::vector<std::string> metadata_of(const MotionObject& object,
                                                     const std::vector<std::string>& schemas) const;
  /// Writes an attribute with a value for each key, or with one value where there is one key.
  template <class Put>
  void put_sampled(const char* attribute, const std::vector<std::size_t>& keys, const Put& put_one);

  const MotionJob& job_;
  const MotionData& data_;
  OutputSink sink_;
  UsdaText text_;
  std::vector<std::string> materials_;  ///< Prim of each material.
  std::vector<std::string> prims_;      ///< Name of each object's prim.
  std::vector<bool> shared_;            ///< Whether a mesh stands in the class of meshes.
  std::map<std::pair<Real, Real>, std::size_t>
      surfaces_;  ///< Physical materials by friction and restitution.
  std::size_t left_out_ = 0;
  std::size_t of_points_ = 0;
};

template <class Put>
void UsdaWriter::put_sampled(const char* attribute, const std::vector<std::size_t>& keys,
                             const Put& put_one) {
  if (keys.size() == 1) {
    text_.begin_value(attribute);
    put_one(keys[0]);
    text_.end_value();
    return;
  }
  text_.begin_samples(attribute);
  for (const std::size_t key : keys) {
    text_.begin_sample(key);
    put_one(key);
    text_.end_sample();
  }
  text_.end_samples();
}

void UsdaWriter::put_header() {
  text_.line("#usda 1.0");
  text_.line("(");
  text_.line("    defaultPrim = \"World\"");
  text_.line("    doc = \"Written by Hooke.\"");
  text_.line("    startTimeCode = 0");
  text_.line("    endTimeCode = " + std::to_string(data_.frames.size() - 1));
  text_.line("    framesPerSecond = " + usda_number(data_.frames_per_second));
  text_.line("    timeCodesPerSecond = " + usda_number(data_.frames_per_second));
  text_.line("    metersPerUnit = 1");
  text_.line("    kilogramsPerUnit = 1");
  text_.line("    upAxis = \"Y\"");
  text_.line(")");
  text_.line("");
}

std::vector<std::string> UsdaWriter::metadata_of(const MotionObject& object,
                                                 const std::vector<std::string>& schemas) const {
  std::string list;
  for (const std::string& schema : schemas) list += (list.empty() ? "\"" : ", \"") + schema + "\"";
  std::vector<std::string> lines;
  if (!list.empty()) lines.push_back("prepend apiSchemas = [" + list + "]");
  lines.push_back("customData = { string name = " + usda_string(object.name) + " }");
  return lines;
}

void UsdaWriter::put_materials(const std::vector<MaterialImages>& images) {
  NameBook book(NameStyle::kIdentifier);
  text_.begin("def Scope \"Looks\"");
  for (std::size_t i = 0; i < data_.materials.size(); ++i) {
    materials_.push_back(book.take(data_.materials[i].name, "material"));
    text_.begin("def Material \"" + materials_[i] + "\"");
    put_shaders(text_, data_.materials[i], "/World/Looks/" + materials_[i], images[i]);
    text_.end();
  }
  text_.end();
  text_.begin("def Scope \"Surfaces\"");
  for (const MotionObject& object : data_.objects) {
    if (object.kind != MotionObject::Kind::kBody || !object.collides) continue;
    const auto [entry, is_new] =
        surfaces_.try_emplace({object.friction, object.restitution}, surfaces_.size());
    if (!is_new) continue;
    const std::array<std::string, 1> schemas = {"prepend apiSchemas = [\"PhysicsMaterialAPI\"]"};
    const std::string friction = usda_number(static_cast<double>(object.friction));
    text_.begin("def Material \"surface_" + std::to_string(entry->second) + "\"", schemas);
    text_.line("float physics:dynamicFriction = " + friction);
    text_.line("float physics:staticFriction = " + friction);
    text_.line("float physics:restitution = " + usda_number(static_cast<double>(object.restitution)));
    text_.end();
  }
  text_.end();
}

void UsdaWriter::put_extent(std::span<const Vec3> points) {
  Vec3 low = points[0];
  Vec3 high = low;
  for (const Vec3& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  text_.put_vectors(std::array{low, high}, kPlaceDigits);
}

void UsdaWriter::put_topology(const MotionMesh& mesh) {
  text_.line("uniform token subdivisionScheme = \"none\"");
  const bool two_sided = std::any_of(mesh.parts.begin(), mesh.parts.end(), [&](const ModelPart& part) {
    return data_.materials[part.material].two_sided;
  });
  if (two_sided) text_.line("uniform bool doubleSided = 1");
  text_.begin_value("int[] faceVertexCounts");
  text_.put_indices(std::vector<std::uint32_t>(mesh.indices.size() / 3, 3));
  text_.end_value();
  text_.begin_value("int[] faceVertexIndices");
  text_.put_indices(mesh.indices);
  text_.end_value();
  if (!has_uvs(mesh)) return;
  text_.begin_value("texCoord2f[] primvars:st");
  text_.put("[");
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const auto& uv = mesh.vertices[i].uv;
    text_.put(i > 0 ? ", (" : "(");
    text_.put_number(static_cast<double>(uv[0]));
    text_.put(", ");
    text_.put_number(static_cast<double>(uv[1]));
    text_.put(")");
  }
  text_.put("]");
  text_.put(kPerVertex);
  text_.end_value();
}

void UsdaWriter::put_bindings(const MotionMesh& mesh) {
  const auto binding = [&](const ModelPart& part) {
    return "rel material:binding = </World/Looks/" + materials_[part.material] + ">";
  };
  if (mesh.parts.size() == 1) {
    text_.line(binding(mesh.parts[0]));
    return;
  }
  for (std::size_t i = 0; i < mesh.parts.size(); ++i) {
    const ModelPart& part = mesh.parts[i];
    const std::array<std::string, 1> schemas = {"prepend apiSchemas = [\"MaterialBindingAPI\"]"};
    text_.begin("def GeomSubset \"part_" + std::to_string(i) + "\"", schemas);
    text_.line("uniform token elementType = \"face\"");
    text_.line("uniform token familyName = \"materialBind\"");
    std::vector<std::uint32_t> faces(part.count / 3);
    for (std::uint32_t f = 0; f < faces.size(); ++f) faces[f] = part.first / 3 + f;
    text_.begin_value("int[] indices");
    text_.put_indices(faces);
    text_.end_value();
    text_.line(binding(part));
    text_.end();
  }
}

/// Counts the pieces of each mesh. Meshes of few pieces stand in each of them, where every program finds
/// them; those of many stand once in a class, which is not drawn, and bodies refer to them.
void UsdaWriter::choose_shared() {
  std::vector<std::size_t> users(data_.meshes.size());
  for (const MotionObject& object : data_.objects) {
    for (const MotionPiece& piece : object.pieces) ++users[piece.mesh];
  }
  for (std::size_t i = 0; i < users.size(); ++i) {
    shared_.push_back(users[i] > 1 && users[i] * data_.meshes[i].vertices.size() > kMostCopied);
  }
}

void UsdaWriter::put_still_mesh(const MotionMesh& mesh) {
  const std::vector<Vec3> points = positions_of(mesh);
  std::vector<Vec3> normals;
  for (const ModelVertex& v : mesh.vertices) normals.push_back({v.normal[0], v.normal[1], v.normal[2]});
  put_topology(mesh);
  text_.begin_value("point3f[] points");
  text_.put_vectors(points, kPlaceDigits);
  text_.end_value();
  text_.begin_value("normal3f[] normals");
  text_.put_vectors(normals, kNormalDigits);
  text_.put(kPerVertex);
  text_.end_value();
  text_.begin_value("float3[] extent");
  put_extent(points);
  text_.end_value();
  put_bindings(mesh);
}

void UsdaWriter::put_shared_meshes() {
  if (std::find(shared_.begin(), shared_.end(), true) == shared_.end()) return;
  text_.begin("class Scope \"Meshes\"");
  for (std::size_t i = 0; i < data_.meshes.size(); ++i) {
    if (!shared_[i]) continue;
    const std::array<std::string, 1> schemas = {"prepend apiSchemas = [\"MaterialBindingAPI\"]"};
    text_.begin("def Mesh \"mesh_" + std::to_string(i) + "\"", schemas);
    put_still_mesh(data_.meshes[i]);
    text_.end();
  }
  text_.end();
}

void UsdaWriter::put_presence(std::size_t object) {
  const MotionTrack& track = data_.tracks[object];
  const bool is_late = track.first > 0;
  const bool goes = track.end < data_.frames.size();
  if (!is_late && !goes) return;
  text_.begin_samples("token visibility");
  const auto put_one = [&](std::size_t frame, const char* token) {
    text_.begin_sample(frame);
    text_.put(token);
    text_.end_sample();
  };
  if (is_late) put_one(0, "\"invisible\"");
  put_one(track.first, "\"inherited\"");
  if (goes) put_one(track.end, "\"invisible\"");
  text_.end_samples();
}

void UsdaWriter::put_way(std::size_t first, const BodyWay& way) {
  put_sampled("double3 xformOp:translate", from_frame(first, way.place_keys),
              [&](std::size_t key) { text_.put_vector(way.places[key - first], kBodyDigits); });
  put_sampled("quatf xformOp:orient", from_frame(first, way.rotation_keys),
              [&](std::size_t key) { text_.put_rotation(way.rotations[key - first]); });
  text_.line("uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\"]");
}

void UsdaWriter::put_pieces(const MotionObject& body) {
  for (std::size_t i = 0; i < body.pieces.size(); ++i) {
    const MotionPiece& piece = body.pieces[i];
    const std::string number = std::to_string(i);
    const bool by_triangles = collides_by_triangles(body, piece);
    std::string schemas = shared_[piece.mesh] ? "" : "\"MaterialBindingAPI\"";
    if (by_triangles) {
      schemas +=
          std::string(schemas.empty() ? "" : ", ") + "\"PhysicsCollisionAPI\", \"PhysicsMeshCollisionAPI\"";
    }
    std::vector<std::string> metadata;
    if (!schemas.empty()) metadata.push_back("prepend apiSchemas = [" + schemas + "]");
    if (shared_[piece.mesh]) {
      metadata.push_back("prepend references = </World/Meshes/mesh_" + std::to_string(piece.mesh) + ">");
    }
    text_.begin("def Mesh \"piece_" + number + "\"", metadata);
    if (by_triangles) {
      const bool is_hull = piece.shape.kind == ShapeKind::kHull;
      const bool is_static = body.body_kind == BodyKind::kStatic;
      text_.line(std::string("uniform token physics:approximation = \"") +
                 (is_hull     ? "convexHull"
                  : is_static ? "none"
                              : "convexDecomposition") +
                 "\"");
    }
    put_piece_place(text_, piece, {1, 1, 1});
    if (!shared_[piece.mesh]) put_still_mesh(data_.meshes[piece.mesh]);
    text_.end();
    if (body.collides && !by_triangles) put_collider(text_, piece, "collider_" + number);
  }
}

void UsdaWriter::put_body(std::size_t object) {
  const MotionObject& body = data_.objects[object];
  std::vector<std::string> schemas = physics_schemas(body);
  if (body.collides) schemas.emplace_back("MaterialBindingAPI");
  text_.begin("def Xform \"" + prims_[object] + "\"", metadata_of(body, schemas));
  put_body_physics(text_, body, data_.state(object, data_.tracks[object].first));
  if (body.collides) {
    text_.line("rel material:binding:physics = </World/Surfaces/surface_" +
               std::to_string(surfaces_.at({body.friction, body.restitution})) + ">");
  }
  put_way(data_.tracks[object].first, read_way(data_, object, job_.options.tolerance));
  put_presence(object);
  put_pieces(body);
  text_.end();
}

void UsdaWriter::put_points(std::size_t object) {
  const MotionMesh& mesh = data_.mesh_of(object);
  const MotionTrack& track = data_.tracks[object];
  const std::vector<std::size_t> keys = reduce_points(data_, object, job_.options.tolerance);
  of_points_ += track.end - track.first;
  if (keys.size() > 1) left_out_ += track.end - track.first - keys.size();
  text_.begin("def Mesh \"" + prims_[object] + "\"",
              metadata_of(data_.objects[object], {"MaterialBindingAPI"}));
  put_topology(mesh);
  put_sampled("point3f[] points", keys,
              [&](std::size_t key) { text_.put_vectors(data_.points(object, key), kPlaceDigits); });
  const auto put_normals = [&](std::size_t key) {
    text_.put_vectors(normals_of(mesh, data_.points(object, key)), kNormalDigits);
  };
  if (keys.size() == 1) {
    text_.begin_value("normal3f[] normals");
    put_normals(keys[0]);
    text_.put(kPerVertex);
    text_.end_value();
  } else {
    text_.line("normal3f[] normals" + std::string(kPerVertex));
    put_sampled("normal3f[] normals", keys, put_normals);
  }
  put_sampled("float3[] extent", keys, [&](std::size_t key) { put_extent(data_.points(object, key)); });
  put_presence(object);
  put_bindings(mesh);
  text_.end();
}

void UsdaWriter::put_joints() {
  if (data_.joints.empty()) return;
  NameBook book(NameStyle::kIdentifier);
  std::size_t without_schema = 0;
  text_.begin("def Scope \"Joints\"");
  for (const MotionJoint& joint : data_.joints) {
    const auto end_of = [&](const std::optional<std::uint32_t>& object) {
      if (!object || !data_.is_seen(*object)) return UsdaJointEnd{};
      return UsdaJointEnd{"/World/" + prims_[*object], data_.state(*object, data_.tracks[*object].first)};
    };
    const std::string name = book.take(joint.name, "joint");
    if (!put_joint(text_, joint, name, end_of(joint.a), end_of(joint.b))) ++without_schema;
  }
  text_.end();
  if (without_schema == 0) return;
  job_.summary.notes.push_back(
      std::to_string(without_schema) + (without_schema == 1 ? " hook is" : " hooks are") +
      " left out, as UsdPhysics has no joint of that kind; what is held moves as recorded");
}

void UsdaWriter::put_camera() {
  if (data_.cameras.empty()) return;
  // A film of 24 mm in height, in tenths of the unit of length as USD has it.
  const double focal_length = 12 / std::tan(static_cast<double>(data_.cameras[0].vertical_angle) / 2);
  text_.begin("def Camera \"camera\"");
  text_.line("float2 clippingRange = (" + usda_number(kCameraNear) + ", " + usda_number(kCameraFar) + ")");
  text_.line("float focalLength = " + usda_number(focal_length));
  text_.line("float verticalAperture = 24");
  text_.line("float horizontalAperture = " + usda_number(24 * kCameraAspect));
  put_way(0, camera_way(data_, job_.options.tolerance));
  text_.end();
  note_camera_angle(job_);
}

Result<void> UsdaWriter::write() {
  auto images = write_images(job_, job_.path);
  if (!images) return images.error();
  NameBook book(NameStyle::kIdentifier);
  for (const char* own : {"Looks", "Lights", "camera", "Surfaces", "Meshes", "Joints", "physics_scene"})
    (void)book.take(own, own);
  for (const MotionObject& object : data_.objects) prims_.push_back(book.take(object.name, "object"));
  put_header();
  text_.begin("def Xform \"World\"");
  const DVec3 gravity = vector_cast<double>(data_.gravity);
  text_.begin("def PhysicsScene \"physics_scene\"");
  text_.line("vector3f physics:gravityDirection = " + usda_vector(normalize(gravity)));
  text_.line("float physics:gravityMagnitude = " + usda_number(length(gravity)));
  text_.end();
  put_materials(images.value());
  put_lights(text_, data_);
  put_camera();
  choose_shared();
  put_shared_meshes();
  for (std::size_t i = 0; i < data_.objects.size() && !sink_.error(); ++i) {
    if (!data_.is_seen(i)) continue;
    data_.objects[i].kind == MotionObject::Kind::kBody ? put_body(i) : put_points(i);
    job_.show(static_cast<double>(i + 1) / static_cast<double>(data_.objects.size()));
  }
  put_joints();
  text_.end();
  if (left_out_ > 0) {
    job_.summary.notes.push_back(
        std::to_string(left_out_) + " of " + std::to_string(of_points_) +
        " shapes of ropes, cloths and solids are left out, as those around them blend "
        "to within " +
        length_text(job_.options.tolerance));
  }
  return sink_.finish(job_.summary);
}

}  // namespace

Result<void> write_usda_motion(const MotionJob& job) {
  return UsdaWriter(job).write();
}

}  // namespace hooke::io
