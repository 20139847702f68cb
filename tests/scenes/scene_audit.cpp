#include "scenes/scene_audit.h"

#include "collision/deformable/particle_contacts.h"
#include "world/access.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <unordered_map>
#include <vector>

namespace hooke::test {

namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

struct FigureTraits {
  const char* name = nullptr;
  double limit = 0;
};

constexpr std::array<FigureTraits, kFigures> kTraits = {{
    {"energy", 0.01},
    {"gap", 0.05},
    {"rest gap", 0.02},
    {"overlap", 0.3},
    {"rest overlap", 0.05},
    {"point overlap", 0.03},
    {"rope stretch", 0.01},
    {"cloth stretch", 3},
    {"volume", 0.5},
    {"speed", 30},
    {"outside", 0},
    {"unhealthy", 0},
}};

double in_double(Real x) {
  return static_cast<double>(x);
}

/// Lengths of a mesh of the scene along the axes [m].
DVec3 lengths_of(const Scene& scene, const std::string& name) {
  Vec3 low = {kRigid, kRigid, kRigid};
  Vec3 high = -low;
  for (const SceneMesh& mesh : scene.meshes) {
    if (mesh.name != name) continue;
    for (const Vec3& x : mesh.mesh.positions) {
      low = {std::min(low.x, x.x), std::min(low.y, x.y), std::min(low.z, x.z)};
      high = {std::max(high.x, x.x), std::max(high.y, x.y), std::max(high.z, x.z)};
    }
  }
  return vector_cast<double>(high - low);
}

/// Lengths of a body along its axes [m].
DVec3 lengths_of(const SceneBody& body, const Scene& scene) {
  const Shape& shape = body.desc.shape;
  const double r = 2 * in_double(shape.radius);
  const double h = 2 * in_double(shape.half_height);
  switch (shape.kind) {
    case ShapeKind::kSphere:
      return {r, r, r};
    case ShapeKind::kCapsule:
      return {r, r + h, r};
    case ShapeKind::kCylinder:
      return {r, h, r};
    case ShapeKind::kBox:
      return 2.0 * vector_cast<double>(shape.half_extents);
    case ShapeKind::kHull:
      return lengths_of(scene, body.mesh);
    default:
      return {kNone, kNone, kNone};
  }
}

struct BodySize {
  double least = kNone;  ///< Least width [m].
  double mean = kNone;   ///< Geometric mean of the three [m].
};

/// The space inside the walls that a scene has.
struct Inside {
  double x = kNone, z = kNone;
  double low = -kNone;

  [[nodiscard]] bool has(DVec3 p, double margin) const {
    return std::abs(p.x) <= x + margin && std::abs(p.z) <= z + margin && p.y >= low - margin;
  }
};

Inside inside_of(const Scene& scene) {
  Inside inside;
  for (const SceneBody& body : scene.objects.bodies) {
    if (body.tag.name == "wall_right")
      inside.x = body.desc.position.x - in_double(body.desc.shape.half_extents.x);
    if (body.tag.name == "wall_front")
      inside.z = body.desc.position.z - in_double(body.desc.shape.half_extents.z);
    if (body.tag.name == "floor") inside.low = 0;
  }
  return inside;
}

/// The least of the last ten values: what lasts, and is no shock.
class Lasting {
 public:
  double add(double value) {
    values_[count_++ % values_.size()] = value;
    return count_ < values_.size() ? 0 : *std::min_element(values_.begin(), values_.end());
  }

 private:
  std::array<double, 10> values_ = {};
  std::size_t count_ = 0;
};

Simulation create(const Scene& scene, const Placement& placement) {
  Loaded<Simulation> loaded = Simulation::create(scene, placement);
  if (!loaded) throw std::runtime_error("the scene is refused: " + to_line(loaded.errors.front()));
  return std::move(*loaded.value);
}

/// A hook of the scene with what its spring and motor need.
struct AuditedHook {
  const SceneHook* desc = nullptr;
  HookId id = {};
  BodyId a = {}, b = {};
  double size = 0;   ///< Of the smaller body held [m].
  double start = 0;  ///< Value when it was hooked.
  Lasting gap = {};
  DVec3 relative = {};  ///< Velocity, or angular velocity, of b relative to a after the last step.

  [[nodiscard]] bool is_driven() const { return desc->desc.motor.max_force > Real(0); }
};

class Auditor {
 public:
  Auditor(const Scene& scene, const Placement& placement)
      : simulation_(create(scene, placement)), placement_(placement) {
    if (placement == Placement{}) inside_ = inside_of(scene);
    for (const SceneBody& body : scene.objects.bodies) {
      sizes_.push_back(size_of(body));
      bodies_.push_back(simulation_.find(body.tag.name)->body);
      row_of_[bodies_.back().slot] = bodies_.size() - 1;
    }
    for (const SceneSolid& solid : scene.objects.solids)
      volumes_.push_back(world().volume(simulation_.find(solid.tag.name)->solid));
    for (const SceneHook& hook : this->scene().objects.hooks) add_hook(hook);
    least_ = energy();
    // The zero of potential energy is the origin of the scene: what lies there has none.
    start_ = placement == Placement{} ? least_ : Auditor(scene, {}).start_;
  }

