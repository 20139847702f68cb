/// Rows of trees of joints, in Numbers of solver/simd/numbers.h, as solver/joint_rows/joint_rows.h has them.
/// Included again for each instruction set.

#if defined(HOOKE_SOLVER_JOINT_TREE_ROWS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_JOINT_TREE_ROWS_H
#undef HOOKE_SOLVER_JOINT_TREE_ROWS_H
#else
#define HOOKE_SOLVER_JOINT_TREE_ROWS_H
#endif

#include "solver/joint/tree_kernels.h"
#include "solver/joint/tree_stiffness.h"
#include "solver/joint_rows/joint_freedoms.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

/// One lane, or vector of lanes, of the trees.
template <class Number, class Kind>
class TreeRows {
 public:
  using Lane = typename Kind::Lane;
  static constexpr int kCount = Kind::kCount;
  using Link = TreeLinkLanes<Kind>;
  using Joint = TreeJointLanes<Kind>;
  using Row = TreeRowLanes<Kind>;

  HWY_INLINE TreeRows(double h, const TreeForm& form, TreeLanes<Kind>& trees, int lane)
      : form_(form), trees_(trees), lane_(lane), h_(h), per_h_(quotient(Number(1.0), Number(h))) {}

  HWY_INLINE void make() {
    for (Link& link : trees_.links) find_inertia(link);
    for (std::size_t i = 0; i < form_.joints.size(); ++i) {
      const TreeJoint& shape = form_.joints[i];
      const JointEnd<Number> a = end_now(link_a(i));
      const JointEnd<Number> b = end_now(link_b(i));
      const Before before = values_of(trees_.joints[i]);
      const Freedoms<Number> f = find(shape, trees_.joints[i], a, b);
      const Speeds fastest = fastest_of(link_a(i), link_b(i));
      for (int r = shape.first; r < shape.first + shape.count; ++r) {
        const TreeRowForm& form = form_.rows[r];
        Row& row = trees_.rows[r];
        const RowNow now = make_row(form, f, a, b, fastest, row);
        write_row(form, shape.child_is_b, now, row);
        if (form.role == RowRole::kSpring || form.sprung)
          put(f.value[form.freedom] - at(row.goal), row.start);
        first_bound(form, now, row);
        if (Kind::kApproximate && form.role == RowRole::kMotor) {
          const Number moved = per_h_ * (f.value[form.freedom] - before.value[form.freedom]);
          soften_motor(form, slide_of(form, moved, now, link_a(i), link_b(i)), row);
        }
      }
    }
  }

  /// Makes rows about the end of the substep, where C = c + h J (v' - v) for another velocity v'.
  HWY_INLINE Number make_ahead() {
    Number worst(0.0);
    for (std::size_t i = 0; i < form_.joints.size(); ++i) {
      const TreeJoint& shape = form_.joints[i];
      Joint& joint = trees_.joints[i];
      const Link& link_of_a = link_a(i);
      const Link& link_of_b = link_b(i);
      const JointEnd<Number> a = end_ahead(link_of_a);
      const JointEnd<Number> b = end_ahead(link_of_b);
      const Freedoms<Number> f = find(shape, joint, a, b);
      const Speeds fastest = fastest_of(link_of_a, link_of_b);
      const Number size = size_of(joint, link_of_a, link_of_b);
      const Triple<Number> v =
          difference(get3<Number>(link_of_b.v_now, lane_), get3<Number>(link_of_a.v_now, lane_));
      for (int r = shape.first; r < shape.first + shape.count; ++r) {
        const TreeRowForm& row_form = form_.rows[r];
        Row& row = trees_.rows[r];
        RowNow now = make_row(row_form, f, a, b, fastest, row);
        Number rate = dot(now.j_b, get3<Number>(link_of_b.omega_now, lane_)) -
                      dot(now.j_a, get3<Number>(link_of_a.omega_now, lane_));
        if (!row_form.turns()) rate = rate + dot(now.n, v);
        const Number displacement = Number(h_) * rate;
        // An error beyond the speed limit is removed along the row that exists.
        if (row_form.role == RowRole::kLock) {
          const Number size_of_c = size_of_number(now.c);
          if (any(above(Number(0.999) * now.rate * size_of_c, size_of_number(now.target)))) continue;
          worst = larger(worst, row_form.turns() ? size_of_c : quotient(size_of_c, size));
        }
        now.target = now.target + now.rate * displacement;
        if (row_form.sprung) now.spring_target = now.spring_target + now.spring_rate * displacement;
        write_row(row_form, shape.child_is_b, now, row);
      }
    }
    return worst;
  }

