#include "hooke/geometry.h"

#include "base/assert.h"
#include "base/make_room.h"
#include "build/build.h"
#include "build/checks.h"
#include "build/connection_points.h"
#include "build/soft_forms.h"
#include "geometry/convex/mass_properties.h"
#include "state/body_frames.h"
#include "state/sleeping_pairs.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <utility>

namespace hooke::build {

namespace {

using geometry::MassProperties;
using state::ColliderShape;
using state::Tables;

// These limits apply to the convex parts of meshes of dynamic bodies.
constexpr Real kConcavity = Real(0.001);  ///< Largest depth of a part below its hull, over the diagonal.
constexpr int kMostParts = 64;

struct Part {
  PartDesc desc;
  ColliderShape shape;
  MassProperties solid;  // Mass properties at density 1, in the body's frame.
};

void check_surface(const ContactDesc& contact, const std::string& prefix, Checks& checks) {
  const auto number = [](Real value) { return static_cast<double>(value); };
  checks.in_range(prefix + "friction", number(contact.friction), 0, 100)
      .in_range(prefix + "restitution", number(contact.restitution), 0, 1)
      .up_to(prefix + "rolling_friction", number(contact.rolling_friction), limits::kSize)
      .up_to(prefix + "spinning_friction", number(contact.spinning_friction), limits::kSize)
      .velocity(prefix + "surface_velocity", contact.surface_velocity);
  if (!contact.static_friction) return;
  checks.in_range(prefix + "static_friction", number(*contact.static_friction), number(contact.friction),
                  100);
}

void check_shape(const Shape& shape, const std::string& prefix, Checks& checks) {
  checks.require(shape.kind <= ShapeKind::kCompound, prefix + "kind", "must be one of ShapeKind");
  const auto size = [&](const char* field, Real value) {
    checks.size(prefix + field, static_cast<double>(value));
  };
  switch (shape.kind) {
    case ShapeKind::kHalfSpace:
    case ShapeKind::kMesh:
    case ShapeKind::kHull:
      break;
    case ShapeKind::kCompound:
      checks.require(false, prefix + "kind", "a part must not be a compound itself");
      break;
    case ShapeKind::kSphere:
      size("radius", shape.radius);
      break;
    case ShapeKind::kBox:
      size("half_extents.x", shape.half_extents.x);
      size("half_extents.y", shape.half_extents.y);
      size("half_extents.z", shape.half_extents.z);
      break;
    case ShapeKind::kCapsule:
    case ShapeKind::kCylinder:
    case ShapeKind::kCone:
      size("radius", shape.radius);
      size("half_height", shape.half_height);
      break;
  }
}

/// Returns the parts of a body. A body of one shape has one part, at its origin.
std::vector<PartDesc> parts_of(const BodyDesc& desc) {
  if (desc.shape.kind == ShapeKind::kCompound) return desc.parts;
  return {{.shape = desc.shape, .density = desc.density, .contact = desc.contact}};
}

std::string prefix_of(const BodyDesc& desc, std::size_t part) {
  return desc.shape.kind != ShapeKind::kCompound ? std::string() : indexed("parts", part) + ".";
}

MassProperties solid_of(const ColliderShape& shape, const PartDesc& part) {
  MassProperties solid =
      shape.shape.kind == ShapeKind::kHull ? geometry::mass_of(*shape.hull) : geometry::mass_of(shape.shape);
  return geometry::moved(solid, part.rotation, vector_cast<double>(part.position));
}

/// Makes the convex parts of a mesh if the tables do not have them yet.
Result<void> make_convex_parts(MeshId mesh, const std::string& where, Tables& t) {
  const std::uint32_t row = t.mesh_slots.find(mesh);
  if (!t.convex_parts[row].empty()) return {};
  std::vector<std::shared_ptr<const geometry::ConvexHull>> parts;
  const MeshDesc& solid = t.meshes[row]->desc;
  geometry::Box bounds;
  for (const Vec3 p : solid.positions) bounds = merge(bounds, p);
  const Real concavity = kConcavity * length(bounds.upper - bounds.lower);
  Result<std::vector<MeshDesc>> pieces = decompose_convex(solid, concavity, kMostParts);
  if (!pieces) {
    const std::string reason = pieces.error().where + ": " + pieces.error().message;
    return Error{pieces.error().code, where + "shape.mesh", "is no solid that could move: " + reason};
  }
  for (const MeshDesc& piece : pieces.value()) {
    Result<geometry::ConvexHull> hull = geometry::make_convex_hull(piece.positions);
    if (!hull) return Error{hull.error().code, where + "shape.mesh", hull.error().message};
    parts.push_back(std::make_shared<const geometry::ConvexHull>(std::move(hull).value()));
  }
  t.convex_parts[row] = std::move(parts);
  return {};
}

/// A mesh of a dynamic body collides by its convex parts and has the mass of the whole. If its surface
/// crosses itself, so that it bounds no matter, the body has the mass of the parts instead.
Result<void> add_convex_parts(Part whole, const std::string& where, Tables& t, std::vector<Part>& parts) {
  const MeshId id = whole.desc.shape.mesh;
  if (const Result<void> made = make_convex_parts(id, where, t); !made) return made.error();
  const MeshDesc& mesh = whole.shape.mesh->desc;
  const MassProperties solid = geometry::mass_of(mesh.positions, mesh.triangles);
  const bool bounds_matter = geometry::is_physical(solid);
  if (bounds_matter)
    whole.solid = geometry::moved(solid, whole.desc.rotation, vector_cast<double>(whole.desc.position));
  whole.desc.shape = Shape::hull_of(id);
  for (const auto& hull : t.convex_parts[t.mesh_slots.find(id)]) {
    Part part = whole;
    part.shape = {.shape = whole.desc.shape, .mesh = nullptr, .hull = hull, .whole = whole.shape.mesh};
    if (!bounds_matter) part.solid = solid_of(part.shape, part.desc);
    parts.push_back(std::move(part));
    whole.solid = {};
  }
  return {};
}

Result<std::vector<Part>> make_parts(const BodyDesc& desc, Tables& t) {
  std::vector<Part> parts;
  const std::vector<PartDesc> descs = parts_of(desc);
  for (std::size_t i = 0; i < descs.size(); ++i) {
    Part part = {.desc = descs[i], .shape = {}, .solid = {}};
    part.desc.rotation = normalize(part.desc.rotation);
    const std::string where = "body." + prefix_of(desc, i);
    Result<ColliderShape> shape = make_shape(part.desc.shape, where, t);
    if (!shape) return shape.error();
    part.shape = std::move(shape.value());
    const ShapeKind kind = part.desc.shape.kind;
    if (kind == ShapeKind::kHull) t.hulls[t.mesh_slots.find(part.desc.shape.mesh)] = part.shape.hull;
    const bool moves = desc.kind == BodyKind::kDynamic;
    if (moves && kind == ShapeKind::kHalfSpace)
      return Error{ErrorCode::kOutOfRange, where + "shape", "a half-space does not move: it has no mass"};
    if (moves && kind == ShapeKind::kMesh) {
      if (const auto added = add_convex_parts(std::move(part), where, t, parts); !added) return added.error();
      continue;
    }
    if (kind != ShapeKind::kMesh && kind != ShapeKind::kHalfSpace)
      part.solid = solid_of(part.shape, part.desc);
    parts.push_back(std::move(part));
  }
  return parts;
}

/// Mass, center and principal inertia of all parts. For a body that is not dynamic all are zero, and its
/// center is the origin of its frame.
state::BodyMass mass_of_parts(const BodyDesc& desc, const std::vector<Part>& parts) {
  if (desc.kind != BodyKind::kDynamic) return {};
  MassProperties whole;
  for (const Part& part : parts) {
    whole = geometry::joined(whole, 1.0, part.solid, static_cast<double>(part.desc.density));
  }
  const double mass = desc.mass ? static_cast<double>(*desc.mass) : whole.volume;
  const geometry::PrincipalAxes axes = geometry::principal_axes(whole.inertia);
  const double scale = mass / whole.volume;
  const auto quaternion = axes.rotation;
  return {.center = vector_cast<Real>(whole.center),
          .principal = {static_cast<Real>(quaternion.x), static_cast<Real>(quaternion.y),
                        static_cast<Real>(quaternion.z), static_cast<Real>(quaternion.w)},
          .inertia = vector_cast<Real>(scale * axes.moments),
          .mass = static_cast<Real>(mass),
          .inverse_mass = static_cast<Real>(1.0 / mass)};
}

/// An upper bound of the distance from the body's center of mass to a point of the part, and the radius of a
/// ball inside the part [m].
struct Extent {
  Real outer = Real(0), inner = Real(0);
};

Extent extent_of(const Part& part, Vec3 center) {
  const Shape& s = part.shape.shape;
  const Real distance = length(part.desc.position - center);
  switch (s.kind) {
    case ShapeKind::kSphere:
      return {distance + s.radius, s.radius};
    case ShapeKind::kCapsule:
      return {distance + s.half_height + s.radius, s.radius};
    case ShapeKind::kBox:
      return {distance + length(s.half_extents),
              std::min({s.half_extents.x, s.half_extents.y, s.half_extents.z})};
    case ShapeKind::kCylinder:
      return {distance + length(Vec3{s.radius, s.half_height, Real(0)}), std::min(s.radius, s.half_height)};
    case ShapeKind::kCone: {
      // This is the ball that touches the base and the side: r h / (r + sqrt(r^2 + h^2)).
      const Real height = Real(2) * s.half_height;
      const Real slant = std::sqrt(s.radius * s.radius + height * height);
      return {distance + length(Vec3{s.radius, s.half_height, Real(0)}),
              s.radius * height / (s.radius + slant)};
    }
    case ShapeKind::kHull:
      return {length(part.desc.position + rotate(part.desc.rotation, part.shape.hull->center) - center) +
                  part.shape.hull->outer_radius,
              part.shape.hull->inner_radius};
    case ShapeKind::kHalfSpace:
    case ShapeKind::kMesh:
    case ShapeKind::kCompound:
      break;
  }
  return {};
}

template <class Table>
void grow(Table& table, std::size_t size) {
  Table::for_each_column(table, [&](auto& column) { column.resize(size); });
}

template <class Table>
void make_room(Table& table, std::size_t more) {
  Table::for_each_column(table, [&](auto& column) { base::make_room(column, more); });
}

/// Makes room for a body and its colliders, so that adding them cannot fail for lack of memory.
void make_room_for_body(Tables& t, std::size_t colliders) {
  make_room(t.bodies, 1);
  make_room(t.colliders, colliders);
  base::make_room(t.moving_bodies);
  base::make_room(t.yielding);
}

std::uint32_t take_body_row(Tables& t) {
  if (t.free_bodies.empty()) {
    grow(t.bodies, t.bodies.motion.size() + 1);
    return static_cast<std::uint32_t>(t.bodies.motion.size()) - 1;
  }
  const std::uint32_t row = t.free_bodies.back();
  HOOKE_ASSERT(row < t.bodies.traits.size() && !t.bodies.traits[row].alive);
  t.free_bodies.pop_back();
  return row;
}

std::uint32_t take_collider_rows(Tables& t, std::uint32_t count) {
  const auto fits = [&](const state::Rows& rows) { return rows.count == count; };
  const auto hole = std::find_if(t.free_colliders.begin(), t.free_colliders.end(), fits);
  if (hole != t.free_colliders.end()) {
    const std::uint32_t first = hole->first;
    HOOKE_ASSERT(hole->end() <= t.colliders.body.size());
    t.free_colliders.erase(hole);
    return first;
  }
  const auto first = static_cast<std::uint32_t>(t.colliders.body.size());
  grow(t.colliders, first + count);
  return first;
}

void add_colliders(const std::vector<Part>& parts, Vec3 center, std::uint32_t body, Tables& t) {
  const auto count = static_cast<std::uint32_t>(parts.size());
  const std::uint32_t first = take_collider_rows(t, count);
  t.bodies.first_collider[body] = first;
  t.bodies.collider_count[body] = count;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Part& part = parts[i];
    const std::uint32_t row = first + i;
    t.colliders.body[row] = body;
    t.colliders.shape[row] = part.shape;
    t.colliders.position[row] = part.desc.position - center;
    t.colliders.rotation[row] = part.desc.rotation;
    t.colliders.surface[row] = part.desc.contact;
    t.colliders.bounds[row] = {};
  }
}

state::BodyTraits traits_of(const BodyDesc& desc, const std::vector<Part>& parts, Vec3 center) {
  state::BodyTraits traits = {.kind = desc.kind,
                              .alive = true,
                              .collides = desc.collides,
                              .sensor = desc.sensor,
                              .bullet = desc.bullet,
                              .can_sleep = desc.can_sleep && desc.dipole_moment == Vec3{},
                              .reports_contacts = desc.reports_contacts,
                              .hit_speed = desc.hit_speed,
                              .linear_damping = desc.linear_damping,
                              .angular_damping = desc.angular_damping,
                              .gravity_scale = desc.gravity_scale,
                              .drag_coefficient = desc.drag_coefficient,
                              .dipole_moment = desc.dipole_moment,
                              .filter = desc.filter};
  for (const Part& part : parts) {
    traits.magnus_volume += desc.magnus_coefficient * static_cast<Real>(part.solid.volume);
    const Extent extent = extent_of(part, center);
    traits.radius = std::max(traits.radius, extent.outer);
    traits.inner_radius = std::max(traits.inner_radius, extent.inner);
  }
  return traits;
}

/// Makes what a body becomes when it yields; its row is not set. A form that could be no solid is refused.
Result<state::Yielding> prepare_yielding(const BodyDesc& desc, const state::BodyMass& mass, const Tables& t) {
  const auto form = make_soft_form(desc, mass, t);
  if (!form) return form.error();
  const Result<void> good = validate_soft_form(*form.value(), *desc.yields);
  if (!good) return good.error();
  return state::Yielding{.desc = *desc.yields, .form = form.value()};
}

}  // namespace

