#pragma once

#include "hooke/lab.h"

#include "lab/system/axle.h"
#include "lab/system/elements.h"
#include "state/tables.h"

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// \file
/// Represents one object of a World as y' = f(t, y).

namespace hooke::lab {

/// y = (x, v) holds positions [m] and velocities [m/s] of the n free points. A body is two points: its center
/// of mass and its rotation [rad], [rad/s], which turn.h moves like a point. Held points are not in y,
/// because their motion is known.
using State = Eigen::VectorXd;

/// This is where a body is and how it moves.
struct BodyMotion {
  DVec3 center = {};                 ///< Center of mass [m].
  Quaternion<double> rotation = {};  ///< Rotation from the principal axes of inertia to the world; unit.
  DVec3 velocity = {};               ///< Velocity of the center [m/s].
  DVec3 spin = {};                   ///< Angular velocity in world axes [rad/s].
};

/// These are the entries of da/dx and da/dv, the derivatives of accelerations. Rows and columns count
/// coordinates of points.
struct Jacobian {
  struct Entry {
    int row = 0, column = 0;
    double value = 0;
  };
  std::vector<Entry> by_position;  ///< [1/s^2]
  std::vector<Entry> by_velocity;  ///< [1/s]
};

/// This is the fastest oscillation that the rows at one point can make: an upper bound (Gershgorin) of
/// omega^2 and of the rate of its damping, lambda^2 + damping lambda + omega^2 = 0. `row` is the row that
/// adds most to it.
struct Oscillation {
  double omega_squared = 0;  ///< [1/s^2]
  double damping = 0;        ///< [1/s]
  std::size_t row = 0;       ///< See System::row_name.
};

/// Says what a system does with what has no force law; see lab::Options.
struct Replacement {
  double rigid_stretch = 0;
  bool solids_stand = false;
};

class Laws;
class BodyLaws;

class System {
 public:
  /// Makes the system of object `object` of the tables. The Error tells of a solid, or of a rigid spring or
  /// segment, that `replacement` does not allow.
  static Result<System> create(const state::Tables& tables, std::uint32_t object,
                               const Replacement& replacement = {});
  /// Makes the system of a rigid body that moves freely, or as told (kinematic). `laws` may be null.
  static System create_body(const state::Tables& tables, std::uint32_t row, std::shared_ptr<BodyLaws> laws);

  [[nodiscard]] State initial_state() const;
  [[nodiscard]] Eigen::Index coordinates() const { return coordinates_; }  ///< Three per free point.

  // These are the parts of y.
  [[nodiscard]] auto x(State& y) const { return y.head(coordinates_); }
  [[nodiscard]] auto v(State& y) const { return y.segment(coordinates_, coordinates_); }
  [[nodiscard]] auto x(const State& y) const { return y.head(coordinates_); }
  [[nodiscard]] auto v(const State& y) const { return y.segment(coordinates_, coordinates_); }

  /// Returns y' = (v, a). This counts as one evaluation.
  [[nodiscard]] State operator()(double t, const State& y) const;
  /// Returns a(t, x, v). This counts as one evaluation.
  [[nodiscard]] State acceleration(double t, const State& y) const;
  /// Returns `count` (1 to 3) of a, its derivative in time along the solution (jerk), and that one's (snap),
  /// exactly, by series. This counts as `count` evaluations. Precondition: differentiable().
  [[nodiscard]] std::vector<State> acceleration_and_derivatives(double t, const State& y, int count) const;
  /// Returns J direction, with J = df/dy. It is exact where differentiable(); force laws and gusts are taken
  /// as constant.
  [[nodiscard]] State jacobian_times(double t, const State& y, const State& direction) const;
  [[nodiscard]] Jacobian jacobian(double t, const State& y) const;

  [[nodiscard]] Energy energy(double t, const State& y) const;
  /// Returns one oscillation per free point on which any row acts.
  [[nodiscard]] std::vector<Oscillation> oscillations(double t, const State& y) const;
  /// Returns the eigenvalues of df/dy; see lab::Spectrum.
  [[nodiscard]] Spectrum spectrum(double t, const State& y) const;
  /// Returns a name such as "spring 3 of particles 1 (k = 1e+05 N/m)".
  [[nodiscard]] std::string row_name(std::size_t row) const;

