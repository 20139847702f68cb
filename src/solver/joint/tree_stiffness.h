/// The geometric stiffness of links in Numbers of solver/simd/numbers.h, as
/// solver/joint_rows/geometric_stiffness.h has it. Included again for each instruction set.

#if defined(HOOKE_SOLVER_JOINT_TREE_STIFFNESS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_JOINT_TREE_STIFFNESS_H
#undef HOOKE_SOLVER_JOINT_TREE_STIFFNESS_H
#else
#define HOOKE_SOLVER_JOINT_TREE_STIFFNESS_H
#endif

#include "solver/joint/tree_kernels.h"
#include "solver/joint_rows/geometric_stiffness.h"
#include "solver/joint_rows/joint_freedoms.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

/// One lane, or vector of lanes, of the trees.
template <class Number, class Kind>
class TreeStiffness {
 public:
  using Lane = typename Kind::Lane;
  static constexpr int kCount = Kind::kCount;
  using Link = TreeLinkLanes<Kind>;
  using Joint = TreeJointLanes<Kind>;

  HWY_INLINE TreeStiffness(double h, const TreeForm& form, TreeLanes<Kind>& trees, int lane)
      : form_(form), trees_(trees), lane_(lane), h_(h) {}

  /// Finds what the links' velocities mean to state::Bodies.
  HWY_INLINE void find_changes() {
    for (Link& link : trees_.links) {
      const Triple<Number> omega = get3<Number>(link.omega_now, lane_);
      const Triple<Number> change = difference(omega, get3<Number>(link.omega_before, lane_));
      put3(get6(link.scale_inverse).times(change), link.gained, lane_);
      const auto is_gyroscopic = above(at(link.is_gyroscopic), Number(0.0));
      Triple<Number> of_step = omega;
      if (any(is_gyroscopic)) {
        const Triple<Number> scaled = get6(link.step_scale_inverse).times(get6(link.scale).times(omega));
        of_step = {choose(is_gyroscopic, scaled.x, omega.x), choose(is_gyroscopic, scaled.y, omega.y),
                   choose(is_gyroscopic, scaled.z, omega.z)};
      }
      put3(of_step, link.omega_of_step, lane_);
    }
  }

  /// Where `only` is above 0, sets the stiffness under the impulses of the joints, if it is more than before.
  /// Returns 1 where it grew so much that a solution found without it is not to be trusted.
  HWY_INLINE Number stiffen(const Number& only) {
    const Number zero(0.0);
    Number grew = zero;
    if (!matters()) return grew;
    for (std::size_t i = 0; i < form_.joints.size(); ++i) {
      const TreeJoint& shape = form_.joints[i];
      const Joint& joint = trees_.joints[i];
      const Triple<Number> force =
          scaled(quotient(Number(1.0), Number(h_)), get3<Number>(joint.impulse, lane_));
      const Number sign = Number(shape.child_is_b ? 1.0 : -1.0);
      add_to(shape.child_is_b ? joint.anchor_b : joint.anchor_a, scaled(sign, force), trees_.links[i]);
      if (shape.parent_moves) {
        add_to(shape.child_is_b ? joint.anchor_a : joint.anchor_b, scaled(zero - sign, force),
               trees_.links[static_cast<std::size_t>(shape.parent)]);
      }
    }
    for (Link& link : trees_.links) take_found(only, link, grew);
    return grew;
  }

 private:
  HWY_INLINE Number at(const Lane (&lanes)[kCount]) const { return get<Number>(lanes + lane_); }
  template <std::size_t kFields>
  HWY_INLINE Scale<Number> get6(const Lane (&from)[kFields][kCount]) const {
    return {at(from[0]), at(from[1]), at(from[2]), at(from[3]), at(from[4]), at(from[5])};
  }
  template <std::size_t kFields>
  HWY_INLINE void put6(const Scale<Number>& m, Lane (&to)[kFields][kCount]) const {
    const Number* entries[6] = {&m.xx, &m.xy, &m.xz, &m.yy, &m.yz, &m.zz};
    for (int i = 0; i < 6; ++i) write(*entries[i], to[i] + lane_);
  }
  static HWY_INLINE Number trace_of(const Scale<Number>& m) { return m.xx + m.yy + m.zz; }

