/// Tests one particle in gravity, in air and in fields.

#include "validation/cases.h"
#include "validation/rig.h"

#include <algorithm>
#include <cmath>

namespace hooke::check {

namespace {

constexpr const char* kParticleSolver = "particles";

double fallen(const CheckSetting& setting, double seconds) {
  Rig rig(setting);
  const ParticlesId id = rig.add({.particles = {ParticleDesc{}}});
  rig.run(seconds);
  return -rig.positions(id)[0].y;
}

/// Returns the downward speed of one particle after `seconds`.
double speed_of_fall(const CheckSetting& setting, const ParticlesDesc& desc, double seconds) {
  Rig rig(setting);
  const ParticlesId id = rig.add(desc);
  rig.run(seconds);
  return -rig.velocities(id)[0].y;
}

/// Returns the mean energy over the frames of this time [J].
double mean_energy(Rig& rig, double seconds) {
  double sum = 0;
  int frames = 0;
  rig.run(seconds, [&] {
    sum += rig.energy().total();
    ++frames;
  });
  return sum / frames;
}

CheckRow speed_row(const char* title, double expected, double achieved, double goal) {
  return {.title = title,
          .unit = "m/s",
          .expected = expected,
          .achieved = achieved,
          .tolerance = 0.005,
          .goal = goal,
          .solver = kParticleSolver};
}

}  // namespace

/// y = g t^2 / 2 (textbook). Semi-implicit Euler falls g t h / 2 more, h the substep: first order. Methods of
/// higher order are exact, up to the rounding of g, so that no order can be measured.
Rows free_fall(const CheckSetting& setting) {
  const double t = 1.0;
  const double exact = 0.5 * kGravity * t * t;
  const double coarse = fallen(setting, t);
  const double fine = fallen(finer(setting), t);
  Rows rows = {{.title = "distance fallen in 1 s",
                .unit = "m",
                .expected = exact,
                .achieved = coarse,
                .tolerance = 0.005,
                .goal = 1e-4,
                .solver = kParticleSolver}};
  if (!setting.laboratory()) {
    rows.push_back({.title = "excess over the exact distance",
                    .unit = "m",
                    .expected = 0.5 * kGravity * t * setting.dt / setting.substeps,
                    .achieved = coarse - exact,
                    .tolerance = 0.005,
                    .solver = kParticleSolver});
  }
  if (std::abs(coarse - exact) < 1e-5 * exact) return rows;
  rows.push_back({.title = "order of convergence",
                  .expected = 1.0,
                  .achieved = std::log2((coarse - exact) / (fine - exact)),
                  .tolerance = 0.05,
                  .measure = CheckRow::Measure::kAbsolute,
                  .solver = kParticleSolver});
  return rows;
}

/// F = -c v: v = (m g / c) (1 - e^(-c t / m)) (textbook).
Rows linear_drag(const CheckSetting& setting) {
  const double m = 1.0;
  const double c = 0.5;
  const ParticlesDesc desc{.particles = {{.mass = real(m)}}, .air_friction = real(c)};
  const auto speed = [&](double t) { return m * kGravity / c * (1 - std::exp(-c * t / m)); };
  return {speed_row("speed after 1 s", speed(1), speed_of_fall(setting, desc, 1), 1e-4),
          speed_row("speed after 4 s", speed(4), speed_of_fall(setting, desc, 4), 1e-4),
          speed_row("terminal speed", m * kGravity / c, speed_of_fall(setting, desc, 30), 1e-4)};
}

/// F = rho Cd A v^2 / 2: v = v_t tanh(g t / v_t), v_t = sqrt(2 m g / (rho Cd A)) (textbook).
Rows quadratic_drag(const CheckSetting& setting) {
  const double m = 0.05;
  const double radius = 0.1;
  const double drag = 0.47;
  const double density = 1.225;
  const ParticlesDesc desc{.particles = {{.mass = real(m), .radius = real(radius)}},
                           .drag_coefficient = real(drag)};
  const double terminal = std::sqrt(2 * m * kGravity / (density * drag * 0.5 * kTau * radius * radius));
  const auto speed = [&](double t) { return terminal * std::tanh(kGravity * t / terminal); };
  Rows rows = {speed_row("speed after 0.5 s", speed(0.5), speed_of_fall(setting, desc, 0.5), 1e-3),
               speed_row("speed after 1 s", speed(1), speed_of_fall(setting, desc, 1), 1e-3),
               speed_row("terminal speed", terminal, speed_of_fall(setting, desc, 30), 1e-3)};
  if (setting.laboratory()) return rows;
  Rig rig(setting, sleepless());
  BodyDesc ball = moving(Shape::sphere(real(radius)), {});
  ball.mass = real(m);
  ball.drag_coefficient = real(drag);
  const BodyId id = rig.add(ball);
  rig.run(1);
  rows.push_back({.title = "speed of a body after 1 s",
                  .unit = "m/s",
                  .expected = speed(1),
                  .achieved = -rig.velocity(id).y,
                  .tolerance = 1e-3,
                  .solver = "body forces"});
  return rows;
}

/// T^2 = 4 pi^2 a^3 / (G M) (Kepler); v^2 = G M (2/r - 1/a); the Laplace-Runge-Lenz vector v x L / (G M) -
/// r/|r| keeps its direction. Here e = 0.6, a = 1 m, T = 20 s, from the pericenter; 100 orbits, 1000 in the
/// laboratory. Within an orbit the energy of a symplectic method goes up and down with the step, so means
/// over an orbit are compared.
Rows kepler_orbit(const CheckSetting& setting) {
  const double period = 20;
  const double strength = kTau * kTau / (period * period);
  const double eccentricity = 0.6;
  const double near = 1 - eccentricity;
  const double speed = std::sqrt(strength * (2 / near - 1));

  Rig rig(setting, weightless());
  must(rig.world().add_field({.kind = FieldDesc::Kind::kInverseSquare, .strength = strength}));
  const ParticlesId id =
      rig.add({.particles = {{.position = {near, 0, 0}, .velocity = {real(0), real(speed), real(0)}}}});
  const double orbits = setting.laboratory() ? 1000 : 100;
  const std::string many = std::to_string(static_cast<int>(orbits)) + " orbits";
  const double exact = -0.5 * strength;
  const double first = mean_energy(rig, period);

  // y grows through zero at the pericenter, once an orbit.
  const Curve height = record(rig, 10.25 * period, [&] { return rig.positions(id)[0].y; });
  rig.run((orbits - 12.25) * period);
  const double last = mean_energy(rig, period);
  const DVec3 x = rig.positions(id)[0];
  const DVec3 v = rig.velocities(id)[0];
  const DVec3 runge = (1 / strength) * cross(v, cross(x, v)) - normalize(x);
  return {{.title = "period over 10 orbits, e = 0.6",
           .unit = "s",
           .expected = period,
           .achieved = height.period(),
           .tolerance = 0.001,
           .solver = kParticleSolver},
          {.title = "change of energy in " + many + ", share of it",
           .expected = 0,
           .achieved = (last - first) / std::abs(exact),
           .tolerance = 0.001,
           .goal = 1e-6,
           .measure = CheckRow::Measure::kAbsolute,
           .solver = kParticleSolver},
          {.title = "turn of the axis in " + many,
           .unit = "rad",
           .expected = 0,
           .achieved = std::atan2(runge.y, runge.x),
           .tolerance = 0.005 * kTau,
           .measure = CheckRow::Measure::kAbsolute,
           .solver = kParticleSolver}};
}

/// The rate is w = q B / m, and the speed stays (textbook).
Rows charge_in_magnetic_field(const CheckSetting& setting) {
  const double charge = 2;
  const double field = 1.5;
  const double mass = 3;
  Rig rig(setting, weightless());
  must(
      rig.world().add_field({.kind = FieldDesc::Kind::kMagnetic, .vector = {real(0), real(field), real(0)}}));
  const ParticlesId id = rig.add(
      {.particles = {{.velocity = {real(1), real(0), real(0)}, .mass = real(mass), .charge = real(charge)}}});
  const Curve side = record(rig, 60, [&] { return rig.velocities(id)[0].x; });
  return {{.title = "period",
           .unit = "s",
           .expected = kTau * mass / (charge * field),
           .achieved = side.period(),
           .tolerance = 1e-4,
           .goal = 1e-6,
           .solver = kParticleSolver},
          {.title = "speed after 60 s",
           .unit = "m/s",
           .expected = 1,
           .achieved = length(rig.velocities(id)[0]),
           .tolerance = 1e-4,
           .goal = 1e-6,
           .solver = kParticleSolver}};
}

}  // namespace hooke::check
