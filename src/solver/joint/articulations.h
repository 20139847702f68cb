#pragma once

#include "hooke/math.h"

#include "math/symmetric.h"
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
  JointBody body;                      ///< Velocities: before the joints.
  math::Symmetric3<double> stiffness;  ///< h^2 S K S, the geometric stiffness in scaled coordinates.
  math::Symmetric3<double> excess;     ///< What of it is implicit.
  math::Symmetric3<double> response;   ///< Change of omega~ per scaled angular impulse.
  DVec3 v = {};                        ///< With the impulses found so far.
  DVec3 omega_scaled = {};
};

/// Bodies that hooks join to each other, solved as a whole in each substep: velocities such that every row of
/// every joint holds at the end of it.
///
/// With all rows J, impulses lambda obey (J M^-1 J^T + gamma) lambda = target - J v. Trees are solved body by
/// body, from the leaves to the root, which is the body that nothing moves or else the heaviest
/// (wide/tree_sweep.h); many trees of one form side by side. Loops are solved in blocks of one hook each,
/// which are joined where hooks share a body that forces move. Motors and limits have bounds: rows that are
/// at one drop out, those that pull away from it come back, in the first four solutions and in trees each row
/// once; then rows only drop out, until none is beyond its bounds. A spring drops out while the motor beside
/// it holds its velocity, and with it the spring's impulse. A compliance of 1e-9 of each diagonal, 1e-5 in
/// loops, decides what rows along one another leave undetermined.
///
/// A joint's force F on a body at lever r turns the body back by K theta when it has turned by theta, with
/// the geometric stiffness K = F.r - (r F^T + F r^T) / 2. Where h^2 K exceeds the inertia, that is a spring
/// too stiff for the substep, and chains under load fly apart. So K acts implicitly: with its positive part
/// taken as |r| |F| (|s|^2 - s s^T) / 4, s = r/|r| + F/|F|, and G = h^2 S K S as far as its trace exceeds
/// 1/2,
///
///   (1 + G) (omega~ - omega~_before) + 0.2 G omega~ = impulses.
///
/// The first term keeps the energy of a swing, the second takes that of the waves that the changing G feeds.
/// A body under moderate load has no G and keeps its angular momentum to rounding. F is the larger of the
/// last substep's force and this one's: a joint that snaps taut is solved again with what it has found.
///
/// In loops all hooks of one body are joined to each other, so that a hub of n hooks would cost n^3. A body
/// of more than 8 hooks enters as several links, of an equal share of it and 4 hooks each, that are welded in
/// a row: exact, and the cost grows with n.
///
/// Where a body turns by more than 0.03 rad in the substep, the rows are made anew about its end until locks
/// err by less than 2e-4 of their levers: a Newton step each, four solutions at most in all.
///
/// Sources: Baraff 1996, "Linear-time dynamics using Lagrange multipliers"; geometric stiffness after
/// Tournier et al. 2015, "Stable constrained dynamics".
struct Articulation {
  static constexpr std::uint32_t kWeld = 0xFFFFFFFF;
  static constexpr std::int8_t kGiven = 2;  ///< Of a spring: the motor beside it says what it does.

  struct Joint {
    std::uint32_t hook = 0;      ///< Row; kWeld between links of one body.
    std::uint32_t a = 0, b = 0;  ///< Links.
    int first = 0;               ///< Of its rows.
    int count = 0;
    [[nodiscard]] bool is_weld() const { return hook == kWeld; }
  };

  std::vector<std::uint32_t> bodies;  ///< Rows; HookPlace::kWorld for the world. One for each link.
  std::vector<Joint> joints;          ///< In order of elimination.
  bool breakable = false;             ///< Some hook of it can break.

  // Of what has loops, for one substep.
  std::vector<Link> links;  ///< As bodies.
  std::vector<JointRow> rows;
  std::vector<double> lambda;
  std::vector<std::int8_t> bound;  ///< Of each row: -1 at low, 1 at high, 0 between, or kGiven.
  std::vector<math::Symmetric3<double>> stiffness_found;  ///< Of each link.
  std::vector<double> parts;  ///< Into how many links the body of each link is divided.

  /// A tree: joint i joins link i, its child, to a link behind it; the root is the last.
  struct Tree {
    wide::TreeForm form;
    std::vector<int> rows;     ///< Of the hook, for each of the form; a motor's spring is the one before it.
    int kind = 0;              ///< Equal where forms are.
    bool approximate = false;  ///< In this step; see solver/joint/approximate_trees.h.
  } tree;
  [[nodiscard]] bool has_loops() const { return tree.form.joints.empty(); }

  /// A link that two joints (or a joint with itself) share, and the block of the matrix it enters.
  struct Coupling {
    std::uint32_t block = 0;
    std::uint32_t link = 0;
  };
  /// What has loops: the matrix of the joints' rows that are free.
  struct Blocks {
    std::vector<Coupling> couplings;
    BlockPattern pattern;         ///< Of the joints; in a solution, of their rows that are free.
    std::vector<int> free;        ///< Rows.
    std::vector<int> free_sizes;  ///< How many each joint has.
    std::vector<double> columns;  ///< Of each joint: n, then the lever on a, then on b; x of all, y, z.
    std::vector<double> factors;
    std::vector<double> factor_scratch;
    std::vector<double> right_side;
  } blocks;
};

/// How much more a tree may take: it costs in proportion to its hooks, and nets do worst on large stars.
inline constexpr double kTreesMayTake = 10;

/// Memory to make articulations with.
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

/// Replaces `articulation` by that of hooks that hang together, in any order; it keeps its memory. False, and
/// an articulation of no use, if one solution takes more than `budget` multiplications, and a tree
/// kTreesMayTake times as many.
[[nodiscard]] bool make_articulation(std::span<const std::uint32_t> hook_rows,
                                     const std::vector<state::Hook>& hooks, const state::Bodies& bodies,
                                     double budget, ArticulationScratch& scratch, Articulation& articulation);

/// What articulations are solved in.
struct JointTables {
  std::vector<state::Hook>& hooks;
  state::Bodies& bodies;
};

/// Memory to solve trees side by side with, for one thread at a time.
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

/// Velocities of all bodies of trees of one kind, for a substep of length h [s], and the impulses of their
/// hooks. Each comes to the same as alone, and writes nothing that another articulation reads.
void solve_trees(double h, std::span<Articulation* const> trees, TreeScratch& scratch, JointTables tables);

/// The same for one that has loops.
void solve_loops(double h, Articulation& articulation, JointTables tables);

}  // namespace hooke::solver