  /// Clamps impulses to their bounds, and finds the velocities that they give and the stiffness.
  HWY_INLINE void clamp() {
    const Number zero(0.0);
    for (Link& link : trees_.links) {
      put3(get3<Number>(link.v, lane_), link.v_now, lane_);
      put3(get3<Number>(link.omega, lane_), link.omega_now, lane_);
    }
    for (std::size_t i = 0; i < form_.joints.size(); ++i) {
      const TreeJoint& shape = form_.joints[i];
      Link& child = trees_.links[i];
      Link& parent = trees_.links[shape.parent];
      Triple<Number> p = {zero, zero, zero};
      Triple<Number> on_child = p;
      Triple<Number> on_parent = p;
      Triple<Number> angular = p;
      for (int r = shape.first; r < shape.first + shape.count; ++r) {
        const TreeRowForm& row_form = form_.rows[r];
        Row& row = trees_.rows[r];
        Number lambda = at(row.lambda);
        if (row_form.bounded()) {
          lambda = smaller(larger(lambda, at(row.low)), at(row.high));
          put(lambda, row.lambda);
        }
        if (row_form.sprung) lambda = lambda + at(row.spring_lambda);
        add(lambda, get3<Number>(row.n, lane_), row_form.turns() ? angular : p);
        add(lambda, get3<Number>(row.child, lane_), on_child);
        add(lambda, get3<Number>(row.parent, lane_), on_parent);
      }
      push(p, on_child, child);
      if (shape.parent_moves) push(scaled(Number(-1.0), p), on_parent, parent);
      const Number sign(shape.child_is_b ? 1.0 : -1.0);
      put3(scaled(sign, p), trees_.joints[i].impulse, lane_);
      put3(scaled(sign, angular), trees_.joints[i].angular, lane_);
    }
    TreeStiffness<Number, Kind> stiffness(h_, form_, trees_, lane_);
    put(stiffness.stiffen(Number(1.0)), trees_.grew);
    stiffness.find_changes();
  }

 private:
  /// A row as it is now, on b.
  struct RowNow {
    Triple<Number> n, j_a, j_b;  ///< `n` is the axis of an angle.
    Number c, rate, target, gamma;
    Number spring_rate, spring_target, spring_gamma;
  };
  struct Speeds {
    Number displacement, turn;
  };
  struct Before {
    Number value[6];
  };

  HWY_INLINE Number at(const Lane (&lanes)[kCount]) const { return get<Number>(lanes + lane_); }
  HWY_INLINE void put(const Number& value, Lane (&lanes)[kCount]) const { write(value, lanes + lane_); }
  HWY_INLINE Quad<Number> get4(const Lane (&from)[4][kCount]) const {
    return {at(from[0]), at(from[1]), at(from[2]), at(from[3])};
  }
  HWY_INLINE Scale<Number> get6(const Lane (&from)[6][kCount]) const {
    return {at(from[0]), at(from[1]), at(from[2]), at(from[3]), at(from[4]), at(from[5])};
  }

