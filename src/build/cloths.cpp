/// This file makes cloth from a grid or a mesh: points with mass by area, springs of three classes, length
/// limits, bends, triangles and tethers.

#include "base/assert.h"
#include "build/build.h"
#include "build/common.h"
#include "build/connection_points.h"
#include "build/tethers.h"
#include "elements/dihedral.h"
#include "elements/isometric_bend.h"
#include "geometry/triangle_mesh.h"
#include "geometry/vertex_order.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace hooke::build {

namespace {

using geometry::EdgeSides;
using geometry::MeshTopology;
using geometry::Triangle;
using state::SpringClass;

constexpr std::size_t kMostPoints = std::size_t{1} << 22;

/// The cloth's points and triangles at rest, in the order of its maker.
struct Surface {
  std::vector<DVec3> points;
  std::vector<Triangle> triangles;
  MeshTopology topology;
  bool is_grid = false;
  int columns = 0, rows = 0;
};

bool can_tear(const ClothDesc& desc) {
  return desc.strength.has_value() || desc.tear_strain.has_value();
}

/// The strain at which the cloth tears.
Real tear_strain_of(const ClothDesc& desc) {
  const Real strain = desc.tear_strain.value_or(kRigid);
  return desc.strength ? std::min(strain, *desc.strength / desc.stretch_stiffness) : strain;
}

Checks check(const ClothDesc& desc, std::size_t count, bool is_grid) {
  Checks checks("cloth");
  if (is_grid) {
    checks.place("corner", desc.corner)
        .finite("column_direction", desc.column_direction)
        .finite("row_direction", desc.row_direction)
        .size("width", static_cast<double>(desc.width))
        .size("height", static_cast<double>(desc.height));
    const DVec3 normal = cross(normalize(vector_cast<double>(desc.column_direction)),
                               normalize(vector_cast<double>(desc.row_direction)));
    checks.require(length(normal) > 1e-3, "row_direction", "must not be zero or along column_direction");
  }
  checks.require(desc.bend <= ClothDesc::Bend::kYarn, "bend", "must be one of ClothDesc::Bend")
      .place("position", desc.position)
      .require(is_rotation(desc.rotation), "rotation", "must be finite and not zero")
      .in_range("areal_density", static_cast<double>(desc.areal_density), 1e-9, 1e9)
      .size("thickness", static_cast<double>(desc.thickness))
      .stiffness("stretch_stiffness", static_cast<double>(desc.stretch_stiffness))
      .stiffness_or_none("shear_stiffness", static_cast<double>(desc.shear_stiffness))
      .up_to("bend_stiffness", static_cast<double>(desc.bend_stiffness), limits::kResistance)
      .up_to("damping", static_cast<double>(desc.damping), limits::kResistance)
      .up_to("bend_damping", static_cast<double>(desc.bend_damping), limits::kResistance)
      .stiffness("yield_angle", static_cast<double>(desc.yield_angle))
      .require(desc.yield_angle == kRigid || desc.bend == ClothDesc::Bend::kAngle ||
                   desc.bend == ClothDesc::Bend::kYarn,
               "yield_angle", "needs bends by angle")
      .stiffness("extension_max", static_cast<double>(desc.extension_max))
      .up_to("drag_coefficient", static_cast<double>(desc.drag_coefficient), 1e6)
      .up_to("lift_coefficient", static_cast<double>(desc.lift_coefficient), 1e6)
      .up_to("air_friction", static_cast<double>(desc.air_friction), limits::kResistance)
      .in_range("charge", static_cast<double>(desc.charge), -1e9, 1e9)
      .velocity("velocity", desc.velocity)
      .in_range("contact.friction", static_cast<double>(desc.contact.friction), 0, 100)
      .require(desc.hit_speed >= Real(0), "hit_speed", static_cast<double>(desc.hit_speed),
               "must not be negative");
  if (desc.strength) {
    checks.positive("strength", static_cast<double>(*desc.strength))
        .require(!std::isinf(desc.stretch_stiffness), "strength",
                 "needs a stretch_stiffness that is not rigid; tear_strain does not");
  }
  if (desc.tear_strain) checks.positive("tear_strain", static_cast<double>(*desc.tear_strain));
  if (desc.pressure) checks.in_range("pressure", static_cast<double>(*desc.pressure), -1e5, 1e8);
  if (desc.total_mass) checks.mass("total_mass", static_cast<double>(*desc.total_mass));
  check_points(checks, desc.pins, desc.loads, count);
  check_connection_points(checks, desc.connection_points, count);
  return checks;
}

Surface make_grid(const ClothDesc& desc) {
  Surface s;
  s.is_grid = true;
  s.columns = desc.columns;
  s.rows = desc.rows;
  const DVec3 right = static_cast<double>(desc.width) * normalize(vector_cast<double>(desc.column_direction));
  const DVec3 down = static_cast<double>(desc.height) * normalize(vector_cast<double>(desc.row_direction));
  for (int row = 0; row < s.rows; ++row) {
    for (int column = 0; column < s.columns; ++column) {
      s.points.push_back(desc.corner + (column / (s.columns - 1.0)) * right + (row / (s.rows - 1.0)) * down);
    }
  }
  for (int row = 0; row + 1 < s.rows; ++row) {
    for (int column = 0; column + 1 < s.columns; ++column) {
      const auto a = static_cast<std::uint32_t>(row * s.columns + column);
      const auto b = a + 1;
      const auto c = a + static_cast<std::uint32_t>(s.columns);
      const auto d = c + 1;
      // Diagonals alternate, so that the cloth prefers no direction to fold.
      const bool even = (row + column) % 2 == 0;
      s.triangles.push_back(even ? Triangle{a, c, d} : Triangle{a, c, b});
      s.triangles.push_back(even ? Triangle{a, d, b} : Triangle{b, c, d});
    }
  }
  return s;
}

/// Triangles without those that join the same three vertices as one before them.
std::vector<Triangle> distinct(const std::vector<Triangle>& triangles) {
  std::vector<std::pair<Triangle, std::size_t>> sorted;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    Triangle corners = triangles[i];
    std::sort(corners.begin(), corners.end());
    sorted.emplace_back(corners, i);
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::uint8_t> is_first(triangles.size(), 0);
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    if (i == 0 || sorted[i].first != sorted[i - 1].first) is_first[sorted[i].second] = 1;
  }
  std::vector<Triangle> kept;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (is_first[i] != 0) kept.push_back(triangles[i]);
  }
  return kept;
}

