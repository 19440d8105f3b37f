// Plots as SVG: points with their spreads over two axes, linear or logarithmic. Series differ in colour (M.
// Okabe and K. Ito's palette, which the colour-blind tell apart) and in shape, so that they can be printed in
// grey.
#pragma once

#include <string>
#include <vector>

namespace plisse::io {

struct PlotPoint {
  double x = 0, y = 0;
  double x_low = 0, x_high = 0;  // spread, drawn as a bar; nothing where both are x or 0
  std::string label;             // beside the point; may be empty
  bool marked = false;           // ringed, and joined to the other marked points: a Pareto front
};

struct PlotSeries {
  std::string name;  // in the legend, unless it is empty
  std::vector<PlotPoint> points;
  bool joined = false;  // by a thin line, in their order
};

struct PlotAxis {
  std::string label;
  bool logarithmic = true;  // values ≤ 0 stand on a line of their own below the axis' lowest decade
  bool seconds = false;     // ticks as 1 ms, 10 ms, …
};

struct Plot {
  std::string title;
  PlotAxis x, y;
  std::vector<PlotSeries> series;
  std::string mark_name;  // what the marked points are, for the legend
  int width = 820, height = 480;
};

// A document of its own, on white. Throws Error(no_output) where there is no point or a value is not finite.
std::string svg_plot(const Plot& plot);

// A text as XML and HTML have it.
std::string xml_text(const std::string& text);

}  // namespace plisse::io
