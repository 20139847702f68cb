/// Tests ropes and springs at rest: extension, shape and tension.

#include "validation/cases.h"
#include "validation/rig.h"

#include <algorithm>
#include <cmath>

namespace hooke::check {

namespace {

constexpr double kSettleTime = 5.0;          ///< Time [s], over 20 decay times of the ropes below.
constexpr double kSpringsSettleTime = 20.0;  ///< Time [s], 20 decay times of two springs.

/// A load hangs from a rope of `segments` segments.
struct HangingRope {
  int segments = 16;
  double stiffness = 200.0;  ///< Stiffness of the whole rope [N/m].
  double rope_mass = 0.2;    ///< [kg]
  double load = 1.0;         ///< [kg]
};

/// The air brakes the motion, critically for the load. Friction inside the rope would make a finer rope
/// stiffer for the laboratory's methods.
double extension_at_rest(const CheckSetting& setting, const HangingRope& rope) {
  Rig rig(setting);
  const RopeId id = rig.add(
      RopeDesc{.direction = {real(0), real(-1), real(0)},
               .total_mass = real(rope.rope_mass),
               .masses = rope.segments + 1,
               .length_at_rest = real(1),
               .stiffness = real(rope.stiffness),
               .air_friction = real(6 * std::sqrt(rope.stiffness * (rope.load + rope.rope_mass / 3))),
               .loads = {{.point = static_cast<std::uint32_t>(rope.segments), .mass = real(rope.load)}},
               .drag_coefficient = real(0)});
  rig.run(kSettleTime);
  return -rig.positions(id).back().y - 1.0;
}

/// Two springs hang in a row, with a joint as heavy as the load, or beside each other, and the air brakes
/// them. Rows that share a particle pass their forces on by h (c + h k) / m too little in one substep, so
/// they rest that much lower.
double two_springs(const CheckSetting& setting, double first, double second, bool in_series) {
  Rig rig(setting);
  const auto spring = [](std::uint32_t a, std::uint32_t b, double k) {
    return SpringDesc{.a = a, .b = b, .stiffness = real(k)};
  };
  ParticlesDesc desc{.particles = {{}, {.position = {0, -1, 0}}}, .air_friction = real(2), .pins = {{}}};
  if (in_series) {
    desc.particles.push_back({.position = {0, -2, 0}});
    desc.springs = {spring(0, 1, first), spring(1, 2, second)};
  } else {
    desc.springs = {spring(0, 1, first), spring(0, 1, second)};
  }
  const ParticlesId id = rig.add(desc);
  rig.run(kSpringsSettleTime);
  const double rest = in_series ? 2.0 : 1.0;
  return -rig.positions(id).back().y - rest;
}

CheckRow extension_row(std::string title, double expected, double achieved, double tolerance) {
  return {.title = std::move(title),
          .unit = "m",
          .expected = expected,
          .achieved = achieved,
          .tolerance = tolerance,
          .solver = "rope"};
}

/// A rope of 1.5 m between two pins 1 m apart is laid as a V and left to come to rest.
struct Hanging {
  double sag = 0;          ///< Sag of the middle point [m].
  double end_tension = 0;  ///< Tension at the first pin [N].
};

Hanging hang_between_pins(const CheckSetting& setting, double mass, Real axial_stiffness) {
  const int edges = 100;
  const double drop = std::sqrt(0.75 * 0.75 - 0.25);
  RopeDesc desc{.total_mass = real(mass),
                .inner_friction = real(0.2),
                .air_friction = real(4 * mass),
                .axial_stiffness = axial_stiffness,
                .pins = {{.point = 0}, {.point = edges}},
                .drag_coefficient = real(0)};
  for (int i = 0; i <= edges; ++i) {
    const double s = static_cast<double>(i) / edges;
    desc.points.push_back({s, -drop * (1 - std::abs(2 * s - 1)), 0});
  }
  Rig rig(setting);
  const RopeId id = rig.add(desc);
  rig.run(10);
  const std::vector<DVec3> x = rig.positions(id);
  // The tension of the first segment holds all but the half segment that belongs to the pin.
  const double stretch = length(x[1]) / length(desc.points[1]) - 1;
  const double tension = setting.laboratory() ? static_cast<double>(axial_stiffness) * stretch
                                              : static_cast<double>(rig.world().tensions(id)[0]);
  const DVec3 pull = tension * normalize(x[1]) + DVec3{0, -0.5 * mass / edges * kGravity, 0};
  return {-x[edges / 2].y, length(pull)};
}

Rows hanging_rows(const Hanging& expected, const Hanging& achieved, double tolerance) {
  return {{.title = "sag, span 1 m, length 1.5 m",
           .unit = "m",
           .expected = expected.sag,
           .achieved = achieved.sag,
           .tolerance = tolerance,
           .solver = "rope"},
          {.title = "pull on the pin",
           .unit = "N",
           .expected = expected.end_tension,
           .achieved = achieved.end_tension,
           .tolerance = tolerance,
           .solver = "rope"}};
}

}  // namespace

/// The extension is M g / k + m g (n + 1) / (2 n k) for a spring of n equal parts with its mass m as n equal
/// lumps at their lower ends (statics): m g / (2 k) for many. A rope's own end node has half a lump; a load
/// gives the other half.
Rows hanging_weight(const CheckSetting& setting) {
  Rows rows;
  for (const int n : {1, 2, 8, 64}) {
    const double k = 200;
    const double m = 0.4;
    const double load = 1;
    const double expected = (load + 0.5 * m * (n + 1) / n) * kGravity / k;
    const double achieved = extension_at_rest(
        setting, {.segments = n, .stiffness = k, .rope_mass = m, .load = load + 0.5 * m / n});
    rows.push_back(extension_row("extension, lumps: " + std::to_string(n), expected, achieved, 0.0001));
    rows.back().goal = 1e-5;
  }
  return rows;
}

/// Springs in a row have 1/K = 1/k1 + 1/k2, beside each other K = k1 + k2 (textbook). A rope of stiffness K
/// and mass m under a load M extends by M g / K + m g / (2 K), whatever the number n of its segments: the
/// mean tension of a hanging rope is (M + m/2) g, and half a segment's mass is at each end node.
Rows series_and_parallel(const CheckSetting& setting) {
  const double k1 = 200;
  const double k2 = 300;
  Rows rows = {extension_row("two springs in a row: extension", kGravity * (2.0 / k1 + 1.0 / k2),
                             two_springs(setting, k1, k2, true), 0.005),
               extension_row("two springs beside each other: extension", kGravity / (k1 + k2),
                             two_springs(setting, k1, k2, false), 0.005)};
  for (CheckRow& row : rows) {
    row.goal = 1e-4;
    row.solver = "springs";
  }
  for (const int n : {4, 16, 64, 256}) {
    const HangingRope rope{.segments = n};
    const double expected = (rope.load + 0.5 * rope.rope_mass) * kGravity / rope.stiffness;
    rows.push_back(extension_row("rope of " + std::to_string(n) + " segments: extension", expected,
                                 extension_at_rest(setting, rope), 0.0001));
  }
  return rows;
}

/// The extension may not depend on n, and its mean is M g / K + m g / (2 K), here for a soft and heavy rope,
/// which stretches to nearly twice its length.
Rows resolution_of_rope(const CheckSetting& setting) {
  const HangingRope rope{.stiffness = 20, .rope_mass = 2, .load = 0.5};
  std::vector<double> extensions;
  for (const int n : {4, 16, 64, 256}) {
    HangingRope finer = rope;
    finer.segments = n;
    extensions.push_back(extension_at_rest(setting, finer));
  }
  const auto [least, most] = std::minmax_element(extensions.begin(), extensions.end());
  const double expected = (rope.load + 0.5 * rope.rope_mass) * kGravity / rope.stiffness;
  return {{.title = "spread of extension over 4, 16, 64, 256 segments",
           .expected = 0,
           .achieved = *most / *least - 1,
           .tolerance = 0.001,
           .measure = CheckRow::Measure::kAbsolute,
           .solver = "rope"},
          extension_row("largest extension", expected, *most, 0.001),
          extension_row("smallest extension", expected, *least, 0.001)};
}

/// y = a cosh(x / a): a sinh(l / (2 a)) = L / 2 gives a = 0.308236 m for span l = 1 m and length L = 1.5 m;
/// sag a (cosh(l / (2 a)) - 1), pull mu g (a + sag) (Bernoulli 1691).
Rows catenary(const CheckSetting& setting) {
  const double mass = 1.5;  // 1 kg/m
  return hanging_rows({0.502633, 0.81087 * kGravity}, hang_between_pins(setting, mass, stiff(setting, 5e4)),
                      0.001);
}

/// With W the weight, L the length without load, V = W / 2 and H the horizontal pull (Irvine 1981):
/// span = H L / EA + (2 H L / W) asinh(V / H),  sag = W L / (8 EA) + (H L / W) (sqrt(1 + (V / H)^2) - 1).
Rows elastic_catenary(const CheckSetting& setting) {
  const double mass = 1.5;
  const double length = 1.5;
  const double weight = mass * kGravity;
  const double stiffness = 3 * weight;  // EA [N]; the rope stretches by a tenth.
  const double v = 0.5 * weight;
  const auto span = [&](double h) {
    return h * length / stiffness + 2 * h * length / weight * std::asinh(v / h);
  };
  const double h = bisect(1e-3, 100, 80, [&](double pull) { return span(pull) < 1; });
  const double sag = weight * length / (8 * stiffness) + h * length / weight * (std::hypot(1.0, v / h) - 1);
  return hanging_rows({sag, std::hypot(h, v)}, hang_between_pins(setting, mass, real(stiffness)), 0.002);
}

/// A rigid rope does not stretch, whatever hangs on it: 1000 kg on a rope of 1 kg.
Rows heavy_load(const CheckSetting& setting) {
  Rig rig(setting);
  const RopeId id = rig.add(RopeDesc{.direction = {real(0), real(-1), real(0)},
                                     .masses = 51,
                                     .loads = {{.point = 50, .mass = real(1000)}},
                                     .drag_coefficient = real(0)});
  double worst = 0;
  rig.run(20, [&] { worst = std::max(worst, rig.world().measure().largest_stretch); });
  return {{.title = "largest stretch in 20 s, 1000 kg on 1 kg",
           .expected = 0,
           .achieved = worst,
           .tolerance = 0.001,
           .measure = CheckRow::Measure::kAbsolute,
           .solver = "rope"},
          {.title = "tension at the hook",
           .unit = "N",
           .expected = (1000 + 0.99) * kGravity,
           .achieved = static_cast<double>(rig.world().tensions(id)[0]),
           .tolerance = 0.001,
           .solver = "rope"}};
}

}  // namespace hooke::check
