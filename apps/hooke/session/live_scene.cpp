#include "hooke/session/live_scene.h"

#include "hooke/session/added_objects.h"
#include "hooke/shape_radius.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <utility>

namespace hooke::app {

namespace {

/// How far a ray may pass beside a rope or a particle and still meet it [m].
constexpr Real kMargin = Real(0.03);
/// The hand pulls with this many times the weight of what it holds, and with the second at least [N].
constexpr Real kHandWeights = Real(20);
constexpr Real kLeastHandForce = Real(200);
/// The hand's spring is made for at least this share of the mass of all that hangs together with what it
/// holds.
constexpr Real kConnectedShare = Real(0.25);
/// How far in front of the eye a ball starts [m].
constexpr double kMuzzle = 0.3;
/// Lever of a ball's resistance to rolling, over its radius: at 5 m/s it comes to rest after 36 m.
constexpr Real kBallRolling = Real(0.05);
/// How far above the place where it is dropped an object starts [m].
constexpr double kDropHeight = 0.3;
constexpr double kUsualReach = 0.5;  ///< [m]

/// What undo calls an action; empty for one that belongs to a grip.
std::string_view title_of(const Action& action) {
  static constexpr std::string_view kTitles[] = {"grab", "",    "",        "shot", "drop",
                                                 "pin",  "tie", "removal", "cut",  "edit"};
  static_assert(std::size(kTitles) == std::variant_size_v<Action>);
  return kTitles[action.index()];
}

Real mass_of(const World& world, const SceneObject& object) {
  // Ids of other kinds are null, and have no mass.
  return world.mass(object.body) + world.mass(object.rope) + world.mass(object.cloth) +
         world.mass(object.solid) + world.mass(object.particles);
}

/// Mass of the object of that name and of all that hooks join to it [kg].
Real connected_mass(const Simulation& simulation, const std::string& name) {
  std::set<std::string> joined = {name};
  for (bool grew = true; grew;) {
    grew = false;
    for (const SceneObject& hook : simulation.objects()) {
      const auto& [a, b] = hook.hooked;
      if (hook.kind != SceneObject::Kind::kHook || hook.broken || a.empty() || b.empty()) continue;
      if (joined.contains(a) == joined.contains(b)) continue;
      joined.insert(a);
      joined.insert(b);
      grew = true;
    }
  }
  Real mass = Real(0);
  for (const std::string& one : joined) {
    const SceneObject* object = simulation.find(one);
    if (object != nullptr) mass += mass_of(simulation.world(), *object);
  }
  return mass;
}

/// Radius of a ball about the origin of an object that is to be dropped which holds it [m], or a usual size.
double reach_of(const SceneObjects& objects) {
  if (!objects.bodies.empty()) return radius_of(objects.bodies[0].desc.shape, kUsualReach);
  if (!objects.solids.empty()) return 0.5 * static_cast<double>(length(objects.solids[0].desc.size));
  return 0;
}

std::string in_meters(double length) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.2f m", length);
  return text;
}

}  // namespace

LiveScene::LiveScene(Simulation simulation, std::size_t budget, SharedDocument document)
    : simulation_(std::move(simulation)), timeline_(budget), document_(std::move(document)) {
  last_step_ = step_count();
  timeline_.add(moment(""));
}

Moment LiveScene::moment(std::string_view before) const {
  return {.snapshot = simulation_.snapshot(),
          .hand = hand_,
          .step = step_count(),
          .actions = next_action_,
          .added = added_,
          .document = document_,
          .before = std::string(before)};
}

void LiveScene::go_to(const Moment& moment) {
  (void)simulation_.restore(moment.snapshot);  // It is not empty.
  hand_ = moment.hand;
  next_action_ = moment.actions;
  added_ = moment.added;
  document_ = moment.document;
}

Outcome LiveScene::act(const Action& action) {
  const std::string_view title = title_of(action);
  if (title.empty() && !hand_.holds()) return {false, "nothing is held"};
  std::optional<Moment> before;
  if (!title.empty()) before = moment(title);
  const std::uint64_t added = added_;
  Outcome outcome = perform(action);
  if (!outcome.done) {
    added_ = added;  // A repeat does not know of what failed, and names the next object as it was named.
    return outcome;
  }
  const bool has_future = last_step_ > step_count() || timeline_.actions().size() > next_action_;
  if (has_future) timeline_.cut(step_count(), next_action_);
  last_step_ = step_count();
  undone_.clear();
  if (before) timeline_.add(std::move(*before));
  timeline_.log(step_count(), action);
  ++next_action_;
  return outcome;
}

