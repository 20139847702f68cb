#pragma once

#include "hooke/lab.h"
#include "hooke/result.h"
#include "hooke/scene_io.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace hooke::app {

/// This word stands for the real-time solver beside the names of lab::steppers().
inline constexpr const char* kSolverName = "solver";
/// This word stands for what lab::Accuracy chooses, in scenes that declare one.
inline constexpr const char* kDeclaredName = "declared";

/// A Stage is what every stepper is given: a scene at its start, without timeline and expectations, and the
/// point that is watched.
struct Stage {
  Simulation start;  ///< The scene at its start, which is never stepped.
  SceneObject object;
  std::vector<DVec3> points;  ///< Points of the object at the start; of a body its center of mass [m].
  std::uint32_t point = 0;    ///< Index of the watched point in the object.
  std::string point_name;     ///< Such as "rope:15".

  [[nodiscard]] const Scene& scene() const { return start.scene(); }
  [[nodiscard]] double dt() const { return static_cast<double>(scene().dt); }
};

/// Makes the stage. `point` is "OBJECT:INDEX", "OBJECT:last", or "OBJECT", which means its last point. Empty
/// stands for the last point of the first object that has points, else for the center of mass of the first
/// body that forces move.
Result<Stage> make_stage(Scene scene, const std::string& point);

/// A Player is one run by one stepper. All functions belong to the same run.
struct Player {
  std::function<Result<void>()> advance;       ///< Advances by Stage::dt.
  std::function<DVec3()> position;             ///< Position of the watched point [m].
  std::function<std::vector<DVec3>()> points;  ///< Positions of all points of the watched object [m].
  std::function<Energy()> energy;
  std::function<double()> evaluations;               ///< Evaluations of the forces so far.
  std::function<lab::CollisionReport()> collisions;  ///< Report so far; empty for the solver.
  std::string note = {};                             ///< What was chosen, if the run chose.
};

/// Checks a name. Errors: no such stepper, with the list of those that exist; kUnsupported for one that was
/// not built in.
Result<void> check_stepper(const std::string& name);

/// Turns an error of the laboratory about a scene into bad input, with the scene as `where`.
Error refusal(const std::string& scene, const Error& reason);

/// Share of its length by which the weight of an object stretches what stands for its rigid springs.
inline constexpr double kRigidStretch = 1e-3;

/// Makes a run of the stage by a method of the laboratory, or by kDeclaredName. Rigid springs and ropes
/// become springs (kRigidStretch), solids stand still. Errors are those of lab::Run::create.
Result<lab::Run> make_stage_run(const Stage& stage, const std::string& name, double dt, bool force);

/// Makes a player of the solver, of a method of the laboratory, or of kDeclaredName. `dt` [s] is the length
/// of one advance. Errors are those of lab::Run::create.
Result<Player> make_player(const Stage& stage, const std::string& name, double dt, bool force);

/// Makes a run of the whole scene by a method of the laboratory, "auto", or kDeclaredName for the scene's
/// accuracy over `seconds`. Objects that name a stepper keep it. Errors are those of lab::Run::create.
Result<lab::Run> make_run(const Simulation& simulation, const std::string& stepper, double seconds,
                          bool force);

/// Gives the objects of the simulation the positions and velocities of the run, to be drawn and measured. The
/// Error tells of a point that is farther away than 1000 km.
Result<void> show_run(const lab::Run& run, Simulation& simulation);

/// Returns the points of an object in a run of the laboratory [m]; of a body its center of mass, if it moves.
std::vector<DVec3> positions_of(const lab::Run& run, const SceneObject& object);

/// Tells whether the report is about the object.
bool is_of(const lab::ObjectReport& report, const SceneObject& object);

/// Returns the first point of an object, as the laboratory names objects.
PointRef reference_of(const SceneObject& object);

}  // namespace hooke::app
