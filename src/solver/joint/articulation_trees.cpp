/// Trees side by side, as many as a vector has lanes. Two thirds of them need one solution, some need ten.
/// Those that need another one move to lanes of their own, so that they keep no other waiting. Read
/// Group::solve first.

#include "base/assert.h"
#include "solver/joint/articulations.h"
#include "solver/joint/joint_energy.h"
#include "solver/joint/joint_tuning.h"
#include "solver/joint/tree_kernels.h"
#include "solver/joint_rows/joint_rows.h"
#include "solver/simd/lane_arrays.h"
#include "state/body_frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace hooke::solver {

namespace {

using state::Hook;

/// Turn within the step up to which lanes find a body's rotation [rad]; see quaternion_of_small.
constexpr double kSmallTurn = 0.25;

/// Copies the first `kNumbers` numbers of a struct of lanes from one lane to another.
template <std::size_t kNumbers, class Lanes>
void copy_lane(const Lanes& from, int lane, int to_lane, Lanes& to) {
  using Lane = typename Lanes::Lane;
  const auto* source = reinterpret_cast<const Lane*>(&from) + lane;
  auto* target = reinterpret_cast<Lane*>(&to) + to_lane;
  for (std::size_t i = 0; i < kNumbers * Lanes::kCount; i += Lanes::kCount) target[i] = source[i];
}

/// A block of trees in lanes.
template <class Kind>
struct Block {
  static constexpr int kCount = Kind::kCount;

  struct Slot {
    const Articulation* tree = nullptr;
    int pass = 0;
    int solution = 0;
  };
  wide::TreeLanes<Kind> lanes;
  std::array<Slot, kCount> slots;

  void resize(const wide::TreeForm& form) {
    lanes.links.resize(form.joints.size() + 1);
    lanes.joints.resize(form.joints.size());
    lanes.rows.resize(form.rows.size());
  }
};

template <class Kind>
class Group {
 public:
  using Lane = typename Kind::Lane;
  static constexpr int kCount = Kind::kCount;

  void solve(double h, std::span<Articulation* const> trees, JointTables tables) {
    h_ = h;
    form_ = &trees.front()->tree.form;
    HOOKE_ASSERT(std::all_of(trees.begin(), trees.end(),
                             [&](const Articulation* tree) { return tree->tree.form == *form_; }));
    fresh_.resize(*form_);
    late_.resize(*form_);
    late_.slots.fill({});
    for (; !trees.empty(); trees = trees.subspan(std::min<std::size_t>(kCount, trees.size()))) {
      // Lanes without a tree repeat the first.
      const int count = static_cast<int>(std::min<std::size_t>(kCount, trees.size()));
      std::array<const Articulation*, kCount> of_lane = {};
      for (int lane = 0; lane < kCount; ++lane) {
        fresh_.slots[lane] = {};
        if (lane < count) fresh_.slots[lane].tree = trees[lane];
        of_lane[lane] = trees[lane < count ? lane : 0];
      }
      load(of_lane, tables);
      wide::make_tree_rows(h, *form_, fresh_.lanes);
      for (int lane = 0; lane < count; ++lane) give_way(*trees[lane], tables.hooks, lane, fresh_.lanes);
      do {
        solve_block(tables, fresh_);
      } while (count_busy(fresh_) >= kFewestTreesThatStay);
      for (int lane = 0; lane < count; ++lane) {
        if (!is_free(fresh_.slots[lane])) move_on(tables, lane);
      }
    }
    while (count_busy(late_) > 0) solve_block(tables, late_);
  }

 private:
  using Slot = typename Block<Kind>::Slot;
  using LinkLanes = wide::TreeLinkLanes<Kind>;
  using JointLanes = wide::TreeJointLanes<Kind>;
  using RowLanes = wide::TreeRowLanes<Kind>;

  static bool is_free(const Slot& slot) { return slot.tree == nullptr; }
  static int count_busy(const Block<Kind>& block) {
    return kCount - static_cast<int>(std::count_if(block.slots.begin(), block.slots.end(), is_free));
  }

  /// Solves all lanes once. Trees that need no other solution are stored, and their lanes are free.
  void solve_block(JointTables tables, Block<Kind>& block) {
    for (int lane = 0; lane < kCount; ++lane)
      block.lanes.release[lane] = block.slots[lane].pass < kFreeBoundPasses ? 1 : 0;
    wide::solve_trees(h_, *form_, block.lanes);
    for (int lane = 0; lane < kCount; ++lane) {
      Slot& slot = block.slots[lane];
      if (is_free(slot) || needs_another(tables.hooks, lane, block)) continue;
      store(*slot.tree, block.lanes, lane, tables);
      slot = {};
    }
  }

