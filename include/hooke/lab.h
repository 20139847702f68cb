#pragma once

#include "hooke/geometry.h"
#include "hooke/id.h"
#include "hooke/math.h"
#include "hooke/result.h"
#include "hooke/world.h"

#include <complex>
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
/// Every method has its own file in src/lab/methods, all with one signature, to be read side by side.
///
/// What a World holds becomes forces: springs, segments of ropes, bends, gravity, fields, drag, wind, force
/// laws. Points that are held follow their motion exactly. These things differ from a World:
///
/// - Rigid springs and ropes have no force law: they are refused, or become stiff springs
///   (Options::rigid_stretch). Soft solids are refused, or stand still (Options::solids_stand). Limits and
///   tethers are left out. ObjectReport::left_out says what was replaced or left out.
/// - A point that a step leaves inside a static body is put back on its surface. It loses its speed into the
///   body and what friction takes of its sliding. That makes any method first order there.
/// - Bodies collide by rollback, see CollisionOptions.
/// - Of hooks, only a hinge to the world through a body's center of mass holds.
///
/// docs/laboratory.md tells more.

namespace hooke::lab {

/// A method of integration. Its limits are those of the oscillator x'' = -omega^2 x - 2 zeta omega x'.
struct StepperInfo {
  std::string_view name;   ///< Name by which options choose it: "rk4". It lives as long as the program.
  std::string_view title;  ///< Title for people: "Runge-Kutta 4".
  int order = 0;        ///< Order: the global error goes as dt^order; 0 if the method keeps to a tolerance.
  int evaluations = 0;  ///< Evaluations of the forces per step; 0: as many as it needs (implicit, adaptive).
  bool implicit = false;       ///< Whether a step solves equations for its own end.
  bool adaptive = false;       ///< Whether it chooses its own steps inside a step, by Options::tolerance.
  bool available = true;       ///< False if it needs SUNDIALS, and was built without.
  double imaginary_limit = 0;  ///< Largest stable omega dt at zeta = 0; 0: grows at any; infinity: never.
  double real_limit = 0;       ///< Largest stable |lambda| dt of a pure decay y' = lambda y; infinity: any.
};

/// Lists all methods, from the simplest on. The list lives as long as the program. "auto" is no method: see
/// Options::stepper.
[[nodiscard]] std::span<const StepperInfo> steppers();

/// Finds the method of this name. Errors: kOutOfRange for an unknown name, with the list of those there are.
[[nodiscard]] Result<StepperInfo> find_stepper(std::string_view name);

/// Factor by which one step multiplies an oscillation, from the method's own formula: the spectral radius at
/// omega dt >= 0 and damping ratio zeta >= 0. The oscillation grows if it is more than 1. It is 0 for
/// adaptive methods. Errors: an unknown name, arguments out of range.
[[nodiscard]] Result<double> growth_per_step(std::string_view stepper, double omega_dt, double zeta);

/// The same for any z = lambda dt of y' = lambda y, lambda being one of a pair of conjugate eigenvalues, or a
/// double real one. The method is stable where this is at most 1. Errors: an unknown name, z not finite.
[[nodiscard]] Result<double> growth_at(std::string_view stepper, std::complex<double> z);

/// The same factor, measured: the method itself makes steps of an oscillator of one mass on one spring, from
/// as many states as its memory is large, and the result is the largest eigenvalue of that linear map.
/// Errors: an unknown name, an adaptive method, omega_dt not in [1e-6, 1000], zeta not in [0, 100].
[[nodiscard]] Result<double> measured_growth(std::string_view stepper, double omega_dt, double zeta);

/// How far the result may be from the exact one, in place of how to compute it.
struct Accuracy {
  /// Largest error of any point's position at any output up to `seconds` [m]. [1e-12, 1e6]
  double max_error = 1e-3;
  double seconds = 1;  ///< Length of the run that it is declared for [s]. [1e-9, 1e6]
};

/// The method for one object.
struct ObjectStepper {
  PointRef object = {};  ///< Any point of the object, as made by point(id, 0).
  std::string stepper;   ///< A name of steppers(), or "auto".
};

/// How the laboratory treats bodies that collide: by rollback (the paper's 4.3.2, listing 11).
///
/// A step that leaves two bodies deeper in each other than `epsilon` is canceled. The bodies are set back to
/// their last clear state and take a shorter step, again and again until they touch; then they hit. Bodies
/// that rest or slide on each other are in a state of their own: what they press on each other with acts
/// through the step as a force.
struct CollisionOptions {
  /// What finds a collision.
  enum class Collider : std::uint8_t {
    kNone,   ///< Nothing: bodies pass through each other.
    kExact,  ///< Faces, edges and corners.
    /// Of a sphere with what is flat, only faces that its center is over: the paper's (4.3.1), which misses
    /// edges (4.4, figure 6).
    kFaces,
  };
  /// How the length of the next try is found.
  enum class Search : std::uint8_t {
    kHalving,      ///< Half of the last one; what is clear stays done (listing 11).
    kBackward,     ///< Back from the penetration by its depth over its speed, again and again (4.5.1).
    kEvent,        ///< The root of the distance on the step's interpolation, mended by the steps that follow.
    kAdvancement,  ///< Conservative advancement on the same interpolation: never late.
  };
  /// How places are found where two solids of triangles touch; the answer is the same to the bit.
  enum class MeshSearch : std::uint8_t {
    kAll,   ///< All faces and edges of one against all of the other: the paper's.
    kTree,  ///< By trees of oriented boxes.
  };
  /// How collisions within a step are seen that leave no overlap at its end.
  enum class Sweep : std::uint8_t {
    kNone,      ///< Not at all: fast bodies pass through thin ones, as in the paper (4.4).
    kCast,      ///< Conservative advancement of each pair along its way.
    kExtruded,  ///< The same for the pairs whose extruded silhouettes meet (4.5.4).
  };