  /// Whether any stiffness may be more than what is left explicit, even where a solution is repeated for it.
  /// Its trace is at most h^2 tr S^2 times the sum of |r| |F|.
  HWY_INLINE bool matters() {
    const Number zero(0.0);
    for (Link& link : trees_.links) {
      write(zero, link.u[0] + lane_);
      for (int k = 0; k < 6; ++k) write(zero, link.g[k] + lane_);
    }
    const Number least(h_ / (kStiffnessLeft / kStiffnessGrowth));
    Number most = zero;
    for (std::size_t i = 0; i < form_.joints.size(); ++i) {
      const TreeJoint& shape = form_.joints[i];
      const Joint& joint = trees_.joints[i];
      const Triple<Number> p = get3<Number>(joint.impulse, lane_);
      const Triple<Number> a = get3<Number>(joint.anchor_a, lane_);
      const Triple<Number> b = get3<Number>(joint.anchor_b, lane_);
      const Number p2 = dot(p, p);
      add_bound(root(p2 * dot(shape.child_is_b ? b : a, shape.child_is_b ? b : a)), trees_.links[i]);
      if (shape.parent_moves) {
        add_bound(root(p2 * dot(shape.child_is_b ? a : b, shape.child_is_b ? a : b)),
                  trees_.links[static_cast<std::size_t>(shape.parent)]);
      }
    }
    for (const Link& link : trees_.links) {
      const Scale<Number> s = get6(link.scale);
      const Number square =
          s.xx * s.xx + s.yy * s.yy + s.zz * s.zz + Number(2.0) * (s.xy * s.xy + s.xz * s.xz + s.yz * s.yz);
      most = larger(most, at(link.u[0]) * square);
    }
    return any(above(least * most, Number(1.0)));
  }
  HWY_INLINE void add_bound(const Number& size, Link& link) const {
    write(at(link.u[0]) + size, link.u[0] + lane_);
  }

  /// Adds the part of one joint to `g` of the link.
  HWY_INLINE void add_to(const Lane (&anchor)[3][kCount], const Triple<Number>& force, Link& link) const {
    const Number zero(0.0);
    const Quad<Number> rotation = {at(link.rotation[0]), at(link.rotation[1]), at(link.rotation[2]),
                                   at(link.rotation[3])};
    const Triple<Number> r = rotated(rotation, get3<Number>(anchor, lane_));
    const Number length_r = root(dot(r, r));
    const Number length_f = root(dot(force, force));
    const Triple<Number> s = sum(unit_of(r, length_r), unit_of(force, length_f));
    const Number size = Number(0.25 * h_ * h_) * (length_r * length_f);
    const Number square = dot(s, s);
    const Scale<Number> k = {size * (square - s.x * s.x), zero - size * (s.x * s.y),
                             zero - size * (s.x * s.z),   size * (square - s.y * s.y),
                             zero - size * (s.y * s.z),   size * (square - s.z * s.z)};
    const Scale<Number> scale = get6(link.scale);
    const Triple<Number> x = scale.times(k.times({scale.xx, scale.xy, scale.xz}));
    const Triple<Number> y = scale.times(k.times({scale.xy, scale.yy, scale.yz}));
    const Triple<Number> z = scale.times(k.times({scale.xz, scale.yz, scale.zz}));
    const Number half(0.5);
    put6(hooke::solver::wide::HWY_NAMESPACE::sum(
             get6(link.g),
             Scale<Number>{x.x, half * (x.y + y.x), half * (x.z + z.x), y.y, half * (y.z + z.y), z.z}),
         link.g);
  }

  HWY_INLINE void take_found(const Number& only, Link& link, Number& grew) const {
    const Number zero(0.0);
    const Number one(1.0);
    const Scale<Number> found = get6(link.g);
    const Scale<Number> before = get6(link.stiffness);
    const Number size = trace_of(found);
    const Number size_before = trace_of(before);
    const Number more = choose(above(size, size_before), only, zero);
    const auto takes = above(more, zero);
    const Number enough = larger(Number(kStiffnessGrowth) * size_before, Number(kStiffnessLeft));
    grew = choose(takes, choose(above(size, enough), one, grew), grew);
    const Scale<Number> now = {choose(takes, found.xx, before.xx), choose(takes, found.xy, before.xy),
                               choose(takes, found.xz, before.xz), choose(takes, found.yy, before.yy),
                               choose(takes, found.yz, before.yz), choose(takes, found.zz, before.zz)};
    put6(now, link.stiffness);
    const Number trace = trace_of(now);
    const auto is_stiff = above(trace, Number(kStiffnessLeft));
    const Number share = choose(is_stiff, one - quotient(Number(kStiffnessLeft), trace), zero);
    const Scale<Number> excess = scaled(share, now);
    const Scale<Number> turning =
        hooke::solver::wide::HWY_NAMESPACE::sum(diagonal(one), scaled(Number(1 + kStiffnessDamping), excess));
    put6(turning, link.turning);
    const Triple<Number> omega = get3<Number>(link.omega_before, lane_);
    const Triple<Number> lost =
        scaled(Number(kStiffnessDamping), inverse(turning).times(excess.times(omega)));
    put3(difference(omega, lost), link.omega, lane_);
  }

  const TreeForm& form_;
  TreeLanes<Kind>& trees_;
  int lane_;
  double h_;
};

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
