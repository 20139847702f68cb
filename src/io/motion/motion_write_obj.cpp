#include "io/model/model_write.h"
#include "io/motion/motion_names.h"
#include "io/motion/motion_write.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace hooke::io {

namespace {

namespace fs = std::filesystem;

/// A Sequence gives a name to each frame: by the "%04d" in the path, or by a number put before its ending.
class Sequence {
 public:
  /// Reads the path. `fault` is not empty for a path with another percent sign.
  explicit Sequence(const std::string& path) {
    const std::size_t percent = path.find('%');
    if (percent == std::string::npos) {
      const fs::path ending = fs::path(path).extension();
      front_ = path.substr(0, path.size() - ending.string().size()) + "_";
      back_ = ending.string();
      return;
    }
    std::size_t end = percent + 1;
    while (end < path.size() && std::isdigit(static_cast<unsigned char>(path[end])) != 0) ++end;
    const std::string digits = path.substr(percent + 1, end - percent - 1);
    const bool is_sound = end < path.size() && path[end] == 'd' && digits.size() <= 2 &&
                          path.find('%', end) == std::string::npos;
    if (!is_sound) {
      fault = "has a % that is not like %04d; write one such place for the number of the frame";
      return;
    }
    front_ = path.substr(0, percent);
    back_ = path.substr(end + 1);
    width_ = digits.empty() ? 1 : static_cast<std::size_t>(std::stoi(digits));
  }

  [[nodiscard]] std::string name(std::size_t number) const {
    const std::string digits = std::to_string(number);
    return front_ + std::string(digits.size() < width_ ? width_ - digits.size() : 0, '0') + digits + back_;
  }
  /// Returns the path of the materials of all frames.
  [[nodiscard]] std::string materials_path() const {
    std::string stem = front_;
    while (!stem.empty() && (stem.back() == '_' || stem.back() == '-' || stem.back() == '.')) stem.pop_back();
    const bool is_bare = stem.empty() || stem.back() == '/';
    return stem + (is_bare ? "materials.mtl" : ".mtl");
  }

  std::string fault;

