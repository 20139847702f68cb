#include "validation/planar_mechanism.h"

#include "validation/rig.h"

#include <cmath>

namespace hooke::check {

std::vector<PlanarPose> PlanarMechanism::slopes(double q) const {
  const double e = 1e-5;
  const std::vector<PlanarPose> before = poses_(q - e);
  std::vector<PlanarPose> slopes = poses_(q + e);
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    slopes[i] = {(slopes[i].x - before[i].x) / (2 * e), (slopes[i].y - before[i].y) / (2 * e),
                 (slopes[i].angle - before[i].angle) / (2 * e)};
  }
  return slopes;
}

double PlanarMechanism::inertia(double q) const {
  const std::vector<PlanarPose> slope = slopes(q);
  double sum = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const PlanarPose& s = slope[i];
    sum += bodies_[i].mass * (s.x * s.x + s.y * s.y) + bodies_[i].inertia * s.angle * s.angle;
  }
  return sum;
}

double PlanarMechanism::potential(double q) const {
  const std::vector<PlanarPose> now = poses_(q);
  double sum = 0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) sum += bodies_[i].mass * kGravity * now[i].y;
  return sum;
}

double PlanarMechanism::acceleration(double q, double speed) const {
  const double e = 1e-4;
  const double inertia_slope = (inertia(q + e) - inertia(q - e)) / (2 * e);
  const double force = -(potential(q + e) - potential(q - e)) / (2 * e);
  return (force - 0.5 * inertia_slope * speed * speed) / inertia(q);
}

double PlanarMechanism::run(double start, double seconds) const {
  const int steps = static_cast<int>(seconds * 2000);
  const double h = seconds / steps;
  double q = start;
  double speed = 0;
  for (int i = 0; i < steps; ++i) {
    const double a1 = acceleration(q, speed);
    const double v2 = speed + 0.5 * h * a1;
    const double a2 = acceleration(q + 0.5 * h * speed, v2);
    const double v3 = speed + 0.5 * h * a2;
    const double a3 = acceleration(q + 0.5 * h * v2, v3);
    const double v4 = speed + h * a3;
    const double a4 = acceleration(q + h * v3, v4);
    q += h / 6 * (speed + 2 * v2 + 2 * v3 + v4);
    speed += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  return q;
}

DVec3 FourBar::pin(double q) const {
  const double x = crank * std::cos(q) - ground;
  const double y = crank * std::sin(q);
  const double r = std::hypot(x, y);
  const double along = (rocker * rocker - coupler * coupler + r * r) / (2 * r);
  const double across = std::sqrt(rocker * rocker - along * along);
  return {ground + (along * x + across * y) / r, (along * y - across * x) / r, 0};
}

std::vector<PlanarPose> FourBar::poses(double q) const {
  const double x = crank * std::cos(q);
  const double y = crank * std::sin(q);
  const DVec3 p = pin(q);
  return {{0.5 * x, 0.5 * y, q},
          {0.5 * (x + p.x), 0.5 * (y + p.y), std::atan2(p.y - y, p.x - x)},
          {0.5 * (ground + p.x), 0.5 * p.y, std::atan2(p.y, p.x - ground)}};
}

std::vector<PlanarPose> SliderCrank::poses(double q) const {
  const double x = crank * std::cos(q);
  const double y = crank * std::sin(q);
  const double end = x + std::sqrt(rod * rod - y * y);
  return {{0.5 * x, 0.5 * y, q}, {0.5 * (x + end), 0.5 * y, std::atan2(-y, end - x)}, {end, 0, 0}};
}

}  // namespace hooke::check
