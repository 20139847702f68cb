#include "solver/contact/direct_rows.h"

#include "solver/contact/contact_tuning.h"

#include <algorithm>
#include <cmath>

namespace hooke::solver {

namespace {

using state::Bodies;

/// Makes the rows of one manifold from its lane.
struct DirectRowMaker {
  const ContactBlock& block;
  int lane;
  double root_a, root_b;  ///< Roots of the inverse masses; 1 for a body that does not move.

  [[nodiscard]] DirectRow row(Vec3 direction, Vec3 j_a, Vec3 j_b) const {
    DirectRow made = {.a = scaled_lever(-root_a, direction, -1, j_a),
                      .b = scaled_lever(root_b, direction, 1, j_b)};
    const double on_b = block.anchored ? 0 : product(made.b, made.b.data());
    const double inverse = product(made.a, made.a.data()) + on_b;
    made.mass = inverse > 0 ? 1 / inverse : 0;
    return made;
  }

  [[nodiscard]] DirectRow point(int k) const {
    const ContactBlock::Point& p = block.point[k];
    DirectRow made = row(vector_of(block.normal, lane), vector_of(p.j_a, lane), vector_of(p.j_b, lane));
    made.separation = static_cast<double>(p.separation[lane]);
    made.twist_lever = static_cast<double>(block.twist_lever[k][lane]);
    return made;
  }

  [[nodiscard]] DirectRow friction(int i) const {
    const Vec3 t_1 = vector_of(block.tangent, lane);
    const Vec3 t = i == 0 ? t_1 : cross(vector_of(block.normal, lane), t_1);
    return row(t, vector_of(block.friction_j_a[i], lane), vector_of(block.friction_j_b[i], lane));
  }

