#include "hooke/compare/page_data.h"

#include "hooke/compare/plots.h"
#include "hooke/text_of.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <nlohmann/json.hpp>

namespace hooke::app {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostNumbers = 100000;  // Of all curves together; ten bytes each.
constexpr std::size_t kNumbersPerSample = 8;
constexpr double kUnits = 2000;    // Units of a frame in the size of the picture.
constexpr double kFarthest = 1e7;  // Of a place in a frame, in units.

/// Returns a number with six digits, which is shorter on the page; null for one that is not finite.
Json shortened(double value) {
  if (!std::isfinite(value)) return nullptr;
  return std::strtod(text_of_number(value).c_str(), nullptr);
}

Json list_of(const std::vector<const Sample*>& samples, const std::function<double(const Sample&)>& value) {
  Json list = Json::array();
  for (const Sample* sample : samples) list.push_back(shortened(value(*sample)));
  return list;
}

/// This is how places become whole numbers of a picture.
struct Projection {
  int axis = 0;  ///< What goes to the right: 0 is x, 2 is z.
  DVec3 origin = {};
  double unit = 1;  ///< [m]

  [[nodiscard]] double whole(double meters) const {
    const double value = std::round(meters / unit);
    return std::isfinite(value) ? std::clamp(value, -kFarthest, kFarthest) : kFarthest;
  }
  [[nodiscard]] double across(DVec3 p) const { return whole(component(p - origin, axis)); }
  [[nodiscard]] double up(DVec3 p) const { return whole(p.y - origin.y); }
};

/// These are the smallest and largest places of a picture, in meters.
struct Box {
  DVec3 low = {1e300, 1e300, 1e300};
  DVec3 high = {-1e300, -1e300, -1e300};

