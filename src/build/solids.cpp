/// This file makes solids from a box of cells, from a closed mesh, from given tetrahedra, or from points
/// alone.

#include "base/assert.h"
#include "build/build.h"
#include "build/common.h"
#include "build/connection_points.h"
#include "elements/tetrahedron.h"
#include "geometry/solid/tetrahedral_mesh.h"
#include "geometry/triangle_mesh.h"
#include "geometry/vertex_order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

namespace hooke::build {

namespace {

using geometry::TetrahedralMesh;
using geometry::Tetrahedron;
using geometry::Triangle;

constexpr double kMostCells = 1 << 20;
constexpr std::size_t kMostTetrahedra = std::size_t{1} << 24;
/// Smallest volume of a tetrahedron over the cube of its longest edge; it is 0.118 if all edges are equal.
constexpr double kFlattest = 1e-5;
constexpr double kSmallest = 1e-15;  ///< Smallest volume of a tetrahedron, below which floats lose it [m^3].

struct SolidBody {
  TetrahedralMesh mesh;  ///< Mesh in the world; it has no tetrahedra if shape matching needs only its points.
  double volume = 0;     ///< Volume to which the density applies [m^3]; 0 for points alone.
  std::vector<double> share;  ///< Share of the mass at each point.
  std::shared_ptr<const state::Skin> skin;
};

bool is_matched(const SolidDesc& desc) {
  return desc.elasticity == SolidDesc::Elasticity::kShapeMatching;
}

/// Whether a solid is made as a box of cells, because neither a mesh nor tetrahedra nor points are given.
bool is_box(const SolidDesc& desc) {
  return !desc.mesh && desc.tetrahedra.empty() && desc.points.empty();
}

Checks check(const SolidDesc& desc) {
  Checks checks("solid");
  checks
      .require(desc.elasticity <= SolidDesc::Elasticity::kShapeMatching, "elasticity",
               "must be one of SolidDesc::Elasticity")
      .place("position", desc.position)
      .require(is_rotation(desc.rotation), "rotation", "must be finite and not zero")
      .in_range("density", static_cast<double>(desc.density), 1e-6, 1e9)
      .positive("young_modulus", static_cast<double>(desc.young_modulus))
      .in_range("young_modulus", static_cast<double>(desc.young_modulus), 1e-6, 1e12)
      .in_range("poisson_ratio", static_cast<double>(desc.poisson_ratio), 0, 0.499)
      .in_range("damping", static_cast<double>(desc.damping), 0, 0.1)
      .stiffness("yield_stress", static_cast<double>(desc.yield_stress))
      .size("thickness", static_cast<double>(desc.thickness))
      .up_to("air_friction", static_cast<double>(desc.air_friction), limits::kResistance)
      .in_range("charge", static_cast<double>(desc.charge), -1e9, 1e9)
      .velocity("velocity", desc.velocity)
      .in_range("contact.friction", static_cast<double>(desc.contact.friction), 0, 100)
      .require(desc.hit_speed >= Real(0), "hit_speed", static_cast<double>(desc.hit_speed),
               "must not be negative");
  if (desc.total_mass) checks.mass("total_mass", static_cast<double>(*desc.total_mass));
  if (desc.strength) {
    checks.positive("strength", static_cast<double>(*desc.strength))
        .require(!is_matched(desc), "strength", "needs tetrahedra, which shape matching has not");
  }
  if (!is_matched(desc)) return checks;
  return checks.stiffness("match_hz", static_cast<double>(desc.match_hz))
      .in_range("match_damping_ratio", static_cast<double>(desc.match_damping_ratio), 0, 100)
      .require(desc.yield_stress == kRigid, "yield_stress", "needs tetrahedra");
}

Checks check_box(const SolidDesc& desc) {
  Checks checks = check(desc);
  const char* const axes[] = {"[0]", "[1]", "[2]"};
  double count = 1;
  for (int k = 0; k < 3; ++k) {
    checks.in_range(std::string("cells") + axes[k], desc.cells[k], 1, 256);
    count *= desc.cells[k];
  }
  checks.require(count <= kMostCells, "cells", "must not be more than 1048576 in all");
  return checks.size("size.x", static_cast<double>(desc.size.x))
      .size("size.y", static_cast<double>(desc.size.y))
      .size("size.z", static_cast<double>(desc.size.z));
}

TetrahedralMesh fill_box(const SolidDesc& desc) {
  const DVec3 size = vector_cast<double>(desc.size);
  geometry::CellGrid grid = {.counts = {desc.cells[0], desc.cells[1], desc.cells[2]}, .corner = -0.5 * size};
  grid.cell = {size.x / desc.cells[0], size.y / desc.cells[1], size.z / desc.cells[2]};
  grid.filled.assign(static_cast<std::size_t>(desc.cells[0]) * desc.cells[1] * desc.cells[2], 1);
  return geometry::fill_cells(grid);
}

double longest_edge(const std::vector<DVec3>& points, const Tetrahedron& t) {
  constexpr int kEdges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
  double longest = 0;
  for (const auto& [a, b] : kEdges) longest = std::max(longest, length(points[t[a]] - points[t[b]]));
  return longest;
}

/// Checks given tetrahedra, and turns those around that are inside out.
Result<TetrahedralMesh> take_given(const SolidDesc& desc) {
  TetrahedralMesh mesh;
  Checks checks("solid");
  checks.in_range("tetrahedra", static_cast<double>(desc.tetrahedra.size()), 1, kMostTetrahedra);
  for (std::size_t i = 0; i < desc.points.size(); ++i) {
    const DVec3 p = vector_cast<double>(desc.points[i]);
    checks.within(indexed("points", i), p, limits::kSize, " m");
    mesh.points.push_back(p);
  }
  std::vector<std::uint8_t> used(desc.points.size(), 0);
  for (std::size_t i = 0; checks.good() && i < desc.tetrahedra.size(); ++i) {
    Tetrahedron t = desc.tetrahedra[i];
    const std::string where = indexed("tetrahedra", i);
    for (const std::uint32_t p : t) checks.require(p < desc.points.size(), where, p, "is not a point");
    if (!checks.good()) break;
    const double longest = longest_edge(mesh.points, t);
    const auto& x = mesh.points;
    const double volume = geometry::volume6(x[t[0]], x[t[1]], x[t[2]], x[t[3]]) / 6;
    checks.require(std::abs(volume) > kFlattest * longest * longest * longest, where, "is flat");
    if (volume < 0) std::swap(t[2], t[3]);
    for (const std::uint32_t p : t) used[p] = 1;
    mesh.tetrahedra.push_back(t);
  }
  for (std::size_t i = 0; i < used.size(); ++i)
    checks.require(used[i] != 0, indexed("points", i), "belongs to no tetrahedron");
  if (!checks.good()) return checks.result().error();
  return mesh;
}

double volume_of(const TetrahedralMesh& mesh, std::size_t i) {
  const auto& x = mesh.points;
  const Tetrahedron& t = mesh.tetrahedra[i];
  return geometry::volume6(x[t[0]], x[t[1]], x[t[2]], x[t[3]]) / 6;
}

double volume_of(const TetrahedralMesh& mesh) {
  double sum = 0;
  for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i) sum += volume_of(mesh, i);
  return sum;
}

/// Gives each corner of a tetrahedron a quarter of its volume. The shares have the sum 1.
std::vector<double> volume_shares(const TetrahedralMesh& mesh) {
  std::vector<double> share(mesh.points.size(), 0.0);
  const double whole = volume_of(mesh);
  for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i) {
    for (const std::uint32_t p : mesh.tetrahedra[i]) share[p] += volume_of(mesh, i) / (4 * whole);
  }
  return share;
}

