/// Tests cloth and closed cloths: the gas in them, and the stiffness of their rows as a sheet.

#include "validation/cases.h"
#include "validation/hinged_sheet.h"
#include "validation/rig.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

namespace hooke::check {

namespace {

constexpr double kAirPressure = 101325;  ///< Pressure around a closed cloth [Pa].

Rows by_cloth(Rows rows) {
  for (CheckRow& row : rows) row.solver = "cloth";
  return rows;
}

/// Makes a sphere of radius r: an octahedron with each triangle cut in four three times.
MeshDesc sphere(double r) {
  MeshDesc mesh{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  for (int level = 0; level < 3; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [entry, is_new] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.positions.size()));
      if (is_new) mesh.positions.push_back(normalize(mesh.positions[a] + mesh.positions[b]));
      return entry->second;
    };
    decltype(mesh.triangles) finer;
    for (const auto& t : mesh.triangles) {
      const std::uint32_t a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
      finer.insert(finer.end(), {{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}});
    }
    mesh.triangles = std::move(finer);
  }
  for (Vec3& p : mesh.positions) p = real(r) * p;
  return mesh;
}

/// Returns volume and area of a closed cloth.
std::pair<double, double> size_of(const Rig& rig, ClothId id) {
  const std::vector<DVec3> x = rig.positions(id);
  double volume = 0;
  double area = 0;
  for (const auto& t : rig.world().triangles(id)) {
    volume += dot(x[t[0]], cross(x[t[1]], x[t[2]])) / 6;
    area += 0.5 * length(cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]));
  }
  return {volume, area};
}

/// Returns the least and largest angle of shear of the cells of a square of cloth whose rim is sheared by an
/// angle [deg].
std::pair<double, double> angles_in_frame(const CheckSetting& setting, double degrees, double areal_density) {
  WorldDesc desc = without_air();
  desc.gravity = {};
  desc.particle_substeps = 4;
  Rig rig(setting, desc);
  const double half = degrees / 720 * kTau;
  const int n = 13;
  ClothDesc sheet{.columns = n, .rows = n, .row_direction = {0, 0, 1}};
  sheet.areal_density = real(areal_density);
  sheet.air_friction = real(20 * areal_density);
  const auto sheared = [&](DVec3 x) {
    return DVec3{x.x * std::cos(half) + x.z * std::sin(half), 0, x.z * std::cos(half) + x.x * std::sin(half)};
  };
  const auto at = [&](int column, int row) { return static_cast<std::uint32_t>(row * n + column); };
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) {
      if (i > 0 && k > 0 && i + 1 < n && k + 1 < n) continue;
      const DVec3 x = {i / (n - 1.0), 0, k / (n - 1.0)};
      sheet.pins.push_back(
          {at(i, k),
           {.kind = MotionDesc::Kind::kKeyframes, .keyframes = {{0, {}}, {1, real(sheared(x) - x)}}}});
    }
  }
  const ClothId id = rig.add(sheet);
  rig.run(2);
  const std::vector<DVec3> x = rig.positions(id);
  double least = HUGE_VAL;
  double most = -HUGE_VAL;
  for (int i = 1; i + 2 < n; ++i) {
    for (int k = 1; k + 2 < n; ++k) {
      const DVec3 a = x[at(i + 1, k)] - x[at(i, k)];
      const DVec3 b = x[at(i, k + 1)] - x[at(i, k)];
      const double angle = std::asin(dot(a, b) / (length(a) * length(b))) * 360 / kTau;
      least = std::min(least, angle);
      most = std::max(most, angle);
    }
  }
  return {least, most};
}