  [[nodiscard]] DirectRow twist() const {
    return row({}, vector_of(block.twist_j_a, lane), vector_of(block.twist_j_b, lane));
  }
};

/// Loads what conveyors and moving walls do to the rows of a contact.
void load_drift(const ContactBlock& block, const Bodies& bodies, const DirectContact& c,
                std::span<DirectRow> rows) {
  for (DirectRow& row : rows) row.drift = 0;
  const std::span<DirectRow> friction = rows.subspan(static_cast<std::size_t>(c.points));
  for (std::size_t i = 0; i < 2; ++i) friction[i].drift = static_cast<double>(block.surface_speed[i][c.lane]);
  if (c.has_b()) return;
  const state::MotionRecord& still = bodies.motion[block.record_b[c.lane] / 16];
  const DirectLever velocity = scaled_lever(1, still.v, 1, still.omega_scaled);
  for (DirectRow& row : rows) row.drift += product(row.b, velocity.data());
}

/// Friction goes on with the sliding coefficient where it slid in the last substep.
void choose_friction(const ContactBlock& block, DirectRows& of, DirectContact& c) {
  const double slow = static_cast<double>(block.static_friction[c.lane]);
  const double fast = static_cast<double>(block.friction[c.lane]);
  double load = 0;
  for (int i = c.first; i < c.first + c.points; ++i) load += of.rows[i].before;
  const DirectRow* friction = of.friction_of(c);
  const double size =
      std::sqrt(friction[0].before * friction[0].before + friction[1].before * friction[1].before);
  const bool slid = size >= kDirectSticking * slow * load ||
                    std::abs(size - fast * load) <= (1 - kDirectSticking) * fast * load;
  c.friction = slid ? fast : slow;
}

}  // namespace

DirectLever scaled_lever(double scale, Vec3 linear, double sign, Vec3 angular) {
  const auto d = [](Real x) { return static_cast<double>(x); };
  return {scale * d(linear.x), scale * d(linear.y), scale * d(linear.z),
          sign * d(angular.x), sign * d(angular.y), sign * d(angular.z)};
}

int count_points(const ContactBlock& block, int lane) {
  int points = 0;
  while (points < block.point_count && block.point[points].mass[lane] > Real(0)) ++points;
  return points;
}

void add_contact(const ContactBlock& block, const Bodies& bodies, DirectContact contact, DirectRows& rows) {
  const auto root = [](Real w) { return std::sqrt(static_cast<double>(w)); };
  const int lane = contact.lane;
  HOOKE_ASSERT(!block.is_soft() && lane < block.count && contact.points <= block.point_count);
  const DirectRowMaker make = {block, lane, root(block.w_a[lane]),
                               block.anchored ? 1.0 : root(block.w_b[lane])};
  contact.first = static_cast<int>(rows.rows.size());
  for (int k = 0; k < contact.points; ++k) rows.rows.push_back(make.point(k));
  rows.rows.push_back(make.friction(0));
  rows.rows.push_back(make.friction(1));
  rows.rows.push_back(make.twist());
  const Real radius_a = bodies.traits[block.record_a[lane] / 16].radius;
  const Real radius =
      block.anchored ? radius_a : std::min(radius_a, bodies.traits[block.record_b[lane] / 16].radius);
  contact.slop = kDirectSlop * static_cast<double>(radius);
  rows.contacts.push_back(contact);
}

void load_impulses(const BodyContacts& contacts, DirectRows& rows) {
  for (const DirectContact& c : rows.contacts) {
    const ContactBlock& block = contacts.blocks[c.block];
    DirectRow* row = &rows.rows[c.first];
    for (int k = 0; k < c.points; ++k) (row++)->before = static_cast<double>(block.point[k].impulse[c.lane]);
    for (const ContactBlock::Lane& friction : block.friction_impulse)
      (row++)->before = static_cast<double>(friction[c.lane]);
    row->before = static_cast<double>(block.twist_impulse[c.lane]);
  }
}

void load_drifts(const BodyContacts& contacts, const Bodies& bodies, DirectRows& rows) {
  for (DirectContact& c : rows.contacts) {
    load_drift(contacts.blocks[c.block], bodies, c, rows.rows_of(c));
    choose_friction(contacts.blocks[c.block], rows, c);
  }
}

void open_gaps(double h, const BodyContacts& contacts, const Bodies& bodies,
               const std::vector<double>& displacement, DirectRows& of) {
  for (const DirectContact& c : of.contacts) {
    DirectLever still = {};
    if (!c.has_b()) {
      const state::MotionRecord& m = bodies.motion[contacts.blocks[c.block].record_b[c.lane] / 16];
      still = scaled_lever(1, m.dx, 1, m.theta_scaled);
    }
    for (int i = c.first; i < c.first + c.points; ++i) {
      DirectRow& row = of.rows[i];
      double s = row.separation + rate_of(c, row, displacement);
      if (!c.has_b()) s += product(row.b, still.data());
      row.touches = !(s > c.slop);
      if (!row.touches) row.drift += s / h;
    }
  }
}

void set_stiffness(double stiffness, DirectRows& rows) {
  for (DirectRow& row : rows.rows) {
    row.stiffness = stiffness * row.mass;
    row.impulse = row.before;
    row.slope = 0;
  }
}

void find_rates(const std::vector<double>& u, DirectRows& rows) {
  for (const DirectContact& c : rows.contacts) {
    for (DirectRow& row : rows.rows_of(c)) row.rate = rate_of(c, row, u) + row.drift;
  }
}

SlidingRow sliding_row(const DirectContact& c, const DirectRows& rows) {
  const DirectRow& x = rows.friction_of(c)[0];
  const DirectRow& y = rows.friction_of(c)[1];
  const double wish_x = x.before - x.stiffness * x.rate;
  const double wish_y = y.before - y.stiffness * y.rate;
  const double size = std::sqrt(wish_x * wish_x + wish_y * wish_y);
  if (x.holds || !(size > 0)) return {};
  SlidingRow row = {.x = -wish_y / size, .y = wish_x / size, .stiffness = x.stiffness * c.limit / size};
  for (std::size_t i = 0; i < row.a.size(); ++i) {
    row.a[i] = (wish_x * y.a[i] - wish_y * x.a[i]) / size;
    row.b[i] = (wish_x * y.b[i] - wish_y * x.b[i]) / size;
  }
  return row;
}

void guess_rows(Guess guess, DirectRows& of) {
  for (const DirectContact& c : of.contacts) {
    const bool all = guess == Guess::kAll || !(c.limit > 0);
    for (DirectRow& row : of.rows_of(c)) row.holds = row.before > 0 || (all && row.touches);
    DirectRow* friction = &of.rows[c.first + c.points];
    const double size =
        std::sqrt(friction[0].before * friction[0].before + friction[1].before * friction[1].before);
    friction[0].holds = friction[1].holds = all || size < kDirectSticking * c.limit;
    friction[2].holds = all || std::abs(friction[2].before) < kDirectSticking * c.twist_limit;
  }
}

bool limit_friction(DirectRows& of) {
  bool changed = false;
  for (DirectContact& c : of.contacts) {
    double load = 0;
    double twist_limit = 0;
    for (int i = c.first; i < c.first + c.points; ++i) {
      load += of.rows[i].impulse;
      twist_limit += of.rows[i].impulse * of.rows[i].twist_lever;
    }
    const double limit = load * c.friction;
    const DirectRow* friction = &of.rows[c.first + c.points];
    const double size =
        std::sqrt(friction[0].impulse * friction[0].impulse + friction[1].impulse * friction[1].impulse);
    const auto moved = [](double used, double old, double now) {
      return used > std::min(kDirectSticking * old, now) &&
             std::abs(now - old) > kDirectSameLoad * std::max(now, old);
    };
    changed = changed || moved(size, c.limit, limit) ||
              moved(std::abs(friction[2].impulse), c.twist_limit, twist_limit);
    c.limit = limit;
    c.twist_limit = twist_limit;
  }
  return changed;
}

}  // namespace hooke::solver
