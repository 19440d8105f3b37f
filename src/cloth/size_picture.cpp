#include "cloth/size_picture.h"

#include <fmt/format.h>
#include <stb_easy_font.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace plisse::cloth {
namespace {

using glm::dvec2;
using Colour = std::array<std::uint8_t, 3>;

// Viridis (S. van der Walt, N. Smith 2015, CC0) at nine places, dark to light.
constexpr std::array<Colour, 9> viridis = {{{68, 1, 84},
                                            {71, 44, 122},
                                            {59, 81, 139},
                                            {44, 113, 142},
                                            {33, 144, 141},
                                            {39, 173, 129},
                                            {92, 200, 99},
                                            {170, 220, 50},
                                            {253, 231, 37}}};

constexpr int text_scale = 3;  // stb_easy_font's letters are seven units high
constexpr Colour ink = {34, 38, 46};
constexpr Colour paper = {250, 250, 248};

double size_at(const sizing::SizedPanel& sized, const dvec2& working) {
  const dvec2 r = sized.map->resolution(working);
  return std::sqrt(r.x * r.y);
}

class Canvas {
 public:
  Canvas(int width, int height) {
    image_.width = width;
    image_.height = height;
    image_.rgba.assign(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 255);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) blend(x, y, paper, 1);
    }
  }
  io::Image take() { return std::move(image_); }
  int width() const { return image_.width; }
  int height() const { return image_.height; }

  void blend(int x, int y, const Colour& colour, double alpha) {
    if (x < 0 || y < 0 || x >= image_.width || y >= image_.height) return;
    std::uint8_t* pixel =
        &image_.rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
                          static_cast<std::size_t>(x))];
    for (std::size_t c = 0; c < 3; ++c)
      pixel[c] = static_cast<std::uint8_t>(std::lround(pixel[c] + alpha * (colour[c] - pixel[c])));
  }

  // Antialiasing by distance: coverage falls from 1 to 0 over one pixel at the edge of the line.
  void line(const dvec2& a, const dvec2& b, const Colour& colour, double width, double opacity) {
    const dvec2 low = glm::min(a, b) - width - 1.0, high = glm::max(a, b) + width + 1.0;
    const dvec2 clamped_low = glm::max(low, dvec2(0)),
                clamped_high = glm::min(high, dvec2(image_.width - 1, image_.height - 1));
    for (int y = static_cast<int>(clamped_low.y); y <= static_cast<int>(clamped_high.y); ++y) {
      for (int x = static_cast<int>(clamped_low.x); x <= static_cast<int>(clamped_high.x); ++x) {
        const double distance = sizing::distance_to_segment(dvec2(x + 0.5, y + 0.5), a, b);
        const double cover = std::clamp(width / 2 + 0.5 - distance, 0.0, 1.0) * std::min(width, 1.0);
        if (cover > 0) blend(x, y, colour, cover * opacity);
      }
    }
  }

  void rectangle(int x0, int y0, int x1, int y1, const Colour& colour) {
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) blend(x, y, colour, 1);
    }
  }

  // ASCII; (x, y) is the upper left corner.
  void text(int x, int y, std::string words, const Colour& colour) {
    struct Corner {
      float x, y, z;
      std::uint8_t colour[4];
    };
    std::vector<Corner> corners(std::max<std::size_t>(64, words.size() * 80));  // at most 17 quads a letter
    const int quads = stb_easy_font_print(0, 0, words.data(), nullptr, corners.data(),
                                          static_cast<int>(corners.size() * sizeof(Corner)));
    for (int q = 0; q < quads; ++q) {
      const Corner &low = corners[static_cast<std::size_t>(4 * q)],
                   &high = corners[static_cast<std::size_t>(4 * q + 2)];
      rectangle(x + static_cast<int>(low.x) * text_scale, y + static_cast<int>(low.y) * text_scale,
                x + static_cast<int>(high.x) * text_scale, y + static_cast<int>(high.y) * text_scale, colour);
    }
  }
  static int text_width(std::string words) { return stb_easy_font_width(words.data()) * text_scale; }

 private:
  io::Image image_;
};