Result<ColliderShape> make_shape(const Shape& shape, const std::string& where, const Tables& t) {
  ColliderShape result = {.shape = shape, .mesh = nullptr, .hull = nullptr};
  if (shape.kind == ShapeKind::kBox) {
    result.hull = std::make_shared<geometry::ConvexHull>(geometry::make_box_hull(shape.half_extents));
  }
  if (shape.kind != ShapeKind::kMesh && shape.kind != ShapeKind::kHull) return result;
  const std::uint32_t row = t.mesh_slots.find(shape.mesh);
  if (row == t.mesh_slots.kNone || !t.meshes[row]) {
    return Error{ErrorCode::kStaleId, where + "shape.mesh", "refers to nothing that is in the world"};
  }
  result.mesh = t.meshes[row];
  if (shape.kind == ShapeKind::kMesh) return result;
  result.hull = t.hulls[row];
  if (result.hull) return result;
  Result<geometry::ConvexHull> hull = geometry::make_convex_hull(result.mesh->desc.positions);
  if (!hull) return Error{hull.error().code, where + "shape.mesh", hull.error().message};
  result.hull = std::make_shared<geometry::ConvexHull>(std::move(hull.value()));
  return result;
}

Result<void> validate(const Shape& shape) {
  Checks checks("shape");
  check_shape(shape, "", checks);
  return checks.result();
}

