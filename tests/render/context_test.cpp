#include "render/context.h"

#include "render/renderer.h"

#include <cstdlib>
#include <doctest/doctest.h>

using hooke::ErrorCode;
using hooke::render::Context;

TEST_SUITE("render/context") {
  TEST_CASE("a window without a display is an error") {
    const char* display = std::getenv("DISPLAY");
    const std::string old = display != nullptr ? display : "";
    ::unsetenv("DISPLAY");
    ::unsetenv("WAYLAND_DISPLAY");
    const auto window = Context::create_window("none", 100, 100);
    REQUIRE_FALSE(window);
    CHECK(window.error().code == ErrorCode::kUnsupported);
    if (!old.empty()) ::setenv("DISPLAY", old.c_str(), 1);
  }

  // Run alone with __EGL_VENDOR_LIBRARY_DIRS set to an empty folder: EGL reads it once per process.
  TEST_CASE("a machine without a driver gives an error") {
    if (std::getenv("__EGL_VENDOR_LIBRARY_DIRS") == nullptr) return;
    const auto context = Context::create_headless();
    REQUIRE_FALSE(context);
    CHECK(context.error().code == ErrorCode::kUnsupported);
  }

  TEST_CASE("two contexts live side by side, and a renderer keeps its own alive") {
    auto first = Context::create_headless();
    if (!first) {
      MESSAGE("skipped: " << first.error().message);
      return;
    }
    auto renderer = hooke::render::Renderer::create(first.value(), {64, 64});
    REQUIRE(renderer);
    {
      const auto second = Context::create_headless();
      REQUIRE(second);
      CHECK(hooke::render::Renderer::create(second.value(), {32, 32}));
    }
    first = hooke::Error{};
    CHECK(renderer.value().draw({}));
    const auto image = renderer.value().read_image();
    REQUIRE(image);
    // The sky is never black.
    CHECK(image.value().pixels[2] > 50);
  }
}
