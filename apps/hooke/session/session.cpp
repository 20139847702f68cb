#include "hooke/session/session.h"

#include "hooke/session/added_objects.h"

#include "process/new_file.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <numeric>
#include <utility>

namespace hooke::app {

namespace {

/// Steps that are behind by more than this many are not made up for: the scene then runs slower than time.
constexpr int kCatchUpSteps = 4;

/// Worlds that undo can put back whole, with all of their timelines.
constexpr std::size_t kKeptWorlds = 8;
/// How often the scene's file is looked at.
constexpr std::chrono::milliseconds kLookInterval(250);

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

const char* name_of(ModelForm form) {
  switch (form) {
    case ModelForm::kRigid:
      return "a rigid body";
    case ModelForm::kJelly:
      return "jelly";
    case ModelForm::kCloth:
      return "cloth";
    case ModelForm::kStill:
      break;
  }
  return "still";
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

std::vector<ListedObject> list_of(const Simulation& simulation) {
  std::vector<ListedObject> listed;
  for (const SceneObject& object : simulation.objects())
    listed.push_back({object.name, object.kind, object.path});
  return listed;
}

}  // namespace

Session::Session(std::string file, Loader loader, const SessionOptions& options)
    : file_(std::move(file)), loader_(std::move(loader)), options_(options) {
  state_.playing = options.playing;
  state_.timeline_budget = options.timeline_budget;
  view_ = std::make_shared<const SessionView>(state_);
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

/// Asks for what cloths, ropes and solids press on bodies with: the view tells it, and the world keeps it
/// only where it is asked for.
static void report_contacts(SceneObjects& objects) {
  for (SceneBody& body : objects.bodies) body.desc.reports_contacts = true;
}

Session::LivePtr Session::build(SharedDocument document) {
  // The command is not done, so that all but the progress is as others saw it last.
  SessionView shown = *view();
  Scene scene = document->scene;
  report_contacts(scene.objects);
  for (SceneEvent& event : scene.timeline) report_contacts(event.add);
  Loaded<Simulation> built = loader_.build(scene, [&](const std::string& text) {
    shown.progress = text;
    publish(shown);
  });
  state_.errors = std::move(built.errors);
  if (!built) return nullptr;
  return std::make_unique<LiveScene>(std::move(*built.value), options_.timeline_budget, std::move(document));
}

bool Session::load() {
  file_watch_.watch(file_);
  Loaded<SceneDocument> document = loader_.read(file_);
  LivePtr live;
  if (document) {
    saved_ = std::make_shared<const SceneDocument>(std::move(*document.value));
    live = build(saved_);
  } else {
    state_.errors = std::move(document.errors);
  }
  if (!live) {
    state_.stage = SessionView::Stage::kFailed;
    publish(state_);
    return false;
  }
  state_.stage = SessionView::Stage::kReady;
  state_.opened = 1;
  take(std::move(live));
  publish();
  return true;
}

/// Shows another world from now on. All that was made for the one before goes.
void Session::take(LivePtr live) {
  live_ = std::move(live);
  capture_ = {};
  insight_ = {};
  warning_watch_.emplace(live_->simulation());
  state_.warnings.clear();
  history_->clear();
  ++state_.built;
  state_.step_seconds = static_cast<double>(live_->simulation().scene().dt);
  state_.droppable = names_to_drop(live_->simulation().scene());
  state_.step_ms = 0;
  state_.problem.clear();
  state_.texture_warnings.clear();
  listed_anew_ = true;
  due_ = WallClock::now();
}

/// Shows another world, and keeps the one before for undo.
void Session::replace(LivePtr live) {
  live_->forget_undone();
  past_.push_back(std::move(live_));
  const auto bytes = [&] {
    return std::accumulate(past_.begin(), past_.end(), std::size_t{0},
                           [](std::size_t sum, const LivePtr& one) { return sum + one->timeline().bytes(); });
  };
  while (past_.size() > 1 && (past_.size() > kKeptWorlds || bytes() > options_.timeline_budget))
    past_.erase(past_.begin());
  future_.clear();
  take(std::move(live));
}

void Session::play() {
  for (;;) {
    const std::vector<Command> commands = wait();
    if (is_ending()) return;
    if (!commands.empty()) listed_anew_ = true;
    for (std::size_t i = 0; i < commands.size(); ++i) {
      if (is_ending()) return;
      ++state_.commands;
      if (i + 1 < commands.size() && replaces(commands[i + 1], commands[i])) continue;
      obey(commands[i]);
    }
    const bool was_read = look_at_file();
    const bool moved = step_if_due();
    if (!commands.empty() || was_read || moved) publish();
  }
}

std::vector<Command> Session::wait() {
  std::unique_lock lock(mutex_);
  const auto has_work = [&] { return ends_ || !queue_.empty(); };
  changed_.wait_until(lock, state_.playing ? std::min(due_, next_look_) : next_look_, has_work);
  std::vector<Command> commands(std::make_move_iterator(queue_.begin()),
                                std::make_move_iterator(queue_.end()));
  queue_.clear();
  return commands;
}

bool Session::is_ending() const {
  const std::lock_guard lock(mutex_);
  return ends_;
}

bool Session::look_at_file() {
  if (WallClock::now() < next_look_) return false;
  next_look_ = WallClock::now() + kLookInterval;
  if (!file_watch_.was_saved()) return false;
  obey(Reload{});
  return true;
}

void Session::say(Outcome outcome) {
  state_.said = std::move(outcome);
  state_.said_by = state_.commands;
}

void Session::obey(const Command& command) {
  std::visit([this](const auto& one) { obey(one); }, command);
}

void Session::obey(const Action& action) {
  if (const auto* grab = std::get_if<Grab>(&action)) {
    if (const std::string name = live_->name_at(grab->ray); !name.empty()) state_.selected = name;
  }
  Outcome outcome = live_->act(action);
  if (outcome.done) future_.clear();
  if (std::holds_alternative<Grab>(action)) {
    state_.last_grab = state_.commands;
    state_.last_grab_done = outcome.done;
    // Who turns the camera need not read each time that nothing is there.
    if (!outcome.done) return;
  }
  if (!outcome.done || !outcome.text.empty()) say(std::move(outcome));
}

void Session::obey(const Play& play) {
  state_.playing = play.playing;
  due_ = WallClock::now();
}

void Session::obey(const MakeSteps& steps) {
  state_.playing = false;
  for (int i = 0; i < steps.count && !is_ending(); ++i) step();
}

void Session::obey(const SetSpeed& speed) {
  // No number at all counts as the least.
  state_.speed = speed.speed >= kLeastSpeed ? std::min(speed.speed, kMostSpeed) : kLeastSpeed;
  due_ = WallClock::now();
}

void Session::obey(const Seek& seek) {
  state_.playing = false;
  const Result<void> done = live_->seek(seek.step, [this] { return is_ending(); });
  (void)live_->take_lost();  // It was said when it happened first.
  state_.problem = done ? "" : to_line(done.error());
}

/// Goes on with the last of `from`, and keeps what was there in `to`.
void Session::change_scene(std::vector<LivePtr>& from, std::vector<LivePtr>& to, const char* said) {
  to.push_back(std::move(live_));
  take(std::move(from.back()));
  from.pop_back();
  say({true, said});
}

void Session::obey(const Undo& /*undo*/) {
  state_.problem.clear();
  if (live_->undo_count() > 0 || past_.empty()) return say(live_->undo());
  change_scene(past_, future_, "undone: change of the scene");
}

void Session::obey(const Redo& /*redo*/) {
  state_.problem.clear();
  if (live_->redo_count() > 0 || future_.empty()) return say(live_->redo());
  change_scene(future_, past_, "done again: change of the scene");
}

void Session::obey(const Restart& /*restart*/) {
  live_->restart();
  warning_watch_.emplace(live_->simulation());
  state_.problem.clear();
}

void Session::obey(const Open& open) {
  Loaded<SceneDocument> document = loader_.read(open.file);
  LivePtr live;
  if (document) {
    auto shared = std::make_shared<const SceneDocument>(std::move(*document.value));
    live = build(shared);
    if (live) saved_ = std::move(shared);
  } else {
    state_.errors = std::move(document.errors);
  }
  state_.file_errors = std::exchange(state_.errors, {});
  if (!live) return say({false, "'" + open.file + "' cannot be opened"});
  file_ = open.file;
  file_watch_.watch(file_);
  past_.clear();
  future_.clear();
  state_.selected.clear();
  ++state_.opened;
  take(std::move(live));
  say({true, "opened '" + file_ + "'"});
}

void Session::obey(const Reload& /*reload*/) {
  file_watch_.watch(file_);
  Loaded<SceneDocument> document = loader_.read(file_);
  state_.file_errors = std::move(document.errors);
  if (!document) return say({false, "the file has a mistake; the scene stays as it was"});
  auto shared = std::make_shared<const SceneDocument>(std::move(*document.value));
  if (shared->text == live_->document()->text) {
    saved_ = live_->document();
    return say({true, "the file says what is shown"});
  }
  LivePtr live = build(shared);
  state_.file_errors = std::exchange(state_.errors, {});
  if (!live) return say({false, "the file has a mistake; the scene stays as it was"});
  saved_ = std::move(shared);
  replace(std::move(live));
  say({true, "read the file again"});
}

void Session::obey(const Change& change) {
  const SharedDocument& before = live_->document();
  Loaded<SceneDocument> edited = edit_document(*before, change.path, change.value);
  if (!edited) return say({false, to_line(edited.errors.front())});
  auto shared = std::make_shared<const SceneDocument>(std::move(*edited.value));
  if (shared->text == before->text) return;
  const std::string what = change.path + " is " + change.value + " now";
  if (can_change_live(before->scene, shared->scene)) return obey(Action(Edit{std::move(shared), what}));
  LivePtr live = build(std::move(shared));
  const std::vector<Error> errors = std::exchange(state_.errors, {});
  if (!live) return say({false, to_line(errors.front())});
  replace(std::move(live));
  say({true, what + "; the scene starts anew with it"});
}

void Session::obey(const TurnModel& turn) {
  const SharedDocument& before = live_->document();
  const std::optional<ModelForm> now = form_of_model(*before);
  const ModelForm form = now == turn.form ? ModelForm::kStill : turn.form;
  Result<SceneDocument> turned = turn_model(*before, form);
  if (!turned) return say({false, "nothing is turned: " + turned.error().message});
  LivePtr live = build(std::make_shared<const SceneDocument>(std::move(turned).value()));
  const std::vector<Error> errors = std::exchange(state_.errors, {});
  if (!live) return say({false, "the model stays as it was: " + to_line(errors.front())});
  replace(std::move(live));
  say({true, std::string("the model is ") + name_of(form) + " now"});
}

void Session::obey(const Save& save) {
  const std::filesystem::path name = save.name;
  if (name.empty() || name.has_parent_path()) {
    return say(
        {false, "a scene is saved in its folder, from which its models and textures count: give a name"});
  }
  const std::string path =
      (std::filesystem::path(live_->document()->scene.path).parent_path() / name).string();
  if (std::filesystem::path(path).extension() != ".json")
    return say({false, "a scene's name ends with .json"});
  const Result<void> written = process::write_file(path, live_->document()->text);
  if (!written) return say({false, to_line(written.error())});
  if (path == file_) file_watch_.watch(file_);
  saved_ = live_->document();
  say({true, "saved '" + path + "'"});
}

void Session::obey(const Select& select) {
  state_.selected = select.name;
}

void Session::obey(const ShowInsight& show) {
  wish_ = show.wish;
}

void Session::obey(const SaveFigures& /*save*/) {
  const std::filesystem::path scene = live_->document()->scene.path;
  const std::string path = (scene.parent_path() / (scene.stem().string() + "-figures.csv")).string();
  const Result<void> written = process::write_file(path, history_->csv());
  if (!written) return say({false, to_line(written.error())});
  say({true, "saved '" + path + "', " + std::to_string(history_->size()) + " rows"});
}

void Session::step() {
  const auto start = WallClock::now();
  const Result<void> done = live_->step();
  if (std::optional<std::string> lost = live_->take_lost()) say({false, *std::move(lost)});
  smooth(state_.step_ms, std::chrono::duration<double, std::milli>(WallClock::now() - start).count());
  if (done) {
    warning_watch_->look(live_->simulation(), live_->report());
    return;
  }
  state_.playing = false;
  state_.problem = to_line(done.error());
}

bool Session::step_if_due() {
  const bool is_over = options_.stop_time && live_->simulation().world().time() >= *options_.stop_time;
  if (!state_.playing || (!is_over && WallClock::now() < due_)) return false;
  if (is_over) {
    state_.playing = false;
    return true;
  }
  step();
  const auto period = std::chrono::duration_cast<WallClock::duration>(
      std::chrono::duration<double>(state_.step_seconds / state_.speed));
  due_ = std::max(due_ + period, WallClock::now() - kCatchUpSteps * period);
  return true;
}

void Session::measure_all() {
  const Simulation& simulation = live_->simulation();
  std::vector<MeasuredValue> all = measure(simulation, "");
  state_.measured = state_.selected.empty() ? all : measure(simulation, state_.selected);
  const StepReport& report = live_->report();
  all.push_back({"detect", "ms", report.detect_ms});
  all.push_back({"prepare", "ms", report.prepare_ms});
  all.push_back({"substeps", "ms", report.substep_ms});
  all.push_back({"finish", "ms", report.finish_ms});
  const std::vector<MeasuredValue> none;
  history_->note(live_->step_count(), simulation.world().time(), all, state_.selected,
                 state_.selected.empty() ? none : state_.measured);
  state_.history = history_;
}

void Session::publish() {
  const Simulation& simulation = live_->simulation();
  const World& world = simulation.world();
  const Timeline& timeline = live_->timeline();
  state_.step = live_->step_count();
  state_.last_step = live_->last_step();
  state_.time = world.time();
  measure_all();
  state_.holding = live_->hand().holds();
  state_.held = live_->held();
  state_.hand_place = live_->hand().place(world);
  state_.hand_target = live_->hand().target();
  state_.undo_count = live_->undo_count() + past_.size();
  state_.redo_count = live_->redo_count() + future_.size();
  state_.document = live_->document();
  state_.edited = saved_ != live_->document();
  const bool has_changed = std::exchange(listed_anew_, false) || !state_.listed;
  if (has_changed || state_.listed->size() != simulation.objects().size())
    state_.listed = std::make_shared<const std::vector<ListedObject>>(list_of(simulation));
  state_.warnings.clear();
  for (const RunWarning& warning : warning_watch_->warnings()) state_.warnings.push_back(warning.line());
  state_.moments = timeline.moments();
  state_.timeline_bytes = timeline.bytes();
  state_.timeline_interval = timeline.interval();
  state_.picture = std::make_shared<const SceneState>(capture_.capture(simulation, world.time()));
  state_.insight = insight_.make(world, wish_, world.time() - shown_time_);
  shown_time_ = world.time();
  for (std::string& line : capture_.take_warnings()) state_.texture_warnings.push_back(std::move(line));
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