/// Takes the vertices of a closed surface as points, with their shares of its area.
Result<SolidBody> take_vertices(const MeshDesc& surface) {
  SolidBody body;
  body.volume = geometry::compute_signed_volume(surface.positions, surface.triangles);
  const geometry::MeshTopology topology =
      geometry::compute_topology(surface.positions.size(), surface.triangles);
  if (!topology.is_closed() || !(body.volume > 0))
    return Error{ErrorCode::kOutOfRange, "solid.mesh", "must be closed and face outward"};
  auto skin = std::make_shared<state::Skin>();
  skin->triangles = surface.triangles;
  for (const Vec3& p : surface.positions) {
    const auto number = static_cast<std::uint32_t>(body.mesh.points.size());
    skin->vertices.push_back({.points = {number, number, number, number}, .weights = {Real(1)}});
    body.mesh.points.push_back(vector_cast<double>(p));
  }
  body.share.assign(body.mesh.points.size(), 0.0);
  double area = 0;
  const auto& x = body.mesh.points;
  for (const auto& [a, b, c] : surface.triangles) {
    const double third = length(cross(x[b] - x[a], x[c] - x[a])) / 6;
    for (const std::uint32_t p : {a, b, c}) body.share[p] += third;
    area += 3 * third;
  }
  for (double& share : body.share) share /= area;
  body.skin = std::move(skin);
  return body;
}

