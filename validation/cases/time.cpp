/// Tests that physics does not depend on the display's rate, nor the wind on the step.

#include "validation/cases.h"
#include "validation/rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace hooke::check {

namespace {

constexpr int kFlagColumns = 13;
constexpr int kFlagRows = 9;

/// Adds ropes, cloth and particles in gusts over a ground.
void fill(Rig& rig, const CheckSetting& setting) {
  rig.add(BodyDesc{.shape = Shape::half_space(), .position = {0, -1, 0}});
  rig.add(
      RopeDesc{.masses = 20, .stiffness = stiff(setting, 1e4), .loads = {{.point = 19, .mass = real(2)}}});
  rig.add(ClothDesc{.columns = 12, .rows = 8, .corner = {0.5, 0, 0}, .pins = {{.point = 0}, {.point = 84}}});
  rig.add(ParticlesDesc{.particles = {{.position = {0, 0, 1}}, {.position = {0.3, 0, 1}}},
                        .springs = {{.a = 0, .b = 1}},
                        .drag_coefficient = real(0.5)});
}

/// A Display gives the seconds from one picture to the next.
using Display = double (*)(int picture);

double at_24_hz(int /*picture*/) {
  return 1.0 / 24;
}
double at_30_hz(int /*picture*/) {
  return 1.0 / 30;
}
double at_144_hz(int /*picture*/) {
  return 1.0 / 144;
}
double uneven(int picture) {
  return 0.001 * (1 + (picture * 7919) % 53);
}

/// Returns a hash of the state after at least 300 fixed steps and 0.6 s. Steps are made as the display's time
/// allows, and the state is read at every picture.
std::uint64_t state_after(const CheckSetting& setting, Display display) {
  WorldDesc desc;
  desc.wind = {.velocity = {real(5), real(0), real(1)}, .gust = real(0.5)};
  Rig rig(setting, desc);
  fill(rig, setting);
  const int all = std::max(300, static_cast<int>(0.6 / setting.dt));
  double owed = 0;
  int steps = 0;
  for (int picture = 0; steps < all; ++picture) {
    for (owed += display(picture); owed >= setting.dt && steps < all; owed -= setting.dt) {
      rig.step();
      ++steps;
    }
    // What a viewer does at every picture must not change the state.
    if (!std::isfinite(rig.energy().total())) return 0;
    const Snapshot kept = rig.world().snapshot();
    if (picture % 10 == 0) must(rig.world().restore(kept));
  }
  return rig.state_hash();
}

WorldDesc windy() {
  WorldDesc desc;
  desc.wind = {.velocity = {real(6), real(0), real(0)},
               .gust = real(0.8),
               .side_gust = real(0.6),
               .correlation_time = real(0.5)};
  return desc;
}

double root_mean_square(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v * v;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// Returns the root mean square speed, relative to the mean wind, of light particles that are far apart and
/// carried by it [m/s].
double particle_response(const CheckSetting& setting) {
  const int side = 12;
  WorldDesc desc = windy();
  desc.gravity = {};
  Rig rig(setting, desc);
  ParticlesDesc cloud{.drag_coefficient = real(0.5)};
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      cloud.particles.push_back(
          {.position = {0, 8.0 * row, 8.0 * column}, .mass = real(0.002), .radius = real(0.05)});
    }
  }
  const ParticlesId id = rig.add(cloud);
  std::vector<double> speeds;
  rig.run(20, [&] {
    const std::vector<DVec3> v = rig.world().velocities(id);
    for (std::size_t i = 0; i < v.size() && rig.time() > 2; ++i) {
      speeds.push_back(length(v[i] - DVec3{6, 0, 0}));
    }
  });
  return root_mean_square(speeds);
}

