#include "sizing/domain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "sizing/source.h"

namespace plisse::sizing {
namespace {

using glm::dvec2;

struct Cut {
  std::size_t segment = 0;
  double share = 0;
  dvec2 point{0};
};

struct Curve {
  Polyline line;
  Domain::Line what;  // everything except the shape
  std::vector<Cut> cuts;
};

// Turns sharper than this are corners of the mesh; it is more than the turn in a circle of twelve points.
constexpr double corner_angle = 31 * std::numbers::pi / 180;

class Preparation {
 public:
  Preparation(const Panel& panel, const SizingOptions& options) : panel_(panel), options_(options) {}

  Domain run() {
    frame();
    add_boundary();
    report();
    add_marks();
    report();
    add_features();
    report();
    cut_at_crossings();
    split();
    if (domain_.lines.size() > 65000) problem("has too many lines: more than 65000 pieces");
    report();
    return std::move(domain_);
  }

 private:
  void problem(const std::string& text) {
    problems_ += fmt::format("{}panel '{}': {}", problems_.empty() ? "" : "\n", panel_.name, text);
  }
  void report() const {
    if (!problems_.empty()) throw Error(ExitCode::bad_input, problems_);
  }

  // Rotate weft to x and warp to y, then stretch y until both resolutions are the weft's.
  void frame() {
    domain_.resolution = fabric_resolution(panel_, options_);
    domain_.size = domain_.resolution.x;
    const double angle = panel_.grain * std::numbers::pi / 180,
                 stretch = domain_.resolution.x / domain_.resolution.y;
    const dvec2 warp(std::cos(angle), std::sin(angle)), weft(warp.y, -warp.x);
    domain_.to_working = glm::transpose(glm::dmat2(weft, warp * stretch));  // rows
    domain_.to_panel = glm::inverse(domain_.to_working);
  }

  Polyline working(Polyline line) const {
    for (dvec2& point : line.points) point = domain_.to_working * point;
    return without_repeats(std::move(line));
  }

  std::string place(const dvec2& point) const {
    const dvec2 p = domain_.to_panel * point;
    return fmt::format("({:.6g}, {:.6g}) m", p.x, p.y);
  }

  void add_boundary() {
    const auto add = [&](const Polyline& shape, const std::string& name) {
      Polyline line = working(shape);
      line.closed = true;
      for (const dvec2& point : line.points) {
        if (!std::isfinite(point.x) || !std::isfinite(point.y))
          return problem(name + " has a point that is no number");
      }
      line = without_repeats(std::move(line));
      if (line.points.size() < 3)
        return problem(fmt::format("{} has {} points; three at least", name, line.points.size()));
      if (const auto where = self_crossing(line))
        return problem(fmt::format("{} crosses itself at {}", name, place(*where)));
      const double perimeter = line.length();
      // An outline with less area is a line forth and back, up to the rounding of its coordinates.
      if (!(std::abs(signed_area(line)) > 1e-9 * perimeter * perimeter))
        return problem(name + " has no area");
      for (std::size_t i = 0; i < domain_.boundary.size(); ++i) {
        if (!contains(domain_.boundary[i], line.points[0]) == (i == 0))
          return problem(name + (i == 0 ? " lies outside the outline" : " lies inside another hole"));
      }
      Domain::Line what;
      what.boundary = true;
      what.curve = static_cast<int>(curves_.size());
      domain_.boundary.push_back(line);
      curves_.push_back({std::move(line), what, {}});
    };
    add(panel_.outline, "the outline");
    if (domain_.boundary.empty()) return;
    domain_.low = domain_.high = domain_.boundary[0].points[0];
    for (const dvec2& point : domain_.boundary[0].points) {
      domain_.low = glm::min(domain_.low, point);
      domain_.high = glm::max(domain_.high, point);
    }
    tolerance_ = 1e-7 * glm::distance(domain_.low, domain_.high);
    // The number of triangles must be limited: more than 2^24 cells cannot be resolved by the grid's
    // integers.
    const double expected = std::abs(signed_area(domain_.boundary[0])) / (domain_.size * domain_.size);
    if (expected > 2e7)
      problem(fmt::format("is {:.3g} × {:.3g} m, which takes {:.2g} vertices; check its units",
                          domain_.high.x - domain_.low.x, domain_.high.y - domain_.low.y, expected));
    for (std::size_t i = 0; i < panel_.holes.size(); ++i) add(panel_.holes[i], fmt::format("hole {}", i + 1));
    for (std::size_t i = 0; i < curves_.size(); ++i) {
      for (std::size_t j = i + 1; j < curves_.size(); ++j) {
        if (const auto where = meeting(curves_[i].line, curves_[j].line))
          problem(fmt::format("hole {} meets {} at {}", j, i == 0 ? "the outline" : fmt::format("hole {}", i),
                              place(*where)));
      }
    }
  }