  Collider collider = Collider::kExact;  ///< What finds a collision.
  /// Which pairs the collider is asked about: those whose volumes may meet on their ways. Half-spaces are
  /// near to all.
  Preselection preselection = Preselection::kBox;
  MeshSearch mesh_search = MeshSearch::kTree;  ///< How places are found where solids of triangles touch.
  Search search = Search::kEvent;              ///< How the length of the next try is found.
  Sweep sweep = Sweep::kCast;                  ///< How collisions within a step are seen.
  double epsilon = 1e-6;  ///< Depth, and distance, that counts as touching [m]. [1e-12, 1]
  /// Tries in a row that may be canceled. [1, 1000] Then the bodies hit where they were clear last, moved
  /// together by their inverse masses.
  int iteration_limit = 40;
  bool regional = true;  ///< Whether only bodies that meet in a step take it again, and not all.
};

/// What collisions cost and left, since the run began.
struct CollisionReport {
  std::uint64_t rollbacks = 0;      ///< Steps that were canceled.
  double resimulated_seconds = 0;   ///< Sum of their lengths, each times its bodies [s].
  std::uint64_t hits = 0;           ///< Hits of pairs of bodies.
  std::uint64_t limit_reached = 0;  ///< Times that the iteration limit ended a search.
  std::uint64_t zeno = 0;           ///< Steps with more hits than could be followed: the rest went unbounced.
  double deepest = 0;               ///< Largest overlap that was left in a state [m].
  double last_hit = 0;              ///< Time of the last hit [s].
  std::uint64_t candidates = 0;     ///< Pairs of bodies that the preselection left, summed over steps.
  std::uint64_t touching = 0;       ///< Pairs of these that touched.
  /// Largest distance of a first step back from where the method was at that time, for kBackward [m].
  double backward_error = 0;
};

/// How a Run integrates a scene.
struct Options {
  /// A name of steppers(), or "auto", which chooses for each object
  /// - taylor2 if only gravity and uniform fields act on it, as its steps are then exact;
  /// - implicit_euler if rk4 would not be stable at `dt`;
  /// - verlet if nothing brakes it, no magnetic field or force law acts, and omega dt <= 0.5;
  /// - rk4 otherwise.
  std::string stepper = "rk4";
  std::vector<ObjectStepper> object_steppers = {};  ///< Methods of some objects, in place of `stepper`.
  double dt = 1.0 / 60;                             ///< Length of one advance() [s]. [1e-9, 1e6]
  double tolerance = 1e-8;  ///< Tolerance of adaptive methods, relative and absolute. [1e-14, 0.1]
  /// Replaces `stepper` and `object_steppers`: verlet, rk4, and bdf2 where the scene is stiff, are tried with
  /// `dt` cut into 1, 2, 4, ... 16384 parts until two runs agree. The run with fewest evaluations is taken,
  /// those of an implicit method counted tenfold. Then `dt` is the distance of outputs only.
  std::optional<Accuracy> accuracy = {};
  /// Whether to run an explicit method where it is known to diverge. Otherwise that is an Error that names
  /// the spring: where its oscillation grows, or, for methods without any stable step without damping, grows
  /// by more than 10 % per period.
  bool force = false;
  bool contacts = true;  ///< Whether points touch static bodies, and bodies each other.
  /// What a rigid spring or segment becomes. 0: an Error. Otherwise a spring without damping, so stiff that
  /// the weight of the whole object at 9.81 m/s^2 stretches it by this share of its length. [0, 0.1]
  double rigid_stretch = 0;
  /// Whether soft solids, which have no forces here, stand still where they are instead of being an Error.
  bool solids_stand = false;
  CollisionOptions collisions = {};  ///< How bodies collide.
};

/// What was done for one object, and how well.
struct ObjectReport {
  PointRef::Kind kind = PointRef::Kind::kNone;  ///< Kind of the object; kNone for a body.
  std::uint32_t slot = 0;                       ///< Slot of its id.
  std::string stepper;                          ///< Name of its method.
  double dt = 0;                                ///< Step of the method, not of the output [s].
  std::uint64_t steps = 0;            ///< Steps of the method; of adaptive ones those that they chose.
  std::uint64_t evaluations = 0;      ///< Evaluations of the forces on the whole object.
  std::optional<double> error = {};   ///< Estimated error if Options::accuracy was given [m].
  std::vector<std::string> left_out;  ///< What of the object has no force here, or another, in words.
};

/// How an object moves for small displacements from where it is: the eigenvalues of y' = f(t, y).
struct Spectrum {
  PointRef::Kind kind = PointRef::Kind::kNone;  ///< Kind of the object.
  std::uint32_t slot = 0;                       ///< Slot of its id.
  /// Eigenvalues lambda [1/s], the largest first. An oscillation that is damped by zeta has the pair
  /// omega (-zeta +- i sqrt(1 - zeta^2)).
  std::vector<std::complex<double>> eigenvalues = {};
  /// Whether the object has more than 100 free points. Then these are upper bounds, one pair for each free
  /// point, after Gershgorin: no oscillation is faster than the fastest of them.
  bool bounded = false;
  std::string stiffest = {};  ///< What makes it fast, such as "spring 3 of particles 1 (k = 1e+05 N/m)".
};

/// The state of a body in the laboratory.
struct BodyState {
  DVec3 center = {};                 ///< Center of mass [m].
  Quaternion<double> rotation = {};  ///< Rotation of the body's frame, of unit length.
  DVec3 velocity = {};               ///< Velocity of the center of mass [m/s].
  DVec3 angular_velocity = {};       ///< Angular velocity in the world's axes [rad/s].
};

/// A scene in the laboratory, as it stood in the World when the run was created. It does not need the World
/// any more. Deformable objects do not act on one another here, so that each is integrated on its own, if
/// wanted by a method of its own.
class Run {
 public:
  /// Makes a run from a World. Errors: an unknown stepper, a step or tolerance out of range, a rigid spring
  /// or rope or a soft solid (see Options::rigid_stretch and Options::solids_stand), an explicit method
  /// beyond its stability limit (see Options::force), a Taylor method where a force has no known derivative
  /// (force laws, gusts), an accuracy that cannot be reached, SUNDIALS missing.
  [[nodiscard]] static Result<Run> create(const World& world, const Options& options = {});
  /// Destroys the run.
  ~Run();
  ///@{
  /// Takes everything over. The Run moved from may only be destroyed or assigned to.
  Run(Run&&) noexcept;
  Run& operator=(Run&&) noexcept;
  ///@}

