#pragma once

#include "hooke/desc.h"
#include "hooke/math.h"
#include "hooke/model_io.h"
#include "hooke/result.h"
#include "hooke/world.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// \file
/// Records how objects move, frame by frame, and writes the motion for other programs: .glb, .usda, .obj,
/// .pc2 and .csv. Part of the library `hooke::io`. `hooke export` does so for scenes; docs/export.md says
/// what each format holds.
///
/// Frames go to a temporary file beside the output, so that memory does not grow with their number.

namespace hooke {

struct MotionData;  // what a MotionRecording holds; src/io/motion/motion_data.h

/// An image as its file holds it.
struct MotionImage {
  std::string name = {};              ///< Name of the file without folders, such as "flag.png".
  std::vector<std::byte> bytes = {};  ///< Content of a PNG or JPEG file.
};

/// How a surface looks.
struct MotionMaterial {
  std::string name = {};                            ///< Name; need not be unique.
  std::array<float, 3> color = {0.8f, 0.8f, 0.8f};  ///< Linear red, green and blue, each in [0, 1].
  float opacity = 1.0f;                             ///< Opacity; 1 hides what is behind. [0, 1]
  float shininess = 16.0f;                          ///< Blinn-Phong exponent.
  std::optional<float> roughness = {};  ///< 0 for a mirror, 1 for chalk; (2 / (shininess + 2))^(1/4) without
                                        ///< it. [0, 1]
  float metalness = 0.0f;               ///< 0 for an insulator, 1 for a metal. [0, 1]
  float transmission = 0.0f;            ///< Share of the light that goes through, as through glass. [0, 1]
  std::shared_ptr<const MotionImage> image = {};  ///< Image that the color multiplies; null for none.
  /// Normals in the frame of the surface: red to the right of the texture, green up, blue outward.
  std::shared_ptr<const MotionImage> normal_map = {};
  float normal_scale = 1.0f;  ///< Factor of the red and the green of `normal_map`. [-100, 100]
  /// Image whose green multiplies the roughness, and its blue the metalness; null for none.
  std::shared_ptr<const MotionImage> roughness_map = {};
  bool cutout = false;     ///< Whether the image's alpha cuts holes.
  bool two_sided = false;  ///< Whether back faces are seen.
};

/// A light, which does not move.
struct MotionLight {
  /// From where its light comes.
  enum class Kind : std::uint8_t {
    kDirectional,  ///< From far away, along `direction`.
    kPoint,        ///< From `position`, to all sides.
    kSpot,         ///< From `position`, within a cone about `direction`.
  };

  std::string name = {};                            ///< Name; writers make names unique.
  Kind kind = Kind::kPoint;                         ///< From where its light comes.
  DVec3 position = {};                              ///< Of a point and a spot [m].
  Vec3 direction = {Real(0), Real(-1), Real(0)};    ///< In which its light goes; of any length but zero.
  std::array<float, 3> color = {1.0f, 1.0f, 1.0f};  ///< Linear red, green and blue, each in [0, 1].
  /// Luminance of a white matte surface that faces it, of a point and a spot at 1 m, from where it falls off
  /// by the square [cd/m^2]. 1 is the white of a screen that shows light as it is. Not negative.
  float strength = 1.0f;
  /// Half angle of a spot within which it is as bright as its middle [rad]. [0, outer_angle)
  float inner_angle = 0.35f;
  float outer_angle = 0.52f;  ///< Half angle beyond which there is none. (inner_angle, pi / 2]
  bool shadows = true;        ///< Whether things keep its light from one another; only .usda tells it.
};

/// Triangles of a body's piece, or of a deformable object at its first frame. Each vertex belongs to one
/// part, and vertices stand in the order of the parts, so that every program keeps their order.
struct MotionMesh {
  std::vector<ModelVertex> vertices = {};   ///< Vertices [m]; normals of deformable objects are computed.
  std::vector<std::uint32_t> indices = {};  ///< Three per triangle, counter-clockwise seen from the front.
  std::vector<ModelPart> parts = {};  ///< Parts, each with a material from MotionRecording::add_material;
                                      ///< they cover `indices` in order.
  /// Group of each vertex of a deformable object; vertices of one group share a normal. Each has its own by
  /// default.
  std::vector<std::uint32_t> normal_groups = {};
};

/// One shape of a body.
struct MotionPiece {
  std::uint32_t mesh = 0;  ///< Mesh, from MotionRecording::add_mesh.
  Vec3 position = {};      ///< Origin of the mesh's frame in the body's frame [m].
  Quat rotation = {};      ///< Rotation of the mesh's frame in the body's frame.
  Shape shape = {};        ///< Shape that collides, in the mesh's frame; its MeshId is not read.
};

/// What is recorded: a rigid body, or an object whose points move.
struct MotionObject {
  /// What moves of the object.
  enum class Kind : std::uint8_t {
    kBody,    ///< The frame of a rigid body.
    kPoints,  ///< Each vertex of one mesh.
  };

