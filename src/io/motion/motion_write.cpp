#include "io/motion/motion_write.h"

#include "base/float_environment.h"
#include "io/model/model_write.h"
#include "io/motion/motion_names.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <exception>
#include <filesystem>
#include <map>
#include <numbers>
#include <system_error>
#include <unistd.h>

namespace hooke {

namespace io {

namespace {

constexpr std::size_t kBufferSize = std::size_t{1} << 20;

}  // namespace

OutputSink::OutputSink(const std::string& path) : path_(path) {
  auto file = process::NewFile::create(path);
  if (file) {
    file_.emplace(std::move(file).value());
  } else {
    error_ = file.error();
  }
}

void OutputSink::put(std::span<const std::byte> bytes) {
  size_ += bytes.size();
  if (error_) return;
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
  if (buffer_.size() >= kBufferSize) flush();
}

void OutputSink::put_number(double value, int digits) {
  std::array<char, 40> text = {};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value == 0 ? 0.0 : value,
                                 std::chars_format::general, digits);
  put(std::string_view(text.data(), static_cast<std::size_t>(end.ptr - text.data())));
}

void OutputSink::flush() {
  if (!error_ && !buffer_.empty()) {
    if (const auto written = file_->write(buffer_); !written) error_ = written.error();
  }
  buffer_.clear();
}

void OutputSink::append(OutputSink& other) {
  other.flush();
  if (other.error_ && !error_) error_ = other.error_;
  std::vector<std::byte> piece(kBufferSize);
  for (std::uint64_t done = 0; done < other.size_ && !error_;) {
    const ssize_t got = ::pread(other.file_->number(), piece.data(), piece.size(), static_cast<off_t>(done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) {
      error_ =
          Error{ErrorCode::kFileNotWritable, path_, "cannot be written: what was written cannot be read"};
      return;
    }
    put(std::span(piece).first(static_cast<std::size_t>(got)));
    done += static_cast<std::uint64_t>(got);
  }
}

Result<void> OutputSink::finish(MotionSummary& summary) {
  flush();
  if (error_) return *error_;
  if (auto finished = file_->finish(); !finished) return finished;
  summary.files.push_back(path_);
  summary.bytes += size_;
  return {};
}

std::vector<Vec3> normals_of(const MotionMesh& mesh, std::span<const Vec3> points) {
  const auto group = [&](std::uint32_t vertex) {
    return mesh.normal_groups.empty() ? vertex : mesh.normal_groups[vertex];
  };
  std::uint32_t groups = 0;
  for (std::uint32_t v = 0; v < points.size(); ++v) groups = std::max(groups, group(v) + 1);
  std::vector<DVec3> sums(groups);
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const auto corner = [&](std::size_t k) { return vector_cast<double>(points[mesh.indices[i + k]]); };
    const DVec3 normal = cross(corner(1) - corner(0), corner(2) - corner(0));
    for (std::size_t k = 0; k < 3; ++k) sums[group(mesh.indices[i + k])] += normal;
  }
  std::vector<Vec3> normals;
  normals.reserve(points.size());
  for (std::uint32_t v = 0; v < points.size(); ++v) {
    const Vec3 normal = vector_cast<Real>(normalize(sums[group(v)]));
    normals.push_back(normal == Vec3{} ? Vec3{0, 1, 0} : normal);
  }
  return normals;
}

namespace {

/// The edges of a triangle from its first corner, in the texture: u1, v1, u2, v2.
std::array<float, 4> texture_edges(const MotionMesh& mesh, std::size_t first_index) {
  const auto& [u, v] = mesh.vertices[mesh.indices[first_index]].uv;
  const auto& [u1, v1] = mesh.vertices[mesh.indices[first_index + 1]].uv;
  const auto& [u2, v2] = mesh.vertices[mesh.indices[first_index + 2]].uv;
  return {u1 - u, v1 - v, u2 - u, v2 - v};
}

}  // namespace

// Of a triangle (Lengyel, "Computing tangent space basis vectors for an arbitrary mesh", 2001), by its area
// in the texture.
std::vector<Vec3> tangents_of(const MotionMesh& mesh, std::span<const Vec3> points,
                              std::span<const Vec3> normals) {
  std::vector<Vec3> sums(points.size());
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const auto [u1, v1, u2, v2] = texture_edges(mesh, i);
    const Vec3& corner = points[mesh.indices[i]];
    const Vec3 right =
        v2 * (points[mesh.indices[i + 1]] - corner) - v1 * (points[mesh.indices[i + 2]] - corner);
    const float sign = u1 * v2 - u2 * v1 < 0 ? -1.0f : 1.0f;
    for (std::size_t k = 0; k < 3; ++k) sums[mesh.indices[i + k]] += sign * right;
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const Vec3& n = normals[i];
    sums[i] = normalize(sums[i] - dot(sums[i], n) * n);
    if (length(sums[i]) > 0.5f) continue;
    const bool is_along_x = std::abs(n.x) > 0.9f * length(n);
    sums[i] = normalize(cross(n, is_along_x ? Vec3{0, 1, 0} : Vec3{1, 0, 0}));
  }
  return sums;
}

