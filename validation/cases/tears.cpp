/// Tests cloth that tears, and that surfaces never pass through each other, by a checker that shares no code
/// with the engine.

#include "validation/cases.h"
#include "validation/crossings.h"
#include "validation/rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace hooke::check {

namespace {

constexpr int kPulledPoints = 21;  ///< Points along each side of a sheet that tears.

/// Describes a sheet of 1 m by 1 m in the plane z = 0 that tears at a strain of 0.2.
ClothDesc weak_sheet() {
  ClothDesc sheet{.columns = kPulledPoints, .rows = kPulledPoints};
  sheet.bend = ClothDesc::Bend::kAngle;
  sheet.stretch_stiffness = real(100);
  sheet.shear_stiffness = real(20);
  sheet.damping = real(0.05);
  sheet.tear_strain = real(0.2);
  sheet.tethers = false;
  sheet.drag_coefficient = Real(0);
  sheet.lift_coefficient = Real(0);
  return sheet;
}

/// What a sheet that flies apart has kept after a tenth of a second.
struct TornSheet {
  double mass_change = 0;      ///< Of the sum of the points' masses, over the sum before.
  double momentum_change = 0;  ///< Over the size before.
  double energy_gain = 0;      ///< Largest rise from step to step, over the energy before.
};

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

/// Returns the mean angle [deg] between a direction in the sheet and the edges between triangles that have
/// come apart: that of the sums of their ways across and along.
double angle_of_cracks(const std::vector<DVec3>& rest, const Triangles& before, const Triangles& after,
                       DVec3 along) {
  struct Side {
    std::array<std::uint32_t, 2> ends;  ///< Points after, in the order of those before.
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, Side> sides;
  double sum_along = 0;
  double sum_across = 0;
  const DVec3 across = {-along.y, along.x, 0};
  for (std::size_t i = 0; i < before.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<std::uint32_t, 2> was = {before[i][k], before[i][(k + 1) % 3]};
      std::array<std::uint32_t, 2> is = {after[i][k], after[i][(k + 1) % 3]};
      if (was[0] > was[1]) {
        std::swap(was[0], was[1]);
        std::swap(is[0], is[1]);
      }
      const auto [other, is_first] = sides.try_emplace({was[0], was[1]}, Side{is});
      if (is_first || other->second.ends == is) continue;
      const DVec3 way = rest[was[1]] - rest[was[0]];
      const double forward = dot(way, along);
      const DVec3 side = way - forward * along;
      sum_along += dot(side, across) < 0 ? -forward : forward;
      sum_across += length(side);
    }
  }
  return std::atan2(sum_across, std::abs(sum_along)) * 360 / kTau;
}

/// Stretches a free sheet by giving its points speeds that grow along its rows, and lets it fly.
TornSheet fly_apart(const CheckSetting& setting) {
  WorldDesc desc = without_air();
  desc.gravity = {};
  Rig rig(setting, desc);
  const ClothId id = rig.add(weak_sheet());
  World& world = rig.world().in_its_frame();
  const std::vector<DVec3> x = rig.positions(id);
  DVec3 middle = {};
  for (const DVec3& one : x) middle += (1.0 / static_cast<double>(x.size())) * one;
  for (std::uint32_t i = 0; i < x.size(); ++i) {
    const DVec3 speed = {30 * (x[i].x - middle.x), 0, 5};
    must(rig.world().set_velocity(point(id, i), real(speed)));
  }
  const auto mass = static_cast<double>(world.mass(id));
  const Measurement before = world.measure();
  double energy = before.energy.total();
  TornSheet result;
  rig.run(0.1, [&] {
    const double now = world.measure().energy.total();
    result.energy_gain = std::max(result.energy_gain, (now - energy) / before.energy.total());
    energy = now;
  });
  // A sheet that has not torn says nothing of tears.
  result.mass_change = world.splits(id).empty() ? NAN : static_cast<double>(world.mass(id)) / mass - 1;
  result.momentum_change = length(world.measure().momentum - before.momentum) / length(before.momentum);
  return result;
}

/// Describes a strip of 1 m that is half as wide in its middle, 0.2 m, as at its ends, with diagonals in turn
/// both ways.
MeshDesc waisted_strip() {
  constexpr std::uint32_t kLong = 41, kWide = 13;
  MeshDesc mesh;
  for (std::uint32_t i = 0; i < kLong; ++i) {
    for (std::uint32_t k = 0; k < kWide; ++k) {
      const double x = i / (kLong - 1.0) - 0.5;
      const double width = 0.2 * (1 + 4 * x * x);
      mesh.positions.push_back(real(DVec3{x, width * (k / (kWide - 1.0) - 0.5), 0}));
      if (i == 0 || k == 0) continue;
      const std::uint32_t d = i * kWide + k, c = d - 1, b = d - kWide, a = b - 1;
      if ((i + k) % 2 == 0) {
        mesh.triangles.insert(mesh.triangles.end(), {{a, c, d}, {a, d, b}});
      } else {
        mesh.triangles.insert(mesh.triangles.end(), {{a, c, b}, {c, d, b}});
      }
    }
  }
  return mesh;
}

/// Pulls the strip by its ends until a crack has begun and run for a tenth of a second. Returns the crack's
/// angle.
double crack_angle(const CheckSetting& setting) {
  WorldDesc desc = without_air();
  desc.gravity = {};
  Rig rig(setting, desc);
  const MeshDesc mesh = waisted_strip();
  ClothDesc strip = weak_sheet();
  strip.mesh = must(rig.world().add_mesh(mesh));
  strip.air_friction = real(0.5);
  for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) {
    const double x = static_cast<double>(mesh.positions[i].x);
    if (std::abs(x) < 0.499) continue;
    strip.pins.push_back({.point = i,
                          .motion = {.kind = MotionDesc::Kind::kConstantVelocity,
                                     .velocity = real(DVec3{x > 0 ? 0.1 : -0.1, 0, 0})}});
  }
  const ClothId id = rig.add(strip);
  const std::vector<DVec3> rest = rig.positions(id);
  const World& world = rig.world().in_its_frame();
  for (int i = 0; i < 300 && world.splits(id).empty(); ++i) rig.step();
  rig.run(0.1);
  const auto torn = rig.world().triangles(id);
  return angle_of_cracks(rest, mesh.triangles, Triangles(torn.begin(), torn.end()), {1, 0, 0});
}

