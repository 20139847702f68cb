#include "io/model/model_write.h"
#include "io/motion/motion_glb_document.h"
#include "io/motion/motion_names.h"
#include "io/motion/motion_reduce.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace hooke::io {

namespace {

constexpr double kLeastTolerance = 1e-6;  ///< What a tolerance of 0 is raised to [m].
constexpr int kHalvings = 5;              ///< Steps by which the tolerance that suffices is narrowed down.
constexpr float kCutoff = 0.5f;           ///< Alpha of an image below which there is a hole.

void add_vector(std::vector<float>& numbers, Vec3 v) {
  numbers.insert(numbers.end(), {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)});
}

std::vector<float> flat(std::span<const Vec3> vectors) {
  std::vector<float> numbers;
  numbers.reserve(3 * vectors.size());
  for (const Vec3& v : vectors) add_vector(numbers, v);
  return numbers;
}

std::array<float, 3> in_float(DVec3 v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

std::array<float, 4> in_float(Quat rotation) {
  const Quat q = normalize(rotation);
  return {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z), static_cast<float>(q.w)};
}

/// A GlbWriter makes the nodes, meshes and channels of one file.
class GlbWriter {
 public:
  GlbWriter(const MotionJob& job, GlbContent content, const std::vector<std::string>& caches,
            const std::string& path)
      : job_(job), data_(job.data), content_(content), caches_(caches), path_(path), document_(path) {}

  Result<void> write();

 private:
  Json texture_of(const MotionImage& image);
  void use_extension(const char* name);
  void add_materials();
  void add_lights();
  void add_camera();
  [[nodiscard]] bool has_relief(const MotionMesh& mesh) const;
  Json primitives_of(const MotionMesh& mesh, std::span<const Vec3> positions, std::span<const Vec3> normals);
  std::size_t mesh_number(std::uint32_t mesh);
  void add_body(std::size_t object, Json node);
  void add_way(std::size_t first, std::size_t node, const BodyWay& way);
  void add_points(std::size_t object, Json node);
  void add_targets(std::size_t object, Json& mesh, std::span<const std::size_t> keys);
  std::vector<std::size_t> choose_keys(std::size_t object);
  void add_presence(std::size_t object, std::size_t node);
  void add_channel(std::size_t node, const char* path, std::size_t times, std::size_t values,
                   const char* interpolation);
  std::size_t times_of(const std::vector<std::size_t>& keys);
  std::size_t weights_of(std::size_t keys);
  void note_left_out();

  const MotionJob& job_;
  const MotionData& data_;
  GlbContent content_;
  const std::vector<std::string>& caches_;
  const std::string& path_;
  GlbDocument document_;
  NameBook names_{NameStyle::kText};
  std::map<const MotionImage*, std::size_t> textures_;
  std::map<std::uint32_t, std::size_t> meshes_;            ///< Number in the file of each body's mesh.
  std::map<std::vector<std::size_t>, std::size_t> times_;  ///< Accessor of the times of each set of keys.
  std::map<std::size_t, std::size_t> weights_;             ///< Accessor of weights by number of keys.
  Json samplers_ = Json::array();
  Json channels_ = Json::array();
  std::size_t frames_left_out_ = 0;
  std::size_t frames_of_points_ = 0;
};

/// Returns a reference to the texture of an image, which is added when it is first asked for.
Json GlbWriter::texture_of(const MotionImage& image) {
  const auto [entry, is_new] = textures_.try_emplace(&image);
  if (is_new) {
    const bool is_png = !image.bytes.empty() && image.bytes[0] == std::byte{0x89};
    const std::size_t source = document_.append("images", {{"name", image.name},
                                                           {"mimeType", is_png ? "image/png" : "image/jpeg"},
                                                           {"bufferView", document_.add_bytes(image.bytes)}});
    entry->second = document_.append("textures", {{"source", source}});
  }
  return {{"index", entry->second}};
}

