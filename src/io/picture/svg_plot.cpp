#include "io/picture/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/text.h"

namespace plisse::io {
namespace {

constexpr std::array<const char*, 7> colours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                "#56b4e9", "#e69f00", "#444444"};
constexpr double left = 86, right = 28, top = 52, bottom = 58;
constexpr double text_size = 12, letter = 0.56 * text_size;  // mean advance of a sans-serif letter
constexpr double mark = 5;                                   // half a symbol's size
constexpr double zero_strip = 28;                            // below a logarithmic axis, for what is 0

std::string tick_text(double value, const PlotAxis& axis) {
  if (!axis.seconds) {
    const double size = std::abs(value);
    return size != 0 && (size < 1e-3 || size >= 1e5) ? fmt::format("{:.3g}", value)
                                                     : fmt::format("{:g}", value);
  }
  const double size = std::abs(value);
  if (size >= 1 || size == 0) return fmt::format("{:g} s", value);
  if (size >= 0.999e-3) return fmt::format("{:g} ms", 1e3 * value);
  return fmt::format("{:g} µs", 1e6 * value);
}

// From values to pixels along one axis.
class Scale {
 public:
  Scale(const PlotAxis& axis, double from, double to, const std::vector<double>& values)
      : axis_(axis), from_(from), to_(to) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const double value : values) {
      if (axis.logarithmic && value <= 0) {
        has_zero_ = true;
        continue;
      }
      low = std::min(low, value);
      high = std::max(high, value);
    }
    if (!(low <= high)) low = high = 1;
    if (has_zero_) from_ += std::copysign(zero_strip, to - from);
    if (axis.logarithmic) {
      log_ticks(low, high);
    } else {
      linear_ticks(low, high);
    }
  }

  double operator()(double value) const {
    if (axis_.logarithmic && value <= 0) return zero();
    const double at = axis_.logarithmic ? std::log10(value) : value;
    return from_ + (at - low_) / (high_ - low_) * (to_ - from_);
  }
  double zero() const { return from_ - std::copysign(zero_strip / 2 + 2, to_ - from_); }
  bool has_zero() const { return has_zero_; }
  const std::vector<double>& ticks() const { return ticks_; }

 private:
  void log_ticks(double low, double high) {
    low_ = std::log10(low);
    high_ = std::log10(high);
    const double air = std::max(0.08, 0.07 * (high_ - low_));
    low_ -= air;
    high_ += air;
    const int stride = std::max(1, static_cast<int>(std::ceil((high_ - low_) / 8)));
    // As many digits in a decade as it takes for three ticks.
    const std::vector<double> steps[] = {{1}, {1, 2, 5}, {1, 2, 3, 4, 5, 6, 7, 8, 9}};
    for (const std::vector<double>& digits : steps) {
      ticks_.clear();
      for (int decade = static_cast<int>(std::floor(low_)); decade <= static_cast<int>(std::ceil(high_));
           ++decade) {
        if (decade % stride != 0) continue;
        for (const double digit : digits) {
          const double tick = digit * std::pow(10.0, decade);
          if (std::log10(tick) >= low_ && std::log10(tick) <= high_) ticks_.push_back(tick);
        }
      }
      if (ticks_.size() >= 3) return;
    }
  }
  void linear_ticks(double low, double high) {
    const double air = low < high ? 0.06 * (high - low) : std::max(1.0, std::abs(low)) / 2;
    // Down to 0 where that is near: lengths of columns of air mean something then.
    low_ = low >= 0 && low < 0.4 * high ? 0 : low - air;
    high_ = high + air;
    const double raw = (high_ - low_) / 6, decade = std::pow(10.0, std::floor(std::log10(raw)));
    const double step = decade * (raw < 1.5 * decade   ? 1
                                  : raw < 3.5 * decade ? 2
                                  : raw < 7.5 * decade ? 5
                                                       : 10);
    for (double tick = std::ceil(low_ / step) * step; tick <= high_ + 1e-9 * step; tick += step)
      ticks_.push_back(std::abs(tick) < 1e-9 * step ? 0 : tick);
  }

  PlotAxis axis_;
  double from_, to_, low_ = 0, high_ = 1;
  bool has_zero_ = false;
  std::vector<double> ticks_;
};

