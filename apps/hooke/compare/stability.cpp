#include "hooke/compare/stability.h"

#include "hooke/text_of.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hooke::app {

namespace {

constexpr double kNeutral = 1e-9;  // Growth that counts as none.
constexpr double kSame = 1e-4;     // Relative distance below which two eigenvalues are one.
// Share of the largest eigenvalue beyond which a real part is no rounding of single precision.
constexpr double kGrowsItself = 1e-3;
constexpr std::size_t kMostDots = 400;
constexpr double kCurveEnd = 4;  // Largest omega h of the curve.
constexpr double kCurveStep = 0.05;
constexpr int kBisections = 20;
constexpr double kColumn = 0.05;  // Distance of the places that are tried before bisection.

bool is_near(std::complex<double> a, std::complex<double> b, double scale) {
  return std::abs(a - b) <= kSame * std::abs(b) + 1e-9 * scale;
}

/// Takes over the eigenvalues of one object, without conjugates and doubles.
void add_eigenvalues(const lab::Spectrum& spectrum, double dt, SystemMotion& system) {
  if (spectrum.eigenvalues.empty()) return;
  const double scale = dt * std::abs(spectrum.eigenvalues.front());
  if (scale > dt * system.omega) {
    system.omega = scale / dt;
    system.stiffest = spectrum.stiffest;
  }
  system.bounded = system.bounded || spectrum.bounded;
  std::complex<double> last = {1e300, 0};
  for (const std::complex<double> lambda : spectrum.eigenvalues) {
    const std::complex<double> z = {dt * lambda.real(), dt * std::abs(lambda.imag())};
    if (z.real() > kGrowsItself * scale) system.grows = true;
    if (is_near(z, last, scale)) continue;
    const bool known = std::any_of(system.z.begin(), system.z.end(),
                                   [&](const auto& other) { return is_near(z, other, scale); });
    if (!known && system.z.size() < kMostDots) system.z.push_back(z);
    last = z;
  }
}

SystemMotion study_system(const Stage& stage) {
  SystemMotion system;
  const auto run = make_stage_run(stage, "rk4", stage.dt(), true);
  if (!run) {
    system.left_out.push_back("the whole scene: " + run.error().where + " " + run.error().message);
    return system;
  }
  for (const lab::ObjectReport& report : run.value().report()) {
    for (const SceneObject& object : stage.start.objects()) {
      if (!is_of(report, object)) continue;
      for (const std::string& what : report.left_out) system.left_out.push_back(object.name + ": " + what);
    }
  }
  for (const lab::Spectrum& spectrum : run.value().spectra()) add_eigenvalues(spectrum, stage.dt(), system);
  std::stable_sort(system.z.begin(), system.z.end(),
                   [](const auto& a, const auto& b) { return std::abs(a) > std::abs(b); });
  if (!system.z.empty() && std::abs(system.z.front()) > 0)
    system.zeta = std::max(0.0, -system.z.front().real() / std::abs(system.z.front()));
  return system;
}

double growth_at(const std::string& name, std::complex<double> z) {
  const auto growth = lab::growth_at(name, z);
  return growth ? growth.value() : 0;
}

/// Returns the measured growth; that of the formula where no steps can be made, as of motions that grow.
double measured_at(const std::string& name, std::complex<double> z) {
  const double size = std::abs(z);
  const auto measured = lab::measured_growth(name, size, size > 0 ? std::max(0.0, -z.real() / size) : 0);
  return measured && z.real() <= 0 ? measured.value() : growth_at(name, z);
}

/// Returns the real part between `stable` and `unstable` where the method begins to be unstable.
double edge_between(const std::string& name, double imaginary, double stable, double unstable) {
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (stable + unstable);
    (growth_at(name, {middle, imaginary}) <= 1 + kNeutral ? stable : unstable) = middle;
  }
  return stable;
}

