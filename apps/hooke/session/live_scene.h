#pragma once

#include "hooke/hand.h"
#include "hooke/scene_io.h"
#include "hooke/session/action.h"
#include "hooke/session/timeline.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace hooke::app {

/// A simulation that can be played, touched, rewound and undone, on one thread. Session runs it on a thread
/// of its own.
///
/// After a rewind, steps repeat what happened, with all actions, up to the last step that was made. The first
/// new action forgets what came after it.
class LiveScene {
 public:
  /// `budget` is the memory for the timeline [bytes]. `document` is what the simulation was made from; edits
  /// need it.
  LiveScene(Simulation simulation, std::size_t budget, SharedDocument document = nullptr);

  /// Does an action now. What failed changes nothing.
  Outcome act(const Action& action);
  /// Makes one step. The Error says that the world did not move.
  Result<void> step();
  /// Goes to a step that was made; a later one counts as the last one. It ends early, without an Error, once
  /// `stops` returns true, which it asks before each step. The Error says that the world did not move on.
  Result<void> seek(std::uint64_t step, const std::function<bool()>& stops = {});
  /// Goes back to before the last action that was not undone: a whole grip from grab to release counts as
  /// one.
  Outcome undo();
  /// Goes on to where the last undo was called, and does again what it took back. A new action forgets what
  /// was undone.
  Outcome redo();
  /// Forgets what was undone, as a new action does.
  void forget_undone() { undone_.clear(); }
  /// Goes back to the start, and forgets everything but edits of the scene.
  void restart();

  [[nodiscard]] const Simulation& simulation() const { return simulation_; }
  [[nodiscard]] const Timeline& timeline() const { return timeline_; }
  [[nodiscard]] const Hand& hand() const { return hand_; }
  [[nodiscard]] std::uint64_t step_count() const { return simulation_.world().step_count(); }
  /// The last step that was made.
  [[nodiscard]] std::uint64_t last_step() const { return last_step_; }
  /// Number of actions that undo can take back.
  [[nodiscard]] std::size_t undo_count() const { return timeline_.undo_count(next_action_); }
  /// Number of actions that redo can do again.
  [[nodiscard]] std::size_t redo_count() const { return undone_.size(); }
  /// The scene as it is edited now; null without one.
  [[nodiscard]] const SharedDocument& document() const { return document_; }
  /// Name of the object that a ray meets first; empty for none.
  [[nodiscard]] std::string name_at(const Ray& ray) const;
  /// Name of the object that the hand holds; empty for none.
  [[nodiscard]] std::string held() const;
  /// Returns why the hand lost what it held in a step since the last call; nothing for no such case.
  [[nodiscard]] std::optional<std::string> take_lost() { return std::exchange(lost_, std::nullopt); }
  /// Report of the last step.
  [[nodiscard]] const StepReport& report() const { return report_; }

 private:
  /// What a ray meets.
  struct Target {
    BodyId body = {};
    PointRef point = {};
    DVec3 place = {};
    std::string name = {};
  };

  /// What undo took back.
  struct Undone {
    Moment before;                      ///< The moment that undo went to.
    Moment after;                       ///< The state in which undo was called.
    std::vector<LoggedAction> actions;  ///< Those that were done after `before`.
    std::uint64_t last_step = 0;
  };

  [[nodiscard]] Moment moment(std::string_view before) const;
  void go_to(const Moment& moment);
  void repeat_actions();
  Outcome perform(const Action& action);
  Outcome perform(const Grab& grab);
  Outcome perform(const MoveHand& move);
  Outcome perform(const Release& release);
  Outcome perform(const Shoot& shoot);
  Outcome perform(const Drop& drop);
  Outcome perform(const Pin& pin);
  Outcome perform(const Tie& tie);
  Outcome perform(const Remove& remove);
  Outcome perform(const Cut& cut);
  Outcome perform(const Edit& edit);
  Outcome pin_body(const Target& target);
  Outcome add(const SceneObjects& objects, const std::string& text);
  [[nodiscard]] std::optional<Target> find(const Ray& ray) const;
  [[nodiscard]] std::string name_of(BodyId body, PointRef point) const;
  [[nodiscard]] std::string new_name(std::string_view kind);

  Simulation simulation_;
  Hand hand_;
  Timeline timeline_;
  SharedDocument document_;
  std::vector<Undone> undone_;   ///< Redo takes the last one.
  std::size_t next_action_ = 0;  ///< Number of actions of the log that were done.
  std::uint64_t last_step_ = 0;
  std::uint64_t added_ = 0;
  StepReport report_;
  std::optional<std::string> lost_;  ///< Why the hand lost what it held.
};

}  // namespace hooke::app