/// Takes points alone, with equal masses.
Result<SolidBody> take_points(const SolidDesc& desc) {
  Checks checks("solid");
  checks.require(desc.total_mass.has_value(), "total_mass", "is needed for points without tetrahedra");
  SolidBody body;
  for (std::size_t i = 0; i < desc.points.size(); ++i) {
    body.mesh.points.push_back(vector_cast<double>(desc.points[i]));
    checks.place(indexed("points", i), body.mesh.points.back());
  }
  if (!checks.good()) return checks.result().error();
  body.share.assign(desc.points.size(), 1.0 / static_cast<double>(desc.points.size()));
  body.skin = std::make_shared<state::Skin>();
  return body;
}

/// Fills the inside of a mesh with a lattice of tetrahedra.
Result<SolidBody> fill_mesh(const SolidDesc& desc, const MeshDesc& surface) {
  Result<TetrahedralMesh> filled = geometry::fill_solid(surface, static_cast<double>(desc.cell));
  if (!filled) return Error{filled.error().code, "solid." + filled.error().where, filled.error().message};
  SolidBody body;
  body.mesh = std::move(filled).value();
  body.volume = geometry::compute_signed_volume(surface.positions, surface.triangles);
  body.share = volume_shares(body.mesh);
  body.skin = skin_of(body.mesh, surface);
  return body;
}

/// Takes a box of cells, or given tetrahedra.
Result<SolidBody> take_tetrahedra(const SolidDesc& desc) {
  Result<TetrahedralMesh> mesh = is_box(desc) ? Result<TetrahedralMesh>(fill_box(desc)) : take_given(desc);
  if (!mesh) return mesh.error();
  SolidBody body;
  body.mesh = std::move(mesh).value();
  body.volume = volume_of(body.mesh);
  body.share = volume_shares(body.mesh);
  body.skin = skin_of(body.mesh);
  if (is_matched(desc)) body.mesh.tetrahedra.clear();
  return body;
}

Result<SolidBody> find_body(const SolidDesc& desc, const state::Tables& tables) {
  if (!desc.mesh) {
    const bool points_alone = is_matched(desc) && desc.tetrahedra.empty() && !desc.points.empty();
    return points_alone ? take_points(desc) : take_tetrahedra(desc);
  }
  const std::uint32_t row = tables.mesh_slots.find(desc.mesh);
  if (row == tables.mesh_slots.kNone || !tables.meshes[row]) {
    return Error{ErrorCode::kStaleId, "solid.mesh", "refers to no mesh that is in the world"};
  }
  const MeshDesc& surface = tables.meshes[row]->desc;
  return is_matched(desc) ? take_vertices(surface) : fill_mesh(desc, surface);
}

/// Replaces the skin of a solid by a mesh that its tetrahedra carry along.
Result<void> put_on_visual(const SolidDesc& desc, const state::Tables& tables, SolidBody& body) {
  if (!desc.visual) return {};
  const std::uint32_t row = tables.mesh_slots.find(desc.visual);
  if (row == tables.mesh_slots.kNone || !tables.meshes[row])
    return Error{ErrorCode::kStaleId, "solid.visual", "refers to no mesh that is in the world"};
  if (body.mesh.tetrahedra.empty())
    return Error{ErrorCode::kOutOfRange, "solid.visual", "needs tetrahedra, which shape matching has not"};
  body.skin = skin_of(body.mesh, tables.meshes[row]->desc);
  return {};
}

Result<SolidBody> make_body(const SolidDesc& desc, const state::Tables& tables) {
  const Checks checks = is_box(desc) ? check_box(desc) : check(desc);
  if (!checks.good()) return checks.result().error();
  Result<SolidBody> found = find_body(desc, tables);
  if (!found) return found;
  SolidBody body = std::move(found).value();
  if (const Result<void> put = put_on_visual(desc, tables, body); !put) return put.error();
  const Quaternion<double> rotation =
      normalize(Quaternion<double>{desc.rotation.x, desc.rotation.y, desc.rotation.z, desc.rotation.w});
  for (DVec3& p : body.mesh.points) p = desc.position + rotate(rotation, p);
  return body;
}

