#include "io/folder_file.h"
#include "io/motion/motion_data.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <numbers>
#include <system_error>
#include <type_traits>
#include <unistd.h>
#include <utility>

namespace hooke {

namespace {

namespace fs = std::filesystem;

static_assert(std::is_trivially_copyable_v<MotionState>);

Error failure(const std::string& path, const std::string& reason) {
  return {ErrorCode::kFileNotWritable, path, "cannot be written: " + reason};
}

bool is_finite(const MotionState& state) {
  const Quat q = state.rotation;
  return hooke::is_finite(state.position) && hooke::is_finite(state.velocity) &&
         hooke::is_finite(state.angular_velocity) && std::isfinite(q.x) && std::isfinite(q.y) &&
         std::isfinite(q.z) && std::isfinite(q.w) && std::isfinite(state.energy.total());
}

bool is_finite(const std::array<float, 3>& v) {
  return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

bool is_luminance(float value) {
  return std::isfinite(value) && value >= 0;
}

bool is_share(float value) {
  return value >= 0 && value <= 1;
}

/// Returns what is wrong with a mesh, or an empty text.
std::string fault_of(const MotionMesh& mesh, std::size_t materials) {
  if (mesh.indices.empty() && mesh.parts.empty()) return "";
  if (mesh.indices.size() % 3 != 0) return "has a triangle without three corners";
  if (!mesh.normal_groups.empty() && mesh.normal_groups.size() != mesh.vertices.size()) {
    return "has not one normal group for each vertex";
  }
  for (const ModelVertex& vertex : mesh.vertices) {
    if (!is_finite(vertex.position) || !is_finite(vertex.normal))
      return "has a coordinate that is not finite";
  }
  std::uint32_t next_index = 0;
  std::uint32_t next_vertex = 0;  // The first vertex that no part before had.
  for (const ModelPart& part : mesh.parts) {
    if (part.first != next_index || part.count == 0 || part.count % 3 != 0 ||
        part.count > mesh.indices.size() - part.first) {
      return "has parts that do not cover its triangles in order";
    }
    if (part.material >= materials) return "has a material that there is not";
    next_index += part.count;
    std::uint32_t largest = 0;
    for (std::uint32_t i = part.first; i < next_index; ++i) {
      const std::uint32_t vertex = mesh.indices[i];
      if (vertex >= mesh.vertices.size() || vertex < next_vertex) return "has an index out of range";
      largest = std::max(largest, vertex);
    }
    next_vertex = largest + 1;
  }
  if (next_index != mesh.indices.size()) return "has parts that do not cover its triangles in order";
  return next_vertex == mesh.vertices.size() ? "" : "has vertices that no triangle uses at its end";
}

double radius_of(const MotionMesh& mesh) {
  double square = 0;
  for (const ModelVertex& vertex : mesh.vertices) {
    const auto& p = vertex.position;
    square = std::max(square, static_cast<double>(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]));
  }
  return std::sqrt(square);
}

void read_at(const MotionData& data, std::uint64_t offset, void* to, std::size_t size) {
  auto* place = static_cast<std::byte*>(to);
  while (size > 0) {
    const ssize_t done = ::pread(data.file->number(), place, size, static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) throw std::system_error(done < 0 ? errno : EIO, std::generic_category());
    place += done;
    offset += static_cast<std::uint64_t>(done);
    size -= static_cast<std::size_t>(done);
  }
}

/// Repeats the last record of an object where `finite` is false, and tells whether there is a record.
bool keep_last(MotionTrack& track, bool finite, std::span<std::byte> record) {
  if (finite) {
    track.last.assign(record.begin(), record.end());
    return true;
  }
  ++track.not_finite;
  if (track.last.size() != record.size()) return false;
  std::copy(track.last.begin(), track.last.end(), record.begin());
  return true;
}

}  // namespace

namespace io {

MotionFormat motion_format(const std::string& path) {
  std::error_code code;
  if (!path.empty() && (path.back() == '/' || fs::is_directory(path, code)))
    return MotionFormat::kPointCaches;
  const std::string ending = io::lower_ending(path);
  if (ending == ".glb") return MotionFormat::kGlb;
  if (ending == ".usda") return MotionFormat::kUsda;
  if (ending == ".csv") return MotionFormat::kCsv;
  if (ending == ".obj") return MotionFormat::kObj;
  return MotionFormat::kNone;
}

}  // namespace io

MotionState MotionData::state(std::size_t object, std::size_t frame_number) const {
  const MotionTrack& track = tracks[object];
  if (track.size == 0) return track.still;
  MotionState state;
  read_at(*this, frames[frame_number] + track.offset, &state, sizeof state);
  return state;
}

std::vector<Vec3> MotionData::points(std::size_t object, std::size_t frame_number) const {
  const MotionTrack& track = tracks[object];
  std::vector<Vec3> points(mesh_of(object).vertices.size());
  read_at(*this, frames[frame_number] + track.offset + sizeof(MotionState), points.data(),
          points.size() * sizeof(Vec3));
  return points;
}

MotionRecording::MotionRecording(std::unique_ptr<MotionData> data) : data_(std::move(data)) {}
MotionRecording::MotionRecording(MotionRecording&&) noexcept = default;
MotionRecording& MotionRecording::operator=(MotionRecording&&) noexcept = default;
MotionRecording::~MotionRecording() = default;

Result<MotionRecording> MotionRecording::create(const std::string& path, double frames_per_second) {
  if (!(frames_per_second > 0 && frames_per_second <= 1e6)) {
    return Error{ErrorCode::kOutOfRange, "frames_per_second", "must be over 0, at most 1e6"};
  }
  const io::MotionFormat format = io::motion_format(path);
  if (format == io::MotionFormat::kNone || path.find('\0') != std::string::npos) {
    return Error{ErrorCode::kOutOfRange, path,
                 "not one of X.glb X.usda X.csv X_%04d.obj, or X/ for a folder of point caches"};
  }
  auto data = std::make_unique<MotionData>();
  data->path = path;
  data->frames_per_second = frames_per_second;
  std::string place = path;
  std::string folder;
  if (format == io::MotionFormat::kPointCaches) {
    folder = path;
    place = (fs::path(path) / "frames").string();
  }
  if (format == io::MotionFormat::kObj) {
    if (const auto sound = io::check_sequence(path); !sound) return sound.error();
    folder = fs::path(path).parent_path().string();
  }
  if (!folder.empty()) {
    std::error_code code;
    fs::create_directories(folder, code);
    if (code) return failure(path, code.message());
  }
  auto file = process::NewFile::create(place);
  if (!file) return file.error();
  data->file.emplace(std::move(file).value());
  return MotionRecording(std::move(data));
}

void MotionRecording::set_gravity(Vec3 gravity) {
  data_->gravity = gravity;
}

Result<void> MotionRecording::add_light(MotionLight light) {
  const DVec3 direction = vector_cast<double>(light.direction);
  const bool is_spot = light.kind == MotionLight::Kind::kSpot;
  const bool is_cone = light.inner_angle >= 0 && light.inner_angle < light.outer_angle &&
                       light.outer_angle <= std::numbers::pi_v<float> / 2;
  const bool is_color = std::all_of(light.color.begin(), light.color.end(), is_share);
  if (!hooke::is_finite(light.position) || !hooke::is_finite(direction) || length(direction) == 0 ||
      !is_color || !is_luminance(light.strength) || (is_spot && !is_cone)) {
    return Error{
        ErrorCode::kOutOfRange, "light '" + light.name + "'",
        "needs a finite position, a direction that is not zero, colors in [0, 1], a strength of 0 or more, "
        "and 0 <= inner_angle < outer_angle <= pi / 2"};
  }
  data_->lights.push_back(std::move(light));
  return {};
}

Result<void> MotionRecording::set_sky(std::array<float, 3> luminance) {
  if (!std::all_of(luminance.begin(), luminance.end(), is_luminance)) {
    return Error{ErrorCode::kOutOfRange, "sky", "needs three numbers of 0 or more"};
  }
  data_->sky = luminance;
  return {};
}

std::uint32_t MotionRecording::add_material(MotionMaterial material) {
  data_->materials.push_back(std::move(material));
  return static_cast<std::uint32_t>(data_->materials.size() - 1);
}

Result<std::uint32_t> MotionRecording::add_mesh(MotionMesh mesh) {
  if (const std::string fault = fault_of(mesh, data_->materials.size()); !fault.empty()) {
    return Error{ErrorCode::kOutOfRange, "mesh", fault};
  }
  data_->meshes.push_back(std::move(mesh));
  return static_cast<std::uint32_t>(data_->meshes.size() - 1);
}

Result<std::uint32_t> MotionRecording::add_object(MotionObject object) {
  const bool is_body = object.kind == MotionObject::Kind::kBody;
  const auto is_missing = [&](std::uint32_t mesh) { return mesh >= data_->meshes.size(); };
  if ((!is_body && is_missing(object.mesh)) ||
      std::any_of(object.pieces.begin(), object.pieces.end(),
                  [&](const auto& p) { return is_missing(p.mesh); })) {
    return Error{ErrorCode::kOutOfRange, object.name, "has a mesh that there is not"};
  }
  MotionTrack track;
  track.offset = data_->tracks.empty() ? 0 : data_->tracks.back().offset + data_->tracks.back().size;
  if (!is_body) {
    track.size = sizeof(MotionState) + data_->meshes[object.mesh].vertices.size() * sizeof(Vec3);
  } else if (object.body_kind != BodyKind::kStatic) {
    track.size = sizeof(MotionState);
  }
  for (const MotionPiece& piece : object.pieces) {
    const double reach = static_cast<double>(length(piece.position)) + radius_of(data_->meshes[piece.mesh]);
    track.radius = std::max(track.radius, reach);
  }
  data_->objects.push_back(std::move(object));
  data_->tracks.push_back(std::move(track));
  return static_cast<std::uint32_t>(data_->objects.size() - 1);
}

Result<void> MotionRecording::add_joint(MotionJoint joint) {
  for (const auto& end : {joint.a, joint.b}) {
    if (end && (*end >= data_->objects.size() || data_->objects[*end].kind != MotionObject::Kind::kBody)) {
      return Error{ErrorCode::kOutOfRange, joint.name, "holds an object that is no body"};
    }
  }
  data_->joints.push_back(std::move(joint));
  return {};
}

void MotionRecording::set_state(std::uint32_t object, const MotionState& state) {
  if (object >= data_->objects.size()) return;
  MotionTrack& track = data_->tracks[object];
  if (track.size == 0) {
    if (track.end == track.first && is_finite(state)) track.still = state;
    track.is_set = true;
    return;
  }
  if (track.size != sizeof state) return;
  data_->frame.resize(data_->tracks.back().offset + data_->tracks.back().size);
  const std::span record = std::span(data_->frame).subspan(track.offset, track.size);
  std::memcpy(record.data(), &state, sizeof state);
  const bool finite = is_finite(state);
  track.is_set = keep_last(track, finite, record);
  if (finite) {
    track.fastest_spin = std::max(track.fastest_spin, static_cast<double>(length(state.angular_velocity)));
  }
}

void MotionRecording::set_points(std::uint32_t object, const MotionState& state,
                                 std::span<const Vec3> vertices) {
  if (object >= data_->objects.size() || data_->objects[object].kind != MotionObject::Kind::kPoints) return;
  MotionTrack& track = data_->tracks[object];
  if (vertices.size() != data_->mesh_of(object).vertices.size()) return;
  data_->frame.resize(data_->tracks.back().offset + data_->tracks.back().size);
  const std::span record = std::span(data_->frame).subspan(track.offset, track.size);
  std::memcpy(record.data(), &state, sizeof state);
  std::memcpy(record.data() + sizeof state, vertices.data(), vertices.size_bytes());
  const bool finite = is_finite(state) && std::all_of(vertices.begin(), vertices.end(),
                                                      [](Vec3 v) { return hooke::is_finite(v); });
  track.is_set = keep_last(track, finite, record);
}

Result<void> MotionRecording::set_camera(const MotionCamera& camera) {
  const DVec3 forward = camera.target - camera.eye;
  const bool is_angle = camera.vertical_angle > 0 && camera.vertical_angle < std::numbers::pi_v<float>;
  if (!hooke::is_finite(camera.eye) || !hooke::is_finite(forward) || !(length(forward) > 0) || !is_angle) {
    return Error{ErrorCode::kOutOfRange, "camera",
                 "needs a finite place, a target elsewhere, and 0 < vertical_angle < pi"};
  }
  data_->camera = camera;
  return {};
}

Result<void> MotionRecording::finish_frame() {
  const std::size_t number = data_->frames.size();
  if (data_->camera) data_->cameras.resize(number + 1, *data_->camera);
  for (MotionTrack& track : data_->tracks) {
    // What is gone does not come back: its frames are in one piece.
    const bool is_new = track.end == track.first;
    if (track.is_set && is_new) track.first = number;
    if (track.is_set && (is_new || track.end == number)) track.end = number + 1;
    track.is_set = false;
  }
  data_->frames.push_back(data_->file_size);
  data_->file_size += data_->frame.size();
  auto written = data_->file->write(data_->frame);
  std::fill(data_->frame.begin(), data_->frame.end(), std::byte{});
  if (written) return {};
  return Error{ErrorCode::kFileNotWritable, data_->path,
               "the frames do not fit on the disk (" + written.error().message +
                   "); record fewer frames a second or a shorter time"};
}

std::size_t MotionRecording::frame_count() const {
  return data_->frames.size();
}

}  // namespace hooke
