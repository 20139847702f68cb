/// Trees of joints in Numbers of solver/simd/numbers.h. Included again for each instruction set.
///
/// The unknowns are u, by which the joints change each link's velocity, and the impulses lambda of their
/// rows. A link that is eliminated has A u = g + C^T lambda + what its own children do, with A = diag(m, 1 +
/// 1.2 G) and C its side of the joint to its parent. P is the parent's side:
///
///   C u + P u_parent + gamma lambda = b,   b = target - C v - P v_parent
///
/// With A = L E L^T, W = L^-1 C^T, y = L^-1 g and the rows' S = W^T E^-1 W + gamma = K D K^T, V = K^-1 P and
/// z = K^-1 (b - W^T E^-1 y),
///
///   the parent gets     A: V^T D^-1 V     g: V^T D^-1 z
///   on the way back     lambda = K^-T D^-1 (z - V u_parent),   u = L^-T E^-1 (y + W lambda)
///
/// Everything that is added is positive: nothing cancels. A row at a bound has C = P = 0, gamma = 1 and b =
/// 0, and its impulse is in g of both links. Where that is so in all lanes, the row is left out. That changes
/// nothing but signs of zeros, and those end in sums with +0. A pivot that is not positive counts as
/// infinite.

#if defined(HOOKE_SOLVER_JOINT_TREE_SWEEP_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_JOINT_TREE_SWEEP_H
#undef HOOKE_SOLVER_JOINT_TREE_SWEEP_H
#else
#define HOOKE_SOLVER_JOINT_TREE_SWEEP_H
#endif

#include "solver/joint/tree_kernels.h"
#include "solver/joint/tree_stiffness.h"
#include "solver/joint_rows/joint_rows.h"
#include "solver/simd/numbers.h"

#include <cstddef>
#include <hwy/highway.h>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

/// Index of (row, column) in a lower triangle.
constexpr int triangle_at(int row, int column) {
  return row * (row + 1) / 2 + column;
}

/// Index of (row, column) among the six numbers of a Scale.
constexpr int kSymmetricAt[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};

template <class Number>
HWY_INLINE Number inverse_of_pivot(Number d) {
  const Number zero(0.0);
  return choose(above(d, zero), quotient(Number(1.0), d), zero);
}

/// A 6 x 6 matrix A = L E L^T: L below the diagonal, 1 / E on it.
template <class Number>
struct LinkFactor {
  Number a[21];

  /// Factors from column kColumn on. It is a recursion, as compilers do not unroll three loops in each other.
  template <int kColumn = 0>
  HWY_INLINE void factor() {
    if constexpr (kColumn < 6) {
      const Number inverse = inverse_of_pivot(a[triangle_at(kColumn, kColumn)]);
      a[triangle_at(kColumn, kColumn)] = inverse;
      eliminate_row<kColumn, kColumn + 1>(inverse);
      factor<kColumn + 1>();
    }
  }
  [[nodiscard]] HWY_INLINE const Number& inverse(int i) const { return a[triangle_at(i, i)]; }

  template <int kColumn, int kRow>
  HWY_INLINE void eliminate_row(const Number& inverse) {
    if constexpr (kRow < 6) {
      eliminate_row<kColumn, kRow + 1>(inverse);
      const Number l = inverse * a[triangle_at(kRow, kColumn)];
      for (int k = kColumn + 1; k <= kRow; ++k)
        a[triangle_at(kRow, k)] = a[triangle_at(kRow, k)] - l * a[triangle_at(k, kColumn)];
      a[triangle_at(kRow, kColumn)] = l;
    }
  }