  static std::optional<dvec2> meeting(const Polyline& one, const Polyline& other) {
    for (std::size_t i = 0; i < one.segment_count(); ++i) {
      for (std::size_t j = 0; j < other.segment_count(); ++j) {
        if (const auto at = crossing(one.start(i), one.end(i), other.start(j), other.end(j)))
          return one.start(i) + (one.end(i) - one.start(i)) * at->first;
      }
    }
    return std::nullopt;
  }

  // Moves an end of a line onto a curve within a tenth of the size, and cuts the curve there.
  void snap(dvec2& end, double reach) {
    Curve* nearest = nullptr;
    Cut cut;
    double least = reach;
    for (Curve& curve : curves_) {
      for (std::size_t i = 0; i < curve.line.segment_count(); ++i) {
        const dvec2 a = curve.line.start(i), b = curve.line.end(i), at = nearest_on_segment(end, a, b);
        if (const double distance = glm::distance(end, at); distance < least) {
          least = distance;
          nearest = &curve;
          cut = {i, glm::distance(a, at) / glm::distance(a, b), at};
        }
      }
    }
    if (!nearest) return;
    // Uses a vertex of the curve if it is as near.
    for (const dvec2& point : {nearest->line.start(cut.segment), nearest->line.end(cut.segment)}) {
      if (glm::distance(point, cut.point) <= tolerance_) {
        cut.share = point == nearest->line.start(cut.segment) ? 0 : 1;
        cut.point = point;
      }
    }
    nearest->cuts.push_back(cut);
    end = cut.point;
  }

  void add_marks() {
    for (dvec2 mark : panel_.marks) {
      dvec2 at = domain_.to_working * mark;
      const std::size_t cuts = curves_[0].cuts.size();
      snap(at, 0.1 * domain_.size);
      if (curves_[0].cuts.size() == cuts)
        problem(fmt::format("({:.6g}, {:.6g}) m is no point of its outline, where a seam is to begin or end",
                            mark.x, mark.y));
    }
  }

  void add_features() {
    for (std::size_t f = 0; f < panel_.features.size(); ++f) {
      const Feature& feature = panel_.features[f];
      const std::string name = fmt::format("{} '{}'", name_of(feature.rule), feature.name);
      Polyline line = working(feature.line);
      if (std::any_of(line.points.begin(), line.points.end(),
                      [](const dvec2& p) { return !std::isfinite(p.x) || !std::isfinite(p.y); })) {
        problem(name + " has a point that is no number");
        continue;
      }
      if (line.points.size() < 2 || !(line.length() > 10 * tolerance_)) {
        problem(name + " has no length");
        continue;
      }
      const bool region = feature.rule == Feature::Rule::cell || feature.rule == Feature::Rule::collision;
      if (region && (!line.closed || line.points.size() < 3)) {
        problem(name + " must be a closed line");
        continue;
      }
      if (!touches(line)) {
        problem(name + " lies outside the panel");
        continue;
      }
      if (feature.rule == Feature::Rule::collision) continue;  // only a size, not a constraint
      Domain::Line what;
      what.curve = static_cast<int>(curves_.size());
      what.features = {static_cast<int>(f)};
      if (feature.rule == Feature::Rule::fold) what.fold = static_cast<int>(f);
      const bool strip = feature.rule == Feature::Rule::fold && options_.fold_offset > 0 && !line.closed;
      if (!line.closed) {
        snap(line.points.front(), 0.1 * domain_.size);
        snap(line.points.back(), 0.1 * domain_.size);
        line = without_repeats(std::move(line));
      }
      curves_.push_back({line, what, {}});
      if (!strip) continue;
      for (const int side : {-1, 1}) {
        Domain::Line beside = what;
        beside.curve = static_cast<int>(curves_.size());
        beside.fold_side = side;
        curves_.push_back({parallel(line, side * options_.fold_offset), beside, {}});
      }
    }
  }

  // Whether any part of it is in the panel.
  bool touches(const Polyline& line) const {
    for (std::size_t i = 0; i < line.segment_count(); ++i) {
      if (domain_.inside(line.start(i)) || domain_.inside((line.start(i) + line.end(i)) / 2.0)) return true;
    }
    if (domain_.inside(line.points.back())) return true;
    return std::any_of(curves_.begin(), curves_.end(), [&](const Curve& curve) {
      for (const dvec2& point : line.points) {  // a line along the outline is in the panel
        for (std::size_t i = 0; i < curve.line.segment_count(); ++i) {
          if (distance_to_segment(point, curve.line.start(i), curve.line.end(i)) <= tolerance_) return true;
        }
      }
      return meeting(curve.line, line).has_value();
    });
  }

