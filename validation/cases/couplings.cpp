/// Tests ropes, bodies and hooks that act on each other, by statics and small oscillations.

#include "validation/cases.h"
#include "validation/rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace hooke::check {

namespace {

RopeDesc cord(DVec3 from, DVec3 to, int segments, double mass) {
  RopeDesc desc{.total_mass = real(mass), .points = {}, .drag_coefficient = real(0)};
  for (int i = 0; i <= segments; ++i)
    desc.points.push_back(from + (i / static_cast<double>(segments)) * (to - from));
  return desc;
}

BodyId heavy_ball(Rig& rig, DVec3 place, double mass) {
  BodyDesc desc = moving(Shape::sphere(real(0.05)), place);
  desc.mass = real(mass);
  desc.collides = false;
  return rig.add(desc);
}

HookId tie_to(Rig& rig, BodyId body, RopeId rope, std::uint32_t index, DVec3 place) {
  return must(
      rig.world().add_hook({.a = {.body = body}, .b = {.point = point(rope, index)}, .anchor = place}));
}

}  // namespace

/// w^2 = g / l (1 + m / M) for a mass m on a string of length l from a cart M that runs freely (textbook).
Rows pendulum_on_cart(const CheckSetting& setting) {
  Rows rows;
  for (const double cart_mass : {1.0, 4.0}) {
    Rig rig(setting, without_air());
    const double lean = 0.05;
    const DVec3 end = {std::sin(lean), -std::cos(lean), 0};
    const BodyId cart = heavy_ball(rig, {}, cart_mass);
    must(rig.world().add_hook({.kind = HookKind::kSlider, .b = {cart}, .axis = {Real(1), Real(0), Real(0)}}));
    RopeDesc desc = cord({}, end, 10, 1e-3);
    desc.pins = {};
    const RopeId rope = rig.add(desc);
    const BodyId bob = heavy_ball(rig, end, 2);
    tie_to(rig, cart, rope, 0, {});
    tie_to(rig, bob, rope, 10, end);
    const double expected = kTau / std::sqrt(kGravity * (1 + 2 / cart_mass));
    const Curve curve = record(rig, 10, [&] { return rig.center(bob).x - rig.center(cart).x; });
    rows.push_back(relative_row(
        "period of 2 kg on a string from a cart of " + std::to_string(std::lround(cart_mass)) + " kg", "s",
        expected, curve.period()));
    rows.back().solver = "rope, bodies";
  }
  return rows;
}

/// Cords of stiffness k_i side by side share a weight as k_i over their sum (statics).
Rows four_cords(const CheckSetting& setting) {
  constexpr std::array<double, 4> kStiffness = {500, 1000, 2000, 4000};
  const double sum = 7500;
  const double weight = 5 * kGravity;
  Rig rig(setting, without_air());
  const BodyId load = heavy_ball(rig, {0, -1, 0}, 5);
  std::vector<HookId> hooks;
  for (const double stiffness : kStiffness) {
    RopeDesc desc = cord({}, {0, -1, 0}, 8, 1e-3);
    desc.stiffness = real(stiffness);
    desc.inner_friction = real(stiffness / 100);
    hooks.push_back(tie_to(rig, load, rig.add(desc), 8, {0, -1, 0}));
  }
  rig.run(8);
  Rows rows = {relative_row("way down of 5 kg on four cords", "m", weight / sum, -1 - rig.center(load).y)};
  for (std::size_t i = 0; i < hooks.size(); ++i) {
    rows.push_back(relative_row("lift of the cord of " + std::to_string(std::lround(kStiffness[i])) + " N/m",
                                "N", weight * kStiffness[i] / sum,
                                length(vector_cast<double>(rig.world().hook_force(hooks[i]).force))));
  }
  for (CheckRow& row : rows) row.solver = "rope, bodies";
  return rows;
}