  /// Computes x := L^-1 x, where the first kFrom are zero.
  template <int kFrom>
  HWY_INLINE void substitute(Number (&x)[6]) const {
    for (int i = kFrom + 1; i < 6; ++i) {
      for (int k = kFrom; k < i; ++k) x[i] = x[i] - a[triangle_at(i, k)] * x[k];
    }
  }
  /// Computes x := L^-1 x for a side of a row, whose linear part is zero where the row `turns`.
  HWY_INLINE void substitute_side(bool turns, Number (&x)[6]) const {
    if (turns) {
      substitute<3>(x);
    } else {
      substitute<0>(x);
    }
  }
  /// Computes x := E^-1 x.
  HWY_INLINE void divide(Number (&x)[6]) const {
    for (int i = 0; i < 6; ++i) x[i] = inverse(i) * x[i];
  }
  /// Computes x := L^-T x.
  HWY_INLINE void substitute_back(Number (&x)[6]) const {
    for (int i = 4; i >= 0; --i) {
      for (int k = i + 1; k < 6; ++k) x[i] = x[i] - a[triangle_at(k, i)] * x[k];
    }
  }
};

/// One lane, or vector of lanes, of the trees.
template <class Number, class Kind>
class TreeSweep {
 public:
  using Lane = typename Kind::Lane;
  static constexpr int kCount = Kind::kCount;

  HWY_INLINE TreeSweep(const TreeForm& form, TreeLanes<Kind>& trees, int lane)
      : joints_(form.joints.data()),
        forms_(form.rows.data()),
        links_(trees.links.data()),
        hooks_(trees.joints.data()),
        rows_(trees.rows.data()),
        joint_count_(static_cast<int>(form.joints.size())),
        lane_(lane) {}

  HWY_INLINE void run(TreeLanes<Kind>& trees) {
    for (int i = 0; i <= joint_count_; ++i) begin(links_[i]);
    for (int i = 0; i < joint_count_; ++i) eliminate(joints_[i], links_[i], links_[joints_[i].parent]);
    Link& root = links_[joint_count_];
    solve_root(root);
    const Number release = get<Number>(trees.release + lane_);
    Number changed(0.0);
    Number fastest = turn_squared(root);
    for (int i = joint_count_ - 1; i >= 0; --i) {
      go_back(joints_[i], links_[i], links_[joints_[i].parent]);
      revise(joints_[i], links_[i], release, hooks_[i], changed);
      fastest = larger(fastest, turn_squared(links_[i]));
    }
    write(changed, trees.changed + lane_);
    write(fastest, trees.fast + lane_);
  }

 private:
  using Link = TreeLinkLanes<Kind>;
  using Row = TreeRowLanes<Kind>;

  HWY_INLINE Number at(const Lane (&lanes)[kCount]) const { return get<Number>(lanes + lane_); }
  HWY_INLINE void put(const Number& value, Lane (&lanes)[kCount]) const { write(value, lanes + lane_); }

  // Loads number after number: GCC makes a slow memcpy of a loop.
  template <int kSize>
  HWY_INLINE void load(const Lane (&from)[kSize][kCount], Number (&to)[kSize]) const {
    load(from, to, std::make_index_sequence<kSize>());
  }
  template <int kSize, std::size_t... kAt>
  HWY_INLINE void load(const Lane (&from)[kSize][kCount], Number (&to)[kSize],
                       std::index_sequence<kAt...>) const {
    (read(from[kAt] + lane_, to[kAt]), ...);
  }
  template <int kSize>
  HWY_INLINE void store(const Number (&from)[kSize], Lane (&to)[kSize][kCount]) const {
    store(from, to, std::make_index_sequence<kSize>());
  }
  template <int kSize, std::size_t... kAt>
  HWY_INLINE void store(const Number (&from)[kSize], Lane (&to)[kSize][kCount],
                        std::index_sequence<kAt...>) const {
    (write(from[kAt], to[kAt] + lane_), ...);
  }

