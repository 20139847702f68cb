#pragma once

#include "hooke/scene_io.h"
#include "hooke/world.h"

#include <nlohmann/json.hpp>
#include <span>

namespace hooke::app {

inline nlohmann::ordered_json json_of(const Energy& energy) {
  return {{"kinetic", energy.kinetic}, {"potential", energy.potential}, {"elastic", energy.elastic}};
}

inline nlohmann::ordered_json json_of(const Simulation& simulation, std::span<const SceneVerdict> verdicts) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const SceneVerdict& verdict : verdicts) {
    list.push_back({{"text", verdict.text},
                    {"achieved", verdict.achieved},
                    {"value", simulation.scene().expect[verdict.index].value},
                    {"step", verdict.step},
                    {"passed", verdict.passed}});
  }
  return list;
}

}  // namespace hooke::app