/// Returns the root mean square distance of a flag's free corner from its mean position [m].
double flag_response(const CheckSetting& setting) {
  Rig rig(setting, windy());
  ClothDesc desc{.columns = kFlagColumns,
                 .rows = kFlagRows,
                 .width = real(0.9),
                 .height = real(0.6),
                 .areal_density = real(0.1),
                 .damping = real(0.02),
                 .bend_damping = real(0.02)};
  for (std::uint32_t row = 0; row < kFlagRows; ++row) desc.pins.push_back({.point = row * kFlagColumns});
  const ClothId id = rig.add(desc);
  std::vector<DVec3> places;
  rig.run(60, [&] {
    if (rig.time() > 4) places.push_back(rig.world().positions(id)[kFlagColumns * kFlagRows - 1]);
  });
  DVec3 mean = {};
  for (const DVec3 x : places) mean += (1.0 / static_cast<double>(places.size())) * x;
  std::vector<double> distances;
  distances.reserve(places.size());
  for (const DVec3 x : places) distances.push_back(length(x - mean));
  return root_mean_square(distances);
}

void add_rates(const CheckSetting& setting, const std::string& title, const std::string& unit,
               double (*response)(const CheckSetting&), Rows& rows) {
  CheckSetting finest = setting;
  finest.dt = setting.dt / 4;
  const double expected = response(finest);
  for (const double slower : {8.0, 4.0, 2.0}) {
    CheckSetting coarser = setting;
    coarser.dt = finest.dt * slower;
    rows.push_back(
        {.title = title + ", " + std::to_string(std::lround(1 / coarser.dt)) + " Hz against 240 Hz",
         .unit = unit,
         .expected = expected,
         .achieved = response(coarser),
         .tolerance = 0.05,
         .solver = "wind",
         .dt = coarser.dt});
  }
}

}  // namespace

/// A display of any rate, even or uneven, takes the same fixed steps, so the bits are the same.
Rows display_rate(const CheckSetting& setting) {
  const std::uint64_t expected = state_after(setting, [](int) { return 1.0 / 60; });
  const std::array<Display, 4> displays = {at_24_hz, at_30_hz, at_144_hz, uneven};
  const std::array<const char*, 4> names = {"24 Hz", "30 Hz", "144 Hz", "1 to 53 ms"};
  Rows rows;
  for (std::size_t i = 0; i < displays.size(); ++i) {
    rows.push_back({.title = std::string("bits that differ from a display of 60 Hz: ") + names[i],
                    .expected = 0,
                    .achieved = expected != 0 && state_after(setting, displays[i]) == expected ? 0.0 : 1.0,
                    .tolerance = 0,
                    .measure = CheckRow::Measure::kAbsolute,
                    .solver = "all"});
  }
  return rows;
}

/// A machine needs `cost` for a step [s], for a while ten times as much, and shows 60 pictures a second when
/// it can. Clock (hooke/clock.h) asks for at most 4 steps between two pictures. So in the overload the
/// machine makes 1 / cost steps per second, and right after it 60 again. The steps are those of a machine
/// without load, only fewer.
Rows overload(const CheckSetting& setting) {
  constexpr double kPicture = 1.0 / 60;
  constexpr double kCost = 0.004;
  Rig rig(setting);
  fill(rig, setting);
  Clock clock = must(Clock::create({.step_seconds = kPicture}));
  double now = 0;
  int most = 0;
  int made = 0;
  // Runs until `end` at this cost and returns steps per second.
  const auto live = [&](double end, double cost) {
    const double start = now;
    const int before = made;
    double passed = kPicture;
    for (; now < end; now += passed) {
      const int due = clock.advance(passed).steps;
      for (int i = 0; i < due; ++i) rig.run(kPicture);
      most = std::max(most, due);
      made += due;
      passed = std::max(kPicture, due * cost);
    }
    return (made - before) / (now - start);
  };
  live(1, kCost);
  const double slow = live(3, 10 * kCost);
  live(3.2, kCost);  // The last slow picture's time is still to be simulated.
  const double again = live(5.2, kCost);
  Rig calm(setting);
  fill(calm, setting);
  for (int i = 0; i < made; ++i) calm.run(kPicture);
  const auto row = [](const char* title, const char* unit, double expected, double achieved,
                      double tolerance) {
    return CheckRow{.title = title,
                    .unit = unit,
                    .expected = expected,
                    .achieved = achieved,
                    .tolerance = tolerance,
                    .measure = CheckRow::Measure::kAbsolute,
                    .solver = "clock"};
  };
  return {row("most steps between two pictures beyond 4", "", 0, std::max(0, most - 4), 0),
          row("steps per second while a step takes 40 ms", "1/s", 0.1 / kCost, slow, 1),
          row("steps per second right after", "1/s", 60, again, 1),
          row("bits that differ from a machine without load", "", 0,
              rig.healthy() && rig.state_hash() == calm.state_hash() ? 0 : 1, 0)};
}

