#include "solver/contact/backing_contacts.h"

#include "state/body_frames.h"

#include <algorithm>
#include <cmath>

namespace hooke::solver {

namespace {

using state::Bodies;

std::size_t number_of(const ContactLane& at) {
  return static_cast<std::size_t>(at.block) * kContactLanes + static_cast<std::size_t>(at.lane);
}

/// Changes the velocity of a body as a row's impulse does. What its contact does not remember is free motion.
void move(std::uint32_t body, Vec3 v, Vec3 turn, bool is_free, Bodies& bodies) {
  bodies.motion[body].v += v;
  bodies.motion[body].omega_scaled += turn;
  if (!is_free) return;
  bodies.free_motion[body].v += v;
  bodies.free_motion[body].omega_scaled += turn;
  if (state::is_gyroscopic_now(bodies, body))
    bodies.angular_momentum[body] += math::inverse(bodies.scale[body]) * turn;
}

/// Solves one lane. Returns the largest change of speed along the normal [m/s].
Real solve_lane(const ContactLane& at, Real h, Bodies& bodies, ContactBlock& block) {
  const std::uint32_t row_a = block.record_a[at.lane] / 16;
  const std::uint32_t row_b = block.record_b[at.lane] / 16;
  const Vec3 n = vector_of(block.normal, at.lane);
  Real largest = Real(0);
  for (int k = 0; k < block.point_count; ++k) {
    ContactBlock::Point& point = block.point[k];
    const Vec3 j_a = vector_of(point.j_a, at.lane);
    const Vec3 j_b = vector_of(point.j_b, at.lane);
    const state::MotionRecord& a = bodies.motion[row_a];
    const state::MotionRecord& b = bodies.motion[row_b];
    const Real gap =
        point.separation[at.lane] + dot(n, b.dx - a.dx) + dot(j_b, b.theta_scaled) - dot(j_a, a.theta_scaled);
    const Real speed = dot(n, b.v - a.v) + dot(j_b, b.omega_scaled) - dot(j_a, a.omega_scaled);
    const Real change = -(speed + std::max(gap, Real(0)) / h);
    const Real impulse = point.mass[at.lane] * change;
    // What is about to be quarantined takes nothing with it.
    if (!(impulse > Real(0)) || !std::isfinite(impulse)) continue;
    largest = std::max(largest, change);
    const bool is_free = !block.is_soft();
    move(row_a, (-block.w_a[at.lane] * impulse) * n, -impulse * j_a, is_free, bodies);
    if (!block.anchored) move(row_b, (block.w_b[at.lane] * impulse) * n, impulse * j_b, is_free, bodies);
    if (is_free) continue;
    // The last lane stands for all behind it.
    const int end = at.lane + 1 == block.count ? kContactLanes : at.lane + 1;
    for (int lane = at.lane; lane < end; ++lane) point.impulse[lane] += impulse;
  }
  return largest;
}

}  // namespace

void BackingContacts::list(const Bodies& bodies, const BodyContacts& contacts) {
  lanes_.fill(bodies.motion.size(), [&](auto visit) {
    for (std::size_t i = 0; i < contacts.blocks.size(); ++i) {
      const ContactBlock& block = contacts.blocks[i];
      for (int lane = 0; lane < block.count; ++lane) {
        const ContactLane at = {.block = static_cast<int>(i), .lane = lane};
        visit(block.record_a[lane] / 16, at);
        if (!block.anchored) visit(block.record_b[lane] / 16, at);
      }
    }
  });
  reached_.assign(bodies.motion.size(), 0);
  is_active_.assign(contacts.blocks.size() * kContactLanes, 0);
  bodies_.clear();
  active_.clear();
}

void BackingContacts::begin(Real h, const Bodies& bodies, const BodyContacts& contacts) {
  h_ = h;
  if (lanes_.empty()) list(bodies, contacts);
  for (const std::uint32_t body : bodies_) reached_[body] = 0;
  for (const ContactLane& at : active_) is_active_[number_of(at)] = 0;
  bodies_.clear();
  active_.clear();
}

void BackingContacts::reach(std::uint32_t body) {
  if (reached_[body] != 0) return;
  reached_[body] = 1;
  bodies_.push_back(body);
  for (const ContactLane& at : lanes_.of(body)) {
    std::uint8_t& is_active = is_active_[number_of(at)];
    if (is_active == 0) active_.push_back(at);
    is_active = 1;
  }
}

Real BackingContacts::solve(Real least, Bodies& bodies, BodyContacts& contacts) {
  Real largest = Real(0);
  for (std::size_t i = 0; i < active_.size(); ++i) {
    const ContactLane at = active_[i];
    ContactBlock& block = contacts.blocks[at.block];
    const Real change = solve_lane(at, h_, bodies, block);
    largest = std::max(largest, change);
    if (!(change > least)) continue;
    reach(block.record_a[at.lane] / 16);
    if (!block.anchored) reach(block.record_b[at.lane] / 16);
  }
  return largest;
}

}  // namespace hooke::solver