void LiveScene::repeat_actions() {
  const std::vector<LoggedAction>& log = timeline_.actions();
  for (; next_action_ < log.size() && log[next_action_].step <= step_count(); ++next_action_)
    perform(log[next_action_].action);
}

Result<void> LiveScene::step() {
  repeat_actions();
  const Result<bool> held = hand_.before_step(simulation_.world(), simulation_.scene().dt);
  if (!held) {
    if (hand_.holds()) lost_ = "the hand lost '" + this->held() + "': " + to_line(held.error());
    hand_.release(simulation_.world());
  }
  report_ = simulation_.step();
  if (!report_.moved) return Error{ErrorCode::kOutOfRange, simulation_.scene().path, "the step did not move"};
  last_step_ = std::max(last_step_, step_count());
  if (timeline_.is_due(step_count())) timeline_.add(moment(""));
  return {};
}

Result<void> LiveScene::seek(std::uint64_t step, const std::function<bool()>& stops) {
  const std::uint64_t target = std::min(step, last_step_);
  const Moment* start = timeline_.find(target);
  const bool is_behind = target < step_count();
  if (start != nullptr && (is_behind || start->step > step_count())) go_to(*start);
  while (step_count() < target && (!stops || !stops())) {
    if (Result<void> done = this->step(); !done) return done;
  }
  repeat_actions();
  return {};
}

Outcome LiveScene::undo() {
  const Moment* before = timeline_.find_undo(next_action_);
  if (before == nullptr) return {false, "there is nothing to undo"};
  const Moment place = *before;
  undone_.push_back({place, moment(""), timeline_.actions_from(place.actions), last_step_});
  go_to(place);
  timeline_.forget_undo(place.actions);
  timeline_.cut(place.step, place.actions);
  last_step_ = place.step;
  return {true, "undone: " + place.before};
}

Outcome LiveScene::redo() {
  if (undone_.empty()) return {false, "there is nothing to do again"};
  Undone undone = std::move(undone_.back());
  undone_.pop_back();
  timeline_.cut(undone.before.step, undone.before.actions);
  std::string text = "done again: " + undone.before.before;
  timeline_.add(std::move(undone.before));
  for (LoggedAction& logged : undone.actions) timeline_.log(logged.step, std::move(logged.action));
  go_to(undone.after);
  last_step_ = undone.last_step;
  return {true, std::move(text)};
}

void LiveScene::restart() {
  const Moment place = timeline_.first();
  const SharedDocument edited = document_;
  timeline_.cut(place.step, 0);
  timeline_.forget_undo(0);
  go_to(place);
  next_action_ = 0;
  last_step_ = step_count();
  undone_.clear();
  if (document_ != edited) act(Edit{edited, "edits"});
}

std::string LiveScene::name_at(const Ray& ray) const {
  const std::optional<Target> target = find(ray);
  return target ? target->name : std::string();
}

std::string LiveScene::held() const {
  return hand_.holds() ? name_of(hand_.body(), hand_.object()) : std::string();
}

std::string LiveScene::name_of(BodyId body, PointRef point) const {
  for (const SceneObject& object : simulation_.objects()) {
    if (body ? object.body == body : has_point(object, point)) return object.name;
  }
  return {};
}

std::optional<LiveScene::Target> LiveScene::find(const Ray& ray) const {
  const World& world = simulation_.world();
  const auto body = world.cast_ray(ray.origin, ray.motion);
  const auto object = world.cast_ray_on_deformables(ray.origin, ray.motion, {.margin = kMargin});
  if (!body || !object || (!body.value() && !object.value())) return {};
  Target target;
  if (!object.value() || (body.value() && body.value()->fraction <= object.value()->fraction)) {
    target.body = body.value()->body;
    target.place = body.value()->point;
  } else {
    target.point = object.value()->place.nearest;
    target.place = object.value()->place.point;
    if (const BodyId soft = world.body_of(target.point)) {
      target.body = soft;
      target.point = {};
    }
  }
  target.name = name_of(target.body, target.point);
  return target;
}