  // At a distance in metres of the panel, with mitred corners; where the fold ends on the outline it is
  // extended a little, to be cut there.
  Polyline parallel(const Polyline& line, double offset) const {
    std::vector<dvec2> p;
    for (const dvec2& point : line.points) p.push_back(domain_.to_panel * point);
    const auto normal = [&](std::size_t i) {
      const dvec2 along = glm::normalize(p[i + 1] - p[i]);
      return dvec2(-along.y, along.x);
    };
    Polyline result;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const dvec2 before = normal(i == 0 ? 0 : i - 1), after = normal(i + 1 == p.size() ? i - 1 : i);
      const dvec2 mitre = (before + after) / std::max(1 + glm::dot(before, after), 0.2);
      result.points.push_back(domain_.to_working * (p[i] + offset * mitre));
    }
    const auto lengthen = [&](dvec2& end, const dvec2& from, const dvec2& original) {
      for (const Polyline& boundary : domain_.boundary) {
        for (std::size_t i = 0; i < boundary.segment_count(); ++i) {
          if (distance_to_segment(original, boundary.start(i), boundary.end(i)) > tolerance_) continue;
          end += glm::normalize(end - from) * (4 * std::abs(offset));
          return;
        }
      }
    };
    const std::size_t last = result.points.size() - 1;
    lengthen(result.points[0], result.points[1], line.points.front());
    lengthen(result.points[last], result.points[last - 1], line.points.back());
    return result;
  }

  void cut_at_crossings() {
    for (std::size_t a = 0; a < curves_.size(); ++a) {
      for (std::size_t b = std::max(a + 1, domain_.boundary.size()); b < curves_.size(); ++b) {
        Curve &one = curves_[a], &other = curves_[b];
        for (std::size_t i = 0; i < one.line.segment_count(); ++i) {
          const dvec2 low = glm::min(one.line.start(i), one.line.end(i)) - tolerance_;
          const dvec2 high = glm::max(one.line.start(i), one.line.end(i)) + tolerance_;
          for (std::size_t j = 0; j < other.line.segment_count(); ++j) {
            const dvec2 c = other.line.start(j), d = other.line.end(j);
            if (std::max(c.x, d.x) < low.x || std::min(c.x, d.x) > high.x || std::max(c.y, d.y) < low.y ||
                std::min(c.y, d.y) > high.y)
              continue;
            const auto at = crossing(one.line.start(i), one.line.end(i), c, d);
            if (!at) continue;
            const dvec2 point = one.line.start(i) + (one.line.end(i) - one.line.start(i)) * at->first;
            one.cuts.push_back({i, at->first, point});
            other.cuts.push_back({j, at->second, point});
          }
        }
      }
    }
  }

  bool is_corner(const Polyline& line, std::size_t i) const {
    if (!line.closed && (i == 0 || i + 1 == line.points.size())) return true;
    const std::size_t count = line.points.size();
    const dvec2 before = domain_.to_panel * (line.points[i] - line.points[(i + count - 1) % count]);
    const dvec2 after = domain_.to_panel * (line.points[(i + 1) % count] - line.points[i]);
    return std::abs(std::atan2(before.x * after.y - before.y * after.x, glm::dot(before, after))) >
           corner_angle;
  }

  // Equal positions are one point, on whichever curve they are.
  dvec2 merged(const dvec2& point) {
    for (const dvec2& known : junctions_) {
      if (glm::distance(known, point) <= tolerance_) return known;
    }
    junctions_.push_back(point);
    return point;
  }