Surface surface_of_mesh(const ClothDesc& desc, const MeshDesc& mesh) {
  Surface s;
  const Quat rotation = normalize(desc.rotation);
  for (const Vec3& p : mesh.positions)
    s.points.push_back(desc.position + vector_cast<double>(rotate(rotation, p)));
  s.triangles = distinct(mesh.triangles);
  return s;
}

double area_of(const Surface& s, const Triangle& t) {
  return 0.5 * length(cross(s.points[t[1]] - s.points[t[0]], s.points[t[2]] - s.points[t[0]]));
}

/// Area that belongs to each point [m^2]; `total` is their sum.
std::vector<double> area_shares(const Surface& s, double& total) {
  std::vector<double> share(s.points.size(), 0.0);
  for (const Triangle& t : s.triangles) {
    for (const std::uint32_t p : t) share[p] += area_of(s, t) / 3.0;
  }
  // Cells give their areas in quarters, so that corners have exactly 1/4 and rims 1/2 of an inner point's.
  if (s.is_grid) {
    const auto rim = [](int i, int count) { return i == 0 || i + 1 == count ? 0.5 : 1.0; };
    for (int row = 0; row < s.rows; ++row) {
      for (int column = 0; column < s.columns; ++column) {
        share[static_cast<std::size_t>(row) * s.columns + column] = rim(row, s.rows) * rim(column, s.columns);
      }
    }
  }
  double sum = 0;
  total = 0;
  for (const double a : share) sum += a;
  for (const Triangle& t : s.triangles) total += area_of(s, t);
  for (double& a : share) a *= total / sum;
  return share;
}

