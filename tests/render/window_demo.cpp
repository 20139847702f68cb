#include "hooke/view_window.h"

#include "render/scene.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

/// Shows the scene in a window beside a spring and mass integrated here: `render_window_demo PICTURES`, 0 is
/// until closed.
int main(int argument_count, char** arguments) {
  // A mass on a vertical spring by the symplectic Euler method: its energies wander, their sum stays.
  struct Oscillator {
    double height = 0;
    double velocity = 0;
    double time = 0;
  };
  constexpr double kStep = 1.0 / 60;
  constexpr double kGravity = 9.81;
  constexpr double kStiffness = 40;
  Oscillator mass;
  hooke::app::ViewModel model;
  model.step_seconds = kStep;
  model.advance = [&]() -> hooke::Result<void> {
    mass.velocity -= kStep * (kGravity + kStiffness * mass.height);
    mass.height += kStep * mass.velocity;
    mass.time += kStep;
    return {};
  };
  model.reset = [&]() -> hooke::Result<void> {
    mass = {};
    return {};
  };
  model.fill = [&](hooke::render::DrawList& list, double /*blend*/) {
    list = hooke::render_test::make_scene(static_cast<float>(mass.time));
    list.texts.clear();
    list.spheres.push_back({{0.2F, 1.9F + static_cast<float>(mass.height), 0.8F}, 0.12F, {0.8F, 0.3F, 0.3F}});
  };
  model.energies = [&]() -> hooke::app::Energies {
    return {0.5 * mass.velocity * mass.velocity, kGravity * mass.height,
            0.5 * kStiffness * mass.height * mass.height};
  };
  model.time = [&] { return mass.time; };
  hooke::app::ViewOptions options;
  options.max_frames = argument_count > 1 ? std::atoi(arguments[1]) : 0;
  const auto shown = hooke::app::run_view(model, options);
  if (shown) return 0;
  std::fprintf(stderr, "%s: %s\n", shown.error().where.c_str(), shown.error().message.c_str());
  return 1;
}