Outcome LiveScene::perform(const Action& action) {
  return std::visit([&](const auto& one) { return perform(one); }, action);
}

Outcome LiveScene::perform(const Grab& grab) {
  const std::optional<Target> target = find(grab.ray);
  if (!target || target->name.empty()) return {false, "there is nothing to grab"};
  World& world = simulation_.world();
  const SceneObject* object = simulation_.find(target->name);
  const Real own = object != nullptr ? mass_of(world, *object) : Real(0);
  if (!(own > Real(0))) return {false, "'" + target->name + "' cannot be moved"};
  const Real mass = std::max(own, kConnectedShare * connected_mass(simulation_, target->name));
  const Real weight = mass * length(world.desc().gravity);
  const HandDesc desc = {.max_force = std::max(kLeastHandForce, kHandWeights * weight), .mass = mass};
  const SimulationSnapshot before = simulation_.snapshot();
  const Hand hand = hand_;
  const Result<void> grabbed = target->body ? hand_.grab(world, target->body, target->place, desc)
                                            : hand_.grab(world, target->point, target->place, desc);
  if (!grabbed) {
    (void)simulation_.restore(before);  // It is not empty.
    hand_ = hand;
    return {false, to_line(grabbed.error())};
  }
  return {true, "grabbed '" + target->name + "'"};
}

Outcome LiveScene::perform(const MoveHand& move) {
  hand_.move_to(move.target);
  return {true, ""};
}

Outcome LiveScene::perform(const Release& /*release*/) {
  const std::string name = held();
  hand_.release(simulation_.world());
  return {true, "let go of '" + name + "'"};
}

std::string LiveScene::new_name(std::string_view kind) {
  std::string name;
  do {
    name = std::string(kind) + "_" + std::to_string(++added_);
  } while (simulation_.find(name) != nullptr);
  return name;
}

Outcome LiveScene::add(const SceneObjects& objects, const std::string& text) {
  const SimulationSnapshot before = simulation_.snapshot();
  const std::vector<Error> errors = simulation_.add(objects);
  if (errors.empty()) return {true, text};
  (void)simulation_.restore(before);  // It is not empty.
  return {false, to_line(errors.front())};
}

Outcome LiveScene::perform(const Shoot& shoot) {
  const DVec3 direction = normalize(shoot.ray.motion);
  SceneBody ball;
  ball.tag.name = new_name("ball");
  ball.desc.kind = BodyKind::kDynamic;
  ball.desc.shape = Shape::sphere(static_cast<Real>(shoot.radius));
  ball.desc.position = shoot.ray.origin + (kMuzzle + shoot.radius) * direction;
  ball.desc.velocity = vector_cast<Real>(shoot.speed * direction);
  ball.desc.bullet = true;
  ball.desc.reports_contacts = true;
  ball.desc.contact.rolling_friction = kBallRolling * ball.desc.shape.radius;
  return add({.bodies = {ball}}, "shot '" + ball.tag.name + "'");
}

Outcome LiveScene::perform(const Drop& drop) {
  const std::optional<Target> target = find(drop.ray);
  DVec3 place = target ? target->place : drop.ray.origin + drop.distance * normalize(drop.ray.motion);
  const std::string name = new_name(drop.object);
  const auto measured = copy_of(simulation_.scene(), drop.object, place, name);
  if (!measured) return {false, "there is no object '" + drop.object + "' to drop"};
  if (target) place.y += kDropHeight + reach_of(*measured);
  return add(*copy_of(simulation_.scene(), drop.object, place, name), "dropped '" + name + "'");
}

Outcome LiveScene::perform(const Pin& pin) {
  const std::optional<Target> target = find(pin.ray);
  if (!target || target->name.empty()) return {false, "there is nothing to pin"};
  if (target->body) return pin_body(*target);
  World& world = simulation_.world();
  const bool was_pinned = world.is_pinned(target->point);
  const Result<void> done = was_pinned ? world.unpin(target->point) : world.pin(target->point);
  if (!done) return {false, to_line(done.error())};
  return {true, (was_pinned ? "unpinned point " : "pinned point ") + std::to_string(target->point.index) +
                    " of '" + target->name + "'"};
}

