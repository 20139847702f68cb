#pragma once

#include "hooke/compare/tables.h"
#include "hooke/result.h"

#include <string>
#include <vector>

namespace hooke::app {

struct PlotPoint {
  double x = 0;
  double y = 0;
};

/// One line of a plot.
struct PlotCurve {
  std::string title;
  std::string color = "#000000";
  bool dashed = false;
  bool marked = false;  ///< A mark at each point.
  std::vector<PlotPoint> points = {};
};

struct PlotAxis {
  std::string label;  ///< With its unit.
  bool logarithmic = false;
  std::optional<PlotPoint> range = {};  ///< Lowest and highest; the curves' own without it.
};

/// What gnuplot draws.
struct Plot {
  std::string name;  ///< Of the file, without its ending.
  std::string title;
  std::string caption;  ///< For the page: what there is to see.
  PlotAxis x;
  PlotAxis y;
  bool same_scale = false;  ///< A meter is as long along both axes.
  std::vector<PlotCurve> curves;
};

enum class PlotFormat { kPng, kSvg };

/// Trajectory, position, error, energy, order and cost, as far as there is something in them.
std::vector<Plot> plots_of(const Comparison& comparison);

/// The picture's bytes, drawn by the program gnuplot. kUnsupported if it is missing or refuses.
Result<std::string> draw_plot(const Plot& plot, PlotFormat format);

}  // namespace hooke::app