SpringRow spring(const Surface& s, std::uint32_t a, std::uint32_t b, SpringClass kind,
                 const ClothDesc& desc) {
  const Real stiffness = kind == SpringClass::kStretch ? desc.stretch_stiffness
                         : kind == SpringClass::kShear ? desc.shear_stiffness
                                                       : desc.bend_stiffness;
  return {.a = a,
          .b = b,
          .rest_length = static_cast<Real>(length(s.points[a] - s.points[b])),
          .stiffness = stiffness,
          .damping = kind == SpringClass::kBend ? Real(0) : desc.damping,
          .kind = kind};
}

/// Makes springs along rows and columns, across cells, and to second neighbors. For n x m points there are
/// n(m-1)+m(n-1), 2(n-1)(m-1) and n(m-2)+m(n-2) of them.
std::vector<SpringRow> grid_springs(const Surface& s, const ClothDesc& desc) {
  std::vector<SpringRow> rows;
  const auto add = [&](int column, int row, int right, int down, SpringClass kind) {
    if (column + right < 0 || column + right >= s.columns || row + down >= s.rows) return;
    const auto a = static_cast<std::uint32_t>(row * s.columns + column);
    rows.push_back(
        spring(s, a, static_cast<std::uint32_t>((row + down) * s.columns + column + right), kind, desc));
  };
  for (int row = 0; row < s.rows; ++row) {
    for (int column = 0; column < s.columns; ++column) {
      add(column, row, 1, 0, SpringClass::kStretch);
      add(column, row, 0, 1, SpringClass::kStretch);
      add(column, row, 1, 1, SpringClass::kShear);
      add(column, row, -1, 1, SpringClass::kShear);
      if (desc.bend != ClothDesc::Bend::kSpring) continue;
      add(column, row, 2, 0, SpringClass::kBend);
      add(column, row, 0, 2, SpringClass::kBend);
    }
  }
  return rows;
}

bool is_longest(const Surface& s, const Triangle& t, double edge) {
  for (int k = 0; k < 3; ++k) {
    if (length(s.points[t[k]] - s.points[t[(k + 1) % 3]]) > edge * (1.0 + 1e-9)) return false;
  }
  return true;
}

/// Makes one spring for each edge, however many triangles it has. Where an inner edge is the longest of both
/// its triangles, the two form a cell, and the spring between their far corners resists shear. Across other
/// inner edges that spring resists bending.
std::vector<SpringRow> mesh_springs(const Surface& s, const ClothDesc& desc) {
  std::vector<SpringRow> rows;
  for (std::size_t e = 0; e < s.topology.edges.size(); ++e) {
    const auto [a, b] = s.topology.edges[e];
    rows.push_back(spring(s, a, b, SpringClass::kStretch, desc));
    const EdgeSides& sides = s.topology.edge_sides[e];
    if (sides.triangle_count != 2 || sides.opposite[0] == sides.opposite[1]) continue;
    const double l = length(s.points[a] - s.points[b]);
    const bool cell = is_longest(s, s.triangles[sides.triangles[0]], l) &&
                      is_longest(s, s.triangles[sides.triangles[1]], l);
    if (!cell && desc.bend != ClothDesc::Bend::kSpring) continue;
    rows.push_back(spring(s, sides.opposite[0], sides.opposite[1],
                          cell ? SpringClass::kShear : SpringClass::kBend, desc));
  }
  return rows;
}

void append_springs(const Surface& s, const ClothDesc& desc, double mass, state::Tables& tables) {
  std::vector<SpringRow> rows = s.is_grid ? grid_springs(s, desc) : mesh_springs(s, desc);
  for (SpringRow& row : rows) {
    row.damped_mass = static_cast<Real>(mass / static_cast<double>(s.points.size()));
    if (row.stiffness > Real(0) && row.rest_length > Real(0)) append_spring(row, tables);
  }
  if (std::isinf(desc.extension_max)) return;
  for (SpringRow row : rows) {
    if (row.kind != SpringClass::kStretch || !(row.rest_length > Real(0))) continue;
    row.kind = SpringClass::kLimit;
    row.rest_length *= Real(1) + desc.extension_max;
    row.stiffness = kRigid;
    row.damping = Real(0);
    append_spring(row, tables);
  }
}