  /// Returns the positions of all points of the object, held or not, in the order of their creation. A body
  /// has four: its center, and where its three axes meet the sphere around it.
  [[nodiscard]] std::vector<DVec3> positions(double t, const State& y) const;
  [[nodiscard]] std::vector<DVec3> velocities(double t, const State& y) const;

  /// Tells whether series can represent all of f: there are no force laws and no gusts.
  [[nodiscard]] bool differentiable() const { return !has_laws() && !gusts_; }
  /// Tells whether forces depend on velocities.
  [[nodiscard]] bool velocity_dependent() const { return velocity_dependent_; }
  /// Tells whether nothing but gravity and uniform fields acts.
  [[nodiscard]] bool ballistic() const { return ballistic_; }
  [[nodiscard]] bool has_laws() const { return laws_ != nullptr || body_laws_ != nullptr; }

  [[nodiscard]] PointRef::Kind kind() const { return kind_; }
  [[nodiscard]] std::uint32_t slot() const { return slot_; }
  [[nodiscard]] std::string name() const;  ///< Such as "particles 1".
  [[nodiscard]] const std::vector<std::string>& left_out() const { return left_out_; }
  [[nodiscard]] std::uint64_t evaluations() const { return evaluations_; }

  // These are for bodies.
  [[nodiscard]] bool is_body() const { return kind_ == PointRef::Kind::kNone; }
  [[nodiscard]] BodyMotion body(double t, const State& y) const;
  /// Returns the accelerations of the center [m/s^2] and of the spin [rad/s^2], for a body that moves freely.
  [[nodiscard]] std::array<DVec3, 2> body_acceleration(double t, const State& y) const;
  void set_velocity(State& y, DVec3 velocity, DVec3 spin) const;
  void move_center(State& y, DVec3 displacement) const;
  /// Rotates the body by the rotation vector `turn`, 2 tan(angle / 2) times an axis (turn.h). Its spin stays.
  void rotate_by(State& y, DVec3 turn) const;
  /// Sets the force [N] and the torque about the center [N m] that act from now on, in world axes. A bearing
  /// takes what an axle cannot follow.
  void set_load(DVec3 force, DVec3 torque);
  /// Shows force laws where the body is at the start of a step, for what they do to other bodies.
  void show_laws(double t, const State& y) const;
  /// Takes the rotation of `y` as the new origin of rotation coordinates, if it is far from the old one.
  /// \return Whether it did; then states kept from before are meaningless.
  bool lay_chart(State& y);
  /// Returns false after a step in which a body rotated so far that its coordinates are ambiguous.
  [[nodiscard]] bool rotation_is_known(const State& y) const;

  /// Returns the row of free point `i` of y in the object, for contacts.
  [[nodiscard]] std::uint32_t row_of_free(Eigen::Index i) const { return free_rows_[i]; }
  [[nodiscard]] double radius(std::uint32_t row) const { return radius_[row]; }

 private:
  static constexpr int kHeld = -1;

  /// These are positions and velocities of all rows of the object at one time.
  template <class T>
  struct Motion {
    std::vector<Vector3<T>> x, v;
  };

  PointRow add_fields(const state::Tables& tables);
  /// Notes which fields are left out.
  void note_fields(const state::Tables& tables);
  /// Lets a body rotate about the axle of its hinge alone, or notes that its hooks are left out.
  void add_axle(const state::Tables& tables, std::uint32_t row, DVec3 spin);
  /// Notes which loads of a body are left out.
  void note_loads(const state::Tables& tables, std::uint32_t row);
  void add_points(const state::Tables& tables, const state::Deformable& object);
  Result<void> add_springs(const state::Tables& tables, const state::Deformable& object,
                           double rigid_stretch);
  Result<void> add_segments(const state::Tables& tables, const state::Deformable& object,
                            double rigid_stretch);
  /// Returns the stiffness that stands for a rigid one of this length [N/m].
  [[nodiscard]] double stiffness_of_rigid(double rest_length, double rigid_stretch) const;
  /// Notes how many rigid rows became springs, the stiffest of them of `stiffness`.
  void note_rigid(const char* rows, int count, double stiffness, double rigid_stretch);
  /// Makes all points of a solid stand, and notes that.
  void let_stand(const state::Tables& tables, const state::Deformable& object);
  void add_bends(const state::Tables& tables, const state::Deformable& object);
  void add_air(const state::Tables& tables, const state::Deformable& object);
  void note(const state::Tables& tables, const state::Deformable& object);

