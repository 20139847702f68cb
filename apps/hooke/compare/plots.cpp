#include "hooke/compare/plots.h"

#include "hooke/text_of.h"

#include "process/child.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <sys/wait.h>
#include <utility>

namespace hooke::app {

namespace {

constexpr std::size_t kMostPoints = 1500;  // Points of a curve; this is more than there are pixels.
constexpr std::chrono::seconds kLongestDrawing{60};

// People with color blindness, too, can tell the first six apart (Okabe and Ito).
constexpr std::array<const char*, 12> kColors = {"#D55E00", "#0072B2", "#009E73", "#CC79A7",
                                                 "#E69F00", "#56B4E9", "#8A6D00", "#7F3FBF",
                                                 "#B22222", "#5F7F7F", "#FF69B4", "#7FA32F"};
constexpr const char* kReferenceColor = "#000000";

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, FileCloser>;

PlotPoint span_of(const std::vector<Sample>& samples, int axis) {
  PlotPoint span = {1e300, -1e300};
  for (const Sample& sample : samples) {
    const double value = component(sample.position, axis);
    span = {std::min(span.x, value), std::max(span.y, value)};
  }
  return span;
}

/// Returns every n-th sample as a point by `point`.
template <class Point>
std::vector<PlotPoint> thin(const std::vector<Sample>& samples, const Point& point) {
  std::vector<PlotPoint> points;
  const std::size_t stride = samples.size() / kMostPoints + 1;
  for (std::size_t i = 0; i < samples.size(); i += stride) points.push_back(point(samples[i]));
  return points;
}

/// Returns the range `span`, larger by `margin` of its size or of `least` on both sides.
PlotPoint widened(PlotPoint span, double margin, double least) {
  const double more = margin * std::max(span.y - span.x, least);
  return {span.x - more, span.y + more};
}

const std::vector<Sample>& guide_of(const Comparison& comparison) {
  const auto& reference = comparison.reference.samples;
  return reference.empty() ? comparison.trials.front().samples : reference;
}

/// Returns the steppers' curves, and after them the reference's.
template <class Point>
std::vector<PlotCurve> curves_of(const Comparison& comparison, bool with_reference, const Point& point) {
  std::vector<PlotCurve> curves;
  for (std::size_t i = 0; i < comparison.trials.size(); ++i) {
    const Trial& trial = comparison.trials[i];
    curves.push_back({.title = trial.name, .color = color_of_run(i), .points = thin(trial.samples, point)});
  }
  if (!with_reference || comparison.reference.samples.empty()) return curves;
  curves.push_back({.title = "reference",
                    .color = kReferenceColor,
                    .dashed = true,
                    .points = thin(comparison.reference.samples, point)});
  if (!comparison.rigid) return curves;
  std::vector<Sample> rigid = comparison.reference.samples;
  for (Sample& sample : rigid) {
    sample.position = comparison.rigid->position(sample.time);
    sample.energy = comparison.rigid->energy(sample.time);
  }
  curves.push_back({.title = "rigid rod", .color = "#888888", .dashed = true, .points = thin(rigid, point)});
  return curves;
}

Plot trajectory_plot(const Comparison& comparison) {
  const std::vector<Sample>& guide = guide_of(comparison);
  const PlotPoint x = span_of(guide, 0);
  const PlotPoint z = span_of(guide, 2);
  const int side = z.y - z.x > x.y - x.x ? 2 : 0;
  const double extent = comparison.reference.extent;
  return {.name = "trajectory",
          .title = "Path of " + comparison.point,
          .caption = "The way of the watched point. Curves that leave the picture diverge.",
          .x = {.label = side == 0 ? "x [m]" : "z [m]", .range = widened(side == 0 ? x : z, 0.3, extent)},
          .y = {.label = "y [m]", .range = widened(span_of(guide, 1), 0.3, extent)},
          .same_scale = true,
          .curves = curves_of(comparison, true, [side](const Sample& sample) -> PlotPoint {
            return {component(sample.position, side), sample.position.y};
          })};
}

Plot position_plot(const Comparison& comparison) {
  const std::vector<Sample>& guide = guide_of(comparison);
  int axis = 0;
  for (int other = 1; other < 3; ++other) {
    const PlotPoint best = span_of(guide, axis);
    const PlotPoint span = span_of(guide, other);
    if (span.y - span.x > best.y - best.x) axis = other;
  }
  const char letter = "xyz"[axis];
  return {.name = "position",
          .title = std::string(1, letter) + " of " + comparison.point + " over time",
          .caption = "The coordinate that moves most.",
          .x = {.label = "time [s]", .range = PlotPoint{0, comparison.seconds}},
          .y = {.label = std::string(1, letter) + " [m]",
                .range = widened(span_of(guide, axis), 0.3, 0.1 * comparison.reference.extent)},
          .curves = curves_of(comparison, true, [axis](const Sample& sample) -> PlotPoint {
            return {sample.time, component(sample.position, axis)};
          })};
}

Plot error_plot(const Comparison& comparison) {
  return {
      .name = "error",
      .title = "Distance from " + comparison.reference.title,
      .caption =
          "How far the watched point is from the reference. Logarithmic: equal heights are equal factors.",
      .x = {.label = "time [s]", .range = PlotPoint{0, comparison.seconds}},
      .y = {.label = "error [m]", .logarithmic = true},
      .curves = curves_of(comparison, false, [](const Sample& sample) -> PlotPoint {
        return {sample.time, sample.error};
      })};
}

Plot energy_plot(const Comparison& comparison) {
  PlotPoint span = {1e300, -1e300};
  double kinetic = 0;
  for (const Sample& sample : guide_of(comparison)) {
    const double total = sample.energy.total();
    span = {std::min(span.x, total), std::max(span.y, total)};
    kinetic = std::max(kinetic, sample.energy.kinetic);
  }
  return {
      .name = "energy",
      .title = "Total energy",
      .caption = "Kinetic, potential and elastic together. What rises without a push is made by the method.",
      .x = {.label = "time [s]", .range = PlotPoint{0, comparison.seconds}},
      .y = {.label = "energy [J]", .range = widened(span, 0.6, std::max(kinetic, 1e-9))},
      .curves = curves_of(comparison, true, [](const Sample& sample) -> PlotPoint {
        return {sample.time, sample.energy.total()};
      })};
}

/// Returns the measured errors over what `x` makes of a trial and a step.
template <class X>
std::vector<PlotCurve> order_curves(const Comparison& comparison, const X& x) {
  std::vector<PlotCurve> curves;
  for (std::size_t i = 0; i < comparison.trials.size(); ++i) {
    const Trial& trial = comparison.trials[i];
    if (!trial.limits.order) continue;
    const lab::OrderMeasurement& order = *trial.limits.order;
    const std::optional<double> measured = order_of(trial, comparison);
    PlotCurve curve = {.title = trial.name + (measured ? text_of(", order %.2f", *measured) : ""),
                       .color = color_of_run(i),
                       .marked = true};
    for (std::size_t k = 0; k < order.dt.size(); ++k) {
      // A run that has diverged would leave no room for the others.
      const bool shown = order.error[k] < 10 * comparison.reference.extent;
      if (shown) curve.points.push_back({x(trial, order.dt[k]), order.error[k]});
    }
    curves.push_back(std::move(curve));
  }
  return curves;
}

Plot order_plot(const Comparison& comparison) {
  return {
      .name = "order",
      .title = "Error against step",
      .caption =
          "After at most one second. The slope is the order: halving the step divides the error by 2^order.",
      .x = {.label = "step [s]", .logarithmic = true},
      .y = {.label = "error [m]", .logarithmic = true},
      .curves = order_curves(comparison, [](const Trial&, double dt) { return dt; })};
}

Plot cost_plot(const Comparison& comparison) {
  return {.name = "cost",
          .title = "Error against cost",
          .caption = "The same runs by what they cost. Further left is cheaper, further down is better.",
          .x = {.label = "evaluations of the forces per simulated second", .logarithmic = true},
          .y = {.label = "error [m]", .logarithmic = true},
          .curves = order_curves(comparison, [&](const Trial& trial, double dt) {
            return evaluations_at(trial, comparison.dt, dt);
          })};
}

/// Returns a text as gnuplot reads it, without markup.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') result += '\'';
    result += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return result + "'";
}

std::string axis_script(const char* letter, const PlotAxis& axis) {
  std::string text = text_of("set %slabel ", letter) + quoted(axis.label) + "\n";
  if (axis.logarithmic) text += text_of("set logscale %s\nset format %s '10^{%%L}'\n", letter, letter);
  if (axis.range) text += text_of("set %srange [%.9g:%.9g]\n", letter, axis.range->x, axis.range->y);
  return text;
}

std::string script_of(const Plot& plot, PlotFormat format) {
  std::string text =
      format == PlotFormat::kSvg
          ? "set terminal svg size 860,470 enhanced font 'DejaVu Sans,13' name " + quoted(plot.name)
          : "set terminal pngcairo size 1290,705 enhanced font 'DejaVu Sans,15' linewidth 1.4";
  text += "\nset encoding utf8\nset border 3 linecolor '#444444'\nset tics nomirror\n";
  text += "set grid linecolor '#dddddd' linewidth 1\nset key outside right top Left reverse noenhanced\n";
  text += "set title " + quoted(plot.title) + " noenhanced\n";
  text += axis_script("x", plot.x) + axis_script("y", plot.y);
  if (plot.same_scale) text += "set size ratio -1\n";
  std::string command;
  for (std::size_t i = 0; i < plot.curves.size(); ++i) {
    const PlotCurve& curve = plot.curves[i];
    text += text_of("$curve%zu << END\n", i);
    for (const PlotPoint& point : curve.points) {
      const bool shown = std::isfinite(point.x) && std::isfinite(point.y);
      if (shown) text += text_of("%.9g %.9g\n", point.x, point.y);
    }
    text += "END\n";
    command +=
        text_of("%s$curve%zu using 1:2 with %s linewidth %s linecolor '%s'%s%s title ", i > 0 ? ", " : "", i,
                curve.marked ? "linespoints" : "lines", curve.dashed ? "1.2" : "2", curve.color.c_str(),
                curve.dashed ? " dashtype 2" : "", curve.marked ? " pointtype 7 pointsize 0.6" : "");
    command += quoted(curve.title);
  }
  return text + "plot " + command + "\n";
}

std::string text_of_file(std::FILE* file) {
  std::string text;
  std::array<char, 65536> part{};
  std::rewind(file);
  while (const std::size_t size = std::fread(part.data(), 1, part.size(), file))
    text.append(part.data(), size);
  return text;
}

bool has_points(const Plot& plot) {
  return std::any_of(plot.curves.begin(), plot.curves.end(), [&](const PlotCurve& curve) {
    return std::any_of(curve.points.begin(), curve.points.end(), [&](const PlotPoint& point) {
      return std::isfinite(point.x) && std::isfinite(point.y) && (!plot.y.logarithmic || point.y > 0);
    });
  });
}

}  // namespace

