#pragma once

#include "hooke/math.h"

#include "base/assert.h"
#include "solver/contact/body_contacts.h"
#include "solver/contact/contact_tuning.h"
#include "state/bodies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// \file
/// Rows of contacts that are solved as a whole: rigid, with friction, in double. A direct island has these
/// rows alone (solver/contact/direct_contacts.h), a coupled group has them beside hooks and ropes
/// (solver/coupled/coupled_groups.h).
///
/// With u the velocities of a substep, a row answers its rate by the impulse -phi', where phi is convex:
///
///   point      impulse = max(0, before - D (rate + s/h if apart, s > slop))
///   friction   impulse = before - D rate, cut to the disc of radius mu N
///   twist      the same, cut to an interval
///
/// D is large (kDirectStiffness effective masses) and `before` is the impulse of the last substep, so that D
/// is no compliance at rest: what stands, stands still. N is the load of the solution before; where something
/// slides, it is solved again with the new load.
///
/// Sources: Newton for piecewise quadratic energies of contact, e.g. Todorov 2014, "Convex and analytically
/// invertible dynamics"; multipliers kept from step to step: Hestenes 1969, "Multiplier and gradient
/// methods".

namespace hooke::solver {

/// What a row does to the velocities of one body, or to those of a node. Nodes use the scaled coordinates of
/// state/bodies.h with v / sqrt(w) in place of v, so that masses are one.
using DirectLever = std::array<double, 6>;

struct DirectRow {
  DirectLever a = {};      ///< Signed: the rate of the row is a.u_a + b.u_b + drift.
  DirectLever b = {};      ///< If B does not move: for its v and omega as they are.
  double mass = 0;         ///< Effective mass [kg or kg m^2].
  double stiffness = 0;    ///< D: impulse per rate [kg or kg m^2].
  double separation = 0;   ///< Separation of a point, at the start of the step [m].
  double twist_lever = 0;  ///< Largest twist impulse per impulse of a point [m].
  double drift = 0;        ///< Rate by bodies that do not move, conveyors, and gaps that may close [m/s].
  double before = 0;       ///< Impulse that the solution starts from [N s].
  double impulse = 0;      ///< [N s]
  double rate = 0;         ///< Rate at the present velocities.
  double slope = 0;        ///< Change of the rate along the present search direction.
  bool touches = false;    ///< The point has no gap.
  bool holds = false;      ///< Its impulse follows its rate: it is at no bound.
};

/// A manifold: rows of its points, then two of friction, then twist.
struct DirectContact {
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  static constexpr int kFrictionRows = 3;  ///< Rows behind those of the points.

  int block = 0, lane = 0;         ///< Its lane of BodyContacts.
  std::uint32_t a = 0, b = kNone;  ///< Nodes; b is kNone where only A moves.
  int first = 0;                   ///< Index of its first row.
  int points = 0;
  double slop = 0;         ///< Overlap, or gap, that counts as none [m].
  double friction = 0;     ///< Coefficient, of rest or of sliding.
  double limit = 0;        ///< Largest friction impulse [N s].
  double twist_limit = 0;  ///< [N m s]
  // Blocks of a direct island's matrix, by their first number.
  std::uint32_t diagonal_a = 0, diagonal_b = 0, between = 0;
  bool b_is_row = false;  ///< In the block between: b comes after a in the order of elimination.

  [[nodiscard]] int end() const { return first + points + kFrictionRows; }
  [[nodiscard]] bool has_b() const { return b != kNone; }
};

struct DirectRows {
  std::vector<DirectContact> contacts;
  std::vector<DirectRow> rows;

