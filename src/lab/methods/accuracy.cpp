#include "lab/methods/growth.h"
#include "lab/methods/part.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace hooke::lab {

namespace {

constexpr int kMostCuts = 14;             ///< The smallest step is dt / 16384.
constexpr double kMostEvaluations = 1e6;  ///< Evaluations of one trial.
constexpr double kImplicitCost = 10;      ///< Cost of a Newton step, in evaluations.
constexpr double kReserve = 0.5;          ///< Share of the allowed error that the estimate may use up.
constexpr int kStiffCuts = 6;  ///< Implicit methods are tried if rk4 needs more than 2^6 steps per output.

struct Trial {
  std::vector<std::vector<DVec3>> outputs;
  double cost = 0;
};

/// Runs `part` with its dt divided into `steps_per_output` steps; returns nothing if it fails.
std::optional<Trial> try_run(Part part, const Method& method, int steps_per_output, int outputs) {
  const double dt = part.h;
  part.method = &method;
  part.steps_per_output = steps_per_output;
  part.h = dt / steps_per_output;
  const std::uint64_t before = part.system.evaluations();
  Trial trial;
  for (int i = 0; i < outputs; ++i) {
    if (!advance(part)) return std::nullopt;
    trial.outputs.push_back(part.system.positions(part.time(), part.y));
  }
  trial.cost =
      static_cast<double>(part.system.evaluations() - before) * (method.info.implicit ? kImplicitCost : 1);
  return trial;
}

double largest_difference(const Trial& a, const Trial& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.outputs.size(); ++i) {
    for (std::size_t j = 0; j < a.outputs[i].size(); ++j)
      largest = std::max(largest, length(a.outputs[i][j] - b.outputs[i][j]));
  }
  return largest;
}

struct Choice {
  const Method* method = nullptr;
  int steps_per_output = 1;
  double error = 0;
  double cost = 0;
};

/// Returns the least number of halvings of dt at which the method is stable.
int first_cut(const Part& part, const Method& method) {
  for (int cut = 0; cut <= kMostCuts; ++cut) {
    Part finer = part;
    finer.method = &method;
    finer.h = part.h / (1 << cut);
    if (check(finer, {})) return cut;
  }
  return kMostCuts + 1;
}

/// Applies Richardson's estimate: halving the step of a method of order p leaves 1 / (2^p - 1) of the
/// difference. With bodies around, the motion is not smooth, and p is taken as 1.
std::optional<Choice> try_method(const Part& part, const Method& method, const Accuracy& accuracy,
                                 int outputs) {
  const double share = std::pow(2.0, part.bodies.entries.empty() ? method.info.order : 1) - 1;
  std::optional<Trial> coarse;
  for (int cut = first_cut(part, method); cut <= kMostCuts; ++cut) {
    const int steps = 1 << cut;
    if (static_cast<double>(outputs) * steps * std::max(1, method.info.evaluations) > kMostEvaluations) break;
    std::optional<Trial> fine = try_run(part, method, steps, outputs);
    if (coarse && fine) {
      const double error = largest_difference(*coarse, *fine) / share;
      if (error <= kReserve * accuracy.max_error) return Choice{&method, steps, error, fine->cost};
    }
    coarse = std::move(fine);
  }
  return std::nullopt;
}

}  // namespace

Result<void> reach(const Accuracy& accuracy, const Options& options, Part& part) {
  const int outputs = static_cast<int>(std::clamp(std::ceil(accuracy.seconds / options.dt), 1.0, 1e7));
  std::vector<const Method*> candidates = {find_method("verlet"), find_method("rk4")};
  if (first_cut(part, *find_method("rk4")) > kStiffCuts) candidates.push_back(find_method("bdf2"));
  std::optional<Choice> best;
  for (const Method* method : candidates) {
    const std::optional<Choice> choice = try_method(part, *method, accuracy, outputs);
    if (choice && (!best || choice->cost < best->cost)) best = choice;
  }
  if (!best) {
    char text[160];
    std::snprintf(text, sizeof(text), "%g m over %g s was not reached for %s with %d steps per dt",
                  accuracy.max_error, accuracy.seconds, part.system.name().c_str(), 1 << kMostCuts);
    return Error{ErrorCode::kLimitExceeded, "accuracy", text};
  }
  part.method = best->method;
  part.steps_per_output = best->steps_per_output;
  part.h = options.dt / best->steps_per_output;
  part.error_estimate = best->error;
  return {};
}

}  // namespace hooke::lab
