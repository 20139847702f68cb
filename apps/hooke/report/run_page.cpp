#include "hooke/report/run_page.h"

#include "hooke/text_of.h"
#include "hooke/version.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>

namespace hooke::app {

namespace {

constexpr std::uint64_t kSamples = 600;
constexpr std::size_t kMostRows = 50;  ///< Of a table; the report in JSON has all.

constexpr std::string_view kRunStyle = R"(
body { font: 16px/1.5 system-ui, "DejaVu Sans", sans-serif; color: #222; background: #fff;
       max-width: 1000px; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.6rem; margin-bottom: 0; }
h2 { font-size: 1.2rem; margin-top: 2.2rem; }
p.about { color: #555; margin-top: .3rem; }
table { border-collapse: collapse; font-size: .85rem; font-variant-numeric: tabular-nums; }
th, td { padding: .3rem .6rem; text-align: right; border-bottom: 1px solid #ddd; }
th:first-child, td:first-child { text-align: left; }
.fail { color: #b00020; } .pass { color: #1a6b2d; }
svg { max-width: 100%; height: auto; }
)";

std::string html_of(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '&') {
      result += "&amp;";
    } else if (c == '<') {
      result += "&lt;";
    } else if (c == '>') {
      result += "&gt;";
    } else {
      result += c;
    }
  }
  return result;
}

/// A line of a plot over time.
struct TimeCurve {
  const char* title;
  const char* color;
  std::function<double(const RunSample&)> value;
};

/// Draws curves over time as SVG, with a frame, the ends of both axes and a legend.
std::string svg_of(const std::vector<RunSample>& samples, const std::vector<TimeCurve>& curves,
                   const char* unit) {
  constexpr double kLeft = 90, kTop = 30, kWide = 780, kHigh = 240;
  double low = 0;
  double high = 0;
  for (const RunSample& sample : samples) {
    for (const TimeCurve& curve : curves) {
      low = std::min(low, curve.value(sample));
      high = std::max(high, curve.value(sample));
    }
  }
  if (!(high > low)) high = low + 1;
  const double end = std::max(samples.back().time, 1e-9);
  const auto x = [&](double time) { return kLeft + kWide * time / end; };
  const auto y = [&](double value) { return kTop + kHigh * (high - value) / (high - low); };
  std::string text = text_of(
      "<svg viewBox=\"0 0 900 320\" font-size=\"13\" font-family=\"sans-serif\">"
      "<rect x=\"%g\" y=\"%g\" width=\"%g\" height=\"%g\" fill=\"none\" stroke=\"#888\"/>",
      kLeft, kTop, kWide, kHigh);
  for (const double value : {low, high, 0.0}) {
    text += text_of("<text x=\"%g\" y=\"%.1f\" text-anchor=\"end\">%.4g %s</text>", kLeft - 6, y(value) + 4,
                    value, value == high ? unit : "");
  }
  text += text_of("<line x1=\"%g\" y1=\"%.1f\" x2=\"%g\" y2=\"%.1f\" stroke=\"#ccc\"/>", kLeft, y(0),
                  kLeft + kWide, y(0));
  text +=
      text_of("<text x=\"%g\" y=\"290\">0 s</text><text x=\"%g\" y=\"290\" text-anchor=\"end\">%.4g s</text>",
              kLeft, kLeft + kWide, end);
  double legend = kLeft;
  for (const TimeCurve& curve : curves) {
    text += text_of("<polyline fill=\"none\" stroke-width=\"1.6\" stroke=\"%s\" points=\"", curve.color);
    for (const RunSample& sample : samples)
      text += text_of("%.1f,%.1f ", x(sample.time), y(curve.value(sample)));
    text += text_of("\"/><text x=\"%g\" y=\"20\" fill=\"%s\">%s</text>", legend, curve.color, curve.title);
    legend += 130;
  }
  return text + "</svg>\n";
}

std::string plots_of_run(const std::vector<RunSample>& samples) {
  if (samples.size() < 2) return "<p>Too few steps for plots.</p>\n";
  return "<h2>Energy</h2>\n" +
         svg_of(samples,
                {{"kinetic", "#D55E00", [](const RunSample& s) { return s.energy.kinetic; }},
                 {"potential", "#0072B2", [](const RunSample& s) { return s.energy.potential; }},
                 {"elastic", "#009E73", [](const RunSample& s) { return s.energy.elastic; }},
                 {"total", "#000000", [](const RunSample& s) { return s.energy.total(); }}},
                "J") +
         "<h2>Momentum</h2>\n" +
         svg_of(samples, {{"momentum", "#CC79A7", [](const RunSample& s) { return s.momentum; }}}, "kg m/s") +
         svg_of(samples,
                {{"angular momentum", "#8A6D00", [](const RunSample& s) { return s.angular_momentum; }}},
                "kg m²/s") +
         "<h2>Contacts</h2>\n" +
         svg_of(samples, {{"contacts", "#56B4E9", [](const RunSample& s) { return s.contacts; }}}, "");
}

/// What broke, in order of time.
std::string breaks_of_run(const Simulation& simulation) {
  const std::vector<const SceneObject*> broken = broken_objects(simulation);
  if (broken.empty()) return "<p>Nothing broke, tore or was cut.</p>\n";
  std::string text =
      "<table><tr><th>what</th><th>time [s]</th><th>needed [N]</th><th>torque [N m]</th><th></th></tr>\n";
  for (std::size_t i = 0; i < std::min(broken.size(), kMostRows); ++i) {
    const SceneObject& one = *broken[i];
    const bool is_surface = one.kind == SceneObject::Kind::kCloth || one.kind == SceneObject::Kind::kSolid;
    text += "<tr><td>" + html_of(one.name) + (i == 0 ? " (first)" : "") +
            text_of("</td><td>%.4f</td>", one.broke.time);
    if (is_surface || !one.cut_by.empty()) {
      text += "<td></td><td></td><td>";
      text += one.cut_by.empty() ? text_of("tore at %.4g %s", static_cast<double>(one.tore_at),
                                           one.kind == SceneObject::Kind::kCloth ? "strain" : "Pa")
                                 : "cut by " + html_of(one.cut_by);
      text += "</td></tr>\n";
    } else {
      text += text_of("<td>%.6g</td><td>%.4g</td><td></td></tr>\n", static_cast<double>(one.broke.force),
                      static_cast<double>(one.broke.torque));
    }
  }
  text += "</table>\n";
  if (broken.size() > kMostRows) text += text_of("<p>and %zu more</p>\n", broken.size() - kMostRows);
  return text;
}

std::string supports_of_run(const RunSeries& series) {
  if (series.supports().empty())
    return "<p>No hook holds anything to the world or to a body that does not move.</p>\n";
  std::vector<const SupportLoad*> rows;
  for (const SupportLoad& one : series.supports()) rows.push_back(&one);
  std::stable_sort(rows.begin(), rows.end(),
                   [](const SupportLoad* a, const SupportLoad* b) { return a->largest > b->largest; });
  std::string text =
      "<table><tr><th>hook</th><th>force at the end, x y z [N]</th><th>largest [N]</th><th>at "
      "[s]</th></tr>\n";
  for (std::size_t i = 0; i < std::min(rows.size(), kMostRows); ++i) {
    const SupportLoad& one = *rows[i];
    text += "<tr><td>" + html_of(one.name) +
            text_of("</td><td>%.5g %.5g %.5g</td><td>%.6g</td><td>%.4f</td></tr>\n",
                    static_cast<double>(one.last.x), static_cast<double>(one.last.y),
                    static_cast<double>(one.last.z), one.largest, one.largest_time);
  }
  text += "</table>\n";
  if (rows.size() > kMostRows) text += text_of("<p>and %zu more</p>\n", rows.size() - kMostRows);
  return text;
}

/// The lines of Simulation::report, colored by their first word.
std::string promises_of_run(const Simulation& simulation) {
  std::istringstream lines(simulation.report());
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    const char* kind = line.starts_with("pass")   ? " class=\"pass\""
                       : line.starts_with("FAIL") ? " class=\"fail\""
                                                  : "";
    text += std::string("<li") + kind + ">" + html_of(line) + "</li>\n";
  }
  return text.empty() ? "<p>The scene promises nothing.</p>\n" : "<ul>\n" + text + "</ul>\n";
}

std::string list_of(const std::vector<std::string>& lines, const char* none) {
  if (lines.empty()) return std::string("<p>") + none + "</p>\n";
  std::string text = "<ul>\n";
  for (const std::string& line : lines) text += "<li>" + html_of(line) + "</li>\n";
  return text + "</ul>\n";
}

}  // namespace