  // The curve with its cuts as additional points; flags mark the cuts.
  void with_cuts(Curve& curve, std::vector<std::uint8_t>& breaks) {
    std::stable_sort(curve.cuts.begin(), curve.cuts.end(), [](const Cut& a, const Cut& b) {
      return std::pair(a.segment, a.share) < std::pair(b.segment, b.share);
    });
    Polyline line{{}, curve.line.closed};
    const auto put = [&](const dvec2& point, bool cut) {
      if (!line.points.empty() && glm::distance(line.points.back(), point) <= tolerance_) {
        if (cut) {
          line.points.back() = point;
          breaks.back() = 1;
        }
        return;
      }
      line.points.push_back(point);
      breaks.push_back(cut);
    };
    auto cut = curve.cuts.begin();
    for (std::size_t i = 0; i < curve.line.points.size(); ++i) {
      const bool corner = is_corner(curve.line, i);
      // A cut at the last added point replaces it, which `put` does.
      if (line.points.empty() || glm::distance(line.points.back(), curve.line.points[i]) > tolerance_ ||
          corner)
        put(corner ? merged(curve.line.points[i]) : curve.line.points[i], corner);
      for (; cut != curve.cuts.end() && cut->segment == i; ++cut) put(merged(cut->point), true);
    }
    if (line.closed && line.points.size() > 1 &&
        glm::distance(line.points.front(), line.points.back()) <= tolerance_) {
      line.points.front() = line.points.back();
      breaks.front() |= breaks.back();
      line.points.pop_back();
      breaks.pop_back();
    }
    curve.line = std::move(line);
  }

  // Whether a piece is on this line along its whole length.
  bool runs_along(const Polyline& piece, const Polyline& line) const {
    const auto on = [&](const dvec2& point) {
      for (std::size_t i = 0; i < line.segment_count(); ++i) {
        if (distance_to_segment(point, line.start(i), line.end(i)) <= 4 * tolerance_) return true;
      }
      return false;
    };
    for (std::size_t i = 0; i < piece.segment_count(); ++i) {
      if (!on((piece.start(i) + piece.end(i)) / 2.0) || !on(piece.start(i))) return false;
    }
    return true;
  }

  void split() {
    std::vector<std::vector<std::uint8_t>> breaks(curves_.size());
    for (std::size_t c = 0; c < curves_.size(); ++c) with_cuts(curves_[c], breaks[c]);
    for (std::size_t c = 0; c < curves_.size(); ++c) {
      const Curve& curve = curves_[c];
      const auto& flags = breaks[c];
      const std::size_t count = curve.line.points.size();
      std::size_t first = 0;
      while (first < count && !flags[first]) ++first;
      if (first == count) {  // a smooth closed curve that meets no other
        add_piece(curve, curve.line);
        continue;
      }
      Polyline piece{{curve.line.points[first]}, false};
      for (std::size_t k = 1; k <= curve.line.segment_count(); ++k) {
        const std::size_t i = (first + k) % count;
        piece.points.push_back(curve.line.points[i]);
        if (!flags[i]) continue;
        add_piece(curve, piece);
        piece.points = {curve.line.points[i]};
      }
    }
    for (Domain::Line& line : domain_.lines) {
      for (const Curve& curve : curves_) {
        if (curve.what.boundary || curve.what.curve == line.curve || curve.what.fold_side != 0) continue;
        if (runs_along(line.shape, curve.line)) line.features.push_back(curve.what.features[0]);
      }
    }
    domain_.boundary_lines = static_cast<std::size_t>(std::count_if(
        domain_.lines.begin(), domain_.lines.end(), [](const Domain::Line& line) { return line.boundary; }));
  }

  void add_piece(const Curve& curve, const Polyline& piece) {
    if (!curve.what.boundary) {
      // A piece along an earlier curve belongs to that curve; `split` adds the feature to it.
      const auto end = curves_.begin() + curve.what.curve;
      if (std::any_of(curves_.begin(), end,
                      [&](const Curve& earlier) { return runs_along(piece, earlier.line); }))
        return;
      const std::size_t middle = piece.segment_count() / 2;
      if (!domain_.inside((piece.start(middle) + piece.end(middle)) / 2.0)) {
        if (curve.what.fold_side == 0) {
          const Feature& feature = panel_.features[static_cast<std::size_t>(curve.what.features[0])];
          const std::string text =
              fmt::format("panel '{}': {} '{}' reaches over the outline and is cut there", panel_.name,
                          name_of(feature.rule), feature.name);
          if (domain_.warnings.empty() || domain_.warnings.back() != text) domain_.warnings.push_back(text);
        }
        return;
      }
    }
    Domain::Line line = curve.what;
    line.shape = piece;
    domain_.lines.push_back(std::move(line));
  }

  const Panel& panel_;
  const SizingOptions& options_;
  Domain domain_;
  std::vector<Curve> curves_;
  std::vector<dvec2> junctions_;
  double tolerance_ = 0;
  std::string problems_;
};

}  // namespace

bool Domain::inside(const dvec2& working) const {
  bool inside = false;
  for (const Polyline& line : boundary) inside ^= contains(line, working);
  return inside;
}

Domain prepare(const Panel& panel, const SizingOptions& options) {
  return Preparation(panel, options).run();
}

}  // namespace plisse::sizing