Points make_points(const SolidBody& body, const SolidDesc& desc) {
  Points points(body.mesh.points.size());
  points.position = body.mesh.points;
  const double mass = desc.total_mass ? static_cast<double>(*desc.total_mass)
                                      : body.volume * static_cast<double>(desc.density);
  const std::vector<double>& share = body.share;
  for (std::size_t i = 0; i < share.size(); ++i) {
    points.velocity[i] = desc.velocity;
    points.mass[i] = static_cast<Real>(share[i] * mass);
    points.charge[i] = static_cast<Real>(share[i] * static_cast<double>(desc.charge));
    points.viscous_drag[i] = static_cast<Real>(share[i] * static_cast<double>(desc.air_friction));
    points.radius[i] = Real(0.5) * desc.thickness;
  }
  add_loads(desc.loads, points.mass);
  if (is_matched(desc)) return points;
  std::vector<geometry::Edge> edges;
  for (const Tetrahedron& t : body.mesh.tetrahedra) {
    for (int k = 0; k < 4; ++k) edges.push_back({t[k], t[(k + 1) % 4]});
  }
  points.row_of = geometry::invert_order(geometry::compute_cuthill_mckee_order(share.size(), edges));
  return points;
}

void append_tetrahedra(const TetrahedralMesh& mesh, const SolidDesc& desc, state::Tables& tables) {
  state::Deformable& object = tables.objects.back();
  const auto material =
      elements::neo_hookean(static_cast<double>(desc.young_modulus), static_cast<double>(desc.poisson_ratio));
  const auto& x = mesh.points;
  for (const Tetrahedron& t : mesh.tetrahedra) {
    HOOKE_ASSERT(std::max({t[0], t[1], t[2], t[3]}) < object.particles.count);
    const auto rest = elements::tetrahedron_rest<double>({x[t[0]], x[t[1]], x[t[2]], x[t[3]]});
    tables.tetrahedra.corners.push_back({row_of(tables, object, t[0]), row_of(tables, object, t[1]),
                                         row_of(tables, object, t[2]), row_of(tables, object, t[3])});
    tables.tetrahedra.shape_gradient.push_back(
        {vector_cast<Real>(rest.b[1]), vector_cast<Real>(rest.b[2]), vector_cast<Real>(rest.b[3])});
    tables.tetrahedra.volume.push_back(static_cast<Real>(rest.volume));
    tables.tetrahedra.shear_modulus.push_back(static_cast<Real>(material.shear));
    tables.tetrahedra.volume_modulus.push_back(static_cast<Real>(material.volume));
    tables.tetrahedra.damping_time.push_back(desc.damping);
    ++object.tetrahedra.count;
  }
}

std::shared_ptr<const state::RestEdges> rest_edges_of(const TetrahedralMesh& mesh) {
  auto edges = std::make_shared<state::RestEdges>();
  const auto& x = mesh.points;
  for (const Tetrahedron& t : mesh.tetrahedra) {
    const auto edge = [&](int k) { return vector_cast<Real>(x[t[k]] - x[t[0]]); };
    edges->push_back({edge(1), edge(2), edge(3)});
  }
  return edges;
}

/// Makes the rest shape for shape matching. Returns an Error for flat points, whose rotation could not be
/// found.
Result<std::shared_ptr<const state::RestShape>> rest_shape_of(const Points& points, const SolidDesc& desc,
                                                              double volume) {
  auto rest = std::make_shared<state::RestShape>();
  rest->volume = volume;
  DVec3 center;
  for (std::size_t i = 0; i < points.mass.size(); ++i) {
    const auto mass = static_cast<double>(points.mass[i]);
    rest->mass += mass;
    center += mass * points.position[i];
  }
  center = (1 / rest->mass) * center;
  Matrix3<double> second = {{}, {}, {}};
  for (std::size_t i = 0; i < points.mass.size(); ++i) {
    const DVec3 q = points.position[i] - center;
    const DVec3 weighed = static_cast<double>(points.mass[i]) * q;
    second = second + Matrix3<double>{q.x * weighed, q.y * weighed, q.z * weighed};
    rest->inertia += dot(q, weighed);
    rest->place.push_back(q);
  }
  constexpr double kFlat = 1e-9;  // This is a thickness of about 1e-4 of the size.
  if (!(determinant(second) > kFlat * rest->inertia * rest->inertia * rest->inertia))
    return Error{ErrorCode::kOutOfRange, "solid.points", "must not lie in one plane"};
  const double w = 2 * std::numbers::pi * static_cast<double>(desc.match_hz);
  rest->stiffness = w * w;
  if (std::isfinite(w)) rest->damping = 2 * static_cast<double>(desc.match_damping_ratio) * w;
  return std::shared_ptr<const state::RestShape>(std::move(rest));
}

