/// Tests how cloth falls and flutters.

#include "validation/cases.h"
#include "validation/rig.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace hooke::check {

namespace {

constexpr double kClothRadius = 0.15;  ///< Radius of the cloth in Cusick's drape test (BS 5058) [m].
constexpr double kDiscRadius = 0.09;
/// Particle substeps; fewer leave a part of the stiffness of fine cloth unused.
constexpr int kDrapeSubsteps = 16;

/// Makes a disc of `rings` rings around its middle; ring i has 6 i points. They are off
/// the plane by up to 10 um in an irregular pattern, so that no direction of folds is preferred.
MeshDesc disc(std::uint32_t rings) {
  MeshDesc mesh;
  const auto first_of = [](std::uint32_t ring) { return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1); };
  for (std::uint32_t ring = 0; ring <= rings; ++ring) {
    const double r = kClothRadius * ring / rings;
    for (std::uint32_t i = 0; i < std::max(1U, 6 * ring); ++i) {
      const double angle = kTau * i / std::max(1U, 6 * ring);
      const double uneven = 1e-5 * std::sin(3 * angle + 7 * r / kClothRadius) * std::sin(5.3 * angle);
      mesh.positions.push_back(real(DVec3{r * std::cos(angle), uneven, -r * std::sin(angle)}));
    }
  }
  for (std::uint32_t ring = 1; ring <= rings; ++ring) {
    for (std::uint32_t side = 0; side < 6; ++side) {
      const auto outer = [&](std::uint32_t i) { return first_of(ring) + (side * ring + i) % (6 * ring); };
      const auto inner = [&](std::uint32_t i) {
        return first_of(ring - 1) + (ring == 1 ? 0 : (side * (ring - 1) + i) % (6 * (ring - 1)));
      };
      for (std::uint32_t i = 0; i < ring; ++i) {
        mesh.triangles.push_back({outer(i), outer(i + 1), inner(i)});
        if (i + 1 < ring) mesh.triangles.push_back({inner(i), outer(i + 1), inner(i + 1)});
      }
    }
  }
  return mesh;
}

/// Returns the area of the triangles seen from above, each place counted once, on a grid of 0.5 mm.
double shadow(const std::vector<DVec3>& x, const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  constexpr double kCell = 0.0005;
  constexpr int kSide = 640;
  constexpr int kHalfSide = kSide / 2;
  std::vector<char> covered(static_cast<std::size_t>(kSide) * kSide, 0);
  const auto cell_of = [&](double v) {
    return std::clamp(static_cast<int>(std::floor(v / kCell)) + kHalfSide, 0, kSide - 1);
  };
  for (const auto& t : triangles) {
    const DVec3 a = x[t[0]], b = x[t[1]], c = x[t[2]];
    const auto turn = [](DVec3 p, DVec3 q, double u, double v) {
      return (q.x - p.x) * (v - p.z) - (q.z - p.z) * (u - p.x);
    };
    for (int i = cell_of(std::min({a.x, b.x, c.x})); i <= cell_of(std::max({a.x, b.x, c.x})); ++i) {
      for (int k = cell_of(std::min({a.z, b.z, c.z})); k <= cell_of(std::max({a.z, b.z, c.z})); ++k) {
        const double u = (i - kHalfSide + 0.5) * kCell, v = (k - kHalfSide + 0.5) * kCell;
        const double ab = turn(a, b, u, v), bc = turn(b, c, u, v), ca = turn(c, a, u, v);
        if ((ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0))
          covered[static_cast<std::size_t>(i) * kSide + static_cast<std::size_t>(k)] = 1;
      }
    }
  }
  return kCell * kCell * static_cast<double>(std::count(covered.begin(), covered.end(), 1));
}

struct Fabric {
  const char* name;
  double areal_density, rigidity;  ///< [kg/m^2], [N m]
  /// Stiffness of an edge [N/m]; a mesh of triangles resists shear with 0.43 of it.
  double spring;
  double least, most;  ///< Drape coefficient [%].
};

struct Drape {
  double coefficient = 0;  ///< Drape coefficient [%].
  int nodes = 0;           ///< Folds at the rim.
};

Drape drape_of(const CheckSetting& setting, const Fabric& fabric, std::uint32_t rings) {
  WorldDesc desc = without_air();
  desc.particle_substeps = kDrapeSubsteps;
  Rig rig(setting, desc);
  ClothDesc cloth;
  const MeshDesc mesh = disc(rings);
  cloth.mesh = must(rig.world().add_mesh(mesh));
  cloth.areal_density = real(fabric.areal_density);
  cloth.bend_stiffness = real(fabric.rigidity);
  cloth.bend_damping = Real(0.01);
  cloth.stretch_stiffness = real(fabric.spring);
  cloth.shear_stiffness = Real(0);
  cloth.damping = Real(0.01);
  cloth.air_friction = real(3 * fabric.areal_density * 0.07);
  for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3 p = mesh.positions[i];
    if (std::hypot(p.x, p.z) < real(1.0001 * kDiscRadius)) cloth.pins.push_back({i});
  }
  const ClothId id = rig.add(cloth);
  rig.run(4);
  const std::vector<DVec3> x = rig.positions(id);
  const double held = kTau / 2 * kDiscRadius * kDiscRadius;
  const double whole = kTau / 2 * kClothRadius * kClothRadius;
  Drape drape = {100 * (shadow(x, rig.world().triangles(id)) - held) / (whole - held)};
  const std::size_t rim = 6 * rings;
  const auto reach = [&](std::size_t i) {
    const DVec3& p = x[x.size() - rim + i % rim];
    return std::hypot(p.x, p.z);
  };
  for (std::size_t i = 0; i < rim; ++i) {
    double highest = 0;
    for (std::size_t k = 1; k <= rim / 20; ++k)
      highest = std::max({highest, reach(i + k), reach(i + rim - k)});
    drape.nodes += reach(i) > highest ? 1 : 0;
  }
  return drape;
}