  /// Finds the rotation, and S = I^(-1/2) in world axes. For a gyroscopic turn it is that of now;
  /// state::Bodies have that of the step's start.
  HWY_INLINE void find_inertia(Link& link) const {
    const Number zero(0.0);
    const Scale<Number> step = get6(link.step_scale);
    const Quad<Number> turn = quaternion_of_small(step.times(get3<Number>(link.turned, lane_)));
    const Quad<Number> rotation = normalized(product(turn, get4(link.rotation)));
    put(rotation.x, link.rotation[0]);
    put(rotation.y, link.rotation[1]);
    put(rotation.z, link.rotation[2]);
    put(rotation.w, link.rotation[3]);
    put6({zero, zero, zero, zero, zero, zero}, link.stiffness);
    put6(diagonal(Number(1.0)), link.turning);
    const Scale<Number> step_inverse = inverse(step);
    put6(step_inverse, link.step_scale_inverse);
    const Triple<Number> given = get3<Number>(link.omega_before, lane_);
    const auto is_gyroscopic = above(at(link.is_gyroscopic), zero);
    if (!any(is_gyroscopic)) {
      put6(step, link.scale);
      put6(step_inverse, link.scale_inverse);
      put3(given, link.omega, lane_);
      return;
    }
    const Axes<Number> r = axes_of(product(rotation, normalized(get4(link.principal))));
    const Triple<Number> inertia = get3<Number>(link.inertia, lane_);
    const Triple<Number> roots = {root(inertia.x), root(inertia.y), root(inertia.z)};
    const Number one(1.0);
    const Scale<Number> now =
        in_axes(r, {quotient(one, roots.x), quotient(one, roots.y), quotient(one, roots.z)});
    const Scale<Number> now_inverse = in_axes(r, roots);
    const Triple<Number> turned = now_inverse.times(step.times(given));
    put6(chosen(is_gyroscopic, now, step), link.scale);
    put6(chosen(is_gyroscopic, now_inverse, step_inverse), link.scale_inverse);
    const Triple<Number> omega = {choose(is_gyroscopic, turned.x, given.x),
                                  choose(is_gyroscopic, turned.y, given.y),
                                  choose(is_gyroscopic, turned.z, given.z)};
    put3(omega, link.omega_before, lane_);
    put3(omega, link.omega, lane_);
  }
  /// A matrix with these eigenvalues along the axes.
  static HWY_INLINE Scale<Number> in_axes(const Axes<Number>& r, const Triple<Number>& d) {
    const auto entry = [&](Number Triple<Number>::*i, Number Triple<Number>::*k) HWY_ATTR {
      return d.x * (r.x.*i * r.x.*k) + d.y * (r.y.*i * r.y.*k) + d.z * (r.z.*i * r.z.*k);
    };
    using T = Triple<Number>;
    return {entry(&T::x, &T::x), entry(&T::x, &T::y), entry(&T::x, &T::z),
            entry(&T::y, &T::y), entry(&T::y, &T::z), entry(&T::z, &T::z)};
  }
  template <class Condition>
  static HWY_INLINE Scale<Number> chosen(const Condition& condition, const Scale<Number>& yes,
                                         const Scale<Number>& no) {
    return {choose(condition, yes.xx, no.xx), choose(condition, yes.xy, no.xy),
            choose(condition, yes.xz, no.xz), choose(condition, yes.yy, no.yy),
            choose(condition, yes.yz, no.yz), choose(condition, yes.zz, no.zz)};
  }
  HWY_INLINE void put6(const Scale<Number>& m, Lane (&to)[6][kCount]) const {
    put(m.xx, to[0]);
    put(m.xy, to[1]);
    put(m.xz, to[2]);
    put(m.yy, to[3]);
    put(m.yz, to[4]);
    put(m.zz, to[5]);
  }

  HWY_INLINE const Link& link_a(std::size_t i) const {
    const TreeJoint& shape = form_.joints[i];
    return trees_.links[shape.child_is_b ? static_cast<std::size_t>(shape.parent) : i];
  }
  HWY_INLINE const Link& link_b(std::size_t i) const {
    const TreeJoint& shape = form_.joints[i];
    return trees_.links[shape.child_is_b ? i : static_cast<std::size_t>(shape.parent)];
  }

  HWY_INLINE JointEnd<Number> end_now(const Link& link) const {
    const Number zero(0.0);
    return {get3<Number>(link.center, lane_), {zero, zero, zero}, get4(link.rotation), get6(link.scale)};
  }
  /// The end as it will be at the end of the substep with the velocity that was found.
  HWY_INLINE JointEnd<Number> end_ahead(const Link& link) const {
    JointEnd<Number> end = end_now(link);
    end.ahead = scaled(Number(h_), get3<Number>(link.v_now, lane_));
    end.center = sum(end.center, end.ahead);
    const Triple<Number> turn = end.scale.times(scaled(Number(h_), get3<Number>(link.omega_now, lane_)));
    end.rotation = product(quaternion_of(turn), end.rotation);
    return end;
  }