void GlbWriter::add_materials() {
  for (const MotionMaterial& material : data_.materials) {
    const auto& c = material.color;
    Json surface = {{"baseColorFactor", {c[0], c[1], c[2], material.opacity}},
                    {"metallicFactor", material.metalness},
                    {"roughnessFactor", roughness_of(material)}};
    if (material.image) surface["baseColorTexture"] = texture_of(*material.image);
    if (material.roughness_map) surface["metallicRoughnessTexture"] = texture_of(*material.roughness_map);
    Json entry = {{"name", material.name}, {"pbrMetallicRoughness", surface}};
    if (material.normal_map) {
      entry["normalTexture"] = texture_of(*material.normal_map);
      entry["normalTexture"]["scale"] = material.normal_scale;
    }
    if (material.transmission > 0.0f) {
      use_extension("KHR_materials_transmission");
      entry["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", material.transmission}};
    }
    if (material.opacity < 1.0f) {
      entry["alphaMode"] = "BLEND";
    } else if (material.cutout) {
      entry["alphaMode"] = "MASK";
      entry["alphaCutoff"] = kCutoff;
    }
    if (material.two_sided) entry["doubleSided"] = true;
    document_.append("materials", std::move(entry));
  }
}

void GlbWriter::use_extension(const char* name) {
  Json& used = document_.json()["extensionsUsed"];
  if (std::find(used.begin(), used.end(), name) == used.end()) used.push_back(name);
}

/// Adds the lights, in lux and candela: a white matte surface of luminance L has an illuminance of pi L.
void GlbWriter::add_lights() {
  if (data_.lights.empty()) return;
  use_extension("KHR_lights_punctual");
  Json lights = Json::array();
  for (const MotionLight& light : data_.lights) {
    const std::string name = names_.take(light.name, "light");
    Json entry = {{"name", name},
                  {"type", "point"},
                  {"color", light.color},
                  {"intensity", std::numbers::pi_v<float> * light.strength}};
    if (light.kind == MotionLight::Kind::kDirectional) entry["type"] = "directional";
    if (light.kind == MotionLight::Kind::kSpot) {
      entry["type"] = "spot";
      entry["spot"] = {{"innerConeAngle", light.inner_angle}, {"outerConeAngle", light.outer_angle}};
    }
    const Quaternion<double> q = rotation_of_light(light.direction);
    Json node = {{"name", name},
                 {"translation", in_float(light.position)},
                 {"rotation", {q.x, q.y, q.z, q.w}},
                 {"extensions", {{"KHR_lights_punctual", {{"light", lights.size()}}}}}};
    lights.push_back(std::move(entry));
    document_.json()["scenes"][0]["nodes"].push_back(document_.append("nodes", std::move(node)));
  }
  document_.json()["extensions"]["KHR_lights_punctual"]["lights"] = std::move(lights);
}

void GlbWriter::add_camera() {
  if (data_.cameras.empty()) return;
  const float angle = data_.cameras[0].vertical_angle;
  const std::string name = names_.take("camera", "camera");
  const std::size_t camera = document_.append(
      "cameras", {{"name", name},
                  {"type", "perspective"},
                  {"perspective", {{"yfov", angle}, {"znear", kCameraNear}, {"zfar", kCameraFar}}}});
  const BodyWay way = camera_way(data_, job_.options.tolerance);
  const std::size_t node = document_.append("nodes", {{"name", name},
                                                      {"camera", camera},
                                                      {"translation", in_float(way.places[0])},
                                                      {"rotation", in_float(way.rotations[0])}});
  document_.json()["scenes"][0]["nodes"].push_back(node);
  add_way(0, node, way);
  note_camera_angle(job_);
}

bool GlbWriter::has_relief(const MotionMesh& mesh) const {
  return std::any_of(mesh.parts.begin(), mesh.parts.end(), [&](const ModelPart& part) {
    return data_.materials[part.material].normal_map != nullptr;
  });
}

