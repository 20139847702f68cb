#pragma once

#include "hooke/drawing/scene_capture.h"
#include "hooke/run_watch.h"
#include "hooke/scene_io.h"
#include "hooke/session/action.h"
#include "hooke/session/history.h"
#include "hooke/session/insight.h"
#include "hooke/session/live_scene.h"
#include "hooke/session/measured_value.h"
#include "hooke/session/model_scene.h"
#include "hooke/session/scene_document.h"

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

namespace hooke::app {

/// Plays or pauses.
struct Play {
  bool playing = true;
};
/// Pauses and makes steps.
struct MakeSteps {
  int count = 1;
};
/// How slow and how fast time may pass.
inline constexpr double kLeastSpeed = 1e-3;
inline constexpr double kMostSpeed = 16;
/// Changes how fast time passes; 1 is real time. A speed beyond kLeastSpeed or kMostSpeed counts as that.
struct SetSpeed {
  double speed = 1;
};
/// Pauses and goes to a step of the timeline.
struct Seek {
  std::uint64_t step = 0;
};
/// Goes back to before the last action or edit.
struct Undo {};
/// Does again what was undone last.
struct Redo {};
/// Goes back to the start, and forgets what was done; edits of the scene stay.
struct Restart {};
/// Opens another scene or model.
struct Open {
  std::string file = {};
};
/// Reads the file again.
struct Reload {};
/// Changes what the scene says. Gravity and wind change at once; all else starts the scene again.
struct Change {
  std::string path = {};   ///< As "ropes[0].total_mass".
  std::string value = {};  ///< As JSON.
};
/// Makes the model that is shown by itself rigid, jelly or cloth; of what it is already, still again. The
/// scene starts anew with it.
struct TurnModel {
  ModelForm form = ModelForm::kRigid;
};
/// Saves the scene as it is edited now.
struct Save {
  std::string name =
      {};  ///< Name of a file in the folder of the scene, which models and textures count from.
};
/// Selects an object, whose figures the view then shows; an empty name for none.
struct Select {
  std::string name = {};
};

/// Writes all figures so far into a .csv file beside the scene.
struct SaveFigures {};
/// Says what the view shows besides objects.
struct ShowInsight {
  InsightWish wish = {};
};

using Command = std::variant<Play, MakeSteps, SetSpeed, Seek, Undo, Redo, Restart, Open, Reload, Change,
                             TurnModel, Save, Select, ShowInsight, SaveFigures, Action>;

/// An object of the scene, for lists.
struct ListedObject {
  std::string name = {};
  SceneObject::Kind kind = SceneObject::Kind::kBody;
  std::string path =
      {};  ///< Where the scene describes it, as "ropes[0]"; "added[0].ropes[0]" for one that came later.
};

/// What others see of a session at one moment. It does not change any more.
struct SessionView {
  /// How far the session is.
  enum class Stage : std::uint8_t {
    kLoading,  ///< It reads models and builds the world.
    kReady,    ///< It can be played.
    kFailed,   ///< The scene could not be built; `errors` say why.
  };