Result<void> validate(const BodyDesc& body) {
  Checks checks("body");
  checks.require(body.kind <= BodyKind::kDynamic, "kind", "must be one of BodyKind")
      .place("position", body.position)
      .require(is_rotation(body.rotation), "rotation", "must be finite and not zero")
      .velocity("velocity", body.velocity)
      .within("angular_velocity", body.angular_velocity, limits::kSpin)
      .in_range("linear_damping", static_cast<double>(body.linear_damping), 0, 1e6)
      .in_range("angular_damping", static_cast<double>(body.angular_damping), 0, 1e6)
      .in_range("gravity_scale", static_cast<double>(body.gravity_scale), -1e6, 1e6)
      .in_range("drag_coefficient", static_cast<double>(body.drag_coefficient), 0, 1e6)
      .in_range("magnus_coefficient", static_cast<double>(body.magnus_coefficient), -1e6, 1e6)
      .require(length(vector_cast<double>(body.dipole_moment)) <= 1e9, "dipole_moment",
               "must be at most 1e9 long")
      .require(body.hit_speed >= Real(0), "hit_speed", static_cast<double>(body.hit_speed),
               "must be zero, positive or infinite");
  if (body.mass) checks.mass("mass", static_cast<double>(*body.mass));
  const std::vector<PartDesc> parts = parts_of(body);
  checks.require(!parts.empty(), "parts", "needs at least one part");
  check_connection_points(checks, body.connection_points, 0);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string prefix = prefix_of(body, i);
    checks.within(prefix + "position", parts[i].position, limits::kSize)
        .require(is_rotation(parts[i].rotation), prefix + "rotation", "must be finite and not zero")
        .in_range(prefix + "density", static_cast<double>(parts[i].density), 1e-6, 1e9);
    check_shape(parts[i].shape, prefix + "shape.", checks);
    check_surface(parts[i].contact, prefix + "contact.", checks);
  }
  if (!checks.good()) return checks.result();
  if (body.yields) {
    if (const Result<void> good = validate_yields(body); !good) return good;
  }
  Result<void> motion = validate(body.motion, "body.motion");
  return motion;
}

