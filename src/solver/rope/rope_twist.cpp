#include "solver/rope/rope_twist.h"

#include "base/assert.h"
#include "math/rotation.h"
#include "math/trig.h"
#include "solver/joint_rows/joint_rows.h"
#include "solver/rope/rope_tuning.h"

#include <algorithm>
#include <cmath>

namespace hooke::solver {

namespace {

using state::Tables;
using state::TwistClamp;
using state::TwistSpan;

/// A segment as it lies now.
struct Edge {
  std::uint32_t segment = 0;
  double length = 0;
  DVec3 tangent;
};

Edge edge_of(const Tables& t, const TwistSpan& span, std::uint32_t segment) {
  HOOKE_ASSERT(segment < t.objects[span.object].segments.count);
  const std::uint32_t first = t.objects[span.object].particles.first + segment;
  const DVec3 e = vector_cast<double>(t.particles.position[first + 1].x) -
                  vector_cast<double>(t.particles.position[first].x);
  const double l = length(e);
  return {segment, l, l > 0 ? (1 / l) * e : DVec3{}};
}

/// The present director of a clamp in the world, across its segment.
DVec3 director_now(const Tables& t, const TwistClamp& clamp, DVec3 tangent) {
  const Quaternion<double> turn = joint_body_now(t.bodies, clamp.body).rotation;
  return transport(rotate(turn, clamp.tangent), tangent, rotate(turn, clamp.director));
}

/// Calls visit(before, behind) for each corner between the segments of the clamps. Segments of no length
/// have no direction and are left out.
template <class Visit>
void for_each_corner(const Tables& t, const TwistSpan& span, Visit&& visit) {
  Edge before = edge_of(t, span, span.a.segment);
  for (std::uint32_t i = span.a.segment + 1; i <= span.b.segment; ++i) {
    const Edge behind = edge_of(t, span, i);
    if (behind.length == 0) continue;
    if (before.length > 0) visit(before, behind);
    before = behind;
  }
}

/// The angle from a transported director to that of the last clamp.
double angle_at_end(const Tables& t, const TwistSpan& span, DVec3 tangent, DVec3 carried) {
  const DVec3 end = director_now(t, span.b, tangent);
  const double angle = math::atan2(dot(tangent, cross(carried, end)), dot(carried, end));
  return angle + math::whole_turns(span.expected - angle);
}

bool moves(const Tables& t, const TwistClamp& clamp) {
  return state::gives_way(t.bodies, clamp.body);
}

std::uint32_t first_particle(const Tables& t, const TwistSpan& span) {
  return t.objects[span.object].particles.first + span.a.segment;
}

/// C' in the directions of the row.
double rate_of(const Tables& t, const TwistSpan& span, const TwistRow& row) {
  const auto omega = [&](const TwistClamp& clamp) {
    const JointBody body = joint_body_now(t.bodies, clamp.body);
    return body.scale * body.omega_scaled;
  };
  double rate = dot(row.t_b, omega(span.b)) - dot(row.t_a, omega(span.a));
  const std::uint32_t first = first_particle(t, span);
  for (std::uint32_t i = 0; i < row.gradients.size(); ++i)
    rate += dot(row.gradients[i], vector_cast<double>(t.particles.velocity[first + i].v));
  return rate;
}

math::Symmetric3<double> scale_of(const Tables& t, const TwistClamp& clamp) {
  return joint_body_now(t.bodies, clamp.body).scale;
}

/// w of the row.
double inverse_mass_of(const Tables& t, const TwistSpan& span, const TwistRow& row) {
  double w = 0;
  const std::uint32_t first = first_particle(t, span);
  for (std::uint32_t i = 0; i < row.gradients.size(); ++i) {
    const auto inverse_mass = static_cast<double>(t.particles.velocity[first + i].inverse_mass);
    w += inverse_mass * length_squared(row.gradients[i]);
  }
  if (span.a.body == span.b.body && moves(t, span.a))
    return w + length_squared(scale_of(t, span.a) * (row.t_b - row.t_a));
  if (moves(t, span.a)) w += length_squared(scale_of(t, span.a) * row.t_a);
  if (moves(t, span.b)) w += length_squared(scale_of(t, span.b) * row.t_b);
  return w;
}

void turn_body(const TwistClamp& clamp, DVec3 impulse, Tables& t) {
  if (!moves(t, clamp)) return;
  const JointBody body = joint_body_now(t.bodies, clamp.body);
  set_joint_velocity(body, body.v, body.omega_scaled + body.scale * impulse, clamp.body, t.bodies);
}

/// Turns the director of what the world holds as pins move.
void follow_pins(DVec3 tangent, TwistClamp& clamp) {
  if (clamp.slot != 0) return;
  clamp.director = normalize(transport(clamp.tangent, tangent, clamp.director));
  clamp.tangent = tangent;
}

/// The share s of a row that is implicit.
double implicit_share(double stiffness) {
  return stiffness > 1 ? 1 - 1 / stiffness : 0;
}

/// Finds the present twist of the span, and the impulse for it.
void load_impulse(double h, const Tables& t, const TwistRow& row, TwistSpan& span) {
  span.impulse = 0;
  span.implicit = false;
  if (!std::isfinite(row.angle)) return;
  span.angle = span.expected = row.angle;
  follow_pins(row.t_a, span.a);
  follow_pins(row.t_b, span.b);
  const double k = twist_stiffness(t, span);
  const double w = inverse_mass_of(t, span, row);
  const double stiffness = h * h * k * w;
  const double share = implicit_share(stiffness);
  span.impulse = -h * k * span.angle;
  span.implicit = share > 0;
  if (span.implicit) {
    const double rate = rate_of(t, span, row);
    span.impulse -= share * h * h * k * (rate + span.reaction);
    span.impulse /= 1 + share * stiffness;
    span.reaction = rate + w * span.impulse;
  } else {
    span.reaction = 0;
  }
  span.mean_torque -= static_cast<Real>(span.impulse / h);
}

}  // namespace

DVec3 transport(DVec3 t, DVec3 u, DVec3 v) {
  const double c = 1 + dot(t, u);
  return c > 1e-12 ? v - (dot(u, v) / c) * (t + u) : v;
}

double twist_now(const Tables& t, const TwistSpan& span) {
  DVec3 tangent = edge_of(t, span, span.a.segment).tangent;
  DVec3 director = director_now(t, span.a, tangent);
  for_each_corner(t, span, [&](const Edge& before, const Edge& behind) {
    director = transport(before.tangent, behind.tangent, director);
    tangent = behind.tangent;
  });
  return angle_at_end(t, span, tangent, director);
}

void load_twist(const Tables& t, const TwistSpan& span, TwistRow& row) {
  row.t_a = row.t_b = edge_of(t, span, span.a.segment).tangent;
  row.gradients.assign(span.b.segment - span.a.segment + 2, DVec3{});
  DVec3 director = director_now(t, span.a, row.t_a);
  for_each_corner(t, span, [&](const Edge& before, const Edge& behind) {
    director = transport(before.tangent, behind.tangent, director);
    row.t_b = behind.tangent;
    const double c = 1 + dot(before.tangent, behind.tangent);
    const DVec3 half = (1 / std::max(c, kSharpestTwistBend)) * cross(before.tangent, behind.tangent);
    const DVec3 g_before = (1 / before.length) * half;
    const DVec3 g_behind = (1 / behind.length) * half;
    DVec3* at = &row.gradients[before.segment - span.a.segment];
    at[0] -= g_before;
    at[1] += g_before;
    at = &row.gradients[behind.segment - span.a.segment];
    at[0] -= g_behind;
    at[1] += g_behind;
  });
  row.angle = angle_at_end(t, span, row.t_b, director);
}

double twist_stiffness(const Tables& t, const TwistSpan& span) {
  HOOKE_ASSERT(span.length > 0);  // clamps have a segment between them
  const std::uint32_t first = t.objects[span.object].segments.first;
  for (std::uint32_t i = span.a.segment; i <= span.b.segment; ++i) {
    if (!t.segments.joins(first + i)) return 0;
  }
  return static_cast<double>(t.objects[span.object].twist_stiffness) / span.length;
}

void twist_bodies(double h, Tables& tables, std::vector<TwistRow>& rows) {
  rows.resize(tables.twists.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    TwistSpan& span = tables.twists[i];
    load_twist(tables, span, rows[i]);
    load_impulse(h, tables, rows[i], span);
    if (span.impulse == 0) continue;
    turn_body(span.a, -span.impulse * rows[i].t_a, tables);
    turn_body(span.b, span.impulse * rows[i].t_b, tables);
  }
}

void twist_nodes(const std::vector<TwistRow>& rows, Tables& tables) {
  HOOKE_ASSERT(rows.size() == tables.twists.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const TwistSpan& span = tables.twists[k];
    if (span.impulse == 0) continue;
    const std::uint32_t first = first_particle(tables, span);
    for (std::uint32_t i = 0; i < rows[k].gradients.size(); ++i) {
      state::VelocityRecord& record = tables.particles.velocity[first + i];
      const double share = span.impulse * static_cast<double>(record.inverse_mass);
      record.v += vector_cast<Real>(share * rows[k].gradients[i]);
    }
  }
}

void note_twist_rates(double h, const std::vector<TwistRow>& rows, Tables& tables) {
  HOOKE_ASSERT(h > 0 && rows.size() == tables.twists.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    TwistSpan& span = tables.twists[i];
    const double rate = rate_of(tables, span, rows[i]);
    if (std::isfinite(rate)) span.expected += h * rate;
    if (span.implicit) span.reaction = rate - span.reaction;
  }
}

}  // namespace hooke::solver