  /// Finds the present freedoms and notes their values.
  HWY_INLINE Freedoms<Number> find(const TreeJoint& shape, Joint& joint, const JointEnd<Number>& a,
                                   const JointEnd<Number>& b) const {
    const HookFrame<Number> frame = {get3<Number>(joint.anchor_a, lane_), get3<Number>(joint.anchor_b, lane_),
                                     normalized(get4(joint.axes_a)), normalized(get4(joint.axes_b))};
    const Triple<Number> before = {at(joint.value[3]), at(joint.value[4]), at(joint.value[5])};
    Freedoms<Number> f = find_freedoms(shape.kind, shape.turns, frame, a, b, before);
    for (int i = 0; i < (shape.turns ? 6 : 3); ++i) put(f.value[i], joint.value[i]);
    return f;
  }

  HWY_INLINE Before values_of(const Joint& joint) const {
    Before before;
    for (int i = 0; i < 6; ++i) before.value[i] = at(joint.value[i]);
    return before;
  }

  HWY_INLINE Speeds fastest_of(const Link& a, const Link& b) const {
    const Triple<Number> v = difference(get3<Number>(b.v, lane_), get3<Number>(a.v, lane_));
    const Triple<Number> turn = difference(get6(b.scale).times(get3<Number>(b.omega_before, lane_)),
                                           get6(a.scale).times(get3<Number>(a.omega_before, lane_)));
    return {Number(kJointPushSpeed) + root(dot(v, v)), Number(kJointPushSpeed) + root(dot(turn, turn))};
  }

  /// The length that a joint's gap is compared with: its levers on bodies that move [m].
  HWY_INLINE Number size_of(const Joint& joint, const Link& a, const Link& b) const {
    const Number zero(0.0);
    const auto lever = [&](const Lane(&anchor)[3][kCount], const Link& link) HWY_ATTR {
      const Triple<Number> r = get3<Number>(anchor, lane_);
      return choose(above(at(link.mass), zero), root(dot(r, r)), zero);
    };
    return larger(Number(kLeastJointLever), lever(joint.anchor_a, a) + lever(joint.anchor_b, b));
  }

  HWY_INLINE RowNow make_row(const TreeRowForm& form, const Freedoms<Number>& f, const JointEnd<Number>& a,
                             const JointEnd<Number>& b, const Speeds& fastest, const Row& row) const {
    const Number zero(0.0);
    RowNow now;
    const bool is_twist = form.freedom == kTwistFreedom && form.role == RowRole::kLimit && f.is_ball;
    const int freedom = is_twist ? kBallTwist : form.freedom;
    now.n = f.axis[freedom];
    if (form.turns()) {
      now.j_a = a.scale.times(now.n);
      now.j_b = b.scale.times(now.n);
    } else {
      now.j_a = a.scale.times(cross(f.r_a, now.n));
      now.j_b = b.scale.times(cross(f.r_b, now.n));
    }
    now.gamma = zero;
    now.rate = zero;
    const Number value = f.value[freedom];
    switch (form.role) {
      case RowRole::kLock: {
        now.c = value - at(row.goal);
        if (form.turns()) now.c = now.c - whole_turns_of(now.c);
        now.rate = per_h_;
        const Number most = form.turns() ? fastest.turn : fastest.displacement;
        now.target = smaller(larger(zero - now.rate * now.c, zero - most), most);
        break;
      }
      case RowRole::kSpring:
        make_spring(value - at(row.goal), row, now.rate, now.gamma, now.target);
        now.c = zero;
        break;
      case RowRole::kMotor:
        now.c = zero;
        now.target = at(row.speed);
        if (form.sprung)
          make_spring(value - at(row.goal), row, now.spring_rate, now.spring_gamma, now.spring_target);
        break;
      case RowRole::kLimit: {
        const Number from_lower = value - at(row.lower);
        const Number from_upper = at(row.upper) - value;
        const Number sign = choose(above(from_lower, from_upper), Number(-1.0), Number(1.0));
        now.n = scaled(sign, now.n);
        now.j_a = scaled(sign, now.j_a);
        now.j_b = scaled(sign, now.j_b);
        now.c = smaller(from_lower, from_upper);
        now.rate = choose(above(now.c, zero), per_h_, Number(kJointLimitShare) * per_h_);
        now.target = smaller(zero - now.rate * now.c, Number(kJointLimitSpeed));
        break;
      }
    }
    return now;
  }