  std::string name = {};                   ///< Name in any characters; writers make names unique.
  Kind kind = Kind::kBody;                 ///< What moves of the object.
  std::vector<MotionPiece> pieces = {};    ///< Shapes of a body; it may have none.
  std::uint32_t mesh = 0;                  ///< Mesh of an object of points, used by no other object.
  BodyKind body_kind = BodyKind::kStatic;  ///< What moves a body. The first state of a static one counts.
  Real mass = Real(0);                     ///< Mass of a dynamic body [kg].
  Vec3 center_of_mass = {};                ///< Center of mass in the body's frame [m].
  Real friction = Real(0.5);               ///< Coulomb coefficient while sliding.
  Real restitution = Real(0);              ///< Speed after over speed before.
  bool collides = true;                    ///< Whether the body touches others.
};

/// A hook of two bodies, or of a body and the world.
struct MotionJoint {
  std::string name = {};            ///< Name in any characters.
  HookKind kind = HookKind::kBall;  ///< Kind of the hook.
  /// Body on side a, from MotionRecording::add_object; none for the world.
  std::optional<std::uint32_t> a = {};
  std::optional<std::uint32_t> b = {};      ///< Body on side b, likewise.
  std::array<DVec3, 2> anchors = {};        ///< Places on a and on b at the first frame, in the world [m].
  Vec3 axis = {Real(0), Real(1), Real(0)};  ///< Axis at the first frame, in the world; not zero.
  HookLimits limits = {};                   ///< Bounds of the main freedom [m] or [rad].
  std::optional<Real> cone = {};            ///< Cone of a ball [rad].
  Real break_force = kRigid;                ///< Force that breaks it [N].
  Real break_torque = kRigid;               ///< Torque that breaks it [N m].
};

/// From where the picture of a frame is taken. Up in the picture is y, or z where it looks along y.
struct MotionCamera {
  DVec3 eye = {};               ///< Place of the camera [m].
  DVec3 target = {0, 0, -1};    ///< What is in the middle of the picture [m]; another place than `eye`.
  float vertical_angle = 0.8f;  ///< Angle between the lower and the upper edge of the picture [rad]. (0, pi)
};

/// The state of an object in one frame.
struct MotionState {
  DVec3 position = {};         ///< Origin of a body's frame, or mean of an object's points [m].
  Quat rotation = {};          ///< Rotation of a body's frame, of unit length.
  Vec3 velocity = {};          ///< Velocity of a body's center of mass, or mean of the points [m/s].
  Vec3 angular_velocity = {};  ///< Angular velocity of a body in the world's axes [rad/s].
  Energy energy = {};          ///< Energy of a body [J].
};

/// A recorded motion. Add what there is, then for each frame the states of all that is present, and
/// finish_frame(). An object that has no state in a frame after its first one is gone from then on.
class MotionRecording {
 public:
  /// Begins a recording that write_motion will write to `path`: its ending is that of a format, or a slash
  /// for a folder. That folder, or the one of an .obj sequence, is created. `frames_per_second` is (0, 1e6].
  ///
  /// Errors: kOutOfRange for another ending or rate, kFileNotWritable where the output cannot be written.
  [[nodiscard]] static Result<MotionRecording> create(const std::string& path, double frames_per_second);
  ///@{
  /// Takes everything over. The MotionRecording moved from may only be destroyed or assigned to.
  MotionRecording(MotionRecording&&) noexcept;
  MotionRecording& operator=(MotionRecording&&) noexcept;
  ///@}
  /// Removes the temporary file.
  ~MotionRecording();

