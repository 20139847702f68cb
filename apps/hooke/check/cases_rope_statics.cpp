/// Ropes and springs at rest: extension, shape and tension.

#include "cases.h"
#include "rig.h"

#include <cmath>

namespace hooke::check {

namespace {

constexpr double kSettleTime = 15.0;      ///< [s]: over 50 decay times of the critically damped ropes below.
constexpr double kLongSettleTime = 90.0;  ///< [s]: of lightly damped springs.

/// Load hanging from a rope of `segments` segments.
struct HangingRope {
  int segments = 16;
  double stiffness = 200.0;  ///< Of the whole rope [N/m].
  double rope_mass = 0.2;    ///< [kg]
  double load = 1.0;         ///< [kg]
};

double extension_at_rest(const CheckSetting& setting, const HangingRope& rope) {
  Rig rig(setting);
  const RopeId id =
      rig.add({.direction = {real(0), real(-1), real(0)},
               .total_mass = real(rope.rope_mass),
               .masses = rope.segments + 1,
               .length_at_rest = real(1),
               .stiffness = real(rope.stiffness),
               .inner_friction = real(2.0 * std::sqrt(rope.stiffness * (rope.load + rope.rope_mass))),
               .loads = {{.point = static_cast<std::uint32_t>(rope.segments), .mass = real(rope.load)}},
               .drag_coefficient = real(0)});
  rig.run(kSettleTime);
  const PointView points = rig.world().positions(id);
  return -points[points.size() - 1].y - 1.0;
}

/// Two springs in a row, the joint as heavy as the load, or beside each other. Light damping: rows that share
/// a particle pass their forces on by h (c + h k) / m too little in one substep, and so they rest that much
/// lower.
double two_springs(const CheckSetting& setting, double first, double second, bool in_series) {
  Rig rig(setting);
  const auto spring = [](std::uint32_t a, std::uint32_t b, double k) {
    return SpringDesc{.a = a, .b = b, .stiffness = real(k), .damping = real(0.2)};
  };
  ParticlesDesc desc{.particles = {{}, {.position = {0, -1, 0}}}, .pins = {{}}};
  if (in_series) {
    desc.particles.push_back({.position = {0, -2, 0}});
    desc.springs = {spring(0, 1, first), spring(1, 2, second)};
  } else {
    desc.springs = {spring(0, 1, first), spring(0, 1, second)};
  }
  const ParticlesId id = rig.add(desc);
  rig.run(kLongSettleTime);
  const double rest = in_series ? 2.0 : 1.0;
  return -rig.world().positions(id)[desc.particles.size() - 1].y - rest;
}

}  // namespace

/// Springs in a row 1/K = 1/k1 + 1/k2, beside each other K = k1 + k2 (textbook). A rope of stiffness K and
/// mass m under a load M extends by M g / K + m g / (2 K), whatever the number n of its segments: the mean
/// tension of a hanging rope is (M + m/2) g, and half a segment's mass sits on each end node.
std::vector<CheckRow> series_and_parallel(const CheckSetting& setting) {
  const double k1 = 200;
  const double k2 = 300;
  std::vector<CheckRow> rows = {{.title = "two springs in a row: extension",
                                 .unit = "m",
                                 .expected = kGravity * (2.0 / k1 + 1.0 / k2),
                                 .achieved = two_springs(setting, k1, k2, true),
                                 .tolerance = 0.005,
                                 .solver = "springs"},
                                {.title = "two springs beside each other: extension",
                                 .unit = "m",
                                 .expected = kGravity / (k1 + k2),
                                 .achieved = two_springs(setting, k1, k2, false),
                                 .tolerance = 0.005,
                                 .solver = "springs"}};
  for (const int n : {4, 16, 64, 256}) {
    const HangingRope rope{.segments = n};
    rows.push_back({.title = "rope of " + std::to_string(n) + " segments: extension",
                    .unit = "m",
                    .expected = (rope.load + 0.5 * rope.rope_mass) * kGravity / rope.stiffness,
                    .achieved = extension_at_rest(setting, rope),
                    .tolerance = 0.0001,
                    .solver = "rope"});
  }
  return rows;
}

}  // namespace hooke::check
