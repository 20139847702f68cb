#include "hooke/session/session.h"

#include "hooke/session/added_objects.h"

#include <algorithm>
#include <exception>
#include <utility>

namespace hooke::app {

namespace {

/// Steps that are behind by more than this many are not made up for: the scene then runs slower than time.
constexpr int kCatchUpSteps = 4;

void smooth(double& value, double input) {
  value = value > 0 ? 0.92 * value + 0.08 * input : input;
}

template <class T>
bool holds(const Command& command) {
  return std::holds_alternative<T>(command);
}

bool is_move(const Command& command) {
  const auto* action = std::get_if<Action>(&command);
  return action != nullptr && std::holds_alternative<MoveHand>(*action);
}

/// Whether a command makes the one before it needless: of several moves of the hand, or of the timeline, only
/// the last counts.
bool replaces(const Command& next, const Command& before) {
  return (is_move(next) && is_move(before)) || (holds<Seek>(next) && holds<Seek>(before));
}

/// A place that stands for an object in logs: where a mouse would find it.
DVec3 place_of(const World& world, const SceneObject& object) {
  if (object.kind == SceneObject::Kind::kBody) return world.pose(object.body).position;
  const PointView points = positions_of(world, object);
  if (points.empty()) return {};
  if (object.kind == SceneObject::Kind::kRope) return points[points.size() - 1];
  if (object.kind == SceneObject::Kind::kCloth) return points[points.size() / 2];
  DVec3 middle;
  for (std::size_t i = 0; i < points.size(); ++i)
    middle += 1.0 / static_cast<double>(points.size()) * points[i];
  return middle;
}

std::vector<std::pair<std::string, DVec3>> places_of(const Simulation& simulation) {
  std::vector<std::pair<std::string, DVec3>> places;
  for (const SceneObject& object : simulation.objects()) {
    const bool has_place =
        object.kind != SceneObject::Kind::kHook && object.kind != SceneObject::Kind::kField;
    if (has_place) places.emplace_back(object.name, place_of(simulation.world(), object));
  }
  return places;
}

}  // namespace

Session::Session(Loader loader, const SessionOptions& options)
    : loader_(std::move(loader)), options_(options), view_(std::make_shared<const SessionView>()) {
  state_.playing = options.playing;
  state_.timeline_budget = options.timeline_budget;
  thread_ = std::thread([this] { run(); });
}

Session::~Session() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

std::uint64_t Session::post(Command command) {
  const std::lock_guard lock(mutex_);
  queue_.push_back(std::move(command));
  changed_.notify_all();
  return ++posted_;
}

std::shared_ptr<const SessionView> Session::view() const {
  const std::lock_guard lock(mutex_);
  return view_;
}

std::shared_ptr<const SessionView> Session::wait_for(const std::function<bool(const SessionView&)>& condition,
                                                     double seconds) const {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return condition(*view_); });
  return view_;
}

void Session::run() {
  try {
    if (load()) play();
  } catch (const std::exception& exception) {
    state_.stage = SessionView::Stage::kFailed;
    state_.errors = {{ErrorCode::kUnsupported, "session", exception.what()}};
    publish(state_);
  }
}

bool Session::load() {
  Loaded<Simulation> loaded = loader_([&](const std::string& text) {
    state_.progress = text;
    publish(state_);
  });
  if (!loaded) {
    state_.stage = SessionView::Stage::kFailed;
    state_.errors = std::move(loaded.errors);
    publish(state_);
    return false;
  }
  live_ = std::make_unique<LiveScene>(std::move(*loaded.value), options_.timeline_budget);
  state_.stage = SessionView::Stage::kReady;
  state_.step_seconds = static_cast<double>(live_->simulation().scene().dt);
  state_.droppable = names_to_drop(live_->simulation().scene());
  due_ = WallClock::now();
  publish();
  return true;
}

void Session::play() {
  for (;;) {
    const std::vector<Command> commands = wait();
    {
      const std::lock_guard lock(mutex_);
      if (ends_) return;
    }
    for (std::size_t i = 0; i < commands.size(); ++i) {
      ++state_.commands;
      if (i + 1 < commands.size() && replaces(commands[i + 1], commands[i])) continue;
      obey(commands[i]);
    }
    step_if_due();
    publish();
  }
}

