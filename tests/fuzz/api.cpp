/// Random sequences of calls of a World: sense and nonsense, ids that are gone, snapshots and restorations in
/// between. A small model knows which ids live. After each call the tables must agree, and a call that was
/// refused must have changed nothing.

#include "hooke/limits.h"
#include "hooke/world.h"

#include "fuzz/exclusions.h"
#include "fuzz/mesh_maker.h"
#include "fuzz/population.h"
#include "fuzz/scene_checks.h"
#include "fuzz/target.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <set>
#include <utility>

namespace hooke::fuzz {

namespace {

constexpr Real kStep = Real(1) / Real(60);
constexpr std::size_t kMostObjects = 24;  // of a world: trials stay quick

/// Which ids of a kind live. Given are all there ever were, also those made before a restoration.
template <class IdType>
struct Ids {
  std::vector<IdType> alive = {};
  std::vector<IdType> ever = {};

  void add(IdType id) {
    expect(static_cast<bool>(id), "a null id was given");
    expect(std::find(ever.begin(), ever.end(), id) == ever.end(), "an id was given twice");
    alive.push_back(id);
    ever.push_back(id);
  }
  [[nodiscard]] bool lives(IdType id) const {
    return std::find(alive.begin(), alive.end(), id) != alive.end();
  }
  [[nodiscard]] IdType pick(Random& random) const {
    if (random.chance(0.03)) return make_up(random);
    if (random.chance(0.85) && !alive.empty()) return random.one_of(alive);
    return ever.empty() ? IdType{} : random.one_of(ever);
  }
  /// One of another World, which is refused, or of none in particular, which is the one of this World that it
  /// hits.
  [[nodiscard]] IdType make_up(Random& random) const {
    constexpr std::uint32_t kOther = 0xFFFFFFFE;
    IdType id = {random.index(5), random.index(3), kOther};
    if (random.chance(0.5)) return id;
    id.world = 0;
    for (const IdType mine : alive) {
      if (mine.slot == id.slot && mine.generation == id.generation) return mine;
    }
    return id;
  }
};

struct Model {
  Ids<MeshId> meshes = {};
  Ids<BodyId> bodies = {};
  Ids<HookId> hooks = {};  ///< Alive may be some that went with what they held.
  Ids<RopeId> ropes = {};
  Ids<ClothId> cloths = {};
  Ids<SolidId> solids = {};
  Ids<ParticlesId> particles = {};
  Ids<FieldId> fields = {};
  Ids<ForceLawId> laws = {};
  bool is_extreme = false;  ///< It took a value that float may overflow on.

  [[nodiscard]] std::size_t size() const {
    return bodies.alive.size() + ropes.alive.size() + cloths.alive.size() + solids.alive.size() +
           particles.alive.size();
  }
};

/// Ids that were ever given stay known when the world goes back.
template <class IdType>
void go_back(const Ids<IdType>& then, Ids<IdType>& now) {
  now.alive = then.alive;
}

class Trial {
 public:
  Trial(Random random, int workers)
      : random_(random), world_(must(World::create(make_world(random_, {})), "world")) {
    must_do(world_.set_workers(workers));
  }

  std::uint64_t run() {
    const int calls = random_.integer(5, 120);
    for (int i = 0; i < calls; ++i) {
      const std::uint64_t seed = random_.bits();
      if (!has_next_part()) continue;
      Random rest = std::exchange(random_, Random(seed));
      call();
      random_ = rest;
      check_tables(world_);
    }
    read_all();
    return world_.state_hash();
  }

 private:
  static void must_do(const Result<void>& result) { expect(result.has_value(), "refused"); }

  // Numbers, mostly with sense.
  bool is_nonsense() { return random_.chance(0.06); }
  double number(double reach) {
    if (!is_nonsense()) return random_.between(-reach, reach);
    const double bad = bad_number(random_);
    const double size = std::fabs(bad);
    model_.is_extreme |= std::isfinite(bad) && bad != 0 && (size > 1e5 || size < 1e-5);
    return bad;
  }
  Real real(double reach) { return static_cast<Real>(number(reach)); }
  Vec3 vector(double reach) { return {real(reach), real(reach), real(reach)}; }
  DVec3 place() { return {number(3), number(3), number(3)}; }

