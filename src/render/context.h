#pragma once

#include "hooke/result.h"

#include <memory>
#include <string>

struct GLFWwindow;

namespace hooke::render {

struct ContextData;

/// An OpenGL 3.3 core context, with a window or without. Copies share it; the last one closes it. It belongs
/// to the thread that uses it: one thread at a time.
class Context {
 public:
  /// Draws without a display: EGL on the surfaceless platform (Mesa). kUnsupported if the machine has none.
  static Result<Context> create_headless();

  /// A window that can be resized, `width` by `height` in screen units. kUnsupported without a display.
  /// One window at a time: closing it ends the window system's library for all.
  static Result<Context> create_window(const std::string& title, int width, int height);

  /// Makes the context the calling thread's current one; an Error if the driver refuses.
  [[nodiscard]] Result<void> make_current() const;

  /// The window, for input; null for a headless context.
  [[nodiscard]] GLFWwindow* window() const;

  /// The driver's own name, for reports.
  [[nodiscard]] std::string driver() const;

 private:
  explicit Context(std::shared_ptr<ContextData> data) : data_(std::move(data)) {}

  std::shared_ptr<ContextData> data_;
};

}  // namespace hooke::render