 private:
  std::string front_;
  std::string back_;
  std::size_t width_ = 4;
};

/// An ObjWriter holds what is the same in all frames.
struct ObjWriter {
  const MotionJob& job;
  std::string materials_file = {};
  std::vector<std::string> materials = {};  ///< Name of each material.
  std::vector<std::string> names = {};      ///< Name of each object.
  std::size_t vertices = 0;                 ///< Vertices of this frame so far.
  std::size_t uvs = 0;                      ///< Texture coordinates of this frame so far.
};

void put_vector(OutputSink& sink, const char* keyword, DVec3 v, int digits) {
  sink.put(keyword);
  for (const double x : {v.x, v.y, v.z}) {
    sink.put(" ");
    sink.put_number(x, digits);
  }
  sink.put("\n");
}

Result<void> write_materials(ObjWriter& writer, const std::string& path) {
  auto images = write_images(writer.job, path);
  if (!images) return images.error();
  NameBook book(NameStyle::kFile);
  OutputSink sink(path);
  for (std::size_t m = 0; m < writer.job.data.materials.size(); ++m) {
    const MotionMaterial& material = writer.job.data.materials[m];
    writer.materials.push_back(book.take(material.name, "material"));
    const auto srgb = [&](std::size_t i) { return static_cast<double>(srgb_of_linear(material.color[i])); };
    sink.put("newmtl " + writer.materials.back() + "\n");
    put_vector(sink, "Kd", {srgb(0), srgb(1), srgb(2)}, 6);
    sink.put("Ks 0.2 0.2 0.2\nNs ");
    sink.put_number(static_cast<double>(material.shininess));
    sink.put("\nd ");
    sink.put_number(static_cast<double>(material.opacity));
    sink.put("\nPr ");
    sink.put_number(static_cast<double>(roughness_of(material)));
    sink.put("\nPm ");
    sink.put_number(static_cast<double>(material.metalness));
    const MaterialImages& files = images.value()[m];
    if (!files.color.empty()) sink.put("\nmap_Kd " + files.color);
    if (!files.normals.empty()) sink.put("\nnorm " + files.normals);
    sink.put("\n\n");
  }
  return sink.finish(writer.job.summary);
}

/// Writes a mesh whose vertices are at `points` with `normals`.
void put_mesh(ObjWriter& writer, OutputSink& sink, const MotionMesh& mesh, std::span<const DVec3> points,
              std::span<const Vec3> normals) {
  const bool with_uvs = has_uvs(mesh);
  for (const DVec3& p : points) put_vector(sink, "v", p, 9);
  for (const Vec3& n : normals) put_vector(sink, "vn", vector_cast<double>(n), 4);
  for (const ModelVertex& vertex : mesh.vertices) {
    if (!with_uvs) break;
    sink.put("vt ");
    sink.put_number(static_cast<double>(vertex.uv[0]));
    sink.put(" ");
    sink.put_number(static_cast<double>(vertex.uv[1]));
    sink.put("\n");
  }
  for (const ModelPart& part : mesh.parts) {
    sink.put("usemtl " + writer.materials[part.material] + "\n");
    for (std::uint32_t i = part.first; i < part.first + part.count; ++i) {
      const std::string vertex = std::to_string(writer.vertices + mesh.indices[i] + 1);
      sink.put((i % 3 == 0 ? "f " : " ") + vertex + "/");
      if (with_uvs) sink.put(std::to_string(writer.uvs + mesh.indices[i] + 1));
      sink.put("/" + vertex + (i % 3 == 2 ? "\n" : ""));
    }
  }
  writer.vertices += points.size();
  if (with_uvs) writer.uvs += points.size();
}

void put_body(ObjWriter& writer, OutputSink& sink, std::size_t object, std::size_t frame) {
  const MotionState state = writer.job.data.state(object, frame);
  for (const MotionPiece& piece : writer.job.data.objects[object].pieces) {
    const MotionMesh& mesh = writer.job.data.meshes[piece.mesh];
    const Quat turn = state.rotation * piece.rotation;
    const DVec3 place = state.position + vector_cast<double>(rotate(state.rotation, piece.position));
    std::vector<DVec3> points;
    std::vector<Vec3> normals;
    for (const ModelVertex& vertex : mesh.vertices) {
      const auto& p = vertex.position;
      const auto& n = vertex.normal;
      points.push_back(place + vector_cast<double>(rotate(turn, Vec3{p[0], p[1], p[2]})));
      normals.push_back(rotate(turn, Vec3{n[0], n[1], n[2]}));
    }
    put_mesh(writer, sink, mesh, points, normals);
  }
}

Result<void> write_frame(ObjWriter& writer, const std::string& path, std::size_t frame) {
  const MotionData& data = writer.job.data;
  OutputSink sink(path);
  sink.put("# meters, y up, frame " + std::to_string(frame) + "\nmtllib " + writer.materials_file + "\n");
  writer.vertices = writer.uvs = 0;
  for (std::size_t i = 0; i < data.objects.size(); ++i) {
    if (frame < data.tracks[i].first || frame >= data.tracks[i].end) continue;
    sink.put("o " + writer.names[i] + "\n");
    if (data.objects[i].kind == MotionObject::Kind::kBody) {
      put_body(writer, sink, i, frame);
      continue;
    }
    const std::vector<Vec3> points = data.points(i, frame);
    std::vector<DVec3> places;
    places.reserve(points.size());
    for (const Vec3& p : points) places.push_back(vector_cast<double>(p));
    put_mesh(writer, sink, data.mesh_of(i), places, normals_of(data.mesh_of(i), points));
  }
  return sink.finish(writer.job.summary);
}

}  // namespace

Result<void> check_sequence(const std::string& path) {
  const Sequence sequence(path);
  return sequence.fault.empty() ? Result<void>() : Error{ErrorCode::kOutOfRange, path, sequence.fault};
}

Result<void> write_obj_motion(const MotionJob& job) {
  if (auto sound = check_sequence(job.path); !sound) return sound;
  const Sequence sequence(job.path);
  ObjWriter writer = {.job = job, .materials_file = fs::path(sequence.materials_path()).filename().string()};
  NameBook names(NameStyle::kFile);
  for (const MotionObject& object : job.data.objects)
    writer.names.push_back(names.take(object.name, "object"));
  // The materials are written first, so that an .obj file always finds them.
  if (auto done = write_materials(writer, sequence.materials_path()); !done) return done;
  std::vector<std::string> shown = job.summary.files;
  for (std::size_t frame = 0; frame < job.data.frames.size(); ++frame) {
    if (auto done = write_frame(writer, sequence.name(frame), frame); !done) return done;
    if (frame == 0) {
      // Every frame has the bodies that stand, too, so that large scenes fill a disk before they end.
      const auto left = static_cast<double>(job.data.frames.size() - 1);
      const double size = static_cast<double>(fs::file_size(sequence.name(0)));
      if (auto fits = check_space(sequence.name(0), left * size); !fits) {
        fs::remove(sequence.name(0));
        return fits;
      }
    }
    job.show(static_cast<double>(frame + 1) / static_cast<double>(job.data.frames.size()));
  }
  shown.push_back(sequence.name(0));
  if (job.data.frames.size() > 1) shown.push_back(sequence.name(job.data.frames.size() - 1));
  job.summary.files = std::move(shown);
  return {};
}

}  // namespace hooke::io