std::vector<float> mirrors_of(const MotionMesh& mesh) {
  std::vector<float> areas(mesh.vertices.size());
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const auto [u1, v1, u2, v2] = texture_edges(mesh, i);
    for (std::size_t k = 0; k < 3; ++k) areas[mesh.indices[i + k]] += u1 * v2 - u2 * v1;
  }
  for (float& area : areas) area = area < 0 ? -1.0f : 1.0f;
  return areas;
}

std::vector<Vec3> positions_of(const MotionMesh& mesh) {
  std::vector<Vec3> positions;
  positions.reserve(mesh.vertices.size());
  for (const ModelVertex& vertex : mesh.vertices) {
    positions.push_back({vertex.position[0], vertex.position[1], vertex.position[2]});
  }
  return positions;
}

bool has_uvs(const MotionMesh& mesh) {
  return std::any_of(mesh.vertices.begin(), mesh.vertices.end(),
                     [](const ModelVertex& vertex) { return vertex.uv != std::array<float, 2>{}; });
}

std::string length_text(double meters) {
  std::array<char, 40> text = {};
  const bool is_small = meters < 0.1;
  std::snprintf(text.data(), text.size(), "%.3g %s", is_small ? 1000 * meters : meters,
                is_small ? "mm" : "m");
  return text.data();
}

Result<void> check_space(const std::string& path, double bytes) {
  std::error_code code;
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  const std::filesystem::space_info space = std::filesystem::space(folder.empty() ? "." : folder, code);
  if (code || bytes <= static_cast<double>(space.available)) return {};
  const auto gibibytes = [](double size) { return std::to_string(std::llround(size / (1 << 30))) + " GiB"; };
  return Error{ErrorCode::kFileNotWritable, path,
               "would take about " + gibibytes(bytes) + ", and " +
                   gibibytes(static_cast<double>(space.available)) +
                   " are free: record a shorter time or fewer frames a second, or write .glb"};
}

float roughness_of(const MotionMaterial& material) {
  return material.roughness.value_or(roughness_of(material.shininess));
}

bool has_images(const MotionMaterial& material) {
  return material.image || material.normal_map || material.roughness_map;
}

Quaternion<double> rotation_of_light(Vec3 direction) {
  const DVec3 to = normalize(vector_cast<double>(direction));
  if (to.z > 0.999999) return {0, 1, 0, 0};  // half a turn about y
  const DVec3 middle = cross(DVec3{0, 0, -1}, to);
  return normalize(Quaternion<double>{middle.x, middle.y, middle.z, 1 - to.z});
}

void note_camera_angle(const MotionJob& job) {
  const auto& cameras = job.data.cameras;
  const bool changes = std::any_of(cameras.begin(), cameras.end(), [&](const MotionCamera& camera) {
    return camera.vertical_angle != cameras[0].vertical_angle;
  });
  if (changes)
    job.summary.notes.push_back("the angle of the camera changes; the file has that of the first frame");
}

Result<std::vector<MaterialImages>> write_images(const MotionJob& job, const std::string& path) {
  std::map<const MotionImage*, std::string> known;
  NameBook book(NameStyle::kFile);
  const std::filesystem::path place(path);
  const auto write = [&](const std::shared_ptr<const MotionImage>& image, std::string& name) -> Result<void> {
    if (image == nullptr) return {};
    const auto [entry, is_new] = known.try_emplace(image.get());
    if (is_new) {
      entry->second = book.take(place.stem().string() + "_" + image->name, "image.png");
      OutputSink sink((place.parent_path() / entry->second).string());
      sink.put(image->bytes);
      if (auto done = sink.finish(job.summary); !done) return done;
    }
    name = entry->second;
    return {};
  };
  std::vector<MaterialImages> names;
  for (const MotionMaterial& material : job.data.materials) {
    MaterialImages& images = names.emplace_back();
    if (auto done = write(material.image, images.color); !done) return done.error();
    if (auto done = write(material.normal_map, images.normals); !done) return done.error();
    if (auto done = write(material.roughness_map, images.roughness); !done) return done.error();
  }
  return names;
}