  bool needs_another(const std::vector<Hook>& hooks, int lane, Block<Kind>& block) {
    Slot& slot = block.slots[lane];
    if (block.lanes.changed[lane] > 0) {
      if (++slot.pass < kMostBoundPasses) return true;
      wide::clamp_tree_impulses(h_, *form_, lane, block.lanes);
    }
    slot.pass = 0;
    const bool grew = block.lanes.grew[lane] > 0;
    const bool bent = is_bent(hooks, lane, block);
    return (grew || bent) && ++slot.solution < kMostArticulationSolves;
  }

  /// Makes the rows of a lane again if a body turns fast. Returns whether a lock is off by too much then.
  bool is_bent(const std::vector<Hook>& hooks, int lane, Block<Kind>& block) const {
    if constexpr (Kind::kApproximate) {
      return false;
    } else {
      const bool turns_fast = h_ * std::sqrt(block.lanes.fast[lane]) > kBentRowsTurn;
      if (!turns_fast) return false;
      const double error = wide::make_tree_rows_ahead(h_, *form_, lane, block.lanes);
      give_way(*block.slots[lane].tree, hooks, lane, block.lanes);
      return error > kBentRowsError;
    }
  }

  /// Adds the compliance of hooks that give way, in series with their rows as they have been made.
  void give_way(const Articulation& art, const std::vector<Hook>& hooks, int lane,
                wide::TreeLanes<Kind>& lanes) const {
    if (!art.breakable) return;
    for (std::size_t i = 0; i < art.joints.size(); ++i) {
      const Hook& hook = hooks[art.joints[i].hook];
      if (hook.giving == Hook::Giving::kHolds) continue;
      const wide::TreeJoint& joint = form_->joints[i];
      for (int r = joint.first; r < joint.first + joint.count; ++r) {
        const wide::TreeRowForm& form = form_->rows[r];
        soften(form, static_cast<Lane>(hook.compliance[form.turns() ? 1 : 0]), lane, lanes.rows[r]);
      }
    }
  }

  /// Rows of locks are not always made again: the compliance of the hook is all that they have.
  static void soften(const wide::TreeRowForm& form, Lane compliance, int lane, RowLanes& row) {
    const bool is_soft =
        form.role == RowRole::kSpring || (Kind::kApproximate && form.role == RowRole::kMotor);
    row.gamma[lane] = is_soft ? row.gamma[lane] + compliance : compliance;
    if (!form.sprung) return;
    row.spring_gamma[lane] += compliance;
    if (!Kind::kApproximate)
      row.held_spring[lane] = (row.spring_target[lane] - row.target[lane]) / row.spring_gamma[lane];
  }

  /// Moves a tree to a lane of those that take longer.
  void move_on(JointTables tables, int lane) {
    auto slot = std::find_if(late_.slots.begin(), late_.slots.end(), is_free);
    while (slot == late_.slots.end()) {
      solve_block(tables, late_);
      slot = std::find_if(late_.slots.begin(), late_.slots.end(), is_free);
    }
    HOOKE_ASSERT(fresh_.lanes.rows.size() == late_.lanes.rows.size());
    *slot = fresh_.slots[lane];
    const int to = static_cast<int>(slot - late_.slots.begin());
    for (std::size_t i = 0; i < late_.lanes.links.size(); ++i) {
      constexpr std::size_t kNumbers = offsetof(LinkLanes, v_now) / sizeof(Lane) / kCount;
      copy_lane<kNumbers>(fresh_.lanes.links[i], lane, to, late_.lanes.links[i]);
    }
    for (std::size_t i = 0; i < late_.lanes.joints.size(); ++i) {
      constexpr std::size_t kNumbers = sizeof(JointLanes) / sizeof(Lane) / kCount;
      copy_lane<kNumbers>(fresh_.lanes.joints[i], lane, to, late_.lanes.joints[i]);
    }
    for (std::size_t i = 0; i < late_.lanes.rows.size(); ++i)
      copy_row(form_->rows[i], fresh_.lanes.rows[i], lane, to, late_.lanes.rows[i]);
  }

