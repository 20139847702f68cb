/// Bending of yarns in the Numbers of solver/simd/numbers.h, in double: stiff cloth of light points has
/// matrices whose numbers differ by a factor of 1e5 and more. Included anew for each instruction set.

#if defined(HOOKE_SOLVER_SOFT_YARN_BEND_ROWS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HOOKE_SOLVER_SOFT_YARN_BEND_ROWS_H
#undef HOOKE_SOLVER_SOFT_YARN_BEND_ROWS_H
#else
#define HOOKE_SOLVER_SOFT_YARN_BEND_ROWS_H
#endif

#include "solver/simd/double_records.h"
#include "solver/simd/numbers.h"
#include "solver/soft/yarn_kernels.h"

#include <cstdint>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hooke::solver::wide::HWY_NAMESPACE {

/// The bend at a node: its curvature is c = behind (x_{i+1} - x_i) - before (x_i - x_{i-1}).
template <class Number>
struct YarnBend {
  Number stiffness, before, behind;
  Triple<Number> pull;  ///< k (h c + s dc/dt), the moment's impulse over the lengths.

  /// Weights of the node before, of the node itself and of the next in c.
  [[nodiscard]] HWY_INLINE Number middle() const { return Number(0.0) - (before + behind); }
};

/// Yarns from `lane` on while their nodes are eliminated, from the first to the last.
template <class Number>
class YarnBendSweep {
 public:
  HWY_INLINE YarnBendSweep(const YarnRow* rows, YarnBendRow* bends, std::uint32_t links, int lane,
                           const YarnBendTime& time, const Real* position, Real* velocity)
      : rows_(rows),
        bends_(bends),
        links_(links),
        lane_(lane),
        h_(time.h),
        share_(time.share),
        position_(position),
        velocity_(velocity) {}

  HWY_INLINE void run() {
    forward();
    back();
  }

 private:
  static HWY_INLINE YarnBend<Number> no_bend() {
    const Number none(0.0);
    return {none, none, none, {none, none, none}};
  }

  /// What lies between a node and the next.
  struct Link {
    Triple<Number> line, rate;
  };
  HWY_INLINE Link link(std::uint32_t i, const Quad<Number>& v0, const Quad<Number>& v1) const {
    Quad<Number> x0, x1;
    read_quad_widened(position_, rows_[i].record + lane_, x0);
    read_quad_widened(position_, rows_[i + 1].record + lane_, x1);
    return {{x1.x - x0.x, x1.y - x0.y, x1.z - x0.z}, {v1.x - v0.x, v1.y - v0.y, v1.z - v0.z}};
  }

  HWY_INLINE YarnBend<Number> bend_at(std::uint32_t i, const Link& link_before,
                                      const Link& link_behind) const {
    const YarnBendRow& row = bends_[i];
    YarnBend<Number> bend = {get<Number>(row.stiffness + lane_),
                             get<Number>(bends_[i - 1].per_rest + lane_),
                             get<Number>(row.per_rest + lane_),
                             {}};
    const auto change = [&](const Triple<Number>& behind, const Triple<Number>& before) HWY_ATTR {
      return difference(scaled(bend.behind, behind), scaled(bend.before, before));
    };
    bend.pull = scaled(bend.stiffness, sum(scaled(h_, change(link_behind.line, link_before.line)),
                                           scaled(share_, change(link_behind.rate, link_before.rate))));
    return bend;
  }

  /// The change of velocity of a node, if those of the next two were zero, and its shares of these.
  struct Eliminated {
    Triple<Number> change;
    Number next, second;
  };
  HWY_INLINE void store(std::uint32_t i, const Eliminated& node) const {
    put3(node.change, bends_[i].change, lane_);
    write(node.next, bends_[i].next + lane_);
    write(node.second, bends_[i].second + lane_);
  }

