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

/// The word for the real-time solver beside the names of lab::steppers().
inline constexpr const char* kSolverName = "solver";
/// The word for what lab::Accuracy chooses, in scenes that declare one.
inline constexpr const char* kDeclaredName = "declared";

/// What every stepper is given: a scene at its start, without timeline and expectations, and the point that
/// is watched.
struct Stage {
  Simulation start;  ///< Never stepped.
  SceneObject object;
  std::vector<DVec3> points;  ///< Of the object at the start; of a body its center of mass [m].
  std::uint32_t point = 0;    ///< Of the object.
  std::string point_name;     ///< "rope:15"

  [[nodiscard]] const Scene& scene() const { return start.scene(); }
  [[nodiscard]] double dt() const { return static_cast<double>(scene().dt); }
};

/// Sets the stage. `point` is "OBJECT:INDEX", "OBJECT:last", "OBJECT", which is the last, or empty: the last
/// point of the first object that has points, else the center of mass of the first body that forces move.
Result<Stage> make_stage(Scene scene, const std::string& point);

/// One stepper at work. All functions belong to the same run.
struct Player {
  std::function<Result<void>()> advance;  ///< By Stage::dt.
  std::function<DVec3()> position;        ///< Of the watched point [m].
  std::function<Energy()> energy;
  std::function<double()> evaluations;               ///< Of the forces, so far.
  std::function<lab::CollisionReport()> collisions;  ///< So far; of the solver none.
  std::string note = {};                             ///< What was chosen, if the run chose.
};

/// Errors: no such stepper, with the list of those that exist; kUnsupported for one that was not built in.
Result<void> check_stepper(const std::string& name);

/// What the laboratory says against a scene is bad input, and the scene is where.
Error refusal(const std::string& scene, const Error& reason);

/// The solver, a method of the laboratory, or kDeclaredName. `dt` [s] is the length of one advance. Errors:
/// as of lab::Run::create.
Result<Player> make_player(const Stage& stage, const std::string& name, double dt, bool force);

/// A run of the whole scene by a method of the laboratory, "auto", or kDeclaredName for the scene's accuracy
/// over `seconds`; objects that name a stepper keep it. Errors: as of lab::Run::create.
Result<lab::Run> make_run(const Simulation& simulation, const std::string& stepper, double seconds,
                          bool force);

/// Gives the objects of the simulation the places and velocities that the run has them at, to be drawn and
/// measured. Errors: a point is gone, further than 1000 km.
Result<void> show_run(const lab::Run& run, Simulation& simulation);

/// Points of an object in a run of the laboratory [m]; of a body its center of mass, if it moves.
std::vector<DVec3> positions_of(const lab::Run& run, const SceneObject& object);

/// Whether the report is of the object.
bool is_of(const lab::ObjectReport& report, const SceneObject& object);

/// The first point of an object, as the laboratory names objects.
PointRef reference_of(const SceneObject& object);

}  // namespace hooke::app