  /// Sets the gravity that a .usda file tells [m/s^2]; (0, -9.81, 0) by default.
  void set_gravity(Vec3 gravity);
  /// Adds a light. Only .glb and .usda have lights. Errors: a number that is out of range or not finite.
  Result<void> add_light(MotionLight light);
  /// Sets the luminance of the sky, red, green and blue, which lights from all sides [cd/m^2]. Only .usda has
  /// it. Errors: a number that is negative or not finite.
  Result<void> set_sky(std::array<float, 3> luminance);
  /// Adds a material and returns its number. Its numbers are not checked: with one that is out of range or
  /// not finite, other programs may refuse the file.
  std::uint32_t add_material(MotionMaterial material);
  /// Adds a mesh and returns its number. Errors: an index, a part or a material out of range,
  /// vertices that are not in the order of the parts, a coordinate that is not finite. A mesh may have points
  /// alone, which only .csv files hold.
  Result<std::uint32_t> add_mesh(MotionMesh mesh);
  /// Adds an object, which may appear between two frames, and returns its number. Errors: a mesh that there
  /// is not.
  Result<std::uint32_t> add_object(MotionObject object);
  /// Adds a joint. Errors: an object that there is not, or that is no body.
  Result<void> add_joint(MotionJoint joint);

  /// Sets the state of an object in this frame. One with a number that is not finite repeats the frame
  /// before, and is counted in MotionSummary::notes. It does nothing for a number that no object has.
  void set_state(std::uint32_t object, const MotionState& state);
  /// Sets the state of an object of points and its vertices in this frame, in the world [m]. It does nothing
  /// unless there are as many as the mesh has.
  void set_points(std::uint32_t object, const MotionState& state, std::span<const Vec3> vertices);
  /// Sets the camera from this frame on. Only .glb and .usda have one; frames before the first camera have
  /// that. Errors: a number that is out of range or not finite, or a target at the eye.
  Result<void> set_camera(const MotionCamera& camera);
  /// Stores the frame. Errors: kFileNotWritable where the disk is full.
  Result<void> finish_frame();

  /// Number of frames that are stored.
  [[nodiscard]] std::size_t frame_count() const;
  /// What the recording holds, for the writers.
  [[nodiscard]] const MotionData& data() const { return *data_; }

 private:
  explicit MotionRecording(std::unique_ptr<MotionData> data);
  std::unique_ptr<MotionData> data_;
};

/// How a motion is written.
struct MotionOptions {
  /// Distance by which a vertex may be off where frames are left out because straight motion between their
  /// neighbors is near enough [m]. [0, 1e6] Of .glb and .usda.
  double tolerance = 1e-4;
  /// Number of morph targets that an object of a .glb file has at most; where they do not suffice, its
  /// tolerance is raised until they do. [1, 4096] Viewers keep targets in layers of a texture: WebGL 2
  /// promises 256 of them, and graphics cards have 2048.
  std::size_t most_targets = 1024;
  /// Whether a .csv file also has a row for each vertex of the objects of points.
  bool with_points = false;
  /// Receives the part of the work that is done, in [0, 1]; empty for none.
  std::function<void(double)> progress = {};
};

/// What was written.
struct MotionSummary {
  std::vector<std::string> files = {};  ///< Paths; of a sequence, the first and the last.
  std::uint64_t bytes = 0;              ///< Size of all files together.
  std::size_t objects = 0;              ///< Number of objects.
  std::size_t frames = 0;               ///< Number of frames.
  /// What was left out or changed and what to do about it, one line each.
  std::vector<std::string> notes = {};
};

/// Writes a recorded motion to `path`, in the format of its ending: .glb, .usda, .csv, a sequence of .obj
/// with "%04d" in the name or numbers appended to it, or a folder with a slash at the end, with point caches
/// (.pc2), a .glb file and a script for Blender. Every file appears under its name when it is complete.
///
/// Errors: another ending, a motion without frames or objects, a file that cannot be written or is beyond
/// what the format holds.
[[nodiscard]] Result<MotionSummary> write_motion(const MotionRecording& motion, const std::string& path,
                                                 const MotionOptions& options = {});

}  // namespace hooke
