#include "build/soft_forms.h"

#include "hooke/geometry.h"

#include "base/assert.h"
#include "build/build.h"
#include "build/checks.h"
#include "build/common.h"
#include "geometry/convex/convex_hull.h"
#include "geometry/solid/tetrahedral_mesh.h"
#include "math/trig.h"
#include "state/body_frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace hooke::build {

namespace {

using geometry::TetrahedralMesh;
using state::SoftForm;

constexpr double kCellsAlong = 10;     ///< Cells along the longest side, if no size is given.
constexpr int kSides = 24;             ///< Sides of a round shape.
constexpr double kMostBoxCells = 256;  ///< Along one side.
constexpr double kLeastFactor =
    0.2;  ///< Least factor on a point's mass when masses are fitted to the inertia.

/// The corners of a ring about the y axis.
void append_ring(double radius, double y, std::vector<Vec3>& points) {
  for (int i = 0; i < kSides; ++i) {
    const auto [s, c] = math::sin_cos(2 * std::numbers::pi * i / kSides);
    points.push_back(vector_cast<Real>(DVec3{radius * c, y, radius * s}));
  }
}

/// The corners of half a sphere about (0, y, 0), above it or below it.
void append_dome(double radius, double y, double up, std::vector<Vec3>& points) {
  for (int i = 0; i < kSides / 4; ++i) {
    const auto [s, c] = math::sin_cos(std::numbers::pi / 2 * i / (kSides / 4));
    append_ring(radius * c, y + up * radius * s, points);
  }
  points.push_back(vector_cast<Real>(DVec3{0, y + up * radius, 0}));
}

/// Corners whose hull is the shape, or nearly so if it is round.
std::vector<Vec3> corners_of(const Shape& shape) {
  const auto radius = static_cast<double>(shape.radius);
  const auto half_height = static_cast<double>(shape.half_height);
  std::vector<Vec3> points;
  switch (shape.kind) {
    case ShapeKind::kSphere:
      append_dome(radius, 0, 1, points);
      append_dome(radius, 0, -1, points);
      break;
    case ShapeKind::kCapsule:
      append_dome(radius, half_height, 1, points);
      append_dome(radius, -half_height, -1, points);
      break;
    case ShapeKind::kCylinder:
      append_ring(radius, half_height, points);
      append_ring(radius, -half_height, points);
      break;
    case ShapeKind::kCone:
      append_ring(radius, -half_height, points);
      points.push_back(vector_cast<Real>(DVec3{0, half_height, 0}));
      break;
    default:
      break;
  }
  return points;
}

/// The closed surface of a shape that is no box.
Result<MeshDesc> surface_of_shape(const Shape& shape, const state::Tables& t) {
  if (shape.kind == ShapeKind::kMesh) return t.meshes[t.mesh_slots.find(shape.mesh)]->desc;
  if (shape.kind == ShapeKind::kHull) {
    const Result<state::ColliderShape> made = make_shape(shape, "body.", t);
    if (!made) return made.error();
    return geometry::mesh_of(*made.value().hull);
  }
  const Result<geometry::ConvexHull> hull = geometry::make_convex_hull(corners_of(shape));
  if (!hull) return hull.error();
  return geometry::mesh_of(hull.value());
}

double longest_side(const MeshDesc& surface) {
  geometry::Box box;
  for (const Vec3& p : surface.positions) box = merge(box, p);
  const DVec3 size = vector_cast<double>(box.upper - box.lower);
  return std::max({size.x, size.y, size.z});
}

TetrahedralMesh fill_box_shape(Vec3 half_extents, double cell) {
  const DVec3 size = 2 * vector_cast<double>(half_extents);
  if (cell == 0) cell = std::max({size.x, size.y, size.z}) / kCellsAlong;
  const auto count = [&](double side) {
    return static_cast<int>(std::clamp(std::floor(side / cell + 0.5), 1.0, kMostBoxCells));
  };
  geometry::CellGrid grid = {.counts = {count(size.x), count(size.y), count(size.z)}, .corner = -0.5 * size};
  grid.cell = {size.x / grid.counts[0], size.y / grid.counts[1], size.z / grid.counts[2]};
  grid.filled.assign(static_cast<std::size_t>(grid.counts[0]) * grid.counts[1] * grid.counts[2], 1);
  return geometry::fill_cells(grid);
}

// Masses of points are fitted to the body: m_i (1 + c.phi(x_i)) with the ten products of up to two
// coordinates as phi has, for one c, the body's mass, center and inertia.
constexpr std::size_t kProducts = 10;
using Products = std::array<double, kProducts>;

Products products_of(DVec3 x) {
  return {1, x.x, x.y, x.z, x.x * x.x, x.y * x.y, x.z * x.z, x.x * x.y, x.x * x.z, x.y * x.z};
}

/// The sums of m phi(x) over a body about its center of mass, with lengths over `unit`.
Products wanted_sums(const state::BodyMass& mass, double unit) {
  const Quat q = mass.principal;
  const Quaternion<double> axes =
      normalize(Quaternion<double>{static_cast<double>(q.x), static_cast<double>(q.y),
                                   static_cast<double>(q.z), static_cast<double>(q.w)});
  const DVec3 moments = vector_cast<double>(mass.inertia);
  const double half = 0.5 * (moments.x + moments.y + moments.z);
  const std::array<DVec3, 3> axis = {rotate(axes, DVec3{1, 0, 0}), rotate(axes, DVec3{0, 1, 0}),
                                     rotate(axes, DVec3{0, 0, 1})};
  const std::array<double, 3> second = {half - moments.x, half - moments.y, half - moments.z};
  Products sums = {static_cast<double>(mass.mass)};
  for (std::size_t k = 0; k < 3; ++k) {
    const Products along = products_of(axis[k]);
    for (std::size_t i = 4; i < kProducts; ++i) sums[i] += second[k] / (unit * unit) * along[i];
  }
  return sums;
}

/// Solves a x = b by elimination with the largest pivot on the diagonal. Unknowns whose pivot vanishes are 0.
Products solve_symmetric(std::array<Products, kProducts> a, Products b) {
  std::array<bool, kProducts> used = {};
  std::array<std::size_t, kProducts> order = {};
  std::size_t rank = 0;
  const double least = 1e-10 * a[0][0];
  for (; rank < kProducts; ++rank) {
    std::size_t best = kProducts;
    for (std::size_t i = 0; i < kProducts; ++i) {
      if (!used[i] && a[i][i] > least && (best == kProducts || a[i][i] > a[best][best])) best = i;
    }
    if (best == kProducts) break;
    used[best] = true;
    order[rank] = best;
    for (std::size_t i = 0; i < kProducts; ++i) {
      if (used[i]) continue;
      const double factor = a[i][best] / a[best][best];
      for (std::size_t j = 0; j < kProducts; ++j) a[i][j] -= factor * a[best][j];
      b[i] -= factor * b[best];
    }
  }
  Products x = {};
  for (std::size_t k = rank; k-- > 0;) {
    const std::size_t i = order[k];
    double rest = b[i];
    for (std::size_t l = k + 1; l < rank; ++l) rest -= a[i][order[l]] * x[order[l]];
    x[i] = rest / a[i][i];
  }
  return x;
}

/// Shares of a mass that points have by the volume of their tetrahedra.
std::vector<double> masses_by_volume(const TetrahedralMesh& mesh, double mass) {
  std::vector<double> share(mesh.points.size(), 0.0);
  const auto& x = mesh.points;
  double whole = 0;
  for (const geometry::Tetrahedron& t : mesh.tetrahedra) {
    const double volume = geometry::volume6(x[t[0]], x[t[1]], x[t[2]], x[t[3]]);
    for (const std::uint32_t p : t) share[p] += volume;
    whole += 4 * volume;
  }
  for (double& m : share) m *= mass / whole;
  return share;
}

/// Masses of points that have the mass of the body and, as far as no point becomes much lighter for it, its
/// center and inertia.
std::vector<double> fitted_masses(const TetrahedralMesh& mesh, const state::BodyMass& mass) {
  const auto& x = mesh.points;
  const std::vector<double> share = masses_by_volume(mesh, static_cast<double>(mass.mass));
  double unit = 0;
  for (const DVec3& p : x) unit = std::max(unit, length(p));
  std::array<Products, kProducts> a = {};
  const Products wanted = wanted_sums(mass, unit);
  Products lacking = wanted;
  for (std::size_t i = 0; i < share.size(); ++i) {
    const Products phi = products_of(1 / unit * x[i]);
    for (std::size_t j = 0; j < kProducts; ++j) {
      lacking[j] -= share[i] * phi[j];
      for (std::size_t k = 0; k < kProducts; ++k) a[j][k] += share[i] * phi[j] * phi[k];
    }
  }
  const Products c = solve_symmetric(a, lacking);
  std::vector<double> fitted = share;
  for (std::size_t i = 0; i < share.size(); ++i) {
    const Products phi = products_of(1 / unit * x[i]);
    double factor = 1;
    for (std::size_t j = 0; j < kProducts; ++j) factor += c[j] * phi[j];
    if (!(factor >= kLeastFactor)) return share;
    fitted[i] *= factor;
  }
  return fitted;
}

/// Rounds masses; what rounding takes from one point is given to the next, so that their sum stays.
std::vector<Real> rounded_masses(const std::vector<double>& exact) {
  std::vector<Real> masses;
  double lost = 0;
  for (const double mass : exact) {
    masses.push_back(static_cast<Real>(mass + lost));
    lost += mass - static_cast<double>(masses.back());
  }
  return masses;
}

}  // namespace

