/// Tests methods of integration: their order, and the stiffness up to which they are stable.

#include "validation/cases.h"
#include "validation/rig.h"

#include <algorithm>
#include <cmath>

namespace hooke::check {

namespace {

constexpr double kEccentricity = 0.3;

/// Adds a planet of semi-major axis 1 m about a center of strength 1 m^3/s^2, at its pericenter.
ParticlesId add_planet(Rig& rig) {
  must(rig.world().add_field({.kind = FieldDesc::Kind::kInverseSquare, .strength = 1}));
  const double speed = std::sqrt((1 + kEccentricity) / (1 - kEccentricity));
  return rig.add(
      {.particles = {{.position = {1 - kEccentricity, 0, 0}, .velocity = {real(0), real(speed), real(0)}}}});
}

/// Returns its position at a time: x = cos E - e, y = sqrt(1 - e^2) sin E, E - e sin E = t (Kepler).
DVec3 place_of_planet(double time) {
  double anomaly = time;
  for (int i = 0; i < 100; ++i) anomaly = time + kEccentricity * std::sin(anomaly);
  return {std::cos(anomaly) - kEccentricity, std::sqrt(1 - kEccentricity * kEccentricity) * std::sin(anomaly),
          0};
}

double planet_error(const CheckSetting& setting, double seconds) {
  Rig rig(setting, weightless());
  const ParticlesId id = add_planet(rig);
  rig.run(seconds);
  return length(rig.positions(id)[0] - place_of_planet(seconds));
}

/// Adds two masses on springs below a point that is shaken, with friction inside and out, in wind. Forces
/// depend on position, velocity and time, and none of them is linear.
void add_shaken_pendulum(Rig& rig) {
  const MotionDesc shake{.kind = MotionDesc::Kind::kSine,
                         .amplitude = {real(0.1), real(0.2), real(0)},
                         .frequency_hz = real(0.7)};
  must(rig.world().set_wind({.velocity = {real(2), real(0), real(1)}}));
  rig.add({.particles = {{.radius = real(0.2)},
                         {.position = {0.8, -0.6, 0}, .radius = real(0.2)},
                         {.position = {1.4, 0.2, 0.3}, .radius = real(0.2)}},
           .springs = {{.a = 0, .b = 1, .stiffness = real(30), .damping = real(0.4)},
                       {.a = 1, .b = 2, .stiffness = real(20), .damping = real(0.3)}},
           .air_friction = real(0.2),
           .drag_coefficient = real(1),
           .pins = {{.point = 0, .motion = shake}}});
}

CheckRow order_row(std::string title, int expected, double achieved) {
  return {.title = std::move(title),
          .expected = static_cast<double>(expected),
          .achieved = achieved,
          .tolerance = 0.1,
          .measure = CheckRow::Measure::kAbsolute,
          .solver = "particles"};
}

Rows laboratory_orders(const CheckSetting& setting) {
  const auto found = lab::find_stepper(setting.stepper);
  if (!found || found.value().adaptive) return {};  // "auto" has no order of its own.
  const lab::StepperInfo& info = found.value();
  // Low orders need smaller steps before only their leading error is visible.
  const lab::Options options = {.stepper = setting.stepper, .dt = info.order <= 2 ? 0.002 : 0.02};
  Rig orbit(setting, weightless());
  add_planet(orbit);
  Rig swing(setting);
  add_shaken_pendulum(swing);
  return {order_row("order on a planet's orbit", info.order,
                    must(lab::measure_order(orbit.world().in_its_frame(), options, 2, 3)).order),
          order_row("order on a damped pendulum on a shaken pivot", info.order,
                    must(lab::measure_order(swing.world().in_its_frame(), options, 1, 3)).order)};
}

CheckRow stiffness_row(const std::string& stepper, double springs) {
  const lab::Chain chain = {.springs = static_cast<int>(springs)};
  const double theory = must(lab::stable_stiffness_in_theory(stepper, chain));
  CheckRow row = {.title = "largest stable stiffness, 1 kg, 60 Hz, springs: " + std::to_string(chain.springs),
                  .unit = "N/m",
                  .expected = theory,
                  .achieved = must(lab::largest_stable_stiffness(stepper, chain)),
                  .tolerance = 0.02,
                  .solver = stepper};
  if (theory == 0) row.measure = CheckRow::Measure::kAbsolute;
  if (!std::isinf(theory)) return row;
  row.title += ": any";
  row.unit = "";
  row.expected = 1;
  row.achieved = std::isinf(row.achieved) ? 1 : 0;
  return row;
}

/// Returns the largest height that a mass on a spring released from the horizontal reaches in 10 s, at 60 Hz
/// [m].
double highest(const CheckSetting& setting, double stiffness) {
  Rig rig(setting);
  const ParticlesId id = rig.add({.particles = {{}, {.position = {1, 0, 0}}},
                                  .springs = {{.a = 0, .b = 1, .stiffness = real(stiffness)}},
                                  .pins = {{}}});
  double most = 0;
  rig.run(10, [&] { most = std::max(most, rig.positions(id)[1].y); });
  return most;
}

}  // namespace

/// The error of a method of order p falls by 2^p with half the step. This is tested on an orbit, with
/// Kepler's equation as reference for the solver and rk4 with a far smaller step for the laboratory, and on a
/// motion with every kind of force.
Rows orders(const CheckSetting& setting) {
  if (setting.laboratory()) return laboratory_orders(setting);
  const double seconds = 2;
  return {order_row("order on a planet's orbit", 1,
                    std::log2(planet_error(setting, seconds) / planet_error(finer(setting), seconds)))};
}

/// Tests the paper's question of stability. Its own stepper diverges for k > 2 m / h^2 = 7200 N/m, Euler and
/// its eq. 5 to 7 at any stiffness, Runge-Kutta 4 for k > 8 m / h^2. So rk4 allows 4 times the stiffness of
/// the paper's stepper at 4 times its evaluations, and not 40 times at 3 times the cost. The solver has no
/// limit.
Rows stability(const CheckSetting& setting) {
  if (setting.laboratory()) {
    const auto found = lab::find_stepper(setting.stepper);
    if (!found || found.value().adaptive) return {};
    return {stiffness_row(setting.stepper, 1), stiffness_row(setting.stepper, 8)};
  }
  Rows rows = {{.title = "1 kg, k = 1e4 N/m, from the horizontal: highest place in 10 s",
                .unit = "m",
                .expected = 0,
                .achieved = highest(setting, 1e4),
                .tolerance = 0.01,
                .measure = CheckRow::Measure::kAbsolute,
                .solver = "springs"}};
  for (const char* stepper : {"paper", "euler", "taylor2_paper", "rk4"})
    rows.push_back(stiffness_row(stepper, 1));
  for (auto row = rows.begin() + 1; row != rows.end(); ++row) {
    row->title += ", " + row->solver;
    row->substeps = 1;
  }
  rows.push_back({.title = "stiffness that rk4 bears / that the paper's stepper bears",
                  .expected = 4,
                  .achieved = rows[4].achieved / rows[1].achieved,
                  .tolerance = 0.02,
                  .solver = "rk4, paper",
                  .substeps = 1});
  return rows;
}

}  // namespace hooke::check