/// Adds the triangles of a cloth where they are.
void add_surface(const Rig& rig, ClothId id, std::uint32_t owner, Surfaces& surfaces) {
  const auto first = static_cast<std::uint32_t>(surfaces.points.size());
  for (const DVec3& x : rig.positions(id)) {
    surfaces.points.push_back(x);
    surfaces.owners.push_back(owner);
  }
  for (const auto& t : rig.world().triangles(id))
    surfaces.triangles.push_back({first + t[0], first + t[1], first + t[2]});
}

/// Runs cloths for two seconds, and counts in every step the pairs of an edge and a triangle that cross.
double crossings_of(Rig& rig, const std::vector<ClothId>& cloths) {
  double hits = 0;
  rig.run(2, [&] {
    Surfaces surfaces;
    for (std::uint32_t i = 0; i < cloths.size(); ++i) add_surface(rig, cloths[i], i, surfaces);
    hits += static_cast<double>(count_crossings(surfaces).crossing);
  });
  return hits;
}

ClothDesc touching_sheet(int points, DVec3 corner, DVec3 along, double speed) {
  ClothDesc sheet{.columns = points, .rows = points, .corner = corner, .row_direction = real(along)};
  sheet.self_contact = true;
  sheet.velocity = {0, real(speed), 0};
  return sheet;
}

/// Two sheets that are thrown at each other.
double thrown_sheets(const CheckSetting& setting) {
  Rig rig(setting, sleepless());
  std::vector<ClothId> cloths;
  cloths.push_back(rig.add(touching_sheet(21, {0, 0, 0}, {0, 0, 1}, 4)));
  cloths.push_back(rig.add(touching_sheet(17, {0.1, 0.3, 0.13}, {0.2, 0, 1}, -4)));
  return crossings_of(rig, cloths);
}

/// A sheet that falls edgewise on the ground and folds over itself.
double folding_sheet(const CheckSetting& setting) {
  Rig rig(setting, sleepless());
  rig.add(level_ground(0.4));
  return crossings_of(rig, {rig.add(touching_sheet(25, {0, 1.2, 0}, {0.02, -1, 0.15}, -2))});
}

}  // namespace

/// Balances across tears: mass is parted, not lost; points that split move on with the velocity that they
/// had. A crack of an even sheet runs across the pull, where the largest stretch is normal to it.
Rows torn_sheets(const CheckSetting& setting) {
  const TornSheet torn = fly_apart(setting);
  const double ulp = 0x1p-23;
  Rows rows = {
      absolute_row("mass of a sheet that flies apart, change", "", 0, torn.mass_change, ulp),
      absolute_row("its momentum, change over its size", "", 0, torn.momentum_change, 1e-6),
      absolute_row("its energy, largest gain in a step", "", 0, torn.energy_gain, 1e-6),
      absolute_row("crack of a strip that is pulled, from the pull", "deg", 90, crack_angle(setting), 10)};
  for (CheckRow& row : rows) row.solver = "cloth";
  return rows;
}

/// Surfaces that begin apart stay apart: exact signs of volumes say in every step whether an edge goes
/// through a triangle (validation/crossings.h).
Rows surfaces_that_never_cross(const CheckSetting& setting) {
  Rows rows = {absolute_row("edges through triangles, two sheets thrown at each other", "", 0,
                            thrown_sheets(setting), 0),
               absolute_row("edges through triangles, a sheet that folds over itself", "", 0,
                            folding_sheet(setting), 0)};
  for (CheckRow& row : rows) row.solver = "cloth";
  return rows;
}

}  // namespace hooke::check
