#include "hooke/fracture.h"

#include "base/assert.h"
#include "base/float_environment.h"
#include "geometry/closest.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>

namespace hooke {

namespace {

using DQuat = Quaternion<double>;

DQuat rotation_of(const BodyDesc& whole) {
  const Quat q = normalize(whole.rotation);
  return normalize(DQuat{q.x, q.y, q.z, q.w});
}

double volume_of(const Fracture& fracture) {
  double sum = 0;
  for (const FractureCell& cell : fracture.cells) sum += cell.volume;
  return sum;
}

/// Center of mass of the whole, in its frame.
DVec3 center_of(const Fracture& fracture) {
  DVec3 sum = {};
  for (const FractureCell& cell : fracture.cells) sum += cell.volume * cell.center;
  return 1 / volume_of(fracture) * sum;
}

double distance_to_surface(const FractureCell& cell, DVec3 place) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& t : cell.mesh.triangles) {
    const auto corner = [&](std::size_t k) { return vector_cast<double>(cell.mesh.positions[t[k]]); };
    const DVec3 nearest =
        geometry::closest_on_triangle(place - cell.center, corner(0), corner(1), corner(2)).point;
    least = std::min(least, length(place - cell.center - nearest));
  }
  return least;
}

/// Mass of one cell [kg]. What rounding takes from the cells before it is given to it, so that all masses sum
/// to that of the whole.
Real mass_of(const Fracture& fracture, std::size_t index, const BodyDesc& whole) {
  const double density = whole.mass ? static_cast<double>(*whole.mass) / volume_of(fracture)
                                    : static_cast<double>(whole.density);
  double lost = 0;
  Real mass = Real(0);
  for (std::size_t i = 0; i <= index; ++i) {
    const double wanted = density * fracture.cells[i].volume + lost;
    mass = static_cast<Real>(wanted);
    lost = wanted - static_cast<double>(mass);
  }
  return mass;
}

}  // namespace

std::size_t cell_at(const Fracture& fracture, DVec3 place) {
  const base::FloatEnvironment environment;
  const auto from_seed = [&](const FractureCell& cell) { return length_squared(place - cell.seed_place); };
  double nearest = std::numeric_limits<double>::infinity();
  for (const FractureCell& cell : fracture.cells) nearest = std::min(nearest, from_seed(cell));
  // Of a seed whose cell is in several pieces, the piece that is nearest counts.
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < fracture.cells.size(); ++i) {
    if (from_seed(fracture.cells[i]) > nearest) continue;
    const double distance = distance_to_surface(fracture.cells[i], place);
    if (!(distance < least)) continue;
    least = distance;
    best = i;
  }
  return best;
}

BodyDesc describe_cell(const Fracture& fracture, std::size_t index, const BodyDesc& whole) {
  if (index >= fracture.cells.size()) return {};
  const base::FloatEnvironment environment;
  const FractureCell& cell = fracture.cells[index];
  const DQuat turn = rotation_of(whole);
  BodyDesc desc = whole;
  desc.shape = cell.is_convex ? Shape::hull_of({}) : Shape::of_mesh({});
  desc.parts.clear();
  desc.position = whole.position + rotate(turn, cell.center);
  const DVec3 arm = rotate(turn, cell.center - center_of(fracture));
  desc.velocity = vector_cast<Real>(vector_cast<double>(whole.velocity) +
                                    cross(vector_cast<double>(whole.angular_velocity), arm));
  desc.mass = mass_of(fracture, index, whole);
  desc.connection_points.clear();
  for (ConnectionPointDesc point : whole.connection_points) {
    if (cell_at(fracture, point.position) != index) continue;
    point.position -= cell.center;
    desc.connection_points.push_back(std::move(point));
  }
  return desc;
}

HookDesc describe_bond(const Fracture& fracture, std::size_t index, const BodyDesc& whole, Real strength) {
  if (index >= fracture.bonds.size()) return {};
  const base::FloatEnvironment environment;
  const FractureBond& bond = fracture.bonds[index];
  const DQuat turn = rotation_of(whole);
  HookDesc desc = {.kind = HookKind::kFixed};
  desc.anchor = whole.position + rotate(turn, bond.center);
  desc.axis = vector_cast<Real>(rotate(turn, bond.normal));
  if (!std::isfinite(strength)) return desc;
  desc.break_force = static_cast<Real>(static_cast<double>(strength) * bond.area);
  desc.break_torque = static_cast<Real>(static_cast<double>(strength) * bond.section_modulus);
  return desc;
}

namespace {

/// Takes back what was added if not all could be.
class FracturedUndo {
 public:
  FracturedUndo(World& world, FracturedBody& made) : world_(world), made_(made) {}
  FracturedUndo(const FracturedUndo&) = delete;
  FracturedUndo& operator=(const FracturedUndo&) = delete;
  ~FracturedUndo() {
    if (kept_) return;
    world_.remove(std::span<const BodyId>(made_.bodies));  // Their hooks go with them.
    for (const MeshId mesh : made_.meshes) world_.remove(mesh);
  }
  void keep() { kept_ = true; }

 private:
  World& world_;
  FracturedBody& made_;
  bool kept_ = false;
};

Error error_of(const char* what, std::size_t index, const Error& error) {
  return {error.code, "fracture." + std::string(what) + "[" + std::to_string(index) + "]",
          error.where + ": " + error.message};
}

}  // namespace

Result<FracturedBody> add_fractured(World& world, const Fracture& fracture, const BodyDesc& whole,
                                    Real strength) {
  if (whole.kind != BodyKind::kDynamic) {
    return Error{ErrorCode::kOutOfRange, "body.kind",
                 "must be dynamic: what does not move does not break; hooks to the world hold it"};
  }
  if (!(strength > Real(0))) {
    return Error{ErrorCode::kOutOfRange, "strength",
                 std::to_string(strength) + " is out of range, must be positive"};
  }
  FracturedBody made;
  FracturedUndo undo(world, made);
  for (std::size_t i = 0; i < fracture.cells.size(); ++i) {
    const Result<MeshId> mesh = world.add_mesh(fracture.cells[i].mesh);
    if (!mesh) return error_of("cells", i, mesh.error());
    made.meshes.push_back(mesh.value());
    BodyDesc desc = describe_cell(fracture, i, whole);
    desc.shape.mesh = mesh.value();
    const Result<BodyId> body = world.add_body(desc);
    if (!body) {
      Error error = error_of("cells", i, body.error());
      error.message += "; a larger `least_share` merges cells that are small or thin";
      return error;
    }
    made.bodies.push_back(body.value());
  }
  for (std::size_t i = 0; i < fracture.bonds.size(); ++i) {
    if (std::max(fracture.bonds[i].a, fracture.bonds[i].b) >= made.bodies.size())
      return error_of("bonds", i, {ErrorCode::kOutOfRange, "a, b", "name a cell that is not there"});
    HookDesc desc = describe_bond(fracture, i, whole, strength);
    desc.a.body = made.bodies[fracture.bonds[i].a];
    desc.b.body = made.bodies[fracture.bonds[i].b];
    const Result<HookId> hook = world.add_hook(desc);
    if (!hook) return error_of("bonds", i, hook.error());
    made.hooks.push_back(hook.value());
  }
  undo.keep();
  return made;
}

}  // namespace hooke
