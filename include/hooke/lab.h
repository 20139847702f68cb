#pragma once

#include "hooke/geometry.h"
#include "hooke/id.h"
#include "hooke/math.h"
#include "hooke/result.h"
#include "hooke/world.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// \file
/// The integrator laboratory: the same scenes as a World, as an ordinary differential equation y' = f(t, y)
/// in double, solved by the methods of the textbooks. Library hooke::lab.
///
///     World world = ...;  // with particles, ropes, cloths, bodies, fields
///     lab::Run run = lab::Run::create(world, {.stepper = "rk4"}).value();
///     while (run.time() < 10 && run.advance()) plot(run.time(), run.energy().total());
///
/// Every method has its own file in src/lab, all with one signature, to be read side by side.
///
/// What a World holds becomes forces: springs, segments of ropes, bends, gravity, fields, drag, wind, force
/// laws. Points that are held follow their motion exactly. What differs from a World: rigid springs and ropes
/// are refused, because they have no force law; limits and tethers, which have none either, are left out, and
/// ObjectReport::left_out says so; a point that a step leaves inside a static body is put back on its surface
/// and loses its speed into it, and of its sliding what friction takes, which makes any method first order
/// there. Bodies collide by rollback, see CollisionOptions; of hooks a hinge to the world through a body's
/// center of mass holds it, and no other. Docs: docs/laboratory.md.

namespace hooke::lab {

/// A method of integration. Limits are those of the oscillator x'' = -omega^2 x - 2 zeta omega x'.
struct StepperInfo {
  std::string_view name;
  std::string_view title;  ///< For people: "Runge-Kutta 4".
  int order = 0;           ///< Global error ~ dt^order; 0: the method keeps to a tolerance instead.
  int evaluations = 0;     ///< Of the forces per step; 0: as many as it needs (implicit, or by tolerance).
  bool implicit = false;
  bool adaptive = false;       ///< Chooses its own steps inside a step, by Options::tolerance.
  bool available = true;       ///< False: built without SUNDIALS.
  double imaginary_limit = 0;  ///< Largest stable omega dt at zeta = 0; 0: grows at any; infinity: never.
  double real_limit = 0;       ///< Largest stable |lambda| dt of a pure decay y' = lambda y; infinity: any.
};

/// All of them, from the simplest on. "auto" is not a method: see Options::stepper.
[[nodiscard]] std::span<const StepperInfo> steppers();

/// Errors: kOutOfRange for an unknown name, with the list of those there are.
[[nodiscard]] Result<StepperInfo> find_stepper(std::string_view name);

/// Factor by which one step multiplies an oscillation, from the method's own formula: the spectral radius at
/// omega dt >= 0 and damping ratio zeta >= 0; more than 1 diverges. Adaptive methods: 0. Errors: an unknown
/// name, arguments out of range.
[[nodiscard]] Result<double> growth_per_step(std::string_view stepper, double omega_dt, double zeta);

/// How far the result may be from the exact one, instead of how to compute it.
struct Accuracy {
  double max_error = 1e-3;  ///< Of any point's position at any output up to `seconds` [m], positive.
  double seconds = 1;       ///< Length of the run that it is declared for [s], positive.
};

/// A method for one object: `object` is any of its points, as made by point(id, 0).
struct ObjectStepper {
  PointRef object = {};
  std::string stepper;
};

/// How bodies that collide are dealt with: rollback (the paper's 4.3.2, listing 11).
///
/// A step that leaves two bodies deeper in each other than `epsilon` is canceled: they are set back to their
/// last clear state and take a shorter step, until they touch, when they hit. Bodies that rest or slide on
/// each other are a state of their own: what they press on each other with acts through the step as a force.
struct CollisionOptions {
  /// What finds a collision.
  enum class Collider : std::uint8_t {
    kNone,
    kExact,  ///< Faces, edges and corners.
    kFaces,  ///< Of a sphere with what is flat, only faces that its center is over: the paper's (4.3.1),
             ///< which misses edges (4.4, figure 6).
  };
  /// How the length of the next try is found.
  enum class Search : std::uint8_t {
    kHalving,      ///< Half of the last one; what is clear stays done (listing 11).
    kBackward,     ///< Back from the penetration by its depth over its speed, again and again (4.5.1).
    kEvent,        ///< The root of the distance on the step's interpolation, mended by the steps that follow.
    kAdvancement,  ///< Conservative advancement on the same: never late.
  };
  /// How places are found where two solids of triangles touch; the answer is the same to the bit.
  enum class MeshSearch : std::uint8_t {
    kAll,   ///< All faces and edges of one against all of the other: the paper's.
    kTree,  ///< By trees of oriented boxes.
  };
  /// How collisions within a step are seen that leave no overlap at its end.
  enum class Sweep : std::uint8_t {
    kNone,      ///< Not: fast bodies pass through thin ones, as in the paper (4.4).
    kCast,      ///< Conservative advancement of each pair along its way.
    kExtruded,  ///< The same for the pairs whose extruded silhouettes meet (4.5.4).
  };

