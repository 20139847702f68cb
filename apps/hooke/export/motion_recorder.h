#pragma once

#include "hooke/drawing/body_geometry.h"
#include "hooke/drawing/figure.h"
#include "hooke/export/motion_look.h"
#include "hooke/export/motion_skin.h"
#include "hooke/motion_io.h"
#include "hooke/scene_io.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace hooke::app {

/// Records a simulation: its objects with their looks, and frames that may lie between two steps.
class MotionRecorder {
 public:
  /// What is recorded of ropes, cloths, solids and particles.
  enum class Detail : std::uint8_t {
    kSkins,   ///< The triangles that are drawn.
    kPoints,  ///< The points that are simulated.
  };

  MotionRecorder(MotionRecording motion, Detail detail) : motion_(std::move(motion)), detail_(detail) {}

  /// Copies the present state with its time [s]; the copy before it stays for interpolation.
  void take(const Simulation& simulation, double time);

  /// Stores the frame at a time between the last two states, or at the last one. Errors: those of
  /// MotionRecording.
  Result<void> record(const Simulation& simulation, double time);

  /// Returns the motion recorded so far.
  [[nodiscard]] const MotionRecording& motion() const { return motion_; }
  /// Returns what could not be recorded as it is, one line each.
  [[nodiscard]] std::vector<std::string> warnings() const;
  /// Tells whether some object was recorded.
  [[nodiscard]] bool has_objects() const { return !entries_.empty(); }

 private:
  /// An Entry is an object of the recording.
  struct Entry {
    std::uint32_t object = 0;
    std::optional<MotionSkin> skin;
  };
  /// A Taken is the state of an object after a step.
  struct Taken {
    ObjectKey key = {};
    MotionState state = {};
    std::vector<DVec3> points = {};
  };
  struct State {
    double time = 0;
    std::vector<Taken> objects;
  };

  [[nodiscard]] bool is_recorded(const SceneObject& object) const;
  /// Tells whether an object is a body that may get dents, which is recorded by its surface.
  [[nodiscard]] bool has_dents(const World& world, const SceneObject& object) const;
  [[nodiscard]] Taken taken(const World& world, const SceneObject& object) const;
  /// Returns null for an object that cannot be seen.
  Result<Entry*> find_entry(const Simulation& simulation, const SceneObject& object, const Taken& now);
  Result<std::uint32_t> add_body(const Simulation& simulation, const SceneObject& object,
                                 const Figure& figure);
  Result<std::uint32_t> add_piece_mesh(const FigureSolid& solid, std::vector<std::uint32_t> materials);
  Result<Entry> add_points(const SceneObject& object, const Figure& figure, const Taken& now);
  Result<std::uint32_t> add_plane(std::uint32_t material);
  Result<void> set_camera(const Scene& scene, double time);
  Result<void> add_lights(const Scene& scene);
  Result<void> add_joints(const Simulation& simulation);

  MotionRecording motion_;
  Detail detail_;
  MotionLooks looks_;
  BodyGeometries geometries_;
  std::map<ObjectKey, Entry> entries_;
  std::map<std::string, std::uint32_t> bodies_;  ///< Bodies of the first frame by their names.
  /// Meshes of bodies by what they are made of.
  std::map<std::tuple<const void*, float, float, float, std::vector<std::uint32_t>>, std::uint32_t> meshes_;
  std::vector<std::string> names_;  ///< Names of objects that have nothing to show.
  std::set<std::string> yielding_;  ///< Names of bodies that are recorded by their surfaces.
  std::size_t lost_joints_ = 0;     ///< Number of hooks of those.
  bool has_joints_ = false;
  bool is_crowded_ = false;  ///< Whether there are so many bodies that balls have fewer triangles.
  State previous_;
  State current_;
};

}  // namespace hooke::app
