#include "solver/rope_rows.h"

#include "solver/contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hooke::solver {

namespace {

using V = DVec3;
using M = math::Symmetric3<double>;

constexpr double kDamping = 0.2;           ///< Share of the geometric stiffness that damps waves.
constexpr double kTransverseFloor = 1e-5;  ///< Of the lighter end's mass; keeps slack segments defined.
constexpr double kLimitTolerance = 1e-4;
constexpr double kSlidingShare = 0.9999;  ///< Of mu N: a node whose friction was this large was sliding.
constexpr int kLeastContactSolves = 2;
constexpr int kSlidingSolves = 4;

double lighter_end(const RopeNode& a, const RopeNode& b) {
  const double inf = std::numeric_limits<double>::infinity();
  const double m = std::min(a.w > 0 ? a.mass : inf, b.w > 0 ? b.mass : inf);
  return m < inf ? m : 1.0;
}

V direction(V d, double l) {
  return l > 0 ? (1.0 / l) * d : V{0, -1, 0};
}

V across(V n, V v) {
  return v - dot(n, v) * n;
}

/// Angular velocity of the line from the first to the last node before this substep; zero for a rope that is
/// folded to less than a quarter of its length, whose line means nothing.
V turning_of(std::size_t first_node, const RopeScratch& s) {
  double total = 0;
  for (std::size_t i = s.segments.size(); i > 0 && s.segments[i - 1].a >= first_node; --i)
    total += s.segments[i - 1].rest;
  const RopeNode& first = s.nodes[first_node];
  const V line = s.nodes.back().x - first.x;
  const double l2 = length_squared(line);
  if (l2 < total * total / 16) return {};
  return (1.0 / l2) * cross(line, s.nodes.back().v_before - first.v_before);
}

/// How fast a contact would open, with its gap as speed.
double approach_of(const RopeTouch& t, V u, double h) {
  return dot(t.n, u - t.surface) + std::max(t.separation / h, -kPushOutSpeed);
}

/// Friction of an active contact: holds with f0 - rho u_t up to mu N, slides against u_t beyond.
void update_friction(RopeTouch& t, V u, double rho) {
  const V sliding = across(t.n, u - t.surface);
  const double speed = length(sliding);
  if (t.slides) {
    t.slides = dot(sliding, t.against) <= 0;
    if (t.slides && speed > 0) t.against = (-1.0 / speed) * sliding;
  } else {
    t.f = t.f0 - rho * sliding;
    const double size = length(t.f);
    t.slides = size > t.friction * t.normal;
    if (t.slides) t.against = (1.0 / size) * t.f;
  }
  if (t.slides) t.f = (t.friction * t.normal) * t.against;
}

RopeTouch load_touch(std::size_t row, double h, const state::Contacts& contacts) {
  RopeTouch t;
  t.row = static_cast<std::uint32_t>(row);
  t.n = vector_cast<double>(contacts.normal[row]);
  t.surface = vector_cast<double>(contacts.surface_velocity[row]);
  t.lever = vector_cast<double>(contacts.lever[row]);
  t.separation = static_cast<double>(contacts.separation[row]);
  t.friction = static_cast<double>(contacts.friction[row]);
  t.n0 = h * static_cast<double>(contacts.normal_force[row]);
  t.f0 = across(t.n, h * vector_cast<double>(contacts.friction_force[row]));
  t.active = t.n0 > 0 || t.separation <= 0;
  const double size = length(t.f0);
  t.normal = t.n0;
  t.slides = size > 0 && size >= kSlidingShare * t.friction * t.n0;
  if (t.slides) t.against = (1.0 / size) * t.f0;
  return t;
}

}  // namespace

RopeNode load_node(std::uint32_t particle, Vec3 before, const state::Particles& particles) {
  return {.x = vector_cast<double>(particles.position[particle].x),
          .v_free = vector_cast<double>(particles.velocity[particle].v),
          .v_before = vector_cast<double>(before),
          .mass = static_cast<double>(particles.mass[particle]),
          .w = static_cast<double>(particles.velocity[particle].inverse_mass),
          .u = {},
          .target = {},
          .inverse = {}};
}

