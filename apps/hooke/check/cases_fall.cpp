/// One particle in gravity, in air and in fields.

#include "cases.h"
#include "rig.h"

#include <cmath>

namespace hooke::check {

namespace {

constexpr const char* kSolver = "particles";

double fallen(const CheckSetting& setting, int substeps, double seconds) {
  CheckSetting finer = setting;
  finer.substeps = substeps;
  Rig rig(finer);
  const ParticlesId id = rig.add({.particles = {ParticleDesc{}}});
  rig.run(seconds);
  return -rig.world().positions(id)[0].y;
}

}  // namespace

/// y = g t^2 / 2 (textbook). Semi-implicit Euler falls g t h / 2 more, h the substep: first order.
std::vector<CheckRow> free_fall(const CheckSetting& setting) {
  const double t = 1.0;
  const double exact = 0.5 * kGravity * t * t;
  const double coarse = fallen(setting, setting.substeps, t);
  const double fine = fallen(setting, 2 * setting.substeps, t);
  const double h = setting.dt / setting.substeps;
  return {{.title = "distance fallen in 1 s",
           .unit = "m",
           .expected = exact,
           .achieved = coarse,
           .tolerance = 0.005,
           .solver = kSolver},
          {.title = "excess over the exact distance",
           .unit = "m",
           .expected = 0.5 * kGravity * t * h,
           .achieved = coarse - exact,
           .tolerance = 0.005,
           .solver = kSolver},
          {.title = "order of convergence",
           .expected = 1.0,
           .achieved = std::log2((coarse - exact) / (fine - exact)),
           .tolerance = 0.05,
           .measure = CheckRow::Measure::kAbsolute,
           .solver = kSolver}};
}

}  // namespace hooke::check