  Stage stage = Stage::kLoading;
  std::string progress = {};            ///< What is done while it loads.
  std::vector<Error> errors = {};       ///< Why it failed.
  std::vector<Error> file_errors = {};  ///< What is wrong with the file that was to be read last.
  SharedDocument document = {};         ///< The scene as it is edited now.
  bool edited = false;                  ///< Whether it was changed since it was read or saved.
  std::uint64_t opened = 0;  ///< Number of scenes that were opened: whoever looks at another one looks anew.
  std::uint64_t built =
      0;  ///< Number of worlds that were made or put back: all that is drawn is another then.
  std::shared_ptr<const std::vector<ListedObject>> listed = {};  ///< All objects.
  std::string selected = {};                                     ///< Name of the object that is selected.
  std::vector<MeasuredValue> measured = {};                      ///< Its figures, or those of the world.
  std::uint64_t commands = 0;        ///< Number of commands that were done: see Session::post.
  std::optional<Outcome> said = {};  ///< What came of the last action or undo.
  std::uint64_t said_by = 0;         ///< Number of the command that `said` is about.
  std::uint64_t last_grab = 0;       ///< Number of the last command that was a grab.
  bool last_grab_done = false;       ///< Whether it grabbed something.
  bool playing = false;
  double speed = 1;
  std::uint64_t step = 0;
  std::uint64_t last_step = 0;  ///< End of the timeline; beyond `step` after a rewind.
  double time = 0;              ///< [s]
  double step_seconds = 0;      ///< Length of a step [s].
  double step_ms = 0;           ///< Time that the last steps took, smoothed.
  bool holding = false;         ///< Whether the hand holds something.
  std::string held = {};        ///< Name of what it holds.
  DVec3 hand_place = {};        ///< The place that is held [m].
  DVec3 hand_target = {};       ///< Where the hand wants it [m].
  std::size_t undo_count = 0;   ///< Number of actions and edits that undo can take back.
  std::size_t redo_count = 0;   ///< Number of those that redo can do again.
  std::size_t moments = 0;      ///< States that the timeline holds.
  std::size_t timeline_bytes = 0;
  std::size_t timeline_budget = 0;      ///< [bytes]
  std::uint64_t timeline_interval = 0;  ///< Steps between states.
  std::string problem = {};             ///< Why it does not play on; empty for no problem.
  /// What the engine had to give up since the world was made, with what helps; a line each.
  std::vector<std::string> warnings = {};
  std::shared_ptr<const History> history = {};     ///< Figures over time; it goes on.
  std::vector<std::string> texture_warnings = {};  ///< Textures that could not be read; all so far.
  std::vector<std::string> droppable = {};         ///< Names that Drop takes.
  std::shared_ptr<const SceneState> picture = {};  ///< What to draw.
  std::shared_ptr<const Insight> insight = {};     ///< What to draw on top; null for nothing.
  /// Name and a place [m] of each object that is drawn: a body's origin, a middle or last point of others.
  std::vector<std::pair<std::string, DVec3>> places = {};
  /// When the view was made.
  std::chrono::steady_clock::time_point made = {};
};

/// How a session runs.
struct SessionOptions {
  bool playing = true;
  std::size_t timeline_budget = std::size_t{512} << 20;  ///< Memory for the timeline [bytes].
  std::optional<double> stop_time = {};                  ///< Pauses for good at this time [s].
};

/// Runs a simulation on a thread of its own, which loads it, steps it in real time and does what it is told.
/// All calls but wait_for return at once, whatever the thread is busy with.
class Session {
 public:
  /// `file` is the scene or model to open; it is read again whenever it is saved.
  Session(std::string file, Loader loader, const SessionOptions& options);
  /// Waits for the command or the step that runs; a scene that loads is loaded to its end. Commands that were
  /// not begun are not done.
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Hands over a command. Returns its number: it was done when SessionView::commands is at least that.
  std::uint64_t post(Command command);
  /// The latest view; never null.
  [[nodiscard]] std::shared_ptr<const SessionView> view() const;
  /// Waits until a view fulfills a condition, at most `seconds`, and returns the view then; for tests.
  std::shared_ptr<const SessionView> wait_for(const std::function<bool(const SessionView&)>& condition,
                                              double seconds) const;

 private:
  using WallClock = std::chrono::steady_clock;

  using LivePtr = std::unique_ptr<LiveScene>;

  void run();
  bool load();
  LivePtr build(SharedDocument document);
  void take(LivePtr live);
  void change_scene(std::vector<LivePtr>& from, std::vector<LivePtr>& to, const char* said);
  /// Reads the file again if it was saved, and returns whether it was.
  bool look_at_file();
  void play();
  /// Waits for commands, or for the time of the next step. Returns the commands.
  std::vector<Command> wait();
  void obey(const Command& command);
  void obey(const Action& action);
  void obey(const Play& play);
  void obey(const MakeSteps& steps);
  void obey(const SetSpeed& speed);
  void obey(const Seek& seek);
  void obey(const Undo& undo);
  void obey(const Redo& redo);
  void obey(const Restart& restart);
  void obey(const Open& open);
  void obey(const Reload& reload);
  void obey(const Change& change);
  void obey(const TurnModel& turn);
  void obey(const Save& save);
  void obey(const Select& select);
  void obey(const ShowInsight& show);
  void obey(const SaveFigures& save);
  void say(Outcome outcome);
  void replace(LivePtr live);
  void step();
  /// Whether the session is about to end.
  [[nodiscard]] bool is_ending() const;
  /// Measures the world and the selected object.
  void measure_all();
  /// Returns whether it made a step, or stopped for good.
  bool step_if_due();
  void publish();
  void publish(SessionView view);

  std::string file_;
  Loader loader_;
  SessionOptions options_;
  LivePtr live_;
  std::vector<LivePtr> past_;    ///< What edits and reloads replaced, the last one last.
  std::vector<LivePtr> future_;  ///< What undo replaced, likewise.
  FileWatch file_watch_;
  SharedDocument saved_;             ///< What the file says.
  WallClock::time_point next_look_;  ///< When to look at the file again.
  SceneCapture capture_;
  std::optional<RunWatch> warning_watch_;
  std::shared_ptr<History> history_ = std::make_shared<History>();
  InsightWish wish_;
  InsightMaker insight_;
  double shown_time_ = 0;      ///< Time of the last view [s].
  bool listed_anew_ = true;    ///< Whether commands may have changed the list of objects.
  SessionView state_;          ///< The next view, but for what follows from the scene.
  WallClock::time_point due_;  ///< When the next step is due.

  mutable std::mutex mutex_;  ///< Guards what follows.
  mutable std::condition_variable changed_;
  std::deque<Command> queue_;
  std::uint64_t posted_ = 0;
  bool ends_ = false;
  std::shared_ptr<const SessionView> view_;

  std::thread thread_;  ///< Comes last: it uses all of the above.
};

}  // namespace hooke::app