  Audit run(const std::function<void(const std::string&)>& say) {
    const std::uint32_t steps = scene().step_count();
    for (std::uint32_t i = 0; i < steps; ++i) {
      const auto begin = std::chrono::steady_clock::now();
      const StepReport report = simulation_.step();
      const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - begin;
      audit_.milliseconds = std::max(audit_.milliseconds, time.count());
      if (!report.healthy()) raise(Figure::kUnhealthy, audit_.of(Figure::kUnhealthy).value + 1, "");
      is_late_ = 4 * i >= 3 * steps;
      look_at_energy();
      look_at_hooks();
      look_at_contacts();
      look_at_bodies();
      look_at_points();
      raise(Figure::kOutside, outside_, "several");
      outside_ = 0;
      if (say) say(state());
    }
    for (std::size_t i = 0; i < bodies_.size(); ++i)
      audit_.ends[name_of(i)] = placement_.own_point(world().pose(bodies_[i]).position);
    return audit_;
  }

 private:
  [[nodiscard]] const World& world() const { return simulation_.world(); }
  [[nodiscard]] const Scene& scene() const { return simulation_.scene(); }

  void raise(Figure figure, double value, const std::string& where) {
    Worst& worst = audit_.worst[static_cast<std::size_t>(figure)];
    if (value > worst.value) worst = {value, world().time(), where};
  }

  [[nodiscard]] BodySize size_of(const SceneBody& body) const {
    if (body.desc.kind == BodyKind::kStatic) return {};
    const DVec3 lengths = lengths_of(body, scene());
    return {std::min({lengths.x, lengths.y, lengths.z}), std::cbrt(lengths.x * lengths.y * lengths.z)};
  }

  [[nodiscard]] BodyId body_named(const std::string& name) const {
    const SceneObject* object = simulation_.find(name);
    return object == nullptr ? BodyId{} : object->body;
  }

  void add_hook(const SceneHook& desc) {
    AuditedHook hook = {.desc = &desc, .id = simulation_.find(desc.name)->hook};
    hook.a = body_named(desc.a);
    hook.b = body_named(desc.b);
    hook.size = 0.3;
    for (const BodyId body : {hook.a, hook.b}) {
      if (body) hook.size = std::min(hook.size, sizes_[row_of_.at(body.slot)].mean);
    }
    hook.start = in_double(world().hook_value(hook.id));
    hook.relative = relative_velocity(hook);
    hooks_.push_back(hook);
  }

  [[nodiscard]] DVec3 relative_velocity(const AuditedHook& hook) const {
    const bool is_slider = hook.desc->desc.kind == HookKind::kSlider;
    const Vec3 a = is_slider ? world().velocity(hook.a) : world().angular_velocity(hook.a);
    const Vec3 b = is_slider ? world().velocity(hook.b) : world().angular_velocity(hook.b);
    return vector_cast<double>(b - a);
  }

  /// Kinetic, potential and elastic energy, with that of the springs of hooks [J].
  [[nodiscard]] double energy() const {
    double sum = world().measure().energy.total();
    for (const AuditedHook& hook : hooks_) {
      const HookSpring& spring = hook.desc->desc.spring;
      if (!(spring.stiffness > Real(0))) continue;
      const double way = in_double(world().hook_value(hook.id)) - hook.start - in_double(spring.target);
      sum += 0.5 * in_double(spring.stiffness) * way * way;
    }
    return sum;
  }

  /// Adds what motors did in the last step: their force by the mean velocity of the hook.
  void add_work() {
    for (AuditedHook& hook : hooks_) {
      if (!hook.is_driven()) continue;
      const DVec3 relative = relative_velocity(hook);
      const HookForce done = world().hook_force(hook.id);
      const bool is_slider = hook.desc->desc.kind == HookKind::kSlider;
      const DVec3 effort = vector_cast<double>(is_slider ? done.force : done.torque);
      const double work = 0.5 * in_double(scene().dt) * dot(effort, relative + hook.relative);
      hook.relative = relative;
      work_ += work;
      turnover_ += std::abs(work);
    }
  }

  void look_at_energy() {
    add_work();
    const double left = energy() - work_;
    least_ = std::min(least_, left);
    raise(Figure::kEnergy, (left - least_) / (start_ + turnover_), "");
  }

  void look_at_hooks() {
    for (AuditedHook& hook : hooks_) {
      const double gap = in_double(world().hook_gap(hook.id)) / hook.size;
      raise(Figure::kGap, gap, hook.desc->name);
      const double lasting = hook.gap.add(gap);
      if (is_late_) raise(Figure::kRestGap, lasting, hook.desc->name);
    }
  }

