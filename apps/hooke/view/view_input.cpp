#include "hooke/view/view_input.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hooke::app {

namespace {

constexpr float kRadiansPerPixel = 0.006F;
constexpr float kZoomPerNotch = 0.9F;
constexpr float kZoomPerKey = 1.25F;
constexpr float kLargestZoom = 4;
/// Radius [m] and speed [m/s] of a ball for each meter between the camera and what it turns about, within
/// bounds: a scene of a doll's house and one of a town both want balls that fit.
constexpr double kBallRadius = 0.015;
constexpr double kBallSpeed = 3;

constexpr ViewInput::KeyHelp kHelp[] = {
    {"left drag", "grabs what is under the mouse and throws it; on nothing it turns the camera"},
    {"right drag", "turns the camera"},
    {"middle drag", "moves the camera sideways"},
    {"wheel", "zooms; while something is held, it moves it away and nearer"},
    {"space", "plays and pauses"},
    {"S, right", "pauses and makes one step"},
    {"left", "pauses and goes one step back"},
    {"-, +", "half and double speed"},
    {"R", "goes back to the start"},
    {"U, Ctrl+Z", "goes back to before the last grab, shot, drop, pin, string, cut, removal or edit"},
    {"Ctrl+Y", "does again what was undone"},
    {"F5", "reads the scene's file again, as happens whenever it is saved"},
    {"I", "shows and hides the inspector: objects, their values, scenes to open"},
    {"1", "contacts: normals green, forces red, friction yellow; an arrow is as long as its force is large,"},
    {"", "the largest of the last seconds 0.12 of the way from the eye to what it turns about"},
    {"2", "velocities: the way in 0.1 s"},
    {"3", "boxes around shapes and deformables"},
    {"4", "loads: tensions and strains as colors"},
    {"5", "hooks: places, gaps, axes"},
    {"6", "who sleeps"},
    {"7", "which way contacts and hooks are solved"},
    {"8", "numbers beside 1, 2, 4 and 5; \"asleep\" beside 6"},
    {"Ctrl +, Ctrl -", "larger and smaller panels"},
    {"B", "shoots a ball at what is under the mouse"},
    {"D", "drops a copy of the chosen object there"},
    {"P", "pins what is under the mouse, or lets it go"},
    {"H", "ties: once at each end of a string"},
    {"C", "takes the knife: the next drag draws the line of a cut"},
    {"Delete", "removes what is under the mouse"},
    {"G, J, K", "make a model that was opened by itself a rigid body, jelly, cloth; again: still"},
    {"?, F1", "shows and hides this page"},
    {"Escape", "closes this page, or the window; twice if edits are not saved"},
};

/// By subject of insight_choices().
constexpr ViewInput::Key kInsightKeys[] = {ViewInput::Key::kContacts, ViewInput::Key::kVelocities,
                                           ViewInput::Key::kBounds,   ViewInput::Key::kLoads,
                                           ViewInput::Key::kHooks,    ViewInput::Key::kSleep,
                                           ViewInput::Key::kRoutes,   ViewInput::Key::kNumbers};

}  // namespace

std::span<const ViewInput::KeyHelp> ViewInput::help() {
  return kHelp;
}

void ViewInput::look(const Eye& eye, const SessionView& view, std::array<double, 2> mouse) {
  const std::array<double, 2> motion = {mouse[0] - mouse_[0], mouse[1] - mouse_[1]};
  eye_ = eye;
  mouse_ = mouse;
  edited_ = view.edited;
  asks_to_close_ = asks_to_close_ && edited_;
  // A view that was made before the last command was done knows less than what was typed since.
  if (view.commands >= awaited_) {
    playing_ = view.playing;
    speed_ = view.speed;
    step_ = view.step;
  }
  if (chosen_.empty() && !view.droppable.empty()) chosen_ = view.droppable.front();
  if (drag_ == Drag::kAsks && view.last_grab >= grab_) {
    const bool holds = view.last_grab == grab_ && view.last_grab_done;
    drag_ = holds ? Drag::kHand : Drag::kTurn;
    depth_ = depth_of(eye_, view.hand_place);
    sent_.reset();
    if (drag_ == Drag::kTurn) drag_on(std::exchange(waiting_, {}));
  }
  drag_on(motion);
}

void ViewInput::post(Command command) {
  const auto* const action = std::get_if<Action>(&command);
  const bool is_move = action != nullptr && std::holds_alternative<MoveHand>(*action);
  posted_ = session_.post(std::move(command));
  if (!is_move) awaited_ = posted_;
}

void ViewInput::drag_on(std::array<double, 2> motion) {
  const auto x = static_cast<float>(motion[0]);
  const auto y = static_cast<float>(motion[1]);
  const auto height = static_cast<float>(eye_.size[1]);
  switch (drag_) {
    case Drag::kNone:
    case Drag::kCut:
      break;
    case Drag::kAsks:
      waiting_ = {waiting_[0] + motion[0], waiting_[1] + motion[1]};
      break;
    case Drag::kHand: {
      const DVec3 target = place_at(eye_, mouse_, depth_);
      if (sent_ != target) post(Action(MoveHand{target}));
      sent_ = target;
      break;
    }
    case Drag::kTurn:
      render::turn(camera_, -kRadiansPerPixel * x, kRadiansPerPixel * y);
      break;
    case Drag::kPan:
      render::pan(camera_, x / height, -y / height);
      break;
  }
}

