#include "render/renderer.h"
#include "render/scene.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

/// Writes the scene as a picture: `render_demo FILE.png FRAMES`. It also prints the driver and the time of a
/// frame.
int main(int argument_count, char** arguments) {
  using Clock = std::chrono::steady_clock;
  const std::string path = argument_count > 1 ? arguments[1] : "render_demo.png";
  const auto fail = [](const hooke::Error& error) {
    std::fprintf(stderr, "%s: %s\n", error.where.c_str(), error.message.c_str());
    return 1;
  };
  const auto context = hooke::render::Context::create_headless();
  if (!context) return fail(context.error());
  auto renderer = hooke::render::Renderer::create(context.value());
  if (!renderer) return fail(renderer.error());
  const int frames = argument_count > 2 ? std::max(std::atoi(arguments[2]), 1) : 2;
  const auto start = Clock::now();
  for (int i = 0; i < frames; ++i) {
    const auto drawn = renderer.value().draw(hooke::render_test::make_scene(0.02F * static_cast<float>(i)));
    if (!drawn) return fail(drawn.error());
    const auto image = renderer.value().read_image();
    if (!image) return fail(image.error());
  }
  const std::chrono::duration<double, std::milli> spent = Clock::now() - start;
  std::printf("%s, %.1f ms a frame\n", context.value().driver().c_str(), spent.count() / frames);
  const auto image = renderer.value().read_image();
  if (!image) return fail(image.error());
  const auto written = hooke::render::write_png(image.value(), path);
  return written ? 0 : fail(written.error());
}
