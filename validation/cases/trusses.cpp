/// Tests the forces that hooks report in structures whose statics is known.

#include "validation/cases.h"
#include "validation/rig.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace hooke::check {

namespace {

/// A Warren truss with panels of 1 m, 1 m high: lower nodes 0 to n, upper nodes n + 1 to 2 n. Nodes are small
/// bodies that stay in the plane, bars are distance hooks.
class Warren {
 public:
  Warren(Rig& rig, int panels, double load) : rig_(&rig) {
    for (int i = 0; i <= panels; ++i) add_node({static_cast<double>(i), 0, 0}, 2 * i == panels ? load : 0);
    for (int i = 0; i < panels; ++i) add_node({i + 0.5, 1, 0}, 0);
    for (int i = 0; i <= 2 * panels; ++i) hold(i, i == 0, i == 0 || i == panels);
  }

  /// Joins two nodes. `a` and `b` count as said above.
  HookId add_bar(int a, int b) {
    return must(rig_->world().add_hook({.kind = HookKind::kDistance,
                                        .a = {.body = nodes_[at(a)]},
                                        .b = {.body = nodes_[at(b)]},
                                        .anchor = locations_[at(a)],
                                        .anchor_b = locations_[at(b)]}));
  }

 private:
  static std::size_t at(int node) { return static_cast<std::size_t>(node); }

  void add_node(DVec3 place, double load) {
    BodyDesc desc = moving(Shape::sphere(real(0.05)), place);
    desc.mass = real(load > 0 ? load : 1e-3);
    desc.collides = false;
    nodes_.push_back(rig_->add(desc));
    locations_.push_back(place);
  }

  void hold(int node, bool along, bool up) {
    HookDesc desc = {.kind = HookKind::kSixDegrees,
                     .b = {.body = nodes_[at(node)]},
                     .anchor = locations_[at(node)],
                     .axis = {Real(1), Real(0), Real(0)},
                     .second_axis = Vec3{Real(0), Real(1), Real(0)}};
    for (HookFreedom& freedom : desc.freedoms) freedom.locked = true;
    desc.freedoms[0].locked = along;
    desc.freedoms[1].locked = up;
    must(rig_->world().add_hook(desc));
  }

  Rig* rig_;
  std::vector<BodyId> nodes_;
  std::vector<DVec3> locations_;
};

}  // namespace

/// With a load P in the middle of n panels of length and height 1, the method of sections gives P n / 4 in
/// the middle of the upper chord, P / 2 (i + 1/2) in panel i of the lower one, and P / 2 over the sine of its
/// slope in each diagonal.
Rows trusses(const CheckSetting& setting) {
  const int panels = 4;
  const double mass = 1000;
  const double load = mass * kGravity;
  Rig rig(setting, without_air());
  Warren truss(rig, panels, mass);
  struct Bar {
    HookId hook;
    double expected;
    std::string name;
  };
  std::vector<Bar> bars;
  for (int i = 0; i < panels; ++i) {
    const int panel = std::min(i, panels - 1 - i);
    const std::string number = std::to_string(i);
    const double diagonal = load / 2 * std::sqrt(1.25);
    bars.push_back({truss.add_bar(i, i + 1), load / 2 * (panel + 0.5), "lower chord " + number});
    bars.push_back({truss.add_bar(i, panels + 1 + i), diagonal, "diagonal " + number + " left"});
    bars.push_back({truss.add_bar(panels + 1 + i, i + 1), diagonal, "diagonal " + number + " right"});
    if (i + 1 == panels) continue;
    const double chord = load / 2 * std::min(i + 1, panels - 1 - i);
    bars.push_back({truss.add_bar(panels + 1 + i, panels + 2 + i), chord, "upper chord " + number});
  }
  rig.run(1);
  Rows rows;
  double worst = 0;
  for (const Bar& bar : bars) {
    const double found = length(vector_cast<double>(rig.world().hook_force(bar.hook).force));
    worst = std::max(worst, std::abs(found / bar.expected - 1));
    const bool shown =
        bar.name == "upper chord 1" || bar.name == "lower chord 1" || bar.name == "diagonal 0 left";
    if (!shown) continue;
    rows.push_back(
        relative_row("truss of 15 bars: force in its " + bar.name, "N", bar.expected, found, 0.001));
  }
  rows.push_back(absolute_row("its bar that is farthest off, relative", "", 0, worst, 0.001));
  for (CheckRow& row : rows) row.solver = "bodies";
  return rows;
}

}  // namespace hooke::check