/// Returns an Error if the surface is not flat at rest, as isometric bends need it.
Result<void> check_flat(const Surface& s) {
  constexpr double kFlat = 0.01;  // Angle between triangles below which they are flat [rad].
  for (std::size_t e = 0; e < s.topology.edges.size(); ++e) {
    const EdgeSides& sides = s.topology.edge_sides[e];
    if (sides.triangle_count != 2) continue;
    const auto [a, b] = s.topology.edges[e];
    const auto& p = s.points;
    const auto d = elements::dihedral(p[a], p[b], p[sides.opposite[0]], p[sides.opposite[1]]);
    if (!d.valid || std::abs(d.angle) < kFlat) continue;
    return Error{ErrorCode::kOutOfRange, "cloth.bend",
                 "isometric needs a surface that is flat at rest; triangles " +
                     std::to_string(sides.triangles[0]) + " and " + std::to_string(sides.triangles[1]) +
                     " meet at an angle"};
  }
  return {};
}

/// A row of state::Bends.
struct BendRow {
  std::array<std::uint32_t, 4> at = {};  ///< Both ends of an edge, then both wings, as points of the surface.
  std::array<double, 4> weights = {};
  double rest_angle = 0;
  double stiffness = 0;
  Real damping = Real(0);
};

void append_bend(const BendRow& row, state::Tables& tables) {
  state::Deformable& object = tables.objects.back();
  const auto at = [&](std::size_t k) { return row_of(tables, object, row.at[k]); };
  tables.bends.stencil.push_back({at(0), at(1), at(2), at(3)});
  tables.bends.rest_angle.push_back(static_cast<Real>(row.rest_angle));
  tables.bends.stiffness.push_back(static_cast<Real>(row.stiffness));
  tables.bends.damping.push_back(row.damping);
  std::array<Real, 4> weights = {};
  for (std::size_t k = 0; k < 4; ++k) weights[k] = static_cast<Real>(row.weights[k]);
  tables.bends.weights.push_back(weights);
  ++object.bends.count;
}

/// Appends bends of the stiffness |e|^2 B / (A_1 + A_2) of E = k C^2 / 2 for a flexural rigidity B. Folds of
/// length |e| across strips of the width (A_1 + A_2) / |e| then bend a sheet of squares about its lines, and
/// one of equilateral triangles about any line (Seung and Nelson 1988), as a plate of that rigidity does. An
/// isometric bend, |q| = |e| theta, has the same energy with a stiffness B / (A_1 + A_2).
void append_hinges(const Surface& s, const ClothDesc& desc, state::Tables& tables) {
  const bool isometric = desc.bend == ClothDesc::Bend::kIsometric;
  for (std::size_t e = 0; e < s.topology.edges.size(); ++e) {
    const EdgeSides& sides = s.topology.edge_sides[e];
    if (sides.triangle_count != 2 || !sides.has_same_winding) continue;
    if (sides.opposite[0] == sides.opposite[1])
      continue;  // both sides of one triangle: there is nothing to bend
    // The first triangle must run along the edge from x0 to x1; see elements/dihedral.h.
    auto [a, b] = s.topology.edges[e];
    const Triangle& t = s.triangles[sides.triangles[0]];
    for (int k = 0; k < 3; ++k) {
      if (t[k] == b && t[(k + 1) % 3] == a) std::swap(a, b);
    }
    const auto& p = s.points;
    const auto d = elements::dihedral(p[a], p[b], p[sides.opposite[0]], p[sides.opposite[1]]);
    if (!d.valid) continue;
    const double areas = area_of(s, t) + area_of(s, s.triangles[sides.triangles[1]]);
    const double stiffness =
        (isometric ? 1.0 : length_squared(p[b] - p[a])) / areas * static_cast<double>(desc.bend_stiffness);
    std::array<double, 4> weights = {};
    if (isometric) weights = elements::isometric_bend(p[a], p[b], p[sides.opposite[0]], p[sides.opposite[1]]);
    append_bend({.at = {a, b, sides.opposite[0], sides.opposite[1]},
                 .weights = weights,
                 .rest_angle = d.angle,
                 .stiffness = stiffness,
                 .damping = isometric ? desc.bend_damping : static_cast<Real>(stiffness) * desc.bend_damping},
                tables);
  }
}

