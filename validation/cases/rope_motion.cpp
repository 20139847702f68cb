/// Tests ropes in motion: waves, heavy loads, shocks, any stiffness.

#include "validation/cases.h"
#include "validation/rig.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace hooke::check {

namespace {

CheckRow limit_row(std::string title, double achieved, double limit) {
  return {.title = std::move(title),
          .expected = 0,
          .achieved = achieved,
          .tolerance = limit,
          .measure = CheckRow::Measure::kAbsolute,
          .solver = "rope"};
}

/// This is an elastic string of length 1 m pulled to 1.5 m between two pins.
struct String {
  static constexpr int kSegments = 64;
  static constexpr double kStiffness = 50;   ///< EA [N]
  static constexpr double kStretched = 1.5;  ///< [m]

  double transverse = 0;    ///< Amplitude of the first mode across [m].
  double longitudinal = 0;  ///< Amplitude of the first mode along [m].
};

/// Returns the period of the string's first mode.
double string_period(const CheckSetting& setting, const String& string) {
  Rig rig(setting, weightless());
  PlacedWorld& world = rig.world();
  const RopeId id = rig.add(RopeDesc{.direction = {real(1), real(0), real(0)},
                                     .total_mass = real(1),
                                     .masses = String::kSegments + 1,
                                     .length_at_rest = real(1),
                                     .axial_stiffness = real(String::kStiffness),
                                     .pins = {{.point = 0}, {.point = String::kSegments}},
                                     .drag_coefficient = real(0)});
  const auto place = [](int i) { return String::kStretched * i / String::kSegments; };
  const auto shape = [](int i) { return std::sin(0.5 * kTau * i / String::kSegments); };
  for (int i = 0; i <= String::kSegments; ++i) {
    const DVec3 x = {place(i) + string.longitudinal * shape(i), string.transverse * shape(i), 0};
    must(world.set_position(point(id, static_cast<std::uint32_t>(i)), x));
  }
  const bool across = string.transverse > 0;
  const Curve curve = record(rig, 4, [&] {
    double sum = 0;
    const std::vector<DVec3> x = rig.positions(id);
    for (int i = 1; i < String::kSegments; ++i) {
      const DVec3 moved = x[static_cast<std::size_t>(i)] - DVec3{place(i), 0, 0};
      sum += shape(i) * (across ? moved.y : moved.x);
    }
    return sum;
  });
  return curve.period();
}

/// This is the result of a swing, as shares of its energy.
struct Swing {
  double largest_gain = 0;
  double final_change = 0;
  double largest_stretch = 0;
  bool healthy = true;
};

enum class Count { kAll, kNotElastic };

/// The energy of springs is left out where it is read off a rounded and linearized length, which k = 1e9 N/m
/// makes large. It is never negative and zero at the start, so what is left may not grow either.
double energy_of(const PlacedWorld& world, Count count) {
  const Energy now = world.measure().energy;
  return count == Count::kAll ? now.total() : now.kinetic + now.potential;
}

Swing watch(Rig& rig, double seconds, double swing_energy, Count count = Count::kAll) {
  Swing swing;
  const double start = energy_of(rig.world(), count);
  swing.healthy = rig.run(seconds, [&] {
    const double change = (energy_of(rig.world(), count) - start) / swing_energy;
    swing.final_change = change;
    // std::max alone would drop a value that is not a number.
    swing.largest_gain = std::isfinite(change) ? std::max(swing.largest_gain, change) : change;
    swing.largest_stretch = std::max(swing.largest_stretch, rig.world().measure().largest_stretch);
  });
  if (!swing.healthy) swing.largest_gain = std::numeric_limits<double>::quiet_NaN();
  return swing;
}

/// A rope of 1 m and 0.1 kg with 1 kg at its end is released from the horizontal.
Swing swing_rope(const CheckSetting& setting, double stiffness) {
  Rig rig(setting);
  rig.add(RopeDesc{.direction = {real(1), real(0), real(0)},
                   .total_mass = real(0.1),
                   .masses = 17,
                   .length_at_rest = real(1),
                   .stiffness = real(stiffness),
                   .loads = {{.point = 16, .mass = real(1)}},
                   .drag_coefficient = real(0)});
  return watch(rig, 30, 1.05 * kGravity);
}

/// Swings loose particles, each pair joined by a spring as stiff as the rope.
Swing swing_springs(const CheckSetting& setting, std::uint32_t segments, double stiffness) {
  ParticlesDesc desc{.pins = {{}}};
  for (std::uint32_t i = 0; i <= segments; ++i) {
    const double mass = i == segments ? 1.0 : 0.1 / segments;
    desc.particles.push_back({.position = {static_cast<double>(i) / segments, 0, 0}, .mass = real(mass)});
    if (i > 0) desc.springs.push_back({.a = i - 1, .b = i, .stiffness = real(stiffness)});
  }
  Rig rig(setting);
  rig.add(desc);
  return watch(rig, 30, 1.05 * kGravity, Count::kNotElastic);
}

}  // namespace