void ViewInput::press(Button button) {
  asks_to_close_ = false;
  if (drag_ != Drag::kNone) return;
  if (button == Button::kRight) drag_ = Drag::kTurn;
  if (button == Button::kMiddle) drag_ = Drag::kPan;
  if (button != Button::kLeft) return;
  if (std::exchange(has_knife_, false)) {
    cut_start_ = mouse_;
    drag_ = Drag::kCut;
    return;
  }
  post(Action(Grab{ray_through(eye_, mouse_)}));
  grab_ = posted_;
  waiting_ = {};
  drag_ = Drag::kAsks;
}

void ViewInput::release(Button button) {
  const bool was_left = drag_ == Drag::kAsks || drag_ == Drag::kHand;
  const bool cuts = drag_ == Drag::kCut;
  const bool ends = button == Button::kLeft ? was_left || cuts || drag_ == Drag::kTurn
                                            : drag_ == Drag::kTurn || drag_ == Drag::kPan;
  if (!ends) return;
  if (cuts && cut_start_ != mouse_)
    post(Action(Cut{ray_through(eye_, cut_start_), ray_through(eye_, mouse_)}));
  if (was_left) post(Action(Release{}));
  drag_ = Drag::kNone;
}

void ViewInput::wheel(float notches) {
  if (notches == 0) return;
  if (drag_ == Drag::kHand) {
    depth_ *= std::pow(static_cast<double>(kZoomPerNotch), -static_cast<double>(notches));
    drag_on({});
  } else {
    render::zoom(camera_, std::pow(kZoomPerNotch, notches));
  }
}

void ViewInput::key(Key key) {
  const Ray ray = ray_through(eye_, mouse_);
  const auto distance = static_cast<double>(camera_.distance);
  if (key != Key::kTie) first_end_.reset();
  if (key != Key::kClose && key != Key::kQuit) asks_to_close_ = false;
  const bool had_knife = key != Key::kCut && std::exchange(has_knife_, false);
  if (had_knife && key == Key::kClose) return;
  switch (key) {
    case Key::kPlay:
      playing_ = !playing_;
      return post(Play{playing_});
    case Key::kStep:
      playing_ = false;
      ++step_;
      return post(MakeSteps{1});
    case Key::kStepBack:
      playing_ = false;
      if (step_ > 0) --step_;
      return post(Seek{step_});
    case Key::kRestart:
      step_ = 0;
      return post(Restart{});
    case Key::kSlower:
      speed_ = std::max(speed_ / 2, kLeastSpeed);
      return post(SetSpeed{speed_});
    case Key::kFaster:
      speed_ = std::min(speed_ * 2, kMostSpeed);
      return post(SetSpeed{speed_});
    case Key::kShoot:
      return post(Action(Shoot{.ray = ray,
                               .speed = std::clamp(kBallSpeed * distance, 2.0, 100.0),
                               .radius = std::clamp(kBallRadius * distance, 0.002, 1.0)}));
    case Key::kDrop:
      return post(Action(Drop{.object = chosen_, .ray = ray, .distance = distance}));
    case Key::kPin:
      return post(Action(Pin{ray}));
    case Key::kTie:
      if (first_end_) post(Action(Tie{*first_end_, ray}));
      first_end_ = first_end_ ? std::nullopt : std::optional(ray);
      return;
    case Key::kRemove:
      return post(Action(Remove{ray}));
    case Key::kCut:
      has_knife_ = !has_knife_;
      return;
    case Key::kRigid:
      return post(TurnModel{ModelForm::kRigid});
    case Key::kJelly:
      return post(TurnModel{ModelForm::kJelly});
    case Key::kCloth:
      return post(TurnModel{ModelForm::kCloth});
    case Key::kUndo:
      return post(Undo{});
    default:
      return window_key(key);
  }
}

bool ViewInput::toggle_insight(Key key) {
  const auto* const found = std::find(std::begin(kInsightKeys), std::end(kInsightKeys), key);
  if (found == std::end(kInsightKeys)) return false;
  bool& chosen = insight_.desc.*insight_choices()[static_cast<std::size_t>(found - kInsightKeys)].shown;
  chosen = !chosen;
  insight_.arrow = kArrowShare * static_cast<double>(camera_.distance);
  post(ShowInsight{insight_});
  return true;
}

void ViewInput::window_key(Key key) {
  if (toggle_insight(key)) return;
  switch (key) {
    case Key::kRedo:
      return post(Redo{});
    case Key::kReload:
      return post(Reload{});
    case Key::kInspector:
      shows_inspector_ = !shows_inspector_;
      return;
    case Key::kLarger:
      zoom_ = std::min(zoom_ * kZoomPerKey, kLargestZoom);
      return;
    case Key::kSmaller:
      zoom_ = std::max(zoom_ / kZoomPerKey, 1 / kLargestZoom);
      return;
    case Key::kHelp:
      shows_help_ = !shows_help_;
      return;
    case Key::kClose:
      if (std::exchange(shows_help_, false)) return;
      [[fallthrough]];
    case Key::kQuit:
      wants_to_close_ = !edited_ || asks_to_close_;
      asks_to_close_ = true;
      return;
    default:
      return;
  }
}

ViewInput::Key ViewInput::insight_key(std::size_t choice) {
  return kInsightKeys[choice];
}

std::string_view ViewInput::hint() const {
  if (asks_to_close_) return "Edits are not saved. Escape again closes the window without them";
  if (has_knife_) return "Drag a line across what is to be cut; C puts the knife away";
  return first_end_ ? "Point at the other end of the string and press H" : "";
}

std::optional<std::array<std::array<double, 2>, 2>> ViewInput::cut_line() const {
  if (drag_ != Drag::kCut) return {};
  return std::array{cut_start_, mouse_};
}

}  // namespace hooke::app