/// Appends what gives a grid the energy B (c_x^2 + c_y^2 + 2 c_xy^2) / 2 per area, that of a plate of the
/// flexural rigidity B whose Poisson's ratio is 0. The curvature c_x at a point is the change of direction
/// along its row over the length l of a cell; it counts for an area of l and half the cells on both sides of
/// the row. The twist c_xy of a cell of the area A is (x_0 + x_3 - x_1 - x_2) / A.
void append_bends_of_grid(const Surface& s, const ClothDesc& desc, state::Tables& tables) {
  const auto rigidity = static_cast<double>(desc.bend_stiffness);
  const auto point = [&](int column, int row) {
    return static_cast<std::uint32_t>(row * s.columns + column);
  };
  const DVec3 along = s.points[point(1, 0)] - s.points[point(0, 0)];
  const DVec3 down = s.points[point(0, 1)] - s.points[point(0, 0)];
  const double area = length(cross(along, down));
  const auto bend = [&](std::uint32_t at, std::uint32_t beside, std::uint32_t stride, double l, bool at_rim) {
    const double width = (at_rim ? 0.5 : 1.0) * area / l;
    append_bend({.at = {at, beside, at - stride, at + stride},
                 .weights = {-2 / l, 0, 1 / l, 1 / l},
                 .stiffness = rigidity * width / l,
                 .damping = desc.bend_damping},
                tables);
  };
  const auto stride = static_cast<std::uint32_t>(s.columns);
  for (int row = 0; row < s.rows; ++row) {
    for (int column = 0; column < s.columns; ++column) {
      const std::uint32_t at = point(column, row);
      const bool first_row = row == 0, last_row = row + 1 == s.rows;
      const bool first_column = column == 0, last_column = column + 1 == s.columns;
      if (!first_column && !last_column)
        bend(at, last_row ? at - stride : at + stride, 1, length(along), first_row || last_row);
      if (!first_row && !last_row)
        bend(at, last_column ? at - 1 : at + 1, stride, length(down), first_column || last_column);
      if (last_row || last_column) continue;
      append_bend({.at = {at, at + stride + 1, at + 1, at + stride},
                   .weights = {1, 1, -1, -1},
                   .stiffness = 2 * rigidity / area,
                   .damping = desc.bend_damping},
                  tables);
    }
  }
}

void append_bends(const Surface& s, const ClothDesc& desc, state::Tables& tables) {
  using Bend = ClothDesc::Bend;
  if (!(desc.bend_stiffness > Real(0)) || desc.bend == Bend::kSpring || desc.bend == Bend::kNone) return;
  if (desc.bend == Bend::kYarn && s.is_grid && desc.yield_angle == kRigid)
    return append_bends_of_grid(s, desc, tables);
  append_hinges(s, desc, tables);
}

void append_triangles(const Surface& s, double areal_density, state::Tables& tables) {
  state::Deformable& object = tables.objects.back();
  for (std::uint32_t i = 0; i < s.triangles.size(); ++i) {
    const Triangle& t = s.triangles[i];
    HOOKE_ASSERT(t[0] != t[1] && t[1] != t[2] && t[2] != t[0]);
    std::uint8_t own_edges = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const geometry::EdgeSides& sides = s.topology.edge_sides[s.topology.triangle_edges[i][k]];
      if (sides.triangles[0] == i) own_edges |= static_cast<std::uint8_t>(1U << k);
    }
    tables.triangles.corners.push_back(
        {row_of(tables, object, t[0]), row_of(tables, object, t[1]), row_of(tables, object, t[2])});
    tables.triangles.own_edges.push_back(own_edges);
    tables.triangles.mass.push_back(static_cast<Real>(areal_density * area_of(s, t)));
    ++object.triangles.count;
  }
}

