#pragma once

#include "hooke/scene_io.h"

#include <doctest/doctest.h>
#include <utility>

namespace hooke::app {

/// Builds a scene from its text; a mistake fails the test.
inline Simulation simulation_of(const char* text) {
  Loaded<Scene> scene = parse_scene(text, "scene.json");
  for (const Error& error : scene.errors) FAIL(to_line(error));
  Loaded<Simulation> simulation = Simulation::create(std::move(*scene.value));
  for (const Error& error : simulation.errors) FAIL(to_line(error));
  return std::move(*simulation.value);
}

}  // namespace hooke::app