Json GlbWriter::primitives_of(const MotionMesh& mesh, std::span<const Vec3> positions,
                              std::span<const Vec3> normals) {
  Json attributes = {{"POSITION", document_.add_floats(flat(positions), "VEC3", GlbTarget::kVertices, true)},
                     {"NORMAL", document_.add_floats(flat(normals), "VEC3", GlbTarget::kVertices, false)}};
  const bool is_textured = std::any_of(mesh.parts.begin(), mesh.parts.end(), [&](const ModelPart& part) {
    return has_images(data_.materials[part.material]);
  });
  if (is_textured || has_uvs(mesh)) {
    std::vector<float> uvs;
    // glTF counts rows of an image from the top.
    for (const ModelVertex& vertex : mesh.vertices) uvs.insert(uvs.end(), {vertex.uv[0], 1 - vertex.uv[1]});
    attributes["TEXCOORD_0"] = document_.add_floats(uvs, "VEC2", GlbTarget::kVertices, false);
  }
  if (has_relief(mesh)) {
    const std::vector<Vec3> tangents = tangents_of(mesh, positions, normals);
    const std::vector<float> mirrors = mirrors_of(mesh);
    std::vector<float> numbers;
    for (std::size_t i = 0; i < tangents.size(); ++i) {
      add_vector(numbers, tangents[i]);
      numbers.push_back(mirrors[i]);
    }
    attributes["TANGENT"] = document_.add_floats(numbers, "VEC4", GlbTarget::kVertices, false);
  }
  Json primitives = Json::array();
  for (const ModelPart& part : mesh.parts) {
    primitives.push_back(
        {{"attributes", attributes},
         {"indices", document_.add_indices(std::span(mesh.indices).subspan(part.first, part.count))},
         {"material", part.material}});
  }
  return primitives;
}

std::size_t GlbWriter::mesh_number(std::uint32_t number) {
  const auto [entry, is_new] = meshes_.try_emplace(number);
  if (is_new) {
    const MotionMesh& mesh = data_.meshes[number];
    std::vector<Vec3> normals;
    for (const ModelVertex& vertex : mesh.vertices) {
      const Vec3 normal = normalize(Vec3{vertex.normal[0], vertex.normal[1], vertex.normal[2]});
      normals.push_back(normal == Vec3{} ? Vec3{0, 1, 0} : normal);
    }
    entry->second =
        document_.append("meshes", {{"primitives", primitives_of(mesh, positions_of(mesh), normals)}});
  }
  return entry->second;
}

std::size_t GlbWriter::times_of(const std::vector<std::size_t>& keys) {
  const auto [entry, is_new] = times_.try_emplace(keys);
  if (is_new) {
    std::vector<float> times;
    times.reserve(keys.size());
    for (const std::size_t key : keys) times.push_back(static_cast<float>(data_.time(key)));
    entry->second = document_.add_floats(times, "SCALAR", GlbTarget::kNone, true);
  }
  return entry->second;
}

void GlbWriter::add_channel(std::size_t node, const char* path, std::size_t times, std::size_t values,
                            const char* interpolation) {
  channels_.push_back({{"sampler", samplers_.size()}, {"target", {{"node", node}, {"path", path}}}});
  samplers_.push_back({{"input", times}, {"interpolation", interpolation}, {"output", values}});
}

/// An object that comes later or goes earlier has no size outside of its time.
void GlbWriter::add_presence(std::size_t object, std::size_t node) {
  const MotionTrack& track = data_.tracks[object];
  std::vector<std::size_t> keys;
  std::vector<float> scales;
  const auto add = [&](std::size_t frame, float scale) {
    keys.push_back(frame);
    scales.insert(scales.end(), {scale, scale, scale});
  };
  if (track.first > 0) add(0, 0);
  if (track.first > 0 || track.end < data_.frames.size()) add(track.first, 1);
  if (track.end < data_.frames.size()) add(track.end, 0);
  if (keys.empty()) return;
  add_channel(node, "scale", times_of(keys), document_.add_floats(scales, "VEC3", GlbTarget::kNone, false),
              "STEP");
}