  HWY_INLINE void begin(Link& link) const {
    const Number zero(0.0);
    const Number mass = at(link.mass);
    for (int i = 0; i < 6; ++i) {
      for (int k = 0; k <= i; ++k) {
        const Number linear = i == k ? mass : zero;
        put(k < 3 ? linear : at(link.turning[kSymmetricAt[i - 3][k - 3]]), link.a[triangle_at(i, k)]);
      }
      put(zero, link.g[i]);
    }
  }

  HWY_INLINE void load_sides(const Row& row, bool turns, Number (&child)[6], Number (&parent)[6]) const {
    const Number zero(0.0);
    for (int i = 0; i < 3; ++i) {
      child[i] = zero;
      parent[i] = zero;
      child[i + 3] = at(row.child[i]);
      parent[i + 3] = at(row.parent[i]);
    }
    if (turns) return;
    for (int i = 0; i < 3; ++i) {
      child[i] = at(row.n[i]);
      parent[i] = zero - child[i];
    }
  }

  HWY_INLINE Number product(const Number (&a)[6], const Lane (&b)[6][kCount], bool turns) const {
    const Number angular = a[3] * at(b[3]) + a[4] * at(b[4]) + a[5] * at(b[5]);
    return turns ? angular : a[0] * at(b[0]) + a[1] * at(b[1]) + a[2] * at(b[2]) + angular;
  }
  static HWY_INLINE Number product(const Number (&a)[6], const Number (&b)[6], bool turns) {
    const Number angular = a[3] * b[3] + a[4] * b[4] + a[5] * b[5];
    return turns ? angular : a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + angular;
  }

  /// The speed of a row's two sides relative to each other, with velocities of the links.
  HWY_INLINE Number rate(const Row& row, bool turns, const Lane (&v)[3][kCount],
                         const Lane (&omega)[3][kCount], const Lane (&v_parent)[3][kCount],
                         const Lane (&omega_parent)[3][kCount]) const {
    const Triple<Number> child = get3<Number>(row.child, lane_);
    const Triple<Number> parent = get3<Number>(row.parent, lane_);
    const Number angular =
        dot(child, get3<Number>(omega, lane_)) + dot(parent, get3<Number>(omega_parent, lane_));
    if (turns) return angular;
    return angular +
           dot(get3<Number>(row.n, lane_), difference(get3<Number>(v, lane_), get3<Number>(v_parent, lane_)));
  }

  /// Whether a row is at a bound: above(result, 0.5).
  HWY_INLINE Number is_bound(const Row& row) const {
    const Number bound = at(row.bound);
    return bound * bound;
  }
  /// The impulse that a row has whatever the velocities are.
  HWY_INLINE Number fixed_impulse(const Row& row, const TreeRowForm& form) const {
    const Number zero(0.0);
    const Number bound = at(row.bound);
    const Number between = form.sprung ? at(row.held_spring) : zero;
    return choose(above(bound, zero), at(row.high), choose(above(zero, bound), at(row.low), between));
  }

  /// The rows of a joint that are factored already.
  struct RowList {
    const Row* const* row;
    int count;
  };
  /// A row's own entry of S, and what its right side is so far.
  struct RowStart {
    Number diagonal;
    Number z;
  };

  /// Adds the factors of one row of S, from `w` = L^-1 C^T and its own b and V, to those that `list` has
  /// already.
  HWY_INLINE void add_row(const RowList& list, const Number (&w)[6], bool turns, const RowStart& start,
                          Number (&v)[6], Row& row) const {
    auto [diagonal, z] = start;
    Number t[kMostTreeRows];
    for (int q = 0; q < list.count; ++q) {
      const Row& other = *list.row[q];
      Number s = product(w, other.w, turns);
      for (int p = 0; p < q; ++p) s = s - t[p] * at(other.l[p]);
      t[q] = s;
      const Number l = s * at(other.inverse);
      diagonal = diagonal - s * l;
      put(l, row.l[q]);
      z = z - l * at(other.z);
      for (int i = 0; i < 6; ++i) v[i] = v[i] - l * at(other.v[i]);
    }
    put(inverse_of_pivot(diagonal), row.inverse);
    put(z, row.z);
    store(v, row.v);
  }