std::vector<Command> Session::wait() {
  std::unique_lock lock(mutex_);
  const auto has_work = [&] { return ends_ || !queue_.empty(); };
  if (state_.playing) {
    changed_.wait_until(lock, due_, has_work);
  } else {
    changed_.wait(lock, has_work);
  }
  std::vector<Command> commands(std::make_move_iterator(queue_.begin()),
                                std::make_move_iterator(queue_.end()));
  queue_.clear();
  return commands;
}

void Session::obey(const Action& action) {
  const Outcome outcome = live_->act(action);
  if (std::holds_alternative<Grab>(action)) {
    state_.last_grab = state_.commands;
    state_.last_grab_done = outcome.done;
    // Who turns the camera need not read each time that nothing is there.
    if (!outcome.done) return;
  }
  if (!outcome.done || !outcome.text.empty()) {
    state_.said = outcome;
    state_.said_by = state_.commands;
  }
}

void Session::obey(const Command& command) {
  if (const auto* action = std::get_if<Action>(&command)) return obey(*action);
  if (const auto* play = std::get_if<Play>(&command)) {
    state_.playing = play->playing;
    due_ = WallClock::now();
  } else if (const auto* steps = std::get_if<MakeSteps>(&command)) {
    state_.playing = false;
    for (int i = 0; i < steps->count; ++i) step();
  } else if (const auto* speed = std::get_if<SetSpeed>(&command)) {
    state_.speed = std::clamp(speed->speed, 1e-3, 16.0);
    due_ = WallClock::now();
  } else if (const auto* seek = std::get_if<Seek>(&command)) {
    state_.playing = false;
    live_->seek(seek->step);
    state_.problem.clear();
  } else if (holds<Undo>(command)) {
    state_.said = live_->undo();
    state_.said_by = state_.commands;
    state_.problem.clear();
  } else {
    live_->restart();
    state_.problem.clear();
  }
}

void Session::step() {
  const auto start = WallClock::now();
  const Result<void> done = live_->step();
  smooth(state_.step_ms, std::chrono::duration<double, std::milli>(WallClock::now() - start).count());
  if (done) return;
  state_.playing = false;
  state_.problem = to_line(done.error());
}

void Session::step_if_due() {
  const bool is_over = options_.stop_time && live_->simulation().world().time() >= *options_.stop_time;
  if (is_over) state_.playing = false;
  if (!state_.playing || WallClock::now() < due_) return;
  step();
  const auto period = std::chrono::duration_cast<WallClock::duration>(
      std::chrono::duration<double>(state_.step_seconds / state_.speed));
  due_ = std::max(due_ + period, WallClock::now() - kCatchUpSteps * period);
}

void Session::publish() {
  const Simulation& simulation = live_->simulation();
  const World& world = simulation.world();
  const Timeline& timeline = live_->timeline();
  state_.step = live_->step_count();
  state_.last_step = live_->last_step();
  state_.time = world.time();
  const Energy energy = world.measure().energy;
  state_.energies = {energy.kinetic, energy.potential, energy.elastic};
  state_.holding = live_->hand().holds();
  state_.held = live_->held();
  state_.hand_place = live_->hand().place(world);
  state_.hand_target = live_->hand().target();
  state_.undo_count = live_->undo_count();
  state_.moments = timeline.moments();
  state_.timeline_bytes = timeline.bytes();
  state_.timeline_interval = timeline.interval();
  state_.picture = std::make_shared<const SceneState>(capture_.capture(simulation, world.time()));
  for (std::string& line : capture_.take_warnings()) state_.warnings.push_back(std::move(line));
  state_.places = places_of(simulation);
  publish(state_);
}

void Session::publish(SessionView view) {
  view.made = WallClock::now();
  auto shared = std::make_shared<const SessionView>(std::move(view));
  const std::lock_guard lock(mutex_);
  view_ = std::move(shared);
  changed_.notify_all();
}

}  // namespace hooke::app
