/// Trees side by side, as many as a vector has lanes: a lane takes the next tree as soon as its own is done,
/// so that one which needs many solutions keeps nobody waiting. Read Group::solve first.

#include "solver/articulation_links.h"
#include "solver/geometric_stiffness.h"
#include "solver/wide/trees.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace hooke::solver {

namespace {

constexpr std::size_t kFewestForLanes = 2;  ///< Below that one after another is faster.

template <int kCount>
void put(DVec3 v, double (&to)[3][kCount], int lane) {
  to[0][lane] = v.x;
  to[1][lane] = v.y;
  to[2][lane] = v.z;
}
template <int kCount>
DVec3 get(const double (&from)[3][kCount], int lane) {
  return {from[0][lane], from[1][lane], from[2][lane]};
}

template <int kCount>
class Group {
 public:
  void solve(double h, std::span<Articulation* const> trees, JointTables tables) {
    form_ = &trees.front()->tree.form;
    lanes_.links.resize(form_->joints.size() + 1);
    lanes_.rows.resize(form_->rows.size());
    trees_ = trees;
    running_ = 0;
    // Lanes without a tree repeat the first.
    for (int lane = kCount - 1; lane > 0; --lane) {
      if (static_cast<std::size_t>(lane) >= trees.size()) begin(h, lane, *trees.front(), tables);
    }
    slots_.fill({});
    for (int lane = 0; lane < kCount; ++lane) take_next(h, lane, tables);
    while (running_ > 0) {
      for (int lane = 0; lane < kCount; ++lane)
        lanes_.release[lane] = slots_[lane].pass < kFreeBoundPasses ? 1 : 0;
      wide::solve_trees(*form_, lanes_);
      for (int lane = 0; lane < kCount; ++lane) {
        if (slots_[lane].tree != nullptr) settle(h, lane, tables);
      }
    }
  }

 private:
  struct Slot {
    Articulation* tree = nullptr;
    int pass = 0;
    int solution = 0;
  };

  void take_next(double h, int lane, JointTables tables) {
    slots_[lane] = {};
    if (trees_.empty()) return;
    slots_[lane].tree = trees_.front();
    trees_ = trees_.subspan(1);
    ++running_;
    begin(h, lane, *slots_[lane].tree, tables);
  }

  void begin(double h, int lane, Articulation& art, JointTables tables) {
    begin_articulation(h, tables, art);
    load(art, lane);
  }

  /// After a solution of all lanes.
  void settle(double h, int lane, JointTables tables) {
    Slot& slot = slots_[lane];
    const bool changed = lanes_.changed[lane] > 0;
    if (changed && ++slot.pass < kMostBoundPasses) return;
    Articulation& art = *slot.tree;
    fetch(lane, art);
    if (changed) clamp_impulses(art);
    slot.pass = 0;
    if (begin_next_solution(h, tables, art) && ++slot.solution < kMaxSolves) return load(art, lane);
    store_velocities(art, tables.bodies);
    --running_;
    take_next(h, lane, tables);
  }

  void load(Articulation& art, int lane) {
    reset_velocities(art);
    for (std::size_t i = 0; i < art.links.size(); ++i) load_link(art.links[i], lanes_.links[i], lane);
    for (std::size_t i = 0; i < art.joints.size(); ++i) {
      const wide::TreeJoint& joint = form_->joints[i];
      const bool child_is_b = art.joints[i].b == i;
      for (int r = joint.first; r < joint.first + joint.count; ++r) load_row(art, r, child_is_b, lane);
    }
  }

  static void load_link(const Link& link, wide::TreeLinkLanes<kCount>& to, int lane) {
    const bool moves = link.body.inverse_mass > 0;
    to.mass[lane] = moves ? 1 / link.body.inverse_mass : 0;
    const math::Symmetric3<double> m =
        math::Symmetric3<double>::diagonal(1) + scaled(1 + kStiffnessDamping, link.excess);
    const std::array<double, 6> turning = {m.xx, m.xy, m.xz, m.yy, m.yz, m.zz};
    for (int k = 0; k < 6; ++k) to.turning[k][lane] = turning[k];
    put(link.v, to.v, lane);
    put(link.omega_scaled, to.omega, lane);
  }

  void load_row(const Articulation& art, int r, bool child_is_b, int lane) {
    const wide::TreeRowForm& form = form_->rows[r];
    const int i = art.tree.rows[r];
    const JointRow& row = art.rows[i];
    wide::TreeRowLanes<kCount>& to = lanes_.rows[r];
    if (!form.turns) put(child_is_b ? row.n : -row.n, to.n, lane);
    put(child_is_b ? row.j_b : -row.j_a, to.child, lane);
    put(child_is_b ? -row.j_a : row.j_b, to.parent, lane);
    to.gamma[lane] = row.gamma;
    to.target[lane] = row.target;
    if (!form.bounded) return;
    to.low[lane] = row.low;
    to.high[lane] = row.high;
    to.bound[lane] = art.bound[i];
    if (!form.sprung) return;
    const JointRow& spring = art.rows[i - 1];
    to.spring_gamma[lane] = spring.gamma;
    to.spring_target[lane] = spring.target;
    to.held_spring[lane] = (spring.target - row.target) / spring.gamma;
  }

  void fetch(int lane, Articulation& art) const {
    for (std::size_t r = 0; r < form_->rows.size(); ++r) {
      const wide::TreeRowForm& form = form_->rows[r];
      const wide::TreeRowLanes<kCount>& from = lanes_.rows[r];
      const int i = art.tree.rows[r];
      art.lambda[i] = from.lambda[lane];
      if (form.bounded) art.bound[i] = static_cast<std::int8_t>(from.bound[lane]);
      if (form.sprung) art.lambda[i - 1] = from.spring_lambda[lane];
    }
    for (std::size_t i = 0; i < art.links.size(); ++i) {
      art.links[i].v = get(lanes_.links[i].v_now, lane);
      art.links[i].omega_scaled = get(lanes_.links[i].omega_now, lane);
    }
  }

  const wide::TreeForm* form_ = nullptr;
  std::span<Articulation* const> trees_;  ///< That no lane has taken yet.
  int running_ = 0;
  std::array<Slot, kCount> slots_;
  wide::TreeLanes<kCount> lanes_;
};

}  // namespace

struct TreeScratch::Groups {
  Group<wide::kTreeLanes> together;
  Group<1> alone;
};

TreeScratch::TreeScratch() : groups_(std::make_unique<Groups>()) {}
TreeScratch::~TreeScratch() = default;
TreeScratch::TreeScratch(TreeScratch&&) noexcept = default;
TreeScratch& TreeScratch::operator=(TreeScratch&&) noexcept = default;

void solve_trees(double h, std::span<Articulation* const> trees, TreeScratch& scratch, JointTables tables) {
  if (trees.size() >= kFewestForLanes) {
    scratch.groups().together.solve(h, trees, tables);
  } else if (!trees.empty()) {
    scratch.groups().alone.solve(h, trees, tables);
  }
}

}  // namespace hooke::solver
