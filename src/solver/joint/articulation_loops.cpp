#include "base/assert.h"
#include "solver/joint/articulation_links.h"
#include "solver/joint/joint_energy.h"
#include "solver/joint/joint_tuning.h"

#include <span>

namespace hooke::solver {

namespace {

double sign_at(const Articulation::Joint& joint, std::uint32_t link) {
  return link == joint.a ? -1 : 1;
}

const DVec3& lever_at(const Articulation::Joint& joint, std::uint32_t link, const JointRow& row) {
  return link == joint.a ? row.j_a : row.j_b;
}

/// Sets the impulses of springs beside motors. A motor that is at no bound holds the velocity along its axis,
/// which gives the impulse of the spring there.
void give_springs(Articulation& art) {
  for (const Articulation::Joint& joint : art.joints) {
    for (int i = joint.first; i + 1 < joint.first + joint.count; ++i) {
      const JointRow& spring = art.rows[i];
      const JointRow& motor = art.rows[i + 1];
      if (spring.role != RowRole::kSpring || motor.role != RowRole::kMotor) continue;
      if (!(spring.n == motor.n) || !(spring.axis == motor.axis)) continue;
      art.bound[i] = art.bound[i + 1] == 0 ? Articulation::kGiven : std::int8_t{0};
      if (art.bound[i] != 0) art.lambda[i] = (spring.target - motor.target) / spring.gamma;
    }
  }
}

/// Lists the rows that are at no bound, those of a joint column by column.
void list_free_rows(Articulation& art) {
  art.blocks.free.clear();
  art.blocks.free_sizes.clear();
  art.blocks.columns.clear();
  for (const Articulation::Joint& joint : art.joints) {
    const std::size_t begin = art.blocks.free.size();
    for (int i = joint.first; i < joint.first + joint.count; ++i) {
      if (art.bound[i] == 0) art.blocks.free.push_back(i);
    }
    const auto rows = std::span(art.blocks.free).subspan(begin);
    art.blocks.free_sizes.push_back(static_cast<int>(rows.size()));
    for (const auto member : {&JointRow::n, &JointRow::j_a, &JointRow::j_b}) {
      for (const auto axis : {&DVec3::x, &DVec3::y, &DVec3::z}) {
        for (const int i : rows) art.blocks.columns.push_back(art.rows[i].*member.*axis);
      }
    }
  }
  HOOKE_ASSERT(art.blocks.columns.size() == 9 * art.blocks.free.size());
  resize_blocks(art.blocks.free_sizes, art.blocks.pattern);
}

/// Adds the part of a link to the block of two joints' rows.
void add_coupling(const Articulation::Coupling& coupling, Articulation& art) {
  const BlockPattern::Block& block = art.blocks.pattern.block[coupling.block];
  const Articulation::Joint& left = art.joints[block.row];
  const Articulation::Joint& right = art.joints[block.column];
  const Link& link = art.links[coupling.link];
  HOOKE_ASSERT(coupling.link == left.a || coupling.link == left.b);
  HOOKE_ASSERT(coupling.link == right.a || coupling.link == right.b);
  const double sign = sign_at(left, coupling.link) * sign_at(right, coupling.link);
  const int* rows = art.blocks.free.data() + art.blocks.pattern.first[block.row];
  const auto count = static_cast<std::size_t>(art.blocks.free_sizes[block.column]);
  const double* n =
      art.blocks.columns.data() + 9 * static_cast<std::size_t>(art.blocks.pattern.first[block.column]);
  const double* j = n + (coupling.link == right.a ? 3 : 6) * count;
  double* to = art.blocks.factors.data() + block.offset;
  for (int r = 0; r < art.blocks.free_sizes[block.row]; ++r) {
    const JointRow& row = art.rows[rows[r]];
    const DVec3 v = sign * link.body.inverse_mass * row.n;
    const DVec3 w = sign * (link.response * lever_at(left, coupling.link, row));
    for (std::size_t c = 0; c < count; ++c) {
      to[c] += (v.x * n[c] + v.y * n[count + c] + v.z * n[2 * count + c]) +
               (w.x * j[c] + w.y * j[count + c] + w.z * j[2 * count + c]);
    }
    to += count;
  }
}

/// Assembles J M^-1 J^T + gamma of the free rows: impulses at bounds are in the velocities already.
void assemble(Articulation& art) {
  art.blocks.factors.assign(art.blocks.pattern.number_count, 0.0);
  art.blocks.compliance.clear();
  for (const Articulation::Coupling& coupling : art.blocks.couplings) add_coupling(coupling, art);
  for (int i = 0; i < art.blocks.pattern.node_count(); ++i) {
    const BlockPattern::Block& block = art.blocks.pattern.block[art.blocks.pattern.column_begin[i]];
    const int n = art.blocks.free_sizes[i];
    for (int r = 0; r < n; ++r) {
      double& number = art.blocks.factors[block.offset + static_cast<std::size_t>(r * (n + 1))];
      const double compliance = kLoopCompliance * number;
      art.blocks.compliance.push_back(compliance);
      number += art.rows[art.blocks.free[art.blocks.pattern.first[i] + r]].gamma + compliance;
    }
  }
}

/// What a row lacks to reach its target at the present velocities, without gamma lambda.
double shortfall(const Articulation& art, const Articulation::Joint& joint, const JointRow& row) {
  const Link& a = art.links[joint.a];
  const Link& b = art.links[joint.b];
  return row.target - dot(row.n, b.v - a.v) - dot(row.j_b, b.omega_scaled) + dot(row.j_a, a.omega_scaled);
}

void solve_free_rows(Articulation& art) {
  for (std::size_t i = 0; i < art.rows.size(); ++i) {
    art.lambda[i] = art.bound[i] < 0 ? art.rows[i].low : art.bound[i] > 0 ? art.rows[i].high : 0;
  }
  give_springs(art);
  reset_velocities(art);
  apply_rows([&](int i) { return art.bound[i] != 0; }, art);
  list_free_rows(art);
  assemble(art);
  art.blocks.right_side.clear();
  for (const Articulation::Joint& joint : art.joints) {
    for (int i = joint.first; i < joint.first + joint.count; ++i) {
      if (art.bound[i] == 0) art.blocks.right_side.push_back(shortfall(art, joint, art.rows[i]));
    }
  }
  HOOKE_ASSERT(art.blocks.right_side.size() == art.blocks.free.size());
  factor(art.blocks.pattern, art.blocks.factors, art.blocks.factor_scratch);
  solve(art.blocks.pattern, art.blocks.factors, art.blocks.right_side);
  // Rows that say the same twice, as two hinges of a door, never say quite the same: the difference over the
  // compliance is a force without a cause, kilonewtons from roundings.
  remove_unfelt(art.blocks.pattern, art.blocks.factors, art.blocks.compliance, art.blocks.right_side,
                art.blocks.unfelt);
  for (std::size_t k = 0; k < art.blocks.free.size(); ++k)
    art.lambda[art.blocks.free[k]] = art.blocks.right_side[k];
  apply_rows([&](int i) { return art.bound[i] == 0; }, art);
}

/// Rows beyond a bound go to it. Rows that the bound holds back are let go if `release`. True if any changed.
bool revise_bounds(bool release, Articulation& art) {
  bool changed = false;
  for (const Articulation::Joint& joint : art.joints) {
    for (int i = joint.first; i < joint.first + joint.count; ++i) {
      const JointRow& row = art.rows[i];
      std::int8_t bound = 0;
      if (art.bound[i] == Articulation::kGiven) continue;
      if (art.bound[i] == 0) {
        bound = side_of(art.lambda[i], row.low, row.high);
      } else if (!release) {
        continue;
      } else {
        const double lacks = shortfall(art, joint, row) - row.gamma * art.lambda[i];
        bound = stays_at(art.bound[i], lacks) ? art.bound[i] : std::int8_t{0};
      }
      changed = changed || bound != art.bound[i];
      art.bound[i] = bound;
    }
  }
  return changed;
}

void solve_with_bounds(Articulation& art) {
  bool changed = true;
  for (int pass = 0; changed && pass < kMostBoundPasses; ++pass) {
    solve_free_rows(art);
    changed = revise_bounds(pass < kFreeBoundPasses, art);
  }
  if (!changed) return;
  clamp_impulses(art);
}

/// How fast the value of a row changes, with the velocities `v` and `omega` of its links.
template <class V, class Omega>
double rate_of(const JointRow& row, const Link& a, const Link& b, V&& v, Omega&& omega) {
  return dot(row.n, v(b) - v(a)) + dot(row.j_b, omega(b)) - dot(row.j_a, omega(a));
}

JointWork work_of(double h, const Articulation& art, const Articulation::Joint& joint) {
  const Link& a = art.links[joint.a];
  const Link& b = art.links[joint.b];
  const auto moves = [](const Link& link) { return link.body.inverse_mass > 0; };
  const auto v = [](const Link& link) { return link.v; };
  const auto omega = [](const Link& link) { return link.omega_scaled; };
  const auto mean_v = [&](const Link& link) { return 0.5 * (link.body.v + link.v); };
  const auto mean_omega = [&](const Link& link) {
    return 0.5 * (link.body.omega_scaled + link.omega_scaled);
  };
  const auto told_v = [&](const Link& link) { return moves(link) ? DVec3{} : link.v; };
  const auto told_omega = [&](const Link& link) { return moves(link) ? DVec3{} : link.omega_scaled; };
  JointWork sum;
  for (int i = joint.first; i < joint.first + joint.count; ++i) {
    const JointRow& row = art.rows[i];
    if (row.role == RowRole::kSpring && row.rate > 0) {
      sum.add_spring(row.rate / (h * row.gamma), row.start,
                     h * rate_of(row, a, b, v, omega) - row.target / row.rate);
    }
    if (row.role == RowRole::kMotor) sum.work += art.lambda[i] * rate_of(row, a, b, mean_v, mean_omega);
    sum.work -= art.lambda[i] * rate_of(row, a, b, told_v, told_omega);
  }
  return sum;
}

}  // namespace

void solve_loops(double h, Articulation& art, JointTables tables) {
  HOOKE_ASSERT(h > 0 && art.has_loops());
  begin_articulation(h, tables, art);
  for (int i = 0; i < kMostArticulationSolves; ++i) {
    solve_with_bounds(art);
    if (!begin_next_solution(h, tables, art)) break;
  }
  const bool far = turns_farther(kEnergyAccountTurn, h, art) ||
                   lines_turn_farther(kEnergyAccountTurn, h, tables.hooks, art);
  const BodySums before = far ? sum_bodies(art, tables.bodies) : BodySums{};
  store_velocities(art, tables.bodies);
  if (!far) return reset_energy(art, tables.hooks);
  balance_energy(before, art, tables, [&](std::size_t i) { return work_of(h, art, art.joints[i]); });
}

}  // namespace hooke::solver
