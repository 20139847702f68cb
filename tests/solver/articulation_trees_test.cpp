#include "solver/joint_rig.h"
#include "solver/soft/particle_kernels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <doctest/doctest.h>
#include <string>
#include <vector>

namespace hooke::solver {
namespace {

constexpr int kFigures = 11;
constexpr int kParts = 6;

/// A trunk, two arms of two parts each that have springs, friction and limits, and a drawer, all thrown: some
/// hardly turn, some so fast that their rows are made anew within a substep. Others hang from the world. The
/// drawers of every second one are not driven: those are loose.
void add_figure(int number, JointRig& rig) {
  const double z = 10 * number;
  const Real spin = Real(number * number);
  std::array<BodyId, kParts> parts;
  const std::array<double, kParts> x = {0, 1, 2, -1, -2, 0};
  for (int i = 0; i < kParts; ++i) {
    parts[i] = rig.add({.center = {x[i], i == 5 ? 1.0 : 0.0, z},
                        .mass = Real(i == 0 ? 5 : 1),
                        .inertia = {Real(0.02), Real(0.1), Real(0.11)},
                        .velocity = {Real(i), Real(0), Real(0)},
                        .angular_velocity = {spin, Real(0.1) * spin, Real(i) - spin}});
  }
  const auto shoulder = [&](BodyId arm, double at) {
    rig.hook({.a = {parts[0]},
              .b = {arm},
              .anchor = {at, 0, z},
              .axis = {Real(1), Real(0), Real(0)},
              .limits = {Real(-0.3), Real(0.3)},
              .cone = Real(0.5),
              .spring = {.stiffness = Real(10), .damping = Real(2)},
              .motor = {.max_force = Real(1)}});
  };
  const auto elbow = [&](BodyId a, BodyId b, double at) {
    rig.hook({.kind = HookKind::kHinge,
              .a = {a},
              .b = {b},
              .anchor = {at, 0, z},
              .limits = {Real(0), Real(1)},
              .spring = {.stiffness = Real(5), .damping = Real(1)},
              .motor = {.max_force = Real(0.5)}});
  };
  shoulder(parts[1], 0.5);
  shoulder(parts[3], -0.5);
  elbow(parts[1], parts[2], 1.5);
  elbow(parts[4], parts[3], -1.5);
  rig.hook({.kind = HookKind::kSlider,
            .a = {parts[5]},
            .b = {parts[0]},
            .anchor = {0, 0.5, z},
            .limits = {Real(-0.2), Real(0.2)},
            .motor = {.speed = Real(number % 2), .max_force = Real(3)}});
  if (number % 4 == 3) rig.hook({.a = {parts[2]}, .anchor = {2.5, 0, z}});
}

struct Figures {
  JointRig rig;
  Figures(std::vector<int> numbers, int workers) : rig(workers) {
    for (const int number : numbers) add_figure(number, rig);
    rig.run(0.5, 4);
  }
};

std::vector<int> all_figures() {
  std::vector<int> numbers(kFigures);
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

/// Whether figure i of one rig has the bits of figure k of another.
bool same(const Figures& a, int i, const Figures& b, int k) {
  const auto equal = [&](const auto& left, const auto& right) {
    return std::memcmp(left.data() + static_cast<std::ptrdiff_t>(i * kParts),
                       right.data() + static_cast<std::ptrdiff_t>(k * kParts), kParts * sizeof(left[0])) == 0;
  };
  const state::Bodies& left = a.rig.t.bodies;
  const state::Bodies& right = b.rig.t.bodies;
  return equal(left.center, right.center) && equal(left.rotation, right.rotation) &&
         equal(left.motion, right.motion) && equal(left.angular_momentum, right.angular_momentum);
}

TEST_SUITE("solver/articulation_trees") {
  TEST_CASE("a tree has the same bits alone and beside others") {
    const Figures together(all_figures(), 1);
    REQUIRE(together.rig.joints.order.size() == kFigures);
    for (int i = 0; i < kFigures; ++i) {
      CHECK(is_finite(together.rig.t.bodies.motion[i * kParts].v));
      CHECK_MESSAGE(same(together, i, Figures({i}, 1), 0), i);
    }
  }

  TEST_CASE("trees have the same bits with every instruction set and any number of workers") {
    const Figures expected(all_figures(), 1);
    for (const std::string& target : wide::targets()) {
      REQUIRE(wide::use_target(target));
      for (const int workers : {1, 3}) {
        const Figures figures(all_figures(), workers);
        for (int i = 0; i < kFigures; ++i) CHECK_MESSAGE(same(figures, i, expected, i), target);
      }
    }
    wide::use_target("");
  }

  TEST_CASE("trees are of one kind in whatever order their hooks were made") {
    JointRig rig;
    for (const bool outer_first : {false, true}) {
      std::array<BodyId, 3> bar;
      const double z = outer_first ? 5 : 0;
      for (int i = 0; i < 3; ++i)
        bar[i] = rig.add({.center = {1.0 * i, 0, z}, .inertia = {Real(0.1), Real(0.1), Real(0.1)}});
      const auto join = [&](int i) {
        rig.hook({.kind = i == 0 ? HookKind::kHinge : HookKind::kBall,
                  .a = i == 0 ? HookEnd{} : HookEnd{bar[i - 1]},
                  .b = {bar[i]},
                  .anchor = {i - 0.5, 0, z}});
      };
      for (int k = 0; k < 3; ++k) join(outer_first ? 2 - k : k);
    }
    rig.step(Real(0.01), 1);
    REQUIRE(rig.joints.order.size() == 2);
    CHECK_FALSE(rig.joints.articulations[0].has_loops());
    CHECK(rig.joints.articulations[0].tree.kind == rig.joints.articulations[1].tree.kind);
  }
}

}  // namespace
}  // namespace hooke::solver
