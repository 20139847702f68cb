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

/// This is one line of a plot.
struct PlotCurve {
  std::string title;
  std::string color = "#000000";
  bool dashed = false;
  bool marked = false;  ///< Whether each point has a mark.
  std::vector<PlotPoint> points = {};
};

struct PlotAxis {
  std::string label;  ///< Text with its unit.
  bool logarithmic = false;
  std::optional<PlotPoint> range = {};  ///< Lowest and highest value; without it, those of the curves.
};

/// A Plot is what gnuplot draws.
struct Plot {
  std::string name;  ///< Name of the file, without its ending.
  std::string title;
  std::string caption;  ///< Text of the page on what the plot shows.
  PlotAxis x;
  PlotAxis y;
  bool same_scale = false;  ///< Whether a meter has the same length along both axes.
  std::vector<PlotCurve> curves;
};

/// Returns the color of the run of this number, as "#D55E00".
const char* color_of_run(std::size_t number);

enum class PlotFormat { kPng, kSvg };

/// Makes plots of trajectory, position, error, energy, order and cost, as far as there are data.
std::vector<Plot> plots_of(const Comparison& comparison);

/// Returns the picture's bytes, drawn by the program gnuplot. The Error is kUnsupported if gnuplot is missing
/// or refuses.
Result<std::string> draw_plot(const Plot& plot, PlotFormat format);

}  // namespace hooke::app