Outcome LiveScene::pin_body(const Target& target) {
  const auto objects = simulation_.objects();
  const auto pin = std::find_if(objects.begin(), objects.end(), [&](const SceneObject& object) {
    return object.kind == SceneObject::Kind::kHook && object.hook_kind == HookKind::kFixed &&
           object.hooked[0].empty() && object.hooked[1] == target.name && !object.broken;
  });
  if (pin != objects.end()) {
    const Result<void> removed = simulation_.remove(std::string(pin->name));
    if (!removed) return {false, to_line(removed.error())};
    return {true, "unpinned '" + target.name + "'"};
  }
  if (simulation_.world().mass(target.body) == 0)
    return {false, "'" + target.name + "' stands still or follows its motion in any case"};
  if (simulation_.world().soft_form(target.body))
    return {false, "'" + target.name + "' is soft now: pin it once it is rigid again"};
  SceneHook hook;
  hook.name = new_name("pin");
  hook.desc.kind = HookKind::kFixed;
  hook.b = target.name;
  hook.anchor = target.place;
  return add({.hooks = {hook}}, "pinned '" + target.name + "'");
}

Outcome LiveScene::perform(const Tie& tie) {
  const std::optional<Target> a = find(tie.first);
  const std::optional<Target> b = find(tie.second);
  if (!a || !b || a->name.empty() || b->name.empty()) return {false, "there is nothing to tie"};
  const double distance = length(b->place - a->place);
  SceneHook hook;
  hook.name = new_name("string");
  hook.desc.kind = HookKind::kDistance;
  hook.desc.limits = {Real(0), static_cast<Real>(distance)};
  hook.desc.anchor_b = b->place;
  hook.desc.collide = true;
  hook.a = a->name;
  hook.b = b->name;
  hook.anchor = a->place;
  return add({.hooks = {hook}},
             "tied '" + a->name + "' to '" + b->name + "' by a string of " + in_meters(distance));
}

Outcome LiveScene::perform(const Remove& remove) {
  const std::optional<Target> target = find(remove.ray);
  if (!target || target->name.empty()) return {false, "there is nothing to remove"};
  const Result<void> removed = simulation_.remove(target->name);
  if (!removed) return {false, to_line(removed.error())};
  return {true, "removed '" + target->name + "'"};
}

Outcome LiveScene::perform(const Cut& cut) {
  const DVec3 eye = cut.first.origin;
  const Result<CutResult> done =
      simulation_.world().cut({.from = {eye, eye + cut.first.motion}, .to = {eye, eye + cut.second.motion}});
  if (!done) return {false, to_line(done.error())};
  const CutResult& result = done.value();
  std::string names;
  for (const SceneObject& object : simulation_.objects()) {
    const auto is_it = [&](const auto& list, auto id, auto member) {
      return std::any_of(list.begin(), list.end(), [&](const auto& one) { return one.*member == id; });
    };
    const bool is_cut = is_it(result.ropes, object.rope, &RopeCut::rope) ||
                        is_it(result.cloths, object.cloth, &ClothCut::cloth) ||
                        is_it(result.solids, object.solid, &SolidCut::solid);
    if (is_cut) names += (names.empty() ? "'" : ", '") + object.name + "'";
  }
  if (!names.empty()) return {true, "cut " + names};
  if (result.refused.empty()) return {false, "the line crosses nothing that can be cut"};
  const CutRefusal& refusal = result.refused.front();
  return {false, "'" + name_of({}, refusal.object) + "' is not cut: " + refusal.why};
}

Outcome LiveScene::perform(const Edit& edit) {
  World& world = simulation_.world();
  const WorldDesc& wanted = edit.document->scene.world;
  const SimulationSnapshot before = simulation_.snapshot();
  Result<void> done = world.set_gravity(wanted.gravity);
  if (done) done = world.set_wind(wanted.wind);
  // The command line may have set other workers than the document says.
  const Scene& said = document_ ? document_->scene : simulation_.scene();
  if (done && wanted.workers != said.world.workers) done = world.set_workers(wanted.workers);
  if (!done) {
    (void)simulation_.restore(before);  // It is not empty.
    return {false, to_line(done.error())};
  }
  document_ = edit.document;
  return {true, edit.what};
}

}  // namespace hooke::app
