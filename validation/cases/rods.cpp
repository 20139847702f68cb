/// Tests ropes that resist bending: cantilevers far from straight, columns that buckle.

#include "validation/cases.h"
#include "validation/rig.h"

#include <array>
#include <cmath>
#include <string>

namespace hooke::check {

namespace {

/// Describes a straight rod of 1 m and EI = g, almost without mass, so that a load of p kg bends it by p = P
/// L^2 / EI.
RopeDesc rod(DVec3 along, int segments, bool clamped_start, bool clamped_end) {
  RopeDesc desc{.total_mass = real(1e-3),
                .bend_stiffness = real(kGravity),
                .bend_damping = real(2e-3),
                .pins = {},
                .drag_coefficient = real(0)};
  for (int i = clamped_start ? -1 : 0; i <= segments + (clamped_end ? 1 : 0); ++i)
    desc.points.push_back((i / static_cast<double>(segments)) * along);
  return desc;
}

/// This is how a column is held; its top always carries the load.
struct Column {
  bool clamped_below = false, free_above = false, clamped_above = false;
  double k = 1;  ///< Effective length over length (textbook).
  std::string name;
};

/// Tells whether a column that is a little crooked has bent visibly after some seconds.
bool buckles(const CheckSetting& setting, const Column& column, double load) {
  const int segments = 48;
  RopeDesc desc = rod({0, 1, 0}, segments, column.clamped_below, column.clamped_above);
  // With a load of more than a million segments the rod would bounce on its length.
  desc.total_mass = real(1e-2);
  const auto last = static_cast<std::uint32_t>(desc.points.size()) - 1;
  const std::uint32_t top = column.clamped_above ? last - 1 : last;
  desc.pins = {{.point = 0}};
  if (column.clamped_below) desc.pins.push_back({.point = 1});
  if (!column.clamped_above) desc.loads = {{.point = top, .mass = real(load)}};
  Rig rig(setting, without_air());
  const RopeId id = rig.add(desc);
  HookDesc guide = {.kind = HookKind::kSlider, .b = {.point = point(id, top)}, .axis = real(DVec3{0, 1, 0})};
  if (column.clamped_above) {
    BodyDesc slide = moving(Shape::sphere(real(0.5)), {0, 1, 0});
    slide.mass = real(load);
    slide.collides = false;
    const BodyId body = rig.add(slide);
    for (std::uint32_t i = top; i <= last; ++i) {
      must(rig.world().add_hook(
          {.a = {.body = body}, .b = {.point = point(id, i)}, .anchor = desc.points[i]}));
    }
    guide.b = {.body = body};
  }
  if (!column.free_above) must(rig.world().add_hook(guide));
  const std::uint32_t seen = column.free_above ? top : last / 2;
  must(rig.world().apply_impulse(point(id, seen),
                                 {real(column.free_above ? 1e-3 * load : 1e-6), real(0), real(0)}));
  rig.run(column.free_above ? 8 : 4);
  return std::abs(rig.positions(id)[seen].x) > 0.03;
}

/// Tells whether a clamped rod of 1 m and EI = 1 bends visibly under its own weight of `weight` [N/m] in 12
/// s.
bool bows(const CheckSetting& setting, double weight) {
  const int segments = 48;
  RopeDesc desc = rod({0, 1, 0}, segments, true, false);
  desc.bend_stiffness = real(1);
  desc.pins = {{.point = 0}, {.point = 1}};
  const double share = weight / kGravity / segments;  // Mass of a segment; one more segment is in the clamp.
  desc.total_mass = real(share * (segments + 1));
  Rig rig(setting, without_air());
  const RopeId id = rig.add(desc);
  must(rig.world().apply_impulse(point(id, segments + 1), {real(1e-3 * share), real(0), real(0)}));
  rig.run(12);
  return std::abs(rig.positions(id).back().x) > 0.03;
}

}  // namespace

/// The end of a clamped rod under a load across it is where Bisshopp and Drucker 1945 and Mattiasson 1981
/// have it; the figures are Mattiasson's.
Rows elastica(const CheckSetting& setting) {
  struct Figure {
    double load, down, in;
  };
  constexpr std::array<Figure, 4> kFigures = {
      {{1, 0.30172, 0.05643}, {2, 0.49346, 0.16064}, {5, 0.71379, 0.38763}, {10, 0.81061, 0.55500}}};
  Rows rows;
  for (const Figure& figure : kFigures) {
    const int segments = 32;
    RopeDesc desc = rod({1, 0, 0}, segments, true, false);
    desc.pins = {{.point = 0}, {.point = 1}};
    desc.bend_damping = real(0.3);
    desc.loads = {{.point = segments + 1, .mass = real(figure.load)}};
    Rig rig(setting, without_air());
    const RopeId id = rig.add(desc);
    rig.run(12);
    const DVec3 end = rig.positions(id).back();
    const std::string load = ", P L^2 / EI = " + std::to_string(static_cast<int>(figure.load));
    rows.push_back(relative_row("way of the end down" + load, "m", figure.down, -end.y));
    rows.push_back(relative_row("way of the end back" + load, "m", figure.in, 1 - end.x));
  }
  for (CheckRow& row : rows) row.solver = "rope";
  return rows;
}

/// The end of a clamped rod sinks by P L^3 / 3 EI at any stiffness: with the load in proportion to EI it is
/// always the same.
Rows cantilevers(const CheckSetting& setting) {
  Rows rows;
  for (const double stiffness : {0.1, 10.0, 1000.0}) {
    const int segments = 32;
    RopeDesc desc = rod({1, 0, 0}, segments, true, false);
    desc.bend_stiffness = real(stiffness);
    desc.pins = {{.point = 0}, {.point = 1}};
    desc.bend_damping = real(0.3);
    desc.loads = {{.point = segments + 1, .mass = real(0.03 * stiffness / kGravity)}};
    desc.total_mass = real(1e-6 * stiffness);
    Rig rig(setting, without_air());
    const RopeId id = rig.add(desc);
    rig.run(6);
    const std::string title = stiffness < 1 ? "EI = 0.1" : "EI = " + std::to_string(std::lround(stiffness));
    rows.push_back(relative_row("rod of " + title + ", P L^2 / EI = 0.03: way of the end down", "m", 0.01,
                                -rig.positions(id).back().y, 0.01));
  }
  for (CheckRow& row : rows) row.solver = "rope";
  const Rows jelly = cantilever_of_jelly(setting);
  rows.insert(rows.end(), jelly.begin(), jelly.end());
  return rows;
}

/// A rod bent only by a moment M at its end is an arc of curvature M / EI, a circle at 2 pi EI / L (Euler).
/// The moment is a pair of forces at its last two points, which rotates with them.
Rows bent_to_circle(const CheckSetting& setting) {
  const int segments = 32;
  RopeDesc desc = rod({1, 0, 0}, segments, true, true);
  desc.pins = {{.point = 0}, {.point = 1}};
  desc.bend_damping = real(0.1);
  desc.total_mass = real(0.01);
  desc.air_friction = real(2);
  WorldDesc still = without_air();
  still.gravity = {};
  Rig rig(setting, still);
  const RopeId id = rig.add(desc);
  const auto last = static_cast<std::uint32_t>(desc.points.size()) - 1;
  const double full = kTau * kGravity;
  while (rig.time() < 12 && rig.healthy()) {
    const std::vector<DVec3> x = rig.positions(id);
    const DVec3 along = x[last] - x[last - 1];
    const double l2 = length_squared(along);
    const double force = full * std::min(1.0, rig.time() / 6) / l2;
    const Vec3 push = real(force * DVec3{-along.y, along.x, 0});
    must(rig.world().apply_force(point(id, last), push));
    must(rig.world().apply_force(point(id, last - 1), -push));
    rig.step();
  }
  const std::vector<DVec3> x = rig.positions(id);
  double top = 0;
  for (const DVec3& p : x) top = std::max(top, p.y);
  Rows rows = {absolute_row("gap of the circle, over L", "", 0, length(x[last - 1] - x[1]), 0.01),
               relative_row("its diameter", "m", 2 / kTau, top, 0.01)};
  for (CheckRow& row : rows) row.solver = "rope";
  return rows;
}

/// The load is pi^2 EI / (K L)^2 (Euler 1744), found by bisection of an interval of 10 % to either side.
Rows euler_columns(const CheckSetting& setting) {
  const std::array<Column, 4> columns = {
      {{.k = 1, .name = "on hinges"},
       {.clamped_below = true, .free_above = true, .k = 2, .name = "clamped, free"},
       {.clamped_below = true, .clamped_above = true, .k = 0.5, .name = "clamped, clamped"},
       {.clamped_below = true, .k = 0.699156, .name = "clamped, on a hinge"}}};
  Rows rows;
  for (const Column& column : columns) {
    const double expected = std::pow(kTau / 2 / column.k, 2);
    double low = 0.9 * expected;
    double high = 1.1 * expected;
    for (int i = 0; i < 8; ++i) {
      const double middle = 0.5 * (low + high);
      (buckles(setting, column, middle) ? high : low) = middle;
    }
    CheckRow row = relative_row("load that buckles a column " + column.name + ", over EI / L^2", "", expected,
                                0.5 * (low + high), 0.02);
    row.solver = "rope";
    rows.push_back(known_miss_turned(setting, row, "roundings across the column hold a bend that creeps"));
  }
  return rows;
}

/// A clamped column bows under its own weight q for q L^3 / EI > 7.8373 (Greenhill 1881).
Rows heavy_column(const CheckSetting& setting) {
  const double expected = 7.8373;
  const double found =
      bisect(0.9 * expected, 1.1 * expected, 6, [&](double weight) { return !bows(setting, weight); });
  CheckRow row = relative_row("own weight that bows a clamped column, q L^3 / EI", "", expected, found, 0.02);
  row.solver = "rope";
  return {known_miss_turned(setting, row, "roundings across the column hold a bend that creeps")};
}

}  // namespace hooke::check
