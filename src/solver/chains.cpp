/// One rope after another: linearize its segments and contacts, sweep forward, sweep back, check, repeat if
/// need be. Read solve_chain first, at the end of the file.

#include "solver/chains.h"

#include "math/symmetric.h"
#include "solver/contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hooke::solver {

namespace {

using math::Symmetric3;
using V = DVec3;
using M = Symmetric3<double>;

constexpr double kDamping = 0.2;               ///< Share of the geometric stiffness that damps waves.
constexpr double kTransverseFloor = 1e-5;      ///< Of the lighter end's mass; keeps slack segments defined.
constexpr double kComplianceInAir = 1e-7;      ///< Over the lighter end's mass.
constexpr double kComplianceInContact = 1e-5;  ///< Rigid segments between stuck nodes would be undetermined.
constexpr double kLengthTolerance = 1e-3;      ///< The next substep takes back what is left, as speed.
constexpr double kReportedError = 0.01;
constexpr double kLimitTolerance = 1e-4;
constexpr double kContactStiffness = 1e3;  ///< rho over the node's mass.
constexpr double kSlidingShare = 0.9999;   ///< Of mu N: a node whose friction was this large was sliding.
constexpr int kMostSolves = 8;
constexpr int kLeastContactSolves = 2;
constexpr int kSlidingSolves = 4;

struct Node {
  V x, v_free, v_before;  // position, velocity with forces, velocity before forces
  double mass = 0, w = 0;
  V u;        // the result
  V target;   // v*: free velocity with the contact's pull
  M inverse;  // W
};

struct Segment {
  V n, offset;
  M compliance;
  M k;     // (X + W)^-1
  V s, q;  // free velocity of the rope behind, impulse
  double rest = 0, stiffness = 0, damping = 0, limit = 0;
  double tension_bound = 0;  // T+
  double gamma = 0;
  bool limited = false;
};

struct Touch {
  std::uint32_t row = 0, node = 0;
  V n, f0, f;
  V against;  // direction of friction on a node that slides
  double separation = 0, friction = 0, n0 = 0, normal = 0;
  bool active = false, slides = false;
};

/// How a rope's segments are linearized.
struct Setting {
  double compliance = kComplianceInAir;
  V turning = {};     ///< Angular velocity of the line between the rope's ends [rad/s].
  bool first = true;  ///< At the start of the substep; later about the last result.
};

struct Scratch {
  std::vector<Node> nodes;
  std::vector<Segment> segments;
  std::vector<Touch> touches;
};

double lighter_end(const Node& a, const Node& b) {
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

/// The segment's equation u_b - u_a = offset + compliance q.
void linearize(Segment& e, const Node& a, const Node& b, double h, const Setting& setting) {
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

/// Angular velocity of the line from the first to the last node before this substep; zero for a rope that is
/// folded to less than a quarter of its length, whose line means nothing.
V turning_of(const Scratch& s) {
  double total = 0;
  for (const Segment& e : s.segments) total += e.rest;
  const V line = s.nodes.back().x - s.nodes.front().x;
  const double l2 = length_squared(line);
  if (l2 < total * total / 16) return {};
  return (1.0 / l2) * cross(line, s.nodes.back().v_before - s.nodes.front().v_before);
}

/// W and v* of every node, with what touches it.
void hold_nodes(Scratch& s, double h) {
  for (Node& node : s.nodes) {
    node.inverse = M::diagonal(node.w);
    node.target = node.v_free;
  }
  for (std::size_t i = 0; i < s.touches.size();) {
    Node& node = s.nodes[s.touches[i].node];
    const std::uint32_t index = s.touches[i].node;
    M mass = M::diagonal(node.mass);
    V impulse = node.mass * node.v_free;
    for (; i < s.touches.size() && s.touches[i].node == index; ++i) {
      const Touch& t = s.touches[i];
      if (!t.active) continue;
      const double rho = kContactStiffness * node.mass;
      mass = mass + math::axial(t.n, rho, t.slides ? 0.0 : rho);
      impulse += (t.n0 - rho * std::max(t.separation / h, -kPushOutSpeed)) * t.n;
      impulse += t.slides ? (t.friction * t.normal) * t.against : t.f0;
    }
    if (!(node.w > 0)) continue;
    node.inverse = math::inverse(mass);
    node.target = node.inverse * impulse;
  }
}

void sweep(Scratch& s) {
  Node& head = s.nodes.front();
  M phi_matrix = head.inverse;
  V phi = head.target;
  const std::size_t last = s.segments.size();
  for (std::size_t i = 0; i < last; ++i) {
    Segment& e = s.segments[i];
    const Node& node = s.nodes[i + 1];
    const M x = phi_matrix + e.compliance;
    e.s = phi + e.offset;
    e.k = math::inverse(x + node.inverse);
    phi_matrix = math::symmetric_product(x, e.k, node.inverse);
    phi = node.target + node.inverse * (e.k * (e.s - node.target));
  }
  V next = {};
  for (std::size_t i = last; i > 0; --i) {
    Segment& e = s.segments[i - 1];
    Node& node = s.nodes[i];
    e.q = e.k * (node.target + node.inverse * next - e.s);
    node.u = node.target + node.inverse * (next - e.q);
    next = e.q;
  }
  head.u = head.target + head.inverse * next;
}

/// Friction of an active contact: holds with f0 - rho u_t up to mu N, slides against u_t beyond.
void update_friction(Touch& t, V u, double rho) {
  const V sliding = across(t.n, u);
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

/// Contact forces that follow from u. True if the set of active contacts changed or a node slides.
bool update_touches(Scratch& s, double h) {
  bool unsettled = false;
  for (Touch& t : s.touches) {
    const Node& node = s.nodes[t.node];
    const double approach = dot(t.n, node.u) + std::max(t.separation / h, -kPushOutSpeed);
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

/// Largest relative length error left; raises T+ and moves segments onto or off their limits.
double check_segments(Scratch& s, double h, bool& limits_changed) {
  double worst = 0;
  for (std::size_t i = 0; i < s.segments.size(); ++i) {
    Segment& e = s.segments[i];
    const Node& a = s.nodes[i];
    const Node& b = s.nodes[i + 1];
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

void load(const Chain& chain, const std::vector<Vec3>& before, const state::Particles& particles,
          const state::Segments& segments, Scratch& s) {
  s.nodes.resize(chain.node_count);
  s.segments.resize(chain.node_count - 1);
  for (std::uint32_t i = 0; i < chain.node_count; ++i) {
    const std::size_t row = chain.first_particle + i;
    const state::PositionLine& line = particles.position[row];
    s.nodes[i] = {.x = vector_cast<double>(line.x),
                  .v_free = vector_cast<double>(particles.velocity[row].v),
                  .v_before = vector_cast<double>(before[row]),
                  .mass = static_cast<double>(particles.mass[row]),
                  .w = static_cast<double>(particles.velocity[row].inverse_mass),
                  .u = {},
                  .target = {},
                  .inverse = {}};
  }
  for (std::uint32_t i = 0; i + 1 < chain.node_count; ++i) {
    const std::size_t row = chain.first_segment + i;
    Segment& e = s.segments[i];
    e = {};
    e.rest = static_cast<double>(segments.rest_length[row]);
    e.stiffness = static_cast<double>(segments.stiffness[row]);
    e.damping = static_cast<double>(segments.damping[row]);
    e.limit = static_cast<double>(segments.length_limit[row]);
    e.tension_bound = static_cast<double>(segments.tension[row]);
    e.limited = segments.limited[row] != 0;
  }
}

void load_touches(const Chain& chain, double h, const state::Contacts& contacts, Scratch& s) {
  s.touches.clear();
  for (std::uint32_t row = chain.first_contact; row < chain.end_contact; ++row) {
    Touch t;
    t.row = row;
    t.node = contacts.particle[row] - chain.first_particle;
    if (!(s.nodes[t.node].w > 0)) continue;
    t.n = vector_cast<double>(contacts.normal[row]);
    t.separation = static_cast<double>(contacts.separation[row]);
    t.friction = static_cast<double>(contacts.friction[row]);
    t.n0 = h * static_cast<double>(contacts.normal_force[row]);
    t.f0 = across(t.n, h * vector_cast<double>(contacts.friction_force[row]));
    t.active = t.n0 > 0 || t.separation <= 0;
    const double size = length(t.f0);
    t.normal = t.n0;
    t.slides = size > 0 && size >= kSlidingShare * t.friction * t.n0;
    if (t.slides) t.against = (1.0 / size) * t.f0;
    s.touches.push_back(t);
  }
}

void store(const Chain& chain, double h, const Scratch& s, state::Particles& particles,
           state::Segments& segments, state::Contacts& contacts) {
  for (std::uint32_t i = 0; i < chain.node_count; ++i) {
    if (s.nodes[i].w > 0) particles.velocity[chain.first_particle + i].v = vector_cast<Real>(s.nodes[i].u);
  }
  for (std::uint32_t i = 0; i + 1 < chain.node_count; ++i) {
    const std::size_t row = chain.first_segment + i;
    const auto tension = static_cast<Real>(dot(s.segments[i].n, s.segments[i].q) / h);
    segments.tension[row] = tension;
    segments.mean_tension[row] += tension;
    segments.limited[row] = s.segments[i].limited ? 1 : 0;
  }
  for (const Touch& t : s.touches) {
    contacts.normal_force[t.row] = static_cast<Real>(t.normal / h);
    contacts.friction_force[t.row] = vector_cast<Real>((1.0 / h) * t.f);
  }
}

bool finite(const Scratch& s) {
  return std::all_of(s.nodes.begin(), s.nodes.end(), [](const Node& node) { return is_finite(node.u); });
}

/// Newton steps until the rope is as long as its forces say and its contacts are settled. `s` is loaded.
void solve_chain(Chain& chain, double h, Scratch& s) {
  Setting setting;
  if (s.touches.empty()) setting.turning = turning_of(s);
  if (!s.touches.empty()) setting.compliance = kComplianceInContact;
  double error = 0;
  for (int solves = 1; solves <= kMostSolves; ++solves) {
    for (std::size_t i = 0; i < s.segments.size(); ++i) {
      linearize(s.segments[i], s.nodes[i], s.nodes[i + 1], h, setting);
    }
    hold_nodes(s, h);
    sweep(s);
    ++chain.solves;
    if (!finite(s)) break;

    const bool unsettled = update_touches(s, h);
    bool limits_changed = false;
    error = check_segments(s, h, limits_changed);
    const bool long_enough = error <= kLengthTolerance && !limits_changed;
    const int least = s.touches.empty() ? 1 : (unsettled ? kSlidingSolves : kLeastContactSolves);
    if (long_enough && solves >= least) break;
    setting.first = setting.first && long_enough;
  }
  chain.unconverged = chain.unconverged || !(error <= kReportedError) || !finite(s);
}

}  // namespace

void solve_chains(std::span<Chain> chains, const std::vector<Vec3>& before, Real h,
                  state::Particles& particles, state::Segments& segments, state::Contacts& contacts) {
  thread_local Scratch scratch;
  const auto substep = static_cast<double>(h);
  for (Chain& chain : chains) {
    load(chain, before, particles, segments, scratch);
    load_touches(chain, substep, contacts, scratch);
    solve_chain(chain, substep, scratch);
    if (finite(scratch)) store(chain, substep, scratch, particles, segments, contacts);
  }
}

}  // namespace hooke::solver