/// The triangles of a solid's surface between its points; none for points alone.
std::vector<Triangle> surface_triangles(const SolidBody& body) {
  if (!body.mesh.tetrahedra.empty()) return geometry::surface_of(body.mesh.tetrahedra);
  std::vector<Triangle> triangles = body.skin->triangles;
  for (Triangle& triangle : triangles) {
    for (std::uint32_t& corner : triangle) corner = body.skin->vertices[corner].points[0];
  }
  return triangles;
}

void check_body(const SolidDesc& desc, const TetrahedralMesh& mesh, Checks& checks) {
  check_points(checks, desc.pins, desc.loads, mesh.points.size());
  check_connection_points(checks, desc.connection_points, mesh.points.size());
  for (std::size_t i = 0; checks.good() && i < mesh.tetrahedra.size(); ++i)
    checks.require(volume_of(mesh, i) >= kSmallest, "size", "is too small: tetrahedra below 1e-15 m^3");
}

}  // namespace

std::shared_ptr<const state::Skin> skin_of(const TetrahedralMesh& mesh) {
  auto skin = std::make_shared<state::Skin>();
  std::vector<std::uint32_t> number(mesh.points.size(), geometry::kNone);
  for (geometry::Triangle t : geometry::surface_of(mesh.tetrahedra)) {
    for (std::uint32_t& p : t) {
      if (number[p] == geometry::kNone) {
        number[p] = static_cast<std::uint32_t>(skin->vertices.size());
        skin->vertices.push_back({.points = {p, p, p, p}, .weights = {Real(1)}});
      }
      p = number[p];
    }
    skin->triangles.push_back(t);
  }
  return skin;
}

std::shared_ptr<const state::Skin> skin_of(const TetrahedralMesh& mesh, const MeshDesc& surface) {
  std::vector<DVec3> places;
  for (const Vec3& p : surface.positions) places.push_back(vector_cast<double>(p));
  auto skin = std::make_shared<state::Skin>();
  for (const geometry::TetrahedronPlace& place : geometry::locate(mesh, places)) {
    state::Skin::Anchor& anchor = skin->vertices.emplace_back();
    anchor.points = mesh.tetrahedra[place.tetrahedron];
    for (std::size_t k = 0; k < 4; ++k) anchor.weights[k] = static_cast<Real>(place.weights[k]);
  }
  skin->triangles = surface.triangles;
  return skin;
}

Result<void> add_solid(const SolidDesc& desc, state::Tables& tables) {
  const Result<SolidBody> body = make_body(desc, tables);
  if (!body) return body.error();
  const TetrahedralMesh& mesh = body.value().mesh;
  Checks checks("solid");
  check_body(desc, mesh, checks);
  if (!checks.good()) return checks.result();
  const Points points = make_points(body.value(), desc);
  for (std::size_t i = 0; i < points.mass.size(); ++i)
    checks.require(points.mass[i] > Real(0), "density", "is too small: point masses would be zero");
  if (!checks.good()) return checks.result();
  std::shared_ptr<const state::RestShape> rest_shape;
  if (is_matched(desc)) {
    const auto made = rest_shape_of(points, desc, body.value().volume);
    if (!made) return made.error();
    rest_shape = made.value();
  }
  const auto contact = surface_for_contact({desc.thickness, desc.self_contact, desc.filter}, points,
                                           surface_triangles(body.value()), "solid.thickness");
  if (!contact) return contact.error();
  state::Deformable& object = append_object(PointRef::Kind::kSolid, points, desc.pins, tables);
  object.rest_shape = std::move(rest_shape);
  object.friction = desc.contact.friction;
  report_contacts(desc.reports_contacts, desc.hit_speed, tables);
  object.surface = contact.value();
  object.yield_stress = desc.yield_stress;
  object.tear_stress = desc.strength.value_or(kRigid);
  if (desc.yield_stress < kRigid) object.rest_edges = rest_edges_of(mesh);
  object.skin = body.value().skin;
  append_tetrahedra(mesh, desc, tables);
  append_connection_points(desc.connection_points, {desc.position, desc.rotation},
                           is_box(desc) ? connection_points_of_box(desc.cells) : state::NamedPlaces{},
                           tables);
  return {};
}

}  // namespace hooke::build
