#pragma once

#include "hooke/hand.h"
#include "hooke/scene_io.h"
#include "hooke/session/action.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace hooke::app {

/// A state of a session that can be put back. It lies before the action number `actions` of the log.
struct Moment {
  SimulationSnapshot snapshot;
  Hand hand;
  std::uint64_t step = 0;
  std::size_t actions = 0;       ///< Number of actions of the log that were done by then.
  std::uint64_t added = 0;       ///< Number of objects that were added by then, for their names.
  SharedDocument document = {};  ///< The scene as it was edited by then.
  std::string before = {};       ///< The action that undo takes back from here; empty for none.
};

/// An action and the step before which it was done.
struct LoggedAction {
  std::uint64_t step = 0;
  Action action;
};

/// The past of a session: states within a memory budget, and every action. A state that lies between two
/// moments is made again from the one before, because the same actions give the same bits.
///
/// When the budget is used up, every second moment goes, and from then on they are taken half as often. The
/// first one stays, so that any step can be reached. Those that undo needs go last, the oldest first.
class Timeline {
 public:
  /// `budget` is the memory for moments [bytes].
  explicit Timeline(std::size_t budget) : budget_(budget) {}

  /// Whether a moment is due at this step.
  [[nodiscard]] bool is_due(std::uint64_t step) const;
  /// Adds a moment, which is not before the last one.
  void add(Moment moment);
  /// Notes that an action was done.
  void log(std::uint64_t step, Action action) { log_.push_back({step, std::move(action)}); }

  /// The first moment: the start. There is one from the first call of add() on.
  [[nodiscard]] const Moment& first() const { return moments_.front(); }
  /// The last moment at or before a step; null if there is none.
  [[nodiscard]] const Moment* find(std::uint64_t step) const;
  /// The last moment before whose action undo goes back, at or before a place of the log; null for none.
  [[nodiscard]] const Moment* find_undo(std::size_t actions) const;
  /// Forgets actions from number `actions` on, and moments after them or after `step`.
  void cut(std::uint64_t step, std::size_t actions);
  /// The actions from number `actions` on.
  [[nodiscard]] std::vector<LoggedAction> actions_from(std::size_t actions) const;
  /// Says that undo has used the moment before action number `actions`.
  void forget_undo(std::size_t actions);

  [[nodiscard]] const std::vector<LoggedAction>& actions() const { return log_; }
  [[nodiscard]] std::size_t moments() const { return moments_.size(); }
  [[nodiscard]] std::size_t undo_count(std::size_t actions) const;
  [[nodiscard]] std::size_t bytes() const { return bytes_; }
  [[nodiscard]] std::size_t budget() const { return budget_; }
  /// Number of steps between moments.
  [[nodiscard]] std::uint64_t interval() const { return interval_; }

 private:
  void thin_out();
  bool drop_oldest_undo();
  void count_bytes();

  std::size_t budget_;
  std::size_t bytes_ = 0;
  std::uint64_t interval_ = 5;
  std::vector<Moment> moments_;  ///< In order of step, then of actions.
  std::vector<LoggedAction> log_;
};

}  // namespace hooke::app