void load_rope(const Chain& chain, const std::vector<Vec3>& before, double h,
               const state::Particles& particles, const state::Segments& segments,
               const state::Contacts& contacts, RopeScratch& s) {
  const auto first = static_cast<std::uint32_t>(s.nodes.size());
  for (std::uint32_t i = 0; i < chain.node_count; ++i) {
    const std::uint32_t row = chain.first_particle + i;
    s.nodes.push_back(load_node(row, before[row], particles));
  }
  for (std::uint32_t i = 0; i + 1 < chain.node_count; ++i) {
    const std::size_t row = chain.first_segment + i;
    RopeSegment e;
    e.a = first + i;
    e.rest = static_cast<double>(segments.rest_length[row]);
    e.stiffness = static_cast<double>(segments.stiffness[row]);
    e.damping = static_cast<double>(segments.damping[row]);
    e.limit = static_cast<double>(segments.length_limit[row]);
    e.tension_bound = static_cast<double>(segments.tension[row]);
    e.limited = segments.limited[row] != 0;
    s.segments.push_back(e);
  }
  for (std::uint32_t row = chain.first_contact; row < chain.end_contact; ++row) {
    const std::uint32_t node = first + contacts.particle[row] - chain.first_particle;
    if (!(s.nodes[node].w > 0)) continue;
    s.touches.push_back(load_touch(row, h, contacts));
    s.touches.back().node = node;
  }
}

void load_bends(const Chain& chain, std::size_t first_node, std::size_t first_segment, double h,
                RopeScratch& s) {
  if (!(chain.bend_stiffness > 0)) return;
  for (std::size_t i = 1; i + 1 < chain.node_count; ++i) {
    const double before = s.segments[first_segment + i - 1].rest;
    const double behind = s.segments[first_segment + i].rest;
    const RopeNode* node = &s.nodes[first_node + i];
    const auto held = [&](std::ptrdiff_t step) { return !(node[0].w > 0) && !(node[step].w > 0); };
    const double length = 0.5 * ((held(-1) ? 0 : before) + (held(1) ? 0 : behind));
    RopeBend bend;
    bend.node = static_cast<std::uint32_t>(first_node + i);
    bend.before = 1 / before;
    bend.behind = 1 / behind;
    bend.stiffness = chain.bend_stiffness / (length > 0 ? length : 0.5 * (before + behind));
    bend.damping = chain.bend_damping * bend.stiffness;
    bend.gamma = 1 / (h * (bend.damping + h * bend.stiffness));
    const V change = bend.behind * (node[1].x - node[0].x) - bend.before * (node[0].x - node[-1].x);
    bend.target = (-bend.stiffness / (bend.damping + h * bend.stiffness)) * change;
    s.bends.push_back(bend);
  }
}

RopeSetting first_setting(std::size_t first_node, const RopeScratch& s) {
  const bool touches = std::any_of(s.touches.begin(), s.touches.end(),
                                   [&](const RopeTouch& t) { return t.node >= first_node && t.active; });
  if (touches) return {.compliance = kComplianceInContact};
  return {.compliance = kComplianceInAir, .turning = turning_of(first_node, s)};
}

void linearize(const RopeSetting& setting, double h, const std::vector<RopeNode>& nodes, RopeSegment& e) {
  const RopeNode& a = nodes[e.a];
  const RopeNode& b = nodes[e.a + 1];
  const bool first = setting.first;
  const V relative = first ? V{} : b.u - a.u;
  const V d = b.x - a.x + h * relative;
  const double l = length(d);
  e.n = direction(d, l);

  const bool rigid = e.limited || std::isinf(e.stiffness);
  const double s = e.damping + h * e.stiffness;
  const double bias = rigid ? 1.0 / h : (s > 0 ? e.stiffness / s : 0.0);
  const double lighter = lighter_end(a, b);
  e.gamma = std::max(rigid ? 0.0 : 1.0 / (h * s), setting.compliance / lighter);
  const double c = l - (e.limited ? e.limit : e.rest);

  const double g = h * h * std::max(0.0, e.tension_bound) / e.rest;
  const double floor = kTransverseFloor * lighter;
  const double beta = first ? (1.0 + kDamping) * g + floor : g + floor;
  const V turned = (kDamping * g / beta) * cross(setting.turning, e.rest * e.n);
  const V kept = ((g + floor) / beta) * across(e.n, b.v_before - a.v_before);
  const V transverse = first ? kept + across(e.n, turned) : across(e.n, relative);
  e.offset = (bias * (h * dot(e.n, relative) - c)) * e.n + transverse;
  e.compliance = math::axial(e.n, e.gamma, 1.0 / beta);
}

M grip_of(const RopeTouch& t, const RopeNode& node) {
  const double rho = kContactStiffness * node.mass;
  return math::axial(t.n, rho, t.slides ? 0.0 : rho);
}

V push_of(const RopeTouch& t, const RopeNode& node, double h) {
  const double rho = kContactStiffness * node.mass;
  const V normal = (t.n0 - rho * std::max(t.separation / h, -kPushOutSpeed)) * t.n;
  return normal + (t.slides ? (t.friction * t.normal) * t.against : t.f0);
}