RunSeries::RunSeries(const Simulation& simulation, std::uint64_t steps)
    : interval_(std::max<std::uint64_t>(1, steps / kSamples)) {
  const World& world = simulation.world();
  std::set<std::string> moving;
  for (const SceneObject& object : simulation.objects()) {
    if (object.kind != SceneObject::Kind::kBody || world.mass(object.body) > Real(0))
      moving.insert(object.name);
  }
  for (const SceneObject& object : simulation.objects()) {
    if (object.kind != SceneObject::Kind::kHook || object.broken) continue;
    const bool is_support = std::any_of(object.hooked.begin(), object.hooked.end(),
                                        [&](const std::string& name) { return !moving.contains(name); });
    if (is_support) supports_.push_back({.name = object.name, .hook = object.hook});
  }
}

void RunSeries::look(const Simulation& simulation, std::uint32_t contacts) {
  const World& world = simulation.world();
  for (SupportLoad& one : supports_) {
    one.last = world.hook_force(one.hook).force;
    const auto size = static_cast<double>(length(one.last));
    if (!(size > one.largest)) continue;
    one.largest = size;
    one.largest_time = world.time();
  }
  if (steps_++ % interval_ != 0) return;
  const Measurement measured = world.measure();
  samples_.push_back({.time = world.time(),
                      .energy = measured.energy,
                      .momentum = length(measured.momentum),
                      .angular_momentum = length(measured.angular_momentum),
                      .contacts = static_cast<double>(contacts)});
}