// Panel coordinates to pixels: fitted, y up; as wide as the title needs.
class View {
 public:
  View(const sizing::Panel& panel, const std::string& title) {
    dvec2 low = panel.outline.points.front(), high = low;
    for (const dvec2& point : panel.outline.points) {
      low = glm::min(low, point);
      high = glm::max(high, point);
    }
    const dvec2 extent = glm::max(high - low, dvec2(1e-12));
    scale_ = std::min(largest / extent.x, largest / extent.y);
    const int fitted = static_cast<int>(extent.x * scale_) + 2 * margin + legend;
    width_ = std::max(fitted, Canvas::text_width(title) + 2 * margin);
    height_ = std::max(static_cast<int>(extent.y * scale_) + 2 * margin + caption, 560);
    shift_ = dvec2(margin + (width_ - fitted) / 2.0,
                   margin + caption + (height_ - 2 * margin - caption - extent.y * scale_) / 2) -
             dvec2(low.x, -high.y) * scale_;
  }
  dvec2 pixel(const dvec2& p) const { return shift_ + dvec2(p.x, -p.y) * scale_; }
  dvec2 place(const dvec2& pixel) const {
    const dvec2 at = (pixel - shift_) / scale_;
    return {at.x, -at.y};
  }
  int width() const { return width_; }
  int height() const { return height_; }
  double scale() const { return scale_; }
  static constexpr int margin = 48, legend = 210, caption = 64;

 private:
  static constexpr double largest = 900;
  double scale_ = 1;
  int width_ = 0, height_ = 0;
  dvec2 shift_{0};
};

// Colours as strong as the panel's own.
void draw_legend(Canvas& canvas, const View& view, const SizeScale& scale, const std::string& title,
                 double opacity) {
  canvas.text(View::margin, 36, title, ink);
  const int x = view.width() - View::legend + 10, top = View::margin + View::caption + 40,
            bottom = view.height() - View::margin - 20, width = 34;
  for (int y = top; y < bottom; ++y) {
    const double share = 1 - static_cast<double>(y - top) / (bottom - top);
    const Colour colour = scale.colour(scale.low() + share * (scale.high() - scale.low()));
    for (int i = 0; i < width; ++i) canvas.blend(x + i, y, colour, opacity);
  }
  canvas.text(x, top - 50, "r, mm", ink);
  constexpr int ticks = 5;
  const bool flat = scale.high() - scale.low() < 1e-3 * scale.high();
  for (int k = 0; k < ticks; ++k) {
    const double share = static_cast<double>(k) / (ticks - 1);
    const int y = bottom - 1 - static_cast<int>(share * (bottom - 1 - top));
    if (flat && k != ticks / 2) continue;
    canvas.rectangle(x + width, y, x + width + 8, y + 2, ink);
    canvas.text(x + width + 16, y - 10,
                fmt::format("{:.3g}", 1e3 * (scale.low() + share * (scale.high() - scale.low()))), ink);
  }
}

// A bar of a round length below the panel.
void draw_ruler(Canvas& canvas, const View& view) {
  const double wanted = 0.2 * (view.width() - View::legend) / view.scale();
  double length = std::pow(10, std::floor(std::log10(wanted)));
  if (5 * length <= wanted) {
    length *= 5;
  } else if (2 * length <= wanted) {
    length *= 2;
  }
  const int x = View::margin, y = view.height() - 24, pixels = static_cast<int>(length * view.scale());
  canvas.rectangle(x, y, x + pixels, y + 3, ink);
  canvas.rectangle(x, y - 5, x + 3, y + 8, ink);
  canvas.rectangle(x + pixels - 3, y - 5, x + pixels, y + 8, ink);
  canvas.text(x + pixels + 14, y - 9,
              length < 1 ? fmt::format("{:g} mm", 1e3 * length) : fmt::format("{:g} m", length), ink);
}