  /// With some probability one of the numbers becomes bad.
  void spoil(std::initializer_list<Real*> numbers) {
    if (!random_.chance(0.15)) return;
    Real& one = **(numbers.begin() + random_.below(numbers.size()));
    const double bad = bad_number(random_);
    one = static_cast<Real>(bad);
    const double size = std::fabs(bad);
    model_.is_extreme |= size > 1e4 || (size < 1e-4 && bad != 0);
    std::size_t number = 0;
    while (*(numbers.begin() + number) != &one) ++number;
    note("number " + std::to_string(number) + " of what follows is " + std::to_string(bad));
  }
  void spoil(int& count) {
    if (random_.chance(0.03)) count = random_.pick<int>({-1, 0, 1, 65537, 2147483647, -2147483647});
  }
  void spoil(std::vector<PinDesc>& pins) {
    if (random_.chance(0.05)) pins.push_back({random_.pick<std::uint32_t>({0, 1, 100, 0xFFFFFFFF})});
  }
  template <class Enum>
  void spoil_kind(Enum& kind) {
    if (!random_.chance(0.01)) return;
    kind = static_cast<Enum>(200);
  }

  /// Of what a call gave. A refusal says why and has changed nothing.
  template <class T>
  bool judge(const char* what, const Result<T>& result) {
    if (!result) {
      expect(!result.error().message.empty(), "refused without a word");
      expect(world_.state_hash() == hash_, std::string(what) + " was refused and changed something");
    }
    note(std::string(what) +
         (result ? "" : " refused: " + result.error().where + " " + result.error().message));
    return result.has_value();
  }
  template <class IdType>
  void take(const char* what, const Result<IdType>& result, Ids<IdType>& ids) {
    if (judge(what, result)) ids.add(*result);
  }

  Meshes meshes() { return {.any = model_.meshes.alive, .solid = model_.meshes.alive}; }
  PointRef pick_point() {
    if (random_.chance(0.03))
      return {PointRef::Kind::kRope, random_.index(4), random_.index(3), random_.index(9)};
    const std::uint32_t index = random_.chance(0.03) ? 0xFFFFFFFF : random_.index(12);
    switch (random_.below(4)) {
      case 0:
        return point(model_.ropes.pick(random_), index);
      case 1:
        return point(model_.cloths.pick(random_), index);
      case 2:
        return point(model_.solids.pick(random_), index);
      default:
        return point(model_.particles.pick(random_), index);
    }
  }
  HookEnd pick_end() {
    HookEnd end;
    if (random_.chance(0.6))
      end.body = model_.bodies.pick(random_);
    else if (random_.chance(0.7))
      end.point = pick_point();
    if (random_.chance(0.1)) end.point = pick_point();
    if (random_.chance(0.1)) end.point.index = PointRef::kNearest;
    if (random_.chance(0.1))
      end.connection_point = random_.pick<const char*>({"center", "end", "top", "", "no such"});
    return end;
  }
  MotionDesc pick_motion() {
    MotionDesc motion = make_motion(random_);
    spoil({&motion.velocity.x, &motion.amplitude.y, &motion.frequency_hz, &motion.phase});
    spoil_kind(motion.kind);
    if (is_nonsense()) motion.keyframes.clear();
    return motion;
  }

  void call() {
    using Call = void (Trial::*)();
    constexpr Call kCalls[] = {
        &Trial::step,      &Trial::step,       &Trial::step,       &Trial::step,          &Trial::add_body,
        &Trial::add_body,  &Trial::add_hook,   &Trial::add_hook,   &Trial::add_rope,      &Trial::add_cloth,
        &Trial::add_solid, &Trial::add_points, &Trial::add_mesh,   &Trial::add_field,     &Trial::add_law,
        &Trial::add_seam,  &Trial::remove_one, &Trial::remove_one, &Trial::remove_bodies, &Trial::push_point,
        &Trial::push_body, &Trial::push_body,  &Trial::hold,       &Trial::set_hook,      &Trial::set_world,
        &Trial::ask,       &Trial::read_one,   &Trial::save,       &Trial::restore,
    };
    hash_ = world_.state_hash();
    (this->*kCalls[random_.below(std::size(kCalls))])();
  }

