/// The matrix of a coupled group and its right side. Equations: solver/coupled/coupled_groups.h.

#include "base/assert.h"
#include "solver/coupled/coupled_group_solution.h"
#include "solver/coupled/coupled_tuning.h"
#include "solver/joint_rows/geometric_stiffness.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace hooke::solver {

namespace {

using math::Symmetric3;
using Incident = CoupledGroup::Incident;

std::array<double, 9> entries_of(const Symmetric3<double>& m) {
  return {m.xx, m.xy, m.xz, m.xy, m.yy, m.yz, m.xz, m.yz, m.zz};
}

BodyRow row_along(DVec3 n, DVec3 lever, const JointBody& body) {
  return {std::sqrt(body.inverse_mass) * n, body.scale * cross(lever, n)};
}

/// Column m of the Jacobian at `lever`: the velocity there when V_m alone is one.
DVec3 column_at(int m, DVec3 lever, const JointBody& body) {
  return {row_along(kAxes[0], lever, body).at(m), row_along(kAxes[1], lever, body).at(m),
          row_along(kAxes[2], lever, body).at(m)};
}

/// The body of the active contacts of a node, if there is exactly one.
std::optional<int> only_body_of(std::span<const RopeContactRow> at_node) {
  std::optional<int> body;
  for (const RopeContactRow& contact_row : at_node) {
    if (!contact_row.active || contact_row.body < 0) continue;
    if (body && *body != contact_row.body) return std::nullopt;
    body = contact_row.body;
  }
  return body;
}

}  // namespace

void CoupledGroupSolution::assemble_pair(const Incident& a, const Incident& b, std::uint32_t block,
                                         const RopeNode& node) {
  const BlockPattern::Block& at = b_.pattern.block[block];
  const bool a_is_row = b_.slot[a.block] == at.row;
  HOOKE_ASSERT(b_.slot[a_is_row ? b.block : a.block] == at.column &&
               (a_is_row || b_.slot[b.block] == at.row));
  const Incident& row = a_is_row ? a : b;
  const Incident& column = a_is_row ? b : a;
  double* numbers = b_.numbers.data() + at.offset;
  const double weight = row.weight * column.weight;
  const Symmetric3<double>& w = node.inverse;
  if (row.block < vector_count() && column.block < vector_count()) {
    const std::array<double, 9> entries = entries_of(w);
    for (int i = 0; i < 9; ++i) numbers[i] += weight * entries[i];
    return;
  }
  const int width = b_.pattern.size[at.column];
  for (int k = 0; k < width; ++k) {
    const DVec3 moved_by = weight * (w * direction(column.block, k));
    for (int i = 0; i < b_.pattern.size[at.row]; ++i)
      numbers[i * width + k] += dot(direction(row.block, i), moved_by);
  }
}

void CoupledGroupSolution::assemble_pairs() {
  for (std::size_t node = 0; node < b_.ropes.nodes.size(); ++node) {
    const RopeNode& of = b_.ropes.nodes[node];
    if (!(of.w > 0)) continue;
    const std::span<const Incident> at = incidents_of(node);
    std::uint32_t pair = b_.first_pair[node];
    for (std::size_t i = 0; i < at.size(); ++i) {
      for (std::size_t j = 0; j <= i; ++j) assemble_pair(at[i], at[j], b_.pair_block[pair++], of);
    }
  }
}

/// Compliance of a row, as a share of its diagonal.
double CoupledGroupSolution::compliance_of(std::uint32_t hook, const JointRow& row) const {
  if (row.role == RowRole::kMotor) return kMotorCompliance;
  const bool is_joint = hook < b_.hooks.size() && !t_.hooks[b_.hooks[hook]].holds_point();
  return is_joint ? kCoupledJointCompliance : kHookCompliance;
}

void CoupledGroupSolution::assemble_hooks() {
  b_.compliance.assign(b_.right_side.size(), 0);
  for_each_row([&](std::uint32_t hook, std::uint32_t row, int k) {
    const std::uint32_t block = hook_block(hook);
    if (k >= size_of(block)) return;
    double& diagonal = numbers(block, block)(k, k);
    if (b_.bound[row] != 0) {
      diagonal = 1;
      return;
    }
    double mobility = diagonal;  // with what bodies add once they are eliminated
    for (int end = 0; end < 2; ++end) {
      const int body = b_.ends[hook][end];
      if (body < 0) continue;
      const BodyRow c = hook_row(b_.rows[row], end, b_.moving[body].body);
      mobility += dot(c, c);
      const Numbers coupled = numbers(block, body_block(body));
      for (int m = 0; m < 6; ++m) coupled(k, m) += c.at(m);
    }
    const double compliance = compliance_of(hook, b_.rows[row]) * mobility;
    if (hook < b_.hooks.size()) b_.compliance[b_.pattern.first[b_.slot[block]] + k] = compliance;
    diagonal += b_.rows[row].gamma + compliance;
  });
}

