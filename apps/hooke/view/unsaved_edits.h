#pragma once

namespace hooke::app {

class Session;

/// Keeps edits of a scene that were not saved where the window ends without asking: an error, or a display
/// that is lost, at which its library ends the program by exit(). Then the edited scene is written beside the
/// scene's file, as NAME-unsaved.json, and a line on the standard error says so. There is one at a time.
class UnsavedEdits {
 public:
  explicit UnsavedEdits(const Session& session);
  ~UnsavedEdits();
  UnsavedEdits(const UnsavedEdits&) = delete;
  UnsavedEdits& operator=(const UnsavedEdits&) = delete;

  /// Says that the user chose to close the window: nothing is kept.
  void forget();
};

}  // namespace hooke::app