namespace {

/// Adds notes on what the recording itself had to leave out.
void note_faults(const MotionJob& job) {
  const MotionData& data = job.data;
  const auto count = [](std::size_t number, const char* one, const char* many) {
    return std::to_string(number) + (number == 1 ? one : many);
  };
  std::size_t spinning = 0;
  bool moves = false;
  for (std::size_t i = 0; i < data.objects.size(); ++i) {
    const MotionTrack& track = data.tracks[i];
    moves = moves || track.size > 0;
    if (track.fastest_spin > std::numbers::pi * data.frames_per_second) ++spinning;
    if (track.not_finite == 0) continue;
    job.summary.notes.push_back("'" + data.objects[i].name + "' was not finite in " +
                                count(track.not_finite, " frame", " frames") +
                                ", which repeat the one before: hooke run says what went wrong");
  }
  if (spinning > 0) {
    job.summary.notes.push_back(count(spinning, " body turns", " bodies turn") +
                                " by more than half a turn between two frames, and will seem to turn slower: "
                                "more frames a second show it");
  }
  if (!moves) job.summary.notes.emplace_back("nothing that was recorded can move: all bodies are static");
}

Result<void> write_as(const MotionJob& job) {
  switch (motion_format(job.path)) {
    case MotionFormat::kGlb:
      return write_glb_motion(job, GlbContent::kAll);
    case MotionFormat::kUsda:
      return write_usda_motion(job);
    case MotionFormat::kCsv:
      return write_csv_motion(job);
    case MotionFormat::kObj:
      return write_obj_motion(job);
    case MotionFormat::kPointCaches:
      return write_point_caches(job);
    case MotionFormat::kNone:
      break;
  }
  return Error{ErrorCode::kOutOfRange, job.path, "has not the ending of a format"};
}

Result<void> check(const MotionData& data, const std::string& path, const MotionOptions& options) {
  if (data.frames.empty()) return Error{ErrorCode::kOutOfRange, data.path, "there is no frame to write"};
  bool is_any_seen = false;
  for (std::size_t i = 0; i < data.objects.size(); ++i) is_any_seen = is_any_seen || data.is_seen(i);
  if (!is_any_seen) return Error{ErrorCode::kOutOfRange, data.path, "there is no object to write"};
  for (std::size_t i = 0; i < data.objects.size() && motion_format(path) != MotionFormat::kCsv; ++i) {
    if (data.objects[i].kind == MotionObject::Kind::kPoints && data.mesh_of(i).indices.empty()) {
      return Error{ErrorCode::kOutOfRange, data.objects[i].name,
                   "has points alone, which only .csv files hold"};
    }
  }
  if (!(options.tolerance >= 0 && options.tolerance <= 1e6)) {
    return Error{ErrorCode::kOutOfRange, "tolerance", "must be 0 to 1e6"};
  }
  if (options.most_targets < 1 || options.most_targets > 4096) {
    return Error{ErrorCode::kOutOfRange, "most_targets", "must be 1 to 4096"};
  }
  return {};
}

}  // namespace

}  // namespace io

Result<MotionSummary> write_motion(const MotionRecording& motion, const std::string& path,
                                   const MotionOptions& options) {
  const base::FloatEnvironment environment;
  const MotionData& data = motion.data();
  if (const auto sound = io::check(data, path, options); !sound) return sound.error();
  MotionSummary summary;
  summary.frames = data.frames.size();
  for (std::size_t i = 0; i < data.objects.size(); ++i) summary.objects += data.is_seen(i) ? 1 : 0;
  try {
    const io::MotionJob job = {data, path, options, summary};
    io::note_faults(job);
    if (const auto written = io::write_as(job); !written) return written.error();
    return summary;
  } catch (const std::system_error& failure) {
    return Error{ErrorCode::kFileNotWritable, path,
                 std::string("the recorded frames cannot be read back: ") + failure.what()};
  } catch (const std::exception&) {
    return Error{ErrorCode::kLimitExceeded, path, "not enough memory to write this motion"};
  }
}

}  // namespace hooke