  void step() {
    const Real dt =
        is_nonsense() ? real(0.1) : random_.pick<Real>({kStep, kStep, kStep, Real(0.001), Real(0.1)});
    const StepReport report = world_.step(dt);
    note("step");
    const bool is_step =
        dt >= static_cast<Real>(limits::kShortestStep) && dt <= static_cast<Real>(limits::kLongestStep);
    expect(report.moved == is_step, "moved, or did not");
    for (const HookId id : world_.broken_hooks()) std::erase(model_.hooks.alive, id);
    const bool may_be_ill =
        (kLeftOut.health_after_huge_values && (model_.is_extreme || dt > Real(1) || dt < Real(1e-5))) ||
        (kLeftOut.health_of_cloths && !model_.cloths.ever.empty());
    expect(!report.moved || may_be_ill || report.healthy(), "an unhealthy step");
    const Population all = population();
    if (!may_be_ill) (void)check_finite(world_, all);
  }

  Population population() {
    return {.bodies = model_.bodies.alive,
            .ropes = model_.ropes.alive,
            .cloths = model_.cloths.alive,
            .solids = model_.solids.alive,
            .particles = model_.particles.alive};
  }

  void add_body() {
    if (model_.size() > kMostObjects) return;
    BodyDesc body = make_body(random_, place(), meshes(), {});
    spoil({&body.shape.radius, &body.shape.half_extents.y, &body.shape.half_height, &body.density,
           &body.velocity.x, &body.angular_velocity.z, &body.linear_damping, &body.angular_damping,
           &body.gravity_scale, &body.contact.friction, &body.contact.restitution, &body.hit_speed,
           &body.drag_coefficient, &body.dipole_moment.x, &body.rotation.w, &body.contact.surface_velocity.x,
           &body.magnus_coefficient});
    spoil_kind(body.shape.kind);
    spoil_kind(body.kind);
    if (random_.chance(0.03)) body.shape.mesh = model_.meshes.pick(random_);
    if (random_.chance(0.05))
      body.connection_points = {{"a", place()}, {random_.chance(0.5) ? "a" : "b", place()}};
    take("add_body", world_.add_body(body), model_.bodies);
  }
  void add_hook() {
    HookDesc hook = make_hook(random_, place(), random_.chance(0.4), {});
    if (random_.chance(0.1)) hook.kind = HookKind::kRopeSlide;
    hook.a = pick_end();
    hook.b = pick_end();
    spoil({&hook.axis.x, &hook.limits.lower, &hook.limits.upper, &hook.motor.speed, &hook.motor.max_force,
           &hook.spring.stiffness, &hook.spring.damping, &hook.spring.target, &hook.break_force,
           &hook.break_torque, &hook.freedoms[0].limits.lower, &hook.freedoms[4].spring.stiffness});
    spoil_kind(hook.kind);
    if (random_.chance(0.1)) hook.second_axis = vector(1);
    take("add_hook", world_.add_hook(hook), model_.hooks);
  }
  void add_rope() {
    if (model_.size() > kMostObjects) return;
    RopeDesc rope = make_rope(random_, place(), {});
    spoil({&rope.total_mass, &rope.length_at_rest, &rope.stiffness, &rope.inner_friction, &rope.air_friction,
           &rope.extension_max, &rope.bend_stiffness, &rope.bend_damping, &rope.twist_stiffness, &rope.twist,
           &rope.radius, &rope.charge, &rope.velocity.y, &rope.direction.x, &rope.repulsion_strength,
           &rope.contact.friction});
    spoil(rope.masses);
    spoil(rope.pins);
    if (random_.chance(0.1)) rope.points = {place(), place(), place()};
    take("add_rope", world_.add_rope(rope), model_.ropes);
  }
  void add_cloth() {
    if (model_.size() > kMostObjects) return;
    ClothDesc cloth = make_cloth(random_, place(), meshes(), {});
    spoil({&cloth.width, &cloth.height, &cloth.areal_density, &cloth.thickness, &cloth.stretch_stiffness,
           &cloth.shear_stiffness, &cloth.bend_stiffness, &cloth.damping, &cloth.bend_damping,
           &cloth.extension_max, &cloth.drag_coefficient, &cloth.lift_coefficient, &cloth.air_friction,
           &cloth.column_direction.x});
    spoil(cloth.columns);
    spoil(cloth.rows);
    spoil(cloth.pins);
    spoil_kind(cloth.bend);
    take("add_cloth", world_.add_cloth(cloth), model_.cloths);
  }
  void add_solid() {
    if (model_.size() > kMostObjects) return;
    SolidDesc solid = fuzz::make_solid(random_, place(), meshes());
    spoil({&solid.size.x, &solid.density, &solid.young_modulus, &solid.poisson_ratio, &solid.damping,
           &solid.yield_stress, &solid.thickness, &solid.match_hz, &solid.match_damping_ratio,
           &solid.rotation.x});
    spoil(solid.cells[0]);
    spoil(solid.pins);
    spoil_kind(solid.elasticity);
    take("add_solid", world_.add_solid(solid), model_.solids);
  }
  void add_points() {
    if (model_.size() > kMostObjects) return;
    ParticlesDesc particles = make_particles(random_, place());
    spoil({&particles.particles[0].mass, &particles.particles[0].radius, &particles.particles[0].velocity.x,
           &particles.air_friction, &particles.drag_coefficient});
    if (random_.chance(0.05))
      particles.springs.push_back({random_.index(12), random_.index(12), real(100), real(1)});
    if (random_.chance(0.02)) particles.particles.clear();
    spoil(particles.pins);
    take("add_particles", world_.add_particles(particles), model_.particles);
  }
  void add_mesh() {
    if (model_.meshes.alive.size() > 4) return;
    const MeshDesc mesh =
        random_.chance(0.6) ? fuzz::make_solid(random_, 0.3) : make_hostile_mesh(random_, 0.3);
    // What is far away in a mesh is far away in what is made of it.
    for (const Vec3 p : mesh.positions) model_.is_extreme |= !(length(p) < Real(100));
    take("add_mesh", world_.add_mesh(mesh, random_.chance(0.3) ? MeshTree::kPlanes : MeshTree::kBoxes),
         model_.meshes);
  }
  void add_field() {
    if (model_.fields.alive.size() > 3) return;
    FieldDesc field = make_field(random_, place());
    if (random_.chance(0.1)) field.strength = number(10);
    if (random_.chance(0.1)) field.reach = number(10);
    if (random_.chance(0.1)) field.density = number(1000);
    spoil({&field.vector.x});
    spoil_kind(field.kind);
    take("add_field", world_.add_field(field), model_.fields);
  }
  void add_law() {
    if (model_.laws.alive.size() > 2) return;
    const Vec3 force = random_.vector(2);
    if (random_.chance(0.5)) {
      take("add_force_law", world_.add_force_law(ForceLaw([force](ForceView& view) {
        for (std::size_t i = 0; i < view.size() + 1; ++i) view.add_force(i, view.mass(i) * force);
      })),
           model_.laws);
    } else {
      take("add_force_law", world_.add_force_law(BodyForceLaw([force](BodyForceView& view) {
        for (std::size_t i = 0; i < view.size() + 1; ++i) view.add_force(i, view.mass(i) * force);
      })),
           model_.laws);
    }
  }
  void add_seam() {
    SeamDesc seam;
    const auto edge = [&] {
      SeamEdge one = {.object = point(model_.cloths.pick(random_), 0)};
      if (random_.chance(0.2)) one.object = pick_point();
      one.edge = random_.pick<const char*>({"left", "right", "top", "bottom", "border", "border_0", ""});
      if (random_.chance(0.3)) one.points = {random_.index(9), random_.index(9), random_.index(9)};
      if (!one.points.empty() && random_.chance(0.8)) one.edge.clear();
      return one;
    };
    seam.a = edge();
    seam.b = edge();
    if (random_.chance(0.3)) seam.strength = real(100);
    const auto stitches = world_.sew(seam);
    if (!judge("sew", stitches)) return;
    for (const HookId id : *stitches) model_.hooks.add(id);
  }