void CoupledGroupSolution::assemble_bodies() {
  for (int i = 0; i < static_cast<int>(b_.moving.size()); ++i) {
    const std::array<double, 9> turn =
        entries_of(Symmetric3<double>::diagonal(1) + scaled(1 + kStiffnessDamping, b_.moving[i].excess));
    const Numbers own = numbers(body_block(i), body_block(i));
    for (int k = 0; k < 3; ++k) {
      own(k, k) -= 1;
      for (int m = 0; m < 3; ++m) own(3 + k, 3 + m) -= turn[3 * k + m];
    }
  }
}

/// Adds the contacts of a node without rows that touches one body: -J^T (P - P W P) J on the body's own
/// block, where P is the stiffness of all that body's contacts at the node.
void CoupledGroupSolution::assemble_point(int body, std::span<const RopeContactRow> at_node) {
  Symmetric3<double> stiffness;
  DVec3 lever;  // the same of all: to the particle
  HOOKE_ASSERT(!at_node.empty() && body >= 0 && body < static_cast<int>(b_.moving.size()));
  for (const RopeContactRow& contact_row : at_node) {
    if (!contact_row.active || contact_row.body != body) continue;
    stiffness = stiffness + contact_stiffness(contact_row);
    lever = contact_row.lever;
  }
  const Symmetric3<double>& inverse = b_.ropes.nodes[at_node.front().node].inverse;
  const Symmetric3<double> held = stiffness + scaled(-1, symmetric_product(stiffness, inverse, stiffness));
  std::array<DVec3, 6> columns;
  for (int m = 0; m < 6; ++m) columns[m] = column_at(m, lever, b_.moving[body].body);
  const Numbers own = numbers(body_block(body), body_block(body));
  for (int m = 0; m < 6; ++m) {
    const DVec3 moved = held * columns[m];
    for (int k = 0; k < 6; ++k) own(k, m) -= dot(columns[k], moved);
  }
}

/// R = P J couples the rows at the node to the body, the body to itself and to other bodies that touch the
/// node.
void CoupledGroupSolution::assemble_contact_row(const RopeContactRow& contact_row,
                                                std::span<const RopeContactRow> at_node) {
  const RopeNode& node = b_.ropes.nodes[contact_row.node];
  const Symmetric3<double> stiffness = contact_stiffness(contact_row);
  HOOKE_ASSERT(contact_row.body >= 0 && contact_row.active);
  const JointBody& body = b_.moving[contact_row.body].body;
  const std::uint32_t block = body_block(contact_row.body);
  for (int m = 0; m < 6; ++m) {
    const DVec3 r = stiffness * column_at(m, contact_row.lever, body);
    const DVec3 moved_by = node.inverse * r;
    for (const Incident& at : incidents_of(contact_row.node)) {
      const Numbers coupled = numbers(at.block, block);
      for (int k = 0; k < size_of(at.block); ++k)
        coupled(k, m) += at.weight * dot(direction(at.block, k), moved_by);
    }
    const Numbers own = numbers(block, block);
    for (int k = 0; k < 6; ++k) own(k, m) -= dot(column_at(k, contact_row.lever, body), r);
    for (const RopeContactRow& other : at_node) {
      if (other.body < contact_row.body || !other.active) continue;
      const JointBody& to = b_.moving[other.body].body;
      const DVec3 pushed = contact_stiffness(other) * moved_by;
      const Numbers coupled = numbers(body_block(other.body), block);
      for (int k = 0; k < 6; ++k) coupled(k, m) += dot(column_at(k, other.lever, to), pushed);
    }
  }
}

void CoupledGroupSolution::assemble_contact_rows() {
  for_each_node_in_contact(b_.ropes.contact_rows, [&](std::span<const RopeContactRow> at_node) {
    if (incidents_of(at_node.front().node).empty()) {
      if (const std::optional<int> body = only_body_of(at_node)) {
        assemble_point(*body, at_node);
        return;
      }
    }
    for (const RopeContactRow& contact_row : at_node) {
      if (contact_row.body >= 0 && contact_row.active) assemble_contact_row(contact_row, at_node);
    }
  });
}

/// Rope contacts that do not act have no rows in the matrix, and those without friction have one. Most of
/// those that may act do not.
void CoupledGroupSolution::resize_coupled_contacts() {
  if (b_.rope_contacts.empty()) return;
  b_.sizes.assign(b_.pattern.size.begin(), b_.pattern.size.end());
  for (std::size_t i = b_.hooks.size() + b_.element_contacts.size(); i < b_.ends.size(); ++i) {
    const std::uint32_t first = b_.first_row[i];
    const int held = b_.bound[first + 1] == 0 ? CoupledContact::kRows : 1;
    b_.sizes[b_.slot[hook_block(static_cast<std::uint32_t>(i))]] = b_.bound[first] == 0 ? held : 0;
  }
  resize_blocks(b_.sizes, b_.pattern);
}