/// Flutter is not regular; over this time its mean frequency is known to a few percent.
constexpr double kFlutterSeconds = 20;

/// This is how the middle of the free edge of a flag moves across the wind.
struct Flutter {
  double frequency = 0;  ///< [Hz]
  double width = 0;      ///< Root of eight times the mean square, which is the full width of a sine [m].
};

Flutter flutter_of(const CheckSetting& setting, double speed) {
  WorldDesc desc;
  desc.wind.velocity = {real(speed), 0, real(0.02 * speed)};
  Rig rig(setting, desc);
  ClothDesc flag{.columns = 33, .rows = 21, .corner = {0, 0.3, 0}};
  flag.width = Real(1);
  flag.height = real(0.6);
  flag.areal_density = real(0.12);
  flag.bend_stiffness = real(1e-5);
  flag.stretch_stiffness = Real(3000);
  flag.shear_stiffness = Real(100);
  for (std::uint32_t row = 0; row < 21; ++row) flag.pins.push_back({33 * row});
  const ClothId id = rig.add(flag);
  rig.run(3);
  std::vector<double> way;
  rig.run(kFlutterSeconds, [&] { way.push_back(rig.positions(id)[10 * 33 + 32].z); });
  double mean = 0, square = 0;
  for (const double z : way) mean += z / static_cast<double>(way.size());
  for (const double z : way) square += (z - mean) * (z - mean) / static_cast<double>(way.size());
  // Only motion from one side to the other counts, not ripples about the middle.
  const double aside = 0.2 * std::sqrt(square);
  int turns = 0;
  double side = 0;
  for (const double z : way) {
    if (std::abs(z - mean) < aside || (z - mean) * side > 0) continue;
    turns += side != 0 ? 1 : 0;
    side = z - mean;
  }
  return {0.5 * turns / kFlutterSeconds, std::sqrt(8 * square)};
}

constexpr const char* kNoWake =
    "triangles meet the wind each by itself: without a wake a sheet that holds flutters too fast";

}  // namespace

/// In steady wind U a flag flutters at a frequency in proportion to U. With the width A of the motion of its
/// end, its Strouhal number f A / U is 0.1 to 0.2.
Rows flag_flutter(const CheckSetting& setting) {
  Rows rows;
  std::vector<double> frequency;
  for (const double speed : {2.0, 4.0, 12.0}) {
    const Flutter f = flutter_of(setting, speed);
    const std::string title = "f A / U of a flag in wind of " + std::to_string(std::lround(speed)) + " m/s";
    const CheckRow row = absolute_row(title, "", 0.15, f.frequency * f.width / speed, 0.05);
    rows.push_back(speed < 12 ? row : known_miss(row, kNoWake));
    frequency.push_back(f.frequency / speed);
  }
  rows.push_back(known_miss(
      relative_row("f / U at 12 m/s, against that at 4 m/s", "1/m", frequency[1], frequency[2], 0.15),
      kNoWake));
  for (CheckRow& row : rows) row.solver = "cloth";
  return rows;
}

/// A disc of cloth of 30 cm is held over a disc of 18 cm. The drape coefficient is the share of the ring
/// between them that its shadow covers (Cusick 1968; BS 5058). Weights and rigidities are those of fabrics;
/// bands of their coefficients, and of the number of folds, follow ISO 9073-9. It must not depend on the
/// mesh.
Rows cusick_drape(const CheckSetting& setting) {
  Rows rows;
  for (const Fabric& fabric :
       {Fabric{"silk", 0.06, 1.5e-6, 40, 20, 40}, Fabric{"cotton", 0.14, 1.8e-5, 130, 60, 76},
        Fabric{"denim", 0.40, 1.2e-4, 500, 70, 90}}) {
    const Drape coarse = drape_of(setting, fabric, 10);
    const Drape fine = drape_of(setting, fabric, 20);
    const std::string of = std::string(" of ") + fabric.name;
    const double middle = 0.5 * (fabric.least + fabric.most);
    rows.push_back(
        absolute_row("drape coefficient" + of, "%", middle, fine.coefficient, fabric.most - middle));
    const CheckRow same = absolute_row("the same on a quarter of the triangles" + of, "%", fine.coefficient,
                                       coarse.coefficient, 3);
    rows.push_back(
        fabric.areal_density < 0.4
            ? known_miss(same, "folds of light cloth lie as the triangles do, and few bend in each")
            : same);
    rows.push_back(absolute_row("folds" + of, "", 11, fine.nodes, 5));
  }
  for (CheckRow& row : rows) {
    row.solver = "cloth";
    row.substeps = kDrapeSubsteps * setting.substeps;
  }
  return rows;
}

}  // namespace hooke::check