  template <class IdType>
  void remove(const char* what, Ids<IdType>& ids) {
    const IdType id = ids.pick(random_);
    note(std::string("remove ") + what);
    const bool lived = ids.lives(id);
    const bool removed = world_.remove(id);
    // Hooks may have gone with what they held.
    constexpr bool kIsHook = std::is_same_v<IdType, HookId>;
    expect(removed == lived || (kIsHook && lived), "removed, or not");
    std::erase(ids.alive, id);
    expect(!world_.remove(id), "removed twice");
  }
  void remove_one() {
    switch (random_.below(9)) {
      case 0:
        return remove("mesh", model_.meshes);
      case 1:
        return remove("body", model_.bodies);
      case 2:
        return remove("hook", model_.hooks);
      case 3:
        return remove("rope", model_.ropes);
      case 4:
        return remove("cloth", model_.cloths);
      case 5:
        return remove("solid", model_.solids);
      case 6:
        return remove("particles", model_.particles);
      case 7:
        return remove("field", model_.fields);
      default:
        return remove("law", model_.laws);
    }
  }
  void remove_bodies() {
    std::vector<BodyId> ids;
    std::size_t living = 0;
    const int count = random_.integer(0, 4);
    for (int i = 0; i < count; ++i) {
      const BodyId id = model_.bodies.pick(random_);
      const bool is_new = std::find(ids.begin(), ids.end(), id) == ids.end();
      living += is_new && model_.bodies.lives(id) ? 1 : 0;
      ids.push_back(id);
    }
    note("remove bodies");
    expect(world_.remove(ids) == living, "another number of bodies removed");
    for (const BodyId id : ids) std::erase(model_.bodies.alive, id);
  }

