#pragma once

#include "hooke/math.h"

#include "math/symmetric.h"
#include "solver/joint/joint_tuning.h"
#include "solver/joint/tree_kernels.h"
#include "solver/joint_rows/joint_rows.h"
#include "solver/linear/block_matrix.h"
#include "state/bodies.h"
#include "state/hooks.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace hooke::solver {

/// One end of a joint while its articulation is solved.
struct Link {
  JointBody body;                      ///< Body; its velocities are those before the joints.
  math::Symmetric3<double> stiffness;  ///< h^2 S K S, the geometric stiffness in scaled coordinates.
  math::Symmetric3<double> excess;     ///< Implicit part of the stiffness.
  math::Symmetric3<double> response;   ///< Change of omega~ per scaled angular impulse.
  DVec3 v = {};                        ///< Velocity with the impulses found so far.
  DVec3 omega_scaled = {};
  double most_stiffness = 0;  ///< Sum of |r| |h F| of its joints [kg m^2/s].
};

/// Bodies that hooks join to each other, solved as a whole in each substep: the velocities are such that
/// every row of every joint holds at the end of it.
///
/// With all rows J, impulses lambda obey (J M^-1 J^T + gamma) lambda = target - J v. Trees are solved body by
/// body, from the leaves to the root (solver/joint/tree_sweep.h). The root is the body that nothing moves, or
/// else the heaviest. Many trees of one form are solved side by side. Loops are solved in blocks of one hook
/// each, which are joined where hooks share a body that forces move. Rows of motors and limits have bounds.
/// In the first four solutions, rows at a bound drop out, and those that pull away from it come back, in
/// trees each row once. Then rows only drop out, until none is beyond its bounds. A spring drops out while
/// the motor beside it holds its velocity, and with it the spring's impulse. A compliance of 1e-9 of each
/// diagonal, 1e-8 in loops, decides what rows along one another leave undetermined.
///
/// A joint's force F on a body at lever r turns the body back by K theta when it has turned by theta, with
/// the geometric stiffness K = F.r - (r F^T + F r^T) / 2. Where h^2 K exceeds the inertia, that is a spring
/// too stiff for the substep, and chains under load fly apart. So K acts implicitly, with its positive part
/// taken as |r| |F| (|s|^2 - s s^T) / 4, s = r/|r| + F/|F|. With G = h^2 S K S as far as its trace exceeds
/// 1/2,
///
///   (1 + G) (omega~ - omega~_before) + 0.2 G omega~ = impulses.
///
/// The first term keeps the energy of a swing. The second removes that of the waves that the changing G
/// feeds. A body under moderate load has no G and keeps its angular momentum to rounding. F is the larger of
/// the last substep's force and this one's: a joint that snaps taut is solved again with the force that was
/// found.
///
/// In loops all hooks of one body are joined to each other, so that a hub of n hooks would cost n^3. A body
/// of more than 8 hooks enters as several links, each with an equal share of it and 4 hooks, which are welded
/// in a row. That is exact, and the cost grows with n.
///
/// Where a body turns by more than 0.03 rad in the substep, its rows are made again about the end of the
/// substep, until locks err by less than 2e-4 of their levers. Each time is a Newton step; there are four
/// solutions at most.
///
/// Sources: Baraff 1996, "Linear-time dynamics using Lagrange multipliers"; geometric stiffness after
/// Tournier et al. 2015, "Stable constrained dynamics".
struct Articulation {
  static constexpr std::uint32_t kWeld = 0xFFFFFFFF;
  static constexpr std::int8_t kGiven = 2;  ///< A spring whose impulse the motor beside it determines.

  struct Joint {
    /// Row of the hook; kWeld between links of one body.
    std::uint32_t hook = 0;
    std::uint32_t a = 0, b = 0;  ///< Links.
    int first = 0;               ///< Index of its first row.
    int count = 0;
    [[nodiscard]] bool is_weld() const { return hook == kWeld; }
  };