Result<std::uint32_t> add_body(const BodyDesc& desc, Tables& t) {
  const Result<void> good = validate(desc);
  if (!good) return good.error();
  Result<std::vector<Part>> made = make_parts(desc, t);
  if (!made) return made.error();
  const std::vector<Part>& parts = made.value();
  const state::BodyMass mass = mass_of_parts(desc, parts);
  state::Yielding yielding;
  if (desc.yields) {
    Result<state::Yielding> prepared = prepare_yielding(desc, mass, t);
    if (!prepared) return prepared.error();
    yielding = std::move(prepared).value();
  }
  MotionDesc path = desc.motion;
  auto connection_points = connection_points_of(desc.connection_points, mass.center);
  make_room_for_body(t, parts.size());

  const std::uint32_t row = take_body_row(t);
  const Quat rotation = normalize(desc.rotation);
  state::Bodies& b = t.bodies;
  b.mass[row] = mass;
  b.rotation[row] = rotation;
  b.center[row] = desc.position + vector_cast<double>(rotate(rotation, mass.center));
  b.motion[row] = {.inverse_mass = mass.inverse_mass};
  const bool moves = desc.kind != BodyKind::kStatic;
  b.motion[row].v = moves ? desc.velocity : Vec3{};
  b.angular_momentum[row] = state::angular_momentum_of(mass, rotation, desc.angular_velocity);
  b.angular_velocity[row] = moves ? desc.angular_velocity : Vec3{};
  b.traits[row] = traits_of(desc, parts, mass.center);
  b.direct_state[row] = desc.kind == BodyKind::kDynamic ? state::Bodies::kNew : std::int8_t{0};
  b.path[row] = std::move(path);
  b.path_start[row] = b.center[row];
  b.path_time[row] = t.time;
  b.connection_points[row] = std::move(connection_points);
  add_colliders(parts, mass.center, row, t);
  if (yielding.form) {
    yielding.body = row;
    t.yielding.push_back(std::move(yielding));
  }
  t.any_reports = t.any_reports || desc.sensor || desc.reports_contacts || std::isfinite(desc.hit_speed);
  if (moves)
    t.moving_bodies.insert(std::lower_bound(t.moving_bodies.begin(), t.moving_bodies.end(), row), row);
  return row;
}

