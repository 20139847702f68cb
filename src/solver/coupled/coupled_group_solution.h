#pragma once

#include "solver/coupled/coupled_groups.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

/// \file
/// A coupled group in the middle of its solution. Only coupled_groups.cpp, coupled_groups_matrix.cpp,
/// coupled_element_contacts.cpp and coupled_body_contacts.cpp know this class.

namespace hooke::solver {

inline constexpr std::array<DVec3, 3> kAxes = {DVec3{1, 0, 0}, DVec3{0, 1, 0}, DVec3{0, 0, 1}};

/// Forces of a contact in the last substep [N].
struct ContactForce {
  DVec3 n;  ///< Direction in which `normal` pushes.
  double normal = 0;
  DVec3 friction;
};

/// The segment of a rope that needs most over what it can take.
struct WeakestSegment {
  double need = 0;  ///< The one over the other; it gives way from 1 on.
  GivingSegment segment = {};
};

class CoupledGroupSolution {
 public:
  CoupledGroupSolution(const ParticleSubstep& substep, CoupledGroup& group, BodyContacts& contacts,
                       state::Tables& tables)
      : h_(static_cast<double>(substep.h)),
        loaded_at_points_(substep.loaded_at_points),
        surfaces_(substep.surfaces),
        b_(group),
        contacts_(contacts),
        t_(tables) {}

  void load_and_solve(const std::vector<state::VelocityRecord>& before,
                      std::vector<RopeSystem>& rope_systems);
  /// Whether hooks or segments of ropes give way (solver/joint/hook_breaks.h, solver/rope/segment_breaks.h),
  /// so that everything must be loaded and run again.
  [[nodiscard]] bool gives_way(int round, const std::vector<RopeSystem>& rope_systems);
  void store(const std::vector<RopeSystem>& rope_systems);
  /// Breaks the segments that gave way, at this time [s].
  void break_segments(double time);
  void remove_overlaps(const std::vector<RopeSystem>& rope_systems);

 private:
  void load(const std::vector<state::VelocityRecord>& before, const std::vector<RopeSystem>& rope_systems);
  /// False if the solution did not converge and has energy from nothing, or lets something pass.
  [[nodiscard]] bool run(std::vector<RopeSystem>& rope_systems);
  /// Solves with what holds, touches or would meet at the start, without friction, and takes no gap or
  /// overlap back. If ropes still gain energy, they take no stretch back either: that is a projection of
  /// velocities, which can only take energy.
  void run_calmly(std::vector<RopeSystem>& rope_systems);
  /// Largest relative length error left in any rope.
  double check_ropes(bool& limits_changed);
  void linearize_ropes(std::vector<RopeSystem>& rope_systems);
  [[nodiscard]] bool gains_energy() const;
  void calm_contacts();
  void calm_coupled_contacts();
  // Segments that break.
  void apply_dashpots(const std::vector<RopeSystem>& rope_systems);
  [[nodiscard]] bool set_segment_dashpots(const std::vector<RopeSystem>& rope_systems);
  [[nodiscard]] WeakestSegment weakest_segment(const std::vector<RopeSystem>& rope_systems) const;
  // Loading and checking.
  void load_points();
  [[nodiscard]] std::span<const std::uint32_t> tethers_of(std::size_t point, std::size_t contact,
                                                          std::size_t end) const;
  void load_hooks();
  bool stiffen();
  void solve_with_bounds();
  void solve_once();
  bool revise_bounds(bool release);
  void read_solution();
  void move_nodes();
  [[nodiscard]] bool is_sound() const;
  /// Whether the matrix may be factored once more in this substep. If not, the group notes it.
  bool within_budget();
  void push_out_points();

  // Element contacts and rope contacts: coupled_element_contacts.cpp.
  void load_coupled_contacts();
  void load_element_contact(std::size_t index);
  void load_rope_contact(std::size_t index);
  [[nodiscard]] const state::RopeContact& rope_contact(std::size_t index) const;
  void make_contact_rows(std::size_t index, const ContactForce& last);
  void make_contact_directions(std::size_t index, DVec3 n);
  void give_last_force(std::size_t index, const ContactForce& last);
  void note_rope_in_contact(std::uint32_t node);
  void set_coupled_rows(std::size_t index);
  void revise_coupled_contacts();
  bool update_coupled_friction(std::size_t index, bool may_stick);
  [[nodiscard]] Unconverged update_coupled_contact(std::size_t index, bool let_go);
  [[nodiscard]] Unconverged update_coupled_contacts(bool let_go);
  bool let_contacts_slide();
  void store_coupled_contacts();
  [[nodiscard]] bool has_coupled_contact(std::size_t node) const;
  [[nodiscard]] double heaviest_in_contact(std::size_t node) const;
  [[nodiscard]] double gap_speed(const CoupledContact& contact_row) const;
  [[nodiscard]] DVec3 velocity_at(std::size_t index, bool before) const;
  [[nodiscard]] DVec3 sliding_of(std::size_t index, bool before) const;
  [[nodiscard]] int least_solves_of_contacts() const;