std::string symbol(std::size_t series, double x, double y) {
  const char* colour = colours[series % colours.size()];
  const double m = mark;
  switch (series % 5) {
    case 0:
      return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\"/>\n", x, y, m, colour);
    case 1:
      return fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{}\" fill=\"{}\"/>\n", x - m,
                         y - m, 2 * m, 2 * m, colour);
    case 2:
      return fmt::format("<path d=\"M{:.1f} {:.1f}l{} {}h{}z\" fill=\"{}\"/>\n", x, y - 1.2 * m, 1.2 * m,
                         2.2 * m, -2.4 * m, colour);
    case 3:
      return fmt::format("<path d=\"M{:.1f} {:.1f}l{} {}l{} {}l{} {}z\" fill=\"{}\"/>\n", x, y - 1.4 * m,
                         1.4 * m, 1.4 * m, -1.4 * m, 1.4 * m, -1.4 * m, -1.4 * m, colour);
    default:
      return fmt::format(
          "<path d=\"M{:.1f} {:.1f}l{} {}m0 {}l{} {}\" stroke=\"{}\" stroke-width=\"3\" fill=\"none\"/>\n",
          x - m, y - m, 2 * m, 2 * m, -2 * m, -2 * m, 2 * m, colour);
  }
}

struct Box {
  double x = 0, y = 0, width = 0, height = 0;
  double overlap(const Box& other) const {
    const double w = std::min(x + width, other.x + other.width) - std::max(x, other.x);
    const double h = std::min(y + height, other.y + other.height) - std::max(y, other.y);
    return w > 0 && h > 0 ? w * h : 0;
  }
};

// Where labels go: of eight places round a point the one that covers least.
class Labels {
 public:
  explicit Labels(const Box& area) : area_(area) {}
  void keep_free(const Box& box) { taken_.push_back(box); }
  std::string place(const std::string& text, double x, double y) {
    const double width = letter * static_cast<double>(letters(text)), height = text_size;
    Box best;
    double least = std::numeric_limits<double>::infinity();
    const double gap = mark + 7;  // clear of a ring
    const std::array<std::array<double, 2>, 12> places = {{{gap, -height / 2},
                                                           {-gap - width, -height / 2},
                                                           {-width / 2, -gap - height},
                                                           {-width / 2, gap},
                                                           {gap, -gap - height + 4},
                                                           {gap, gap - 4},
                                                           {-gap - width, -gap - height + 4},
                                                           {-gap - width, gap - 4},
                                                           {-width / 2, -gap - 2.1 * height},
                                                           {-width / 2, gap + 1.1 * height},
                                                           {gap, -gap - 2 * height},
                                                           {gap, gap + height}}};
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Box box{x + places[i][0], y + places[i][1], width, height};
      double cost = 0.5 * static_cast<double>(i);
      for (const Box& other : taken_) cost += box.overlap(other);
      cost += 4 * (box.width * box.height - box.overlap(area_));
      if (cost < least) {
        least = cost;
        best = box;
      }
    }
    taken_.push_back(best);
    return fmt::format("<text class=\"label\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", best.x,
                       best.y + 0.8 * height, xml_text(text));
  }

 private:
  Box area_;
  std::vector<Box> taken_;
};

void check(const Plot& plot) {
  bool any = false;
  for (const PlotSeries& series : plot.series) {
    for (const PlotPoint& point : series.points) {
      any = true;
      if (!std::isfinite(point.x + point.y + point.x_low + point.x_high))
        throw Error(ExitCode::no_output,
                    fmt::format("plot '{}': a value of '{}' is not finite", plot.title, series.name));
    }
  }
  if (!any) throw Error(ExitCode::no_output, fmt::format("plot '{}': there is no point to draw", plot.title));
}

}  // namespace