void CoupledGroupSolution::assemble() {
  b_.numbers.assign(b_.pattern.number_count, 0);
  assemble_pairs();
  for (std::uint32_t i = 0; i < segment_count(); ++i) {
    const std::array<double, 9> e = entries_of(b_.ropes.segments[i].compliance);
    const Numbers own = numbers(i, i);
    for (int k = 0; k < 9; ++k) own(k / 3, k % 3) += e[k];
  }
  for (std::uint32_t i = 0; i < b_.ropes.bends.size(); ++i) {
    const Numbers own = numbers(bend_block(i), bend_block(i));
    for (int k = 0; k < 3; ++k) own(k, k) += b_.ropes.bends[i].gamma;
  }
  assemble_hooks();
  assemble_bodies();
  assemble_contact_rows();
  assemble_body_contacts();
}

/// Computes (1 + G) V0 of each body.
void CoupledGroupSolution::start_bodies() {
  b_.start.clear();
  for (const CoupledBody& m : b_.moving) {
    b_.start.push_back({(1 / std::sqrt(m.body.inverse_mass)) * m.body.v,
                        m.body.omega_scaled + m.excess * m.body.omega_scaled});
  }
}

/// Rows at a bound apply its impulse, like a force from outside.
void CoupledGroupSolution::give_impulses() {
  for_each_row([&](std::uint32_t hook, std::uint32_t row, int) {
    if (b_.bound[row] == 0 || b_.lambda[row] == 0) return;
    for (int end = 0; end < 2; ++end) {
      const int body = b_.ends[hook][end];
      if (body >= 0) b_.start[body] += b_.lambda[row] * hook_row(b_.rows[row], end, b_.moving[body].body);
    }
  });
  for (std::size_t n = 0; n < b_.ropes.nodes.size(); ++n) {
    RopeNode& node = b_.ropes.nodes[n];
    for (const Incident& at : incidents_of(n)) {
      if (at.block < vector_count()) continue;
      const std::uint32_t hook = at.block - vector_count();
      for (std::uint32_t row = b_.first_row[hook]; row < b_.first_row[hook + 1]; ++row) {
        if (b_.bound[row] != 0 && b_.lambda[row] != 0)
          node.target += node.inverse * ((at.weight * b_.lambda[row]) * b_.rows[row].n);
      }
    }
  }
}

/// Fills the right sides of all rows: what they ask for, less what the nodes do without them.
void CoupledGroupSolution::fill_rows() {
  for (std::size_t n = 0; n < b_.ropes.nodes.size(); ++n) {
    for (const Incident& at : incidents_of(n)) {
      for (int k = 0; k < size_of(at.block); ++k)
        right_side(at.block, k) -= at.weight * dot(direction(at.block, k), b_.ropes.nodes[n].target);
    }
  }
  for (std::uint32_t i = 0; i < segment_count(); ++i) {
    for (int k = 0; k < 3; ++k) right_side(i, k) -= dot(kAxes[k], b_.ropes.segments[i].offset);
  }
  for (std::uint32_t i = 0; i < b_.ropes.bends.size(); ++i) {
    for (int k = 0; k < 3; ++k) right_side(bend_block(i), k) += dot(kAxes[k], b_.ropes.bends[i].target);
  }
  for_each_row([&](std::uint32_t hook, std::uint32_t row, int k) {
    if (b_.bound[row] == 0) right_side(hook_block(hook), k) += b_.rows[row].target;
  });
}

/// Adds to the bodies the impulses of contacts with nodes, without the part that depends on velocities.
void CoupledGroupSolution::push_bodies() {
  for (const RopeContactRow& contact_row : b_.ropes.contact_rows) {
    if (contact_row.body < 0 || !contact_row.active) continue;
    const RopeNode& node = b_.ropes.nodes[contact_row.node];
    const DVec3 on_node =
        push_of(contact_row, h_) + contact_stiffness(contact_row) * (contact_row.belt - node.target);
    const JointBody& body = b_.moving[contact_row.body].body;
    b_.start[contact_row.body] +=
        {-std::sqrt(body.inverse_mass) * on_node, -(body.scale * cross(contact_row.lever, on_node))};
  }
}

void CoupledGroupSolution::fill_right_side() {
  b_.right_side.assign(static_cast<std::size_t>(b_.pattern.first.back()), 0);
  start_bodies();
  give_impulses();
  fill_rows();
  push_bodies();
  push_by_body_contacts();
  for (int i = 0; i < static_cast<int>(b_.start.size()); ++i) {
    for (int m = 0; m < 6; ++m) right_side(body_block(i), m) = -b_.start[i].at(m);
  }
}

}  // namespace hooke::solver
