#include "solver/body_contacts.h"

#include <algorithm>
#include <cmath>

namespace hooke::solver {

namespace {

using state::MotionLine;

constexpr Real kLargestFall = Real(0.5);  // [m]

bool was_hit(const BounceBlock& bounce, int k, int lane) {
  return bounce.impact_speed[k][lane] > Real(0) && bounce.largest_impulse[k][lane] > Real(0);
}

/// One lane of a block and the bodies it pushes.
struct BouncingLane {
  const ContactBlock& block;
  BounceBlock& bounce;
  int lane;
  Real h;
  MotionLine& a;
  MotionLine& b;

  [[nodiscard]] Vec3 normal() const { return vector_of(block.normal, lane); }
  [[nodiscard]] Real w() const { return block.w_a[lane] + block.w_b[lane]; }

  [[nodiscard]] Real rate(Vec3 j_a, Vec3 j_b) const {
    return dot(normal(), b.v - a.v) + (dot(j_b, b.omega_scaled) - dot(j_a, a.omega_scaled));
  }

  void push(Real impulse, Vec3 j_a, Vec3 j_b) const {
    a.v -= (block.w_a[lane] * impulse) * normal();
    a.omega_scaled -= impulse * j_a;
    if (block.anchored) return;
    b.v += (block.w_b[lane] * impulse) * normal();
    b.omega_scaled += impulse * j_b;
  }

  [[nodiscard]] bool bounced(int k) const { return was_hit(bounce, k, lane); }

  /// The speed the point leaves with.
  [[nodiscard]] Real target(int k) const {
    const ContactBlock::Point& p = block.point[k];
    const Real s =
        p.separation[lane] + dot(normal(), b.dx - a.dx) +
        (dot(vector_of(p.j_b, lane), b.theta_scaled) - dot(vector_of(p.j_a, lane), a.theta_scaled));
    const Real e = bounce.restitution[lane];
    const Real acceleration = bounce.acceleration[lane];
    // What a body that turns by radians makes of the separation is no height to fall from.
    const Real fall = std::clamp(s, -kLargestFall, kLargestFall);
    const Real speed_squared = e * e * bounce.impact_speed[k][lane] + Real(2) * acceleration * fall;
    return std::sqrt(std::max(Real(0), speed_squared)) - Real(0.5) * h * acceleration;
  }

  /// All points that bounced as one row, its impulse shared out evenly.
  void bounce_center() const {
    Vec3 j_a = {};
    Vec3 j_b = {};
    Real wish = Real(0);
    Real available = Real(0);
    int count = 0;
    for (int k = 0; k < block.point_count; ++k) {
      bounce.impulse[k][lane] = block.point[k].impulse[lane];
      if (!bounced(k)) continue;
      j_a += vector_of(block.point[k].j_a, lane);
      j_b += vector_of(block.point[k].j_b, lane);
      wish += target(k);
      available += block.point[k].impulse[lane];
      ++count;
    }
    if (count == 0) return;
    const Real share = Real(1) / static_cast<Real>(count);
    j_a = share * j_a;
    j_b = share * j_b;
    const Real turn = length_squared(j_a) + (block.anchored ? Real(0) : length_squared(j_b));
    const Real impulse = std::max((share * wish - rate(j_a, j_b)) / (w() + turn), -available);
    push(impulse, j_a, j_b);
    for (int k = 0; k < block.point_count; ++k) {
      if (bounced(k)) bounce.impulse[k][lane] += share * impulse;
    }
  }

  void bounce_points() const {
    for (int k = 0; k < block.point_count; ++k) {
      if (!bounced(k)) continue;
      const ContactBlock::Point& p = block.point[k];
      const Vec3 j_a = vector_of(p.j_a, lane);
      const Vec3 j_b = vector_of(p.j_b, lane);
      Real& impulse = bounce.impulse[k][lane];
      const Real after = std::max(Real(0), impulse + p.mass[lane] * (target(k) - rate(j_a, j_b)));
      push(after - impulse, j_a, j_b);
      impulse = after;
    }
  }
};

}  // namespace

bool bounced(const BodyContacts& contacts, const ContactBlock& block, int point, int lane) {
  return block.bounces >= 0 && was_hit(contacts.bounces[block.bounces], point, lane);
}

void restitute_body_contacts(parallel::Range blocks, int pass, const ContactStep& step,
                             BodyContacts& contacts, state::Bodies& bodies) {
  for (int i = blocks.begin; i < blocks.end; ++i) {
    const ContactBlock& block = contacts.blocks[i];
    if (block.bounces < 0) continue;
    for (int lane = 0; lane < block.count; ++lane) {
      const BouncingLane row = {
          block,  contacts.bounces[block.bounces],        lane,
          step.h, bodies.motion[block.line_a[lane] / 16], bodies.motion[block.line_b[lane] / 16]};
      if (pass == 0) {
        row.bounce_center();
      } else {
        row.bounce_points();
      }
    }
  }
}

}  // namespace hooke::solver