  static void copy_row(const wide::TreeRowForm& form, const RowLanes& from, int lane, int to_lane,
                       RowLanes& to) {
    constexpr std::size_t kAlways = offsetof(RowLanes, low) / sizeof(Lane) / kCount;
    constexpr std::size_t kBounded = offsetof(RowLanes, speed) / sizeof(Lane) / kCount;
    constexpr std::size_t kSprung = offsetof(RowLanes, lambda) / sizeof(Lane) / kCount;
    const bool is_all = form.role == RowRole::kMotor || form.role == RowRole::kSpring;
    if (is_all) {
      copy_lane<kSprung>(from, lane, to_lane, to);
    } else if (form.bounded()) {
      copy_lane<kBounded>(from, lane, to_lane, to);
    } else {
      copy_lane<kAlways>(from, lane, to_lane, to);
    }
  }

  /// Loads lane after lane of each part: a cache line is written eight times while it is at hand.
  void load(const std::array<const Articulation*, kCount>& trees, JointTables tables) {
    std::array<DVec3, kCount> origin = {};
    for (int lane = 0; Kind::kApproximate && lane < kCount; ++lane)
      origin[lane] = tables.bodies.center[trees[lane]->bodies.back()];
    for (std::size_t i = 0; i <= form_->joints.size(); ++i) {
      for (int lane = 0; lane < kCount; ++lane)
        load_link(tables.bodies, trees[lane]->bodies[i], origin[lane], fresh_.lanes.links[i], lane);
    }
    for (std::size_t i = 0; i < form_->joints.size(); ++i) {
      for (int lane = 0; lane < kCount; ++lane) load_joint(i, *trees[lane], tables.hooks, lane);
    }
  }

  void load_joint(std::size_t i, const Articulation& art, const std::vector<Hook>& hooks, int lane) {
    const Hook& hook = hooks[art.joints[i].hook];
    const wide::TreeJoint& joint = form_->joints[i];
    load_hook(hook, joint.turns, fresh_.lanes.joints[i], lane);
    for (int r = joint.first; r < joint.first + joint.count; ++r)
      load_row(hook, form_->rows[r], art.tree.rows[r], fresh_.lanes.rows[r], lane);
  }

  /// Loads a body. For a gyroscopic turn it loads what the present inertia is found from. Positions are those
  /// from `origin`.
  static void load_link(const state::Bodies& bodies, std::uint32_t row, DVec3 origin, LinkLanes& to,
                        int lane) {
    to.is_gyroscopic[lane] = 0;
    if (row == state::HookPlace::kWorld) {
      load_motion(0, -origin, {}, {}, to, lane);
      load_rotation(Quaternion<double>{}, math::Symmetric3<double>::diagonal(1), {}, to, lane);
      return;
    }
    const state::MotionRecord& m = bodies.motion[row];
    const bool moves = m.inverse_mass > Real(0);
    load_motion(static_cast<double>(m.inverse_mass), bodies.center[row] + vector_cast<double>(m.dx) - origin,
                m.v, m.omega_scaled, to, lane);
    if (moves && is_gyroscopic_now(bodies, row)) {
      const state::BodyMass& mass = bodies.mass[row];
      to.is_gyroscopic[lane] = 1;
      put(mass.principal, to.principal, lane);
      put(mass.inertia, to.inertia, lane);
      load_rotation(math::in_double(bodies.rotation[row]), math::in_double(bodies.scale[row]), {}, to, lane);
      return;
    }
    if (moves) {
      const auto scale = math::in_double(bodies.scale[row]);
      const auto turned = vector_cast<double>(m.theta_scaled);
      if (length_squared(scale * turned) < kSmallTurn * kSmallTurn)
        return load_rotation(math::in_double(bodies.rotation[row]), scale, turned, to, lane);
    }
    const JointBody body = joint_body(bodies, row);
    load_rotation(body.rotation, body.scale, {}, to, lane);
  }

  static void load_rotation(const Quaternion<double>& rotation, const math::Symmetric3<double>& scale,
                            DVec3 turned, LinkLanes& to, int lane) {
    put(rotation, to.rotation, lane);
    put(scale, to.step_scale, lane);
    put(turned, to.turned, lane);
  }

  static void load_motion(double inverse_mass, DVec3 center, Vec3 v, Vec3 omega_scaled, LinkLanes& to,
                          int lane) {
    to.inverse_mass[lane] = static_cast<Lane>(inverse_mass);
    to.mass[lane] = static_cast<Lane>(inverse_mass > 0 ? 1 / inverse_mass : 0);
    put(center, to.center, lane);
    put(v, to.v, lane);
    put(omega_scaled, to.omega_before, lane);
  }