/// A bead slides on a cord of length S between hooks d apart, one h above the other. It rests where both
/// strands lean by asin(d / S) from the vertical, and each pulls with m g / (2 cos) (statics).
Rows bead_on_cord(const CheckSetting& setting) {
  constexpr int kSegments = 200;
  const double across = 1;
  const double rise = 0.3;
  const double length_of_cord = 1.6;
  const double sine = across / length_of_cord;
  const double cosine = std::sqrt(1 - sine * sine);
  const double left = 0.5 * (length_of_cord - rise / cosine);  // The strand to the lower hook.
  // The cord is laid along two straight lines that meet at another point of the ellipse about its hooks.
  const DVec3 upper = {across, rise, 0};
  const double start_left = 0.75;
  const double base = length(upper);
  const double start_right = length_of_cord - start_left;
  const double along = (start_left * start_left - start_right * start_right + base * base) / (2 * base);
  const double off = std::sqrt(start_left * start_left - along * along);
  const DVec3 kink = (along / base) * upper + (off / base) * DVec3{rise, -across, 0};
  RopeDesc desc{.total_mass = real(1e-3), .points = {}, .pins = {{.point = 0}, {.point = kSegments}}};
  for (int i = 0; i <= kSegments; ++i) {
    const double s = length_of_cord * i / kSegments;
    desc.points.push_back(s < start_left ? (s / start_left) * kink
                                         : kink + ((s - start_left) / start_right) * (upper - kink));
  }
  Rig rig(setting, without_air());
  const RopeId rope = rig.add(desc);
  const ParticlesId bead =
      rig.add(ParticlesDesc{.particles = {{.position = kink, .mass = real(1)}}, .air_friction = real(2)});
  must(rig.world().add_hook({.kind = HookKind::kRopeSlide,
                             .a = {.point = point(rope, PointRef::kNearest)},
                             .b = {.point = point(bead, 0)},
                             .anchor = kink}));
  rig.run(15);
  const std::vector<Real> tensions = rig.world().tensions(rope);
  // Within a straight segment the bead slides until the segment lies level, so it may be half a segment off.
  const double half_segment = 0.5 * length_of_cord / kSegments;
  const double pull = kGravity / (2 * cosine);
  const DVec3 place = rig.positions(bead)[0];
  Rows rows = {absolute_row("bead at rest on a cord, way across", "m", left * sine, place.x, half_segment),
               absolute_row("its way down", "m", left * cosine, -place.y, half_segment),
               relative_row("pull of the strand to the lower hook", "N", pull,
                            static_cast<double>(tensions.front()), 0.01),
               relative_row("pull of the strand to the upper hook", "N", pull,
                            static_cast<double>(tensions.back()), 0.01)};
  for (CheckRow& row : rows) {
    row.solver = "rope, ties";
    row = known_miss_turned(setting, row, "where directions are rounded it may stop 1.5 segments away");
  }
  return rows;
}

/// Every hook carries the weight that hangs below it: a chain of bodies, a rope, a load (statics).
Rows chain_then_rope(const CheckSetting& setting) {
  Rig rig(setting, without_air());
  std::array<HookId, 5> hooks = {};
  BodyId last = {};
  for (std::size_t i = 0; i < 3; ++i) {
    const double top = -0.4 * static_cast<double>(i);
    BodyDesc link = moving(box_of({0.03, 0.2, 0.03}), {0, top - 0.2, 0});
    link.mass = real(1);
    const BodyId body = rig.add(link);
    hooks[i] = must(rig.world().add_hook({.a = {last}, .b = {body}, .anchor = {0, top, 0}}));
    last = body;
  }
  RopeDesc desc = cord({0, -1.2, 0}, {0, -2.2, 0}, 20, 0.5);
  desc.pins = {};
  const RopeId rope = rig.add(desc);
  const BodyId load = heavy_ball(rig, {0, -2.2, 0}, 20);
  hooks[3] = tie_to(rig, last, rope, 0, {0, -1.2, 0});
  hooks[4] = tie_to(rig, load, rope, 20, {0, -2.2, 0});
  rig.run(5);
  constexpr std::array<double, 5> kBelow = {23.5, 22.5, 21.5, 20.5, 20};
  Rows rows;
  for (std::size_t i = 0; i < hooks.size(); ++i) {
    rows.push_back(relative_row("three links, a rope, 20 kg: force of hook " + std::to_string(i + 1), "N",
                                kBelow[i] * kGravity,
                                length(vector_cast<double>(rig.world().hook_force(hooks[i]).force))));
    rows.back().solver = "rope, bodies";
  }
  return rows;
}

}  // namespace hooke::check