void hold_nodes(double h, RopeScratch& s) {
  for (RopeNode& node : s.nodes) {
    node.inverse = M::diagonal(node.w);
    node.target = node.v_free;
  }
  for (std::size_t i = 0; i < s.touches.size();) {
    const std::uint32_t index = s.touches[i].node;
    RopeNode& node = s.nodes[index];
    M mass = M::diagonal(node.mass);
    V impulse = node.mass * node.v_free;
    for (; i < s.touches.size() && s.touches[i].node == index; ++i) {
      const RopeTouch& t = s.touches[i];
      if (!t.active) continue;
      const M grip = grip_of(t, node);
      mass = mass + grip;
      impulse += push_of(t, node, h);
      if (t.body < 0) impulse += grip * t.surface;
    }
    if (!(node.w > 0)) continue;
    node.inverse = math::inverse(mass);
    node.target = node.inverse * impulse;
  }
}

bool update_touches(double h, RopeScratch& s) {
  bool unsettled = false;
  for (RopeTouch& t : s.touches) {
    const RopeNode& node = s.nodes[t.node];
    const double approach = approach_of(t, node.u, h);
    const double rho = kContactStiffness * node.mass;
    const bool was_active = t.active;
    const bool slid = t.slides;
    if (t.active) {
      t.normal = std::max(0.0, t.n0 - rho * approach);
      t.active = t.normal > 0;
      update_friction(t, node.u, rho);
    } else {
      t.normal = 0;
      t.f = {};
      t.active = approach < 0;
    }
    unsettled = unsettled || was_active != t.active || slid != t.slides || t.slides;
  }
  return unsettled;
}

double check_segments(double h, RopeScratch& s, bool& limits_changed) {
  double worst = 0;
  for (RopeSegment& e : s.segments) {
    const RopeNode& a = s.nodes[e.a];
    const RopeNode& b = s.nodes[e.a + 1];
    const V relative = b.u - a.u;
    const double l = length(b.x - a.x + h * relative);
    const double pull = dot(e.n, e.q);
    e.tension_bound = std::max(e.tension_bound, pull / h);
    if (!(a.w > 0) && !(b.w > 0)) continue;

    const bool firm =
        e.limited || std::isinf(e.stiffness) || e.gamma * h * (e.damping + h * e.stiffness) > 1.0001;
    const double expected =
        firm ? h * e.gamma * pull : (pull / h - e.damping * dot(e.n, relative)) / e.stiffness;
    const double error = l - (e.limited ? e.limit : e.rest) - expected;
    worst = std::max(worst, std::abs(error) / e.rest);

    const bool over = !e.limited && l > e.limit * (1.0 + kLimitTolerance);
    const bool released = e.limited && pull < h * e.stiffness * (e.limit - e.rest);
    limits_changed = limits_changed || over || released;
    e.limited = over || (e.limited && !released);
  }
  return worst;
}

int least_solves(const RopeScratch& s, bool unsettled) {
  const bool touches =
      std::any_of(s.touches.begin(), s.touches.end(), [](const RopeTouch& t) { return t.active; });
  if (!touches && !unsettled) return 1;
  return unsettled ? kSlidingSolves : kLeastContactSolves;
}

bool is_finite(const RopeScratch& s) {
  return std::all_of(s.nodes.begin(), s.nodes.end(),
                     [](const RopeNode& node) { return hooke::is_finite(node.u); });
}

void store_rope(const Chain& chain, std::size_t first_node, std::size_t first_segment, double h,
                const RopeScratch& s, state::Particles& particles, state::Segments& segments) {
  for (std::uint32_t i = 0; i < chain.node_count; ++i) {
    const RopeNode& node = s.nodes[first_node + i];
    if (node.w > 0) particles.velocity[chain.first_particle + i].v = vector_cast<Real>(node.u);
  }
  for (std::uint32_t i = 0; i + 1 < chain.node_count; ++i) {
    const std::size_t row = chain.first_segment + i;
    const RopeSegment& e = s.segments[first_segment + i];
    const auto tension = static_cast<Real>(dot(e.n, e.q) / h);
    segments.tension[row] = tension;
    segments.mean_tension[row] += tension;
    segments.limited[row] = e.limited ? 1 : 0;
  }
}

void store_touches(double h, const RopeScratch& s, state::Contacts& contacts) {
  for (const RopeTouch& t : s.touches) {
    contacts.normal_force[t.row] = static_cast<Real>(t.normal / h);
    contacts.friction_force[t.row] = vector_cast<Real>((1.0 / h) * t.f);
  }
}

}  // namespace hooke::solver