  template <class T, class Row, class From>
  static auto gather(const Row& row, const Motion<From>& m, const std::vector<DVec3>& wind) {
    Points<T, Row::kPoints> p;
    for (int i = 0; i < Row::kPoints; ++i) {
      p.x[i] = vector_cast<T>(m.x[row.at[i]]);
      p.v[i] = vector_cast<T>(m.v[row.at[i]]);
      p.wind[i] = wind[row.at[i]];
    }
    return p;
  }
  template <class T>
  Motion<T> motion(double t, const std::vector<State>& x_terms, const std::vector<State>& v_terms) const;
  /// Returns accelerations of all rows, without force laws; they are meaningless for held rows.
  template <class T>
  std::vector<Vector3<T>> accelerations(const Motion<T>& motion, const std::vector<DVec3>& wind) const;
  /// Calls `visit(row)` for each row of each kind.
  template <class Visit>
  void for_each_row(Visit&& visit) const {
    for (const SpringRow& row : springs_) visit(row);
    for (const BendRow& row : bends_) visit(row);
    for (const CurvatureRow& row : curvatures_) visit(row);
    for (const SailRow& row : sails_) visit(row);
    for (const StrandRow& row : strands_) visit(row);
    for (const PointRow& row : points_) visit(row);
    for (const RotationRow& row : turns_) visit(row);
  }
  [[nodiscard]] std::vector<DVec3> wind(double t, const std::vector<DVec3>& x) const;
  [[nodiscard]] std::vector<DVec3> body_positions(double t, const State& y) const;
  [[nodiscard]] BodyMotion body_of(const Motion<double>& motion, double t) const;
  /// Adds the effect of force laws on a body to the accelerations of its two rows.
  void add_body_laws(double t, const Motion<double>& motion, std::vector<DVec3>& accelerations) const;
  [[nodiscard]] Motion<double> motion_now(double t, const State& y) const;

  std::vector<SpringRow> springs_;  ///< Springs of the table, then the segments of a rope.
  std::vector<std::string> spring_names_;
  std::vector<BendRow> bends_;
  std::vector<CurvatureRow> curvatures_;
  std::vector<SailRow> sails_;
  std::vector<StrandRow> strands_;
  std::vector<PointRow> points_;
  std::vector<RotationRow> turns_;       ///< One for a body that moves freely.
  Quaternion<double> chart_ = {};        ///< Rotation of a body where its coordinates p are zero.
  std::optional<DVec3> kinematic_spin_;  ///< Spin of a kinematic body [rad/s].
  std::optional<Axle> axle_;             ///< Set for a body that only rotates about an axis.
  std::shared_ptr<const std::vector<FieldDesc>> attractors_;
  std::shared_ptr<Laws> laws_;           ///< Null if there are none.
  std::shared_ptr<BodyLaws> body_laws_;  ///< Shared by all bodies; null if there are none.
  std::uint32_t body_row_ = 0;           ///< Row in the World's tables.

  Eigen::Index coordinates_ = 0;
  std::vector<std::uint32_t> free_rows_;
  std::vector<int> free_of_row_;  ///< Index of the free point, or kHeld.
  std::vector<state::Pin> pins_;  ///< Motions of held points, by row.
  std::vector<std::uint32_t> row_of_point_;
  std::vector<double> mass_, radius_;
  std::vector<DVec3> start_x_, start_v_;

  PointRef::Kind kind_ = PointRef::Kind::kNone;
  std::uint32_t slot_ = 0;
  WindDesc wind_;
  std::uint64_t wind_step_ = 0;
  bool feels_air_ = false;
  bool gusts_ = false;
  bool velocity_dependent_ = false;
  bool ballistic_ = false;
  std::vector<std::string> left_out_;
  mutable std::uint64_t evaluations_ = 0;
};

template <class T>
std::vector<Vector3<T>> System::accelerations(const Motion<T>& m, const std::vector<DVec3>& wind) const {
  std::vector<Vector3<T>> force(m.x.size());
  for_each_row([&](const auto& row) {
    constexpr int kPoints = std::remove_cvref_t<decltype(row)>::kPoints;
    const Forces<T, kPoints> f = row.force(gather<T>(row, m, wind));
    for (int i = 0; i < kPoints; ++i) force[row.at[i]] += f[i];
  });
  for (std::size_t i = 0; i < force.size(); ++i) force[i] = (1 / mass_[i]) * force[i];
  return force;
}

}  // namespace hooke::lab