Result<void> validate_yields(const BodyDesc& desc) {
  const YieldsDesc& yields = *desc.yields;
  Checks checks("body");
  checks.positive("yields.impulse", static_cast<double>(yields.impulse))
      .up_to("yields.cell", static_cast<double>(yields.cell), limits::kSize)
      .positive("yields.freeze_below", static_cast<double>(yields.freeze_below))
      .in_range("yields.freeze_after", static_cast<double>(yields.freeze_after), 0, 1e6)
      .require(desc.kind == BodyKind::kDynamic, "yields",
               "needs a dynamic body: nothing hits a static or kinematic one out of its place; hooks to the "
               "world hold a dynamic one")
      .require(desc.shape.kind != ShapeKind::kCompound, "yields",
               "needs one shape: join the parts to one mesh (combine_solids), or hook bodies together")
      .require(desc.shape.kind != ShapeKind::kHalfSpace, "yields", "needs a shape of finite size")
      .require(desc.collides && !desc.sensor, "yields", "needs a body that collides and is no sensor")
      .require(desc.gravity_scale == Real(1), "yields",
               "needs a gravity_scale of 1, as solids have; a uniform field can lift what is light")
      .require(desc.dipole_moment == Vec3{}, "yields",
               "needs a body without a dipole_moment: solids have none");
  return checks.result();
}

