#include "validation/ground_truth.h"

#include "hooke/lab.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <string_view>

using hooke::check::ground_truth;
using hooke::check::ground_truth_scenes;
using hooke::check::kTruthFrames;
using hooke::check::kTruthSubsteps;
using hooke::check::Truth;
using hooke::check::TruthScene;

namespace {

bool has_sundials() {
  return hooke::lab::find_stepper("dormand_prince").value().available;
}

Truth truth_of(std::string_view start) {
  const auto& scenes = ground_truth_scenes();
  return ground_truth(*std::find_if(scenes.begin(), scenes.end(),
                                    [&](const TruthScene& scene) { return scene.name.starts_with(start); }));
}

double substep(std::size_t s) {
  return 1.0 / 60 / kTruthSubsteps[s];
}

}  // namespace

TEST_SUITE("check/ground_truth") {
  TEST_CASE("a charge stays on its circle, shifted by less than v h") {
    if (!has_sundials()) return;
    const Truth truth = truth_of("charge");
    for (std::size_t s = 0; s < kTruthSubsteps.size(); ++s) {
      for (const double difference : truth.difference[s]) CHECK(difference < substep(s));
      CHECK(truth.difference[s][2] > 0.5 * substep(s));
    }
    CHECK(truth.sensitivity == doctest::Approx(1).epsilon(0.01));
  }

  TEST_CASE(
      "a damped oscillator differs by the omega h / 2 that is added to its damping, and by half a step") {
    if (!has_sundials()) return;
    const Truth truth = truth_of("damped");
    const double omega = 10;
    for (std::size_t s = 0; s < kTruthSubsteps.size(); ++s) {
      for (std::size_t i = 0; i < kTruthFrames.size(); ++i) {
        const double t = kTruthFrames[i] / 60.0;
        const double left = 0.2 * std::exp(-0.05 * omega * t);
        CHECK(truth.difference[s][i] < left * omega * substep(s) / 2 * (omega * t + 1));
      }
    }
  }

  TEST_CASE("a planet is first-order ahead on its orbit") {
    if (!has_sundials()) return;
    const Truth truth = truth_of("planet");
    for (std::size_t i = 0; i < kTruthFrames.size(); ++i) {
      CHECK(truth.difference[0][i] / truth.difference[1][i] == doctest::Approx(2).epsilon(0.05));
    }
    CHECK(truth.difference[0][3] < 0.02);
  }
}