  /// Body rows; HookPlace::kWorld for the world. One for each link.
  std::vector<std::uint32_t> bodies;
  std::vector<Joint> joints;  ///< In order of elimination.
  bool breakable = false;     ///< Some hook of the articulation can break.

  // Only with loops, for one substep.
  std::vector<Link> links;  ///< One for each of `bodies`.
  std::vector<JointRow> rows;
  std::vector<double> lambda;
  std::vector<std::int8_t> bound;  ///< Bound of each row: -1 at low, 1 at high, 0 between, or kGiven.
  /// Stiffness of each link by the forces found last.
  std::vector<math::Symmetric3<double>> stiffness_found;
  std::vector<double> parts;  ///< Number of links into which the body of each link is divided.

  /// A tree: joint i joins link i, its child, to a link behind it; the root is the last.
  struct Tree {
    wide::TreeForm form;
    /// Index into the hook's rows for each row of the form. A motor's spring is the row before it.
    std::vector<int> rows;
    int kind = 0;              ///< Equal for trees of equal form.
    bool approximate = false;  ///< In this step; see solver/joint/approximate_trees.h.
  } tree;
  [[nodiscard]] bool has_loops() const { return tree.form.joints.empty(); }

  /// A link that two joints share (or a joint with itself), and the block of the matrix to which it adds.
  struct Coupling {
    std::uint32_t block = 0;
    std::uint32_t link = 0;
  };
  /// For loops: the matrix of the joints' free rows.
  struct Blocks {
    std::vector<Coupling> couplings;
    BlockPattern pattern;         ///< Pattern of the joints; in a solution, of their free rows.
    std::vector<int> free;        ///< Rows.
    std::vector<int> free_sizes;  ///< Number of free rows of each joint.
    /// For each joint: n, then the lever on a, then on b; x of all rows, then y, then z.
    std::vector<double> columns;
    std::vector<double> factors;
    std::vector<double> factor_scratch;
    std::vector<double> right_side;
    std::vector<double> compliance;  ///< Of each free row, added to its diagonal.
    std::vector<double> unfelt;      ///< Impulses of free rows that no body feels.
  } blocks;
};

/// Memory for making articulations.
class ArticulationScratch {
 public:
  struct Lists;  // articulations.cpp

  ArticulationScratch();
  ~ArticulationScratch();
  ArticulationScratch(ArticulationScratch&&) noexcept;
  ArticulationScratch& operator=(ArticulationScratch&&) noexcept;

  [[nodiscard]] Lists& lists() { return *lists_; }

 private:
  std::unique_ptr<Lists> lists_;
};

/// Replaces `articulation` by that of hooks that hang together, in any order, and keeps its memory. Returns
/// false, and a useless articulation, if one solution takes more than `budget` multiplications, or for a tree
/// kTreeBudgetRatio times as many.
[[nodiscard]] bool make_articulation(std::span<const std::uint32_t> hook_rows,
                                     const std::vector<state::Hook>& hooks, const state::Bodies& bodies,
                                     double budget, ArticulationScratch& scratch, Articulation& articulation);

/// The tables in which articulations are solved.
struct JointTables {
  std::vector<state::Hook>& hooks;
  state::Bodies& bodies;
};

/// Memory for solving trees side by side, for one thread at a time.
class TreeScratch {
 public:
  struct Groups;  // articulation_trees.cpp

  TreeScratch();
  ~TreeScratch();
  TreeScratch(TreeScratch&&) noexcept;
  TreeScratch& operator=(TreeScratch&&) noexcept;

  [[nodiscard]] Groups& groups() { return *groups_; }

 private:
  std::unique_ptr<Groups> groups_;
};

/// Solves for the velocities of all bodies of trees of one kind in a substep of length h [s], and the
/// impulses of their hooks. Each tree gives the same result as alone, and writes nothing that another
/// articulation reads.
void solve_trees(double h, std::span<Articulation* const> trees, TreeScratch& scratch, JointTables tables);

/// Does the same for an articulation with loops.
void solve_loops(double h, Articulation& articulation, JointTables tables);

}  // namespace hooke::solver
