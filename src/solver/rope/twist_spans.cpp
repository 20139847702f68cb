/// Finds which parts of ropes are held against twist.

#include "base/assert.h"
#include "math/rotation.h"
#include "solver/joint_rows/joint_rows.h"
#include "solver/rope/rope_clamps.h"
#include "solver/rope/rope_twist.h"

#include <algorithm>
#include <cmath>

namespace hooke::solver {

namespace {

using state::HookPlace;
using state::Tables;
using state::TwistClamp;
using state::TwistSpan;

TwistClamp clamp_at(const Tables& t, std::uint32_t segment, Holder holder) {
  const std::uint32_t slot = holder.body == HookPlace::kWorld ? 0 : t.bodies.slot[holder.body];
  return {.segment = segment, .body = holder.body, .slot = slot, .tangent = {}, .director = {}};
}

double rest_length(const Tables& t, const state::Deformable& rope, std::uint32_t segment) {
  return static_cast<double>(t.segments.rest_length[rope.segments.first + segment]);
}

bool same_place(const TwistClamp& a, const TwistClamp& b) {
  return a.segment == b.segment && a.slot == b.slot;
}

/// Some unit vector across t.
DVec3 across_of(DVec3 t) {
  const bool steep = std::abs(t.y) > std::abs(t.x) && std::abs(t.y) > std::abs(t.z);
  return normalize(cross(t, steep ? DVec3{1, 0, 0} : DVec3{0, 1, 0}));
}

/// Gives the clamps of a new span the directors that make its twist `angle`.
void set_directors(const Tables& t, double angle, TwistSpan& span) {
  const auto x = [&](std::uint32_t node) {
    return vector_cast<double>(t.particles.position[t.objects[span.object].particles.first + node].x);
  };
  DVec3 tangent = normalize(x(span.a.segment + 1) - x(span.a.segment));
  DVec3 director = across_of(tangent);
  const auto put = [&](TwistClamp& clamp, DVec3 turned) {
    const Quaternion<double> back = conjugate(joint_body_now(t.bodies, clamp.body).rotation);
    clamp.tangent = rotate(back, tangent);
    clamp.director = rotate(back, turned);
  };
  put(span.a, director);
  for (std::uint32_t i = span.a.segment + 1; i <= span.b.segment; ++i) {
    const DVec3 next = normalize(x(i + 1) - x(i));
    if (next == DVec3{}) continue;
    director = transport(tangent, next, director);
    tangent = next;
  }
  put(span.b, rotate(math::quaternion_of(angle * tangent), director));
  span.angle = span.expected = angle;
}

/// The twist of each segment per length [rad/m], as the earlier spans had it.
std::vector<double> twist_rates(const Tables& t, std::uint32_t object, const std::vector<TwistSpan>& spans) {
  const state::Deformable& rope = t.objects[object];
  std::vector<double> rates(rope.segments.count, static_cast<double>(rope.twist_rate));
  for (const TwistSpan& span : spans) {
    if (span.object != object) continue;
    for (std::uint32_t i = span.a.segment + 1; i < span.b.segment; ++i)
      rates[i] = span.expected / span.length;
  }
  return rates;
}

/// The span between two clamps: an earlier one, or a new one.
TwistSpan span_between(const Tables& t, std::uint32_t object, const TwistClamp& a, const TwistClamp& b,
                       const std::vector<TwistSpan>& before) {
  HOOKE_ASSERT(a.segment + 1 < b.segment && b.segment < t.objects[object].segments.count);
  const auto was = std::find_if(before.begin(), before.end(), [&](const TwistSpan& span) {
    return span.object == object && same_place(span.a, a) && same_place(span.b, b);
  });
  if (was != before.end()) return *was;
  TwistSpan span = {.object = object, .a = a, .b = b};
  const std::vector<double> rates = twist_rates(t, object, before);
  double angle = 0;
  for (std::uint32_t i = a.segment + 1; i < b.segment; ++i) {
    const double rest = rest_length(t, t.objects[object], i);
    span.length += rest;
    angle += rates[i] * rest;
  }
  set_directors(t, angle, span);
  return span;
}

/// Whether the rope goes on from one clamp to another.
bool are_joined(const Tables& t, const state::Deformable& rope, std::uint32_t a, std::uint32_t b) {
  for (std::uint32_t i = a; i <= b; ++i) {
    if (!t.segments.joins(rope.segments.first + i)) return false;
  }
  return true;
}

}  // namespace

void find_twist_spans(const std::vector<Holder>& holders, Tables& t) {
  const std::vector<TwistSpan> before = std::move(t.twists);
  t.twists.clear();
  for (std::uint32_t i = 0; i < t.objects.size(); ++i) {
    state::Deformable& rope = t.objects[i];
    if (!(rope.twist_stiffness > Real(0))) continue;
    TwistClamp last;
    bool any_last = false;
    for_each_clamp(rope, holders, [&](std::uint32_t from, std::uint32_t to, Holder holder) {
      if (any_last && are_joined(t, rope, last.segment, from))
        t.twists.push_back(span_between(t, i, last, clamp_at(t, from, holder), before));
      last = clamp_at(t, to - 1, holder);
      any_last = true;
    });
    rope.twist_rate = Real(0);
  }
}

}  // namespace hooke::solver