std::vector<StableSpan> stable_spans(const std::string& name) {
  using Window = StabilityWindow;
  std::vector<StableSpan> spans;
  for (double y = Window::kBandHeight / 2; y < Window::kTop; y += Window::kBandHeight) {
    bool inside = false;
    double before = Window::kLeft;
    const int columns = static_cast<int>((Window::kRight - Window::kLeft) / kColumn + 0.5);
    for (int i = 0; i <= columns; ++i) {
      const double x = Window::kLeft + i * kColumn;
      const bool stable = growth_at(name, {x, y}) <= 1 + kNeutral;
      if (stable && !inside)
        spans.push_back({y, i > 0 ? edge_between(name, y, x, before) : x, Window::kRight});
      if (!stable && inside) spans.back().to = edge_between(name, y, before, x);
      inside = stable;
      before = x;
    }
  }
  return spans;
}

MethodGrowth study_method(const lab::StepperInfo& info, const SystemMotion& system, const Stage& stage) {
  MethodGrowth method = {.info = info};
  if (info.adaptive) {
    method.consequence = "chooses its own steps by a tolerance, and so stays stable";
    return method;
  }
  const std::string name(info.name);
  for (int i = 1; i * kCurveStep <= kCurveEnd + 1e-9; ++i) {
    const double omega_dt = i * kCurveStep;
    const auto growth = lab::measured_growth(name, omega_dt, 0);
    if (growth) method.curve.push_back({omega_dt, growth.value()});
  }
  method.stable = stable_spans(name);
  for (const std::complex<double> z : system.z) {
    if (z.real() > kNeutral) continue;  // It grows by itself, whatever the method.
    const double growth = growth_at(name, z);
    if (method.worst && !(growth > method.worst_growth + kNeutral)) continue;
    method.worst = z;
    method.worst_growth = growth;
  }
  if (!method.worst) return method;
  method.undamped = measured_at(name, {0, stage.dt() * system.omega});
  method.worst_growth = measured_at(name, *method.worst);
  method.consequence = consequence_of(method.worst_growth, *method.worst, stage.dt(), stage.scene().seconds);
  return method;
}

}  // namespace

const MethodGrowth* Stability::find(const std::string& name) const {
  const auto found =
      std::find_if(methods.begin(), methods.end(), [&](const auto& one) { return one.info.name == name; });
  return found == methods.end() ? nullptr : &*found;
}

std::string consequence_of(double growth, std::complex<double> z, double dt, double seconds) {
  const double exact = std::exp(z.real());
  const double steps = std::log(10.0) / std::abs(std::log(growth));
  if (growth > 1 + kNeutral) {
    const std::string text = text_of("grows by the factor %.6g a step: 10 times after %.3g steps, %.3g s",
                                     growth, steps, steps * dt);
    return steps * dt > 20 * seconds ? text + ", too slowly to be seen here" : text;
  }
  if (growth > 1 - kNeutral) {
    return exact < 1 - 1e-6 ? text_of("neither grows nor fades, though it should fade by %.6g a step", exact)
                            : "neither grows nor fades";
  }
  const std::string text = text_of("fades by the factor %.6g a step: to a tenth after %.3g steps, %.3g s",
                                   growth, steps, steps * dt);
  return text + (exact > 1 - 1e-6 ? ", though nothing brakes it" : text_of("; exactly it is %.6g", exact));
}

std::string text_of_motion(const SystemMotion& system, double dt) {
  if (!(system.omega > 0)) return "Nothing in the scene swings by itself near its start.";
  const double period = 2 * std::numbers::pi / system.omega;
  std::string text =
      system.bounded ? "No oscillation of the scene is faster than" : "The fastest motion of the scene has";
  text += text_of(" omega = %.4g/s (a period of %.3g s), with a damping ratio of %.3g. ", system.omega,
                  period, system.zeta);
  text += text_of("A step of h = %.4g s makes that h omega = %.4g", dt, dt * system.omega);
  text += text_of(", or %.3g steps a period.", period / dt);
  if (!system.stiffest.empty()) text += " The stiffest part is " + system.stiffest + ".";
  if (system.grows) {
    text +=
        " Some motion of the scene grows by itself, as from an unstable equilibrium; any method follows it.";
  }
  return text;
}

Stability study_stability(const Stage& stage, const std::vector<std::string>& names) {
  Stability stability = {.system = study_system(stage), .methods = {}};
  for (const std::string& name : names) {
    const auto info = lab::find_stepper(name);
    if (info) stability.methods.push_back(study_method(info.value(), stability.system, stage));
  }
  return stability;
}

}  // namespace hooke::app
