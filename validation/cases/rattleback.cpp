/// Tests a body that reverses its spin when it is spun in one of the two directions.

#include "validation/cases.h"
#include "validation/rig.h"

#include <algorithm>
#include <cmath>

namespace hooke::check {

namespace {

constexpr double kTime = 24;  // Time of the run [s]; the body reverses its spin after 17.

/// The round side of a lying cylinder of 0.5 m rests on top of a fixed ball of 1 m. The relative curvatures
/// are 1 / m along it and 3 / m across, in one contact. Four balls 0.15 m above it carry the mass, with the
/// principal axes rotated by `skew` [rad] from those of the curvature.
struct Stone {
  Rig rig;
  BodyId body;
  double start = 0;  ///< Energy at the start [J].

  Stone(const CheckSetting& setting, double skew, double spin) : rig(setting, without_air()) {
    const double round = 0.5;
    BodyDesc dome = level_ground(1);
    dome.shape = Shape::sphere(real(1));
    dome.position = {0, -1, 0};
    rig.add(dome);
    BodyDesc desc = moving(Shape::compound(), {0, round, 0});
    PartDesc bottom = {.shape = Shape::capsule(real(round), real(1)), .density = real(0.01)};
    bottom.rotation = quaternion_about(Vec3{Real(0), Real(0), Real(1)}, real(kTau / 4));
    bottom.contact.friction = real(1);
    desc.parts = {bottom};
    for (int i = 0; i < 4; ++i) {
      const double angle = skew + kTau / 4 * i;
      desc.parts.push_back(
          {.shape = Shape::sphere(real(0.05)),
           .position = real(DVec3{0.4 * std::cos(angle), 0.15 - round, 0.4 * std::sin(angle)}),
           .density = real(i % 2 == 0 ? 1900 : 570)});
    }
    const double rock = 0.02;
    desc.angular_velocity = real(DVec3{rock, spin, rock});
    desc.velocity = real(DVec3{-rock * 0.15, 0, rock * 0.15});
    body = rig.add(desc);
    start = rig.energy().total();
  }
};

CheckRow sign_row(const CheckSetting& setting, const char* title, double skew, double spin, double expected) {
  Stone stone(setting, skew, spin);
  stone.rig.run(kTime);
  const double found = stone.rig.spin(stone.body).y;
  return absolute_row(title, "", expected, std::abs(found) < 0.5 ? 0 : std::copysign(1, found), 0);
}

}  // namespace

/// The principal axes of inertia are not those of the curvature. Then spin in one direction feeds rocking,
/// which reverses the spin; in the other direction the rocking is damped, and the spin goes on (Garcia and
/// Hubbard, Proc. R. Soc. Lond. A 418, 1988: the sign of the coupling is that of the skew). Hooke has no
/// ellipsoids, so the ground has the curvature that a cylinder lacks along its axis; only the relative
/// curvature matters for rocking.
Rows rattleback(const CheckSetting& setting) {
  const double skew = 0.3;
  Rows rows = {sign_row(setting, "sign of the spin after 24 s, 2 rad/s: against its sense", skew, 2, -1),
               sign_row(setting, "the same: in its sense", skew, -2, -1),
               sign_row(setting, "the same of the mirrored stone: against its sense", -skew, -2, 1),
               sign_row(setting, "the same of the mirrored stone: in its sense", -skew, 2, 1),
               sign_row(setting, "the same of a stone without skew", 0, 2, 1)};
  double gain = 0;
  Stone stone(setting, skew, 2);
  stone.rig.run(kTime, [&] { gain = std::max(gain, stone.rig.energy().total() / stone.start - 1); });
  rows.push_back(absolute_row("largest gain of energy in those 24 s, share", "", 0, gain, 0.01));
  return rows;
}

}  // namespace hooke::check
