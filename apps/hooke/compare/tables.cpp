#include "hooke/compare/tables.h"

#include "hooke/text_of.h"

#include <algorithm>
#include <cmath>

namespace hooke::app {

namespace {

constexpr double kRounding = 1e-11;  // Share of the extent; errors below it are sums of roundings.

/// Returns text such as "1.23e-05"; "any" for infinity; "-" for what is not known.
std::string word(double value) {
  if (std::isnan(value)) return "-";
  if (std::isinf(value)) return "any";
  return text_of("%.3g", value);
}

std::string word(const std::optional<double>& value) {
  return value ? word(*value) : "-";
}

std::string number(const std::optional<double>& value) {
  return value ? text_of("%.9g", *value) : "";
}

/// Returns text such as "measured (theory)".
std::string pair(const std::optional<double>& measured, const std::optional<double>& theory) {
  if (!measured && !theory) return "-";
  // Both mean that there is no limit; the bisection itself ends at a finite value.
  const auto any = [](const std::optional<double>& value) { return value && std::isinf(*value); };
  if (any(measured) && any(theory)) return "any";
  const auto none = [](const std::optional<double>& value) { return value && !(*value > 0); };
  if (none(measured) && none(theory)) return "none";
  return word(measured) + " (" + word(theory) + ")";
}

std::optional<double> theory_of(const Trial& trial) {
  return trial.limits.order_in_theory > 0 ? std::optional<double>(trial.limits.order_in_theory)
                                          : std::nullopt;
}

/// Returns the energy of the last sample minus the reference's at the same time [J].
std::optional<double> energy_error(const Trial& trial, const Comparison& comparison) {
  const std::size_t count = trial.samples.size();
  if (count == 0 || comparison.reference.samples.size() < count) return std::nullopt;
  return trial.samples.back().energy.total() - comparison.reference.samples[count - 1].energy.total();
}

std::string order_word(const Trial& trial, const Comparison& comparison) {
  const std::optional<double> order = order_of(trial, comparison);
  if (!order && !theory_of(trial)) return "-";
  const std::string theory = theory_of(trial) ? text_of(" (%.0f)", *theory_of(trial)) : "";
  return (order ? text_of("%.2f", *order) : "-") + theory;
}

}  // namespace

Table summary_table(const Comparison& comparison) {
  const bool collide = std::any_of(comparison.trials.begin(), comparison.trials.end(),
                                   [](const Trial& trial) { return trial.collisions.candidates > 0; });
  Table table = {{"stepper", "order", "largest error [m]", "error at end [m]", "energy off [J]",
                  "evaluations /s", "ms /s", "largest k [N/m]", "largest omega dt", "diverged at [s]"}};
  if (collide) table[0].insert(table[0].end(), {"pairs asked", "pairs touching"});
  for (const Trial& trial : comparison.trials) {
    const Limits& limits = trial.limits;
    const double last = trial.samples.empty() ? std::nan("") : trial.samples.back().error;
    table.push_back({trial.name, order_word(trial, comparison), word(trial.largest_error), word(last),
                     word(energy_error(trial, comparison)), text_of("%.0f", trial.evaluations),
                     text_of("%.3g", trial.cost_ms), pair(limits.stiffness, limits.stiffness_in_theory),
                     pair(limits.step, limits.step_in_theory), word(trial.diverged_at)});
    if (collide) {
      table.back().insert(table.back().end(), {std::to_string(trial.collisions.candidates),
                                               std::to_string(trial.collisions.touching)});
    }
  }
  return table;
}

std::string summary_csv(const Comparison& comparison) {
  std::string text =
      "stepper,order,order_theory,largest_error_m,final_error_m,energy_error_J,evaluations_per_s,cost_ms_per_"
      "s,"
      "largest_stiffness_N_per_m,largest_stiffness_theory_N_per_m,largest_omega_dt,largest_omega_dt_theory,"
      "diverged_at_s,pairs_asked,pairs_touching\n";
  for (const Trial& trial : comparison.trials) {
    const Limits& limits = trial.limits;
    const std::optional<double> last =
        trial.samples.empty() ? std::nullopt : std::optional<double>(trial.samples.back().error);
    const std::initializer_list<std::optional<double>> numbers = {
        order_of(trial, comparison),     theory_of(trial),  trial.largest_error,   last,
        energy_error(trial, comparison), trial.evaluations, trial.cost_ms,         limits.stiffness,
        limits.stiffness_in_theory,      limits.step,       limits.step_in_theory, trial.diverged_at};
    text += trial.name;
    for (const std::optional<double>& value : numbers) text += "," + number(value);
    text += "," + std::to_string(trial.collisions.candidates) + "," +
            std::to_string(trial.collisions.touching) + "\n";
  }
  return text;
}

std::string text_of_table(const Table& table) {
  std::vector<std::size_t> widths;
  for (const auto& row : table) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : table) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string space(widths[i] - row[i].size(), ' ');
      text += i == 0 ? row[i] + space : "  " + space + row[i];
    }
    text += "\n";
  }
  return text;
}