  void add(DVec3 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  [[nodiscard]] double size(int axis) const { return component(high - low, axis); }
};

/// Returns the box of what the reference does, or else of the start: what leaves it has gone wrong.
Box box_of(const Comparison& comparison) {
  Box box;
  const auto& reference = comparison.reference.frames;
  if (reference.empty()) {
    for (const Trial& trial : comparison.trials) {
      if (trial.frames.empty()) continue;
      const std::size_t shown = trial.diverged_at ? 1 : trial.frames.size();
      for (std::size_t i = 0; i < shown; ++i) {
        for (const DVec3 p : trial.frames[i]) box.add(p);
      }
    }
  }
  for (const Frame& frame : reference) {
    for (const DVec3 p : frame) box.add(p);
  }
  if (box.low.x > box.high.x) box.add({});
  return box;
}

Json frames_of(const std::vector<Frame>& frames, const Outline& outline, const Projection& projection) {
  Json list = Json::array();
  for (const Frame& frame : frames) {
    Json places = Json::array();
    for (const std::uint32_t point : outline.points) {
      places.push_back(static_cast<long>(projection.across(frame[point])));
      places.push_back(static_cast<long>(projection.up(frame[point])));
    }
    list.push_back(std::move(places));
  }
  return list;
}

/// Returns the curves of one run, of at most so many samples.
Json curves_of(const std::vector<Sample>& samples, const Comparison& comparison, std::size_t most) {
  const std::size_t every = std::max<std::size_t>(1, (samples.size() + most - 1) / most);
  std::vector<const Sample*> kept;
  for (std::size_t i = 0; i < samples.size(); i += every) kept.push_back(&samples[i]);
  Json run;
  run["every"] = static_cast<double>(every * comparison.schedule.stride) * comparison.schedule.dt;
  run["energy"] = list_of(kept, [](const Sample& s) { return s.energy.total(); });
  run["kinetic"] = list_of(kept, [](const Sample& s) { return s.energy.kinetic; });
  run["potential"] = list_of(kept, [](const Sample& s) { return s.energy.potential; });
  run["elastic"] = list_of(kept, [](const Sample& s) { return s.energy.elastic; });
  run["x"] = list_of(kept, [](const Sample& s) { return s.position.x; });
  run["y"] = list_of(kept, [](const Sample& s) { return s.position.y; });
  run["z"] = list_of(kept, [](const Sample& s) { return s.position.z; });
  run["error"] = list_of(kept, [](const Sample& s) { return s.error; });
  return run;
}

Json named(const std::string& name, const char* color, bool dashed, Json run) {
  Json whole = {{"name", name}, {"color", color}, {"dashed", dashed}, {"gone", nullptr}};
  whole.update(run);
  return whole;
}

Json runs_of(const Comparison& comparison, const Projection& projection) {
  const std::size_t count = comparison.trials.size() + 2;
  const std::size_t most = std::clamp<std::size_t>(kMostNumbers / (kNumbersPerSample * count), 200, 2000);
  Json runs = Json::array();
  for (std::size_t i = 0; i < comparison.trials.size(); ++i) {
    const Trial& trial = comparison.trials[i];
    Json run = named(trial.name, color_of_run(i), false, curves_of(trial.samples, comparison, most));
    if (trial.diverged_at) run["gone"] = shortened(*trial.diverged_at);
    run["frames"] = frames_of(trial.frames, comparison.outline, projection);
    runs.push_back(std::move(run));
  }
  const Reference& reference = comparison.reference;
  if (reference.samples.empty()) return runs;
  Json run = named(kReferenceName, "#000000", true, curves_of(reference.samples, comparison, most));
  run.erase("error");
  run["frames"] = frames_of(reference.frames, comparison.outline, projection);
  runs.push_back(std::move(run));
  if (!comparison.rigid) return runs;
  std::vector<Sample> rigid = reference.samples;
  for (Sample& sample : rigid) {
    sample.position = comparison.rigid->position(sample.time);
    sample.energy = comparison.rigid->energy(sample.time);
  }
  Json rod = named("rigid rod", "#767676", true, curves_of(rigid, comparison, most));
  rod.erase("error");
  rod["frames"] = Json::array();
  runs.push_back(std::move(rod));
  return runs;
}

Json motion_of(const Comparison& comparison, const Box& box, const Projection& projection) {
  Json lines = Json::array();
  for (const auto& [a, b] : comparison.outline.lines) lines.push_back({a, b});
  const double margin = 0.08 * kUnits;
  return {{"dt", static_cast<double>(comparison.schedule.frame_stride) * comparison.schedule.dt},
          {"count", comparison.schedule.steps / comparison.schedule.frame_stride + 1},
          {"axis", projection.axis},
          {"watched", comparison.outline.watched},
          {"lines", std::move(lines)},
          {"box",
           {projection.across(box.low) - margin, projection.up(box.low) - margin,
            projection.across(box.high) + margin, projection.up(box.high) + margin}}};
}

Json method_json(const MethodGrowth& method, const char* color) {
  Json curve = Json::array();
  for (const GrowthPoint& point : method.curve) {
    curve.push_back(
        {shortened(point.omega_dt), std::strtod(text_of_number(point.growth, 12).c_str(), nullptr)});
  }
  Json spans = Json::array();
  for (const StableSpan& span : method.stable)
    spans.push_back({shortened(span.imaginary), shortened(span.from), shortened(span.to)});
  Json result = {{"name", method.info.name},
                 {"color", color},
                 {"limit", shortened(method.info.imaginary_limit)},
                 {"undamped", method.undamped ? shortened(*method.undamped) : Json(nullptr)},
                 {"curve", std::move(curve)},
                 {"spans", std::move(spans)}};
  return result;
}

Json stability_json(const Comparison& comparison) {
  const SystemMotion& system = comparison.stability.system;
  Json z = Json::array();
  for (const std::complex<double> value : system.z)
    z.push_back({shortened(value.real()), shortened(value.imag())});
  Json methods = Json::array();
  for (const MethodGrowth& method : comparison.stability.methods) {
    std::size_t number = 0;
    while (number < comparison.trials.size() && comparison.trials[number].name != method.info.name) ++number;
    methods.push_back(method_json(method, color_of_run(number)));
  }
  return {{"omega_dt", shortened(system.omega * comparison.dt)},
          {"z", std::move(z)},
          {"window",
           {{"left", StabilityWindow::kLeft},
            {"right", StabilityWindow::kRight},
            {"top", StabilityWindow::kTop},
            {"height", StabilityWindow::kBandHeight}}},
          {"methods", std::move(methods)}};
}

}  // namespace

std::string text_of_number(double value, int digits) {
  return text_of("%.*g", digits, value);
}

std::string page_data(const Comparison& comparison) {
  const Box box = box_of(comparison);
  Projection projection = {.axis = box.size(2) > box.size(0) ? 2 : 0};
  const double size = std::max({box.size(projection.axis), box.size(1), 0.25 * comparison.reference.extent});
  projection.origin = 0.5 * (box.low + box.high);
  projection.unit = size / kUnits;
  // A thing that moves along a line still gets a picture of some width.
  Box picture = box;
  for (double DVec3::*axis : {&DVec3::x, &DVec3::y, &DVec3::z}) {
    picture.low.*axis = std::min(box.low.*axis, projection.origin.*axis - 0.5 * size);
    picture.high.*axis = std::max(box.high.*axis, projection.origin.*axis + 0.5 * size);
  }
  Json data = {{"seconds", shortened(comparison.seconds)},
               {"dt", comparison.dt},
               {"extent", shortened(comparison.reference.extent)},
               {"reference", comparison.reference.title},
               {"guide", comparison.reference.samples.empty() && !comparison.trials.empty()
                             ? comparison.trials.back().name
                             : std::string(kReferenceName)},
               {"motion", motion_of(comparison, picture, projection)},
               {"runs", runs_of(comparison, projection)},
               {"stability", stability_json(comparison)}};
  std::string text = data.dump(-1, ' ', false, Json::error_handler_t::replace);
  // Inside of an HTML page nothing may look like the end of a script.
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at))
    text.replace(at, 1, "\\u003c");
  return text;
}

}  // namespace hooke::app