  // Contacts of two bodies: coupled_body_contacts.cpp.
  void load_body_contacts();
  void add_body_contacts();
  void load_carried_impulses();
  void turn_levers();
  void solve_body_contacts();
  [[nodiscard]] bool converge(double stiffness, Guess guess, int steps);
  void jump(Guess guess);
  [[nodiscard]] bool descend(int steps);
  [[nodiscard]] bool evaluate();
  void note_search();
  void go(double t);
  [[nodiscard]] double climb(double t);
  void read_velocities(std::vector<double>& u) const;
  void assemble_body_contacts();
  void assemble_body_contact(const DirectContact& c, double stiffness, const DirectLever& a,
                             const DirectLever& b);
  void push_by_body_contacts();
  void store_bodies();
  void store_body_contacts();
  bool find_overlaps();
  void fill_pushes();
  void read_displacement();
  [[nodiscard]] double displaced_share() const;
  void displace_bodies(double share);
  void displace_nodes(double share, const std::vector<RopeSystem>& rope_systems);

  // The matrix and its right side.
  void assemble();
  void resize_coupled_contacts();
  void assemble_pair(const CoupledGroup::Incident& a, const CoupledGroup::Incident& b, std::uint32_t block,
                     const RopeNode& node);
  void assemble_pairs();
  [[nodiscard]] double compliance_of(std::uint32_t hook, const JointRow& row) const;
  void assemble_hooks();
  void assemble_bodies();
  void assemble_contact_rows();
  void assemble_contact_row(const RopeContactRow& contact_row, std::span<const RopeContactRow> at_node);
  void assemble_point(int body, std::span<const RopeContactRow> at_node);
  void fill_right_side();
  void start_bodies();
  void give_impulses();
  void fill_rows();
  void push_bodies();

  [[nodiscard]] BodyRow hook_row(const JointRow& row, int end, const JointBody& body) const {
    const double sign = end == 1 ? 1 : -1;
    return {(sign * std::sqrt(body.inverse_mass)) * row.n, sign * (end == 1 ? row.j_b : row.j_a)};
  }
  /// Calls visit(hook, row, k) for each row; k counts within the hook. Contact rows follow those of the
  /// hooks.
  template <class Visit>
  void for_each_row(Visit&& visit) const {
    for (std::uint32_t i = 0; i < b_.ends.size(); ++i) {
      for (std::uint32_t row = b_.first_row[i]; row < b_.first_row[i + 1]; ++row)
        visit(i, row, static_cast<int>(row - b_.first_row[i]));
    }
  }

  [[nodiscard]] std::uint32_t segment_count() const {
    return static_cast<std::uint32_t>(b_.ropes.segments.size());
  }
  [[nodiscard]] std::uint32_t bend_block(std::uint32_t bend) const { return segment_count() + bend; }
  /// Number of blocks before those of hooks: vectors, along the axes of the world.
  [[nodiscard]] std::uint32_t vector_count() const {
    return segment_count() + static_cast<std::uint32_t>(b_.ropes.bends.size());
  }
  [[nodiscard]] const DVec3& vector_impulse(std::uint32_t block) const {
    return block < segment_count() ? b_.ropes.segments[block].q
                                   : b_.ropes.bends[block - segment_count()].impulse;
  }
  [[nodiscard]] std::uint32_t hook_block(std::uint32_t hook) const { return vector_count() + hook; }
  [[nodiscard]] std::uint32_t body_block(int body) const {
    return hook_block(static_cast<std::uint32_t>(b_.ends.size())) + static_cast<std::uint32_t>(body);
  }
  [[nodiscard]] std::span<const CoupledGroup::Incident> incidents_of(std::size_t node) const {
    return std::span(b_.incidents)
        .subspan(b_.first_incident[node], b_.first_incident[node + 1] - b_.first_incident[node]);
  }
  [[nodiscard]] int size_of(std::uint32_t block) const { return b_.pattern.size[b_.slot[block]]; }
  /// Direction k of a row block; zero if the row is at a bound.
  [[nodiscard]] DVec3 direction(std::uint32_t block, int k) const {
    if (block < vector_count()) return kAxes[static_cast<std::size_t>(k)];
    const std::uint32_t row = b_.first_row[block - vector_count()] + static_cast<std::uint32_t>(k);
    return b_.bound[row] == 0 ? b_.rows[row].n : DVec3{};
  }
  /// Entries (i, k) of a block. Only the lower half of the matrix is stored.
  struct Numbers {
    double* first;
    int down, across;
    double& operator()(int i, int k) const { return first[i * down + k * across]; }
  };
  /// The block that couples `a` with `b`: row i is of `a`, column k of `b`.
  Numbers numbers(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t row = b_.slot[a];
    const std::uint32_t column = b_.slot[b];
    const std::uint32_t block = find_block(b_.pattern, std::max(row, column), std::min(row, column));
    const BlockPattern::Block& at = b_.pattern.block[block];
    const int width = b_.pattern.size[at.column];
    double* first = b_.numbers.data() + at.offset;
    return row >= column ? Numbers{first, width, 1} : Numbers{first, 1, width};
  }
  double& right_side(std::uint32_t block, int i) {
    const int at = b_.pattern.first[b_.slot[block]] + i;
    return b_.right_side[static_cast<std::size_t>(at)];
  }

  double h_;
  std::span<const std::uint8_t> loaded_at_points_;  ///< As in ParticleSubstep.
  SurfaceContacts& surfaces_;                       ///< Holds what presses on ropes.
  CoupledGroup& b_;
  BodyContacts& contacts_;
  state::Tables& t_;
  bool is_calm_ = false;   ///< It takes no error back: run_calmly.
  bool is_solved_ = true;  ///< The last search for what contacts of two bodies do has found it.
};

}  // namespace hooke::solver