const char* color_of_run(std::size_t number) {
  return kColors[number % kColors.size()];
}

std::vector<Plot> plots_of(const Comparison& comparison) {
  std::vector<Plot> plots;
  if (comparison.trials.empty()) return plots;
  for (Plot& plot : std::array{trajectory_plot(comparison), position_plot(comparison), error_plot(comparison),
                               energy_plot(comparison), order_plot(comparison), cost_plot(comparison)}) {
    if (has_points(plot)) plots.push_back(std::move(plot));
  }
  return plots;
}

Result<std::string> draw_plot(const Plot& plot, PlotFormat format) {
  const File script(std::tmpfile());
  const File picture(std::tmpfile());
  const File messages(std::tmpfile());
  if (!script || !picture || !messages) {
    return Error{ErrorCode::kFileNotWritable, plot.name, "no room for temporary files"};
  }
  const std::string text = script_of(plot, format);
  std::fwrite(text.data(), 1, text.size(), script.get());
  std::rewind(script.get());
  // The option -d ignores the user's start-up file, which must not change the picture.
  auto gnuplot = process::Child::start(
      {"gnuplot", "-d"}, {::fileno(script.get()), ::fileno(picture.get()), ::fileno(messages.get())});
  if (!gnuplot) {
    return Error{ErrorCode::kUnsupported, "gnuplot",
                 "cannot start the program: " + gnuplot.error().message + " (Debian: package gnuplot-nox)"};
  }
  const auto status = gnuplot.value().wait_until(std::chrono::steady_clock::now() + kLongestDrawing);
  std::string bytes = text_of_file(picture.get());
  if (status && WIFEXITED(*status) && WEXITSTATUS(*status) == 0 && !bytes.empty()) return bytes;
  std::string reason = status ? text_of_file(messages.get()) : "took too long";
  std::replace(reason.begin(), reason.end(), '\n', ' ');
  return Error{ErrorCode::kUnsupported, "gnuplot", "cannot draw '" + plot.name + "': " + reason};
}

}  // namespace hooke::app