/// These are first modes of a string between two pins (textbook). Across, f = sqrt(T / mu) / (2 l), T the
/// tension, mu the mass per length as stretched, l the length as stretched. Along, f = sqrt(EA / mu0) / (2
/// l0) by the length and mass per length without load. Here T = EA (1.5 - 1) = 25 N.
Rows wave_speeds(const CheckSetting& setting) {
  const double stretched = String::kStretched;
  const double tension = String::kStiffness * (stretched - 1);
  const double across = std::sqrt(tension * stretched);  // mu = 1 kg / 1.5 m
  const double along = std::sqrt(String::kStiffness);
  return {{.title = "speed of transverse waves, stretched string",
           .unit = "m/s",
           .expected = across,
           .achieved = 2 * stretched / string_period(setting, {.transverse = 0.002}),
           .tolerance = 0.01,
           .solver = "rope"},
          {.title = "speed of longitudinal waves, unstretched length",
           .unit = "m/s",
           .expected = along,
           .achieved = 2 / string_period(setting, {.longitudinal = 0.005}),
           .tolerance = 0.01,
           .solver = "rope"}};
}

/// A swing keeps its energy and a rigid rope its length: 1000 kg on 10 m of rope of 1 kg, released at 30 deg.
Rows crane(const CheckSetting& setting) {
  const double angle = kTau / 12;
  Rig rig(setting);
  rig.add(RopeDesc{.direction = {real(std::sin(angle)), real(-std::cos(angle)), real(0)},
                   .masses = 51,
                   .length_at_rest = real(10),
                   .loads = {{.point = 50, .mass = real(1000)}},
                   .drag_coefficient = real(0)});
  const Swing swing = watch(rig, 20, 1000.5 * kGravity * 10 * (1 - std::cos(angle)));
  return {
      limit_row("largest stretch in 20 s", swing.largest_stretch, 1e-4),
      limit_row("largest gain of energy / energy of the swing", swing.largest_gain, 0.001),
      limit_row("loss of energy in 20 s / energy of the swing", std::max(0.0, -swing.final_change), 0.005)};
}

/// A rope of 1 m and 0.05 kg folded in half drops 500 kg into its length: the rope stays finite and comes to
/// rest at its length.
Rows folded_rope(const CheckSetting& setting) {
  const int edges = 50;
  RopeDesc desc{
      .total_mass = real(0.05), .loads = {{.point = edges, .mass = real(500)}}, .drag_coefficient = real(0)};
  for (int i = 0; i <= edges; ++i) {
    const bool back = i > edges / 2;
    desc.points.push_back({0.02 * (back ? edges - i : i), back ? -0.001 : 0.0, 0});
  }
  Rig rig(setting);
  const RopeId id = rig.add(desc);
  const double start = rig.world().measure().energy.total();
  const Swing swing = watch(rig, 20, 500 * kGravity);
  const std::vector<DVec3> x = rig.world().positions(id);
  bool finite = swing.healthy && std::isfinite(start);
  for (std::size_t i = 0; i < x.size(); ++i) finite = finite && is_finite(x[i]);
  return {limit_row("particles reset or not finite", finite ? 0 : 1, 0),
          limit_row("stretch after 20 s, 10000 : 1", rig.world().measure().largest_stretch, 0.01),
          limit_row("largest gain of energy / m g L", swing.largest_gain, 0.001)};
}

/// Nothing diverges at any stiffness. After a release from the horizontal, kinetic and potential energy never
/// exceed the start by 0.1 % of the swing, in 30 s. The paper's explicit steps diverge at 60 Hz for k > 7200
/// N/m and 1 kg.
Rows any_stiffness(const CheckSetting& setting) {
  Rows rows;
  const auto add = [&](const std::string& title, double stiffness, const Swing& swing, const char* solver) {
    char name[32];
    std::snprintf(name, sizeof name, ", k = %.0e N/m", stiffness);
    rows.push_back(limit_row(title + name + ": largest gain / swing", swing.largest_gain, 0.001));
    rows.back().solver = solver;
  };
  for (const double k : {1e4, 1e5, 1e6, 1e7, 1e8, 1e9}) {
    add("rope of 16 segments", k, swing_rope(setting, k), "rope");
    add("one spring", k, swing_springs(setting, 1, k), "springs");
    add("16 springs in a row", k, swing_springs(setting, 16, k), "springs");
  }
  return rows;
}

}  // namespace hooke::check