  /// Makes one step of Options::dt. Errors: the state is not finite any more, or Newton or SUNDIALS did not
  /// converge; time and state are then those before the step.
  Result<void> advance();

  /// Time, which continues that of the World [s].
  [[nodiscard]] double time() const;
  /// Length of one advance() [s].
  [[nodiscard]] double dt() const;

  ///@{
  /// Positions of an object's points [m], in the order that its maker gave; empty for an id that was not in
  /// the World.
  [[nodiscard]] std::vector<DVec3> positions(ParticlesId id) const;
  [[nodiscard]] std::vector<DVec3> positions(RopeId id) const;
  [[nodiscard]] std::vector<DVec3> positions(ClothId id) const;
  ///@}
  ///@{
  /// Velocities of an object's points [m/s], likewise.
  [[nodiscard]] std::vector<DVec3> velocities(ParticlesId id) const;
  [[nodiscard]] std::vector<DVec3> velocities(RopeId id) const;
  [[nodiscard]] std::vector<DVec3> velocities(ClothId id) const;
  ///@}
  ///@{
  /// Positions [m] or velocities [m/s] of the points of all objects, one object after the other in the order
  /// of creation.
  [[nodiscard]] std::vector<DVec3> positions() const;
  [[nodiscard]] std::vector<DVec3> velocities() const;
  ///@}

