#pragma once

#include "hooke/session/session.h"
#include "hooke/view/eye.h"

#include "render/orbit_camera.h"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hooke::app {

/// Turns what mouse and keys do into commands to a session, and into motions of the camera. It knows no
/// window: the window calls it with what happened since the last picture.
class ViewInput {
 public:
  enum class Button : std::uint8_t { kLeft, kRight, kMiddle };
  enum class Key : std::uint8_t {
    kPlay,      ///< Plays and pauses.
    kStep,      ///< One step on.
    kStepBack,  ///< One step back.
    kRestart,   ///< Back to the start.
    kSlower,    ///< Time passes half as fast.
    kFaster,    ///< Twice as fast.
    kShoot,     ///< Shoots a ball at what the mouse points at.
    kDrop,      ///< Drops a copy of the chosen object there.
    kPin,       ///< Pins or unpins what the mouse points at.
    kTie,       ///< The first time takes an end, the second time ties it to another.
    kRemove,    ///< Removes what the mouse points at.
    kCut,       ///< Takes the knife, or lays it down: the next drag is a cut.
    kRigid,     ///< Makes a model that is shown by itself a rigid body, or still again; so the next two.
    kJelly,
    kCloth,
    kUndo,       ///< Goes back to before the last action or edit.
    kRedo,       ///< Does again what was undone.
    kReload,     ///< Reads the file again.
    kInspector,  ///< Shows and hides the inspector.
    kLarger,     ///< Larger panels.
    kSmaller,    ///< Smaller panels.
    kContacts,   ///< Shows and hides contacts; the ones that follow do the same for their subjects.
    kVelocities,
    kBounds,
    kLoads,
    kHooks,
    kSleep,
    kRoutes,
    kNumbers,
    kHelp,   ///< Shows and hides the page of keys.
    kClose,  ///< Hides the page of keys, or closes the window; the second time if edits are not saved.
    kQuit,   ///< Closes the window likewise, whatever it shows.
  };
  /// One key of the page of keys.
  struct KeyHelp {
    const char* keys;
    const char* what;
  };

  ViewInput(Session& session, render::OrbitCamera& camera) : session_(session), camera_(camera) {}

  /// Says what is seen now, and where the mouse is. Call it first in each picture.
  void look(const Eye& eye, const SessionView& view, std::array<double, 2> mouse);
  void press(Button button);
  void release(Button button);
  /// The mouse wheel was turned by so many notches; positive is away from the user.
  void wheel(float notches);
  void key(Key key);
  /// Which object kDrop drops.
  void choose(std::string name) { chosen_ = std::move(name); }
  [[nodiscard]] const std::string& chosen() const { return chosen_; }

  /// A line about what waits for more input; empty for none.
  [[nodiscard]] std::string_view hint() const;
  /// The line of a cut while it is drawn [screen units].
  [[nodiscard]] std::optional<std::array<std::array<double, 2>, 2>> cut_line() const;
  [[nodiscard]] bool shows_help() const { return shows_help_; }
  [[nodiscard]] bool shows_inspector() const { return shows_inspector_; }
  /// The key of a subject of insight_choices().
  [[nodiscard]] static Key insight_key(std::size_t choice);
  /// What is shown besides objects.
  [[nodiscard]] const DebugDrawDesc& insight() const { return insight_.desc; }
  /// Size of the panels against what fits the window; 1 at the start.
  [[nodiscard]] float zoom() const { return zoom_; }
  [[nodiscard]] bool wants_to_close() const { return wants_to_close_; }
  /// Number of the last command.
  [[nodiscard]] std::uint64_t posted() const { return posted_; }
  /// Gives a command that comes from a button of the window.
  void post(Command command);

  /// The page of keys.
  [[nodiscard]] static std::span<const KeyHelp> help();

 private:
  /// What a pressed button does.
  enum class Drag : std::uint8_t {
    kNone,
    kAsks,  ///< The left button was pressed, and the session has not said yet whether something is there.
    kHand,  ///< It pulls what the hand holds.
    kTurn,  ///< It turns the camera.
    kPan,   ///< It moves the camera sideways.
    kCut,   ///< It draws the line of a cut.
  };

  /// Keys that concern the window and the scene as a whole.
  void window_key(Key key);
  /// Keys of what is shown besides objects. Returns whether it is one.
  bool toggle_insight(Key key);
  void drag_on(std::array<double, 2> motion);

  Session& session_;
  render::OrbitCamera& camera_;
  Eye eye_;
  bool playing_ = false;  ///< Whether it plays once the commands so far are done; likewise the next two.
  double speed_ = 1;
  std::uint64_t step_ = 0;
  std::array<double, 2> mouse_ = {};
  Drag drag_ = Drag::kNone;
  std::uint64_t grab_ = 0;              ///< Number of the command that asks.
  double depth_ = 1;                    ///< Depth at which the hand moves [m].
  std::array<double, 2> waiting_ = {};  ///< Motion of the mouse while it asks.
  std::optional<DVec3> sent_;           ///< Target that the hand was given last [m].
  std::optional<Ray> first_end_;        ///< First end of a string.
  bool has_knife_ = false;
  std::array<double, 2> cut_start_ = {};
  std::string chosen_;
  InsightWish insight_;
  bool shows_help_ = false;
  bool shows_inspector_ = true;
  float zoom_ = 1;
  bool edited_ = false;         ///< Whether edits are not saved.
  bool asks_to_close_ = false;  ///< Whether it was said that they would be lost.
  bool wants_to_close_ = false;
  std::uint64_t posted_ = 0;
  /// Number of the last command that may play, pause or go to another step: none that moves the hand.
  std::uint64_t awaited_ = 0;
};

}  // namespace hooke::app