/// Returns the angle below the level [rad] at which a clamped strip of length 1 and flexural rigidity 1 sees
/// its end, if its weight per length is `weight`: B theta'' = -w (L - s) cos theta (the heavy elastica;
/// Peirce 1930 measures the stiffness of cloth by it). Shoots from the clamp for a free end without moment.
double angle_of_heavy_strip(double weight) {
  constexpr int kSteps = 2000;
  constexpr double kStep = 1.0 / kSteps;
  struct State {
    double angle, curvature;
  };
  const auto rate = [weight](double s, const State& at) {
    return State{at.curvature, -weight * (1 - s) * std::cos(at.angle)};
  };
  DVec3 end = {};
  const auto curvature_at_end = [&](double at_clamp) {
    State now = {0, at_clamp};
    end = {};
    for (int i = 0; i < kSteps; ++i) {
      const double s = i * kStep;
      const auto moved = [&](const State& by, double t) {
        return State{now.angle + t * by.angle, now.curvature + t * by.curvature};
      };
      const State a = rate(s, now), b = rate(s + kStep / 2, moved(a, kStep / 2));
      const State c = rate(s + kStep / 2, moved(b, kStep / 2)), d = rate(s + kStep, moved(c, kStep));
      const double middle = moved(b, kStep / 2).angle;
      end = end + kStep * DVec3{std::cos(middle), std::sin(middle), 0};
      now = {now.angle + kStep / 6 * (a.angle + 2 * b.angle + 2 * c.angle + d.angle),
             now.curvature + kStep / 6 * (a.curvature + 2 * b.curvature + 2 * c.curvature + d.curvature)};
    }
    return now.curvature;
  };
  curvature_at_end(bisect(0, weight, 60, [&](double k) { return curvature_at_end(k) < 0; }));
  return std::atan2(end.y, end.x);
}

}  // namespace

/// A skin of tension T holds gas of the pressure dp above that outside: dp = 2 T / R (Laplace), and (dp + p0)
/// V stays (Boyle). Springs of force F and length l in an area A pull with T = sum F l / 2 A, and with R = 3
/// V / A that is dp = sum F l / 3 V.
Rows balloon(const CheckSetting& setting) {
  CheckSetting fine = setting;
  fine.substeps = 64;  // One pass leaves a part of the skin's stiffness unused.
  WorldDesc desc = without_air();
  desc.gravity = {};
  desc.particle_substeps = 4;
  Rig rig(fine, desc);
  const double k = 5000;
  ClothDesc skin;
  skin.mesh = must(rig.world().add_mesh(sphere(0.1)));
  skin.stretch_stiffness = real(k);
  skin.shear_stiffness = skin.bend_stiffness = Real(0);
  skin.areal_density = Real(20);
  skin.air_friction = Real(2500);
  skin.pressure = Real(5000);
  const ClothId id = rig.add(skin);
  const std::vector<DVec3> rest = rig.positions(id);
  const double volume = size_of(rig, id).first;
  rig.run(0.5);

  const std::vector<DVec3> x = rig.positions(id);
  const auto [now, area] = size_of(rig, id);
  double pull = 0;  // Sum of F l; each edge has two triangles.
  for (const auto& t : rig.world().triangles(id)) {
    for (int i = 0; i < 3; ++i) {
      const double l = length(x[t[i]] - x[t[(i + 1) % 3]]);
      pull += 0.5 * k * (l - length(rest[t[i]] - rest[t[(i + 1) % 3]])) * l;
    }
  }
  const double pressure = static_cast<double>(rig.world().pressure(id));
  Rows rows = {relative_row("pressure of 2 T / R", "Pa", pull / (3 * now), pressure, 0.01),
               relative_row("pressure times volume, that of the air included", "J",
                            (5000 + kAirPressure) * volume, (pressure + kAirPressure) * now, 1e-4),
               absolute_row("speed of the skin at rest", "m/s", 0,
                            std::sqrt(2 * rig.energy().kinetic / (20 * area)), 1e-3)};
  for (CheckRow& row : rows) row.substeps = fine.substeps;
  return by_cloth(rows);
}