  HWY_INLINE void make_spring(const Number& c, const Row& row, Number& rate, Number& gamma,
                              Number& target) const {
    const Number k = at(row.stiffness);
    const Number sum = at(row.damping) + Number(h_) * k;
    gamma = quotient(Number(1.0), Number(h_) * sum);
    rate = quotient(k, sum);
    target = Number(0.0) - rate * c;
  }

  HWY_INLINE void write_row(const TreeRowForm& form, bool child_is_b, const RowNow& now, Row& row) const {
    const Number minus(-1.0);
    put3(child_is_b ? now.n : scaled(minus, now.n), row.n, lane_);
    put3(child_is_b ? now.j_b : scaled(minus, now.j_a), row.child, lane_);
    put3(child_is_b ? scaled(minus, now.j_a) : now.j_b, row.parent, lane_);
    put(now.gamma, row.gamma);
    put(now.target, row.target);
    if (!form.sprung) return;
    put(now.spring_gamma, row.spring_gamma);
    put(now.spring_target, row.spring_target);
    put(quotient(now.spring_target - now.target, now.spring_gamma), row.held_spring);
  }

  /// Sets the bound of a row to that where it ended the last substep.
  HWY_INLINE void first_bound(const TreeRowForm& form, const RowNow& now, Row& row) const {
    if (!form.bounded()) return;
    const Number zero(0.0);
    const Number one(1.0);
    const Number last = at(row.lambda);
    put(zero, row.freed);
    if (form.role == RowRole::kLimit) {
      put(choose(above(last, zero), zero, choose(above(now.c, zero), zero - one, zero)), row.bound);
      return;
    }
    const Number nearly = Number(0.999) * at(row.high);
    put(choose(above(last, nearly), one, choose(above(zero - nearly, last), zero - one, zero)), row.bound);
  }

  /// How fast friction may slide in this substep: as in the last one, or as a jolt demands.
  HWY_INLINE Number slide_of(const TreeRowForm& form, const Number& last, const RowNow& now, const Link& a,
                             const Link& b) const {
    Number rate =
        dot(now.j_b, get3<Number>(b.omega_before, lane_)) - dot(now.j_a, get3<Number>(a.omega_before, lane_));
    if (!form.turns())
      rate = rate + dot(now.n, difference(get3<Number>(b.v, lane_), get3<Number>(a.v, lane_)));
    const Number jolt = Number(kApproximateJolt) * size_of_number(rate);
    return larger(larger(size_of_number(last), jolt), Number(kApproximateSlide));
  }

  /// In an approximate tree, friction that slides is viscous, and one row with the spring beside it. It
  /// slides at `speed`.
  HWY_INLINE void soften_motor(const TreeRowForm& form, const Number& speed, Row& row) const {
    const Number zero(0.0);
    Number gamma = quotient(speed, at(row.high));
    Number target = zero;
    if (form.sprung) {
      const Number share = quotient(gamma, gamma + at(row.spring_gamma));
      target = share * at(row.spring_target);
      gamma = share * at(row.spring_gamma);
      put(zero, row.held_spring);
    }
    put(gamma, row.gamma);
    put(target, row.target);
    put(zero, row.bound);
  }

  HWY_INLINE void push(const Triple<Number>& p, const Triple<Number>& turn, Link& link) const {
    Triple<Number> v = get3<Number>(link.v_now, lane_);
    add(at(link.inverse_mass), p, v);
    put3(v, link.v_now, lane_);
    const Triple<Number> change = inverse(get6(link.turning)).times(turn);
    put3(sum(get3<Number>(link.omega_now, lane_), change), link.omega_now, lane_);
  }

  const TreeForm& form_;
  TreeLanes<Kind>& trees_;
  int lane_;
  double h_;
  Number per_h_;
};

template <class Number, class Kind>
HWY_INLINE void make_tree_row_lanes(double h, const TreeForm& form, TreeLanes<Kind>& trees) {
  for (int lane = 0; lane < Kind::kCount; lane += kLanesOf<Number>) {
    TreeRows<Number, Kind>(h, form, trees, lane).make();
    TreeStiffness<Number, Kind>(h, form, trees, lane).stiffen(Number(1.0));
  }
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