Result<std::shared_ptr<const SoftForm>> make_soft_form(const BodyDesc& desc, const state::BodyMass& mass,
                                                       const state::Tables& t) {
  auto cell = static_cast<double>(desc.yields->cell);
  TetrahedralMesh mesh;
  auto form = std::make_shared<SoftForm>();
  if (desc.shape.kind == ShapeKind::kBox) {
    mesh = fill_box_shape(desc.shape.half_extents, cell);
    form->skin = skin_of(mesh);
  } else {
    const Result<MeshDesc> surface = surface_of_shape(desc.shape, t);
    if (!surface) return surface.error();
    if (cell == 0) cell = longest_side(surface.value()) / kCellsAlong;
    Result<TetrahedralMesh> filled = geometry::fill_solid(surface.value(), cell);
    if (!filled) {
      return Error{
          filled.error().code, "body.yields",
          "cannot fill the shape with tetrahedra: " + filled.error().where + ": " + filled.error().message};
    }
    mesh = std::move(filled).value();
    form->skin = skin_of(mesh, surface.value());
  }
  for (DVec3& p : mesh.points) p -= vector_cast<double>(mass.center);
  form->mass = rounded_masses(fitted_masses(mesh, mass));
  for (const DVec3& p : mesh.points) form->points.push_back(vector_cast<Real>(p));
  form->tetrahedra = std::move(mesh.tetrahedra);
  return std::shared_ptr<const SoftForm>(std::move(form));
}

Result<void> validate_soft_form(const SoftForm& form, const YieldsDesc& yields) {
  state::Tables scratch;
  Result<void> good = add_solid(describe_soft_form(form, yields), scratch);
  if (good) return good;
  const std::string& where = good.error().where;  // It begins with "solid.".
  return Error{good.error().code, "body.yields" + where.substr(std::min(where.find('.'), where.size())),
               good.error().message};
}

SolidDesc describe_soft_form(const SoftForm& form, const YieldsDesc& yields) {
  return {.points = form.points,
          .tetrahedra = form.tetrahedra,
          .young_modulus = yields.young_modulus,
          .poisson_ratio = yields.poisson_ratio,
          .damping = yields.damping,
          .yield_stress = yields.yield_stress,
          .thickness = yields.thickness};
}

Result<void> append_soft_form(const state::Yielding& yielding, state::Tables& t) {
  const SoftForm& form = *yielding.form;
  const std::uint32_t body = yielding.body;
  const state::Bodies& b = t.bodies;
  SolidDesc desc = describe_soft_form(form, yielding.desc);
  desc.position = b.center[body];
  desc.rotation = b.rotation[body];
  desc.total_mass = b.mass[body].mass;
  const ContactDesc& surface = t.colliders.surface[b.first_collider[body]];
  desc.contact = surface;
  desc.filter = b.traits[body].filter;
  const Result<void> added = add_solid(desc, t);
  if (!added) return added;

  state::Deformable& object = t.objects.back();
  object.skin = form.skin;
  const DVec3 omega = vector_cast<double>(
      state::angular_velocity_of(b.mass[body], b.rotation[body], b.angular_momentum[body]));
  for (std::uint32_t i = 0; i < object.particles.count; ++i) {
    const std::uint32_t row = row_of(t, object, i);
    const DVec3 arm =
        object.origin + vector_cast<double>(t.particles.position[row].x) - t.bodies.center[body];
    const DVec3 v = vector_cast<double>(b.motion[body].v) + cross(omega, arm);
    t.particles.mass[row] = form.mass[i];
    t.particles.velocity[row] = {vector_cast<Real>(v), Real(1) / form.mass[i]};
  }
  return {};
}

}  // namespace hooke::build