void GlbWriter::add_body(std::size_t object, Json node) {
  const BodyWay way = read_way(data_, object, job_.options.tolerance);
  node["translation"] = in_float(way.places[0]);
  node["rotation"] = in_float(way.rotations[0]);
  const std::vector<MotionPiece>& pieces = data_.objects[object].pieces;
  const bool is_plain = pieces.size() == 1 && pieces[0].position == Vec3{} && pieces[0].rotation == Quat{};
  if (is_plain) node["mesh"] = mesh_number(pieces[0].mesh);
  for (const MotionPiece& piece : pieces) {
    if (is_plain) continue;
    node["children"].push_back(
        document_.append("nodes", {{"mesh", mesh_number(piece.mesh)},
                                   {"translation", in_float(vector_cast<double>(piece.position))},
                                   {"rotation", in_float(piece.rotation)}}));
  }
  const std::size_t number = document_.append("nodes", std::move(node));
  document_.json()["scenes"][0]["nodes"].push_back(number);
  add_presence(object, number);
  add_way(data_.tracks[object].first, number, way);
}

/// What rests needs no channel: the node has its place.
void GlbWriter::add_way(std::size_t first, std::size_t node, const BodyWay& way) {
  std::vector<float> values;
  if (way.place_keys.size() > 1) {
    for (const std::size_t key : way.place_keys) {
      const auto place = in_float(way.places[key]);
      values.insert(values.end(), place.begin(), place.end());
    }
    const std::size_t output = document_.add_floats(values, "VEC3", GlbTarget::kNone, false);
    add_channel(node, "translation", times_of(from_frame(first, way.place_keys)), output, "LINEAR");
  }
  values.clear();
  if (way.rotation_keys.size() > 1) {
    for (const std::size_t key : way.rotation_keys) {
      const auto turn = in_float(way.rotations[key]);
      values.insert(values.end(), turn.begin(), turn.end());
    }
    const std::size_t output = document_.add_floats(values, "VEC4", GlbTarget::kNone, false);
    add_channel(node, "rotation", times_of(from_frame(first, way.rotation_keys)), output, "LINEAR");
  }
}

/// Raises the tolerance until the object has no more targets than are allowed, by as little as makes them do.
/// The first key is the mesh itself, and needs none.
std::vector<std::size_t> GlbWriter::choose_keys(std::size_t object) {
  double tolerance = job_.options.tolerance;
  std::vector<std::size_t> keys = reduce_points(data_, object, tolerance);
  const auto suffices = [&](const std::vector<std::size_t>& some) {
    return some.size() <= job_.options.most_targets + 1;
  };
  const bool is_raised = !suffices(keys);
  double too_small = tolerance;
  while (!suffices(keys)) {
    too_small = tolerance;
    tolerance = tolerance > 0 ? 2 * tolerance : kLeastTolerance;
    keys = reduce_points(data_, object, tolerance);
  }
  for (int i = 0; i < kHalvings && is_raised; ++i) {
    const double middle = (too_small + tolerance) / 2;
    std::vector<std::size_t> more = reduce_points(data_, object, middle);
    (suffices(more) ? tolerance : too_small) = middle;
    if (suffices(more)) keys = std::move(more);
  }
  if (is_raised) {
    job_.summary.notes.push_back("'" + data_.objects[object].name + "' would need more than " +
                                 std::to_string(job_.options.most_targets) + " morph targets; it keeps " +
                                 std::to_string(keys.size() - 1) + ", and is off by up to " +
                                 length_text(tolerance) +
                                 " between them: more targets or a folder of point caches show it better");
  }
  const MotionTrack& track = data_.tracks[object];
  frames_of_points_ += track.end - track.first;
  if (keys.size() > 1) frames_left_out_ += track.end - track.first - keys.size();
  return keys;
}

/// At key i target i - 1 has the weight 1 and all others have 0, so that blending is along a straight line.
/// Objects with as many keys share the table.
std::size_t GlbWriter::weights_of(std::size_t keys) {
  const auto [entry, is_new] = weights_.try_emplace(keys);
  if (is_new) {
    const std::size_t targets = keys - 1;
    std::vector<float> table(keys * targets, 0.0f);
    for (std::size_t i = 1; i < keys; ++i) table[i * targets + i - 1] = 1.0f;
    entry->second = document_.add_floats(table, "SCALAR", GlbTarget::kNone, false);
  }
  return entry->second;
}