  Collider collider = Collider::kExact;
  Preselection preselection = Preselection::kBox;  ///< Which pairs it is asked about: whose volumes may
                                                   ///< meet on their ways. Half-spaces are near to all.
  MeshSearch mesh_search = MeshSearch::kTree;
  Search search = Search::kEvent;
  Sweep sweep = Sweep::kCast;
  double epsilon = 1e-6;     ///< Depth, and distance, that counts as touching [m]. [1e-12, 1]
  int iteration_limit = 40;  ///< Tries in a row that may be canceled. Then the bodies hit where they were
                             ///< clear last, moved together by their inverse masses. [1, 1000]
  bool regional = true;      ///< Only bodies that meet in a step take it again, not all.
};

/// What collisions cost and left, since the run began.
struct CollisionReport {
  std::uint64_t rollbacks = 0;      ///< Steps that were canceled.
  double resimulated_seconds = 0;   ///< Of them, each times its bodies [s].
  std::uint64_t hits = 0;           ///< Of pairs of bodies.
  std::uint64_t limit_reached = 0;  ///< Times the iteration limit ended a search.
  std::uint64_t zeno = 0;           ///< Steps with more hits than could be followed: the rest went unbounced.
  double deepest = 0;               ///< Largest overlap that was left in a state [m].
  double last_hit = 0;              ///< When the last hit was [s].
  std::uint64_t candidates = 0;     ///< Pairs of bodies that the preselection left, summed over steps.
  std::uint64_t touching = 0;       ///< Of those, pairs that touched.
  double backward_error = 0;  ///< kBackward: farthest that a first step back came out from where the method
                              ///< was at that time [m].
};

struct Options {
  /// A name of steppers(), or "auto": for each object
  ///   taylor2         if only gravity and uniform fields act on it: its steps are then exact;
  ///   implicit_euler  if rk4 would not be stable at `dt`;
  ///   verlet          if nothing brakes it, no magnetic field or force law acts, and omega dt <= 0.5;
  ///   rk4             otherwise.
  std::string stepper = "rk4";
  std::vector<ObjectStepper> object_steppers = {};  ///< Replace `stepper` for some objects.
  double dt = 1.0 / 60;                             ///< Of one advance() [s]. [1e-9, 1e6]
  double tolerance = 1e-8;  ///< Of adaptive methods, relative and absolute. [1e-14, 0.1]
  /// Replaces `stepper` and `object_steppers`: verlet, rk4, and bdf2 where the scene is stiff, are tried with
  /// `dt` cut in 1, 2, 4, ... 16384 until two runs agree; the one with fewest evaluations is taken, an
  /// implicit one counting tenfold. Then `dt` is of the output only.
  std::optional<Accuracy> accuracy = {};
  /// Run an explicit method where it is known to diverge. Otherwise that is an Error naming the spring: where
  /// its oscillation grows, for methods without any stable step without damping by more than 10 % per period.
  bool force = false;
  bool contacts = true;  ///< Of points with static bodies, and of bodies with each other.
  CollisionOptions collisions = {};
};

/// What is done for one object, and how well.
struct ObjectReport {
  PointRef::Kind kind = PointRef::Kind::kNone;  ///< None: a body.
  std::uint32_t slot = 0;                       ///< Of its id.
  std::string stepper;
  double dt = 0;                      ///< Of the method, not of the output [s].
  std::uint64_t steps = 0;            ///< Of the method; for adaptive ones those they chose.
  std::uint64_t evaluations = 0;      ///< Of the forces on the whole object.
  std::optional<double> error = {};   ///< Estimate when Accuracy was declared [m].
  std::vector<std::string> left_out;  ///< What of the object has no force here, in words.
};

/// A body in the laboratory.
struct BodyState {
  DVec3 center = {};                 ///< Of mass [m].
  Quaternion<double> rotation = {};  ///< Of the body's frame; unit.
  DVec3 velocity = {};               ///< Of the center of mass [m/s].
  DVec3 angular_velocity = {};       ///< In world axes [rad/s].
};

/// A scene in the laboratory: as it stood in the World when the run was created. Objects do not act on one
/// another here, so each is integrated on its own, if wanted by a method of its own.
class Run {
 public:
  /// Errors: an unknown stepper, a step or tolerance out of range, a rigid spring, an explicit method beyond
  /// its stability limit (see Options::force), a Taylor method where a force has no known derivative (force
  /// laws, gusts), an accuracy that cannot be reached, SUNDIALS missing.
  [[nodiscard]] static Result<Run> create(const World& world, const Options& options = {});
  ~Run();
  Run(Run&&) noexcept;
  Run& operator=(Run&&) noexcept;