/// How much longer than the rest distance tethers are, as a share of it; nothing for cloth without tethers.
/// `mass` and `area` are those of the whole cloth.
std::optional<Real> slack_of_tethers(const ClothDesc& desc, double mass, double area) {
  constexpr double kGravity = 9.81;
  constexpr double kMostOwnStretch = 1e-3;
  if (desc.tethers) return *desc.tethers ? std::optional<Real>(Real(0)) : std::nullopt;
  if (desc.pressure || can_tear(desc)) return std::nullopt;
  const double own_stretch = mass * kGravity / std::sqrt(area) / static_cast<double>(desc.stretch_stiffness);
  const bool is_limited = !std::isinf(desc.extension_max);
  if (own_stretch > kMostOwnStretch) return is_limited ? std::optional(desc.extension_max) : std::nullopt;
  return std::min(desc.extension_max, static_cast<Real>(2 * kMostOwnStretch));
}

void append_tethers(const Surface& s, const ClothDesc& desc, Real slack, state::Tables& tables) {
  std::vector<std::uint32_t> pins;
  for (const PinDesc& pin : desc.pins) pins.push_back(pin.point);
  const TetherSurface surface = {s.points, s.triangles, s.topology, s.is_grid};
  for (const Tether& tether : find_tethers(surface, pins)) {
    append_spring({.a = tether.point,
                   .b = tether.pin,
                   .rest_length = (Real(1) + slack) * tether.length,
                   .stiffness = kRigid,
                   .damping = Real(0),
                   .kind = SpringClass::kTether},
                  tables);
  }
}

/// Sets the volume and the product of pressure and volume, which the gas keeps. Returns an Error if the
/// surface does not enclose a volume.
Result<void> fill_with_gas(const Surface& s, double pressure, state::Deformable& object) {
  double volume = 0;
  for (const Triangle& t : s.triangles) {
    const DVec3 a = s.points[t[0]] - s.points[0];
    volume += dot(a, cross(s.points[t[1]] - s.points[0], s.points[t[2]] - s.points[0])) / 6;
  }
  if (!s.topology.is_closed() || !(volume > 0)) {
    return Error{ErrorCode::kOutOfRange, "cloth.pressure", "needs a closed mesh that faces outward"};
  }
  object.gas = (state::kAirPressure + pressure) * volume;
  object.gas_volume = volume;
  return {};
}

Points make_points(const Surface& s, const ClothDesc& desc, double total_area,
                   const std::vector<double>& share) {
  Points points(s.points.size());
  points.position = s.points;
  const double mass = desc.total_mass ? static_cast<double>(*desc.total_mass)
                                      : total_area * static_cast<double>(desc.areal_density);
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    const double part = share[i] / total_area;
    points.velocity[i] = desc.velocity;
    points.mass[i] = static_cast<Real>(part * mass);
    points.charge[i] = static_cast<Real>(part * static_cast<double>(desc.charge));
    points.viscous_drag[i] = static_cast<Real>(part * static_cast<double>(desc.air_friction));
    points.radius[i] = Real(0.5) * desc.thickness;
  }
  add_loads(desc.loads, points.mass);
  if (!s.is_grid) {
    points.row_of =
        geometry::invert_order(geometry::compute_cuthill_mckee_order(s.points.size(), s.topology.edges));
  }
  return points;
}