// The panel's pixels in the colours of the map, mixed with paper.
void fill(Canvas& canvas, const View& view, const sizing::Panel& panel, const sizing::SizedPanel& sized,
          const SizeScale& scale, double opacity) {
  std::vector<double> xs;
  const auto cross = [&](const sizing::Polyline& line, double y) {
    for (std::size_t i = 0; i < line.segment_count(); ++i) {
      const dvec2 a = view.pixel(line.start(i)), b = view.pixel(line.end(i));
      if ((a.y > y) != (b.y > y)) xs.push_back(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
    }
  };
  for (int row = 0; row < canvas.height(); ++row) {
    xs.clear();
    cross(panel.outline, row + 0.5);
    for (const auto& hole : panel.holes) cross(hole, row + 0.5);
    std::sort(xs.begin(), xs.end());
    for (std::size_t k = 0; k + 1 < xs.size(); k += 2) {
      for (int x = static_cast<int>(std::ceil(xs[k] - 0.5)); x + 0.5 < xs[k + 1]; ++x) {
        const dvec2 working = sized.domain.to_working * view.place(dvec2(x + 0.5, row + 0.5));
        canvas.blend(x, row, scale.colour(size_at(sized, working)), opacity);
      }
    }
  }
}

void draw_lines(Canvas& canvas, const View& view, const sizing::SizedPanel& sized) {
  for (const auto& line : sized.domain.lines) {
    for (std::size_t i = 0; i < line.shape.segment_count(); ++i) {
      canvas.line(view.pixel(sized.domain.to_panel * line.shape.start(i)),
                  view.pixel(sized.domain.to_panel * line.shape.end(i)),
                  line.boundary ? ink : Colour{205, 30, 60}, line.fold_side != 0 ? 1.0 : 2.6,
                  line.fold_side != 0 ? 0.5 : 1.0);
    }
  }
}

std::string title_of(const sizing::Panel& panel) {
  std::string title = panel.name;
  if (!panel.fabric.name.empty()) title += ", " + panel.fabric.name;
  for (char& c : title) c = c >= ' ' && c <= '~' ? c : '?';
  return title;
}

}  // namespace

SizeScale::SizeScale(const sizing::SizedPanel& panel) {
  const auto [low, high] = std::minmax_element(panel.mesh.sizes.begin(), panel.mesh.sizes.end());
  if (low == panel.mesh.sizes.end()) return;
  low_ = *low;
  high_ = *high;
}

std::array<std::uint8_t, 3> SizeScale::colour(double size) const {
  const double share =
      high_ > low_ * (1 + 1e-3) ? std::clamp((high_ - size) / (high_ - low_), 0.0, 1.0) : 0.5;
  const double place = share * (viridis.size() - 1);
  const auto first = std::min(static_cast<std::size_t>(place), viridis.size() - 2);
  Colour result{};
  for (std::size_t c = 0; c < 3; ++c) {
    result[c] = static_cast<std::uint8_t>(
        std::lround(viridis[first][c] +
                    (place - static_cast<double>(first)) * (viridis[first + 1][c] - viridis[first][c])));
  }
  return result;
}

io::Image draw_size_map(const sizing::Panel& panel, const sizing::SizedPanel& sized, const SizeScale& scale) {
  const std::string title = title_of(panel);
  const View view(panel, title);
  Canvas canvas(view.width(), view.height());
  fill(canvas, view, panel, sized, scale, 1);
  draw_lines(canvas, view, sized);
  draw_legend(canvas, view, scale, title, 1);
  draw_ruler(canvas, view);
  return canvas.take();
}

io::Image draw_size_mesh(const sizing::Panel& panel, const sizing::SizedPanel& sized,
                         const SizeScale& scale) {
  const std::string title = fmt::format("{}: {} vertices", title_of(panel), sized.mesh.vertices.size());
  const View view(panel, title);
  Canvas canvas(view.width(), view.height());
  constexpr double pale = 0.45;  // under the lines
  fill(canvas, view, panel, sized, scale, pale);
  // Thin lines where triangles are small, so that dense regions do not become black.
  for (const auto& triangle : sized.mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = triangle[i], b = triangle[(i + 1) % 3];
      const double pixels = 0.5 * (sized.mesh.sizes[a] + sized.mesh.sizes[b]) * view.scale();
      // Inner edges come twice, once a triangle.
      canvas.line(view.pixel(sized.mesh.vertices[a]), view.pixel(sized.mesh.vertices[b]), ink,
                  std::clamp(pixels / 14, 0.3, 1.1), 0.55);
    }
  }
  draw_lines(canvas, view, sized);
  draw_legend(canvas, view, scale, title, pale);
  draw_ruler(canvas, view);
  return canvas.take();
}

}  // namespace plisse::cloth