  void look_at_contacts() {
    double worst = 0;
    std::string where;
    for (const BodyContact& contact : world().body_contacts()) {
      const std::size_t a = row_of_.at(contact.a.slot);
      const std::size_t b = row_of_.at(contact.b.slot);
      const double overlap = -in_double(contact.separation);
      const double relative = overlap / std::min(sizes_[a].least, sizes_[b].least);
      if (relative <= worst) continue;
      worst = relative;
      where = name_of(a) + " and " + name_of(b);
    }
    raise(Figure::kOverlap, worst, where);
    const double lasting = overlap_.add(worst);
    if (is_late_) raise(Figure::kRestOverlap, lasting, where);
  }

  void look_at_bodies() {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (!(world().mass(bodies_[i]) > Real(0))) continue;
      raise(Figure::kSpeed, length(vector_cast<double>(world().velocity(bodies_[i]))), name_of(i));
      count_outside(world().center_of_mass(bodies_[i]), name_of(i));
    }
  }

  [[nodiscard]] const std::string& name_of(std::size_t body) const {
    return scene().objects.bodies[body].tag.name;
  }

  void count_outside(DVec3 place, const std::string& name) {
    if (inside_.has(place, 0.02)) return;
    ++outside_;
    raise(Figure::kOutside, 1, name);
  }

  void look_at_points() {
    raise(Figure::kPointOverlap, collision::largest_penetration(WorldAccess::tables(world())), "");
    for (const SceneRope& rope : scene().objects.ropes) look_at_rope(points_of(rope.tag.name), rope);
    for (const SceneCloth& cloth : scene().objects.cloths) look_at_cloth(points_of(cloth.tag.name), cloth);
    for (std::size_t i = 0; i < volumes_.size(); ++i) {
      const std::string& name = scene().objects.solids[i].tag.name;
      (void)points_of(name);
      const double volume = world().volume(simulation_.find(name)->solid);
      raise(Figure::kVolume, std::abs(volume / volumes_[i] - 1), name);
    }
  }

  PointView points_of(const std::string& name) {
    const PointView points = positions_of(world(), *simulation_.find(name));
    for (std::size_t i = 0; i < points.size(); ++i) count_outside(points[i], name);
    return points;
  }

  void look_at_rope(const PointView& points, const SceneRope& rope) {
    for (std::size_t i = 0; i + 1 < rope.desc.points.size(); ++i) {
      const double rest = length(rope.desc.points[i + 1] - rope.desc.points[i]);
      raise(Figure::kRopeStretch, std::abs(length(points[i + 1] - points[i]) / rest - 1), rope.tag.name);
    }
  }

  void look_at_cloth(const PointView& points, const SceneCloth& cloth) {
    const auto columns = static_cast<std::size_t>(cloth.desc.columns);
    const double across = in_double(cloth.desc.width) / (cloth.desc.columns - 1);
    const double along = in_double(cloth.desc.height) / (cloth.desc.rows - 1);
    const auto look = [&](std::size_t i, std::size_t next, double rest) {
      raise(Figure::kClothStretch, length(points[next] - points[i]) / rest - 1, cloth.tag.name);
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
      if ((i + 1) % columns != 0) look(i, i + 1, across);
      if (i + columns < points.size()) look(i, i + columns, along);
    }
  }

  [[nodiscard]] std::string state() const {
    std::string line = "t " + std::to_string(world().time()) + " energy " + std::to_string(energy()) +
                       " work " + std::to_string(work_);
    for (std::size_t i = 0; i < kFigures; ++i)
      line += std::string(" | ") + kTraits[i].name + " " + std::to_string(audit_.worst[i].value);
    return line;
  }

  Simulation simulation_;
  Placement placement_;
  Inside inside_;
  std::vector<BodyId> bodies_;  ///< In the order of the scene, as the next.
  std::vector<BodySize> sizes_;
  std::unordered_map<std::uint32_t, std::size_t> row_of_;  ///< From the slots of bodies.
  std::vector<AuditedHook> hooks_;
  std::vector<double> volumes_;
  Lasting overlap_;
  double start_ = 0, least_ = 0, work_ = 0, turnover_ = 0;  ///< Energies [J].
  int outside_ = 0;
  bool is_late_ = false;
  Audit audit_;
};

}  // namespace

const char* name_of(Figure figure) {
  return kTraits[static_cast<std::size_t>(figure)].name;
}

double limit_of(Figure figure) {
  return kTraits[static_cast<std::size_t>(figure)].limit;
}

Audit run_audit(const Scene& scene, const Placement& placement,
                const std::function<void(const std::string&)>& say) {
  return Auditor(scene, placement).run(say);
}

}  // namespace hooke::test