void reshape_body(std::uint32_t row, std::span<const std::shared_ptr<const geometry::ConvexHull>> hulls,
                  Tables& t) {
  state::Bodies& b = t.bodies;
  const state::Rows old = {b.first_collider[row], b.collider_count[row]};
  const ContactDesc surface = t.colliders.surface[old.first];
  for (std::uint32_t i = old.first; i < old.end(); ++i) {
    t.colliders.body[i] = state::Colliders::kNoBody;
    t.colliders.shape[i] = {};
  }
  t.free_colliders.push_back(old);
  std::vector<Part> parts;
  b.traits[row].radius = b.traits[row].inner_radius = Real(0);
  for (const auto& hull : hulls) {
    Part& part = parts.emplace_back();
    part.desc = {.shape = Shape::hull_of({}), .contact = surface};
    part.shape = {.shape = part.desc.shape, .mesh = nullptr, .hull = hull};
    const Extent extent = extent_of(part, {});
    b.traits[row].radius = std::max(b.traits[row].radius, extent.outer);
    b.traits[row].inner_radius = std::max(b.traits[row].inner_radius, extent.inner);
  }
  add_colliders(parts, {}, row, t);
}

void remove_bodies(const std::vector<std::uint8_t>& goes, Tables& t) {
  HOOKE_ASSERT(goes.size() == t.bodies.traits.size());
  std::erase_if(t.yielding, [&](const state::Yielding& yielding) { return goes[yielding.body] != 0; });
  state::remove_pairs(goes, t.colliders, t.pairs);
  std::erase_if(t.moving_bodies, [&](std::uint32_t row) { return goes[row] != 0; });
  for (std::uint32_t row = 0; row < goes.size(); ++row) {
    if (goes[row] == 0) continue;
    const state::Rows rows = {t.bodies.first_collider[row], t.bodies.collider_count[row]};
    for (std::uint32_t i = rows.first; i < rows.end(); ++i) {
      HOOKE_ASSERT(t.colliders.body[i] == row);
      t.colliders.body[i] = state::Colliders::kNoBody;
      t.colliders.shape[i] = {};
    }
    t.free_colliders.push_back(rows);
    t.free_bodies.push_back(row);
    state::Bodies::for_each_column(t.bodies, [&](auto& column) { column[row] = {}; });
    if (row < t.pairs.seen.size()) t.pairs.seen[row] = {};  // It is hashed, also of rows that are free.
  }
}

}  // namespace hooke::build