  static void load_hook(const Hook& hook, bool turns, JointLanes& to, int lane) {
    put(hook.a.anchor, to.anchor_a, lane);
    put(hook.b.anchor, to.anchor_b, lane);
    put(hook.a.axes, to.axes_a, lane);
    put(hook.b.axes, to.axes_b, lane);
    put(hook.impulse, to.impulse, lane);
    for (int k = 0; k < (turns ? 6 : 3); ++k) to.value[k][lane] = static_cast<Lane>(hook.value[k]);
  }

  /// Loads the settings of a row, and its impulse in the last substep.
  void load_row(const Hook& hook, const wide::TreeRowForm& form, int row, RowLanes& to, int lane) const {
    const bool is_cone = form.freedom == 6;
    const HookFreedom& freedom = hook.freedom[is_cone ? 0 : form.freedom];
    to.goal[lane] = static_cast<Lane>(freedom.spring.target);
    if (form.role == RowRole::kSpring || form.sprung) {
      to.stiffness[lane] = static_cast<Lane>(freedom.spring.stiffness);
      to.damping[lane] = static_cast<Lane>(freedom.spring.damping);
    }
    if (!form.bounded()) return;
    to.lambda[lane] = static_cast<Lane>(hook.row_impulse[row]);
    if (form.role == RowRole::kMotor) {
      to.speed[lane] = static_cast<Lane>(freedom.motor.speed);
      to.high[lane] = static_cast<Lane>(h_) * static_cast<Lane>(freedom.motor.max_force);
      to.low[lane] = -to.high[lane];
      return;
    }
    const HookLimits limits = is_cone ? HookLimits{.upper = hook.cone} : freedom.limits;
    to.lower[lane] = static_cast<Lane>(limits.lower);
    to.upper[lane] = static_cast<Lane>(limits.upper);
    to.low[lane] = 0;
    to.high[lane] = std::numeric_limits<Lane>::infinity();
  }

  void store(const Articulation& art, const wide::TreeLanes<Kind>& from, int lane, JointTables tables) const {
    HOOKE_ASSERT(art.joints.size() == form_->joints.size() && art.tree.rows.size() == form_->rows.size());
    const bool far = !Kind::kApproximate && turns_far(from, lane);
    const BodySums before = far ? sum_bodies(art, tables.bodies) : BodySums{};
    for (std::size_t i = 0; i < art.joints.size(); ++i) {
      Hook& hook = tables.hooks[art.joints[i].hook];
      const wide::TreeJoint& joint = form_->joints[i];
      for (int r = joint.first; r < joint.first + joint.count; ++r) {
        const int row = art.tree.rows[r];
        hook.row_impulse[row] = static_cast<Real>(from.rows[r].lambda[lane]);
        if (form_->rows[r].sprung)
          hook.row_impulse[row - 1] = static_cast<Real>(from.rows[r].spring_lambda[lane]);
      }
      hook.impulse = vector_cast<Real>(get(from.joints[i].impulse, lane));
      hook.angular_impulse = vector_cast<Real>(get(from.joints[i].angular, lane));
      for (int k = 0; k < 6; ++k)
        hook.value[k] = k < 3 || joint.turns ? static_cast<double>(from.joints[i].value[k][lane]) : 0.0;
    }
    for (std::size_t i = 0; i < art.bodies.size(); ++i) {
      const LinkLanes& link = from.links[i];
      if (!(link.inverse_mass[lane] > 0)) continue;
      set_joint_velocity(vector_cast<double>(get(link.v_now, lane)),
                         vector_cast<double>(get(link.omega_of_step, lane)),
                         vector_cast<double>(get(link.gained, lane)), art.bodies[i], tables.bodies);
    }
    if (!far) return reset_energy(art, tables.hooks);
    if constexpr (!Kind::kApproximate) {
      balance_energy(before, art, tables, [&](std::size_t i) { return work_of(from, i, lane); });
    }
  }

  /// Whether a body turns far, or the line of a hook that keeps a distance.
  bool turns_far(const wide::TreeLanes<Kind>& from, int lane) const {
    if (h_ * std::sqrt(from.fast[lane]) > kEnergyAccountTurn) return true;
    for (std::size_t i = 0; i < form_->joints.size(); ++i) {
      const wide::TreeJoint& joint = form_->joints[i];
      if (joint.kind != HookKind::kDistance) continue;
      const auto v = get(from.links[static_cast<std::size_t>(joint.parent)].v_now, lane);
      const auto speed = length(get(from.links[i].v_now, lane) - v);
      if (h_ * speed > kEnergyAccountTurn * std::abs(from.joints[i].value[0][lane])) return true;
    }
    return false;
  }