/// The wind is a function of time and place, so its effect has the same size at 30, 60, 120 and 240 Hz.
Rows gusts(const CheckSetting& setting) {
  Rows rows;
  add_rates(setting, "particle: rms speed about the mean", "m/s", particle_response, rows);
  add_rates(setting, "flag: rms distance of the free corner", "m", flag_response, rows);
  return rows;
}

namespace {

/// Makes balls in a line that is not quite straight; the first runs into the others.
std::vector<BodyDesc> balls_that_collide() {
  std::vector<BodyDesc> balls;
  for (int i = 0; i < 4; ++i) {
    BodyDesc desc = moving(Shape::sphere(real(0.1)), {0.5 * i, 0.05 * i, 0});
    desc.mass = real(1 + i);
    desc.velocity = real(DVec3{i == 0 ? 2.0 : -0.1 * i, 0, 0});
    desc.contact = {.friction = real(0), .restitution = real(1)};
    balls.push_back(desc);
  }
  return balls;
}

/// Makes a rectangle of springs with one diagonal, whose corners start with different speeds.
ParticlesDesc braced_rectangle() {
  ParticlesDesc lattice;
  for (int i = 0; i < 4; ++i) {
    const int column = i / 2;
    const int row = i % 2;
    lattice.particles.push_back(
        {.position = {column * 1.2, row * 1.0, 5}, .velocity = {real(0.1 * i), real(0), real(0)}});
  }
  lattice.springs = {
      {0, 1, real(50)}, {1, 3, real(50)}, {3, 2, real(50)}, {2, 0, real(50)}, {0, 3, real(20)}};
  return lattice;
}

void turn_around(Rig& rig, const std::vector<BodyId>& balls, ParticlesId springs) {
  for (const BodyId ball : balls) {
    must(rig.world().set_velocity(ball, real(-rig.velocity(ball))));
    must(rig.world().set_angular_velocity(ball, real(-rig.spin(ball))));
  }
  const std::vector<DVec3> v = rig.velocities(springs);
  for (std::uint32_t i = 0; i < v.size(); ++i) must(rig.world().set_velocity(point(springs, i), real(-v[i])));
}

}  // namespace

/// Elastic impacts without friction and springs without damping run backward as they ran forward. With every
/// velocity reversed, all is where it began after the same time (Loschmidt 1876).
Rows there_and_back(const CheckSetting& setting) {
  WorldDesc space = without_air();
  space.gravity = {};
  Rig rig(setting, space);
  const std::vector<BodyDesc> descs = balls_that_collide();
  std::vector<BodyId> balls;
  balls.reserve(descs.size());
  for (const BodyDesc& desc : descs) balls.push_back(rig.add(desc));
  const ParticlesDesc lattice = braced_rectangle();
  const ParticlesId springs = rig.add(lattice);
  const double seconds = 2;
  rig.run(seconds);
  turn_around(rig, balls, springs);
  rig.run(seconds);
  double bodies_off = 0;
  for (std::size_t i = 0; i < balls.size(); ++i)
    bodies_off = std::max(bodies_off, length(rig.center(balls[i]) - descs[i].position));
  double points_off = 0;
  const std::vector<DVec3> x = rig.positions(springs);
  for (std::size_t i = 0; i < x.size(); ++i)
    points_off = std::max(points_off, length(x[i] - lattice.particles[i].position));
  Rows rows = {
      absolute_row("balls that hit each other, 2 s there and back: way off", "m", 0, bodies_off, 1e-4),
      absolute_row("lattice of springs, 2 s there and back: way off", "m", 0, points_off, 1e-3)};
  rows[0].solver = "bodies";
  rows[1].solver = "springs";
  return rows;
}

}  // namespace hooke::check