  /// Solves (1 + s w K) change = -w K (h x + s v) for the change of velocities, where s = h^2 + h tau, by
  /// elimination without pivots: but for the factors w the matrix is symmetric and positive definite.
  HWY_INLINE void forward() {
    const Number none(0.0);
    const Number one(1.0);
    YarnBend<Number> before = no_bend();
    YarnBend<Number> here = no_bend();
    YarnBend<Number> next = no_bend();
    Quad<Number> v, v1;
    read_quad_widened(velocity_, rows_[0].record + lane_, v);
    read_quad_widened(velocity_, rows_[1].record + lane_, v1);
    Link link_behind = link(0, v, v1);
    Eliminated last = {{none, none, none}, none, none};
    Eliminated second_last = last;
    for (std::uint32_t i = 0; i <= links_; ++i) {
      Quad<Number> v2 = v1;
      next = no_bend();
      if (i + 1 < links_) {
        read_quad_widened(velocity_, rows_[i + 2].record + lane_, v2);
        const Link further = link(i + 1, v1, v2);
        next = bend_at(i + 1, link_behind, further);
        link_behind = further;
      }
      const Number c = share_ * v.w;
      const Number sub2 = c * (before.stiffness * before.before * before.behind);
      const Number sub1 = c * (before.stiffness * before.middle() * before.behind +
                               here.stiffness * here.before * here.middle());
      const Number own = before.stiffness * before.behind * before.behind +
                         here.stiffness * here.middle() * here.middle() +
                         next.stiffness * next.before * next.before;
      const Number super1 =
          c * (here.stiffness * here.middle() * here.behind + next.stiffness * next.before * next.middle());
      const Number super2 = c * (next.stiffness * next.before * next.behind);
      Triple<Number> rest = scaled(before.behind, before.pull);
      add(here.middle(), here.pull, rest);
      add(next.before, next.pull, rest);
      rest = scaled(none - v.w, rest);

      const Number sub = sub1 - sub2 * second_last.next;
      take(sub2, second_last.change, rest);
      take(sub, last.change, rest);
      const Number inverse = quotient(one, one + c * own - sub2 * second_last.second - sub * last.next);
      second_last = last;
      last = {scaled(inverse, rest), inverse * (super1 - sub * last.second), inverse * super2};
      store(i, last);
      before = here;
      here = next;
      v = v1;
      v1 = v2;
    }
  }

  HWY_INLINE void back() {
    const Number none(0.0);
    Triple<Number> next = {none, none, none}, second = next;
    for (std::uint32_t i = links_ + 1; i-- > 0;) {
      const YarnBendRow& row = bends_[i];
      Triple<Number> change = get3<Number>(row.change, lane_);
      take(get<Number>(row.next + lane_), next, change);
      take(get<Number>(row.second + lane_), second, change);
      Quad<Number> v;
      read_quad_widened(velocity_, rows_[i].record + lane_, v);
      write_quad_narrowed(Quad<Number>{v.x + change.x, v.y + change.y, v.z + change.z, v.w}, velocity_,
                          rows_[i].record + lane_);
      second = next;
      next = change;
    }
  }

  const YarnRow* rows_;
  YarnBendRow* bends_;
  std::uint32_t links_;
  int lane_;
  Number h_, share_;
  const Real* position_;
  Real* velocity_;
};

template <class Number>
HWY_INLINE void bend_yarn_block(const YarnBlock& block, const YarnRow* rows, YarnBendRow* bends,
                                const YarnBendTime& time, const state::PositionRecord* positions,
                                state::VelocityRecord* velocities) {
  const auto* position = reinterpret_cast<const Real*>(positions);
  auto* velocity = reinterpret_cast<Real*>(velocities);
  for (int lane = 0; lane < block.count; lane += kLanesOf<Number>)
    YarnBendSweep<Number>(rows, bends, block.row_count - 1, lane, time, position, velocity).run();
}

}  // namespace hooke::solver::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