  /// State of a body. Errors: kStaleId for a body that was not in the World, or that is static.
  [[nodiscard]] Result<BodyState> body(BodyId id) const;

  /// Energy of all objects and bodies, as World::measure() has it: points that are held have none, fields and
  /// gravity are potential.
  [[nodiscard]] Energy energy() const;

  /// Number of evaluations of the forces so far, summed over objects and bodies.
  [[nodiscard]] std::uint64_t evaluations() const;
  /// Reports on each object in the order of creation, then on each body that moves.
  [[nodiscard]] std::vector<ObjectReport> report() const;
  /// Eigenvalues of each object as it is now, without bodies, in the order of creation. Force laws count as
  /// constant.
  [[nodiscard]] std::vector<Spectrum> spectra() const;
  /// Report on collisions so far; it lives as long as the run, and advance() updates it.
  [[nodiscard]] const CollisionReport& collisions() const;

 private:
  struct Data;
  explicit Run(std::unique_ptr<Data> data);
  std::unique_ptr<Data> data_;
};

/// How the error falls with the step.
struct OrderMeasurement {
  double order = 0;        ///< Slope of log error over log dt between the two smallest steps.
  std::vector<double> dt;  ///< Lengths of the step, each half of the one before [s].
  std::vector<double>
      error;  ///< For each, the largest distance of any point from the reference at the end [m].
};

/// Runs `options` to time `seconds` with dt and with dt halved 1, 2, ... `halvings` times, and compares with
/// rk4 at an eighth of the smallest step. The scene must be smooth: without contacts and gusts. Errors:
/// `seconds` not from dt to 1e6 dt, `halvings` not from 1 to 16, and those of Run.
[[nodiscard]] Result<OrderMeasurement> measure_order(const World& world, const Options& options,
                                                     double seconds, int halvings = 4);

/// A chain of equal springs and masses along a line, its first end held.
struct Chain {
  int springs = 1;       ///< Number of springs. [1, 1024]
  double mass = 1;       ///< Mass of each point [kg]. [1e-6, 1e6]
  double dt = 1.0 / 60;  ///< Length of a step [s]. [1e-6, 1000]
};

///@{
/// Largest stiffness k of the chain's springs [N/m] at which its oscillations do not grow. The first function
/// bisects runs. The second takes the method's limit for the fastest mode of n springs and masses m:
///
///     omega^2 = 4 (k/m) sin^2(pi (2n - 1) / (4n + 2))
///
/// It is 0 for methods that always diverge, and infinite for those that never do (found above 1e6 m/dt^2).
/// Errors: an unknown name, a chain out of range.
[[nodiscard]] Result<double> largest_stable_stiffness(std::string_view stepper, const Chain& chain = {});
[[nodiscard]] Result<double> stable_stiffness_in_theory(std::string_view stepper, const Chain& chain = {});
///@}

///@{
/// Largest stable omega dt of one mass on one spring with damping ratio `zeta` in [0, 100]. The first
/// function bisects runs, the second takes growth_per_step. Errors: an unknown name, `zeta` out of range.
[[nodiscard]] Result<double> largest_stable_step(std::string_view stepper, double zeta);
[[nodiscard]] Result<double> stable_step_in_theory(std::string_view stepper, double zeta);
///@}

}  // namespace hooke::lab