void GlbWriter::add_targets(std::size_t object, Json& mesh, std::span<const std::size_t> keys) {
  const MotionMesh& source = data_.mesh_of(object);
  const std::vector<Vec3> base = data_.points(object, keys[0]);
  const std::vector<Vec3> base_normals = normals_of(source, base);
  const bool with_tangents = has_relief(source);
  const std::vector<Vec3> base_tangents =
      with_tangents ? tangents_of(source, base, base_normals) : std::vector<Vec3>();
  Json targets = Json::array();
  Json names = Json::array();
  for (const std::size_t key : keys.subspan(1)) {
    std::vector<Vec3> points = data_.points(object, key);
    std::vector<Vec3> normals = normals_of(source, points);
    std::vector<Vec3> tangents = with_tangents ? tangents_of(source, points, normals) : std::vector<Vec3>();
    for (std::size_t i = 0; i < tangents.size(); ++i) tangents[i] = tangents[i] - base_tangents[i];
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i] = points[i] - base[i];
      normals[i] = normals[i] - base_normals[i];
    }
    targets.push_back({{"POSITION", document_.add_floats(flat(points), "VEC3", GlbTarget::kVertices, true)},
                       {"NORMAL", document_.add_floats(flat(normals), "VEC3", GlbTarget::kVertices, false)}});
    if (with_tangents) {
      targets.back()["TANGENT"] = document_.add_floats(flat(tangents), "VEC3", GlbTarget::kVertices, false);
    }
    names.push_back("frame_" + std::to_string(key));
  }
  for (Json& primitive : mesh["primitives"]) primitive["targets"] = targets;
  mesh["weights"] = std::vector<float>(keys.size() - 1, 0.0f);
  mesh["extras"] = {{"targetNames", names}};
}

void GlbWriter::add_points(std::size_t object, Json node) {
  const MotionMesh& source = data_.mesh_of(object);
  const MotionTrack& track = data_.tracks[object];
  const bool is_still = content_ == GlbContent::kBodiesMove;
  const std::vector<std::size_t> keys = is_still ? std::vector{track.first} : choose_keys(object);
  const std::vector<Vec3> base = data_.points(object, keys[0]);
  Json mesh = {{"primitives", primitives_of(source, base, normals_of(source, base))}};
  if (keys.size() > 1) add_targets(object, mesh, keys);
  if (is_still) node["extras"] = {{"point_cache", caches_[object]}};
  node["mesh"] = document_.append("meshes", std::move(mesh));
  const std::size_t number = document_.append("nodes", std::move(node));
  document_.json()["scenes"][0]["nodes"].push_back(number);
  add_presence(object, number);
  if (keys.size() > 1) {
    add_channel(number, "weights", times_of(keys), weights_of(keys.size()), "LINEAR");
  }
}

void GlbWriter::note_left_out() {
  if (frames_left_out_ == 0) return;
  job_.summary.notes.push_back(
      std::to_string(frames_left_out_) + " of " + std::to_string(frames_of_points_) +
      " shapes of ropes, cloths and solids are left out, as those around them blend to within " +
      length_text(job_.options.tolerance) +
      (job_.summary.notes.empty() ? "" : " where nothing else is said"));
}

Result<void> GlbWriter::write() {
  document_.json()["scene"] = 0;
  document_.json()["scenes"] = {{{"nodes", Json::array()}}};
  add_materials();
  const std::size_t count = data_.objects.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (!data_.is_seen(i)) continue;
    const MotionObject& object = data_.objects[i];
    Json node = {{"name", names_.take(object.name, "object")}};
    if (object.kind == MotionObject::Kind::kBody) {
      add_body(i, std::move(node));
    } else {
      add_points(i, std::move(node));
    }
    job_.show(static_cast<double>(i + 1) / static_cast<double>(count));
  }
  add_lights();
  add_camera();
  if (!channels_.empty()) {
    document_.append("animations", {{"name", "motion"}, {"samplers", samplers_}, {"channels", channels_}});
  }
  note_left_out();
  return document_.write(job_, path_);
}

}  // namespace

Result<void> write_glb_motion(const MotionJob& job, GlbContent content,
                              const std::vector<std::string>& caches) {
  return GlbWriter(job, content, caches, job.path).write();
}

}  // namespace hooke::io