std::string run_page(const Simulation& simulation, const RunRecord& record, const RunSeries& series) {
  const Scene& scene = simulation.scene();
  const std::string title = scene.title.empty() ? record.scene : scene.title;
  std::string text =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" + html_of(title) +
      "</title><style>" + std::string(kRunStyle) + "</style></head><body>\n<h1>" + html_of(title) +
      "</h1>\n<p class=\"about\">" + html_of(record.scene) +
      text_of(", %.6g s in %zu steps, hooke %s, hash of the last state %s</p>\n", simulation.world().time(),
              record.step_ms.size(), kVersion, hash_text(simulation.world().state_hash()).c_str());
  if (!scene.description.empty()) text += "<p>" + html_of(scene.description) + "</p>\n";
  text += passed(simulation) ? "<p class=\"pass\">What was due has passed.</p>\n"
                             : "<p class=\"fail\">Something that was due has failed.</p>\n";
  text += "<h2>What the scene promises</h2>\n" + promises_of_run(simulation);
  text += "<h2>What broke</h2>\n" + breaks_of_run(simulation);
  text += "<h2>Forces on supports</h2>\n" + supports_of_run(series);
  text += "<h2>Warnings, and what helps</h2>\n" + list_of(record.warnings, "None.");
  if (!record.notes.empty()) text += "<h2>Notes</h2>\n" + list_of(record.notes, "");
  return text + plots_of_run(series.samples()) + "</body></html>\n";
}

}  // namespace hooke::app