/// A strip held level by one edge sags under a small load as its edges bend. If only edges across the strip
/// bent, each by its moment over B / h, the end would sag by q L^4 / 8 B (Euler, Bernoulli) for infinitely
/// small cells. But diagonals fold, too, and let a strip with free sides sag by up to a quarter more.
Rows overhanging_cloth(const CheckSetting& setting) {
  CheckSetting fine = setting;
  fine.substeps = 64;
  WorldDesc desc = without_air();
  desc.particle_substeps = 4;
  const double gravity = 0.005, rigidity = 0.001, overhang = 0.4, density = 0.2;
  desc.gravity = {0, real(-gravity), 0};
  struct Trial {
    int cells;
    ClothDesc::Bend bend;
  };
  Rows rows;
  for (const auto [n, bend] : {Trial{4, ClothDesc::Bend::kAngle}, Trial{8, ClothDesc::Bend::kAngle},
                               Trial{4, ClothDesc::Bend::kIsometric}}) {
    Rig rig(fine, desc);
    const double cell = overhang / n;
    ClothDesc strip{.columns = n + 2, .rows = 3, .corner = {-cell, 0, 0}, .row_direction = {0, 0, 1}};
    strip.width = real(overhang + cell);
    strip.height = real(2 * cell);
    strip.areal_density = real(density);
    strip.bend = bend;
    strip.bend_stiffness = real(rigidity);
    strip.bend_damping = Real(0.02);
    strip.air_friction = real(6 * density * (overhang + cell) * cell);
    for (std::uint32_t row = 0; row < 3; ++row) {
      for (const std::uint32_t column : {0U, 1U})
        strip.pins.push_back({row * static_cast<std::uint32_t>(n + 2) + column});
    }
    const ClothId id = rig.add(strip);
    HingedSheet sheet = {rig.positions(id), rig.world().triangles(id), {}, rigidity};
    sheet.is_fixed.resize(sheet.points.size());
    for (const PinDesc& pin : strip.pins) sheet.is_fixed[pin.point] = 1;
    const double expected = sag_of(sheet, density * gravity).back();
    rig.run(12);
    const char* kind = bend == ClothDesc::Bend::kIsometric ? ", isometric bends" : "";
    const CheckRow row = relative_row("sag of a strip of " + std::to_string(n) + " cells" + kind, "m",
                                      expected, -rig.positions(id).back().y, 0.01);
    rows.push_back(known_miss_turned(
        setting, row, "at 15360 substeps a second what creeps moves less than a float's last place"));
    rows.back().substeps = fine.substeps;
  }
  return by_cloth(rows);
}

/// A strip that hangs over an edge sees its end at an angle that depends on w L^3 / B alone, w its weight per
/// area and B its flexural rigidity (Peirce 1930). Settings are the default ones; the strip still swings a
/// little, so that its mean over two seconds counts.
Rows peirce_strips(const CheckSetting& setting) {
  Rows rows;
  const double overhang = 0.2;
  for (const double load : {1.0, 5.0, 8.0, 20.0, 100.0}) {
    for (const int n : {10, 30}) {
      Rig rig(setting);
      const double cell = overhang / n;
      ClothDesc strip{.columns = n + 2, .rows = 5, .corner = {-cell, 0, 0}, .row_direction = {0, 0, 1}};
      strip.width = real(overhang + cell);
      strip.height = real(4 * cell);
      strip.bend_stiffness =
          real(static_cast<double>(strip.areal_density) * kGravity * std::pow(overhang, 3) / load);
      for (std::uint32_t row = 0; row < 5; ++row) {
        for (const std::uint32_t column : {0U, 1U})
          strip.pins.push_back({row * static_cast<std::uint32_t>(n + 2) + column});
      }
      const ClothId id = rig.add(strip);
      rig.run(6);
      double sum = 0;
      for (int i = 0; i < 120; ++i) {
        rig.run(1.0 / 60);
        const DVec3 end = rig.positions(id)[static_cast<std::size_t>(2 * (n + 2) + n + 1)];
        sum += std::atan2(-end.y, end.x) * 360 / kTau;
      }
      rows.push_back(absolute_row("angle of the end of a strip of " + std::to_string(n) +
                                      " cells, w L^3 / B = " + std::to_string(std::lround(load)),
                                  "deg", angle_of_heavy_strip(load) * 360 / kTau, sum / 120, 2));
    }
  }
  return by_cloth(rows);
}