  /// One step of Options::dt. Errors: the state is not finite any more, Newton or SUNDIALS did not converge;
  /// time and state are then those before the step.
  Result<void> advance();

  [[nodiscard]] double time() const;  ///< [s], continues that of the World.
  [[nodiscard]] double dt() const;    ///< Of one advance() [s].

  /// In the order the maker gave the points; empty for an id that was not in the World. [m], [m/s]
  [[nodiscard]] std::vector<DVec3> positions(ParticlesId id) const;
  [[nodiscard]] std::vector<DVec3> positions(RopeId id) const;
  [[nodiscard]] std::vector<DVec3> positions(ClothId id) const;
  [[nodiscard]] std::vector<DVec3> velocities(ParticlesId id) const;
  [[nodiscard]] std::vector<DVec3> velocities(RopeId id) const;
  [[nodiscard]] std::vector<DVec3> velocities(ClothId id) const;
  /// Of all objects in order of creation, one after the other.
  [[nodiscard]] std::vector<DVec3> positions() const;
  [[nodiscard]] std::vector<DVec3> velocities() const;

  /// Errors: kStaleId for a body that was not in the World, or that stands.
  [[nodiscard]] Result<BodyState> body(BodyId id) const;

  /// As World::measure() has it: held points have none, fields and gravity are potential.
  [[nodiscard]] Energy energy() const;

  [[nodiscard]] std::uint64_t evaluations() const;  ///< Of the forces, summed over objects.
  [[nodiscard]] std::vector<ObjectReport> report() const;
  [[nodiscard]] const CollisionReport& collisions() const;

 private:
  struct Data;
  explicit Run(std::unique_ptr<Data> data);
  std::unique_ptr<Data> data_;
};

/// How the error falls with the step.
struct OrderMeasurement {
  double order = 0;           ///< Slope of log error over log dt between the two smallest steps.
  std::vector<double> dt;     ///< [s]
  std::vector<double> error;  ///< Largest distance of any point from the reference at the end [m].
};

/// Runs `options` with dt, dt/2, dt/4, ... (`halvings` times, 1 to 16) to time `seconds`, and compares with
/// rk4 at an eighth of the smallest of them. The scene must be smooth: no contacts, no gusts.
[[nodiscard]] Result<OrderMeasurement> measure_order(const World& world, const Options& options,
                                                     double seconds, int halvings = 4);

/// A chain of `springs` equal springs and masses along a line, its first end held.
struct Chain {
  int springs = 1;       ///< [1, 1024]
  double mass = 1;       ///< Of each point [kg].
  double dt = 1.0 / 60;  ///< [s]
};

/// Largest stiffness [N/m] at which oscillations of the chain do not grow: by bisection of runs, and by
/// growth_per_step at the chain's fastest mode, omega^2 = 4 (k/m) sin^2(pi (2n - 1) / (4n + 2)). 0 for
/// methods that always diverge, infinity for those that never do (found above 1e6 m/dt^2).
[[nodiscard]] Result<double> largest_stable_stiffness(std::string_view stepper, const Chain& chain = {});
[[nodiscard]] Result<double> stable_stiffness_in_theory(std::string_view stepper, const Chain& chain = {});

/// Largest stable omega dt of one mass on one spring with damping ratio `zeta` in [0, 100]: by bisection of
/// runs, and by growth_per_step.
[[nodiscard]] Result<double> largest_stable_step(std::string_view stepper, double zeta);
[[nodiscard]] Result<double> stable_step_in_theory(std::string_view stepper, double zeta);

}  // namespace hooke::lab
