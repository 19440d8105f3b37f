// R. Bridson, "Fast Poisson Disk Sampling in Arbitrary Dimensions", SIGGRAPH 2007 sketches, with a radius
// that varies: accepted samples are stored in several grids by the size of their discs, each about twice as
// coarse as the one before, so that a look-up costs the same everywhere.

#include "sizing/sample.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <utility>

namespace plisse::sizing {
namespace {

using glm::dvec2;

constexpr std::uint32_t none = ~std::uint32_t{0};

// Buckets of samples by size and place.
class Buckets {
 public:
  Buckets(const Domain& domain, double least, double greatest) : low_(domain.low), least_(least) {
    const dvec2 extent = domain.high - domain.low;
    for (double cell = least;; cell *= 2) {
      const int columns = static_cast<int>(extent.x / cell) + 2, rows = static_cast<int>(extent.y / cell) + 2;
      levels_.push_back({cell, columns, rows, {}});
      levels_.back().first.assign(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), none);
      if (cell * 2 > greatest) break;
    }
  }

  void add(const dvec2& point, double size) {
    Level& level = levels_[level_of(size)];
    std::uint32_t& first = level.first[cell(level, point)];
    next_.push_back(first);
    first = static_cast<std::uint32_t>(next_.size() - 1);
    samples_.push_back({point, size});
  }

  // Whether a disc there is far enough from all others: |pq|² ≥ κ² r_p r_q.
  bool fits(const dvec2& point, double size) const {
    const std::size_t own = level_of(size);
    // Its own level first, where most conflicts are. Sizes vary slowly in space, but features may meet, so
    // also one level finer and two coarser.
    for (const int step : {0, 1, -1, 2}) {
      const std::size_t l = own + static_cast<std::size_t>(step);
      if (l >= levels_.size()) continue;  // also true for −1, which wraps around
      const Level& level = levels_[l];
      const double reach =
          least_distance * std::sqrt(size * std::min(2 * level.cell, greatest_in_reach * size));
      const int x0 = column(level, point.x - reach), x1 = column(level, point.x + reach);
      const int y0 = row(level, point.y - reach), y1 = row(level, point.y + reach);
      for (int y = y0; y <= y1; ++y) {
        for (int x = x0; x <= x1; ++x) {
          for (std::uint32_t i =
                   level.first[static_cast<std::size_t>(y) * static_cast<std::size_t>(level.columns) +
                               static_cast<std::size_t>(x)];
               i != none; i = next_[i]) {
            const dvec2 way = samples_[i].point - point;
            if (glm::dot(way, way) < least_distance * least_distance * size * samples_[i].size) return false;
          }
        }
      }
    }
    return true;
  }

 private:
  struct Level {
    double cell;
    int columns, rows;
    std::vector<std::uint32_t> first;
  };
  struct Sample {
    dvec2 point;
    double size;
  };
  static constexpr double greatest_in_reach = 8;

  std::size_t level_of(double size) const {
    const int level = size > least_ ? std::ilogb(size / least_) : 0;
    return std::min(levels_.size() - 1, static_cast<std::size_t>(std::max(level, 0)));
  }
  int column(const Level& level, double x) const {
    return std::clamp(static_cast<int>((x - low_.x) / level.cell), 0, level.columns - 1);
  }
  int row(const Level& level, double y) const {
    return std::clamp(static_cast<int>((y - low_.y) / level.cell), 0, level.rows - 1);
  }
  std::size_t cell(const Level& level, const dvec2& point) const {
    return static_cast<std::size_t>(row(level, point.y)) * static_cast<std::size_t>(level.columns) +
           static_cast<std::size_t>(column(level, point.x));
  }