  void push_point() {
    const PointRef p = pick_point();
    switch (random_.below(4)) {
      case 0:
        judge("apply_force(point)", world_.apply_force(p, vector(10)));
        break;
      case 1:
        judge("apply_impulse(point)", world_.apply_impulse(p, vector(0.1)));
        break;
      case 2:
        judge("set_velocity(point)", world_.set_velocity(p, vector(5)));
        break;
      default:
        judge("set_position(point)", world_.set_position(p, place()));
    }
  }
  void push_body() {
    const BodyId body = model_.bodies.pick(random_);
    switch (random_.below(9)) {
      case 0:
        judge("apply_force", world_.apply_force(body, vector(10)));
        break;
      case 1:
        judge("apply_force at", world_.apply_force(body, vector(10), place()));
        break;
      case 2:
        judge("apply_torque", world_.apply_torque(body, vector(1)));
        break;
      case 3:
        judge("apply_impulse", world_.apply_impulse(body, vector(1)));
        break;
      case 4:
        judge("apply_impulse at", world_.apply_impulse(body, vector(1), place()));
        break;
      case 5:
        judge("set_velocity", world_.set_velocity(body, vector(5)));
        break;
      case 6:
        judge("set_angular_velocity", world_.set_angular_velocity(body, vector(5)));
        break;
      case 7: {
        Quat turn = random_.turn();
        if (is_nonsense()) turn.x = real(1);
        judge("set_pose", world_.set_pose(body, {place(), turn}));
        break;
      }
      default:
        judge("set_motion", world_.set_motion(body, pick_motion()));
    }
  }
  void hold() {
    const PointRef p = pick_point();
    if (random_.chance(0.5)) {
      judge("pin", world_.pin(p, pick_motion()));
    } else if (random_.chance(0.5)) {
      cut();
    } else {
      judge("unpin", world_.unpin(p));
    }
  }
  /// Cuts everything, or one of each kind, by a blade that sweeps a surface anywhere.
  void cut() {
    CutDesc desc = {.from = {place(), place()}, .to = {place(), place()}};
    if (random_.chance(0.3)) desc.cloths = {model_.cloths.pick(random_)};
    if (random_.chance(0.3)) desc.ropes = {model_.ropes.pick(random_)};
    if (random_.chance(0.3)) desc.solids = {model_.solids.pick(random_)};
    const double before = world_.measure().momentum.x;
    const Result<CutResult> cut = world_.cut(desc);
    judge("cut", cut);
    const double after = world_.measure().momentum.x;
    expect(std::fabs(after - before) <= 1e-6 * (1 + std::fabs(before)) || !std::isfinite(before),
           "a cut changed the momentum");
  }
  void set_hook() {
    const HookId hook = model_.hooks.pick(random_);
    switch (random_.below(3)) {
      case 0:
        judge("set_motor", world_.set_motor(hook, {real(5), std::fabs(real(10))}));
        break;
      case 1:
        judge("set_spring", world_.set_spring(hook, {std::fabs(real(100)), std::fabs(real(5)), real(1)}));
        break;
      default:
        judge("set_steering", world_.set_steering(hook, real(1)));
    }
  }
  void set_world() {
    switch (random_.below(3)) {
      case 0:
        judge("set_gravity", world_.set_gravity(vector(10)));
        break;
      case 1: {
        WindDesc wind = make_wind(random_);
        spoil({&wind.velocity.x, &wind.gust, &wind.correlation_time, &wind.correlation_length,
               &wind.air_density});
        judge("set_wind", world_.set_wind(wind));
        break;
      }
      default: {
        World moved = std::move(world_);
        world_ = std::move(moved);
        note("move");
      }
    }
  }