  /// Adds the impulses of rows at a bound to the right sides of both links.
  HWY_INLINE void add_fixed_impulses(const TreeJoint& joint, Number (&g)[6], Number (&g_parent)[6]) const {
    const Number zero(0.0);
    for (int r = joint.first; r < joint.first + joint.count; ++r) {
      const TreeRowForm& form = forms_[r];
      if (!form.bounded()) continue;
      const Row& row = rows_[r];
      const Number impulse = fixed_impulse(row, form);
      for (int i = form.turns() ? 3 : 0; i < 6; ++i) {
        const Number child = i < 3 ? at(row.n[i % 3]) : at(row.child[i % 3]);
        const Number other = i < 3 ? zero - at(row.n[i % 3]) : at(row.parent[i % 3]);
        g[i] = g[i] + impulse * child;
        g_parent[i] = g_parent[i] + impulse * other;
      }
    }
  }

  /// gamma and b of a row. One with a spring beside its bounds has those of the spring while it is at a
  /// bound.
  struct RowDemand {
    Number gamma;
    Number b;
  };
  HWY_INLINE RowDemand demand_of(const TreeRowForm& form, const Row& row, const Link& link,
                                 const Link& parent) const {
    Number gamma = at(row.gamma);
    Number target = at(row.target);
    if (form.sprung) {
      const auto slides = above(is_bound(row), Number(0.5));
      gamma = choose(slides, at(row.spring_gamma), gamma);
      target = choose(slides, at(row.spring_target), target);
    }
    return {gamma, target - rate(row, form.turns(), link.v, link.omega, parent.v, parent.omega)};
  }

  /// Leaves a row out in the lanes where it is at a bound: it has C = P = 0, gamma = 1 and b = 0.
  HWY_INLINE void drop_held(const Row& row, bool turns, Number& gamma, Number& b, Number (&child)[6],
                            Number (&parent)[6]) const {
    const Number zero(0.0);
    const auto held = above(is_bound(row), Number(0.5));
    for (int i = turns ? 3 : 0; i < 6; ++i) {
      child[i] = choose(held, zero, child[i]);
      parent[i] = choose(held, zero, parent[i]);
    }
    gamma = choose(held, Number(1.0), gamma);
    b = choose(held, zero, b);
  }

  HWY_INLINE void eliminate(const TreeJoint& joint, Link& link, Link& parent) const {
    LinkFactor<Number> factor;
    load(link.a, factor.a);
    factor.factor();
    store(factor.a, link.a);
    Number y[6];
    load(link.g, y);
    Number g_parent[6];
    load(parent.g, g_parent);
    add_fixed_impulses(joint, y, g_parent);
    factor.template substitute<0>(y);
    factor.divide(y);
    store(y, link.g);

    const Row* list[kMostTreeRows];
    int count = 0;
    for (int r = joint.first; r < joint.first + joint.count; ++r) {
      const TreeRowForm form = forms_[r];
      Row& row = rows_[r];
      const bool drops = form.drops();
      if (drops && !any(above(Number(0.5), is_bound(row)))) continue;
      Number w[6];
      Number v[6];
      load_sides(row, form.turns(), w, v);
      auto [gamma, b] = demand_of(form, row, link, parent);
      if (drops) drop_held(row, form.turns(), gamma, b, w, v);
      factor.substitute_side(form.turns(), w);
      Number scaled[6];
      for (int i = 0; i < 6; ++i) scaled[i] = factor.inverse(i) * w[i];
      store(scaled, row.w);
      const Number diagonal = product(w, scaled, form.turns());
      b = b - product(w, y, form.turns());
      const Number firm = diagonal + Number(Kind::kCompliance) * diagonal;
      add_row({list, count}, w, form.turns(), {firm + gamma, b}, v, row);
      list[count++] = &row;
    }
    if (joint.parent_moves) add_to_parent(list, count, g_parent, parent);
  }