Result<Surface> make_surface(const ClothDesc& desc, const state::Tables& tables) {
  if (!desc.mesh) {
    Checks size("cloth");
    size.in_range("columns", desc.columns, 2, 4096).in_range("rows", desc.rows, 2, 4096);
    if (!size.good()) return size.result().error();
    const std::size_t count = static_cast<std::size_t>(desc.columns) * static_cast<std::size_t>(desc.rows);
    const Checks checks = check(desc, count, true);
    if (!checks.good()) return checks.result().error();
    return make_grid(desc);
  }
  const std::uint32_t row = tables.mesh_slots.find(desc.mesh);
  if (row == tables.mesh_slots.kNone || !tables.meshes[row]) {
    return Error{ErrorCode::kStaleId, "cloth.mesh", "refers to no mesh that is in the world"};
  }
  const MeshDesc& mesh = tables.meshes[row]->desc;
  Checks checks = check(desc, mesh.positions.size(), false);
  checks.in_range("mesh", static_cast<double>(mesh.positions.size()), 3, static_cast<double>(kMostPoints));
  if (!checks.good()) return checks.result().error();
  return surface_of_mesh(desc, mesh);
}

Result<void> check_shares(const std::vector<double>& share) {
  for (std::size_t i = 0; i < share.size(); ++i) {
    if (!(share[i] > 0)) {
      return Error{ErrorCode::kOutOfRange, "cloth.mesh",
                   "vertex " + std::to_string(i) + " belongs to no area"};
    }
  }
  return {};
}

void append_places(const Surface& surface, const ClothDesc& desc, state::Tables& tables) {
  if (surface.is_grid) {
    append_connection_points(desc.connection_points, {},
                             connection_points_of_grid(static_cast<std::uint32_t>(surface.columns),
                                                       static_cast<std::uint32_t>(surface.rows)),
                             tables);
  } else {
    append_connection_points(desc.connection_points, {desc.position, desc.rotation}, {}, tables);
  }
}

/// Copies what a description says of the cloth as a whole.
void copy_values(const ClothDesc& desc, state::Deformable& object) {
  object.friction = desc.contact.friction;
  object.yield_angle = desc.yield_angle;
  object.tear_strain = tear_strain_of(desc);
  object.drag_coefficient = desc.drag_coefficient;
  object.lift_coefficient = desc.lift_coefficient;
}

}  // namespace

Result<void> add_cloth(const ClothDesc& desc, state::Tables& tables) {
  Result<Surface> made = make_surface(desc, tables);
  if (!made) return made.error();
  Surface& surface = made.value();
  surface.topology = geometry::compute_topology(surface.points.size(), surface.triangles);
  double area = 0;
  const std::vector<double> share = area_shares(surface, area);
  const Result<void> shared = check_shares(share);
  if (!shared) return shared.error();
  if (desc.bend == ClothDesc::Bend::kIsometric) {
    const Result<void> flat = check_flat(surface);
    if (!flat) return flat.error();
  }
  state::Deformable filled;
  if (desc.pressure) {
    const Result<void> gas = fill_with_gas(surface, static_cast<double>(*desc.pressure), filled);
    if (!gas) return gas.error();
  }
  const Points points = make_points(surface, desc, area, share);
  const auto contact = surface_for_contact({desc.thickness, desc.self_contact, desc.filter}, points,
                                           surface.triangles, "cloth.thickness");
  if (!contact) return contact.error();
  state::Deformable& object = append_object(PointRef::Kind::kCloth, points, desc.pins, tables);
  object.gas = filled.gas;
  object.gas_volume = filled.gas_volume;
  object.surface = contact.value();
  object.columns = static_cast<std::uint32_t>(surface.columns);
  copy_values(desc, object);
  report_contacts(desc.reports_contacts, desc.hit_speed, tables);
  const double mass = desc.total_mass ? static_cast<double>(*desc.total_mass)
                                      : area * static_cast<double>(desc.areal_density);
  append_springs(surface, desc, mass, tables);
  append_bends(surface, desc, tables);
  append_triangles(surface, mass / area, tables);
  if (const auto slack = slack_of_tethers(desc, mass, area)) append_tethers(surface, desc, *slack, tables);
  append_places(surface, desc, tables);
  return {};
}

}  // namespace hooke::build