std::string series_csv(const std::vector<Sample>& samples) {
  std::string text = "time_s,x_m,y_m,z_m,error_m,kinetic_J,potential_J,elastic_J,total_J\n";
  for (const Sample& s : samples) {
    text += text_of("%.9g,%.15g,%.15g,%.15g,%.9g,%.9g,%.9g,%.9g,%.12g\n", s.time, s.position.x, s.position.y,
                    s.position.z, s.error, s.energy.kinetic, s.energy.potential, s.energy.elastic,
                    s.energy.total());
  }
  return text;
}

std::string order_csv(const Comparison& comparison) {
  std::string text = "stepper,dt_s,error_m,evaluations_per_s\n";
  for (const Trial& trial : comparison.trials) {
    if (!trial.limits.order) continue;
    const lab::OrderMeasurement& order = *trial.limits.order;
    for (std::size_t i = 0; i < order.dt.size(); ++i) {
      text += trial.name + text_of(",%.9g,%.9g,%.9g\n", order.dt[i], order.error[i],
                                   evaluations_at(trial, comparison.dt, order.dt[i]));
    }
  }
  return text;
}

double evaluations_at(const Trial& trial, double comparison_dt, double dt) {
  return trial.evaluations * comparison_dt / dt;
}

std::optional<double> order_of(const Trial& trial, const Comparison& comparison) {
  if (trial.diverged_at || !trial.limits.order) return std::nullopt;
  const lab::OrderMeasurement& measured = *trial.limits.order;
  for (std::size_t i = measured.error.size(); i-- > 1;) {
    const double coarse = measured.error[i - 1];
    const double fine = measured.error[i];
    if (!(fine > kRounding * comparison.reference.extent)) continue;
    const bool falls = fine < 0.8 * coarse && fine < 0.1 * comparison.reference.extent;
    if (!falls) return std::nullopt;
    return std::log(coarse / fine) / std::log(measured.dt[i - 1] / measured.dt[i]);
  }
  return std::nullopt;
}

/// Returns why a run diverged, as far as the growth of small motions explains it.
static std::string reason_of(const Trial& trial, const Comparison& comparison) {
  const MethodGrowth* method = comparison.stability.find(trial.name);
  if (method == nullptr || !method->worst) return "";
  const double size = std::abs(*method->worst);
  if (!(method->worst_growth > 1 + 1e-9)) {
    return ": small motions do not grow by this method, so that large ones or contacts must be the cause";
  }
  const std::string& stiffest = comparison.stability.system.stiffest;
  const bool is_fastest = size > 0.999 * comparison.dt * comparison.stability.system.omega;
  std::string text = text_of(": an oscillation of omega = %.4g/s", size / comparison.dt);
  if (is_fastest && !stiffest.empty()) text += " (" + stiffest + ")";
  return text + text_of(", h omega = %.4g, ", size) + method->consequence;
}

std::string verdict_of(const Trial& trial, const Comparison& comparison) {
  if (trial.diverged_at) {
    const std::string note = trial.note.empty() ? "" : " (" + trial.note + ")";
    return text_of("diverges; at %.3g s it is gone", *trial.diverged_at) + note +
           reason_of(trial, comparison);
  }
  if (comparison.reference.samples.empty()) return "stays finite";
  std::string text = text_of("is at most %.2g m off", trial.largest_error);
  if (comparison.max_error) {
    text += trial.largest_error <= *comparison.max_error ? ", within" : ", not within";
    text += text_of(" the declared %.2g m", *comparison.max_error);
  }
  return trial.note.empty() ? text : text + " (" + trial.note + ")";
}

}  // namespace hooke::app
