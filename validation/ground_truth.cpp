#include "validation/ground_truth.h"

#include "hooke/lab.h"

#include "validation/rig.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace hooke::check {

namespace {

constexpr double kFrame = 1.0 / 60;  ///< [s]
constexpr double kTolerance = 1e-10;
constexpr double kNudge = 1e-5;  ///< Displacement [m], a hundred times what a float rounds off a meter.

using Frames = std::array<std::vector<DVec3>, kTruthFrames.size()>;

double largest_distance(const std::vector<DVec3>& a, const std::vector<DVec3>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, length(a[i] - b[i]));
  return largest;
}

Frames exact_frames(const World& world) {
  auto run =
      must(lab::Run::create(world, {.stepper = "dormand_prince", .dt = kFrame, .tolerance = kTolerance}));
  Frames frames;
  int frame = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    for (; frame < kTruthFrames[i]; ++frame) must(run.advance());
    frames[i] = run.positions();
  }
  return frames;
}

Frames solver_frames(TruthStage stage) {
  Frames frames;
  int frame = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    for (; frame < kTruthFrames[i]; ++frame) stage.world.step(real(kFrame));
    frames[i] = stage.positions(stage.world);
  }
  return frames;
}

std::string centimeters(double meters) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g", 100 * meters);
  return text;
}

/// Returns the p of a difference that grows like t^p between 0.3 and 3 s.
std::string growth(const std::array<double, kTruthFrames.size()>& difference) {
  char text[40];
  std::snprintf(text, sizeof text, "%.1f", std::log10(difference[3] / difference[1]));
  return text;
}

}  // namespace

Truth ground_truth(const TruthScene& scene) {
  Truth truth{.scene = &scene};
  TruthStage stage = scene.make(kTruthSubsteps[0]);
  const Frames exact = exact_frames(stage.world);
  for (std::size_t s = 0; s < kTruthSubsteps.size(); ++s) {
    const Frames solver = solver_frames(scene.make(kTruthSubsteps[s]));
    for (std::size_t i = 0; i < exact.size(); ++i)
      truth.difference[s][i] = largest_distance(solver[i], exact[i]);
  }
  const DVec3 last = stage.positions(stage.world).back();
  must(stage.world.set_position(stage.last, last + DVec3{kNudge, kNudge, 0}));
  const double moved = length(stage.positions(stage.world).back() - last);
  truth.sensitivity = largest_distance(exact_frames(stage.world).back(), exact.back()) / moved;
  return truth;
}

std::string ground_truth_markdown() {
  std::ostringstream out;
  out << "# How far the solver is from the truth\n\n"
         "Small scenes without a closed form, by the real-time solver ("
      << (sizeof(Real) == sizeof(double) ? "double" : "float")
      << ", 60 Hz) and by SUNDIALS (Dormand-Prince,\n"
         "tolerance 1e-10, double; [laboratory](laboratory.md)): the largest distance in cm of any point "
         "from "
         "where it should\n"
         "be. Written by `hooke check --ground-truth --markdown docs/ground_truth.md`; what was let in is "
         "in\n"
         "[ground_truth_scenes.cpp](../validation/ground_truth_scenes.cpp). Contacts are not among "
         "them: the\n"
         "laboratory's own are of first order.\n\n"
         "\"Growth\" is the p of t^p between 0.3 and 3 s. \"Sensitivity\" is by how much the exact solution "
         "itself enlarges a\n"
         "small displacement of its last point in 3 s. Twice the substeps halve the difference of a "
         "first-order method.\n\n"
         "| scene | substeps | 0.1 s | 0.3 s | 1 s | 3 s | growth | sensitivity |\n"
         "|---|---|---|---|---|---|---|---|\n";
  std::string reasons;
  for (const TruthScene& scene : ground_truth_scenes()) {
    const Truth truth = ground_truth(scene);
    for (std::size_t s = 0; s < kTruthSubsteps.size(); ++s) {
      out << "| " << (s == 0 ? scene.name : "") << " | " << kTruthSubsteps[s] << " |";
      for (const double difference : truth.difference[s]) out << " " << centimeters(difference) << " |";
      char text[40];
      std::snprintf(text, sizeof text, "%.2g", truth.sensitivity);
      out << " " << growth(truth.difference[s]) << " | " << (s == 0 ? text : "") << " |\n";
    }
    reasons += "- " + scene.name + ": " + scene.reason + "\n";
  }
  out << "\n## Where the difference comes from\n\n" << reasons;
  return out.str();
}

}  // namespace hooke::check