  dvec2 low_;
  double least_;
  std::vector<Level> levels_;
  std::vector<std::uint32_t> next_;
  std::vector<Sample> samples_;
};

// A line in short steps: the number of edges of the wanted length up to each point.
class Walk {
 public:
  Walk(const Polyline& shape, const SizeMap& map, double line_size) : shape_(shape) {
    count_.push_back(0);
    for (std::size_t i = 0; i < shape.segment_count(); ++i) {
      const dvec2 a = shape.start(i), b = shape.end(i);
      const double length = glm::distance(a, b);
      const int pieces =
          std::clamp(static_cast<int>(std::ceil(4 * length / std::min(map.size(a), line_size))), 1, 1 << 20);
      for (int k = 0; k < pieces; ++k) {
        const double size = std::min(map.size(a + (b - a) * ((k + 0.5) / pieces)), line_size);
        place_.push_back({i, static_cast<double>(k) / pieces, static_cast<double>(k + 1) / pieces});
        count_.push_back(count_.back() + length / pieces / size);
      }
    }
  }
  double edges() const { return count_.back(); }
  // The segment, and how far along it.
  std::pair<std::size_t, double> place(double edges) const {
    const auto after = std::upper_bound(count_.begin() + 1, count_.end() - 1, edges);
    const auto k = static_cast<std::size_t>(after - count_.begin()) - 1;
    const auto& [segment, from, to] = place_[k];
    return {segment, from + (to - from) * (edges - count_[k]) / (count_[k + 1] - count_[k])};
  }
  dvec2 at(double edges) const {
    const auto [segment, share] = place(edges);
    return shape_.start(segment) + (shape_.end(segment) - shape_.start(segment)) * share;
  }

 private:
  struct Place {
    std::size_t segment;
    double from, to;
  };
  const Polyline& shape_;
  std::vector<double> count_;
  std::vector<Place> place_;
};

// Shares of a line's length in panel coordinates; working coordinates are stretched.
class PanelLength {
 public:
  PanelLength(const Domain& domain, const Polyline& shape) : shape_(shape) {
    length_.push_back(0);
    for (std::size_t i = 0; i < shape.segment_count(); ++i)
      length_.push_back(length_.back() + glm::length(domain.to_panel * (shape.end(i) - shape.start(i))));
  }
  double share_of(const std::pair<std::size_t, double>& place) const {
    const auto [i, share] = place;
    return (length_[i] + share * (length_[i + 1] - length_[i])) / length_.back();
  }
  dvec2 at(double share) const {
    const double wanted = share * length_.back();
    const auto after = std::upper_bound(length_.begin() + 1, length_.end() - 1, wanted);
    const auto i = static_cast<std::size_t>(after - length_.begin()) - 1;
    const double part = (wanted - length_[i]) / (length_[i + 1] - length_[i]);
    return shape_.start(i) + (shape_.end(i) - shape_.start(i)) * part;
  }

 private:
  const Polyline& shape_;
  std::vector<double> length_;
};

// All four nodes around it are inside: this decides most cases.
bool amid_inside(const SizeMap& map, const dvec2& point) {
  const dvec2 at = (point - map.node(0, 0)) / map.step();
  const int x = std::clamp(static_cast<int>(at.x), 0, map.columns() - 2),
            y = std::clamp(static_cast<int>(at.y), 0, map.rows() - 2);
  return map.inside(x, y) && map.inside(x + 1, y) && map.inside(x, y + 1) && map.inside(x + 1, y + 1);
}

}  // namespace

std::vector<double> line_division(const Domain& domain, const SizeMap& map, std::size_t line) {
  const Polyline& shape = domain.lines[line].shape;
  const Walk walk(shape, map, map.line_size(line));
  const int edges = std::max(1, static_cast<int>(std::lround(walk.edges())));
  const PanelLength length(domain, shape);
  std::vector<double> shares;
  for (int k = 1; k < edges; ++k) shares.push_back(length.share_of(walk.place(walk.edges() * k / edges)));
  return shares;
}