std::string xml_text(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string svg_plot(const Plot& plot) {
  check(plot);
  std::vector<double> xs, ys;
  double longest = letter * static_cast<double>(letters(plot.mark_name));
  for (const PlotSeries& series : plot.series) {
    longest = std::max(longest, letter * static_cast<double>(letters(series.name)));
    for (const PlotPoint& point : series.points) {
      xs.push_back(point.x);
      if (point.x_low > 0) xs.push_back(point.x_low);
      if (point.x_high > 0) xs.push_back(point.x_high);
      ys.push_back(point.y);
    }
  }
  const bool legend = plot.series.size() > 1 || !plot.mark_name.empty();
  const double legend_width = legend ? longest + 44 : 0;
  const Box area{left, top, plot.width - left - right - legend_width, plot.height - top - bottom};
  const Scale x(plot.x, area.x, area.x + area.width, xs), y(plot.y, area.y + area.height, area.y, ys);

  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "role=\"img\" aria-label=\"{2}\">\n"
      "<style>text{{font:{3}px 'Helvetica Neue',Arial,'Liberation Sans',sans-serif;fill:#222}}"
      ".title{{font-size:15px;font-weight:600}}.label{{font-size:11.5px;fill:#333;stroke:#fff;stroke-width:"
      "3px;paint-order:stroke}}"
      ".grid{{stroke:#e3e3e3}}.axis{{stroke:#777}}</style>\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n"
      "<text class=\"title\" x=\"{4}\" y=\"26\">{2}</text>\n",
      plot.width, plot.height, xml_text(plot.title), text_size, left);

  const double under = area.y + area.height;
  for (const double tick : x.ticks()) {
    svg += fmt::format(
        "<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/>"
        "<text x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4}</text>\n",
        x(tick), area.y, under, under + 18, tick_text(tick, plot.x));
  }
  for (const double tick : y.ticks()) {
    svg += fmt::format(
        "<line class=\"grid\" x1=\"{1}\" x2=\"{2}\" y1=\"{0:.1f}\" y2=\"{0:.1f}\"/>"
        "<text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5}</text>\n",
        y(tick), area.x, area.x + area.width, area.x - 8, y(tick) + 4, tick_text(tick, plot.y));
  }
  if (y.has_zero()) {
    svg += fmt::format(
        "<line class=\"axis\" stroke-dasharray=\"2 3\" x1=\"{1}\" x2=\"{2}\" y1=\"{0:.1f}\" y2=\"{0:.1f}\"/>"
        "<text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">0</text>\n",
        y.zero() - zero_strip / 2 - 2, area.x, area.x + area.width, area.x - 8, y.zero() + 4);
  }
  svg += fmt::format("<path class=\"axis\" fill=\"none\" d=\"M{} {}V{}H{}\"/>\n", area.x, area.y, under,
                     area.x + area.width);
  svg += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n",
                     area.x + area.width / 2, plot.height - 16, xml_text(plot.x.label));
  svg +=
      fmt::format("<text transform=\"translate(22 {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
                  area.y + area.height / 2, xml_text(plot.y.label));

  // The front first, so that symbols lie over it.
  std::vector<PlotPoint> front;
  for (const PlotSeries& series : plot.series)
    for (const PlotPoint& point : series.points)
      if (point.marked) front.push_back(point);
  std::sort(front.begin(), front.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  const char* front_style = "fill=\"none\" stroke=\"#222\" stroke-width=\"1.4\" stroke-dasharray=\"5 4\"";
  if (front.size() > 1) {
    std::string path;
    for (const PlotPoint& point : front)
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x(point.x), y(point.y));
    svg += fmt::format("<path {} d=\"{}\"/>\n", front_style, path);
  }

  Labels labels(area);
  for (const PlotSeries& series : plot.series)
    for (const PlotPoint& point : series.points)
      labels.keep_free({x(point.x) - mark, y(point.y) - mark, 2 * mark, 2 * mark});
  std::string texts;
  for (std::size_t s = 0; s < plot.series.size(); ++s) {
    const PlotSeries& series = plot.series[s];
    const char* colour = colours[s % colours.size()];
    if (series.joined && series.points.size() > 1) {
      std::string path;
      for (const PlotPoint& point : series.points)
        path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x(point.x), y(point.y));
      svg +=
          fmt::format("<path fill=\"none\" stroke=\"{}\" stroke-opacity=\".55\" d=\"{}\"/>\n", colour, path);
    }
    for (const PlotPoint& point : series.points) {
      if (point.x_low > 0 && point.x_high > point.x_low)
        svg += fmt::format(
            "<line stroke=\"{0}\" stroke-width=\"1.5\" x1=\"{1:.1f}\" x2=\"{2:.1f}\" y1=\"{3:.1f}\" "
            "y2=\"{3:.1f}\"/>\n",
            colour, x(point.x_low), x(point.x_high), y(point.y));
      svg += symbol(s, x(point.x), y(point.y));
      if (point.marked)
        svg += fmt::format(
            "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"none\" stroke=\"#222\" "
            "stroke-width=\"1.4\"/>\n",
            x(point.x), y(point.y), mark + 4);
      if (!point.label.empty()) texts += labels.place(point.label, x(point.x), y(point.y));
    }
  }
  svg += texts;

  if (legend) {
    const double at = area.x + area.width + 22;
    double line = area.y + 8;
    for (std::size_t s = 0; s < plot.series.size(); ++s) {
      if (plot.series[s].name.empty()) continue;
      svg += symbol(s, at, line);
      svg += fmt::format("<text x=\"{}\" y=\"{}\">{}</text>\n", at + 14, line + 4,
                         xml_text(plot.series[s].name));
      line += 22;
    }
    if (!plot.mark_name.empty()) {
      svg += fmt::format(
          "<path {} d=\"M{} {}h20\"/><circle cx=\"{}\" cy=\"{}\" r=\"7\" fill=\"#fff\" stroke=\"#222\" "
          "stroke-width=\"1.4\"/>",
          front_style, at - 10, line + 2, at, line + 2);
      svg += fmt::format("<text x=\"{}\" y=\"{}\">{}</text>\n", at + 14, line + 6, xml_text(plot.mark_name));
    }
  }
  return svg + "</svg>\n";
}

}  // namespace plisse::io
