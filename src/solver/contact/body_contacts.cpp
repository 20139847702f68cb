#include "solver/contact/body_contacts.h"

#include "base/assert.h"
#include "solver/contact/body_contact_kernels.h"
#include "state/body_frames.h"

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <span>

namespace hooke::solver {

namespace {

using parallel::Range;
using state::Bodies;
using state::ContactPoint;
using state::Manifold;

constexpr int kFillGrain = 4;
constexpr int kWarmGrain = 16;

/// Whether the manifold's bodies are swapped in its rows, so that A moves.
bool is_swapped(const Manifold& m, const ContactBlock& block, int lane) {
  return block.record_a[lane] != 16 * m.body_a;
}

/// Writes which bodies are in the lane; the kernel computes the rest.
void fill_lane(std::uint32_t row, const ContactColors& colors, const Bodies& bodies, int lane,
               wide::ContactSource& source, ContactBlock& block) {
  const Manifold& m = source.manifolds[row];
  const bool swapped = colors.moves[m.body_a] == 0;
  const std::uint32_t a = swapped ? m.body_b : m.body_a;
  HOOKE_ASSERT(colors.moves[a] != 0);
  const std::uint32_t b = swapped ? m.body_a : m.body_b;
  source.sign[lane] = swapped ? Real(-1) : Real(1);
  source.points[lane] = static_cast<Real>(m.point_count);
  source.manifold[lane] = row * static_cast<std::uint32_t>(sizeof(Manifold) / sizeof(Real));
  block.record_a[lane] = 16 * a;
  block.record_b[lane] = 16 * b;
  block.w_a[lane] = bodies.motion[a].inverse_mass;
  block.w_b[lane] = block.anchored ? Real(0) : bodies.motion[b].inverse_mass;
  block.restitution[lane] = m.restitution;
}

/// S^2, the inverse of the inertia.
math::Symmetric3<Real> square(const math::Symmetric3<Real>& s) {
  const Vec3 x = {s.xx, s.xy, s.xz};
  const Vec3 y = {s.xy, s.yy, s.yz};
  const Vec3 z = {s.xz, s.yz, s.zz};
  return {dot(x, x), dot(x, y), dot(x, z), dot(y, y), dot(y, z), dot(z, z)};
}

void fill_rolling(const Manifold& m, const Bodies& bodies, const ContactStep& step, const ContactBlock& block,
                  RollingRow& row) {
  math::Symmetric3<Real> give = square(bodies.scale[block.record_a[row.lane] / 16]);
  if (!block.anchored) give = give + square(bodies.scale[block.record_b[row.lane] / 16]);
  row.inertia = math::inverse(give);
  row.lever = m.rolling_friction;
  row.impulse =
      (is_swapped(m, block, row.lane) ? -step.impulse_scale : step.impulse_scale) * m.rolling_impulse;
}

/// Takes the next lane of a block for a member of its color.
void add_lane(const ContactColors::Member& member, const Manifold& m, int index, BodyContacts& contacts) {
  ContactBlock& block = contacts.blocks[index];
  contacts.manifold_of.push_back(member.manifold);
  HOOKE_ASSERT(block.count < kContactLanes);
  block.bounces = block.bounces || m.restitution > Real(0);
  block.point_count = std::max(block.point_count, m.point_count);
  if (m.is_refreshed() && m.route != state::ContactRoute::kDirect) {
    block.point_count = Manifold::kMaxPoints;
    contacts.refreshed.push_back({index, block.count, member.manifold});
  }
  if (m.rolling_friction > Real(0)) contacts.rolling.push_back({.lane = block.count});
  ++block.count;
}

/// Lays out a block for the first of these members of one color, up to where their kind changes. Returns how
/// many it holds.
int lay_out_block(std::span<const ContactColors::Member> members, const std::vector<Manifold>& manifolds,
                  int index, BodyContacts& contacts) {
  ContactBlock& block = contacts.blocks[index];
  HOOKE_ASSERT(contacts.manifold_of.size() == static_cast<std::size_t>(index) * kContactLanes);
  const bool anchored = members.front().anchored;
  const state::ContactRoute route = members.front().route;
  block.anchored = anchored;
  block.route = route;
  block.point_count = 0;
  block.first_rolling = static_cast<int>(contacts.rolling.size());
  block.count = 0;
  block.bounces = false;
  for (const ContactColors::Member& member :
       members.first(std::min<std::size_t>(members.size(), kContactLanes))) {
    if (member.anchored != anchored || member.route != route) break;
    add_lane(member, manifolds[member.manifold], index, contacts);
  }
  contacts.manifold_of.resize((static_cast<std::size_t>(index) + 1) * kContactLanes,
                              BodyContacts::kNoManifold);
  block.rolling_count = static_cast<int>(contacts.rolling.size()) - block.first_rolling;
  return block.count;
}

/// Cuts the colors into blocks, and finds room for what only some blocks have.
void lay_out_blocks(const std::vector<Manifold>& manifolds, BodyContacts& contacts) {
  const ContactColors& colors = contacts.colors;
  contacts.color_begin = {0};
  contacts.manifold_of.clear();
  contacts.rolling.clear();
  contacts.refreshed.clear();
  std::size_t block_count = 0;
  for (std::size_t color = 0; color + 1 < colors.begin.size(); ++color) {
    auto members = std::span(colors.members)
                       .subspan(static_cast<std::size_t>(colors.begin[color]),
                                static_cast<std::size_t>(colors.begin[color + 1] - colors.begin[color]));
    while (!members.empty()) {
      if (contacts.blocks.size() == block_count) contacts.blocks.emplace_back();
      const int held = lay_out_block(members, manifolds, static_cast<int>(block_count++), contacts);
      members = members.subspan(static_cast<std::size_t>(held));
    }
    contacts.color_begin.push_back(static_cast<int>(block_count));
  }
  contacts.blocks.resize(block_count);
}

void fill_block(int index, const std::vector<Manifold>& manifolds, const Bodies& bodies,
                const ContactStep& step, BodyContacts& contacts) {
  ContactBlock& block = contacts.blocks[index];
  const std::uint32_t* rows = contacts.manifold_of.data() + static_cast<std::size_t>(kContactLanes) * index;
  HOOKE_ASSERT(block.count > 0);
  wide::ContactSource source;
  source.manifolds = manifolds.data();
  source.scale = bodies.scale.data();
  source.impulse_scale = step.impulse_scale;
  for (int lane = 0; lane < kContactLanes; ++lane)
    fill_lane(rows[std::min(lane, block.count - 1)], contacts.colors, bodies, lane, source, block);
  wide::compute_contact_rows(source, block);
  for (int i = 0; i < block.rolling_count; ++i) {
    RollingRow& row = contacts.rolling[block.first_rolling + i];
    fill_rolling(manifolds[rows[row.lane]], bodies, step, block, row);
  }
}

/// Removes the impulses of the block's rolling rows from the free motion.
void warm_start_rolling(const BodyContacts& contacts, const ContactBlock& block, Bodies& bodies) {
  for (int i = 0; i < block.rolling_count; ++i) {
    const RollingRow& row = contacts.rolling[block.first_rolling + i];
    const std::uint32_t a = block.record_a[row.lane] / 16;
    const std::uint32_t b = block.record_b[row.lane] / 16;
    bodies.free_motion[a].omega_scaled += bodies.scale[a] * row.impulse;
    if (!block.anchored) bodies.free_motion[b].omega_scaled -= bodies.scale[b] * row.impulse;
  }
}

/// Resists relative angular velocity across the normal.
void roll(const ContactBlock& block, RollingRow& row, Bodies& bodies) {
  const std::uint32_t a = block.record_a[row.lane] / 16;
  const std::uint32_t b = block.record_b[row.lane] / 16;
  Vec3& omega_a = bodies.motion[a].omega_scaled;
  Vec3& omega_b = bodies.motion[b].omega_scaled;
  Real load = Real(0);
  for (int k = 0; k < block.point_count; ++k) load += block.point[k].impulse[row.lane];
  const Real limit = row.lever * load;
  const Vec3 n = vector_of(block.normal, row.lane);
  const Vec3 spin = bodies.scale[b] * omega_b - bodies.scale[a] * omega_a;
  Vec3 wish = row.impulse - row.inertia * spin;
  wish -= dot(n, wish) * n;
  const Real size = length(wish);
  const Vec3 after = size > limit ? (limit / size) * wish : wish;
  const Vec3 change = after - row.impulse;
  row.impulse = after;
  omega_a -= bodies.scale[a] * change;
  if (!block.anchored) omega_b += bodies.scale[b] * change;
}

std::span<ContactBlock> blocks_of(BodyContacts& contacts, Range blocks) {
  return {contacts.blocks.data() + blocks.begin, static_cast<std::size_t>(blocks.count())};
}

/// The blocks of a range whose way is none behind `last`: in each color soft blocks come first, then direct
/// ones, then coupled ones.
std::span<ContactBlock> blocks_up_to(state::ContactRoute last, BodyContacts& contacts, Range blocks) {
  const std::span<ContactBlock> all = blocks_of(contacts, blocks);
  const auto is_behind = [last](const ContactBlock& block) { return block.route > last; };
  const auto end = std::find_if(all.begin(), all.end(), is_behind);
  HOOKE_ASSERT(std::all_of(end, all.end(), is_behind));
  return all.first(static_cast<std::size_t>(end - all.begin()));
}

std::span<ContactBlock> soft_blocks_of(BodyContacts& contacts, Range blocks) {
  return blocks_up_to(state::ContactRoute::kSoft, contacts, blocks);
}

/// Calls `change(body, v, omega_scaled)` with what a lane's impulses do to each body that they move.
template <class Change>
void for_impulses(const ContactBlock& block, int lane, Change&& change) {
  const Vec3 n = vector_of(block.normal, lane);
  const Vec3 t_1 = vector_of(block.tangent, lane);
  const Real twist = block.twist_impulse[lane];
  const Real along = block.friction_impulse[0][lane];
  const Real across = block.friction_impulse[1][lane];
  Vec3 push = along * t_1 + across * cross(n, t_1);
  Vec3 turn_a = twist * vector_of(block.twist_j_a, lane) + along * vector_of(block.friction_j_a[0], lane) +
                across * vector_of(block.friction_j_a[1], lane);
  Vec3 turn_b = twist * vector_of(block.twist_j_b, lane) + along * vector_of(block.friction_j_b[0], lane) +
                across * vector_of(block.friction_j_b[1], lane);
  for (int k = 0; k < block.point_count; ++k) {
    const Real impulse = block.point[k].impulse[lane];
    push += impulse * n;
    turn_a += impulse * vector_of(block.point[k].j_a, lane);
    turn_b += impulse * vector_of(block.point[k].j_b, lane);
  }
  change(block.record_a[lane] / 16, (-block.w_a[lane]) * push, -turn_a);
  if (!block.anchored) change(block.record_b[lane] / 16, block.w_b[lane] * push, turn_b);
}

/// Adds what a lane's impulses have done to the free motion of the bodies (`sign` 1), or removes it (-1).
void move_impulses(const ContactBlock& block, int lane, Real sign, Bodies& bodies) {
  if (block.is_coupled()) return;
  for_impulses(block, lane, [&](std::uint32_t body, Vec3 v, Vec3 turn) {
    bodies.free_motion[body].v += sign * v;
    bodies.free_motion[body].omega_scaled += sign * turn;
    if (state::is_gyroscopic_now(bodies, body))
      bodies.angular_momentum[body] += math::inverse(bodies.scale[body]) * (sign * turn);
  });
}

/// Turns separations of `time` from now into those of the start of the step, along the rows' straight motion.
void bring_to_start(const Bodies& bodies, Real time, int lane, ContactBlock& block) {
  const std::uint32_t row_a = block.record_a[lane] / 16;
  const std::uint32_t row_b = block.record_b[lane] / 16;
  const state::MotionRecord& a = bodies.motion[row_a];
  const state::MotionRecord& b = bodies.motion[row_b];
  const state::FreeMotionRecord from_a = state::motion_before_contacts(bodies, row_a);
  const state::FreeMotionRecord from_b = state::motion_before_contacts(bodies, row_b);
  const Real displacement =
      dot(vector_of(block.normal, lane), (b.dx + time * from_b.v) - (a.dx + time * from_a.v));
  const Vec3 turn_a = a.theta_scaled + time * from_a.omega_scaled;
  const Vec3 turn_b = b.theta_scaled + time * from_b.omega_scaled;
  for (int k = 0; k < block.point_count; ++k) {
    ContactBlock::Point& p = block.point[k];
    p.separation[lane] -=
        displacement + (dot(vector_of(p.j_b, lane), turn_b) - dot(vector_of(p.j_a, lane), turn_a));
  }
}

/// The end of the lanes that repeat this one: the last lane with a manifold is repeated in all behind it.
int end_of(const ContactBlock& block, int lane) {
  return lane + 1 == block.count ? kContactLanes : lane + 1;
}

/// Adds rows for a manifold that has more points now than any of the block's had. Other lanes have no point
/// there.
void make_room(int point_count, ContactBlock& block) {
  HOOKE_ASSERT(point_count <= Manifold::kMaxPoints);
  while (block.point_count < point_count) block.point[block.point_count++] = {};
}

void refill_lane(const ContactLane& at, const std::vector<Manifold>& manifolds, Real time, Bodies& bodies,
                 BodyContacts& contacts) {
  ContactBlock& block = contacts.blocks[at.block];
  HOOKE_ASSERT(at.lane < block.count);
  move_impulses(block, at.lane, Real(1), bodies);
  make_room(manifolds[at.manifold].point_count, block);
  const Real pushed = block.pushed[at.lane];
  wide::ContactSource source;
  source.manifolds = manifolds.data();
  source.scale = bodies.scale.data();
  for (int lane = at.lane; lane < end_of(block, at.lane); ++lane) {
    fill_lane(at.manifold, contacts.colors, bodies, lane, source, block);
    wide::compute_contact_lane_scalar(source, lane, block);
    bring_to_start(bodies, time, lane, block);
    block.pushed[lane] = pushed;
  }
  move_impulses(block, at.lane, Real(-1), bodies);
}

void store_friction(const ContactBlock& block, int lane, Manifold& m) {
  const Vec3 t_1 = vector_of(block.tangent, lane);
  const Vec3 friction = block.friction_impulse[0][lane] * t_1 +
                        block.friction_impulse[1][lane] * cross(vector_of(block.normal, lane), t_1);
  m.friction_impulse = (is_swapped(m, block, lane) ? Real(-1) : Real(1)) * friction;
  m.twist_impulse = block.twist_impulse[lane];
}

}  // namespace

Vec3 free_acceleration(const Bodies& bodies, std::uint32_t row, Vec3 gravity) {
  if (!is_moved(bodies, row)) return {};
  return bodies.traits[row].gravity_scale * gravity + bodies.motion[row].inverse_mass * bodies.force[row];
}

ContactSoftness contact_softness(const ContactStep& step, bool anchored) {
  const Real limit = Real(1) / ((step.sweeps > 1 ? Real(4) : Real(8)) * step.h);
  const Real frequency = std::min(step.hz, limit) * (anchored ? Real(2) : Real(1));
  const Real zeta = step.damping_ratio * (anchored ? Real(0.5) : Real(1));
  const Real omega = Real(2) * std::numbers::pi_v<Real> * frequency;
  const Real a_1 = Real(2) * zeta + step.h * omega;
  const Real a_2 = step.h * omega * a_1;
  const Real gamma = Real(1) / (Real(1) + a_2);
  const Real mu = a_2 * gamma;
  return {.rate = mu * omega / a_1, .mass_scale = mu, .impulse_scale = gamma};
}

void prepare_body_contacts(parallel::ThreadPool& pool, const std::vector<Manifold>& manifolds, Bodies& bodies,
                           const ContactStep& step, BodyContacts& contacts) {
  color_contacts(manifolds, bodies, contacts.colors);
  lay_out_blocks(manifolds, contacts);
  for_ranges(pool, static_cast<int>(contacts.blocks.size()), kFillGrain, [&](Range range) {
    for (int i = range.begin; i < range.end; ++i) fill_block(i, manifolds, bodies, step, contacts);
  });
  for (int color = 0; color < contacts.color_count(); ++color) {
    const int first = contacts.color_begin[color];
    for_ranges(pool, contacts.color_begin[color + 1] - first, kWarmGrain, [&](Range range) {
      const Range blocks = {first + range.begin, first + range.end};
      // accelerate_bodies repeats these impulses. Coupled groups carry those of their contacts over
      // themselves.
      wide::warm_start_contacts(blocks_up_to(state::ContactRoute::kDirect, contacts, blocks),
                                bodies.free_motion.data());
      for (const ContactBlock& block : blocks_of(contacts, blocks))
        warm_start_rolling(contacts, block, bodies);
    });
  }
}

void solve_body_contacts(Range blocks, const ContactStep& step, BodyContacts& contacts, Bodies& bodies) {
  const std::span<ContactBlock> all = soft_blocks_of(contacts, blocks);
  const auto middle =
      std::find_if(all.begin(), all.end(), [](const ContactBlock& block) { return block.anchored; });
  const auto pairs = static_cast<std::size_t>(middle - all.begin());
  HOOKE_ASSERT(std::all_of(middle, all.end(), [](const ContactBlock& block) { return block.anchored; }));
  const auto pass = [&](bool anchored) {
    return wide::ContactPass{.softness = contact_softness(step, anchored),
                             .inverse_h = Real(1) / step.h,
                             .friction = step.friction_in_bias};
  };
  wide::solve_contacts(all.first(pairs), pass(false), bodies.motion.data());
  wide::solve_contacts(all.subspan(pairs), pass(true), bodies.motion.data());
}

void relax_body_contacts(Range blocks, const ContactStep& step, BodyContacts& contacts, Bodies& bodies) {
  const std::span<ContactBlock> all = blocks_of(contacts, blocks);
  for (const ContactBlock& block : all) {
    for (int i = 0; i < block.rolling_count; ++i)
      roll(block, contacts.rolling[block.first_rolling + i], bodies);
  }
  // What approaches and will bounce in the next substep must not be slower by then.
  const wide::ContactPass pass = {
      .softness = {}, .inverse_h = Real(1) / step.h, .foresees = false, .friction = true};
  wide::solve_contacts(soft_blocks_of(contacts, blocks), pass, bodies.motion.data());
}

void store_lanes(std::span<const ContactLane> lanes, const BodyContacts& contacts,
                 std::vector<Manifold>& manifolds) {
  for (const auto& [index, lane, row] : lanes) {
    const ContactBlock& block = contacts.blocks[index];
    Manifold& m = manifolds[row];
    if (m.route == state::ContactRoute::kDirect) continue;
    HOOKE_ASSERT(lane < block.count && contacts.manifold_of[kContactLanes * index + lane] == row);
    const int count = std::min(m.point_count, block.point_count);
    for (int k = 0; k < count; ++k) m.point[k].normal_impulse = block.point[k].impulse[lane];
    store_friction(block, lane, m);
  }
}

void drop_warm_start(const ContactLane& at, const std::vector<Manifold>& manifolds, BodyContacts& contacts,
                     Bodies& bodies) {
  ContactBlock& block = contacts.blocks[at.block];
  if (manifolds[at.manifold].route != state::ContactRoute::kSoft) return;
  for_impulses(block, at.lane, [&](std::uint32_t body, Vec3 v, Vec3 turn) {
    bodies.motion[body].v -= v;
    bodies.motion[body].omega_scaled -= turn;
  });
  for (int lane = at.lane; lane < end_of(block, at.lane); ++lane) {
    for (int k = 0; k < block.point_count; ++k) block.point[k].impulse[lane] = Real(0);
    block.friction_impulse[0][lane] = Real(0);
    block.friction_impulse[1][lane] = Real(0);
    block.twist_impulse[lane] = Real(0);
  }
}

void refill_lanes(std::span<const ContactLane> lanes, const std::vector<Manifold>& manifolds, Real time,
                  Bodies& bodies, BodyContacts& contacts) {
  for (const ContactLane& lane : lanes) {
    if (manifolds[lane.manifold].route != state::ContactRoute::kDirect)
      refill_lane(lane, manifolds, time, bodies, contacts);
  }
}

void store_body_contacts(Range blocks, const BodyContacts& contacts, std::vector<Manifold>& manifolds) {
  HOOKE_ASSERT(blocks.begin >= 0 && blocks.end <= static_cast<int>(contacts.blocks.size()));
  for (int index = blocks.begin; index < blocks.end; ++index) {
    const ContactBlock& block = contacts.blocks[index];
    const std::size_t first = static_cast<std::size_t>(kContactLanes) * index;
    for (int lane = 0; lane < block.count; ++lane) {
      Manifold& m = manifolds[contacts.manifold_of[first + lane]];
      m.largest_impulse = block.pushed[lane];
      const int count = std::min(m.point_count, block.point_count);
      for (int k = 0; k < count; ++k) m.point[k].normal_impulse = block.point[k].impulse[lane];
      m.touching = block.pushed[lane] > Real(0);
      store_friction(block, lane, m);
    }
    for (int i = 0; i < block.rolling_count; ++i) {
      const RollingRow& row = contacts.rolling[block.first_rolling + i];
      Manifold& m = manifolds[contacts.manifold_of[first + row.lane]];
      m.rolling_impulse = is_swapped(m, block, row.lane) ? -row.impulse : row.impulse;
    }
  }
}

}  // namespace hooke::solver