  HWY_INLINE void add_to_parent(const Row* const* list, int count, Number (&g)[6], Link& parent) const {
    Number a[21];
    load(parent.a, a);
    for (int k = 0; k < count; ++k) {
      const Row& row = *list[k];
      Number v[6];
      load(row.v, v);
      const Number inverse = at(row.inverse);
      const Number z = at(row.z);
      for (int i = 0; i < 6; ++i) {
        const Number scaled = inverse * v[i];
        g[i] = g[i] + scaled * z;
        for (int j = 0; j <= i; ++j) a[triangle_at(i, j)] = a[triangle_at(i, j)] + scaled * v[j];
      }
    }
    store(a, parent.a);
    store(g, parent.g);
  }

  HWY_INLINE void solve_root(Link& root) const {
    const Number zero(0.0);
    Number x[6];
    if (joint_count_ > 0 && joints_[joint_count_ - 1].parent_moves) {
      LinkFactor<Number> factor;
      load(root.a, factor.a);
      factor.factor();
      load(root.g, x);
      factor.template substitute<0>(x);
      factor.divide(x);
      factor.substitute_back(x);
    } else {
      for (int i = 0; i < 6; ++i) x[i] = zero;
    }
    finish(x, root);
  }

  HWY_INLINE void finish(const Number (&x)[6], Link& link) const {
    store(x, link.u);
    const Number zero(0.0);
    for (int i = 0; i < 3; ++i) {
      put(at(link.v[i]) + x[i] + zero, link.v_now[i]);
      put(at(link.omega[i]) + x[i + 3] + zero, link.omega_now[i]);
    }
  }

  /// Square of the link's angular velocity [(rad/s)^2].
  HWY_INLINE Number turn_squared(const Link& link) const {
    const Number zero(0.0);
    const Scale<Number> scale = {at(link.scale[0]), at(link.scale[1]), at(link.scale[2]),
                                 at(link.scale[3]), at(link.scale[4]), at(link.scale[5])};
    const Triple<Number> omega = scale.times(get3<Number>(link.omega_now, lane_));
    return choose(above(at(link.mass), zero), dot(omega, omega), zero);
  }

  HWY_INLINE void go_back(const TreeJoint& joint, Link& link, const Link& parent) const {
    Number u[6];
    load(parent.u, u);
    Number x[6];
    load(link.g, x);
    Row* list[kMostTreeRows];
    int count = 0;
    for (int r = joint.first; r < joint.first + joint.count; ++r) {
      if (forms_[r].drops() && !any(above(Number(0.5), is_bound(rows_[r])))) continue;
      list[count++] = &rows_[r];
    }
    for (int k = count - 1; k >= 0; --k) {
      Row& row = *list[k];
      Number v[6];
      load(row.v, v);
      Number lambda = at(row.inverse) * (at(row.z) - product(v, u, false));
      for (int q = k + 1; q < count; ++q) lambda = lambda - at(list[q]->l[k]) * at(list[q]->change);
      put(lambda, row.change);
      for (int i = 0; i < 6; ++i) x[i] = x[i] + at(row.w[i]) * lambda;
    }
    LinkFactor<Number> factor;
    load(link.a, factor.a);
    factor.substitute_back(x);
    finish(x, link);
  }

