/// Measures by how much one step of a method multiplies an oscillation, by making steps.

#include "base/float_environment.h"
#include "lab/methods/method.h"
#include "world/access.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace hooke::lab {

namespace {

constexpr Eigen::Index kMoving = 0;            ///< The coordinate along which the mass swings.
constexpr int kStepsToFill = 6;                ///< After these the memory of any method is full.
constexpr double kShortStep = 0.01;            ///< Of an oscillation with omega = 1/s [s].
constexpr double kUnevenSpeed = 0.7390851332;  ///< No method takes the mass exactly through its hook from it.

/// One kilogram swings through a held point, on a spring of 1 N/m whose length at rest is zero. Its force is
/// linear at any amplitude, as long as the mass stays on one line.
Result<System> make_oscillator(double zeta) {
  auto world = World::create({.gravity = {}, .wind = {.air_density = Real(0)}});
  if (!world) return world.error();
  ParticlesDesc desc;
  desc.particles = {{.position = {0, 0, 0}}, {.position = {1, 0, 0}}};
  desc.springs = {
      {.a = 0, .b = 1, .stiffness = Real(1), .damping = static_cast<Real>(2 * zeta), .rest_length = Real(0)}};
  desc.pins = {{}};
  const auto added = world.value().add_particles(desc);
  if (!added) return added.error();
  return System::create(WorldAccess::tables(world.value()), 0);
}

/// Makes single steps from any state and any memory. The state's numbers are x, h v, and the same two of each
/// entry of the memory: its other coordinates stay zero.
class Stepping {
 public:
  Stepping(const Method& method, const System& system, double h)
      : method_(method), system_(system), h_(h), y_(system.initial_state()) {
    // Only the size of the memory counts. Short steps fill it, because long ones may let the state explode.
    const double fill = std::min(h_, kShortStep);
    for (int i = 0; i < kStepsToFill; ++i) method_.step(system_, i * fill, fill, y_, work_);
    full_ = work_;
  }

  [[nodiscard]] Eigen::Index size() const {
    return 2 * (1 + static_cast<Eigen::Index>(full_.history.size()));
  }

  Eigen::VectorXd step(const Eigen::VectorXd& from) {
    work_ = full_;
    work_.matrix.reset();
    work_.carried.reset();
    y_ = entry(from, 0);
    for (std::size_t i = 0; i < work_.history.size(); ++i) work_.history[i] = entry(from, i + 1);
    method_.step(system_, 0, h_, y_, work_);
    Eigen::VectorXd to(size());
    to.head(2) = numbers(y_);
    for (std::size_t i = 0; i < work_.history.size(); ++i)
      to.segment(2 * static_cast<Eigen::Index>(i + 1), 2) = numbers(work_.history[i]);
    return to;
  }

  [[nodiscard]] const std::optional<Error>& error() const { return work_.error; }

 private:
  [[nodiscard]] Eigen::Index speed() const { return system_.coordinates() + kMoving; }
  [[nodiscard]] State entry(const Eigen::VectorXd& numbers, std::size_t i) const {
    State state = State::Zero(y_.size());
    state[kMoving] = numbers[2 * static_cast<Eigen::Index>(i)];
    state[speed()] = numbers[2 * static_cast<Eigen::Index>(i) + 1] / h_;
    return state;
  }
  [[nodiscard]] Eigen::Vector2d numbers(const State& state) const {
    return {state[kMoving], h_ * state[speed()]};
  }

  const Method& method_;
  const System& system_;
  double h_;
  State y_;
  Workspace work_;
  Workspace full_;
};

}  // namespace

Result<double> measured_growth(std::string_view stepper, double omega_dt, double zeta) {
  const base::FloatEnvironment environment;
  const Method* method = find_method(stepper);
  if (method == nullptr) return unknown_method(stepper);
  if (!(omega_dt >= 1e-6 && omega_dt <= 1e3))
    return Error{ErrorCode::kOutOfRange, "omega_dt", "must be 1e-6 to 1000"};
  if (!(zeta >= 0 && zeta <= 100)) return Error{ErrorCode::kOutOfRange, "zeta", "must be 0 to 100"};
  if (method->growth == nullptr)
    return Error{ErrorCode::kUnsupported, "stepper", "an adaptive method has no growth per step"};
  const Result<System> system = make_oscillator(zeta);
  if (!system) return system.error();
  Stepping stepping(*method, system.value(), omega_dt);
  const Eigen::Index size = stepping.size();
  Eigen::VectorXd base = Eigen::VectorXd::Zero(size);
  base.head(2) << 1, kUnevenSpeed;
  const Eigen::VectorXd from_base = stepping.step(base);
  Eigen::MatrixXd map(size, size);
  for (Eigen::Index i = 0; i < size && !stepping.error(); ++i) {
    map.col(i) = stepping.step(base + Eigen::VectorXd::Unit(size, i)) - from_base;
  }
  if (stepping.error()) return *stepping.error();
  return map.eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace hooke::lab