Samples sample_lines(const Domain& domain, const SizeMap& map, const Divisions& divisions) {
  Samples samples;
  std::map<std::pair<double, double>, std::uint32_t> junctions;
  const auto add = [&](const dvec2& point) {
    samples.points.push_back(point);
    return static_cast<std::uint32_t>(samples.points.size() - 1);
  };
  const auto junction = [&](const dvec2& point) {
    const auto [entry, fresh] = junctions.try_emplace({point.x, point.y}, 0);
    if (fresh) entry->second = add(point);
    return entry->second;
  };
  for (std::size_t l = 0; l < domain.lines.size(); ++l) {
    const Polyline& shape = domain.lines[l].shape;
    const Walk walk(shape, map, map.line_size(l));
    const int edges = std::max(shape.closed ? 3 : 1, static_cast<int>(std::lround(walk.edges())));
    auto& line = samples.lines.emplace_back();
    line.push_back(shape.closed ? add(shape.points[0]) : junction(shape.points.front()));
    if (const auto given = divisions.find(l); given != divisions.end()) {
      const PanelLength length(domain, shape);
      for (const double share : given->second) line.push_back(add(length.at(share)));
    } else {
      for (int k = 1; k < edges; ++k) line.push_back(add(walk.at(walk.edges() * k / edges)));
    }
    line.push_back(shape.closed ? line.front() : junction(shape.points.back()));
  }
  samples.on_lines = samples.points.size();
  return samples;
}

void sample_interior(const Domain& domain, const SizeMap& map, std::uint32_t seed, Samples& samples) {
  std::mt19937_64 random(seed);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  Buckets buckets(domain, map.least(), domain.size);
  std::vector<std::uint32_t> active;
  std::vector<double> sizes;
  const auto accept = [&](std::size_t i, double size) {
    buckets.add(samples.points[i], size);
    sizes.push_back(size);
    active.push_back(static_cast<std::uint32_t>(i));
  };
  for (std::size_t i = 0; i < samples.points.size(); ++i) accept(i, map.size(samples.points[i]));
  constexpr int tries = 30;  // Bridson's k
  while (!active.empty()) {
    const auto pick = static_cast<std::size_t>(uniform() * static_cast<double>(active.size()));
    const std::uint32_t centre = active[pick];
    const dvec2 from = samples.points[centre];
    bool found = false;
    for (int k = 0; k < tries && !found; ++k) {
      const double angle = 2 * std::numbers::pi * uniform();
      // Uniformly in κr … √2 κr. With Bridson's 2r a tenth of the discs that would fit are missing; with this
      // the packing is nearly full.
      const double radius = least_distance * sizes[centre] * std::sqrt(1 + uniform());
      const dvec2 point = from + radius * dvec2(std::cos(angle), std::sin(angle));
      if (!amid_inside(map, point) && !domain.inside(point)) continue;
      const double size = map.size(point);
      if (!buckets.fits(point, size)) continue;
      samples.points.push_back(point);
      accept(samples.points.size() - 1, size);
      found = true;
    }
    if (!found) {
      active[pick] = active.back();
      active.pop_back();
    }
  }
}

double expected_vertices(const Domain& domain, const SizeMap& map, const Samples& samples) {
  double cells = 0;
  for (int y = 0; y < map.rows(); ++y) {
    for (int x = 0; x < map.columns(); ++x) {
      if (map.inside(x, y)) cells += 1 / std::pow(static_cast<double>(map.node_size(x, y)), 2);
    }
  }
  double boundary = 0, beside_folds = 0;
  for (std::size_t l = 0; l < domain.lines.size(); ++l) {
    if (domain.lines[l].boundary) boundary += static_cast<double>(samples.lines[l].size() - 1);
    if (domain.lines[l].fold_side != 0) beside_folds += static_cast<double>(samples.lines[l].size());
  }
  return vertex_density * cells * map.step() * map.step() + boundary / 2 + 2 -
         static_cast<double>(domain.boundary.size()) + beside_folds;
}

}  // namespace plisse::sizing