/// In a frame whose four sides rotate about its corners, the threads of a fabric rotate with them: right
/// angles become 90 degrees less the angle of shear everywhere (kinematics). A light fabric needs shorter
/// substeps for the same stiffness; the table says where it has them.
Rows picture_frame(const CheckSetting& setting) {
  struct Trial {
    double degrees, areal_density;
    int substeps;
    bool missed = false;
  };
  const int own = setting.substeps;
  Rows rows;
  for (const Trial trial :
       {Trial{10, 20, own}, Trial{30, 20, own}, Trial{10, 0.2, own, true}, Trial{10, 0.2, 64}}) {
    CheckSetting of_trial = setting;
    of_trial.substeps = trial.substeps;
    const auto [least, most] = angles_in_frame(of_trial, trial.degrees, trial.areal_density);
    const std::string title = " angle of shear of a cell, " +
                              std::string(trial.areal_density < 1 ? "0.2" : "20") + " kg/m^2, frame at " +
                              std::to_string(std::lround(trial.degrees)) + " deg";
    const CheckRow low = relative_row("least" + title, "deg", trial.degrees, least, 0.05);
    const CheckRow high = relative_row("largest" + title, "deg", trial.degrees, most, 0.05);
    const std::string why = "one pass over springs of light points leaves (w h)^2 of their forces unbalanced";
    for (const CheckRow& row : {low, high}) {
      rows.push_back(trial.missed ? known_miss(row, why) : row);
      rows.back().substeps = trial.substeps;
    }
  }
  return by_cloth(rows);
}

/// A square plate on four edges sags under its weight by 0.004062 q a^4 / D at its center, whatever its
/// Poisson ratio (Navier 1820; Timoshenko).
Rows supported_plate(const CheckSetting& setting) {
  constexpr int kPoints = 9;
  const double rigidity = 0.02;  // D [N m]
  const double sag = 2e-3;
  const double areal_density = 0.2;
  Rows rows;
  for (const auto& [bend, name] :
       {std::pair{ClothDesc::Bend::kAngle, "angles"}, std::pair{ClothDesc::Bend::kIsometric, "curvatures"}}) {
    WorldDesc world = without_air();
    world.gravity = {real(0), real(-sag * rigidity / 0.004062 / areal_density), real(0)};
    Rig rig(setting, world);
    ClothDesc desc{.columns = kPoints, .rows = kPoints, .row_direction = {real(0), real(0), real(1)}};
    desc.areal_density = real(areal_density);
    desc.bend = bend;
    desc.bend_stiffness = real(rigidity);
    desc.stretch_stiffness = real(1000);
    desc.shear_stiffness = real(200);
    desc.air_friction = real(1);
    for (std::uint32_t i = 0; i < kPoints; ++i) {
      for (std::uint32_t k = 0; k < kPoints; ++k) {
        if (i % (kPoints - 1) == 0 || k % (kPoints - 1) == 0) desc.pins.push_back({.point = k * kPoints + i});
      }
    }
    const ClothId id = rig.add(desc);
    rig.run(8);
    rows.push_back(known_miss(relative_row(std::string("sag of a square plate that bends by ") + name, "m",
                                           sag, -rig.positions(id)[kPoints * kPoints / 2].y, 0.05),
                              "cells that twist fold along their diagonals, which resist twice as much"));
  }
  return by_cloth(rows);
}

/// A balloon under water pulls on its rope with the weight of the displaced water less its own (Archimedes).
Rows tethered_balloon(const CheckSetting& setting) {
  WorldDesc desc = without_air();
  desc.particle_substeps = 4;
  Rig rig(setting, desc);
  must(rig.world().add_field({.kind = FieldDesc::Kind::kLiquid, .density = 1000, .drag = 3}));
  ClothDesc skin;
  skin.mesh = must(rig.world().add_mesh(sphere(0.1)));
  skin.position = {0, -0.5, 0};
  skin.areal_density = Real(2);
  skin.pressure = Real(20000);
  skin.damping = Real(1);
  const ClothId id = rig.add(skin);
  RopeDesc rope{.total_mass = real(0.001), .points = {}, .radius = real(0.001)};
  for (int i = 0; i <= 10; ++i) rope.points.push_back({0, -1.6 + 0.1 * i, 0});
  const RopeId tether = rig.add(rope);
  must(rig.world().add_hook({.a = {.point = point(tether, 10)},
                             .b = {.point = point(id, PointRef::kNearest)},
                             .anchor = {0, -0.6, 0}}));
  rig.run(10);
  double pull = 0;
  rig.run(2, [&] { pull += static_cast<double>(rig.world().tensions(tether)[0]) * setting.dt / 2; });
  const auto [volume, area] = size_of(rig, id);
  CheckRow row = relative_row("pull of a balloon under water on its rope", "N",
                              (1000 * volume - 2 * 0.1 * 0.1 * 2 * kTau) * kGravity, pull, 0.01);
  row.solver = "cloth, rope";
  static_cast<void>(area);
  return {row};
}

}  // namespace hooke::check