  /// Stores impulses, and finds bounds for the next solution.
  HWY_INLINE void revise(const TreeJoint& joint, const Link& link, const Number& release,
                         TreeJointLanes<Kind>& hook, Number& changed) const {
    const Number zero(0.0);
    const Link& parent = links_[joint.parent];
    Triple<Number> linear = {zero, zero, zero};
    Triple<Number> angular = linear;
    for (int r = joint.first; r < joint.first + joint.count; ++r) {
      const TreeRowForm& form = forms_[r];
      Row& row = rows_[r];
      Number lambda = at(row.change) + zero;
      if (form.bounded()) {
        lambda =
            revise_bound(form, row, lambda, release, changed,
                         rate(row, form.turns(), link.v_now, link.omega_now, parent.v_now, parent.omega_now));
      } else {
        put(lambda, row.lambda);
      }
      add(lambda, get3<Number>(row.n, lane_), form.turns() ? angular : linear);
    }
    const Number sign(joint.child_is_b ? 1.0 : -1.0);
    put3(scaled(sign, linear), hook.impulse, lane_);
    put3(scaled(sign, angular), hook.angular, lane_);
  }

  /// Impulse of a row with bounds, together with its spring's; `lambda` is what was found for it.
  HWY_INLINE Number revise_bound(const TreeRowForm& form, Row& row, const Number& lambda,
                                 const Number& release, Number& changed, const Number& rate_now) const {
    const Number zero(0.0);
    const Number fixed = fixed_impulse(row, form);
    const auto is_free = above(Number(0.5), is_bound(row));
    Number own = lambda;
    Number spring = zero;
    if (form.sprung) {
      Number beside = fixed;
      if constexpr (Kind::kApproximate) {
        // Friction and the spring are one row.
        beside = quotient(at(row.spring_target) - rate_now, at(row.spring_gamma));
        own = lambda - beside;
      }
      spring = choose(is_free, beside, lambda);
      put(spring, row.spring_lambda);
    }
    const Number given = choose(is_free, own, fixed);
    put(given, row.lambda);
    const Number next = next_bound(form, row, own, release, at(row.target) - rate_now);
    const Number step = next - at(row.bound);
    put(next, row.bound);
    changed = choose(above(step * step, zero), Number(1.0), changed);
    return form.sprung ? given + spring : given;
  }

  /// Bound -1, 0 or 1 of a row that has found the impulse `own`, and whose speed `lacks` so much.
  HWY_INLINE Number next_bound(const TreeRowForm& form, Row& row, const Number& own, const Number& release,
                               const Number& lacks) const {
    const Number zero(0.0);
    const Number one(1.0);
    const Number bound = at(row.bound);
    Number low = at(row.low);
    Number high = at(row.high);
    Number least(kJointRoundingSpeed);
    if constexpr (Kind::kApproximate) {
      const Number slack = form.role == RowRole::kMotor ? Number(kApproximateFriction - 1) * high
                                                        : Number(kApproximateSpeed) * at(row.inverse);
      low = low - slack;
      high = high + slack;
      least = Number(kApproximateSpeed);
    }
    const Number to = choose(above(low, own), zero - one, choose(above(own, high), one, zero));
    const Number let_go = choose(above(zero - least, bound * lacks), zero, bound);
    const Number freed = at(row.freed);
    const bool stays = Kind::kApproximate && form.role == RowRole::kMotor;
    const Number held = stays ? bound : choose(above(release, freed), let_go, bound);
    put(choose(above(bound * bound, held * held), one, freed), row.freed);
    return choose(above(Number(0.5), bound * bound), to, held);
  }

  const TreeJoint* joints_;
  const TreeRowForm* forms_;
  Link* links_;
  TreeJointLanes<Kind>* hooks_;
  Row* rows_;
  int joint_count_;
  int lane_;
};

template <class Number, class Kind>
HWY_INLINE void solve_tree_lanes(double h, const TreeForm& form, TreeLanes<Kind>& trees) {
  for (int lane = 0; lane < Kind::kCount; lane += kLanesOf<Number>) {
    TreeSweep<Number, Kind>(form, trees, lane).run(trees);
    const Number converged = Number(1.0) - get<Number>(trees.changed + lane);
    TreeStiffness<Number, Kind> stiffness(h, form, trees, lane);
    write(stiffness.stiffen(converged), trees.grew + lane);
    stiffness.find_changes();
  }
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