  [[nodiscard]] std::span<DirectRow> rows_of(const DirectContact& c) {
    HOOKE_ASSERT(static_cast<std::size_t>(c.end()) <= rows.size());
    return {&rows[c.first], static_cast<std::size_t>(c.end() - c.first)};
  }
  [[nodiscard]] const DirectRow* friction_of(const DirectContact& c) const {
    return &rows[c.first + c.points];
  }
};

/// Friction that slides also resists across its slip, by the row of friction in that direction.
struct SlidingRow {
  DirectLever a = {}, b = {};
  double x = 0, y = 0;   ///< The direction, in those of the two rows of friction.
  double stiffness = 0;  ///< 0 if nothing slides.
};

/// Which rows are assumed to hold before anything is known.
enum class Guess : std::uint8_t {
  kSame,  ///< What held in the last substep; in a new contact, all rows.
  kAll,   ///< Points without a gap, and all friction.
};

[[nodiscard]] inline double product(const DirectLever& j, const double* u) {
  double sum = 0;
  for (std::size_t i = 0; i < j.size(); ++i) sum += j[i] * u[i];
  return sum;
}

inline void add_lever(double impulse, const DirectLever& j, double* u) {
  for (std::size_t i = 0; i < j.size(); ++i) u[i] += impulse * j[i];
}

/// scale times the linear half, and sign times the angular one.
[[nodiscard]] DirectLever scaled_lever(double scale, Vec3 linear, double sign, Vec3 angular);

/// Rate of a row at the velocities u, without drift.
[[nodiscard]] inline double rate_of(const DirectContact& c, const DirectRow& row,
                                    const std::vector<double>& u) {
  const double rate = product(row.a, &u[6 * c.a]);
  return c.has_b() ? rate + product(row.b, &u[6 * c.b]) : rate;
}

/// Number of points that a lane has.
[[nodiscard]] int count_points(const ContactBlock& block, int lane);

/// Adds a contact, whose lane, nodes and number of points are known, with its rows.
void add_contact(const ContactBlock& block, const state::Bodies& bodies, DirectContact contact,
                 DirectRows& rows);

/// Lets rows begin with the impulses that their lanes have.
void load_impulses(const BodyContacts& contacts, DirectRows& rows);

/// Loads what conveyors and moving walls do. Friction goes on with the sliding coefficient where it slid in
/// the last substep.
void load_drifts(const BodyContacts& contacts, const state::Bodies& bodies, DirectRows& rows);

/// Points that are apart may close their gap in the substep, of length h [s]. `displacement` is that since
/// the start of the step, six numbers a node.
void open_gaps(double h, const BodyContacts& contacts, const state::Bodies& bodies,
               const std::vector<double>& displacement, DirectRows& rows);

/// Gives rows that stiffness over their effective masses, and their impulses of the last substep.
void set_stiffness(double stiffness, DirectRows& rows);

/// Finds the rates of all rows at the velocities u.
void find_rates(const std::vector<double>& u, DirectRows& rows);

/// Adds what the impulses of a contact do.
inline void add_impulses(const DirectRows& rows, const DirectContact& c, double DirectRow::*impulse,
                         std::vector<double>& u) {
  for (int i = c.first; i < c.end(); ++i) {
    const DirectRow& row = rows.rows[i];
    add_lever(row.*impulse, row.a, &u[6 * c.a]);
    if (c.has_b()) add_lever(row.*impulse, row.b, &u[6 * c.b]);
  }
}

/// Sets the impulses of a contact at rate + t slope, and which rows are not at their bounds then.
inline void respond(double t, const DirectContact& c, std::vector<DirectRow>& rows) {
  const auto wish = [&](const DirectRow& row) {
    return row.before - row.stiffness * (row.rate + t * row.slope);
  };
  for (int i = c.first; i < c.first + c.points; ++i) {
    rows[i].impulse = std::max(0.0, wish(rows[i]));
    rows[i].holds = rows[i].impulse > 0;
  }
  DirectRow* friction = &rows[c.first + c.points];
  const double x = wish(friction[0]);
  const double y = wish(friction[1]);
  const double size = std::sqrt(x * x + y * y);
  const double shrink = size > c.limit ? c.limit / size : 1;
  friction[0].impulse = shrink * x;
  friction[1].impulse = shrink * y;
  friction[0].holds = friction[1].holds = !(size > c.limit);
  const double twist = wish(friction[2]);
  friction[2].impulse = std::clamp(twist, -c.twist_limit, c.twist_limit);
  friction[2].holds = std::abs(twist) < c.twist_limit;
}

/// The share of a search direction where a convex energy is least; climb(t) is how fast it grows after a
/// share t.
template <class Climb>
[[nodiscard]] double find_least(Climb&& climb) {
  const double start = climb(0.0);
  if (climb(1.0) <= kDirectSearchTolerance * std::abs(start)) return 1;
  double low = 0;
  double high = 1;
  for (int i = 0; i < kDirectSearchSteps; ++i) {
    const double middle = 0.5 * (low + high);
    (climb(middle) > 0 ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

/// The row across the slip of a contact, at the present rates.
[[nodiscard]] SlidingRow sliding_row(const DirectContact& c, const DirectRows& rows);

void guess_rows(Guess guess, DirectRows& rows);

/// Sets limits of friction by the loads that were found. True if something slides whose load has changed.
bool limit_friction(DirectRows& rows);

}  // namespace hooke::solver
