#include "sizing/polyline.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "base/error.h"

namespace plisse::sizing {
namespace {

using glm::dvec2;

double cross(const dvec2& a, const dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

// One pass over SVG path data (SVG 1.1, 8.3).
class PathReader {
 public:
  explicit PathReader(std::string_view text) : text_(text) {}

  std::vector<Polyline> read() {
    char command = 0;
    for (skip(); at_ < text_.size(); skip()) {
      const char c = text_[at_];
      if (std::isalpha(static_cast<unsigned char>(c))) {
        command = c;
        ++at_;
      } else if (command == 0 || command == 'Z' || command == 'z') {
        fail("a number where a command should stand");
      }
      if (lines_.empty() && command != 'M' && command != 'm') fail("a path begins with M");
      step(command);
      if (command == 'M') command = 'L';  // further pairs are lines
      if (command == 'm') command = 'l';
    }
    if (lines_.empty()) fail("no path");
    return std::move(lines_);
  }

 private:
  [[noreturn]] void fail(const char* what) const {
    throw Error(ExitCode::bad_input, fmt::format("path data, character {}: {}", at_ + 1, what));
  }
  void skip() {
    while (at_ < text_.size() && (std::isspace(static_cast<unsigned char>(text_[at_])) || text_[at_] == ','))
      ++at_;
  }
  double number() {
    skip();
    if (at_ < text_.size() && text_[at_] == '+') ++at_;
    double value = 0;
    const auto [end, problem] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (problem != std::errc{} || !std::isfinite(value)) fail("a number should stand here");
    at_ = static_cast<std::size_t>(end - text_.data());
    return value;
  }
  bool flag() {
    skip();
    if (at_ >= text_.size() || (text_[at_] != '0' && text_[at_] != '1')) fail("an arc's flag is 0 or 1");
    return text_[at_++] == '1';
  }
  dvec2 point(bool relative) {
    const double x = number(), y = number();
    return relative ? here_ + dvec2(x, y) : dvec2(x, y);
  }
  void line_to(const dvec2& to) {
    if (lines_.back().closed)
      lines_.push_back({{here_}, false});  // SVG: a new subpath from where the last closed
    lines_.back().points.push_back(to);
    here_ = control_ = to;
  }
  void curve_to(const dvec2& first, const dvec2& second, const dvec2& to) {
    const dvec2 from = here_;
    constexpr int pieces = 48;
    for (int i = 1; i <= pieces; ++i) {
      const double t = static_cast<double>(i) / pieces, s = 1 - t;
      line_to(i == pieces
                  ? to
                  : s * s * s * from + 3 * s * s * t * first + 3 * s * t * t * second + t * t * t * to);
    }
  }
  void arc_to(double rx, double ry, double degrees, bool large, bool sweep, const dvec2& to) {
    // SVG 1.1, F.6.5: from end points to centre and angles.
    const dvec2 from = here_;
    rx = std::abs(rx);
    ry = std::abs(ry);
    if (rx == 0 || ry == 0 || from == to) return line_to(to);
    const double phi = degrees * std::numbers::pi / 180, cosine = std::cos(phi), sine = std::sin(phi);
    const dvec2 half = (from - to) / 2.0;
    const dvec2 turned(cosine * half.x + sine * half.y, -sine * half.x + cosine * half.y);
    const double needed = std::hypot(turned.x / rx, turned.y / ry);
    if (needed > 1) {
      rx *= needed;
      ry *= needed;
    }
    const double below = std::pow(rx * turned.y, 2) + std::pow(ry * turned.x, 2);
    const double factor =
        std::sqrt(std::max(0.0, (rx * rx * ry * ry - below) / below)) * (large == sweep ? -1 : 1);
    const dvec2 middle(factor * rx * turned.y / ry, -factor * ry * turned.x / rx);
    const dvec2 centre =
        dvec2(cosine * middle.x - sine * middle.y, sine * middle.x + cosine * middle.y) + (from + to) / 2.0;
    const double begin = std::atan2((turned.y - middle.y) / ry, (turned.x - middle.x) / rx);
    double turn = std::atan2((-turned.y - middle.y) / ry, (-turned.x - middle.x) / rx) - begin;
    if (sweep && turn < 0) turn += 2 * std::numbers::pi;
    if (!sweep && turn > 0) turn -= 2 * std::numbers::pi;
    const int pieces =
        std::max(2, static_cast<int>(std::ceil(std::abs(turn) * 60 / std::numbers::pi)));  // 3° each
    for (int i = 1; i <= pieces; ++i) {
      const double angle = begin + turn * i / pieces;
      const dvec2 q(rx * std::cos(angle), ry * std::sin(angle));
      line_to(i == pieces ? to : centre + dvec2(cosine * q.x - sine * q.y, sine * q.x + cosine * q.y));
    }
  }
  void step(char command) {
    const bool relative = std::islower(static_cast<unsigned char>(command));
    const dvec2 reflected = 2.0 * here_ - control_;
    switch (command) {
      case 'M':
      case 'm':
        here_ = control_ = point(relative);
        lines_.push_back({{here_}, false});
        return;
      case 'L':
      case 'l':
        return line_to(point(relative));
      case 'H':
      case 'h':
        return line_to({number() + (relative ? here_.x : 0), here_.y});
      case 'V':
      case 'v':
        return line_to({here_.x, number() + (relative ? here_.y : 0)});
      case 'C':
      case 'c':
      case 'S':
      case 's': {
        const bool smooth = command == 'S' || command == 's';
        const dvec2 first = smooth ? (last_curve_ == 'C' ? reflected : here_) : point(relative);
        const dvec2 second = point(relative), to = point(relative);
        curve_to(first, second, to);
        control_ = second;
        last_curve_ = 'C';
        return;
      }
      case 'Q':
      case 'q':
      case 'T':
      case 't': {
        const bool smooth = command == 'T' || command == 't';
        const dvec2 control = smooth ? (last_curve_ == 'Q' ? reflected : here_) : point(relative);
        const dvec2 to = point(relative), from = here_;
        curve_to(from + (control - from) * (2.0 / 3), to + (control - to) * (2.0 / 3), to);
        control_ = control;
        last_curve_ = 'Q';
        return;
      }
      case 'A':
      case 'a': {
        const double rx = number(), ry = number(), degrees = number();
        const bool large = flag(), sweep = flag();
        return arc_to(rx, ry, degrees, large, sweep, point(relative));
      }
      case 'Z':
      case 'z':
        here_ = control_ = lines_.back().points.front();
        lines_.back().closed = true;
        return;
      default:
        --at_;
        fail("no command of path data; there are M L H V C S Q T A Z");
    }
  }

  std::string_view text_;
  std::size_t at_ = 0;
  dvec2 here_{0}, control_{0};
  char last_curve_ = 0;
  std::vector<Polyline> lines_;
};

}  // namespace

double Polyline::length() const {
  double sum = 0;
  for (std::size_t i = 0; i < segment_count(); ++i) sum += glm::distance(start(i), end(i));
  return sum;
}

std::vector<Polyline> parse_path(std::string_view text) {
  auto lines = PathReader(text).read();
  for (Polyline& line : lines) line = without_repeats(std::move(line));
  return lines;
}

std::vector<Polyline> parse_svg(std::string_view document, std::string_view id) {
  // The value of an attribute within one tag: name, =, a quoted text. Names must stand whole ("d", not "id").
  const auto attribute = [](std::string_view tag, std::string_view name) -> std::string_view {
    for (std::size_t at = tag.find(name); at != std::string_view::npos; at = tag.find(name, at + 1)) {
      if (at == 0 || !std::isspace(static_cast<unsigned char>(tag[at - 1]))) continue;
      std::size_t quote = tag.find_first_not_of(" \t\r\n", at + name.size());
      if (quote == std::string_view::npos || tag[quote] != '=') continue;
      quote = tag.find_first_not_of(" \t\r\n", quote + 1);
      if (quote == std::string_view::npos || (tag[quote] != '"' && tag[quote] != '\'')) continue;
      const std::size_t end = tag.find(tag[quote], quote + 1);
      if (end != std::string_view::npos) return tag.substr(quote + 1, end - quote - 1);
    }
    return {};
  };
  for (std::size_t at = document.find("<path"); at != std::string_view::npos;
       at = document.find("<path", at + 1)) {
    const std::string_view tag = document.substr(at, document.find('>', at) - at);
    if (!id.empty() && attribute(tag, "id") != id) continue;
    auto lines = parse_path(attribute(tag, "d"));
    for (Polyline& line : lines) {
      for (dvec2& point : line.points) point.y = -point.y;
    }
    return lines;
  }
  throw Error(ExitCode::bad_input, id.empty() ? "has no <path>" : fmt::format("has no <path id=\"{}\">", id));
}

Polyline spline_through(const std::vector<dvec2>& points, bool closed) {
  const Polyline line = without_repeats({points, closed});
  const auto& p = line.points;
  if (p.size() < 3) return line;
  constexpr int pieces = 24;
  Polyline result{{}, closed};
  const auto count = static_cast<std::ptrdiff_t>(p.size());
  const auto at = [&](std::ptrdiff_t i) {
    if (closed) return p[static_cast<std::size_t>((i + count) % count)];
    if (i < 0) return 2.0 * p[0] - p[1];  // linear extrapolation beyond the ends
    if (i >= count) return 2.0 * p[p.size() - 1] - p[p.size() - 2];
    return p[static_cast<std::size_t>(i)];
  };
  for (std::ptrdiff_t i = 0; i < static_cast<std::ptrdiff_t>(line.segment_count()); ++i) {
    const dvec2 a = at(i - 1), b = at(i), c = at(i + 1), d = at(i + 2);
    // Knots by the root of the chord (α = ½): no loops and no cusps between points.
    const double t1 = std::sqrt(glm::distance(a, b)), t2 = t1 + std::sqrt(glm::distance(b, c)),
                 t3 = t2 + std::sqrt(glm::distance(c, d));
    for (int k = 0; k < pieces; ++k) {
      const double t = t1 + (t2 - t1) * k / pieces;
      const dvec2 ab = a * ((t1 - t) / t1) + b * (t / t1);
      const dvec2 bc = b * ((t2 - t) / (t2 - t1)) + c * ((t - t1) / (t2 - t1));
      const dvec2 cd = c * ((t3 - t) / (t3 - t2)) + d * ((t - t2) / (t3 - t2));
      const dvec2 abc = ab * ((t2 - t) / t2) + bc * (t / t2);
      const dvec2 bcd = bc * ((t3 - t) / (t3 - t1)) + cd * ((t - t1) / (t3 - t1));
      result.points.push_back(k == 0 ? b : abc * ((t2 - t) / (t2 - t1)) + bcd * ((t - t1) / (t2 - t1)));
    }
  }
  if (!closed) result.points.push_back(p.back());
  return result;
}

Polyline without_repeats(Polyline line) {
  line.points.erase(std::unique(line.points.begin(), line.points.end()), line.points.end());
  while (line.closed && line.points.size() > 1 && line.points.front() == line.points.back())
    line.points.pop_back();
  return line;
}

double signed_area(const Polyline& closed) {
  if (closed.points.empty()) return 0;
  double sum = 0;
  const dvec2 origin = closed.points.front();  // near the curve, against cancellation of large areas
  for (std::size_t i = 0; i < closed.points.size(); ++i)
    sum += cross(closed.start(i) - origin, closed.end(i) - origin);
  return sum / 2;
}

bool contains(const Polyline& closed, const dvec2& point) {
  bool inside = false;
  for (std::size_t i = 0; i < closed.points.size(); ++i) {
    const dvec2 a = closed.start(i), b = closed.end(i);
    if ((a.y > point.y) != (b.y > point.y) && point.x < a.x + (b.x - a.x) * ((point.y - a.y) / (b.y - a.y)))
      inside = !inside;
  }
  return inside;
}

dvec2 nearest_on_segment(const dvec2& point, const dvec2& a, const dvec2& b) {
  const dvec2 ab = b - a;
  const double squared = glm::dot(ab, ab);
  return squared > 0 ? a + ab * std::clamp(glm::dot(point - a, ab) / squared, 0.0, 1.0) : a;
}

double distance_to_segment(const dvec2& point, const dvec2& a, const dvec2& b) {
  return glm::distance(point, nearest_on_segment(point, a, b));
}

std::optional<Crossing> crossing(const dvec2& a, const dvec2& b, const dvec2& c, const dvec2& d) {
  const dvec2 first = b - a, second = d - c, between = c - a;
  const double turn = cross(first, second);
  if (std::abs(turn) <= 1e-12 * glm::length(first) * glm::length(second)) return std::nullopt;
  const Crossing shares{cross(between, second) / turn, cross(between, first) / turn};
  if (shares.first < 0 || shares.first > 1 || shares.second < 0 || shares.second > 1) return std::nullopt;
  return shares;
}

std::optional<dvec2> self_crossing(const Polyline& closed) {
  const std::size_t count = closed.segment_count();
  // Sorted by the smallest x, so that only segments with a common x are compared.
  std::vector<std::size_t> order(count);
  for (std::size_t i = 0; i < count; ++i) order[i] = i;
  const auto left = [&](std::size_t i) { return std::min(closed.start(i).x, closed.end(i).x); };
  const auto right = [&](std::size_t i) { return std::max(closed.start(i).x, closed.end(i).x); };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return left(a) < left(b); });
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = order[k];
    for (std::size_t l = k + 1; l < count && left(order[l]) <= right(i); ++l) {
      const std::size_t j = order[l];
      if ((i + 1) % count == j || (j + 1) % count == i) continue;
      if (const auto meets = crossing(closed.start(i), closed.end(i), closed.start(j), closed.end(j)))
        return closed.start(i) + (closed.end(i) - closed.start(i)) * meets->first;
    }
  }
  return std::nullopt;
}

}  // namespace plisse::sizing