  void ask() {
    const QueryFilter filter = {
        .skip = model_.bodies.lives(model_.bodies.pick(random_)) ? BodyId{} : BodyId{},
        .sensors = random_.chance(0.3)};
    note("ask");
    (void)world_.cast_ray(place(), place(), filter);
    (void)world_.cast_ray_through(place(), place(), filter);
    (void)world_.is_ray_blocked(place(), place(), filter);
    Shape shape = make_simple_shape(random_);
    spoil({&shape.radius, &shape.half_extents.x, &shape.half_height});
    spoil_kind(shape.kind);
    if (random_.chance(0.1)) shape = Shape::hull_of(model_.meshes.pick(random_));
    (void)world_.cast_shape(shape, {place(), random_.turn()}, place(), filter);
    (void)world_.find_overlaps(shape, {place(), random_.turn()}, filter);
    (void)world_.find_in_box(place(), place(), filter);
    (void)world_.find_closest(place(), real(5), filter);
    expect(world_.state_hash() == hash_, "a question changed something");
  }

  template <class IdType>
  void read_points(IdType id, bool lives) {
    const PointView positions = world_.positions(id);
    const PointView velocities = world_.velocities(id);
    expect(lives == !positions.empty() && positions.size() == velocities.size(), "points of what is gone");
    for (std::size_t i = 0; i < positions.size() + 1; ++i) (void)(positions[i] == velocities[i]);
  }
  void read_one() {
    note("read");
    const RopeId rope = model_.ropes.pick(random_);
    read_points(rope, model_.ropes.lives(rope));
    expect(world_.tensions(rope).size() == world_.twists(rope).size(), "tensions and twists");
    (void)world_.torques(rope);
    const ClothId cloth = model_.cloths.pick(random_);
    read_points(cloth, model_.cloths.lives(cloth));
    (void)world_.triangles(cloth);
    (void)world_.pressure(cloth);
    const SolidId solid = model_.solids.pick(random_);
    read_points(solid, model_.solids.lives(solid));
    (void)world_.surface(solid);
    (void)world_.triangles(solid);
    (void)world_.volume(solid);
    const ParticlesId particles = model_.particles.pick(random_);
    read_points(particles, model_.particles.lives(particles));
    read_body();
    expect(world_.state_hash() == hash_, "reading changed something");
  }
  void read_body() {
    const BodyId body = model_.bodies.pick(random_);
    (void)world_.pose(body);
    (void)world_.mass(body);
    (void)world_.asleep(body);
    (void)world_.body_contacts(body);
    (void)world_.visitors(body);
    const HookId hook = model_.hooks.pick(random_);
    (void)world_.hook_force(hook);
    (void)world_.hook_value(hook);
    (void)world_.hook_anchors(hook);
    (void)world_.hook_gap(hook);
    const HookEnd end = pick_end();
    (void)world_.connection_points(end);
    (void)world_.find_place(end);
  }
  void read_all() {
    (void)world_.measure();
    (void)world_.memory();
    (void)world_.body_contacts();
    (void)world_.events();
    (void)world_.wind_at(place(), number(10));
  }

  void save() {
    note("snapshot");
    snapshots_.emplace_back(world_.snapshot(), model_);
  }
  void restore() {
    if (snapshots_.empty() || random_.chance(0.05)) {
      const bool taken = world_.restore({}).has_value();
      expect(!taken, "an empty snapshot was taken");
      return;
    }
    const auto& [snapshot, then] = snapshots_[random_.below(snapshots_.size())];
    note("restore");
    must_do(world_.restore(snapshot));
    go_back(then.meshes, model_.meshes);
    go_back(then.bodies, model_.bodies);
    go_back(then.hooks, model_.hooks);
    go_back(then.ropes, model_.ropes);
    go_back(then.cloths, model_.cloths);
    go_back(then.solids, model_.solids);
    go_back(then.particles, model_.particles);
    go_back(then.fields, model_.fields);
    go_back(then.laws, model_.laws);
    model_.is_extreme = then.is_extreme;
  }

  Random random_;
  World world_;
  Model model_ = {};
  std::vector<std::pair<Snapshot, Model>> snapshots_ = {};
  std::uint64_t hash_ = 0;  ///< Before the call at hand.
};

}  // namespace

void try_api(Random& random) {
  const bool twice = random.chance(0.1);
  const std::uint64_t hash = Trial(random, 1).run();
  if (!twice) return;
  note("the same on two threads");
  part_count() = 0;
  expect(Trial(random, 2).run() == hash, "two threads give other bits");
}

}  // namespace hooke::fuzz
