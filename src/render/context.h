#pragma once

#include "hooke/result.h"

#include <cstdint>
#include <memory>
#include <string>

struct GLFWwindow;

namespace hooke::render {

struct ContextData;

/// A Context is an OpenGL 3.3 core context, with a window or without. Copies share it, and the last one
/// closes it. Only one thread at a time may use it.
class Context {
 public:
  /// Makes a context that draws without a display, by EGL on the surfaceless platform (Mesa). The Error is
  /// kUnsupported if the machine has none.
  static Result<Context> create_headless();

  /// Makes a resizable window, `width` by `height` in screen units. The Error is kUnsupported without a
  /// display. There may be one window at a time, because closing it ends the library of windows for all.
  static Result<Context> create_window(const std::string& title, int width, int height);

  /// Makes the context current in the calling thread; returns an Error if the driver refuses.
  [[nodiscard]] Result<void> make_current() const;

  /// Returns the window, for input; null for a headless context.
  [[nodiscard]] GLFWwindow* window() const;

  /// Returns the first error of OpenGL since the last call, and forgets it; 0 for none.
  [[nodiscard]] std::uint32_t take_error() const;

  /// Returns the driver's own name, for reports.
  [[nodiscard]] std::string driver() const;

 private:
  explicit Context(std::shared_ptr<ContextData> data) : data_(std::move(data)) {}

  std::shared_ptr<ContextData> data_;
};

}  // namespace hooke::render