  JointWork work_of(const wide::TreeLanes<Kind>& from, std::size_t i, int lane) const {
    const wide::TreeJoint& joint = form_->joints[i];
    const LinkLanes& child = from.links[i];
    const LinkLanes& parent = from.links[static_cast<std::size_t>(joint.parent)];
    const auto is_told = [&](const LinkLanes& link) {
      return !(link.mass[lane] > 0) &&
             !(get(link.v, lane) == DVec3{} && get(link.omega_before, lane) == DVec3{});
    };
    const bool told = is_told(child) || is_told(parent);
    JointWork sum;
    for (int r = joint.first; r < joint.first + joint.count; ++r) {
      const wide::TreeRowForm& form = form_->rows[r];
      const RowLanes& row = from.rows[r];
      const auto rate_of = [&](auto&& v, auto&& omega) {
        const double turning =
            dot(get(row.child, lane), omega(child)) + dot(get(row.parent, lane), omega(parent));
        return form.turns() ? turning : turning + dot(get(row.n, lane), v(child) - v(parent));
      };
      if (form.role == RowRole::kSpring || form.sprung) {
        const double k = row.stiffness[lane];
        const double target = form.sprung ? row.spring_target[lane] : row.target[lane];
        const double rate = rate_of([&](const LinkLanes& link) { return get(link.v_now, lane); },
                                    [&](const LinkLanes& link) { return get(link.omega_now, lane); });
        if (k > 0) sum.add_spring(k, row.start[lane], h_ * rate - target * (row.damping[lane] + h_ * k) / k);
      }
      if (form.role == RowRole::kMotor) {
        const double rate =
            rate_of([&](const LinkLanes& link) { return 0.5 * (get(link.v, lane) + get(link.v_now, lane)); },
                    [&](const LinkLanes& link) {
                      return 0.5 * (get(link.omega_before, lane) + get(link.omega_now, lane));
                    });
        sum.work += row.lambda[lane] * rate;
      }
      if (told) {
        const double lambda = row.lambda[lane] + (form.sprung ? row.spring_lambda[lane] : 0);
        sum.work -=
            lambda *
            rate_of([&](const LinkLanes& link) { return link.mass[lane] > 0 ? DVec3{} : get(link.v, lane); },
                    [&](const LinkLanes& link) {
                      return link.mass[lane] > 0 ? DVec3{} : get(link.omega_before, lane);
                    });
      }
    }
    return sum;
  }

  double h_ = 0;
  const wide::TreeForm* form_ = nullptr;
  Block<Kind> fresh_;  ///< Trees at their first solution.
  Block<Kind> late_;   ///< Trees that need more.
};

/// Trees solved side by side, or one alone.
template <class Many, class One>
struct Pool {
  std::vector<Articulation*> trees;
  Group<Many> together;
  Group<One> alone;

  void solve(double h, JointTables tables) {
    if (trees.size() >= kFewestTreesForLanes) {
      together.solve(h, trees, tables);
    } else if (!trees.empty()) {
      alone.solve(h, trees, tables);
    }
    trees.clear();
  }
};

}  // namespace

struct TreeScratch::Groups {
  Pool<wide::ExactTrees, wide::ExactTree> exact;
  Pool<wide::ApproximateTrees, wide::ApproximateTree> approximate;
};

TreeScratch::TreeScratch() : groups_(std::make_unique<Groups>()) {}
TreeScratch::~TreeScratch() = default;
TreeScratch::TreeScratch(TreeScratch&&) noexcept = default;
TreeScratch& TreeScratch::operator=(TreeScratch&&) noexcept = default;

void solve_trees(double h, std::span<Articulation* const> trees, TreeScratch& scratch, JointTables tables) {
  auto& [exact, approximate] = scratch.groups();
  // A solution that ran out of memory has left trees here.
  exact.trees.clear();
  approximate.trees.clear();
  for (Articulation* tree : trees) (tree->tree.approximate ? approximate.trees : exact.trees).push_back(tree);
  exact.solve(h, tables);
  approximate.solve(h, tables);
}

}  // namespace hooke::solver
