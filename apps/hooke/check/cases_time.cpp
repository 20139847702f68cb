/// The same physics whatever the display does, and the same wind whatever the step.

#include "cases.h"
#include "rig.h"

#include <array>
#include <cmath>
#include <cstdint>

namespace hooke::check {

namespace {

constexpr int kFlagColumns = 13;
constexpr int kFlagRows = 9;
constexpr int kSteps = 300;  ///< Fixed steps of each run.

/// Ropes, cloth and particles in gusts over a ground.
void fill(Rig& rig) {
  rig.add(BodyDesc{.shape = Shape::half_space(), .position = {0, -1, 0}});
  rig.add(RopeDesc{.masses = 20, .loads = {{.point = 19, .mass = real(2)}}});
  rig.add(ClothDesc{.columns = 12, .rows = 8, .corner = {0.5, 0, 0}, .pins = {{.point = 0}, {.point = 84}}});
  rig.add(ParticlesDesc{.particles = {{.position = {0, 0, 1}}, {.position = {0.3, 0, 1}}},
                        .springs = {{.a = 0, .b = 1}},
                        .drag_coefficient = real(0.5)});
}

/// Seconds from one picture to the next.
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

/// State after kSteps fixed steps, taken as the time of the display allows and read at every picture.
std::uint64_t state_after(const CheckSetting& setting, Display display) {
  WorldDesc desc;
  desc.wind = {.velocity = {real(5), real(0), real(1)}, .gust = real(0.5)};
  Rig rig(setting, desc);
  fill(rig);
  double owed = 0;
  int steps = 0;
  for (int picture = 0; steps < kSteps; ++picture) {
    for (owed += display(picture); owed >= setting.dt && steps < kSteps; owed -= setting.dt) {
      rig.step();
      ++steps;
    }
    // What a viewer does at every picture must not touch the state.
    if (!std::isfinite(rig.world().measure().energy.total())) return 0;
    const Snapshot kept = rig.world().snapshot();
    if (picture % 10 == 0) must(rig.world().restore(kept));
  }
  return rig.world().state_hash();
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

/// Root mean square speed about the mean wind of light particles, far apart and carried by it [m/s].
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
    const PointView v = rig.world().velocities(id);
    for (std::size_t i = 0; i < v.size() && rig.time() > 2; ++i) {
      speeds.push_back(length(v[i] - DVec3{6, 0, 0}));
    }
  });
  return root_mean_square(speeds);
}

/// Root mean square distance of a flag's free corner from its mean place [m].
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

/// The wind is a function of time and place, so what it does has the same size at 30, 60, 120 and 240 Hz.
Rows gusts(const CheckSetting& setting) {
  Rows rows;
  add_rates(setting, "particle: rms speed about the mean", "m/s", particle_response, rows);
  add_rates(setting, "flag: rms distance of the free corner", "m", flag_response, rows);
  return rows;
}

}  // namespace hooke::check
